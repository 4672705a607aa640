#!/bin/sh
# What a run leaves: every file that the guide promises, readable by others.
source=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/library.sh"
# Three measures: each is a picture in what follows.
block | sed 's/end: 0.4/end: 0.1/; s/every: 0.1/every: 0.02, history: {steps: 5}/
  /^  momentum:/d; /^  turn:/d; /^  kinetic:/d; /^  elastic:/d; /^  external:/d' >block.yaml
expect "run" 0 on_ranks 2 "$talus" run block.yaml --out run
cp out.txt screen.txt
for file in case.yaml log.txt version.txt timings.txt history.csv points.hdf.series grid.hdf.series; do
  [ -s run/$file ] || fail "run: no $file"
done
if ls run | grep -q unfinished; then fail "run: an unfinished file"; fi

# History: a row each 5 steps and the last; states at their times
[ "$(sed -n 1p run/history.csv | cut -d, -f1-4)" = 'time [s],step,corner [m],low [m]' ] || fail "history: header"
[ "$(cut -d, -f2 run/history.csv | tr '\n' ' ')" = 'step 0 5 10 15 20 25 30 35 40 45 50 ' ] || fail "history: rows"
[ "$(tail -n 1 run/history.csv | cut -d, -f1 | cut -c1-3)" = 0.1 ] || fail "history: the last row"
[ "$(grep -c '"name"' run/points.hdf.series)" -eq 6 ] || fail "series: states"
for file in $(sed -n 's/.*"name": "\([^"]*\)".*/\1/p' run/*.hdf.series); do
  [ "$(dd if=run/$file bs=1 skip=1 count=3 2>/dev/null)" = HDF ] || fail "series: $file is not HDF5"
done
if command -v python3 >/dev/null; then
  for series in run/*.hdf.series; do python3 -m json.tool "$series" >/dev/null || fail "$series: no JSON"; done
fi
if command -v h5dump >/dev/null; then h5dump -H run/points_000005.hdf | grep -q PointData || fail "h5dump: no PointData"; fi

# The log: plain lines that programs can read, the same as on the screen and more
says run/log.txt "method = mpm" "ranks = 2" "step = 50 time = 0.1 " "seconds ="
says screen.txt "step = 50 time = 0.1 "
if grep -q "$(printf '\r')" run/log.txt screen.txt; then fail "log: a carriage return"; fi
[ "$(grep -c '^step = ' run/log.txt)" -eq 50 ] || fail "log: not every step"
says run/version.txt "talus = " "sources = " "petsc = " "mpi = " "ranks = 2"
says run/timings.txt "total [s] = " "linear [s] = "

# The resolved case runs and gives the same
expect "resolved case" 0 on_ranks 2 "$talus" run run/case.yaml --out again --quiet
cmp -s run/history.csv again/history.csv || fail "resolved case: another history"

# Pictures
expect "plot" 0 "$talus" plot run --size 300x200
says out.txt "picture = run/pictures/state_" "picture = run/pictures/history_"
for picture in $(sed -n 's/^picture = //p' out.txt); do
  [ "$(dd if=$picture bs=1 skip=1 count=3 2>/dev/null)" = PNG ] || fail "plot: $picture is no PNG"
done
expect "plot of an unknown field" 2 "$talus" plot run --field stres
says err.txt "stres" "stress"
expect "plot of a plane run turned" 2 "$talus" plot run --turned
says err.txt "'run' is no axisymmetric run: there is nothing to turn"
expect "plot of half and whole" 2 "$talus" plot run --half --turned
says err.txt "a picture shows the one or the other"
expect "plot of two runs" 0 "$talus" plot run again --y corner --y low --legend names --out both.svg
says out.txt "picture = both.svg"
grep -q ">again: corner<" both.svg || fail "plot of two runs: no legend"
expect "plot without a measure" 2 "$talus" plot run again
says err.txt "several runs are drawn with --y MEASURE alone"
expect "plot as a photograph" 2 "$talus" plot run --out run.jpg
says err.txt "no picture is drawn as '.jpg'"
expect "compare" 0 "$talus" compare run again --measure corner --tolerance 0 --out compared
says out.txt "The cases do not differ" "corner [m]" "picture = compared/history_corner.png"
[ "$(sed -n 2p compared/differences.csv | cut -d, -f7)" = 0 ] || fail "compare: the same run differs"

# A value that only one run has is a difference; what searches find is compared whenever they found it
copy_without() { mkdir -p $1 && cp run/case.yaml $1 && awk -F, -v OFS=, -v from=$2 'FNR > from { $3 = "nan" } { print }' run/history.csv >$1/history.csv; }
copy_without lost 8
expect "compare with what was lost" 3 "$talus" compare run lost --measure corner --tolerance 1e-6 --out compared
says out.txt "'corner' has no value in lost from 0.07 to 0.1 s, where run has one"
[ "$(sed -n 2p compared/differences.csv | cut -d, -f7,10-)" = 0,nan,lost,0.07 ] || fail "$name: $(sed -n 2p compared/differences.csv)"
expect "compare what was lost with it" 3 "$talus" compare lost run --measure corner --tolerance 1e-6 --out compared
says out.txt "'corner' has no value in lost from 0.07 to 0.1 s, where run has one"
cp -r lost lost-again
expect "compare what both lost" 0 "$talus" compare lost lost-again --measure corner --tolerance 0 --out compared
lacks out.txt "has no value"
search() { mkdir -p $1 && printf 'time [s],step,limit [],load []\n0,0,nan,0\n1,1,nan,5\n%s\n%s\n' "$2" "$3" >$1/history.csv; }
search early 2,2,nan,10 2,2,10,10 && search late 3,2,nan,10 3,2,10.1,10 && search never 2,2,nan,10 2.5,3,nan,10
expect "compare searches" 0 "$talus" compare early late --measure limit --tolerance 0.011 --out compared
says out.txt "'limit' of late: what each run has found, whenever that was (from 2 to 3 s)" "1.00e-02"
expect "compare searches more closely" 3 "$talus" compare early late --measure limit --tolerance 0.009 --out compared
expect "compare with a search that found nothing" 3 "$talus" compare early never --measure limit --tolerance 1 --out compared
says out.txt "'limit' has no value in never at 2 s, where early has one"
expect "compare searches that found nothing later" 3 "$talus" compare late never --tolerance 1 --out compared
says out.txt "no time at which both have values"
expect "compare with nothing" 2 "$talus" compare run nowhere
says err.txt "there is no run directory 'nowhere'"
expect "plot of nothing" 2 "$talus" plot nowhere
says err.txt "there is no run directory 'nowhere'"


# Nodes of a restored grid have the mean of their points' motion: what the mass matrix gives to those that points hardly
# reach, beside the edges of a brick of two cells, is 1e19 m/s and more
cat >edges.yaml <<'END'
kinematics: 3d
method: mpm
analysis: {type: dynamic, end: 0.02, step: 0.01}
grid: {box: {min: [-0.5, -0.5, -0.5], max: [1.5, 1.5, 1.5]}, size: 0.5}
bodies: [{name: b, shape: {box: {min: [0, 0, 0], max: [1, 1, 1]}}, points_per_cell: 8, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e5, poisson: 0.3}}
boundary: [{on: {z: 0}, fix: [x, y, z]}]
loads: {gravity: [0, 0, -9.81]}
output: {fields: [displacement, velocity, acceleration, mass], every: end}
END
for ranks in 1 3; do
  expect "motion of nodes, $ranks" 0 on_ranks $ranks "$talus" run edges.yaml --out edges$ranks --force --quiet
done
if python3 -c 'import h5py, numpy' 2>/dev/null; then
  PYTHONPATH="$source/python" python3 - edges1 edges3 >out.txt 2>&1 <<'END' || fail "$name: $(tail -n 1 out.txt)"
import sys, numpy, talus
for run in sys.argv[1:]:
    state = talus.Run(run).states[-1]
    points, nodes = state.points, state.grid
    once = numpy.unique(nodes["position"], axis=0, return_index=True)[1] # those of several ranks are there more than once
    for field in "displacement", "velocity", "acceleration":
        most = abs(points[field]).max()
        assert 0.5 * most < abs(nodes[field]).max() < (1 + 1e-12) * most, (run, field, abs(nodes[field]).max(), most)
        lost = abs((points["mass"].reshape(-1, 1) * points[field]).sum(0) - (nodes["mass"].reshape(-1, 1) * nodes[field])[once].sum(0)).max()
        assert lost < 1e-12 * most * points["mass"].sum(), (run, field, lost)
END
fi
finish
