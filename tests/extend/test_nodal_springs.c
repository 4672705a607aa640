/* A heavy block on springs settles by W / (n k), in steps, through a checkpoint, and on several
 * ranks. */
#include "../model/case_builder.h"
#include "model/state/state.h"

enum { CELLS = 4 };
#define STIFFNESS 1e5
#define WEIGHT 9810

static void make_case(Bench *b, CellType cell, char *options[3])
{
  bench_init(b, "fem", cell, CELLS);
  b->constants[0].value = 1e8; /* all but rigid */
  b->c.newton.residual = 1e-10;
  b->c.gravity[kinematics_dim(b->c.kinematics) - 1] = -9.81;
  b->c.analysis.step = b->c.analysis.largest = 0.5;
  bench_motion(b, 0, 0, MOTION_FIXED, 1);
  if (cell >= CELL_TETRAHEDRON) bench_motion(b, 1, 0, MOTION_FIXED, 2);
  b->c.n_petsc = 3;
  b->c.petsc = options;
}

/* How far the nodes of the bottom have come down in the mean; the mesh moves with them. */
static PetscReal settlement(const Model *m, PetscInt springs)
{
  PetscReal sum = 0, all;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    const PetscReal height = m->grid->x[(node + 1) * m->dim - 1];
    if (height < 0.5 / CELLS) sum -= height;
  }
  CALL(MPI_Allreduce(&sum, &all, 1, MPIU_REAL, MPI_SUM, m->comm));
  return all / (PetscReal)springs;
}

static void half_step(Model *m)
{
  StepReport report;
  CALL(ModelStep(m, 1, &report));
  CHECK(report.outcome == STEP_ACCEPTED && report.cuts == 0, "%s", report.reason);
  CHECK(report.newton.iterations <= 3, "%d iterations", (int)report.newton.iterations);
}

/* The other half of the load on a model that knows the first from tables. */
static Model *continued(Bench *b, Model *m)
{
  Tables *tables;
  char reason[256];
  CALL(TablesCreate(&tables));
  Model *next = bench_model(b, PETSC_COMM_WORLD);
  CALL(ModelToTables(m, tables));
  CALL(ModelFromTables(next, tables, reason));
  CHECK(!reason[0], "%s", reason);
  CALL(TablesDestroy(&tables));
  CALL(ModelDestroy(&m));
  return next;
}

static void test_settlement(void **state)
{
  static char *const places[] = {"-springs_on bottom", "-springs_on front"};
  PetscMPIInt ranks;
  (void)state;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell)
    for (int again = 0; again < 3; ++again) { /* straight on, through a checkpoint, on a plate */
      const int is_3d = cell >= CELL_TETRAHEDRON;
      const PetscInt springs = is_3d ? (CELLS + 1) * (CELLS + 1) : CELLS + 1;
      const PetscReal settles = WEIGHT / (STIFFNESS * (PetscReal)springs);
      char *options[] = {places[is_3d], "-springs_stiffness 1e5",
                         again == 2 && ranks == 1 ? "-springs_plate true" : "-springs_plate false"};
      Energies e;
      Bench b;
      make_case(&b, cell, options);
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      half_step(m);
      CHECK_CLOSE(settlement(m, springs), settles / 2, 1e-10 * settles);
      if (again == 1) m = continued(&b, m);
      half_step(m);
      CHECK_CLOSE(settlement(m, springs), settles, 1e-10 * settles);
      /* gravity's work went into the springs, but for what the block keeps */
      CALL(ModelEnergies(m, &e));
      CHECK_CLOSE(e.external, e.elastic, 1e-6 * WEIGHT * settles);
      CALL(ModelDestroy(&m));
    }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_settlement)};
  return run_model_tests(argc, argv, tests);
}
