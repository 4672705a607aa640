#!/bin/sh
# fails.sh SOURCE: every case with rows that fail in docs/verification.md is told of in docs/guide/trust.md.
cd "$1" || exit 2
fail=$(awk '/^## /{sub(":.*", "", $2); name = $2} /\*\*FAIL\*\*/{print name}' docs/verification.md | sort -u)
told=$(awk '/^## /{on = /Rows that fail/} on' docs/guide/trust.md | sed -n 's/^| \[[^]]*\](..\/..\/cases\/\([^)]*\)).*/\1/p' | sort -u)
[ -n "$told" ] || { echo "docs/guide/trust.md has no table of rows that fail"; exit 1; }
status=0
for name in $fail; do
  echo "$told" | grep -qx "$name" || { echo "rows of $name fail, and 'Rows that fail' of docs/guide/trust.md does not say so"; status=1; }
done
for name in $told; do
  echo "$fail" | grep -qx "$name" || echo "(no row of $name fails any more: it may leave docs/guide/trust.md)"
done
exit $status
