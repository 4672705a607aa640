#!/bin/sh
# Elastic constants that change (docs/theory.md, section 24): of every law, in a state that has flowed and hardened, stress
# stays, by a stage, by an amplitude and from one run to the next; so does the strength of soil that has dilated.
. "$(dirname "$0")/library.sh"

# block METHOD FORMULATION LAW CONSTANTS: squeezed between smooth plates in six steps, then held.
block() {
  cat <<END2
kinematics: plane-strain
method: $1
formulation: $2
analysis: {type: static, end: 8, steps: 8}
grid: {box: {min: [0, 0], max: [1.5, 1]}, size: 0.5}
bodies: [{name: a, shape: {box: {min: [0, 0], max: [1, 1]}}, material: A, stress: {xx: -1e5, yy: -1e5, zz: -1e5}}]
materials:
  A: {law: $3, density: 1000, $4}
boundary:
  - {name: left, on: {x: 0}, fix: [x]}
  - {name: floor, on: {y: 0}, fix: [y]}
  - {name: top, on: {y: 1}, displacement: {y: -0.03}, amplitude: [[0, 0], [6, 1], [99, 1]]}
loads: {pressures: [{on: {body: a, x: 1}, value: 1e5, amplitude: [[0, 1], [99, 1]]}]}
measures:
  R: {reaction: y, of: {boundary: top}}
  xx: {stress: xx}
  yy: {stress: yy}
  zz: {stress: zz}
  rate: {stress: q, rate: {window: 2}}
output: {fields: [stress]}
END2
}

# constants LAW: its strength, and two elastic constants: the name of each, its value, and a hundredth more
constants() {
  young="young 5e7 5.05e7 poisson 0.25 0.2525"
  case $1 in
    neo*) echo "$young" ;;
    j2*) echo "$young, yield_stress: 1e5, hardening: 1e6" ;;
    mohr-coulomb) echo "$young, friction_angle: 20, dilatancy_angle: 10, cohesion: 2e4" ;;
    mohr-coulomb-softening) echo "$young, friction_angle: 35, dilatancy_angle: 10, cohesion: 2e4, residual_friction_angle: 25, residual_cohesion: 1e4, residual_strain: 0.6, initial_friction_angle: 20, initial_cohesion: 5e3, peak_strain: 0.2" ;;
    drucker-prager) echo "$young, friction_angle: 30, dilatancy_angle: 10, cohesion: 2e4" ;;
    modified-cam-clay) echo "shear_modulus 5e6 5.05e6 kappa 0.02 0.0202, critical_stress_ratio: 1.2, lambda: 0.1, specific_volume: 2, ocr: 2" ;;
    mu-i) echo "$young, static_friction: 0.5, limit_friction: 0.7, grain_size: 1e-3, grain_density: 2600" ;;
  esac
}

# like HISTORY OTHER ALLOWED: R and the stresses are the other's, over the largest of each
like() {
  awk -F, -v allowed="$3" 'FNR == 1 { for (i = 1; i <= NF; ++i) if ($i ~ /^R /) first = i }
    FNR > 1 { for (i = 0; i < 4; ++i) { x = $(first + i); if (NR == FNR) { was[FNR, i] = x; k = i > 0; if (x * x > big[k]) big[k] = x * x }
      else if (!((x - was[FNR, i]) ^ 2 <= allowed ^ 2 * big[i > 0])) { bad = 1; print "step " $2 ", column " first + i ": " x " for " was[FNR, i] } } }
    END { exit bad || FNR < 9 }' "$2" "$1" >out.txt || fail "$name: $(head -n 1 out.txt)"
}

# held HISTORY STEP ALLOWED: from that step on R and the stresses are what they were, over the largest of each
held() {
  awk -F, -v step="$2" -v allowed="$3" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i ~ /^R /) first = i }
    NR > 1 && $2 == step { for (i = 0; i < 4; ++i) { was[i] = $(first + i); big = was[i] < 0 ? -was[i] : was[i]; if (i && big > most) most = big } next }
    NR > 1 && $2 > step { ++n; for (i = 0; i < 4; ++i) { off = $(first + i) - was[i]; size = i ? most : was[0]
      if (!(off * off <= (allowed * size) ^ 2)) { bad = 1; print "step " $2 ", column " first + i ": " $(first + i) " after " was[i] } } }
    END { exit bad || !n }' "$1" >out.txt || fail "$name: $(head -n 1 out.txt)"
}

# fem: all that is held stays. Points of mpm meet other functions in each step, and what ties its nodes counts in the stiffness:
# what a run without any change has, to 1e-7 (mixed: 5e-5). With p = K (J - 1), or where pressure goes with shape, nodes of the
# mixed formulation have other pressures under the same stress, which the first step of a stage finds: those stages are left out.
for law in $("$talus" list laws | sed -n 's/^\([a-z0-9-]*\)$/\1/p' | grep -v ':'); do
  both=$(constants "$law")
  [ -n "$both" ] || { name=$law fail "$law: no constants here"; continue; }
  set -- ${both%%,*}
  strength=${both#"${both%%,*}"}
  plain="$1: $2, $4: $5$strength"
  for method in fem mpm; do
    for formulation in displacement mixed; do
      [ "$formulation$law" != mixedmodified-cam-clay ] || continue
      allowed=1e-10
      [ $method = fem ] || allowed=1e-7
      if [ $method$formulation = mpmmixed ]; then
        allowed=5e-5
        case $law in j2 | mohr-coulomb | neo-hookean) ;; *) continue ;; esac # the pairs of p and shape that there are
      fi
      # First by amplitudes, once a step has stood still, then in stages, which leave amplitudes at 1.
      staged=stages
      [ "$formulation" = displacement ] || case $method$law in fem*log | femmohr* | femdrucker*) ;; *) staged= ;; esac
      case $method$formulation$law in mpm* | femmixeddrucker*) alone= ;; *) alone=yes ;; esac # pressures of that one still settle
      for change in "$1 $2 $3 $4 $5 $6" "$1 $2 $2 $4 $5 $5"; do
        set -- $change
        amplitude=", amplitude: {$1: [[7, 1], [9, 1.01], [10, 1]], $4: [[8, 1], [10, 1.01], [11, 1]]}" out=aged
        [ "$2" != "$3" ] || amplitude= out=still
        block $method $formulation "$law" "$plain$amplitude" | sed 's/end: 8, steps: 8/end: 12, steps: 12/' >$out.yaml
        [ -z "$staged" ] || cat >>$out.yaml <<END2
stages:
  - name: squeezed
  - {name: other, analysis: {end: 2, steps: 2}, materials: {A: {$1: $3}}}
  - {name: more, analysis: {end: 2, steps: 2}, materials: {A: {$1: $2, $4: $6}}}
  - {name: back, analysis: {end: 2, steps: 2}, materials: {A: {$4: $5}}}
END2
        expect "$law, $method, $formulation, $out" 0 "$talus" run $out.yaml --out $out --force --quiet
        [ -z "$alone" ] || break
      done
      set -- ${both%%,*}
      if [ -n "$alone" ]; then held aged/history.csv 7 $allowed; else like aged/history.csv still/history.csv $allowed; fi
    done
  done
done
name="the unit of a rate of stress"
head -n 1 aged/history.csv >out.txt
says out.txt "rate [Pa/s]"

# Clay that stands on its ellipse flows in the step in which M falls, whatever happens to its stiffness in that step, and what is written at
# its end is in balance: stress under the load in fem, and energies also where nodes are new (gmm).
cat >weak.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, end: 0.2, step: 0.1}
grid: {box: {min: [0, 0], max: [0.5, 1]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [0.5, 1]}}, points_per_cell: 4, material: m, stress: {xx: -6e4, yy: -1e5, zz: -6e4}}]
materials:
  m: {law: modified-cam-clay, density: 1800, critical_stress_ratio: 1.1, lambda: 0.2, kappa: 0.04, specific_volume: 2.1, shear_modulus: 4e6}
boundary:
  - {name: floor, on: {boundary: bottom}, fix: [y]}
  - {name: left, on: {boundary: left}, fix: [x]}
  - {name: right, on: {boundary: right}, fix: [x]}
loads: {tractions: [{on: {body: b, y: 1}, value: [0, -1e5], amplitude: [[0, 1], [1, 1]]}]}
initial: {equilibrium: none}
measures:
  yy: {stress: yy}
  balance: {energy: balance}
  top: {displacement: y, of: {tracer: [0.25, 1]}}
END
fall="critical_stress_ratio: [[0, 1], [0.2, 0.5]]"
for change in "gmm 1 1e-5" "fem 0.01 1e-8 , shear_modulus: [[0, 1], [1, 1.0001]]" "gmm 1 1e-5 , kappa: [[0, 1], [0.2, 1.1]]"; do
  set -- $change
  method=$1 stress=$2 work=$3
  shift 3
  expect "M falls, $change" 0 "$talus" run weak.yaml --out weak --force --quiet --set method=$method --set "materials.m.amplitude={$fall$*}"
  awk -F, -v stress=$stress -v work=$work 'NR > 2 { off = $3 + 1e5; if (off * off > stress * stress || $4 * $4 > work * work || $5 > -5e-3) bad = 1 }
    END { exit bad || NR != 4 }' weak/history.csv || fail "$name: $(tail -n 2 weak/history.csv)"
done
# A lambda that falls below the kappa with which the step begins is gone to in shorter steps.
expect "lambda and kappa fall" 0 "$talus" run weak.yaml --out weak --force --quiet --set materials.m.lambda=0.06 --set "materials.m.amplitude={lambda: [[0, 1], [0.2, 0.5]], kappa: [[0, 1], [0.2, 0.5]]}"
grep -q 'halvings = 1 ' weak/log.txt || fail "$name: $(grep halvings weak/log.txt)"

# An amplitude that stays is the constant itself, to the bit.
for law in j2 mohr-coulomb; do
  both=$(constants $law)
  block fem displacement $law "young: 4.95e7, poisson: 0.25${both#"${both%%,*}"}" >is.yaml
  block fem displacement $law "young: 5e7, poisson: 0.25${both#"${both%%,*}"}, amplitude: {young: [[0, 0.99], [7, 0.99], [100, 0.99]]}" >times.yaml
  expect "$law, 0.99 E" 0 "$talus" run is.yaml --out is --force --quiet
  expect "$law, E with an amplitude of 0.99" 0 "$talus" run times.yaml --out times --force --quiet
  cmp -s is/history.csv times/history.csv || fail "$name: not the same"
done

# Soil that has dilated by a sixth goes on with its strength, which counts from the undeformed body.
block fem displacement mohr-coulomb "young: 5e7, poisson: 0.25, friction_angle: 20, dilatancy_angle: 20, cohesion: 1e5" |
  sed -e '/^loads/d' -e '/  A:/!s/, stress: {.*}}/}/' -e 's/y: -0.03}, .*/y: -0.3}, amplitude: [[0, 0], [16, 1], [99, 1]]}/' >dilated.yaml
for E in 5e7 4.95e7; do
  { cat dilated.yaml; echo "stages: [{name: a}, {name: b, analysis: {end: 1, steps: 1}, materials: {A: {young: $E}}}]"; } >goes-on.yaml
  expect "dilated soil with E = $E" 0 "$talus" run goes-on.yaml --out goes-on-$E --force --quiet
  tail -n 1 goes-on-$E/history.csv | cut -d, -f4 >reaction-$E
done
name="dilated soil with other moduli bears what it did"
[ -n "$(paste -d' ' reaction-5e7 reaction-4.95e7 | awk '{ x = $2 / $1 - 1 } x < 1e-3 && x > -1e-3')" ] || fail "$name: $(cat reaction-*)"

# A law that shares the history takes a hardened stress over.
block fem displacement j2 "young: 5e7, poisson: 0.25, yield_stress: 1e5, hardening: 1e6" >from.yaml
{ sed 's/^loads.*/&/' from.yaml; echo "stages: [{name: a}, {name: b, analysis: {end: 2, steps: 2}, materials: {A: {law: j2-log, density: 1000, young: 5e7, poisson: 0.25, yield_stress: 1e5, hardening: 1e6}}}]"; } >log.yaml
expect "from j2 to j2-log" 0 "$talus" run log.yaml --out log --force --quiet
held log/history.csv 8 1e-10

# Soil that has flowed by mohr-coulomb begins to soften at its peak: N = tan^2(45 + 35 / 2) = 3.690172, 1e5 N + 2e4 sqrt N = 407437 Pa, less
# 10 degrees and 9 kPa in 0.1 of 1.2e-4 of strain of its own. What has not flowed goes on as the law does that was there from the start, in cells of two `reference_size`.
peak="young: 5e7, poisson: 0.25, friction_angle: 35, cohesion: 1e4"
softens="$peak, residual_friction_angle: 25, residual_cohesion: 1e3, residual_strain: 0.1"
block fem displacement mohr-coulomb "$peak" >flowed.yaml
{ sed "s/^  A:.*/&\n  B: {law: mohr-coulomb-softening, density: 1000, $softens}/" flowed.yaml
  echo "stages: [{name: settle}, {name: fail, analysis: {end: 1, steps: 1}, bodies: [{name: a, material: B}], boundary: [{name: top, on: {y: 1}, displacement: {y: -1e-4}}]}]"; } >peak.yaml
expect "from mohr-coulomb to its peak" 0 "$talus" run peak.yaml --out peak --force --quiet
awk -F, '$2 == 9 && $6 < -407437 * 0.998 && $6 > -407437 * 1.001 { ok = 1 } END { exit !ok }' peak/history.csv || fail "$name: $(tail -n 2 peak/history.csv)"
sized="law: mohr-coulomb-softening, density: 1000, $softens, reference_size: 0.25"
press="{name: press, analysis: {end: 1, steps: 10}, boundary: [{name: top, on: {y: 1}, displacement: {y: -0.03}}]"
sed "s/y: -0.03}/y: 0}/; s/^  A:.*/&\n  B: {$sized}/" flowed.yaml >rests.yaml
{ cat rests.yaml; echo "stages: [{name: rest}, $press, bodies: [{name: a, material: B}]}]"; } >later.yaml
{ sed "s/^  A:.*/  A: {$sized}/; /^  B:/d" rests.yaml; echo "stages: [{name: rest}, $press}]"; } >always.yaml
expect "softens later" 0 "$talus" run later.yaml --out later --force --quiet
expect "softens from the start" 0 "$talus" run always.yaml --out always --force --quiet
like later/history.csv always/history.csv 1e-10
lacks err.txt "table of strength"
# Steps that go over much of the table say so: -ln 0.97 less (1 - 0.25^2) (301 kPa - 1e5) / E, 2 / sqrt 3 times that as strain, in cells of two sizes, over 0.1.
turn
expect "softens in a step on $ranks" 0 on_ranks $ranks "$talus" run always.yaml --set stages[1].analysis.steps=1 --out once --force --quiet
says err.txt "a step has taken a point through up to 0.62 of a piece of its table of strength"
# A nonlocal strain on the way up to the peak, in short steps: what is alike is no other in many cells than in one.
sed "s/^  A:.*/  A: {law: mohr-coulomb-softening, density: 1000, $softens, initial_friction_angle: 28, initial_cohesion: 3e3, peak_strain: 0.01, nonlocal_length: 1}/
  s/end: 8, steps: 8/end: 8, steps: 100/; s/-0.03}, amplitude.*/-0.008}, amplitude: [[0, 0], [8, 1]]}/; s/max: .1.5, 1./max: [1, 1]/" flowed.yaml >rises.yaml
expect "rises in one cell" 0 "$talus" run rises.yaml --out one --force --quiet --set grid.size=1
turn
expect "rises in sixteen on $ranks" 0 on_ranks $ranks "$talus" run rises.yaml --set grid.size=0.25 --out sixteen --force --quiet
grep -q 'halvings = 0 ' sixteen/log.txt || fail "$name: $(grep halvings sixteen/log.txt)"
like sixteen/history.csv one/history.csv 1e-9
cat >point.yaml <<'END'
material: {law: mohr-coulomb-softening, young: 50e6, poisson: 0.25, friction_angle: 35, cohesion: 10e3, residual_friction_angle: 25, residual_strain: 0.1}
start: {pressure: 100e3}
path: [{test: triaxial, to: 0.1, steps: 1}]
END
expect "a point in an increment" 0 "$talus" element point.yaml --out point
says err.txt "of a piece of the table of strength"
expect "a point in fifty" 0 "$talus" element point.yaml --out point --set path[0].steps=50
lacks err.txt "table of strength"

# From one run to the next, with other moduli: all sides are held.
sed '/^loads/d' from.yaml | sed 's/^boundary:/&\n  - {name: right, on: {x: 1}, fix: [x]}/' >first.yaml
sed -e 's/young: 5e7/young: 4e7/' -e 's/amplitude: \[\[0, 0\], \[6, 1\], \[99, 1\]\]/amplitude: [[0, 0], [99, 0]]/' first.yaml >next.yaml
echo "initial: {run: first}" >>next.yaml
expect "squeezed" 0 "$talus" run first.yaml --out first --force --quiet
expect "goes on in another run" 0 "$talus" run next.yaml --out next --force --quiet
held next/history.csv 1 1e-10
name="what a run begins with has the stress of the run before"
[ "$(awk -F, 'FILENAME == ARGV[1] { y = $5 } FILENAME == ARGV[2] { z = $5 } END { print (y / z - 1) ^ 2 < 1e-20 }' first/history.csv next/history.csv)" = 1 ] || fail "$name"
finish
