/* Fields of points at the nodes: uniform ones stay, linear ones are met where points lie evenly around
 * a node, and nothing is lost on the way. */
#include "../model/case_builder.h"
#include "run/output/output_private.h"

static PetscReal linear(const PetscReal *x, PetscInt dim)
{
  PetscReal value = 3;
  for (PetscInt d = 0; d < dim; ++d) value += (d + 2) * x[d];
  return value;
}

static PetscBool is_inside(const Model *m, PetscInt node)
{
  for (PetscInt d = 0; d < m->dim; ++d) {
    const PetscReal x = m->grid->x[node * m->dim + d];
    if (x < 0.3 || x > 0.7) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static void check(const char *method, CellType cell)
{
  PetscReal *values, *nodes, sum[2] = {0, 0}, inside = 0;
  Bench b;
  bench_init(&b, method, cell, cell < CELL_TETRAHEDRON ? 6 : 4);
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CALL(ModelInitialise(m));
  CALL(PetscMalloc1(2 * m->points->n + 1, &values));
  CALL(PetscMalloc1(2 * m->grid->n_nodes, &nodes));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    values[2 * p] = 7;
    values[2 * p + 1] = linear(point_real(m->points, POINT_X, p), m->dim);
    sum[0] += m->points->real[POINT_VOLUME][p] * values[2 * p + 1];
  }
  CALL(OutputNodalAverage(m, 2, values, nodes));
  for (PetscInt i = 0; i < m->grid->n_nodes; ++i) {
    const PetscReal *x = m->grid->x + i * m->dim;
    CHECK_CLOSE(nodes[2 * i], 7, 1e-13);
    if (i < m->grid->n_owned) sum[1] += m->nodes->mass[i] / 1000 * nodes[2 * i + 1];
    if (!is_inside(m, i)) continue;
    CHECK_CLOSE(nodes[2 * i + 1], linear(x, m->dim), 1e-12);
    inside = 1;
  }
  CALL(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  CHECK_CLOSE(sum[1], sum[0], 1e-12);
  CHECK(model_max(m, inside) > 0, "no node inside");
  CALL(PetscFree(values));
  CALL(PetscFree(nodes));
  CALL(ModelDestroy(&m));
}

static void test_average(void **state)
{
  (void)state;
  check("fem", CELL_QUADRILATERAL);
  check("mpm", CELL_QUADRILATERAL);
  check("fem", CELL_TRIANGLE);
  check("fem", CELL_HEXAHEDRON);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_average)};
  return run_model_tests(argc, argv, tests);
}
