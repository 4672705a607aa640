/* Values of keys, numbers taken from a history, units of keys. No run. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
/* cmocka wants those before it */
#include <cmocka.h>
#include "input/case_file.h"
#include "sweep/sweep_private.h"

#define OK(call) assert_int_equal((call), 0)

/* The values of one key, joined by '|'; the number of errors. */
static PetscInt expand(const char *text, char joined[256])
{
  const SweepWord word = {SWEEP_OVER, "key"};
  SweepKey key = {.key = (char *)"key", .text = (char *)text, .word = &word};
  Diag *diag;
  OK(DiagCreate(&diag));
  OK(SweepKeyExpand(&key, PETSC_FALSE, NULL, diag));
  sweep_key_check_twice(&key, NULL, diag);
  const PetscInt errors = diag_errors(diag);
  joined[0] = '\0';
  for (PetscInt i = 0; i < key.n; ++i) {
    if (i) strcat(joined, "|");
    strcat(joined, key.value[i]);
    OK(PetscFree(key.value[i]));
  }
  OK(PetscFree(key.value));
  OK(DiagDestroy(&diag));
  return errors;
}

static void test_values(void **state)
{
  static const char *const cases[][2] = {
    {"35:47:2", "35|37|39|41|43|45|47"},
    {"35:46:2", "35|37|39|41|43|45"},
    {"0.1:0.3:0.1", "0.1|0.2|0.3"},
    {"3:1:-1", "3|2|1"},
    {"5:5:1", "5"},
    {"0, 10:20:5,  40", "0|10|15|20|40"},
    {"[0, -9.81], [1, 0]", "[0, -9.81]|[1, 0]"},
    {"{a: 1, b: [2, 3]},fem", "{a: 1, b: [2, 3]}|fem"},
    {"'a,b','c'", "'a,b'|'c'"},
    {"a:b:c", "a:b:c"},
    {"-1e-3:1e-3:1e-3", "-0.001|0|0.001"},
  };
  static const char *const bad[] = {"1:2", "1:2:-1", "2:1:1", "1:2:0", "", "1,", ",1", "1,1", "0:1e9:1", "1:3:1,2"};
  char joined[256];
  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
    assert_int_equal(expand(cases[k][0], joined), 0);
    assert_string_equal(joined, cases[k][1]);
  }
  for (size_t k = 0; k < sizeof bad / sizeof bad[0]; ++k) assert_int_equal(expand(bad[k], joined), 1);
}

/* A measure that goes along lines. */
static const TakenMeans lines = {1, (const PetscBool[]){PETSC_FALSE}};

static PetscReal take(Take what, PetscReal from, PetscReal to, const History *history)
{
  const Taken taken = {
    .measure = (char *)"y", .take = what, .has_window = to > from, .from = from, .to = to, .times = 2};
  char why[TAKEN_WHY];
  const PetscReal value = taken_value(&taken, &lines, history, why);
  assert_true(!PetscIsNanReal(value) || why[0] || (what == TAKE_END && !taken.has_window));
  return value;
}

/* y = 3 t - 1 at moments that are not evenly spaced: trapezia and least squares are exact. */
static void test_taken(void **state)
{
  PetscReal rows[6][3];
  char *names[] = {(char *)"time", (char *)"step", (char *)"y"};
  static const PetscReal times[6] = {0, 0.1, 0.15, 0.6, 0.8, 2};
  const History history = {.n_rows = 6, .n_columns = 3, .names = names, .values = rows[0]};
  (void)state;
  for (int i = 0; i < 6; ++i) rows[i][0] = times[i], rows[i][1] = i, rows[i][2] = 3 * times[i] - 1;
  assert_true(take(TAKE_END, 0, 0, &history) == 10);
  assert_true(take(TAKE_END, 0.1, 0.8, &history) == 2 * (3 * 0.8 - 1));
  assert_true(take(TAKE_MAX, 0, 0.6, &history) == 2 * (3 * 0.6 - 1));
  assert_true(take(TAKE_MIN, 0.1, 2, &history) == 2 * (3 * 0.1 - 1));
  assert_float_equal(take(TAKE_MEAN, 0, 0, &history), 4, 1e-14);
  assert_float_equal(take(TAKE_MEAN, 0.1, 0.6, &history), 2 * (3 * 0.35 - 1), 1e-14);
  assert_float_equal(take(TAKE_SLOPE, 0, 0, &history), 6, 1e-13);
  assert_true(PetscIsNanReal(take(TAKE_MEAN, 3, 4, &history)));
  rows[2][2] = NAN;
  assert_true(PetscIsNanReal(take(TAKE_MAX, 0, 0, &history)));
  assert_true(PetscIsNanReal(take(TAKE_MIN, 0, 0, &history)));
  assert_true(PetscIsNanReal(take(TAKE_MEAN, 0, 0, &history)));
}

/* A roof, 0 1 0 at 0 1 2 s, cut by windows between its rows: the lines are known in closed form. */
static void test_window_between_rows(void **state)
{
  PetscReal rows[3][2] = {{0, 0}, {1, 1}, {2, 0}};
  char *names[] = {(char *)"time", (char *)"y"};
  const History history = {.n_rows = 3, .n_columns = 2, .names = names, .values = rows[0]};
  (void)state;
  assert_float_equal(take(TAKE_MEAN, 0.5, 1.75, &history), 2 * (0.375 + 0.46875) / 1.25, 1e-14);
  assert_float_equal(take(TAKE_MIN, 0.5, 1.75, &history), 2 * 0.25, 1e-14);
  assert_float_equal(take(TAKE_MAX, 0.5, 1.75, &history), 2 * 1, 1e-14);
  assert_float_equal(take(TAKE_END, 0.5, 1.75, &history), 2 * 0.25, 1e-14);
  assert_float_equal(take(TAKE_MEAN, 0.25, 0.75, &history), 2 * 0.5, 1e-14); /* no row in it */
  assert_float_equal(take(TAKE_MIN, 0.25, 0.75, &history), 2 * 0.25, 1e-14);
  assert_float_equal(take(TAKE_MAX, 0.25, 0.75, &history), 2 * 0.75, 1e-14);
  assert_float_equal(take(TAKE_END, 0.25, 0.75, &history), 2 * 0.75, 1e-14);
  assert_float_equal(take(TAKE_MEAN, 1, 1.5, &history), 2 * 0.75, 1e-14); /* from a row on */
  assert_float_equal(take(TAKE_SLOPE, 0.9, 2, &history), -2, 1e-14);
}

/* A force, whose rows are means since the row before: 4 for 1 s, then 0 for 2 s, then, in a stage of statics, a line
 * from there to 6. Its impulse is 4 + 0 + 3, whatever the row at the start says. */
static void test_means(void **state)
{
  PetscReal rows[4][3] = {{0, 1, 9}, {1, 1, 4}, {3, 1, 0}, {4, 2, 6}};
  char *names[] = {(char *)"time", (char *)"stage", (char *)"y"};
  const History history = {.n_rows = 4, .n_columns = 3, .names = names, .values = rows[0]};
  const TakenMeans means = {2, (const PetscBool[]){PETSC_TRUE, PETSC_FALSE}};
  static const struct {
    Take what;
    PetscReal from, to, is;
  } cases[] = {{TAKE_MEAN, 0, 0, 7. / 4},  {TAKE_MEAN, 0, 3, 4. / 3}, {TAKE_MEAN, 0.5, 2, 2 / 1.5},
               {TAKE_MEAN, 0.25, 0.75, 4}, {TAKE_MEAN, 2, 3.5, 0.5},  {TAKE_MAX, 0.25, 0.75, 4},
               {TAKE_MIN, 0.25, 0.75, 4},  {TAKE_END, 0.25, 0.75, 4}, {TAKE_END, 0, 1, 4},
               {TAKE_MAX, 1.5, 2.5, 0},    {TAKE_END, 2, 3.5, 3}};
  char why[TAKEN_WHY];
  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
    const Taken taken = {.measure = (char *)"y",
                         .take = cases[k].what,
                         .has_window = (PetscBool)(cases[k].to > 0),
                         .from = cases[k].from,
                         .to = cases[k].to,
                         .times = 1};
    assert_float_equal(taken_value(&taken, &means, &history, why), cases[k].is, 1e-14);
  }
}

static PetscReal take_and_say(Take what, PetscReal from, PetscReal to, const History *history, const char *must)
{
  const Taken taken = {
    .measure = (char *)"y", .take = what, .has_window = PETSC_TRUE, .from = from, .to = to, .times = 1};
  char why[TAKEN_WHY];
  const PetscReal value = taken_value(&taken, &lines, history, why);
  if (!strstr(why, must)) fail_msg("'%s' does not say '%s'", why, must);
  if (!must[0]) assert_string_equal(why, "");
  return value;
}

/* What the history does not have is told, and is no number or that of the part that it has. */
static void test_window_beyond(void **state)
{
  PetscReal rows[3][2] = {{0, 0}, {1, 1}, {2, 0}};
  char *names[] = {(char *)"time", (char *)"y"};
  const History history = {.n_rows = 3, .n_columns = 2, .names = names, .values = rows[0]};
  (void)state;
  assert_float_equal(take_and_say(TAKE_MEAN, 1.5, 3, &history, "reaches beyond the history"), 0.25, 1e-14);
  assert_float_equal(take_and_say(TAKE_MAX, 1.5, 3, &history, "taken from 1.5 to 2 s alone"), 0.5, 1e-14);
  assert_true(PetscIsNanReal(take_and_say(TAKE_MEAN, 3, 4, &history, "lies outside of the history")));
  assert_true(PetscIsNanReal(take_and_say(TAKE_SLOPE, 0.5, 1.5, &history, "a slope needs two rows")));
  assert_true(PetscIsNanReal(take_and_say(TAKE_SLOPE, 0.25, 0.75, &history, "a slope needs two rows")));
  assert_float_equal(take_and_say(TAKE_MEAN, 0.5, 2 + 1e-12, &history, ""), (0.375 + 0.5) / 1.5, 1e-11);
  rows[1][1] = NAN;
  assert_true(PetscIsNanReal(take_and_say(TAKE_MEAN, 1, 2, &history, "no value (nan) at 1 s")));
}

static void test_units(void **state)
{
  static const char *const cases[][2] = {
    {"materials.sugar.friction_angle", "deg"},
    {"materials.sugar.young", "Pa"},
    {"materials.x.density", "kg/m3"},
    {"grid.size", "m"},
    {"grid.box.min[1]", "m"},
    {"loads.gravity", "m/s2"},
    {"bodies[0].shape.box.max[0]", "m"},
    {"measures.tip.of.tracer", "m"},
    {"analysis.end", "s"},
  };
  static const char *const none[] = {"method", "materials.sugar", "materials.sugar.law", "nothing", "", "grid..size",
                                     "."};
  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
    assert_non_null(schema_unit(cases[k][0]));
    assert_string_equal(schema_unit(cases[k][0]), cases[k][1]);
  }
  for (size_t k = 0; k < sizeof none / sizeof none[0]; ++k) assert_null(schema_unit(none[k]));
}

/* Members of a product: the last axis is the fastest. */
static void test_product(void **state)
{
  SweepAxis axes[3] = {{.key = {.n = 2}}, {.key = {.n = 3}}, {.key = {.n = 4}}};
  const SweepSpecification sweep = {.n_axes = 3, .axes = axes};
  PetscInt member = 0;
  (void)state;
  for (PetscInt a = 0; a < 2; ++a)
    for (PetscInt b = 0; b < 3; ++b)
      for (PetscInt c = 0; c < 4; ++c, ++member) {
        assert_int_equal(sweep_at(&sweep, member, 0), a);
        assert_int_equal(sweep_at(&sweep, member, 1), b);
        assert_int_equal(sweep_at(&sweep, member, 2), c);
      }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_values),        cmocka_unit_test(test_taken),
    cmocka_unit_test(test_means),         cmocka_unit_test(test_window_between_rows),
    cmocka_unit_test(test_window_beyond), cmocka_unit_test(test_units),
    cmocka_unit_test(test_product),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
