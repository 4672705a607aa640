/* What the formulations do to one cell after the other: its nodes' motion, what its points add
 * up to, and what holds a hardly filled one. */
#pragma once
#include "formulation/displacement_kernels.h"
#include "formulation/walk.h"

/* What one cell gathers before it is scattered. */
typedef struct {
  PetscReal du[3 * CELL_MAX_NODES];                 /* nn x dim */
  PetscReal a[3 * CELL_MAX_NODES];                  /* dim rows, effective acceleration */
  PetscReal f[3 * CELL_MAX_NODES];                  /* dim rows */
  PetscReal M[CELL_MAX_NODES * CELL_MAX_NODES];     /* nn rows */
  PetscReal K[9 * CELL_MAX_NODES * CELL_MAX_NODES]; /* nn x dim x dim rows */
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
  for (int i = 0; i < nn * width; ++i) w->M[i] = 0;
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
  if (in->tie && in->tie[group] > 0) add_tie(dim, nn, in->tie[group], w->a, w->f, w->M);
  for (int I = 0; tangent && I < nn; ++I)
    for (int d = 0; d < dim; ++d) row_add(nn, in->inertia, w->M + I * width, w->K + ((I * dim + d) * dim + d) * width);
}

KERNEL void cell_give_force(const int dim, const int nn, const PetscInt *node, const CellWork *w, PetscReal *force)
{
  for (int I = 0; I < nn; ++I)
    for (int d = 0; d < dim; ++d) force[node[I] * dim + d] += w->f[d * row_width(nn) + I];
}

/* dF of the points of a batch, and where `pressure` is the unknown pressure there. */
KERNEL void batch_increments(const int dim, const int nn, const PetscBool hoop, const PetscBool pressure,
                             const WeakFormInput *in, Batch *b)
{
  const Support *support = in->support;
  PetscReal du[3 * CELL_MAX_NODES], at_node[CELL_MAX_NODES];
  PetscInt group = -1, next = b->group, offset = 0;

  for (PetscInt k = 0, p = b->first; k < b->n; ++k, ++p) {
    while (group < 0 || p >= support->point_start[group + 1]) {
      group = next++;
      offset = support->value_start[group] - support->point_start[group] * nn;
      cell_motion(dim, nn, in, group, du);
      for (int I = 0; pressure && I < nn; ++I) at_node[I] = in->pressure_scale * in->pressure[cell_nodes(in, group)[I]];
    }
    const PetscReal *N = support->N + offset + p * nn;
    increment_rows(dim, nn, support->dN + (offset + p * nn) * dim, du, b->dF + 9 * k);
    for (int I = 0; hoop && I < nn; ++I) b->dF[9 * k + 8] += N[I] * du[I * dim] / *point_real(in->points, POINT_X, p);
    if (!pressure) continue;
    b->p[k] = 0;
    for (int I = 0; I < nn; ++I) b->p[k] += N[I] * at_node[I];
  }
}
