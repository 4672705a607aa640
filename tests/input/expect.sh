#!/bin/sh
# expect.sh CODE PATTERN COMMAND...: run the command; its exit code and a pattern in its output must be as expected.
code=$1
pattern=$2
shift 2
output=$("$@" 2>&1)
got=$?
printf '%s\n' "$output"
if [ "$got" -ne "$code" ]; then
  echo "exit code $got, expected $code"
  exit 1
fi
printf '%s\n' "$output" | grep -q -e "$pattern" || { echo "no '$pattern' in the output"; exit 1; }
