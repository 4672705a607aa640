#!/bin/sh
# The account of energies closes: what prescribed motion sets anew, what a stage changes at once, what flows at a rate, and where nothing acts.
. "$(dirname "$0")/library.sh"

# worst DIR: the largest balance of its history, either sign.
worst() {
  awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k ~ "^balance") c = k }
    NR > 1 { b = $c < 0 ? -$c : $c; if (!(b <= most)) most = b } END { print most + 0 }' "$1/history.csv"
}

# closes DIR [MOST]: to what Newton's method leaves, or contact.
closes() { awk -v b="$(worst "$1")" -v most="${2:-1e-8}" 'BEGIN { exit !(b < most) }' || fail "$name: the balance is $(worst "$1")"; }

# Of six runs one is on 2 and one on 3 ranks, which cost most where they outnumber cores.
turns=0
now_and_then() {
  turns=$((turns % 6 + 1))
  case $turns in 3) ranks=2 ;; 6) ranks=3 ;; *) ranks=1 ;; esac
}

# closes_on LABEL METHODS ARGUMENT...: case.yaml with these, now and then on 2 and 3 ranks.
closes_on() {
  label=$1 methods=$2
  shift 2
  for method in $methods; do
    now_and_then
    expect "$label, $method on $ranks" 0 on_ranks $ranks "$talus" run case.yaml --out run --quiet --set "method=$method" "$@"
    closes run
    rm -r run
  done
}

cat >case.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 0.02, steps: 20, damping: 100}
grid: {box: {min: [0, 0], max: [0.4, 0.4]}, size: 0.1}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [0.4, 0.4]}}, material: m, velocity: [0, -0.5]}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{name: f, on: {boundary: bottom}, fix: [x, y]}]
measures: {balance: {energy: balance}, transfer: {energy: transfer}}
output: {history: {steps: 1}}
END
closes_on "damped, and stopped at the start" "fem gmm mpm"
closes_on "the same by Bossak's alpha" fem --set analysis.bossak=-0.2
for damping in 0 100; do # the free nodes beside them go along
  closes_on "held nodes set off, damping $damping" "fem gmm" --set analysis.damping=$damping \
    --set 'boundary=[{name: f, on: {boundary: bottom}, velocity: {x: 1, y: 0}, amplitude: [[0, 0], [0.005, 0], [0.0051, 1], [1, 1]]}]'
done

soil='materials.m={law: j2, yield_stress: 500, density: 1000, young: 1e6, poisson: 0.3}'
closes_on "a stage that lowers strength" "fem gmm" --set "$soil" --set 'stages=[{name: one}, {name: two, strength: {factor: 1.5}}]'
closes_on "a stage that lets go" fem --set "$soil" \
  --set 'stages=[{name: one}, {name: two, boundary: [{name: f, on: {boundary: bottom}, fix: [y]}]}]'
closes_on "a stage that brings gravity along another axis" fem --set "$soil" \
  --set 'stages=[{name: one}, {name: two, loads: {gravity: [5, -10]}}]'

# what a law that flows at a rate would do in a step of no motion is none of the step's start
grains='materials.m={law: mu-i, density: 1000, young: 1e6, poisson: 0.2, static_friction: 0.4, limit_friction: 0.7, grain_size: 0.001, grain_density: 2500}'
closes_on "grains under a wall" "fem gmm" --set "$grains" --set 'loads={gravity: [3, -16]}' --set analysis.damping=0 \
  --set 'walls=[{name: lid, shape: {half-space: {point: [0, 0.4], normal: [0, -1]}}, contact: stick}]'

# a heavy disk that bounces: to lie on what sticks takes energy from the disk, and gives none back
cat >disk.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 0.76, steps: 19}
grid: {box: {min: [0, 0], max: [0.4, 0.8]}, size: 0.2}
bodies: [{name: block, shape: {box: {min: [0, 0], max: [0.4, 0.8]}}, material: m}]
materials: {m: {law: neo-hookean-split, density: 1000, young: 1e5, poisson: 0}}
loads: {gravity: [0, -0.25]}
boundary: [{name: floor, on: {boundary: bottom}, fix: [y]}]
walls: [{name: heavy, shape: {circle: {centre: [0.2, 0.96], radius: 0.16}}, mass: {density: 2000}, contact: stick}]
measures: {friction: {energy: friction}, balance: {energy: balance}}
output: {history: {steps: 1}}
END
for ranks in 1 3; do
  expect "a disk that sticks, on $ranks" 0 on_ranks $ranks "$talus" run disk.yaml --out disk$ranks --quiet
  closes disk$ranks 1e-6
  awk -F, 'NR > 1 { if ($3 < last - 5e-4) exit 1; last = $3 }' disk$ranks/history.csv || fail "$name: friction gives energy: $(cut -d, -f3 disk$ranks/history.csv | tr '\n' ' ')"
done

# what a constraint holds a node with is a reaction, and nothing that steps leave open: the account is told, and its loss
cat >held.yaml <<'END'
kinematics: plane-strain
method: gmm
basis: {mls: {}}
analysis: {type: dynamic, end: 0.1, step: 2e-3}
grid: {box: {min: [0, 0], max: [1, 2]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 2]}}, material: m, velocity: [0, -3]}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{name: side, on: {x: 0}, fix: [x]}, {name: foot, on: {y: 0}, fix: [y]}]
measures: {balance: {energy: balance}, transfer: {energy: transfer}}
output: {history: {steps: 1}}
END
for basis in mls lme; do
  turn
  expect "held by constraints, $basis on $ranks" 0 on_ranks $ranks "$talus" run held.yaml --out held --set "basis={$basis: {essential: constraints}}"
  closes held
  says out.txt "J that came in (start, loads, gravity, prescribed motion)"
  says err.txt "the transfer to what stops or holds it took"
  rm -r held
done

# clouds that change below a foot that spreads put accelerations out of balance: without damping that rings, makes more
# energy than came, and ends the run (at 0.18 s); mls, whose material passes its foot, is told what to do instead
plastic='materials.m={law: j2, density: 1000, young: 1e6, poisson: 0.3, yield_stress: 1000}'
expect "a plastic impact" 0 "$talus" run held.yaml --out plastic --set "$plastic" --set 'basis={lme: {}}' \
  --set 'grid={box: {min: [0, 0], max: [1, 2]}, counts: [6, 12]}' --set 'analysis={type: dynamic, end: 0.19, step: 5e-4}'
closes plastic
awk -F, 'NR > 1 && !($4 >= 0 && $4 < 0.08 * 9000) { exit 1 }' plastic/history.csv || fail "$name: the transfer is $(cut -d, -f4 plastic/history.csv | sort -g | sed -n '1p;$p')"
lacks err.txt "the transfer to what stops or holds it gave"
# it ends badly, in one way or another
expect "a plastic impact, mls" 0 sh -c '"$@" || :' sh "$talus" run held.yaml --out passes --set "$plastic" --set 'analysis={type: dynamic, end: 0.3, step: 5e-4}'
says err.txt "the energy that came in (" "and shorter steps more: \`basis: {lme: {}}\`, or methods mpm and fem"

# nothing acts: round-off over round-off
expect "nothing acts" 0 "$talus" run case.yaml --out none --quiet --set 'analysis={type: static, steps: 4}' --set formulation=mixed \
  --set 'bodies=[{name: b, shape: {box: {min: [0, 0], max: [0.3, 0.4]}}, material: m}]' \
  --set 'walls=[{name: heavy, shape: {box: {min: [-0.1, 0.4], max: [0.5, 0.5]}}, mass: {density: 500, free: [y]}, friction_angle: 20}]' \
  --set 'boundary=[{name: f, on: {boundary: bottom}, fix: [y]}, {name: l, on: {boundary: left}, fix: [x]}]'
[ "$(worst none)" = 0 ] || fail "$name: the balance is $(worst none)"
expect "next to nothing acts" 0 "$talus" run case.yaml --out little --quiet --set 'loads={gravity: [0, -1e-3]}' --set 'analysis={type: static, steps: 4}' \
  --set 'bodies=[{name: b, shape: {box: {min: [0, 0], max: [0.3, 0.4]}}, material: m}]'
closes little

# What flies in space and is two cells wide keeps its energy and its shape: whoever follows a node leaves it mass of its own.
for body in '[0.25, 0, 0.25]:[0.75, 0.25, 0.75]' '[0, 0, 0]:[0.5, 0.5, 0.5]' '[0, 0.25, 0.01]:[0.5, 0.436, 1.01]'; do
  cat >small.yaml <<END
kinematics: 3d
method: mpm
analysis: {type: dynamic, end: 0.05, step: 0.01}
grid: {box: {min: [-0.5, -0.5, 0], max: [2, 2, 2]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: ${body%:*}, max: ${body#*:}}}, material: m, velocity: [0, -1, 0]}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e5, poisson: 0.3}}
measures: {k: {energy: kinetic}, e: {energy: elastic}}
output: {history: {steps: 1}}
END
  turn
  expect "two cells in flight, $body on $ranks" 0 on_ranks $ranks "$talus" run small.yaml --out small --force --quiet
  awk -F, 'NR == 2 { k = $3 } NR > 1 && (($3 / k - 1) ^ 2 > 1e-18 || $4 ^ 2 > 1e-18) { exit 1 } END { exit NR != 7 }' small/history.csv || fail "$name: $(tail -n 1 small/history.csv)"
done

# What nodes of a cloud are moved with gains its speed by impulses of the boundary alone: a block that is shaken at one end, told by its places at
# the ends of all steps, keeps its energy but for 0.02 that
# the jumps of speed from step to step take, in fem as well (0.27 of it went where the others were given a share of each jump).
cat >shaken.yaml <<END
kinematics: plane-strain
method: gmm
analysis: {type: dynamic, step: 1e-3, end: 0.06}
grid: {box: {min: [0, 0], max: [2, 1]}, counts: [8, 4]}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [2, 1]}}, material: m}]
materials: {m: {law: neo-hookean, young: 1e6, poisson: 0.3, density: 1000}}
boundary: [{on: {boundary: left}, displacement: {x: 0, y: 0.1}, amplitude: $(awk 'BEGIN { for (k = 0; k < 60; ++k) printf "%s[%g, %.8f]", k ? ", " : "[", k / 1000, sin(k / 60 * 3.14159265) ^ 2; print ", [0.06, 0]]" }')}]
measures: {came: {energy: external}, transfer: {energy: transfer}}
END
for way in '1 {mls: {}}' '1 {mls: {essential: direct}}' '2 {lme: {essential: constraints}}'; do
  ranks=${way%% *} basis=${way#* }
  expect "shaken, $basis on $ranks" 0 on_ranks $ranks "$talus" run shaken.yaml --out shaken --force --quiet --set "basis=$basis"
  awk -F, 'END { exit !($3 > 100 && $4 * $4 < (0.025 * $3) ^ 2) }' shaken/history.csv || fail "$name: $(tail -n 1 shaken/history.csv)"
done

# A drum that turns about its own centre works by its torque alone: a smooth one under a shoe not at all, and one that
# rubs by its torque times its angle; nothing of that is lost. The same of statics and of substeps.
cat >drum.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 20}
grid: {box: {min: [-0.5, 0.8], max: [0.5, 1.6]}, size: 0.1}
bodies: [{name: shoe, shape: {box: {min: [-0.4, 1], max: [0.4, 1.4]}}, points_per_cell: 4, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0}}
boundary: [{name: hold, on: {y: [1.31, 2]}, displacement: {x: 0, y: -0.02}, amplitude: [[0, 0], [0.2, 1], [1, 1]]}]
walls: [{name: drum, shape: {circle: {centre: [0, 0], radius: 1}}, motion: [{rotation: {centre: [0, 0], rate: 3}, amplitude: [[0, 0], [0.2, 0], [0.25, 1], [1, 1]]}]}]
measures: {torque: {wall_torque: z, of: {wall: drum}}, came: {energy: external}, friction: {energy: friction}, transfer: {energy: transfer}, balance: {energy: balance}}
output: {every: end}
END
for way in "fem 1" "mpm 1" "gmm 2"; do
  method=${way% *} ranks=${way#* }
  expect "a smooth drum, $method on $ranks" 0 on_ranks $ranks "$talus" run drum.yaml --out smooth --force --quiet --set method=$method
  lacks err.txt "the transfer to what stops"
  awk -F, 'NR > 1 && $1 < 0.201 { pressed = $4 } END { exit !(($4 / pressed - 1) ^ 2 < 1e-6 && $6 ^ 2 < (0.02 * pressed) ^ 2) }' smooth/history.csv || fail "$name: $(tail -n 1 smooth/history.csv)"
  expect "a drum that rubs, $method on $ranks" 0 on_ranks $ranks "$talus" run drum.yaml --out rubs --force --quiet --set method=$method --set walls[0].friction=0.3
  awk -F, 'NR > 1 && $1 > 0.5 { if (t) { came += $4 - c; rubbed += $5 - r; angle += 3 * ($1 - t) } t = $1; c = $4; r = $5 }
    END { exit !(angle > 1 && (came / angle / $3 - 1) ^ 2 < 1e-5 && (rubbed / came - 1) ^ 2 < 1e-6 && $6 ^ 2 < (1e-3 * $4) ^ 2 && $7 ^ 2 < 1e-16) }' rubs/history.csv || fail "$name: $(tail -n 1 rubs/history.csv)"
done
cat >round.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: explicit, end: 0.3, step: 0.005}
grid: {box: {min: [-1.27, -1.23], max: [1.33, 1.27]}, size: 0.1}
bodies: [{name: b, shape: {box: {min: [-0.15, -0.988686], max: [0.15, -0.788686]}}, material: m, spin: 3}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
walls: [{name: w, shape: {circle: {centre: [0, 0], radius: 1}}, inside: true, motion: [{rotation: {centre: [0, 0], rate: 5}}]}]
measures: {came: {energy: external}, transfer: {energy: transfer}}
output: {every: end}
END
ranks=3
expect "a smooth drum, explicit on $ranks" 0 on_ranks $ranks "$talus" run round.yaml --out turns --force --quiet
expect "and one that stands" 0 "$talus" run round.yaml --out stands --force --quiet --set 'walls[0].motion=[]'
awk -F, -v stands="$(tail -n 1 stands/history.csv | cut -d, -f4)" 'END { exit !($3 ^ 2 < 0.02 ^ 2 && ($4 - stands) ^ 2 < 0.02 ^ 2) }' turns/history.csv || fail "$name: $(tail -n 1 turns/history.csv)"

finish
