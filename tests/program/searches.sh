#!/bin/sh
# Every sweep and every calibration that stands beside the cases can be read, as it is and with its quick settings.
. "$(dirname "$0")/library.sh"
cases=$(cd "$(dirname "$0")/../../cases" && pwd)
for file in "$cases"/*/sweep.yaml; do
  for which in $(sed -n 's/^ *- name: //p' "$file"); do
    for quick in "" --quick; do
      expect "sweep $which $quick" 0 "$talus" sweep "${file%/sweep.yaml}" --name "$which" --dry $quick --out s
    done
  done
done
for file in $(grep -l '^instruments:' "$cases"/*/*.yaml); do
  for quick in "" --quick; do expect "$file $quick" 0 "$talus" calibrate "$file" --dry $quick --out c; done
done
finish
