#!/bin/sh
# run.sh BUILD: all benchmarks of this folder, as `make bench` runs them. What the numbers mean stands in README.md.
set -eu
bench=${1:-build}/bench
export OPENBLAS_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

title() { printf '\n== %s\n' "$*"; }

# best_step RANKS [-weak]: milliseconds a step of the best of three runs, with 100,000 points in all or on each rank.
best_step() {
  ranks=$1
  shift
  mpiexec --oversubscribe -n "$ranks" "$bench/bench_dynamic" -points 100000 -steps 20 -repeat 3 "$@" |
    awk '/per step/ {for (i = 1; i < NF; ++i) if ($i == "all") print $(i + 1), substr($(i + 2), 2)}'
}

title "one table: talus, the bound of explicit dynamics, other programs (medians of three rounds)"
"$bench/bench_table"

title "laws"
"$bench/bench_law"

title "the three reference loads: statics, the dry column, a 3D collapse"
"$bench/bench_loads"

title "a collapsing column: aspect ratio 1.2, mesh 2, 0.5 s"
"$bench/bench_column"
title "explicit dynamics: the same column, blocks that slide"
"$bench/bench_explicit"
title "powder in a tube: rings of triangles"
"$bench/bench_tube"
title "meshfree bases"
"$bench/bench_cloud"
title "a floor of nodes, and a wall"
"$bench/bench_walls"
title "rigid walls of triangles"
"$bench/bench_wall"

title "a rolling disk: gmm beside mpm, cells of 0.04 m and steps of 4 ms, then 0.02 m and 2 ms"
"$bench/bench_gmm" -size 0.04 -step 4e-3 -steps 100 -repeat 3
"$bench/bench_gmm" -size 0.02 -step 2e-3 -steps 100 -repeat 1

title "bases in space: a ball, a beam"
"$bench/bench_bases" -repeat 2
"$bench/bench_bases" -repeat 2 -case bench/bases-ball.yaml -transfer consistent

title "statics"
"$bench/bench_static"

title "large statics: a beam, soil, a nearly incompressible block, the plane cantilever"
"$bench/bench_statics"

title "mixed formulation in 3D"
"$bench/bench_mixed"
title "the same, 62,500 unknowns, on one and two ranks"
"$bench/bench_mixed" -cells 24 -direct_up_to 0
mpiexec --oversubscribe -n 2 "$bench/bench_mixed" -cells 24 -direct_up_to 0

title "dynamics in 2D: an elastic block lands and bounces"
"$bench/bench_dynamic" -points 10000,100000,1000000 -steps 20 -repeat "${REPEAT:-2}"

title "dynamics in 3D"
"$bench/bench_dynamic" -dim 3 -points 100000 -steps 20

title "ranks: 2D, 100,000 points, best of 3"
one=$(best_step 1)
two=$(best_step 2)
echo "$one $two" | awk '{printf "  1 rank %.2f ms a step, 2 ranks %.2f ms: %.2f times faster, efficiency %.0f %%   [target 1.7 and 85 %%, on two free cores]\n" \
  "  (other work on the machine took a core away for %d %% and %d %% of the time)\n", $1, $3, $1 / $3, 50 * $1 / $3, $2, $4}'

title "ranks: 2D, 100,000 points on each, best of 3"
two=$(best_step 2 -weak)
echo "$one $two" | awk '{printf "  1 rank %.2f ms a step, 2 ranks %.2f ms: efficiency %.0f %%   [target 85 %%, on two free cores]\n" \
  "  (other work on the machine took a core away for %d %% and %d %% of the time)\n", $1, $3, 100 * $1 / $3, $2, $4}'

title "what ranks say to each other"
mpiexec --oversubscribe -n 4 "$bench/bench_messages" -per_rank 2500

title "checkpoints: written, fsync included, and read back"
"$bench/bench_checkpoint"
"$bench/bench_checkpoint" -dim 3
mpiexec --oversubscribe -n 2 "$bench/bench_checkpoint"
