/* Loads that the material carries, in stages that change some of them and drop others: the foot bears what is there at
 * the end. What no stage can bring is refused beforehand. Of what is out of balance as a stage begins, what points that
 * moved have left is none that it releases. */
#include "case_builder.h"
#include "model/stage/stage_private.h"

static void block(Bench *b, const char *method)
{
  bench_init(b, method, !strcmp(method, "gmm") ? CELL_TRIANGLE : CELL_QUADRILATERAL, 4);
  bench_motion(b, 1, 0, MOTION_FIXED, 3);
  if (!strcmp(method, "gmm"))
    b->c.basis = (BasisSpec){.kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
}

/* The same case a stage later. */
static void go_on(const Bench *first, Bench *then)
{
  block(then, first->c.method);
  then->c.stage = 1;
  then->c.start = first->c.analysis.end;
  then->c.analysis.end = 2 * then->c.start;
}

/* A load that the stage brings or changes. */
static LoadSpec *changed(Bench *b, LoadSpec load)
{
  load.amplitude.since = 1;
  b->load[b->c.n_loads] = load;
  return &b->load[b->c.n_loads++];
}

static LoadSpec point(PetscReal y, PetscReal force)
{
  return (LoadSpec){.kind = LOAD_POINT, .at = {0.4, y}, .value = {0, force}};
}

static Model *succeed(Model *m, const Bench *then)
{
  Imbalance imbalance;
  PetscInt errors;
  Diag *diag;
  CALL(DiagCreate(&diag));
  CALL(ModelSucceed(&then->c, diag, &m, &imbalance));
  CALL(DiagReduce(PETSC_COMM_WORLD, diag, &errors));
  CALL(DiagFlush(diag, stderr));
  CALL(DiagDestroy(&diag));
  CHECK(m, "the stage was refused");
  return m;
}

static Model *both_stages(Bench *first, Bench *then)
{
  Model *m = bench_model(first, PETSC_COMM_WORLD);
  model_step(m, 1);
  m = succeed(m, then);
  model_step(m, then->c.analysis.end - m->time);
  return m;
}

static PetscReal foot(Model *m, PetscInt component)
{
  const MeasureSpec measure = {.kind = "reaction", .component = component};
  PetscReal value;
  CALL(ModelMeasure(m, &measure, 0, &value));
  return value;
}

/* Of two tractions on the same side one goes, one changes, and so does a point force, whose neighbour stays. */
static void test_tractions(void **state)
{
  static const char *const kinds[] = {"fem", "mpm", "gmm"};
  (void)state;
  EACH_OF (k, kinds) {
    Bench first, then;
    block(&first, kinds[k]);
    bench_traction(&first, 1, 1, "body", 0, -1000, 0)->name = "a";
    bench_traction(&first, 1, 1, "body", 300, 0, 0)->name = "b";
    first.load[first.c.n_loads++] = point(0.5, -300);
    first.load[first.c.n_loads++] = point(0.7, -20);
    go_on(&first, &then);
    LoadSpec load = first.load[1];
    load.value[0] = 100, load.value[1] = -700;
    changed(&then, load);
    changed(&then, point(0.5, -50));
    then.load[then.c.n_loads++] = point(0.7, -20);
    Model *m = both_stages(&first, &then);
    CHECK_CLOSE(foot(m, 0), -100, 1e-6 * 1000);
    CHECK_CLOSE(foot(m, 1), 770, 1e-6 * 1000);
    CALL(ModelDestroy(&m));
  }
}

/* Pressures on both sides, of which one goes and the other doubles. */
static void test_pressures(void **state)
{
  static const char *const kinds[] = {"fem", "mpm"};
  (void)state;
  EACH_OF (k, kinds) {
    Bench first, then;
    block(&first, kinds[k]);
    bench_traction(&first, 0, 0, "body", 900, 0, 0)->kind = LOAD_PRESSURE;
    bench_traction(&first, 0, 1, "body", 200, 0, 0)->kind = LOAD_PRESSURE;
    go_on(&first, &then);
    LoadSpec load = first.load[1];
    load.value[0] = 400;
    changed(&then, load);
    Model *m = both_stages(&first, &then);
    CHECK_CLOSE(foot(m, 0), 400, 1e-3 * 400);
    CALL(ModelDestroy(&m));
  }
}

static void refused(const Bench *first, const Bench *then, const char *words)
{
  char *text = NULL;
  size_t size;
  PetscMPIInt rank;
  FILE *out = open_memstream(&text, &size);
  Diag *diag;
  CALL(DiagCreate(&diag));
  CALL(RenameCheck(&then->c, &first->c, PETSC_TRUE, diag));
  CHECK(diag_errors(diag) == (words ? 1 : 0), "%d errors", (int)diag_errors(diag));
  CALL(DiagFlush(diag, out));
  fclose(out);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (!rank && words) CHECK(strstr(text, words), "no '%s' in: %s", words, text);
  free(text);
  CALL(DiagDestroy(&diag));
}

/* A load at a new place, and one whose carriers forgot their surface. */
static void test_refused(void **state)
{
  Bench first, then;
  (void)state;
  block(&first, "fem");
  bench_traction(&first, 1, 1, "body", 0, 0, 0);
  go_on(&first, &then);
  bench_traction(&then, 1, 1, "body", 0, 0, 0);
  refused(&first, &then, NULL);
  then.load[0].value[1] = -5;
  refused(&first, &then, "it was 0 before");
  first.load[0].value[1] = -1;
  refused(&first, &then, NULL);
  then.load[0].on.has[0] = PETSC_TRUE;
  then.c.stage = 0; /* the state is that of another run */
  refused(&first, &then, "of which the run of `initial` knows nothing");
}

/* While what was there fades and what the stage brings grows, the foot bears what acts: in proportion, as the whole of
 * the material, its own nodes too. */
static void test_fades(void **state)
{
  static const char *const kinds[] = {"fem", "mpm", "gmm"};
  (void)state;
  EACH_OF (k, kinds) {
    Bench first, then;
    block(&first, kinds[k]);
    bench_traction(&first, 1, 1, "body", 300, -1000, 0);
    first.c.gravity[1] = -1;
    go_on(&first, &then);
    then.load[then.c.n_loads++] = first.load[0];
    then.c.gravity[1] = -3;
    then.c.gravity_amplitude.since = 1;
    then.c.release = 1;
    then.c.analysis.step = then.c.analysis.largest = 0.25;
    Model *m = bench_model(&first, PETSC_COMM_WORLD);
    model_step(m, 1);
    m = succeed(m, &then);
    for (int step = 1; step <= 4; ++step) {
      model_step(m, 0.25);
      CHECK_CLOSE(foot(m, 0), -300, 1e-3);
      CHECK_CLOSE(foot(m, 1), 2000 + 0.25 * step * 2000, 1e-3);
    }
    CALL(ModelDestroy(&m));
  }
}

/* Room to go where the load presses it, on a grid that is restored or a cloud. */
static void soft_block(Bench *b, int kind)
{
  static const PetscReal min[] = {-0.5, 0, 0}, max[] = {1.5, 1.25, 0};
  static PetscReal rise[] = {0, 1};
  block(b, kind == 2 ? "gmm" : "mpm");
  bench_grid(b, min, max, 0.25);
  if (kind < 2) b->c.basis = (BasisSpec){.kind = kind ? "gimp" : "cell"};
  b->c.analysis.step = b->c.analysis.largest = 0.25;
  b->c.release = 1;
  bench_traction(b, 1, 1, "body", 5e3, -3e4, 0)->amplitude = (Amplitude){.n = 2, .time = rise, .value = rise};
}

/* A stage that changes nothing is no other run than one that goes on, and points that moved are out of balance in both:
 * nothing is held, and what that takes is of the transfer. */
static void test_unchanged(void **state)
{
  (void)state;
  EACH_VARIANT (kind, 3) {
    Bench one, then;
    PetscReal energy[2][2];
    for (int staged = 0; staged < 2; ++staged) {
      soft_block(&one, (int)kind);
      soft_block(&then, (int)kind);
      one.c.analysis.end = staged ? 0.5 : 1;
      then.c.stage = 1;
      then.c.start = 0.5;
      Model *m = bench_model(&one, PETSC_COMM_WORLD);
      for (int k = 0; k < 2; ++k) model_step(m, 0.25);
      if (staged) m = succeed(m, &then);
      for (int k = 0; k < 2; ++k) model_step(m, 0.25);
      energy[staged][0] = m->external_work;
      energy[staged][1] = m->transfer_energy;
      CALL(ModelDestroy(&m));
    }
    CHECK(PetscAbsReal(energy[0][1]) > 1e-7 * energy[0][0], "nothing was out of balance");
    for (int k = 0; k < 2; ++k) CHECK_CLOSE(energy[1][k], energy[0][k], 1e-11 * energy[0][0]);
  }
}

/* Forces out of balance at the start of the stage, N, those of nodes at a height: the largest there, or elsewhere. */
static PetscReal out_of_balance(Model *m, PetscReal height, PetscBool there)
{
  PetscReal *residual, most = 0;
  CALL(PetscCalloc1(m->grid->n_nodes * 2, &residual));
  CALL(Residual(m, residual));
  for (PetscInt i = 0; i < m->grid->n_owned * 2; ++i) {
    const PetscBool is_there = PetscAbsReal(m->grid->x[i / 2 * 2 + 1] - height) < 1e-9;
    if (is_there == there && !m->boundary->fixed[i]) most = PetscMax(most, PetscAbsReal(residual[i]));
  }
  CALL(PetscFree(residual));
  CALL(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  return most;
}

/* The second of two stages, when the first is over: a second each, four steps long. */
static Model *one_then(Bench *one, Bench *then)
{
  then->c.stage = 1;
  then->c.start = 1;
  then->c.analysis.end = 2;
  Model *m = bench_model(one, PETSC_COMM_WORLD);
  for (int k = 0; k < 4; ++k) model_step(m, 0.25);
  return succeed(m, then);
}

/* A boundary lets go what it has pulled: its nodes are held with what they bear as points stand now, and feel nothing
 * at once of what these left as they moved. That is of the other nodes alone. */
static void test_lets_go(void **state)
{
  (void)state;
  EACH_VARIANT (kind, 2) {
    Bench one, then;
    soft_block(&one, (int)kind);
    soft_block(&then, (int)kind);
    one.c.n_loads = then.c.n_loads = 0;
    bench_motion(&one, 1, 1, MOTION_VELOCITY, 3)->value[1] = 0.1;
    Model *m = one_then(&one, &then);
    const PetscReal at = out_of_balance(m, 1, PETSC_TRUE), beside = out_of_balance(m, 1, PETSC_FALSE);
    CHECK(beside > 100 && at < 1e-9 * beside, "%g N on what was held, %g N beside it", (double)at, (double)beside);
    CALL(ModelDestroy(&m));
  }
}

/* The upper half goes, and what points have left out of balance is held with what it bore: the foot bears the weight of
 * the rest, and what there still is of the other. */
static void test_goes(void **state)
{
  (void)state;
  EACH_VARIANT (kind, 2) {
    Bench one, then;
    Bench *both[] = {&one, &then};
    for (int k = 0; k < 2; ++k) {
      soft_block(both[k], (int)kind);
      both[k]->c.n_loads = 0;
      both[k]->c.gravity[1] = -200;
      both[k]->c.n_bodies = 2;
      both[k]->body[1] = both[k]->body[0];
      both[k]->body[1].name = "upper";
      both[k]->body[0].shape.max[1] = both[k]->body[1].shape.min[1] = 0.5;
    }
    then.body[1].absent = PETSC_TRUE;
    Model *m = one_then(&one, &then);
    for (int k = 1; k <= 4; ++k) {
      model_step(m, 0.25);
      CHECK_CLOSE(foot(m, 1), 200 * 1000 * (0.5 + 0.5 * (1 - 0.25 * k)), 1e-5);
    }
    CALL(ModelDestroy(&m));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_tractions), cmocka_unit_test(test_pressures),
                                     cmocka_unit_test(test_refused),   cmocka_unit_test(test_fades),
                                     cmocka_unit_test(test_unchanged), cmocka_unit_test(test_goes),
                                     cmocka_unit_test(test_lets_go)};
  return run_model_tests(argc, argv, tests);
}
