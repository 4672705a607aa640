/* Equations with the mass matrix: the product is that of sums over points, written down again here, before and after
 * its rows are summed up; a motion is found again from its momentum, on any number of ranks, in a few sweeps where
 * functions are wider than a cell, wherever the body ends in its cells. */
#include "case_builder.h"
#include "method/transfer/mass.h"

enum { CELLS = 8 };

static PetscBool is_wide(const char *basis) { return strcmp(basis, "cell") ? PETSC_TRUE : PETSC_FALSE; }

static Model *scattered(Bench *b, PetscInt dim, const char *basis)
{
  bench_init(b, "mpm", dim == 3 ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, CELLS);
  bench_box(b, 0, (PetscReal[]){0.19, 0.26, 0.31}, (PetscReal[]){0.83, 0.71, 0.74});
  bench_dynamic(b, 1, 1e-3);
  b->c.basis.kind = basis;
  b->c.analysis.transfer = (char *)"consistent";
  if (is_wide(basis)) b->c.analysis.scheme = (char *)"midpoint";
  if (is_wide(basis)) b->c.stabilisation = (StabilisationSpec){.follow = 0.3, .curvature = 0.1};
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    Random random = {(uint64_t)m->points->id[p] + 3};
    m->points->real[POINT_MASS][p] *= random_real(&random, 0.5, 1.5);
  }
  CALL(m->method->initialise(m->space));
  return m;
}

/* As rough as the grid allows. */
static PetscReal motion_at(const PetscReal *x, PetscInt k) { return sin(91 * x[0] + 57 * x[1] + 3 * (PetscReal)k); }

/* momentum = sum m N N . x + what cells that are not full add, on owners. */
static void momentum_of(const Model *m, PetscInt width, const PetscReal *x, PetscReal *momentum)
{
  const Support *w = m->space->support;
  for (PetscInt i = 0; i < m->grid->n_nodes * width; ++i) momentum[i] = 0;
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscInt nn = support_nodes(w, g), *node = w->node + w->node_start[g];
      const PetscReal *N = w->N + w->value_start[g] + (p - w->point_start[g]) * nn;
      for (PetscInt k = 0; k < width; ++k) {
        PetscReal at = 0;
        for (PetscInt I = 0; I < nn; ++I) at += N[I] * x[node[I] * width + k];
        for (PetscInt I = 0; I < nn; ++I) momentum[node[I] * width + k] += m->points->real[POINT_MASS][p] * N[I] * at;
      }
    }
  CALL(GridSumToOwners(m->grid, width, momentum));
}

/* lack = - M x, which of functions that are wider than a cell is the momentum alone. */
static void subtract(const Model *m, MassSolve *c)
{
  PetscReal *momentum;
  CALL(PetscMalloc1(c->size, &momentum));
  momentum_of(m, c->width, c->x, momentum);
  for (PetscInt i = 0; i < m->grid->n_owned * c->width; ++i) c->lack[i] = 0;
  CALL(MassSubtract(c));
  for (PetscInt i = 0; i < m->grid->n_owned * c->width && is_wide(m->c->basis.kind); ++i)
    CHECK_CLOSE(-c->lack[i], momentum[i], 1e-12 * m->nodes->mass[i / c->width]);
  CALL(PetscFree(momentum));
}

/* most: sweeps. */
static void check(PetscInt dim, const char *basis, PetscInt most)
{
  Bench b;
  Model *m = scattered(&b, dim, basis);
  PetscReal enough[MOTIONS];
  MassSolve c;
  CALL(MassSolveCreate(m->space, &c));
  for (PetscInt i = 0; i < c.size; ++i) c.x[i] = motion_at(m->grid->x + i / c.width * dim, i % c.width);
  subtract(m, &c);
  for (PetscInt i = 0; i < c.size; ++i) c.x[i] = 0;
  CALL(MassLack(&c, enough));
  for (int f = 0; f < MOTIONS; ++f) enough[f] *= PetscSqr(5e-12);
  CALL(MassSolveRun(&c, enough, 300));
  const PetscInt sweeps = c.products;
  CALL(GridToGhosts(m->grid, c.width, c.x));
  const PetscReal whole = b.material.density * PetscPowReal(1. / CELLS, dim);
  for (PetscInt i = 0; i < c.size; ++i)
    if (m->nodes->mass[i / c.width] > 0.01 * whole)
      CHECK_CLOSE(c.x[i], -motion_at(m->grid->x + i / c.width * dim, i % c.width), 1e-7);
  subtract(m, &c);
  PetscPrintf(PETSC_COMM_WORLD, "%s, dimension %d: %d sweeps\n", basis, (int)dim, (int)sweeps);
  CHECK(sweeps <= most, "%d sweeps", (int)sweeps);
  CALL(MassSolveDestroy(&c));
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

/* By the diagonal alone sweeps are 27 and 45 in the plane, 45 and more than 300 in space. */
static void test_plane(void **state)
{
  (void)state;
  check(2, "cell", 32);
  check(2, "gimp", 20);
  check(2, "bspline", 34);
}

static void test_space(void **state)
{
  (void)state;
  check(3, "cell", 54);
  check(3, "gimp", 30);
  check(3, "bspline", 230);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_plane), cmocka_unit_test(test_space)};
  return run_model_tests(argc, argv, tests);
}
