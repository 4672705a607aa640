/* The public interface as a user's program sees it: only talus.h. The tests run in order; the first
 * starts MPI and PETSc, the last ends them. */
#include "api_test.h"

/* Each rank starts in a folder whose petscrc asks PETSc to write a file in the end. */
static struct {
  char folder[FOLDER], before[1024];
} strange;

static void enter_strange_folder(void)
{
  strcpy(strange.folder, "/tmp/talus-api-XXXXXX");
  CHECK(getcwd(strange.before, sizeof strange.before) && mkdtemp(strange.folder) && chdir(strange.folder) == 0);
  FILE *out = fopen("petscrc", "w");
  CHECK(out != NULL);
  fprintf(out, "-log_view :%s/written\n", strange.folder);
  CHECK(fclose(out) == 0);
}

static void leave_strange_folder(void)
{
  char path[FOLDER + 16];
  snprintf(path, sizeof path, "%s/written", strange.folder);
  CHECK(access(path, F_OK) != 0);
  snprintf(path, sizeof path, "%s/petscrc", strange.folder);
  CHECK(unlink(path) == 0 && rmdir(strange.folder) == 0);
}

static void test_session(void **state)
{
  TalusCase *c = NULL;
  int rank, size;
  (void)state;
  CHECK_ERROR(TalusFinalize(), TALUS_ERROR_STATE);
  CHECK_ERROR(TalusRanks(MPI_COMM_WORLD, &rank, &size), TALUS_ERROR_STATE);
  CHECK_ERROR(TalusCaseOpen(MPI_COMM_WORLD, BLOCK, 0, NULL, &c, NULL), TALUS_ERROR_STATE);
  CHECK(strchr(TalusVersion(), '.') != NULL);
  enter_strange_folder();
  CALL(TalusInitialize(NULL, NULL));
  CHECK(chdir(strange.before) == 0);
  CHECK_ERROR(TalusInitialize(NULL, NULL), TALUS_ERROR_STATE);
  CALL(TalusRanks(MPI_COMM_WORLD, &rank, &size));
  CHECK(rank >= 0 && rank < size);
  CALL(TalusRanks(MPI_COMM_WORLD, NULL, NULL));
}

static void test_errors_in_words(void **state)
{
  (void)state;
  for (int a = -1; a <= TALUS_ERROR_BUSY + 1; ++a) {
    CHECK(talus_error_string(a)[0] != '\0');
    for (int b = 0; b < a && a <= TALUS_ERROR_BUSY; ++b) CHECK(strcmp(talus_error_string(a), talus_error_string(b)));
  }
}

/* Opening must fail, and the message must hold `what` on every rank. */
static void expect_mistake(const char *file, const char *set, const char *what)
{
  TalusCase *c = (TalusCase *)&c;
  char *messages = NULL;
  CHECK_ERROR(TalusCaseOpen(MPI_COMM_WORLD, file, set ? 1 : 0, &set, &c, &messages), TALUS_ERROR_INPUT);
  CHECK(c == NULL);
  CHECK(messages && strstr(messages, what));
  TalusTextFree(&messages);
  CHECK(messages == NULL);
}

static void test_mistakes(void **state)
{
  char folder[FOLDER], file[FOLDER + 16];
  (void)state;
  make_folder(folder);
  snprintf(file, sizeof file, "%s/bad.yaml", folder);
  expect_mistake(file, NULL, "no such file");
  expect_mistake(folder, NULL, "directory");
  if (my_rank() == 0) {
    FILE *out = fopen(file, "w");
    fputs("kinematics: plane-strain\nmethod: mpm\nmaterials:\n  rubber: {law: neo-hookean, yung: 1e6}\n", out);
    fclose(out);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  expect_mistake(file, NULL, "bad.yaml:4:");
  expect_mistake(file, NULL, "yung");
  expect_mistake(BLOCK, "materials.rubber.density=-1", "density");
  expect_mistake(BLOCK, "materials.rubber.colour=red", "colour");
  remove_folder(folder);
}

/* Mistakes that show only when the grid is there. */
static void test_mistakes_of_a_model(void **state)
{
  const char *const set[] = {"grid.box.min=[5, -0.5]", "grid.box.max=[7, 1.5]"};
  TalusModel *model = (TalusModel *)&model;
  TalusRun *run = (TalusRun *)&run;
  char *messages = NULL, folder[FOLDER], out[FOLDER + 8], log[FOLDER + 16];
  (void)state;
  TalusCase *c = open_block(2, set);
  CHECK_ERROR(TalusModelCreate(c, &model, &messages), TALUS_ERROR_INPUT);
  CHECK(model == NULL && messages && strstr(messages, "block.yaml:7:") && strstr(messages, "block"));
  TalusTextFree(&messages);
  make_folder(folder);
  snprintf(out, sizeof out, "%s/run", folder);
  snprintf(log, sizeof log, "%s/log.txt", out);
  CHECK_ERROR(TalusRunCase(c, out, TALUS_RUN_QUIET, &run, &messages), TALUS_ERROR_INPUT);
  CHECK(run == NULL && messages && strstr(messages, "block.yaml:7:"));
  CHECK(access(log, F_OK) != 0); /* nothing was written */
  TalusTextFree(&messages);
  remove_folder(folder);
  CALL(TalusCaseClose(&c));
}

static void test_null(void **state)
{
  TalusCase *c = NULL;
  TalusModel *model = NULL;
  TalusRun *run = NULL;
  TalusOutcome outcome;
  TalusStep step;
  double value;
  int n;
  (void)state;
  CHECK_ERROR(TalusCaseOpen(MPI_COMM_WORLD, NULL, 0, NULL, &c, NULL), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusCaseOpen(MPI_COMM_NULL, BLOCK, 0, NULL, &c, NULL), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusRanks(MPI_COMM_NULL, &n, NULL), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusCaseOpen(MPI_COMM_WORLD, BLOCK, 0, NULL, NULL, NULL), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusCaseOpen(MPI_COMM_WORLD, BLOCK, 1, NULL, &c, NULL), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusCaseOpen(MPI_COMM_WORLD, BLOCK, -1, NULL, &c, NULL), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusCaseCountMeasures(NULL, &n), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusCaseMeasureName(NULL, 0, NULL, NULL), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusRunCase(NULL, "x", 0, &run, NULL), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusRunOutcome(NULL, &outcome), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusRunMeasure(NULL, "top", &value), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusModelCreate(NULL, &model, NULL), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusModelStep(NULL, 0, &step), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusModelTime(NULL, &value, NULL), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusModelMeasure(NULL, "top", &value), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusModelPoints(NULL, "mass", &n, NULL, NULL, 0), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusModelSetBodyForce(NULL, NULL, NULL), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusModelSetLoadFactors(NULL, "points[0]", NULL, NULL), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusCaseSetLoadFactors(NULL, "points[0]", NULL, NULL), TALUS_ERROR_ARGUMENT);
  CHECK(TalusModelReason(NULL)[0] == '\0');
  CALL(TalusModelDestroy(&model)); /* destroying nothing is fine */
  CALL(TalusRunDestroy(&run));
  CALL(TalusCaseClose(&c));
  CALL(TalusCaseClose(NULL));
  TalusTextFree(NULL);
}

static void test_names(void **state)
{
  const char *name, *unit;
  double value = 7;
  int n;
  (void)state;
  TalusCase *c = open_block(0, NULL);
  CALL(TalusCaseCountMeasures(c, &n));
  CHECK(n == 3);
  CALL(TalusCaseMeasureName(c, 0, &name, &unit));
  CHECK(!strcmp(name, "top") && !strcmp(unit, "m"));
  CHECK_ERROR(TalusCaseMeasureName(c, 3, &name, &unit), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusCaseMeasureName(c, -1, &name, &unit), TALUS_ERROR_ARGUMENT);
  TalusModel *model = create_model(c);
  CHECK_ERROR(TalusModelMeasure(model, "bottom", &value), TALUS_ERROR_UNKNOWN);
  CHECK_ERROR(TalusModelPoints(model, "colour", &n, NULL, NULL, 0), TALUS_ERROR_UNKNOWN);
  CHECK(value == 7 && n == 3);
  CALL(TalusModelMeasure(model, "mass", &value));
  CHECK_CLOSE(value, 1000, 1e-9);
  CALL(TalusModelDestroy(&model));
  CHECK(model == NULL);
  CALL(TalusCaseClose(&c));
  CHECK(c == NULL);
}

/* Stepping by hand and running give the same numbers to the last bit. */
static void test_steps_equal_run(void **state)
{
  static const char *const names[] = {"top", "falling", "mass"};
  char folder[FOLDER], out[FOLDER + 8], history[FOLDER + 24], *messages = NULL;
  double run_value, model_value, time, end;
  TalusOutcome outcome;
  TalusRun *run;
  (void)state;
  make_folder(folder);
  snprintf(out, sizeof out, "%s/run", folder);
  snprintf(history, sizeof history, "%s/history.csv", out);
  TalusCase *c = open_block(0, NULL);
  CALL(TalusRunCase(c, out, TALUS_RUN_QUIET, &run, NULL));
  CALL(TalusRunOutcome(run, &outcome));
  CHECK(outcome == TALUS_DONE && access(history, R_OK) == 0);
  TalusModel *model = create_model(c);
  CHECK(run_to_end(model) == 5);
  CALL(TalusModelTime(model, &time, &end));
  CHECK_CLOSE(time, 0.01, 1e-12);
  CHECK(end == 0.01);
  for (int i = 0; i < 3; ++i) {
    CALL(TalusRunMeasure(run, names[i], &run_value));
    CALL(TalusModelMeasure(model, names[i], &model_value));
    CHECK(run_value == model_value);
  }
  CALL(
    /* the free top falls freely, news from the bottom takes 0.027 s */
    TalusModelMeasure(model, "top", &model_value));
  CHECK_CLOSE(model_value, -0.5 * 9.81 * 0.01 * 0.01, 2e-5);
  CHECK_ERROR(TalusRunMeasure(run, "bottom", &run_value), TALUS_ERROR_UNKNOWN);
  CALL(TalusRunDestroy(&run));
  /* What is there is not replaced unasked, and flags that do not exist are refused. */
  CHECK_ERROR(TalusRunCase(c, out, TALUS_RUN_QUIET, &run, &messages), TALUS_ERROR_INPUT);
  CHECK(run == NULL && messages && messages[0]);
  TalusTextFree(&messages);
  CHECK_ERROR(TalusRunCase(c, out, 1u << 20, &run, NULL), TALUS_ERROR_ARGUMENT);
  CALL(TalusRunCase(c, out, TALUS_RUN_QUIET | TALUS_RUN_FORCE, &run, NULL));
  CALL(TalusRunDestroy(&run));
  CALL(TalusModelDestroy(&model));
  CALL(TalusCaseClose(&c));
  remove_folder(folder);
}

/* The values of a run of the block to this end, of the same block that ran to half of it and was
 * resumed, and of one that was resumed at its end. */
static void test_resume(void **state)
{
  static const char *const often[] = {"checkpoint.steps=2", "analysis.end=0.02"}, *const half[] = {
                                                                                    "checkpoint.steps=2"};
  char folder[FOLDER], whole[FOLDER + 8], cut[FOLDER + 8], file[FOLDER + 24];
  double values[3];
  int size;
  TalusRun *run;
  TalusCase *c;
  (void)state;
  CALL(TalusRanks(MPI_COMM_WORLD, NULL, &size));
  make_folder(folder);
  snprintf(whole, sizeof whole, "%s/whole", folder);
  snprintf(cut, sizeof cut, "%s/cut", folder);
  snprintf(file, sizeof file, "%s/case.yaml", cut);
  for (int k = 0; k < 4; ++k) { /* whole, half, to its end, again at its end */
    if (k < 2) c = open_block(k ? 1 : 2, k ? half : often);
    else CALL(TalusCaseOpen(MPI_COMM_WORLD, file, 1, often + 1, &c, NULL));
    CALL(TalusRunCase(c, k ? cut : whole, TALUS_RUN_QUIET | (k < 2 ? 0 : TALUS_RUN_RESUME), &run, NULL));
    if (k != 1) CALL(TalusRunMeasure(run, "top", &values[k ? k - 1 : 0]));
    CALL(TalusRunDestroy(&run));
    CHECK_ERROR(TalusRunCase(c, cut, TALUS_RUN_FORCE | TALUS_RUN_RESUME, &run, NULL), TALUS_ERROR_ARGUMENT);
    CALL(TalusCaseClose(&c));
  }
  CHECK(values[0] < -0.0019);
  CHECK_CLOSE(values[1], values[0], size == 1 ? 0 : 1e-9);
  CHECK(values[2] == values[1]);
  remove_folder(folder);
}

static void write_line(const char *folder, const char *name, const char *text)
{
  char path[FOLDER + 32];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *out = fopen(path, "w");
  CHECK(out && fputs(text, out) >= 0 && fclose(out) == 0);
}

/* A mesh script that makes a file is refused, and obeyed once its case is trusted. */
static void test_trust(void **state)
{
  char folder[FOLDER], file[FOLDER + 16], made[FOLDER + 16], *messages = NULL;
  TalusCase *c;
  TalusModel *model;
  (void)state;
  make_folder(folder);
  snprintf(file, sizeof file, "%s/case.yaml", folder);
  snprintf(made, sizeof made, "%s/made", folder);
  if (my_rank() == 0) {
    write_line(folder, "square.geo",
               "Point(1) = {0, 0, 0, 0.5}; l() = Extrude {1, 0, 0} { Point{1}; };\n"
               "s() = Extrude {0, 1, 0} { Curve{l(1)}; };\nPrintf(\"x\") > \"made\";\n");
    write_line(folder, "case.yaml",
               "kinematics: plane-strain\nmethod: fem\nanalysis: {type: static, steps: 1}\ngrid: {mesh: square.geo}\n"
               "bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 3, material: m}]\n"
               "materials: {m: {law: neo-hookean, density: 1, young: 1, poisson: 0}}\n"
               "boundary: [{on: {x: 0}, fix: [x, y]}]\n");
  }
  MPI_Barrier(MPI_COMM_WORLD);
  CALL(TalusCaseOpen(MPI_COMM_WORLD, file, 0, NULL, &c, NULL));
  CHECK_ERROR(TalusModelCreate(c, &model, &messages), TALUS_ERROR_INPUT);
  CHECK(messages && strstr(messages, "square.geo:3:13: error: this writes into a file") && access(made, F_OK) != 0);
  TalusTextFree(&messages);
  CHECK_ERROR(TalusCaseTrust(NULL), TALUS_ERROR_ARGUMENT);
  CALL(TalusCaseTrust(c));
  CALL(TalusModelCreate(c, &model, &messages));
  CHECK(access(made, F_OK) == 0);
  TalusTextFree(&messages);
  CALL(TalusModelDestroy(&model));
  CALL(TalusCaseClose(&c));
  remove_folder(folder);
}

static void test_limits(void **state)
{
  TalusStep step = TALUS_STEP_AT_END;
  double time;
  (void)state;
  TalusCase *c = open_block(0, NULL);
  TalusModel *model = create_model(c);
  CHECK_ERROR(TalusModelStep(model, -1, &step), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusModelStep(model, nan(""), &step), TALUS_ERROR_ARGUMENT);
  CALL(TalusModelStep(model, 0.0005, &step));
  CALL(TalusModelTime(model, &time, NULL));
  CHECK(step == TALUS_STEP_ACCEPTED && time == 0.0005);
  run_to_end(model);
  /* asked for, a model goes on beyond the end of its case */
  CALL(TalusModelStep(model, 0.001, &step));
  CALL(TalusModelTime(model, &time, NULL));
  CHECK(step == TALUS_STEP_ACCEPTED);
  CHECK_CLOSE(time, 0.011, 1e-12);
  CALL(TalusModelDestroy(&model));
  CALL(TalusCaseClose(&c));
}

/* A step that cannot converge says so in words and leaves the model as it was. */
static void test_failed_step(void **state)
{
  const char *const set[] = {"analysis.smallest=0.0015", "newton.max_iterations=1", "newton.residual=1e-14",
                             "materials.rubber.young=1e3"};
  TalusStep step = TALUS_STEP_ACCEPTED;
  double time, top = 7;
  (void)state;
  TalusCase *c = open_block(4, set);
  TalusModel *model = create_model(c);
  CHECK(TalusModelReason(model)[0] == '\0');
  CALL(TalusModelStep(model, 0, &step));
  CHECK(step == TALUS_STEP_TOO_SMALL && strstr(TalusModelReason(model), "converge"));
  CALL(TalusModelTime(model, &time, NULL));
  CALL(TalusModelMeasure(model, "top", &top));
  CHECK(time == 0 && top == 0);
  CALL(TalusModelDestroy(&model));
  CALL(TalusCaseClose(&c));
}

/* A run that gives up is no error of the call, and no run that is done; what it had reached is
 * there. */
static void test_gave_up(void **state)
{
  const char *const set[] = {"analysis.smallest=0.0015", "newton.max_iterations=1", "newton.residual=1e-14",
                             "materials.rubber.young=1e3"};
  char folder[FOLDER], out[FOLDER + 8], *messages;
  TalusOutcome outcome;
  TalusRun *run;
  double value;
  (void)state;
  TalusCase *c = open_block(4, set);
  make_folder(folder);
  snprintf(out, sizeof out, "%s/run", folder);
  CALL(TalusRunCase(c, out, TALUS_RUN_QUIET, &run, &messages));
  CALL(TalusRunOutcome(run, &outcome));
  CHECK(outcome == TALUS_GAVE_UP);
  CHECK(!messages || strstr(messages, "gave up"));
  CALL(TalusRunMeasure(run, "mass", &value));
  CHECK_CLOSE(value, 1000, 1e-9);
  TalusTextFree(&messages);
  CALL(TalusRunDestroy(&run));
  CALL(TalusCaseClose(&c));
  remove_folder(folder);
}

/* A field of this rank's points, to be freed. */
static double *get_field(const TalusModel *model, const char *name, int expected_components, int *n)
{
  int components;
  CALL(TalusModelPoints(model, name, n, &components, NULL, 0));
  CHECK(components == expected_components);
  const size_t size = (size_t)*n * (size_t)components;
  double *values = malloc((size + 1) * sizeof(double));
  if (size > 0) CHECK_ERROR(TalusModelPoints(model, name, NULL, NULL, values, size - 1), TALUS_ERROR_ARGUMENT);
  CALL(TalusModelPoints(model, name, NULL, NULL, values, size));
  return values;
}

static void test_points(void **state)
{
  double local[3] = {0, 0, 0}, sum[3];
  int n;
  (void)state;
  TalusCase *c = open_block(0, NULL);
  TalusModel *model = create_model(c);
  run_to_end(model);
  double *x = get_field(model, "position", 3, &n), *u = get_field(model, "displacement", 3, &n),
         *id = get_field(model, "id", 1, &n);
  double *mass = get_field(model, "mass", 1, &n), *F = get_field(model, "deformation_gradient", 9, &n);
  double *volume = get_field(model, "volume", 1, &n), *stress = get_field(model, "stress", 6, &n);
  for (int p = 0; p < n; ++p) {
    const double X = x[3 * p] - u[3 * p], Y = x[3 * p + 1] - u[3 * p + 1],
                 J = F[9 * p] * F[9 * p + 4] - F[9 * p + 1] * F[9 * p + 3];
    CHECK(X > 0.25 && X < 1.25 && Y > 0 && Y < 1 && x[3 * p + 2] == 0 && u[3 * p + 2] == 0);
    CHECK_CLOSE(volume[p], J / 64, 1e-12); /* 16 cells of 4 points */
    CHECK(F[9 * p + 8] == 1 && stress[6 * p + 4] == 0 && stress[6 * p + 5] == 0);
    local[0] += mass[p];
    local[1] += mass[p] * u[3 * p + 1];
    ++local[2];
    for (int q = 0; q < p; ++q) CHECK(id[q] != id[p]);
  }
  MPI_Allreduce(local, sum, 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  CHECK_CLOSE(sum[0], 1000, 1e-9);
  CHECK(sum[1] < 0 && sum[2] == 64);
  free(x), free(u), free(id), free(mass), free(F), free(volume), free(stress);
  CALL(TalusModelDestroy(&model));
  CALL(TalusCaseClose(&c));
}

/* A body under its own weight starts with just the stress that carries it, in the volume it was
 * seeded with. */
static void test_geostatic_stress(void **state)
{
  const char *const set[] = {"bodies[0].k0=0.5", "bodies[0].surface=1", "materials.rubber.young=1e5"};
  int n;
  (void)state;
  TalusCase *c = open_block(3, set);
  TalusModel *model = create_model(c);
  double *x = get_field(model, "position", 3, &n), *stress = get_field(model, "stress", 6, &n),
         *volume = get_field(model, "volume", 1, &n);
  for (int p = 0; p < n; ++p) {
    const double vertical = -1000 * 9.81 * (1 - x[3 * p + 1]);
    CHECK_CLOSE(stress[6 * p + 1], vertical, 1e-8);
    CHECK_CLOSE(stress[6 * p], 0.5 * vertical, 1e-8);
    CHECK_CLOSE(stress[6 * p + 2], 0.5 * vertical, 1e-8);
    CHECK_CLOSE(volume[p], 1. / 64, 1e-15);
  }
  free(x), free(stress), free(volume);
  CALL(TalusModelDestroy(&model));
  CALL(TalusCaseClose(&c));
}

typedef struct {
  double b[2];
  int calls;
} Pull;

static void pull(void *context, const double X[3], double t, double b[3])
{
  Pull *p = context;
  ++p->calls;
  if (X[2] == 0 && t >= 0 && b[2] == 0) b[0] = p->b[0], b[1] = p->b[1];
}

/* A constant body force is gravity: the same motion, from the initial acceleration on. */
static void test_body_force(void **state)
{
  const char *set = "loads.gravity=[0, 0]";
  Pull context = {.b = {0, -9.81}};
  double with_gravity, with_force;
  int n;
  (void)state;
  TalusCase *heavy = open_block(0, NULL), *light = open_block(1, &set);
  TalusModel *a = create_model(heavy), *b = create_model(light);
  CALL(TalusModelSetBodyForce(b, pull, &context));
  double *acceleration = get_field(b, "acceleration", 3, &n);
  for (int p = 0; p < n; ++p) CHECK(acceleration[3 * p + 1] < 0);
  free(acceleration);
  CHECK(run_to_end(a) == run_to_end(b));
  for (int k = 0; k < 2; ++k) {
    CALL(TalusModelMeasure(a, k ? "falling" : "top", &with_gravity));
    CALL(TalusModelMeasure(b, k ? "falling" : "top", &with_force));
    CHECK_CLOSE(with_gravity, with_force, 1e-9 * fabs(with_gravity));
  }
  CHECK(context.calls > 0 || n == 0);
  CALL(TalusModelSetBodyForce(b, NULL, NULL));
  context.calls = 0;
  TalusStep step;
  CALL(TalusModelStep(b, 0.001, &step));
  CHECK(step == TALUS_STEP_ACCEPTED && context.calls == 0);
  CALL(TalusModelDestroy(&a));
  CALL(TalusModelDestroy(&b));
  CALL(TalusCaseClose(&heavy));
  CALL(TalusCaseClose(&light));
}

static void test_end(void **state)
{
  TalusCase *c = NULL;
  (void)state;
  CALL(TalusFinalize());
  CHECK_ERROR(TalusFinalize(), TALUS_ERROR_STATE);
  CHECK_ERROR(TalusInitialize(NULL, NULL), TALUS_ERROR_STATE);
  CHECK_ERROR(TalusCaseOpen(MPI_COMM_WORLD, BLOCK, 0, NULL, &c, NULL), TALUS_ERROR_STATE);
  leave_strange_folder();
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_session),
    cmocka_unit_test(test_errors_in_words),
    cmocka_unit_test(test_null),
    cmocka_unit_test(test_mistakes),
    cmocka_unit_test(test_mistakes_of_a_model),
    cmocka_unit_test(test_names),
    cmocka_unit_test(test_steps_equal_run),
    cmocka_unit_test(test_resume),
    cmocka_unit_test(test_trust),
    cmocka_unit_test(test_limits),
    cmocka_unit_test(test_failed_step),
    cmocka_unit_test(test_gave_up),
    cmocka_unit_test(test_points),
    cmocka_unit_test(test_geostatic_stress),
    cmocka_unit_test(test_body_force),
    cmocka_unit_test(test_end),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
