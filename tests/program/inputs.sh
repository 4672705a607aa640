#!/bin/sh
# Files that a case names belong to its runs: sweeps, calibrations, verifications and resumed runs take over none that read another one.
. "$(dirname "$0")/library.sh"

# mesh HEIGHT: a block of one quadrilateral, 1 m wide
mesh() {
  cat >block.msh <<END
\$MeshFormat
2.2 0 8
\$EndMeshFormat
\$PhysicalNames
2
1 1 "bottom"
2 2 "block"
\$EndPhysicalNames
\$Nodes
4
1 0 0 0
2 1 0 0
3 1 $1 0
4 0 $1 0
\$EndNodes
\$Elements
2
1 1 2 1 1 1 2
2 3 2 2 1 1 2 3 4
\$EndElements
END
}

# block GRID INITIAL
block() {
  cat <<END
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 1}
initial: {$2}
grid: {$1}
bodies: [{name: s, region: block, points_per_cell: 4, material: m}]
materials: {m: {law: neo-hookean, density: 1800, young: 1e6, poisson: 0.3}}
boundary: [{name: base, on: {boundary: bottom}, fix: [x, y]}]
loads: {gravity: [0, -1]}
measures: {m: {mass: total}}
output: {fields: [stress], every: end}
END
}
block "mesh: block.msh" "" >case.yaml
cat >calibrate.yaml <<'END'
title: density
parameters: {rho: {range: [1000, 3000], unit: kg/m3}}
set: {materials.m.density: $rho}
instruments: {b: {case: case.yaml, measures: [{measure: m, take: end, target: 2000, uncertainty: 20}]}}
END
cat >reference.yaml <<'END'
title: block
studies:
  mass:
    title: its mass
    measure: m
    sweep: {name: density, symbol: rho, unit: kg/m3, set: {materials.m.density: $rho}}
    series: {fem: {set: {method: fem}}}
    tolerance: 1e-6
    source: density times volume
    confidence: verified
    rows: [{at: 1000, reference: 1000}]
END

mesh 1
expect "a sweep" 0 "$talus" sweep case.yaml --over materials.m.young=1e6 --measure m --out s --jobs 1
says s/young=1e6/files.txt "grid.mesh = " "/block.msh"
expect "calibrate" 0 "$talus" calibrate calibrate.yaml --out c --jobs 1
says out.txt "Best point: rho = 2000"
expect "verify" 0 "$talus" verify . --out v
expect "by hand" 0 "$talus" run case.yaml --out one --quiet --set materials.m.density=1000
expect "as it was" 0 "$talus" sweep case.yaml --over materials.m.young=1e6 --measure m --out s --jobs 1
says out.txt "1 done before"
expect "verify, as it was" 0 "$talus" verify . --out v --resume

mesh 2
expect "another mesh" 2 "$talus" sweep case.yaml --over materials.m.young=1e6,2e6 --measure m --out s --jobs 1
says err.txt "/block.msh' has changed since the run in 's/young=1e6' read it" "--force"
expect "by force" 0 "$talus" sweep case.yaml --over materials.m.young=1e6,2e6 --measure m --out s --jobs 1 --force
[ "$(cut -d, -f2 s/sweep.csv | sort -u | tail -n +2 | wc -l)" -eq 1 ] || fail "$name: $(cat s/sweep.csv)"
expect "calibrate on another mesh" 2 "$talus" calibrate calibrate.yaml --out c --jobs 1
says err.txt "has changed since the run in"
expect "verify on another mesh" 3 "$talus" verify . --out v --resume
expect "verify a run of another mesh" 2 "$talus" verify . --run one
says err.txt "/block.msh' has changed since the run in 'one' read it"
for ranks in 1 2 3; do
  expect "go on with another mesh, $ranks ranks" 2 on_ranks $ranks "$talus" run --resume one
  says err.txt "/block.msh' has changed since the run in 'one' read it"
  [ "$(grep -c 'has changed' err.txt)" -eq 1 ] || fail "$name: told twice"
done
expect "a run of it" 0 "$talus" run case.yaml --out two --quiet --set materials.m.density=1000
expect "compare" 0 "$talus" compare one two --out compared
says out.txt "grid.mesh (contents)"
lacks out.txt "do not differ in any key"

# Of an older program, which tells nothing of its files
rm two/files.txt
expect "nothing is known" 0 "$talus" compare one two --out compared
says out.txt "do not differ in any key"
expect "an older run goes on" 0 "$talus" run --resume two
mesh 1

# The run that another one starts from: itself again, and another one
expect "a first run" 0 "$talus" run case.yaml --out first --quiet
block "mesh: block.msh" "run: first" >next.yaml
expect "runs that start from it" 0 "$talus" sweep next.yaml --over loads.gravity=[0,-3] --measure m --out n --jobs 1
expect "again" 0 "$talus" sweep next.yaml --over loads.gravity=[0,-3] --measure m --out n --jobs 1
says out.txt "1 done before"
expect "another first run" 0 "$talus" run case.yaml --out first --quiet --force --set loads.gravity=[0,-2]
expect "runs that started from the other one" 2 "$talus" sweep next.yaml --over loads.gravity=[0,-3] --measure m --out n --jobs 1
says err.txt "/first' has changed since the run in 'n/"

# What a .geo includes
if command -v gmsh >/dev/null; then
  echo 'h = 1;' >height.geo
  cat >block.geo <<'END'
Include "height.geo";
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0};
Line(1) = {1, 2};
out[] = Extrude {0, h, 0} { Line{1}; Layers{1}; Recombine; };
Transfinite Line{1} = 2;
Physical Line("bottom") = {1};
Physical Surface("block") = {out[1]};
END
  block "mesh: block.geo" "" >geo.yaml
  expect "a .geo" 0 "$talus" run geo.yaml --out geo --quiet
  says geo/files.txt "grid.mesh = " "grid.mesh, height.geo = "
  echo 'h = 2;' >height.geo
  expect "another height" 2 "$talus" run --resume geo
  says err.txt "/height.geo' has changed since the run in 'geo' read it"
fi

# A run that has moved with its files goes on where it is told where they are, as it would have
cat >slow.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.02, step: 1e-3}
grid: {box: {min: [0, 0], max: [1, 2]}, size: 0.25}
bodies: [{name: s, mesh: block.msh, region: block, points_per_cell: 4, material: m}]
materials: {m: {law: neo-hookean, density: 1800, young: 1e6, poisson: 0.3}}
boundary: [{name: base, on: {boundary: bottom}, fix: [x, y]}]
loads: {gravity: [0, -10]}
measures: {m: {energy: kinetic}}
checkpoint: {steps: 8}
output: {every: end}
END
mkdir home && mv slow.yaml home && cp block.msh home
expect "whole" 0 "$talus" run home/slow.yaml --out home/whole --quiet
expect "cut off" 0 "$talus" run home/slow.yaml --out home/cut --quiet
turn
mv home away && cp -r away/cut away/again && rm away/again/checkpoint_000000020.h5
expect "not told where" 2 "$talus" run --resume away/again
says err.txt "cannot read" "say where it is (from the folder of the run): --set bodies[0].mesh=PATH"
expect "told where" 0 on_ranks $ranks "$talus" run --resume away/again --quiet --set bodies[0].mesh=../block.msh
says away/again/files.txt "bodies[0].mesh = " "away/again/../block.msh"
grep -q "resumed = step 16" away/again/log.txt || fail "$name: $(grep resumed away/again/log.txt)"
[ "$ranks" != 1 ] || cmp -s away/whole/history.csv away/again/history.csv || fail "$name: another history"
mesh 1.5
cp -r away/cut away/other && rm away/other/checkpoint_000000020.h5
expect "another mesh there" 2 "$talus" run --resume away/other --set bodies[0].mesh=../../block.msh
says err.txt "away/other/../../block.msh' has changed since the run in 'away/other' read it"
expect "another thing" 2 "$talus" run --resume away/other --set bodies[0].points_per_cell=9
says err.txt "a resumed run cannot change bodies[0].points_per_cell" "where files are"
finish
