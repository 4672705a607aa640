/* A body that a stage, or a case that begins with the state of another run, brings onto ground of fem that has moved:
 * it fills its cells as they are then, with its density, so that its lowest row bears what statics alone says, whatever
 * the stiffness: the weight of half of it. Where the ground has left no room for it that is said. */
#include "case_builder.h"
#include "model/stage/stage.h"
#include "model/state/state.h"

#define ROW 0.25 /* of cells, m; three of ground, and one that comes */
#define DRAWN 0.75

static char *const sides[] = {"ground", "fill"};

static void column(Bench *b, const char *method, CellType cell, const Kinematics *kinematics, const char *formulation,
                   PetscReal gravity)
{
  bench_init(b, method, cell, 4);
  b->c.kinematics = kinematics;
  b->c.formulation = (char *)formulation;
  b->c.n_bodies = 2;
  b->body[1] = b->body[0];
  for (int k = 0; k < 2; ++k) {
    b->body[k].name = sides[k];
    b->body[k].shape.min[1] = k * DRAWN;
    b->body[k].shape.max[1] = k ? 1 : DRAWN;
  }
  b->c.gravity[1] = gravity;
  bench_motion(b, 1, 0, MOTION_FIXED, 2);
  for (int d = 0; d < kinematics_dim(kinematics); d += 2)
    for (int k = 0; k < 2; ++k) bench_motion(b, d, k, MOTION_FIXED, 1u << d);
}

static void both(Bench *first, Bench *then, const char *method, CellType cell, const Kinematics *kinematics,
                 const char *formulation, PetscReal gravity)
{
  column(first, method, cell, kinematics, formulation, gravity);
  first->body[1].absent = PETSC_TRUE;
  column(then, method, cell, kinematics, formulation, gravity);
}

/* The second case from the state of the first: as its next stage, or as a run of its own. What that says. */
static char *go_on(Bench *then, PetscBool next, Model **m)
{
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  Imbalance imbalance;
  PetscInt errors;
  Diag *diag;
  CALL(DiagCreate(&diag));
  CALL(DiagSetResolver(diag, show_path, NULL));
  if (next) {
    then->c.stage = (*m)->c->stage + 1;
    then->c.start = (PetscReal)then->c.stage;
    then->c.analysis.end = then->c.start + 1;
    CALL(ModelSucceed(&then->c, diag, m, &imbalance));
  } else {
    Model *before = *m;
    Tables *tables;
    CALL(TablesCreate(&tables));
    CALL(ModelToTables(before, tables));
    *m = bench_model(then, PETSC_COMM_WORLD);
    CALL(ModelTake(*m, tables, before->c, NULL, diag, &imbalance));
    CALL(TablesDestroy(&tables));
    CALL(ModelDestroy(&before));
  }
  CALL(DiagReduce(PETSC_COMM_WORLD, diag, &errors));
  CALL(DiagFlush(diag, out));
  fclose(out);
  CALL(DiagDestroy(&diag));
  return text;
}

/* Of the fill: mass, volume, mean vertical stress. */
static void fill_of(const Model *m, PetscReal sum[3])
{
  PetscReal local[3] = {0, 0, 0};
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal volume = m->points->real[POINT_VOLUME][p];
    if (m->points->body[p] != 1) continue;
    local[0] += m->points->real[POINT_MASS][p];
    local[1] += volume * m->points->real[POINT_J][p];
    local[2] += volume * point_real(m->points, POINT_TAU, p)[1];
  }
  CALL(MPI_Allreduce(local, sum, 3, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  sum[2] /= sum[1];
}

/* The volume of the cells above the ground, of quadrilaterals or hexahedra under an even top the rest of the column. */
static PetscReal room_of(const Model *m)
{
  const Grid *grid = m->grid;
  PetscReal local = 0, all, x[CELL_MAX_NODES * 3];
  for (PetscInt k = 0; k < grid->n_cells; ++k) {
    PetscBool above = PETSC_FALSE;
    grid_cell_x(grid, k, x);
    for (PetscInt i = 0; i < grid->nodes_per_cell; ++i) above |= x[i * m->dim + 1] > 0.99;
    if (above) local += cell_volume_in(m->c->kinematics, grid_cell_type(grid, k), x);
  }
  CALL(MPI_Allreduce(&local, &all, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  return all;
}

static PetscReal measured(Model *m, const char *kind, const char *word)
{
  const MeasureSpec measure = {.kind = (char *)kind, .word = (char *)word, .component = 1};
  PetscReal value;
  CALL(ModelMeasure(m, &measure, 0, &value));
  return value;
}

/* Under gravity g; where it is negative the ground has risen. */
static void stands_right(CellType cell, const Kinematics *kinematics, const char *formulation, PetscBool next,
                         PetscReal g)
{
  const PetscReal section = kinematics == &kinematics_axisymmetric ? PETSC_PI : 1;
  const PetscBool even = cell == CELL_QUADRILATERAL || cell == CELL_HEXAHEDRON;
  Bench first, then;
  PetscReal fill[3];
  both(&first, &then, "fem", cell, kinematics, formulation, -g);
  Model *m = bench_model(&first, PETSC_COMM_WORLD);
  for (int k = 0; k < 4; ++k) model_step(m, 0.25);
  char *said = go_on(&then, next, &m);
  CHECK(m && !said[0], "it says %s", said);
  free(said);
  const PetscReal room = room_of(m), mass = 1000 * room;
  CHECK(PetscAbsReal(room - ROW * section) > 0.1 * ROW * section, "the ground has hardly moved: %g m3", (double)room);
  fill_of(m, fill);
  CHECK_CLOSE(fill[0], mass, 1e-9 * mass);
  CHECK_CLOSE(fill[1], room, 1e-12);
  for (int k = 0; k < 4; ++k) model_step(m, 0.25);
  fill_of(m, fill);
  if (even) CHECK_CLOSE(fill[2], -0.5 * g * mass / section, 1e-9 * PetscAbsReal(g) * mass);
  const PetscReal all = 1000 * DRAWN * section + mass;
  CHECK_CLOSE(measured(m, "mass", "total"), all, 1e-9 * all);
  CHECK_CLOSE(measured(m, "reaction", NULL), g * all, 1e-9 * PetscAbsReal(g) * all);
  CALL(ModelDestroy(&m));
}

static void test_moved(void **state)
{
  static const struct {
    CellType cell;
    const Kinematics *kinematics;
    const char *formulation;
    PetscBool next;
    PetscReal g;
  } variants[] = {{CELL_QUADRILATERAL, &kinematics_plane_strain, "displacement", PETSC_TRUE, 150},
                  {CELL_TRIANGLE, &kinematics_axisymmetric, "displacement", PETSC_TRUE, 150},
                  {CELL_HEXAHEDRON, &kinematics_3d, "mean-dilatation", PETSC_TRUE, 150},
                  {CELL_QUADRILATERAL, &kinematics_axisymmetric, "mean-dilatation", PETSC_FALSE, 150},
                  {CELL_TRIANGLE, &kinematics_plane_strain, "mixed", PETSC_TRUE, 150},
                  {CELL_QUADRILATERAL, &kinematics_plane_strain, "mean-dilatation", PETSC_TRUE, -140},
                  {CELL_TETRAHEDRON, &kinematics_3d, "displacement", PETSC_FALSE, 150}};
  (void)state;
  EACH_OF (k, variants)
    stands_right(variants[k].cell, variants[k].kinematics, variants[k].formulation, variants[k].next, variants[k].g);
}

/* A fill that was there, went down with its ground and was taken away is as large when it comes again as the ground
 * leaves room for, which has come back to what it has alone: its own nodes are where they were drawn. */
static void comes_again(CellType cell, const Kinematics *kinematics, const char *formulation)
{
  Bench stage[4];
  PetscReal first[3], again[3];
  for (int k = 0; k < 4; ++k) {
    column(stage + k, "fem", cell, kinematics, formulation, -150);
    stage[k].body[1].absent = (PetscBool) !(k & 1);
  }
  Model *m = bench_model(stage, PETSC_COMM_WORLD);
  for (int k = 0; k < 4; ++k) {
    char *said = k ? go_on(stage + k, PETSC_TRUE, &m) : NULL;
    CHECK(m && (!k || !said[0]), "it says %s", said);
    free(said);
    if (k == 1) fill_of(m, first);
    if (k == 3) fill_of(m, again);
    for (int step = 0; step < 4 && k < 3; ++step) model_step(m, 0.25);
  }
  CHECK(first[0] > 1100 * ROW, "the ground has hardly moved: %g kg", (double)first[0]);
  CHECK_CLOSE(again[0], first[0], 1e-6 * first[0]);
  CHECK_CLOSE(again[1], first[1], 1e-6 * first[1]);
  CALL(ModelDestroy(&m));
}

static void test_again(void **state)
{
  (void)state;
  comes_again(CELL_QUADRILATERAL, &kinematics_plane_strain, "mean-dilatation");
  comes_again(CELL_TRIANGLE, &kinematics_plane_strain, "mixed");
}

/* Ground that has risen by more than a cell. */
static void test_heaved(void **state)
{
  Bench first, then;
  PetscMPIInt rank;
  (void)state;
  both(&first, &then, "fem", CELL_QUADRILATERAL, &kinematics_plane_strain, "displacement", 1200);
  Model *m = bench_model(&first, PETSC_COMM_WORLD);
  for (int k = 0; k < 8; ++k) model_step(m, 0.125);
  char *said = go_on(&then, PETSC_TRUE, &m);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (!rank)
    CHECK(strstr(said, "bodies[1].shape") && strstr(said, "error: there is no room left for 'fill' in its cell at ("),
          "it says %s", said);
  free(said);
  CALL(ModelDestroy(&m));
}

/* What is said of points of mpm, whose shape begins `by` above where it was drawn, on ground under gravity g,
 * upwards where that is negative. */
static void says(PetscReal g, PetscReal by, const char *words)
{
  Bench first, then;
  PetscMPIInt rank;
  both(&first, &then, "mpm", CELL_QUADRILATERAL, &kinematics_plane_strain, "displacement", -g);
  then.body[1].shape.min[1] += by;
  then.c.gravity[1] = -PetscAbsReal(g);
  Model *m = bench_model(&first, PETSC_COMM_WORLD);
  for (int k = 0; k < 4; ++k) model_step(m, 0.25);
  char *said = go_on(&then, PETSC_TRUE, &m);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (!rank && words) CHECK(strstr(said, "bodies[1].shape") && strstr(said, words), "no '%s' in: %s", words, said);
  if (!rank && !words) CHECK(!said[0], "it says %s", said);
  free(said);
  CALL(ModelDestroy(&m));
}

/* 0.75 m of ground settle by about 1000 kg/m3 g (0.75 m)^2 / 2 over 1.35 MPa: an eighth of a cell. */
static void test_gaps(void **state)
{
  (void)state;
  says(150, 0, "warning: 'fill' begins 0.03");
  says(150, 0, "above what it stands on, in the middle of its foot");
  says(150, 0, "let its shape begin where the ground is now, at y = 0.72");
  says(150, -0.03, NULL);
  says(20, 0, NULL);
  says(-150, 0, "inside what it stands on");
}

/* A wedge on a slope, and a block beside a face, of stiff ground that does not move: nothing is said, whatever the
 * cells. */
static void test_slopes(void **state)
{
  static const CellType types[] = {CELL_QUADRILATERAL, CELL_TRIANGLE};
  (void)state;
  EACH_OF (k, types)
    for (int face = 0; face < 2; ++face) {
      PetscReal ground[] = {0, 0, 1, 0, 1, 0.1, 0.55, 0.1, 0.2, 0.9, 0, 0.9};
      PetscReal fill[] = {1, 0.1, 1, 0.9, 0.2, 0.9, 0.55, 0.1};
      Bench first, then;
      if (face) ground[6] = fill[6] = ground[8] = fill[4] = 0.43;
      both(&first, &then, "mpm", types[k], &kinematics_plane_strain, "displacement", -0.1);
      for (int side = 0; side < 2; ++side) {
        Bench *b = side ? &then : &first;
        b->c.grid.counts[0] = b->c.grid.counts[1] = 12;
        b->body[0].shape = (Shape){.kind = SHAPE_POLYGON, .n_vertices = 6, .vertices = ground};
        b->body[1].shape = (Shape){.kind = SHAPE_POLYGON, .n_vertices = 4, .vertices = fill};
      }
      Model *m = bench_model(&first, PETSC_COMM_WORLD);
      model_step(m, 1);
      char *said = go_on(&then, PETSC_TRUE, &m);
      CHECK(m && !said[0], "it says %s", said);
      free(said);
      CALL(ModelDestroy(&m));
    }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_moved), cmocka_unit_test(test_again),
                                     cmocka_unit_test(test_heaved), cmocka_unit_test(test_gaps),
                                     cmocka_unit_test(test_slopes)};
  return run_model_tests(argc, argv, tests);
}
