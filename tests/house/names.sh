#!/bin/sh
# names.sh SOURCE: a function whose name begins with a capital returns a PetscErrorCode (call it through PetscCall), any other none.
cd "$1" || exit 2
find src -name '*.[ch]' | xargs awk '
  /^[A-Za-z_].*[A-Za-z_0-9]\(/ && !/^(typedef|extern|return|else|#|DEFINE)/ && !/^[A-Z_0-9]+\(/ {
    head = $0; sub(/\(.*/, "", head)
    while (head ~ /^(static|inline|KERNEL|UNROLLED|[A-Z_]*INLINE|__attribute__) /) sub(/^[A-Za-z_]+ /, "", head)
    if (head !~ / /) next
    name = head; sub(/.*[ *]/, "", name); sub(/[ *]*[A-Za-z_0-9]*$/, "", head)
    if (name ~ /^[A-Z_0-9]+$/ || name ~ /^[tT]alus/) next
    ++all
    if ((name ~ /^[A-Z]/) != (head ~ /^(const )?PetscErrorCode$/)) {print FILENAME ":" FNR ": " head " " name; ++bad}}
  END {print all + 0 " functions, " bad + 0 " misnamed"; exit bad > 0 || all < 1000}'
