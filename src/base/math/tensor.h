/* Small dense tensors, always three-dimensional.
 *
 * Second-order tensors are 9 numbers, row by row. Symmetric ones are 6 in Voigt order
 * xx yy zz xy yz zx; strains double the shear, stresses don't. Fourth-order tangents are 6 x 6. */
#pragma once
#include <petscsys.h>

#undef I /* complex.h's imaginary unit: here I is a node, as in the equations */

static inline PetscReal tensor_det(const PetscReal a[9])
{
  return a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) + a[2] * (a[3] * a[7] - a[4] * a[6]);
}

/* inverse = a^-1, returns det a; the caller checks that it is not zero. */
static inline PetscReal tensor_inverse(const PetscReal a[9], PetscReal inverse[9])
{
  const PetscReal c0 = a[4] * a[8] - a[5] * a[7];
  const PetscReal c1 = a[5] * a[6] - a[3] * a[8];
  const PetscReal c2 = a[3] * a[7] - a[4] * a[6];
  const PetscReal det = a[0] * c0 + a[1] * c1 + a[2] * c2, s = 1.0 / det;
  inverse[0] = c0 * s;
  inverse[1] = (a[2] * a[7] - a[1] * a[8]) * s;
  inverse[2] = (a[1] * a[5] - a[2] * a[4]) * s;
  inverse[3] = c1 * s;
  inverse[4] = (a[0] * a[8] - a[2] * a[6]) * s;
  inverse[5] = (a[2] * a[3] - a[0] * a[5]) * s;
  inverse[6] = c2 * s;
  inverse[7] = (a[1] * a[6] - a[0] * a[7]) * s;
  inverse[8] = (a[0] * a[4] - a[1] * a[3]) * s;
  return det;
}

static inline void tensor_multiply(const PetscReal a[9], const PetscReal b[9], PetscReal c[9])
{
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

/* Row and column of Voigt component k. */
static const int voigt_row[6] = {0, 1, 2, 0, 1, 2};
static const int voigt_column[6] = {0, 1, 2, 1, 2, 0};
/* Voigt component of row i, column j. */
static const int voigt_of[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

static inline void sym_to_full(const PetscReal s[6], PetscReal a[9])
{
  a[0] = s[0];
  a[4] = s[1];
  a[8] = s[2];
  a[1] = a[3] = s[3];
  a[5] = a[7] = s[4];
  a[2] = a[6] = s[5];
}

static inline PetscReal sym_det(const PetscReal s[6])
{
  return s[0] * (s[1] * s[2] - s[4] * s[4]) - s[3] * (s[3] * s[2] - s[4] * s[5]) + s[5] * (s[3] * s[4] - s[1] * s[5]);
}

/* pushed = f s f^T: push-forward of a contravariant symmetric tensor such as b. */
static inline void sym_push_forward(const PetscReal f[9], const PetscReal s[6], PetscReal pushed[6])
{
  PetscReal a[9], fa[9];
  sym_to_full(s, a);
  tensor_multiply(f, a, fa);
  for (int k = 0; k < 6; ++k) {
    const PetscReal *row = fa + 3 * voigt_row[k], *column = f + 3 * voigt_column[k];
    pushed[k] = row[0] * column[0] + row[1] * column[1] + row[2] * column[2];
  }
}
