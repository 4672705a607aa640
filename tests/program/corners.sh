#!/bin/sh
# Corners of one wall hold a body that fills them by both sides: a block in a room without friction is pressed by its own
# weight as a column is, whatever the room is made of, and with friction the room does what walls of their own do. Corners
# of a body that slide along another one make no energy.
. "$(dirname "$0")/library.sh"

cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 2}
grid: {box: {min: [-1.5, -1.5], max: [1.5, 1.5]}, size: 0.125}
bodies: [{name: block, shape: {box: {min: [-1, -1], max: [1, 0.5]}}, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 10, young: 1e6, poisson: 0.3}}
walls: [{name: room, shape: {box: {min: [-1, -1], max: [1, 2]}}, inside: true}]
loads: {gravity: [0, -10]}
measures:
  across: {stress: xx, of: {tracer: [-0.9, -0.9]}}
  along: {stress: yy, of: {tracer: [0.9, -0.9]}}
  top: {displacement: y, of: {tracer: [0.99, 0.49]}}
output: {fields: [displacement], every: end}
END
half='{half-space: {point: [0, -1], normal: [0, 1]}}, {half-space: {point: [-1, 0], normal: [1, 0]}}, {half-space: {point: [1, 0], normal: [-1, 0]}}'
line='walls=[{name: room, shape: {line: [[-1, 1.2], [-1, -1], [1, -1], [1, 1.2]]}}]'
frame='walls=[{name: room, shape: {polygon: [[-1.4, 1.2], [-1.4, -1.4], [1.4, -1.4], [1.4, 1.2], [1, 1.2], [1, -1], [-1, -1], [-1, 1.2]]}}]'
union="walls=[{name: room, shape: {union: [$half]}}]"
off='grid={box: {min: [-1.53, -1.45], max: [1.47, 1.55]}, size: 0.125}'

# At small strains rho g (H - y), of which nu / (1 - nu) is across, and rho g H^2 / (2 M) at the top.
pressed() {
  name=$1
  awk -F, 'END { exit !(($3 / -60 - 1) ^ 2 < 0.005 ^ 2 && ($4 / -140 - 1) ^ 2 < 0.005 ^ 2 && ($5 / -8.357e-5 - 1) ^ 2 < 0.002 ^ 2) }' \
    run/history.csv || fail "$name: $(tail -n 1 run/history.csv)"
}
expect "a box" 0 on_ranks 3 "$talus" run case.yaml --out run --force --quiet
pressed "a box"
lacks err.txt warning
for room in "$line" "$frame" "$union" "$off"; do
  expect "$room" 0 "$talus" run case.yaml --out run --force --quiet --set "$room"
  pressed "$room"
done
expect "fem" 0 "$talus" run case.yaml --out run --force --quiet --set method=fem --set grid.size=0.0625
pressed "fem"

# One wall against three: moved, with friction and inertia, cut off and gone on with.
# Columns agree to a share of their largest number.
same() {
  name=$1 digits=$2
  paste -d, run/history.csv "$3/history.csv" | awk -F, -v e="$digits" '
    function size(x) { return x < 0 ? -x : x }
    NR > 1 { n++; for (k = 3; k <= 5; ++k) { if (size($(k + 5)) > most[k]) most[k] = size($(k + 5)); if (size($k - $(k + 5)) > off[k]) off[k] = size($k - $(k + 5)) } }
    END { for (k = 3; k <= 5; ++k) if (off[k] > e * most[k]) { print k, off[k], most[k]; bad = 1 } exit bad || n < 5 }' ||
    fail "$name: $(tail -n 1 run/history.csv) and $(tail -n 1 "$3/history.csv")"
}
moved='contact: friction, friction: 0.3, motion: [{displacement: {x: 0.05, y: 0.1}, amplitude: [[0, 0], [0.1, 1]]}]'
room="walls=[{name: room, shape: {box: {min: [-1, -1], max: [1, 2]}}, inside: true, $moved}]"
own="walls=[{name: floor, shape: {half-space: {point: [0, -1], normal: [0, 1]}}, $moved}, {name: left, shape: {half-space: {point: [-1, 0], normal: [1, 0]}}, $moved}, {name: right, shape: {half-space: {point: [1, 0], normal: [-1, 0]}}, $moved}]"
for analysis in 'dynamic, scheme: newmark, step: 5e-3, end: 0.1' 'explicit, step: 5e-3, end: 0.1'; do
  set -- --set "analysis={type: $analysis}" --set materials.rubber.density=1000 --set grid.size=0.25
  expect "walls of their own, $analysis" 0 "$talus" run case.yaml --out own --force --quiet "$@" --set "$own"
  expect "one wall, $analysis" 0 "$talus" run case.yaml --out run --force --quiet "$@" --set "$room"
  same "one wall, $analysis" 1e-3 own
  expect "half of it, $analysis" 0 "$talus" run case.yaml --out half --force --quiet "$@" --set "$room" --set analysis.end=0.05 --set checkpoint.steps=10
  expect "the rest, $analysis" 0 "$talus" run --resume half --quiet --set analysis.end=0.1
  cmp -s half/history.csv run/history.csv || fail "$name: $(tail -n 1 half/history.csv), not $(tail -n 1 run/history.csv)"
done

# Half-spaces in the first stage, of which the state knows one side each; then the room in their place, and they again.
cat >>case.yaml <<'END'
stages:
  - name: own
  - name: room
    walls:
      - {name: floor, absent: true}
      - {name: left, absent: true}
      - {name: right, absent: true}
      - {name: room, shape: {box: {min: [-1, -1], max: [1, 2]}}, inside: true}
  - name: again
    walls:
      - {name: room, absent: true}
      - {name: floor, shape: {half-space: {point: [0, -1], normal: [0, 1]}}}
      - {name: left, shape: {half-space: {point: [-1, 0], normal: [1, 0]}}}
      - {name: right, shape: {half-space: {point: [1, 0], normal: [-1, 0]}}}
END
own='walls=[{name: floor, shape: {half-space: {point: [0, -1], normal: [0, 1]}}}, {name: left, shape: {half-space: {point: [-1, 0], normal: [1, 0]}}}, {name: right, shape: {half-space: {point: [1, 0], normal: [-1, 0]}}}]'
expect "stages" 0 on_ranks 2 "$talus" run case.yaml --out run --force --quiet --set "$own"
awk -F, 'NR > 2 && $2 % 2 == 0 { n += 1; if (($4 / -60 - 1) ^ 2 > 0.005 ^ 2 || ($5 / -140 - 1) ^ 2 > 0.005 ^ 2) bad = 1 }
  END { exit bad || n < 3 }' run/history.csv || { fail "$name"; cat run/history.csv; }

# The rim of a hole below a flat face bears nothing along the wall: before and while the block slides over it.
cat >hole.yaml <<'END'
kinematics: 3d
method: fem
analysis: {type: dynamic, end: 0.02, steps: 2}
grid: {box: {min: [0.6, 0.6, 0.3], max: [1.4, 1.4, 0.7]}, counts: [6, 6, 3]}
bodies: [{name: b, shape: {box: {min: [0.6, 0.6, 0.3], max: [1.4, 1.4, 0.7]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e9, poisson: 0.3}}
loads: {gravity: [2, 0, -10]}
walls: [{name: w, shape: {disk: {centre: [1, 1, 0.3], normal: [0, 0, 1], radius: 3, hole: 0.2}}}]
measures:
  along: {wall_force: x, of: {wall: w}}
  up: {wall_force: z, of: {wall: w}}
  area: {contact: area, of: {wall: w}}
  pressure: {contact: pressure, of: {wall: w}}
END
revolved='walls[0].shape={revolved: {base: [1, 1, 0.3], axis: [0, 0, 1], line: [[0.2, 0], [3, 0]]}}'
off='grid={box: {min: [0.3, 0.3, 0.2], max: [1.84, 1.84, 0.9]}, size: 0.14}'
for method in fem mpm; do
  [ $method = fem ] && ranks=2 || ranks=1
  [ $method = fem ] && set -- || set -- --set "$revolved" --set "$off"
  expect "a hole below, $method on $ranks" 0 on_ranks $ranks "$talus" run hole.yaml --out hole --force --quiet --set method=$method "$@"
  # 0.64 - pi 0.2^2 m2, seen by points a fifteenth of that wide
  awk -F, 'NR > 2 && ($3 ^ 2 > 1e-6 || ($4 / 2560 - 1) ^ 2 > 0.02 ^ 2 || ($5 / 0.5143 - 1) ^ 2 > 0.04 ^ 2 || ($5 * $6 / $4 - 1) ^ 2 > 1e-6) { bad = 1 }
    END { exit bad || NR != 4 }' hole/history.csv || fail "$name: $(cat hole/history.csv)"
done

# A load that varies along a side which the grid cuts anywhere: quadratic ones are exact, what bends within a piece nearly.
cat >varies.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [-1, -0.5], max: [2.5, 1.5]}, size: 0.25}
bodies: [{name: s, shape: {box: {min: [0, 0.07], max: [1, 1.07]}}, material: m}]
materials: {m: {law: neo-hookean, density: 2000, young: 1e9, poisson: 0.3}}
walls: [{name: w, shape: {half-space: {point: [0, 0.07], normal: [0, 1]}}, contact: stick}]
loads: {gravity: [0, -10], tractions: [{on: {x: 0, body: s}, value: [3e4, 0], factor: (y - 0.07)^2}]}
measures: {P: {wall_force: x, of: {wall: w}}}
END
for load in '(y - 0.07)^2:-10000:1e-6' 'max(0, 1 - (y - 0.07) / 0.25):-3750:40'; do
  rest=${load#*:}
  case $load in max*) ranks=2 ;; *) ranks=1 ;; esac
  expect "a load that varies, ${load%%:*} on $ranks" 0 on_ranks $ranks "$talus" run varies.yaml --out varies --force --quiet --set "loads.tractions[0].factor=${load%%:*}"
  tail -n 1 varies/history.csv | awk -F, -v is="${rest%:*}" -v off="${rest#*:}" '{ exit !($3 - is < off && is - $3 < off) }' || fail "$name: $(tail -n 1 varies/history.csv)"
done

# The corner of a soft block slides up the side of a stiff one that turns: whichever is named first, what is left of the
# 515 J that came in is no more than friction leaves.
cat >slides.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 0.4, step: 1e-3}
grid: {box: {min: [1, 1.5], max: [3.25, 3]}, size: 0.125}
bodies:
  - {name: soft, shape: {box: {min: [1, 1.5], max: [2, 2.5]}}, material: soft, velocity: [1, 0]}
  - {name: stiff, shape: {box: {min: [2.25, 2], max: [3.25, 3]}}, material: stiff, spin: 0.3, spin_centre: [2.75, 2.5]}
materials:
  soft: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}
  stiff: {law: neo-hookean, density: 2000, young: 1e9, poisson: 0.2}
interfaces: [{name: joint, between: [stiff, soft], friction: 0.3}]
measures: {mechanical: {energy: mechanical}, friction: {energy: friction}}
output: {fields: [displacement], every: end}
END
wide='grid={box: {min: [0.5, 1], max: [4, 3.5]}, size: 0.125}'
# left_of NAME LEAST RANKS OPTIONS...
left_of() {
  name=$1 least=$2 ranks=$3
  shift 3
  expect "$name" 0 on_ranks $ranks "$talus" run slides.yaml --out slides --force --quiet "$@"
  awk -F, -v least=$least 'NR > 1 && $3 + $4 > 515.5 { bad = 1 } END { exit bad || $3 < least }' slides/history.csv ||
    fail "$name: $(tail -n 1 slides/history.csv)"
}
left_of "a corner along a side" 440 2
left_of "a corner along a side, half the step" 440 1 --set analysis.step=5e-4
left_of "a corner along a side, mpm" 436 1 --set method=mpm --set "$wide" \
  --set analysis.transfer=consistent --set analysis.step=5e-4
left_of "a corner along a side, its body first" 480 1 --set 'interfaces[0].between=[soft, stiff]'

# An elastic cube that fits into a box which holds it by strong friction goes where that goes.
cat >fits.yaml <<'END'
kinematics: 3d
method: fem
analysis: {type: dynamic, end: 1, step: 1e-2}
grid: {box: {min: [0, 0, 0], max: [0.4, 0.4, 0.4]}, size: 0.2, cell: hexahedron}
bodies: [{name: cube, shape: {box: {min: [0, 0, 0], max: [0.4, 0.4, 0.4]}}, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 1500, young: 1e6, poisson: 0.3}}
walls:
  - name: case
    shape: {box: {min: [0, 0, 0], max: [0.4, 0.4, 0.4]}}
    inside: true
    contact: stick
    motion: [{velocity: {x: 0.4}, amplitude: [[0, 0], [0.5, 1], [1, 0]]}]
measures: {x: {position: x, of: {tracer: [0.3, 0.2, 0.1]}}}
output: {fields: [displacement], every: end}
END
# carried NAME RANKS OPTIONS...
carried() {
  name=$1 ranks=$2
  shift 2
  expect "$name" 0 on_ranks $ranks "$talus" run fits.yaml --out fits --force --quiet "$@"
  awk -F, 'END { exit !($1 > 1 - 1e-9 && ($3 - 0.5) ^ 2 < 5e-5 ^ 2) }' fits/history.csv || fail "$name: $(tail -n 1 fits/history.csv)"
}
carried "a cube in a box that sticks" 2
carried "a cube in a box, friction 5" 1 --set "walls[0].contact=friction" --set "walls[0].friction=5"

finish
