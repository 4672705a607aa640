#!/bin/sh
# The output directory: one that cannot be written or holds a run, a disk that fills. Nothing is lost.
. "$(dirname "$0")/library.sh"
cantilever >case.yaml
block | sed 's/end: 0.4/end: 0.1/' >block.yaml

# A directory that cannot be
: >file
expect "below a file" 2 "$talus" run case.yaml --out file/run
says err.txt "cannot create the output directory 'file/run': Not a directory"
expect "below /proc" 2 "$talus" run case.yaml --out /proc/run
says err.txt "cannot create the output directory '/proc/run'"
expect "a file" 2 "$talus" run case.yaml --out file
says err.txt "'file': Not a directory"
expect "no name" 2 "$talus" run case.yaml --out ''
expect "no log" 2 "$talus" run case.yaml --out no-log --log nowhere/log.txt
says err.txt "cannot write the log file 'nowhere/log.txt': No such file or directory"
[ ! -s file ] && [ ! -e no-log/history.csv ] || fail "$name: something was written"

# A directory that holds a run, and things of the user's own
expect "first run" 0 "$talus" run case.yaml --out run --quiet
echo mine >run/notes.txt
cp -r run kept
expect "second run" 2 "$talus" run case.yaml --out run --set grid.size=0.25
says err.txt "the output directory 'run' already holds a run" "--force"
says err.txt "--resume run goes on with it"
diff -r run kept || fail "second run: the first one was touched"
expect "forced with a mistake" 2 "$talus" run case.yaml --out run --force --set grid.size=0.3
diff -r run kept || fail "a forced run that cannot start destroyed the first one"
expect "forced" 0 "$talus" run case.yaml --out run --force --quiet --set output.grid=false
[ -e run/notes.txt ] && [ ! -e run/grid.hdf.series ] || fail "forced: wrong files"
mkdir own && echo 'my: own' >own/case.yaml
expect "the user's own case" 2 "$talus" run case.yaml --out own
says err.txt "holds a case.yaml that is not of a run"
[ "$(cat own/case.yaml)" = 'my: own' ] || fail "the user's case is lost"

# A limit on the size of files stops the states, not the program
(trap '' XFSZ; ulimit -f 100; "$talus" run block.yaml --out limited --quiet >out.txt 2>err.txt; echo $? >code.txt)
name="size limit"
[ "$(cat code.txt)" -eq 2 ] || fail "$name: exit code $(cat code.txt)"
says err.txt "cannot write the state at t = 0 s: File too large"
[ -z "$(ls limited)" ] || fail "$name: files are left"

# A full disk, where one may be mounted (in a name space of its own: it goes with the process)
mkdir disk
if ! unshare -m mount -t tmpfs -o size=8k tmpfs disk 2>/dev/null; then
  echo "no disk can be mounted here: skipped"
  finish
fi
# on_disk SIZE COMMAND...: with a disk of this size at disk/; what it holds in the end is copied to left/.
on_disk() {
  rm -rf left
  unshare -m sh -c 'mount -t tmpfs -o size=$0 tmpfs disk && { "$@"; code=$?; cp -r disk left; exit $code; }' "$@"
}
for size in 4k 8k 16k; do
  expect "disk of $size" 2 on_disk $size "$talus" run block.yaml --out disk/run --quiet
  says err.txt "block.yaml: error: cannot write" "No space left on device"
  [ -z "$(ls left/run)" ] || fail "$name: files are left"
done
expect "disk that fills with states" 1 on_disk 1400k "$talus" run block.yaml --out disk/run --quiet --set output.every=0.01
says err.txt "block.yaml: error: cannot write the state at t = 0." "No space left on device"
says left/run/log.txt "error = cannot write the state at t = 0."
[ "$(grep -c '"name"' left/run/points.hdf.series)" -eq "$(ls left/run/points_*.hdf | wc -l)" ] || fail "$name: the series is off"
if ls left/run/*unfinished >/dev/null 2>&1; then fail "$name: an unfinished file"; fi
[ "$(tail -n 1 left/run/history.csv | cut -d, -f2)" -ge 5 ] || fail "$name: the last row is missing"
expect "disk that fills with rows" 1 on_disk 20k "$talus" run block.yaml --out disk/run --quiet --set output.every=end
says err.txt "block.yaml: error: cannot write disk/run/history.csv: No space left on device"
awk -F, 'NF != 10 || $10 == "" { print "row " NR " is broken: " $0; bad = 1 } END { exit bad }' left/run/history.csv ||
  fail "$name: a broken row"
expect "full disk on two ranks" 1 on_disk 1400k mpiexec --oversubscribe -n 2 "$talus" run block.yaml --out disk/run --quiet --set output.every=0.01
[ "$(grep -c 'No space left' err.txt)" -eq 1 ] || fail "$name: the error is not printed once"

finish
