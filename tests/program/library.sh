# What the tests of the whole program share. Sourced by a script that got the program as its first argument: works in a
# folder of its own that vanishes, collects failures, and ends with `finish`.
talus=$1
work=$(mktemp -d "${TMPDIR:-/tmp}/talus-test.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
ulimit -c 0
# Ranks of different tests would otherwise share a folder, and the first to end would take it away from the others.
mkdir "$work/.mpi"
export OMPI_MCA_orte_tmpdir_base="$work/.mpi"
failures=0

fail() {
  failures=$((failures + 1))
  echo "FAILED $*"
  if [ -s out.txt ]; then sed 's/^/    out: /' out.txt | head -n 20; fi
  if [ -s err.txt ]; then sed 's/^/    err: /' err.txt | head -n 20; fi
}

finish() {
  [ "$failures" -eq 0 ] || { echo "$failures failed"; exit 1; }
  exit 0
}

# expect NAME CODE COMMAND...: the command's output goes to out.txt and err.txt; its exit code must be CODE, and PETSc
# must not have printed a trace.
expect() {
  name=$1 wanted=$2
  shift 2
  "$@" >out.txt 2>err.txt </dev/null
  code=$?
  [ "$code" -eq "$wanted" ] || fail "$name: exit code $code, expected $wanted"
  if grep -q -e 'PETSC ERROR' -e 'MPI_ABORT' err.txt; then fail "$name: a trace"; fi
}

# says FILE TEXT...: the file holds every text.
says() {
  file=$1
  shift
  for text; do
    grep -q -F -e "$text" "$file" || fail "$name: no '$text' in $file"
  done
}

lacks() {
  file=$1
  shift
  for text; do
    if grep -q -F -e "$text" "$file"; then fail "$name: '$text' in $file"; fi
  done
}

# A ranks' prefix: on 1 the plain program.
on_ranks() {
  ranks=$1
  shift
  if [ "$ranks" -eq 1 ]; then "$@"; else mpiexec --oversubscribe -n "$ranks" "$@"; fi
}

# Of variants of one feature each has its turn: sets `ranks` to 1, 2, 3, 1, ... Where there are many of a short run, which
# costs less than its start, `turn N` sets it to 2 for one of N, to 3 for another one, to 1 for all others.
turn() {
  [ $# -gt 0 ] || { ranks=$((${ranks:-0} % 3 + 1)); return; }
  turns=$((${turns:-0} % $1 + 1))
  case $turns in $(($1 / 3 + 1))) ranks=2 ;; $(($1 * 3 / 4 + 1))) ranks=3 ;; *) ranks=1 ;; esac
}

# The cantilever of the case book on a coarse grid.
cantilever() {
  cat <<'END'
title: Cantilever under its own weight
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [0, -1.5], max: [8.5, 1.5]}, size: 0.5}
bodies:
  - {name: beam, shape: {box: {min: [0, 0], max: [8, 1]}}, points_per_cell: 4, material: rubber}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 90e6, poisson: 0}
boundary:
  - {on: {x: 0}, fix: [x, y]}
loads: {gravity: [0, -9.81]}
measures:
  tip: {displacement: y, of: {tracer: [8, 0.5]}}
  weight: {reaction: y, of: {boundary: 0}}
basis: {cell: {}}
END
}

# A spinning block that flies to the right, falls on the floor and bounces; it crosses the cells of every rank.
block() {
  cat <<'END'
title: Elastic block falls and bounces
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, step: 2e-3, end: 0.4, transfer: thesis}
grid: {box: {min: [0, 0], max: [3, 2]}, size: 0.05}
bodies:
  - {name: block, shape: {box: {min: [0.5, 0.5], max: [1.5, 1]}}, points_per_cell: 4, material: rubber,
     velocity: [1.5, -1], spin: -1, spin_centre: [1, 0.75]}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 2e5, poisson: 0.3}
boundary:
  - {on: {boundary: bottom}, fix: [x, y]}
loads: {gravity: [0, -9.81]}
measures:
  corner: {position: x, of: {tracer: [1.5, 1]}}
  low: {extent: {min: y}, of: {body: block}}
  momentum: {momentum: x}
  turn: {angular_momentum: z}
  kinetic: {energy: kinetic}
  elastic: {energy: elastic}
  external: {energy: external}
  floor: {reaction: y, of: {boundary: 0}}
output: {every: 0.1}
basis: {cell: {}}
END
}

# The same block lower and faster, in half of the time.
quick_block() {
  block | sed 's/end: 0.4/end: 0.2/; s/\[1.5, -1\]/[3, -1]/; s/min: \[0.5, 0.5\], max: \[1.5, 1\]/min: [0.5, 0.3], max: [1.5, 0.8]/
    s/spin_centre: \[1, 0.75\]/spin_centre: [1, 0.55]/; s/tracer: \[1.5, 1\]/tracer: [1.5, 0.8]/'
}

# plate STEPS: plate.geo, meshed by gmsh with regions and boundaries by their names, and a case.yaml that pulls it in so many steps.
plate() {
  cat >plate.geo <<'END'
DefineConstant[ h = 0.2 ];
Point(1) = {0, 0, 0, h}; Point(2) = {3, 0, 0, h}; Point(3) = {3, 1, 0, h / 2}; Point(4) = {0, 1.5, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("plate") = {1};
Physical Curve("wall") = {4};
Physical Curve("edge") = {2};
END
  cat >case.yaml <<END
kinematics: plane-strain
method: fem
analysis: {type: static, steps: $1}
grid: {mesh: plate.geo, parameters: {h: 0.15}}
bodies:
  - {name: plate, region: plate, points_per_cell: 3, material: rubber}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}
boundary:
  - {name: wall, on: {boundary: wall}, fix: [x, y]}
loads:
  tractions:
    - {on: {boundary: edge}, value: [2e4, -1e4]}
measures:
  tip: {displacement: y, of: {tracer: [3, 1]}}
  hold: {reaction: y, of: {boundary: wall}}
  pull: {reaction: x, of: {boundary: wall}}
END
}
