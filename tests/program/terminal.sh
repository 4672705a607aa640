#!/bin/sh
# On a terminal a bar with the time left is drawn over itself; the log has plain lines all the same.
. "$(dirname "$0")/library.sh"
command -v script >/dev/null || { echo "skipped: there is no program 'script'"; exit 77; }
script -qec "test -t 1" probe.txt >/dev/null 2>err.txt </dev/null || { echo "skipped: no pseudo-terminal is to be had: $(head -n 1 err.txt)"; exit 77; }
block >block.yaml
name="terminal"
TERM=xterm script -qec "stty cols 100; '$talus' run block.yaml --out run" typescript.txt >/dev/null 2>err.txt </dev/null || fail "exit code $?"
carriage=$(printf '\r')
[ "$(tr -cd '\r' <typescript.txt | wc -c)" -gt 5 ] || fail "no bar is drawn over another"
tr '\r' '\n' <typescript.txt | sed 's/\x1b\[K//' >screen.txt
grep -q '^\[#*-*\] .*[0-9] %  left 0:00:0[0-9]  step [0-9]*  t 0\.[0-9]* s' screen.txt || fail "no bar with the time left"
grep -q '^\[#*\] *100 %' screen.txt || fail "no full bar at the end"
if awk 'length($0) > 100' screen.txt | grep -q '^\['; then fail "a bar is wider than the terminal"; fi
if grep -q '^step = ' screen.txt; then fail "plain lines besides the bar"; fi
says screen.txt "method = mpm" "corner = "
[ "$(grep -c '^step = ' run/log.txt)" -eq 200 ] || fail "log: not every step"
if grep -q "$carriage" run/log.txt; then fail "log: a carriage return"; fi
TERM=dumb script -qec "'$talus' run block.yaml --out run --force --set analysis.end=0.1" typescript.txt >/dev/null </dev/null || fail "dumb: exit code $?"
if grep -q "$(printf '\033')" typescript.txt; then fail "dumb: an escape sequence"; fi
grep -q '^step = ' typescript.txt || fail "dumb: no plain lines"
script -qec "'$talus' run block.yaml --out run --force --quiet --set analysis.end=0.1" typescript.txt >/dev/null </dev/null || fail "quiet: exit code $?"
if grep -q -e '%' -e 'step' typescript.txt; then fail "quiet: it speaks"; fi
finish
