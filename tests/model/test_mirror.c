/* A problem moved by whole cells, or seen in a mirror, has the same solution: nothing is left to round-off, nor to the
 * order in which things stand. */
#include "case_builder.h"
#include "model/model_private.h"

#define EDGE 1.43 /* of the body of mirrored problems: within a cell, as its other sides are */

/* What three tracers do along each axis. */
typedef struct {
  PetscReal u[3][3];
} Ways;

static Ways solve(Bench *b, PetscInt tracers)
{
  Ways w = {{{0}}};
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, 1 - m->time);
  for (PetscInt k = 0; k < tracers * m->dim; ++k)
    CALL(ModelMeasure(m, b->measure + k, k, &w.u[k / m->dim][k % m->dim]));
  CALL(ModelDestroy(&m));
  bench_end(b);
  return w;
}

/* A cube of eight cells on a floor, whose sides are lines of the grid, pushed at one of them. */
static Ways pushed_cube(const char *basis, LoadKind kind, PetscReal by)
{
  Bench b;
  const PetscReal low = 0.5 + by, high = 1.5 + by;
  bench_init(&b, "mpm", CELL_HEXAHEDRON, 0);
  bench_grid(&b, (PetscReal[]){by, by, by}, (PetscReal[]){2 + by, 2 + by, 2 + by}, 0.5);
  bench_box(&b, 0, (PetscReal[]){low, low, low}, (PetscReal[]){high, high, high});
  b.c.basis.kind = basis;
  bench_motion(&b, 2, low, MOTION_FIXED, 7);
  LoadSpec *load = bench_traction(&b, 0, high, "body", kind == LOAD_PRESSURE ? 3000 : -3000, 0, 0);
  load->kind = kind;
  for (int d = 0; d < 3; ++d) bench_tracer(&b, "displacement", d, 1.4 + by, 1.3 + by, 1.45 + by);
  for (int d = 0; d < 3; ++d) bench_tracer(&b, "displacement", d, 1.4 + by, 0.7 + by, 1.45 + by);
  return solve(&b, 2);
}

static void test_shift(void **state)
{
  static const char *const bases[] = {"bspline", "gimp"};
  (void)state;
  EACH_VARIANT (k, 4) {
    const LoadKind kind = k / 2 ? LOAD_PRESSURE : LOAD_TRACTION;
    const Ways here = pushed_cube(bases[k % 2], kind, 0), there = pushed_cube(bases[k % 2], kind, 2);
    const PetscReal most = PetscAbsReal(here.u[0][0]);
    CHECK(most > 1e-3, "nothing moves");
    for (int i = 0; i < 6; ++i) CHECK_CLOSE(there.u[i / 3][i % 3], here.u[i / 3][i % 3], 1e-9 * most);
    for (int d = 0; d < 3; ++d) CHECK_CLOSE(here.u[1][d], (d == 1 ? -1 : 1) * here.u[0][d], 1e-9 * most);
  }
}

/* A body on a floor, between it and a plane of symmetry, bends under its weight: seen in mirrors that change x, y, or
 * both. */
static Ways mirrored(const char *basis, PetscInt points, PetscInt dim, unsigned mirror)
{
  const PetscReal max[3] = {EDGE, 1.08, 0.87};
  PetscReal low[3] = {0, 0, 0}, high[3] = {2.5, 1.5, 1.25}, from[3] = {0, 0, 0}, to[3] = {max[0], max[1], max[2]};
  Bench b;
  bench_init(&b, "mpm", dim == 3 ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, 0);
  for (int d = 0; d < 3; ++d) {
    if (!(mirror >> d & 1)) continue;
    low[d] = -high[d], high[d] = 0;
    from[d] = -max[d], to[d] = 0;
  }
  bench_grid(&b, low, high, 0.25);
  bench_box(&b, 0, from, to);
  b.body[0].points_per_cell = points;
  b.c.basis.kind = basis;
  b.c.gravity[0] = mirror & 1 ? -3 : 3;
  b.c.gravity[1] = mirror & 2 ? 9 : -9;
  b.material.density = 5000;
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  for (int t = 0; t < 2; ++t)
    for (int d = 0; d < dim; ++d)
      bench_tracer(&b, "displacement", d, (mirror & 1 ? -1 : 1) * (t ? 0.6 : 1.287), (mirror & 2 ? -1 : 1) * 1.0044,
                   (mirror & 4 ? -1 : 1) * 0.5);
  Ways w = solve(&b, 2);
  for (int i = 0; i < 6; ++i) w.u[i / 3][i % 3] *= mirror >> i % 3 & 1 ? -1 : 1;
  return w;
}

static void test_mirror(void **state)
{
  static const struct {
    const char *basis;
    PetscInt points, dim;
  } cases[] = {{"gimp", 9, 2}, {"bspline", 9, 2}, {"cell", 9, 2}, {"gimp", 25, 2}, {"gimp", 4, 2}, {"gimp", 27, 3}};
  (void)state;
  EACH_OF (k, cases) {
    const Ways seen = mirrored(cases[k].basis, cases[k].points, cases[k].dim, 0);
    for (unsigned mirror = 1; mirror < 4; ++mirror) {
      const Ways image = mirrored(cases[k].basis, cases[k].points, cases[k].dim, mirror + (cases[k].dim == 3 ? 4 : 0));
      for (int i = 0; i < 6; ++i)
        CHECK_CLOSE(image.u[i / 3][i % 3], seen.u[i / 3][i % 3], 1e-9 * PetscAbsReal(seen.u[0][1]));
    }
  }
}

/* Splines whose knots points stand on: a block of 5 x 5 cells of `size`, one point in the middle of each, or nine, and
 * moved by dx, dy. */
static Ways on_knots(const Kinematics *kinematics, PetscInt points, PetscReal size, PetscReal dx, PetscReal dy)
{
  const PetscReal left = kinematics->hoop ? 0 : 3 * size + dx, width = 5 * size;
  Bench b;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
  b.c.kinematics = kinematics;
  bench_grid(&b, (PetscReal[]){kinematics->hoop ? 0 : dx, dy, 0}, (PetscReal[]){dx + 12 * size, dy + 9 * size, 0},
             size);
  bench_box(&b, 0, (PetscReal[]){left, dy, 0}, (PetscReal[]){left + width, dy + width, 0});
  b.body[0].points_per_cell = points;
  b.c.basis.kind = "bspline";
  b.c.gravity[0] = kinematics->hoop ? 0 : 3;
  b.c.gravity[1] = -9;
  b.material.density = 2000 / size;
  bench_motion(&b, 1, dy, MOTION_FIXED, 3);
  if (kinematics->hoop) bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  for (int d = 0; d < 2; ++d) bench_tracer(&b, "displacement", d, left + 0.9 * width, dy + 0.95 * width, 0);
  for (int d = 0; d < 2; ++d) bench_tracer(&b, "displacement", d, left + 0.2 * width, dy + 0.6 * width, 0);
  Ways w = solve(&b, 2);
  for (int i = 0; i < 6; ++i) w.u[i / 3][i % 3] /= size;
  return w;
}

static void test_knots(void **state)
{
  (void)state;
  EACH_VARIANT (k, 4) {
    const Kinematics *kinematics = k / 2 ? &kinematics_axisymmetric : &kinematics_plane_strain;
    const PetscInt points = k % 2 ? 9 : 1;
    const Ways here = on_knots(kinematics, points, 0.2, 0, 0);
    for (int i = 0; i < 4; ++i) {
      const Ways there = i ? on_knots(kinematics, points, 0.2, k / 2 ? 0 : (PetscReal[]){0.3, 7.7, 1.1}[i - 1],
                                      (PetscReal[]){1.7, 3.1, 2.3}[i - 1])
                           : on_knots(kinematics, points, 0.6, 0, 0);
      for (int j = 0; j < 6; ++j)
        CHECK_CLOSE(there.u[j / 3][j % 3], here.u[j / 3][j % 3], 1e-9 * PetscAbsReal(here.u[0][1]));
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_shift), cmocka_unit_test(test_mirror),
                                     cmocka_unit_test(test_knots)};
  return run_model_tests(argc, argv, tests);
}
