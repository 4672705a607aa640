#!/bin/sh
# Other programs solve the same cases: the projects of Kratos that bench/peer_kratos.py writes are, once imported, the
# cases of bench_table, to round-off.
source=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/library.sh"
command -v python3 >/dev/null || exit 77

# same PROJECT MEASURE CASE SET...: the project gives what the case gives with these settings, to seven digits. The body is
# called BODY in MEASURE.
same() {
  project=$1 measure=$2 case=$3
  shift 3
  expect "$project is written" 0 python3 "$source/bench/peer_kratos.py" "$project" "$project"
  expect "$project is read" 0 "$talus" import kratos "$project" --out imported
  expect "$project by the project" 0 "$talus" run imported/case.yaml --set "measures={answer: $(echo "$measure" | sed 's/BODY/Body/')}" --out there
  body=$(sed -n '/^bodies/,/name/s/.*name: \([a-z]*\).*/\1/p' "$source/cases/$case/case.yaml")
  expect "$project by the case" 0 "$talus" run "$source/cases/$case/case.yaml" --set "measures={answer: $(echo "$measure" | sed "s/BODY/$body/")}" "$@" --out here
  there=$(tail -n 1 there/history.csv) here=$(tail -n 1 here/history.csv)
  echo "$there,$here" | awk -F , '{d = $3 - $6; exit !$6 || d * d > 1e-14 * $6 * $6}' || fail "$project: $there is not $here"
  rm -rf imported here there
}

same column '{extent: {max: x}, of: {body: BODY}}' granular-collapse --set analysis.end=0.05 --set analysis.damping=0
same cantilever '{displacement: y, of: {tracer: [8, 0.5]}}' cantilever --set grid.size=0.03125
finish
