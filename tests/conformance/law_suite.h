/* What every material law must do. A new law adds one line to the list in
 * tests/material/test_laws.c. */
#pragma once
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "base/math/tensor.h"
#include "material/elasticity.h"
#include "material/pressure.h"
#include "random.h"

#define LAW_SUITE_STATES 4000
#define LAW_SUITE_STEP 1e-6 /* of central differences */

typedef struct {
  const char *law;
  PetscInt n_parameters;
  NamedValue parameters[LAW_MAX_PARAMETERS]; /* as a case file gives them */
  PetscReal strain;                          /* size of the random increments */
  PetscBool hyperelastic;                    /* tau derives from the energy on every path */
  PetscReal tangent;                         /* relative tolerance against differences; 0: 1e-6 */
  PetscBool not_mixed;                       /* these parameters have no mixed form */
  /* share of the columns of c that may be at a corner; 0: 1/1000. Strength that changes with the
   * size of the shear strain has one where nothing shears: at an apex of cohesion under uniform
   * expansion. */
  PetscReal corners;
  PetscReal pressure;   /* of a law that needs a stress: the one it begins with, Pa */
  PetscReal heard;      /* of a nonlocal law: the mean of the strains around, if there is one */
  PetscReal dt;         /* of a law that knows of rates: of each update, s; 0: it is told of no time */
  PetscBool may_refuse; /* may it say that it does not converge within stretches of 0.1 to 10? */
} LawUnderTest;

typedef struct {
  const LawUnderTest *test;
  const Law *law;
  Material material;
  Random random;
  PetscBool mixed; /* updates take the pressure of the point instead of the law's own */
} LawSuite;

/* One update and all that it gives. */
typedef struct {
  PetscReal dF[9], old[LAW_MAX_STATE], state[LAW_MAX_STATE], tau[6], c[36];
  PetscReal pressure, theta, rate, coupling[6]; /* mixed only */
  LawStatus status;
} LawPoint;

static inline void law_suite_open(LawSuite *suite, const LawUnderTest *test)
{
  MaterialSpec spec = {.name = (char *)"sample",
                       .law = (char *)test->law,
                       .density = 1000.0,
                       .n_parameters = test->n_parameters,
                       .parameters = (NamedValue *)test->parameters};
  Case c = {.n_materials = 1, .materials = &spec, .formulation = (char *)(test->not_mixed ? "displacement" : "mixed")};
  Diag *diag = NULL;
  *suite = (LawSuite){.test = test, .random = {12345}};
  if (DiagCreate(&diag) || MaterialResolve(&c, 0, diag, &suite->material)) fail_msg("%s: not resolved", test->law);
  if (diag_errors(diag)) {
    (void)DiagFlush(diag, stderr);
    fail_msg("%s: bad parameters", test->law);
  }
  if (DiagDestroy(&diag)) fail();
  if (suite->material.law->rate) materials_step(1, &suite->material, 0, test->dt > 0 ? test->dt : 1, test->dt > 0);
  suite->law = suite->material.law;
  suite->material.wave_modulus = suite->material.elastic.lame + 2 * suite->material.elastic.shear;
}

static inline PetscReal law_suite_largest(PetscInt n, const PetscReal *v)
{
  PetscReal largest = 0.0;
  for (PetscInt k = 0; k < n; ++k)
    if (!(fabs(v[k]) <= largest)) largest = fabs(v[k]); /* a NaN comes through */
  return largest;
}

/* What a strain's rounding is multiplied with: also where plastic flow leaves no stiffness. */
static inline PetscReal law_suite_modulus(const LawSuite *suite, const LawPoint *p)
{
  return fmax(law_suite_largest(36, p->c), suite->material.wave_modulus);
}

static inline void law_suite_near(const LawSuite *suite, const char *what, PetscInt n, const PetscReal *value,
                                  const PetscReal *expected, PetscReal tolerance)
{
  for (PetscInt k = 0; k < n; ++k)
    if (!(fabs(value[k] - expected[k]) <= tolerance))
      fail_msg("%s: %s, number %d is %.17g, expected %.17g within %.2g", suite->law->name, what, (int)k, value[k],
               expected[k], tolerance);
}

static inline void law_suite_mixed_part(const LawSuite *suite, LawPoint *p, PetscBool tangent)
{
  PressureStress s;
  p->status =
    pressure_update(&suite->material, suite->law->update, 1, p->dF, &p->pressure, p->old, p->state, tangent, &s);
  if (p->status != LAW_OK) return;
  memcpy(p->tau, s.tau, sizeof p->tau);
  p->theta = s.theta[0];
  p->rate = s.rate[0];
  if (!tangent) return;
  memcpy(p->c, s.c, sizeof p->c);
  memcpy(p->coupling, s.coupling, sizeof p->coupling);
}

static inline void law_suite_update_mixed(const LawSuite *suite, LawPoint *p)
{
  law_suite_mixed_part(suite, p, PETSC_TRUE);
}

static inline void law_suite_update(const LawSuite *suite, LawPoint *p)
{
  if (suite->mixed) {
    law_suite_update_mixed(suite, p);
    return;
  }
  p->status = suite->law->update(suite->material.parameters, 1, p->dF, p->old, p->state, p->tau, p->c);
}

/* Stress and state alone, for differences; law_suite_batches sees that a law gives the same without the tangent. */
static inline void law_suite_stress(const LawSuite *suite, LawPoint *p)
{
  if (suite->mixed) law_suite_mixed_part(suite, p, PETSC_FALSE);
  else p->status = suite->law->update(suite->material.parameters, 1, p->dF, p->old, p->state, p->tau, NULL);
}

/* The natural state, or the one that a law which has none begins with. */
static inline void law_suite_start(const LawSuite *suite, PetscReal *state)
{
  const PetscReal p = suite->test->pressure, sigma[6] = {-p, -p, -p, 0, 0, 0};
  law_initial_state(suite->law, state);
  if (suite->test->heard > 0) suite->law->hear(suite->material.parameters, suite->test->heard, state);
  if (!suite->law->needs_stress) return;
  if (!suite->law->initial_stress(suite->material.parameters, sigma, state))
    fail_msg("%s: no state with a pressure of %g Pa", suite->law->name, p);
}

/* General, or (one in four) of plane strain. */
static inline void law_suite_random_increment(LawSuite *suite, PetscReal dF[9])
{
  const PetscBool plane = random_real(&suite->random, 0, 4) < 1;
  do {
    for (int k = 0; k < 9; ++k) dF[k] = (k % 4 == 0) + suite->test->strain * random_real(&suite->random, -1, 1);
    if (plane) dF[2] = dF[5] = dF[6] = dF[7] = 0.0, dF[8] = 1.0;
  } while (tensor_det(dF) < 0.2);
}

/* Along one axis, or uniform, in a random direction: principal stretches that are equal, or apart
 * by anything down to rounding. */
static inline void law_suite_coaxial_increment(LawSuite *suite, PetscReal dF[9])
{
  const PetscReal size = suite->test->strain, near = size * pow(10, -random_real(&suite->random, 2, 17));
  const PetscReal mean = 1 + size * random_real(&suite->random, -1, 1), kind = random_real(&suite->random, 0, 3);
  PetscReal q[9], qt[9], stretch[9] = {0}, left[9];
  random_rotation(&suite->random, q);
  for (int k = 0; k < 9; ++k) qt[k] = q[3 * (k % 3) + k / 3];
  stretch[0] = 1 + size * random_real(&suite->random, -1, 1);
  stretch[4] = mean;
  stretch[8] = kind < 1 ? mean : mean + near;
  if (kind > 2) stretch[0] = mean - near;
  tensor_multiply(q, stretch, left);
  tensor_multiply(left, qt, dF);
}

/* A point at a state that the law itself reached in two steps, with a third increment done; or (one
 * in four) after one coaxial increment from rest. Always the first try for laws that never fail;
 * others may refuse some. */
static inline void law_suite_random_law_point(LawSuite *suite, LawPoint *p)
{
  for (int tries = 0; tries < 100; ++tries) {
    const PetscBool coaxial = random_real(&suite->random, 0, 4) < 1;
    const int wanted = coaxial ? 1 : 3;
    int steps = 0;
    law_suite_start(suite, p->old);
    for (; steps < wanted; ++steps) {
      if (steps) memcpy(p->old, p->state, sizeof p->old);
      if (coaxial) law_suite_coaxial_increment(suite, p->dF);
      else law_suite_random_increment(suite, p->dF);
      if (steps + 1 < wanted) law_suite_stress(suite, p);
      else law_suite_update(suite, p);
      if (p->status != LAW_OK) break;
    }
    if (steps == wanted) return;
  }
  fail_msg("%s: no valid state in 100 tries", suite->law->name);
}

/* The same, in mixed form with a pressure of the size of the point's own. */
static inline void law_suite_random_point(LawSuite *suite, LawPoint *p)
{
  const PetscBool mixed = suite->mixed;
  suite->mixed = PETSC_FALSE;
  law_suite_random_law_point(suite, p);
  suite->mixed = mixed;
  if (!mixed) return;
  p->pressure = 0;
  law_suite_stress(suite, p);
  assert_int_equal(p->status, LAW_OK);
  const PetscReal own = p->theta / suite->material.compliance,
                  noise = suite->test->strain * suite->material.wave_modulus;
  for (PetscReal share = 1;; share /= 2) { /* a law may refuse extremes */
    p->pressure = share * own * random_real(&suite->random, 0.5, 1.5) + noise * random_real(&suite->random, -1, 1);
    law_suite_update(suite, p);
    if (p->status == LAW_OK) return;
    assert_true(share > 1e-3);
  }
}

/* d: unit strain rate of Voigt component k (engineering shear 1); f = (I + h d) f0. */
static inline void law_suite_strain(PetscInt k, PetscReal h, const PetscReal f0[9], PetscReal f[9])
{
  PetscReal g[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const int i = voigt_row[k], j = voigt_column[k];
  g[3 * i + j] += 0.5 * h;
  g[3 * j + i] += 0.5 * h;
  tensor_multiply(g, f0, f);
}

/* d tau + tau d for that d. */
static inline void law_suite_spin_free(PetscInt k, const PetscReal tau[6], PetscReal out[6])
{
  PetscReal t[9], d[9] = {0}, a[9], b[9];
  d[3 * voigt_row[k] + voigt_column[k]] += 0.5;
  d[3 * voigt_column[k] + voigt_row[k]] += 0.5;
  sym_to_full(tau, t);
  tensor_multiply(d, t, a);
  tensor_multiply(t, d, b);
  for (int m = 0; m < 6; ++m) out[m] = a[3 * voigt_row[m] + voigt_column[m]] + b[3 * voigt_row[m] + voigt_column[m]];
}

typedef enum { LAW_SUITE_SMOOTH, LAW_SUITE_KINK, LAW_SUITE_CORNER } LawSuiteColumn;

/* Is the one-sided difference of second order, on the side of h, column k of c? */
static inline PetscBool law_suite_one_sided(const LawSuite *suite, const LawPoint *p, PetscInt k, PetscReal h,
                                            PetscReal tolerance)
{
  PetscReal convected[6];
  LawPoint near = *p, far = *p;
  law_suite_strain(k, h, p->dF, near.dF);
  law_suite_strain(k, 2 * h, p->dF, far.dF);
  law_suite_stress(suite, &near);
  law_suite_stress(suite, &far);
  if (near.status != LAW_OK || far.status != LAW_OK) return PETSC_FALSE;
  law_suite_spin_free(k, p->tau, convected);
  for (int m = 0; m < 6; ++m) {
    const PetscReal slope = (4 * near.tau[m] - 3 * p->tau[m] - far.tau[m]) / (2 * h) - convected[m];
    if (!(fabs(slope - p->c[6 * m + k]) <= tolerance)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Column k of c against differences of tau. At a kink, where the two one-sided differences
 * disagree, it has to be the derivative of one side; between kinks (a corner) it cannot be told. */
static inline LawSuiteColumn law_suite_tangent_column(const LawSuite *suite, const LawPoint *p, PetscInt k)
{
  const PetscReal scale = law_suite_largest(36, p->c) + law_suite_largest(6, p->tau), h = LAW_SUITE_STEP;
  const PetscReal tolerance = scale * (suite->test->tangent > 0 ? suite->test->tangent : 1e-6);
  PetscReal analytic[6], column[6], convected[6];
  LawPoint plus = *p, minus = *p;
  law_suite_strain(k, h, p->dF, plus.dF);
  law_suite_strain(k, -h, p->dF, minus.dF);
  law_suite_stress(suite, &plus);
  law_suite_stress(suite, &minus);
  if (plus.status != LAW_OK || minus.status != LAW_OK) return LAW_SUITE_CORNER;
  law_suite_spin_free(k, p->tau, convected);
  PetscReal bend = 0.0;
  for (int m = 0; m < 6; ++m) {
    analytic[m] = p->c[6 * m + k];
    column[m] = (plus.tau[m] - minus.tau[m]) / (2 * h) - convected[m];
    bend = fmax(bend, fabs(plus.tau[m] - 2 * p->tau[m] + minus.tau[m]) / h);
  }
  PetscReal error = 0.0;
  for (int m = 0; m < 6; ++m)
    if (!(fabs(analytic[m] - column[m]) <= error)) error = fabs(analytic[m] - column[m]);
  if (error <= tolerance) return LAW_SUITE_SMOOTH;
  if (law_suite_one_sided(suite, p, k, h, tolerance) || law_suite_one_sided(suite, p, k, -h, tolerance))
    return LAW_SUITE_KINK;
  if (!(bend > tolerance)) law_suite_near(suite, "tangent column", 6, analytic, column, tolerance);
  return LAW_SUITE_CORNER;
}

static inline void law_suite_tangent(LawSuite *suite)
{
  PetscInt count[3] = {0};
  LawPoint p = {0};
  for (int s = 0; s < LAW_SUITE_STATES; ++s) {
    law_suite_random_point(suite, &p);
    for (PetscInt k = 0; k < 6; ++k) ++count[law_suite_tangent_column(suite, &p, k)];
  }
  if (getenv("TALUS_TEST_PRINT"))
    print_message("%-22s columns: %d smooth, %d at a kink, %d at a corner\n", suite->law->name, (int)count[0],
                  (int)count[1], (int)count[2]);
  if (count[LAW_SUITE_KINK] > 6 * LAW_SUITE_STATES / 100 ||
      count[LAW_SUITE_CORNER] > 6 * LAW_SUITE_STATES * fmax(suite->test->corners, 1e-3))
    fail_msg("%s: %d columns at a kink, %d at a corner", suite->law->name, (int)count[LAW_SUITE_KINK],
             (int)count[LAW_SUITE_CORNER]);
  if (suite->test->hyperelastic && count[LAW_SUITE_SMOOTH] != 6 * LAW_SUITE_STATES)
    fail_msg("%s: not smooth", suite->law->name);
}

static inline void law_suite_symmetry(LawSuite *suite)
{
  LawPoint p = {0};
  PetscReal transposed[36];
  if (!material_symmetric(&suite->material, PETSC_FALSE)) return;
  for (int s = 0; s < 1000; ++s) {
    law_suite_random_point(suite, &p);
    for (int k = 0; k < 36; ++k) transposed[k] = p.c[6 * (k % 6) + k / 6];
    law_suite_near(suite, "symmetric tangent", 36, p.c, transposed, 1e-13 * law_suite_largest(36, p.c));
  }
}

/* Turn every tensor of the state, leave the scalars. */
/* Tensors of the present space turn, the deformation gradient of a umat on its left side. */
static inline void law_suite_rotate_state(const Law *law, const PetscReal q[9], const PetscReal *state,
                                          PetscReal *turned)
{
  for (const LawField *field = law->fields; field->name; ++field) {
    if (field->components == 6) sym_push_forward(q, state, turned);
    else memcpy(turned, state, (size_t)field->components * sizeof *state);
    if (!strcmp(field->name, "umat_f_xx")) tensor_multiply(q, state, turned);
    if (!strcmp(field->name, "umat_f_xx")) state += 8, turned += 8, field += 8;
    state += field->components, turned += field->components;
  }
}

/* Turning the old configuration by r and the new one by q turns the stress and the state by q, and
 * nothing else. */
static inline void law_suite_objectivity(LawSuite *suite)
{
  LawPoint p = {0}, turned = {0};
  PetscReal q[9], r[9], rt[9], qf[9], tau[6], state[LAW_MAX_STATE];
  for (int s = 0; s < 1000; ++s) {
    law_suite_random_point(suite, &p);
    random_rotation(&suite->random, q);
    random_rotation(&suite->random, r);
    for (int k = 0; k < 9; ++k) rt[k] = r[3 * (k % 3) + k / 3];
    tensor_multiply(q, p.dF, qf);
    tensor_multiply(qf, rt, turned.dF);
    law_suite_rotate_state(suite->law, r, p.old, turned.old);
    turned.pressure = p.pressure;
    law_suite_update(suite, &turned);
    assert_int_equal(turned.status, LAW_OK);
    sym_push_forward(q, p.tau, tau);
    law_suite_rotate_state(suite->law, q, p.state, state);
    law_suite_near(suite, "objective stress", 6, turned.tau, tau, 1e-12 * law_suite_modulus(suite, &p));
    law_suite_near(suite, "objective state", suite->law->n_state, turned.state, state,
                   1e-12 * (1 + law_suite_largest(suite->law->n_state, state)));
  }
}

/* Of a law that knows of rates. */
static inline void law_suite_tell_time(LawSuite *suite, PetscReal dt)
{
  if (suite->test->dt > 0) materials_step(1, &suite->material, 0, dt, PETSC_TRUE);
}

/* A step in which nothing moves, and no time passes, changes nothing. */
static inline void law_suite_idempotence(LawSuite *suite)
{
  LawPoint p = {0}, again = {.dF = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  for (int s = 0; s < 1000; ++s) {
    law_suite_random_point(suite, &p);
    memcpy(again.old, p.state, sizeof again.old);
    law_suite_tell_time(suite, 0);
    law_suite_update(suite, &again);
    law_suite_tell_time(suite, suite->test->dt);
    assert_int_equal(again.status, LAW_OK);
    law_suite_near(suite, "state at rest", suite->law->n_state, again.state, p.state,
                   1e-12 * (1 + law_suite_largest(suite->law->n_state, p.state)));
    law_suite_near(suite, "stress at rest", 6, again.tau, p.tau, 1e-12 * law_suite_modulus(suite, &p));
  }
}

/* The initial state carries no stress and no energy. */
static inline void law_suite_natural_state(LawSuite *suite)
{
  LawPoint p = {.dF = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  const PetscReal zero[6] = {0}, modulus = suite->material.wave_modulus;
  if (suite->law->needs_stress) return;
  law_initial_state(suite->law, p.old);
  law_suite_update(suite, &p);
  assert_int_equal(p.status, LAW_OK);
  law_suite_near(suite, "stress of the natural state", 6, p.tau, zero, 1e-14 * modulus);
  if (suite->law->energy) assert_true(fabs(suite->law->energy(suite->material.parameters, p.old)) <= 1e-14 * modulus);
}

/* Energies of many points are those of one after the other, however far their states are apart, up to some 1e-14 of
 * energy and of strain. */
static inline void law_suite_energies(LawSuite *suite)
{
  enum { MANY = 11 };
  const PetscInt stride = suite->law->n_state + 3;
  PetscReal state[MANY * (LAW_MAX_STATE + 3)] = {0}, all[MANY];
  if (!suite->law->energies) return;
  for (int s = 0; s < 100; ++s) {
    const PetscReal *p = suite->material.parameters;
    for (int k = 0; k < MANY; ++k) {
      LawPoint point = {0};
      law_suite_random_point(suite, &point);
      law_suite_stress(suite, &point);
      memcpy(state + k * stride, point.state, (size_t)suite->law->n_state * sizeof *state);
    }
    suite->law->energies(p, MANY, stride, state, all);
    for (int k = 0; k < MANY; ++k) {
      const PetscReal one = suite->law->energy(p, state + k * stride), modulus = suite->material.wave_modulus;
      if (!(fabs(all[k] - one) <= 1e-14 * (one + sqrt(modulus * one)) + 4e-30 * modulus))
        fail_msg("%s: energy %.17g, among others %.17g", suite->law->name, (double)one, (double)all[k]);
    }
  }
}

/* d(energy)/d(strain) = tau. */
static inline void law_suite_energy(LawSuite *suite)
{
  LawPoint p = {0}, plus, minus;
  if (!suite->test->hyperelastic) return;
  assert_non_null(suite->law->energy);
  for (int s = 0; s < 1000; ++s) {
    law_suite_random_point(suite, &p);
    PetscReal slope[6];
    for (PetscInt k = 0; k < 6; ++k) {
      plus = minus = p;
      law_suite_strain(k, LAW_SUITE_STEP, p.dF, plus.dF);
      law_suite_strain(k, -LAW_SUITE_STEP, p.dF, minus.dF);
      law_suite_stress(suite, &plus);
      law_suite_stress(suite, &minus);
      slope[k] = (suite->law->energy(suite->material.parameters, plus.state) -
                  suite->law->energy(suite->material.parameters, minus.state)) /
                 (2 * LAW_SUITE_STEP);
    }
    law_suite_near(suite, "slope of the energy", 6, slope, p.tau, 1e-8 * law_suite_largest(36, p.c));
  }
}

/* Principal stretches from 1e-8 to 1e8 in any direction: numbers or a status, never a NaN. */
static inline void law_suite_extremes(LawSuite *suite)
{
  for (int s = 0; s < LAW_SUITE_STATES; ++s) {
    LawPoint p = {0};
    PetscReal q[9], r[9], scaled[9], reach = random_real(&suite->random, 0, 8);
    law_suite_start(suite, p.old);
    random_rotation(&suite->random, q);
    random_rotation(&suite->random, r);
    for (int j = 0; j < 3; ++j) {
      const PetscReal stretch = pow(10, random_real(&suite->random, -reach, reach));
      for (int i = 0; i < 3; ++i) scaled[3 * i + j] = q[3 * i + j] * stretch;
    }
    tensor_multiply(scaled, r, p.dF);
    law_suite_update(suite, &p);
    if (p.status != LAW_OK) {
      if (reach < 1 && !suite->test->may_refuse)
        fail_msg("%s: status %d within stretches 0.1 to 10", suite->law->name, (int)p.status);
      continue;
    }
    const PetscReal all[] = {law_suite_largest(6, p.tau), law_suite_largest(36, p.c),
                             law_suite_largest(suite->law->n_state, p.state)};
    if (!isfinite(all[0]) || !isfinite(all[1]) || !isfinite(all[2]))
      fail_msg("%s: not finite, and the status does not say so", suite->law->name);
  }
}

/* Bad increments, alone and as one among a full batch. */
static inline void law_suite_bad_increments(LawSuite *suite)
{
  static const struct {
    LawStatus status;
    PetscReal dF[9];
  } bad[] = {
    {LAW_INVERTED, {-1, 0, 0, 0, 1, 0, 0, 0, 1}},
    {LAW_INVERTED, {0, 0, 0, 0, 0, 0, 0, 0, 0}},
    {LAW_INVERTED, {1, 1, 0, 1, 1, 0, 0, 0, 1}},
    {LAW_NOT_FINITE, {NAN, 0, 0, 0, 1, 0, 0, 0, 1}},
    {LAW_NOT_FINITE, {1, 0, 0, 0, 1, NAN, 0, 0, 1}},
    {LAW_NOT_FINITE, {1, 0, 0, 0, INFINITY, 0, 0, 0, 1}},
    {LAW_NOT_FINITE, {1e200, 0, 0, 0, 1e200, 0, 0, 0, 1e200}},
  };
  const Law *law = suite->law;
  PetscReal dF[9 * LAW_BATCH], old[LAW_MAX_STATE * LAW_BATCH], state[LAW_MAX_STATE * LAW_BATCH];
  PetscReal tau[6 * LAW_BATCH], c[36 * LAW_BATCH];
  for (size_t b = 0; b < sizeof bad / sizeof bad[0]; ++b)
    for (PetscInt n = 1; n <= LAW_BATCH; n += 31)
      for (PetscInt at = 0; at < n; at += 5) {
        for (PetscInt p = 0; p < n; ++p) {
          law_suite_start(suite, old + p * law->n_state);
          law_suite_random_increment(suite, dF + 9 * p);
        }
        memcpy(dF + 9 * at, bad[b].dF, sizeof bad[b].dF);
        const LawStatus status = law->update(suite->material.parameters, n, dF, old, state, tau, c);
        if (status != bad[b].status)
          fail_msg("%s: bad increment %d gives status %d, not %d", law->name, (int)b, (int)status, (int)bad[b].status);
      }
}

/* Stress and tangent without the new state are those with it, to the last bit. */
static inline void law_suite_spare(LawSuite *suite, LawUpdate update, PetscInt n, const PetscReal *dF,
                                   const PetscReal *old)
{
  PetscReal state[LAW_MAX_STATE * LAW_BATCH], tau[2][6 * LAW_BATCH] = {{0}}, c[2][36 * LAW_BATCH] = {{0}};
  for (int spared = 0; spared < 2; ++spared)
    assert_int_equal(update(suite->material.parameters, n, dF, old, spared ? NULL : state, tau[spared], c[spared]),
                     LAW_OK);
  assert_memory_equal(tau[0], tau[1], sizeof tau[0]);
  assert_memory_equal(c[0], c[1], sizeof c[0]);
}

/* A batch of n is n batches of one, to the last bit, with the tangent or without; nothing else is
 * written. */
static inline void law_suite_batches(LawSuite *suite)
{
  const Law *law = suite->law;
  const PetscInt ns = law->n_state;
  PetscReal dF[9 * LAW_BATCH], old[LAW_MAX_STATE * LAW_BATCH], kept[LAW_MAX_STATE * LAW_BATCH];
  for (PetscInt n = 1; n <= LAW_BATCH; ++n) {
    PetscReal state[LAW_MAX_STATE * LAW_BATCH + 1], tau[6 * LAW_BATCH + 1], c[36 * LAW_BATCH + 1];
    PetscReal state2[LAW_MAX_STATE * LAW_BATCH], tau2[6 * LAW_BATCH];
    for (PetscInt p = 0; p < n; ++p) {
      LawPoint point;
      law_suite_random_point(suite, &point);
      memcpy(dF + 9 * p, point.dF, sizeof point.dF);
      memcpy(old + ns * p, point.old, (size_t)ns * sizeof *old);
    }
    memcpy(kept, old, (size_t)(n * ns) * sizeof *old);
    state[n * ns] = tau[6 * n] = c[36 * n] = 4711.0;
    assert_int_equal(law->update(suite->material.parameters, n, dF, old, state, tau, c), LAW_OK);
    assert_true(state[n * ns] == 4711.0 && tau[6 * n] == 4711.0 && c[36 * n] == 4711.0);
    assert_memory_equal(kept, old, (size_t)(n * ns) * sizeof *old);
    assert_int_equal(law->update(suite->material.parameters, n, dF, old, state2, tau2, NULL), LAW_OK);
    assert_memory_equal(state, state2, (size_t)(n * ns) * sizeof *state);
    assert_memory_equal(tau, tau2, (size_t)(6 * n) * sizeof *tau);
    if (law->spares_state) law_suite_spare(suite, law->update, n, dF, old);
    for (PetscInt p = 0; p < n; ++p) {
      LawPoint one = {0};
      memcpy(one.dF, dF + 9 * p, sizeof one.dF);
      memcpy(one.old, old + ns * p, (size_t)ns * sizeof *old);
      law_suite_update(suite, &one);
      assert_memory_equal(one.state, state + ns * p, (size_t)ns * sizeof *state);
      assert_memory_equal(one.tau, tau + 6 * p, sizeof one.tau);
      assert_memory_equal(one.c, c + 36 * p, sizeof one.c);
    }
  }
}

/* The kernels of the plane, where z strains by itself (dF_33) or not at all, are the law: stress,
 * state, and the moduli that they make. At a kink rounding may take the other side's moduli. */
static inline void law_suite_in_plane(LawSuite *suite, LawUpdate update, PetscBool hoop)
{
  static const int component[4] = {0, 1, 3, 2};
  const Law *law = suite->law;
  int others = 0;
  for (int s = 0; update && s < LAW_SUITE_STATES / 10; ++s) {
    LawPoint p = {0}, own;
    law_suite_start(suite, p.old);
    for (int step = 0; step < 3; ++step) {
      const PetscReal modulus = suite->material.wave_modulus;
      PetscReal error = 0;
      for (int k = 0; k < 9; ++k) {
        const PetscBool moves = k < 2 || k == 3 || k == 4 || (hoop && k == 8);
        p.dF[k] = (k % 4 == 0) + (moves ? suite->test->strain * random_real(&suite->random, -1, 1) : 0);
      }
      if (tensor_det(p.dF) < 0.2) break;
      own = p;
      law_suite_update(suite, &p);
      if (p.status != LAW_OK) break;
      assert_int_equal(update(suite->material.parameters, 1, own.dF, own.old, own.state, own.tau, own.c), LAW_OK);
      if (law->spares_state) law_suite_spare(suite, update, 1, own.dF, own.old);
      law_suite_near(suite, "stress of the plane", 6, own.tau, p.tau, 1e-12 * law_suite_modulus(suite, &p));
      law_suite_near(suite, "state of the plane", law->n_state, own.state, p.state, 1e-12);
      for (int i = 0; i < (hoop ? 4 : 3); ++i)
        for (int j = 0; j < (hoop ? 4 : 3); ++j) {
          const int at = 6 * component[i] + component[j];
          error = fmax(error, fabs(own.c[at] - p.c[at]));
        }
      others += !(error < 1e-9 * modulus);
      memcpy(p.old, p.state, sizeof p.old);
    }
  }
  if (others > 3 * LAW_SUITE_STATES / 10 / 500) fail_msg("%s: %d moduli of the plane differ", law->name, others);
}

/* A point whose last increment is of the plane, where z strains by itself. */
static inline void law_suite_plane_point(LawSuite *suite, LawPoint *p)
{
  for (int tries = 0; tries < 100; ++tries) {
    law_suite_start(suite, p->old);
    for (int step = 0; step < 3; ++step) {
      if (step) memcpy(p->old, p->state, sizeof p->old);
      for (int k = 0; k < 9; ++k) {
        const PetscBool moves = k < 2 || k == 3 || k == 4 || k == 8;
        p->dF[k] = (k % 4 == 0) + (moves ? suite->test->strain * random_real(&suite->random, -1, 1) : 0);
      }
      law_suite_update(suite, p);
      if (p->status != LAW_OK) break;
    }
    if (p->status == LAW_OK) return;
  }
  fail_msg("%s: no valid state in 100 tries", suite->law->name);
}

/* Points as explicit dynamics has them: the law without its tangent, whatever the number of points, and nothing
 * else is written to. */
static inline void law_suite_march(LawSuite *suite, PetscBool plane)
{
  static const int place[2][9] = {{0, 1, 2, 3, 4, 5, 6, 7, 8}, {0, 1, 3, 4, 8}};
  const Law *law = suite->law;
  const PetscInt ns = law->n_state, stride = ns + 1;
  for (PetscInt n = 1; n <= LAW_BATCH; ++n) {
    PetscReal dF[9][LAW_BATCH], tau[6][LAW_BATCH], state[(LAW_MAX_STATE + 1) * LAW_BATCH];
    const LawMarch march = {dF[0], tau[0], state, stride};
    LawPoint point[LAW_BATCH] = {{.dF = {0}}};
    for (int k = 0; k < 9; ++k)
      for (PetscInt p = 0; p < LAW_BATCH; ++p) dF[k][p] = plane ? k == 0 || k > 2 : k % 4 == 0;
    for (PetscInt p = 0; p < n; ++p) {
      if (plane) law_suite_plane_point(suite, &point[p]);
      else law_suite_random_point(suite, &point[p]);
      for (int k = 0; k < (plane ? 5 : 9); ++k) dF[k][p] = point[p].dF[place[plane][k]];
      memcpy(state + p * stride, point[p].old, (size_t)ns * sizeof *state);
      state[p * stride + ns] = 4711.0;
    }
    assert_int_equal(law_march(law, plane, suite->material.parameters, n, &march), LAW_OK);
    for (PetscInt p = 0; p < n; ++p) {
      PetscReal stress[6];
      for (int k = 0; k < 6; ++k) stress[k] = !plane || k < 4 ? tau[k][p] : point[p].tau[k];
      law_suite_near(suite, "stress without tangent", 6, stress, point[p].tau,
                     1e-12 * law_suite_modulus(suite, &point[p]));
      law_suite_near(suite, "state without tangent", law->n_state, state + p * stride, point[p].state,
                     1e-12 * (1 + law_suite_largest(law->n_state, point[p].state)));
      assert_true(state[p * stride + ns] == 4711.0);
    }
  }
}

/* The mixed form by the kernel with a hoop is that by the law. */
static inline void law_suite_pressure_in_plane(LawSuite *suite)
{
  for (int s = 0; suite->law->update_hoop && s < LAW_SUITE_STATES / 10; ++s) {
    const PetscReal size = suite->test->strain;
    PressureStress whole, ring;
    LawPoint p = {0};
    PetscReal state[LAW_MAX_STATE];
    law_initial_state(suite->law, p.old);
    for (int k = 0; k < 9; ++k)
      p.dF[k] = (k % 4 == 0) + (k < 2 || k == 3 || k == 4 || k == 8 ? size * random_real(&suite->random, -1, 1) : 0);
    if (tensor_det(p.dF) < 0.2) continue;
    const PetscReal pressure = size * suite->material.wave_modulus * random_real(&suite->random, -1, 1);
    const LawStatus status =
      pressure_update(&suite->material, suite->law->update, 1, p.dF, &pressure, p.old, p.state, PETSC_TRUE, &whole);
    if (status != LAW_OK) continue;
    assert_int_equal(
      pressure_update(&suite->material, suite->law->update_hoop, 1, p.dF, &pressure, p.old, state, PETSC_TRUE, &ring),
      LAW_OK);
    const PetscReal modulus = suite->material.wave_modulus + fabs(pressure);
    law_suite_near(suite, "mixed stress of a ring", 6, ring.tau, whole.tau, 1e-12 * modulus);
    law_suite_near(suite, "mixed state of a ring", suite->law->n_state, state, p.state, 1e-12);
    for (int i = 0; i < 4; ++i)
      law_suite_near(suite, "mixed moduli of a ring", 4, ring.c + 6 * i, whole.c + 6 * i, 1e-9 * modulus);
    law_suite_near(suite, "coupling of a ring", 4, ring.coupling, whole.coupling, 1e-12 * (1 + modulus));
  }
}

/* J of a state of rest: from the elastic strain or the volume ratio, whichever the law stores. */
static inline PetscReal law_suite_volume(const Law *law, const PetscReal *state, PetscReal fallback)
{
  if (law->needs_stress) return 1; /* the body is as large as it is */
  for (const LawField *field = law->fields; field->name; state += field->components, ++field) {
    if (!strcmp(field->name, "elastic_strain")) return sqrt(sym_det(state));
    if (!strcmp(field->name, "volume_ratio")) return *state;
  }
  return fallback;
}

/* initial_stress(sigma) -> state -> tau = J sigma, for stresses up to a tenth of the softer modulus
 * in any component. J is read from the elastic strain; a law without that field is only asked for
 * the direction of the stress. */
static inline void law_suite_initial_stress(LawSuite *suite)
{
  const Law *law = suite->law;
  const PetscReal modulus = suite->material.wave_modulus;
  const PetscReal softer = fmin(suite->material.elastic.shear, suite->material.elastic.bulk);
  if (!law->initial_stress) return;
  for (int s = 0; s < 1000; ++s) {
    LawPoint p = {.dF = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    PetscReal sigma[6], expected[6], J, along = 0.0, norm2 = 0.0;
    const PetscReal size = softer * pow(10, random_real(&suite->random, -6, -1));
    for (int k = 0; k < 6; ++k) sigma[k] = size * random_real(&suite->random, -1, 1);
    if (!law->initial_stress(suite->material.parameters, sigma, p.old)) {
      if (suite->test->hyperelastic) fail_msg("%s: no state for a moderate stress", law->name);
      continue; /* outside the yield surface */
    }
    law_suite_update(suite, &p);
    assert_int_equal(p.status, LAW_OK);
    for (int k = 0; k < 6; ++k) along += p.tau[k] * sigma[k], norm2 += sigma[k] * sigma[k];
    J = law_suite_volume(law, p.old, along / norm2);
    for (int k = 0; k < 6; ++k) expected[k] = J * sigma[k];
    law_suite_near(suite, "initial stress", 6, p.tau, expected, 1e-13 * modulus);
  }
}

/* The law's parameters with other moduli, if they are not its own. */
static inline void law_suite_other(const LawSuite *suite, PetscReal softer, PetscReal rounder, PetscReal *parameters)
{
  PetscReal value[ELASTIC_CONSTANTS] = {0};
  Elasticity other = suite->material.elastic;
  const int bulk = elastic_index("bulk"), shear = elastic_index("shear");
  value[bulk] = rounder * other.bulk;
  value[shear] = softer * other.shear;
  memcpy(parameters, suite->material.parameters, sizeof suite->material.parameters);
  if (suite->law->elastic) return;
  assert_true(elasticity_from_two(1u << bulk | 1u << shear, value, &other));
  suite->law->prepare(&other, suite->material.given, parameters);
  if (suite->law->rate) suite->law->step(0, 0, parameters); /* nothing flows */
}

/* A state that has flowed bears its stress with other moduli, too, at rest, and is what it was with its own again.
 * Where shape and volume act on each other, or with p = K (J - 1), Kirchhoff stresses have a least value: few are near
 * it. */
static inline void law_suite_bear(LawSuite *suite)
{
  const Law *law = suite->law;
  static const PetscReal identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscInt refused = 0;
  if (!law->bear) return;
  for (int s = 0; s < 1000; ++s) {
    LawPoint p = {0};
    PetscReal q[LAW_MAX_PARAMETERS], other[LAW_MAX_STATE], after[LAW_MAX_STATE], tau[6];
    law_suite_random_point(suite, &p);
    const PetscReal tolerance = 1e-10 * (law_suite_modulus(suite, &p) + law_suite_largest(6, p.tau));
    const PetscReal most = suite->test->hyperelastic ? 0.01 : 0.1;
    const PetscReal shear = random_real(&suite->random, 1 - most, 1 + most),
                    bulk = random_real(&suite->random, 1 - most, 1 + most);
    law_suite_other(suite, shear, suite->test->hyperelastic ? shear : bulk, q);
    memcpy(other, p.state, sizeof other);
    if (!law->bear(q, p.tau, other)) {
      ++refused;
      continue;
    }
    assert_int_equal(law->update(q, 1, identity, other, after, tau, NULL), LAW_OK);
    law_suite_near(suite, "stress with other moduli", 6, tau, p.tau, tolerance);
    if (!law->bear(suite->material.parameters, tau, after)) {
      ++refused;
      continue;
    }
    if (suite->test->hyperelastic) continue; /* near a limit of stress volumes are hardly determined */
    law_suite_near(suite, "state there and back", law->n_state, after, p.state,
                   1e-9 * (1 + law_suite_largest(law->n_state, p.state)));
  }
  if (refused > (suite->test->hyperelastic || !strcmp(law->name, "j2") ? 150 : 0))
    fail_msg("%s: %d of 1000 states cannot bear their stress with other moduli", law->name, (int)refused);
}

/* With the pressure that the law itself has, K theta, the mixed form is the law: stress, and
 * tangent once the pressure is eliminated. */
static inline void law_suite_pressure_is_own(LawSuite *suite)
{
  for (int s = 0; s < 1000; ++s) {
    LawPoint p = {0}, own;
    PetscReal c[36];
    law_suite_random_law_point(suite, &p);
    own = p;
    law_suite_update_mixed(suite, &own);
    own.pressure = own.theta / suite->material.compliance;
    law_suite_update_mixed(suite, &own);
    assert_int_equal(own.status, LAW_OK);
    const PetscReal size = 1e-11 * (law_suite_modulus(suite, &p) + fabs(own.pressure));
    law_suite_near(suite, "stress at its own pressure", 6, own.tau, p.tau, size);
    law_suite_near(suite, "state at its own pressure", suite->law->n_state, own.state, p.state,
                   1e-11 * (1 + law_suite_largest(suite->law->n_state, p.state)));
    for (int k = 0; k < 36; ++k)
      c[k] = own.c[k] + (k % 6 < 3 ? own.coupling[k / 6] * own.rate / suite->material.compliance : 0);
    law_suite_near(suite, "tangent at its own pressure", 36, c, p.c, 1e-9 * law_suite_modulus(suite, &p));
  }
}

/* Slopes by the pressure, and of the volumetric strain; a kink may stand between two
 * differences. */
static inline void law_suite_pressure_slopes(LawSuite *suite)
{
  PetscInt kinks = 0;
  for (int s = 0; s < 1000; ++s) {
    LawPoint p = {0}, plus, minus;
    PetscReal slope[6], error = 0;
    law_suite_random_point(suite, &p);
    const PetscReal h = 1e-6 * suite->material.wave_modulus, tolerance = 1e-6 * (1 + law_suite_largest(6, p.coupling));
    plus = minus = p;
    plus.pressure += h;
    minus.pressure -= h;
    law_suite_stress(suite, &plus);
    law_suite_stress(suite, &minus);
    for (int k = 0; k < 6; ++k) slope[k] = (plus.tau[k] - minus.tau[k]) / (2 * h);
    for (int k = 0; k < 6; ++k) error = fmax(error, fabs(slope[k] - p.coupling[k]));
    if (suite->test->hyperelastic) law_suite_near(suite, "slope by the pressure", 6, p.coupling, slope, tolerance);
    kinks += error > tolerance;
    for (PetscInt k = 0; k < 6; ++k) {
      plus = minus = p;
      law_suite_strain(k, LAW_SUITE_STEP, p.dF, plus.dF);
      law_suite_strain(k, -LAW_SUITE_STEP, p.dF, minus.dF);
      law_suite_stress(suite, &plus);
      law_suite_stress(suite, &minus);
      const PetscReal rate = (plus.theta - minus.theta) / (2 * LAW_SUITE_STEP), expected = k < 3 ? p.rate : 0;
      law_suite_near(suite, "slope of the volumetric strain", 1, &rate, &expected, 1e-8 * (1 + p.rate));
    }
  }
  if (kinks > 20) fail_msg("%s: %d of 1000 slopes by the pressure are wrong", suite->law->name, (int)kinks);
}

/* The mixed form: tangents, objectivity, agreement with the law. Symmetric where shape and volume
 * stand apart. */
static inline void law_suite_pressure(LawSuite *suite)
{
  if (!suite->law->volume) return;
  law_suite_pressure_is_own(suite);
  suite->mixed = PETSC_TRUE;
  law_suite_pressure_slopes(suite);
  law_suite_objectivity(suite);
  law_suite_tangent(suite);
  law_suite_pressure_in_plane(suite);
  if (suite->material.volume != VOLUME_COUPLED) law_suite_symmetry(suite);
  suite->mixed = PETSC_FALSE;
}

static inline void law_suite_run(const LawUnderTest *test)
{
  LawSuite suite;
  law_suite_open(&suite, test);
  assert_true(suite.law->n_state <= LAW_MAX_STATE);
  law_suite_natural_state(&suite);
  law_suite_idempotence(&suite);
  law_suite_objectivity(&suite);
  law_suite_symmetry(&suite);
  law_suite_tangent(&suite);
  law_suite_energies(&suite);
  law_suite_energy(&suite);
  law_suite_extremes(&suite);
  law_suite_bad_increments(&suite);
  law_suite_batches(&suite);
  law_suite_in_plane(&suite, suite.law->update_plane, PETSC_FALSE);
  law_suite_in_plane(&suite, suite.law->update_hoop, PETSC_TRUE);
  law_suite_march(&suite, PETSC_TRUE);
  law_suite_march(&suite, PETSC_FALSE);
  law_suite_initial_stress(&suite);
  law_suite_bear(&suite);
  if (!test->not_mixed) law_suite_pressure(&suite);
}
