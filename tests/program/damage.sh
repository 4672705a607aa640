#!/bin/sh
# A damaged file of a run: `talus plot` names it and says what is wrong, exits with 2, and shows no trace of PETSc or HDF5.
. "$(dirname "$0")/library.sh"
command -v gnuplot >/dev/null || { echo "skipped: there is no gnuplot"; exit 77; }
block | sed '/^  \(low\|momentum\|turn\|kinetic\|elastic\|external\|floor\):/d; s/end: 0.4/end: 0.02/; s/^output:.*/output: {every: 0.01, grid: true}/; s/size: 0.05/size: 0.1/' >block.yaml
expect "run" 0 "$talus" run block.yaml --out good --quiet
expect "good" 0 "$talus" plot good --grid --time last --size 320x240

# damaged NAME FILE TEXT...: after the change that stands in `change` (of $1, the file) the answer has these texts.
damaged() {
  name=$1 file=$2
  shift 2
  rm -rf run && cp -r good run
  rm -rf run/pictures
  change "run/$file"
  expect "$name" 2 "$talus" plot run --grid --time last --size 320x240
  says err.txt "$@"
  lacks err.txt "HDF5-DIAG" "infinite loop"
}

points=points_000002.hdf grid=grid_000002.hdf
change() { : >"$1"; }
damaged "empty points" $points "error: cannot read 'run/$points': "
damaged "empty grid" $grid "error: cannot read 'run/$grid': "
change() { printf x >"$1"; }
damaged "no history" history.csv "error: cannot read 'run/history.csv': it does not start with the header"
change() { head -c 5000 "$1" >cut && mv cut "$1"; }
damaged "cut points" $points "error: cannot read 'run/$points': "
damaged "cut grid" $grid "error: cannot read 'run/$grid': "
change() { tr '\000' '\377' <"$1" >other && mv other "$1"; }
damaged "other bytes" $points "error: cannot read 'run/$points': "
change() { rm "$1" && mkfifo "$1"; }
damaged "pipe for points" $points "error: cannot read 'run/$points': "
damaged "pipe for a list" points.hdf.series "error: cannot read 'run/points.hdf.series': "
damaged "pipe for a history" history.csv "error: cannot read 'run/history.csv': "
change() { sed 's/"time"/"tyme"/' "$1" >other && mv other "$1"; }
damaged "list without times" points.hdf.series "error: cannot read 'run/points.hdf.series': line 4 names no file and its time"
change() { sed 's/points_000002/..\/good\/points_000002/' "$1" >other && mv other "$1"; }
damaged "list of other folders" points.hdf.series "error: cannot read 'run/points.hdf.series': line 6 names no file and its time"
change() { sed '4s/,[^,]*$//' "$1" >other && mv other "$1"; }
damaged "history with a short row" history.csv "error: cannot read 'run/history.csv': line 4 is no row of "
finish
