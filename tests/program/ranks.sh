#!/bin/sh
# The same case on 1 rank and on 2 or 3, which take turns, gives the same histories to 1e-9.
compare="$(cd "$(dirname "$0")" && pwd)/compare.awk"
. "$(dirname "$0")/library.sh"

# same NAME RANKS: case.yaml on 1 and on so many ranks.
same() {
  title=$1 more=$2
  for ranks in 1 $more; do
    expect "$title on $ranks" 0 on_ranks $ranks "$talus" run case.yaml --out run$ranks --force --quiet
    says run$ranks/version.txt "ranks = $ranks"
  done
  awk -f "$compare" run1/history.csv run$more/history.csv >difference.txt || { fail "$title: $more ranks differ"; head -n 5 difference.txt; }
}

cantilever | sed 's/size: 0.5/size: 0.25/; s/steps: 1/steps: 2/' >case.yaml
same "cantilever, mpm" 3
tip=$(tail -n 1 run1/history.csv | cut -d, -f3)

cantilever | sed 's/size: 0.5/size: 0.25/; s/method: mpm/method: fem/; s/steps: 1/steps: 2/' >case.yaml
same "cantilever, fem" 2
# Two steps: mpm forgets its grid between them, fem does not.
awk -v a="$tip" -v b="$(tail -n 1 run1/history.csv | cut -d, -f3)" 'BEGIN { exit !(a < -0.1 && b / a > 0.8 && b / a < 1.25) }' ||
  fail "mpm and fem are far apart"

quick_block | sed 's/step: 2e-3/step: 4e-3/' >case.yaml
same "bouncing block" 3
# Points did cross from rank to rank: the ranks share the block's first place, and it flew half its length further.
awk -F, 'NR > 1 && $3 > 1.9 { flew = 1 } NR > 1 && $10 > 1e4 { hit = 1 } END { exit !(flew && hit) }' run1/history.csv ||
  fail "the block did not fly and bounce"

# The functions of a case that names none reach farther than its cells, over to other ranks; where Newton stops is not told apart from that
quick_block | sed 's/^basis:.*/newton: {residual: 1e-12}/; s/, transfer: thesis//; s/step: 2e-3/step: 4e-3/' >case.yaml
same "bouncing block, default basis" 2
says run2/log.txt "basis = gimp, the default of mpm" "transfer = consistent, the default"

cat >case.yaml <<'END'
kinematics: 3d
method: mpm
analysis: {type: dynamic, step: 5e-3, end: 0.1}
grid: {box: {min: [0, 0, 0], max: [1.6, 0.8, 0.8]}, size: 0.1}
bodies:
  - {name: ball, shape: {sphere: {centre: [0.5, 0.4, 0.3], radius: 0.22}}, points_per_cell: 8, material: rubber,
     velocity: [3, 0, -3], spin: [0, 0, 5], spin_centre: [0.5, 0.4, 0.3]}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 2e5, poisson: 0.3}
boundary:
  - {on: {boundary: front}, fix: [z]}
loads: {gravity: [0, 0, -9.81]}
measures:
  top: {position: z, of: {tracer: [0.5, 0.4, 0.48]}}
  right: {extent: {max: x}, of: {body: ball}}
  turn: {angular_momentum: z}
  kinetic: {energy: kinetic}
  elastic: {energy: elastic}
  floor: {reaction: z, of: {boundary: 0}}
END
same "ball in space" 2
awk -F, 'NR > 1 && $8 > 10 { hit = 1 } END { exit !hit }' run1/history.csv || fail "the ball did not reach the floor"

# A mesh by gmsh, regions and boundaries by their names
plate 2
same "mesh by gmsh" 2
awk -F, 'END { exit !($4 > 9999.999 && $4 < 10000.001 && $5 < -19999.99 && $5 > -20000.01) }' run1/history.csv || fail "the wall does not hold the load"

# With an odd number of edges around it no recombination is without a triangle.
{ cat plate.geo; echo 'Transfinite Curve {1, 3} = 16; Transfinite Curve {2} = 8; Transfinite Curve {4} = 9; Recombine Surface {1};'; } >mixed.geo
sed 's/plate.geo, parameters: {h: 0.15}/mixed.msh/; s/points_per_cell: 3/points_per_cell: 4/' case.yaml >mixed.yaml
gmsh -2 mixed.geo -o mixed.msh -format msh41 >out.txt 2>&1 || fail "mixed.geo: no mesh" # once: it starts slowly
mv mixed.yaml case.yaml
expect "check of a mesh of two kinds of cells" 0 "$talus" check case.yaml
says out.txt "cells (quadrilateral, triangle)"
same "triangles among quadrilaterals" 3
awk -F, 'END { exit !($4 > 9999.999 && $4 < 10000.001 && $5 < -19999.99 && $5 > -20000.01) }' run1/history.csv || fail "the wall does not hold the load"

finish
