/* Rigid walls in explicit dynamics, against what mechanics says of rigid bodies: momentum that they give, how a
 * block slides, that it rests, what it weighs; on any number of ranks, after a resumed run, and after statics. */
#include "model/explicit/explicit.h"
#include "resumed.h"

typedef struct {
  const char *basis;
  CellType cell;
  const Kinematics *kinematics;
  PetscReal friction;
} Block;

#define SLOPE (PETSC_PI / 6)

/* A block of 1 x 0.5 (x 0.5) m stands on a wall, half a cell above a line of the grid. */
static void standing(Bench *b, const Block *r, PetscReal slope, WallSpec *wall)
{
  const int up = r->cell == CELL_HEXAHEDRON ? 2 : 1;
  const PetscReal left = r->kinematics->hoop ? 0 : 0.125, x = r->kinematics->hoop ? 0 : 0.625;
  bench_init(b, "mpm", r->cell, 0);
  b->c.kinematics = r->kinematics;
  bench_grid(b, (PetscReal[]){left, 0.25, 0}, (PetscReal[]){3 + left, 1.5, 1}, 0.25);
  bench_box(b, 0, (PetscReal[]){x, 0.5, 0.25}, (PetscReal[]){x + 1, 1, 0.75});
  bench_dynamic(b, 1, 5e-3);
  b->c.analysis.type = ANALYSIS_EXPLICIT;
  b->c.analysis.courant = 0.6;
  b->c.analysis.transfer = (char *)(r->cell == CELL_TRIANGLE ? "thesis" : "consistent");
  b->c.basis.kind = r->basis;
  b->c.gravity[0] = 9.81 * PetscSinReal(slope);
  b->c.gravity[up] = -9.81 * PetscCosReal(slope);
  *wall = (WallSpec){.name = (char *)"floor",
                     .shape = {.kind = SHAPE_HALF_SPACE},
                     .contact = r->friction > 0 ? CONTACT_FRICTION : CONTACT_FRICTIONLESS,
                     .friction = r->friction};
  wall->shape.point[up] = up == 2 ? 0.25 : 0.5;
  wall->shape.normal[up] = 1;
  b->c.n_walls = 1;
  b->c.walls = wall;
  if (r->kinematics->hoop) bench_motion(b, 0, 0, MOTION_FIXED, 1);
}

static PetscReal measure(Model *m, const char *kind, const char *word, PetscInt component)
{
  return model_wall(m, "floor", kind, word, component);
}

static const Block blocks[] = {{"cell", CELL_QUADRILATERAL, &kinematics_plane_strain, 0.2},
                               {"cell", CELL_TRIANGLE, &kinematics_plane_strain, 0.2},
                               {"gimp", CELL_QUADRILATERAL, &kinematics_plane_strain, 0.2},
                               {"cell", CELL_HEXAHEDRON, &kinematics_3d, 0.2},
                               {"cell", CELL_QUADRILATERAL, &kinematics_plane_strain, 0}};

/* Impulses of the wall are the change of momentum to round-off; it never pulls; their ratio is the friction, and
 * its work the way times the force; the block is as fast as a rigid one; all energy is accounted for. */
static void test_slides(void **state)
{
  (void)state;
  EACH_OF (i, blocks) {
    const Block *r = blocks + i;
    Bench b;
    WallSpec wall;
    Energies e;
    const int up = r->cell == CELL_HEXAHEDRON ? 2 : 1;
    const PetscReal mass = up == 2 ? 250 : 500;
    PetscReal given[3] = {0, 0, 0}, off = 0, least = 0, deepest = 0;
    standing(&b, r, SLOPE, &wall);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (PetscInt k = 0; m->time < 0.3; ++k) {
      const PetscReal before = m->time;
      model_step(m, k % 3 == 1 ? 2e-3 : 5e-3);
      for (PetscInt d = 0; d < m->dim; ++d) {
        given[d] += (m->time - before) * measure(m, "wall_force", NULL, d);
        off = PetscMax(off, PetscAbsReal(given[d] + mass * b.c.gravity[d] * m->time - model_sum(m, "momentum", d)));
      }
      least = PetscMin(least, measure(m, "wall_force", NULL, up));
      deepest = PetscMax(deepest, measure(m, "contact", "penetration", 0));
    }
    CALL(ModelEnergies(m, &e));
    const PetscReal speed = 9.81 * (PetscSinReal(SLOPE) - r->friction * PetscCosReal(SLOPE)) * m->time;
    const PetscReal found = model_sum(m, "momentum", 0) / mass, ratio = -given[0] / given[up];
    PetscPrintf(PETSC_COMM_WORLD,
                "%s cell %d mu %g: impulse off %.2g, ratio %.6g, speed %.6g of %.6g, %.2g m deep, friction %.4g, "
                "transfer %.3g of %.6g J\n",
                r->basis, (int)r->cell, (double)r->friction, (double)(off / given[up]), (double)ratio, (double)found,
                (double)speed, (double)deepest, (double)e.friction, (double)e.transfer, (double)e.external);
    CHECK(off <= 1e-11 * given[up] && given[up] > 500, "impulse off by %g of %g", (double)off, (double)given[up]);
    CHECK(least >= 0, "the wall pulls with %g N", (double)-least);
    CHECK(ratio <= r->friction + 1e-12 && ratio >= 0.98 * r->friction, "ratio %g", (double)ratio);
    CHECK(PetscAbsReal(found - speed) < 0.01 * speed, "speed %g, not %g", (double)found, (double)speed);
    /* weight that comes at once, and strains a cell twice as much as weight at rest */
    CHECK(deepest <= 2.5 * 1000 * 9.81 * 0.5 * 0.25 / m->materials[0].wave_modulus, "it is %g m deep in the wall",
          (double)deepest);
    CHECK(PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-12, "open");
    CALL(ModelDestroy(&m));
  }
}

/* A block that is put down gently rests, where mu > tan t, and the wall bears it. */
static void test_rests(void **state)
{
  static const Block rest[] = {{"cell", CELL_QUADRILATERAL, &kinematics_plane_strain, 0.7},
                               {"gimp", CELL_QUADRILATERAL, &kinematics_plane_strain, 0.7},
                               {"cell", CELL_QUADRILATERAL, &kinematics_axisymmetric, 0.7},
                               {"gimp", CELL_QUADRILATERAL, &kinematics_axisymmetric, 0.7}};
  (void)state;
  EACH_OF (i, rest) {
    const Block *r = rest + i;
    Bench b;
    WallSpec wall;
    const PetscReal slope = r->kinematics->hoop ? 0 : SLOPE, mass = r->kinematics->hoop ? 500 * PETSC_PI : 500;
    standing(&b, r, slope, &wall);
    b.c.analysis.damping = 40;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    while (m->time < 2.0) model_step(m, PETSC_MAX_REAL);
    const PetscReal across = measure(m, "wall_force", NULL, 0), up = measure(m, "wall_force", NULL, 1);
    /* what second mappings shake is 1e-5 of the weight */
    CHECK_CLOSE(up, mass * 9.81 * PetscCosReal(slope), 2e-4 * mass);
    if (!r->kinematics->hoop) CHECK_CLOSE(across, -mass * 9.81 * PetscSinReal(slope), 2e-4 * mass);
    /* its foot is strained by less than rho g H / M */
    CHECK_CLOSE(measure(m, "contact", "area", 0), r->kinematics->hoop ? PETSC_PI : 1,
                mass / 500 * 1000 * 9.81 * 0.5 / m->materials[0].wave_modulus);
    CALL(ModelDestroy(&m));
  }
}

/* A wall that lifts the block: what it does is work of the boundary. */
static void test_lifts(void **state)
{
  Bench b;
  WallSpec wall;
  Energies e;
  MotionSpec lift = {.kind = MOTION_VELOCITY, .component = {1, 1, 1}, .value = {0, 0.5, 0}};
  (void)state;
  standing(&b, blocks, 0, &wall);
  wall.n_motions = 1;
  wall.motions = &lift;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  PetscReal work = 0;
  while (m->time < 0.4) {
    model_step(m, PETSC_MAX_REAL);
    work += 5e-3 * 0.5 * measure(m, "wall_force", NULL, 1);
  }
  CALL(ModelEnergies(m, &e));
  PetscPrintf(PETSC_COMM_WORLD, "lifted: work %.6g J of %.6g, momentum %.6g\n", (double)e.boundary, (double)work,
              (double)model_sum(m, "momentum", 1));
  CHECK_CLOSE(e.boundary, work, 0.01 * work);
  CHECK(PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-12, "open");
  CALL(ModelDestroy(&m));
}

/* A block that two smooth walls press together by d: the springs on both sides are in line with it,
 * p = E' d / (L + 2 h E' / (k M)), and as much softer than a cell as they are told. */
static void test_pressed(void **state)
{
  static const PetscReal stiffness[] = {1, 1.7, 5.6, 17};
  static const Block pressed[] = {{"gimp", CELL_QUADRILATERAL, &kinematics_plane_strain, 0},
                                  {"cell", CELL_TRIANGLE, &kinematics_plane_strain, 0},
                                  {"cell", CELL_HEXAHEDRON, &kinematics_3d, 0}};
  const PetscReal length = 0.5, way = 0.005;
  (void)state;
  EACH_OF (i, pressed)
    EACH_OF (k, stiffness) {
      const Block *r = pressed + i;
      const int up = r->cell == CELL_HEXAHEDRON ? 2 : 1;
      MotionSpec down = {.kind = MOTION_VELOCITY};
      Bench b;
      WallSpec wall[2];
      standing(&b, r, 0, wall);
      b.c.gravity[up] = 0;
      b.c.analysis.courant = 0.8;
      b.c.analysis.contact = stiffness[k];
      b.c.analysis.damping = 40;
      wall[1] = wall[0];
      wall[1].name = (char *)"press";
      wall[1].shape.point[up] += length;
      wall[1].shape.normal[up] = -1;
      down.component[up] = PETSC_TRUE;
      down.value[up] = -way / 0.5;
      wall[1].n_motions = 1;
      wall[1].motions = &down;
      b.c.n_walls = 2;
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      while (m->time < 0.5 - 1e-9) model_step(m, PETSC_MAX_REAL);
      const PetscReal free = 1e6 / (up == 2 ? 1 : 1 - 0.09), M = m->materials[0].wave_modulus, area = up == 2 ? 0.5 : 1;
      const PetscReal spring = stiffness[k] * M / 0.25, p = way / (length / free + 2 / spring);
      const PetscReal force = measure(m, "wall_force", NULL, up), deep = measure(m, "contact", "penetration", 0);
      PetscPrintf(PETSC_COMM_WORLD, "%s cell %d, %g: %.6g N of %.6g, %.4g mm deep of %.4g, %d substeps\n", r->basis,
                  (int)r->cell, (double)stiffness[k], (double)force, (double)(p * area), (double)(1e3 * deep),
                  (double)(1e3 * p / spring), (int)m->total_iterations);
      CHECK_CLOSE(force, p * area, 0.03 * p * area);
      /* the deepest of all: stresses of triangles scatter */
      if (r->cell != CELL_TRIANGLE) CHECK_CLOSE(deep, p / spring, 0.05 * p / spring);
      CALL(ModelDestroy(&m));
    }
}

/* A wall that is there until 0.1 s: what it gave stays, and then there is free fall. */
static void test_vanishes(void **state)
{
  Bench b;
  WallSpec wall;
  PetscReal given = 0;
  (void)state;
  standing(&b, blocks, 0, &wall);
  wall.has_until = PETSC_TRUE;
  wall.until = 0.1;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscReal before = 0; m->time < 0.25; before = m->time) {
    model_step(m, 7e-3);
    given += (m->time - before) * measure(m, "wall_force", NULL, 1);
    CHECK(m->time < 0.1 + 1e-12 || measure(m, "wall_force", NULL, 1) == 0, "it pushes at %g s", (double)m->time);
    CHECK(before > 0.1 - 1e-12 || m->time < 0.1 + 1e-12, "a step goes from %g to %g s", (double)before,
          (double)m->time);
  }
  CHECK(given > 0.5 * 500 * 9.81 * 0.1, "it has given %g N s", (double)given);
  CHECK_CLOSE(model_sum(m, "momentum", 1), given - 500 * 9.81 * m->time, 1e-8);
  CALL(ModelDestroy(&m));
}

/* A bonded wall carries what hangs on it. */
static void test_hangs(void **state)
{
  Bench b;
  WallSpec wall;
  (void)state;
  EACH_VARIANT (i, 4) {
    const Block *r = blocks + i;
    const int up = r->cell == CELL_HEXAHEDRON ? 2 : 1;
    const PetscReal mass = up == 2 ? 250 : 500;
    standing(&b, r, PETSC_PI - SLOPE, &wall);
    wall.contact = CONTACT_BONDED;
    b.c.analysis.damping = 40;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    while (m->time < 0.6) model_step(m, PETSC_MAX_REAL);
    CHECK_CLOSE(measure(m, "wall_force", NULL, up), -mass * 9.81 * PetscCosReal(SLOPE), 1e-3 * mass * 9.81);
    CHECK_CLOSE(measure(m, "wall_force", NULL, 0), -mass * 9.81 * PetscSinReal(SLOPE), 1e-3 * mass * 9.81);
    CALL(ModelDestroy(&m));
  }
}

static void test_ranks(void **state)
{
  static const PointReal fields[] = {POINT_X, POINT_V, POINT_F, POINT_CONTACT};
  (void)state;
  EACH_VARIANT (i, 4) {
    const Block *r = blocks + i;
    Bench b;
    WallSpec wall;
    standing(&b, r, SLOPE, &wall);
    Model *together = bench_model(&b, PETSC_COMM_WORLD), *alone = bench_model(&b, PETSC_COMM_SELF);
    for (int s = 0; s < 6; ++s) {
      model_step(together, PETSC_MAX_REAL);
      model_step(alone, PETSC_MAX_REAL);
    }
    for (size_t f = 0; f < PETSC_STATIC_ARRAY_LENGTH(fields); ++f) {
      const PetscReal off = points_difference(together, alone, fields[f]);
      CHECK(off <= (fields[f] == POINT_CONTACT ? 1e-4 : 1e-8), "field %d is off by %g", (int)fields[f], (double)off);
    }
    CHECK_CLOSE(measure(together, "wall_force", NULL, 1), measure(alone, "wall_force", NULL, 1), 1e-5);
    CHECK_CLOSE(measure(together, "wall_torque", NULL, 2), measure(alone, "wall_torque", NULL, 2), 1e-5);
    CALL(ModelDestroy(&together));
    CALL(ModelDestroy(&alone));
  }
}

/* Put away and taken up again: the same bits. */
static void test_resumed(void **state)
{
  WallSpec wall;
  Bench b;
  (void)state;
  standing(&b, blocks, SLOPE, &wall);
  Model *m = bench_model(&b, PETSC_COMM_WORLD), *again = bench_model(&b, PETSC_COMM_WORLD);
  for (int s = 0; s < 9; ++s) model_step(m, PETSC_MAX_REAL);
  model_take_up(m, again);
  models_go_on(m, again, 4);
  CHECK(measure(m, "wall_force", NULL, 1) == measure(again, "wall_force", NULL, 1), "forces differ");
  CALL(ModelDestroy(&m));
  CALL(ModelDestroy(&again));
}

/* A force that is none: what loads act on is looked at anew in every substep. */
static void nothing(void *context, PetscInt n, const PetscReal *X, const PetscReal *x, PetscReal t, PetscReal *b)
{
  (void)context, (void)n, (void)X, (void)x, (void)t, (void)b;
}

/* Walls are looked for once for many substeps: a floor that comes from four cells below meanwhile, and stops under the
 * block for it to fall on, is found, and all is as if it were looked for in each of them. */
static void test_laps(void **state)
{
  static const PointReal fields[] = {POINT_X, POINT_V, POINT_TAU, POINT_CONTACT};
  static PetscReal time[] = {0, 0.03}, way[] = {0, 1};
  static const Block met[] = {{"cell", CELL_QUADRILATERAL, &kinematics_plane_strain, 0.2},
                              {"gimp", CELL_QUADRILATERAL, &kinematics_plane_strain, 0.2},
                              {"gimp", CELL_QUADRILATERAL, &kinematics_axisymmetric, 0.2},
                              {"cell", CELL_TRIANGLE, &kinematics_plane_strain, 0.2},
                              {"cell", CELL_HEXAHEDRON, &kinematics_3d, 0.2}};
  (void)state;
  EACH_OF (i, met) {
    const Block *r = met + i;
    Bench b;
    WallSpec wall;
    const int up = r->cell == CELL_HEXAHEDRON ? 2 : 1;
    MotionSpec come = {
      .kind = MOTION_DISPLACEMENT, .component = {1, 1, 1}, .amplitude = {.n = 2, .time = time, .value = way}};
    standing(&b, r, 0, &wall);
    come.value[up] = 1;
    b.c.analysis.step = b.c.analysis.largest = 0.05;
    wall.shape.point[up] -= 1.01;
    wall.n_motions = 1;
    wall.motions = &come;
    Model *laps = bench_model(&b, PETSC_COMM_WORLD), *alone = bench_model(&b, PETSC_COMM_SELF);
    CALL(ModelSetBodyForce(alone, nothing, NULL));
    PetscReal bears[2] = {0, 0};
    for (int s = 0; s < 2; ++s) {
      model_step(laps, 0.05);
      model_step(alone, 0.05);
      bears[0] += measure(laps, "wall_force", NULL, up);
      bears[1] += measure(alone, "wall_force", NULL, up);
    }
    CHECK(bears[1] > 1000, "the floor bears %g N", (double)bears[1]);
    CHECK(laps->explicit->box == (r->cell != CELL_TRIANGLE) && !alone->explicit->box, "both walk alike");
    for (size_t f = 0; f < PETSC_STATIC_ARRAY_LENGTH(fields); ++f) {
      const PetscReal off = points_difference(laps, alone, fields[f]), most = (PetscReal[]){1e-10, 1e-8, 1e-3, 1e-4}[f];
      CHECK(off <= most, "%s cell %d: field %d is off by %g", r->basis, (int)r->cell, (int)fields[f], (double)off);
    }
    CHECK_CLOSE(bears[0], bears[1], 1e-8 * bears[1]);
    CALL(ModelDestroy(&laps));
    CALL(ModelDestroy(&alone));
  }
}

/* A wall without an inside that strikes a block like one that has one: a line, or a disk in space. */
static void thin_one(const Block *r, PetscReal *ends, WallSpec *wall)
{
  const PetscReal *point = wall->shape.point, *normal = wall->shape.normal;
  if (r->cell == CELL_HEXAHEDRON) {
    wall->shape = (Shape){.kind = SHAPE_DISK,
                          .centre = {point[0] + 1, point[1] + 1, point[2]},
                          .normal = {normal[0], normal[1], normal[2]},
                          .radii = {0, 4}};
    return;
  }
  ends[0] = -5, ends[2] = 10;
  ends[1] = ends[3] = point[1];
  wall->shape = (Shape){.kind = SHAPE_LINE, .n_vertices = 2, .vertices = ends};
}

/* The momentum that a wall gives a free block which it strikes with 0.7 of the speed of waves, by springs of such a
 * stiffness, and what of the block has gone through it, kg. */
static PetscReal struck(const Block *r, PetscBool thin, PetscReal stiffness, PetscReal *through, PetscReal *deepest)
{
  Bench b;
  WallSpec wall;
  PetscReal ends[4];
  const int up = r->cell == CELL_HEXAHEDRON ? 2 : 1;
  MotionSpec come = {.kind = MOTION_VELOCITY, .component = {1, 1, 1}};
  standing(&b, r, 0, &wall);
  b.c.gravity[up] = 0;
  if (thin) thin_one(r, ends, &wall);
  const PetscReal c = PetscSqrtReal(b.constants[0].value / 1000), end = (stiffness < 1 ? 0.8 : 0.45) / (0.7 * c);
  come.value[up] = 0.7 * c;
  b.c.analysis.contact = stiffness;
  wall.n_motions = 1;
  wall.motions = &come;
  b.c.analysis.step = b.c.analysis.largest = end / 8;
  Model *m = bench_model(&b, PETSC_COMM_WORLD), *again = bench_model(&b, PETSC_COMM_WORLD);
  for (int s = 0; s < 8; ++s) {
    model_step(m, PETSC_MAX_REAL);
    *deepest = PetscMax(*deepest, measure(m, "contact", "penetration", 0));
  }
  const PetscReal given = model_sum(m, "momentum", up);
  *through = m->contact->crossed[0];
  model_take_up(m, again);
  CHECK(again->contact->crossed[0] == *through, "a resumed run forgets what has gone through");
  CALL(ModelDestroy(&m));
  CALL(ModelDestroy(&again));
  return given;
}

/* Points sink in by more than they are thick (a quarter of a cell), and stand beyond a thin wall: it pushes them back,
 * as a solid one does. What such walls cannot hold at all is told. */
static void test_thin(void **state)
{
  static const Block met[] = {{"gimp", CELL_QUADRILATERAL, &kinematics_plane_strain, 0.2},
                              {"cell", CELL_TRIANGLE, &kinematics_plane_strain, 0.2},
                              {"cell", CELL_HEXAHEDRON, &kinematics_3d, 0.2}};
  (void)state;
  EACH_OF (i, met) {
    PetscReal through[2], deepest[2] = {0, 0};
    const PetscReal solid = struck(met + i, PETSC_FALSE, 1, through, deepest);
    const PetscReal thin = struck(met + i, PETSC_TRUE, 1, through + 1, deepest + 1);
    CHECK(deepest[0] > 0.25 / 4, "%s: only %g m deep", met[i].basis, (double)deepest[0]);
    PetscPrintf(PETSC_COMM_WORLD, "%s %g: thin %.12g, solid %.12g kg m/s\n", met[i].basis, (double)deepest[0],
                (double)thin, (double)solid);
    CHECK_CLOSE(thin, solid, 1e-9 * solid);
    CHECK(through[0] == 0 && through[1] == 0, "%g kg are through", (double)through[1]);
  }
  PetscReal through, deepest = 0;
  struck(met, PETSC_TRUE, 0.01, &through, &deepest);
  CHECK(through > 10 && through <= 500, "%g of 500 kg are said to be through", (double)through);
}

/* A wall that comes where the block is stands there and pushes nothing, until something presses. */
static void test_comes(void **state)
{
  (void)state;
  EACH_VARIANT (i, 4) {
    Bench b;
    WallSpec wall;
    Energies e;
    const int up = blocks[i].cell == CELL_HEXAHEDRON ? 2 : 1;
    standing(&b, blocks + i, 0, &wall);
    b.c.gravity[up] = 0;
    wall.shape.point[up] += 0.02;
    wall.from = 0.01;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (int s = 0; s < 6; ++s) model_step(m, PETSC_MAX_REAL);
    CALL(ModelEnergies(m, &e));
    CHECK(measure(m, "wall_force", NULL, up) == 0, "it pushes with %g N", (double)measure(m, "wall_force", NULL, up));
    CHECK(e.kinetic + e.elastic < 1e-20, "it has made %g J", (double)(e.kinetic + e.elastic));
    CALL(ModelDestroy(&m));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_slides),   cmocka_unit_test(test_rests), cmocka_unit_test(test_lifts),
    cmocka_unit_test(test_vanishes), cmocka_unit_test(test_hangs), cmocka_unit_test(test_ranks),
    cmocka_unit_test(test_resumed),  cmocka_unit_test(test_laps),  cmocka_unit_test(test_pressed),
    cmocka_unit_test(test_thin),     cmocka_unit_test(test_comes)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
