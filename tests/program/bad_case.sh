#!/bin/sh
# Mistakes in a case file: `talus run` says where and what, exits with 2, and writes nothing.
. "$(dirname "$0")/library.sh"

# refused NAME TEXT...: case.yaml is refused with all these texts; one that starts with a place comes with a caret.
refused() {
  name=$1
  shift
  expect "$name" 2 "$talus" run case.yaml --out result
  says err.txt "$@"
  [ ! -e result ] || fail "$name: something was written"
  rm -rf result
  [ ! -s out.txt ] || fail "$name: something on standard output"
  case $1 in
  case.yaml:[0-9]*:[0-9]*:*) grep -q '^ *^~*$' err.txt || fail "$name: no caret" ;;
  esac
}

# changed NAME SED-EXPRESSION TEXT...: the same for the cantilever with a change.
changed() {
  what=$1 expression=$2
  shift 2
  cantilever | sed "$expression" >case.yaml
  refused "$what" "$@"
}

# Files that are no case at all
: >case.yaml
refused "empty file" "case.yaml: error: the file is empty"
rm case.yaml && mkdir case.yaml
refused "directory" "case.yaml: error: this is a directory; the case is a file in it"
rmdir case.yaml
refused "no file" "case.yaml: error: there is no such file"
head -c 4000 "$talus" >case.yaml
refused "binary" "case.yaml:1:1: error: " "0x7F"
printf '# nothing but a comment\n' >case.yaml
refused "comment" "error: " "empty"
printf 'just words\n' >case.yaml
refused "words" "case.yaml:1:1: error: " "key: value"
cantilever | sed 's/^  rubber/\trubber/' >case.yaml
refused "tab" "case.yaml:9:1: error: " "tab"
printf 'title: x\n\tkinematics: plane-strain\nmethod: mpm\n' >case.yaml
refused "tab behind a text" "case.yaml:2:1: error: syntax: a tab indents this line" "tab"
cantilever | head -c 300 >case.yaml
refused "truncated" "case.yaml:" "error: "

# Keys
changed "unknown key" 's/young/yung/' "case.yaml:9:45: error: key 'yung' of materials.rubber is not known" "did you mean 'young'?"
changed "a mapping left out" 's/on: {x: 0}/x: 0/' "error: key 'x' of boundary[0] is not known" 'hint: write `on: {x: ..}`'
changed "a list left out" 's/^loads/walls: [{name: w, half-space: {point: [0, 0], normal: [0, 1]}, velocity: [0, 0]}]\nloads/' \
  'hint: write `shape: {half-space: ..}`' 'hint: write `motion: [{velocity: ..}]` or `mass: {velocity: ..}`'
changed "one mapping too deep" 's/type: static/gravity: [0, 1], type: static/' 'hint: it belongs elsewhere in the file: `loads: {gravity: ..}`'
changed "a part of a name" 's/^loads/measures: {f: {force: x}}\nloads/' 'hint: write `wall_force: ..` or `interface_force: ..`'
changed "nowhere" 's/^loads/bananas: 3\nloads/' "hint: known here: title, kinematics"
changed "a name for what it is of" 's/^loads/measures: {f: {reaction: y, of: floor}}\nloads/' "hint: known here: tracer, body, boundary"
changed "a side for an entry" 's/^loads/measures: {f: {reaction: y, of: {boundary: bottom}}}\nloads/; s/- {on/- {name: clamp, on/' "there is no 'bottom' in boundary" "hint: known here: clamp"
changed "two letters that are others" 's/^loads/measures: {f: {reaction: y, on: 0}}\nloads/' 'hint: it belongs elsewhere in the file: `boundary: [{on: ..}]`'
changed "duplicate key" 's/^loads/method: fem\nloads/' "case.yaml:12:1: error: key 'method' stands twice in the file (first in line 3)"
changed "a bracket that stays open" 's/^title: .*/title: [a/' "case.yaml:3:7: error: syntax: " "hint: the '[' in line 1, column 8 has no ']' before this"
changed "missing key" '/^method/d' "case.yaml:1:1: error: key 'method' of the file is missing"
changed "wrong type" 's/90e6/stiff/' "case.yaml:9:52: error: materials.rubber.young must be a number > 0" "not 'stiff'"
changed "number for a list" 's/fix: \[x, y\]/fix: 3/' "case.yaml:11:" "boundary[0].fix"
changed "list for a number" 's/90e6/[1, 2]/' "case.yaml:9:52: error: materials.rubber.young must be a number"
changed "two numbers of three" 's/\[0, -9.81\]/[0]/' "case.yaml:12:18: error: loads.gravity must have 2 entries (this case is two-dimensional), not 1"
changed "unknown word" 's/plane-strain/plane-stress/' "case.yaml:2:13: error: " "plane-strain"

# Numbers
for density in .nan .inf -1000 0 nan; do
  changed "density $density" "s/density: 1000/density: $density/" "case.yaml:9:39: error: materials.rubber.density must be a number > 0 in kg/m3, not '$density'"
done
changed "incompressible" 's/poisson: 0/poisson: 0.5/' "case.yaml:9:67: error: " "Poisson's ratio 0.5"

changed "no warning of what was not read" 's/type: static, steps: 1/type: dynamic, end: abc, step: 0.1/' "case.yaml:4:32: error: analysis.end must be a number"
lacks err.txt "gamma"

# Names, places
changed "unknown material" 's/material: rubber/material: ruber/' "case.yaml:7:90: error: " "'ruber'" "did you mean 'rubber'?"
changed "unknown side" 's/{x: 0}/{boundary: lefd}/' "case.yaml:11:21: error: " "'lefd'" "did you mean 'left'?"
changed "region of a box" 's/shape: .*, points/region: soil, points/' "case.yaml:7:26: error: bodies[0].region: a box grid has no regions"
changed "body outside" 's/min: \[0, 0\], max: \[8, 1\]/min: [20, 0], max: [28, 1]/' "case.yaml:7:18: error: body 'beam' holds the centre of no cell" "the body lies outside the grid"
changed "nothing held" 's/{x: 0}/{x: 77}/' "case.yaml:11:6: error: boundary[0].on selects no node of the grid, which spans (0, -1.5) to (8.5, 1.5)"
changed "tracer outside" 's/\[8, 0.5\]/[80, 0.5]/' "case.yaml:14:31: error: the tracer starts outside the grid"
changed "contradiction" 's/^loads/  - {on: {y: 0}, velocity: {x: 1}}\nloads/' "case.yaml:12:5: error: boundary[1] contradicts boundary[0]: both prescribe x of the node at (0, 0), but not the same motion"

# Options of PETSc
changed "option of PETSc" '$a petsc: {pc_type: luu}' "case.yaml:17:" "PETSc refuses an option" "luu"
changed "number of PETSc" '$a petsc: {ksp_rtol: small}' "case.yaml:17:" "PETSc refuses an option" "small"

# All at once, in the order of their lines
changed "several" 's/young/yung/; s/\[0, -9.81\]/down/; s/type: static/type: statick/' "case.yaml:4:18: error: " "case.yaml:9:45: error: " "case.yaml:12:18: error: "
[ "$(grep -c ': error: ' err.txt)" -eq 3 ] || fail "several: not one for each"
grep ': error: ' err.txt | cut -d: -f2 >lines.txt
sort -n -c lines.txt || fail "several: out of order"

# Once on several ranks, not once on each
cantilever | sed 's/min: \[0, 0\], max: \[8, 1\]/min: [20, 0], max: [28, 1]/' >case.yaml
expect "two ranks" 2 on_ranks 2 "$talus" run case.yaml --out result
[ "$(grep -c ': error: ' err.txt)" -eq 1 ] || fail "two ranks: the error is not printed once"
[ ! -e result ] || fail "two ranks: something was written"

finish
