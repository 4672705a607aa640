/* Loads in numbers: the sum of the nodal forces and their moments, of each load by its own
 * amplitude, on bodies and on the grid. */
#include "case_builder.h"
#include "model/model_private.h"

/* What nodal forces push with at time t. */
static void gather(Model *m, PetscReal t, PetscReal *force)
{
  CALL(ModelInitialise(m));
  const NodalScene scene = nodal_scene(m, t, m->nodes->du);
  CALL(NodalForcesBegin(&m->forces, &scene));
  CALL(NodalForcesExternal(&m->forces, &scene, PETSC_TRUE, force));
}

/* Sum over owned nodes of the loads at time t, and of their moments about the origin in x and y: f,
 * x f_x, y f_y. */
static void sum_loads(Model *m, PetscReal t, PetscReal sum[5])
{
  PetscReal *force, local[5] = {0, 0, 0, 0, 0};
  CALL(PetscCalloc1(m->grid->n_nodes * m->dim, &force));
  gather(m, t, force);
  for (PetscInt i = 0; i < m->grid->n_owned; ++i) {
    for (PetscInt d = 0; d < m->dim; ++d) local[d] += force[i * m->dim + d];
    for (PetscInt d = 0; d < 2; ++d) local[3 + d] += m->grid->x[i * m->dim + d] * force[i * m->dim + d];
  }
  CALL(PetscFree(force));
  CALL(MPI_Allreduce(local, sum, 5, MPIU_REAL, MPI_SUM, m->comm));
}

static PetscBool is_space(CellType cell) { return cell >= CELL_TETRAHEDRON; }

/* The whole surface of a block inside the grid, and no face inside it: value times its area, at its
 * centre. */
static void test_whole_surface(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell) {
    Bench b;
    PetscReal sum[5];
    bench_init(&b, "mpm", cell, 4);
    bench_box(&b, 0, (PetscReal[]){0.25, 0.25, 0.25}, (PetscReal[]){0.75, 1, 0.75});
    bench_dynamic(&b, 1, 0.01);
    LoadSpec *load = bench_traction(&b, 0, 0.25, "body", 30, -20, is_space(cell) ? 7 : 0);
    load->on.max[0] = 0.75; /* all of it */
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    sum_loads(m, 0.3, sum);
    const PetscReal area = is_space(cell) ? 2 * (0.5 * 0.5 + 2 * 0.5 * 0.75) : 2 * (0.5 + 0.75);
    CHECK_CLOSE(sum[0], 30 * area, 1e-10);
    CHECK_CLOSE(sum[1], -20 * area, 1e-10);
    CHECK_CLOSE(sum[2], is_space(cell) ? 7 * area : 0, 1e-10);
    CHECK_CLOSE(sum[3], 30 * area * 0.5, 1e-10);
    CHECK_CLOSE(sum[4], -20 * area * 0.625, 1e-10);
    CALL(ModelDestroy(&m));
  }
}

/* Two bodies that touch: the face between them belongs to the surface of each. */
static void test_between_bodies(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell) {
    Bench b;
    PetscReal sum[5];
    bench_init(&b, "mpm", cell, 4);
    bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){0.5, 1, 1});
    b.body[1] = b.body[0];
    b.body[1].name = (char *)"other";
    bench_box(&b, 1, (PetscReal[]){0.5, 0, 0}, (PetscReal[]){1, 1, 1});
    b.c.n_bodies = 2;
    bench_dynamic(&b, 1, 0.01);
    bench_traction(&b, 0, 0.5, "body", 5, 0, 0);
    bench_traction(&b, 0, 0.5, "other", 0, 3, 0);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    sum_loads(m, 0, sum);
    CHECK_CLOSE(sum[0], 5, 1e-12);
    CHECK_CLOSE(sum[1], 3, 1e-12);
    CHECK_CLOSE(sum[3], 5 * 0.5, 1e-12);
    CALL(ModelDestroy(&m));
  }
}

/* Each load by its own amplitude, carried or on the grid; a face of the grid without material bears
 * nothing. */
static void test_amplitudes(void **state)
{
  static PetscReal time[] = {0, 1}, rise[] = {0, 1}, fall[] = {2, 0};
  (void)state;
  for (int on_body = 0; on_body < 2; ++on_body)
    for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell) {
      Bench b;
      PetscReal sum[5];
      const char *body = on_body ? "body" : NULL;
      bench_init(&b, "mpm", cell, 4);
      bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 0.5, 1});
      bench_dynamic(&b, 1, 0.01);
      bench_traction(&b, 0, 0, body, 4, 0, 0)->amplitude = (Amplitude){.n = 2, .time = time, .value = rise};
      bench_traction(&b, 0, 1, body, 0, 8, 0)->amplitude = (Amplitude){.n = 2, .time = time, .value = fall};
      b.load[b.c.n_loads++] = (LoadSpec){.kind = LOAD_POINT,
                                         .at = {0.3, 0.2, 0.4},
                                         .value = {0, -1, 0},
                                         .amplitude = {.n = 2, .time = time, .value = rise}};
      bench_traction(&b, 1, 0, body, 1, 0, 0);
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      for (int k = 0; k <= 4; ++k) {
        const PetscReal t = 0.25 * k;
        sum_loads(m, t, sum);
        CHECK_CLOSE(sum[0], 4 * 0.5 * t + 1, 1e-12);
        CHECK_CLOSE(sum[1], 8 * 0.5 * (2 - 2 * t) - t, 1e-12);
        CHECK_CLOSE(sum[3], 0.5, 1e-12);
        CHECK_CLOSE(sum[4], 8 * 0.5 * (2 - 2 * t) * 0.25 - t * 0.2, 1e-12);
      }
      CALL(ModelDestroy(&m));
    }
}

/* The sum over a boundary counts each node once, whatever ranks hold copies of it, and a component that two boundaries
 * prescribe for the one that stands across it, whoever comes first. */
static void test_boundary_sum(void **state)
{
  (void)state;
  for (int k = 0; k < 8; ++k) {
    const CellType cell = (CellType)(k / 2);
    const PetscInt across = k % 2, along = 1 - across; /* x is held by all of x = 0, and by all of y = 0 */
    Bench b;
    PetscReal *force, sum[3];
    bench_init(&b, "mpm", cell, 6);
    if (across) bench_motion(&b, 1, 0, MOTION_FIXED, 1);
    bench_motion(&b, 0, 0, MOTION_FIXED, 7);
    if (!across) bench_motion(&b, 1, 0, MOTION_FIXED, 1);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    const PetscReal side = is_space(cell) ? 49 : 7;
    CALL(PetscMalloc1(m->grid->n_nodes * m->dim, &force));
    for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i) force[i] = i % m->dim == 0 ? 1 : 10;
    CALL(BoundarySum(m->boundary, m->grid, across, force, sum));
    CHECK_CLOSE(sum[0], side, 1e-12);
    CHECK_CLOSE(sum[1], 10 * side, 1e-12);
    /* y is none of its own, and what the other holds neither */
    CALL(BoundarySum(m->boundary, m->grid, along, force, sum));
    CHECK_CLOSE(sum[0], side - (is_space(cell) ? 7 : 1), 1e-12);
    CHECK_CLOSE(sum[1], 0, 1e-12);
    CALL(PetscFree(force));
    CALL(ModelDestroy(&m));
  }
}

/* A body force belongs to the material: it is asked for where a point was at the start, wherever it
 * is now. */
static void as_far(void *context, PetscInt n, const PetscReal *X, const PetscReal *x, PetscReal t, PetscReal *b)
{
  (void)context;
  (void)x;
  for (PetscInt i = 0; i < 3 * n; ++i) b[i] = (1 + t) * X[i];
}

static void test_body_force(void **state)
{
  static const char *const methods_[] = {"mpm", "fem"};
  (void)state;
  for (int k = 0; k < 2; ++k)
    for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell) {
      Bench b;
      PetscReal *force, local[3] = {0, 0, 0}, sum[3];
      PetscInt dim = is_space(cell) ? 3 : 2;
      bench_init(&b, methods_[k], cell, 8);
      bench_box(&b, 0, (PetscReal[]){0, 0.25, 0}, (PetscReal[]){0.25, 0.5, 0.5});
      bench_dynamic(&b, 1, 0.1);
      b.body[0].velocity[0] = 4;
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      model_step(m, 0.1);
      CALL(ModelSetBodyForce(m, as_far, NULL));
      CALL(PetscCalloc1(m->grid->n_nodes * dim, &force));
      gather(m, 0.5, force);
      for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) local[i % dim] += force[i];
      CALL(MPI_Allreduce(local, sum, 3, MPIU_REAL, MPI_SUM, m->comm));
      const PetscReal mass = model_sum(m, "mass: total", 0), centre[3] = {0.125, 0.375, 0.25};
      for (PetscInt d = 0; d < dim; ++d) CHECK_CLOSE(sum[d], 1.5 * mass * centre[d], 1e-9 * mass);
      CALL(PetscFree(force));
      CALL(ModelDestroy(&m));
    }
}

/* Downwards, by more the higher where *context is not 0. */
static void downwards(void *context, PetscInt n, const PetscReal *X, const PetscReal *x, PetscReal t, PetscReal *b)
{
  const PetscReal *more = context;
  (void)x;
  (void)t;
  for (PetscInt i = 0; i < n; ++i) b[3 * i + 1] = -10 - *more * X[3 * i + 1];
}

/* A block that can hardly be compressed, and gives way nowhere but at its top, under gravity or that force. */
static Model *confined(Bench *b, const char *method, const char *basis, CellType cell, PetscReal *more, MPI_Comm comm)
{
  static PetscReal start[] = {0}, whole[] = {1};
  bench_init(b, method, cell, 4);
  if (basis) b->c.basis.kind = basis;
  if (basis) bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1.25, 0}, 0.25);
  b->c.formulation = (char *)"mixed";
  b->c.mixed.stabilisation = 8;
  b->c.newton.residual = 1e-10;
  b->constants[1].value = 0.4999;
  b->material.law = (char *)"neo-hookean-split";
  if (!more) b->c.gravity[1] = -10;
  b->c.gravity_amplitude = (Amplitude){.n = 1, .time = start, .value = whole};
  bench_motion(b, 1, 0, MOTION_FIXED, 2);
  for (int side = 0; side < 2; ++side) bench_motion(b, 0, side, MOTION_FIXED, 1);
  for (int side = 0; is_space(cell) && side < 2; ++side) bench_motion(b, 2, side, MOTION_FIXED, 4);
  Model *m = bench_model(b, comm);
  if (more) CALL(ModelSetBodyForce(m, downwards, more));
  model_step(m, 1);
  return m;
}

/* What holds pressures within cells leaves alone those that bear a body force, as those that bear a weight. */
static void test_pressure_bears_a_body_force(void **state)
{
  static const struct {
    const char *method, *basis;
    CellType cell;
  } variants[] = {{"fem", NULL, CELL_QUADRILATERAL},   {"mpm", NULL, CELL_TRIANGLE},
                  {"mpm", "gimp", CELL_QUADRILATERAL}, {"mpm", NULL, CELL_HEXAHEDRON},
                  {"fem", NULL, CELL_TETRAHEDRON},     {"fem", NULL, CELL_TRIANGLE}};
  (void)state;
  EACH_OF (k, variants) {
    PetscReal more = 0, off = 0;
    Bench weighing, forced;
    Model *weight = confined(&weighing, variants[k].method, variants[k].basis, variants[k].cell, NULL, PETSC_COMM_SELF);
    Model *force = confined(&forced, variants[k].method, variants[k].basis, variants[k].cell, &more, PETSC_COMM_WORLD);
    CHECK_CLOSE(points_difference(force, weight, POINT_PRESSURE), 0, 1e-3);
    CALL(ModelDestroy(&weight));
    CALL(ModelDestroy(&force));
    more = 20;
    force = confined(&forced, variants[k].method, variants[k].basis, variants[k].cell, &more, PETSC_COMM_WORLD);
    for (PetscInt p = 0; p < force->points->n; ++p) {
      const PetscReal y = point_real(force->points, POINT_X, p)[1];
      const PetscReal exact = -1e4 * (1 - y) - 1e4 * (1 - y * y); /* Pa */
      off = PetscMax(off, PetscAbsReal(force->points->real[POINT_PRESSURE][p] - exact));
    }
    off = model_max(force, off);
    PetscPrintf(PETSC_COMM_WORLD, "%s, cell %d: off by %.3g Pa\n", variants[k].method, (int)variants[k].cell,
                (double)off);
    CHECK(off < 100, "pressure off by %g Pa", (double)off);
    CALL(ModelDestroy(&force));
  }
}

/* (1 + t y, y^2, 2) of where the surface was: Gauss points of its faces are exact for it. */
static void of_height(void *context, PetscInt n, const PetscReal *X, const PetscReal *x, PetscReal t, PetscReal *f)
{
  *(PetscInt *)context += n;
  for (PetscInt i = 0; i < n; ++i) {
    assert_true(f[3 * i] == 1 && f[3 * i + 1] == 1 && f[3 * i + 2] == 1);
    assert_true(fabs(x[3 * i] - X[3 * i]) < 1e-12);
    f[3 * i] = 1 + t * X[3 * i + 1];
    f[3 * i + 1] = PetscSqr(X[3 * i + 1]);
    f[3 * i + 2] = 2;
  }
}

/* The left side of a block from y = 1/4 to 1 under a traction of (30, -20, 7) or a pressure of 30 that varies so:
 * carried by the body's surface, or on faces of the grid. */
static void check_factors(const char *method, CellType cell, LoadKind kind, PetscBool on_body)
{
  const PetscReal t = 0.3, deep = is_space(cell) ? 0.5 : 1;
  const PetscReal x = 30 * deep * (0.75 + t * (1 - 0.0625) / 2), y = -20 * deep * (1 - 0.015625) / 3,
                  z = 7 * 2 * deep * 0.75;
  const PetscBool pushes = (PetscBool)(kind == LOAD_PRESSURE);
  PetscInt asked = 0, all;
  PetscReal sum[5], plain[5];
  Bench b;
  bench_init(&b, method, cell, 4);
  if (!strcmp(method, "gmm"))
    b.c.basis = (BasisSpec){.kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
  bench_box(&b, 0, (PetscReal[]){0, 0.25, 0.25}, (PetscReal[]){0.75, 1, 0.75});
  bench_dynamic(&b, 1, 0.01);
  bench_traction(&b, 0, 0, on_body ? "body" : NULL, 30, -20, is_space(cell) ? 7 : 0)->kind = kind;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  sum_loads(m, t, plain);
  CHECK_CLOSE(plain[0], 30 * deep * 0.75, 1e-10);
  CALL(ModelSetLoadFactors(m, 0, of_height, &asked));
  sum_loads(m, t, sum);
  CALL(MPI_Allreduce(&asked, &all, 1, MPIU_INT, MPI_SUM, m->comm));
  assert_true(all > 0);
  CHECK_CLOSE(sum[0], x, 1e-10);
  CHECK_CLOSE(sum[1], pushes ? 0 : y, 1e-10);
  if (is_space(cell)) CHECK_CLOSE(sum[2], pushes ? 0 : z, 1e-10);
  if (pushes) CHECK_CLOSE(sum[4], 0, 1e-10);
  else CHECK_CLOSE(sum[3], 0, 1e-10); /* at x = 0 */
  CALL(ModelSetLoadFactors(m, 0, NULL, NULL));
  sum_loads(m, t, sum);
  for (int i = 0; i < 5; ++i) assert_true(sum[i] == plain[i] || i == 2);
  CALL(ModelDestroy(&m));
}

static void test_factors(void **state)
{
  static const char *const methods_[] = {"mpm", "fem", "gmm"};
  (void)state;
  for (int k = 0; k < 3; ++k)
    for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell)
      for (int on_body = 0; on_body < 2; ++on_body)
        for (int pressure = 0; pressure < 2; ++pressure)
          check_factors(methods_[k], cell, pressure ? LOAD_PRESSURE : LOAD_TRACTION, (PetscBool)on_body);
}

/* A point force by its own factor. */
static void test_factor_of_a_point(void **state)
{
  Bench b;
  PetscInt asked = 0;
  PetscReal sum[5];
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 0.5, 1});
  bench_dynamic(&b, 1, 0.01);
  b.load[b.c.n_loads++] = (LoadSpec){.kind = LOAD_POINT, .at = {0.3, 0.2, 0}, .value = {5, -1, 0}};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CALL(ModelSetLoadFactors(m, 0, of_height, &asked));
  sum_loads(m, 0.5, sum);
  CHECK_CLOSE(sum[0], 5 * (1 + 0.5 * 0.2), 1e-12);
  CHECK_CLOSE(sum[1], -0.04, 1e-12);
  CALL(ModelDestroy(&m));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_whole_surface),     cmocka_unit_test(test_between_bodies),
    cmocka_unit_test(test_amplitudes),        cmocka_unit_test(test_factors),
    cmocka_unit_test(test_factor_of_a_point), cmocka_unit_test(test_boundary_sum),
    cmocka_unit_test(test_body_force),        cmocka_unit_test(test_pressure_bears_a_body_force)};
  return run_model_tests(argc, argv, tests);
}
