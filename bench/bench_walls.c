/* What a floor costs as a wall, beside the same floor as held nodes: a column of 3600 grains' points that runs out,
 * without friction on nodes that slide, with 0.6 on nodes that stick.
 *
 *   build/bench/bench_walls [-steps 150] [-friction 0.6] [-size 0.003] [-case cases/dry-column/case.yaml]
 *
 * Both take turns, ten steps at a time, in seconds that a core worked for this process. Iterations and assemblies
 * (passes over all points) are counts, the same on every machine: those of the wall may be 1.3 times those of the
 * nodes, and a step 1.2 times as long. */
#include "bench.h"
#include "input/case_file.h"

enum { TURN = 10, N_SET = 5 };

/* How many passes the model that is stepping has asked for. */
static struct {
  const Formulation *own;
  PetscInt passes;
} counted;

typedef struct {
  Diag *diag;
  Case *c;
  Model *model;
  Formulation formulation; /* its own, counted */
  const Formulation *own;
  PetscReal seconds;
  PetscInt passes;
} Floor;

static PetscErrorCode AssembleCounted(const WeakFormInput *in, WeakFormOutput *out)
{
  PetscFunctionBeginUser;
  ++counted.passes;
  PetscCall(counted.own->assemble(in, out));
  PetscFunctionReturn(0);
}

static PetscErrorCode Begin(const char *file, PetscReal size, PetscBool wall, PetscReal friction, Floor *f)
{
  char grid[128], law[64], held[160];
  const char *const set[N_SET] = {
    grid,
    "bodies=[{name: column, shape: {box: {min: [0, 0], max: [0.09, 0.09]}}, points_per_cell: 4, material: grains}]",
    "measures=null", law, held};

  PetscFunctionBeginUser;
  snprintf(grid, sizeof grid, "grid={box: {min: [0, -0.009], max: [0.72, 0.111]}, size: %g, cell: quadrilateral}",
           (double)size);
  snprintf(law, sizeof law, wall ? "walls[0].friction=%g" : "walls=null", (double)friction);
  snprintf(held, sizeof held,
           "boundary=[{name: back, on: {boundary: left}, fix: [x]}, {name: low, on: {y: %s}, fix: [%s]}]",
           wall ? "-0.009" : "0", friction > 0 ? "x, y" : "y");
  *f = (Floor){0};
  PetscCall(DiagCreate(&f->diag));
  PetscCall(CaseRead(PETSC_COMM_WORLD, file, N_SET, set, f->diag, &f->c));
  if (f->c) PetscCall(ModelCreate(PETSC_COMM_WORLD, f->c, f->diag, &f->model));
  PetscCall(DiagFlush(f->diag, stderr));
  PetscCheck(f->model, PETSC_COMM_WORLD, PETSC_ERR_USER, "the benchmark's case has mistakes: %s", file);
  f->own = f->model->formulation;
  f->formulation = *f->own;
  f->formulation.assemble = AssembleCounted;
  f->model->formulation = &f->formulation;
  PetscFunctionReturn(0);
}

static PetscErrorCode Advance(Floor *f, PetscInt until)
{
  StepReport report;
  const PetscReal step = f->c->analysis.step, start = processor_now();

  PetscFunctionBeginUser;
  counted.own = f->own;
  counted.passes = 0;
  while (f->model->time < (PetscReal)until * step * (1 - 1e-12)) {
    PetscCall(ModelStep(f->model, (PetscReal)until * step - f->model->time, &report));
    PetscCheck(report.outcome == STEP_ACCEPTED, PETSC_COMM_WORLD, PETSC_ERR_NOT_CONVERGED, "%s", report.reason);
  }
  f->seconds += processor_now() - start;
  f->passes += counted.passes;
  PetscFunctionReturn(0);
}

static void print_row(PetscReal friction, const Floor f[2])
{
  const Model *nodes = f[0].model, *wall = f[1].model;
  printf("%8g %6d %9d %6d %6.2f %9d %6d %6.2f %9.2f %6.2f %6.2f %5d %4d\n", (double)friction, (int)wall->step,
         (int)nodes->total_iterations, (int)wall->total_iterations,
         (double)wall->total_iterations / (double)nodes->total_iterations, (int)f[0].passes, (int)f[1].passes,
         (double)f[1].passes / (double)f[0].passes, (double)f[0].seconds, (double)f[1].seconds,
         (double)(f[1].seconds / f[0].seconds), (int)nodes->cuts, (int)wall->cuts);
  fflush(stdout);
}

static PetscErrorCode Compare(const char *file, PetscReal size, PetscReal friction, PetscInt steps)
{
  Floor f[2];

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; ++k) PetscCall(Begin(file, size, (PetscBool)k, friction, f + k));
  for (PetscInt until = TURN; until <= steps; until += TURN) {
    for (int k = 0; k < 2; ++k) PetscCall(Advance(f + k, until));
    if (until == steps / 3 / TURN * TURN || until == steps) print_row(friction, f);
  }
  for (int k = 0; k < 2; ++k) {
    PetscCall(ModelDestroy(&f[k].model));
    PetscCall(CaseDestroy(&f[k].c));
    PetscCall(DiagDestroy(&f[k].diag));
  }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  char file[PETSC_MAX_PATH_LEN] = "cases/dry-column/case.yaml";
  PetscReal friction = 0.6, size = 0.003;
  PetscInt steps = 150;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-steps", &steps, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-friction", &friction, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-size", &size, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-case", file, sizeof file, NULL));
  steps = PetscMax(TURN, steps / TURN * TURN);
  printf(
    "friction  steps  Newton: nodes, wall, ratio  passes: nodes, wall, ratio  seconds: nodes, wall, ratio  halvings\n");
  PetscCall(Compare(file, size, 0, steps));
  PetscCall(Compare(file, size, friction, steps));
  PetscCall(PetscFinalize());
  return 0;
}
