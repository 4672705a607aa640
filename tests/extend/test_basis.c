/* A basis that no file under src knows: quadratic B-splines in mpm, from the case file to the
 * stress in a body. */
#include "../conformance/basis_suite.h"
#include "../input/test_case.h"
#include "../model/smooth.h"
#include "support/basis.h"

#define SPLINES "quadratic_splines"

static Grid *box(PetscInt nx, PetscInt ny)
{
  Bench b;
  Diag *diag;
  Grid *grid;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 1);
  bench_grid(&b, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){0.5 * (PetscReal)nx, 0.5 * (PetscReal)ny, 0}, 0.5);
  CALL(DiagCreate(&diag));
  CALL(GridCreate(PETSC_COMM_SELF, &b.c, NULL, NULL, diag, &grid));
  CALL(DiagDestroy(&diag));
  return grid;
}

static PetscBool evaluate(const void *context, const PetscReal *x, PetscReal *N, PetscReal *dN)
{
  const Grid *grid = context;
  const BasisInput input = {.grid = grid};
  PetscReal xi[2];
  PetscInt cell = grid_locate(grid, x, -1, xi);
  const Points point = {.dim = 2, .n = 1, .cell = &cell, .real[POINT_XI] = xi, .components[POINT_XI] = 2};
  Support *s;
  CALL(SupportCreate(&s));
  CALL(basis_find(SPLINES)->support(&input, &point, s));
  for (PetscInt i = 0; i < grid->n_nodes; ++i) N[i] = dN[2 * i] = dN[2 * i + 1] = 0;
  for (PetscInt I = 0; I < support_nodes(s, 0); ++I) {
    N[s->node[I]] = s->N[I];
    for (int d = 0; d < 2; ++d) dN[2 * s->node[I] + d] = s->dN[2 * I + d];
  }
  CALL(SupportDestroy(&s));
  return cell >= 0;
}

/* Sums, linear fields and gradients, in the middle, at the edges and in a corner. */
static void suite(void **state)
{
  static const PetscReal sample[] = {1.26, 1.13, 1.49, 0.9, 0.1, 0.1, 2.41, 1.96, 0.3, 1.2, 1.6, 0.07};
  Grid *grid = box(5, 4);
  const BasisUnderTest test = {.name = SPLINES,
                               .dim = 2,
                               .nodes = grid->n_nodes,
                               .x = grid->x,
                               .n_samples = 6,
                               .sample = sample,
                               .size = 0.5,
                               .tolerance = 1e-14,
                               .difference = 1e-10,
                               .evaluate = evaluate,
                               .context = grid};
  (void)state;
  basis_suite_run(&test);
  CALL(GridDestroy(&grid));
}

/* Two Gauss points a direction give the node at the wall 13/24 of a cell's mass, where linear
 * functions give a half. */
static void mass_at_the_wall(void **state)
{
  Grid *grid = box(4, 1);
  PetscReal mass = 0, N[10], dN[20];
  (void)state;
  for (int i = 0; i < 8; ++i) {
    const PetscReal x[2] = {0.5 * (i / 2 + 0.5 * (1 + (i % 2 ? 1 : -1) / sqrt(3))), 0.25};
    (void)evaluate(grid, x, N, dN);
    mass += 0.5 * (N[0] + N[5]);
  }
  CHECK_CLOSE(mass, 13.0 / 24, 1e-14);
  CALL(GridDestroy(&grid));
}

/* Points stand in rows of equal distances, a whole number of them in a cell, so that the sum of the
 * splines' gradients over them is that of the integral, wherever they are: where nodes are free the
 * forces of the uniform stress vanish. The body's end crosses eight cells in the first step. */
static void patch(void **state)
{
  (void)state;
  pressed_body("displacement", SPLINES, 1, 16, 1e-12);
}

/* A body that flies and turns nowhere keeps its velocity while it crosses cells, damped as it is
 * told. */
static void flight(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 12);
  bench_box(&b, 0, (PetscReal[3]){0.25, 0.25, 0}, (PetscReal[3]){0.5, 0.5, 0});
  bench_dynamic(&b, 0.1, 0.01);
  b.c.basis.kind = SPLINES;
  b.c.analysis.damping = 3;
  b.body[0].velocity[0] = 3, b.body[0].velocity[1] = 2;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscReal momentum = model_sum(m, "momentum", 0);
  while (m->time < 0.1 - 1e-9) model_step(m, 0.1 - m->time);
  const PetscReal v = point_real(m->points, POINT_V, 0)[0], u = point_real(m->points, POINT_U, 0)[0];
  CHECK_CLOSE(v / 3, exp(-0.3), 1e-4);
  CHECK_CLOSE(model_sum(m, "momentum", 0) / momentum, v / 3, 1e-12);
  CHECK_CLOSE(model_sum(m, "energy: balance", 0) / (5 * momentum), 0, 1e-12);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    CHECK_CLOSE(point_real(m->points, POINT_V, p)[1] * 1.5, v, 1e-11);
    CHECK_CLOSE(point_real(m->points, POINT_U, p)[0], u, 1e-12);
  }
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

/* How far stresses are off in the mean. */
static void smoother_than_cells(void **state)
{
  (void)state;
  CHECK(settled_column("displacement", SPLINES, 16, 0) < 0.2 * settled_column("displacement", "cell", 16, 0),
        "splines are no better");
}

/* The case file knows it by its name, and where it does not fit says so. */
static void in_case_files(void **state)
{
  char *said;
  (void)state;
  Case *c = read_good(PLAIN "basis: {" SPLINES ": {}}\n");
  CHECK(!strcmp(c->basis.kind, SPLINES), "it is %s", c->basis.kind);
  CALL(CaseDestroy(&c));
  CHECK(!read_text(
          "kinematics: plane-strain\nmethod: fem\nanalysis: {type: static}\n" PLAIN_GRID PLAIN_BODIES PLAIN_MATERIALS
          "basis: {" SPLINES ": {}}\n",
          &said),
        "fem took it");
  CHECK(strstr(said, "method fem does not take the basis '" SPLINES "'"), "%s", said);
  free(said);
  Bench b;
  bench_init(&b, "mpm", CELL_TRIANGLE, 2);
  b.c.basis.kind = SPLINES;
  bench_refused(&b, PETSC_COMM_WORLD, "basis." SPLINES, "a box of equal squares");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(suite),  cmocka_unit_test(mass_at_the_wall), cmocka_unit_test(patch),
    cmocka_unit_test(flight), cmocka_unit_test(in_case_files),    cmocka_unit_test(smoother_than_cells),
  };
  return run_model_tests(argc, argv, tests);
}
