/* Numbers of a stress or a strain that do not depend on the axes. Stresses are Cauchy's, tension
 * positive, in Voigt order; pressures are positive in compression. */
#pragma once
#include "base/math/eigen.h"

/* p = - tr sigma / 3 */
static inline PetscReal stress_pressure(const PetscReal sigma[6])
{
  return 0.0 - (sigma[0] + sigma[1] + sigma[2]) / 3.0;
}

/* s : s of the deviator s of a symmetric tensor whose shears are not doubled. */
static inline PetscReal deviator_norm2(const PetscReal a[6])
{
  const PetscReal mean = (a[0] + a[1] + a[2]) / 3.0;
  PetscReal sum = 0;
  for (int k = 0; k < 3; ++k) sum += (a[k] - mean) * (a[k] - mean) + 2.0 * a[k + 3] * a[k + 3];
  return sum;
}

/* q = sqrt(3/2 s : s), von Mises' equivalent stress: |sigma_axial - sigma_radial| in a triaxial test. */
static inline PetscReal stress_deviatoric(const PetscReal sigma[6]) { return sqrt(1.5 * deviator_norm2(sigma)); }

/* sin phi = (sigma_1 - sigma_3) / -(sigma_1 + sigma_3), the angle of friction that holds this stress
 * without cohesion, rad: 0 without shear, 90 degrees where that cannot be, with a tension. */
static inline PetscReal stress_mobilised_friction(const PetscReal sigma[6])
{
  PetscReal value[3], v[9];
  sym_eigen(sigma, value, v);
  const PetscReal difference = value[0] - value[2], sum = -(value[0] + value[2]);
  return difference > 0 ? atan2(difference, sqrt(PetscMax(sum * fabs(sum) - difference * difference, 0.0))) : 0.0;
}

/* ln V = ln(F F^T) / 2, the logarithmic strain in the axes of space; shears are not doubled. */
static inline void strain_logarithmic(const PetscReal F[9], PetscReal strain[6])
{
  const PetscReal identity[6] = {1, 1, 1, 0, 0, 0};
  PetscReal b[6], value[3], v[9];
  sym_push_forward(F, identity, b);
  sym_eigen(b, value, v);
  for (int k = 0; k < 6; ++k) {
    strain[k] = 0;
    for (int a = 0; a < 3; ++a) strain[k] += 0.5 * log(value[a]) * v[3 * voigt_row[k] + a] * v[3 * voigt_column[k] + a];
  }
}

/* eps_q = sqrt(2/3 e : e) of the deviator e: |axial - radial| 2/3 in a triaxial test, the partner of q
 * in the work p d eps_v + q d eps_q. */
static inline PetscReal strain_deviatoric(const PetscReal strain[6])
{
  return sqrt(2.0 / 3.0 * deviator_norm2(strain));
}
