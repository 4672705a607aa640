/* Isotropic laws in principal axes: from stretches, stresses and their moduli to tensors, exactly
 * also where principal stretches are equal or nearly so.
 *
 * With n_A the principal directions of the trial b, D_AB = d tau_A / d eps_B (logarithmic
 * stretches) and L_v tau = c : d, the components of c in these axes are
 *
 *   c_AABB = D_AB - 2 tau_A delta_AB
 *   c_ABAB = (tau_A b_B - tau_B b_A) / (b_A - b_B) = (r x coth x - tau_A - tau_B) / 2,
 *            r = (tau_A - tau_B) / x,  x = eps_A - eps_B,
 *
 * all others zero. The second form has no cancellation once the law supplies the divided difference
 * r, which stays within [0, 2 mu]. It takes the place of the thesis' 3.147, whose terms grow like 1
 * / x and cancel. */
#pragma once
#include "base/math/eigen.h"
#include "base/math/tensor.h"
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
