/* analysis: {unheld: hold}. A body that nothing holds, under loads in balance, has the stresses of one that is held by
 * its planes of symmetry; what is held already stays as it is, to the last bit; what is pushed is refused. */
#include <string.h>
#include "case_builder.h"

/* A block of 1 x 0.5 (x 0.5) m within a grid that is larger, pulled at both ends. */
static void block(Bench *b, const char *method, CellType cell)
{
  const PetscBool space = cell >= CELL_TETRAHEDRON;
  bench_init(b, method, cell, 0);
  bench_grid(b, (PetscReal[]){-0.25, -0.25, -0.25}, (PetscReal[]){1.25, 0.75, 0.75}, space ? 0.25 : 0.125);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 0.5, 0.5});
  b->c.basis.kind = "cell";
  b->c.newton = (NewtonSpec){.residual = 1e-11, .increment = 1e-11, .max_iterations = 25, .ease = 6};
}

static void pull(Bench *b, PetscReal p)
{
  bench_traction(b, 0, 1, "body", p, 0, 0);
  bench_traction(b, 0, 0, "body", -p, 0, 0);
}

/* Mean, least and largest of each component of stress, over all points of all ranks. */
static void stresses(const Model *m, PetscReal least[6], PetscReal most[6])
{
  for (int k = 0; k < 6; ++k) least[k] = PETSC_MAX_REAL, most[k] = PETSC_MIN_REAL;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal sigma[6];
    CALL(ModelPointStress(m, p, sigma));
    for (int k = 0; k < 6; ++k) {
      least[k] = PetscMin(least[k], sigma[k]);
      most[k] = PetscMax(most[k], sigma[k]);
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, least, 6, MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, most, 6, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD);
}

static void run(Bench *b, PetscInt steps, PetscReal least[6], PetscReal most[6])
{
  b->c.analysis.step = b->c.analysis.largest = 1. / (PetscReal)steps;
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, 1);
  stresses(m, least, most);
  CALL(ModelDestroy(&m));
}

/* By nothing, by its foot alone, and by its planes of symmetry: the same stress everywhere. */
static void test_pulled(void **state)
{
  static const char *const names[] = {"fem", "mpm"};
  static const CellType types[] = {CELL_QUADRILATERAL, CELL_TRIANGLE, CELL_HEXAHEDRON};
  (void)state;
  for (int k = 0; k < 6; ++k) {
    PetscReal least[6], most[6], expected[6], same[6];
    Bench b;
    for (int held = 2; held >= 0; --held) {
      block(&b, names[k % 2], types[k / 2]);
      pull(&b, 2e4);
      if (held == 2) bench_motion(&b, 0, 0.5, MOTION_FIXED, 1);
      if (held >= 1) bench_motion(&b, 1, 0.25, MOTION_FIXED, 2);
      if (held == 2 && k >= 4) bench_motion(&b, 2, 0.25, MOTION_FIXED, 4);
      b.c.analysis.unheld = UNHELD_HOLD;
      run(&b, 1, held == 2 ? expected : least, held == 2 ? same : most);
      for (int c = 0; c < 6 && held < 2; ++c) {
        CHECK_CLOSE(least[c], expected[c], 1e-6 * 2e4);
        CHECK_CLOSE(most[c], same[c], 1e-6 * 2e4);
      }
    }
    PetscPrintf(PETSC_COMM_WORLD, "%s cell %d: stress xx %.9g to %.9g, yy %.3g\n", names[k % 2], (int)types[k / 2],
                (double)least[0], (double)most[0], (double)PetscMax(-least[1], most[1]));
  }
}

static void load_part(Bench *b, PetscReal y, PetscReal from, PetscReal to, PetscReal p)
{
  LoadSpec *load = bench_traction(b, 1, y, "body", 0, p, 0);
  load->on.has[0] = PETSC_TRUE;
  load->on.min[0] = from;
  load->on.max[0] = to;
}

static void support(Bench *b, PetscReal x, unsigned mask)
{
  MotionSpec *motion = bench_motion(b, 1, 0, MOTION_FIXED, mask);
  motion->on.has[0] = PETSC_TRUE;
  motion->on.min[0] = motion->on.max[0] = x;
}

/* Bent by four loads in balance, in steps, against the beam on two supports, which bear nothing either. Points of mpm
 * come to lie elsewhere in their cells: as the free one bends, its middle sinks or its ends rise. */
static void test_bent(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    PetscReal least[6], most[6], expected[6], same[6], off = 0;
    Bench b;
    for (int held = 1; held >= 0; --held) {
      block(&b, k ? "mpm" : "fem", CELL_QUADRILATERAL);
      load_part(&b, 0, 0.25, 0.75, 200);
      load_part(&b, 0.5, 0, 0.25, -200);
      load_part(&b, 0.5, 0.75, 1, -200);
      b.c.analysis.unheld = UNHELD_HOLD;
      if (held) support(&b, 0, 3), support(&b, 1, 2);
      run(&b, 4, held ? expected : least, held ? same : most);
    }
    for (int c = 0; c < 4; ++c)
      off = PetscMax(off, PetscMax(PetscAbsReal(least[c] - expected[c]), PetscAbsReal(most[c] - same[c])));
    PetscPrintf(PETSC_COMM_WORLD, "%s: stress xx %.6g to %.6g Pa, off by %.3g Pa\n", k ? "mpm" : "fem",
                (double)least[0], (double)most[0], (double)off);
    CHECK(off < (k ? 1e-3 : 1e-8) * (most[0] - least[0]), "off by %g Pa", (double)off);
  }
}

/* A bar with a lump at one of its corners turns under loads that do not turn with it: it is let go. Elastic, it does
 * not know in how many steps it was pulled; single points of mpm do, by the cells that they come to lie in. */
static void test_turns(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    PetscReal least[6], most[6], expected[6], same[6], off = 0;
    Bench b;
    for (int steps = 1; steps <= 4; steps += 3) {
      block(&b, k ? "mpm" : "fem", CELL_QUADRILATERAL);
      b.body[1] = b.body[0];
      b.body[1].name = "lump";
      b.c.n_bodies = 2;
      bench_box(&b, 1, (PetscReal[]){0, 0.5, 0}, (PetscReal[]){0.25, 0.625, 0});
      pull(&b, 5e4);
      b.c.analysis.unheld = UNHELD_HOLD;
      run(&b, steps, steps > 1 ? least : expected, steps > 1 ? most : same);
    }
    for (int c = 0; c < 4; ++c)
      off = PetscMax(off, PetscMax(PetscAbsReal(least[c] - expected[c]), PetscAbsReal(most[c] - same[c])));
    PetscPrintf(PETSC_COMM_WORLD, "%s: stress xx %.6g to %.6g Pa, off by %.3g Pa\n", k ? "mpm" : "fem",
                (double)least[0], (double)most[0], (double)off);
    CHECK(k || off < 1e-9 * most[0], "off by %g Pa", (double)off);
  }
}

/* Held at an end, it does not know of the key. */
static void test_held(void **state)
{
  PetscReal least[2][6], most[2][6];
  PetscMPIInt ranks;
  Bench b;
  (void)state;
  for (int k = 0; k < 2; ++k) {
    block(&b, "mpm", CELL_QUADRILATERAL);
    bench_motion(&b, 0, 0, MOTION_FIXED, 3);
    b.c.gravity[1] = -9.81;
    b.c.analysis.unheld = k ? UNHELD_HOLD : UNHELD_REFUSE;
    run(&b, 2, least[k], most[k]);
  }
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks); /* MUMPS adds up in the order in which ranks are ready */
  for (int c = 0; c < 6; ++c) {
    CHECK_CLOSE(least[0][c], least[1][c], ranks > 1 ? 1e-6 : 0);
    CHECK_CLOSE(most[0][c], most[1][c], ranks > 1 ? 1e-6 : 0);
  }
}

/* Two bodies apart, of which one is held; a hinge; a ring, which its hoop holds. */
static void test_parts(void **state)
{
  PetscReal least[6], most[6];
  Bench b;
  (void)state;
  block(&b, "mpm", CELL_QUADRILATERAL);
  bench_grid(&b, (PetscReal[]){-0.25, -0.25, 0}, (PetscReal[]){1.25, 2, 0}, 0.125);
  b.body[1] = b.body[0];
  b.body[1].name = "upper";
  b.c.n_bodies = 2;
  bench_box(&b, 1, (PetscReal[]){0, 1, 0}, (PetscReal[]){1, 1.5, 0});
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  bench_traction(&b, 0, 1, "upper", 2e4, 0, 0);
  bench_traction(&b, 0, 0, "upper", -2e4, 0, 0);
  b.c.analysis.unheld = UNHELD_HOLD;
  run(&b, 1, least, most);
  CHECK_CLOSE(least[0], 0, 1e-6 * 2e4); /* the one that stands */
  CHECK(most[0] > 1.8e4 && most[0] < 2.2e4, "%g Pa", (double)most[0]);
  block(&b, "fem", CELL_QUADRILATERAL);
  pull(&b, 2e4);
  bench_motion(&b, 0, 0, MOTION_FIXED, 3);
  b.motion[0].on.has[1] = PETSC_TRUE;
  b.motion[0].on.min[1] = b.motion[0].on.max[1] = 0.25;
  b.c.analysis.unheld = UNHELD_HOLD;
  run(&b, 1, least, most);
  CHECK_CLOSE(least[0], most[0], 1e-6 * 2e4);
  block(&b, "fem", CELL_QUADRILATERAL);
  b.c.kinematics = &kinematics_axisymmetric;
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 0.5, 0}, 0.125);
  bench_traction(&b, 1, 0.5, "body", 0, 2e4, 0);
  bench_traction(&b, 1, 0, "body", 0, -2e4, 0);
  b.c.analysis.unheld = UNHELD_HOLD;
  run(&b, 1, least, most);
  CHECK_CLOSE(least[1], most[1], 1e-6 * 2e4);
  CHECK_CLOSE(least[0], 0, 1e-6 * 2e4);
}

static void test_refused(void **state)
{
  Bench b;
  (void)state;
  block(&b, "mpm", CELL_QUADRILATERAL);
  b.c.analysis.unheld = UNHELD_HOLD;
  b.c.gravity[1] = -9.81;
  bench_refused(&b, PETSC_COMM_WORLD, "bodies[0]", "nothing holds 'body' in x and y and from turning, and loads push");
  block(&b, "fem", CELL_HEXAHEDRON); /* a couple */
  b.c.analysis.unheld = UNHELD_HOLD;
  bench_traction(&b, 0, 1, "body", 0, 1e3, 0);
  bench_traction(&b, 0, 0, "body", 0, -1e3, 0);
  bench_refused(&b, PETSC_COMM_WORLD, "bodies[0]", "loads push it that way: ");
  block(&b, "mpm", CELL_QUADRILATERAL);
  b.c.analysis.unheld = UNHELD_HOLD;
  bench_dynamic(&b, 1, 0.1);
  bench_refused(&b, PETSC_COMM_WORLD, "analysis.unheld", "hold is for type static");
  block(&b, "fem", CELL_QUADRILATERAL); /* dead loads that press it turn it: not the answer */
  b.c.analysis.unheld = UNHELD_REFUSE;
  pull(&b, 1e3);
  bench_refused(&b, PETSC_COMM_WORLD, "bodies[0]", "analysis: {unheld: hold}");
}

/* Warnings after a block of rubber has settled by its weight on a floor that does not rub, at one or two such walls. */
static PetscInt settle(const char *method, PetscInt sides)
{
  WallSpec walls[3] = {{.name = (char *)"floor", .shape = {.kind = SHAPE_HALF_SPACE, .normal = {0, 1}}},
                       {.name = (char *)"left", .shape = {.kind = SHAPE_HALF_SPACE, .normal = {1}}},
                       {.name = (char *)"right", .shape = {.kind = SHAPE_HALF_SPACE, .point = {1}, .normal = {-1}}}};
  Bench b;
  Diag *diag;
  StepReport report;
  block(&b, method, CELL_QUADRILATERAL);
  if (!strcmp(method, "fem")) bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 0.5, 0}, 0.125);
  b.c.gravity[1] = -40;
  b.c.n_walls = 1 + sides;
  b.c.walls = walls;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  do CALL(ModelStep(m, 0.25, &report));
  while (report.outcome == STEP_ACCEPTED && m->time < 1 - 1e-9);
  CALL(DiagCreate(&diag));
  if (report.outcome == STEP_ACCEPTED) CALL(ModelWarnLoose(m, diag));
  const PetscInt found = report.outcome == STEP_ACCEPTED ? diag_warnings(diag) : -1;
  CALL(DiagDestroy(&diag));
  CALL(ModelDestroy(&m));
  return found;
}

/* A pressure all round a block, or a disk, that fit no lines of the grid, in steps: it bears just that pressure, and
 * what its surface's parts leave out of balance as they come to overlap and gape is no push. */
static void test_pressed_round(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    const PetscReal p = 1e5, within = k ? 0.12 * p : 1e-3 * p; /* five cells of a disk */
    PetscReal least[6], most[6];
    Bench b;
    block(&b, "mpm", CELL_QUADRILATERAL);
    b.c.basis.kind = "gimp";
    bench_box(&b, 0, (PetscReal[]){0.03, 0.02, 0}, (PetscReal[]){0.97, 0.47, 0});
    if (k) b.body[0].shape = (Shape){.kind = SHAPE_BALL, .centre = {0.47, 0.24}, .radius = 0.31};
    b.c.n_loads = 1;
    b.load[0] = (LoadSpec){.kind = LOAD_PRESSURE, .value = {p}};
    b.load[0].on.body = (char *)"body";
    b.c.analysis.unheld = UNHELD_HOLD;
    run(&b, 4, least, most);
    PetscPrintf(PETSC_COMM_WORLD, "pressed round, %s: %.9g to %.9g, %.9g to %.9g, shear %.3g\n", k ? "disk" : "block",
                (double)least[0], (double)most[0], (double)least[1], (double)most[1], (double)(most[3] - least[3]));
    for (int i = 0; i < 2; ++i) {
      CHECK_CLOSE(least[i], -p, within);
      CHECK_CLOSE(most[i], -p, within);
    }
  }
}

/* A wall that only pushes counts as one that holds; what it has pushed away is told. The block's lower corner ends at
 * the wall with a force of round-off, which says nothing. */
static void test_leaves(void **state)
{
  (void)state;
  const PetscInt one = settle("fem", 1), two = settle("fem", 2), grid = settle("mpm", 2);
  CHECK(one == 1 && two == 0 && grid == 0, "%d, %d and %d warnings", (int)one, (int)two, (int)grid);
}

/* A block, or a ring, that is drawn out between two smooth plates comes off both: what is left of their forces is
 * round-off, and which of the two it would be above hangs on the order of sums. */
static void test_comes_off(void **state)
{
  static const char *const bases[] = {"cell", "gimp", "bspline"};
  WallSpec walls[2] = {
    {.name = (char *)"floor", .shape = {.kind = SHAPE_HALF_SPACE, .point = {0, 0.07}, .normal = {0, 1}}},
    {.name = (char *)"lid", .shape = {.kind = SHAPE_HALF_SPACE, .point = {0, 0.33}, .normal = {0, -1}}}};
  StepReport report;
  Bench b;
  Diag *diag;
  (void)state;
  for (int k = 0; k < 6; ++k) {
    block(&b, "mpm", CELL_QUADRILATERAL);
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1.25, 0.5, 0}, 0.125);
    bench_box(&b, 0, (PetscReal[]){0, 0.07, 0}, (PetscReal[]){0.97, 0.33, 0});
    b.c.basis.kind = (char *)bases[k / 2];
    if (k % 2) b.c.kinematics = &kinematics_axisymmetric;
    bench_motion(&b, 0, 0, MOTION_FIXED, 1);
    bench_traction(&b, 0, 0.97, "body", 1e3, 0, 0);
    b.c.n_walls = 2;
    b.c.walls = walls;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    CALL(ModelStep(m, 1, &report));
    CHECK(report.outcome == STEP_ACCEPTED, "%s: it is drawn out", bases[k / 2]);
    CALL(DiagCreate(&diag));
    CALL(ModelWarnLoose(m, diag));
    CHECK(diag_warnings(diag) == 1, "%s, %d: %d warnings", bases[k / 2], k % 2, (int)diag_warnings(diag));
    CALL(DiagDestroy(&diag));
    CALL(ModelDestroy(&m));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_pulled), cmocka_unit_test(test_bent),      cmocka_unit_test(test_turns),
    cmocka_unit_test(test_held),   cmocka_unit_test(test_parts),     cmocka_unit_test(test_refused),
    cmocka_unit_test(test_leaves), cmocka_unit_test(test_comes_off), cmocka_unit_test(test_pressed_round),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
