/* The rolling disk of cases/rolling-disk by mpm and by gmm: what a step costs, by phase, and gmm's
 * cost as a ratio to mpm's.
 *
 *   build/bench/bench_gmm [-size 0.02] [-step 2e-3] [-steps 40] [-repeat 3] [-only NAME [-alone]]
 *   [-case cases/rolling-disk/case.yaml]
 *
 * Ratios are taken inside one run, from the best of several rounds in which all methods take turns;
 * seconds are those in which a core worked for this process. The disk stands one cell above the
 * plane at the start, as in the case. */
#include "bench.h"
#include "input/case_file.h"

typedef struct {
  const char *name;
  const char *set[2];
} Variant;

static const Variant variants[] = {
  {"mpm", {"method=mpm", NULL}},
  {"lme 0.8", {"method=gmm", "basis={lme: {cloud: fixed, radius: 1.41421356, gamma: 0.8}}"}},
  {"lme 1.8", {"method=gmm", "basis={lme: {cloud: fixed, radius: 1.41421356, gamma: 1.8}}"}},
  {"lme 2.8", {"method=gmm", "basis={lme: {cloud: fixed, radius: 1.41421356, gamma: 2.8}}"}},
  {"lme adaptive", {"method=gmm", "basis={lme: {gamma: 1.8}}"}},
  {"mls", {"method=gmm", "basis={mls: {cloud: fixed, radius: 1.41421356, effective_radius: 0.70710678}}"}},
  {"mls wide", {"method=gmm", "basis={mls: {cloud: fixed, radius: 2.12132034, effective_radius: 1.41421356}}"}},
  {"mls adaptive", {"method=gmm", "basis={mls: {effective_radius: 0.70710678}}"}},
};
#define VARIANTS (sizeof variants / sizeof variants[0])

typedef struct {
  const char *file;
  PetscReal size, step;
  PetscInt steps, repeat;
  PetscBool alone; /* without mpm: for a profile */
} Plan;

typedef struct {
  PetscReal seconds, phase[PHASE_N], way;
  PetscInt steps, iterations, points, unknowns, entries;
  PetscBool gave_up;
} Outcome;

static PetscErrorCode ReadCase(const Plan *plan, const Variant *variant, Diag *diag, Case **c)
{
  char text[3][80];
  const char *const set[] = {text[0], text[1], text[2], variant->set[0], variant->set[1]};

  PetscFunctionBeginUser;
  snprintf(text[0], sizeof text[0], "grid.size=%.15g", (double)plan->size);
  snprintf(text[1], sizeof text[1], "analysis.step=%.15g", (double)plan->step);
  snprintf(text[2], sizeof text[2], "grid.box.min=[0, %.15g]", (double)-plan->size);
  PetscCall(CaseRead(PETSC_COMM_WORLD, plan->file, variant->set[1] ? 5 : 4, set, diag, c));
  PetscFunctionReturn(0);
}

static PetscErrorCode Advance(Model *m, PetscInt steps, Outcome *o)
{
  StepReport report;

  PetscFunctionBeginUser;
  const PetscReal start = processor_now();
  while (m->step < steps && !o->gave_up) {
    PetscCall(ModelStep(m, PETSC_MAX_REAL, &report));
    o->gave_up = report.outcome != STEP_ACCEPTED;
  }
  o->seconds = processor_now() - start;
  o->steps = m->step;
  o->iterations = m->total_iterations;
  model_times(m, o->phase);
  PetscFunctionReturn(0);
}

static PetscErrorCode Describe(Model *m, Outcome *o)
{
  const Support *w = m->space->support;

  PetscFunctionBeginUser;
  PetscCall(ModelCountPoints(m, &o->points));
  o->unknowns = m->system->n_active_global * m->system->block;
  o->entries = w->node_start[w->n_groups] * m->points->n / PetscMax(w->n_groups, 1);
  if (w->n_runs) o->entries = w->run[0].nodes * m->points->n;
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    if (!strcmp(m->c->measures[k].name, "way")) PetscCall(ModelMeasure(m, &m->c->measures[k], k, &o->way));
  PetscFunctionReturn(0);
}

static PetscErrorCode Measure(const Plan *plan, const Variant *variant, Outcome *o)
{
  Model *m = NULL;
  Diag *diag;
  Case *c;

  PetscFunctionBeginUser;
  *o = (Outcome){0};
  PetscCall(DiagCreate(&diag));
  PetscCall(ReadCase(plan, variant, diag, &c));
  if (c) PetscCall(ModelCreate(PETSC_COMM_WORLD, c, diag, &m));
  /* the warning that the disk starts within reach of the plane is known */
  if (!m) PetscCall(DiagFlush(diag, stderr));
  PetscCheck(m, PETSC_COMM_WORLD, PETSC_ERR_USER, "the benchmark's case has mistakes: %s", plan->file);
  PetscCall(Advance(m, plan->steps, o));
  PetscCall(Describe(m, o));
  PetscCall(ModelDestroy(&m));
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

static void print_row(const char *name, const Outcome *o, const Outcome *mpm)
{
  const double steps = (double)o->steps;
  PetscReal clock = 0;
  for (int k = 0; k < PHASE_N; ++k) clock += o->phase[k];
  /* phases are timed by the clock */
  const double ms = 1e3 * o->seconds / steps, share = o->seconds / clock;
  printf("%-13s %6.1f %7d %6.2f %8.4f", name, (double)o->entries / (double)o->points, (int)o->unknowns,
         (double)o->iterations / steps, (double)o->way);
  for (int k = 0; k < PHASE_N; ++k) printf(" %10.2f", 1e3 * o->phase[k] * share / steps);
  printf(" %8.2f", ms);
  if (mpm->steps) printf(" %6.2f", ms / (1e3 * mpm->seconds / (double)mpm->steps));
  printf("%s\n", o->gave_up ? "  GAVE UP" : "");
}

static PetscErrorCode RunAll(const Plan *plan, const char *only)
{
  Outcome best[VARIANTS] = {{0}}, o;
  PetscBool chosen[VARIANTS];

  PetscFunctionBeginUser;
  for (size_t k = 0; k < VARIANTS; ++k)
    chosen[k] = !only[0] || !strcmp(only, variants[k].name) || (k == 0 && !plan->alone);
  for (PetscInt round = 0; round < plan->repeat; ++round)
    for (size_t k = 0; k < VARIANTS; ++k) {
      if (!chosen[k]) continue;
      PetscCall(Measure(plan, &variants[k], &o));
      if (round == 0 || o.seconds < best[k].seconds) best[k] = o;
    }
  printf("%d points, cells of %g m, %d steps of %g ms; ms a step, best of %d   [target: gmm / mpm at most 1.5]\n",
         (int)best[0].points, (double)plan->size, (int)plan->steps, 1e3 * (double)plan->step, (int)plan->repeat);
  printf("%-13s %6s %7s %6s %8s", "", "nodes", "dofs", "Newton", "way [m]");
  for (int k = 0; k < PHASE_N; ++k) printf(" %10s", phase_names[k]);
  printf(" %8s %6s\n", "all", "ratio");
  for (size_t k = 0; k < VARIANTS; ++k)
    if (chosen[k]) print_row(variants[k].name, &best[k], &best[0]);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  char file[PETSC_MAX_PATH_LEN] = "cases/rolling-disk/case.yaml", only[32] = "";
  Plan plan = {.file = file, .size = 0.02, .step = 2e-3, .steps = 40, .repeat = 3};

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-size", &plan.size, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-step", &plan.step, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-steps", &plan.steps, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-repeat", &plan.repeat, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-only", only, sizeof only, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-alone", &plan.alone, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-case", file, sizeof file, NULL));
  PetscCall(RunAll(&plan, only));
  PetscCall(PetscFinalize());
  return 0;
}
