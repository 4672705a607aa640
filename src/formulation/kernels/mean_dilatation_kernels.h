/* Point kernels of mean dilatation, beside those of displacement_kernels.h: same rows, same
 * conventions.
 *
 * With m the unit tensor of the d directions that share a volume, D[u] = sum_q v_q div_q u / sum_q v_q
 * and P = sum_q V0 tr tau_q / d over the points of the cell, d its derivative (docs/theory.md),
 *
 *   delta W = sum_p V0 tau : (grad u + (D[u] - div u) m / d)
 *
 * is linear in the gradients of each point and in the one D of the cell. The second derivative
 * falls into what the points do by themselves, moduli c' and a stress tau' as a law gives them, and
 * sums over the cell that meet D. */
#pragma once
#include "formulation/kernels/displacement_kernels.h"

/* In plane strain the third direction keeps its length and shares nothing. */
KERNEL int sharing_directions(const int dim, const PetscBool hoop) { return dim == 2 && !hoop ? 2 : 3; }

/* Does the kinematics know this component of Voigt's? */
KERNEL PetscBool is_strain(const int dim, const PetscBool hoop, int i)
{
  return dim == 3 || (i < 4 && (i != 2 || hoop));
}

/* tr tau / d */
KERNEL PetscReal mean_stress(const int dim, const PetscBool hoop, const PetscReal *tau)
{
  const int d = sharing_directions(dim, hoop);
  PetscReal trace = 0;
  for (int i = 0; i < d; ++i) trace += tau[i];
  return trace / d;
}

typedef struct {
  PetscReal c[36], tau[6]; /* what meets the gradients of the point alone */
  PetscReal left[6];       /* K = g_I left D[J] + */
  PetscReal right[6];      /* D[I] right g_J + */
  PetscReal bulk;          /* D[I] bulk D[J] */
} MeanModuli;

/* Rows and columns of c summed over what shares, with 2 tau, over d; returns their sum, the moduli
 * between two mean dilatations. */
KERNEL PetscReal mean_rows(const int dim, const PetscBool hoop, const PetscReal *restrict tau,
                           const PetscReal *restrict c, MeanModuli *restrict m)
{
  const int d = sharing_directions(dim, hoop);
  PetscReal all = 2 * mean_stress(dim, hoop, tau) / d;
  for (int i = 0; i < 6; ++i) {
    m->left[i] = m->right[i] = 0;
    if (!is_strain(dim, hoop, i)) continue;
    for (int j = 0; j < d; ++j) m->left[i] += c[6 * i + j], m->right[i] += c[6 * j + i];
    if (i < d) all += m->left[i] / (d * d);
    m->left[i] = (m->left[i] + 2 * tau[i]) / d;
    m->right[i] = (m->right[i] + 2 * tau[i]) / d;
  }
  return all;
}

/* From the law's tau and c; weight: P v_p / (sum v) over V0 of the point.
 *
 * tr(grad u grad w) is 2 sym grad u : sym grad w - grad u : grad w, that is moduli 2 I_s and a stress of
 * -1, so that its factor s, of m, goes into c' and tau'. */
KERNEL void mean_moduli(const int dim, const PetscBool hoop, const PetscReal *restrict tau, const PetscReal *restrict c,
                        PetscReal weight, MeanModuli *restrict m)
{
  const int d = sharing_directions(dim, hoop);
  const PetscReal s = mean_stress(dim, hoop, tau) - weight, all = mean_rows(dim, hoop, tau, c, m);
  for (int i = 0; i < 6; ++i) {
    m->tau[i] = is_strain(dim, hoop, i) ? tau[i] - (i < d ? s : 0) : 0;
    for (int j = 0; j < 6; ++j) {
      if (!is_strain(dim, hoop, i) || !is_strain(dim, hoop, j)) continue;
      m->c[6 * i + j] =
        c[6 * i + j] - (j < d ? m->left[i] : 0) - (i < d ? m->right[j] : 0) + (i < d && j < d ? all + weight : 0);
    }
    if (is_strain(dim, hoop, i)) m->c[7 * i] += i < 3 ? 2 * s : s;
  }
  for (int i = 0; i < d; ++i) m->left[i] -= all, m->right[i] -= all;
  m->bulk = all;
}

/* K[I][a][b][J] += left_Ia D_Jb + D_Ia (right_Jb + bulk D_Jb), dim rows each; only a <= b if the rest
 * is to be mirrored. */
KERNEL void add_shared_stiffness(const int dim, const int nn, const PetscBool symmetric, const PetscReal *restrict D,
                                 const PetscReal *restrict left, const PetscReal *restrict right, PetscReal bulk,
                                 PetscReal *restrict K)
{
  const int w = row_width(nn);
  PetscReal column[3 * CELL_MAX_NODES];
  for (int b = 0; b < dim; ++b) {
    row_copy(nn, right + b * w, column + b * w);
    row_add(nn, bulk, D + b * w, column + b * w);
  }
  for (int I = 0; I < nn; ++I)
    for (int a = 0; a < dim; ++a)
      for (int b = symmetric ? a : 0; b < dim; ++b) {
        PetscReal *row = K + ((I * dim + a) * dim + b) * w;
        row_add(nn, left[a * w + I], D + b * w, row);
        row_add(nn, D[a * w + I], column + b * w, row);
      }
}
