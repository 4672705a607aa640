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
for ranks in 2 3; do
  expect "$ranks ranks" 0 on_ranks $ranks "$talus" run bar.yaml --law=voce=voce.so --out on$ranks --quiet --set newton.residual=1e-11
  awk -f "$compare" one/history.csv on$ranks/history.csv >out.txt || fail "$name: another history"
done

# From the middle on: the same bits; without the library, or with one of another state, nothing
cp -r one cut
rm cut/checkpoint_000000020.h5
expect "resumed without it" 2 "$talus" run --resume cut
says err.txt "materials.metal.law must be one of" "a law of your own is loaded by --law voce=FILE.so"
sed 's/{.name = 0},\n};//; s/^static const TalusLawState state_fields.*/&\n  {"more", "", "one number more", 1, {0}},/' "$source/docs/example/law/voce.c" >other.c
build other.so other.c
expect "resumed with another state" 2 "$talus" run --resume cut --law voce=./other.so
expect "resumed" 0 "$talus" run --resume cut --law voce=./voce.so --quiet
cmp -s one/history.csv cut/history.csv || fail "$name: another history"
says one/log.txt "law = --law=voce="

expect "check" 0 "$talus" check bar.yaml --law voce=./voce.so
says out.txt "law: voce" "rate: 8" "saturation: "
expect "a key that it does not have" 2 "$talus" check bar.yaml --law voce=./voce.so --set materials.metal.saturatoin=3
says err.txt "key 'saturatoin' of materials.metal is not known" "did you mean 'saturation'?"
expect "a number out of its range" 2 "$talus" check bar.yaml --law voce=./voce.so --set materials.metal.rate=-1
says err.txt "materials.metal.rate"
expect "numbers that contradict each other" 2 "$talus" check bar.yaml --law voce=./voce.so --set materials.metal.saturation=1e6
says err.txt "saturation must not be below yield_stress"
expect "no such file" 2 "$talus" check bar.yaml --law voce=./none.so
says err.txt "the library './none.so' of the law voce cannot be read: No such file"
expect "in the case" 2 "$talus" check bar.yaml --set materials.metal.plugin=./voce.so
expect "sweep" 0 "$talus" sweep bar.yaml --law voce=./voce.so --over materials.metal.rate=4,8 --measure pull --out sweep
[ "$(grep -c done sweep/sweep.csv)" -eq 2 ] || fail "$name: members"

# Under a pressure along y alone tau = q J = k(alpha), and the strain is tau / E + alpha
expect "element" 0 "$talus" element bar.yaml --law voce=./voce.so --test triaxial --to 0.05 --out element
awk -F, 'NR > 1 {tau = $19 * exp($2 + $3 + $4); a = $NF}
  END {k = 4e8 - 2e8 * exp(-8 * a); e = tau / 2e11 + a; exit !(a > 0.04 && tau > k * (1 - 1e-9) && tau < k * (1 + 1e-9) && e > 0.05 - 1e-11 && e < 0.05 + 1e-11)}' \
  element/element.csv || fail "$name: not on the curve of hardening"

# A subroutine UMAT, with stress and strain in closed form: Cauchy = C ln V
build elastic.so "$source/tests/material/plugins/umat_elastic.c"
cat >sand.yaml <<'END'
title: Elastic
material: {law: soil, prop_1: 1e6, prop_2: 0.25}
start: {pressure: 1e3}
path: [{test: oedometer, to: 0.1, steps: 10}]
END
expect "umat" 0 "$talus" element sand.yaml --umat soil=elastic.so,2,1 --out umat
awk -F, 'END {s = -1e3 - 1.2e6 * 0.1; exit !($12 > s - 1e-6 && $12 < s + 1e-6 && $NF == 11)}' umat/element.csv || fail "$name: other stress, or another count"
expect "how many" 2 "$talus" element sand.yaml --umat soil=elastic.so
says err.txt "behind the file stand NPROPS" "--umat clay=./clay.so,6,3"
expect "no umat" 2 "$talus" element sand.yaml --umat soil=voce.so,2,1
says err.txt "has no subroutine UMAT (symbol umat_)" "is loaded by --law soil="
finish
