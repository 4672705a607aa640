/* Walls with mass in explicit dynamics, against mechanics of rigid bodies: free flight, momentum and energy of
 * collisions, what implicit dynamics gives, rest under their own weight; on any number of ranks, resumed too. */
#include "model/explicit/explicit.h"
#include "heavy.h"
#include "resumed.h"

typedef struct {
  const char *basis, *transfer;
  CellType cell;
  PetscReal friction, density;
} Hit;

/* Tests of what ranks have no part in. */
static PetscBool alone(void)
{
  PetscMPIInt size;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return size == 1;
}

static int axis_up(const Hit *h) { return h->cell == CELL_HEXAHEDRON ? 2 : 1; }

static PetscReal mass_of(const Hit *h)
{
  return h->density * (axis_up(h) == 2 ? 4. / 3 * PETSC_PI * 0.027 : PETSC_PI * 0.09);
}

/* A block of rubber, 1 x 0.5 (x 0.5) m, and a ball above its top that falls on it with 2 m/s. */
static void below_ball(Bench *b, const Hit *h, PetscReal size, WallSpec *wall)
{
  const int up = axis_up(h);
  bench_init(b, "mpm", h->cell, 0);
  bench_grid(b, (PetscReal[]){-1, up == 2 ? -0.5 : -1, -0.5}, (PetscReal[]){3, 2, 1}, size);
  bench_box(b, 0, (PetscReal[]){0.5, 0, 0}, (PetscReal[]){1.5, 0.5, 0.5});
  bench_dynamic(b, 1, 5e-3);
  b->c.analysis.type = ANALYSIS_EXPLICIT;
  b->c.analysis.courant = 0.6;
  b->c.analysis.transfer = (char *)h->transfer;
  b->c.basis.kind = h->basis;
  heavy_ball(b, up == 2, h->density, h->friction, wall);
}

static const Hit hits[] = {
  {"cell", "thesis", CELL_QUADRILATERAL, 0, 2000},     {"gimp", "consistent", CELL_QUADRILATERAL, 0.3, 2000},
  {"gimp", "consistent", CELL_QUADRILATERAL, 0.3, 20}, {"cell", "thesis", CELL_TRIANGLE, 0.3, 2000},
  {"cell", "consistent", CELL_HEXAHEDRON, 0.3, 2000},  {"cell", "consistent", CELL_HEXAHEDRON, 0.3, 20}};

/* What the ball loses the block gets, in steps of changing length, whatever the ball weighs; no energy is made, and
 * only friction turns it. */
static void test_hits(void **state)
{
  (void)state;
  for (const Hit *h = hits; h < hits + PETSC_STATIC_ARRAY_LENGTH(hits); ++h) {
    const int up = axis_up(h);
    PetscReal off = 0;
    Energies e;
    Bench b;
    WallSpec wall;
    below_ball(&b, h, 0.125, &wall);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (PetscInt k = 0; m->time < 0.1; ++k) {
      model_step(m, k % 3 == 1 ? 2e-3 : 5e-3);
      for (PetscInt d = 0; d < m->dim; ++d) {
        const PetscReal before = mass_of(h) * wall.mass.velocity[d];
        off = PetscMax(
          off, PetscAbsReal(mass_of(h) * of_ball(m, "wall_velocity", d) + model_sum(m, "momentum", d) - before));
      }
    }
    CALL(ModelEnergies(m, &e));
    const PetscReal given = -model_sum(m, "momentum", up), most = mass_of(h) * 2;
    PetscPrintf(PETSC_COMM_WORLD,
                "%s cell %d, %g kg: momentum off %.2g of %.6g, transfer %.4g, friction %.4g of %.6g J\n", h->basis,
                (int)h->cell, (double)mass_of(h), (double)off, (double)given, (double)e.transfer, (double)e.friction,
                (double)e.start);
    CHECK(off <= 1e-11 * most, "momentum off by %g of %g", (double)off, (double)most);
    CHECK(given > 0.5 * most, "it is not stopped: %g of %g", (double)given, (double)most);
    /* a light one bounces faster than the cells can follow */
    CHECK(e.transfer > -1e-3 * e.start && e.transfer < (h->density > 1000 ? 0.1 : 0.5) * e.start, "%g of %g J are lost",
          (double)e.transfer, (double)e.start);
    if (h->friction == 0) CHECK_CLOSE(of_ball(m, "wall_spin", 2), 2, 1e-9);
    else
      CHECK(PetscAbsReal(of_ball(m, "wall_spin", up == 2 ? 1 : 2) - (up == 2 ? 0 : 2)) > 0.1,
            "friction does not turn it");
    CALL(ModelDestroy(&m));
  }
}

static PetscReal speed_after(const Hit *h, PetscReal size, PetscBool implicit)
{
  Bench b;
  WallSpec wall;
  below_ball(&b, h, size, &wall);
  if (implicit) b.c.analysis.type = ANALYSIS_DYNAMIC, b.c.analysis.scheme = (char *)"midpoint";
  b.c.linear = LINEAR_AUTO;
  b.c.newton = (NewtonSpec){.residual = 1e-9, .increment = 1e-10, .max_iterations = 25, .ease = 6};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 0.1 - 1e-9) model_step(m, 1e-3);
  const PetscReal speed = of_ball(m, "wall_velocity", 1);
  CALL(ModelDestroy(&m));
  return speed;
}

/* Implicit and explicit dynamics come to the same speed with the cells: their walls give way by the strain of one. */
static void test_as_implicit(void **state)
{
  (void)state;
  if (!alone()) skip();
  for (int k = 1; k < 3; ++k) {
    PetscReal off[2];
    for (int fine = 0; fine < 2; ++fine) {
      const PetscReal size = fine ? 0.0625 : 0.125, found = speed_after(&hits[k], size, PETSC_FALSE),
                      expected = speed_after(&hits[k], size, PETSC_TRUE);
      off[fine] = PetscAbsReal(found - expected);
      PetscPrintf(PETSC_COMM_WORLD, "%g kg/m3, h = %g m: %.5g m/s after it, implicit %.5g\n", (double)hits[k].density,
                  (double)size, (double)found, (double)expected);
    }
    CHECK(off[1] < 0.6 * off[0] && off[1] < 0.08 * 2, "%g m/s apart, %g with finer cells", (double)off[0],
          (double)off[1]);
  }
}

/* A brick that tumbles in free fall keeps its moment of momentum to round-off and falls as a point does; energy goes
 * with the square of the substep. */
static void test_flies(void **state)
{
  static const Hit far = {"cell", "thesis", CELL_HEXAHEDRON, 0, 2000};
  PetscReal off[2];
  (void)state;
  for (int fine = 0; fine < 2; ++fine) {
    PetscReal L[3], now = 0;
    Bench b;
    WallSpec wall;
    below_ball(&b, &far, 0.125, &wall);
    b.c.analysis.courant = fine ? 0.3 : 0.6;
    const PetscReal energy = spinning_box(&wall, L);
    b.c.gravity[2] = -9.81;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (PetscInt k = 0; m->time < 0.28; ++k) model_step(m, k % 3 == 1 ? 0.02 : 0.05);
    const RigidWall *ball = m->contact->rigid;
    const PetscReal t = m->time, fallen = -2 * t - 9.81 / 2 * t * t;
    CHECK_CLOSE(of_ball(m, "wall_position", 2), 3 + fallen, 1e-12);
    CHECK_CLOSE(of_ball(m, "wall_position", 0), 2 + 0.5 * t, 1e-12);
    CHECK_CLOSE(of_ball(m, "wall_velocity", 2), -2 - 9.81 * t, 1e-12);
    for (int d = 0; d < 3; ++d) {
      const PetscReal v = of_ball(m, "wall_velocity", d);
      CHECK_CLOSE(ball->now.L[d], L[d], 1e-12 * L[1]);
      now += 0.5 * (of_ball(m, "wall_spin", d) * ball->now.L[d] + BOX_MASS * v * v);
    }
    off[fine] = PetscAbsReal(now - energy + BOX_MASS * 9.81 * fallen) / energy;
    CHECK(PetscAbsReal(of_ball(m, "wall_spin", 0) - 1) > 0.1, "it does not tumble");
    CALL(ModelDestroy(&m));
  }
  PetscPrintf(PETSC_COMM_WORLD, "energy off by %.3g, %.3g with half the substep\n", (double)off[0], (double)off[1]);
  CHECK(off[0] < 1e-4 && off[1] < 0.35 * off[0], "energy off by %g, %g", (double)off[0], (double)off[1]);
}

/* Balls of cork and of foam lie still on the block, which carries their weight: their springs do not swing up. */
static void test_rests(void **state)
{
  (void)state;
  if (!alone()) skip();
  for (int k = 0; k < 3; ++k) {
    Hit h = hits[k < 2 ? 1 : 4];
    Bench b;
    WallSpec wall;
    h.density = k ? 20 : 200;
    const int up = axis_up(&h);
    below_ball(&b, &h, 0.125, &wall);
    wall.shape.centre[up] = 0.8 - 1e-4;
    for (int d = 0; d < 3; ++d) wall.mass.velocity[d] = wall.mass.spin[d] = 0;
    b.c.gravity[up] = -9.81;
    b.c.analysis.damping = 20;
    bench_motion(&b, up, 0, MOTION_FIXED, up == 2 ? 7 : 3);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    PetscReal force = 0, n = 0, deepest = 0;
    for (; m->time < 1.2; model_step(m, PETSC_MAX_REAL)) {
      if (m->time < 0.9) continue;
      force += of_ball(m, "wall_force", up), ++n;
      deepest = PetscMax(deepest, model_wall(m, "ball", "contact", "penetration", 0));
    }
    const PetscReal weight = mass_of(&h) * 9.81;
    PetscPrintf(PETSC_COMM_WORLD, "%g kg rest with %.6g of %.6g N, %.3g m deep, %.3g m/s\n", (double)mass_of(&h),
                (double)(-force / n), (double)weight, (double)deepest, (double)of_ball(m, "wall_velocity", up));
    CHECK_CLOSE(-force / n, weight, 0.02 * weight);
    CHECK(PetscAbsReal(of_ball(m, "wall_velocity", up)) < 0.02, "it moves by %g m/s",
          (double)of_ball(m, "wall_velocity", up));
    CALL(ModelDestroy(&m));
  }
}

static void test_ranks(void **state)
{
  (void)state;
  for (int k = 1; k < 5; k += 3) {
    Bench b;
    WallSpec wall;
    below_ball(&b, &hits[k], 0.125, &wall);
    Model *together = bench_model(&b, PETSC_COMM_WORLD), *alone = bench_model(&b, PETSC_COMM_SELF);
    for (int s = 0; s < 8; ++s) {
      model_step(together, PETSC_MAX_REAL);
      model_step(alone, PETSC_MAX_REAL);
    }
    CHECK(points_difference(together, alone, POINT_V) <= 1e-8, "points differ");
    for (PetscInt d = 0; d < together->dim; ++d)
      CHECK_CLOSE(of_ball(together, "wall_velocity", d), of_ball(alone, "wall_velocity", d), 1e-9);
    CHECK(PetscAbsReal(of_ball(alone, "wall_velocity", axis_up(&hits[k])) + 2) > 0.1, "it has met nothing");
    CALL(ModelDestroy(&together));
    CALL(ModelDestroy(&alone));
  }
}

/* Put away in the middle of the impact and taken up again: the same bits. */
static void test_resumed(void **state)
{
  WallSpec wall;
  Bench b;
  (void)state;
  below_ball(&b, &hits[1], 0.125, &wall);
  Model *m = bench_model(&b, PETSC_COMM_WORLD), *again = bench_model(&b, PETSC_COMM_WORLD);
  for (int s = 0; s < 6; ++s) model_step(m, PETSC_MAX_REAL);
  CHECK(of_ball(m, "wall_force", 1) < 0, "there is no contact");
  model_take_up(m, again);
  models_go_on(m, again, 4);
  CHECK(!memcmp(&m->contact->rigid->now, &again->contact->rigid->now, sizeof m->contact->rigid->now), "balls differ");
  CALL(ModelDestroy(&m));
  CALL(ModelDestroy(&again));
}

/* A block that leaves the grid: nothing is left that would tell a substep, and the ball falls on. */
static void test_left(void **state)
{
  Bench b;
  WallSpec wall;
  (void)state;
  below_ball(&b, &hits[0], 0.125, &wall);
  b.c.grid.outside = OUTSIDE_REMOVE;
  b.body[0].velocity[1] = -300;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (int s = 0; s < 4; ++s) model_step(m, PETSC_MAX_REAL);
  CHECK(model_sum(m, "mass: total", 0) == 0, "some is left");
  CHECK_CLOSE(of_ball(m, "wall_position", 1), 0.81 - 2 * m->time, 1e-12);
  CALL(ModelDestroy(&m));
}

static void test_comes_and_goes(void **state)
{
  Bench b;
  WallSpec wall;
  (void)state;
  below_ball(&b, hits, 0.125, &wall);
  heavy_comes_and_goes(&b, &wall);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_hits),  cmocka_unit_test(test_as_implicit),
                                     cmocka_unit_test(test_flies), cmocka_unit_test(test_rests),
                                     cmocka_unit_test(test_ranks), cmocka_unit_test(test_resumed),
                                     cmocka_unit_test(test_left),  cmocka_unit_test(test_comes_and_goes)};
  return run_model_tests_in_turns(argc, argv, tests);
}
