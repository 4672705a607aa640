/* Walls along which nodes slide, `fix: [normal]`: a turned copy of an aligned problem gives the
 * turned answer, a block slides down a plane as a point mass does, walls carry what balance asks
 * of them, and what cannot be is refused. */
#include "case_builder.h"

/* x -> R x + shift */
typedef struct {
  PetscReal R[9], shift[3];
} Turn;

static const Turn nowhere = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

/* By an angle about z and, in space, by another about x. */
static Turn turn_by(PetscInt dim, PetscReal a, PetscReal b)
{
  const PetscReal c = cos(a), s = sin(a), C = dim == 3 ? cos(b) : 1, S = dim == 3 ? sin(b) : 0;
  return (Turn){.R = {c, -s, 0, C * s, C * c, -S, S * s, S * c, C}, .shift = {0.3, -0.2, 0}};
}

static void turn_vector(const Turn *t, const PetscReal *v, PetscReal *turned)
{
  for (int i = 0; i < 3; ++i) turned[i] = t->R[3 * i] * v[0] + t->R[3 * i + 1] * v[1] + t->R[3 * i + 2] * v[2];
}

static void turn_place(const Turn *t, PetscInt dim, const PetscReal *x, PetscReal *turned)
{
  const PetscReal X[3] = {x[0], x[1], dim == 3 ? x[2] : 0};
  turn_vector(t, X, turned);
  for (int i = 0; i < 3; ++i) turned[i] += t->shift[i];
}

typedef struct {
  const Turn *turn;
  BenchDistortion shake;
} Placing;

static void place(void *context, PetscInt dim, PetscReal size, PetscReal *x)
{
  Placing *p = context;
  PetscReal y[3];
  bench_shake(&p->shake, dim, size, x);
  turn_place(p->turn, dim, x, y);
  for (PetscInt d = 0; d < dim; ++d) x[d] = y[d];
}

/* Of the plane X_axis = at: what lies on the side of larger X (1) or smaller X (-1), turned. */
static Shape beyond(const Turn *t, int axis, PetscReal at, int side)
{
  Shape s = {.kind = SHAPE_HALF_SPACE};
  PetscReal X[3] = {0, 0, 0};
  X[axis] = at;
  turn_place(t, 3, X, s.point);
  for (int i = 0; i < 3; ++i) s.normal[i] = -side * t->R[3 * i + axis];
  return s;
}

static MotionSpec *wall(Bench *b, const Turn *t, int axis, PetscReal at, int side, PetscBool slip)
{
  MotionSpec *m = bench_motion(b, -1, 0, MOTION_FIXED, slip ? 0 : 1u << axis);
  m->component[NORMAL] = slip;
  m->on.has_shape = PETSC_TRUE;
  m->on.shape = beyond(t, axis, at, side);
  return m;
}

typedef struct {
  const char *method, *formulation;
  CellType cell;
  PetscBool dynamic, keep;
  LinearChoice linear;
} Kind;

/* The unit square or cube up to a height, turned: as a polygon, in space as the box around it. */
static void fill(Bench *b, const Turn *t, PetscInt dim, PetscReal height, PetscReal vertices[8])
{
  Shape *s = &b->body[0].shape;
  PetscReal x[3];
  *s = (Shape){.kind = dim == 2 ? SHAPE_POLYGON : SHAPE_BOX, .n_vertices = 4, .vertices = vertices};
  for (int k = 0; k < 8; ++k) {
    turn_place(t, 3, (PetscReal[]){(k & 1) ^ (k >> 1 & 1), (k >> 1 & 1) * height, k >> 2}, x);
    for (int d = 0; d < 2 && k < 4; ++d) vertices[2 * k + d] = x[d];
    for (int d = 0; d < 3; ++d) {
      s->min[d] = k ? PetscMin(s->min[d], x[d]) : x[d];
      s->max[d] = k ? PetscMax(s->max[d], x[d]) : x[d];
    }
  }
}

/* Rubber that fills a distorted mesh of the unit square or cube, or its lower part (mpm), is
 * pulled by an inclined gravity, and in dynamics thrown, too; all walls, where the body would leave
 * the grid the upper one too, hold their normal component: as they are, by components; turned, by normals. */
static void bench_of(Bench *b, const Kind *k, const Turn *t, PetscReal vertices[8])
{
  const PetscReal g[3] = {4, -9, 2}, v[3] = {0.5, -2, -0.3}, planes[] = {0, 1};
  Placing placing = {.turn = t, .shake = {.random = {7}, .amount = 0.15, .n_planes = 2, .plane = planes}};
  bench_init(b, k->method, k->cell, k->cell < CELL_TETRAHEDRON ? 4 : 3);
  const PetscInt dim = kinematics_dim(b->c.kinematics);
  bench_mesh(b, place, &placing);
  b->c.formulation = (char *)k->formulation;
  b->c.mixed.stabilisation = 1;
  b->c.linear = k->linear;
  if (!strcmp(k->formulation, "mixed")) b->material.law = "neo-hookean-split";
  b->body[0].weights = WEIGHTS_GAUSS;
  fill(b, t, dim, dim == 2 && !strcmp(k->method, "mpm") ? 0.7 : 1, vertices);
  turn_vector(t, (PetscReal[]){g[0], g[1], dim == 3 ? g[2] : 0}, b->c.gravity);
  if (k->dynamic) {
    bench_dynamic(b, 1, 0.01);
    b->c.analysis.keep_velocity = k->keep;
    b->c.analysis.bossak = -0.05;
    turn_vector(t, (PetscReal[]){v[0], v[1], dim == 3 ? v[2] : 0}, b->body[0].velocity);
  }
  for (int axis = 0; axis < dim; ++axis)
    for (int side = -1; side <= (axis == 1 && (dim == 2 || !k->dynamic) ? -1 : 1); side += 2)
      wall(b, t, axis, side > 0 ? 1 : 0, side, t != &nowhere);
}

static void reactions(Model *m, PetscInt entry, PetscReal *force)
{
  for (PetscInt d = 0; d < 3; ++d) {
    const MeasureSpec measure = {.kind = "reaction", .component = d, .boundary = entry};
    force[d] = 0;
    if (d < m->dim) CALL(ModelMeasure(m, &measure, 0, &force[d]));
  }
}

/* Points of the one where the turn puts those of the other, which holds all on each rank. */
static void compare_points(const Model *turned, const Model *plain, const Turn *t, PetscReal worst[2])
{
  const Points *a = turned->points, *s = plain->points;
  PetscInt64 last = 0;
  PetscInt *at, n;
  PetscReal x[3], v[3], local[2] = {0, 0};
  for (PetscInt p = 0; p < s->n; ++p) last = PetscMax(last, s->id[p]);
  CALL(PetscMalloc1(last + 1, &at));
  for (PetscInt p = 0; p < s->n; ++p) at[s->id[p]] = p;
  for (PetscInt p = 0; p < a->n; ++p) {
    const PetscReal *V = point_real(s, POINT_V, at[a->id[p]]), full[3] = {V[0], V[1], s->dim == 3 ? V[2] : 0};
    turn_place(t, s->dim, point_real(s, POINT_X, at[a->id[p]]), x);
    turn_vector(t, full, v);
    for (PetscInt d = 0; d < s->dim; ++d) {
      local[0] = PetscMax(local[0], PetscAbsReal(point_real(a, POINT_X, p)[d] - x[d]));
      local[1] = PetscMax(local[1], PetscAbsReal(point_real(a, POINT_V, p)[d] - v[d]));
    }
  }
  CALL(PetscFree(at));
  CALL(ModelCountPoints(turned, &n));
  CHECK(n == s->n, "%d points, not %d", (int)n, (int)s->n);
  CALL(MPI_Allreduce(local, worst, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
}

static void copy_of(const Kind *k)
{
  Bench plain, turned;
  PetscReal worst[2], R[3], r[3], turned_R[3], off = 0, vertices[2][8];
  const Turn t = turn_by(k->cell >= CELL_TETRAHEDRON ? 3 : 2, 0.6, 1.1);
  bench_of(&plain, k, &nowhere, vertices[0]);
  bench_of(&turned, k, &t, vertices[1]);
  Model *p = bench_model(&plain, PETSC_COMM_SELF), *m = bench_model(&turned, PETSC_COMM_WORLD);
  const PetscInt steps = k->dynamic ? 5 : 1;
  PetscInt iterations[2] = {0, 0};
  PetscMPIInt ranks;
  for (PetscInt s = 0; s < steps; ++s) {
    iterations[0] += model_step(p, 1).newton.iterations;
    iterations[1] += model_step(m, 1).newton.iterations;
  }
  compare_points(m, p, &t, worst);
  for (PetscInt e = 0; e < turned.c.n_boundary; ++e) {
    reactions(p, e, R);
    reactions(m, e, r);
    turn_vector(&t, R, turned_R);
    for (int d = 0; d < 3; ++d) off = PetscMax(off, PetscAbsReal(r[d] - turned_R[d]));
  }
  CHECK(worst[0] <= 1e-13 && worst[1] <= 1e-11, "%s %s: off by %.2g m, %.2g m/s", k->method, k->formulation,
        (double)worst[0], (double)worst[1]);
  CHECK(off <= 6e-8, "%s %s: reactions are off by %.2g N", k->method, k->formulation, (double)off);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks); /* iterative solvers go another way on several */
  CHECK(ranks > 1 || iterations[0] == iterations[1], "%d iterations, not %d", (int)iterations[1], (int)iterations[0]);
  CALL(ModelDestroy(&p));
  CALL(ModelDestroy(&m));
  bench_end(&plain);
  bench_end(&turned);
}

static void test_turned(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell)
    EACH_VARIANT (variant, 4) {
      const PetscBool mpm = (variant ^ cell) & 1, dynamic = variant >> 1;
      Kind k = {mpm ? "mpm" : "fem", "displacement", cell, dynamic, dynamic && mpm && cell % 2, LINEAR_DIRECT};
      copy_of(&k);
      k.formulation = "mixed";
      if (!dynamic) copy_of(&k);
      k.linear = LINEAR_ITERATIVE;
      k.formulation = mpm ? "displacement" : "mixed";
      if (dynamic) copy_of(&k);
    }
}

/* Mean place and velocity of all points in the frame of the slope, and the lowest of them. */
static void block_state(const Model *m, const Turn *t, PetscReal mean[3], PetscReal *lowest)
{
  PetscReal local[3] = {0, 0, 0}, low = PETSC_MAX_REAL;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p), *v = point_real(m->points, POINT_V, p);
    const PetscReal mass = m->points->real[POINT_MASS][p];
    const PetscReal dx[2] = {x[0] - t->shift[0], x[1] - t->shift[1]};
    local[0] += mass;
    local[1] += mass * (t->R[0] * dx[0] + t->R[3] * dx[1]);
    local[2] += mass * (t->R[0] * v[0] + t->R[3] * v[1]);
    low = PetscMin(low, t->R[1] * dx[0] + t->R[4] * dx[1]);
  }
  CALL(MPI_Allreduce(local, mean, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  CALL(MPI_Allreduce(&low, lowest, 1, MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD));
  mean[1] /= mean[0];
  mean[2] /= mean[0];
}

/* A block of rubber on a slope of 0.5 rad without friction: g sin(0.5) along it, exactly, over
 * twenty cells of a distorted mesh, while it quivers across; nothing goes through the wall. */
static void test_slope(void **state)
{
  const PetscReal planes[] = {0, 1, 4}, angle = 0.5;
  const Turn t = turn_by(2, -angle, 0);
  (void)state;
  for (int keep = 0; keep < 2; ++keep) {
    Bench b;
    PetscReal vertices[8], start[3], now[3], lowest;
    Placing placing = {.turn = &t, .shake = {.random = {7}, .amount = 0.15, .n_planes = 3, .plane = planes}};
    bench_init(&b, "mpm", keep ? CELL_TRIANGLE : CELL_QUADRILATERAL, 0);
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 0}, 0.125);
    bench_mesh(&b, place, &placing);
    fill(&b, &t, 2, 0.45, vertices);
    for (int k = 0; k < 4; ++k) { /* from X = 0.2 to 0.7 */
      const PetscReal X[2] = {k == 1 || k == 2 ? 0.7 : 0.2, k >> 1 ? 0.45 : 0};
      PetscReal x[3];
      turn_place(&t, 2, X, x);
      vertices[2 * k] = x[0], vertices[2 * k + 1] = x[1];
    }
    b.c.gravity[1] = -9.81;
    bench_dynamic(&b, 1, 0.01);
    b.c.analysis.keep_velocity = keep;
    wall(&b, &t, 1, 0, -1, PETSC_TRUE);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    block_state(m, &t, start, &lowest);
    for (int s = 0; s < 100; ++s) {
      model_step(m, 1);
      block_state(m, &t, now, &lowest);
      CHECK_CLOSE(now[1] - start[1], 0.5 * 9.81 * sin(angle) * m->time * m->time, 1e-10);
      CHECK_CLOSE(now[2], 9.81 * sin(angle) * m->time, 1e-10);
      CHECK(lowest > 0, "a point is %g m below the wall", (double)-lowest);
    }
    for (PetscInt k = 0; k < m->boundary->frames.n; ++k) {
      const PetscReal *du = m->nodes->du + 2 * m->boundary->frames.node[k];
      CHECK(PetscAbsReal(t.R[1] * du[0] + t.R[4] * du[1]) <= 1e-14 * 0.125, "a node left the wall");
    }
    CALL(ModelDestroy(&m));
    bench_end(&b);
  }
}

/* A funnel without friction, 0.4 m wide at its open foot and 0.45 rad from its axis. */
#define FUNNEL 0.45

static void place_in_funnel(void *context, PetscInt dim, PetscReal size, PetscReal *x)
{
  const PetscBool *round = context;
  (void)dim, (void)size;
  x[0] = (*round ? x[0] : 2 * x[0] - 1) * (0.2 + x[1] * tan(FUNNEL));
}

/* An elastic plug hangs on the walls: each carries its share along its normal, in the plane and
 * around the axis. */
static void test_funnel(void **state)
{
  (void)state;
  EACH_VARIANT (k, 8) {
    const PetscBool dynamic = k & 1, is_round = k >> 2;
    const PetscReal top = 0.2 + tan(FUNNEL);
    PetscReal vertices[8] = {is_round ? 0 : -0.2, 0, 0.2, 0, top, 1, is_round ? 0 : -top, 1}, R[3];
    Bench b;
    bench_init(&b, "fem", k & 2 ? CELL_TRIANGLE : CELL_QUADRILATERAL, 6);
    if (is_round) b.c.kinematics = &kinematics_axisymmetric;
    bench_mesh(&b, place_in_funnel, (void *)&is_round);
    b.body[0].weights = WEIGHTS_GAUSS;
    b.body[0].shape = (Shape){.kind = SHAPE_POLYGON, .n_vertices = 4, .vertices = vertices};
    b.c.gravity[1] = -3;
    for (int side = 1; side >= (is_round ? 1 : -1); side -= 2) {
      MotionSpec *m = bench_motion(&b, -1, 0, MOTION_FIXED, 0);
      m->component[NORMAL] = m->on.has_shape = PETSC_TRUE;
      m->on.shape =
        (Shape){.kind = SHAPE_HALF_SPACE, .point = {side * 0.2}, .normal = {-side * cos(FUNNEL), sin(FUNNEL)}};
    }
    if (is_round) bench_motion(&b, 0, 0, MOTION_FIXED, 1);
    if (dynamic) bench_dynamic(&b, 1, 0.02);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (int s = 0; s < (dynamic ? 20 : 1); ++s) {
      const PetscReal before = dynamic ? model_sum(m, "momentum", 1) : 0;
      const PetscReal dt = model_step(m, 1).dt, gained = dynamic ? (model_sum(m, "momentum", 1) - before) / dt : 0;
      const PetscReal carried = 3 * model_sum(m, "mass: total", 0) + gained;
      PetscReal rest = carried;
      for (int side = 0; side < (is_round ? 1 : 2); ++side) {
        reactions(m, side, R);
        rest -= R[1];
        CHECK_CLOSE(R[0], (side ? 1 : -1) * R[1] / tan(FUNNEL), 1e-12 * 3000);
      }
      CHECK_CLOSE(rest, 0, 1e-8 * 3000);
    }
    CALL(ModelDestroy(&m));
    bench_end(&b);
  }
}

/* A quarter of a ring of radii 1 and 2 that begins at an odd angle. */
#define FIRST 0.35

static void place_in_ring(void *context, PetscInt dim, PetscReal size, PetscReal *x)
{
  const PetscReal r = 1 + x[0], angle = FIRST + x[1] * PETSC_PI / 2, offset = *(const PetscReal *)context;
  (void)dim, (void)size;
  x[0] = offset + r * cos(angle);
  x[1] = r * sin(angle);
}

/* All of it: the box around is as large as the mesh. */
static void fill_ring(Bench *b, PetscReal offset)
{
  const PetscReal last = FIRST + PETSC_PI / 2;
  b->body[0].shape = (Shape){
    .kind = SHAPE_BOX, .min = {offset + 2 * cos(last), sin(FIRST), 0}, .max = {offset + 2 * cos(FIRST), 1.99, 1}};
}

/* The whole boundary slides, round sides of chords too, and the body is pressed alike everywhere:
 * nothing moves, since nodes are held across the very way along which pressure acts. */
static void test_pressure(void **state)
{
  (void)state;
  EACH_VARIANT (k, 5) {
    static const CellType cell[] = {CELL_TRIANGLE, CELL_QUADRILATERAL, CELL_TRIANGLE, CELL_QUADRILATERAL,
                                    CELL_HEXAHEDRON};
    const PetscBool is_round = k == 2 || k == 3;
    const PetscReal offset = is_round ? 3 : 0, squeeze = 0.98 * 0.98;
    PetscReal moved = 0;
    Bench b;
    bench_init(&b, "fem", cell[k], 5);
    if (is_round) b.c.kinematics = &kinematics_axisymmetric;
    bench_mesh(&b, place_in_ring, (void *)&offset);
    b.body[0].weights = WEIGHTS_GAUSS;
    fill_ring(&b, offset);
    bench_motion(&b, -1, 0, MOTION_FIXED, 0)->component[NORMAL] = PETSC_TRUE;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (PetscInt p = 0; p < m->points->n; ++p)
      for (int i = 0; i < 3; ++i) point_real(m->points, POINT_STATE, p)[i] = squeeze;
    model_step(m, 1);
    for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i) moved = PetscMax(moved, PetscAbsReal(m->nodes->du[i]));
    CHECK(m->boundary->frames.n > 4, "only %d nodes slide along a side of their own", (int)m->boundary->frames.n);
    CHECK(model_max(m, moved) <= 1e-14, "a node moves by %g m", (double)model_max(m, moved));
    CALL(ModelDestroy(&m));
    bench_end(&b);
  }
}

/* The largest error of the displacements of all points beside those of Lame; pressure within, both
 * cuts slide. */
static PetscReal tube_error(PetscInt n)
{
  const PetscReal offset = 0, p = 1, top = FIRST + PETSC_PI / 2, h = PETSC_PI / 2 / (PetscReal)n;
  LoadSpec load[16];
  Bench b;
  PetscReal worst = 0;
  bench_init(&b, "fem", CELL_QUADRILATERAL, n);
  bench_mesh(&b, place_in_ring, (void *)&offset);
  b.body[0].weights = WEIGHTS_GAUSS;
  fill_ring(&b, 0);
  b.c.loads = load;
  for (PetscInt e = 0; e < n; ++e) { /* on each chord of the inner side */
    const PetscReal middle = FIRST + h * ((PetscReal)e + 0.5), r = cos(h / 2);
    LoadSpec *l = &load[b.c.n_loads++];
    *l = (LoadSpec){.kind = LOAD_TRACTION, .value = {p * cos(middle), p * sin(middle)}};
    l->on.has_shape = PETSC_TRUE;
    l->on.shape =
      (Shape){.kind = SHAPE_BALL, .centre = {r * cos(middle), r * sin(middle)}, .radius = 1.01 * sin(h / 2)};
  }
  for (int cut = 0; cut < 2; ++cut) {
    MotionSpec *m = bench_motion(&b, -1, 0, MOTION_FIXED, 0);
    m->component[NORMAL] = m->on.has_shape = PETSC_TRUE;
    m->on.shape =
      (Shape){.kind = SHAPE_HALF_SPACE, .normal = {cut ? sin(top) : -sin(FIRST), cut ? -cos(top) : cos(FIRST)}};
  }
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  model_step(m, 1);
  for (PetscInt q = 0; q < m->points->n; ++q) {
    const PetscReal *u = point_real(m->points, POINT_U, q), *x = point_real(m->points, POINT_X, q);
    const PetscReal X[2] = {x[0] - u[0], x[1] - u[1]}, r = sqrt(X[0] * X[0] + X[1] * X[1]);
    const PetscReal radial = 1.3 * p / 1e6 / 3 * (0.4 * r + 4 / r);
    for (int d = 0; d < 2; ++d) worst = PetscMax(worst, PetscAbsReal(u[d] - radial * X[d] / r) / 1.9066667e-6);
  }
  worst = model_max(m, worst);
  CALL(ModelDestroy(&m));
  bench_end(&b);
  return worst;
}

static void test_tube(void **state)
{
  (void)state;
  const PetscReal coarse = tube_error(8), fine = tube_error(16);
  CHECK(fine < 0.004, "off by %g", (double)fine);
  CHECK(coarse / fine > 3.6, "errors %g, %g: not of order 2", (double)coarse, (double)fine);
}

/* A wall inside the grid that is no side; a place that another entry moves through its wall; a cloud. */
static void test_refused(void **state)
{
  Bench b;
  MotionSpec *m;
  (void)state;
  bench_init(&b, "fem", CELL_QUADRILATERAL, 4);
  m = bench_motion(&b, 0, 0.5, MOTION_FIXED, 0);
  m->component[NORMAL] = PETSC_TRUE;
  bench_refused(&b, PETSC_COMM_WORLD, "boundary[0].fix", "but no side of the grid's boundary there");
  m->on.min[0] = m->on.max[0] = 0;
  m = bench_motion(&b, 1, 0, MOTION_VELOCITY, 1);
  m->value[0] = 1;
  bench_refused(&b, PETSC_COMM_WORLD, "boundary[0].fix", "boundary[0] contradicts boundary[1]");
  b.c.n_boundary = 1;
  b.c.method = "gmm";
  b.c.basis.kind = "lme";
  bench_refused(&b, PETSC_COMM_WORLD, "boundary[0].fix", "method gmm cannot let nodes slide");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_turned), cmocka_unit_test(test_slope),
                                     cmocka_unit_test(test_funnel), cmocka_unit_test(test_pressure),
                                     cmocka_unit_test(test_tube),   cmocka_unit_test(test_refused)};
  return run_model_tests(argc, argv, tests);
}
