#!/bin/sh
# rooms.sh SOURCE: rooms stand one above the other in the order of CMakeLists.txt, and includes run down alone.
cd "$1" || exit 2
order=$(sed -n 's/^talus_rooms(\(.*\))$/\1/p' CMakeLists.txt)
[ -n "$order" ] || { echo "CMakeLists.txt names no rooms"; exit 2; }
for room in src/*/; do
  room=${room#src/} room=${room%/}
  case " $order cli " in *" $room "*) ;; *) echo "src/$room is a room that CMakeLists.txt does not name"; exit 1 ;; esac
done
find src -name '*.[ch]' -o -name '*.inc' | xargs grep -n '^#include "[a-z_]*/' | awk -v order="$order cli" '
  BEGIN {n = split(order, names, " "); for (i = 1; i <= n; ++i) floor[names[i]] = i}
  {split($0, part, ":"); split(part[1], path, "/"); split($0, quote, "\""); split(quote[2], to, "/"); ++all}
  to[1] in floor && floor[to[1]] > floor[path[2]] {print part[1] ":" part[2] ": " path[2] " is below " to[1] ", whose " quote[2] " it includes"; ++bad}
  END {print all + 0 " includes, " bad + 0 " run upward"; exit bad > 0 || all < 500}'
