#!/bin/sh
# The command line: help, mistakes with the nearest word, options, exit codes.
. "$(dirname "$0")/library.sh"
cantilever >case.yaml

expect "help" 0 "$talus" --help
says out.txt "usage: talus COMMAND" "Exit codes: 0 done, 1 the solver gave up, 2 bad input or usage, 3 a verification"
commands=$(sed -n '/^commands:/,/^$/s/^  \([a-z]*\) .*/\1/p' out.txt)
[ "$(echo $commands)" = "run check init import list schema verify sweep calibrate element plot compare version completion help" ] || fail "help: commands are '$commands'"
for command in $commands; do
  expect "$command --help" 0 "$talus" $command --help
  says out.txt "usage: talus $command" "options:" "--help"
  case $command in run | list | plot | help) ;; *) continue ;; esac # one way to read options for all
  expect "$command --hlep" 2 "$talus" $command --hlep
  says err.txt "option --hlep is not known" "did you mean --help?"
  [ ! -s out.txt ] || fail "$name: something on standard output"
done
expect "nothing" 2 "$talus"
says err.txt "usage: talus COMMAND"
expect "unknown command" 2 "$talus" rnu case.yaml
says err.txt "'rnu' is no command" "did you mean 'talus run'?"
expect "case as a command" 2 "$talus" case.yaml
says err.txt "to run a case: talus run case.yaml"
expect "no case" 2 "$talus" run
says err.txt "there is no CASE on the command line" "usage: talus run CASE"
expect "two cases" 2 "$talus" run case.yaml b.yaml
says err.txt "'b.yaml' is one word too many"
expect "unknown option" 2 "$talus" run case.yaml --otu x
says err.txt "option --otu is not known" "did you mean --out?"
expect "no value" 2 "$talus" run case.yaml --out
says err.txt "option --out needs a value"
expect "value of a flag" 2 "$talus" run case.yaml --quiet=yes
says err.txt "option --quiet takes no value"
expect "single dash" 2 "$talus" run case.yaml -out x
says err.txt "did you mean --out?"
expect "version" 0 "$talus" --version
says out.txt "talus 0." "PETSc 3." "MPI " "HDF5 "

# Lists and the schema
for list in laws:neo-hookean methods:fem cells:hexahedron measures:angular_momentum fields:deformation_gradient; do
  expect "list ${list%:*}" 0 "$talus" list "${list%:*}"
  says out.txt "${list#*:}"
done
expect "list of nothing" 2 "$talus" list field
says err.txt "did you mean 'fields'?"
expect "schema" 0 "$talus" schema
says out.txt "points_per_cell" "kg/m3"
expect "schema as JSON" 0 "$talus" schema --json
says out.txt '"$schema"' '"kinematics"' '"plane-strain"'
if command -v python3 >/dev/null; then python3 -m json.tool out.txt >/dev/null || fail "schema: no JSON"; fi
expect "schema twice" 2 "$talus" schema --json --markdown

# check: the resolved case is a case, and says the same of itself
expect "check" 0 "$talus" check case.yaml
says out.txt "nodes, from (0, -1.5) to (8.5, 1.5) m" "memory: about" "body beam: 128 points in 32 cells, volume 8 m3, mass 8000 kg" "boundary left:"
cp out.txt resolved.yaml
expect "check what check said" 0 "$talus" check resolved.yaml
grep -v '^#' resolved.yaml >a.txt
grep -v '^#' out.txt >b.txt
cmp -s a.txt b.txt || fail "$name: it changed"
says out.txt "#   basis: cell"
expect "check of a case without a basis" 0 "$talus" check case.yaml --set 'basis={}'
says out.txt "#   basis: gimp, the default of mpm; basis: {cell: {}} is the thesis's" "  gimp:"
expect "a run without a basis" 0 "$talus" run case.yaml --set 'basis={}' --set grid.cell=triangle --set 'bodies[0].points_per_cell=3' --quiet --out without
says without/log.txt "basis = cell, since gimp, the default of mpm, needs a box of quadrilaterals or hexahedra"
says without/case.yaml "  cell: {}"
expect "check of what has no room" 0 env TALUS_MEMORY=0.04 "$talus" check case.yaml
says err.txt "the run will need about 0.0" "GB of memory, and there are 0.04 GB"
expect "room in words" 0 on_ranks 2 env TALUS_MEMORY=16GB "$talus" check case.yaml
[ "$(grep -c "warning: TALUS_MEMORY is '16GB', and counts for nothing: it must be a number > 0, in GB" err.txt)" -eq 1 ] || fail "$name: not told once"
no_room="TALUS_MEMORY=1e-6 $talus run case.yaml --set petsc.ksp_max_it=1 --set analysis.steps=1 --out small --quiet"
expect "no factorisation without room" 1 env $no_room --set linear=iterative
says err.txt "the linear iteration failed, and a factorisation needs more memory than there is"
expect "a factorisation that was asked for" 0 env $no_room --set linear=direct --force
says small/log.txt "linear = direct"
expect "iterates without room" 0 env TALUS_MEMORY=1e-6 "$talus" run case.yaml --out small --quiet --force
says small/log.txt "linear = conjugate gradients, two levels of the box"
cat >cost.yaml <<'EOF'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.1, step: 0.002}
grid: {box: {min: [-0.5, -0.5], max: [1.5, 1.5]}, size: 0.03125}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}}
loads: {gravity: [0, -9.81]}
EOF
# What explicit steps cost is one number, whichever the file has; and what runs took, measured as the largest resident memory.
for way in "dynamic 0.0008 cheaper than" "dynamic 0.006 dearer than" "dynamic 0.002 about as dear as" "explicit 0.002 about as dear as"; do
  type=${way%% *} step=${way#* }
  expect "price of $type, $step" 0 "$talus" check cost.yaml --set analysis.type=$type --set "analysis.step=${step%% *}"
  says out.txt "${step#* } an implicit step"
done
expect "a run that logs its price" 0 "$talus" run cost.yaml --set analysis.end=0.0008 --set analysis.step=0.0008 --out cost --quiet --force
says cost/log.txt "cheaper than an implicit step"
# Grains cost iterations the more the stiffer they are
for way in "mohr-coulomb about as dear as" "neo-hookean dearer than"; do
  law=${way%% *} more=
  [ $law = neo-hookean ] || more=', friction_angle: 30, cohesion: 0'
  expect "price of stiff $law" 0 "$talus" check cost.yaml --set analysis.step=0.006 --set "materials.m={law: $law, density: 1000, young: 1e7, poisson: 0.3$more}"
  says out.txt "${way#* } an implicit step"
done
takes() { awk -v mb="$1" '/memory: about/ { m = $4 } END { exit !(m > mb / 1.3 && m < 1.3 * mb) }' out.txt || fail "$name: $(grep memory out.txt) for $1"; }
in_space="--set kinematics=3d --set loads.gravity=[0,-9.81,0]"
expect "memory of gmm" 0 "$talus" check cost.yaml $in_space --set method=gmm --set 'grid={box: {min: [0, 0, 0], max: [1, 1, 1]}, counts: [10, 10, 10]}' --set 'bodies[0].shape={box: {min: [0, 0, 0], max: [1, 1, 1]}}'
takes 144
# Nodes that see many fill a factor more than cells do, and no more levels of multigrid
for row in "gmm 10 direct 290" "gmm 15 iterative 480" "mpm 15 direct 391"; do
  set -- $row
  expect "memory of statics, $row" 0 "$talus" check cost.yaml $in_space --set 'analysis={type: static, steps: 1}' --set method=$1 --set "grid={box: {min: [0, 0, 0], max: [1, 1, 1]}, counts: [$2, $2, $2]}" \
    --set linear=$3 --set 'bodies[0].shape={box: {min: [0, 0, 0], max: [1, 1, 1]}}' --set 'boundary=[{on: {z: 0}, fix: [x, y, z]}]'
  takes $4
done
for type in "dynamic 459" "explicit 156"; do
  expect "memory of mpm, $type" 0 "$talus" check cost.yaml $in_space --set 'grid={box: {min: [-0.1, -0.1, 0], max: [1.1, 1.1, 1.1]}, size: 0.05}' --set 'bodies[0].shape={box: {min: [0, 0, 0], max: [1, 1, 1]}}' \
    --set 'analysis.step=0.0001' --set "analysis.type=${type% *}"
  takes ${type#* }
done
block >block.yaml
expect "an iteration that gets nowhere gives way to a factorisation" 0 timeout 60 "$talus" run block.yaml --set petsc.ksp_atol=1e300 --set analysis.end=0.01 --out block --quiet
says block/log.txt "halvings = 0"
expect "a key left out on the command line" 0 "$talus" check case.yaml --set 'basis={bspline: {}}' --set basis=null
expect "one that must be there" 2 "$talus" check case.yaml --set materials=null
says err.txt "key 'materials'" "is missing"
expect "check of a mistake" 2 "$talus" check case.yaml --set materials.rubber.yung=1
says err.txt "--set materials.rubber.yung=1: error: key 'yung' of materials.rubber is not known"
[ ! -e runs ] || fail "check wrote something"
expect "one point in a cell" 0 "$talus" check case.yaml --set 'bodies[0].points_per_cell=1'
says err.txt "warning: with one point in each quadrilateral of 'beam' nothing resists its hourglass motions" "use 4 points, or triangles"
expect "one point in a triangle" 0 "$talus" run --quiet --out single case.yaml --set 'bodies[0].points_per_cell=1' --set grid.cell=triangle
[ ! -s err.txt ] || fail "$name: a warning"
incompressible="--set formulation=mixed --set materials.rubber.law=neo-hookean-split --set materials.rubber.poisson=0.5"
expect "an incompressible body in dynamics" 0 "$talus" check case.yaml $incompressible --set 'analysis={type: dynamic, end: 1, step: 0.01}'
says err.txt "warning: material 'rubber' is exactly incompressible: without numerical damping its pressure" "bossak: -0.1"
expect "damped" 0 "$talus" check case.yaml $incompressible --set 'analysis={type: dynamic, end: 1, step: 0.01, bossak: -0.1}'
[ ! -s err.txt ] || fail "$name: a warning"

# Options of run
expect "run" 0 "$talus" run case.yaml
[ -s runs/case/history.csv ] || fail "run: no runs/case"
says out.txt "method = mpm" "step = 1 time = 1 " "tip = -0.5996591864 m" "weight = 78480 N"
expect "quiet" 0 "$talus" run case.yaml --out quiet --quiet --log here.txt
[ ! -s out.txt ] && [ ! -s err.txt ] || fail "quiet: it speaks"
says here.txt "tip = -0.5996591864 m"
[ ! -e quiet/log.txt ] || fail "--log: log.txt is there too"
expect "set" 0 "$talus" run case.yaml --out set --quiet --set materials.rubber.young=180e6 --set 'measures.tip.of.tracer=[8, 1]'
says set/case.yaml "young: 1.8e+08"
expect "one run alone" 2 "$talus" compare set
says err.txt "there is no second RUN_DIR on the command line"
expect "set nothing" 2 "$talus" run case.yaml --set grid.size
says err.txt "there is no '='"
expect "options of PETSc" 0 "$talus" run case.yaml --out monitor --quiet -snes_monitor
says out.txt "0 SNES Function norm"
expect "options of PETSc before the command" 0 "$talus" -snes_monitor run case.yaml --out monitor --quiet --force
says out.txt "0 SNES Function norm"
expect "options of PETSc in the case" 0 "$talus" run case.yaml --out monitor --quiet --force --set petsc.snes_monitor=true
says out.txt "0 SNES Function norm"
expect "a misspelled option of PETSc" 0 "$talus" run case.yaml --out monitor --quiet --force -snes_monitr
says err.txt "warning: nothing in this run asked for the PETSc option -snes_monitr"
[ "$(grep -c warning err.txt)" = 1 ] || fail "$name: more than one warning"
expect "a misspelled option in the case" 2 "$talus" run case.yaml --out monitor --quiet --force --set petsc.snes_monitr=true
says err.txt "petsc.snes_monitr=true: error: a case file may not set the PETSc option 'snes_monitr'" "did you mean 'snes_monitor'?"
expect "an idle option in the case" 0 "$talus" run case.yaml --out monitor --quiet --force --set petsc.pc_gamg_threshold=0.1
says err.txt "petsc.pc_gamg_threshold=0.1: warning: nothing in this run asked for the PETSc option -pc_gamg_threshold"
expect "the command line wins" 2 "$talus" run case.yaml --out monitor --quiet --force --set petsc.ksp_type=preonly -ksp_type nonsense
says err.txt "nonsense"
expect "a formula without a value" 0 "$talus" run case.yaml --out none --quiet --set 'measures.none={formula: sqrt(-1)}'
says err.txt "'none' is empty (nan) at the end: its formula has no value there"
lacks none/history.csv "-nan"
expect "a formula without bounds" 0 "$talus" run case.yaml --out infinite --quiet --set 'measures.most={formula: -log(0)}'
says err.txt "'most' is infinite at the end: its formula divides by nothing"
expect "solver gives up" 1 "$talus" run case.yaml --out soft --quiet --set newton.max_iterations=1
says err.txt "case.yaml: error: the run gave up: Newton did not converge" "is kept in soft"
says soft/log.txt "gave up = Newton did not converge"
[ "$(wc -l <soft/history.csv)" -ge 2 ] && [ -s soft/points.hdf.series ] || fail "$name: the state is not there"
expect "point leaves the grid" 1 "$talus" run case.yaml --out lost --quiet --set grid.box.min='[0, -0.5]' --set materials.rubber.young=30e6
says err.txt "left the grid: point" "with velocity" "outside: remove"

# A reader that goes away
"$talus" list fields | head -n 1 >out.txt 2>err.txt
"$talus" run case.yaml --out pipe 2>err.txt | head -n 1 >out.txt
name="a pipe that closes"
[ ! -s err.txt ] || fail "$name: it complains"

# What cannot be written was not said
if [ -c /dev/full ]; then
  for words in "schema" "list laws" "check case.yaml" "help" "run --help" "completion bash" "version"; do
    name="$words on a full disk"
    "$talus" $words >/dev/full 2>err.txt
    [ $? -eq 1 ] || fail "$name: exit code"
    says err.txt "error: what is printed could not be written"
  done
  name="a run on a full terminal"
  "$talus" run case.yaml --out full >/dev/full 2>err.txt || fail "$name: exit code $?"
  says err.txt "warning: what is printed could not be written"
fi

# A process that no launcher started begins no daemon and keeps no folder of MPI's.
name="alone"
mkdir for_mpi
env -u OMPI_MCA_ess_singleton_isolated -u OMPI_MCA_pml -u OMPI_MCA_btl OMPI_MCA_orte_tmpdir_base="$PWD/for_mpi" \
  "$talus" run case.yaml --out alone --quiet 2>err.txt >out.txt || fail "$name: it does not run"
[ -z "$(ls for_mpi)" ] || fail "$name: a folder of MPI's is left"

# A processor that is newer than OpenBLAS has not the kernels of one of 2004.
name="kernels of OpenBLAS"
OPENBLAS_VERBOSE=2 "$talus" --version 2>&1 | grep '^Core:' | tail -n 1 >core.txt
if grep -q '^flags.* avx2' /proc/cpuinfo; then lacks core.txt "Prescott"; fi

finish
