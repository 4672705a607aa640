/* The weak form of one point as a textbook has it, in plain loops: what the vectorised kernels
 * of src/formulation must give.
 *
 *   f_I  = V tau grad N_I                                        thesis eq. 4.31, docs/theory.md
 *   K_IJ = V (grad N_I . c . grad N_J + (grad N_I . tau grad N_J) 1)
 *
 * Gradients are those at the end of the step, grad N = dF^-T dN. tau (Kirchhoff) and c (L_v tau
 * = c : d) in Voigt's order xx yy zz xy yz zx; dim 2 is plane strain. */
#pragma once
#include "base/math/tensor.h"

static inline void reference_increment(int dim, int nn, const double *dN, const double *du, double dF[9])
{
  for (int i = 0; i < 9; ++i) dF[i] = i % 4 == 0;
  for (int I = 0; I < nn; ++I)
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) dF[3 * i + j] += du[I * dim + i] * dN[I * dim + j];
}

static inline void reference_gradients(int dim, int nn, const double *dN, const double *dF, double *g)
{
  double inverse[9];
  tensor_inverse(dF, inverse);
  for (int I = 0; I < nn; ++I)
    for (int j = 0; j < dim; ++j) {
      g[I * dim + j] = 0;
      for (int i = 0; i < dim; ++i) g[I * dim + j] += inverse[3 * i + j] * dN[I * dim + i];
    }
}

/* f_I (dim numbers) of a node with the gradient gI. */
static inline void reference_force(int dim, const double *gI, double volume, const double *tau, double *f)
{
  for (int a = 0; a < dim; ++a) {
    f[a] = 0;
    for (int j = 0; j < dim; ++j) f[a] += volume * tau[voigt_of[a][j]] * gI[j];
  }
}

/* K_IJ (dim x dim numbers) of a pair of nodes. */
static inline void reference_stiffness(int dim, const double *gI, const double *gJ, double volume, const double *tau,
                                       const double *c, double *K)
{
  double geometric = 0;
  for (int j = 0; j < dim; ++j)
    for (int l = 0; l < dim; ++l) geometric += gI[j] * tau[voigt_of[j][l]] * gJ[l];
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b) {
      double material = 0;
      for (int j = 0; j < dim; ++j)
        for (int l = 0; l < dim; ++l) material += gI[j] * c[6 * voigt_of[a][j] + voigt_of[b][l]] * gJ[l];
      K[a * dim + b] = volume * (material + (a == b ? geometric : 0));
    }
}
