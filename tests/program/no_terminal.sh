#!/bin/sh
# Where no pseudo-terminal is to be had, the test of the terminal is skipped, and says so.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/library.sh"
mkdir bin
printf '#!/bin/sh\necho "script: failed to create pseudo-terminal: No such device" >&2\nexit 1\n' >bin/script
chmod +x bin/script
expect "no pseudo-terminal" 77 env PATH="$work/bin:$PATH" sh "$here/terminal.sh" "$talus"
says out.txt "skipped: no pseudo-terminal is to be had: script: failed to create pseudo-terminal"
finish
