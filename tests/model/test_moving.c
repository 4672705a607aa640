/* Prescribed motion whose place takes part in it: rigid bodies that go through a grid which is
 * restored every step. */
#include "case_builder.h"

/* A place that holds all of the material carries it rigidly, over many cells; one that stays would
 * press it out. */
static void test_carried(void **state)
{
  (void)state;
  for (int turning = 0; turning < 2; ++turning) {
    Bench b;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 2, 0}, 0.125);
    bench_box(&b, 0, (PetscReal[]){1.25, 0.75, 0}, (PetscReal[]){1.75, 1.25, 0});
    b.c.analysis.step = b.c.analysis.largest = 1. / 16;
    MotionSpec *motion = bench_motion(&b, 0, 0, turning ? MOTION_ROTATION : MOTION_VELOCITY, 3);
    motion->moves = PETSC_TRUE;
    motion->on.min[0] = 1.05, motion->on.max[0] = 1.95; /* a cell and more around the body */
    motion->on.has[1] = PETSC_TRUE, motion->on.min[1] = 0.55, motion->on.max[1] = 1.45;
    motion->value[0] = -1, motion->value[1] = 0.25;
    motion->centre[0] = motion->centre[1] = 1, motion->rate = 2;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    while (m->time < 1 - 1e-9) model_step(m, 1 - m->time);
    for (PetscInt p = 0; p < m->points->n; ++p) {
      const PetscReal *x = point_real(m->points, POINT_X, p), *u = point_real(m->points, POINT_U, p);
      const PetscReal X = x[0] - u[0] - 1, Y = x[1] - u[1] - 1; /* about the centre */
      const PetscReal to[2] = {turning ? X * cos(2) - Y * sin(2) : X - 1, turning ? X * sin(2) + Y * cos(2) : Y + 0.25};
      for (int d = 0; d < 2; ++d) CHECK_CLOSE(x[d] - 1, to[d], 1e-9);
    }
    CALL(ModelDestroy(&m));
  }
}

static PetscReal reaction(Model *m)
{
  const MeasureSpec measure = {.kind = "reaction", .component = 1, .boundary = 3};
  PetscReal value;
  CALL(ModelMeasure(m, &measure, 0, &value));
  return value;
}

/* A plate presses a column in a box to 0.7 of its height, through two rows of nodes and a half: the
 * force is that of uniform compression, but for the cell that is stiff since the plate's underside
 * cuts it, and for what sampling by moving points loses. */
static void test_pressed(void **state)
{
  const PetscReal width = 0.25, shortest = 0.7;
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_QUADRILATERAL; ++cell) {
    Bench b;
    bench_init(&b, "mpm", cell, 0);
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){width, 1.25, 0}, 0.125);
    bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){width, 1, 0});
    b.c.analysis.step = b.c.analysis.largest = 1. / 64;
    bench_motion(&b, 0, 0, MOTION_FIXED, 1);
    bench_motion(&b, 0, width, MOTION_FIXED, 1);
    bench_motion(&b, 1, 0, MOTION_FIXED, 2);
    MotionSpec *plate = bench_motion(&b, 1, 1, MOTION_DISPLACEMENT, 2);
    b.body[0].points_per_cell =
      /* fewer leave cells unevenly filled, which softens the column */
      cell == CELL_TRIANGLE ? 12 : 16;
    plate->moves = PETSC_TRUE;
    /* the cell that its underside cuts, too */
    plate->on.min[1] = 1 - 0.125 + 1e-6, plate->on.max[1] = 1.2;
    plate->value[1] = shortest - 1;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    while (m->time < 1 - 1e-9) {
      PetscReal sigma[6];
      model_step(m, 1 - m->time);
      rubber_stress((PetscReal[]){1, 0, 0, 0, 1 - (1 - shortest) * m->time, 0, 0, 0, 1}, sigma);
      CHECK_CLOSE(reaction(m) / (width * sigma[1]), 1, 0.12);
    }
    CALL(ModelDestroy(&m));
  }
}

/* A plate that comes down on a held floor: where both prescribe a node, the entry that stands first
 * does. */
static void test_first_entry_holds(void **state)
{
  (void)state;
  for (int floor = 0; floor < 2; ++floor) { /* its number */
    Bench b;
    PetscReal *increment;
    PetscInt met = 0, all;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 8);
    if (floor == 0) bench_motion(&b, 1, 0, MOTION_FIXED, 3);
    MotionSpec *plate = bench_motion(&b, 1, 0.5, MOTION_VELOCITY, 3);
    plate->moves = PETSC_TRUE;
    plate->on.max[1] = 0.6;
    plate->value[0] = 0.5, plate->value[1] = -1;
    if (floor == 1) bench_motion(&b, 1, 0, MOTION_FIXED, 3);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    CALL(BoundaryMove(m->boundary, m->grid, 0.55)); /* from -0.05 to 0.05 now */
    CALL(PetscCalloc1(2 * m->grid->n_nodes, &increment));
    boundary_increments(m->boundary, m->grid, 0.55, 0.65, increment);
    for (PetscInt i = 0; i < m->grid->n_nodes; ++i) {
      if (m->grid->x[2 * i + 1] > 1e-9) continue;
      ++met;
      CHECK_CLOSE(increment[2 * i], floor ? 0.05 : 0, 1e-15);
      CHECK_CLOSE(increment[2 * i + 1], floor ? -0.1 : 0, 1e-15);
    }
    CALL(MPI_Allreduce(&met, &all, 1, MPIU_INT, MPI_SUM, m->comm));
    CHECK(all >= 9, "they do not meet");
    CALL(PetscFree(increment));
    CALL(ModelDestroy(&m));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_pressed),
    cmocka_unit_test(test_carried),
    cmocka_unit_test(test_first_entry_holds),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
