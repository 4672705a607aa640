#!/bin/sh
# A case, a mesh script or a folder from somebody else does nothing but what it is there for.
. "$(dirname "$0")/library.sh"
export PWNED="$work/PWNED"

# harmless NAME CODE COMMAND...: ends with this code, and nothing of what was planted has happened.
harmless() {
  expect "$@"
  [ ! -e PWNED ] || fail "$1: it acted"
  rm -rf PWNED
}

# Options of PETSc in the case's block
cantilever >case.yaml
mkdir -p pictures/old && echo mine >pictures/old/file && echo mine >mine.txt
printf 'petsc: {snes_monitor: "draw::draw_lg", draw_type: image, draw_save: %s, draw_save_movie: .gif}\n' "'m\$(touch PWNED)'" >>case.yaml
harmless "a picture that runs a command" 2 "$talus" check case.yaml
harmless "a picture" 2 "$talus" run case.yaml --out run
says err.txt "case.yaml:17:24: error: petsc.snes_monitor may not be 'draw::draw_lg'" "error: a case file may not set the PETSc option 'draw_save'" \
  "other options of PETSc belong on the command line: -draw_save"
[ ! -e run ] || fail "$name: something was written"
cantilever >case.yaml
for option in snes_view=:mine.txt draw_save=pictures options_file=mine.txt dll_append=./mine.so pc_type=python; do
  harmless "$option" 2 "$talus" run case.yaml --out run --set "petsc.$option"
  says err.txt "--set petsc.$option: error: " "command line"
done
harmless "a block of --set" 2 "$talus" run case.yaml --out run --set "petsc={snes_view: ':mine.txt'}"
[ "$(cat mine.txt pictures/old/file)" = "mine
mine" ] && [ ! -e run ] || fail "options: something was written"
expect "the command line is the user's" 0 "$talus" run case.yaml --out run --quiet -snes_view :view.txt -ksp_type preonly
says view.txt "SNES Object"
lacks run/case.yaml "snes_view"

# Files of options in the working directory
for rc in petscrc .petscrc; do
  echo '-snes_view :PWNED' >$rc
  harmless "$rc" 0 "$talus" run case.yaml --out run --force --quiet
  says err.txt "warning: $rc is not read" "belong on the command line or in \$PETSC_OPTIONS" "-options_file $rc reads this one"
  echo '-snes_view :view2.txt' >$rc
  expect "-options_file $rc" 0 "$talus" run case.yaml --out run --force --quiet -options_file $rc
  [ -s view2.txt ] && [ ! -s err.txt ] || fail "-options_file: it was not read"
  rm -f $rc view2.txt
done
PETSC_OPTIONS='-snes_view :view3.txt' expect "PETSC_OPTIONS" 0 "$talus" run case.yaml --out run --force --quiet
[ -s view3.txt ] || fail "$name: it was not read"

# Mesh scripts
command -v gmsh >/dev/null || { echo "no gmsh here: skipped"; finish; }
plate 1
cp plate.geo good.geo
# acts NAME LINE PLACE: the script with this line at its end is refused at the place, and does it under --trust.
acts() {
  cp good.geo plate.geo
  printf '%s\n' "$2" >>plate.geo
  harmless "$1" 2 "$talus" check case.yaml
  says err.txt "/plate.geo:$3: error: this " "--trust on the command line lets it"
  timeout 20 "$talus" check case.yaml --trust >out.txt 2>err.txt </dev/null
  [ -e PWNED ] || fail "$1, trusted: it did not act"
  rm -rf PWNED
}
acts "system call" 'SystemCall "touch PWNED";' 9:1
acts "background" 'NonBlockingSystemCall "touch PWNED; sleep 0.1";' 9:1
acts "made of a text" 'S2N[StrCat("System", "Call")] "touch PWNED";' 9:1
acts "print" 'Printf("x") > "PWNED";' 9:13
acts "save" 'Save "PWNED";' 9:1
acts "folder" 'CreateDir "PWNED";' 9:1
acts "quote in a branch" "$(printf "If (0)\n a = \"x\"; E\" EndIf; SystemCall 'touch PWNED'; \"\nEndIf")" 10:21
cp good.geo plate.geo
mkdir -p deep && printf 'SystemCall "touch PWNED";\n' >deep/c.geo && printf 'Include "c.geo";\n' >deep/b.geo
printf 'Include "deep/b.geo";\n' >>plate.geo
harmless "included" 2 "$talus" run case.yaml --out run3
says err.txt "/deep/c.geo:1:1: error: this runs a program"
cp good.geo plate.geo
printf 'SystemCall "touch PWNED";\n' >plate.geo.opt
harmless "options beside the script" 2 "$talus" check case.yaml
says err.txt "/plate.geo.opt:1:1: error: this runs a program"
rm plate.geo.opt
sed 's/method: fem/method: mpm/; s/^grid:.*/grid: {box: {min: [0, 0], max: [4, 2]}, size: 0.5}/; s/region: plate/mesh: plate.geo/; /^boundary/,/^measures/d; /hold\|pull/d' case.yaml >body.yaml
printf 'boundary: [{name: wall, on: {x: 0}, fix: [x, y]}]\nmeasures:\n  tip: {displacement: y, of: {tracer: [2, 0.5]}}\n' >>body.yaml
grep -v '^  tip: .*3, 1' body.yaml >b.yaml && mv b.yaml body.yaml
printf 'SystemCall "touch PWNED";\n' >>plate.geo
harmless "mesh of a body" 2 "$talus" check body.yaml
says err.txt "/plate.geo:9:1: error: this runs a program"
harmless "two ranks" 2 on_ranks 2 "$talus" run case.yaml --out run2
[ "$(grep -c 'runs a program' err.txt)" = 1 ] || fail "$name: not said once"
expect "run of a trusted script" 0 "$talus" run case.yaml --out trusted --quiet --trust
[ -e PWNED ] || fail "$name: it did not act"
rm PWNED
lacks trusted/case.yaml trust
harmless "what was run with trust, without" 2 "$talus" check trusted/case.yaml
harmless "parameter that is an option" 2 "$talus" check case.yaml --set 'grid.parameters={-merge: 1}'
says err.txt "the name '-merge' begins with"
cp good.geo plate.geo
printf '// SystemCall "x"; Save "y";\nPrintf("SystemCall");\n' >>plate.geo
expect "words in comments and texts" 0 "$talus" run case.yaml --out words --quiet

for command in run check verify; do
  expect "$command --help" 0 "$talus" $command --help
  says out.txt "--trust" "SystemCall"
done
finish
