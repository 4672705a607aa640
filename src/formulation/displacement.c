/* Displacement formulation in finite strains, updated Lagrangian (thesis eq. 4.31).
 *
 * Points run in batches of one material: first the increments of the deformation gradient of the
 * whole batch, then one call of the law, then forces and stiffness. What a group (a cell)
 * gathers is scattered once. */
#include "formulation/cells.h"
#include "formulation/displacement_cloud.h"

KERNEL PetscBool wants_tangent(const WeakFormOutput *out) { return out->values || out->singles; }

KERNEL void cell_prefetch(const int dim, const int nn, const PetscInt *slot, const WeakFormOutput *out)
{
  if (out->singles) prefetch_blocks(dim, nn, slot, out->singles, sizeof(float));
  else prefetch_blocks(dim, nn, slot, out->values, sizeof(PetscReal));
}

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

KERNEL LawStatus batch_update(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in,
                              PetscBool tangent, Batch *b)
{
  batch_increments(dim, nn, hoop, PETSC_FALSE, in, b);
  return batch_law(in, tangent, b);
}

/* Points first .. first + n - 1 of the batch, all of one cell, at most RUN_POINTS. */
KERNEL void add_points(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in, PetscBool tangent,
                       const Batch *b, PetscInt first, PetscInt n, PetscInt group, CellWork *w)
{
  const Points *points = in->points;
  const Support *support = in->support;
  const PetscReal lumping = in->lumping ? in->lumping[group] : 0;
  const PetscInt offset = support->value_start[group] - support->point_start[group] * nn;
  PetscReal N[CELL_MAX_NODES];
  PointRun run;

  run.n = (int)n;
  for (int i = 0; i < n; ++i) {
    const PetscInt k = first + i, p = b->first + k;
    const PetscReal volume = points->real[POINT_VOLUME][p], mass = points->real[POINT_MASS][p];
    const PetscReal radius = hoop ? *point_real(points, POINT_X, p) : 0;
    row_load(nn, 1, support->N + offset + p * nn, N);
    current_gradients(dim, nn, hoop, support->dN + (offset + p * nn) * dim, N, radius, b->dF + 9 * k, run.g[i]);
    add_internal_force(dim, nn, hoop, run.g[i], b->s.tau + 6 * k, volume, w->f);
    add_inertia_force(dim, nn, N, w->a, mass, lumping, w->f);
    if (tangent && in->inertia > 0) add_mass(nn, N, mass, lumping, w->M);
    run.tau[i] = b->s.tau + 6 * k;
    run.c[i] = b->s.c + 36 * k;
    run.volume[i] = volume;
  }
  if (tangent && in->symmetric) add_stiffness(dim, nn, hoop, PETSC_TRUE, &run, w->K);
  else if (tangent) add_stiffness(dim, nn, hoop, PETSC_FALSE, &run, w->K);
}

KERNEL void assemble_points(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in,
                            const SupportRun *cells_of, PetscInt slot, WeakFormOutput *out)
{
  const Support *support = in->support;
  const PetscBool tangent = wants_tangent(out);
  PetscInt group = cells_of->first;
  CellWork w;
  Batch b;

  cell_load(dim, nn, in, group, &w);
  batch_begin(cells_of, support, &b);
  while (batch_next(in, &b)) {
    if (!batch_is_good(&b, batch_update(dim, nn, hoop, in, tangent, &b), out)) return;
    for (PetscInt k = 0, run; k < b.n; k += run) {
      while (b.first + k >= support->point_start[group + 1]) {
        cell_store(dim, nn, in, group++, slot, &w, out);
        slot += nn * nn;
        cell_load(dim, nn, in, group, &w);
        if (tangent) cell_prefetch(dim, nn, out->slot + slot, out);
      }
      run = PetscMin(PetscMin(b.n - k, RUN_POINTS), support->point_start[group + 1] - (b.first + k));
      add_points(dim, nn, hoop, in, tangent, &b, k, run, group, &w);
    }
  }
  cell_store(dim, nn, in, group, slot, &w, out);
}

CELL_SIZES(SIZED_KERNELS)

static const SizedKernels kernels[] = {CELL_SIZES(SIZED_ROW){0}};

static const SizedKernels *kernels_of(const WeakFormInput *in)
{
  return in->support->n_runs ? kernels : displacement_cloud_kernels;
}

static PetscErrorCode DisplacementAssemble(const WeakFormInput *in, WeakFormOutput *out)
{
  return SizedAssemble(kernels_of(in), in, out);
}

static PetscErrorCode DisplacementCommit(const WeakFormInput *in, Points *points, LawStatus *status)
{
  return SizedCommit(kernels_of(in), in, points, status);
}

const Formulation formulation_displacement = {
  .name = "displacement",
  .help = "displacements are the only unknowns",
  .singles = PETSC_TRUE,
  .assemble = DisplacementAssemble,
  .commit = DisplacementCommit,
};
