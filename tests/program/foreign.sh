#!/bin/sh
# Directories and files that are not talus's own: neither --force nor a careless --out or --log costs anybody a file.
cases="$(cd "$(dirname "$0")/../../cases" && pwd)"
. "$(dirname "$0")/library.sh"
cantilever >case.yaml
run() { "$talus" run case.yaml --quiet "$@"; }

# untouched NAME CODE COMMAND...: refused, and every file below here but out.txt and err.txt is as it was.
sums() { find . -path ./.mpi -prune -o -path './*.txt' ! -path './*/*' -prune -o \( -type f -o -type l \) -print -exec cksum {} + | sort; }
untouched() {
  sums >"$work.before"
  expect "$@"
  sums >"$work.after"
  cmp -s "$work.before" "$work.after" || fail "$1: files changed: $(diff "$work.before" "$work.after" | head -n 3)"
  rm -f "$work.before" "$work.after"
}

# Somebody's files of names that a run writes
mkdir mine && for f in log.txt timings.txt points_000000.hdf history.csv checkpoint_1.h5 points.hdf.series; do echo mine >mine/$f; done
echo mine >mine/notes.md
for force in "" --force; do
  untouched "files of others $force" 2 run --out mine $force
  says err.txt "the output directory 'mine' holds a " "txt" " and 4 more that are not of a run: they would be overwritten" "made-by-talus.txt"
done
for f in timings.txt points_000000.hdf log.txt; do
  mkdir one && echo mine >one/$f
  untouched "$f, forced" 2 run --out one --force
  says err.txt "holds a $f that is not of a run: it would be overwritten"
  rm -r one
done
mkdir link && ln -s ../mine/notes.md link/log.txt
untouched "a link" 2 run --out link --force
says err.txt "holds a log.txt that is not of a run"
mkdir other && echo mine >other/notes.md
expect "files of other names" 0 run --out other
[ "$(cat other/notes.md)" = mine ] && [ -s other/made-by-talus.txt ] || fail "$name: no signature"

# The case itself
mkdir -p project/sub && cp case.yaml project && ln -s project alias
for out in project "project --force" "./project/ --force" "project/sub/.. --force" "alias --force"; do
  untouched "the case's own directory: $out" 2 "$talus" run project/case.yaml --out $out
  says err.txt "the case 'project/case.yaml' stands in the output directory '${out% --force}': the run would replace it"
done
(cd project && untouched "here" 2 "$talus" run case.yaml --out . --force)
expect "a run" 0 run --out run
untouched "the case of the run itself" 2 "$talus" run run/case.yaml --out run --force
says err.txt "the case 'run/case.yaml' stands in the output directory 'run'"

# What is talus's own goes, and only that
echo mine >run/notes.md && echo mine >run/mesh_1.hdf && mkdir elsewhere && echo mine >elsewhere/state_u.png
ln -s ../elsewhere run/pictures && rm run/log.txt && ln -s ../elsewhere/state_u.png run/log.txt && ln -s ../elsewhere/state_u.png run/old.tmp-unfinished
expect "forced" 0 run --out run --force
[ "$(cat run/notes.md run/mesh_1.hdf elsewhere/state_u.png | tr '\n' ' ')" = "mine mine mine " ] || fail "$name: a file of somebody's is gone"
[ -f run/log.txt ] && [ ! -L run/log.txt ] && [ ! -L run/old.tmp-unfinished ] || fail "$name: links are left"
rm run/made-by-talus.txt
expect "a run of an earlier version" 0 run --out run --force
[ -s run/made-by-talus.txt ] || fail "$name: no signature"

# A run to be resumed that leads elsewhere
echo precious >elsewhere/precious
for f in log.txt history.csv.tmp-unfinished case.yaml.tmp-unfinished; do
  cp -r run led && rm -f led/$f && ln -s ../elsewhere/precious led/$f
  untouched "resumed through a link: $f" 2 "$talus" run --resume led
  says err.txt "'led/$f' is a link or a pipe: the run would write elsewhere"
  rm -r led
done

# Pictures
if command -v gnuplot >/dev/null; then
  cp -r run led && rm -rf led/pictures && ln -s ../elsewhere led/pictures
  untouched "pictures through a link" 2 "$talus" plot led
  says err.txt "'led/pictures' is a link: the pictures would go elsewhere"
  rm led/pictures && mkdir led/pictures
  for f in history_tip history_weight state_displacement_last; do ln -s ../../elsewhere/precious led/pictures/$f.png.tmp-unfinished; done
  expect "pictures" 0 "$talus" plot led --size 300x200
  [ "$(cat elsewhere/precious)" = precious ] || fail "$name: a link was written through"
  rm -r led
fi

# The log
echo 'my notes' >notes
for log in case.yaml notes; do
  untouched "log into $log" 2 run --out logged --log $log
  says err.txt "'$log' is no log of talus: the log would overwrite it" "--log takes the name of a new file"
  rm -rf logged
done
ln -s case.yaml disguise
untouched "log into a link to the case" 2 run --out logged --log disguise
rm -rf logged
expect "log into a file of the run" 2 run --out logged --log logged/history.csv
says err.txt "the run itself writes a file of this name"
rm -rf logged
expect "log" 0 run --out logged --log a.log
expect "log again" 0 run --out logged --force --log a.log
[ "$(grep -c '^talus = ' a.log)" = 1 ] && [ "$(head -n 1 a.log | cut -d ' ' -f 1)" = talus ] || fail "$name: it does not begin with talus"
expect "log to nowhere" 0 run --out logged --force --log /dev/null
expect "log on a full disk" 1 run --out logged --force --log /dev/full
says err.txt "cannot write the log '/dev/full': No space left on device"
says logged/timings.txt "outcome = done"

# A verification
mkdir book tables && cp "$cases/cantilever/case.yaml" "$cases/cantilever/reference.yaml" book
echo mine >tables/verification.md
untouched "tables of others" 2 "$talus" verify book --only convergence --out tables
says err.txt "'tables' holds a verification.md that talus has not written: it would be overwritten"
rm tables/verification.md && echo mine >tables/convergence.png
untouched "figures of others" 2 "$talus" verify book --only convergence --out tables
says err.txt "'tables' holds a convergence.png"
rm -r tables
expect "a verification" 0 "$talus" verify book --only convergence --out tables
[ -s tables/made-by-talus.txt ] && [ -s tables/verification.md ] || fail "$name: no tables"
run=tables/convergence/fem/h_0.5 # the first that is looked at
echo mine >"$run/measured_01.hdf" && rm "$run/made-by-talus.txt"
expect "again, from an earlier version" 0 "$talus" verify book --only convergence --out tables
[ "$(cat "$run/measured_01.hdf")" = mine ] || fail "$name: a file of somebody's is gone"
rm "$run/made-by-talus.txt" "$run/version.txt" && echo mine >"$run/points_000000.hdf"
untouched "into a directory of others" 2 "$talus" verify book --only convergence --out tables
says err.txt "that are not of a run"
finish
