/* Point kernels of the displacement formulation, with dimension and number of nodes known at compile time.
 *
 * The innermost index runs over nodes: a row holds one number per node, padded to the width of a SIMD register. Rows are vectors of
 * the compiler's, since it leaves loops of such fixed short length scalar. g is dim rows, the cell force dim rows, the cell
 * matrix nn x dim x dim rows. */
#pragma once
#include "base/tensor.h"

#define KERNEL static inline __attribute__((always_inline))

typedef PetscReal Row4 __attribute__((vector_size(4 * sizeof(PetscReal)), aligned(sizeof(PetscReal)), may_alias));
typedef PetscReal Row8 __attribute__((vector_size(8 * sizeof(PetscReal)), aligned(sizeof(PetscReal)), may_alias));

KERNEL int row_width(const int nn) { return nn <= 4 ? 4 : 8; }

/* row = every `stride`-th number, zero beyond nn. */
KERNEL void row_load(const int nn, const int stride, const PetscReal *x, PetscReal *row)
{
  if (nn == 3) *(Row4 *)row = (Row4){x[0], x[stride], x[2 * stride], 0};
  else if (nn == 4) *(Row4 *)row = (Row4){x[0], x[stride], x[2 * stride], x[3 * stride]};
  else
    *(Row8 *)row =
      (Row8){x[0], x[stride], x[2 * stride], x[3 * stride], x[4 * stride], x[5 * stride], x[6 * stride], x[7 * stride]};
}

/* row = s x */
KERNEL void row_scale(const int nn, PetscReal s, const PetscReal *x, PetscReal *row)
{
  if (row_width(nn) == 4) *(Row4 *)row = s * *(const Row4 *)x;
  else *(Row8 *)row = s * *(const Row8 *)x;
}

/* row += s x */
KERNEL void row_add(const int nn, PetscReal s, const PetscReal *x, PetscReal *row)
{
  if (row_width(nn) == 4) *(Row4 *)row += s * *(const Row4 *)x;
  else *(Row8 *)row += s * *(const Row8 *)x;
}

/* g = dF^-T dN: gradients at x_(n+1). */
KERNEL void current_gradients(const int dim, const int nn, const PetscReal *restrict dN, const PetscReal *restrict dF,
                              PetscReal *restrict g)
{
  const int w = row_width(nn);
  PetscReal inverse[9], old[3 * CELL_MAX_NODES];
  tensor_inverse(dF, inverse);
  for (int i = 0; i < dim; ++i) row_load(nn, dim, dN + i, old + i * w);
  for (int j = 0; j < dim; ++j) {
    row_scale(nn, inverse[j], old, g + j * w);
    for (int i = 1; i < dim; ++i) row_add(nn, inverse[3 * i + j], old + i * w, g + j * w);
  }
}

KERNEL void add_internal_force(const int dim, const int nn, const PetscReal *restrict g, const PetscReal *restrict tau,
                               PetscReal volume, PetscReal *restrict f)
{
  const int w = row_width(nn);
  for (int a = 0; a < dim; ++a)
    for (int j = 0; j < dim; ++j) row_add(nn, volume * tau[voigt_of[a][j]], g + j * w, f + a * w);
}

/* K[I][a][b][J] += V0 sum_jl g_Ij (c_ajbl + delta_ab tau_jl) g_Jl */
KERNEL void add_stiffness(const int dim, const int nn, const PetscReal *restrict g, const PetscReal *restrict tau,
                          const PetscReal *restrict c, PetscReal volume, PetscReal *restrict K)
{
  const int w = row_width(nn);
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b) {
      PetscReal T[3 * CELL_MAX_NODES];
      for (int j = 0; j < dim; ++j)
        for (int l = 0; l < dim; ++l) {
          const PetscReal modulus =
            volume * (c[6 * voigt_of[a][j] + voigt_of[b][l]] + (a == b ? tau[voigt_of[j][l]] : 0.0));
          if (l == 0) row_scale(nn, modulus, g, T + j * w);
          else row_add(nn, modulus, g + l * w, T + j * w);
        }
      for (int I = 0; I < nn; ++I)
        for (int j = 0; j < dim; ++j) row_add(nn, g[j * w + I], T + j * w, K + ((I * dim + a) * dim + b) * w);
    }
}

/* Consistent inertia and body force: f_I += m N_I ((1 - lumping) sum_J N_J a_J + lumping a_I). */
KERNEL void add_inertia_force(const int dim, const int nn, const PetscReal *restrict N, const PetscReal *restrict a,
                              PetscReal mass, PetscReal lumping, PetscReal *restrict f)
{
  const int w = row_width(nn);
  for (int d = 0; d < dim; ++d) {
    PetscReal mean = 0;
    for (int I = 0; I < nn; ++I) mean += N[I] * a[d * w + I];
    row_add(nn, mass * (1.0 - lumping) * mean, N, f + d * w);
    if (lumping > 0)
      for (int I = 0; I < nn; ++I) f[d * w + I] += mass * lumping * N[I] * a[d * w + I];
  }
}

/* M is nn rows. */
KERNEL void add_mass(const int nn, const PetscReal *restrict N, PetscReal mass, PetscReal lumping,
                     PetscReal *restrict M)
{
  const int w = row_width(nn);
  for (int I = 0; I < nn; ++I) {
    row_add(nn, mass * (1.0 - lumping) * N[I], N, M + I * w);
    if (lumping > 0) M[I * w + I] += mass * lumping * N[I];
  }
}

/* Inertia that ties the nodes of a cell to their mean: f_I += s (a_I - mean), no force on a uniform acceleration. M is nn rows. */
KERNEL void add_tie(const int dim, const int nn, PetscReal s, const PetscReal *restrict a, PetscReal *restrict f,
                    PetscReal *restrict M)
{
  const int w = row_width(nn);
  for (int d = 0; d < dim; ++d) {
    PetscReal mean = 0;
    for (int I = 0; I < nn; ++I) mean += a[d * w + I] / nn;
    for (int I = 0; I < nn; ++I) f[d * w + I] += s * (a[d * w + I] - mean);
  }
  for (int I = 0; I < nn; ++I)
    for (int J = 0; J < nn; ++J) M[I * w + J] += s * ((I == J) - 1.0 / nn);
}
