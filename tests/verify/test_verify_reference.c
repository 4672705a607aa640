/* The language of reference.yaml, the arithmetic of its checks, and the record. No run. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
/* cmocka wants those before it */
#include <cmocka.h>
#include "verify/verify_private.h"

#define OK(call) assert_int_equal((call), 0)

static const char good[] =
  "title: A test\n"
  "studies:\n"
  "  tip:\n"
  "    title: The tip\n"
  "    measure: tip\n"
  "    sweep: {name: cells, symbol: n, set: {'grid.counts': [$n, $n], 'grid.name': 'a $nn $n'}}\n"
  "    series:\n"
  "      fem: {set: {method: fem}}\n"
  "      mpm: {set: {method: mpm}, full: true, tolerance: 0.5, source: nowhere, confidence: assumed}\n"
  "    tolerance: 1e-2\n"
  "    source: a book\n"
  "    confidence: given\n"
  "    rows:\n"
  "      - {at: 2, reference: 1.25}\n"
  "      - {at: 4, references: {mpm: 1.0625}, set: {method: gmm}, source: a page}\n"
  "    exact: {value: 1, order: 2, order-tolerance: 0.25, between: [2, 4]}\n"
  "    agree: [{series: mpm, with: fem, tolerance: 1e-10}]\n"
  "    limits: {iterations: 7}\n"
  "    figure: convergence\n";

/* `good` with one line replaced. */
static char *with_line(int line, const char *replacement)
{
  static char text[4096];
  const char *from = good;
  size_t used = 0;
  for (int k = 1; *from; ++k) {
    const size_t n = strcspn(from, "\n") + 1;
    if (k == line) used += (size_t)snprintf(text + used, sizeof text - used, "%s\n", replacement);
    else used += (size_t)snprintf(text + used, sizeof text - used, "%.*s", (int)n, from);
    from += n;
  }
  return text;
}

/* Read a text as a file; `messages` (free) gets what diag says. */
static Reference *read_text(const char *text, char **messages)
{
  char file[] = "/tmp/talus-reference-XXXXXX";
  const int fd = mkstemp(file);
  Reference *reference = NULL;
  size_t size;
  Diag *diag;
  assert_true(fd >= 0);
  assert_int_equal(write(fd, text, strlen(text)), (ssize_t)strlen(text));
  close(fd);
  OK(DiagCreate(&diag));
  OK(ReferenceRead(PETSC_COMM_SELF, file, diag, &reference));
  FILE *out = open_memstream(messages, &size);
  OK(DiagFlush(diag, out));
  fclose(out);
  OK(DiagDestroy(&diag));
  unlink(file);
  return reference;
}

static Reference *read_good(void)
{
  char *messages;
  Reference *reference = read_text(good, &messages);
  assert_string_equal(messages, "");
  free(messages);
  assert_non_null(reference);
  return reference;
}

static void reads_a_study(void **state)
{
  (void)state;
  Reference *reference = read_good();
  const StudySpec *study = &reference->studies[0];
  assert_int_equal(reference->n_studies, 1);
  assert_string_equal(study->name, "tip");
  assert_int_equal(study->n_series, 2);
  assert_int_equal(study->n_rows, 2);
  assert_true(study->series[1].full && !study->series[0].full);
  assert_true(study->rows[1].x == 4);
  assert_true(reference_value(&study->rows[0], &study->series[1]) == 1.25);
  assert_true(PetscIsNanReal(reference_value(&study->rows[1], &study->series[0])));
  assert_true(reference_value(&study->rows[1], &study->series[1]) == 1.0625);
  assert_true(reference_tolerance(study, &study->rows[0], &study->series[0]) == 1e-2);
  assert_true(reference_tolerance(study, &study->rows[0], &study->series[1]) == 0.5);
  assert_string_equal(reference_source(study, &study->rows[0], &study->series[0])->text, "a book");
  assert_int_equal(reference_source(study, &study->rows[0], &study->series[1])->confidence, CONFIDENCE_ASSUMED);
  assert_string_equal(reference_source(study, &study->rows[1], &study->series[1])->text, "a page");
  assert_true(reference_exact(study, &study->series[1]) == 1);
  assert_true(study->exact.from == 2 && study->exact.to == 4);
  OK(ReferenceDestroy(&reference));
  assert_null(reference);
}

static void settings_replace_the_symbol(void **state)
{
  (void)state;
  Reference *reference = read_good();
  const StudySpec *study = &reference->studies[0];
  SettingList list, other;
  OK(SettingListCreate(study, &study->series[0], &study->rows[1], &list));
  assert_int_equal(list.n, 4);
  assert_string_equal(list.text[0], "method=fem");
  assert_string_equal(list.text[1], "grid.counts=[4, 4]");
  assert_string_equal(list.text[2], "grid.name=\"a $nn 4\"");
  assert_string_equal(list.text[3], "method=gmm"); /* the row's comes last, and counts */
  OK(SettingListCreate(study, &study->series[0], &study->rows[0], &other));
  assert_true(setting_lists_equal(&list, &list));
  assert_false(setting_lists_equal(&list, &other));
  OK(SettingListClear(&list));
  OK(SettingListClear(&other));
  OK(ReferenceDestroy(&reference));
}

/* What a row changes for one series alone comes after all else, and for no other series. */
static void a_row_sets_values_of_a_series(void **state)
{
  (void)state;
  char *messages;
  Reference *reference =
    read_text(with_line(14, "      - {at: 2, reference: 1, sets: {mpm: {grid.size: $n, method: sph}}}"), &messages);
  SettingList list;
  assert_string_equal(messages, "");
  free(messages);
  const StudySpec *study = &reference->studies[0];
  OK(SettingListCreate(study, &study->series[1], &study->rows[0], &list));
  assert_int_equal(list.n, 5);
  assert_string_equal(list.text[3], "grid.size=2");
  assert_string_equal(list.text[4], "method=sph");
  OK(SettingListClear(&list));
  OK(SettingListCreate(study, &study->series[0], &study->rows[0], &list));
  assert_int_equal(list.n, 3);
  OK(SettingListClear(&list));
  OK(ReferenceDestroy(&reference));
}

static void mistakes_have_places(void **state)
{
  (void)state;
  static const struct {
    int line;
    const char *text, *place, *message;
  } mistakes[] = {
    {1, "titel: A test", ":1:1: error:", "did you mean 'title'?"},
    {5, "    mesure: tip", ":5:5: error:", "did you mean 'measure'?"},
    {6, "    sweep: {name: cells}", ":6:5: error:", "key 'symbol' of studies.tip.sweep is missing"},
    {8, "      fem: {set: [1]}", ":8:18: error:", "mapping"},
    {8, "      fme: {set: {method: fem}}", ":17:33: error:", "there is no series 'fem' in this study"},
    {10, "    tolerance: -1", ":10:16: error:", ">= 0"},
    {12, "    confidence: sure", ":12:17: error:", "given"},
    {14, "      - {at: two, reference: 1}", ":14:14: error:", "numbers above 0"},
    {14, "      - {at: 4, reference: 1}", ":15:14: error:", "there is a row at 4 already"},
    {14, "      - {at: 2, reference: 1, references: {fem: 1}}", ":14:31: error:", "both 'reference' and 'references'"},
    {14, "      - {at: 2, reference: .nan}", ":14:28: error:", "number"},
    {15, "      - {at: 4, references: {mpn: 1}}", ":15:30: error:", "did you mean 'mpm'?"},
    {15, "      - {at: 4, sets: {mpn: {a: 1}}}", ":15:24: error:", "did you mean 'mpm'?"},
    {16, "    exact: {value: 1, order: 2}", ":16:23: error:", "'between'"},
    {16, "", ":19:13: error:", "needs `exact`"},
    {17, "    agree: [{series: fem, with: mpm, tolerance: 1}]", ":17:33: error:", "must stand before 'fem'"},
    {18, "    powers: [{between: [2, 4], series: mpn}]", ":18:40: error:", "did you mean 'mpm'?"},
    {18, "    powers: [{between: [3, 4]}]", ":18:24: error:", "two rows above 0 between these"},
    {18, "    powers: [{between: [2, 4], exponent: 1}]", ":18:32: error:", "'within'"},
    {18, "    limits: {iteration: 7}", ":18:14: error:", "did you mean 'iterations'?"},
    {19, "    figure: convergance", ":19:13: error:", "did you mean 'convergence'?"},
    {19, "    figure: [", ": error:", ""},
    {11, "", ":14:9: error:", "this reference has no source"},
  };
  for (size_t k = 0; k < sizeof mistakes / sizeof mistakes[0]; ++k) {
    char *messages;
    Reference *reference = read_text(with_line(mistakes[k].line, mistakes[k].text), &messages);
    if (reference || !strstr(messages, mistakes[k].place) || !strstr(messages, mistakes[k].message))
      fail_msg("'%s' gave %s, without '%s' and '%s':\n%s", mistakes[k].text, reference ? "a reference" : "none",
               mistakes[k].place, mistakes[k].message, messages);
    free(messages);
  }
}

static void nonsense_is_refused(void **state)
{
  (void)state;
  static const char *const texts[] = {
    "", "[1, 2]", "studies", "title: x\nstudies: {}\n", "\x01\x02\xff", "title: x\nstudies: {a: 1}\n"};
  for (size_t k = 0; k < sizeof texts / sizeof texts[0]; ++k) {
    char *messages;
    assert_null(read_text(texts[k], &messages));
    assert_non_null(strstr(messages, "error:"));
    free(messages);
  }
}

/* Rows with given values, as if they had run: two of fem, two of mpm. */
static void make_rows(const Reference *reference, PetscReal *values, VerifyRow rows[4])
{
  const StudySpec *study = &reference->studies[0];
  for (PetscInt k = 0; k < 4; ++k) {
    rows[k] = (VerifyRow){.study = study,
                          .series = &study->series[k / 2],
                          .row = &study->rows[k % 2],
                          .n_measures = 1,
                          .measures = &values[k],
                          .value = values[k],
                          .ran = PETSC_TRUE,
                          .result = RUN_DONE,
                          .summary = {.steps = 1, .iterations = 5, .iterations_per_step = 5}};
    verify_judge(rows, k);
  }
}

static void judges_what_is_right(void **state)
{
  (void)state;
  Reference *reference = read_good();
  PetscReal values[4] = {1.25, 1.0625, 1.25, 1.0625};
  VerifyRow rows[4];
  make_rows(reference, values, rows);
  for (int k = 0; k < 4; ++k) assert_true(rows[k].pass);
  assert_true(rows[0].deviation == 0 && PetscIsNanReal(rows[1].deviation) && PetscIsNanReal(rows[0].difference));
  assert_true(rows[0].error == 0.25 && PetscIsNanReal(rows[0].order));
  /* the variable grows with refinement: the error falls all the same */
  assert_true(fabs(rows[1].order - 2) < 1e-14);
  assert_true(PetscIsNanReal(rows[2].order)); /* not across series */
  assert_true(rows[2].difference == 0 && rows[3].difference == 0);
  OK(ReferenceDestroy(&reference));
}

static void judges_what_is_wrong(void **state)
{
  (void)state;
  Reference *reference = read_good();
  VerifyRow rows[4];
  PetscReal off[4] = {1.28, 1.07, 1.25, NAN};
  make_rows(reference, off, rows);
  assert_false(rows[0].pass);
  assert_non_null(strstr(rows[0].why, "off the reference, allowed 0.01"));
  assert_true(fabs(rows[0].deviation - 0.024) < 1e-14);
  assert_true(rows[1].pass); /* order 2 of errors 0.28 and 0.07; no reference for fem here */
  assert_non_null(strstr(rows[2].why, "off fem, allowed 1e-10"));
  assert_non_null(strstr(rows[3].why, "not finite"));

  PetscReal slow[4] = {1.25, 1.125, 1.25, 1.125};
  make_rows(reference, slow, rows);
  assert_non_null(strstr(rows[1].why, "order 1.000, expected 2 within 0.25"));
  assert_true(rows[0].pass);

  rows[0].summary.iterations = 8;
  verify_judge(rows, 0);
  assert_string_equal(rows[0].why, "iterations = 8, allowed 7");
  rows[0].result = RUN_GAVE_UP;
  verify_judge(rows, 0);
  assert_non_null(strstr(rows[0].why, "gave up"));
  verify_judge(rows, 1); /* nothing to compare with: neither order nor failure */
  assert_true(rows[1].pass && PetscIsNanReal(rows[1].order));
  OK(ReferenceDestroy(&reference));
}

/* --- tables: what is asked of one row, and whether it passes --- */
static char name_a[] = "a", name_b[] = "b", name_c[] = "c", name_1[] = "1", name_2[] = "2";
static SeriesSpec abc[3] = {{.name = name_a}, {.name = name_b}, {.name = name_c}};

/* Rows of series a, b, c with these values, at the one row of the study; the last is judged. */
static VerifyRow judged(const StudySpec *study, RowSpec *row, const PetscReal values[3])
{
  VerifyRow rows[3];
  for (PetscInt k = 0; k < 3; ++k) {
    rows[k] = (VerifyRow){.study = study,
                          .series = &abc[k],
                          .row = row,
                          .value = values[k],
                          .ran = PETSC_TRUE,
                          .result = RUN_DONE,
                          .seconds = 4 + k,
                          .summary = {.steps = 10, .iterations = 30, .iterations_per_step = 5, .halvings = 2}};
    verify_judge(rows, k);
  }
  return rows[2];
}

/* Every agreement counts, whatever the others say, and only those of the row's own series. */
static void judges_every_agreement(void **state)
{
  static const struct {
    PetscReal a, b, c;
    AgreeSpec agree[3];
    PetscBool pass;
    PetscReal difference;
  } table[] = {
    {1, 1, 1, {{name_c, name_a, 0.01, 0}, {name_c, name_b, 0.01, 0}}, PETSC_TRUE, 0},
    {1, 1.1, 1, {{name_c, name_a, 0.01, 0}, {name_c, name_b, 0.01, 0}}, PETSC_FALSE, 0.1 / 1.1},
    {1.1, 1, 1, {{name_c, name_a, 0.01, 0}, {name_c, name_b, 0.01, 0}}, PETSC_FALSE, 0.1 / 1.1},
    {1, 1.1, 1, {{name_c, name_a, 0.01, 0}, {name_c, name_b, 0.2, 0}}, PETSC_TRUE, 0.1 / 1.1},
    {1, 1.1, 1, {{name_b, name_a, 0.01, 0}, {name_c, name_a, 0.01, 0}}, PETSC_TRUE, 0},
    {1,
     1.1,
     1,
     {{name_b, name_a, 0.01, 0}, {name_c, name_a, 0.01, 0}, {name_c, name_b, 0.05, 0}},
     PETSC_FALSE,
     0.1 / 1.1},
    {-2, 3, 2, {{name_c, name_a, 1.9, 0}}, PETSC_FALSE, 2},
    {0, 3, 1e-3, {{name_c, name_a, 1e-2, 0}}, PETSC_TRUE, 1e-3}, /* nothing to be relative to */
    {5, 3, 5.2, {{name_c, name_a, 1e-2, 0.16}}, PETSC_TRUE, 0.04},
    {5, 3, 5.2, {{name_c, name_a, 1e-2, 0.14}}, PETSC_FALSE, 0.04},
    {0, 3, 0.15, {{name_c, name_a, 1e-2, 0.16}}, PETSC_TRUE, 0.15},
  };
  (void)state;
  for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
    RowSpec row = {.at = name_1, .x = 1};
    StudySpec study = {.name = name_a, .n_series = 3, .series = abc, .n_rows = 1, .rows = &row, .tolerance = 1};
    study.agree = (AgreeSpec *)table[k].agree;
    while (study.n_agree < 3 && table[k].agree[study.n_agree].series) ++study.n_agree;
    const VerifyRow r = judged(&study, &row, (PetscReal[]){table[k].a, table[k].b, table[k].c});
    if (r.pass != table[k].pass) print_error("agreement %d: %s\n", (int)k, r.why);
    assert_true(r.pass == table[k].pass);
    assert_true(fabs(r.difference - table[k].difference) < 1e-14);
  }
}

/* References: relative to their size, with an absolute share, one-sided. */
static void judges_distances(void **state)
{
  static const struct {
    PetscReal value, reference, tolerance, absolute;
    PetscBool at_most, pass;
    PetscReal deviation;
  } table[] = {
    {1.009, 1, 0.01, 0, PETSC_FALSE, PETSC_TRUE, 0.009},    {1.011, 1, 0.01, 0, PETSC_FALSE, PETSC_FALSE, 0.011},
    {0.989, 1, 0.01, 0, PETSC_FALSE, PETSC_FALSE, 0.011},   {-1.009, -1, 0.01, 0, PETSC_FALSE, PETSC_TRUE, 0.009},
    {-1.011, -1, 0.01, 0, PETSC_FALSE, PETSC_FALSE, 0.011}, {1, -1, 0.5, 0, PETSC_FALSE, PETSC_FALSE, 2},
    {505, 500, 0.011, 0, PETSC_FALSE, PETSC_TRUE, 0.01},    {505, 500, 0.009, 0, PETSC_FALSE, PETSC_FALSE, 0.01},
    {505, 500, 0.009, 1, PETSC_FALSE, PETSC_TRUE, 0.01},    {0.5, 0, 0.9, 0.4, PETSC_FALSE, PETSC_FALSE, 0.5},
    {0.3, 0, 0, 0.4, PETSC_FALSE, PETSC_TRUE, 0.3},         {0.1, 1, 0.01, 0, PETSC_TRUE, PETSC_TRUE, 0},
    {1.005, 1, 0.01, 0, PETSC_TRUE, PETSC_TRUE, 0.005},     {1.02, 1, 0.01, 0, PETSC_TRUE, PETSC_FALSE, 0.02},
  };
  (void)state;
  for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
    RowSpec row = {.at = name_1, .x = 1, .has_reference = PETSC_TRUE, .reference = table[k].reference};
    const StudySpec study = {.name = name_a,
                             .n_series = 3,
                             .series = abc,
                             .n_rows = 1,
                             .rows = &row,
                             .tolerance = table[k].tolerance,
                             .absolute = table[k].absolute,
                             .at_most = table[k].at_most};
    const PetscReal v = table[k].value;
    const VerifyRow r = judged(&study, &row, (PetscReal[]){v, v, v});
    if (r.pass != table[k].pass) print_error("distance %d: %s\n", (int)k, r.why);
    assert_true(r.pass == table[k].pass);
    assert_true(fabs(r.deviation - table[k].deviation) < 1e-14);
  }
}

/* Each number of a run has its own bound, and the last of several counts, too. */
static void judges_every_limit(void **state)
{
  static const struct {
    const char *name;
    PetscReal value;
  } is[] = {{"iterations", 30}, {"iterations-per-step", 5}, {"steps", 10}, {"halvings", 2}, {"seconds", 6}};
  (void)state;
  for (int k = 0; k < 5; ++k)
    for (int over = 0; over < 2; ++over) {
      RowSpec row = {.at = name_1, .x = 1};
      NamedValue limits[2] = {{(char *)is[(k + 1) % 5].name, 1e9}, {(char *)is[k].name, is[k].value - over * 0.5}};
      const StudySpec study = {
        .n_series = 3, .series = abc, .n_rows = 1, .rows = &row, .n_limits = 2, .limits = limits};
      const VerifyRow r = judged(&study, &row, (PetscReal[]){1, 1, 1});
      assert_true(r.pass == !over);
      assert_true(!over || strstr(r.why, is[k].name));
    }
}

/* Order, and pace: of two rows of a series that refines twice by a factor of two or three. */
static void judges_orders(void **state)
{
  static const struct {
    PetscReal x, error, order, tolerance, from, to;
    PetscBool pass;
    PetscReal observed;
  } table[] = {
    {2, 0.25, 2, 0.1, 1, 2, PETSC_TRUE, 2},   {2, 0.5, 2, 0.1, 1, 2, PETSC_FALSE, 1},
    {2, 0.5, 1, 0.1, 1, 2, PETSC_TRUE, 1},    {2, 2, 1, 0.1, 1, 2, PETSC_FALSE, -1},
    {2, 0.125, 2, 0.1, 1, 2, PETSC_FALSE, 3}, {3, 1. / 9, 2, 0.1, 1, 3, PETSC_TRUE, 2},
    {2, 0.5, 2, 0.1, 1, 1.5, PETSC_TRUE, 1}, /* beyond the rows asked for */
    {2, 0.5, 2, 0.1, 1.5, 2, PETSC_TRUE, 1},  {0.5, 0.25, 2, 0.1, 0.5, 1, PETSC_TRUE, 2},
  };
  (void)state;
  for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
    RowSpec row[2] = {{.at = name_1, .x = 1}, {.at = name_2, .x = table[k].x}};
    const StudySpec study = {.n_series = 1,
                             .series = abc,
                             .n_rows = 2,
                             .rows = row,
                             .has_exact = PETSC_TRUE,
                             .exact = {.has_value = PETSC_TRUE,
                                       .value = -4,
                                       .order = table[k].order,
                                       .order_tolerance = table[k].tolerance,
                                       .from = table[k].from,
                                       .to = table[k].to}};
    VerifyRow rows[2];
    for (int i = 0; i < 2; ++i) {
      rows[i] = (VerifyRow){.study = &study, .series = abc, .row = &row[i], .result = RUN_DONE};
      rows[i].value = -4 * (1 - 0.1 * (i ? table[k].error : 1));
      verify_judge(rows, i);
    }
    assert_true(fabs(rows[1].error - 0.1 * table[k].error) < 1e-14);
    assert_true(fabs(rows[1].order - table[k].observed) < 1e-12);
    if (rows[1].pass != table[k].pass) print_error("order %d: %s\n", (int)k, rows[1].why);
    assert_true(rows[1].pass == table[k].pass);
  }
}

/* (value - 5) goes with x^p by least squares: p from the covariance of the logarithms. Rows at 1, 2,
 * 4 and, not fitted, 64. */
static void judges_powers(void **state)
{
  static const struct {
    PetscReal at_1, at_2, at_4, exponent, within;
    char *series;
    PetscBool pass;
    PetscReal observed;
  } table[] = {{1, 2, 4, 1, 0.01, NULL, PETSC_TRUE, 1},     {3, 12, 48, 1, 0.01, NULL, PETSC_FALSE, 2},
               {3, 12, 48, 2, 0.01, name_a, PETSC_TRUE, 2}, {3, 12, 48, 1, 0.01, name_b, PETSC_TRUE, 2},
               {4, 2, 1, -1, 0.01, NULL, PETSC_TRUE, -1},   {1, 7, 4, 1, 0.01, NULL, PETSC_TRUE, 1},
               {1, 2, 4, 1.2, 0.19, NULL, PETSC_FALSE, 1},  {1, 2, 4, 1.2, 0.21, NULL, PETSC_TRUE, 1},
               {1, 2, 4, 0.8, 0.19, NULL, PETSC_FALSE, 1},  {1, 1, 2, 0.5, 0.01, NULL, PETSC_TRUE, 0.5},
               {1, 2, -1, 1, 2, NULL, PETSC_FALSE, -500},   {1, 2, 0, 1, 2, NULL, PETSC_FALSE, -500}};
  (void)state;
  for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
    RowSpec row[4] = {{.x = 1}, {.x = 2}, {.x = 4}, {.x = 64}};
    PowerSpec power = {.from = 1, .to = 4, .offset = 5, .has_exponent = PETSC_TRUE, .series = table[k].series};
    power.exponent = table[k].exponent, power.within = table[k].within;
    const StudySpec study = {
      .n_series = 1, .series = abc, .n_rows = 4, .rows = row, .n_powers = 1, .powers = &power, .measure = name_a};
    const PetscReal values[] = {table[k].at_1, table[k].at_2, table[k].at_4, 1e5};
    VerifyRow rows[4];
    char text[512];
    for (int i = 0; i < 4; ++i) {
      rows[i] = (VerifyRow){.study = &study, .series = abc, .row = &row[i], .result = RUN_DONE, .value = 5 + values[i]};
      verify_judge(rows, i);
      const PetscReal found = verify_exponent(rows, i, &power);
      assert_true(i == 2 ? fabs(found - table[k].observed) < 1e-12 || (table[k].observed < -400 && found < -100)
                         : PetscIsNanReal(found));
      assert_true(i == 2 || rows[i].pass);
    }
    if (rows[2].pass != table[k].pass) print_error("power %d: %s\n", (int)k, rows[2].why);
    assert_true(rows[2].pass == table[k].pass);
    verify_power_text(rows, 0, 2, &power, text);
    assert_string_equal(text, "");
    rows[1].result = RUN_GAVE_UP; /* not known any more */
    assert_true(PetscIsNanReal(verify_exponent(rows, 2, &power)));
  }
}

static void judges_pace(void **state)
{
  (void)state;
  RowSpec row = {.at = name_1, .x = 1};
  const StudySpec study = {.n_series = 3, .series = abc, .n_rows = 1, .rows = &row, .pace = name_a};
  const VerifyRow r = judged(&study, &row, (PetscReal[]){1, 1, 1});
  assert_true(fabs(r.pace - 1.5) < 1e-14);
}

static char *record_section(const char *before, const char *name, const VerifySection *section)
{
  static char text[1024];
  char file[] = "/tmp/talus-record-XXXXXX";
  const int fd = mkstemp(file);
  int error;
  assert_int_equal(write(fd, before, strlen(before)), (ssize_t)strlen(before));
  close(fd);
  OK(VerifyRecord(file, name, section, &error));
  assert_int_equal(error, 0);
  FILE *in = fopen(file, "r");
  text[fread(text, 1, sizeof text - 1, in)] = '\0';
  fclose(in);
  unlink(file);
  return text;
}

static char *record(const char *before, const char *name, const char *all)
{
  return record_section(before, name, &(VerifySection){.all = all});
}

/* A study run alone leaves the others of its case, and other cases, as they were. */
static void record_replaces_one_study(void **state)
{
  const char *const before =
    "<!-- begin a -->\n## a: A\n\n### x: X\n\n1\n\n### xy: Y\n\n2\n<!-- end a -->\n\n"
    "<!-- begin b -->\n## b: B\n\n### z: Z\n\n3\n<!-- end b -->\n";
  const char *const rest = "<!-- begin b -->\n## b: B\n\n### z: Z\n\n3\n<!-- end b -->\n";
  char expected[1024];
  (void)state;

  VerifySection section = {.all = "all\n", .study = "x", .alone = "\n### x: X\n\nnew\n"};
  sprintf(expected, "<!-- begin a -->\n## a: A\n\n### x: X\n\nnew\n\n### xy: Y\n\n2\n<!-- end a -->\n\n%s", rest);
  assert_string_equal(record_section(before, "a", &section), expected);
  section = (VerifySection){.all = "all\n", .study = "xy", .alone = "\n### xy: Y\n\nnew\n"};
  sprintf(expected, "<!-- begin a -->\n## a: A\n\n### x: X\n\n1\n\n### xy: Y\n\nnew\n<!-- end a -->\n\n%s", rest);
  assert_string_equal(record_section(before, "a", &section), expected);
  section = (VerifySection){.all = "all\n", .study = "z", .alone = "\n### z: Z\n\nnew\n"};
  sprintf(expected,
          "<!-- begin a -->\n## a: A\n\n### x: X\n\n1\n\n### xy: Y\n\n2\n\n### z: Z\n\nnew\n<!-- end a -->\n\n%s",
          rest);
  assert_string_equal(record_section(before, "a", &section), expected);
  sprintf(expected, "%s\n<!-- begin c -->\nall\n<!-- end c -->\n", rest);
  assert_string_equal(record_section(rest, "c", &section), expected);
}

static void record_replaces_one_section(void **state)
{
  (void)state;
  char first[1024];
  int error;
  strcpy(first, record("# Header\n", "a", "one\n"));
  assert_string_equal(first, "# Header\n\n<!-- begin a -->\none\n<!-- end a -->\n");
  strcpy(first, record(first, "b", "two\n"));
  assert_string_equal(first,
                      "# Header\n\n<!-- begin a -->\none\n<!-- end a -->\n\n<!-- begin b -->\ntwo\n<!-- end b -->\n");
  assert_string_equal(record(first, "a", "three\n"),
                      "# Header\n\n<!-- begin a -->\nthree\n<!-- end a -->\n\n<!-- begin b -->\ntwo\n<!-- end b -->\n");
  OK(VerifyRecord("/nowhere/verification.md", "a", &(VerifySection){.all = ""}, &error));
  assert_int_not_equal(error, 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(reads_a_study),
    cmocka_unit_test(settings_replace_the_symbol),
    cmocka_unit_test(a_row_sets_values_of_a_series),
    cmocka_unit_test(mistakes_have_places),
    cmocka_unit_test(nonsense_is_refused),
    cmocka_unit_test(judges_what_is_right),
    cmocka_unit_test(judges_what_is_wrong),
    cmocka_unit_test(judges_every_agreement),
    cmocka_unit_test(judges_distances),
    cmocka_unit_test(judges_every_limit),
    cmocka_unit_test(judges_orders),
    cmocka_unit_test(judges_powers),
    cmocka_unit_test(judges_pace),
    cmocka_unit_test(record_replaces_one_section),
    cmocka_unit_test(record_replaces_one_study),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
