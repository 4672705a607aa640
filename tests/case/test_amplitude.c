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

/* Where tables turn: of what acts. A point on a line is no corner, and what changes already does not begin. */
static void Corners(void **state)
{
  PetscReal load_time[] = {1, 2, 3, 3.2, 5}, load_value[] = {0, 0, 1, 1.2, 1.2}, wall_time[] = {0, 2.5};
  PetscReal strength_time[] = {0, 4, 4.5}, strength_value[] = {1, 1, 0.5};
  LoadSpec load = {.amplitude = {.n = 5, .time = load_time, .value = load_value, .origin = 10}};
  MotionSpec motion = {.kind = MOTION_VELOCITY, .amplitude = {.n = 2, .time = wall_time, .value = wall_time}};
  WallSpec wall = {.n_motions = 1, .motions = &motion};
  NamedAmplitude strength = {.name = "cohesion", .amplitude = {.n = 3, .time = strength_time, .value = strength_value}};
  MaterialSpec material = {.name = "clay", .n_amplitudes = 1, .amplitudes = &strength};
  BodySpec body = {.material = "clay"};
  Case c = {.n_loads = 1, .loads = &load, .n_walls = 1, .walls = &wall, .n_materials = 1, .materials = &material};
  (void)state;
  ASSERT_NEAR(case_corner_after(&c, 0), 2.5, 0);
  ASSERT_NEAR(case_corner_after(&c, 2.5 * (1 - 1e-12)), 12, 0); /* it is there, but for rounding */
  ASSERT_NEAR(case_corner_after(&c, 12), 13.2, 0);
  assert_true(case_corner_after(&c, 13.2) == PETSC_MAX_REAL);
  assert_true(case_begins_within(&c, 11.9, 12.1) && case_begins_within(&c, 12 * (1 + 1e-12), 12.1));
  assert_false(case_begins_within(&c, 11.5, 11.9) || case_begins_within(&c, 12.1, 20));
  c.n_bodies = 1, c.bodies = &body; /* of the clay */
  ASSERT_NEAR(case_corner_after(&c, 2.5), 4, 0);
  assert_true(case_begins_within(&c, 3.9, 4));
  wall.absent = PETSC_TRUE;
  ASSERT_NEAR(case_corner_after(&c, 0), 4, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Value), cmocka_unit_test(Integral),
                                     cmocka_unit_test(IntegralFromZero), cmocka_unit_test(Corners)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
