/* Nodes that domains of points all but miss follow those inside the body: linear motion stays exact where a body ends
 * by next to nothing in a cell, and the work of what holds the others is below 1e-6 of that of gravity. */
#include "method/extend/extend.h"
#include "smooth.h"

/* A beam of 4 m x 1 m, held at x = 0, whose upper side lies `cut` of a cell beyond a line of the grid, as its end
 * does. It bends under its weight in ten static steps. */
static void beam(Bench *b, PetscReal cut, PetscReal follow)
{
  const PetscReal h = 0.25;
  bench_init(b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(b, (PetscReal[]){0, -1.5, 0}, (PetscReal[]){4.5, 1.5, 0}, h);
  bench_box(b, 0, (PetscReal[]){0, -cut * h, 0}, (PetscReal[]){4 + cut * h, 1 + cut * h, 0});
  b->constants[0].value = 3e7;
  b->constants[1].value = 0;
  b->material.density = 1000;
  b->c.gravity[1] = -9.81;
  b->c.basis.kind = "gimp";
  b->c.stabilisation.follow = follow;
  b->c.newton.residual = 1e-10;
  b->c.analysis.step = b->c.analysis.largest = 0.1;
  bench_motion(b, 0, 0, MOTION_FIXED, 3);
  bench_tracer(b, "displacement", 1, 4, 0.5, 0);
}

/* What was held of the work of gravity, where the end is, and Newton's iterations. */
typedef struct {
  PetscReal share, tip;
  PetscInt iterations;
} Bent;

static Bent bend(PetscReal cut, PetscReal follow)
{
  Bench b;
  Bent bent = {0};
  beam(&b, cut, follow);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) bent.iterations += model_step(m, 1 - m->time).newton.iterations;
  bent.share = model_sum(m, "energy: held", 0) / model_sum(m, "energy: external", 0);
  CALL(ModelMeasure(m, b.measure, 0, &bent.tip));
  CALL(ModelDestroy(&m));
  bench_end(&b);
  PetscPrintf(PETSC_COMM_WORLD, "cut %g, follow %g: held %.3g of the work, tip %.8f m, %d iterations\n", (double)cut,
              (double)follow, (double)bent.share, (double)bent.tip, (int)bent.iterations);
  return bent;
}

static void test_energy(void **state)
{
  (void)state;
  for (int k = 0; k < 3; ++k) {
    const PetscReal cut = (PetscReal[]){0, 1e-6, 0.03}[k];
    const Bent held = bend(cut, 0), follows = bend(cut, 0.02);
    CHECK(follows.share >= 0 && follows.share < 1e-6, "%g of the work is held", (double)follows.share);
    CHECK(follows.share < 0.1 * held.share, "not less than %g", (double)held.share);
    CHECK(follows.iterations <= held.iterations, "%d iterations", (int)follows.iterations);
    CHECK_CLOSE(follows.tip, held.tip, 2e-3 * PetscAbsReal(held.tip));
  }
}

/* A load of 0 on a surface is none, though nodes under a loaded one follow that others would not. */
static void test_zero_load(void **state)
{
  PetscReal tip[2];
  (void)state;
  for (int loaded = 0; loaded < 2; ++loaded) {
    Bench b;
    beam(&b, 0.03, 0);
    if (loaded) bench_traction(&b, 1, 1 + 0.03 * 0.25, "body", 0, 0, 0);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    model_step(m, 0.1);
    CALL(ModelMeasure(m, b.measure, 0, &tip[loaded]));
    CALL(ModelDestroy(&m));
  }
  CHECK_CLOSE(tip[1], tip[0], 1e-12 * PetscAbsReal(tip[0]));
}

/* Nor in space, where nodes were kept that could not follow for the carriers alone, from which a load of 0 pushes, and
 * where a pressure of 0 had the system solved as one that is not symmetric. */
static void test_zero_load_in_space(void **state)
{
  PetscReal tip[2];
  (void)state;
  for (int loaded = 0; loaded < 2; ++loaded) {
    Bench b;
    bench_init(&b, "mpm", CELL_HEXAHEDRON, 0);
    bench_grid(&b, (PetscReal[]){-0.5, 0, -0.5}, (PetscReal[]){1.25, 1.25, 0.75}, 0.25);
    bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){0.57, 1.07, 0.57});
    b.constants[0].value = 1e5;
    b.c.gravity[0] = 2;
    b.c.gravity[1] = -5;
    b.c.basis.kind = "gimp";
    b.c.stabilisation.follow = 0.02;
    b.c.newton.residual = 1e-10;
    bench_motion(&b, 1, 0, MOTION_FIXED, 7);
    bench_tracer(&b, "displacement", 1, 0.5, 0.95, 0.25);
    if (loaded) bench_traction(&b, 2, 0, "body", 0, 0, 0);
    if (loaded) bench_traction(&b, 2, 0, "body", 0, 0, 0)->kind = LOAD_PRESSURE;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    CHECK(m->symmetric, "not symmetric, loaded: %d", loaded);
    for (int k = 0; k < 2; ++k) model_step(m, 1. / 3);
    CALL(ModelMeasure(m, b.measure, 0, &tip[loaded]));
    CALL(ModelDestroy(&m));
  }
  CHECK_CLOSE(tip[1], tip[0], 1e-12 * PetscAbsReal(tip[0]));
}

/* What points see of linear fields: sum N = 1, sum N x_I = x_p, sum dN = 0, sum x_I dN = 1. */
static void check_linear(const Model *m)
{
  const Support *w = m->space->support;
  const PetscInt dim = m->dim;
  for (PetscInt p = 0; p < w->n_groups; ++p) {
    PetscReal one = 0, x[3] = {0}, zero[3] = {0}, unit[9] = {0};
    for (PetscInt I = 0; I < support_nodes(w, p); ++I) {
      const PetscInt node = w->node[w->node_start[p] + I];
      one += support_N(w, p, p)[I];
      for (PetscInt d = 0; d < dim; ++d) {
        x[d] += support_N(w, p, p)[I] * m->grid->x[node * dim + d];
        zero[d] += support_dN(w, p, p, dim)[I * dim + d];
        for (PetscInt k = 0; k < dim; ++k)
          unit[3 * k + d] += m->grid->x[node * dim + k] * support_dN(w, p, p, dim)[I * dim + d];
      }
    }
    CHECK_CLOSE(one, 1, 1e-13);
    for (PetscInt d = 0; d < dim; ++d) CHECK_CLOSE(x[d], point_real(m->points, POINT_X, p)[d], 1e-13);
    for (PetscInt d = 0; d < dim; ++d) CHECK_CLOSE(zero[d], 0, 1e-11);
    for (PetscInt k = 0; k < dim * dim; ++k) CHECK_CLOSE(unit[3 * (k / dim) + k % dim], k / dim == k % dim, 1e-11);
  }
}

/* A block that ends by a twentieth of a cell beyond lines of the grid on all sides: nodes along its sides, edges and
 * corners follow, in a graded grid, too. */
static void cut_block(const char *basis, CellType cell, PetscReal grading)
{
  const PetscReal h = 0.25, cut = 0.05 * h;
  PetscInt local[2] = {0, 0}, of_all[2];
  Bench b;
  bench_init(&b, "mpm", cell, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 2, 2}, h);
  bench_box(&b, 0, (PetscReal[]){0.5 - cut, 0.5 - cut, 0.5 - cut}, (PetscReal[]){1.5 + cut, 1.5 + cut, 1.5 + cut});
  b.c.grid.grading[0] = grading;
  b.c.basis.kind = basis;
  bench_dynamic(&b, 1, 0.1);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CALL(ModelInitialise(m));
  CHECK(m->space->extension->any, "nobody follows");
  check_linear(m);
  for (PetscInt i = 0; i < m->grid->n_owned; ++i) {
    local[0] += m->space->extension->ways[i] > 0;
    local[1] += m->nodes->touched[i] && m->space->extension->fill[i] < b.c.stabilisation.follow;
  }
  CALL(MPI_Allreduce(local, of_all, 2, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  CHECK(of_all[1] == 0, "%d of %d nodes follow nobody", (int)of_all[1], (int)(of_all[0] + of_all[1]));
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_linear(void **state)
{
  (void)state;
  cut_block("gimp", CELL_QUADRILATERAL, 1);
  cut_block("gimp", CELL_QUADRILATERAL, 1.5);
  cut_block("gimp", CELL_HEXAHEDRON, 1);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_energy), cmocka_unit_test(test_zero_load),
                                     cmocka_unit_test(test_zero_load_in_space), cmocka_unit_test(test_linear)};
  return run_model_tests(argc, argv, tests);
}
