/* What goes between points and nodes, in numbers: the sums of the projection, what convection gives
 * back, when a cell counts as filled, and how far nodes of a cloud keep off each other. Shape
 * functions are written down again here, and nodes are known by their places, so that sums over
 * ranks can be checked against sums over all points. */
#include "case_builder.h"
#include "method/gmm/gmm.h"

enum { CELLS = 6, SIDE = CELLS + 1 };

static const BasisSpec usual_lme = {
  .kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};

static PetscReal hat(PetscReal x, PetscReal node) { return PetscMax(0, 1 - PetscAbsReal(x - node) * CELLS); }

/* N of the node of place k at the point x of the unit square or cube, CELLS cells a side. */
static PetscReal shape_at(PetscInt dim, PetscInt k, const PetscReal *x)
{
  PetscReal N = 1;
  for (PetscInt d = 0; d < dim; ++d, k /= SIDE) N *= hat(x[d], (PetscReal)(k % SIDE) / CELLS);
  return N;
}

static PetscInt place_of(const Grid *grid, PetscInt node)
{
  PetscInt k = 0;
  for (PetscInt d = grid->dim - 1; d >= 0; --d) k = k * SIDE + (PetscInt)(grid->x[node * grid->dim + d] * CELLS + 0.5);
  return k;
}

/* A field that is the same on all ranks. */
static PetscReal field(PetscInt kind, PetscInt place, PetscInt d)
{
  return 1e-3 * sin(1.7 * (PetscReal)place + 0.9 * (PetscReal)d + 2.3 * (PetscReal)kind);
}

/* A block in the middle, its points with masses and motions of their own. */
static Model *scattered(Bench *b, CellType cell)
{
  bench_init(b, "mpm", cell, CELLS);
  bench_box(b, 0, (PetscReal[]){1. / 3, 1. / 6, 1. / 6}, (PetscReal[]){5. / 6, 5. / 6, 2. / 3});
  bench_dynamic(b, 1, 1e-3);
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    Random random = {(uint64_t)m->points->id[p] + 3};
    m->points->real[POINT_MASS][p] *= random_real(&random, 0.5, 1.5);
    for (PetscInt d = 0; d < m->dim; ++d) {
      point_real(m->points, POINT_V, p)[d] = random_real(&random, -1, 1);
      point_real(m->points, POINT_A, p)[d] = random_real(&random, -9, 9);
    }
  }
  CALL(m->method->initialise(m->space));
  return m;
}

/* Sums over all points for each place: mass, momentum, force; on all ranks. */
static void sums_of(const Model *m, PetscInt n, PetscReal *mass, PetscReal *momentum, PetscReal *force)
{
  for (PetscInt k = 0; k < n; ++k) {
    mass[k] = 0;
    for (PetscInt d = 0; d < m->dim; ++d) momentum[k * m->dim + d] = force[k * m->dim + d] = 0;
    for (PetscInt p = 0; p < m->points->n; ++p) {
      const PetscReal w = shape_at(m->dim, k, point_real(m->points, POINT_X, p)) * m->points->real[POINT_MASS][p];
      mass[k] += w;
      for (PetscInt d = 0; d < m->dim; ++d) {
        momentum[k * m->dim + d] += w * point_real(m->points, POINT_V, p)[d];
        force[k * m->dim + d] += w * point_real(m->points, POINT_A, p)[d];
      }
    }
  }
  CALL(MPI_Allreduce(MPI_IN_PLACE, mass, (int)n, MPIU_REAL, MPI_SUM, m->comm));
  CALL(MPI_Allreduce(MPI_IN_PLACE, momentum, (int)(n * m->dim), MPIU_REAL, MPI_SUM, m->comm));
  CALL(MPI_Allreduce(MPI_IN_PLACE, force, (int)(n * m->dim), MPIU_REAL, MPI_SUM, m->comm));
}

/* Owned nodes and ghosts alike. */
static void check_projection(CellType cell)
{
  Bench b;
  Model *m = scattered(&b, cell);
  const PetscInt dim = m->dim, n = dim == 3 ? SIDE * SIDE * SIDE : SIDE * SIDE;
  PetscReal *mass, *momentum, *force;
  CALL(PetscMalloc3(n, &mass, n * dim, &momentum, n * dim, &force));
  sums_of(m, n, mass, momentum, force);
  for (PetscInt i = 0; i < m->grid->n_nodes; ++i) {
    const PetscInt k = place_of(m->grid, i);
    CHECK_CLOSE(m->nodes->mass[i], mass[k], 1e-9);
    CHECK(m->nodes->touched[i] == (mass[k] > 1e-9), "node at place %d", (int)k);
    for (PetscInt d = 0; d < dim && mass[k] > 1e-9; ++d) {
      CHECK_CLOSE(m->nodes->v[i * dim + d], momentum[k * dim + d] / mass[k], 1e-9);
      CHECK_CLOSE(m->nodes->v_points[i * dim + d], momentum[k * dim + d] / mass[k], 1e-9);
      CHECK_CLOSE(m->nodes->a[i * dim + d], force[k * dim + d] / mass[k], 1e-9);
    }
  }
  CALL(PetscFree3(mass, momentum, force));
  CALL(ModelDestroy(&m));
}

static void test_projection(void **state)
{
  (void)state;
  check_projection(CELL_QUADRILATERAL);
  check_projection(CELL_HEXAHEDRON);
}

/* x and u by the increment, a anew, v by what nodes gained over what points had given them, less a
 * share of what no node sees. */
static void check_convection(CellType cell)
{
  Bench b;
  Model *m = scattered(&b, cell);
  const PetscInt dim = m->dim, n = dim == 3 ? SIDE * SIDE * SIDE : SIDE * SIDE;
  const PetscReal fade = 0.3;
  PetscInt64 last = 0;
  PetscReal *x, *v;
  for (PetscInt p = 0; p < m->points->n; ++p) last = PetscMax(last, m->points->id[p]);
  CALL(MPI_Allreduce(MPI_IN_PLACE, &last, 1, MPIU_INT64, MPI_MAX, m->comm));
  CALL(PetscCalloc2((last + 1) * dim, &x, (last + 1) * dim, &v));
  for (PetscInt p = 0; p < m->points->n; ++p)
    for (PetscInt d = 0; d < dim; ++d) {
      x[m->points->id[p] * dim + d] = point_real(m->points, POINT_X, p)[d];
      v[m->points->id[p] * dim + d] = point_real(m->points, POINT_V, p)[d];
    }
  CALL(MPI_Allreduce(MPI_IN_PLACE, x, (int)((last + 1) * dim), MPIU_REAL, MPI_SUM, m->comm));
  CALL(MPI_Allreduce(MPI_IN_PLACE, v, (int)((last + 1) * dim), MPIU_REAL, MPI_SUM, m->comm));
  for (PetscInt i = 0; i < m->grid->n_nodes; ++i)
    for (PetscInt d = 0, k = place_of(m->grid, i); d < dim; ++d) {
      m->nodes->du[i * dim + d] = field(0, k, d);
      m->nodes->v1[i * dim + d] = field(1, k, d);
      m->nodes->a1[i * dim + d] = field(2, k, d);
      m->nodes->v_points[i * dim + d] = field(3, k, d);
    }
  m->space->fade = fade;
  CALL(m->method->convect(m->space));
  for (PetscInt p = 0; p < m->points->n; ++p)
    for (PetscInt d = 0; d < dim; ++d) {
      const PetscInt64 id = m->points->id[p];
      PetscReal sum[4] = {0, 0, 0, 0};
      for (PetscInt k = 0; k < n; ++k)
        for (PetscInt f = 0; f < 4; ++f) sum[f] += shape_at(dim, k, x + id * dim) * field(f, k, d);
      const PetscReal fast = v[id * dim + d], moved = fast + sum[1] - sum[3] - fade * (fast - sum[3]);
      CHECK_CLOSE(point_real(m->points, POINT_X, p)[d], x[id * dim + d] + sum[0], 1e-13);
      CHECK_CLOSE(point_real(m->points, POINT_U, p)[d], sum[0], 1e-13);
      CHECK_CLOSE(point_real(m->points, POINT_V, p)[d], moved, 1e-13);
      CHECK_CLOSE(point_real(m->points, POINT_A, p)[d], sum[2], 1e-13);
    }
  CALL(PetscFree2(x, v));
  CALL(ModelDestroy(&m));
}

static void test_convection(void **state)
{
  (void)state;
  check_convection(CELL_QUADRILATERAL);
  check_convection(CELL_HEXAHEDRON);
}

/* Nodes that are held, or move evenly, have that velocity and no acceleration, whatever hits them:
 * a block that lands on a floor, which itself slides. */
static void test_held_nodes(void **state)
{
  (void)state;
  for (int damped = 0; damped < 2; ++damped) {
    Bench b;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, CELLS);
    bench_box(&b, 0, (PetscReal[]){1. / 3, 1. / 6, 0}, (PetscReal[]){2. / 3, 1. / 2, 1});
    bench_dynamic(&b, 1, 5e-3);
    b.body[0].velocity[1] = -2;
    b.c.gravity[1] = -10;
    if (damped) b.c.analysis.bossak = -0.2, b.c.analysis.beta = 0.36, b.c.analysis.gamma = 0.7;
    MotionSpec *floor = bench_motion(&b, 1, 0, MOTION_VELOCITY, 3);
    floor->value[0] = 0.25;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    PetscReal pushed = 0;
    for (int step = 0; step < 40; ++step) {
      model_step(m, 5e-3);
      for (PetscInt i = 0; i < m->grid->n_owned; ++i) {
        if (m->grid->x[2 * i + 1] > 1e-9 || !m->nodes->touched[i]) continue;
        CHECK_CLOSE(m->nodes->v1[2 * i], 0.25, 1e-12);
        CHECK_CLOSE(m->nodes->v1[2 * i + 1], 0, 1e-12);
        for (int d = 0; d < 2; ++d) CHECK_CLOSE(m->nodes->a1[2 * i + d], 0, 1e-9);
        pushed = PetscMax(pushed, m->nodes->reaction[2 * i + 1]);
      }
    }
    CHECK(model_max(m, pushed) > 100, "the block has not landed");
    CALL(ModelDestroy(&m));
  }
}

/* At t = 0 all that is free falls, and nothing moves what is held: points of the lowest cells know
 * both. */
static void test_first_acceleration(void **state)
{
  (void)state;
  for (int held = 0; held < 2; ++held) {
    Bench b;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, CELLS);
    bench_box(&b, 0, (PetscReal[]){1. / 3, 0, 0}, (PetscReal[]){2. / 3, 1. / 2, 1});
    bench_dynamic(&b, 1, 5e-3);
    b.c.gravity[1] = -10;
    if (held) bench_motion(&b, 1, 0, MOTION_FIXED, 2);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (PetscInt p = 0; p < m->points->n; ++p) {
      const PetscReal y = point_real(m->points, POINT_X, p)[1];
      CHECK_CLOSE(point_real(m->points, POINT_A, p)[1], held ? -10 * PetscMin(1, y * CELLS) : -10, 1e-9);
      CHECK_CLOSE(point_real(m->points, POINT_A, p)[0], 0, 1e-12);
    }
    CALL(ModelDestroy(&m));
  }
}

/* What one averaging over neighbours takes away of a pressure, by present volumes: to the nodes and
 * back. */
static void test_roughness(void **state)
{
  Bench b;
  PetscReal average[SIDE * SIDE], volume[SIDE * SIDE], rough = 0, all = 0;
  Random random = {9};
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, CELLS);
  bench_dynamic(&b, 1, 0.01);
  Model *m = bench_model(&b, PETSC_COMM_SELF);
  PetscReal *pressure;
  CALL(PetscMalloc1(m->points->n, &pressure));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal J = m->points->real[POINT_J][p] = random_real(&random, 0.5, 2);
    PetscReal tau[6] = {0, 0, 0, 3, 0, 0};
    pressure[p] = random_real(&random, 10, 30);
    for (int k = 0; k < 3; ++k) tau[k] = -pressure[p] * J;
    point_set_tau(m->points, p, tau);
  }
  for (PetscInt k = 0; k < SIDE * SIDE; ++k) {
    average[k] = volume[k] = 0;
    for (PetscInt p = 0; p < m->points->n; ++p) {
      const PetscReal w = shape_at(2, k, point_real(m->points, POINT_X, p)) * m->points->real[POINT_VOLUME][p] *
                          m->points->real[POINT_J][p];
      average[k] += w * pressure[p];
      volume[k] += w;
    }
    average[k] /= volume[k];
  }
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal present = m->points->real[POINT_VOLUME][p] * m->points->real[POINT_J][p];
    PetscReal smooth = 0;
    for (PetscInt k = 0; k < SIDE * SIDE; ++k) smooth += shape_at(2, k, point_real(m->points, POINT_X, p)) * average[k];
    rough += present * PetscSqr(pressure[p] - smooth);
    all += present * PetscSqr(pressure[p]);
  }
  CHECK_CLOSE(model_sum(m, "roughness: pressure", 0), PetscSqrtReal(rough / all), 1e-12);
  CALL(PetscFree(pressure));
  CALL(ModelDestroy(&m));
}

/* A cell is as full as the undeformed volume of its points, less what they are pressed together:
 * material that has come apart fills no more than it did. What it lacks is lumped and tied. */
static void check_filling(CellType cell, PetscReal volume, PetscReal J, PetscReal lack)
{
  const PetscReal M = 1e6 * 0.7 / (1.3 * 0.4);
  Bench b;
  bench_init(&b, "mpm", cell, 4);
  bench_motion(&b, 1, 0, MOTION_FIXED, 7); /* statics wants it held */
  b.c.stabilisation = (StabilisationSpec){.stiffness = 1e-3, .mass = 0.2, .inertia = 0.05};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    m->points->real[POINT_VOLUME][p] *= volume;
    m->points->real[POINT_MASS][p] *= volume;
    m->points->real[POINT_J][p] = J;
  }
  CALL(m->method->initialise(m->space));
  const PetscReal size = cell == CELL_TRIANGLE ? PetscSqrtReal(1. / 32) : 0.25, whole = m->dim == 3 ? 1. / 64
                                                                                        : cell == CELL_TRIANGLE
                                                                                          ? 1. / 32
                                                                                          : 1. / 16;
  for (PetscInt g = 0; g < m->space->support->n_groups; ++g) {
    CHECK_CLOSE(m->space->lumping[g], 0.2 * lack, 1e-12);
    CHECK_CLOSE(m->space->tie[g], 0.05 * lack * 1000 * volume * whole, 1e-9);
    CHECK_CLOSE(m->space->soft[g], 1e-3 * lack * M * whole / PetscSqr(size), 1e-6);
  }
  CALL(ModelDestroy(&m));
}

static void test_filling(void **state)
{
  static const CellType cell[] = {CELL_TRIANGLE, CELL_QUADRILATERAL, CELL_HEXAHEDRON};
  (void)state;
  for (int k = 0; k < 3; ++k) {
    check_filling(cell[k], 1, 1, 0);
    check_filling(cell[k], 0.5, 1, 0.5);
    check_filling(cell[k], 0.5, 2, 0.5);
    check_filling(cell[k], 1, 0.75, 0.25);
    check_filling(cell[k], 2, 1, 0);
  }
}

/* Points that stand at one side leave the corners of the other without mass, however many they are:
 * a corner should have a sixteenth of the mass in the plane, a quarter of what regular points give
 * it. */
static void test_one_sided(void **state)
{
  static const PetscReal side[] = {0.5, 0.7, 0.8, 0.9, 0.99};
  (void)state;
  for (int k = 0; k < 5; ++k) {
    Bench b;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
    bench_motion(&b, 1, 0, MOTION_FIXED, 7);
    b.c.stabilisation = (StabilisationSpec){.stiffness = 1e-3, .mass = 0.2, .inertia = 0.05};
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (PetscInt p = 0; p < m->points->n; ++p) point_real(m->points, POINT_XI, p)[0] = side[k];
    CALL(m->method->initialise(m->space));
    const PetscReal least = (1 - side[k]) / 2 / 2, lack = PetscMax(0, 1 - 16 * least);
    for (PetscInt g = 0; g < m->space->support->n_groups; ++g) {
      CHECK_CLOSE(m->space->lumping[g], 0.2 * lack, 1e-12);
      CHECK_CLOSE(m->space->tie[g], 0.05 * lack * 1000. / 16, 1e-9);
    }
    CALL(ModelDestroy(&m));
  }
}

/* --- clouds --- */
/* Statics without any force on a block over a floor: nothing moves but nodes that stand too
 * near. */
static Model *resting(Bench *b)
{
  bench_init(b, "gmm", CELL_QUADRILATERAL, 0);
  b->c.basis = usual_lme;
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 1}, 0.125);
  bench_motion(b, 1, 0, MOTION_FIXED, 3);
  b->c.newton.residual_absolute = 1e-6;
  return bench_model(b, PETSC_COMM_SELF);
}

static PetscInt node_at(const Model *m, PetscReal x, PetscReal y)
{
  for (PetscInt i = 0; i < m->grid->n_nodes; ++i)
    if (!cloud_is_twin(m->grid, i) &&
        PetscAbsReal(m->grid->x[2 * i] - x) + PetscAbsReal(m->grid->x[2 * i + 1] - y) < 1e-9)
      return i;
  CHECK(0, "no node at %g, %g", (double)x, (double)y);
  return -1;
}

/* Put a node so near to another (along (0.6, 0.8)), and let a step pass: how far apart are they,
 * and how far did the other go? */
static void check_apart(PetscReal other_y, PetscReal distance, PetscReal expected, PetscReal other_goes)
{
  Bench b;
  Model *m = resting(&b);
  const PetscInt near = node_at(m, 0.5, other_y + 0.125), other = node_at(m, 0.5, other_y);
  const PetscReal at[2] = {m->grid->x[2 * other], m->grid->x[2 * other + 1]};
  m->grid->x[2 * near] = at[0] + 0.6 * distance;
  m->grid->x[2 * near + 1] = at[1] + 0.8 * distance;
  CALL(m->method->initialise(m->space));
  model_step(m, 1);
  const PetscReal *x = m->grid->x + 2 * near, *y = m->grid->x + 2 * other;
  CHECK_CLOSE(x[0] - y[0], 0.6 * expected, 1e-8);
  CHECK_CLOSE(x[1] - y[1], 0.8 * expected, 1e-8);
  CHECK_CLOSE(at[0] - y[0], 0.6 * other_goes, 1e-8);
  CHECK_CLOSE(at[1] - y[1], 0.8 * other_goes, 1e-8);
  CALL(ModelDestroy(&m));
}

/* A quarter of the spacing at least: a free pair shares the way, a held node keeps its place. */
static void test_keep_off(void **state)
{
  const PetscReal least = 0.125 / 4;
  (void)state;
  check_apart(0.5, 0.01, least, (least - 0.01) / 2);
  check_apart(0, 0.01, least, 0);
  check_apart(0.5, 0.04, 0.04, 0);
  check_apart(0, 0.04, 0.04, 0);
}

/* Does the cloud of a node of the block hold a node of the floor, and do points touch one? */
static void look_at_floor(const Model *m, PetscBool *near, PetscBool *touched)
{
  const Support *w = gmm_of(m->space)->nodes;
  *near = *touched = PETSC_FALSE;
  for (PetscInt i = 0; i < m->grid->n_nodes; ++i)
    if (m->grid->x[2 * i + 1] < 1e-9 && m->nodes->touched[i]) *touched = PETSC_TRUE;
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    PetscBool floor = PETSC_FALSE, block = PETSC_FALSE;
    for (PetscInt e = w->node_start[g]; e < w->node_start[g + 1]; ++e) {
      if (m->grid->x[2 * w->node[e] + 1] < 1e-9) floor = PETSC_TRUE;
      else block = PETSC_TRUE;
    }
    if (floor && block) *near = PETSC_TRUE;
  }
}

/* A block that slides over a floor whose nodes are in clouds of its nodes, but of none of its
 * points: its nodes move as it does. */
static void test_nodes_follow(void **state)
{
  int seen = 0;
  (void)state;
  for (int k = 0; k < 12; ++k) {
    Bench b;
    PetscBool near, touched;
    const PetscReal h = 0.125, lower = h * (PetscReal)k / 8;
    bench_init(&b, "gmm", CELL_QUADRILATERAL, 0);
    b.c.basis = usual_lme;
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1, 1}, h);
    bench_box(&b, 0, (PetscReal[]){0.5, 2 * h, 0}, (PetscReal[]){1, 6 * h, 1});
    bench_dynamic(&b, 1, 1e-3);
    b.body[0].velocity[0] = 4;
    bench_motion(&b, 1, 0, MOTION_FIXED, 2);
    Model *m = bench_model(&b, PETSC_COMM_SELF);
    for (PetscInt i = 0; i < m->grid->n_nodes; ++i)
      if (m->grid->x[2 * i + 1] > h) m->grid->x[2 * i + 1] -= lower;
    for (PetscInt p = 0; p < m->points->n; ++p) point_real(m->points, POINT_X, p)[1] -= lower;
    CALL(m->method->initialise(m->space));
    look_at_floor(m, &near, &touched);
    PetscReal *before;
    CALL(PetscMalloc1(2 * m->grid->n_owned, &before));
    CALL(PetscArraycpy(before, m->grid->x, 2 * m->grid->n_owned));
    if (near && !touched) {
      ++seen;
      model_step(m, 1e-3);
      for (PetscInt i = 0; i < m->grid->n_owned; ++i) {
        CHECK_CLOSE(m->grid->x[2 * i] - before[2 * i], before[2 * i + 1] < 1e-9 ? 0 : 4e-3, 1e-12);
        CHECK_CLOSE(m->grid->x[2 * i + 1] - before[2 * i + 1], 0, 1e-12);
      }
    }
    CALL(PetscFree(before));
    CALL(ModelDestroy(&m));
  }
  CHECK(seen > 0, "no height at which only nodes see the floor");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_projection),         cmocka_unit_test(test_convection), cmocka_unit_test(test_held_nodes),
    cmocka_unit_test(test_first_acceleration), cmocka_unit_test(test_roughness),  cmocka_unit_test(test_filling),
    cmocka_unit_test(test_one_sided),          cmocka_unit_test(test_keep_off),   cmocka_unit_test(test_nodes_follow)};
  return run_model_tests(argc, argv, tests);
}
