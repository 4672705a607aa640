/* Progress: durations, time left, lines and bars. */
#include "test_output.h"
#include "output/progress.h"

static void test_durations(void **state)
{
  char text[32];
  (void)state;
  progress_duration(0.4, text), assert_string_equal(text, "0:00:00");
  progress_duration(59.6, text), assert_string_equal(text, "0:01:00");
  progress_duration(3723, text), assert_string_equal(text, "1:02:03");
  progress_duration(90061, text), assert_string_equal(text, "1 d 01:01:01");
  progress_duration(-1, text), assert_string_equal(text, "?");
  progress_duration(NAN, text), assert_string_equal(text, "?");
}

/* A steady run: the time left is exact. When steps get twice as slow the estimate follows, without
 * a jump. */
static void test_time_left(void **state)
{
  ProgressClock clock = {0};
  RunProgress progress = {.end = 10, .dt = 0.01};
  PetscReal wall = 0;
  (void)state;
  assert_true(progress_left(&clock, &progress) < 0);
  for (int step = 1; step <= 500; ++step) {
    progress.time = 0.01 * step;
    progress_update(&clock, &progress, wall += 0.2);
    assert_true(fabs(progress_left(&clock, &progress) - (10 - progress.time) / 0.05) < 1e-6);
  }
  PetscReal before = progress_left(&clock, &progress);
  for (int step = 501; step <= 999; ++step) {
    progress.time = 0.01 * step;
    progress_update(&clock, &progress, wall += 0.4);
    const PetscReal left = progress_left(&clock, &progress);
    assert_true(fabs(left - before) < 2.0);
    before = left;
  }
  assert_true(fabs(before - 0.4) < 0.02);
}

/* A resumed run starts in the middle: only what it does itself counts. */
static void test_resumed(void **state)
{
  ProgressClock clock = {0};
  const RunProgress progress = {.time = 5.1, .end = 10.1, .dt = 0.1};
  (void)state;
  progress_update(&clock, &progress, 2);
  assert_true(fabs(progress_left(&clock, &progress) - 100) < 1e-9);
}

static void test_line(void **state)
{
  const RunProgress progress = {.step = 12, .iterations = 3, .time = 0.012, .end = 1, .dt = 0.001, .residual = 1.2e-10};
  char text[256];
  (void)state;
  progress_line(&progress, 80, text);
  assert_string_equal(text, "step = 12 time = 0.012 dt = 0.001 iterations = 3 residual = 1.2e-10 left = 0:01:20");
  progress_line(&progress, -1, text);
  assert_string_equal(text, "step = 12 time = 0.012 dt = 0.001 iterations = 3 residual = 1.2e-10");
}

static void test_bar_fits(void **state)
{
  const RunProgress progress = {.step = 12, .iterations = 3, .time = 0.5, .end = 1, .dt = 0.001, .points = 1234567};
  char text[512];
  (void)state;
  for (int width = 20; width <= 300; ++width) {
    progress_bar(&progress, 10, 3723, width, text);
    assert_true((int)strlen(text) <= width);
    assert_non_null(strstr(text, " 50 %"));
  }
  assert_non_null(strstr(text, "[####################--------------------]"));
  assert_non_null(strstr(text, "1.23M points"));
  assert_non_null(strstr(text, "left 1:02:03"));
  progress_bar(&progress, 10, 3723, 5, text); /* narrower than sense: no harm */
  assert_true(strlen(text) < 20);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_durations), cmocka_unit_test(test_time_left),
                                     cmocka_unit_test(test_resumed), cmocka_unit_test(test_line),
                                     cmocka_unit_test(test_bar_fits)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char **argv) { return TestMain(argc, argv, Tests); }
