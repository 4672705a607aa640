#!/bin/sh
# A disk that fills and an output directory that vanishes in mid-run: one clear message, and when the trouble is over the run goes on to the same bits.
. "$(dirname "$0")/library.sh"
block | sed 's/end: 0.4/end: 0.2/; s/every: 0.1/every: 0.02/' >block.yaml
options="--quiet --set checkpoint.steps=10"
# shellcheck disable=SC2086 # options are words
expect "whole" 0 "$talus" run block.yaml --out whole $options
expect "whole on 2" 0 mpiexec --oversubscribe -n 2 "$talus" run block.yaml --out whole2 $options

# same WHOLE RUN
same() {
  for file in $(cd "$1" && ls history.csv *.hdf *.hdf.series); do
    cmp -s "$1/$file" "$2/$file" || fail "$name: $file differs"
  done
  if ls "$2"/*unfinished >/dev/null 2>&1; then fail "$name: an unfinished file"; fi
}

# The directory becomes read-only in mid-run. Root needs no permissions, so it is made immutable; a remount would be refused while files are open.
read_only() {
  name="read-only, one rank"
  rm -rf run
  # shellcheck disable=SC2086
  "$talus" run block.yaml --out run $options >out.txt 2>err.txt </dev/null &
  job=$!
  for i in $(seq 2000); do [ -e run/checkpoint_000000010.h5 ] && break; sleep 0.01; done
  chattr +i run
  wait "$job"
  code=$?
  chattr -i run
  [ $code -eq 1 ] || fail "$name: exit code $code"
  says err.txt "cannot write the state at t = " "Operation not permitted" "talus run --resume run goes on from step"
  expect "$name, resumed" 0 "$talus" run --resume run --quiet
}
mkdir immutable
if chattr +i immutable 2>/dev/null && ! touch immutable/file 2>/dev/null; then
  read_only
  same whole run
else echo "no directory can be made immutable here: skipped"
fi
chattr -i immutable 2>/dev/null

# The directory is renamed while the run is at work: it says so, and goes on where it was when the directory is back
renamed() {
  ranks=$1
  name="renamed, $ranks ranks"
  rm -rf away run
  # shellcheck disable=SC2086
  if [ "$ranks" -eq 1 ]; then "$talus" run block.yaml --out run $options >out.txt 2>err.txt </dev/null &
  else mpiexec --oversubscribe -n "$ranks" "$talus" run block.yaml --out run $options >out.txt 2>err.txt </dev/null &
  fi
  job=$!
  for i in $(seq 2000); do [ -e run/checkpoint_000000010.h5 ] && break; sleep 0.01; done
  mv run away
  wait "$job"
  [ $? -eq 1 ] || fail "$name: exit code"
  says err.txt "the run directory run was removed, renamed or replaced" "talus run --resume run goes on from step"
  mv away run
  expect "$name, resumed" 0 on_ranks "$ranks" "$talus" run --resume run --quiet
}
renamed 1
same whole run
renamed 2
same whole2 run

# A full disk, where one may be mounted
mkdir disk
if ! unshare -m mount -t tmpfs -o size=8k tmpfs disk 2>/dev/null; then
  echo "no disk can be mounted here: skipped"
  finish
fi
# In a name space of its own: a run on a disk of size $1, and again on a larger one.
cat >filled.sh <<'END'
size=$1 ranks=$2 talus=$3
prefix=
[ "$ranks" -eq 1 ] || prefix="mpiexec --oversubscribe -n $ranks"
mount -t tmpfs -o size=$size tmpfs disk || exit 99
$prefix "$talus" run block.yaml --out disk/run --quiet --set checkpoint.steps=10 >first.txt 2>&1 </dev/null
echo $? >first_code.txt
$prefix "$talus" run --resume disk/run --quiet >second.txt 2>&1 </dev/null
echo $? >second_code.txt
mount -o remount,size=100m disk || exit 99
$prefix "$talus" run --resume disk/run --quiet
code=$?
rm -rf left
cp -r disk/run left
exit $code
END
filled() {
  expect "disk of $1, $2 ranks" 0 unshare -m sh filled.sh "$1" "$2" "$talus"
  [ "$(cat first_code.txt)" -eq 1 ] || fail "$name: exit code $(cat first_code.txt) when the disk was full"
  [ "$(cat second_code.txt)" -ne 0 ] || fail "$name: it went on with a full disk"
  grep -q 'No space left on device' first.txt || { fail "$name: the reason is not said"; cat first.txt; }
  if grep -q 'PETSC ERROR' first.txt second.txt; then fail "$name: a trace"; fi
}
for size in 1200k 2000k 3000k; do
  filled $size 1
  same whole left
done
filled 2500k 2
same whole2 left
# Room for all but the checkpoints: the run tells of it and goes on
cat >tight.sh <<'END'
mount -t tmpfs -o size=860k tmpfs disk && "$@" && cp -r disk/run tight
END
expect "no room for checkpoints" 0 unshare -m sh tight.sh "$talus" run block.yaml --out disk/run --quiet --set checkpoint.steps=10 \
  --set output.grid=false --set output.every=end --set 'checkpoint.keep=9' --set 'output.history={steps: 10}'
says tight/log.txt "warning = cannot write the checkpoint at step" "No space left on device"
ls tight/checkpoint_*.h5 >/dev/null || fail "$name: the checkpoints that fitted are gone"
finish
