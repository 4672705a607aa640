/* What the formulations do to one cell after the other: its nodes' motion, what its points add
 * up to, and what holds a hardly filled one. */
#pragma once
#include "formulation/kernels/displacement_kernels.h"
#include "formulation/walk.h"

/* What one cell gathers before it is scattered. */
typedef struct {
  PetscReal du[3 * CELL_MAX_NODES];                   /* nn x dim */
  PetscReal a[3 * CELL_MAX_NODES];                    /* dim rows, effective acceleration */
  PetscReal f[3 * CELL_MAX_NODES];                    /* dim rows */
  PetscReal M[(CELL_MAX_NODES + 1) * CELL_MAX_NODES]; /* nn rows, and one of lumped masses */
  PetscReal K[9 * CELL_MAX_NODES * CELL_MAX_NODES];   /* nn x dim x dim rows */
} CellWork;

KERNEL const PetscInt *cell_nodes(const WeakFormInput *in, PetscInt group)
{
  return in->support->node + in->support->node_start[group];
}

KERNEL void cell_motion(const int dim, const int nn, const WeakFormInput *in, PetscInt group, PetscReal *du)
{
  const PetscInt *node = cell_nodes(in, group);
  for (int I = 0; I < nn; ++I)
    for (int d = 0; d < dim; ++d) du[I * dim + d] = in->du[node[I] * dim + d];
}

KERNEL void cell_load(const int dim, const int nn, const WeakFormInput *in, PetscInt group, CellWork *w)
{
  const PetscInt *node = cell_nodes(in, group);
  const int width = row_width(nn);
  cell_motion(dim, nn, in, group, w->du);
  for (int I = 0; I < nn; ++I)
    for (int d = 0; d < dim; ++d)
      w->a[d * width + I] = in->inertia * w->du[I * dim + d] + in->history[node[I] * dim + d];
  for (int i = 0; i < dim * width; ++i) w->f[i] = 0;
  for (int i = 0; i < (nn + 1) * width; ++i) w->M[i] = 0;
  for (int i = 0; i < dim * dim * nn * width; ++i) w->K[i] = 0;
}

/* Ties the nodes of a hardly filled cell: s (du_I - mean), no force on a translation. */
KERNEL void cell_soften(const int dim, const int nn, PetscReal s, PetscBool tangent, CellWork *w)
{
  const int width = row_width(nn);
  for (int d = 0; d < dim; ++d) {
    PetscReal mean = 0;
    for (int I = 0; I < nn; ++I) mean += w->du[I * dim + d] / nn;
    for (int I = 0; I < nn; ++I) w->f[d * width + I] += s * (w->du[I * dim + d] - mean);
  }
  for (int I = 0; tangent && I < nn; ++I)
    for (int d = 0; d < dim; ++d)
      for (int J = 0; J < nn; ++J) w->K[((I * dim + d) * dim + d) * width + J] += s * ((I == J) - 1.0 / nn);
}

/* What comes after the points: ties and inertia. */
KERNEL void cell_close(const int dim, const int nn, const WeakFormInput *in, PetscInt group, PetscBool tangent,
                       CellWork *w)
{
  const int width = row_width(nn);
  if (in->soft && in->soft[group] > 0) cell_soften(dim, nn, in->soft[group], tangent, w);
  add_lumped_mass(nn, w->M);
  if (in->tie && in->tie[group] > 0) add_tie(nn, in->tie[group], w->M);
  add_inertia_force(dim, nn, w->M, w->a, w->f);
  for (int I = 0; tangent && I < nn; ++I)
    for (int d = 0; d < dim; ++d) row_add(nn, in->inertia, w->M + I * width, w->K + ((I * dim + d) * dim + d) * width);
}

KERNEL void cell_give_force(const int dim, const int nn, const PetscInt *node, const CellWork *w, PetscReal *force)
{
  for (int I = 0; I < nn; ++I)
    for (int d = 0; d < dim; ++d) force[node[I] * dim + d] += w->f[d * row_width(nn) + I];
}

KERNEL void cell_prefetch(const int dim, const int nn, const PetscInt *slot, const WeakFormOutput *out)
{
  if (out->singles) prefetch_blocks(dim, nn, slot, out->singles, sizeof(float));
  else prefetch_blocks(dim, nn, slot, out->values, sizeof(PetscReal));
}

/* All of a cell of displacements alone, when its points are done: a symmetric K only has its blocks
 * a <= b. */
KERNEL void cell_store(const int dim, const int nn, const WeakFormInput *in, PetscInt group, PetscInt slot, CellWork *w,
                       WeakFormOutput *out)
{
  const PetscBool tangent = wants_tangent(out);
  if (in->symmetric && tangent) mirror_stiffness(dim, nn, w->K);
  cell_close(dim, nn, in, group, tangent, w);
  if (out->singles) scatter_blocks(dim, nn, PETSC_TRUE, out->slot + slot, w->K, out->singles);
  else if (tangent) scatter_blocks(dim, nn, PETSC_FALSE, out->slot + slot, w->K, out->values);
  cell_give_force(dim, nn, cell_nodes(in, group), w, out->force);
}

/* N of a point of a cell of nn nodes. */
KERNEL const PetscReal *support_values(const int nn, const WeakFormInput *in, PetscInt group, PetscInt p)
{
  const Support *s = in->support;
  return s->N + s->value_start[group] + (p - s->point_start[group]) * nn;
}

/* sum_I N_I x_I, x every `stride`-th number. */
KERNEL PetscReal node_mean(const int nn, const PetscReal *N, const int stride, const PetscReal *x)
{
  PetscReal sum = 0;
  for (int I = 0; I < nn; ++I) sum += N[I] * x[I * stride];
  return sum;
}

/* One gradient for all points of a triangle or tetrahedron: most of dN is never read, and what is lies too far apart
 * for the processor to foresee. */
#define AHEAD 8

KERNEL void prefetch_gradients(const int dim, const Support *support, PetscInt group)
{
  if (group >= support->n_groups) return;
  const PetscReal *dN = support->dN + support->value_start[group] * dim;
  __builtin_prefetch(dN);
  __builtin_prefetch(dN + dim * (dim + 1) - 1);
}

/* dF of the points of a batch, and where `pressure` is the unknown pressure there. In triangles and
 * tetrahedra it is that of the cell's first point, but for the hoop. */
KERNEL void batch_increments(const int dim, const int nn, const PetscBool hoop, const PetscBool pressure,
                             const WeakFormInput *in, Batch *b)
{
  const Support *support = in->support;
  PetscReal du[3 * CELL_MAX_NODES] = {0}, at_node[CELL_MAX_NODES] = {0}, dF[9] = {0};

  for (PetscInt k = 0, group = b->group; k < b->n; ++group) {
    const PetscInt end = PetscMin(b->n, support->point_start[group + 1] - b->first), first = k;
    const PetscInt offset = support->value_start[group] - support->point_start[group] * nn;
    cell_motion(dim, nn, in, group, du);
    if (nn == dim + 1) prefetch_gradients(dim, support, group + AHEAD);
    for (int I = 0; pressure && I < nn; ++I) at_node[I] = in->pressure_scale * in->pressure[cell_nodes(in, group)[I]];
    for (; k < end; ++k) {
      const PetscInt p = b->first + k;
      const PetscReal *N = support->N + offset + p * nn;
      if (k == first || nn != dim + 1) increment_rows(dim, nn, support->dN + (offset + p * nn) * dim, du, dF);
      for (int i = 0; i < 9; ++i) b->dF[9 * k + i] = dF[i];
      if (hoop) b->dF[9 * k + 8] += node_mean(nn, N, 2, du) / *point_real(in->points, POINT_X, p);
      if (pressure) b->p[k] = node_mean(nn, N, 1, at_node);
    }
  }
}
