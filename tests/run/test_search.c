/* Which factors are tried, against bodies that stand up to a factor that is known here alone. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "run/strength/search.h"

static const ReductionSpec usual = {.from = 1, .step = 0.1, .tolerance = 0.005, .most = 10};

/* A body, and where Newton's method loses its way in steps larger than `stride`. */
typedef struct {
  PetscReal fails, low, high, stride;
  TryOutcome how;
  PetscBool hard; /* many iterations: steps do not grow */
} Body;

static TryOutcome try_it(const Body *b, PetscReal stable, PetscReal factor)
{
  if (factor >= b->fails) return b->how;
  return factor > b->low && factor < b->high && factor - stable > b->stride ? TRY_LOST : TRY_STANDS;
}

static Search run(const ReductionSpec *spec, const Body *b, int *tries)
{
  Search s = search_begin(spec);
  PetscReal next;
  for (*tries = 0; (next = search_next(&s, spec)) > 0 && *tries < 1000; ++*tries) {
    assert_true(next - s.stable > spec->tolerance / 64 * s.stable);
    search_tell(&s, spec, next, try_it(b, s.stable, next), (PetscBool)!b->hard);
  }
  return s;
}

static void brackets(const ReductionSpec *spec, const Body *b, int most)
{
  int tries;
  const Search s = run(spec, b, &tries);
  assert_true(s.stable < b->fails && s.failed >= b->fails);
  assert_true(s.failed - s.stable <= spec->tolerance * s.stable * (1 + 1e-9));
  assert_true(tries <= most);
}

static void test_slides(void **state)
{
  (void)state;
  for (PetscReal fails = 1.003; fails < 4; fails *= 1.0371) {
    brackets(&usual, &(Body){.fails = fails, .how = TRY_SLIDES}, 50);
    brackets(&usual, &(Body){.fails = fails, .how = TRY_RUNS}, 60);
    brackets(&usual, &(Body){.fails = fails, .how = TRY_LOST}, 70);
  }
}

/* The first factor fails: half of it, and so on. */
static void test_below(void **state)
{
  (void)state;
  for (PetscReal fails = 0.9; fails > 0.01; fails *= 0.713)
    brackets(&usual, &(Body){.fails = fails, .how = TRY_SLIDES}, 60);
}

/* Where Newton's method fails in large steps alone, there is no failure. */
static void test_lost_on_the_way(void **state)
{
  const Body body = {.fails = 1.38, .low = 1.2, .high = 1.35, .stride = 0.0008, .how = TRY_SLIDES};
  int tries;
  (void)state;
  const Search s = run(&usual, &body, &tries);
  assert_true(s.stable < 1.38 && s.failed >= 1.38);
}

static void test_most(void **state)
{
  const ReductionSpec spec = {.from = 1, .step = 0.3, .tolerance = 0.005, .most = 1.5};
  const Body body = {.fails = 1e9};
  int tries;
  (void)state;
  const Search s = run(&spec, &body, &tries);
  assert_true(s.stable == 1.5 && s.failed == 0 && tries == 3);
}

/* Steps add up to the end exactly, though 0.1 is no sum of powers of 2; nothing is tried a round-off before it. */
static void test_exact_end(void **state)
{
  const Body body = {.fails = 1e9};
  int tries;
  (void)state;
  const Search s = run(&usual, &body, &tries);
  assert_true(s.stable == 10 && s.failed == 0 && tries == 91);
}

/* Newton's method loses its way beyond `low` in all steps but short ones: what failed from afar is met again from near
 * by, and nothing is tried a round-off before it. */
static void test_met_again(void **state)
{
  (void)state;
  for (PetscReal low = 1; low < 1.55; low += 0.0503)
    for (PetscReal stride = 0.0008; stride < 0.05; stride *= 1.3) {
      int tries;
      const Body body = {
        .fails = 1.6, .low = low, .high = 1.6, .stride = stride, .how = TRY_SLIDES, .hard = PETSC_TRUE};
      const Search s = run(&usual, &body, &tries);
      assert_true(s.stable < 1.6 && s.failed - s.stable >= usual.tolerance / 64 * s.stable);
    }
}

/* Nothing stands: that is said after a while. */
static void test_nothing(void **state)
{
  const Body body = {.fails = 0, .how = TRY_LOST};
  int tries;
  (void)state;
  const Search s = run(&usual, &body, &tries);
  assert_true(s.stable == 0 && s.over > 0 && tries < 20);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_slides),  cmocka_unit_test(test_below),     cmocka_unit_test(test_lost_on_the_way),
    cmocka_unit_test(test_most),    cmocka_unit_test(test_exact_end), cmocka_unit_test(test_met_again),
    cmocka_unit_test(test_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
