/* The choice of the next step: growth, holding, shrinking before Newton fails, the memory of
 * failures, and how far points may travel. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "solve/newton/step_control.h"

static const AnalysisSpec grows = {.step = 1, .smallest = 0.01, .largest = 64};

/* Accept the step that the control chose. */
static PetscReal accept(StepControl *c, const AnalysisSpec *a, PetscInt iterations, PetscReal reach)
{
  const StepTaken taken = {.dt = c->next, .iterations = iterations, .reach = reach};
  step_control_accept(c, a, 6, &taken);
  return c->next;
}

static void near(PetscReal value, PetscReal expected)
{
  assert_true(PetscAbsReal(value - expected) <= 1e-12 * expected);
}

static void test_iterations(void **state)
{
  StepControl c;
  (void)state;
  step_control_start(&c, 1);
  near(accept(&c, &grows, 6, PETSC_MAX_REAL), 2);    /* easy: twice as large */
  near(accept(&c, &grows, 9, PETSC_MAX_REAL), 2.4);  /* fair: a little larger */
  near(accept(&c, &grows, 15, PETSC_MAX_REAL), 2.4); /* laborious: no larger */
  near(accept(&c, &grows, 16, PETSC_MAX_REAL), 1.8); /* about to fail: smaller */
  near(accept(&c, &grows, 25, PETSC_MAX_REAL), 1.35);
  near(accept(&c, &grows, 25, PETSC_MAX_REAL), 1.0125);
  near(accept(&c, &grows, 25, PETSC_MAX_REAL), 1); /* but not below the step that was asked for */
  for (int k = 0; k < 20; ++k) accept(&c, &grows, 1, PETSC_MAX_REAL);
  near(c.next, 64);
}

/* Without `largest` the step that was asked for stays, however laborious. */
static void test_fixed(void **state)
{
  const AnalysisSpec fixed = {.step = 1, .smallest = 0.01, .largest = 1};
  StepControl c;
  (void)state;
  step_control_start(&c, 1);
  near(accept(&c, &fixed, 25, 0.1), 1);
  near(accept(&c, &fixed, 1, 0.1), 1);
}

/* After a failure at 8 the step is 4, then up to 6 for as long as the failure is remembered, then
 * free again; a failure soon after is remembered twice as long. */
static void test_memory(void **state)
{
  StepControl c;
  PetscInt wait[2];
  (void)state;
  step_control_start(&c, 8);
  for (int failure = 0; failure < 2; ++failure) {
    c.next = 8;
    near(step_control_cut(&c, 8), 4);
    near(accept(&c, &grows, 1, PETSC_MAX_REAL), 4); /* not back at once */
    wait[failure] = 1;
    while (accept(&c, &grows, 1, PETSC_MAX_REAL) <= 6) ++wait[failure];
    near(c.next, 12);
  }
  assert_int_equal(wait[0], STEP_WAIT - 1);
  assert_int_equal(wait[1], 2 * STEP_WAIT - 1);
}

/* Cuts that follow each other within one step are one failure. */
static void test_cuts_in_a_row(void **state)
{
  StepControl c;
  (void)state;
  step_control_start(&c, 8);
  near(step_control_cut(&c, 8), 4);
  near(step_control_cut(&c, 4), 2);
  assert_int_equal(c.patience, STEP_WAIT);
  near(accept(&c, &grows, 1, PETSC_MAX_REAL), 2);
  near(accept(&c, &grows, 1, PETSC_MAX_REAL), 3);
}

static void test_reach(void **state)
{
  StepControl c;
  (void)state;
  step_control_start(&c, 1);
  near(accept(&c, &grows, 1, 1.7), 1.7);
  near(accept(&c, &grows, 1, 1.2), 1.2); /* faster: smaller at once */
  near(accept(&c, &grows, 1, 0.3), 1);   /* but not below the step that was asked for */
}

/* A step cut short for an output neither shortens nor doubles what comes after. */
static void test_shortened(void **state)
{
  StepControl c;
  (void)state;
  step_control_start(&c, 4);
  const StepTaken taken = {.dt = 0.1, .iterations = 3, .shortened = PETSC_TRUE, .reach = PETSC_MAX_REAL};
  step_control_accept(&c, &grows, 6, &taken);
  near(c.next, 4);
}

/* Statics that were halved come back to the times of their steps, in parts that are alike, and grow whole again. */
static void test_return(void **state)
{
  const AnalysisSpec fixed = {.step = 1, .smallest = 0.01, .largest = 1};
  StepControl c;
  PetscReal t = 3;
  (void)state;
  step_control_start(&c, 1);
  assert_true(step_control_return(&c, &fixed, t) == PETSC_MAX_REAL); /* nothing was halved */
  near(step_control_return(&c, &fixed, t - 0.3), 0.3);               /* nor here: but an output was due, say */
  t += step_control_cut(&c, 1);
  for (int k = 0; k < 24; ++k) {
    const PetscReal limit = step_control_return(&c, &fixed, t), dt = PetscMin(c.next, limit);
    const PetscBool returns = (PetscBool)(limit < c.next);
    step_control_accept(
      &c, &fixed, 6,
      &(StepTaken){.dt = dt, .iterations = 8, .shortened = returns, .returning = returns, .reach = PETSC_MAX_REAL});
    assert_true(dt > 0.4);
    assert_true(PetscFloorReal(t + 1e-9) == PetscFloorReal(t + dt - 1e-9)); /* it goes over none of these times */
    t += dt;
  }
  near(c.next, 1);
  near(t, PetscFloorReal(t + 0.5));
  assert_true(step_control_return(&c, &fixed, t) > 1 - 1e-9); /* and no rest of round-off is left */
  assert_true(step_control_return(&c, &fixed, t - 1e-12) > 1 - 1e-9);
  c.next = 0.1;
  assert_true(step_control_return(&c, &fixed, t) == PETSC_MAX_REAL);
  near(step_control_return(&c, &fixed, t + 0.85), 0.075);
  c.next = 2; /* whoever lets steps grow has no such times */
  assert_true(step_control_return(&c, &grows, t + 0.5) == PETSC_MAX_REAL);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_iterations),    cmocka_unit_test(test_fixed), cmocka_unit_test(test_memory),
    cmocka_unit_test(test_cuts_in_a_row), cmocka_unit_test(test_reach), cmocka_unit_test(test_shortened),
    cmocka_unit_test(test_return),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
