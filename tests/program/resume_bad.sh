#!/bin/sh
# What may be wrong with a checkpoint, a run directory or a command line when a run is to go on.
compare="$(cd "$(dirname "$0")" && pwd)/compare.awk"
. "$(dirname "$0")/library.sh"
block | sed 's/end: 0.4/end: 0.08/; s/every: 0.1/every: 0.02/; s/size: 0.05/size: 0.1/' >block.yaml
expect "whole" 0 "$talus" run block.yaml --out whole --quiet --set output.grid=true --set checkpoint.steps=10 --set checkpoint.keep=3 --set newton.residual=1e-11 # ranks agree as far as Newton goes
[ "$(ls whole/checkpoint_*.h5 | wc -l)" -eq 3 ] || fail "keep: not three checkpoints"
newest=checkpoint_000000040.h5 older=checkpoint_000000030.h5

# same NAME: the run in cut/ ended as the whole one did.
same() {
  cmp -s whole/history.csv cut/history.csv || fail "$1: another history"
  for file in $(cd whole && ls *.hdf *.series); do cmp -s whole/$file cut/$file || fail "$1: $file differs"; done
}

# Damage of every kind: the older one is used, with a warning, and the damaged one is set aside
damaged() {
  expect "$1" 0 "$talus" run --resume cut
  says cut/log.txt "warning = the checkpoint cut/$newest cannot be used: $2" "resumed = step 30"
  says out.txt "warning = the checkpoint"
  [ -e cut/$newest.damaged ] || fail "$1: the damaged one is gone"
  same "$1"
  rm -r cut
}
cp -r whole cut
size=$(wc -c <cut/$newest)
printf '\377' | dd of=cut/$newest bs=1 seek=$((size - 3000)) conv=notrunc 2>/dev/null
damaged "a wrong byte" "the checksum of "
cp -r whole cut
printf '7' | dd of=cut/$newest bs=1 seek=60 conv=notrunc 2>/dev/null
damaged "a wrong byte in the contents" "the checksum of its contents is wrong"
cp -r whole cut
head -c $((size - 100)) whole/$newest >cut/$newest
damaged "cut off" "it is $((size - 100)) bytes long and should have $size"
cp -r whole cut
head -c 300 whole/$newest >cut/$newest
damaged "cut off in the contents" "its contents are cut off"
cp -r whole cut
: >cut/$newest
damaged "empty" "it is no checkpoint of talus"
cp -r whole cut
rm cut/$newest && mkdir cut/$newest
damaged "a folder" "Is a directory"
cp -r whole cut
dd if=/dev/zero of=cut/$newest bs=$size count=1 2>/dev/null
damaged "zeros" "it is no checkpoint of talus"

# None is whole: from the start, and to the same end. Two ranks agree on that too.
cp -r whole cut
for file in cut/checkpoint_*.h5; do echo 'talus checkpoint' >$file; done
mv cut/timings.txt kept.txt
expect "all damaged" 0 "$talus" run --resume cut --quiet
says cut/log.txt "the run starts again"
same "all damaged"
rm cut/checkpoint_* cut/timings.txt
expect "none there, two ranks" 0 mpiexec --oversubscribe -n 2 "$talus" run --resume cut --quiet
says cut/log.txt "the run starts again"
awk -f "$compare" whole/history.csv cut/history.csv || fail "$name: differs"

# A run that is complete stays so
cp -r whole again
expect "complete" 0 "$talus" run --resume again --quiet
rm -r cut && mv again cut
same "complete"
rm cut/checkpoint_*
cp -r cut kept
expect "complete, no checkpoint" 0 "$talus" run --resume cut
says err.txt "warning: the run in 'cut' is complete and has left no checkpoint: there is nothing to resume"
rm cut/log.txt kept/log.txt
diff -r cut kept || fail "$name: something changed"
rm -r kept

# A later end: as if it had been asked for at once
expect "longer" 0 "$talus" run block.yaml --out longer --quiet --set output.grid=true --set analysis.end=0.12 --set checkpoint.steps=10 --set newton.residual=1e-11
rm -r cut && cp -r whole cut
expect "a later end" 0 "$talus" run --resume cut --quiet --set analysis.end=0.12
awk -f "$compare" longer/history.csv cut/history.csv || fail "$name: differs"
says cut/case.yaml "end: 0.12"
[ "$(grep -c '"name"' cut/points.hdf.series)" -eq 7 ] || fail "$name: states"

# A run that ended before its first checkpoint was due leaves one of its end, too: to the last bit the run that had the later end from the start
sed 's/end: 0.08/end: 0.12/' block.yaml >later.yaml
expect "short" 0 "$talus" run block.yaml --out short --quiet
expect "complete, with its checkpoint" 0 "$talus" run --resume short --quiet
says err.txt "warning: the run in 'short' is complete at t = 0.08 s: there is nothing left to do" "--set analysis.end=..."
lacks short/log.txt "linear =  unknowns"
expect "short goes on" 0 "$talus" run --resume short --quiet --set analysis.end=0.12
[ ! -s err.txt ] || fail "$name: it complains"
expect "later from the start" 0 "$talus" run later.yaml --out later --quiet
for file in $(cd later && ls history.csv *.hdf *.series); do cmp -s later/$file short/$file || fail "$name: $file differs"; done
expect "an earlier end" 2 "$talus" run --resume short --set analysis.end=0.1
says err.txt "the run in 'short' has come to t = 0.12 s already, later than analysis.end = 0.1 s"
grep -q "end: 0.12 " short/case.yaml || fail "$name: the case has changed"
expect "without checkpoints" 0 "$talus" run block.yaml --out bare --quiet --set checkpoint.minutes=0
ls bare/checkpoint_* >/dev/null 2>&1 && fail "$name: there is one"
expect "a later end without a checkpoint" 2 "$talus" run --resume bare --quiet --set analysis.end=0.12
says err.txt "is complete at t = 0.08 s and has left no checkpoint from which it could go on to 0.12 s" "talus run bare/case.yaml --out ANOTHER --set analysis.end=0.12"
cantilever >beam.yaml
expect "statics" 0 "$talus" run beam.yaml --out beam --quiet
expect "a later end in statics" 2 "$talus" run --resume beam --quiet --set analysis.end=2
says err.txt "a static run cannot go on to another end than its own, 1 s" "talus run beam/case.yaml --out ANOTHER"
expect "more steps in statics" 2 "$talus" run --resume beam --quiet --set analysis.steps=2
says err.txt "a resumed run cannot change analysis.steps" "for all else start a new run"
expect "nothing to do in statics" 0 "$talus" run --resume beam --quiet
says err.txt "there is nothing left to do"

# What makes no sense is said, and nothing is touched
rm -r cut && cp -r whole cut
expect "another material" 2 "$talus" run --resume cut --set materials.rubber.young=1e6
says err.txt "a resumed run cannot change materials.rubber.young" "checkpoint, newton"
expect "another material of no run" 2 "$talus" run --resume nowhere --set materials.rubber.young=1e6
says err.txt "there is no run to resume in 'nowhere'"
lacks err.txt "cannot change"
expect "with a case" 2 "$talus" run block.yaml --resume cut
says err.txt "--resume goes on in DIR"
expect "with a directory" 2 "$talus" run --resume cut --out other
expect "nothing" 2 "$talus" run
says err.txt "there is no CASE on the command line"
expect "nowhere" 2 "$talus" run --resume nowhere
says err.txt "there is no run to resume in 'nowhere'"
mkdir empty && cp block.yaml empty/case.yaml
expect "a case, no run" 2 "$talus" run --resume empty
says err.txt "there is no run to resume in 'empty'"
sed -i 's/young: 200000/young: 300000/; s/young: 2e+05/young: 300000/' cut/case.yaml
expect "another case.yaml" 2 "$talus" run --resume cut
says err.txt "does not fit: it is of another case than the case.yaml beside it"
cp whole/case.yaml cut/case.yaml
rm cut/log.txt && cp whole/log.txt cut/log.txt
sed -i '20,$d' cut/history.csv
expect "a history that lost rows" 2 "$talus" run --resume cut
says err.txt "history.csv' has lost rows: the one of step 40 is missing"
# A row in the middle, a number that is another one or none: the checkpoint knows better, and the file stays as it is
spoilt() {
  name="a history $1"
  cp whole/history.csv cut/history.csv
  sed -i "$2" cut/history.csv
  cp cut/history.csv kept.csv
  expect "$name" 2 "$talus" run --resume cut
  says err.txt "history.csv' $3" "put the file back as it was"
  cmp -s kept.csv cut/history.csv || fail "$name: it was changed"
}
spoilt "without a middle row" 12d "has lost rows: up to step 40 there are 40, and there were 41"
spoilt "with nan" '12s/[^,]*$/nan/' "is not as the run wrote it: rows up to step 40 have been changed"
spoilt "with another number" '12s/,[^,]*$/,1/' "is not as the run wrote it"
spoilt "with a row twice" 12p "is not as the run wrote it"
cp whole/history.csv cut/history.csv

# Files of states: missing, cut off, changed, and not told one by one when they are many
state_spoilt() {
  name="a state $1"
  cp whole/*.hdf cut
  eval "$2"
  cp cut/history.csv kept.csv
  expect "$name" 2 "$talus" run --resume cut
  says err.txt "$3" "put the files back as they were"
  cmp -s kept.csv cut/history.csv || fail "$name: the history was changed"
}
state_spoilt "that is missing" "rm cut/points_000001.hdf" "cannot go on after 'cut/points_000001.hdf': it is missing"
state_spoilt "of the grid that is missing" "rm cut/grid_000003.hdf" "cannot go on after 'cut/grid_000003.hdf': it is missing"
bytes=$(wc -c <whole/points_000002.hdf)
state_spoilt "cut off" "head -c 3000 whole/points_000002.hdf >cut/points_000002.hdf" "points_000002.hdf': it is 3000 bytes long and was $bytes"
state_spoilt "with a wrong byte" "printf '\\377' | dd of=cut/points_000002.hdf bs=1 seek=$((bytes / 2)) conv=notrunc 2>/dev/null" \
  "points_000002.hdf': it is not as the run wrote it: its checksum is wrong"
state_spoilt "and all others missing" "rm cut/points_*.hdf cut/grid_*.hdf" "10 files of states are missing or damaged in all"
[ "$(grep -c 'it is missing' err.txt)" -eq 3 ] || fail "$name: not three of them are told"
cp whole/*.hdf cut
expect "all put back" 0 "$talus" run --resume cut --quiet
same "all put back"

sed -i '/000002/d' cut/points.hdf.series
expect "a series that lost entries" 2 "$talus" run --resume cut
says err.txt "cannot go on with cut/points.hdf.series: entries are missing"

# Two runs in one directory: the second is refused, by --resume and by --force
block | sed 's/end: 0.4/end: 1000/' >long.yaml
"$talus" run long.yaml --out busy --quiet >/dev/null 2>&1 </dev/null &
job=$!
for i in $(seq 200); do [ -s busy/history.csv ] && break; sleep 0.05; done
expect "resume of a run at work" 2 "$talus" run --resume busy
says err.txt "another run is at work in the output directory 'busy'"
expect "force on a run at work" 2 "$talus" run block.yaml --out busy --force
says err.txt "another run is at work"
kill -TERM $job
wait $job
[ $? -eq 1 ] || fail "the run at work was harmed"
[ "$(ls busy/checkpoint_*.h5 | wc -l)" -eq 1 ] || fail "SIGTERM: no checkpoint"

finish
