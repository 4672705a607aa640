#!/bin/sh
# fails.sh SOURCE: cases with rows that fail in docs/verification.md are those that docs/guide/trust.md tells of, no more and no less.
cd "$1" || exit 2
fail=$(awk '/^## /{sub(":.*", "", $2); name = $2} /\*\*FAIL\*\*/{print name}' docs/verification.md | sort -u)
told=$(awk '/^## /{on = /Rows that fail/} on' docs/guide/trust.md | sed -n 's/^| \[[^]]*\](..\/..\/cases\/\([^)]*\)).*/\1/p' | sort -u)
[ -n "$told" ] || { echo "docs/guide/trust.md has no table of rows that fail"; exit 1; }
[ "$fail" = "$told" ] && exit 0
echo "docs/verification.md has rows that fail of:" $fail
echo "docs/guide/trust.md, 'Rows that fail', tells of:" $told
exit 1
