/* Point kernels of the mixed formulation, beside those of displacement_kernels.h: same rows,
 * same conventions.
 *
 * Kup is nn x dim rows over the nodes of the pressure, Kpu nn x dim rows over the nodes of the
 * displacement, Kpp nn rows. */
#pragma once
#include "formulation/kernels/displacement_kernels.h"
#include "material/pressure.h"

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

/* By how much pressures that vary inside a cell are held at point p, 1/Pa. */
KERNEL PetscReal point_softness(const WeakFormInput *in, const Material *material, PetscInt p)
{
  PetscReal tau[6];
  if (!material->flow) return in->alpha / material->elastic.shear;
  point_tau(in->points, p, tau);
  return in->alpha * pressure_softness(material, point_real(in->points, POINT_STATE, p), tau);
}

/* What pressures bear at point p, per mass, m/s2. */
KERNEL void point_weight(const int dim, const WeakFormInput *in, PetscInt p, PetscReal weight[3])
{
  const PetscBool weighs = in->weighs[in->points->body[p]];
  for (int d = 0; d < dim; ++d) weight[d] = weighs ? in->gravity[d] + (in->pull ? in->pull[3 * p + d] : 0) : 0;
}

/* By how much the pressure that bears the weight is smaller (more compressive) at x + du than at the origin, over what
 * `weight` is times. A force need not have a potential: in a cell the mean one of its points counts, which has. Its
 * derivative makes the tangent unsymmetric and is left out of symmetric ones: beside the rest it is as the weight of a
 * cell to its stiffness. */
KERNEL PetscReal pressure_depth(const int dim, const PetscReal *weight, const PetscReal *x, const PetscReal *du)
{
  PetscReal depth = 0;
  for (int d = 0; d < dim; ++d) depth += weight[d] * (x[d] + du[d]);
  return depth;
}

/* Integral of N_I N_J N_K over a triangle or quadrilateral of area 1, on the reference cell. */
KERNEL PetscReal triple_entry(const int nn, int I, int J, int K)
{
  static const int corner[4] = {0, 1, 3, 2}; /* bits: upper end along x, y */
  if (nn == 3) return I == J && J == K ? 1.0 / 10.0 : (I == J || J == K || K == I ? 1.0 / 30.0 : 1.0 / 60.0);
  PetscReal product = 1.0;
  for (int d = 0; d < 2; ++d)
    product *= ((corner[I] ^ corner[J]) | (corner[J] ^ corner[K])) >> d & 1 ? 1.0 / 12.0 : 1.0 / 4.0;
  return product;
}

/* The same projection in a ring, nodes at these radii: integrals weighted with r over the ring's
 * volume, so that P (nn x nn) still vanishes for a uniform pressure. */
KERNEL void ring_projection(const int nn, const PetscReal *radius, PetscReal *P)
{
  PetscReal share[CELL_MAX_NODES] = {0}, volume = 0;
  for (int I = 0; I < nn; ++I) {
    for (int J = 0; J < nn; ++J) {
      P[I * nn + J] = 0;
      for (int K = 0; K < nn; ++K) P[I * nn + J] += triple_entry(nn, I, J, K) * radius[K];
      share[I] += P[I * nn + J];
    }
    volume += share[I];
  }
  for (int I = 0; I < nn; ++I)
    for (int J = 0; J < nn; ++J) P[I * nn + J] = (P[I * nn + J] - share[I] * share[J] / volume) / volume;
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
