/* Displacement formulation in finite strains, updated Lagrangian (thesis eq. 4.31).
 *
 * Points run in batches of one material: first the increments of the deformation gradient of the
 * whole batch, then one call of the law, then forces and stiffness. What a group (a cell)
 * gathers is scattered once. */
#include "formulation/kernels/cells.h"
#include "formulation/displacement_cloud.h"
#include "formulation/kernels/simplex_kernels.h"

/* What one cell gathers: its own kind of sum where gradients are the same everywhere in it. */
typedef struct {
  CellWork cell;
  SimplexSum simplex;
} Work;

KERNEL void work_load(const int dim, const int nn, const WeakFormInput *in, PetscInt group, Work *w)
{
  cell_load(dim, nn, in, group, &w->cell);
  const PetscReal *dN = in->support->dN + in->support->value_start[group] * dim;
  if (is_simplex(dim, nn)) simplex_begin(dim, nn, dN, w->cell.du, &w->simplex);
}

KERNEL void work_store(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in, PetscInt group,
                       PetscInt slot, Work *work, WeakFormOutput *out)
{
  const PetscBool tangent = wants_tangent(out);
  CellWork *w = &work->cell;
  if (is_simplex(dim, nn) && in->symmetric) simplex_end(dim, nn, hoop, PETSC_TRUE, tangent, &work->simplex, w->f, w->K);
  else if (is_simplex(dim, nn)) simplex_end(dim, nn, hoop, PETSC_FALSE, tangent, &work->simplex, w->f, w->K);
  cell_store(dim, nn, in, group, slot, w, out);
}

KERNEL LawStatus batch_update(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in,
                              PetscBool tangent, Batch *b)
{
  batch_increments(dim, nn, hoop, PETSC_FALSE, in, b);
  return batch_law(in, tangent, b);
}

/* Points first .. first + n - 1 of the batch, all of one triangle or tetrahedron. */
KERNEL void add_to_simplex(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in,
                           PetscBool tangent, const Batch *b, PetscInt first, PetscInt n, PetscInt group, Work *w)
{
  const PetscReal lumping = in->lumping ? in->lumping[group] : 0;
  for (PetscInt k = first; k < first + n; ++k) {
    const PetscInt p = b->first + k;
    const PetscReal *tau = b->s.tau + 6 * k, *c = b->s.c + 36 * k, volume = in->points->real[POINT_VOLUME][p];
    PetscReal N[CELL_MAX_NODES], h[CELL_MAX_NODES];
    row_load(nn, 1, support_values(nn, in, group, p), N);
    if (hoop) row_scale(nn, 1 / (b->dF[9 * k + 8] * *point_real(in->points, POINT_X, p)), N, h);
    simplex_add(dim, hoop, tau, tangent ? c : NULL, volume, h, &w->simplex);
    add_mass(nn, N, in->points->real[POINT_MASS][p], lumping, w->cell.M);
  }
}

/* The same of another cell, at most RUN_POINTS. */
KERNEL void add_points(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in, PetscBool tangent,
                       const Batch *b, PetscInt first, PetscInt n, PetscInt group, CellWork *w)
{
  const Points *points = in->points;
  const PetscReal lumping = in->lumping ? in->lumping[group] : 0;
  PetscReal N[CELL_MAX_NODES];
  PointRun run;

  run.n = (int)n;
  for (int i = 0; i < n; ++i) {
    const PetscInt k = first + i, p = b->first + k;
    const PetscReal volume = points->real[POINT_VOLUME][p], mass = points->real[POINT_MASS][p];
    const PetscReal radius = hoop ? *point_real(points, POINT_X, p) : 0;
    const PetscReal *values = support_values(nn, in, group, p), *dN = in->support->dN + (values - in->support->N) * dim;
    row_load(nn, 1, values, N);
    current_gradients(dim, nn, hoop, dN, N, radius, b->dF + 9 * k, run.g[i]);
    add_internal_force(dim, nn, hoop, run.g[i], b->s.tau + 6 * k, volume, w->f);
    add_mass(nn, N, mass, lumping, w->M);
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
  Work w;
  Batch b;

  work_load(dim, nn, in, group, &w);
  batch_begin(cells_of, support, PETSC_FALSE, &b);
  while (batch_next(in, &b)) {
    if (!batch_is_good(&b, batch_update(dim, nn, hoop, in, tangent, &b), out)) return;
    for (PetscInt k = 0, run; k < b.n; k += run) {
      while (b.first + k >= support->point_start[group + 1]) {
        work_store(dim, nn, hoop, in, group++, slot, &w, out);
        slot += nn * nn;
        work_load(dim, nn, in, group, &w);
        if (tangent) cell_prefetch(dim, nn, out->slot + slot, out);
      }
      run = PetscMin(PetscMin(b.n - k, RUN_POINTS), support->point_start[group + 1] - (b.first + k));
      if (is_simplex(dim, nn)) add_to_simplex(dim, nn, hoop, in, tangent, &b, k, run, group, &w);
      else add_points(dim, nn, hoop, in, tangent, &b, k, run, group, &w.cell);
    }
  }
  work_store(dim, nn, hoop, in, group, slot, &w, out);
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
