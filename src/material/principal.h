/* Isotropic laws in principal axes: from stretches, stresses and their moduli to tensors, exactly also where principal
 * stretches are equal or nearly so.
 *
 * With n_A the principal directions of the trial b, D_AB = d tau_A / d eps_B (logarithmic stretches) and
 * L_v tau = c : d, the components of c in these axes are
 *
 *   c_AABB = D_AB - 2 tau_A delta_AB
 *   c_ABAB = (tau_A b_B - tau_B b_A) / (b_A - b_B) = (r x coth x - tau_A - tau_B) / 2,
 *            r = (tau_A - tau_B) / x,  x = eps_A - eps_B,
 *
 * all others zero. The second form has no cancellation once the law supplies the divided difference r, which stays
 * within [0, 2 mu]. It takes the place of the thesis' 3.147, whose terms grow like 1 / x and cancel. */
#pragma once
#include "base/eigen.h"
#include "base/tensor.h"
#include <math.h>

/* Voigt rows of n_A n_A (A = 1, 2, 3) and of n_A n_B + n_B n_A (12, 23, 31). */
static inline void principal_basis(const PetscReal v[9], PetscReal basis[36])
{
  for (int a = 0; a < 3; ++a)
    for (int k = 0; k < 6; ++k) {
      const int i = 3 * voigt_row[k], j = 3 * voigt_column[k], b = (a + 1) % 3;
      basis[6 * a + k] = v[i + a] * v[j + a];
      basis[6 * (a + 3) + k] = v[i + a] * v[j + b] + v[i + b] * v[j + a];
    }
}

/* sum value[A] n_A n_A: exactly a multiple of the identity if all three are equal. */
static inline void principal_tensor(const PetscReal value[3], const PetscReal basis[36], PetscReal s[6])
{
  const PetscReal d0 = value[0] - value[1], d2 = value[2] - value[1];
  for (int k = 0; k < 6; ++k) s[k] = (k < 3 ? value[1] : 0.0) + d0 * basis[k] + d2 * basis[12 + k];
}

/* x coth x of the stretches b_A, b_B = exp(2 eps). */
static inline PetscReal principal_coth(PetscReal x, PetscReal b_a, PetscReal b_b)
{
  const PetscReal y = x * x;
  if (y < 1e-3) return 1.0 + y * (1.0 / 3.0 - y * (1.0 / 45.0 - y * (2.0 / 945.0 - y / 4725.0)));
  return x * (b_a + b_b) / (b_a - b_b);
}

/* c = sum_KL B_K M_KL B_L with M = D - 2 tau on the diagonal for the normal part and shear[12, 23, 31]. */
static inline void principal_tangent(const PetscReal D[9], const PetscReal tau[3], const PetscReal shear[3],
                                     const PetscReal basis[36], PetscReal *c)
{
  PetscReal m[36];
  for (int a = 0; a < 3; ++a)
    for (int k = 0; k < 6; ++k) {
      m[6 * a + k] = D[3 * a] * basis[k] + D[3 * a + 1] * basis[6 + k] + D[3 * a + 2] * basis[12 + k] -
                     2.0 * tau[a] * basis[6 * a + k];
      m[6 * (a + 3) + k] = shear[a] * basis[6 * (a + 3) + k];
    }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      PetscReal sum = 0.0;
      for (int a = 0; a < 6; ++a) sum += basis[6 * a + i] * m[6 * a + j];
      c[6 * i + j] = sum;
    }
}
