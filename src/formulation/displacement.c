/* Displacement formulation in finite strains, updated Lagrangian (thesis eq. 4.31).
 *
 * Points run in batches of one material: first the increments of the deformation gradient of the whole batch, then one
 * call of the law, then forces and stiffness. What a group (a cell) gathers is scattered once. */
#include "formulation/sizes.h"
#include "formulation/displacement_cloud.h"
#include "formulation/displacement_kernels.h"
#include "formulation/displacement_points.h"

/* What one cell gathers before it is scattered. */
typedef struct {
  PetscReal du[3 * CELL_MAX_NODES];                 /* nn x dim */
  PetscReal a[3 * CELL_MAX_NODES];                  /* dim rows, effective acceleration */
  PetscReal f[3 * CELL_MAX_NODES];                  /* dim rows */
  PetscReal M[CELL_MAX_NODES * CELL_MAX_NODES];     /* nn rows */
  PetscReal K[9 * CELL_MAX_NODES * CELL_MAX_NODES]; /* nn x dim x dim rows */
} CellWork;

KERNEL void cell_load(const int dim, const int nn, const WeakFormInput *in, PetscInt group, CellWork *w)
{
  const PetscInt *node = in->support->node + group * nn;
  const int width = row_width(nn);
  for (int I = 0; I < nn; ++I)
    for (int d = 0; d < dim; ++d) {
      const PetscInt k = node[I] * dim + d;
      w->du[I * dim + d] = in->du[k];
      w->a[d * width + I] = in->inertia * in->du[k] + in->history[k];
    }
  for (int i = 0; i < dim * width; ++i) w->f[i] = 0;
  for (int i = 0; i < nn * width; ++i) w->M[i] = 0;
  for (int i = 0; i < dim * dim * nn * width; ++i) w->K[i] = 0;
}

/* Ties the nodes of a hardly filled cell: s (du_I - mean), no force on a translation. */
KERNEL void cell_soften(const int dim, const int nn, PetscReal s, PetscBool tangent, CellWork *w)
{
  for (int d = 0; d < dim; ++d) {
    PetscReal mean = 0;
    for (int I = 0; I < nn; ++I) mean += w->du[I * dim + d] / nn;
    for (int I = 0; I < nn; ++I) w->f[d * row_width(nn) + I] += s * (w->du[I * dim + d] - mean);
  }
  if (!tangent) return;
  for (int I = 0; I < nn; ++I)
    for (int d = 0; d < dim; ++d)
      for (int J = 0; J < nn; ++J) w->K[((I * dim + d) * dim + d) * row_width(nn) + J] += s * ((I == J) - 1.0 / nn);
}

/* Rows and columns of prescribed dofs are cut; lifting moves their columns to the right-hand side. */
KERNEL void cell_cut(const int dim, const int nn, const WeakFormInput *in, const PetscInt *node, CellWork *w)
{
  for (int J = 0; J < nn; ++J)
    for (int b = 0; b < dim; ++b) {
      const PetscInt column = node[J] * dim + b;
      if (!in->fixed[column]) continue;
      const PetscReal lift = in->lift ? in->lift[column] : 0;
      for (int I = 0; I < nn; ++I)
        for (int a = 0; a < dim; ++a) {
          PetscReal *k = &w->K[((I * dim + a) * dim + b) * row_width(nn) + J];
          if (!in->fixed[node[I] * dim + a]) w->f[a * row_width(nn) + I] += *k * lift;
          *k = 0;
          w->K[((J * dim + b) * dim + a) * row_width(nn) + I] = 0;
        }
    }
}

KERNEL PetscBool wants_tangent(const WeakFormOutput *out) { return out->values || out->singles; }

KERNEL void cell_prefetch(const int dim, const int nn, PetscInt group, const WeakFormOutput *out)
{
  const PetscInt *slot = out->slot + group * nn * nn;
  if (out->singles) prefetch_blocks(dim, nn, slot, out->singles, sizeof(float));
  else prefetch_blocks(dim, nn, slot, out->values, sizeof(PetscReal));
}

KERNEL void cell_store(const int dim, const int nn, const WeakFormInput *in, PetscInt group, CellWork *w,
                       WeakFormOutput *out)
{
  const PetscInt *node = in->support->node + group * nn;
  if (in->symmetric && wants_tangent(out)) mirror_stiffness(dim, nn, w->K);
  if (in->soft && in->soft[group] > 0) cell_soften(dim, nn, in->soft[group], wants_tangent(out), w);
  if (in->tie && in->tie[group] > 0) add_tie(dim, nn, in->tie[group], w->a, w->f, w->M);
  if (wants_tangent(out)) {
    const PetscInt *slot = out->slot + group * nn * nn;
    int cut = 0;
    for (int I = 0; I < nn; ++I)
      for (int d = 0; d < dim; ++d) {
        cut |= in->fixed[node[I] * dim + d];
        for (int J = 0; J < nn; ++J)
          w->K[((I * dim + d) * dim + d) * row_width(nn) + J] += in->inertia * w->M[I * row_width(nn) + J];
      }
    if (cut) cell_cut(dim, nn, in, node, w);
    if (out->singles) scatter_blocks(dim, nn, PETSC_TRUE, slot, w->K, out->singles);
    else scatter_blocks(dim, nn, PETSC_FALSE, slot, w->K, out->values);
  }
  for (int I = 0; I < nn; ++I)
    for (int d = 0; d < dim; ++d) out->force[node[I] * dim + d] += w->f[d * row_width(nn) + I];
}

KERNEL LawStatus batch_update(const int dim, const int nn, const WeakFormInput *in, PetscBool tangent, Batch *b)
{
  const Support *support = in->support;
  PetscReal du[3 * CELL_MAX_NODES];
  PetscInt group = -1, next = b->group;

  for (PetscInt k = 0; k < b->n; ++k) {
    const PetscInt p = b->first + k;
    while (group < 0 || p >= support->point_start[group + 1]) {
      group = next++;
      for (int I = 0; I < nn; ++I)
        for (int d = 0; d < dim; ++d) du[I * dim + d] = in->du[support->node[group * nn + I] * dim + d];
    }
    increment_rows(dim, nn, support->dN + p * nn * dim, du, b->dF + 9 * k);
  }
  return batch_law(in, tangent, b);
}

/* Points first .. first + n - 1 of the batch, all of one cell, at most RUN_POINTS. */
KERNEL void add_points(const int dim, const int nn, const WeakFormInput *in, PetscBool tangent, const Batch *b,
                       PetscInt first, PetscInt n, PetscReal lumping, CellWork *w)
{
  const Points *points = in->points;
  const Support *support = in->support;
  PetscReal N[CELL_MAX_NODES];
  PointRun run;

  run.n = (int)n;
  for (int i = 0; i < n; ++i) {
    const PetscInt k = first + i, p = b->first + k;
    const PetscReal volume = points->real[POINT_VOLUME][p], mass = points->real[POINT_MASS][p];
    row_load(nn, 1, support->N + p * nn, N);
    current_gradients(dim, nn, support->dN + p * nn * dim, b->dF + 9 * k, run.g[i]);
    add_internal_force(dim, nn, run.g[i], b->tau + 6 * k, volume, w->f);
    add_inertia_force(dim, nn, N, w->a, mass, lumping, w->f);
    if (tangent && in->inertia > 0) add_mass(nn, N, mass, lumping, w->M);
    run.tau[i] = b->tau + 6 * k;
    run.c[i] = b->c + 36 * k;
    run.volume[i] = volume;
  }
  if (tangent && in->symmetric) add_stiffness(dim, nn, PETSC_TRUE, &run, w->K);
  else if (tangent) add_stiffness(dim, nn, PETSC_FALSE, &run, w->K);
}

KERNEL void assemble_points(const int dim, const int nn, const WeakFormInput *in, WeakFormOutput *out)
{
  const Support *support = in->support;
  const PetscBool tangent = wants_tangent(out);
  CellWork w;
  Batch b;
  const PetscInt n = points_in_groups(support);
  PetscInt group = 0;

  cell_load(dim, nn, in, group, &w);
  for (PetscInt first = 0; first < n; first += b.n) {
    b.first = first;
    b.group = group;
    while (first >= support->point_start[b.group + 1]) ++b.group;
    b.n = batch_length(in->points, first, n);
    const LawStatus status = batch_update(dim, nn, in, tangent, &b);
    if (status > out->status) {
      out->status = status;
      out->bad_point = first;
    }
    if (out->status != LAW_OK) return; /* the step is cut, nothing here counts */
    for (PetscInt k = 0, run; k < b.n; k += run) {
      while (first + k >= support->point_start[group + 1]) {
        cell_store(dim, nn, in, group++, &w, out);
        cell_load(dim, nn, in, group, &w);
        if (tangent) cell_prefetch(dim, nn, group, out);
      }
      run = PetscMin(PetscMin(b.n - k, RUN_POINTS), support->point_start[group + 1] - (first + k));
      add_points(dim, nn, in, tangent, &b, k, run, in->lumping ? in->lumping[group] : 0, &w);
    }
  }
  cell_store(dim, nn, in, group, &w, out);
}

KERNEL LawStatus commit_points(const int dim, const int nn, const WeakFormInput *in, Points *points)
{
  const PetscInt n = points_in_groups(in->support);
  Batch b;
  for (PetscInt first = 0, group = 0; first < n; first += b.n) {
    while (first >= in->support->point_start[group + 1]) ++group;
    b.first = first;
    b.group = group;
    b.n = batch_length(points, first, n);
    const LawStatus status = batch_update(dim, nn, in, PETSC_FALSE, &b);
    if (status != LAW_OK) return status;
    batch_commit(in, &b, points);
  }
  return LAW_OK;
}

SIZED_KERNELS(2, 3)
SIZED_KERNELS(2, 4)
SIZED_KERNELS(3, 4)
SIZED_KERNELS(3, 8)

static const SizedKernels kernels[] = {
  SIZED_ROW(2, 3),
  SIZED_ROW(2, 4),
  SIZED_ROW(3, 4),
  SIZED_ROW(3, 8),
  {2, 0, displacement_assemble_cloud, displacement_commit_cloud}, /* as many nodes as a point's cloud has */
  {3, 0, displacement_assemble_cloud, displacement_commit_cloud},
  {0},
};

static PetscErrorCode DisplacementAssemble(const WeakFormInput *in, WeakFormOutput *out)
{
  return SizedAssemble(kernels, in, out);
}

static PetscErrorCode DisplacementCommit(const WeakFormInput *in, Points *points, LawStatus *status)
{
  return SizedCommit(kernels, in, points, status);
}

const Formulation formulation_displacement = {
  .name = "displacement",
  .help = "displacements are the only unknowns",
  .singles = PETSC_TRUE,
  .assemble = DisplacementAssemble,
  .commit = DisplacementCommit,
};
