#!/bin/sh
# Bodies of one mesh meet at an interface whatever ranks have them: a block slides down a slope on another one, by
# Coulomb's law, as on one rank, and goes on with what another number of ranks has left.
. "$(dirname "$0")/library.sh"

# Two rectangles, the line between them twice; once: with `shared`.
cat >blocks.geo <<'END'
DefineConstant[ shared = 0 ];
Point(1) = {0, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {2, 0.5, 0}; Point(4) = {0, 0.5, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(7) = {2, 1, 0}; Point(8) = {0, 1, 0};
If (shared)
  Line(6) = {3, 7}; Line(7) = {7, 8}; Line(8) = {8, 4};
  Curve Loop(2) = {-3, 6, 7, 8}; Plane Surface(2) = {2};
Else
  Point(5) = {0.1, 0.5, 0}; Point(6) = {0.9, 0.5, 0}; Point(9) = {0.9, 0.9, 0}; Point(10) = {0.1, 0.9, 0};
  Line(5) = {5, 6}; Line(6) = {6, 9}; Line(7) = {9, 10}; Line(8) = {10, 5};
  Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(2) = {2};
EndIf
Physical Surface("low") = {1}; Physical Surface("top") = {2}; Physical Curve("floor") = {1};
Mesh.CharacteristicLengthMin = 0.1; Mesh.CharacteristicLengthMax = 0.1;
END
# Meshed once each: gmsh takes longer to start than the program has to do.
for shared in 0 1; do
  gmsh -2 blocks.geo -o blocks$shared.msh -format msh41 -setnumber shared $shared >out.txt 2>&1 || fail "blocks.geo: no mesh"
done
cat >case.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, step: 5e-3, end: 0.15, bossak: -0.3}
grid: {mesh: blocks0.msh}
bodies: [{name: low, region: low, points_per_cell: 3, material: rubber}, {name: top, region: top, points_per_cell: 3, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}}
interfaces: [{name: joint, between: [top, low], contact: friction, friction: 0.2}]
boundary: [{name: floor, on: {boundary: floor}, fix: [x, y]}]
loads: {gravity: [4.905, -8.495709]} # 30 degrees
measures:
  along: {momentum: x, of: {body: top}}
  pressed: {interface_force: y, of: {interface: joint}}
  rubbed: {interface_force: x, of: {interface: joint}}
  friction: {energy: friction}
linear: direct # several ranks would iterate, and what may be left of gaps would differ
output: {fields: [displacement], every: end}
checkpoint: {steps: 8, keep: 5}
END

# 320 kg: gravity's impulse along the slope less 0.2 times that of the joint. It hops at first, so that the joint has
# given less than the weight has. Alike on all ranks, for which the first 12 of the 30 steps are enough, and resumed.
for method in fem gmm; do
  expect "$method slides, 1" 0 "$talus" run case.yaml --out ranks1 --force --quiet --set method=$method
  awk -F, 'NR > 1 { along = $3; given += 5e-3 * $4 }
    END { exit !((along / (320 * 4.905 * 0.15 - 0.2 * given) - 1) ^ 2 < 0.01 ^ 2 && given > 0.9 * 320 * 8.495709 * 0.15) }' ranks1/history.csv ||
    fail "$name: $(tail -n 1 ranks1/history.csv)"
  test $method = fem && ranks=3 other=2 || { ranks=2 other=3; }
  expect "$method slides, $ranks" 0 on_ranks $ranks "$talus" run case.yaml --out more --force --quiet \
    --set method=$method --set analysis.end=0.06
  head -n 14 ranks1/history.csv | paste -d, - more/history.csv | awk -F, '
    function size(x) { return x < 0 ? -x : x }
    NR > 1 { n++; for (k = 3; k <= 6; ++k) { if (size($k) > most[k]) most[k] = size($k); if (size($k - $(k + 6)) > off[k]) off[k] = size($k - $(k + 6)) } }
    END { for (k = 3; k <= 6; ++k) if (off[k] > 1e-8 * most[k]) { print k, off[k], most[k]; bad = 1 } exit bad || n != 13 }' ||
    fail "$name: not as on one rank"
  rm -f more/checkpoint*12*
  expect "$method goes on, $other" 0 on_ranks $other "$talus" run --resume more --quiet
  says more/log.txt "resumed = step 8"
  { sed -n 14p ranks1/history.csv; tail -n 1 more/history.csv; } |
    awk -F, '{ last = along; along = $3 } END { exit !($2 == 12 && (along / last - 1) ^ 2 < 1e-6 ^ 2) }' ||
    fail "$name: $(tail -n 1 more/history.csv)"
done

# Squares of four triangles have nodes in their middle, which ranks on the other side of the joint must know, too. What
# round-off leaves of forces of 364 N is another on each processor: 4e-8 N at most.
cat >crossed.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 0.04, steps: 8}
grid: {box: {min: [0, 0], max: [0.4, 0.5]}, size: 0.1, cell: triangle, diagonal: crossed}
bodies:
  - {name: block, shape: {box: {min: [0, 0], max: [0.2, 0.2]}}, material: m}
  - {name: lid, shape: {box: {min: [0, 0.2], max: [0.2, 0.4]}}, material: m}
materials: {m: {law: neo-hookean, density: 2000, young: 1e5, poisson: 0.3}}
boundary: [{name: floor, on: {y: 0}, fix: [x, y]}]
loads: {gravity: [4, -10]}
interfaces: [{name: joint, between: [block, lid], friction: 0.2}]
measures: {x: {momentum: x, of: {body: lid}}, y: {interface_force: y, of: {interface: joint}}, f: {interface_force: x, of: {interface: joint}}}
linear: direct
output: {every: end}
END
for method in fem mpm; do
  for ranks in 1 2 3; do
    [ $method$ranks != fem2 ] && [ $method$ranks != mpm3 ] || continue
    expect "crossed, $method, $ranks" 0 on_ranks $ranks "$talus" run crossed.yaml --out crossed$ranks --force --quiet --set method=$method
    paste -d, crossed1/history.csv crossed$ranks/history.csv | awk -F, '
      NR > 1 { n++; touch += $4 < -1; for (k = 3; k <= 5; ++k) bad += ($k - $(k + 5)) ^ 2 > (1e-9 * (k > 3 ? 364 : 13)) ^ 2 }
      END { exit bad || n != 9 || touch < 1 || $3 < 1 }' || fail "$name: $(tail -n 1 crossed$ranks/history.csv)"
  done
done

for ranks in 1 2; do
  test $ranks = 1 && method=gmm || method=fem
  expect "share nodes, $ranks" 2 on_ranks $ranks "$talus" run case.yaml --out shared --force --quiet \
    --set grid.mesh=blocks1.msh --set method=$method
  says err.txt "share nodes of the mesh: the line between them must be there twice"
  lacks err.txt "goes through"
done

# Two cubes of tetrahedra that share the nodes between them, in an uneven mesh: that alone is told. What does go through
# another body, in space, is told with three coordinates.
awk -v n=3 'BEGIN {
  m = n + 1
  print "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 1 \"low\"\n3 2 \"up\"\n$EndPhysicalNames\n$Nodes\n" m * m * (2 * n + 1)
  for (k = 0; k <= 2 * n; ++k) for (j = 0; j < m; ++j) for (i = 0; i < m; ++i) {
    ++node
    print node, (i + (i && i < n) * sin(7 * node) / 4) / n, (j + (j && j < n) * sin(11 * node) / 4) / n, (k + (k && k < n) * sin(5 * node) / 4) / n
  }
  print "$EndNodes\n$Elements\n" 12 * n ^ 3
  split("1 3 3 2 2 6 6 4 4 5 5 1", way, " ")
  for (k = 0; k < 2 * n; ++k) for (j = 0; j < n; ++j) for (i = 0; i < n; ++i) {
    a = 1 + i + m * (j + m * k); s[1] = a + 1; s[2] = a + m; s[3] = a + m + 1; s[4] = a + m * m; s[5] = s[4] + 1; s[6] = s[4] + m
    for (t = 1; t < 12; t += 2) print ++e, 4, 2, 1 + (k >= n), 1 + (k >= n), a, s[way[t]], s[way[t + 1]], s[6] + 1
  }
  print "$EndElements"
}' >tied.msh
cat >tied.yaml <<'END'
kinematics: 3d
method: fem
analysis: {type: static, steps: 1}
grid: {mesh: tied.msh}
bodies:
  - {name: low, region: low, points_per_cell: 4, material: rubber}
  - {name: up, region: up, points_per_cell: 4, material: rubber}
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{on: {z: 0}, fix: [x, y, z]}]
interfaces: [{name: joint, between: [low, up], friction: 0.3}]
END
for ranks in 1 3; do
  expect "tied, $ranks" 2 on_ranks $ranks "$talus" run tied.yaml --out tied --force --quiet
  says err.txt "share nodes of the mesh: the surface between them must be there twice"
  lacks err.txt "goes through"
done
expect "in each other" 2 "$talus" check tied.yaml --set method=mpm --set 'grid={box: {min: [0, 0, 0], max: [1, 1, 2]}, size: 0.5}' \
  --set 'bodies=[{name: low, shape: {box: {min: [0, 0, 0], max: [1, 1, 1]}}, material: rubber}, {name: up, shape: {box: {min: [0, 0, 0.5], max: [1, 1, 2]}}, material: rubber}]'
says err.txt "'low' goes through 'up' at the start"
grep -q "its point at ([^,]*, [^,]*, [^,]*) m is" err.txt || fail "$name: $(grep point err.txt)"
finish
