/* Large statics: what a Newton iteration costs, how many linear iterations a digit takes, and how much memory.
 *
 *   build/bench/bench_statics [-only beam,soil,mixed,plane] [-size 0.05] [-steps 1] [-linear iterative] [-residuals]
 *   mpiexec -n 2 build/bench/bench_statics ...           (from the root of the project; any option of PETSc)
 *
 * Seconds are those in which the cores worked for this program, of the rank that worked longest. */
#include "bench.h"
#include "input/case_file.h"
#include <sys/resource.h>

typedef struct {
  const char *name, *file, *size;
} Large;

static const Large larges[] = {{"beam", "bench/statics-beam.yaml", "0.05"},
                               {"soil", "bench/statics-soil.yaml", "0.0625"},
                               {"mixed", "bench/statics-mixed.yaml", "0.04"},
                               {"plane", "cases/cantilever/case.yaml", "0.01"}};

typedef struct {
  PetscInt steps, newton, linear;
  PetscReal worked, clock, setup, phase[PHASE_N];
} Cost;

/* The most that all ranks together have held; each rank counts its own. */
static PetscErrorCode PeakMemory(PetscReal *bytes)
{
  struct rusage usage;
  PetscFunctionBeginUser;
  getrusage(RUSAGE_SELF, &usage);
  const PetscReal own = 1024.0 * (PetscReal)usage.ru_maxrss;
  PetscCall(MPIU_Allreduce(&own, bytes, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintStep(const Model *m, const StepReport *r, PetscBool residuals)
{
  const NewtonReport *n = &r->newton;
  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  to %g: %d Newton (%d lost), %d linear iterations; %s\n", (double)m->time,
                        (int)n->iterations, (int)n->lost, (int)n->linear_iterations, n->reason));
  for (PetscInt k = 0; residuals && k <= PetscMin(n->iterations, NEWTON_HISTORY - 1); ++k)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "    %8.1e", (double)n->residual[k]));
  if (residuals) PetscCall(PetscPrintf(PETSC_COMM_WORLD, "\n"));
  PetscFunctionReturn(0);
}

static PetscErrorCode Advance(Model *m, PetscInt steps, PetscBool residuals, Cost *cost)
{
  StepReport report;

  PetscFunctionBeginUser;
  const PetscReal start = seconds_now(), worked = processor_now();
  for (; cost->steps < steps && m->time < (1 - 1e-9) * m->c->analysis.end; ++cost->steps) {
    PetscCall(ModelStep(m, m->c->analysis.end, &report));
    PetscCheck(report.outcome == STEP_ACCEPTED, PETSC_COMM_WORLD, PETSC_ERR_NOT_CONVERGED, "%s", report.reason);
    PetscCall(PrintStep(m, &report, residuals));
    cost->newton += report.newton.iterations + report.newton.lost;
    cost->linear += report.newton.linear_iterations;
  }
  const PetscReal own[2] = {processor_now() - worked, seconds_now() - start};
  PetscReal all[2];
  PetscCall(MPIU_Allreduce(own, all, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  cost->worked = all[0], cost->clock = all[1];
  model_times(m, cost->phase);
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintCost(const Model *m, const Cost *c)
{
  const PetscReal its = PetscMax(1, (PetscReal)c->newton);
  PetscReal peak;

  PetscFunctionBeginUser;
  PetscCall(PeakMemory(&peak));
  PetscCall(
    PetscPrintf(PETSC_COMM_WORLD,
                "  %s: %d steps, %d Newton, %.1f linear iterations each; processor %.3f s, %.3f each (clock %.2f: "
                "points %.2f matrix %.2f linear %.2f pattern %.2f newton %.2f); most memory %.2f GB\n",
                newton_linear_name(m->newton), (int)c->steps, (int)c->newton, (double)c->linear / (double)its,
                (double)c->worked, (double)(c->worked / its), (double)c->clock, (double)c->phase[PHASE_POINTS],
                (double)c->phase[PHASE_MATRIX], (double)c->phase[PHASE_LINEAR], (double)c->phase[PHASE_PATTERN],
                (double)c->phase[PHASE_NEWTON], (double)(1e-9 * peak)));
  PetscFunctionReturn(0);
}

static PetscErrorCode Measure(const Large *l, const char *size, const char *linear)
{
  char setting[2][64];
  const char *const set[] = {setting[0], setting[1]};
  PetscInt steps = PETSC_MAX_INT;
  PetscBool residuals = PETSC_FALSE;
  Cost cost = {0};
  Model *m = NULL;
  Diag *diag;
  Case *c;
  int ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-steps", &steps, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-residuals", &residuals, NULL));
  snprintf(setting[0], sizeof setting[0], "grid.size=%s", size);
  snprintf(setting[1], sizeof setting[1], "linear=%s", linear);
  PetscCall(DiagCreate(&diag));
  PetscCall(CaseRead(PETSC_COMM_WORLD, l->file, 2, set, diag, &c));
  if (c) PetscCall(ModelCreate(PETSC_COMM_WORLD, c, diag, &m));
  PetscCall(DiagFlush(diag, stderr));
  PetscCheck(m, PETSC_COMM_WORLD, PETSC_ERR_USER, "the benchmark's case has mistakes: %s", l->file);
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s, cells of %s m\n", l->name, size));
  PetscCall(Advance(m, steps, residuals, &cost));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  %d unknowns, %d ranks\n",
                        (int)(m->system->n_active_global * m->system->block), ranks));
  PetscCall(PrintCost(m, &cost));
  PetscCall(ModelDestroy(&m));
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  char only[64] = "beam,soil,mixed,plane", size[32] = "", linear[32] = "auto";
  const int n = (int)(sizeof larges / sizeof larges[0]);

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-only", only, sizeof only, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-size", size, sizeof size, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-linear", linear, sizeof linear, NULL));
  for (int k = 0; k < n; ++k)
    if (strstr(only, larges[k].name)) PetscCall(Measure(larges + k, *size ? size : larges[k].size, linear));
  PetscCall(PetscFinalize());
  return 0;
}
