/* Where a search along Newton's direction ends, for works along it that are known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "solve/newton/line_search.h"

/* (1 - lambda) of the work at the start, as every direction of Newton's has at first, and what points add that yield
 * anew: so much times the fourth power. */
static PetscErrorCode Evaluate(void *context, PetscReal lambda, PetscReal *norm, PetscReal *slope)
{
  *slope = 1 - lambda + *(const PetscReal *)context * lambda * lambda * lambda * lambda;
  *norm = PetscAbsReal(*slope);
  return 0;
}

static Line search(PetscReal adds)
{
  Line line = {.evaluate = Evaluate, .context = &adds, .enough = 0.8, .wary = PETSC_TRUE};
  assert_int_equal(LineTry(&line, 1), 0);
  assert_int_equal(LineShorten(&line, 1, 1), 0);
  line.context = NULL;
  return line;
}

/* Work that is left in full changes its sign: it vanishes between. */
static void test_overshoots(void **state)
{
  (void)state;
  const Line line = search(-20);
  assert_true(line.lambda > 0 && line.lambda < 1 && PetscAbsReal(line.slope) <= 0.8);
}

/* Work that has grown has fallen before it, least at (4 adds)^(-1/3): the search went to the end of it. */
static void test_grows(void **state)
{
  const PetscReal adds[] = {2, 4, 12};
  (void)state;
  for (int k = 0; k < 3; ++k) {
    const Line line = search(adds[k]);
    assert_true(line.slope <= 0.8 && line.slope > 0 && line.lambda < PetscPowReal(adds[k], -1. / 3));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_overshoots), cmocka_unit_test(test_grows)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
