/* A block of points with domains that ends by a share of a cell beyond a line of the grid: the
 * condition number of its stiffness as that goes to zero, where nodes that are hardly reached follow
 * others, where they are held, and without. All eigenvalues, dense.
 *
 *   build/bench/bench_cut [-picture cut.png] */
#include "bench.h"
#include "picture/figure.h"

#define CUTS 25
#define WAYS 3

static const StabilisationSpec ways[] = {{.curvature = 0.01, .follow = 0.02}, {.curvature = 0.01}, {.stiffness = 0}};
static const char *const name[] = {"follow: 0.02", "curvature: 0.01", "neither"};

/* Eight cells a side on the floor of a grid that is larger. */
static void block(BenchCase *b, StabilisationSpec way)
{
  bench_block(b, 2, 8, 4);
  b->body.shape.min[1] = 0;
  b->body.shape.max[1] = 1;
  b->c.analysis = (AnalysisSpec){
    .type = ANALYSIS_STATIC, .end = 1, .step = 1, .smallest = 1.0 / 1024, .largest = 1, .beta = 0.25, .gamma = 0.5};
  b->c.linear = LINEAR_DIRECT;
  b->c.basis.kind = "gimp";
  b->c.stabilisation.follow = way.follow;
  b->c.stabilisation.curvature = way.curvature;
}

/* Unknowns that are not prescribed: the rows of others have their diagonal alone. */
static PetscErrorCode Unknowns(Mat A, IS *unknowns)
{
  PetscInt n, kept = 0, *list, columns;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(A, &n, NULL));
  PetscCall(PetscMalloc1(n, &list));
  for (PetscInt i = 0; i < n; ++i) {
    const PetscScalar *value;
    PetscInt entries = 0;
    PetscCall(MatGetRow(A, i, &columns, NULL, &value));
    for (PetscInt k = 0; k < columns; ++k) entries += value[k] != 0;
    PetscCall(MatRestoreRow(A, i, &columns, NULL, &value));
    if (entries > 1) list[kept++] = i;
  }
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, kept, list, PETSC_OWN_POINTER, unknowns));
  PetscFunctionReturn(0);
}

/* Ratio of the largest to the smallest eigenvalue. */
static PetscErrorCode Condition(Mat A, PetscReal *condition)
{
  PetscReal *real, *imaginary, low = PETSC_MAX_REAL, high = 0;
  PetscInt n;
  IS unknowns;
  Mat general, free;
  KSP ksp;
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(MatConvert(A, MATSEQDENSE, MAT_INITIAL_MATRIX, &general));
  PetscCall(Unknowns(general, &unknowns));
  PetscCall(MatCreateSubMatrix(general, unknowns, unknowns, MAT_INITIAL_MATRIX, &free));
  PetscCall(ISGetSize(unknowns, &n));
  PetscCall(PetscMalloc2(n, &real, n, &imaginary));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &ksp));
  PetscCall(KSPSetOperators(ksp, free, free));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCNONE));
  PetscCall(KSPSetUp(ksp)); /* which chooses the side */
  PetscCall(KSPComputeEigenvaluesExplicitly(ksp, n, real, imaginary));
  for (PetscInt i = 0; i < n; ++i) low = PetscMin(low, real[i]), high = PetscMax(high, real[i]);
  *condition = high / low;
  PetscCall(PetscFree2(real, imaginary));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(ISDestroy(&unknowns));
  PetscCall(MatDestroy(&free));
  PetscCall(MatDestroy(&general));
  PetscFunctionReturn(0);
}

/* The block carried upwards, so that the domains of its uppermost points reach into the next row by
 * `cut` of a cell; its foot stays in the cells of the floor. */
static PetscErrorCode Cut(StabilisationSpec way, PetscReal cut, PetscReal *condition)
{
  LostPoint *lost;
  PetscInt n_lost;
  BenchCase b;
  Subject s;
  Pass pass;

  PetscFunctionBeginUser;
  block(&b, way);
  PetscCall(SubjectCreate(&b.c, &s));
  Points *points = s.model->points;
  for (PetscInt p = 0; p < points->n; ++p) point_real(points, POINT_X, p)[1] += cut * s.model->grid->smallest;
  PetscCall(PointsRelocate(points, s.model->grid, OUTSIDE_STOP, &n_lost, &lost));
  PetscCall(PetscFree(lost));
  s.model->space->present = PETSC_FALSE; /* what nodes got of the old places */
  PetscCall(PassMeasure(s.model, 0, 1, &pass));
  PetscCall(Condition(s.model->system->matrix, condition));
  PetscCall(SubjectDestroy(&s));
  PetscFunctionReturn(0);
}

static PetscErrorCode Draw(const char *png, const PetscReal *cuts, PetscReal (*condition)[CUTS])
{
  FigureSeries series[WAYS];
  PetscBool done;
  Diag *diag;

  PetscFunctionBeginUser;
  for (int k = 0; k < WAYS; ++k)
    series[k] = (FigureSeries){.name = name[k], .style = FIGURE_LINE, .n = CUTS, .x = cuts, .y = condition[k]};
  const Figure figure = {.x_label = "what reaches beyond the line, in cells",
                         .y_label = "condition number of the stiffness, gimp",
                         .log_x = PETSC_TRUE,
                         .log_y = PETSC_TRUE,
                         .n_series = WAYS,
                         .series = series};
  PetscCall(DiagCreate(&diag));
  PetscCall(FigureWrite(&figure, png, diag, &done));
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(void)
{
  PetscReal cuts[CUTS], condition[WAYS][CUTS];
  char png[PETSC_MAX_PATH_LEN];
  PetscBool draws;

  PetscFunctionBeginUser;
  printf("%12s", "cut");
  for (int k = 0; k < WAYS; ++k) printf("%24s", name[k]);
  printf("\n");
  for (int i = 0; i < CUTS; ++i) {
    cuts[i] = 0.25 * PetscPowReal(10, -(PetscReal)i / 4); /* from a quarter of a cell down */
    printf("%12.3g", (double)cuts[i]);
    for (int k = 0; k < WAYS; ++k) {
      PetscCall(Cut(ways[k], cuts[i], &condition[k][i]));
      printf("%24.3g", (double)condition[k][i]);
    }
    printf("\n");
  }
  PetscCall(PetscOptionsGetString(NULL, NULL, "-picture", png, sizeof png, &draws));
  if (draws) PetscCall(Draw(png, cuts, condition));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(Run());
  PetscCall(PetscFinalize());
  return 0;
}
