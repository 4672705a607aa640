/* Point kernels of the displacement formulation, with dimension, number of nodes, and whether
 * there is a hoop known at compile time.
 *
 * Where the plane turns about its axis (Kinematics.hoop) a ring strains by u_x / x: gradients
 * have a row more, N / x, that the first component of displacements alone feels, and that stands
 * for zz.
 *
 * The innermost index runs over nodes: a row holds one number per node, padded to the width of a
 * SIMD register. Rows are vectors of the compiler's, since it leaves loops of such fixed short
 * length scalar. g is dim rows, the cell force dim rows, the cell matrix nn x dim x dim rows. */
#pragma once
#include "base/math/lanes.h"
#include "base/math/rows.h"
#include "base/math/tensor.h"
#include "formulation/formulation.h"

#define KERNEL static inline __attribute__((always_inline))

typedef float Single4 __attribute__((vector_size(4 * sizeof(float)), aligned(sizeof(float)), may_alias));
typedef float Single8 __attribute__((vector_size(8 * sizeof(float)), aligned(sizeof(float)), may_alias));

KERNEL PetscBool wants_tangent(const WeakFormOutput *out) { return out->values || out->singles; }

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

KERNEL void row_copy(const int nn, const PetscReal *x, PetscReal *row)
{
  if (row_width(nn) == 4) *(Row4 *)row = *(const Row4 *)x;
  else *(Row8 *)row = *(const Row8 *)x;
}

KERNEL void rows_transpose4(Row4 r[4]) { TRANSPOSE_FOUR(Row4, r); }

/* row += s x */
KERNEL void row_add(const int nn, PetscReal s, const PetscReal *x, PetscReal *row)
{
  if (row_width(nn) == 4) *(Row4 *)row += s * *(const Row4 *)x;
  else *(Row8 *)row += s * *(const Row8 *)x;
}

/* Rows of a gradient, and Voigt's number of the strain that component a of a displacement gives
 * along row j. */
KERNEL int gradient_rows(const int dim, const PetscBool hoop) { return hoop ? dim + 1 : dim; }
KERNEL int strain_of(const int dim, int a, int j) { return j < dim ? voigt_of[a][j] : 2; }
KERNEL PetscBool is_felt(const int dim, int a, int j) { return j < dim || a == 0; }

/* c_ajbl + delta_ab tau_jl */
KERNEL PetscReal modulus_of(const int dim, int a, int j, int b, int l, const PetscReal *tau, const PetscReal *c)
{
  const PetscReal stress = j < dim && l < dim ? tau[voigt_of[j][l]] : j == l ? tau[2] : 0;
  return c[6 * strain_of(dim, a, j) + strain_of(dim, b, l)] + (a == b ? stress : 0);
}

/* dF = 1 + sum_I du_I dN_I of one point; du is nn x dim. */
KERNEL void increment_rows(const int dim, const int nn, const PetscReal *restrict dN, const PetscReal *restrict du,
                           PetscReal *restrict dF)
{
  if (nn != 8) {
    increment_gradient(dim, nn, dN, du, dF);
    return;
  }
  Row4 x = {1, 0, 0, 0}, y = {0, 1, 0, 0}, z = {0, 0, 1, 0};
  /* a row of dN and one number too many; what that gives is not stored */
  for (int I = 0; I < nn; ++I) {
    const PetscReal *d = dN + I * dim;
    const Row4 row = I < nn - 1 ? *(const Row4 *)d : (Row4){d[0], d[1], d[2], 0};
    x += du[I * dim] * row;
    y += du[I * dim + 1] * row;
    z += du[I * dim + 2] * row;
  }
  *(Row4 *)dF = x;
  *(Row4 *)(dF + 3) = y;
  for (int j = 0; j < 3; ++j) dF[6 + j] = z[j];
}

/* g = dF^-T dN: gradients at x_(n+1). N, radius (at x_n): for the hoop. */
KERNEL void current_gradients(const int dim, const int nn, const PetscBool hoop, const PetscReal *restrict dN,
                              const PetscReal *restrict N, PetscReal radius, const PetscReal *restrict dF,
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
  if (hoop) row_scale(nn, inverse[8] / radius, N, g + dim * w);
}

KERNEL void add_internal_force(const int dim, const int nn, const PetscBool hoop, const PetscReal *restrict g,
                               const PetscReal *restrict tau, PetscReal volume, PetscReal *restrict f)
{
  const int w = row_width(nn);
  for (int a = 0; a < dim; ++a)
    for (int j = 0; j < gradient_rows(dim, hoop); ++j)
      if (is_felt(dim, a, j)) row_add(nn, volume * tau[strain_of(dim, a, j)], g + j * w, f + a * w);
}

/* Points of one cell whose stiffness is added at once: a block row of the cell matrix then stays
 * in registers over all of them. */
#define RUN_POINTS 8

typedef struct {
  int n;
  PetscReal g[RUN_POINTS][3 * CELL_MAX_NODES]; /* gradients at x_(n+1), row by row */
  const PetscReal *tau[RUN_POINTS], *c[RUN_POINTS];
  PetscReal volume[RUN_POINTS];
} PointRun;

/* T_j = V0 sum_l (c_ajbl + delta_ab tau_jl) g_l of one point, as many rows as g has. */
KERNEL void run_products(const int dim, const int nn, const PetscBool hoop, const int a, const int b,
                         const PointRun *run, int k, PetscReal *restrict T)
{
  const int w = row_width(nn);
  const PetscReal *c = run->c[k], *tau = run->tau[k], *g = run->g[k], volume = run->volume[k];
#pragma GCC unroll 3
  for (int j = 0; j < gradient_rows(dim, hoop); ++j)
#pragma GCC unroll 3
    for (int l = 0; l < gradient_rows(dim, hoop); ++l) {
      if (!is_felt(dim, a, j) || !is_felt(dim, b, l)) continue;
      const PetscReal modulus = volume * modulus_of(dim, a, j, b, l, tau, c);
      if (l == 0) row_scale(nn, modulus, g, T + j * w);
      else row_add(nn, modulus, g + l * w, T + j * w);
    }
}

/* K[I][a][b][J] += sum over the points of sum_j g_Ij T_jJ; only a <= b if the rest is to be
 * mirrored. */
KERNEL void add_stiffness(const int dim, const int nn, const PetscBool hoop, const PetscBool symmetric,
                          const PointRun *run, PetscReal *restrict K)
{
  const int w = row_width(nn);
#pragma GCC unroll 3
  for (int a = 0; a < dim; ++a)
#pragma GCC unroll 3
    for (int b = symmetric ? a : 0; b < dim; ++b) {
      PetscReal sum[CELL_MAX_NODES * CELL_MAX_NODES], T[3 * CELL_MAX_NODES];
#pragma GCC unroll 8
      for (int I = 0; I < nn; ++I) row_copy(nn, K + ((I * dim + a) * dim + b) * w, sum + I * w);
      for (int k = 0; k < run->n; ++k) {
        run_products(dim, nn, hoop, a, b, run, k, T);
#pragma GCC unroll 8
        for (int I = 0; I < nn; ++I)
#pragma GCC unroll 3
          for (int j = 0; j < gradient_rows(dim, hoop); ++j)
            if (is_felt(dim, a, j)) row_add(nn, run->g[k][j * w + I], T + j * w, sum + I * w);
      }
#pragma GCC unroll 8
      for (int I = 0; I < nn; ++I) row_copy(nn, sum + I * w, K + ((I * dim + a) * dim + b) * w);
    }
}

/* K[I][b][a][J] = K[J][a][b][I] for a < b. */
KERNEL void mirror_stiffness(const int dim, const int nn, PetscReal *restrict K)
{
  const int w = row_width(nn), stride = dim * dim * w;
  for (int a = 0; a < dim; ++a)
    for (int b = a + 1; b < dim; ++b) {
      const PetscReal *from = K + (a * dim + b) * w;
      PetscReal *to = K + (b * dim + a) * w;
      Row4 four[4] = {{0}};
      Lanes eight[8];
      for (int I = 0; I < nn; ++I) {
        if (w == 4) four[I] = *(const Row4 *)(from + I * stride);
        else eight[I] = *(const Row8 *)(from + I * stride);
      }
      if (w == 4) rows_transpose4(four);
      else lanes_transpose(eight);
      for (int I = 0; I < nn; ++I) {
        if (w == 4) *(Row4 *)(to + I * stride) = four[I];
        else *(Row8 *)(to + I * stride) = eight[I];
      }
    }
}

/* The blocks of the next cells lie apart in memory, where no processor finds them by itself. */
KERNEL void prefetch_blocks(const int dim, const int nn, const PetscInt *restrict slot, const void *values,
                            const int number)
{
  const int size = dim * dim * number; /* bytes */
  for (int i = 0; i < nn * nn; ++i) {
    const char *block = (const char *)values + slot[i] * size;
    __builtin_prefetch(block, 1);
    if (dim > 2) __builtin_prefetch(block + size - number, 1);
  }
}

/* The first numbers of a block, in the precision that they are gathered in. */
KERNEL void block_add4(const PetscBool single, Row4 more, void *values, PetscInt at)
{
  if (single) *(Single4 *)((float *)values + at) += __builtin_convertvector(more, Single4);
  else *(Row4 *)((PetscReal *)values + at) += more;
}

KERNEL void block_add8(const PetscBool single, Row8 more, void *values, PetscInt at)
{
  if (single) *(Single8 *)((float *)values + at) += __builtin_convertvector(more, Single8);
  else *(Row8 *)((PetscReal *)values + at) += more;
}

KERNEL void block_add(const PetscBool single, PetscReal more, void *values, PetscInt at)
{
  if (single) ((float *)values)[at] += (float)more;
  else ((PetscReal *)values)[at] += more;
}

/* Block (I, J) of the cell matrix, dim x dim numbers, is added to values at slot[I nn + J]. In K
 * the numbers of a block are a row apart, so as many of them as a register takes are turned at
 * once. */
KERNEL void scatter_blocks(const int dim, const int nn, const PetscBool single, const PetscInt *restrict slot,
                           const PetscReal *restrict K, void *restrict values)
{
  const int w = row_width(nn), size = dim * dim, whole = size / w * w;
  for (int I = 0; I < nn; ++I, slot += nn, K += size * w) {
    for (int first = 0; first < whole; first += w) {
      Row4 four[4];
      Lanes eight[8];
      for (int e = 0; e < w; ++e) {
        if (w == 4) four[e] = *(const Row4 *)(K + (first + e) * w);
        else eight[e] = *(const Row8 *)(K + (first + e) * w);
      }
      if (w == 4) rows_transpose4(four);
      else lanes_transpose(eight);
      for (int J = 0; J < nn; ++J) {
        if (w == 4) block_add4(single, four[J], values, slot[J] * size + first);
        else block_add8(single, eight[J], values, slot[J] * size + first);
      }
    }
    for (int e = whole; e < size; ++e)
      for (int J = 0; J < nn; ++J) block_add(single, K[e * w + J], values, slot[J] * size + e);
  }
}

/* Mass of a point: its consistent share to M, nn rows, the lumped one to the row behind them. */
KERNEL void add_mass(const int nn, const PetscReal *restrict N, PetscReal mass, PetscReal lumping,
                     PetscReal *restrict M)
{
  const int w = row_width(nn);
  row_add(nn, mass * lumping, N, M + nn * w);
  for (int I = 0; lumping < 1 && I < nn; ++I) row_add(nn, mass * (1.0 - lumping) * N[I], N, M + I * w);
}

/* M += its lumped row. */
KERNEL void add_lumped_mass(const int nn, PetscReal *restrict M)
{
  for (int I = 0; I < nn; ++I) M[I * row_width(nn) + I] += M[nn * row_width(nn) + I];
}

/* Inertia that ties the nodes of a cell to their mean: no force on a uniform acceleration. */
KERNEL void add_tie(const int nn, PetscReal s, PetscReal *restrict M)
{
  for (int I = 0; I < nn; ++I)
    for (int J = 0; J < nn; ++J) M[I * row_width(nn) + J] += s * ((I == J) - 1.0 / nn);
}

/* Inertia and body force: f_I += sum_J M_IJ a_J. */
KERNEL void add_inertia_force(const int dim, const int nn, const PetscReal *restrict M, const PetscReal *restrict a,
                              PetscReal *restrict f)
{
  const int w = row_width(nn);
  for (int d = 0; d < dim; ++d)
    for (int J = 0; J < nn; ++J) row_add(nn, a[d * w + J], M + J * w, f + d * w);
}
