/* Loads on the surface of a shape that cells do not follow: area, place and direction of what acts, by the divergence
 * theorem and by hand; and what bodies then do: stress alike everywhere under pressure, off the grid's lines, flat or
 * round. */
#include "boundary/surface/surface.h"
#include "case_builder.h"
#include "model/model_private.h"

static PetscReal one_time[] = {0}, one_value[] = {1};

/* Of carriers of load k: forces, moments about the origin, and x . f. */
typedef struct {
  PetscReal force[3], turn[3], virial, n;
} Acting;

static void add_acting(Acting *a, const PetscReal x[3], const PetscReal f[3])
{
  for (int d = 0; d < 3; ++d) {
    a->force[d] += f[d];
    a->turn[d] += x[(d + 1) % 3] * f[(d + 2) % 3] - x[(d + 2) % 3] * f[(d + 1) % 3];
    a->virial += x[d] * f[d];
  }
  a->n += 1;
}

static Acting acting(const Model *m, PetscInt k)
{
  const Points *p = m->loads->carriers;
  Acting a = {.n = 0}, all;
  for (PetscInt i = 0; i < p->n; ++i) {
    PetscReal x[3] = {0, 0, 0}, f[3] = {0, 0, 0};
    if (p->body[i] != k) continue;
    point_place(p, i, x);
    for (PetscInt d = 0; d < m->dim; ++d) f[d] = point_real(p, POINT_FORCE, i)[d];
    add_acting(&a, x, f);
  }
  CALL(MPI_Allreduce(&a, &all, sizeof a / sizeof(PetscReal), MPIU_REAL, MPIU_SUM, m->comm));
  return all;
}

static LoadSpec *on_body(Bench *b, LoadKind kind, PetscReal x, PetscReal y, PetscReal z)
{
  LoadSpec *load = &b->load[b->c.n_loads++];
  *load = (LoadSpec){.kind = kind, .value = {x, y, z}, .on = {.body = (char *)"body"}};
  load->amplitude = (Amplitude){.n = 1, .time = one_time, .value = one_value};
  return load;
}

static PetscReal length_of(const PetscReal a[3]) { return PetscSqrtReal(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

typedef struct {
  const char *name;
  const Kinematics *kinematics;
  Shape shape;
  PetscReal volume, area, tolerance, closed;
} Solid;

/* Normals sum to nothing, turn nothing, and x . n is dim times the volume. */
static void whole(const Solid *s, CellType cell)
{
  const PetscInt dim = s->kinematics->dim;
  const Selector all = {.body = NULL};
  Acting a = {.n = 0}, sum;
  PetscReal local = 0, area = 0;
  PetscInt n, *where;
  FacePoint *point;
  Bench b;
  Diag *diag;
  Grid *grid = NULL;
  bench_init(&b, "mpm", cell, 0);
  b.c.kinematics = s->kinematics;
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1.2, 1.2, 1.2}, dim == 3 ? 0.24 : 0.15);
  b.body[0].shape = s->shape;
  CALL(DiagCreate(&diag));
  CALL(GridCreate(PETSC_COMM_WORLD, &b.c, NULL, NULL, diag, &grid));
  CHECK(grid, "no grid");
  CALL(BodySurfacePoints(grid, &b.c, 0, &all, PETSC_FALSE, &n, &where, &point));
  for (PetscInt i = 0; i < n; ++i) {
    add_acting(&a, point[i].x, point[i].vector);
    local += point[i].area;
  }
  CALL(MPI_Allreduce(&a, &sum, sizeof a / sizeof(PetscReal), MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  CALL(MPI_Allreduce(&local, &area, 1, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  if (s->kinematics->hoop) sum.force[0] = sum.turn[2] = 0; /* rings are pulled open */
  const PetscReal volume = sum.virial / (s->kinematics->hoop ? 3 : (PetscReal)dim);
  PetscPrintf(PETSC_COMM_WORLD,
              "%-22s %-13s cell %d: volume off %8.1e, area %8.1e, force %8.1e, turn %8.1e, %g points\n", s->name,
              s->kinematics->name, (int)cell, (double)(volume / s->volume - 1), (double)(area / s->area - 1),
              (double)(length_of(sum.force) / s->area), (double)(length_of(sum.turn) / s->area), (double)sum.n);
  CHECK_CLOSE(volume, s->volume, s->tolerance * s->volume);
  CHECK_CLOSE(area, s->area, s->tolerance * s->area);
  CHECK(length_of(sum.force) < s->closed * s->area, "pushes with %g", (double)length_of(sum.force));
  CHECK(length_of(sum.turn) < PetscMax(s->closed, s->tolerance) * s->area, "turns with %g",
        (double)length_of(sum.turn));
  CALL(PetscFree(where));
  CALL(PetscFree(point));
  CALL(GridDestroy(&grid));
  CALL(DiagDestroy(&diag));
}

/* Turned by 17 degrees about (0.6, 0.6). */
static void turned(PetscReal x, PetscReal y, PetscReal at[2])
{
  const PetscReal c = cos(17 * PETSC_PI / 180), s = sin(17 * PETSC_PI / 180);
  at[0] = 0.6 + c * x - s * y;
  at[1] = 0.6 + s * x + c * y;
}

static void test_closed(void **state)
{
  const Kinematics *plane = &kinematics_plane_strain, *space = &kinematics_3d, *ring = &kinematics_axisymmetric;
  const PetscReal pi = PETSC_PI;
  PetscReal square[8];
  Shape ring_shape[2] = {{.kind = SHAPE_BALL, .centre = {0.61, 0.58, 0.6}, .radius = 0.5},
                         {.kind = SHAPE_BALL, .centre = {0.61, 0.58, 0.6}, .radius = 0.27}};
  Shape both[2] = {{.kind = SHAPE_BOX, .min = {0.2, 0.17, 0.2}, .max = {0.7, 0.7, 0.55}},
                   {.kind = SHAPE_BOX, .min = {0.5, 0.17, 0.2}, .max = {1.01, 0.7, 0.55}}};
  Shape half[2] = {{.kind = SHAPE_BALL, .centre = {0.61, 0.58, 0.6}, .radius = 0.5},
                   {.kind = SHAPE_HALF_SPACE, .point = {0.61, 0.58, 0.6}, .normal = {2, 3, 0}}};
  turned(-0.4, -0.3, square);
  turned(0.4, -0.3, square + 2);
  turned(0.4, 0.3, square + 4);
  turned(-0.4, 0.3, square + 6);
  const Shape box = {.kind = SHAPE_BOX, .min = {0.13, 0.2, 0.31}, .max = {0.77, 0.92, 0.9}};
  const Shape rod = {
    .kind = SHAPE_CYLINDER, .point = {0.4, 0.4, 0.4}, .normal = {1, 2, 2}, .length = 0.6, .radii = {0.25, 0.25}};
  const Solid solids[] = {
    {"box", plane, box, 0.64 * 0.72, 2 * (0.64 + 0.72), 1e-9, 1e-9},
    {"turned box", plane, {.kind = SHAPE_POLYGON, .n_vertices = 4, .vertices = square}, 0.48, 2.8, 1e-7, 1e-7},
    {"disk", plane, ring_shape[0], 0.25 * pi, pi, 3e-5, 1e-10},
    {"ring",
     plane,
     {.kind = SHAPE_DIFFERENCE, .n_children = 2, .children = ring_shape},
     pi * (0.25 - 0.0729),
     2 * pi * 0.77,
     1e-4,
     1e-10},
    {"half disk",
     plane,
     {.kind = SHAPE_INTERSECTION, .n_children = 2, .children = half},
     0.125 * pi,
     0.5 * pi + 1,
     3e-5,
     1e-6},
    {"one box upon another",
     plane,
     {.kind = SHAPE_UNION, .n_children = 2, .children = both},
     0.81 * 0.53,
     2 * 1.34,
     1e-9,
     1e-9},
    {"beyond the grid",
     plane,
     {.kind = SHAPE_HALF_SPACE, .point = {0, 0.97}, .normal = {0, 1}},
     1.2 * 0.97,
     2 * 2.17,
     1e-9,
     1e-9},
    {"along the grid", plane, {.kind = SHAPE_BOX, .min = {0.15, 0, 0}, .max = {0.9, 0.6, 0}}, 0.45, 2.7, 1e-9, 1e-9},
    {"box", ring, box, pi * (0.77 * 0.77 - 0.13 * 0.13) * 0.72, 2 * pi * (0.9 * 0.72 + 0.77 * 0.77 - 0.13 * 0.13), 1e-9,
     1e-9},
    {"ball", ring, {.kind = SHAPE_BALL, .centre = {0, 0.58}, .radius = 0.5}, pi / 6, pi, 3e-5, 1e-10},
    {"box", space, box, 0.64 * 0.72 * 0.59, 2 * (0.64 * 0.72 + 0.72 * 0.59 + 0.59 * 0.64), 1e-9, 1e-9},
    {"ball", space, ring_shape[0], pi / 6, pi, 5e-4, 1e-10},
    {"rod", space, rod, pi * 0.0625 * 0.6, pi * (0.125 + 0.3), 2e-3, 1e-4},
  };
  (void)state;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(solids); ++k) {
    const PetscBool is_3d = (PetscBool)(solids[k].kinematics->dim == 3), flat = (PetscBool)(solids[k].tolerance < 1e-8);
    whole(solids + k, is_3d ? CELL_HEXAHEDRON : CELL_QUADRILATERAL);
    if (!is_3d || flat) whole(solids + k, is_3d ? CELL_TETRAHEDRON : CELL_TRIANGLE);
  }
}

/* Mean over the volume of the Cauchy stress, and how far it is from -p at most and in the mean square, of p. */
typedef struct {
  PetscReal mean, off, worst;
} Pressed;

static Pressed pressed(const Model *m, PetscReal p)
{
  const Points *points = m->points;
  PetscReal local[3] = {0, 0, 0}, sum[3], worst = 0;
  for (PetscInt q = 0; q < points->n; ++q) {
    const PetscReal J = points->real[POINT_J][q], volume = points->real[POINT_VOLUME][q];
    PetscReal tau[6];
    point_tau(points, q, tau);
    for (PetscInt k = 0; k < m->dim; ++k) {
      const PetscReal off = tau[k] / J + p;
      local[0] += volume;
      local[1] += volume * off;
      local[2] += volume * off * off;
      worst = PetscMax(worst, PetscAbsReal(off));
    }
    worst = PetscMax(worst, PetscAbsReal(tau[3] / J));
  }
  CALL(MPI_Allreduce(local, sum, 3, MPIU_REAL, MPIU_SUM, m->comm));
  return (Pressed){sum[1] / sum[0] / p, PetscSqrtReal(sum[2] / sum[0]) / p, model_max(m, worst) / p};
}

/* A body between planes of symmetry, cut at 17 degrees, pressed on all of its surface: what is plane gives the same
 * stress everywhere, where one point integrates a part's shape functions, to round-off. */
static void wedge(CellType cell, PetscBool cornered, PetscReal tolerance)
{
  const PetscReal p = 1e3, c = cos(17 * PETSC_PI / 180), s = sin(17 * PETSC_PI / 180);
  Bench b;
  Shape part[2] = {{.kind = SHAPE_BOX, .min = {0, 0, 0}, .max = {0.93, 0.86, 0.93}},
                   {.kind = SHAPE_HALF_SPACE, .point = {0.75, 0, 0.1}, .normal = {c, s, 0}}};
  bench_init(&b, "mpm", cell, 0);
  const PetscInt dim = b.c.kinematics->dim;
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1.2, 1.2, 1.2}, dim == 3 ? 0.3 : 0.15);
  b.body[0].shape = cornered ? (Shape){.kind = SHAPE_INTERSECTION, .n_children = 2, .children = part} : part[1];
  b.c.stabilisation.stiffness = 0; /* springs on nodes that next to nothing holds */
  for (int d = 0; d < dim; ++d) bench_motion(&b, d, 0, MOTION_FIXED, 1u << d);
  on_body(&b, LOAD_PRESSURE, p, 0, 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, 1);
  const Pressed off = pressed(m, p);
  PetscPrintf(PETSC_COMM_WORLD, "wedge cell %d%s: mean off %.2g, rms %.2g, worst %.2g\n", (int)cell,
              cornered ? ", with corners" : "", (double)off.mean, (double)off.off, (double)off.worst);
  CHECK(off.off < tolerance, "%g", (double)off.off);
  CALL(ModelDestroy(&m));
}

static void test_wedge(void **state)
{
  (void)state;
  wedge(CELL_QUADRILATERAL, PETSC_FALSE, 1e-8);
  wedge(CELL_TRIANGLE, PETSC_FALSE, 1e-8);
  wedge(CELL_TETRAHEDRON, PETSC_FALSE, 1e-6);
  wedge(CELL_HEXAHEDRON, PETSC_FALSE, 2e-3);
  wedge(CELL_QUADRILATERAL, PETSC_TRUE, 1e-4); /* corners of parts are cut off within 1/32 of a cell */
}

/* A ball anywhere in the grid, held so that it cannot run away, under p from all sides. */
static void ball(const Kinematics *kinematics, PetscReal h, PetscReal mean, PetscReal rms)
{
  const PetscReal p = 1e3;
  const PetscInt dim = kinematics->dim;
  Bench b;
  bench_init(&b, "mpm", dim == 3 ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, 0);
  b.c.kinematics = kinematics;
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1.2, 1.2, 1.2}, h);
  b.body[0].shape = (Shape){.kind = SHAPE_BALL, .centre = {0.61, 0.58, 0.6}, .radius = 0.5};
  if (kinematics->hoop) b.body[0].shape.centre[0] = 0;
  on_body(&b, LOAD_PRESSURE, p, 0, 0);
  for (int d = kinematics->hoop; d < dim; ++d) { /* two nodes, three in space */
    MotionSpec *pin = bench_motion(&b, 0, 0.6, MOTION_FIXED, 1u << d);
    for (int e = 0; e < dim; ++e) {
      pin->on.has[e] = PETSC_TRUE;
      pin->on.min[e] = pin->on.max[e] = kinematics->hoop && !e ? 0 : 0.6;
    }
  }
  if (!kinematics->hoop)
    for (int d = 0; d < (dim == 2 ? 1 : 3); ++d) { /* and none of them turns */
      const int along = (d + 1) % dim;
      MotionSpec *pin = bench_motion(&b, d, 0.6, MOTION_FIXED, 1u << d);
      for (int e = 0; e < dim; ++e) {
        pin->on.has[e] = PETSC_TRUE;
        pin->on.min[e] = pin->on.max[e] = e == along ? 0.6 + h * round(0.24 / h) : 0.6;
      }
    }
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, 1);
  const Pressed off = pressed(m, p);
  PetscPrintf(PETSC_COMM_WORLD, "ball %s h %g: mean off %.2g, rms %.2g, worst %.2g\n", kinematics->name, (double)h,
              (double)off.mean, (double)off.off, (double)off.worst);
  CHECK(PetscAbsReal(off.mean) < mean, "%g", (double)off.mean);
  CHECK(off.off < rms, "%g", (double)off.off);
  CALL(ModelDestroy(&m));
}

static void test_ball(void **state)
{
  (void)state;
  const PetscReal plane[2] = {5e-3, 2e-4}, ring[2] = {0.02, 6e-3};
  for (int k = 0; k < 2; ++k) { /* 0.03: 1e-5 and 1e-3 */
    ball(&kinematics_plane_strain, 0.12 / (1 << k), 1e-5, plane[k]);
    ball(&kinematics_axisymmetric, 0.12 / (1 << k), 5e-4 / (1 << k), ring[k]);
  }
  ball(&kinematics_3d, 0.2, 5e-4, 0.1); /* points in slivers are off by more than their pressure */
}

/* The body becomes a mesh of its own of the same box, of which no line is a line of the grid. */
static void bring_mesh(Bench *b, CellType cell)
{
  const GridSpec box = b->c.grid;
  const Shape *shape = &b->body[0].shape;
  bench_grid(b, shape->min, shape->max, 0.2);
  b->c.grid.cell = cell;
  bench_distort(b, 0, 0, NULL);
  b->c.grid = box;
  b->body[0].mesh = b->mesh;
  b->body[0].points_per_cell = 1;
  b->body[0].has_shape = PETSC_FALSE;
}

/* Pieces within the ranges or the shape of a selector count, and nothing where it takes no part of the surface. */
static void selected(const CellType *own)
{
  Bench b;
  bench_init(&b, "mpm", CELL_HEXAHEDRON, 8);
  bench_box(&b, 0, (PetscReal[]){0.13, 0.2, 0.31}, (PetscReal[]){0.77, 0.92, 0.9});
  if (own) bring_mesh(&b, *own);
  bench_dynamic(&b, 1, 0.01);
  LoadSpec *load = on_body(&b, LOAD_TRACTION, 0, -1, 0);
  load->on.has[0] = load->on.has[1] = PETSC_TRUE;
  load->on.min[0] = 0.2, load->on.max[0] = 0.51;
  load->on.min[1] = load->on.max[1] = 0.92;
  load = on_body(&b, LOAD_PRESSURE, 1, 0, 0);
  load->on.has_shape = PETSC_TRUE;
  load->on.shape = (Shape){.kind = SHAPE_BALL, .centre = {0.45, 0.92, 0.6}, .radius = 0.25};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const Acting strip = acting(m, 0), patch = acting(m, 1);
  CHECK_CLOSE(strip.force[1], -0.31 * 0.59, 1e-8);
  CHECK_CLOSE(strip.turn[2], -0.31 * 0.59 * 0.355, 1e-8);
  CHECK_CLOSE(patch.force[1], -PETSC_PI * 0.0625, 1e-4);
  CHECK_CLOSE(patch.turn[2], -PETSC_PI * 0.0625 * 0.45, 1e-4);
  CALL(ModelDestroy(&m));
  b.load[0].on.min[1] = b.load[0].on.max[1] = 1; /* where the last cells end */
  bench_refused(&b, PETSC_COMM_WORLD, "loads.tractions[0].on", "selects no face of the body's boundary");
  bench_end(&b);
}

static void test_selected(void **state)
{
  static const CellType own[] = {CELL_HEXAHEDRON, CELL_TETRAHEDRON};
  (void)state;
  selected(NULL);
  EACH_OF (k, own) selected(own + k);
}

/* A ring that is blown up at once, and turns: the same on all ranks as on one; pieces that turn and stretch on their
 * own keep the surface closed as well as the cells follow it. */
static void test_blown(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2.4, 2.4, 1}, 0.15);
  Shape circles[2] = {{.kind = SHAPE_BALL, .centre = {1.21, 1.18}, .radius = 0.8},
                      {.kind = SHAPE_BALL, .centre = {1.21, 1.18}, .radius = 0.4}};
  b.body[0].shape = (Shape){.kind = SHAPE_DIFFERENCE, .n_children = 2, .children = circles};
  b.body[0].spin[2] = 4;
  b.body[0].spin_centre[0] = 1.21, b.body[0].spin_centre[1] = 1.18;
  b.c.basis.kind = "gimp";
  bench_dynamic(&b, 1, 4e-3);
  LoadSpec *load = on_body(&b, LOAD_PRESSURE, 2e4, 0, 0);
  load->on.has_shape = PETSC_TRUE;
  load->on.shape = (Shape){.kind = SHAPE_BALL, .centre = {1.21, 1.18}, .radius = 0.6};
  Model *m = bench_model(&b, PETSC_COMM_WORLD), *serial = bench_model(&b, PETSC_COMM_SELF);
  for (int k = 0; k < 8; ++k) model_step(m, PETSC_MAX_REAL), model_step(serial, PETSC_MAX_REAL);
  const PetscReal apart = points_difference(m, serial, POINT_X),
                  momentum = hypot(model_sum(m, "momentum", 0), model_sum(m, "momentum", 1));
  CHECK(apart < 1e-10, "%g m apart", (double)apart);
  CHECK(momentum < 1e-3 * 2e4 * PETSC_PI * 0.8 * 0.032, "momentum %g kg m/s", (double)momentum); /* of the push */
  CALL(ModelDestroy(&m));
  CALL(ModelDestroy(&serial));
}

/* What lies on the axis of rings is no surface, however it is picked: carriers there would divide by their radius. */
static void test_axis(void **state)
{
  static const PetscReal size[] = {0.125, 1. / 16, 1. / 32, 0.04};
  (void)state;
  for (size_t k = 0; k < sizeof size / sizeof *size; ++k) {
    Bench b;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
    b.c.kinematics = &kinematics_axisymmetric;
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0}, size[k]);
    bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){0.52, 0.48, 0});
    b.c.basis.kind = "gimp";
    bench_dynamic(&b, 1, 1e-3);
    LoadSpec *load = on_body(&b, LOAD_PRESSURE, 1e3, 0, 0);
    load->on.has_shape = PETSC_TRUE;
    load->on.shape = (Shape){.kind = SHAPE_BOX, .min = {-1, 0.4, 0}, .max = {2, 2, 0}};
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    const Acting a = acting(m, 0);
    PetscReal nearest = 1, all;
    for (PetscInt i = 0; i < m->loads->carriers->n; ++i)
      nearest = PetscMin(nearest, point_real(m->loads->carriers, POINT_X, i)[0]);
    CALL(MPI_Allreduce(&nearest, &all, 1, MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD));
    CHECK(all > 0.1 * size[k], "a carrier at a radius of %g m", (double)all);
    CHECK_CLOSE(a.force[1], -1e3 * PETSC_PI * 0.52 * 0.52, 1e-6);
    model_step(m, PETSC_MAX_REAL);
    CHECK_CLOSE(model_sum(m, "momentum", 1), a.force[1] * 1e-3, 1e-4); /* it follows the surface */
    CALL(ModelDestroy(&m));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_closed), cmocka_unit_test(test_selected), cmocka_unit_test(test_wedge),
    cmocka_unit_test(test_ball),   cmocka_unit_test(test_blown),    cmocka_unit_test(test_axis),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
