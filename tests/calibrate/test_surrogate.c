/* Surrogates against functions that are known, and regions whose area is known. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
/* cmocka wants those before it */
#include <cmocka.h>
#include "calibrate/parameter.h"
#include "calibrate/region.h"

#define OK(call) assert_int_equal((call), 0)

typedef PetscReal Function(const PetscReal *x);

/* Numbers in [0, 1] that have nothing to do with Halton's. */
static PetscReal chance(void)
{
  static unsigned long long state = 88172645463325252ULL;
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return (PetscReal)(state >> 11) / 9007199254740992.0;
}

/* A surrogate of f from n runs, each off by up to `noise`. */
static Surrogate *learn(PetscInt dim, PetscInt n, Function *f, PetscReal noise)
{
  PetscReal x[400], y[100];
  Surrogate *s;
  for (PetscInt i = 0; i < n; ++i) {
    region_halton(dim, i, x + i * dim);
    y[i] = f(x + i * dim) + noise * (2 * chance() - 1);
  }
  OK(SurrogateCreate(dim, n, x, y, &s));
  return s;
}

/* The largest error at 400 places, and the share of those within two deviations. */
static PetscReal try_out(const Surrogate *s, PetscInt dim, Function *f, PetscReal *within)
{
  PetscReal largest = 0, x[3], value, error;
  *within = 0;
  for (int i = 0; i < 400; ++i) {
    for (PetscInt d = 0; d < dim; ++d) x[d] = chance();
    surrogate_at(s, x, &value, &error);
    const PetscReal off = PetscAbsReal(value - f(x));
    largest = PetscMax(largest, off);
    *within += (off <= error + 1e-12) / 400.;
  }
  return largest;
}

static PetscReal plane(const PetscReal *x) { return 3 + 2 * x[0] - 5 * x[1] + 0.1 * x[2]; }
/* steep near one end, with values of both signs */
static PetscReal steep(const PetscReal *x) { return (1 - x[1] * x[1] / 3) / (0.02 + x[0]) - 5; }
static PetscReal constant(const PetscReal *x) { return 7 + 0 * x[0]; }
static PetscReal hill(const PetscReal *x) { return PetscExpReal(x[0]) * PetscSinReal(2 * x[1]) + x[0] * x[1]; }
/* a flow that stops */
static PetscReal stop(const PetscReal *x) { return PetscMax(0, 1 - 1.6 * x[0] - 0.5 * x[1] * x[1]); }

/* The hill has a range of 3.5: 2 % of it from 24 runs, 1 % from 48, also in the corners, where there
 * are none. */
static void test_functions(void **state)
{
  static const struct {
    PetscInt dim, n;
    Function *f;
    PetscReal error;  /* at most */
    PetscReal within; /* two deviations, at least */
  } cases[] = {{3, 10, plane, 1e-9, 0},    {2, 8, constant, 1e-9, 0}, {2, 24, hill, 0.07, 0.95},
               {2, 48, hill, 0.035, 0.95}, {2, 60, stop, 0.05, 0.85}, {2, 16, steep, 30, 0.85},
               {2, 60, steep, 6, 0.95}};
  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
    Surrogate *s = learn(cases[k].dim, cases[k].n, cases[k].f, 0);
    PetscReal within;
    const PetscReal largest = try_out(s, cases[k].dim, cases[k].f, &within);
    if (largest > cases[k].error || (within < cases[k].within && largest > 1e-9))
      fail_msg("function %zu: off by %g, %g within two deviations", k, (double)largest, (double)within);
    OK(SurrogateDestroy(&s));
  }
}

/* Noise in [-0.1, 0.1] has the deviation 0.0577: a run left out cannot be predicted better. */
static void test_noise(void **state)
{
  Surrogate *s = learn(2, 90, hill, 0.1);
  PetscReal within;
  (void)state;
  assert_true(surrogate_left_out(s) > 0.045 && surrogate_left_out(s) < 0.08);
  assert_true(try_out(s, 2, hill, &within) < 0.12 && within > 0.95);
  OK(SurrogateDestroy(&s));
}

static PetscReal sum(const PetscReal *x) { return x[0] + x[1]; }
static PetscReal difference(const PetscReal *x) { return x[0] - x[1]; }

/* |x + y - 1| <= w, |x - y| <= w: a square on its corner, of area 2 w^2, half as wide as w either
 * way; whatever the third parameter is. w = 0.01 has to be looked at closely. */
static void test_square(void **state)
{
  static const PetscReal widths[] = {0.2, 0.01};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    const Target a = {.value = 1, .uncertainty = widths[k]}, b = {.value = 0, .uncertainty = widths[k]};
    const Target *const targets[] = {&a, &b};
    Surrogate *surrogates[] = {learn(3, 12, sum, 0), learn(3, 12, difference, 0)};
    PetscReal low, high;
    Region region;
    OK(RegionCreate(3, 2, targets, surrogates, &region));
    assert_float_equal(region.volume / (2 * widths[k] * widths[k]), 1, 0.06);
    for (PetscInt p = 0; p < 2; ++p) {
      region_range(&region, p, &low, &high);
      assert_float_equal(low, 0.5 - widths[k], 0.15 * widths[k]);
      assert_float_equal(high, 0.5 + widths[k], 0.15 * widths[k]);
    }
    region_range(&region, 2, &low, &high);
    assert_true(low < 0.01 && high > 0.99);
    assert_true(PetscAbsReal(region_correlation(&region, 0, 1)) < 0.1);
    assert_true(region.far[region.best] < 0.2);
    OK(RegionDestroy(&region));
    for (int s = 0; s < 2; ++s) OK(SurrogateDestroy(&surrogates[s]));
  }
}

static PetscReal apart(const PetscReal *x) { return x[2] - x[0]; }

/* |x + y - 1| <= w, |z - x| <= w, whatever a fourth one is: a rod from one corner to another, of 4 w^2 less what its
 * ends lack, in no box that is smaller than all. */
static void test_rod(void **state)
{
  const PetscReal w = 1e-4;
  const Target a = {.value = 1, .uncertainty = w}, b = {.value = 0, .uncertainty = w};
  const Target *const targets[] = {&a, &b};
  Surrogate *surrogates[] = {learn(4, 12, sum, 0), learn(4, 12, apart, 0)};
  PetscReal low, high;
  Region region;
  (void)state;
  OK(RegionCreate(4, 2, targets, surrogates, &region));
  assert_true(region.inside >= 600);
  assert_float_equal(region.volume / (4 * w * w), 1, 0.2);
  for (PetscInt p = 0; p < 4; ++p) {
    region_range(&region, p, &low, &high);
    assert_true(low < 0.02 && high > 0.98);
  }
  assert_true(region_correlation(&region, 0, 1) < -0.9999 && region_correlation(&region, 0, 2) > 0.9999);
  for (PetscInt i = 1; i < region.n; ++i) assert_true(region.x[4 * i] != region.x[4 * i - 4]);
  OK(RegionDestroy(&region));
  for (int s = 0; s < 2; ++s) OK(SurrogateDestroy(&surrogates[s]));
}

/* Settlements of a block under 100 Pa in micrometres, between walls and without one of them: E from 0.05 to 10 MPa by
 * the logarithm, nu from 0.1 to 0.45. */
static PetscReal stiffness(PetscReal x) { return 0.05 * PetscPowReal(200, x); }
static PetscReal poisson(PetscReal x) { return 0.1 + 0.35 * x; }
static PetscReal free_settlement(const PetscReal *x) { return 100 * (1 - PetscSqr(poisson(x[1]))) / stiffness(x[0]); }
static PetscReal walled_settlement(const PetscReal *x)
{
  const PetscReal nu = poisson(x[1]);
  return 100 * (1 + nu) * (1 - 2 * nu) / ((1 - nu) * stiffness(x[0]));
}

/* Known to 1 %, for 1 MPa and 0.3: 0.985 to 1.016 MPa, 0.291 to 0.308, a ten-thousandth of the ranges. The truth is
 * inside, however few runs there are. */
static void test_wide(void **state)
{
  const Target a = {.value = 74.2857, .uncertainty = 0.7}, b = {.value = 91, .uncertainty = 0.9};
  const Target *const targets[] = {&a, &b};
  const PetscReal truth[2] = {PetscLogReal(20) / PetscLogReal(200), 0.2 / 0.35};
  (void)state;
  for (PetscInt n = 8; n <= 24; n += 8) {
    Surrogate *surrogates[] = {learn(2, n, walled_settlement, 0), learn(2, n, free_settlement, 0)};
    PetscReal low[2], high[2];
    Region region;
    OK(RegionCreate(2, 2, targets, surrogates, &region));
    assert_true(region.inside >= 600);
    for (PetscInt p = 0; p < 2; ++p) {
      region_range(&region, p, &low[p], &high[p]);
      assert_true(low[p] < truth[p] && truth[p] < high[p]);
    }
    if (n == 24) {
      assert_float_equal(stiffness(low[0]), 0.985, 0.01);
      assert_float_equal(poisson(high[1]), 0.308, 0.004);
    }
    OK(RegionDestroy(&region));
    for (int s = 0; s < 2; ++s) OK(SurrogateDestroy(&surrogates[s]));
  }
}

/* One target for two parameters: a strip across all of both, in which they go together. */
static void test_strip(void **state)
{
  const Target a = {.value = 1, .uncertainty = 0.05}, far = {.value = 3, .uncertainty = 0.05};
  const Target *const one[] = {&a}, *const beyond[] = {&far};
  Surrogate *s = learn(2, 12, sum, 0);
  PetscReal low, high;
  Region region;
  (void)state;
  OK(RegionCreate(2, 1, one, &s, &region));
  region_range(&region, 0, &low, &high);
  assert_true(low < 0.01 && high > 0.99 && region_correlation(&region, 0, 1) < -0.99);
  assert_float_equal(region.volume, 1 - 0.95 * 0.95, 3e-3);
  OK(RegionDestroy(&region));
  OK(RegionCreate(2, 1, beyond, &s, &region));
  assert_int_equal(region.inside, 0);
  assert_true(region.x[2 * region.best] > 0.98 && region.x[2 * region.best + 1] > 0.98);
  OK(RegionDestroy(&region));
  OK(SurrogateDestroy(&s));
}

/* New runs go where it is not clear whether the targets are met, and not onto each other. */
static void test_next(void **state)
{
  const Target a = {.value = 0.5, .uncertainty = 0.01};
  const Target *const targets[] = {&a};
  Surrogate *s = learn(2, 12, hill, 0);
  PetscInt next[6];
  Region region;
  PetscReal x[24];
  (void)state;
  for (PetscInt i = 0; i < 12; ++i) region_halton(2, i, x + 2 * i);
  OK(RegionCreate(2, 1, targets, &s, &region));
  assert_int_equal(region_next(&region, 12, x, 6, next), 6);
  for (int i = 0; i < 6; ++i) {
    assert_true(PetscAbsReal(hill(region.x + 2 * next[i]) - 0.5) < 0.15);
    for (int k = 0; k < i; ++k) assert_int_not_equal(next[i], next[k]);
  }
  OK(RegionDestroy(&region));
  OK(SurrogateDestroy(&s));
}

/* Values have no more digits than wanted, and their text gives their share back: that of a thousandth of the range and,
 * where that is asked, of parts of it. */
static void test_rounding(void **state)
{
  static const struct {
    PetscReal low, high, exact;
    int finer;
    const char *text;
  } values[] = {{0, 1000, 5.4356, 0, "5"},
                {0, 1000, 5.4356, 1, "5.4"},
                {0, 1000, 5.4356, 3, "5.436"},
                {0.5e6, 2e6, 999587.3, 0, "1000000"},
                {0.5e6, 2e6, 999587.3, 2, "999590"},
                {-1000, -1, -5.4356, 1, "-5.44"},
                {1000.0, 1000.2, 1000.12345678, 0, "1000.1235"},
                {0.123412341234123, 1, 0, 0, "0.123412341234123"},
                {5e4, 1e7, 188760, 0, "189000"}};
  char text[32];
  (void)state;
  for (size_t k = 0; k < sizeof values / sizeof values[0]; ++k) {
    const Parameter p = {.name = "p", .low = values[k].low, .high = values[k].high};
    const PetscReal size = p.high - p.low, even = PetscMax((values[k].exact - p.low) / size, 0);
    const PetscReal share =
      parameter_is_logarithmic(&p) ? PetscLogReal(values[k].exact / p.low) / PetscLogReal(p.high / p.low) : even;
    assert_string_equal(parameter_text(&p, parameter_round(&p, share, values[k].finer), text), values[k].text);
  }
  for (int k = 0; k <= 500; ++k) { /* over decades, too, where the digits change with the size */
    const Parameter p = {.name = "p", .low = 0.05e6, .high = 10e6};
    const PetscReal x = parameter_round(&p, k / 500., 0), value = strtod(parameter_text(&p, x, text), NULL);
    assert_float_equal(value / parameter_at(&p, x), 1, 1e-12);
  }
}

/* A step that is too coarse for a thin region is told from one that is not, along it and across. */
static void test_alike(void **state)
{
  const Target a = {.value = 1, .uncertainty = 1e-3};
  const Target *const targets[] = {&a};
  Surrogate *s = learn(2, 12, sum, 0);
  const Region region = {.dim = 2, .n_targets = 1, .target = targets, .surrogate = &s};
  const PetscReal at[] = {0.5, 0.5}, along[] = {0.51, 0.49}, near[] = {0.50009, 0.5}, off[] = {0.5002, 0.5};
  const PetscReal edge[] = {0.50096, 0.5}, beyond[] = {0.50104, 0.5};
  (void)state;
  assert_true(region_alike(&region, at, along, PETSC_TRUE) && region_alike(&region, at, near, PETSC_TRUE));
  assert_false(region_alike(&region, at, off, PETSC_FALSE));
  assert_true(region_alike(&region, edge, beyond, PETSC_FALSE));
  assert_false(region_alike(&region, edge, beyond, PETSC_TRUE));
  OK(SurrogateDestroy(&s));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_functions), cmocka_unit_test(test_noise),    cmocka_unit_test(test_square),
    cmocka_unit_test(test_strip),     cmocka_unit_test(test_next),     cmocka_unit_test(test_rod),
    cmocka_unit_test(test_wide),      cmocka_unit_test(test_rounding), cmocka_unit_test(test_alike),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
