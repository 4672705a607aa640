#!/bin/sh
# A law of one's own: the example of docs/example/law compiled as its head says, and used by every command that reads cases;
# a subroutine UMAT.
source=$(cd "$(dirname "$0")/../.." && pwd)
compare="$source/tests/program/compare.awk"
. "$(dirname "$0")/library.sh"
build() { "${CC:-cc}" -shared -fPIC -O2 -Wall -Wextra -Werror -I "$source/include" -o "$@" -lm || fail "$1 is not compiled"; }
cp "$source/docs/example/law/bar.yaml" bar.yaml
build voce.so "$source/docs/example/law/voce.c"

expect "run" 0 "$talus" run bar.yaml --law voce=./voce.so --out one --quiet --set newton.residual=1e-11 --set checkpoint.steps=10 --set checkpoint.keep=2
expect "2 ranks" 0 on_ranks 2 "$talus" run bar.yaml --law=voce=voce.so --out two --quiet --set newton.residual=1e-11
awk -f "$compare" one/history.csv two/history.csv >out.txt || fail "$name: another history"

# From the middle on: the same bits; without the library, or with one of another state, nothing
cp -r one cut
rm cut/checkpoint_000000020.h5
expect "resumed without it" 2 "$talus" run --resume cut
says err.txt "materials.metal.law must be one of" "a law of your own is loaded by --law voce=FILE.so"
sed 's/{.name = 0},\n};//; s/^static const TalusLawState state_fields.*/&\n  {"more", "", "one number more", 1, {0}},/' "$source/docs/example/law/voce.c" >other.c
build other.so other.c
expect "resumed with another state" 2 "$talus" run --resume cut --law voce=./other.so
expect "resumed" 0 "$talus" run --resume cut --law voce=./voce.so --quiet
# What points keep is a field of the output, a tensor too; another law has none, which is 0
build keeps.so "$source/tests/material/plugins/gradient.c" -DGIVES=1
expect "states as fields" 0 on_ranks 2 "$talus" run bar.yaml --law voce=./voce.so --law green=./keeps.so --out kept --quiet --set 'output.fields=[displacement, b, deformation_gradient]' \
  --set 'materials.rubber={law: green, density: 1000, lambda: 1e9, mu: 1e9}' --set 'bodies[0].shape.box.max=[2, 1]' --set 'boundary[2].displacement.x=0.2' \
  --set 'bodies[1]={name: rest, shape: {box: {min: [2, 0], max: [4, 1]}}, material: rubber}'
expect "a field without its law" 2 "$talus" check bar.yaml --law voce=./voce.so --set 'output.fields=[b]'
says err.txt "there is no field 'b'" "what points of a law of one's own keep is a field, too, where --law loads it"
cmp -s one/history.csv cut/history.csv || fail "$name: another history"
says one/log.txt "law = --law=voce="

expect "check" 0 "$talus" check bar.yaml --law voce=./voce.so
says out.txt "law: voce" "rate: 8" "saturation: "
expect "a key that it does not have, and a number out of its range" 2 "$talus" check bar.yaml --law voce=./voce.so \
  --set materials.metal.saturatoin=3 --set materials.metal.rate=-1
says err.txt "key 'saturatoin' of materials.metal is not known" "did you mean 'saturation'?" "materials.metal.rate must be a number >= 0"
expect "numbers that contradict each other" 2 "$talus" check bar.yaml --law voce=./voce.so --set materials.metal.saturation=1e6
says err.txt "saturation must not be below yield_stress"
expect "no such file" 2 "$talus" check bar.yaml --law voce=./none.so
says err.txt "the library './none.so' of the law voce cannot be read: No such file"
expect "in the case" 2 "$talus" check bar.yaml --set materials.metal.plugin=./voce.so

# Under a pressure along y alone tau = q J = k(alpha), and the strain is tau / E + alpha
expect "element" 0 "$talus" element bar.yaml --law voce=./voce.so --test triaxial --to 0.05 --out element
awk -F, 'NR > 1 {tau = $19 * exp($2 + $3 + $4); a = $NF}
  END {k = 4e8 - 2e8 * exp(-8 * a); e = tau / 2e11 + a; exit !(a > 0.04 && tau > k * (1 - 1e-9) && tau < k * (1 + 1e-9) && e > 0.05 - 1e-11 && e < 0.05 + 1e-11)}' \
  element/element.csv || fail "$name: not on the curve of hardening"

# Without its energy, and one that finds no stress: each is told as what it is
cat >less.c <<END
#define talus_law talus_law_that_gives
#include "$source/docs/example/law/voce.c"
#undef talus_law
#ifdef FAILS
static int give_up(const double *p, const TalusLawStep *step, const double strain[6], const double *old, double *state,
                   double tau[6], double elastic[6], double *D)
{
  return step->dt > 0 ? TALUS_LAW_NOT_CONVERGED : update(p, step, strain, old, state, tau, elastic, D);
}
#endif
const TalusLaw *talus_law(void)
{
  static TalusLaw less;
  less = law;
  less.energy = NULL;
#ifdef FAILS
  less.update_strain = give_up;
#endif
  return &less;
}
END
build less.so less.c
build fails.so -DFAILS less.c
expect "no energy" 0 "$talus" run bar.yaml --law voce=less.so --out less --quiet --set analysis.end=0.2 --set analysis.steps=2 --set 'measures.stored={energy: elastic}'
says err.txt "'stored' is empty (nan) at the end: the law of a material tells no energy"
cat >falls.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: explicit, end: 1e-3, step: 1e-4}
grid: {box: {min: [0, 0], max: [4, 2]}, size: 0.5}
bodies: [{name: bar, shape: {box: {min: [1, 0.5], max: [3, 1.5]}}, material: metal}]
materials: {metal: {law: voce, density: 7800, young: 200e9, poisson: 0.3, yield_stress: 200e6, saturation: 400e6}}
loads: {gravity: [0, -10]}
END
expect "explicit" 0 "$talus" run falls.yaml --law voce=less.so --out falls --quiet
expect "no stress" 1 "$talus" run falls.yaml --law voce=fails.so --out fails --quiet
says err.txt "the law of a point did not converge near t ="
lacks err.txt "inside out"

# A subroutine UMAT, with stress and strain in closed form: Cauchy = C ln V
build elastic.so "$source/tests/material/plugins/umat_elastic.c"
cat >sand.yaml <<'END'
title: Elastic
material: {law: soil, prop_1: 1e6, prop_2: 0.25}
start: {pressure: 1e3}
path: [{test: oedometer, to: 0.1, steps: 10}]
END
expect "umat" 0 "$talus" element sand.yaml --umat soil=elastic.so,2,1 --out umat
awk -F, 'END {s = -1e3 - 1.2e6 * 0.1; exit !($12 > s - 1e-6 && $12 < s + 1e-6 && $NF == 10)}' umat/element.csv || fail "$name: other stress, or another count"
expect "how many" 2 "$talus" element sand.yaml --umat soil=elastic.so
says err.txt "behind the file stand NPROPS" "--umat clay=./clay.so,6,3"
expect "no umat" 2 "$talus" element sand.yaml --umat soil=voce.so,2,1
says err.txt "has no subroutine UMAT (symbol umat_)" "is loaded by --law soil="

# COORDS is where a point is at the start of the step, in dynamics too and behind a stress at the start; the run is one that
# moves points from rank to rank.
cat >moves.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.5, step: 0.1}
grid: {box: {min: [0, 0], max: [8, 2]}, size: 0.5}
bodies: [{name: bar, shape: {box: {min: [1, 0], max: [3, 1]}}, material: soil, velocity: [8, 0], k0: 0.5}]
materials: {soil: {law: soil, density: 1000, prop_1: 1e6, prop_2: 0.25}}
boundary: [{on: {boundary: bottom}, fix: [y]}]
loads: {gravity: [0, -10]}
output: {fields: [velocity, statev_2, statev_3, statev_4], every: {steps: 1}}
END
expect "COORDS" 0 on_ranks 3 "$talus" run moves.yaml --umat soil=elastic.so,2,4 --out moves --quiet
# In explicit dynamics it is that at the start of a stretch of substeps, here 0.06 m
expect "COORDS, explicit" 0 "$talus" run moves.yaml --umat soil=elastic.so,2,4 --out quick --quiet --set analysis.type=explicit
# This, and the states as fields of above
name="states, COORDS"
if python3 -c 'import h5py, numpy' 2>/dev/null; then
  PYTHONPATH="$source/python" python3 - >out.txt 2>&1 <<'END' || fail "$name: $(tail -n 1 out.txt)"
import numpy, talus
p = talus.Run("kept").states[-1].points
F, b, rubber = p["deformation_gradient"].reshape(-1, 3, 3), p["b"], p["position"][:, 0] > 2
green = (F @ F.transpose(0, 2, 1)).reshape(-1, 9)[:, [0, 4, 8, 1, 5, 2]]
assert rubber.any() and abs(green[rubber] - 1).max() > 0.01
assert numpy.allclose(b[rubber], green[rubber], rtol=1e-12, atol=1e-12), abs(b[rubber] - green[rubber]).max()
assert not b[p["position"][:, 0] < 1.9].any()
states = talus.Run("moves").states
assert len(states) == 6
for before, after in zip(states[:-1], states[1:]):
    was = before.points.by_id("position")
    told = numpy.column_stack([after.points.by_id(f"statev_{k}").ravel() for k in (2, 3, 4)])
    assert abs(told[:, :2] - was[:, :2]).max() < 1e-12 and not told[:, 2].any(), abs(told[:, :2] - was[:, :2]).max()
points = talus.Run("quick").states[-1].points
behind = points["position"][:, 0] - points["statev_2"].ravel()
assert behind.min() > 0 and behind.max() < 0.1, (behind.min(), behind.max())
END
fi
expect "as many as there may be, and another one" 0 "$talus" check moves.yaml --umat soil=elastic.so,24,24 --umat clay=elastic.so,2,1 --set 'output.fields=[statev_24]' \
  --set "materials.soil={law: soil, density: 1000$(awk 'BEGIN {for (k = 1; k <= 24; ++k) printf ", prop_%d: %g", k, k == 1 ? 1e6 : 0.25}')}"

# A subroutine that ends the process in the middle: that is said, and is no success
build ends.so -DENDS=200 "$source/tests/material/plugins/umat_elastic.c"
for ranks in 1 2; do
  expect "STOP, $ranks ranks" 1 on_ranks $ranks "$talus" run moves.yaml --umat soil=./ends.so,2,4 --out ends$ranks --quiet
  says err.txt "error: the library of the law soil has ended the program in the middle" "hint: STOP in Fortran"
  [ -s ends$ranks/case.yaml ] || fail "$name: it ended before the run"
done

# A library that was compiled anew is another law
overs() { "$talus" sweep bar.yaml --law voce=./voce.so --over materials.metal.rate=4,8 --set analysis.steps=4 --measure pull --out overs; }
expect "a sweep with a law" 0 overs
[ "$(grep -c done overs/sweep.csv)" -eq 2 ] || fail "$name: members"
says overs/rate=4/files.txt "law.voce = " "/voce.so"
expect "a sweep with the same law" 0 overs
says out.txt "2 done before"
printf x >>voce.so
expect "a sweep with another law" 2 overs
says err.txt "/voce.so' has changed since the run in 'overs/rate=4' read it"

# One in Fortran: on its curve of hardening, Cauchy = k(alpha), strain = Cauchy / E + alpha; and SDVINI, by which strength is
# that at y = 0 times 1 + y / 2: a slab 1 m high that flows everywhere takes 1.25 of 2 / sqrt(3) times its yield stress
command -v gfortran >/dev/null || { echo "no gfortran: the subroutine in Fortran is not tried"; finish; }
gfortran -shared -fPIC -O2 -o hard.so "$source/tests/material/plugins/umat_j2.f" || fail "umat_j2.f is not compiled"
cat >metal.yaml <<'END'
title: Metal
material: {law: metal, prop_1: 200e9, prop_2: 0.3, prop_3: 200e6, prop_4: 400e6, prop_5: 8, prop_6: 1e8}
path: [{test: triaxial, to: 0.05, steps: 20}]
END
expect "fortran" 0 "$talus" element metal.yaml --umat metal=./hard.so,6,2 --out hard
awk -F, 'NR > 1 {a = $(NF - 1); k = 4e8 - 2e8 * exp(-8 * a) + 1e8 * a; e = k / 2e11 + a}
  END {exit !(a > 0.04 && -$12 > k * (1 - 1e-9) && -$12 < k * (1 + 1e-9) && e > 0.05 - 1e-11 && e < 0.05 + 1e-11 && $NF == 1)}' \
  hard/element.csv || fail "$name: not on the curve of hardening"
for ranks in 1 3; do
  expect "SDVINI, $ranks ranks" 0 on_ranks $ranks "$talus" run bar.yaml --umat metal=hard.so,6,2 --out sdvini$ranks --quiet --set analysis.end=1 \
    --set analysis.steps=10 --set 'boundary[2].displacement.x=0.08' --set newton.residual=1e-11 --set formulation=mean-dilatation --set 'output.fields=[displacement]' \
    --set 'materials.metal={law: metal, density: 7800, prop_1: 200e9, prop_2: 0.3, prop_3: 200e6, prop_4: 200e6, prop_5: 0, prop_6: 0}'
  awk -F, 'END {f = $NF / (1.25 * 2 / sqrt(3) * 2e8 * exp(-0.02)); exit !(f > 0.998 && f < 1.002)}' sdvini$ranks/history.csv || fail "$name: other strength"
  awk -f "$compare" sdvini1/history.csv sdvini$ranks/history.csv >out.txt || fail "$name: another history"
done
finish
