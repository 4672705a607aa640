/* Linear triangles and tetrahedra: all points of a cell see the same gradients, so that stresses
 * and moduli are summed first, and meet the gradients once a cell.
 *
 * Only a hoop's row h = N / x differs from point to point. What it adds is kept in rows over
 * nodes until the cell is done:
 *
 *   K_I0Jb += sum_l across_l[I] g_l[J],  K_IaJ0 += sum_j g_j[I] along_j[J],  K_I0J0 += ring_I[J] */
#pragma once
#include "formulation/kernels/displacement_kernels.h"

KERNEL PetscBool is_simplex(const int dim, const int nn) { return nn == dim + 1; }

typedef struct {
  PetscReal g[3 * 4];      /* dim rows: gradients at x_(n+1) */
  PetscReal tau[8], c[36]; /* sums of V0 tau and V0 c, of components that the kinematics knows */
  PetscReal force[4];      /* V0 tau_33 h */
  PetscReal along[3 * 4];  /* V0 c_i,33 h: a row for each of 11, 22, 12 */
  PetscReal across[3 * 4]; /* V0 c_33,i h */
  PetscReal ring[3 * 4];   /* V0 (c_33,33 + tau_33) h_I h: a row for each node */
} SimplexSum;

/* The row of `along` and `across` of strain_of(2, a, j). */
KERNEL int simplex_row(int a, int j) { return a == j ? a : 2; }

/* Before the first point of a cell: its nodes' increments du (nn x dim), dN of any of its points. */
KERNEL void simplex_begin(const int dim, const int nn, const PetscReal *restrict dN, const PetscReal *restrict du,
                          SimplexSum *s)
{
  PetscReal dF[9];
  increment_rows(dim, nn, dN, du, dF);
  current_gradients(dim, nn, PETSC_FALSE, dN, NULL, 0, dF, s->g);
  for (int i = 0; i < 8; ++i) s->tau[i] = 0;
  for (int i = 0; i < 36; ++i) s->c[i] = 0;
  for (int i = 0; i < 4; ++i) s->force[i] = 0;
  for (int i = 0; i < 12; ++i) s->along[i] = s->across[i] = s->ring[i] = 0;
}

/* h: the row of the hoop at x_(n+1). */
KERNEL void simplex_add_hoop(const PetscReal *restrict tau, const PetscReal *restrict c, PetscReal volume,
                             const PetscReal *restrict h, SimplexSum *s)
{
  static const int strain[3] = {0, 1, 3};
  row_add(3, volume * tau[2], h, s->force);
  if (!c) return;
  for (int i = 0; i < 3; ++i) {
    row_add(3, volume * c[6 * strain[i] + 2], h, s->along + 4 * i);
    row_add(3, volume * c[12 + strain[i]], h, s->across + 4 * i);
    row_add(3, volume * (c[14] + tau[2]) * h[i], h, s->ring + 4 * i);
  }
}

/* Stress and moduli (NULL: none are asked for) of one point; h as above, with a hoop. */
KERNEL void simplex_add(const int dim, const PetscBool hoop, const PetscReal *restrict tau, const PetscReal *restrict c,
                        PetscReal volume, const PetscReal *restrict h, SimplexSum *s)
{
  row_add(4, volume, tau, s->tau);
  for (int i = 4; dim == 3 && i < 6; ++i) s->tau[i] += volume * tau[i];
  for (int i = 0; c && dim == 2 && i < 4; ++i)
    if (i != 2) row_add(4, volume, c + 6 * i, s->c + 6 * i);
  for (int i = 0; c && dim == 3 && i < 36; i += 4) row_add(4, volume, c + i, s->c + i);
  if (hoop) simplex_add_hoop(tau, c, volume, h, s);
}

KERNEL void simplex_hoop_stiffness(const PetscBool symmetric, const SimplexSum *s, PetscReal *restrict K)
{
  for (int I = 0; I < 3; ++I)
    for (int b = 0; b < 2; ++b) {
      PetscReal *first = K + (2 * I * 2 + b) * 4, *other = K + ((2 * I + b) * 2) * 4;
      for (int l = 0; l < 2; ++l) {
        row_add(3, s->across[4 * simplex_row(b, l) + I], s->g + 4 * l, first);
        if (b == 0 || !symmetric) row_add(3, s->g[4 * l + I], s->along + 4 * simplex_row(b, l), other);
      }
      if (b == 0) row_add(3, 1, s->ring + 4 * I, first);
    }
}

/* After the last point: internal forces, dim rows, and unless no moduli were summed the cell
 * matrix. */
KERNEL void simplex_end(const int dim, const int nn, const PetscBool hoop, const PetscBool symmetric, PetscBool tangent,
                        const SimplexSum *s, PetscReal *restrict f, PetscReal *restrict K)
{
  PointRun all = {.n = 1, .tau = {s->tau}, .c = {s->c}, .volume = {1}};
  add_internal_force(dim, nn, PETSC_FALSE, s->g, s->tau, 1, f);
  if (hoop) row_add(nn, 1, s->force, f);
  if (!tangent) return;
  for (int i = 0; i < dim * row_width(nn); ++i) all.g[0][i] = s->g[i];
  add_stiffness(dim, nn, PETSC_FALSE, symmetric, &all, K);
  if (hoop) simplex_hoop_stiffness(symmetric, s, K);
}
