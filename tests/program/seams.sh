#!/bin/sh
# Bodies that touch without an interface stick, and where they touch is inside: a wall that presses on the seam finds the
# surface of one body, whatever parts that has.
. "$(dirname "$0")/library.sh"

# same NAME SHARE: the last rows of run and run2, but for so much of the largest of them.
same() {
  tail -qn 1 run/history.csv run2/history.csv | awk -F, -v s="$2" '
    { for (i = 3; i <= NF; ++i) { if (NR == 1) a[i] = $i; else if (($i - a[i]) ^ 2 > d) d = ($i - a[i]) ^ 2; if ($i ^ 2 > m) m = $i ^ 2 } }
    END { exit !(m > 0 && d <= s * s * m) }' || fail "$1: $(tail -qn 1 run/history.csv run2/history.csv)"
}
# seam NAME SHARE RANKS: case.yaml with one body, and with two that touch at SEAM.
seam() {
  sed 's/^bodies:.*/bodies: [{name: a, shape: {box: {min: [LOW], max: [HIGH]}}, material: mPOINTS}]/' case.yaml >one.yaml
  sed 's/^bodies:.*/bodies: [{name: a, shape: {box: {min: [LOW], max: [SEAMHIGH]}}, material: mPOINTS}, {name: b, shape: {box: {min: [SEAMLOW], max: [HIGH]}}, material: mPOINTS}]/' case.yaml >two.yaml
  sed -i "s/SEAMHIGH/$seam, $high/; s/SEAMLOW/$seam, $low/; s/LOW/0.25, $low/; s/HIGH/1.5, $high/; s/POINTS/$points/g" one.yaml two.yaml
  expect "$1: one" 0 "$talus" run one.yaml --out run --force --quiet
  for ranks in $3; do
    expect "$1: two on $ranks" 0 on_ranks "$ranks" "$talus" run two.yaml --out run2 --force --quiet
    same "$name" "$2"
  done
}

cat >static.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 3}
grid: {box: {min: [0.25, 0], max: [1.5, 0.5]}, size: 0.125}
bodies:
materials: {m: {law: neo-hookean, density: 1000, young: 2e5, poisson: 0.3}}
boundary: [{on: {y: 0}, fix: [x, y]}]
walls: [{name: ball, shape: {circle: {centre: [0.9, 0.71], radius: 0.2}}, motion: [{displacement: {x: 0.02, y: -0.08}}]}]
loads: {gravity: [0, -10]}
measures: {fx: {wall_force: x, of: {wall: ball}}, fy: {wall_force: y, of: {wall: ball}}}
END
low=0 high=0.5 seam=0.875 points=
cp static.yaml case.yaml
seam "a seam, fem" 1e-9 1
sed 's/method: fem/method: gmm/' static.yaml >case.yaml
seam "a seam, gmm" 1e-9 2
# mpm in a larger grid, whose lines pass the bodies' sides and top by: along a line, and amidst a cell
sed 's/method: fem/method: mpm/; s/min: \[0.25, 0\], max: \[1.5, 0.5\]/min: [0, 0], max: [2, 1]/' static.yaml >case.yaml
seam "a seam, mpm" 1e-9 "1 3"
sed 's/method: fem/method: mpm/; s/min: \[0.25, 0\], max: \[1.5, 0.5\]/min: [-0.03, 0], max: [1.97, 1.125]/; s/centre: \[0.9, 0.71\]/centre: [0.92, 0.75]/' static.yaml >case.yaml
high=0.54 seam=0.845
seam "a seam on a line" 1e-9 2
seam=0.9075
seam "a seam amidst a cell" 1e-9 1
points=", points_per_cell: 16"
seam=0.883 # points stand elsewhere now
seam "a seam amidst a part" 2e-3 1

cat >case.yaml <<'END'
kinematics: 3d
method: mpm
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0, 0], max: [2, 0.5, 1]}, size: 0.125}
bodies:
materials: {m: {law: neo-hookean, density: 1000, young: 2e5, poisson: 0.3}}
boundary: [{on: {z: 0}, fix: [x, y, z]}]
walls: [{name: ball, shape: {sphere: {centre: [0.9, 0.21, 0.71], radius: 0.2}}, motion: [{displacement: {x: 0.02, z: -0.06}}]}]
loads: {gravity: [0, 0, -10]}
measures: {fx: {wall_force: x, of: {wall: ball}}, fz: {wall_force: z, of: {wall: ball}}}
END
low="0, 0" high="0.5, 0.5" seam=0.875 points=
seam "a seam in space" 1e-9 2

finish
