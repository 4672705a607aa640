/* Shape and volume apart: what the laws with p = K (J - 1) or p = K ln J / J share, off the hot
 * path. */
#pragma once
#include "base/math/tensor.h"
#include "material/law.h"
#include <math.h>

/* bbar = s / mu + x I with s = J dev sigma, where x > 0 makes det bbar = 1. That determinant, x^3 - j2 x + j3, is
 * convex above its largest root and larger at the start: Newton comes down to it without overshoot. */
static inline PetscBool shape_from_stress(PetscReal mu, PetscReal J, const PetscReal sigma[6], PetscReal *bbar)
{
  const PetscReal mean = (sigma[0] + sigma[1] + sigma[2]) / 3.0;
  PetscReal s[6], norm2 = 0.0;
  for (int k = 0; k < 6; ++k) {
    s[k] = J / mu * (sigma[k] - (k < 3 ? mean : 0.0));
    norm2 += (k < 3 ? 1.0 : 2.0) * s[k] * s[k];
  }
  const PetscReal j2 = 0.5 * norm2, j3 = sym_det(s);
  PetscReal x = 1.0 + sqrt(norm2);
  for (int iteration = 0; iteration < 200; ++iteration) {
    const PetscReal step = (x * x * x - j2 * x + j3 - 1.0) / (3.0 * x * x - j2);
    x -= step;
    if (!(fabs(step) > 2.0 * PETSC_MACHINE_EPSILON * x)) break;
  }
  for (int k = 0; k < 6; ++k) bbar[k] = s[k] + (k < 3 ? x : 0.0);
  return isfinite(x) && fabs(sym_det(bbar) - 1.0) < 1e-10 && bbar[0] > 0.0 && bbar[0] * bbar[1] > bbar[3] * bbar[3];
}

/* ln J with J p = K ln J: y exp(-y) = p / K has its stable solution below y = 1, where the pressure
 * has its peak in tension. NAN beyond that peak. */
static inline PetscReal volume_log_from_pressure(PetscReal K, PetscReal p)
{
  const PetscReal target = p / K;
  /* left of the root: the slope only falls from here on */
  PetscReal y = target > 0.0 ? 0.0 : -log1p(-target);
  if (!(target < exp(-1.0))) return NAN;
  for (int iteration = 0; iteration < 200; ++iteration) {
    const PetscReal step = (target * exp(y) - y) / (1.0 - y);
    y += step;
    if (!(fabs(step) > 2.0 * PETSC_MACHINE_EPSILON * (1.0 + fabs(y)))) break;
  }
  return y < 1.0 ? y : NAN;
}

/* J under the mean stress p; NAN if there is none. */
static inline PetscReal volume_from_pressure(VolumeLaw law, PetscReal K, PetscReal p)
{
  const PetscReal J = 1.0 + p / K;
  if (law == VOLUME_LOG) return exp(volume_log_from_pressure(K, p));
  return J > 0.0 ? J : NAN;
}

/* J under the mean Kirchhoff stress q; NAN if there is none. Of J (J - 1) = q / K the root on whose side
 * of 1/2, where q is least, the volume `before` is. */
static inline PetscReal volume_from_kirchhoff(VolumeLaw law, PetscReal K, PetscReal q, PetscReal before)
{
  if (law == VOLUME_LOG) return exp(q / K);
  return before < 0.5 ? 0.5 - sqrt(0.25 + q / K) : 0.5 + sqrt(0.25 + q / K);
}

/* What these laws pack first: each is a pair that differs in its volumetric part alone. */
enum { SPLIT_BULK, SPLIT_SHEAR, SPLIT_VOLUME, SPLIT_N };

static inline void split_prepare(VolumeLaw volume, const Elasticity *elastic, PetscReal *packed)
{
  packed[SPLIT_BULK] = elastic->bulk;
  packed[SPLIT_SHEAR] = elastic->shear;
  packed[SPLIT_VOLUME] = volume;
}

static inline VolumeLaw split_volume(const PetscReal *parameters) { return (VolumeLaw)parameters[SPLIT_VOLUME]; }

static inline PetscReal volume_energy(VolumeLaw law, PetscReal K, PetscReal J)
{
  const PetscReal x = law == VOLUME_LOG ? log(J) : J - 1.0;
  return 0.5 * K * x * x;
}

/* Elastic volume, and a change of it, of states that begin with b. */
static inline void volume_of_b(PetscInt n, PetscInt n_state, const PetscReal *state, PetscReal *J)
{
  for (PetscInt p = 0; p < n; ++p) J[p] = sqrt(sym_det(state + p * n_state));
}

static inline void scale_b(PetscInt n, PetscInt n_state, const PetscReal *factor, PetscReal *state)
{
  for (PetscInt p = 0; p < n; ++p)
    for (int k = 0; k < 6; ++k) state[p * n_state + k] *= factor[p] * factor[p];
}
