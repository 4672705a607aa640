/* What the ranks say to each other in a step, by phase: messages, bytes, collective calls; and what
 * it costs to share the grid anew. Counts, not seconds: more ranks than cores do no harm.
 * docs/scaling.md has the table and what it means for 1,000 ranks.
 *
 *   mpiexec --oversubscribe -n 4 build/bench/bench_messages [-dim 2] [-points 10000] [-per_rank
 *   2500] [-steps 5] [-mesh] [-explicit]
 *
 * -points: of the whole body; -per_rank instead: of each rank. -mesh: the grid comes from a
 * file. -explicit: explicit dynamics, in whose run a step is eight implicit ones, and counts are those of a substep. */
#include "messages.h"

#include "box_mesh.h"

static Model *model; /* whose clocks tell the phases */

static void clock_of_model(double seconds[MESSAGE_PHASES]) { model_times(model, seconds); }

static PetscBool is_explicit(void) { return model->c->analysis.type == ANALYSIS_EXPLICIT ? PETSC_TRUE : PETSC_FALSE; }

/* Times that Newton takes apart begin and end inside a solve. */
static int takes_all(int phase) { return phase != PHASE_POINTS && phase != PHASE_MATRIX && phase != PHASE_LINEAR; }

typedef struct {
  PetscInt steps, newton, linear;
  PetscReal count[PHASE_N + 1][4]; /* largest of the ranks, per step or substep */
  PetscReal partners, points, bytes;
} Result;

static PetscErrorCode Count(PetscInt steps, Result *r)
{
  StepReport report;
  PetscReal partners = 0;

  PetscFunctionBeginUser;
  *r = (Result){.steps = steps};
  PetscCall(ModelStep(model, 1, &report)); /* the first makes the pattern */
  const PetscInt before = model->total_iterations;
  message_begin(PHASE_N, clock_of_model, takes_all);
  for (PetscInt s = 0; s < steps; ++s) {
    PetscCall(ModelStep(model, 1, &report));
    PetscCheck(report.outcome == STEP_ACCEPTED, PETSC_COMM_WORLD, PETSC_ERR_NOT_CONVERGED, "%s", report.reason);
    r->linear += report.newton.linear_iterations;
  }
  message_end();
  r->newton = model->total_iterations - before; /* explicit: substeps */
  const PetscReal times = (PetscReal)(is_explicit() ? r->newton : steps);
  for (int k = 0; k <= PHASE_N; ++k) {
    const MessageCount *c = &messages.phase[k];
    const PetscReal mine[4] = {c->messages, c->bytes, c->collectives, c->shared_bytes};
    for (int i = 0; i < 4; ++i) r->count[k][i] = mine[i] / times;
  }
  for (int k = 0; k < MESSAGE_RANKS; ++k) partners += messages.partner[k];
  r->partners = partners;
  r->points = (PetscReal)model->points->n;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r->count, 4 * (PHASE_N + 1), MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &r->partners, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

static PetscErrorCode Print(const Result *r)
{
  PetscReal sum[4] = {0, 0, 0, 0};
  PetscInt points;
  PetscMPIInt ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  PetscCall(ModelCountPoints(model, &points));
  const double inner = (double)r->newton / (double)r->steps, linear = (double)r->linear / (double)r->steps;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                        "\n%d ranks, %d points, at most %.0f on a rank, which talks to %.0f others; a step has ",
                        (int)ranks, (int)points, (double)r->points, (double)r->partners));
  if (is_explicit()) PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%.1f substeps\n  per substep      ", inner));
  else
    PetscCall(
      PetscPrintf(PETSC_COMM_WORLD, "%.1f Newton and %.1f linear iterations\n  per step         ", inner, linear));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "   messages     bytes  collectives     bytes\n"));
  for (int k = 0; k <= PHASE_N; ++k) {
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  %-18s %9.1f %9.0f %12.1f %9.0f\n", k < PHASE_N ? phase_names[k] : "rest",
                          (double)r->count[k][0], (double)r->count[k][1], (double)r->count[k][2],
                          (double)r->count[k][3]));
    for (int i = 0; i < 4; ++i) sum[i] += r->count[k][i];
  }
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  %-18s %9.1f %9.0f %12.1f %9.0f\n", "all", (double)sum[0], (double)sum[1],
                        (double)sum[2], (double)sum[3]));
  PetscFunctionReturn(0);
}

static PetscErrorCode ShareBy(PetscBool points, PetscInt *moved)
{
  PetscReal *weight, reached;
  Grid *grid;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(model->grid->n_cells, &weight));
  for (PetscInt c = 0; c < model->grid->n_cells; ++c) weight[c] = points ? 0 : 1;
  for (PetscInt p = 0; points && p < model->points->n; ++p) weight[model->points->cell[p]] += 1;
  PetscCall(GridRepartition(model->grid, weight, PETSC_MAX_REAL, &reached, &grid));
  PetscCall(PetscFree(weight));
  PetscCall(ModelRegrid(model, grid, moved));
  PetscCall(model->method->initialise(model->space));
  PetscFunctionReturn(0);
}

/* Share the grid by cells alone, which moves many points, and back by points: seconds of processor
 * of one such sharing and of the pattern that the step after it makes, over those of a step. */
static PetscErrorCode Repartition(void)
{
  PetscReal seconds[2] = {0, 0};
  PetscInt moved = 0, all, points;
  StepReport report;

  PetscFunctionBeginUser;
  PetscCall(ShareBy(PETSC_FALSE, &moved));
  PetscCall(ModelStep(model, 1, &report));
  const PetscReal start = processor_now();
  PetscCall(ShareBy(PETSC_TRUE, &moved));
  PetscCall(ModelStep(model, 1, &report));
  const PetscReal middle = processor_now();
  for (int k = 0; k < 3; ++k) PetscCall(ModelStep(model, 1, &report));
  seconds[1] = (processor_now() - middle) / 3;
  seconds[0] = middle - start - seconds[1];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, seconds, 2, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(&moved, &all, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(ModelCountPoints(model, &points));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                        "  sharing anew moves %.0f %% of the points and takes as much processor time as %.1f steps\n",
                        100.0 * all / points, (double)(seconds[0] / seconds[1])));
  PetscFunctionReturn(0);
}

static void make_explicit(Case *c)
{
  c->analysis.type = ANALYSIS_EXPLICIT;
  c->analysis.step = c->analysis.largest = 8 * c->analysis.step;
  c->basis.kind = "cell";
}

int main(int argc, char **argv)
{
  PetscInt points = 10000, per_rank = 0, dim = 2, steps = 5;
  PetscBool mesh = PETSC_FALSE, explicitly = PETSC_FALSE;
  PetscMPIInt ranks;
  char path[64];
  BenchCase b;
  Subject s;
  Result r;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-points", &points, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-per_rank", &per_rank, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-dim", &dim, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-steps", &steps, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-mesh", &mesh, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-explicit", &explicitly, NULL));
  if (per_rank) points = per_rank * ranks;
  const PetscReal n = PetscPowReal((PetscReal)points / (dim == 2 ? 4 : 8), 1.0 / (PetscReal)dim);
  bench_landing_block(&b, dim, (PetscInt)(n + 0.5), (PetscInt)(n + 0.5) / 4, 2);
  if (explicitly) make_explicit(&b.c);
  if (mesh) PetscCall(BoxToMesh(&b, sizeof path, path));
  PetscCall(SubjectCreate(&b.c, &s));
  if (mesh) (void)unlink(path); /* by whoever is first */
  model = s.model;
  PetscCall(Count(steps, &r));
  PetscCall(Print(&r));
  if (!explicitly) PetscCall(Repartition());
  PetscCall(SubjectDestroy(&s));
  PetscCall(PetscFinalize());
  return 0;
}
