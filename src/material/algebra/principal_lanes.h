/* material/algebra/principal.h for eight points side by side; the formulas stand there. */
#pragma once
#include "material/algebra/lanes.h"
#include "base/math/eigen_lanes.h"
#include "base/math/projections_lanes.h"

LANES_INLINE void lanes_principal_basis(const Lanes v[9], Lanes basis[36])
{
  for (int a = 0; a < 3; ++a)
    for (int k = 0; k < 6; ++k) {
      const int i = 3 * voigt_row[k], j = 3 * voigt_column[k], b = (a + 1) % 3;
      basis[6 * a + k] = v[i + a] * v[j + a];
      basis[6 * (a + 3) + k] = v[i + a] * v[j + b] + v[i + b] * v[j + a];
    }
}

LANES_INLINE void lanes_principal_tensor(const Lanes value[3], const Lanes basis[36], Lanes s[6])
{
  const Lanes d0 = value[0] - value[1], d2 = value[2] - value[1];
  for (int k = 0; k < 6; ++k) s[k] = (k < 3 ? value[1] : 0.0 * value[1]) + d0 * basis[k] + d2 * basis[12 + k];
}

LANES_INLINE void lanes_principal_coth(const Lanes *x, const Lanes *b_a, const Lanes *b_b, Lanes *result)
{
  const Lanes y = *x * *x, series = 1.0 + y * (1.0 / 3.0 - y * (1.0 / 45.0 - y * (2.0 / 945.0 - y / 4725.0)));
  const Lanes closed = *x * (*b_a + *b_b) / (*b_a - *b_b);
  const LaneBits near = y < 1e-3;
  lanes_select(&near, &series, &closed, result);
}

LANES_INLINE void lanes_principal_tangent(const Lanes D[9], const Lanes tau[3], const Lanes shear[3],
                                          const Lanes basis[36], Lanes c[36])
{
  Lanes m[18];
  for (int a = 0; a < 3; ++a)
    for (int k = 0; k < 6; ++k)
      m[6 * a + k] = D[3 * a] * basis[k] + D[3 * a + 1] * basis[6 + k] + D[3 * a + 2] * basis[12 + k] -
                     2.0 * tau[a] * basis[6 * a + k];
  for (int i = 0; i < 6; ++i) {
    const Lanes turn0 = shear[0] * basis[18 + i], turn1 = shear[1] * basis[24 + i], turn2 = shear[2] * basis[30 + i];
    for (int j = 0; j < 6; ++j)
      c[6 * i + j] = basis[i] * m[j] + basis[6 + i] * m[6 + j] + basis[12 + i] * m[12 + j] + turn0 * basis[18 + j] +
                     turn1 * basis[24 + j] + turn2 * basis[30 + j];
  }
}
