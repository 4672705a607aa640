/* Loads on sides of cells: what ends within a side, or stands beside no material, is told. */
#include "case_builder.h"

/* On the upper side, from x = `from` on. */
static LoadSpec *on_top(Bench *b, const char *body, PetscReal from)
{
  LoadSpec *load = bench_traction(b, 1, 1, body, 0, -1000, 0);
  load->on.has[0] = PETSC_TRUE;
  load->on.min[0] = from, load->on.max[0] = 1.1;
  return load;
}

static void block(Bench *b, const char *method, CellType cell)
{
  bench_init(b, method, cell, 4);
  bench_motion(b, 1, 0, MOTION_FIXED, 7);
  if (!strcmp(method, "gmm"))
    b->c.basis = (BasisSpec){.kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
}

/* A range that ends at 0.6 m within a side from 0.5 to 0.75 m: 0.25 of 0.4 m bear it, and reactions say the same. */
static void test_cut(void **state)
{
  static const struct {
    const char *method, *body;
    CellType cell;
    const char *words;
  } kinds[] = {{"fem", NULL, CELL_QUADRILATERAL, "0.25 m bear it, of about 0.4 m"},
               {"fem", "body", CELL_TRIANGLE, "0.25 m bear it, of about 0.4 m"},
               {"gmm", NULL, CELL_TRIANGLE, "0.25 m bear it, of about 0.4 m"},
               {"fem", "body", CELL_HEXAHEDRON, "0.25 m2 bear it"},
               {"mpm", NULL, CELL_QUADRILATERAL, "0.25 m bear it, of about 0.4 m"},
               {"mpm", "body", CELL_QUADRILATERAL, NULL}};
  const MeasureSpec foot = {.kind = "reaction", .component = 1};
  PetscReal force;
  (void)state;
  EACH_OF (k, kinds) {
    Bench b;
    block(&b, kinds[k].method, kinds[k].cell);
    on_top(&b, kinds[k].body, 0.6);
    bench_warned(&b, PETSC_COMM_WORLD, "loads.tractions[0].on", kinds[k].words);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    model_step(m, 1);
    CALL(ModelMeasure(m, &foot, 0, &force));
    CHECK_CLOSE(force, kinds[k].words ? 250 : 400, 1e-6 * 400);
    CALL(ModelDestroy(&m));
  }
}

/* Ranges that end where sides do, and those that are only a tolerance about a plane. */
static void test_whole(void **state)
{
  static const CellType cell[] = {CELL_QUADRILATERAL, CELL_TRIANGLE, CELL_HEXAHEDRON, CELL_TETRAHEDRON};
  (void)state;
  EACH_OF (k, cell) {
    Bench b;
    block(&b, "fem", cell[k]);
    LoadSpec *load = on_top(&b, k % 2 ? "body" : NULL, 0.5);
    bench_warned(&b, PETSC_COMM_WORLD, "loads", NULL);
    load->on.min[1] = 0.97, load->on.max[1] = 1.03;
    load->on.min[0] = -1;
    bench_warned(&b, PETSC_COMM_WORLD, "loads", NULL);
  }
}

/* Sides of the grid above a block that does not fill it: mpm may bring material there, a mesh does not, and a pressure
 * is carried by what is there at the start. */
static void test_empty(void **state)
{
  Bench b;
  (void)state;
  for (int fem = 0; fem < 2; ++fem) {
    block(&b, fem ? "fem" : "mpm", CELL_QUADRILATERAL);
    bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 0.5, 1});
    LoadSpec *load = on_top(&b, NULL, 0);
    if (fem) bench_refused(&b, PETSC_COMM_WORLD, "loads.tractions[0].on", "hold no material");
    else bench_warned(&b, PETSC_COMM_WORLD, "loads.tractions[0].on", "hold no material: the load is nothing until");
    load->kind = LOAD_PRESSURE;
    bench_refused(&b, PETSC_COMM_WORLD, "loads.pressures[0].on", "here of 'body'");
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_cut), cmocka_unit_test(test_whole),
                                     cmocka_unit_test(test_empty)};
  return run_model_tests(argc, argv, tests);
}
