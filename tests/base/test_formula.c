/* Formulas against the same arithmetic in C. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <string.h>
#include <cmocka.h>
#include "base/formula.h"

#define OK(call) assert_int_equal((call), 0)

static PetscErrorCode TwoNames(void *context, const char *name, PetscBool *known, PetscReal *value)
{
  (void)context;
  PetscFunctionBeginUser;
  *known = PETSC_TRUE;
  if (!strcmp(name, "a")) *value = 3;
  else if (!strcmp(name, "left_2")) *value = -0.5;
  else *known = PETSC_FALSE;
  PetscFunctionReturn(0);
}

static void test_values(void **state)
{
  const struct {
    const char *text;
    double value;
  } cases[] = {
    {"+3", 3},
    {"2 * +3 - +1", 5},
    {"1", 1},
    {" 2 + 3*4 - 6/2/3 ", 2 + 3 * 4 - 1},
    {"(2+3)*(4-1)", 15},
    {"-2^2 + 2^-1 + 2^3^2", -4 + 0.5 + 512},
    {"1.5e3 - .5", 1499.5},
    {"a*left_2 - -a", 1.5},
    {"sqrt(16)+exp(log(a))-abs(left_2)", 4 + 3 - 0.5},
    {"4*atan(1) - pi + sin(pi/6) + cos(pi/3) + tan(pi/4)", 2},
    {"max(0, a - 5) + 2*min(left_2, max(1, a))", -1},
  };
  (void)state;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(cases); ++k) {
    Formula formula = {.value = TwoNames, .at = cases[k].text};
    PetscReal value;
    OK(FormulaValue(&formula, &value));
    assert_null(formula.wrong);
    assert_true(fabs(value - cases[k].value) <= 1e-14 * fabs(cases[k].value));
  }
}

/* What has no value is nan, which has no sign. */
static void test_no_value(void **state)
{
  static const char *const texts[] = {"sqrt(-1)", "-sqrt(0-1)", "log(-2)", "0/0", "-(0/0)"};
  (void)state;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(texts); ++k) {
    Formula formula = {.value = TwoNames, .at = texts[k]};
    PetscReal value;
    OK(FormulaValue(&formula, &value));
    assert_null(formula.wrong);
    assert_true(isnan(value) && !signbit(value));
  }
}

/* Where they make no sense, and which name is not known. */
static void test_mistakes(void **state)
{
  const struct {
    const char *text, *rest, *name;
  } cases[] = {
    {"", "", ""},         {"1 + ", "", ""},       {"1 2", "2", ""},
    {"(1", "", ""},       {"max(1", "", ""},      {"min(1 2)", "2)", ""},
    {"1)", ")", ""},      {"a + b", "b", "b"},    {"sqrt 4", "sqrt 4", "sqrt"},
    {"a # a", "# a", ""}, {"2 ** 3", "* 3", ""},  {"sinh(a)", "sinh(a)", "sinh"},
    {"0x10", "0x10", ""}, {"1 + 0x1", "0x1", ""},
  };
  char deep[4096];
  (void)state;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(cases); ++k) {
    Formula formula = {.value = TwoNames, .at = cases[k].text};
    PetscReal value;
    OK(FormulaValue(&formula, &value));
    assert_true(value != value);
    assert_string_equal(formula.wrong, cases[k].rest);
    assert_string_equal(formula.name, cases[k].name);
  }
  memset(deep, '(', sizeof deep);
  deep[sizeof deep - 1] = 0;
  for (int k = 0; k < 2; ++k, memset(deep, '-', sizeof deep - 1)) {
    Formula formula = {.value = TwoNames, .at = deep};
    PetscReal value;
    OK(FormulaValue(&formula, &value));
    assert_non_null(formula.wrong);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_values), cmocka_unit_test(test_no_value),
                                     cmocka_unit_test(test_mistakes)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
