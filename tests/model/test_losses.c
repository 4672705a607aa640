/* What leaves the grid: tracers and loads go with their body, points are counted with all that they
 * take along, and what is empty says so. */
#include "case_builder.h"

static PetscReal measure(Model *m, PetscInt index)
{
  PetscReal value;
  CALL(ModelMeasure(m, &m->c->measures[index], index, &value));
  return value;
}

/* A bar of 4 m x 1 m in x >= 0 that slides on y = 0, pulled at its end; the grid ends with the bar,
 * or `more` beyond it. nu = 0. */
static void bar(Bench *b, PetscReal more, PetscReal traction)
{
  bench_init(b, "mpm", CELL_QUADRILATERAL, 0);
  b->constants[1].value = 0;
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){4 + more, 1 + more, 0}, 0.25);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 0});
  bench_motion(b, 0, 0, MOTION_FIXED, 1);
  bench_motion(b, 1, 0, MOTION_FIXED, 2);
  bench_traction(b, 0, 4, "body", traction, 0, 0);
  bench_tracer(b, "displacement", 0, 4, 0.5, 0);
  bench_tracer(b, "position", 0, 4, 0.5, 0);
  bench_tracer(b, "displacement", 1, 4, 1, 0);
  bench_tracer(b, "velocity", 0, 4, 1, 0);
  b->c.analysis.step = b->c.analysis.largest = 0.1;
}

/* Steps until the end; the last values of the four measures. */
static void pulled(Bench *b, PetscReal value[4])
{
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  while (m->time < b->c.analysis.end * (1 - 1e-12)) model_step(m, b->c.analysis.end - m->time);
  for (PetscInt k = 0; k < 4; ++k) value[k] = measure(m, k);
  for (PetscInt k = 0; k < 4; ++k) CHECK(m->memory[k].ended == 0, "tracer %d ended", (int)k);
  CHECK(m->load_memory[0].ended == 0, "a part of the load ended");
  CALL(ModelDestroy(&m));
}

/* A grid of the bar's own size gives what a larger one gives; both are the bar. */
static void test_tip_leaves_the_grid(void **state)
{
  /* P = E/2 (s - 1/s) */
  const PetscReal stretch = 0.01 + PetscSqrtReal(1 + 1e-4), exact = 4 * (stretch - 1);
  PetscReal own[4], large[4];
  Bench b;
  (void)state;
  for (int dynamic = 0; dynamic < 2; ++dynamic)
    for (int more = 0; more < 2; ++more) {
      bar(&b, more, 1e4);
      if (dynamic) bench_dynamic(&b, 0.12, 2e-3);
      pulled(&b, more ? large : own);
    }
  for (int k = 0; k < 4; ++k) CHECK_CLOSE(own[k], large[k], 1e-9 * PetscAbsReal(large[k]) + 1e-13);
  CHECK_CLOSE(own[1], 4 + own[0], 1e-14);
  CHECK(own[0] > 0.02 && own[3] > 0.1, "the bar should be on its way");
  bar(&b, 0, 1e4);
  pulled(&b, own);
  CHECK_CLOSE(own[0], exact, 0.02 * exact);
}

/* The same where the grid is a mesh, whose edge is found by search: the tip of a distorted one
 * moves as that of fem. */
static void test_tip_leaves_a_mesh(void **state)
{
  const PetscReal planes[] = {0, 1, 4};
  PetscReal mpm[4], fem[4];
  Bench b;
  (void)state;
  for (int k = 0; k < 2; ++k) {
    bar(&b, 0, 1e4);
    if (k) b.c.method = "fem";
    bench_distort(&b, 0.15, 3, planes);
    pulled(&b, k ? fem : mpm);
    bench_end(&b);
  }
  CHECK_CLOSE(mpm[0], fem[0], 0.02 * fem[0]);
  CHECK(mpm[0] > 0.03, "the tip is pinned: %g", (double)mpm[0]);
}

/* Two blocks fly to the right, the second out of the grid; nothing else acts. */
static void thrown(Bench *b, OutsidePolicy outside)
{
  bench_init(b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 0}, 0.125);
  b->body[1] = b->body[0];
  b->body[1].name = "gone";
  b->c.n_bodies = 2;
  bench_box(b, 0, (PetscReal[]){0.25, 0.25, 0}, (PetscReal[]){0.75, 0.75, 0});
  bench_box(b, 1, (PetscReal[]){3.25, 0.25, 0}, (PetscReal[]){3.75, 0.75, 0});
  b->body[0].velocity[0] = b->body[1].velocity[0] = 5;
  b->body[0].velocity[1] = b->body[1].velocity[1] = 0.1;
  b->c.grid.outside = outside;
  bench_dynamic(b, 0.3, 4e-3);
}

/* Of each block 64 points of 3.90625 kg, 5 m/s: what is gone and what is there are what there
 * was. */
static void check_accounts(Model *m)
{
  Energies e;
  CALL(ModelEnergies(m, &e));
  CHECK_CLOSE(model_sum(m, "energy: balance", 0), 0, 1e-9);
  CHECK_CLOSE(model_sum(m, "mass: total", 0) + model_sum(m, "outside: mass", 0), 500, 1e-9);
  CHECK_CLOSE(model_sum(m, "momentum", 0) + model_sum(m, "outside_momentum", 0), 2500, 1e-6);
  CHECK_CLOSE(model_sum(m, "momentum", 1) + model_sum(m, "outside_momentum", 1), 50, 1e-6);
  CHECK(e.outside == model_sum(m, "energy: outside", 0), "two accounts of one energy");
}

static void test_removed_points_are_counted(void **state)
{
  Bench b;
  PetscInt told = 0;
  PetscBool partly = PETSC_FALSE;
  (void)state;
  thrown(&b, OUTSIDE_REMOVE);
  b.c.n_measures = 0;
  bench_tracer(&b, "displacement", 0, 3.5, 0.5, 0);
  bench_tracer(&b, "displacement", 0, 0.5, 0.5, 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 0.3 - 1e-9) {
    const StepReport report = model_step(m, 0.3 - m->time);
    const PetscReal removed = model_sum(m, "outside: removed", 0);
    told += report.removed;
    check_accounts(m);
    CHECK((PetscReal)told == removed, "%d removed in steps, %g in all", (int)told, (double)removed);
    CHECK_CLOSE(model_sum(m, "outside: mass", 0), removed * 3.90625, 1e-9);
    CHECK_CLOSE(model_sum(m, "energy: outside", 0), removed * 3.90625 * (25 + 0.01) / 2, 1e-6);
    if (report.removed) CHECK(report.first_outside.x[0] > 4 && report.first_outside.id >= 64, "where?");
    if (removed > 0 && removed < 64) partly = PETSC_TRUE;
    if (m->time < 0.09) CHECK_CLOSE(measure(m, 0), 5 * m->time, 1e-9);
  }
  CHECK(partly && told == 64, "%d points have gone", (int)told);
  CHECK(m->outside.first > 0.05 && m->outside.last < 0.16 && m->outside.last > m->outside.first, "when?");
  CHECK(PetscIsNanReal(measure(m, 0)), "a tracer that nothing carries");
  CHECK(m->memory[0].ended > 0.09 && m->memory[0].where[0] > 4 && m->memory[0].where[0] < 4.2,
        "it ended at %g s, x = %g", (double)m->memory[0].ended, (double)m->memory[0].where[0]);
  CHECK_CLOSE(measure(m, 1), 1.5, 1e-9);
  CALL(ModelDestroy(&m));
}

static void test_kept_points_are_counted(void **state)
{
  Bench b;
  PetscReal most = 0;
  (void)state;
  thrown(&b, OUTSIDE_KEEP);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 0.2 - 1e-9) {
    const StepReport report = model_step(m, 0.2 - m->time);
    check_accounts(m);
    CHECK(report.removed == 0, "nothing is removed");
    CHECK(model_sum(m, "outside: held", 0) == (PetscReal)report.held, "held in the step");
    most = PetscMax(most, (PetscReal)report.held);
    if (report.held) CHECK(report.first_outside.x[0] > 4, "where it would have been");
  }
  CHECK(most > 0 && m->outside.held_most == most && m->outside.held >= most, "%g at most, %g in all", (double)most,
        (double)m->outside.held);
  CHECK_CLOSE(m->outside.held_most_mass, most * 3.90625, 1e-9);
  CHECK(model_sum(m, "outside_momentum", 0) > 10, "the edge has stopped something");
  CALL(ModelDestroy(&m));
}

/* What is asked of a body without points has no value; its mass is 0, and sums over all bodies are
 * sums. */
static void test_empty_body(void **state)
{
  static const MeasureSpec empty[] = {
    {.kind = "extent", .maximum = PETSC_TRUE, .body = "gone"},
    {.kind = "extent", .body = "gone"},
    {.kind = "extent", .maximum = PETSC_TRUE, .beyond = 0.1, .body = "gone"},
    {.kind = "spin", .component = 2, .body = "gone"},
    {.kind = "momentum", .body = "gone"},
    {.kind = "energy", .word = "kinetic", .body = "gone"},
    {.kind = "energy", .word = "elastic", .body = "gone"},
    {.kind = "surface", .word = "front", .body = "gone"},
    {.kind = "surface", .word = "height", .body = "gone", .has_at = PETSC_TRUE, .at = 3.5},
    {.kind = "surface", .word = "slope", .body = "gone"},
  };
  const MeasureSpec mass = {.kind = "mass", .word = "total", .body = "gone"};
  PetscReal value;
  Bench b;
  (void)state;
  thrown(&b, OUTSIDE_REMOVE);
  b.c.n_measures = 1;
  b.measure[0] =
    (MeasureSpec){.name = "rest", .kind = "run_out_time", .maximum = PETSC_TRUE, .speed = 1, .body = "gone"};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(empty); ++k) {
    CALL(ModelMeasure(m, &empty[k], 0, &value));
    CHECK(!PetscIsInfOrNanReal(value), "measure %d has a value at the start", (int)k);
  }
  while (m->time < 0.2 - 1e-9) model_step(m, 0.2 - m->time);
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(empty); ++k) {
    CALL(ModelMeasure(m, &empty[k], 0, &value));
    CHECK(PetscIsNanReal(value), "measure %d of an empty body is %g", (int)k, (double)value);
  }
  CHECK(PetscIsNanReal(measure(m, 0)), "run-out time of an empty body");
  CALL(ModelMeasure(m, &mass, 0, &value));
  CHECK(value == 0, "mass of an empty body: %g", (double)value);
  CHECK_CLOSE(model_sum(m, "energy: kinetic", 0), 250 * (25 + 0.01) / 2, 1e-6);
  CALL(ModelDestroy(&m));
}

static void test_tracer_in_the_void(void **state)
{
  static const char *const moved_by[] = {"mpm", "gmm"};
  Bench b;
  (void)state;
  for (int k = 0; k < 2; ++k) {
    bar(&b, 3, 1e4);
    b.c.method = (char *)moved_by[k];
    if (k) b.c.basis = (BasisSpec){.kind = "lme", .radius = 2, .gamma = 1.8, .choice = CLOUD_CHOICE_FIXED};
    b.measure[1].tracer[0] = 6.5;
    b.measure[1].name = "lost";
    bench_refused(&b, PETSC_COMM_WORLD, "measures.lost.of.tracer", "no material carries the tracer");
  }
  bar(&b, 3, 1e4);
  b.load[0] = (LoadSpec){.kind = LOAD_POINT, .at = {6.5, 0.5}, .value = {1, 0}};
  bench_refused(&b, PETSC_COMM_WORLD, "loads.points[0].at", "no material carries the force");
}

/* A load on a body that leaves: its carriers end with it, and that is known. */
static void test_load_goes_with_its_body(void **state)
{
  Bench b;
  (void)state;
  thrown(&b, OUTSIDE_REMOVE);
  bench_traction(&b, 0, 3.75, "gone", 1000, 0, 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 0.2 - 1e-9) model_step(m, 0.2 - m->time);
  CHECK_CLOSE(m->load_memory[0].force[0], 500, 1e-9); /* 1000 N/m2 on half a metre */
  CHECK(m->load_memory[0].carriers == 8 && m->load_memory[0].ended > 0, "%g carriers, until %g s",
        (double)m->load_memory[0].carriers, (double)m->load_memory[0].ended);
  CALL(ModelDestroy(&m));
}

/* Messages about a model; to be freed, empty on ranks above 0. */
static char *messages(Bench *b)
{
  Diag *diag;
  Model *m = NULL;
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  CALL(DiagCreate(&diag));
  CALL(ModelCreate(PETSC_COMM_WORLD, &b->c, diag, &m));
  CHECK(m, "the case was refused");
  CALL(DiagFlush(diag, out));
  fclose(out);
  CALL(DiagDestroy(&diag));
  CALL(ModelDestroy(&m));
  return text;
}

static void expect_edges(Bench *b, const char *words)
{
  PetscMPIInt rank;
  char *text = messages(b);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (!rank)
    CHECK(words ? strstr(text, words) != NULL : !strstr(text, "fills the grid"), "'%s' about '%s'", text, words);
  free(text);
}

/* Only edges that are filled and free are told, by where they look; methods whose nodes move have
 * none. */
static void test_full_grid_is_told(void **state)
{
  Bench b;
  (void)state;
  bar(&b, 0, 1e4);
  expect_edges(
    &b, "'body' fills the grid to its edge towards x, y, where nothing holds it: what passes that edge ends the run");
  b.c.grid.outside = OUTSIDE_REMOVE;
  expect_edges(&b, "is removed");
  bench_motion(&b, 1, 1, MOTION_FIXED, 2);
  expect_edges(&b, "towards x, where");
  bar(&b, 1, 1e4);
  expect_edges(&b, NULL);
  bar(&b, 0, 1e4);
  b.c.method = "fem";
  expect_edges(&b, NULL);
  bench_init(&b, "mpm", CELL_TETRAHEDRON, 2);
  bench_motion(&b, 2, 0, MOTION_FIXED, 7);
  bench_motion(&b, 0, 1, MOTION_FIXED, 1);
  expect_edges(&b, "towards -x, -y, y, z, where");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_tip_leaves_the_grid),
    cmocka_unit_test(test_tip_leaves_a_mesh),
    cmocka_unit_test(test_removed_points_are_counted),
    cmocka_unit_test(test_kept_points_are_counted),
    cmocka_unit_test(test_empty_body),
    cmocka_unit_test(test_tracer_in_the_void),
    cmocka_unit_test(test_load_goes_with_its_body),
    cmocka_unit_test(test_full_grid_is_told),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
