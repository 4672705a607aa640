/* What lets another language in: cases as texts, the model's own arrays, forces for all points at once, progress. */
#include "api_test.h"

static TalusCase *parse(const char *text)
{
  TalusCase *c = NULL;
  CALL(TalusCaseParse(MPI_COMM_WORLD, BLOCK, text, 0, NULL, &c, NULL));
  CHECK(c != NULL);
  return c;
}

static double measure(const TalusModel *model, const char *name)
{
  double value = NAN;
  CALL(TalusModelMeasure(model, name, &value));
  return value;
}

/* The list, and that a model gives each of them, whether or not the case writes it. */
static void test_fields(void **state)
{
  const char *name, *unit;
  int components, found, n = 0, stress = 0;
  double buffer[9 * 64];
  (void)state;
  TalusCase *c = open_block(0, NULL);
  TalusModel *model = create_model(c);
  while (!TalusField(n, &name, &unit, &components)) {
    stress += !strcmp(name, "stress") && !strcmp(unit, "Pa") && components == 6;
    CALL(TalusModelPoints(model, name, NULL, &found, buffer, 9 * 64));
    CHECK(found == components);
    ++n;
  }
  CALL(TalusModelDestroy(&model));
  CALL(TalusCaseClose(&c));
  CHECK(n > 10 && stress == 1);
  CHECK_ERROR(TalusField(-1, NULL, NULL, NULL), TALUS_ERROR_ARGUMENT);
}

/* The resolved case in words is a case again, and the same one; JSON is read like YAML. */
static void test_text(void **state)
{
  char *first, *second, *messages;
  (void)state;
  TalusCase *c = open_block(0, NULL), *again, *wrong = (TalusCase *)&first;
  CALL(TalusCaseText(c, &first));
  CHECK(strstr(first, "density: 1000  # kg/m3"));
  again = parse(first);
  CALL(TalusCaseText(again, &second));
  CHECK(!strcmp(first, second));
  TalusTextFree(&first);
  TalusTextFree(&second);
  CALL(TalusCaseClose(&c));
  CALL(TalusCaseClose(&again));
  CHECK_ERROR(
    TalusCaseParse(MPI_COMM_WORLD, "mine", "{\"kinematics\":\n \"plain-strain\"}", 0, NULL, &wrong, &messages),
    TALUS_ERROR_INPUT);
  CHECK(wrong == NULL && messages && strstr(messages, "mine:2:3: error: kinematics"));
  TalusTextFree(&messages);
  CHECK_ERROR(TalusCaseParse(MPI_COMM_WORLD, "mine", NULL, 0, NULL, &wrong, NULL), TALUS_ERROR_ARGUMENT);
}

/* A velocity written between steps is one of the case, to the last bit. */
static void test_arrays(void **state)
{
  const char *set[] = {"bodies[0].velocity=[0.5, -1]"};
  double *v, *other, *x, copy[3 * 64];
  int n, dim, writable;
  (void)state;
  TalusCase *resting = open_block(0, NULL), *moving = open_block(1, set);
  TalusModel *a = create_model(resting), *b = create_model(moving);
  CALL(TalusModelArray(a, "velocity", &v, &n, &dim, &writable));
  CHECK(dim == 2 && writable);
  for (int p = 0; p < n; ++p) v[2 * p] = 0.5, v[2 * p + 1] = -1;
  CALL(TalusModelChanged(a));
  run_to_end(a);
  run_to_end(b);
  CHECK(measure(a, "top") == measure(b, "top") && measure(a, "falling") == measure(b, "falling"));
  CALL(TalusModelArray(a, "velocity", &v, &n, NULL, NULL));
  CALL(TalusModelArray(b, "velocity", &other, NULL, NULL, NULL));
  CHECK(n == 0 || !memcmp(v, other, sizeof(double) * 2 * (size_t)n));
  CALL(TalusModelArray(a, "position", &x, &n, &dim, &writable));
  CALL(TalusModelPoints(a, "position", NULL, NULL, copy, 3 * 64));
  CHECK(!writable);
  for (int p = 0; p < n; ++p) CHECK(x[2 * p] == copy[3 * p] && x[2 * p + 1] == copy[3 * p + 1]);
  CHECK_ERROR(TalusModelArray(a, "colour", &x, NULL, NULL, NULL), TALUS_ERROR_UNKNOWN);
  CHECK_ERROR(TalusModelArray(a, "mass", NULL, NULL, NULL, NULL), TALUS_ERROR_ARGUMENT);
  CHECK_ERROR(TalusModelChanged(NULL), TALUS_ERROR_ARGUMENT);
  CALL(TalusModelDestroy(&a));
  CALL(TalusModelDestroy(&b));
  CALL(TalusCaseClose(&resting));
  CALL(TalusCaseClose(&moving));
}

/* Nodes of fem keep their motion: it is shown, and not to be written. */
static void test_arrays_of_fem(void **state)
{
  const char *set[] = {"method=fem"};
  double *v;
  int writable;
  (void)state;
  TalusCase *c = open_block(1, set);
  TalusModel *model = create_model(c);
  CALL(TalusModelArray(model, "velocity", &v, NULL, NULL, &writable));
  CHECK(!writable);
  CALL(TalusModelArray(model, "state", &v, NULL, NULL, &writable));
  CHECK(writable);
  CALL(TalusModelDestroy(&model));
  CALL(TalusCaseClose(&c));
}

/* Gravity as a force; x must be where the points were before the step. */
static void weigh(void *context, int n, const double *X, const double *x, double t, double *b)
{
  (void)t;
  for (int i = 0; i < n; ++i) {
    *(double *)context = fmax(*(double *)context, fabs(x[3 * i + 1] - X[3 * i + 1]));
    CHECK(X[3 * i + 2] == 0 && x[3 * i + 2] == 0 && b[3 * i] == 0);
    b[3 * i + 1] = -9.81;
  }
}

static int three_steps(void *context, int step, double time, double end)
{
  CHECK(step == ++*(int *)context && time > 0 && time <= end && end == 0.01);
  return step == 3;
}

/* A whole run with forces equals one with gravity; its caller may end it, and go on with it. */
static void test_run(void **state)
{
  const char *set[] = {"loads.gravity=[0, 0]"}, *none[] = {"checkpoint.keep=3"};
  char folder[FOLDER], out[FOLDER + 8], file[FOLDER + 24], *messages;
  double travel = 0, largest, value, whole;
  int calls = 0;
  TalusOutcome outcome;
  TalusRun *run;
  (void)state;
  make_folder(folder);
  snprintf(out, sizeof out, "%s/run", folder);
  snprintf(file, sizeof file, "%s/case.yaml", out);
  TalusCase *heavy = open_block(0, NULL), *light = open_block(1, set);
  TalusModel *model = create_model(heavy);
  run_to_end(model);
  whole = measure(model, "top");
  CALL(TalusModelDestroy(&model));
  CALL(TalusCaseSetBodyForces(light, weigh, &travel));
  CALL(TalusCaseSetProgress(light, three_steps, &calls));
  CALL(TalusRunCase(light, out, TALUS_RUN_QUIET, &run, &messages));
  CALL(TalusRunOutcome(run, &outcome));
  CHECK(outcome == TALUS_GAVE_UP && calls == 3 && messages &&
        strstr(messages, "by the program that called it, after step 3"));
  TalusTextFree(&messages);
  CALL(TalusRunDestroy(&run));
  CALL(TalusCaseClose(&light));
  CALL(TalusCaseOpen(MPI_COMM_WORLD, file, 1, none, &light, NULL));
  CHECK_ERROR(TalusRunCase(light, out, TALUS_RUN_QUIET | TALUS_RUN_RESUME, &run, &messages), TALUS_ERROR_INPUT);
  CHECK(messages && strstr(messages, "functions of its caller for: body_force; now there are: none"));
  TalusTextFree(&messages);
  CALL(TalusCaseSetBodyForces(light, weigh, &travel));
  CALL(TalusRunCase(light, out, TALUS_RUN_QUIET | TALUS_RUN_RESUME, &run, NULL));
  CALL(TalusRunMeasure(run, "top", &value));
  CHECK_CLOSE(value, whole, 1e-9 * fabs(whole));
  MPI_Allreduce(&travel, &largest, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  CHECK_CLOSE(largest, 0.5 * 9.81 * 0.008 * 0.008, 2e-5); /* until the last step began */
  CALL(TalusRunDestroy(&run));
  CALL(TalusCaseClose(&heavy));
  CALL(TalusCaseClose(&light));
  remove_folder(folder);
}

/* What a function that a step asks may not do to its model, and still the step is one. */
typedef struct {
  TalusModel *model;
  int calls;
} Meddler;

static void meddle(void *context, int n, const double *X, const double *x, double t, double *b)
{
  Meddler *m = context;
  TalusModel *model = m->model;
  TalusStep step;
  (void)n, (void)X, (void)x, (void)t, (void)b;
  ++m->calls;
  CHECK_ERROR(TalusModelStep(model, 0, &step), TALUS_ERROR_BUSY);
  CHECK_ERROR(TalusModelSetBodyForces(model, NULL, NULL), TALUS_ERROR_BUSY);
  CHECK_ERROR(TalusModelSetBodyForce(model, NULL, NULL), TALUS_ERROR_BUSY);
  CHECK_ERROR(TalusModelSetLoadFactors(model, "tractions[0]", NULL, NULL), TALUS_ERROR_BUSY);
  CHECK_ERROR(TalusModelChanged(model), TALUS_ERROR_BUSY);
  CHECK_ERROR(TalusModelDestroy(&model), TALUS_ERROR_BUSY);
  CHECK(model == m->model);
}

static void test_busy(void **state)
{
  double whole;
  (void)state;
  TalusCase *c = open_block(0, NULL);
  Meddler m = {create_model(c), 0};
  run_to_end(m.model);
  whole = measure(m.model, "top");
  CALL(TalusModelDestroy(&m.model));
  m.model = create_model(c);
  CALL(TalusModelSetBodyForces(m.model, meddle, &m));
  run_to_end(m.model);
  CHECK(m.calls >= 5 && measure(m.model, "top") == whole);
  CALL(TalusModelDestroy(&m.model));
  CALL(TalusCaseClose(&c));
}

/* Likewise of a run and its case. */
static int close_case(void *context, int step, double time, double end)
{
  TalusCase *c = context, *same = c;
  TalusRun *run;
  (void)step, (void)time, (void)end;
  CHECK_ERROR(TalusRunCase(c, "nowhere", 0, &run, NULL), TALUS_ERROR_BUSY);
  CHECK_ERROR(TalusCaseClose(&same), TALUS_ERROR_BUSY);
  CHECK(run == NULL && same == c);
  return 0;
}

static void test_busy_case(void **state)
{
  char folder[FOLDER], out[FOLDER + 8];
  TalusRun *run;
  (void)state;
  make_folder(folder);
  snprintf(out, sizeof out, "%s/run", folder);
  TalusCase *c = open_block(0, NULL);
  CALL(TalusCaseSetProgress(c, close_case, c));
  CALL(TalusRunCase(c, out, TALUS_RUN_QUIET, &run, NULL));
  CALL(TalusRunDestroy(&run));
  CALL(TalusCaseClose(&c));
  remove_folder(folder);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_fields),        cmocka_unit_test(test_text), cmocka_unit_test(test_arrays),
    cmocka_unit_test(test_arrays_of_fem), cmocka_unit_test(test_run),  cmocka_unit_test(test_busy),
    cmocka_unit_test(test_busy_case),
  };
  CALL(TalusInitialize(&argc, &argv));
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  CALL(TalusFinalize());
  return failed;
}
