/* Values and integrals of piecewise linear functions of time. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "case/case.h"

#define ASSERT_NEAR(a, b, tolerance) assert_true(PetscAbsReal((a) - (b)) <= (tolerance))

static PetscReal times[] = {1, 2, 4}, values[] = {0, 3, -1};
static const Amplitude table = {.n = 3, .time = times, .value = values};
static const Amplitude none = {.n = 0};

static void Value(void **state)
{
  (void)state;
  ASSERT_NEAR(amplitude_value(&table, 0, 9), 0, 0);
  ASSERT_NEAR(amplitude_value(&table, 1.5, 9), 1.5, 1e-15);
  ASSERT_NEAR(amplitude_value(&table, 2, 9), 3, 0);
  ASSERT_NEAR(amplitude_value(&table, 3, 9), 1, 1e-15);
  ASSERT_NEAR(amplitude_value(&table, 7, 9), -1, 0);
  ASSERT_NEAR(amplitude_value(&none, 7, 9), 9, 0);
}

static void Integral(void **state)
{
  (void)state;
  ASSERT_NEAR(amplitude_integral(&table, 1, 9), 0, 1e-15);
  ASSERT_NEAR(amplitude_integral(&table, 2, 9), 1.5, 1e-15);
  /* 3 falls to 1 within a second: mean 2 */
  ASSERT_NEAR(amplitude_integral(&table, 3, 9), 1.5 + 2, 1e-15);
  ASSERT_NEAR(amplitude_integral(&table, 4, 9), 3.5, 1e-15);
  ASSERT_NEAR(amplitude_integral(&table, 6, 9), 1.5, 1e-15);
  ASSERT_NEAR(amplitude_integral(&none, 6, 9), 54, 0);
}

/* The table may begin before or after t = 0: its first value holds before it. */
static void IntegralFromZero(void **state)
{
  PetscReal t[] = {-1, 1}, v[] = {0, 2}, late[] = {2, 3}, held[] = {5, 5};
  const Amplitude early = {.n = 2, .time = t, .value = v}, later = {.n = 2, .time = late, .value = held};
  (void)state;
  ASSERT_NEAR(amplitude_value(&later, 1, 9), 5, 0);
  ASSERT_NEAR(amplitude_value(&later, -3, 9), 5, 0);
  ASSERT_NEAR(amplitude_integral(&early, 1, 0), 1.5, 1e-15);
  ASSERT_NEAR(amplitude_integral(&later, 1, 0), 5, 1e-15);
  ASSERT_NEAR(amplitude_integral(&later, 0, 0), 0, 1e-15);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Value), cmocka_unit_test(Integral),
                                     cmocka_unit_test(IntegralFromZero)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
