/* A block falls on its floor, stays or bounces: what the floor gives over all steps is the change
 * of momentum and what gravity took, in every method, for steps of any length; and what the
 * transfer takes closes the balance of energy although every work is computed for itself. (Bossak's
 * damping stays open, and with steps of changing length what it echoes over a change of clouds.) */
#include "case_builder.h"

typedef struct {
  const char *method;
  const char *basis;
  PetscReal bossak, step;
  CellType cell;
  /* s. With lme and Bossak the block may tear when it has bounced: its impact counts */
  PetscReal until;
  const char *transfer;
} Fall;

/* A block of rubber (1 m3) that starts 3.4 cells above the floor with 2 m/s; off the grid's lines
 * in x. */
static Model *falling(Bench *b, const Fall *f)
{
  const PetscReal h = f->cell == CELL_HEXAHEDRON ? 0.25 : 0.125;
  bench_init(b, f->method, f->cell, 0);
  bench_grid(b, (PetscReal[]){-0.5, 0, -0.5}, (PetscReal[]){1.5, 2, 1.5}, h);
  bench_box(b, 0, (PetscReal[]){0, 0.5, 0}, (PetscReal[]){1, 1.5, 1});
  bench_dynamic(b, 1, f->step);
  b->c.basis = (BasisSpec){
    .kind = f->basis, .gamma = 1.8, .effective_radius = 1, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
  b->c.analysis.bossak = f->bossak;
  b->c.analysis.transfer = (char *)f->transfer;
  if (!strcmp(f->basis, "gimp")) {
    b->c.analysis.scheme = (char *)"midpoint";
    b->c.stabilisation = (StabilisationSpec){.curvature = 0.1, .follow = 0.02};
  }
  b->c.linear = LINEAR_AUTO;
  b->c.newton = (NewtonSpec){.residual = 1e-11, .increment = 1e-12, .max_iterations = 25, .ease = 6};
  b->c.gravity[1] = -9.81;
  b->body[0].velocity[0] = 0.3;
  b->body[0].velocity[1] = -3;
  bench_motion(b, 1, 0, MOTION_FIXED, 7);
  return bench_model(b, PETSC_COMM_WORLD);
}

static PetscReal energy_gap(Model *m, PetscReal *largest)
{
  Energies e;
  CALL(ModelEnergies(m, &e));
  *largest = PetscMax(*largest, e.kinetic + e.elastic);
  return PetscAbsReal(e.kinetic + e.elastic + e.dissipated + e.damped + e.transfer - e.external - e.boundary - e.start);
}

/* Steps of changing length until the block has met the floor and turned. */
static void impact(const Fall *f)
{
  Bench b;
  Model *m = falling(&b, f);
  MeasureSpec reaction[2];
  PetscReal start[2], given[2] = {0, 0}, off = 0, gap = 0, largest = 0, end[2];
  for (int d = 0; d < 2; ++d) {
    start[d] = model_sum(m, "momentum", d);
    reaction[d] = (MeasureSpec){.kind = "reaction", .component = d};
  }
  for (PetscInt k = 0; m->time < f->until; ++k) {
    const PetscReal before = m->time;
    model_step(m, f->step * (k % 3 == 1 ? 0.37 : 1));
    for (int d = 0; d < 2; ++d) {
      PetscReal force;
      CALL(ModelMeasure(m, &reaction[d], 0, &force));
      given[d] += (m->time - before) * force;
      end[d] = model_sum(m, "momentum", d);
      off = PetscMax(off, PetscAbsReal(given[d] - (end[d] - start[d] + (d == 1) * 9810 * m->time)));
    }
    gap = PetscMax(gap, energy_gap(m, &largest));
  }
  PetscPrintf(PETSC_COMM_WORLD,
              "%s %s %s, cell %d, bossak %g, %g s: impulse %.6g Ns, off by %.2g of it; energy open by %.2g\n",
              f->method, f->basis, f->transfer, (int)f->cell, (double)f->bossak, (double)f->step, (double)given[1],
              (double)(off / given[1]), (double)(gap / largest));
  CHECK(given[1] > 3000, "it did not meet the floor: %g", (double)given[1]);
  CHECK(off <= 1e-6 * given[1], "impulse off by %g of %g", (double)off, (double)given[1]);
  if (f->bossak == 0) CHECK(gap <= 1e-5 * largest, "%g J of %g are not told", (double)gap, (double)largest);
  CALL(ModelDestroy(&m));
}

/* Of ranks a shorter step and damping tell nothing, and space is told by one. */
static PetscBool tells_of_ranks(const Fall *f)
{
  const PetscBool flat = f->cell != CELL_HEXAHEDRON || (!strcmp(f->basis, "cell") && !strcmp(f->method, "mpm"));
  return flat && f->step >= 2e-3 && f->bossak == 0;
}

static void test_impulse(void **state)
{
  static const Fall falls[] = {
    {"mpm", "cell", 0, 4e-3, CELL_QUADRILATERAL, 0.3, "thesis"},
    {"mpm", "cell", 0, 1e-3, CELL_QUADRILATERAL, 0.3, "thesis"},
    {"mpm", "cell", -0.1, 2e-3, CELL_TRIANGLE, 0.3, "thesis"},
    {"gmm", "lme", 0, 4e-3, CELL_QUADRILATERAL, 0.3, "thesis"},
    {"gmm", "lme", 0, 2e-3, CELL_QUADRILATERAL, 0.3, "thesis"},
    {"gmm", "lme", -0.1, 2e-3, CELL_QUADRILATERAL, 0.25, "thesis"},
    {"gmm", "mls", 0, 2e-3, CELL_QUADRILATERAL, 0.3, "thesis"},
    {"gmm", "mls", -0.1, 2e-3, CELL_QUADRILATERAL, 0.3, "thesis"},
    {"gmm", "lme", 0, 4e-3, CELL_HEXAHEDRON, 0.3, "thesis"},
    {"mpm", "cell", 0, 2e-3, CELL_QUADRILATERAL, 0.3, "consistent"},
    {"mpm", "cell", -0.1, 2e-3, CELL_QUADRILATERAL, 0.3, "consistent"},
    {"mpm", "cell", 0, 4e-3, CELL_HEXAHEDRON, 0.3, "consistent"},
    {"mpm", "gimp", 0, 2e-3, CELL_QUADRILATERAL, 0.3, "consistent"},
    {"mpm", "gimp", 0, 4e-3, CELL_HEXAHEDRON, 0.3, "consistent"},
  };
  PetscMPIInt size;
  (void)state;
  CALL(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  EACH_OF (k, falls)
    if (size == 1 || tells_of_ranks(&falls[k])) impact(&falls[k]);
}

/* A block that hangs from its upper side and is let go at t = 0: the trapezoidal rule takes the
 * reaction at both ends of a step, at the start of the first one, too. In fem nodes keep their
 * accelerations, in the others points carry them. */
static void test_hanging(void **state)
{
  static const char *const names[] = {"fem", "mpm", "gmm"};
  (void)state;
  for (int k = 0; k < 3; ++k) {
    Bench b;
    PetscReal given = 0, force, off = 0;
    const MeasureSpec reaction = {.kind = "reaction", .component = 1};
    bench_init(&b, names[k], CELL_QUADRILATERAL, 0);
    bench_grid(&b, (PetscReal[]){0, -0.5, 0}, (PetscReal[]){1, 1, 0}, 0.125);
    bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0});
    bench_dynamic(&b, 1, 2e-3);
    if (!strcmp(names[k], "gmm"))
      b.c.basis = (BasisSpec){.kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
    b.c.gravity[1] = -9.81;
    bench_motion(&b, 1, 1, MOTION_FIXED, 7);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (int s = 0; s < 25; ++s) {
      const PetscReal before = m->time;
      model_step(m, s % 2 ? 2e-3 : 1.1e-3);
      CALL(ModelMeasure(m, &reaction, 0, &force));
      given += (m->time - before) * force;
      off = PetscMax(off, PetscAbsReal(given - (model_sum(m, "momentum", 1) + 9810 * m->time)));
    }
    PetscPrintf(PETSC_COMM_WORLD, "%s: impulse %.6g Ns, off by %.2g\n", names[k], (double)given, (double)off);
    CHECK(off <= 1e-8 * given && given > 100, "off by %g of %g", (double)off, (double)given);
    CALL(ModelDestroy(&m));
  }
}

/* A stiff square that spins beside a wall: its corner strikes when (cos a + sin a) / 2 is the wall's distance, though
 * the side faced the wall when that came near. Explicit springs begin to press when the corner is there, too. */
static void turn(const char *method, AnalysisType type)
{
  const PetscReal spin = 2, distance = 0.6, dt = 2e-3;
  const PetscReal when = (asin(distance * PetscSqrtReal(2)) - PETSC_PI / 4) / spin;
  WallSpec wall = {.name = (char *)"wall",
                   .shape = {.kind = SHAPE_HALF_SPACE, .point = {0, -distance, 0}, .normal = {0, 1, 0}}};
  Bench b;
  bench_init(&b, method, CELL_QUADRILATERAL, 0);
  b.constants[0].value = 1e8;
  bench_grid(&b, (PetscReal[]){-1, -1, 0}, (PetscReal[]){1, 1, 0}, 0.25);
  bench_box(&b, 0, (PetscReal[]){-0.5, -0.5, 0}, (PetscReal[]){0.5, 0.5, 0});
  bench_dynamic(&b, 1, dt);
  b.c.analysis.type = type;
  if (!strcmp(method, "mpm")) b.c.analysis.transfer = (char *)"consistent";
  b.body[0].spin[2] = spin;
  b.c.n_walls = 1;
  b.c.walls = &wall;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 2 * when && model_wall(m, "wall", "wall_force", NULL, 1) == 0) model_step(m, dt);
  PetscPrintf(PETSC_COMM_WORLD, "%s, analysis %d: the corner strikes at %.4f s of %.4f\n", method, (int)type,
              (double)m->time, (double)when);
  CHECK_CLOSE(m->time, when + dt / 2, 1.5 * dt);
  CALL(ModelDestroy(&m));
}

static void test_turns(void **state)
{
  (void)state;
  turn("fem", ANALYSIS_DYNAMIC);
  turn("mpm", ANALYSIS_DYNAMIC);
  turn("mpm", ANALYSIS_EXPLICIT);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_impulse), cmocka_unit_test(test_hanging),
                                     cmocka_unit_test(test_turns)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
