#include "solve/contact/contact_law.h"
#include "base/math/vector.h"

#define TURNED 0.5 /* cosine: a normal that has turned by more in a step is that of another face */

/* --- which way it pushes --- */
/* C = A B, 3 x 3. */
static void product(const PetscReal A[9], const PetscReal B[9], PetscReal C[9])
{
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
}

/* In the direction of `sum`, of which the normal is a part; that turns by (I - n n^T) / |sum| times what is added. */
static ContactPlace along(const WallPlace *place, const PetscReal sum[3])
{
  const PetscReal length = PetscSqrtReal(vector_dot(sum, sum));
  ContactPlace c = {.at = *place};
  for (int i = 0; i < 3; ++i) c.push[i] = sum[i] / length;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.follows[3 * i + j] = ((i == j) - c.push[i] * c.push[j]) / length;
  product(c.follows, place->curvature, c.bends);
  return c;
}

ContactPlace contact_straight(const WallPlace *place) { return along(place, place->normal); }

/* What is left of a beside n. */
static void across(const PetscReal n[3], const PetscReal a[3], PetscReal b[3])
{
  const PetscReal along = vector_dot(n, a);
  for (int i = 0; i < 3; ++i) b[i] = a[i] - along * n[i];
}

/* Curvature along the way that the normal has turned from `start`, 1/m. */
static PetscReal bend_along(const WallPlace *place, const PetscReal start[3])
{
  PetscReal turned[3], bend = 0;
  across(place->normal, start, turned);
  const PetscReal square = vector_dot(turned, turned);
  for (int i = 0; i < 3; ++i) bend += turned[i] * vector_dot(place->curvature + 3 * i, turned);
  return square > 0 ? bend / square : 0;
}

/* Both ends of the way stand along their normals about the centre of what is round, by their distances from it, which
 * go as 1 + bend (open - gap) to 1. */
ContactPlace contact_halfway(const WallPlace *place, const PetscReal start[3], PetscReal open)
{
  PetscReal sum[3];
  if (vector_dot(place->normal, start) < TURNED) return contact_straight(place);
  const PetscReal bend = bend_along(place, start), weight = PetscMax(0, 1 + bend * (open - place->gap));
  for (int d = 0; d < 3; ++d) sum[d] = weight * start[d] + place->normal[d];
  ContactPlace c = along(place, sum);
  /* the weight falls by bend times itself with the gap: so does a radius of curvature grow */
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      c.bends[3 * i + j] -= bend * weight * vector_dot(c.follows + 3 * i, start) * place->normal[j];
  return c;
}

/* --- how strongly --- */
/* The part of the normal force, p n: p goes with the gap. Of each part: by the position without what n turns by, and
 * by n. */
static void normal_stiffness(const ContactLaw *law, const ContactPlace *place, PetscReal pressure, ContactTangent *t)
{
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      t->K[3 * i + j] = law->penalty * place->push[i] * place->at.normal[j];
      t->turn[3 * i + j] = -pressure * (i == j);
    }
}

/* How the plane of the shear turns with n: with P = I - n n^T, P a does by -(a.n) I - n a^T. */
static void turns(const PetscReal n[3], const PetscReal a[3], PetscReal T[9])
{
  const PetscReal across = vector_dot(n, a);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) T[3 * i + j] = across * (i == j) + n[i] * a[j];
}

/* The part of t where it does not slide: r across the normal. */
static void stick(const ContactLaw *law, const PetscReal n[3], const PetscReal T[9], ContactTangent *t)
{
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      t->K[3 * i + j] += law->along * ((i == j) - n[i] * n[j]);
      t->turn[3 * i + j] += T[3 * i + j];
    }
}

/* The largest tangential force, and its derivative by the pressure. Adhesion is no more than so many times the
 * pressure: what did not vanish with it would leave no solution where contact opens. */
static PetscReal bound_of(const ContactLaw *law, PetscReal pressure, PetscReal *slope)
{
  const PetscBool adheres = law->bond <= CONTACT_STICKING * pressure;
  if (law->kind == CONTACT_BONDED) return PETSC_MAX_REAL;
  *slope = law->friction + (adheres ? 0 : CONTACT_STICKING);
  return law->friction * pressure + (adheres ? law->bond : CONTACT_STICKING * pressure);
}

PetscReal contact_most(const ContactLaw *law, PetscReal pressure)
{
  PetscReal slope;
  return pressure > 0 ? bound_of(law, pressure, &slope) : 0;
}

/* Stiffness along the way of what slides, over what sticks: the law has none, and a body that slides on all that holds
 * it, as a sample that widens between two platens, has nothing that tells where it stands. Newton's method is told a
 * trace of it; forces, by which it has converged or not, know none. */
#define TRACE 1e-7

/* Where it slides along `way`, with a force `bound` that was to be `size`: what goes along `way` changes nothing. */
static void slide(const ContactLaw *law, const ContactPlace *place, const PetscReal way[3], PetscReal bound,
                  PetscReal slope, PetscReal size, const PetscReal T[9], ContactTangent *t)
{
  const PetscReal *n = place->push;
  for (int j = 0; j < 3; ++j) {
    PetscReal turned = 0;
    for (int i = 0; i < 3; ++i) turned += way[i] * T[3 * i + j];
    for (int i = 0; i < 3; ++i) {
      t->K[3 * i + j] += law->penalty * slope * way[i] * place->at.normal[j] + TRACE * law->along * way[i] * way[j] +
                         law->along * bound / size * ((i == j) - n[i] * n[j] - way[i] * way[j]);
      t->turn[3 * i + j] += bound / size * (T[3 * i + j] - way[i] * turned);
    }
  }
}

/* n turns with the position along a curved wall, and with a wall that turns. */
static void add_turns(const ContactPlace *place, ContactTangent *t)
{
  PetscReal bends[9], turn[9];
  product(t->turn, place->bends, bends);
  product(t->turn, place->follows, turn);
  for (int i = 0; i < 9; ++i) t->K[i] += bends[i], t->turn[i] = turn[i];
}

/* t, and its part of the tangent. */
static ContactState rub(const ContactLaw *law, const ContactPlace *place, const PetscReal slip[3],
                        const ContactForce *multiplier, ContactForce *now, ContactTangent *t)
{
  const PetscReal *n = place->push;
  PetscReal trial[3], T[9], slope = 0;
  if (law->kind == CONTACT_FRICTIONLESS) return CONTACT_SLIDES;
  for (int i = 0; i < 3; ++i) trial[i] = multiplier->shear[i] - law->along * slip[i];
  across(n, trial, now->shear);
  if (t) turns(n, trial, T);
  const PetscReal size = PetscSqrtReal(vector_dot(now->shear, now->shear));
  const PetscReal bound = bound_of(law, now->pressure, &slope);
  if (size <= bound || law->grips) {
    if (t) stick(law, n, T, t);
    return CONTACT_STICKS;
  }
  for (int i = 0; i < 3; ++i) trial[i] = now->shear[i] / size;
  if (t) slide(law, place, trial, bound, slope, size, T, t);
  for (int i = 0; i < 3; ++i) now->shear[i] = bound * trial[i];
  return CONTACT_SLIDES;
}

PetscBool contact_opens(const ContactLaw *law, PetscReal gap, const ContactForce *multiplier)
{
  const PetscBool pulls = (PetscBool)(law->kind == CONTACT_BONDED || law->grips);
  return (PetscBool)(!pulls && multiplier->pressure - law->penalty * gap <= 0);
}

ContactState contact_law(const ContactLaw *law, const ContactPlace *place, const PetscReal slip[3],
                         const ContactForce *multiplier, ContactForce *now, ContactTangent *tangent)
{
  *now = (ContactForce){.pressure = multiplier->pressure - law->penalty * place->at.gap};
  if (contact_opens(law, place->at.gap, multiplier)) {
    now->pressure = 0;
    if (tangent) *tangent = (ContactTangent){.K = {0}};
    return CONTACT_OPEN;
  }
  if (tangent) normal_stiffness(law, place, now->pressure, tangent);
  const ContactState state = rub(law, place, slip, multiplier, now, tangent);
  if (tangent) add_turns(place, tangent);
  return state;
}
