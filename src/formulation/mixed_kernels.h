/* Point kernels of the mixed formulation, beside those of displacement_kernels.h: same rows,
 * same conventions.
 *
 * Kup is nn x dim rows over the nodes of the pressure, Kpu nn x dim rows over the nodes of the
 * displacement, Kpp nn rows. */
#pragma once
#include "formulation/displacement_kernels.h"

/* Polynomial pressure projection: integral of (N_I - mean)(N_J - mean) over a cell of volume 1,
 * on the reference cell. On a triangle (2 on the diagonal, -1 beside it) / 36, on a tetrahedron
 * (3, -1) / 80; on quadrilaterals and hexahedra the product of the segments' 1/3 and 1/6, less 1
 * / nn^2. Its rows sum to zero. */
KERNEL PetscReal projection_entry(const int dim, const int nn, int I, int J)
{
  static const int corner[8] = {0, 1, 3, 2, 4, 5, 7, 6}; /* bits: upper end along x, y, z */
  const PetscReal mean = 1.0 / ((PetscReal)nn * nn);
  if (nn == dim + 1) return (I == J ? 2.0 : 1.0) / ((dim + 1.0) * (dim + 2.0)) - mean;
  PetscReal product = 1.0;
  for (int d = 0; d < dim; ++d) product *= (corner[I] ^ corner[J]) >> d & 1 ? 1.0 / 6.0 : 1.0 / 3.0;
  return product - mean;
}

/* Kup[I][a][J] += V0 s sum_j g_Ij t_aj N_J, t = dtau/dp. */
KERNEL void add_pressure_force(const int dim, const int nn, const PetscBool hoop, const PetscReal *restrict g,
                               const PetscReal *restrict t, const PetscReal *restrict N, PetscReal volume,
                               PetscReal *restrict K)
{
  const int w = row_width(nn);
  for (int I = 0; I < nn; ++I)
    for (int a = 0; a < dim; ++a) {
      PetscReal sum = 0;
      for (int j = 0; j < gradient_rows(dim, hoop); ++j)
        if (is_felt(dim, a, j)) sum += g[j * w + I] * t[strain_of(dim, a, j)];
      row_add(nn, volume * sum, N, K + (I * dim + a) * w);
    }
}

/* Kpu[I][b][J] += V0 s theta' N_I g_Jb. */
KERNEL void add_dilation(const int dim, const int nn, const PetscBool hoop, const PetscReal *restrict g,
                         const PetscReal *restrict N, PetscReal volume, PetscReal *restrict K)
{
  const int w = row_width(nn);
  for (int I = 0; I < nn; ++I) {
    for (int b = 0; b < dim; ++b) row_add(nn, volume * N[I], g + b * w, K + (I * dim + b) * w);
    if (hoop) row_add(nn, volume * N[I], g + dim * w, K + I * dim * w);
  }
}
