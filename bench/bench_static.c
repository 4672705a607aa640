/* Cantilever under its own weight in one static step, direct solver: the cost of a Newton
 * iteration, and what it is beside the factorisation of its matrix and the bytes that it must move.
 *
 *   build/bench/bench_static [-spacings 0.0625,0.03125] [-repeat 5] */
#include "bench.h"

static void cantilever(BenchCase *b, PetscReal h)
{
  bench_case(b, 2, 90e6, 0);
  b->body.shape.max[0] = 8;
  b->body.shape.max[1] = 1;
  b->motion.on.has[0] = 1;
  b->c.analysis = (AnalysisSpec){
    .type = ANALYSIS_STATIC, .end = 1, .step = 1, .smallest = 1.0 / 1024, .largest = 1, .beta = 0.25, .gamma = 0.5};
  b->c.grid.min[1] = -1.5;
  b->c.grid.max[0] = 8.5;
  b->c.grid.max[1] = 1.5;
  b->c.grid.counts[0] = (PetscInt)(8.5 / h + 0.5);
  b->c.grid.counts[1] = (PetscInt)(3 / h + 0.5);
  b->c.linear = LINEAR_DIRECT;
}

/* Numeric factorisation alone, the analysis of the pattern kept: best of several. */
static PetscErrorCode FactorMeasure(Model *m, PetscInt repeats, PetscReal *seconds)
{
  const LinearProblem problem = {.choice = LINEAR_DIRECT, .dim = m->dim, .symmetric = m->symmetric};
  Mat A = m->system->matrix;
  PetscBool direct;
  const char *name;
  KSP ksp;

  PetscFunctionBeginUser;
  PetscCall(MatSetOption(A, MAT_SYMMETRIC, m->symmetric));
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &ksp));
  PetscCall(LinearConfigure(ksp, &problem, &direct, &name));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPSetUp(ksp));
  *seconds = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < repeats; ++k) {
    PetscCall(SystemToMatrix(m->system)); /* the values count as new */
    PetscCall(KSPSetOperators(ksp, A, A));
    const PetscReal start = seconds_now();
    PetscCall(KSPSetUp(ksp));
    *seconds = PetscMin(*seconds, seconds_now() - start);
  }
  PetscCall(KSPDestroy(&ksp));
  PetscFunctionReturn(0);
}

typedef struct {
  PetscReal total, phase[PHASE_N];
  PetscInt iterations, points, unknowns;
  PetscReal factor, table, support, resident;
  Pass pass;
} Result;

static PetscErrorCode Measure(PetscReal h, PetscInt repeats, Result *r)
{
  BenchCase b;
  Subject s;
  StepReport report;

  PetscFunctionBeginUser;
  cantilever(&b, h);
  PetscCall(SubjectCreate(&b.c, &s));
  PetscCall(PassMeasure(s.model, 0, 4 * repeats, &r->pass));
  PetscCall(FactorMeasure(s.model, repeats, &r->factor));
  PetscCall(SubjectDestroy(&s));
  r->total = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < repeats; ++k) {
    PetscCall(SubjectCreate(&b.c, &s));
    const PetscReal start = seconds_now();
    PetscCall(ModelStep(s.model, 1, &report));
    const PetscReal total = seconds_now() - start;
    PetscCheck(report.outcome == STEP_ACCEPTED, PETSC_COMM_WORLD, PETSC_ERR_NOT_CONVERGED, "%s", report.reason);
    if (total < r->total) {
      r->total = total;
      model_times(s.model, r->phase);
    }
    /* later ones reuse freed memory */
    if (k == 0) r->resident = (resident_bytes() - s.bytes_before) / s.points;
    r->iterations = report.newton.iterations;
    r->points = s.points;
    r->unknowns = s.model->system->n_active_global * s.model->dim;
    r->table = table_bytes(s.model);
    r->support = support_bytes(s.model);
    PetscCall(SubjectDestroy(&s));
  }
  PetscFunctionReturn(0);
}

static void print_row(PetscReal h, const Result *r, PetscReal bandwidth)
{
  const PetscReal pass = r->pass.points + r->pass.matrix, its = (PetscReal)r->iterations;
  const PetscReal split = r->phase[PHASE_POINTS] + r->phase[PHASE_MATRIX] + r->phase[PHASE_LINEAR];
  printf("\nh = %g m: %d points, %d unknowns, %d iterations in one step\n", h, (int)r->points, (int)r->unknowns,
         (int)r->iterations);
  printf("  per iteration [ms]     points+blocks %.3f   matrix %.3f   linear %.3f   rest %.3f   all %.3f\n",
         1e3 * r->phase[PHASE_POINTS] / its, 1e3 * r->phase[PHASE_MATRIX] / its, 1e3 * r->phase[PHASE_LINEAR] / its,
         1e3 * (r->total - split) / its, 1e3 * r->total / its);
  printf("  one pass [ms]          points+blocks %.3f   matrix %.3f   numeric factorisation %.3f\n",
         1e3 * r->pass.points, 1e3 * r->pass.matrix, 1e3 * r->factor);
  printf("  point evaluations      %.2f million/s with the scatter into blocks, %.2f with the matrix   [target 2]\n",
         1e-6 * r->points / r->pass.points, 1e-6 * r->points / pass);
  printf("  pass / factorisation   %.1f %%   [target 25 %%]\n", 100 * pass / r->factor);
  printf("  pass / triad bound     %.1f   (%.1f MB at %.1f GB/s: %.3f ms)\n", pass * bandwidth / r->pass.bytes,
         1e-6 * r->pass.bytes, 1e-9 * bandwidth, 1e3 * r->pass.bytes / bandwidth);
  printf(
    "  bytes a point          %.0f in the table + %.0f of shape functions [target 400]; %.0f resident with grid, "
    "matrix and factor\n",
    r->table, r->support, r->resident);
}

int main(int argc, char **argv)
{
  PetscReal h[8] = {0.0625, 0.03125}, bandwidth = 0;
  PetscInt n = 8, repeats = 5;
  PetscBool given;
  Result r;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetRealArray(NULL, NULL, "-spacings", h, &n, &given));
  if (!given) n = 2;
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-repeat", &repeats, NULL));
  PetscCall(TriadMeasure(&bandwidth));
  printf("cantilever, statics, Neo-Hooke, quadrilaterals with 4 points; best of %d\n", (int)repeats);
  for (PetscInt k = 0; k < n; ++k) {
    PetscCall(Measure(h[k], repeats, &r));
    print_row(h[k], &r, bandwidth);
  }
  PetscCall(PetscFinalize());
  return 0;
}
