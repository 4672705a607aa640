/* The law of an interface: its tangent against central differences, Coulomb's cone, what opens, that it turns with the
 * wall, and which way a round wall pushes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>
#include "solve/contact/contact_law.h"

/* A plane through the origin with unit normal n, or a sphere of radius 2 whose top is there. */
typedef struct {
  PetscReal n[3];
  PetscBool sphere;
  PetscBool halfway; /* does it push along the normal of the middle of a way that began at `start`? */
  PetscReal start[3];
} Wall;

static WallPlace place_of(const Wall *w, const PetscReal x[3])
{
  WallPlace place = {0};
  PetscReal r[3], length = 0;
  if (!w->sphere) {
    for (int d = 0; d < 3; ++d) place.gap += x[d] * w->n[d], place.normal[d] = w->n[d];
    return place;
  }
  for (int d = 0; d < 3; ++d) r[d] = x[d] + 2 * w->n[d], length += r[d] * r[d];
  length = PetscSqrtReal(length);
  place.gap = length - 2;
  for (int d = 0; d < 3; ++d) place.normal[d] = r[d] / length;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) place.curvature[3 * i + j] = ((i == j) - place.normal[i] * place.normal[j]) / length;
  return place;
}

static ContactPlace pushes_of(const Wall *w, const PetscReal x[3])
{
  const WallPlace end = place_of(w, x), start = place_of(w, w->start);
  return w->halfway ? contact_halfway(&end, start.normal, start.gap) : contact_straight(&end);
}

static ContactState force_at(const ContactLaw *law, const Wall *w, const ContactForce *multiplier, const PetscReal x[3],
                             PetscReal f[3], ContactTangent *tangent)
{
  ContactForce now;
  const ContactPlace place = pushes_of(w, x);
  const ContactState state = contact_law(law, &place, x, multiplier, &now, tangent);
  for (int d = 0; d < 3; ++d) f[d] = now.pressure * place.push[d] + now.shear[d];
  return state;
}

/* The same numbers in every run. */
static PetscReal number(unsigned *seed)
{
  *seed = *seed * 1103515245u + 12345u;
  return (PetscReal)((*seed >> 8) & 0xffff) / 32768 - 1;
}

static void unit(unsigned *seed, PetscReal n[3])
{
  PetscReal length = 0;
  for (int d = 0; d < 3; ++d) n[d] = number(seed), length += n[d] * n[d];
  for (int d = 0; d < 3; ++d) n[d] /= PetscSqrtReal(length);
}

static void compare(const ContactLaw *law, const Wall *w, const ContactForce *multiplier, const PetscReal x[3],
                    PetscInt *seen)
{
  const PetscReal step = 1e-6;
  PetscReal f[3], plus[3], minus[3];
  ContactTangent tangent;
  const ContactState state = force_at(law, w, multiplier, x, f, &tangent);
  for (int j = 0; j < 3; ++j) {
    PetscReal there[3] = {x[0], x[1], x[2]};
    there[j] += step;
    if (force_at(law, w, multiplier, there, plus, NULL) != state) return; /* at a corner of the law */
    there[j] -= 2 * step;
    if (force_at(law, w, multiplier, there, minus, NULL) != state) return;
    for (int i = 0; i < 3; ++i)
      assert_true(PetscAbsReal(tangent.K[3 * i + j] + (plus[i] - minus[i]) / (2 * step)) <= 1e-6 * law->penalty);
  }
  ++seen[state];
}

/* Along curved walls, too, where the plane of the shear turns, and where the force has the normal of the middle of the
 * way. Every fifth contact is about to open: there adhesion goes with the pressure. */
static void test_tangent(void **state)
{
  PetscInt seen[3] = {0, 0, 0};
  unsigned seed = 1;
  (void)state;
  for (int k = 0; k < 2000; ++k) {
    Wall w = {.sphere = k % 4 > 1, .halfway = k % 3 > 0};
    const PetscReal size = k % 5 ? 1 : 0.005;
    unit(&seed, w.n);
    for (int d = 0; d < 3; ++d) w.start[d] = 0.5 * number(&seed) + 0.2 * w.n[d];
    const ContactLaw law = {.kind = k % 4 == 3 ? CONTACT_FRICTIONLESS : CONTACT_FRICTION,
                            .friction = k % 4 == 3 ? 0 : 0.4,
                            .bond = k % 2 ? 0 : 3,
                            .penalty = 100,
                            .along = 40};
    const ContactForce multiplier = {.pressure = 20 * size * (1 + number(&seed)),
                                     .shear = {number(&seed), number(&seed), 2}};
    const PetscReal far = 0.2 * size, x[3] = {far * number(&seed), far * number(&seed), far * number(&seed)};
    compare(&law, &w, &multiplier, x, seen);
  }
  assert_true(seen[CONTACT_OPEN] > 50 && seen[CONTACT_SLIDES] > 300 && seen[CONTACT_STICKS] > 100);
}

/* No force in the cone's outside, none that pulls; the shear lies in the plane and against the slip. */
static void test_cone(void **state)
{
  unsigned seed = 7;
  (void)state;
  for (int k = 0; k < 2000; ++k) {
    Wall w = {.sphere = PETSC_FALSE};
    unit(&seed, w.n);
    const ContactLaw law = {.kind = CONTACT_FRICTION, .friction = 0.3, .bond = 1, .penalty = 50, .along = 50};
    const ContactForce none = {.pressure = 5};
    const PetscReal x[3] = {number(&seed), number(&seed), number(&seed)};
    const ContactPlace place = pushes_of(&w, x);
    ContactForce now;
    PetscReal shear = 0, out = 0, work = 0;
    const ContactState is = contact_law(&law, &place, x, &none, &now, NULL);
    for (int d = 0; d < 3; ++d) {
      shear += now.shear[d] * now.shear[d];
      out += now.shear[d] * w.n[d];
      work += now.shear[d] * x[d];
    }
    assert_true((is == CONTACT_OPEN) == (5 - 50 * place.at.gap <= 0) && now.pressure >= 0);
    assert_true(PetscSqrtReal(shear) <= 0.3 * now.pressure + PetscMin(1, 20 * now.pressure) + 1e-12);
    assert_true(PetscAbsReal(out) < 1e-12 && work <= 1e-12);
  }
}

/* Adhesion is there in full from a twentieth of it on, and vanishes with the pressure. */
static void test_adhesion(void **state)
{
  const Wall w = {.n = {0, 1, 0}};
  const ContactLaw law = {.kind = CONTACT_FRICTION, .friction = 0.5, .bond = 8, .penalty = 10, .along = 10};
  const PetscReal at[5] = {100, 1, 0.4, 0.1, 1e-9}, shear[5] = {58, 8.5, 8.2, 2.05, 20.5e-9}, x[3] = {-50, 0, 0};
  PetscReal f[3];
  (void)state;
  for (int k = 0; k < 5; ++k) {
    const ContactForce m = {.pressure = at[k]};
    assert_int_equal(force_at(&law, &w, &m, x, f, NULL), CONTACT_SLIDES);
    assert_true(PetscAbsReal(f[0] - shear[k]) <= 1e-14 * shear[k] && PetscAbsReal(f[1] - at[k]) <= 1e-14 * at[k]);
  }
}

/* Turned about z by a right angle: (x, y) -> (-y, x). */
static void test_turned(void **state)
{
  const Wall w = {.n = {0.6, 0.8, 0}}, turned = {.n = {-0.8, 0.6, 0}};
  const ContactLaw law = {.kind = CONTACT_FRICTION, .friction = 0.5, .penalty = 10, .along = 10};
  const ContactForce m = {.pressure = 4, .shear = {0.8, -0.6, 0.1}}, mt = {.pressure = 4, .shear = {0.6, 0.8, 0.1}};
  const PetscReal x[3] = {0.3, -0.4, 0.2}, xt[3] = {0.4, 0.3, 0.2};
  PetscReal f[3], ft[3];
  (void)state;
  assert_int_equal(force_at(&law, &w, &m, x, f, NULL), force_at(&law, &turned, &mt, xt, ft, NULL));
  assert_true(PetscAbsReal(ft[0] + f[1]) < 1e-14 && PetscAbsReal(ft[1] - f[0]) < 1e-14);
  assert_true(PetscAbsReal(ft[2] - f[2]) < 1e-14);
}

/* A bonded wall pulls, and does not slide. */
static void test_bonded(void **state)
{
  const Wall w = {.n = {0, 1, 0}};
  const ContactLaw law = {.kind = CONTACT_BONDED, .penalty = 10, .along = 10};
  const ContactForce none = {0};
  const PetscReal x[3] = {2, 0.5, -1};
  PetscReal f[3];
  (void)state;
  assert_int_equal(force_at(&law, &w, &none, x, f, NULL), CONTACT_STICKS);
  assert_true(PetscAbsReal(f[0] + 20) < 1e-13 && PetscAbsReal(f[1] + 5) < 1e-13 && PetscAbsReal(f[2] - 10) < 1e-13);
}

/* Round walls push along the line through their centre and the middle of the way, wherever that begins: no torque. */
static void test_halfway(void **state)
{
  unsigned seed = 3;
  (void)state;
  for (int k = 0; k < 200; ++k) {
    Wall w = {.sphere = PETSC_TRUE, .halfway = PETSC_TRUE};
    PetscReal x[3], arm[3];
    unit(&seed, w.n);
    for (int d = 0; d < 3; ++d) x[d] = 0.5 * number(&seed), w.start[d] = 0.5 * number(&seed);
    for (int d = 0; d < 3; ++d) arm[d] = (x[d] + w.start[d]) / 2 + 2 * w.n[d];
    const ContactPlace place = pushes_of(&w, x);
    for (int d = 0; d < 3; ++d) {
      const int i = (d + 1) % 3, j = (d + 2) % 3;
      assert_true(PetscAbsReal(arm[i] * place.push[j] - arm[j] * place.push[i]) < 1e-14);
    }
  }
}

/* A normal that has turned by a right angle is that of another face. */
static void test_turned_away(void **state)
{
  const WallPlace end = {.normal = {0, 1, 0}};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    const PetscReal start[3] = {k ? 1 : 0.6, k ? 0 : 0.8, 0};
    const ContactPlace place = contact_halfway(&end, start, 0.1);
    assert_true(k ? place.push[0] == 0 && place.push[1] == 1 : place.push[0] > 0.3);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_tangent),     cmocka_unit_test(test_cone),   cmocka_unit_test(test_adhesion),
    cmocka_unit_test(test_turned),      cmocka_unit_test(test_bonded), cmocka_unit_test(test_halfway),
    cmocka_unit_test(test_turned_away),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
