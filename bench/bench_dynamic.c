/* An elastic block lands on the floor of its grid and bounces: the cost of a step, and how it grows
 * with the number of points at the same Courant number and with the same number of steps.
 *
 *   build/bench/bench_dynamic [-dim 2] [-points 10000,100000,1000000] [-steps 20] [-repeat 1]
 *   [-weak]
 *
 * -weak: so many points for each rank, for weak scaling. */
#include "bench.h"

typedef struct {
  PetscReal total, idle, phase[PHASE_N], table, support, resident, courant;
  PetscInt dim, points, unknowns, steps, iterations, linear, patterns;
  Pass pass;
} Result;

static PetscErrorCode Largest(PetscReal *values, PetscMPIInt n)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, n, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(Model *m, PetscInt steps, Result *r)
{
  StepReport report;

  PetscFunctionBeginUser;
  r->linear = 0;
  PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
  const PetscReal start = seconds_now(), worked = processor_now();
  for (r->steps = 0; r->steps < steps; ++r->steps) {
    PetscCall(ModelStep(m, 1, &report));
    PetscCheck(report.outcome == STEP_ACCEPTED, PETSC_COMM_WORLD, PETSC_ERR_NOT_CONVERGED, "%s", report.reason);
    r->linear += report.newton.linear_iterations;
  }
  r->total = seconds_now() - start;
  r->idle = r->total - (processor_now() - worked);
  r->iterations = m->total_iterations;
  r->patterns = m->system->builds;
  model_times(m, r->phase);
  PetscCall(Largest(&r->total, 1));
  PetscCall(Largest(&r->idle, 1));
  PetscCall(Largest(r->phase, PHASE_N));
  PetscFunctionReturn(0);
}

static PetscErrorCode Measure(PetscInt dim, PetscInt n, PetscInt steps, PetscInt repeats, Result *best)
{
  BenchCase b;
  Subject s;

  PetscFunctionBeginUser;
  bench_landing_block(&b, dim, n, n / 2, 0.3);
  best->total = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < repeats; ++k) {
    Result r = *best;
    PetscCall(SubjectCreate(&b.c, &s));
    const TimeScheme *scheme = time_scheme_of(&b.c.analysis);
    const TimeWeights weights = scheme->weights(&b.c.analysis, b.c.analysis.step);
    PetscCall(Run(s.model, steps, &r));
    if (k == 0) {
      r.resident = (resident_bytes() - s.bytes_before) / PetscMax(s.model->points->n, 1);
      r.dim = dim;
      r.points = s.points;
      r.unknowns = s.model->system->n_active_global * dim;
      r.table = table_bytes(s.model);
      r.support = support_bytes(s.model);
      r.courant = s.model->courant_speed * b.c.analysis.step / s.model->grid->smallest;
      PetscCall(PassMeasure(s.model, time_inertia(&weights, time_solved(scheme), b.c.analysis.damping), 5,
                            &r.pass)); /* with the matrix that the solver took */
    }
    if (k == 0 || r.total < best->total) *best = r;
    PetscCall(SubjectDestroy(&s));
  }
  PetscFunctionReturn(0);
}

/* What the rest of a step costs beside its linear solves. */
static PetscErrorCode PrintShares(const Result *r)
{
  const PetscReal points = r->phase[PHASE_POINTS], matrix = r->phase[PHASE_MATRIX], linear = r->phase[PHASE_LINEAR];

  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                        "  shares of a step       points %.0f %%, with the matrix %.0f %% [target 20], linear %.0f %%; "
                        "step / linear solves %.1f "
                        "[target 1.5]; %.3f ms a linear iteration\n",
                        100 * points / r->total, 100 * (points + matrix) / r->total, 100 * linear / r->total,
                        r->total / linear, 1e3 * linear / PetscMax(1, (PetscReal)r->linear)));
  PetscFunctionReturn(0);
}

static PetscErrorCode Print(const Result *r, PetscReal bandwidth)
{
  const PetscReal pass = r->pass.points + r->pass.matrix, steps = (PetscReal)r->steps;
  PetscReal rest = r->total;
  PetscMPIInt ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                        "\n%d points, %d unknowns, %d rank(s): %d steps at Courant number %.1f, %.2f iterations a "
                        "step, %.1f linear iterations each, "
                        "%d pattern(s)\n",
                        (int)r->points, (int)r->unknowns, (int)ranks, (int)r->steps, r->courant,
                        (PetscReal)r->iterations / steps, (PetscReal)r->linear / PetscMax(1, (PetscReal)r->iterations),
                        (int)r->patterns));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  per step [ms]         "));
  for (int k = 0; k < PHASE_N; ++k) {
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, " %s %.2f ", phase_names[k], 1e3 * r->phase[k] / steps));
    rest -= r->phase[k];
  }
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, " rest %.2f   all %.2f (%.0f %% without a core)\n",
                        1e3 * PetscMax(rest, 0) / steps, 1e3 * r->total / steps,
                        100 * PetscMax(r->idle, 0) / r->total));
  const PetscReal its = PetscMax(1, (PetscReal)r->iterations);
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  per iteration [ms]     points %.2f  matrix %.2f  linear %.2f  all %.2f\n",
                        1e3 * r->phase[PHASE_POINTS] / its, 1e3 * r->phase[PHASE_MATRIX] / its,
                        1e3 * r->phase[PHASE_LINEAR] / its, 1e3 * r->total / its));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                        "  point evaluations      %.2f million/s with the scatter into blocks, %.2f with the matrix\n",
                        1e-6 * r->points / r->pass.points, 1e-6 * r->points / pass));
  if (bandwidth > 0)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  pass / triad bound     %.1f   (%.1f MB at %.1f GB/s: %.2f ms)\n",
                          pass * bandwidth / r->pass.bytes, 1e-6 * r->pass.bytes, 1e-9 * bandwidth,
                          1e3 * r->pass.bytes / bandwidth));
  PetscCall(PrintShares(r));
  PetscCall(PetscPrintf(
    PETSC_COMM_WORLD,
    "  bytes a point          %.0f in the table + %.0f of shape functions; %.0f resident with grid and matrix%s\n",
    r->table, r->support, r->resident, r->dim == 2 ? " [target 1500]" : ""));
  PetscFunctionReturn(0);
}

/* Least squares in the logarithms, of the time in which the core worked for this run. */
static PetscReal exponent(PetscInt n, const Result *r)
{
  PetscReal x = 0, y = 0, xx = 0, xy = 0;
  for (PetscInt k = 0; k < n; ++k) {
    const PetscReal a = PetscLogReal((PetscReal)r[k].points), b = PetscLogReal(r[k].total - r[k].idle);
    x += a, y += b, xx += a * a, xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

int main(int argc, char **argv)
{
  PetscInt sizes[8] = {10000, 100000, 1000000}, n = 8, dim = 2, steps = 20, repeats = 1;
  PetscReal bandwidth = 0;
  PetscMPIInt ranks;
  PetscBool given, weak = PETSC_FALSE;
  Result r[8];

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  PetscCall(PetscOptionsGetIntArray(NULL, NULL, "-points", sizes, &n, &given));
  if (!given) n = 3;
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-dim", &dim, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-steps", &steps, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-repeat", &repeats, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-weak", &weak, NULL));
  for (PetscInt k = 0; weak && k < n; ++k) sizes[k] *= ranks;
  if (ranks == 1) PetscCall(TriadMeasure(&bandwidth));
  for (PetscInt k = 0; k < n; ++k) {
    const PetscReal per_body = (PetscReal)sizes[k] / (dim == 2 ? 4 : 8);
    PetscCall(Measure(dim, (PetscInt)(PetscPowReal(per_body, 1.0 / (PetscReal)dim) + 0.5), steps, repeats, &r[k]));
    PetscCall(Print(&r[k], bandwidth));
  }
  if (n > 1)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                          "\ntime grows with the number of points to the power %.3f   [target 1.1]; %.0f times from %d "
                          "to %d points\n",
                          exponent(n, r), (r[n - 1].total - r[n - 1].idle) / (r[0].total - r[0].idle), (int)r[0].points,
                          (int)r[n - 1].points));
  PetscCall(PetscFinalize());
  return 0;
}
