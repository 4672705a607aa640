/* The same answers on one rank and on many: every rank computes the case alone (PETSC_COMM_SELF)
 * and together with the others, and compares all its points by id, and the measures. */
#include "case_builder.h"

/* what is thrown flies with 3 m/s */
static const struct {
  PointReal field;
  const char *name;
  PetscReal scale;
} fields[] = {{POINT_X, "x", 1}, {POINT_U, "u", 1}, {POINT_V, "v", 3}, {POINT_F, "F", 1}, {POINT_STATE, "state", 1}};

static void compare(const Model *together, const Model *alone)
{
  for (size_t k = 0; k < sizeof fields / sizeof *fields; ++k) {
    const PetscReal off = points_difference(together, alone, fields[k].field);
    CHECK(off <= 1e-9 * fields[k].scale, "%s is off by %g at step %d", fields[k].name, (double)off,
          (int)together->step);
  }
}

static void compare_measures(Bench *b, Model *together, Model *alone)
{
  static const char *const sums[] = {"mass: total", "momentum", "energy: kinetic", "energy: elastic",
                                     "energy: external"};
  PetscReal v[2];
  for (PetscInt k = 0; k < b->c.n_measures; ++k) {
    CALL(ModelMeasure(together, &b->measure[k], k, &v[0]));
    CALL(ModelMeasure(alone, &b->measure[k], k, &v[1]));
    CHECK_CLOSE(v[0], v[1], 1e-9 * (1 + PetscAbsReal(v[1])));
  }
  for (size_t k = 0; k < sizeof sums / sizeof *sums; ++k) {
    v[0] = model_sum(together, sums[k], 1);
    v[1] = model_sum(alone, sums[k], 1);
    CHECK_CLOSE(v[0], v[1], 1e-9 * (1 + PetscAbsReal(v[1])));
  }
}

/* Returns how many points changed their rank, as far as the numbers of points tell. */
static PetscInt run_both(Bench *b, PetscInt steps)
{
  Model *together = bench_model(b, PETSC_COMM_WORLD), *alone = bench_model(b, PETSC_COMM_SELF);
  PetscInt moved = together->points->n, all;
  for (PetscInt s = 0; s < steps; ++s) {
    const StepReport r = model_step(together, PETSC_MAX_REAL), q = model_step(alone, PETSC_MAX_REAL);
    CHECK(r.cuts == q.cuts && r.dt == q.dt, "steps of %g and %g s", (double)r.dt, (double)q.dt);
  }
  compare(together, alone);
  compare_measures(b, together, alone);
  moved = PetscAbsInt(moved - together->points->n);
  CALL(MPI_Allreduce(&moved, &all, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  CALL(ModelDestroy(&together));
  CALL(ModelDestroy(&alone));
  return all;
}

static const char *formulation = "displacement"; /* of all that follows */

/* A bar 4 m long held at x = 0, bent by gravity; its tip carries a traction and a point force, and
 * is followed. */
static void cantilever(const char *method, const char *basis, CellType cell, PetscReal size)
{
  Bench b;
  bench_init(&b, method, cell, 0);
  bench_grid(&b, (PetscReal[]){0, -1, 0}, (PetscReal[]){4.5, 1.5, 1}, size);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 1});
  b.c.formulation = (char *)formulation;
  b.c.basis.kind = basis;
  b.c.gravity[1] = -0.5;
  b.c.analysis.step = b.c.analysis.largest = 0.5;
  bench_motion(&b, 0, 0, MOTION_FIXED, 7);
  bench_traction(&b, 0, 4, "body", 300, -100, 0);
  b.load[b.c.n_loads++] = (LoadSpec){.kind = LOAD_POINT, .at = {2, 0.5, 0.5}, .value = {0, -100, 0}};
  bench_tracer(&b, "displacement", 1, 4, 0.5, 0.5);
  bench_tracer(&b, "displacement", 0, 4, 0.5, 0.5);
  b.measure[b.c.n_measures++] = (MeasureSpec){.name = "reaction", .kind = "reaction", .component = 1};
  run_both(&b, 2);
}

static void test_cantilever(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    const char *method = k ? "fem" : "mpm";
    cantilever(method, "cell", CELL_QUADRILATERAL, 0.25);
    cantilever(method, "cell", CELL_TRIANGLE, 0.25);
    cantilever(method, "cell", CELL_HEXAHEDRON, 0.5);
    cantilever(method, "cell", CELL_TETRAHEDRON, 0.5);
  }
  cantilever("mpm", "gimp", CELL_QUADRILATERAL, 0.25);
  cantilever("mpm", "gimp", CELL_HEXAHEDRON, 0.5);
  cantilever("mpm", "bspline", CELL_QUADRILATERAL, 0.25);
  cantilever("mpm", "bspline", CELL_HEXAHEDRON, 0.5);
}

/* A block thrown at a floor with some spin; on its way it crosses the borders of the ranks'
 * parts. */
static void thrown_block(const char *basis, const char *transfer, CellType cell, PetscReal size, LinearChoice linear,
                         PetscInt steps)
{
  Bench b;
  PetscMPIInt ranks;
  bench_init(&b, "mpm", cell, 0);
  b.c.basis.kind = basis;
  b.c.formulation = (char *)formulation;
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1.5, 1}, size);
  bench_box(&b, 0, (PetscReal[]){0.25, 0.25, 0.25}, (PetscReal[]){0.75, 0.75, 0.75});
  b.body[0].velocity[0] = 2.5;
  b.body[0].velocity[1] = -2;
  /* whichever way space is cut */
  if (cell == CELL_HEXAHEDRON || cell == CELL_TETRAHEDRON) b.body[0].velocity[2] = 0.6;
  b.body[0].spin[2] = 0.5;
  b.body[0].spin_centre[0] = b.body[0].spin_centre[1] = 0.5;
  b.c.gravity[1] = -9.81;
  b.c.linear = linear;
  b.c.analysis.transfer = (char *)transfer;
  if (strcmp(basis, "cell") != 0 && !strcmp(transfer, "consistent")) {
    b.c.analysis.scheme = (char *)"midpoint";
    b.c.stabilisation = (StabilisationSpec){.curvature = 0.1, .follow = 0.02};
  }
  bench_dynamic(&b, 1, 0.005);
  bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  bench_tracer(&b, "position", 0, 0.5, 0.5, 0.5);
  b.measure[b.c.n_measures++] = (MeasureSpec){.name = "reaction", .kind = "reaction", .component = 1};
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  const PetscInt moved = run_both(&b, ranks > 2 ? steps / 2 : steps); /* three parts meet sooner */
  CHECK(ranks == 1 || moved > 0, "no point changed its rank");
}

static void test_thrown_block(void **state)
{
  (void)state;
  thrown_block("cell", "thesis", CELL_QUADRILATERAL, 0.125, LINEAR_DIRECT, 80);
  thrown_block("cell", "thesis", CELL_TRIANGLE, 0.125, LINEAR_AUTO, 80);
  thrown_block("cell", "thesis", CELL_HEXAHEDRON, 0.25, LINEAR_DIRECT, 60);
  thrown_block("cell", "thesis", CELL_TETRAHEDRON, 0.25, LINEAR_AUTO, 60);
  thrown_block("cell", "consistent", CELL_QUADRILATERAL, 0.125, LINEAR_AUTO, 50);
  thrown_block("cell", "consistent", CELL_HEXAHEDRON, 0.25, LINEAR_AUTO, 60);
  thrown_block("gimp", "thesis", CELL_QUADRILATERAL, 0.125, LINEAR_AUTO, 80);
  thrown_block("gimp", "thesis", CELL_HEXAHEDRON, 0.25, LINEAR_DIRECT, 60);
  thrown_block("gimp", "consistent", CELL_QUADRILATERAL, 0.125, LINEAR_DIRECT, 50);
  thrown_block("bspline", "thesis", CELL_QUADRILATERAL, 0.125, LINEAR_AUTO, 50);
}

/* fem: a block that stands on a floor and is pushed. */
static void swaying_block(CellType cell, PetscReal size)
{
  Bench b;
  bench_init(&b, "fem", cell, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 2, 1}, size);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 2, 1});
  b.c.formulation = (char *)formulation;
  b.body[0].velocity[0] = 1;
  b.c.gravity[1] = -9.81;
  bench_dynamic(&b, 1, 0.01);
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  bench_tracer(&b, "position", 0, 1, 2, 1);
  run_both(&b, 15);
}

static void test_swaying_block(void **state)
{
  (void)state;
  swaying_block(CELL_QUADRILATERAL, 0.125);
  swaying_block(CELL_TRIANGLE, 0.25);
  swaying_block(CELL_HEXAHEDRON, 0.5);
  swaying_block(CELL_TETRAHEDRON, 0.5);
}

/* Cells that share their volume among points of several ranks would be wrong; none do. */
static void test_shared_volume(void **state)
{
  (void)state;
  formulation = "mean-dilatation";
  for (int k = 0; k < 2; ++k) {
    cantilever(k ? "fem" : "mpm", "cell", CELL_QUADRILATERAL, 0.25);
    cantilever(k ? "fem" : "mpm", "cell", CELL_HEXAHEDRON, 0.5);
  }
  thrown_block("cell", "thesis", CELL_QUADRILATERAL, 0.125, LINEAR_AUTO, 80);
  thrown_block("cell", "consistent", CELL_QUADRILATERAL, 0.125, LINEAR_AUTO, 50);
  thrown_block("cell", "thesis", CELL_HEXAHEDRON, 0.25, LINEAR_AUTO, 60);
  swaying_block(CELL_QUADRILATERAL, 0.125);
  formulation = "displacement";
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_thrown_block),
    cmocka_unit_test(test_swaying_block),
    cmocka_unit_test(test_shared_volume),
    cmocka_unit_test(test_cantilever),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
