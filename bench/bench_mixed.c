/* A nearly incompressible block in three dimensions, clamped below and pressed on half of its top,
 * in one static step of the mixed formulation: linear iterations and the cost of a Newton
 * iteration, iterative against direct solver where both can be had.
 *
 *   build/bench/bench_mixed [-cells 8,12,16] [-hexahedra] [-poisson 0.4999] [-direct_up_to 12] */
#include "bench.h"

typedef struct {
  BenchCase b;
  LoadSpec load;
} BlockCase;

static void block(BlockCase *k, PetscInt n, CellType cell, PetscReal poisson, LinearChoice linear)
{
  bench_case(&k->b, 3, 1e6, poisson);
  k->b.material.law = "neo-hookean-split";
  k->b.body.points_per_cell = cell == CELL_HEXAHEDRON ? 8 : 1;
  for (int d = 0; d < 3; ++d) {
    k->b.body.shape.max[d] = k->b.c.grid.max[d] = 1;
    k->b.c.grid.counts[d] = n;
  }
  k->b.c.analysis = (AnalysisSpec){
    .type = ANALYSIS_STATIC, .end = 1, .step = 1, .smallest = 1.0 / 1024, .largest = 1, .beta = 0.25, .gamma = 0.5};
  k->b.c.grid.cell = cell;
  k->b.c.method = "fem";
  k->b.c.formulation = "mixed";
  k->b.c.mixed.stabilisation = 8;
  k->b.motion.on.has[2] = 1; /* z = 0 */
  k->load = (LoadSpec){.kind = LOAD_TRACTION, .value = {0, 0, -5e4}};
  k->load.on.has[0] = k->load.on.has[2] = 1;
  k->load.on.max[0] = 0.5;
  k->load.on.min[2] = k->load.on.max[2] = 1;
  k->b.c.n_loads = 1;
  k->b.c.loads = &k->load;
  k->b.c.linear = linear;
}

static PetscErrorCode Measure(PetscInt n, CellType cell, PetscReal poisson, LinearChoice linear)
{
  BlockCase k;
  Subject s;
  StepReport report;
  PetscReal phase[PHASE_N];

  PetscFunctionBeginUser;
  block(&k, n, cell, poisson, linear);
  PetscCall(SubjectCreate(&k.b.c, &s));
  const PetscReal start = seconds_now(), worked = processor_now();
  PetscCall(ModelStep(s.model, 1, &report));
  const PetscReal total = seconds_now() - start, work = processor_now() - worked;
  PetscCheck(report.outcome == STEP_ACCEPTED, PETSC_COMM_WORLD, PETSC_ERR_NOT_CONVERGED, "%s", report.reason);
  model_times(s.model, phase);
  PetscCall(
    PetscPrintf(PETSC_COMM_WORLD,
                "%6d cells %8d unknowns  %-46s %d Newton, %.1f linear iterations each; %.2f s (processor %.2f), "
                "linear %.2f, points %.2f; %.0f MB\n",
                (int)s.model->grid->n_cells_global, (int)(s.model->system->n_active_global * 4),
                newton_linear_name(s.model->newton), (int)report.newton.iterations,
                (double)report.newton.linear_iterations / (double)report.newton.iterations, (double)total, (double)work,
                (double)phase[PHASE_LINEAR], (double)phase[PHASE_POINTS], (double)(resident_bytes() * 1e-6)));
  PetscCall(SubjectDestroy(&s));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscInt cells_per_side[8] = {8, 12, 16}, n = 8, direct_up_to = 12;
  PetscReal poisson = 0.4999;
  PetscBool given, hexahedra = PETSC_FALSE;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetIntArray(NULL, NULL, "-cells", cells_per_side, &n, &given));
  if (!given) n = 3;
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-direct_up_to", &direct_up_to, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-poisson", &poisson, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-hexahedra", &hexahedra, NULL));
  for (PetscInt k = 0; k < n; ++k) {
    const CellType cell = hexahedra ? CELL_HEXAHEDRON : CELL_TETRAHEDRON;
    PetscCall(Measure(cells_per_side[k], cell, poisson, LINEAR_ITERATIVE));
    if (cells_per_side[k] <= direct_up_to) PetscCall(Measure(cells_per_side[k], cell, poisson, LINEAR_DIRECT));
  }
  PetscCall(PetscFinalize());
  return 0;
}
