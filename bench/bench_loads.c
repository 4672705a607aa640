/* The three reference loads: where the time of a step goes, and what it is beside the bare linear
 * solves of its matrices.
 *
 *   build/bench/bench_loads [-only 3] [-scale 1]     (from the root of the project; -scale: more or
 *   fewer steps of the dynamic loads)
 *
 * Each load runs twice, the second time with PETSc's assembled matrix and usual solver in place of
 * what talus chooses: the same steps, the same matrices (to the tolerance of the solvers), other
 * linear solves. Seconds are those in which the core worked for this process. */
#include "bench.h"
#include "input/case_file.h"

#define SETTINGS 6

typedef struct {
  int load;
  const char *name, *file, *set[SETTINGS];
  /* steps that only lead to where it is measured, and those that are measured */
  PetscInt before, steps;
  /* PETSc's options for the second run; NULL: talus takes PETSc's solver already */
  const char *other;
} Load;

#define COLUMN "cases/granular-collapse/case.yaml"
#define USUAL "-ksp_type bcgs -pc_type bjacobi -sub_pc_type ilu -sub_pc_factor_levels 0 -ksp_rtol 1e-4"

static const char *const usual[] = {"-ksp_type", "-pc_type", "-sub_pc_type", "-sub_pc_factor_levels", "-ksp_rtol"};

static const Load loads[] = {
  {1, "static cantilever, h = 0.03125 m", "cases/cantilever/case.yaml", {"grid.size=0.03125"}, 0, 1, NULL},
  {1, "static cantilever, h = 0.01 m", "cases/cantilever/case.yaml", {"grid.size=0.01"}, 0, 1, NULL},
  {2, "dry column, a = 1.2, mesh 2, steps of 1 ms", COLUMN, {NULL}, 50, 250, USUAL},
  {2,
   "dry column, a = 1.2, mesh 3, steps of 0.5 ms",
   COLUMN,
   {"grid.counts=[180, 47]", "grid.box.max=[0.4525, 0.11870232558139535]", "analysis.step=5e-4"},
   100,
   100,
   USUAL},
  {3, "3D collapse of a Mohr-Coulomb column, steps of 0.5 ms", "bench/collapse.yaml", {NULL}, 4, 8, USUAL},
};

typedef struct {
  PetscInt points, unknowns, steps, iterations, linear_iterations;
  /* of the steps that are measured; the phases by the clock */
  PetscReal seconds, idle, phase[PHASE_N];
  char solver[64];
} Outcome;

static PetscErrorCode Advance(Model *m, PetscInt steps, Outcome *o)
{
  StepReport report;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < steps; ++k) {
    PetscCall(ModelStep(m, m->c->analysis.end, &report));
    PetscCheck(report.outcome == STEP_ACCEPTED, PETSC_COMM_WORLD, PETSC_ERR_NOT_CONVERGED, "%s", report.reason);
    o->linear_iterations += report.newton.linear_iterations;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Measure(const Load *load, PetscInt before, PetscInt steps, Outcome *o)
{
  PetscReal first[PHASE_N];
  Model *m = NULL;
  Diag *diag;
  Case *c;
  PetscInt n_set = 0;

  PetscFunctionBeginUser;
  while (n_set < SETTINGS && load->set[n_set]) ++n_set;
  *o = (Outcome){.steps = steps};
  PetscCall(DiagCreate(&diag));
  PetscCall(CaseRead(PETSC_COMM_WORLD, load->file, n_set, load->set, diag, &c));
  if (c) PetscCall(ModelCreate(PETSC_COMM_WORLD, c, diag, &m));
  PetscCall(DiagFlush(diag, stderr));
  PetscCheck(m, PETSC_COMM_WORLD, PETSC_ERR_USER, "the benchmark's case has mistakes: %s", load->file);
  PetscCall(ModelCountPoints(m, &o->points));
  PetscCall(Advance(m, before, o));
  model_times(m, first);
  o->iterations = -m->total_iterations;
  o->linear_iterations = 0;
  const PetscReal start = seconds_now(), worked = processor_now();
  PetscCall(Advance(m, steps, o));
  o->seconds = seconds_now() - start;
  o->idle = o->seconds - (processor_now() - worked);
  model_times(m, o->phase);
  for (int k = 0; k < PHASE_N; ++k) o->phase[k] -= first[k];
  o->iterations += m->total_iterations;
  o->unknowns = m->system->n_active_global * m->system->block;
  snprintf(o->solver, sizeof o->solver, "%s", newton_linear_name(m->newton));
  PetscCall(ModelDestroy(&m));
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

/* Milliseconds a step by phase, and each phase's share of a step. */
static void print_split(const Outcome *o)
{
  PetscReal rest = o->seconds;
  printf("  a step [ms]   ");
  for (int k = 0; k < PHASE_N; ++k) {
    printf(" %s %.2f ", phase_names[k], 1e3 * o->phase[k] / (PetscReal)o->steps);
    rest -= o->phase[k];
  }
  printf(" rest %.2f   all %.2f\n  shares [%%]    ", 1e3 * PetscMax(rest, 0) / (PetscReal)o->steps,
         1e3 * o->seconds / (PetscReal)o->steps);
  for (int k = 0; k < PHASE_N; ++k) printf(" %s %.1f ", phase_names[k], 100 * o->phase[k] / o->seconds);
  printf(" rest %.1f   (%.0f %% of the time without a core)\n", 100 * PetscMax(rest, 0) / o->seconds,
         100 * PetscMax(o->idle, 0) / o->seconds);
}

static void print_solves(const char *whose, const Outcome *o, PetscReal seconds)
{
  const PetscReal linear = o->phase[PHASE_LINEAR], its = PetscMax(1, (PetscReal)o->iterations);
  printf(
    "  bare solves    %s: %.2f ms a Newton iteration, %.1f linear iterations; a step is %.2f times its solves   "
    "[target 1.5]   (%s)\n",
    whose, 1e3 * linear / its, (PetscReal)o->linear_iterations / its, seconds / linear, o->solver);
}

static PetscErrorCode Compare(const Load *load, PetscReal scale)
{
  const PetscInt before = (PetscInt)(scale * (PetscReal)load->before);
  const PetscInt steps = load->other ? PetscMax(1, (PetscInt)(scale * (PetscReal)load->steps)) : load->steps;
  Outcome own, other;

  PetscFunctionBeginUser;
  PetscCall(Measure(load, before, steps, &own));
  const PetscReal its = PetscMax(1, (PetscReal)own.iterations);
  printf("\nload %d: %s\n  %d points, %d unknowns; %d step(s) after %d, %.2f Newton iterations a step\n", load->load,
         load->name, (int)own.points, (int)own.unknowns, (int)steps, (int)before, its / (PetscReal)steps);
  print_split(&own);
  printf("  points + matrix %.1f %% of a step   [target 20 %%]\n",
         100 * (own.phase[PHASE_POINTS] + own.phase[PHASE_MATRIX]) / own.seconds);
  print_solves("talus's choice ", &own, own.seconds);
  if (load->other) {
    PetscCall(PetscOptionsInsertString(NULL, load->other));
    PetscCall(Measure(load, before, steps, &other));
    for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(usual); ++k) PetscCall(PetscOptionsClearValue(NULL, usual[k]));
    /* the solves of as many Newton iterations */
    other.phase[PHASE_LINEAR] *= its / PetscMax(1, (PetscReal)other.iterations);
    other.iterations = own.iterations;
    print_solves("PETSc's matrix ", &other, own.seconds);
  }
  fflush(stdout);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscInt only = 0;
  PetscReal scale = 1;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-only", &only, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-scale", &scale, NULL));
  for (size_t k = 0; k < sizeof loads / sizeof loads[0]; ++k)
    if (!only || loads[k].load == only) PetscCall(Compare(&loads[k], scale));
  PetscCall(PetscFinalize());
  return 0;
}
