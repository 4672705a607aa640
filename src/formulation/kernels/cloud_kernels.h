/* Point kernels of points with a cloud of nodes each, as many as the basis chose: what the
 * displacement and the mixed formulation share.
 *
 * Nothing is gathered per group, so a point's blocks go straight into the matrix values. With
 * T_j[J] = sum_l modulus_jl g_l[J], a block is sum_j g_j[I] T_j[J] plus the mass. */
#pragma once
#include "formulation/kernels/displacement_kernels.h"

/* A number for each node, with room for the rest of a register behind the last. */
typedef PetscReal CloudRow[CLOUD_MAX_NODES + 4];

/* What one point needs of its cloud. */
typedef struct {
  PetscInt nn;
  const PetscInt *node;
  const PetscReal *N;
  PetscReal mass, inertia, lumping, soft; /* inertia: mass times c0 */
  /* gradients at x_(n+1), as many rows as they have beside each other */
  PetscReal g[3 * CLOUD_MAX_NODES];
  PetscReal modulus[3][3][9]; /* of two rows: V0 (c_ajbl + delta_ab tau_jl) */
  int n_free;                 /* of points that are held (soft): motions that nothing holds, */
  CloudRow free[4];           /* as unit vectors over the nodes */
} CloudWork;

KERNEL void cloud_increment(const int dim, const PetscBool hoop, const WeakFormInput *in, PetscInt p, PetscReal dF[9])
{
  const Support *s = in->support;
  const PetscInt first = s->node_start[p], nn = s->node_start[p + 1] - first, *node = s->node + first;
  const PetscReal *dN = s->dN + s->value_start[p] * dim;
  const PetscReal *N = s->N + s->value_start[p];
  PetscReal H[9] = {0}, outward = 0;
  for (PetscInt I = 0; I < nn; ++I) {
    const PetscReal *du = in->du + node[I] * dim;
    if (hoop) outward += N[I] * du[0];
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) H[i * dim + j] += du[i] * dN[I * dim + j];
  }
  for (int i = 0; i < 9; ++i) dF[i] = i % 4 == 0;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) dF[3 * i + j] += H[i * dim + j];
  if (hoop) dF[8] += outward / *point_real(in->points, POINT_X, p);
}

KERNEL void cloud_gradients(const int dim, const PetscBool hoop, const PetscReal *restrict dN, PetscReal radius,
                            const PetscReal *dF, CloudWork *w)
{
  const int rows = gradient_rows(dim, hoop);
  PetscReal inverse[9];
  tensor_inverse(dF, inverse);
  for (PetscInt I = 0; I < w->nn; ++I) {
    for (int j = 0; j < dim; ++j) {
      PetscReal g = 0;
      for (int i = 0; i < dim; ++i) g += inverse[3 * i + j] * dN[I * dim + i];
      w->g[I * rows + j] = g;
    }
    if (hoop) w->g[I * rows + dim] = inverse[8] / radius * w->N[I];
  }
}

/* f_I += V0 tau g_I + m N_I ((1 - lumping) a_h + lumping a_I) */
KERNEL void cloud_force(const int dim, const PetscBool hoop, const WeakFormInput *in, const PetscReal *tau,
                        PetscReal volume, const CloudWork *w, PetscReal *force)
{
  const int rows = gradient_rows(dim, hoop);
  PetscReal mean_a[3] = {0, 0, 0};
  for (PetscInt I = 0; I < w->nn; ++I)
    for (int d = 0; d < dim; ++d) {
      const PetscInt k = w->node[I] * dim + d;
      mean_a[d] += w->N[I] * (in->inertia * in->du[k] + in->history[k]);
    }
  for (PetscInt I = 0; I < w->nn; ++I)
    for (int d = 0; d < dim; ++d) {
      const PetscInt k = w->node[I] * dim + d;
      const PetscReal a = in->inertia * in->du[k] + in->history[k];
      PetscReal f = w->mass * w->N[I] * ((1 - w->lumping) * mean_a[d] + w->lumping * a);
      for (int j = 0; j < rows; ++j)
        if (is_felt(dim, d, j)) f += volume * tau[strain_of(dim, d, j)] * w->g[I * rows + j];
      force[k] += f;
    }
}

/* V0 (c_ajbl + delta_ab tau_jl) of one j: a block of dim x dim for each row l of the gradients. */
KERNEL void cloud_moduli(const int dim, const int rows, const int j, const PetscReal *tau, const PetscReal *c,
                         PetscReal volume, PetscReal modulus[3][9])
{
  for (int l = 0; l < rows; ++l)
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b)
        modulus[l][a * dim + b] =
          is_felt(dim, a, j) && is_felt(dim, b, l) ? volume * modulus_of(dim, a, j, b, l, tau, c) : 0;
}

/* What is known of point p before its stress. */
KERNEL void cloud_load(const WeakFormInput *in, PetscInt p, CloudWork *w)
{
  const Support *s = in->support;
  w->nn = s->node_start[p + 1] - s->node_start[p];
  w->node = s->node + s->node_start[p];
  w->N = s->N + s->value_start[p];
  w->mass = in->points->real[POINT_MASS][p];
  w->inertia = w->mass * in->inertia;
  w->lumping = in->lumping ? in->lumping[p] : 0;
  w->soft = in->soft ? in->soft[p] : 0;
}

#define SAME 1e-12 /* share of a motion's square that is none */

/* One component of what nodes have, less `from`, in a row that ends with zeros. */
KERNEL void hold_gather(const int dim, int d, const CloudWork *w, const PetscReal *x, PetscReal from, PetscReal *row)
{
  *(Row4 *)(row + w->nn) = (Row4){0, 0, 0, 0};
  for (PetscInt I = 0; I < w->nn; ++I) row[I] = x[w->node[I] * dim + d] - from;
}

/* Products of a row with n parts, by registers and all at once, so that no sum waits for another. */
KERNEL void hold_products(const int n, PetscInt nn, const PetscReal *row, const CloudRow *part, PetscReal *product)
{
  Row4 sum[4] = {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}};
  for (PetscInt I = 0; I < nn; I += 4)
    for (int k = 0; k < n; ++k) sum[k] += *(const Row4 *)(row + I) * *(const Row4 *)(part[k] + I);
  for (int k = 0; k < n; ++k) product[k] = (sum[k][0] + sum[k][1]) + (sum[k][2] + sum[k][3]);
}

/* row = scale (row - what n parts have of it) */
KERNEL void hold_without(const int n, PetscInt nn, PetscReal scale, const PetscReal *product, const CloudRow *part,
                         PetscReal *row)
{
  for (PetscInt I = 0; I < nn; I += 4) {
    Row4 left = *(const Row4 *)(row + I);
    for (int k = 0; k < n; ++k) left -= product[k] * *(const Row4 *)(part[k] + I);
    *(Row4 *)(row + I) = scale * left;
  }
}

/* Motions that nothing holds, as unit vectors over the nodes, across each other: constant, and on a
 * lattice linear along each axis. Returns how many; the other rows are zero. */
KERNEL int free_parts(const int axes, const int dim, const CloudWork *w, const PetscReal *x, CloudRow *part)
{
  const PetscReal one = 1 / PetscSqrtReal((PetscReal)w->nn);
  int n = 1;
  for (PetscInt I = 0; I <= w->nn; I += 4)
    for (int k = 0; k <= axes; ++k) *(Row4 *)(part[k] + I) = (Row4){0, 0, 0, 0};
  for (PetscInt I = 0; I < w->nn; ++I) part[0][I] = one;
  for (int k = 0; k < axes; ++k) {
    PetscReal *row = part[n], product[4];
    hold_gather(dim, k, w, x, x[w->node[0] * dim + k], row);
    hold_products(axes + 1, w->nn, row, part, product); /* that with itself, too */
    const PetscReal square = product[n] - PetscSqr(product[0]);
    PetscReal left = square;
    for (int other = 1; other < n; ++other) left -= PetscSqr(product[other]);
    const PetscBool is_new = left > SAME * square;
    for (int other = n; other <= axes; ++other) product[other] = 0;
    hold_without(axes + 1, w->nn, is_new ? 1 / PetscSqrtReal(left) : 0, product, part, row);
    n += is_new;
  }
  return n;
}

/* What is left in I of the motion of J without these n parts. */
static inline PetscReal held_part(int n, const CloudRow *part, PetscInt I, PetscInt J)
{
  PetscReal s = I == J;
  for (int k = 0; k < n; ++k) s -= part[k][I] * part[k][J];
  return s;
}

KERNEL void held_beside(const int axes, const int dim, const WeakFormInput *in, CloudWork *w, CloudRow *held)
{
  w->n_free = free_parts(axes, dim, w, in->x, w->free);
  for (int d = 0; d < dim; ++d) {
    PetscReal product[4];
    hold_gather(dim, d, w, in->du, 0, held[d]);
    hold_products(axes + 1, w->nn, held[d], w->free, product);
    hold_without(axes + 1, w->nn, 1, product, w->free, held[d]);
  }
}

/* What a point's nodes do beside the free parts of their motion, component by component: du_I - sum_k b_kI b_k . du. */
KERNEL void cloud_held(const int dim, const WeakFormInput *in, CloudWork *w, CloudRow *held)
{
  if (in->lattice) held_beside(dim, dim, in, w, held);
  else held_beside(0, dim, in, w, held);
}

/* Holds a point's nodes to the free parts of their motion: f_I += soft (du_I - sum_k b_kI b_k . du). What
 * that adds to the tangent stands on the diagonals of the blocks: soft (delta_IJ - sum_k b_kI b_kJ). */
KERNEL void cloud_hold(const int dim, const WeakFormInput *in, CloudWork *w, PetscReal *force)
{
  CloudRow held[3];
  cloud_held(dim, in, w, held);
  for (PetscInt I = 0; I < w->nn; ++I)
    for (int d = 0; d < dim; ++d) force[w->node[I] * dim + d] += w->soft * held[d][I];
}
