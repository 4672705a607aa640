#!/bin/sh
# One material point from outside: files and cases, tables and pictures, paths that cannot be followed, mistakes.
. "$(dirname "$0")/library.sh"
cat >sand.yaml <<'END'
title: Sand
material: {law: mohr-coulomb, young: 50e6, poisson: 0.25, friction_angle: 30, cohesion: 0}
start: {pressure: 100e3}
path:
  - {test: triaxial, to: 0.02, steps: 10}
  - {test: triaxial, to: -0.005, relative: true, steps: 5}
  - {strain: {zz: 0}, stress: {yy: -150e3}, steps: 5}
END
# The peak is 2 P with 30 degrees: q = 200 kPa
expect "a file" 0 "$talus" element sand.yaml --out a
says out.txt "Sand (mohr-coulomb)" "triaxial" "strain zz, stress yy" "table: a/element.csv" "picture: a/element.png"
[ "$(wc -l <a/element.csv)" -eq 22 ] || fail "$name: rows"
head -1 a/element.csv | grep -q -F 'stress_zx [Pa],pore_pressure [Pa],p [Pa],q [Pa],mobilised_friction [deg],elastic_strain_xx' || fail "$name: header"
awk -F, 'NR == 12 {if ($19 < 199999 || $19 > 200001 || $20 < 29.9999 || $20 > 30.0001) bad = 1} NR == 22 {if ($12 < -150001 || $12 > -149999) bad = 1}
  END {exit bad}' a/element.csv || fail "$name: no 200 kPa at 30 degrees, or no 150 kPa at the end"
if command -v gnuplot >/dev/null; then [ -s a/element.png ] || fail "$name: no picture"; fi
cp a/element.csv first.csv
expect "again, on two ranks" 0 mpiexec --oversubscribe -n 2 "$talus" element sand.yaml --out a
cmp -s a/element.csv first.csv || fail "$name: other numbers"

cat >case.yaml <<'END'
title: A block
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.5}
bodies:
  - {name: block, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 4, material: clay}
materials:
  clay: {law: mohr-coulomb, density: 1800, young: 20e6, poisson: 0.3, friction_angle: 0, cohesion: 25e3}
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}
boundary:
  - {name: floor, on: {boundary: bottom}, fix: [x, y]}
END
expect "a case" 0 "$talus" element case.yaml --material clay --test triaxial --confining 1e5 --to 0.02,-0.02 --undrained --out b
says out.txt "A block: clay, triaxial, undrained"
# Tresca: q = 2 c up to the volume of the start, 1 - 2e-3
awk -F, 'NR > 150 && ($19 < 49900 || $19 > 50300) {bad = 1} END {exit bad || NR != 202}' b/element.csv || fail "$name: q is not 50 kPa"
expect "a default directory" 0 "$talus" element case.yaml --material rubber --test oedometer --to 0.1 --set materials.rubber.young=2e6
[ -s runs/element/case/rubber-oedometer/element.csv ] || fail "$name: no table"
# Half of the strength in plane strain, undrained, Tresca: s_xx - s_yy = 2 (c / 2); of that body alone
expect "a divided strength" 0 "$talus" element case.yaml --material clay --test biaxial --to 0.02 --undrained --set 'strength={factor: 2}' --out half
says out.txt "strength divided by 2"
awk -F, 'END { q = $11 - $12; exit !(q > 24990 && q < 25010) }' half/element.csv || fail "$name: $(tail -n 1 half/element.csv)"
expect "another body's" 0 "$talus" element case.yaml --material rubber --test biaxial --to 0.02 --set 'strength={factor: 2}' --out half
lacks out.txt "divided"
# What softens does so h / reference_size times as fast
sed 's/clay: .*/clay: {law: mohr-coulomb-softening, density: 1800, young: 20e6, poisson: 0.3, friction_angle: 0, cohesion: 25e3, residual_cohesion: 5e3, residual_strain: 0.1, reference_size: 0.25}/' case.yaml >soft.yaml
scale() { awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "softening_scale") k = i } END { print $k }' "$1/element.csv"; }
expect "a cell" 0 "$talus" element soft.yaml --material clay --test triaxial --confining 1e5 --to 0.02 --out soft
says out.txt "in a cell of 0.5 m"
[ "$(scale soft)" = 2 ] || fail "$name: $(scale soft)"
lacks err.txt "warning"
expect "two bodies" 0 "$talus" element soft.yaml --material clay --test triaxial --confining 1e5 --to 0.02 --out soft --set 'grid={box: {min: [0, 0], max: [2, 1]}, counts: [4, 2], grading: {x: 8}}' \
  --set 'bodies[0].shape.box.max=[0.5, 1]' --set 'bodies[1]={name: right, shape: {box: {min: [0.5, 0], max: [2, 1]}}, material: clay}'
says err.txt "cells of 'clay' are not of one size" "m in 'block'" "m in 'right'"
expect "no grid" 0 "$talus" element soft.yaml --material clay --test triaxial --confining 1e5 --to 0.02 --out soft --set 'grid={mesh: none.msh}'
says err.txt "how large the cells of 'clay' are is not known"
[ "$(scale soft)" = 1 ] || fail "$name: $(scale soft)"
expect "no length" 0 "$talus" element soft.yaml --material clay --test triaxial --confining 1e5 --to 0.02 --out soft --set materials.clay.reference_size=0
lacks out.txt "in a cell"
expect "which material" 2 "$talus" element case.yaml --test oedometer --to 0.1
says err.txt "which of the materials" "clay, rubber"
expect "another material" 2 "$talus" element case.yaml --material clya --test oedometer --to 0.1
says err.txt "did you mean 'clay'?"
expect "another test" 2 "$talus" element case.yaml --test triaxail --to 0.1
says err.txt "did you mean 'triaxial'?"
expect "no number" 2 "$talus" element case.yaml --material clay --test triaxial --to 0.1,x
says err.txt "--to: 'x' is no number"
expect "nowhere" 2 "$talus" element case.yaml --material clay --test isotropic
says err.txt "--to gives a pressure in Pa"
expect "options of a test" 2 "$talus" element sand.yaml --confining 1e5
says err.txt "needs --test"
expect "a case without a test" 2 "$talus" element case.yaml
says err.txt "this is a case" "--test triaxial"

expect "a folder without a test" 2 "$talus" element .
says err.txt "./case.yaml:1:1: error: this is a case" "--test triaxial"
expect "a path with a test" 2 "$talus" element sand.yaml --test triaxial --to 0.1
says err.txt "sand.yaml: error: this file tells its path by itself"

# Grains sheared at 100 / s, at 10 / s and without any rate: arcsin mu(I)
cat >grains.yaml <<'END'
material: {law: mu-i, young: 1e8, poisson: 0.2, static_friction: 0.38, limit_friction: 0.64, grain_size: 1e-3, grain_density: 2500}
start: {pressure: 1e4}
path: [{strain: {xy: 0.2}, seconds: 2e-3, steps: 200}, {strain: {xy: 0.2}, seconds: 2e-2, steps: 200}, {strain: {xy: 0.2}, steps: 200}]
END
expect "rates" 0 "$talus" element grains.yaml --out f
awk -F, 'function off(x) { return $20 > x * (1 + 1e-4) || $20 < x * (1 - 1e-4) } $1 == 1 { n = NR } NR == 202 && off(24.80389) { exit 1 } NR == 402 && off(22.61751) { exit 1 }
  END { exit off(22.33368) }' f/element.csv || fail "$name: $(sed -n '202p;402p;602p' f/element.csv | cut -d, -f20)"

sed 's/yy: -150e3/yy: -500e3/' sand.yaml >strong.yaml
expect "beyond its strength" 1 "$talus" element strong.yaml --out c
says err.txt "strong.yaml:7:5: error: strain zz, stress yy ends after" "prescribe its strain"
[ "$(wc -l <c/element.csv)" -gt 17 ] || fail "$name: what was reached is not there"
mistake() { # name, sed, words
  sed "$2" sand.yaml >bad.yaml
  expect "$1" 2 "$talus" element bad.yaml --out d
  shift 2
  says err.txt "$@"
}
mistake "a word" 's/test: triaxial, to: 0.02/test: triaxal, to: 0.02/' "bad.yaml:5:" "did you mean 'triaxial'?"
mistake "a key" 's/relative/realtive/' "bad.yaml:6:" "did you mean 'relative'?"
mistake "no end" 's/to: 0.02, //' "key 'to' of path[0] is missing"
mistake "both" 's/{zz: 0}/{zz: 0, yy: 0}/' "strain and stress of one component"
mistake "nothing" 's/strain: {zz: 0}, stress: {yy: -150e3}, //' "path[2] needs at least one of"
mistake "no component" 's/strain: {zz: 0}, stress: {yy: -150e3}, /strain: {}, stress: {}, /' "bad.yaml:7:" "path[2] changes nothing"
mistake "a constant" 's/cohesion: 0/cohesion: -1/' "cohesion"
mistake "an angle" 's/cohesion: 0/cohesion: 0, dilatancy_angle: 40/' "bad.yaml:2:" "must not be larger than the friction angle"
mistake "two pressures" 's/pressure: 100e3/pressure: 100e3, stress: {xx: 1}/' "both 'pressure' and 'stress'"
mistake "a start that yields" 's/pressure: 100e3/stress: {xx: -1e5, yy: -1e6, zz: -1e5}/' "the material (mohr-coulomb) cannot begin with this stress"
mkdir e && echo mine >e/element.csv
expect "somebody's table" 2 "$talus" element sand.yaml --out e
says err.txt "talus has not written"
[ "$(cat e/element.csv)" = mine ] || fail "$name: it is gone"
expect "by force" 0 "$talus" element sand.yaml --out e --force
[ "$(wc -l <e/element.csv)" -eq 22 ] || fail "$name: no table"

# Per cent for a strain
sed 's/to: 0.02, /to: 2, /' sand.yaml >cent.yaml
"$talus" element cent.yaml --out cent >out.txt 2>err.txt
name="per cent"
says err.txt "goes to a logarithmic strain of -2: to 0.14 times the length" "5 % is 0.05"
expect "strains" 0 "$talus" element sand.yaml --out cent --force
lacks err.txt "warning"
finish
