/* What a substep of explicit dynamics costs: 0.5 s of collapse of the column of cases/granular-collapse with a
 * row every 10 ms, and blocks of Mohr-Coulomb material that slide, in the plane and in space.
 *
 *   build/bench/bench_explicit [-only column|plane|space|gimp|walls|loads] [-cells N] [-steps N] [-anew]
 *                              [-case cases/granular-collapse/case.yaml] [-bound PROGRAM]
 *
 * Blocks of about 100,000 points, or of N cells along each side (500 in the plane and 50 in space: a million
 * points), for so many steps of the run; over nodes that are held or over a wall with friction, or under a pressure.
 * -anew: points find their functions anew in every substep, as they do where there is no faster way. PROGRAM:
 * explicit_bound or another, to be run between two columns with arguments "1e-4 0.5 20 1 1 1.5"; it prints its own
 * time. Seconds are those in which a core worked for this process, of the slowest rank. */
#include "bench.h"
#include "input/case_file.h"
#include "model/explicit/explicit.h"

typedef struct {
  PetscReal seconds, front;
  PetscInt substeps, points;
} Outcome;

static PetscErrorCode Advance(Model *m, PetscReal end, Outcome *o)
{
  StepReport report = {0};

  PetscFunctionBeginUser;
  PetscCall(ModelCountPoints(m, &o->points));
  const PetscReal start = processor_now();
  while (m->time < end * (1 - 1e-12) && report.outcome == STEP_ACCEPTED)
    PetscCall(ModelStep(m, end - m->time, &report));
  o->seconds = processor_now() - start;
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &o->seconds, 1, MPIU_REAL, MPI_MAX, m->comm));
  o->substeps = m->total_iterations;
  for (PetscInt p = 0; p < m->points->n; ++p) o->front = PetscMax(o->front, *point_real(m->points, POINT_X, p));
  if (report.outcome != STEP_ACCEPTED) PetscCall(PetscPrintf(m->comm, "gave up: %s\n", report.reason));
  PetscFunctionReturn(0);
}

static PetscErrorCode Collapse(const char *file)
{
  const char *const set[] = {"analysis.type=explicit", "analysis.step=0.01", "analysis.end=0.5"};
  Outcome o = {0};
  Diag *diag;
  Case *c;
  Model *m = NULL;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&diag));
  PetscCall(CaseRead(PETSC_COMM_WORLD, file, 3, set, diag, &c));
  if (c) PetscCall(ModelCreate(PETSC_COMM_WORLD, c, diag, &m));
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  if (m) PetscCall(Advance(m, 0.5, &o));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                        "column: %d points, %d substeps in %.3f s, %.1f ns a point and substep; front %.4f m\n",
                        (int)o.points, (int)o.substeps, (double)o.seconds,
                        1e9 * (double)o.seconds / ((double)o.points * (double)o.substeps), (double)o.front));
  if (m) PetscCall(ModelDestroy(&m));
  if (c) PetscCall(CaseDestroy(&c));
  PetscFunctionReturn(0);
}

/* Nanoseconds of a core for a point and substep. */
static double nanoseconds(const Model *m, const Outcome *o)
{
  PetscMPIInt ranks;
  if (MPI_Comm_size(m->comm, &ranks)) ranks = 1;
  return 1e9 * (double)ranks * (double)o->seconds / ((double)o->points * (double)o->substeps);
}

/* A block that slides over a floor under gravity. */
typedef struct {
  const char *word, *basis;
  PetscInt dim;
  PetscBool wall, pressed;
} Block;

static const Block blocks[] = {
  {"plane", "cell", 2, PETSC_FALSE, PETSC_FALSE}, {"gimp", "gimp", 2, PETSC_FALSE, PETSC_FALSE},
  {"space", "cell", 3, PETSC_FALSE, PETSC_FALSE}, {"walls", "cell", 2, PETSC_TRUE, PETSC_FALSE},
  {"walls", "gimp", 2, PETSC_TRUE, PETSC_FALSE},  {"walls", "cell", 3, PETSC_TRUE, PETSC_FALSE},
  {"loads", "cell", 2, PETSC_FALSE, PETSC_TRUE},  {"loads", "cell", 3, PETSC_FALSE, PETSC_TRUE}};

static void block_case(const Block *block, PetscInt cells_of_side, BenchCase *b, WallSpec *wall)
{
  static NamedValue grains[] = {
    {"young", 1e6}, {"poisson", 0.3}, {"friction_angle", 31}, {"dilatancy_angle", 1}, {"cohesion", 0}};
  const PetscReal h = 1. / (PetscReal)cells_of_side;
  bench_case(b, block->dim, 1e6, 0.3);
  b->material =
    (MaterialSpec){.name = "rubber", .law = "mohr-coulomb", .density = 2000, .n_parameters = 5, .parameters = grains};
  for (PetscInt d = 0; d < block->dim; ++d) {
    b->c.grid.max[d] = d == 0 ? 1.5 : 1 + 2 * h;
    b->c.grid.counts[d] = (PetscInt)(b->c.grid.max[d] / h + 0.5);
    b->c.grid.grading[d] = 1;
    b->body.shape.max[d] = 1;
  }
  b->c.analysis = (AnalysisSpec){.type = ANALYSIS_EXPLICIT, .end = 1, .step = 150 * 0.5 * h / 30};
  b->c.analysis.largest = b->c.analysis.step;
  b->c.basis.kind = block->basis;
  b->motion.on.has[1] = PETSC_TRUE;
  b->c.gravity[block->dim - 1] = 0;
  b->c.gravity[1] = -9.81;
  if (block->pressed) {
    static LoadSpec load;
    load = (LoadSpec){.kind = LOAD_PRESSURE, .value = {1000}};
    load.on.body = b->body.name;
    load.on.has[1] = PETSC_TRUE;
    load.on.min[1] = load.on.max[1] = 1;
    b->c.loads = &load;
    b->c.n_loads = 1;
  }
  if (!block->wall) return;
  *wall = (WallSpec){
    .name = (char *)"floor", .shape = {.kind = SHAPE_HALF_SPACE}, .contact = CONTACT_FRICTION, .friction = 0.3};
  wall->shape.normal[1] = 1;
  b->c.n_walls = 1;
  b->c.walls = wall;
  b->c.n_boundary = 0;
}

static PetscErrorCode Slide(const Block *block, PetscInt cells_of_side, PetscInt steps, PetscBool anew)
{
  Outcome o = {0};
  BenchCase b;
  WallSpec wall;
  Diag *diag;
  Model *m = NULL;

  PetscFunctionBeginUser;
  block_case(block, cells_of_side, &b, &wall);
  PetscCall(DiagCreate(&diag));
  PetscCall(ModelCreate(PETSC_COMM_WORLD, &b.c, diag, &m));
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  if (!m) PetscFunctionReturn(0);
  PetscCall(ExplicitCreate(m, &m->explicit));
  m->explicit->box = m->explicit->box && !anew;
  PetscCall(Advance(m, (PetscReal)steps * b.c.analysis.step, &o));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                        "%dD, %s, %s: %d points, %d substeps, %.1f ns a point and substep, %d bytes a point\n",
                        (int)block->dim, strcmp(block->basis, "cell") ? block->basis : "linear",
                        block->pressed ? "pressed on held nodes"
                        : block->wall  ? "over a wall"
                                       : "over held nodes",
                        (int)o.points, (int)o.substeps, nanoseconds(m, &o), (int)points_bytes(m->points)));
  PetscCall(ModelDestroy(&m));
  PetscFunctionReturn(0);
}

/* Column, bound, column. */
static PetscErrorCode Columns(const char *file, const char *bound)
{
  char command[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(Collapse(file));
  snprintf(command, sizeof command, "%s 1e-4 0.5 20 1 1 1.5", bound);
  if (bound[0] && system(command)) PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s failed\n", bound));
  PetscCall(Collapse(file));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  char file[PETSC_MAX_PATH_LEN] = "cases/granular-collapse/case.yaml", bound[PETSC_MAX_PATH_LEN - 32] = "";
  char only[16] = "";
  PetscInt side = 0, steps = 4;
  PetscBool anew = PETSC_FALSE;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-case", file, sizeof file, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-bound", bound, sizeof bound, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-only", only, sizeof only, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-cells", &side, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-steps", &steps, NULL));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-anew", &anew));
  if (!only[0] || !strcmp(only, "column")) PetscCall(Columns(file, bound));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(blocks); ++k)
    if (!only[0] || !strcmp(only, blocks[k].word))
      PetscCall(Slide(&blocks[k], side ? side : blocks[k].dim == 2 ? 160 : 24, steps, anew));
  return PetscFinalize();
}
