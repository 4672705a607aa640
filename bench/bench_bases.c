/* What averaged functions and splines cost in space beside linear ones, on the same cells: a ball that hits a
 * floor, and a beam that statics bends.
 *
 *   build/bench/bench_bases [-repeat 3] [-case FILE] [-transfer consistent]
 *
 * The bases take turns in one run and the best of several rounds counts, in seconds that a core worked for this
 * process; ratios are to linear functions. Nodes, blocks: what a point sees, and pairs in half a tangent. */
#include "bench.h"
#include "input/case_file.h"

static const char *const bases[] = {"cell", "gimp", "bspline"};
enum { N_BASES = 3 };

typedef struct {
  PetscReal seconds, phase[PHASE_N], tip, nodes, blocks;
  PetscInt steps, iterations, points, unknowns;
} Outcome;

static PetscErrorCode Begin(const char *file, const char *basis, Diag *diag, Case **c, Model **m)
{
  char text[32], name[32] = "", transfer[64];
  const char *const set[] = {text, transfer};

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-transfer", name, sizeof name, NULL));
  snprintf(text, sizeof text, "basis={%s: {}}", basis);
  snprintf(transfer, sizeof transfer, "analysis.transfer=%s", name);
  PetscCall(CaseRead(PETSC_COMM_WORLD, file, name[0] ? 2 : 1, set, diag, c));
  *m = NULL;
  if (*c) PetscCall(ModelCreate(PETSC_COMM_WORLD, *c, diag, m));
  if (!*m) PetscCall(DiagFlush(diag, stderr));
  PetscCheck(*m, PETSC_COMM_WORLD, PETSC_ERR_USER, "the benchmark's case has mistakes: %s", file);
  PetscFunctionReturn(0);
}

/* Of the last step: what a point sees. */
static PetscErrorCode Describe(Model *m, Outcome *o)
{
  const Support *w = m->space->support;

  PetscFunctionBeginUser;
  PetscCall(ModelCountPoints(m, &o->points));
  o->unknowns = m->system->n_active_global * m->system->block;
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscReal nn = (PetscReal)support_nodes(w, g);
    o->nodes += nn * (PetscReal)(w->point_start[g + 1] - w->point_start[g]) / (PetscReal)m->points->n;
    o->blocks += nn * (nn + 1) / 2 / (PetscReal)m->points->n;
  }
  PetscCall(ModelMeasure(m, &m->c->measures[0], 0, &o->tip));
  PetscFunctionReturn(0);
}

static PetscErrorCode Measure(const char *file, const char *basis, Outcome *o)
{
  StepReport report = {.outcome = STEP_ACCEPTED};
  Model *m;
  Diag *diag;
  Case *c;

  PetscFunctionBeginUser;
  *o = (Outcome){0};
  PetscCall(DiagCreate(&diag));
  PetscCall(Begin(file, basis, diag, &c, &m));
  const PetscReal start = processor_now();
  for (; m->time < (1 - 1e-9) * c->analysis.end; ++o->steps) {
    PetscCall(ModelStep(m, PETSC_MAX_REAL, &report));
    PetscCheck(report.outcome == STEP_ACCEPTED, PETSC_COMM_WORLD, PETSC_ERR_NOT_CONVERGED, "%s", report.reason);
  }
  o->seconds = processor_now() - start;
  o->iterations = m->total_iterations;
  model_times(m, o->phase);
  PetscCall(Describe(m, o));
  PetscCall(ModelDestroy(&m));
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

static void print_row(const char *name, const Outcome *o, const Outcome *linear)
{
  PetscReal clock = 0;
  for (int k = 0; k < PHASE_N; ++k) clock += o->phase[k];
  const double share = 1e3 * o->seconds / clock / (double)o->iterations; /* phases are timed by the clock */
  printf("%-8s %6.1f %6.0f %7d %7d %12.9f", name, (double)o->nodes, (double)o->blocks, (int)o->unknowns,
         (int)o->iterations, (double)o->tip);
  for (int k = 0; k < PHASE_N; ++k) printf(" %10.2f", o->phase[k] * share);
  printf(" %8.2f %6.2f\n", 1e3 * o->seconds / (double)o->iterations, (double)(o->seconds / linear->seconds));
}

static PetscErrorCode Compare(const char *file, PetscInt repeat)
{
  Outcome best[N_BASES], o;

  PetscFunctionBeginUser;
  for (PetscInt round = 0; round < repeat; ++round)
    for (int k = 0; k < N_BASES; ++k) {
      PetscCall(Measure(file, bases[k], &o));
      if (round == 0 || o.seconds < best[k].seconds) best[k] = o;
    }
  printf("%s: %d points, %d steps; ms an iteration, ratio of all, best of %d   [target: gimp 2.5]\n", file,
         (int)best[0].points, (int)best[0].steps, (int)repeat);
  printf("%-8s %6s %6s %7s %7s %12s", "", "nodes", "blocks", "dofs", "Newton", "tip [m]");
  for (int k = 0; k < PHASE_N; ++k) printf(" %10s", phase_names[k]);
  printf(" %8s %6s\n", "all", "ratio");
  for (int k = 0; k < N_BASES; ++k) print_row(bases[k], &best[k], &best[0]);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  char file[PETSC_MAX_PATH_LEN] = "";
  PetscInt repeat = 3;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-repeat", &repeat, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-case", file, sizeof file, NULL));
  if (file[0]) PetscCall(Compare(file, repeat));
  if (!file[0]) PetscCall(Compare("bench/bases-ball.yaml", repeat));
  if (!file[0]) PetscCall(Compare("bench/bases-beam.yaml", repeat));
  PetscCall(PetscFinalize());
  return 0;
}
