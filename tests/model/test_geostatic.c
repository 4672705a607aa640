/* k0: the vertical stress at the start is that of the material really above, along gravity,
 * whatever the surface, the layers and the ranks. */
#include "case_builder.h"

/* Grid of the unit square or cube (or what `max` says) with cells of h; gravity acts from the
 * start, in dynamics, so that nothing has moved. */
static void ground(Bench *b, const char *method, CellType cell, PetscReal h, const PetscReal max[3])
{
  bench_init(b, method, cell, 0);
  bench_grid(b, (PetscReal[]){0, 0, 0}, max, h);
  bench_dynamic(b, 1, 1e-6);
  if (!strcmp(method, "gmm"))
    b->c.basis = (BasisSpec){.kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
  b->c.gravity[1] = -10;
  b->body[0].has_k0 = PETSC_TRUE;
  b->body[0].k0 = 0.5;
}

static void add_body(Bench *b, MaterialSpec material[2], PetscReal density, Shape shape, PetscBool k0)
{
  material[0] = b->material;
  material[1] = b->material;
  material[1].name = "other";
  material[1].density = density;
  b->c.materials = material;
  b->c.n_materials = 2;
  b->body[1] = b->body[0];
  b->body[1].name = "upper";
  b->body[1].material = "other";
  b->body[1].shape = shape;
  b->body[1].has_k0 = k0;
  b->c.n_bodies = 2;
}

/* sigma = -above g in the direction of gravity, half of that across. */
static void check_stress(const Model *m, PetscInt p, const PetscReal up[3], PetscReal vertical)
{
  PetscReal sigma[6], full[3][3], along = 0;
  CALL(ModelPointStress(m, p, sigma));
  for (int k = 0; k < 6; ++k) {
    full[voigt_row[k]][voigt_column[k]] = sigma[k];
    full[voigt_column[k]][voigt_row[k]] = sigma[k];
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) along += up[i] * full[i][j] * up[j];
  CHECK_CLOSE(along, vertical, 1e-6 + 1e-9 * PetscAbsReal(vertical));
  CHECK_CLOSE(full[0][0] + full[1][1] + full[2][2], 2 * vertical, 1e-6 + 1e-9 * PetscAbsReal(vertical));
}

typedef PetscReal (*Above)(const PetscReal *x, PetscInt body); /* kg/m2 */

static void check_all(Bench *b, const PetscReal up[3], PetscReal g, Above above)
{
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    if (!b->body[m->points->body[p]].has_k0) continue;
    check_stress(m, p, up, -g * above(point_real(m->points, POINT_X, p), m->points->body[p]));
  }
  CALL(ModelDestroy(&m));
}

static const PetscReal y_up[3] = {0, 1, 0};

/* --- shapes of the surface, 2D --- */
static PetscReal below_step(const PetscReal *x, PetscInt body)
{
  (void)body;
  return 1000 * ((x[0] < 1 ? 1 : 0.5) - x[1]);
}

static PetscReal below_incline(const PetscReal *x, PetscInt body)
{
  (void)body;
  return 1000 * (0.5 + x[0] / 2 - x[1]);
}

static PetscReal below_layer(const PetscReal *x, PetscInt body)
{
  return body ? 2500 * (1 - x[1]) : 1250 + 1000 * (0.5 - x[1]);
}

/* 1 m and half a metre high, side by side: nobody carries what is not there. */
static void test_step(void **state)
{
  static const char *const method[] = {"mpm", "fem", "gmm"};
  static Shape parts[2] = {{.kind = SHAPE_BOX, .max = {1, 1}}, {.kind = SHAPE_BOX, .min = {1, 0}, .max = {2, 0.5}}};
  (void)state;
  for (int k = 0; k < 3; ++k)
    for (int fine = 0; fine < 2; ++fine)
      for (CellType cell = CELL_TRIANGLE; cell <= CELL_QUADRILATERAL; ++cell) {
        Bench b;
        ground(&b, method[k], cell, fine ? 0.0625 : 0.25, (PetscReal[]){2, 1.5, 0});
        b.body[0].shape = (Shape){.kind = SHAPE_UNION, .n_children = 2, .children = parts};
        check_all(&b, y_up, 10, below_step);
      }
}

/* Triangles of 2 : 1 whose diagonals are the surface. */
static void test_incline(void **state)
{
  static PetscReal corners[] = {0, 0, 2, 0, 2, 1.5, 0, 0.5};
  (void)state;
  for (int n = 4; n <= 32; n *= 8) {
    Bench b;
    ground(&b, "mpm", CELL_TRIANGLE, 1, (PetscReal[]){2, 1.5, 0});
    b.c.grid.counts[0] = n;
    b.c.grid.counts[1] = 3 * n / 2;
    b.body[0].shape = (Shape){.kind = SHAPE_POLYGON, .n_vertices = 4, .vertices = corners};
    check_all(&b, y_up, 10, below_incline);
  }
}

static PetscReal below_cut(const PetscReal *x, PetscInt body)
{
  const PetscReal surface = 0.41 + 0.48 * x[0], cover = 1.31;
  return body ? 2500 * (cover - x[1]) : 2500 * (cover - surface) + 1000 * (surface - x[1]);
}

/* A surface that cuts cells, and another body that begins in the same cells and ends within
 * others. */
static void test_cut(void **state)
{
  static PetscReal below[] = {0, 0, 1.875, 0, 1.875, 1.31, 0, 0.41}, above[] = {0, 0.41, 1.875, 1.31, 0, 1.31};
  MaterialSpec material[2];
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_QUADRILATERAL; ++cell) {
    Bench b;
    ground(&b, "mpm", cell, 0.125, (PetscReal[]){2, 1.5, 0});
    b.body[0].shape = (Shape){.kind = SHAPE_POLYGON, .n_vertices = 4, .vertices = below};
    add_body(&b, material, 2500, (Shape){.kind = SHAPE_POLYGON, .n_vertices = 3, .vertices = above}, PETSC_TRUE);
    check_all(&b, y_up, 10, below_cut);
  }
}

/* Two densities on each other; the upper body counts with and without a stress of its own. */
static void test_layers(void **state)
{
  MaterialSpec material[2];
  (void)state;
  for (int own = 0; own < 2; ++own)
    for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell) {
      Bench b;
      ground(&b, "mpm", cell, 0.125, (PetscReal[]){1, 1, 1});
      bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 0.5, 1});
      add_body(&b, material, 2500, (Shape){.kind = SHAPE_BOX, .min = {0, 0.5, 0}, .max = {1, 1, 1}}, own);
      check_all(&b, y_up, 10, below_layer);
    }
}

/* --- space between bodies --- */
static PetscReal below_nothing(const PetscReal *x, PetscInt body)
{
  return body ? 2500 * (1 - x[1]) : 1000 * (0.5 - x[1]);
}
static PetscReal around_tunnel(const PetscReal *x, PetscInt body)
{
  (void)body;
  return 1000 * (1 - x[1] - (x[0] > 0.25 && x[0] < 0.75 && x[1] < 0.25 ? 0.5 : 0));
}

/* A block that is still in the air does not press on the ground; the roof of a tunnel does. */
static void test_gaps(void **state)
{
  MaterialSpec material[2];
  static Shape tunnel[2] = {{.kind = SHAPE_BOX, .max = {1, 1}},
                            {.kind = SHAPE_BOX, .min = {0.25, 0.25}, .max = {0.75, 0.75}}};
  Bench b;
  (void)state;
  ground(&b, "mpm", CELL_QUADRILATERAL, 0.125, (PetscReal[]){1, 1, 0});
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 0.5, 1});
  add_body(&b, material, 2500, (Shape){.kind = SHAPE_BOX, .min = {0, 0.625, 0}, .max = {1, 1, 1}}, PETSC_TRUE);
  check_all(&b, y_up, 10, below_nothing);
  ground(&b, "mpm", CELL_QUADRILATERAL, 0.0625, (PetscReal[]){1, 1, 0});
  b.body[0].shape = (Shape){.kind = SHAPE_DIFFERENCE, .n_children = 2, .children = tunnel};
  check_all(&b, y_up, 10, around_tunnel);
}

/* --- gravity in any direction --- */
static PetscReal oblique[3]; /* up */

/* Way to the side of the unit square or cube by which a line along `oblique` leaves it. */
static PetscReal below_oblique(const PetscReal *x, PetscInt body)
{
  PetscReal way = PETSC_MAX_REAL;
  (void)body;
  for (int d = 0; d < 3; ++d) {
    if (oblique[d] > 0) way = PetscMin(way, (1 - x[d]) / oblique[d]);
    if (oblique[d] < 0) way = PetscMin(way, -x[d] / oblique[d]);
  }
  return 1000 * way;
}

static void test_oblique(void **state)
{
  static const PetscReal up[][3] = {{0.6, 0.8, 0}, {-1, 0, 0}, {0, 0, 1}, {-2. / 3, 1. / 3, 2. / 3}};
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell)
    for (int k = 0; k < 4; ++k) {
      Bench b;
      if (cell < CELL_TETRAHEDRON && k > 1) continue;
      ground(&b, "mpm", cell, 0.25, (PetscReal[]){1, 1, 1});
      for (int d = 0; d < 3; ++d) {
        oblique[d] = up[k][d];
        b.c.gravity[d] = -10 * up[k][d];
      }
      check_all(&b, up[k], 10, below_oblique);
    }
}

/* Half of gravity at the start is half of the stress. */
static PetscReal below_unit(const PetscReal *x, PetscInt body)
{
  (void)body;
  return 1000 * (1 - x[1]);
}

static void test_gravity_at_the_start(void **state)
{
  PetscReal time[2] = {0, 1}, value[2] = {0.5, 1};
  Bench b;
  (void)state;
  ground(&b, "fem", CELL_QUADRILATERAL, 0.25, (PetscReal[]){1, 1, 0});
  b.c.gravity_amplitude = (Amplitude){.n = 2, .time = time, .value = value};
  check_all(&b, y_up, 5, below_unit);
  value[0] = 0;
  bench_refused(&b, PETSC_COMM_WORLD, "loads.gravity_amplitude", "gravity is 0 at the start");
  b.c.gravity[1] = 0;
  bench_refused(&b, PETSC_COMM_WORLD, "bodies[0].k0", "there is no gravity");
}

/* --- what carries it --- */
/* A slope of 30 m x 20 m whose toe is 10 m high: the floor carries its weight from the start. The
 * free nodes' forces, which are all that the stress of columns leaves over, are those of shear:
 * none of them is vertical. */
static void slope(const char *method, CellType cell, PetscReal h, PetscReal tolerance)
{
  static PetscReal corners[] = {0, 0, 30, 0, 30, 10, 20, 10, 10, 20, 0, 20};
  PetscReal value;
  Bench b;
  ground(&b, method, cell, h, (PetscReal[]){30, 22, 0});
  b.constants[0].value = 1e8;
  b.material.density = 2000;
  b.body[0].shape = (Shape){.kind = SHAPE_POLYGON, .n_vertices = 6, .vertices = corners};
  b.body[0].fill =
    FILL_CELLS; /* one point of a part that is cut integrates N's products with the stress to first order */
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  for (int side = 0; side < 2; ++side) bench_motion(&b, 0, 30 * side, MOTION_FIXED, 1);
  b.measure[b.c.n_measures++] = (MeasureSpec){.name = "floor", .kind = "reaction", .component = 1, .boundary = 0};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscReal weight = 10 * model_sum(m, "mass: total", 0);
  model_step(m, 1e-6);
  CALL(ModelMeasure(m, &b.measure[0], 0, &value));
  PetscPrintf(PETSC_COMM_WORLD, "%s, cell %d, h = %g m: the floor carries the weight to %.1e\n", method, (int)cell,
              (double)h, (double)(value / weight - 1));
  CHECK(PetscAbsReal(value / weight - 1) < tolerance, "%s, cell %d, h = %g: %g N of %g N", method, (int)cell, (double)h,
        (double)value, (double)weight);
  CALL(ModelDestroy(&m));
}

static void test_slope(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_QUADRILATERAL; ++cell)
    for (PetscReal h = 0.5; h <= 2; h *= 4) {
      slope("mpm", cell, h, 1e-11);
      slope("fem", cell, h, 1e-11);
      slope("gmm", cell, h, 1e-3); /* whose shape functions do not end with the cells */
    }
}

/* --- beside walls --- */
typedef struct {
  const char *method, *basis;
  const Kinematics *kinematics;
  AnalysisType type;
  PetscBool floor; /* is it a wall that bears the weight, too? */
} Walled;

/* What is given is in balance: walls bear what the boundary would, and nothing moves. */
static void stand_between(const Walled *r)
{
  Bench b;
  WallSpec walls[2] = {{.name = (char *)"side", .shape = {.kind = SHAPE_HALF_SPACE, .point = {1}, .normal = {-1}}},
                       {.name = (char *)"floor",
                        .shape = {.kind = SHAPE_HALF_SPACE, .normal = {0, 1}},
                        .contact = CONTACT_FRICTION,
                        .friction = 0.5}};
  const PetscReal round = r->kinematics->hoop ? 2 * PETSC_PI : 1;
  PetscReal moved = 0, start[1] = {0}, whole[1] = {1};
  ground(&b, r->method, CELL_QUADRILATERAL, 0.25, (PetscReal[]){1.5, 1.5, 0});
  b.c.kinematics = r->kinematics;
  b.c.analysis.type = r->type;
  b.c.analysis.step = b.c.analysis.largest = r->type == ANALYSIS_STATIC ? 1 : 5e-3;
  b.c.gravity_amplitude = (Amplitude){.n = 1, .time = start, .value = whole};
  b.c.basis.kind = r->basis;
  b.constants[0].value = 1e5; /* it is shorter by a tenth than without its weight */
  b.body[0].shape = (Shape){.kind = SHAPE_BOX, .max = {1, 1, 0}};
  if (!strcmp(r->method, "mpm")) b.c.grid.min[1] = -0.5, b.c.grid.counts[1] += 2;
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  if (!r->floor) bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  b.c.n_walls = r->floor ? 2 : 1;
  b.c.walls = walls;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscReal weight = 10 * model_sum(m, "mass: total", 0), thrust = -round * 2500;
  for (int k = 0; k < 3 && m->time < 1; ++k) model_step(m, 1);
  const PetscReal side = model_wall(m, "side", "wall_force", NULL, 0),
                  floor = r->floor ? model_wall(m, "floor", "wall_force", NULL, 1) : weight;
  for (PetscInt k = 0; k < m->points->n * 2; ++k) moved = PetscMax(moved, PetscAbsReal(m->points->real[POINT_U][k]));
  moved = model_max(m, moved);
  PetscPrintf(PETSC_COMM_WORLD, "%s %s %s %d: thrust %.9g of %.9g N, floor %.9g of %.9g, moved %.2g m\n", r->method,
              r->basis, r->kinematics->name, (int)r->type, (double)side, (double)thrust, (double)floor, (double)weight,
              (double)moved);
  CHECK_CLOSE(side, thrust, -1e-6 * thrust);
  CHECK_CLOSE(floor, weight, 1e-6 * weight);
  CHECK(moved < 1e-9, "moved by %g m", (double)moved);
  CALL(ModelDestroy(&m));
}

static void test_walls(void **state)
{
  const Kinematics *plane = &kinematics_plane_strain, *ring = &kinematics_axisymmetric;
  const Walled cases[] = {
    {"fem", "cell", plane, ANALYSIS_STATIC, PETSC_FALSE},  {"mpm", "gimp", plane, ANALYSIS_STATIC, PETSC_FALSE},
    {"fem", "cell", plane, ANALYSIS_STATIC, PETSC_TRUE},   {"mpm", "cell", plane, ANALYSIS_STATIC, PETSC_TRUE},
    {"mpm", "gimp", plane, ANALYSIS_DYNAMIC, PETSC_TRUE},  {"fem", "cell", plane, ANALYSIS_DYNAMIC, PETSC_TRUE},
    {"mpm", "cell", plane, ANALYSIS_DYNAMIC, PETSC_FALSE}, {"fem", "cell", ring, ANALYSIS_STATIC, PETSC_FALSE},
    {"mpm", "cell", ring, ANALYSIS_STATIC, PETSC_TRUE},
  };
  (void)state;
  EACH_OF (k, cases) stand_between(&cases[k]);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_step),
    cmocka_unit_test(test_incline),
    cmocka_unit_test(test_cut),
    cmocka_unit_test(test_layers),
    cmocka_unit_test(test_gaps),
    cmocka_unit_test(test_oblique),
    cmocka_unit_test(test_gravity_at_the_start),
    cmocka_unit_test(test_slope),
    cmocka_unit_test(test_walls),
  };
  return run_model_tests(argc, argv, tests);
}
