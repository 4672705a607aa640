/* What a wall does to a surface: a block of no lateral contraction presses on its floor with its weight over its
 * area, everywhere alike; turned, it adds the shear; whatever its cells and points. And when walls stand: steps end
 * where one vanishes. */
#include "case_builder.h"

typedef struct {
  const char *method, *basis;
  CellType cell;
  const Kinematics *kinematics;
  PetscInt points;
  PetscReal off; /* by so much it stands beside the grid's lines, m */
} Block;

#define PRESSURE (1000 * 9.81 * 0.5)

/* A stiff block of 1 x 0.5 (x 0.5) m, of cells of 0.25 x 0.125 (x 0.25) m. */
static void standing(Bench *b, const Block *r, WallSpec *wall)
{
  const PetscInt up = r->kinematics->dim - 1;
  bench_init(b, r->method, r->cell, 0);
  b->c.kinematics = r->kinematics;
  bench_grid(b, (PetscReal[]){0.125, up == 2 ? 0 : 0.3125, 0.3125}, (PetscReal[]){2.125, up == 2 ? 1 : 1.3125, 1.3125},
             0.25);
  b->c.grid.counts[up] *= 2;
  bench_box(b, 0, (PetscReal[]){0.625 + r->off, up == 2 ? 0.25 : 0.4375 + r->off, 0.4375 + r->off},
            (PetscReal[]){1.625 + r->off, up == 2 ? 0.75 : 0.9375 + r->off, 0.9375 + r->off});
  b->body[0].points_per_cell = r->points;
  b->constants[0].value = 1e8;
  b->constants[1].value = 0;
  b->c.basis = (BasisSpec){
    .kind = r->basis, .gamma = 1.8, .effective_radius = 1, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
  b->c.newton = (NewtonSpec){.residual = 1e-10, .increment = 1e-10, .max_iterations = 25, .ease = 6};
  b->c.gravity[up] = -9.81;
  *wall = (WallSpec){
    .name = (char *)"floor", .shape = {.kind = SHAPE_HALF_SPACE}, .contact = CONTACT_FRICTION, .friction = 0.8};
  wall->shape.point[up] = 0.4375 + r->off;
  wall->shape.normal[up] = 1;
  b->c.n_walls = 1;
  b->c.walls = wall;
}

static MeasureSpec *add_measure(Bench *b, const char *word, PetscReal x_max)
{
  MeasureSpec *s = &b->measure[b->c.n_measures++];
  *s = (MeasureSpec){.name = (char *)word, .kind = (char *)"contact", .word = (char *)word, .wall = (char *)"floor"};
  s->has_in = x_max > 0;
  s->in = (Shape){.kind = SHAPE_BOX, .min = {0, 0, 0}, .max = {x_max, 1, 1}};
  return s;
}

static PetscReal number(Model *m, PetscInt k)
{
  PetscReal value;
  CALL(ModelMeasure(m, &m->c->measures[k], k, &value));
  return value;
}

static void press(const Block *r)
{
  Bench b;
  WallSpec wall;
  standing(&b, r, &wall);
  add_measure(&b, "pressure", 0);
  add_measure(&b, "pressure", 1.125 + r->off);
  add_measure(&b, "peak_pressure", 0);
  add_measure(&b, "shear", 0);
  add_measure(&b, "area", 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CHECK(number(m, 0) == 0, "it presses before the first step");
  while (m->time < 1 - 1e-9) model_step(m, 0.5);
  const PetscReal inner = 0.625 + r->off, outer = 1.625 + r->off;
  const PetscReal area = r->kinematics->hoop ? PETSC_PI * (outer * outer - inner * inner) : m->dim == 3 ? 0.5 : 1;
  PetscPrintf(PETSC_COMM_WORLD,
              "%s %s %s cell %d, %d points: %.9g, half %.9g, peak %.9g of %g Pa, shear %.3g, area %g\n", r->method,
              r->basis, r->kinematics->name, (int)r->cell, (int)r->points, (double)number(m, 0), (double)number(m, 1),
              (double)number(m, 2), PRESSURE, (double)number(m, 3), (double)number(m, 4));
  /* beside the lines a point at an edge may hang, and that of a triangle that stands on a corner counts for little, not
   * for nothing; a single one has the force of its nodes' whole surroundings */
  const PetscReal off = r->off == 0 && r->cell != CELL_TRIANGLE ? 1e-4 : 0.02;
  for (PetscInt k = 0; k < 3; ++k)
    CHECK(PetscAbsReal(number(m, k) - PRESSURE) < (k == 2 && off > 1e-3 ? 4 : 1) * off * PRESSURE, "%d: %g Pa", (int)k,
          (double)number(m, k));
  CHECK(number(m, 3) < (off > 1e-3 ? 1e-3 : 1e-4) * PRESSURE, "shear %g Pa", (double)number(m, 3));
  CHECK(PetscAbsReal(number(m, 4) - area) < off * area, "area %g, not %g", (double)number(m, 4), (double)area);
  CALL(ModelDestroy(&m));
}

static void test_presses(void **state)
{
  const Kinematics *plane = &kinematics_plane_strain, *space = &kinematics_3d, *ring = &kinematics_axisymmetric;
  const Block blocks[] = {
    {"mpm", "cell", CELL_QUADRILATERAL, plane, 4, 0},     {"mpm", "gimp", CELL_QUADRILATERAL, plane, 4, 0},
    {"mpm", "cell", CELL_QUADRILATERAL, ring, 4, 0},      {"mpm", "cell", CELL_HEXAHEDRON, space, 8, 0},
    {"fem", "cell", CELL_QUADRILATERAL, plane, 4, 0},     {"mpm", "cell", CELL_QUADRILATERAL, plane, 4, 0.03},
    {"mpm", "gimp", CELL_QUADRILATERAL, plane, 9, 0.053}, {"mpm", "gimp", CELL_QUADRILATERAL, ring, 4, 0.118},
    {"mpm", "gimp", CELL_HEXAHEDRON, space, 8, 0.045},    {"gmm", "mls", CELL_TRIANGLE, plane, 3, 0},
  };
  (void)state;
  EACH_OF (k, blocks) press(&blocks[k]);
}

/* What tractions of single points add up to over their surfaces, as files of contact have them. */
static PetscReal sum_of_tractions(const Model *m, PetscInt d)
{
  PetscReal local = 0, sum;
  PetscInt n;
  ContactTraction *t;
  CALL(ModelTractions(m, 0, &n, &t));
  for (PetscInt k = 0; k < n; ++k) local += (t[k].pressure * t[k].normal[d] + t[k].shear[d]) * t[k].section;
  CALL(PetscFree(t));
  CALL(MPI_Allreduce(&local, &sum, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  return sum;
}

/* Tractions times the surface are the force, in the mean and one by one; also where nodes follow others, with functions
 * that dip below zero. */
static void shear(const Block *block)
{
  Bench b;
  WallSpec wall;
  PetscReal force[2];
  standing(&b, block, &wall);
  b.c.stabilisation.follow = 0.3;
  b.c.gravity[0] = 3;
  add_measure(&b, "pressure", 0);
  add_measure(&b, "shear", 0);
  add_measure(&b, "area", 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, 0.5);
  for (PetscInt d = 0; d < 2; ++d) {
    const MeasureSpec s = {.kind = (char *)"wall_force", .component = d, .wall = (char *)"floor"};
    CALL(ModelMeasure(m, &s, 0, &force[d]));
    CHECK_CLOSE(sum_of_tractions(m, d), force[d], 1e-9 * PRESSURE);
  }
  CHECK_CLOSE(number(m, 0) * number(m, 2), force[1], 1e-9 * force[1]);
  CHECK_CLOSE(number(m, 1) * number(m, 2), -force[0], 1e-9 * force[1]);
  CHECK_CLOSE(force[0], -3 * 500, 1e-6 * force[1]);
  CALL(ModelDestroy(&m));
}

static void test_shears(void **state)
{
  const Block blocks[] = {{"mpm", "cell", CELL_QUADRILATERAL, &kinematics_plane_strain, 4, 0},
                          {"mpm", "gimp", CELL_QUADRILATERAL, &kinematics_plane_strain, 4, 0.03}};
  (void)state;
  EACH_OF (k, blocks) shear(&blocks[k]);
}

/* A body so stiff that the gap that a step may leave would lift it off: the next step finds its floor again. */
static void test_stiff(void **state)
{
  const Block block = {"mpm", "cell", CELL_QUADRILATERAL, &kinematics_plane_strain, 4, 0};
  Bench b;
  WallSpec wall;
  (void)state;
  standing(&b, &block, &wall);
  b.constants[0].value = 1e10;
  add_measure(&b, "pressure", 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, 0.5);
  CHECK(m->step == 2, "%d steps", (int)m->step);
  CHECK_CLOSE(number(m, 0), PRESSURE, 1e-6 * PRESSURE);
  CALL(ModelDestroy(&m));
}

/* The floor of a block vanishes between two steps: one ends just then, and from then on the block falls. */
static void test_gate(void **state)
{
  const Block block = {"mpm", "cell", CELL_QUADRILATERAL, &kinematics_plane_strain, 4, 0};
  const PetscReal until = 0.0137;
  PetscReal last = 0, at_until = NAN;
  Bench b;
  WallSpec wall;
  (void)state;
  standing(&b, &block, &wall);
  b.constants[0].value = 1e6;
  bench_dynamic(&b, 1, 5e-3);
  wall.has_until = PETSC_TRUE;
  wall.until = until;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (int k = 0; k < 8; ++k) {
    model_step(m, PETSC_MAX_REAL);
    CHECK(m->time - last < 5e-3 * (1 + 1e-9) && m->time - last > 1e-3, "a step of %g s", (double)(m->time - last));
    last = m->time;
    if (PetscAbsReal(m->time - until) < 1e-12) at_until = model_sum(m, "momentum", 1);
    if (m->time > until + 1e-12)
      CHECK_CLOSE(model_sum(m, "momentum", 1), at_until - 500 * 9.81 * (m->time - until), 1e-8 * 500 * 9.81);
  }
  CHECK(at_until == at_until, "no step ends at %g s", (double)until);
  CALL(ModelDestroy(&m));
}

/* A wall appears under a block that falls on it in the step after: it does not fall through. */
static void test_appears(void **state)
{
  const Block block = {"mpm", "cell", CELL_QUADRILATERAL, &kinematics_plane_strain, 4, 0};
  const PetscReal from = 0.0171;
  const MeasureSpec depth = {.kind = (char *)"contact", .word = (char *)"penetration", .wall = (char *)"floor"};
  PetscReal at_from = NAN, deep;
  Bench b;
  WallSpec wall;
  (void)state;
  standing(&b, &block, &wall);
  bench_dynamic(&b, 1, 5e-3);
  wall.from = from;
  wall.shape.point[1] -= 0.5 * 9.81 * from * from + 1e-4; /* 0.17 m/s: hit within the step */
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 0.03) {
    model_step(m, PETSC_MAX_REAL);
    CALL(ModelMeasure(m, &depth, 0, &deep));
    CHECK(deep < 1e-4 * 0.25, "%g m deep at %g s", (double)deep, (double)m->time);
    if (PetscAbsReal(m->time - from) < 1e-12) at_from = model_sum(m, "momentum", 1);
  }
  CHECK_CLOSE(at_from, -500 * 9.81 * from, 1e-8 * 500);
  CHECK(model_sum(m, "momentum", 1) > 0.5 * at_from, "it fell through");
  CALL(ModelDestroy(&m));
}

/* What is said of a wall below the grid. */
static void say(const char *method, ShapeKind shape, const char *expected)
{
  const Block block = {method, "cell", CELL_QUADRILATERAL, &kinematics_plane_strain, 4, 0};
  Bench b;
  WallSpec wall;
  Diag *diag;
  Model *m;
  char *text = NULL;
  size_t size;
  PetscMPIInt rank;
  standing(&b, &block, &wall);
  bench_dynamic(&b, 1, 5e-3);
  wall.shape.kind = shape;
  wall.shape.centre[1] = wall.shape.point[1] = -1;
  wall.shape.radius = 0.25;
  FILE *out = open_memstream(&text, &size);
  CALL(DiagCreate(&diag));
  CALL(ModelCreate(PETSC_COMM_WORLD, &b.c, diag, &m));
  CALL(DiagFlush(diag, out));
  fclose(out);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (!rank) CHECK(expected ? strstr(text, expected) != NULL : !*text, "not '%s' but: %s", expected, text);
  free(text);
  CALL(DiagDestroy(&diag));
  CALL(ModelDestroy(&m));
}

/* A mesh may come to it, a grid does not. */
static void test_out_of_reach(void **state)
{
  (void)state;
  say("mpm", SHAPE_BALL,
      "wall 'floor' from (-0.25, -1.25) to (0.25, -0.75) m lies outside of the grid from (0.125, 0.3125) to");
  say("mpm", SHAPE_HALF_SPACE, "wall 'floor' lies outside of the grid from (0.125, 0.3125) to (2.125, 1.3125) m");
  say("fem", SHAPE_HALF_SPACE, NULL);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_presses), cmocka_unit_test(test_shears),  cmocka_unit_test(test_stiff),
    cmocka_unit_test(test_gate),    cmocka_unit_test(test_appears), cmocka_unit_test(test_out_of_reach),
  };
  return run_model_group(argc, argv, tests, PETSC_STATIC_ARRAY_LENGTH(tests));
}
