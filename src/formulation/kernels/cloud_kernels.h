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
  const PetscReal *N, *dN;
  PetscReal radius, inverse[9];           /* of rings, at the start of the step; dF^-1 */
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
  Row4 H[3] = {{0}};
  PetscReal outward = 0;
  for (PetscInt I = 0; I < nn; ++I) {
    const Row4 du = node_row(dim, in->du + node[I] * dim);
    if (hoop) outward += N[I] * du[0];
    for (int j = 0; j < dim; ++j) H[j] += dN[I * dim + j] * du;
  }
  for (int i = 0; i < 9; ++i) dF[i] = i % 4 == 0;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) dF[3 * i + j] += H[j][i];
  if (hoop) dF[8] += outward / *point_real(in->points, POINT_X, p);
}

KERNEL void cloud_gradients(const int dim, const PetscBool hoop, CloudWork *w)
{
  const int rows = gradient_rows(dim, hoop);
  for (PetscInt I = 0; I < w->nn; ++I) {
    for (int j = 0; j < dim; ++j) {
      PetscReal g = 0;
      for (int i = 0; i < dim; ++i) g += w->inverse[3 * i + j] * w->dN[I * dim + i];
      w->g[I * rows + j] = g;
    }
    if (hoop) w->g[I * rows + dim] = w->inverse[8] / w->radius * w->N[I];
  }
}

/* V0 tau dF^-T, column by column: what dN along each axis makes of it is the force of a node. */
KERNEL void cloud_stress(const int dim, const PetscReal *tau, PetscReal volume, const CloudWork *w, Row4 column[3])
{
  for (int i = 0; i < dim; ++i) {
    column[i] = (Row4){0, 0, 0, 0};
    for (int j = 0; j < dim; ++j) {
      const Row4 stress = {tau[voigt_of[0][j]], tau[voigt_of[1][j]], dim > 2 ? tau[voigt_of[2][j]] : 0, 0};
      column[i] += volume * w->inverse[3 * i + j] * stress;
    }
  }
}

/* f_I += V0 tau g_I + m N_I ((1 - lumping) a_h + lumping a_I) */
KERNEL void cloud_force(const int dim, const PetscBool hoop, const WeakFormInput *in, const PetscReal *tau,
                        PetscReal volume, const CloudWork *w, PetscReal *force)
{
  const PetscReal outward = hoop ? volume * tau[2] * w->inverse[8] / w->radius : 0;
  Row4 mean = {0, 0, 0, 0}, column[3];
  cloud_stress(dim, tau, volume, w, column);
  for (PetscInt I = 0; I < w->nn; ++I) {
    const PetscInt k = w->node[I] * dim;
    mean += w->N[I] * (in->inertia * node_row(dim, in->du + k) + node_row(dim, in->history + k));
  }
  mean *= w->mass * (1 - w->lumping);
  if (hoop) mean[0] += outward;
  for (PetscInt I = 0; I < w->nn; ++I) {
    const PetscInt k = w->node[I] * dim;
    Row4 f = w->N[I] * mean;
    for (int i = 0; i < dim; ++i) f += w->dN[I * dim + i] * column[i];
    if (w->lumping > 0) {
      const Row4 a = in->inertia * node_row(dim, in->du + k) + node_row(dim, in->history + k);
      f += w->mass * w->lumping * w->N[I] * a;
    }
    node_add(dim, f, force + k);
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
KERNEL void cloud_load(const int dim, const PetscBool hoop, const WeakFormInput *in, PetscInt p, const PetscReal *dF,
                       CloudWork *w)
{
  const Support *s = in->support;
  w->nn = s->node_start[p + 1] - s->node_start[p];
  w->node = s->node + s->node_start[p];
  w->N = s->N + s->value_start[p];
  w->dN = s->dN + s->value_start[p] * dim;
  w->radius = hoop ? *point_real(in->points, POINT_X, p) : 0;
  tensor_inverse(dF, w->inverse);
  w->mass = in->points->real[POINT_MASS][p];
  w->inertia = w->mass * in->inertia;
  w->lumping = in->lumping ? in->lumping[p] : 0;
  w->soft = in->soft ? in->soft[p] : 0;
}

#define SAME 1e-12 /* share of a motion's square that is none */

/* Where nodes are, from the first of them on, in rows that end with zeros. */
KERNEL void hold_places(const int dim, const CloudWork *w, const PetscReal *x, CloudRow *row)
{
  const PetscReal *origin = x + w->node[0] * dim;
  for (int d = 0; d < dim; ++d) *(Row4 *)(row[d] + w->nn) = (Row4){0, 0, 0, 0};
  for (PetscInt I = 0; I < w->nn; ++I)
    for (int d = 0; d < dim; ++d) row[d][I] = x[w->node[I] * dim + d] - origin[d];
}

/* Products of a row with n parts, by registers and all at once, so that no sum waits for another. */
KERNEL void hold_products(const int n, PetscInt nn, const PetscReal *row, const CloudRow *part, PetscReal *product)
{
  Row4 sum[4] = {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}};
  for (PetscInt I = 0; I < nn; I += 4)
    for (int k = 0; k < n; ++k) sum[k] += *(const Row4 *)(row + I) * *(const Row4 *)(part[k] + I);
  for (int k = 0; k < n; ++k) product[k] = row_sum(sum[k]);
}

/* rest = scale (row - what n parts have of it) */
KERNEL void hold_without(const int n, PetscInt nn, PetscReal scale, const PetscReal *product, const CloudRow *part,
                         const PetscReal *row, PetscReal *rest)
{
  for (PetscInt I = 0; I < nn; I += 4) {
    Row4 left = *(const Row4 *)(row + I);
    for (int k = 0; k < n; ++k) left -= product[k] * *(const Row4 *)(part[k] + I);
    *(Row4 *)(rest + I) = scale * left;
  }
}

/* Motions that nothing holds, as unit vectors over the nodes, across each other: constant, and on a
 * lattice linear along each axis. Returns how many; the other rows are zero. */
KERNEL int free_parts(const int axes, const int dim, const CloudWork *w, const PetscReal *x, CloudRow *part)
{
  const PetscReal one = 1 / PetscSqrtReal((PetscReal)w->nn);
  CloudRow place[3];
  int n = 1;
  for (PetscInt I = 0; I <= w->nn; I += 4)
    for (int k = 0; k <= axes; ++k) *(Row4 *)(part[k] + I) = (Row4){0, 0, 0, 0};
  for (PetscInt I = 0; I < w->nn; ++I) part[0][I] = one;
  if (axes) hold_places(dim, w, x, place);
  for (int k = 0; k < axes; ++k) {
    PetscReal product[4] = {0}, square;
    hold_products(axes, w->nn, place[k], part, product); /* rows from n on are zero */
    hold_products(1, w->nn, place[k], place + k, &square);
    square -= PetscSqr(product[0]);
    PetscReal left = square;
    for (int other = 1; other < n; ++other) left -= PetscSqr(product[other]);
    if (left <= SAME * square) continue;
    hold_without(axes, w->nn, 1 / PetscSqrtReal(left), product, part, place[k], part[n++]);
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

/* The free parts of a point's nodes, in w, and what these do in each: sum_I b_kI du_I. */
KERNEL void held_parts(const int axes, const int dim, const WeakFormInput *in, CloudWork *w, Row4 *done)
{
  w->n_free = free_parts(axes, dim, w, in->x, w->free);
  for (int k = 0; k <= axes; ++k) done[k] = (Row4){0, 0, 0, 0};
  for (PetscInt I = 0; I < w->nn; ++I) {
    const Row4 du = node_row(dim, in->du + w->node[I] * dim);
    for (int k = 0; k <= axes; ++k) done[k] += w->free[k][I] * du;
  }
}

/* What node I of a point does beside the free parts: du_I - sum_k b_kI b_k . du. */
KERNEL Row4 held_rest(const int axes, const int dim, const WeakFormInput *in, const CloudWork *w, const Row4 *done,
                      PetscInt I)
{
  Row4 rest = node_row(dim, in->du + w->node[I] * dim);
  for (int k = 0; k <= axes; ++k) rest -= w->free[k][I] * done[k];
  return rest;
}

KERNEL void hold_beside(const int axes, const int dim, const WeakFormInput *in, CloudWork *w, PetscReal *force)
{
  Row4 done[4];
  held_parts(axes, dim, in, w, done);
  for (PetscInt I = 0; I < w->nn; ++I)
    node_add(dim, w->soft * held_rest(axes, dim, in, w, done, I), force + w->node[I] * dim);
}

/* Holds a point's nodes to the free parts of their motion: f_I += soft (du_I - sum_k b_kI b_k . du). What
 * that adds to the tangent stands on the diagonals of the blocks: soft (delta_IJ - sum_k b_kI b_kJ). */
KERNEL void cloud_hold(const int dim, const WeakFormInput *in, CloudWork *w, PetscReal *force)
{
  if (in->lattice) hold_beside(dim, dim, in, w, force);
  else hold_beside(0, dim, in, w, force);
}

/* Twice the work of that over `soft`. */
KERNEL PetscReal held_square(const int axes, const int dim, const WeakFormInput *in, CloudWork *w)
{
  Row4 done[4], sum = {0, 0, 0, 0};
  held_parts(axes, dim, in, w, done);
  for (PetscInt I = 0; I < w->nn; ++I) {
    const Row4 rest = held_rest(axes, dim, in, w, done, I);
    sum += rest * rest;
  }
  return row_sum(sum);
}
