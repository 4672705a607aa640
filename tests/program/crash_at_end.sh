#!/bin/sh
# crash_at_end.sh TALUS LIBRARY: a crash of MPI's own threads while it is taken down changes neither the exit code nor what was said.
. "$(dirname "$0")/library.sh"
at_end=$2
block | sed 's/end: 0.4/end: 0.01/' >block.yaml
expect "no case" 2 env LD_PRELOAD="$at_end" timeout 60 "$talus" verify /nowhere
says err.txt "error: there is no such file"
lacks err.txt "egmentation"
expect "run" 0 env LD_PRELOAD="$at_end" timeout 60 "$talus" run block.yaml --out run
says run/log.txt "corner = "
expect "list" 0 env LD_PRELOAD="$at_end" timeout 60 "$talus" list laws
says out.txt "neo-hookean"
finish
