#include "solve/contact/contact_law.h"
#include "base/math/vector.h"

/* What is left of a beside the normal. */
static void across(const PetscReal n[3], const PetscReal a[3], PetscReal b[3])
{
  const PetscReal along = vector_dot(n, a);
  for (int i = 0; i < 3; ++i) b[i] = a[i] - along * n[i];
}

/* The part of the normal force, p n. */
static void normal_stiffness(const ContactLaw *law, const WallPlace *place, PetscReal pressure, PetscReal *K)
{
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      K[3 * i + j] = law->penalty * place->normal[i] * place->normal[j] - pressure * place->curvature[3 * i + j];
}

/* How the plane of the shear turns along a curved wall: with P = I - n n^T and H the derivative of n, that of P a is
 * P da - (a.n) H - n (H a)^T. */
static void turns(const WallPlace *place, const PetscReal a[3], PetscReal T[9])
{
  const PetscReal *H = place->curvature, *n = place->normal, along = vector_dot(n, a);
  for (int j = 0; j < 3; ++j) {
    const PetscReal bend = vector_dot(H + 3 * j, a);
    for (int i = 0; i < 3; ++i) T[3 * i + j] = along * H[3 * i + j] + n[i] * bend;
  }
}

/* The part of t where it does not slide: r across the normal. */
static void stick(const ContactLaw *law, const PetscReal n[3], const PetscReal T[9], PetscReal *K)
{
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) K[3 * i + j] += law->along * ((i == j) - n[i] * n[j]) + T[3 * i + j];
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
static void slide(const ContactLaw *law, const PetscReal n[3], const PetscReal way[3], PetscReal bound, PetscReal slope,
                  PetscReal size, const PetscReal T[9], PetscReal *K)
{
  for (int j = 0; j < 3; ++j) {
    PetscReal turned = 0;
    for (int i = 0; i < 3; ++i) turned += way[i] * T[3 * i + j];
    for (int i = 0; i < 3; ++i)
      K[3 * i + j] += law->penalty * slope * way[i] * n[j] + TRACE * law->along * way[i] * way[j] +
                      law->along * bound / size * ((i == j) - n[i] * n[j] - way[i] * way[j]) +
                      bound / size * (T[3 * i + j] - way[i] * turned);
  }
}

ContactState contact_law(const ContactLaw *law, const WallPlace *place, const PetscReal slip[3],
                         const ContactForce *multiplier, ContactForce *now, PetscReal *K)
{
  const PetscReal *n = place->normal;
  PetscReal trial[3], T[9], slope = 0;
  *now = (ContactForce){.pressure = multiplier->pressure - law->penalty * place->gap};
  if (now->pressure <= 0 && law->kind != CONTACT_BONDED && !law->grips) {
    now->pressure = 0;
    for (int i = 0; K && i < 9; ++i) K[i] = 0;
    return CONTACT_OPEN;
  }
  if (K) normal_stiffness(law, place, now->pressure, K);
  if (law->kind == CONTACT_FRICTIONLESS) return CONTACT_SLIDES;
  for (int i = 0; i < 3; ++i) trial[i] = multiplier->shear[i] - law->along * slip[i];
  across(n, trial, now->shear);
  if (K) turns(place, trial, T);
  const PetscReal size = PetscSqrtReal(vector_dot(now->shear, now->shear));
  const PetscReal bound = bound_of(law, now->pressure, &slope);
  if (size <= bound || law->grips) {
    if (K) stick(law, n, T, K);
    return CONTACT_STICKS;
  }
  for (int i = 0; i < 3; ++i) trial[i] = now->shear[i] / size;
  if (K) slide(law, n, trial, bound, slope, size, T, K);
  for (int i = 0; i < 3; ++i) now->shear[i] = bound * trial[i];
  return CONTACT_SLIDES;
}
