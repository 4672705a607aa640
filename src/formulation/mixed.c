/* Mixed formulation: displacements and a pressure at the same nodes, stabilised by polynomial
 * pressure projection (docs/theory.md).
 *
 *   R_I  = sum_p V0 tau grad N_I + inertia          tau with the interpolated pressure
 *   R_pI = sum_p V0 N_I (theta - p / K) - sum_cells (alpha / G) V0 int (N_I - mean)(p + rho b . x - mean)
 *
 * The unknown is p over a scale of Pa/m, and the second equation is multiplied by it: then all
 * unknowns are m and all equations N, and the tangent is symmetric where the law's is. Points
 * run in batches of one material as in displacement.c. */
#include "formulation/kernels/cells.h"
#include "formulation/mixed_cloud.h"
#include "formulation/kernels/mixed_kernels.h"
#include "formulation/sizes.h"

/* What one cell gathers before it is scattered; rows as in mixed_kernels.h. */
typedef struct {
  CellWork u;
  PetscReal p[CELL_MAX_NODES], fp[CELL_MAX_NODES];
  PetscReal Kup[3 * CELL_MAX_NODES * CELL_MAX_NODES], Kpu[3 * CELL_MAX_NODES * CELL_MAX_NODES];
  PetscReal Kpp[CELL_MAX_NODES * CELL_MAX_NODES];
  PetscReal hold;      /* what holds pressures that vary inside the cell, m3/Pa, */
  PetscReal weight[3]; /* but as weight makes them vary, N/Pa */
} MixedWork;

KERNEL void mixed_load(const int dim, const int nn, const WeakFormInput *in, PetscInt group, MixedWork *w)
{
  const int width = row_width(nn);
  cell_load(dim, nn, in, group, &w->u);
  for (int I = 0; I < nn; ++I) w->p[I] = in->pressure[cell_nodes(in, group)[I]];
  for (int i = 0; i < width; ++i) w->fp[i] = 0;
  for (int i = 0; i < nn * width; ++i) w->Kpp[i] = 0;
  for (int i = 0; i < dim * nn * width; ++i) w->Kup[i] = w->Kpu[i] = 0;
  w->hold = in->pressure_tie ? in->pressure_tie[group] : 0;
  for (int d = 0; d < dim; ++d) w->weight[d] = 0;
}

/* The projection's integral is that over the cell, whatever the number of its points. */
KERNEL void mixed_project(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in, PetscInt group,
                          MixedWork *w)
{
  const PetscInt *node = cell_nodes(in, group);
  const PetscReal scale = in->pressure_scale, hold = w->hold * scale * scale;
  PetscReal radius[CELL_MAX_NODES], P[CELL_MAX_NODES * CELL_MAX_NODES], depth[CELL_MAX_NODES];
  for (int I = 0; I < nn; ++I) {
    const PetscReal *x = in->x + node[I] * dim;
    radius[I] = x[0];
    depth[I] = scale * pressure_depth(dim, w->weight, x, w->u.du + I * dim);
  }
  if (hoop) ring_projection(nn, radius, P);
  for (int I = 0; I < nn; ++I)
    for (int J = 0; J < nn; ++J) {
      if (!hoop) P[I * nn + J] = projection_entry(dim, nn, I, J);
      w->fp[I] -= P[I * nn + J] * (hold * w->p[J] + depth[J]);
      w->Kpp[I * row_width(nn) + J] -= hold * P[I * nn + J];
      for (int d = 0; !in->symmetric && d < dim; ++d)
        w->Kpu[(I * dim + d) * row_width(nn) + J] -= scale * w->weight[d] * P[I * nn + J];
    }
}

/* Blocks of (dim + 1)^2 entries: displacements first, the pressure last. */
KERNEL void mixed_scatter(const int dim, const int nn, const PetscInt *slot, const MixedWork *w, PetscReal *values)
{
  const int size = dim + 1, width = row_width(nn);
  for (int I = 0; I < nn; ++I)
    for (int J = 0; J < nn; ++J) {
      PetscReal *restrict block = values + slot[I * nn + J] * size * size;
      for (int a = 0; a < dim; ++a) {
        for (int b = 0; b < dim; ++b) block[a * size + b] += w->u.K[((I * dim + a) * dim + b) * width + J];
        block[a * size + dim] += w->Kup[(I * dim + a) * width + J];
        block[dim * size + a] += w->Kpu[(I * dim + a) * width + J];
      }
      block[dim * size + dim] += w->Kpp[I * width + J];
    }
}

KERNEL void mixed_store(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in, PetscInt group,
                        PetscInt slot, MixedWork *w, WeakFormOutput *out)
{
  const PetscInt *node = cell_nodes(in, group);
  cell_close(dim, nn, in, group, out->values != NULL, &w->u);
  mixed_project(dim, nn, hoop, in, group, w);
  if (out->values) mixed_scatter(dim, nn, out->slot + slot, w, out->values);
  cell_give_force(dim, nn, node, &w->u, out->force);
  for (int I = 0; I < nn; ++I)
    if (out->volume) out->volume[node[I]] += w->fp[I];
}

KERNEL LawStatus batch_update(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in,
                              PetscBool tangent, Batch *b)
{
  batch_increments(dim, nn, hoop, PETSC_TRUE, in, b);
  return batch_pressure_law(in, tangent, b);
}

/* Point k of the batch into its cell. */
KERNEL void add_point(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in, PetscBool tangent,
                      const Batch *b, PetscInt k, PetscInt group, MixedWork *w)
{
  const PetscInt p = b->first + k;
  const Points *points = in->points;
  const Material *material = batch_material(in, b);
  const PetscReal volume = points->real[POINT_VOLUME][p], mass = points->real[POINT_MASS][p];
  const PetscReal radius = hoop ? *point_real(points, POINT_X, p) : 0;
  const PetscReal scaled = in->pressure_scale * volume, lumping = in->lumping ? in->lumping[group] : 0;
  PetscReal N[CELL_MAX_NODES], weight[3];
  PointRun run = {.n = 1, .tau = {b->s.tau + 6 * k}, .c = {b->s.c + 36 * k}, .volume = {volume}};
  row_load(nn, 1, support_N(in->support, group, p), N);
  current_gradients(dim, nn, hoop, support_dN(in->support, group, p, dim), N, radius, b->dF + 9 * k, run.g[0]);
  add_internal_force(dim, nn, hoop, run.g[0], b->s.tau + 6 * k, volume, w->u.f);
  add_mass(nn, N, mass, lumping, w->u.M);
  row_add(nn, scaled * (b->s.theta[k] - b->p[k] * material->compliance), N, w->fp);
  const PetscReal softness = point_softness(in, material, p);
  w->hold += softness * volume;
  point_weight(dim, in, p, weight);
  for (int d = 0; d < dim; ++d) w->weight[d] += softness * mass * weight[d];
  if (!tangent) return;
  add_stiffness(dim, nn, hoop, PETSC_FALSE, &run, w->u.K);
  add_pressure_force(dim, nn, hoop, run.g[0], b->s.coupling + 6 * k, N, scaled, w->Kup);
  add_dilation(dim, nn, hoop, run.g[0], N, scaled * b->s.rate[k], w->Kpu);
  for (int I = 0; I < nn; ++I)
    row_add(nn, -scaled * in->pressure_scale * material->compliance * N[I], N, w->Kpp + I * row_width(nn));
}

KERNEL void assemble_points(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in,
                            const SupportRun *run, PetscInt slot, WeakFormOutput *out)
{
  const PetscBool tangent = out->values != NULL;
  PetscInt group = run->first;
  MixedWork w;
  Batch b;

  mixed_load(dim, nn, in, group, &w);
  batch_begin(run, in->support, PETSC_FALSE, &b);
  while (batch_next(in, &b)) {
    if (!batch_is_good(&b, batch_update(dim, nn, hoop, in, tangent, &b), out)) return;
    for (PetscInt k = 0; k < b.n; ++k) {
      while (b.first + k >= in->support->point_start[group + 1]) {
        mixed_store(dim, nn, hoop, in, group++, slot, &w, out);
        slot += nn * nn;
        mixed_load(dim, nn, in, group, &w);
      }
      add_point(dim, nn, hoop, in, tangent, &b, k, group, &w);
    }
  }
  mixed_store(dim, nn, hoop, in, group, slot, &w, out);
}

CELL_SIZES(SIZED_KERNELS)

static const SizedKernels kernels[] = {CELL_SIZES(SIZED_ROW){0}};

static const SizedKernels *kernels_of(const WeakFormInput *in)
{
  return in->support->n_runs ? kernels : mixed_cloud_kernels;
}

static PetscErrorCode MixedAssemble(const WeakFormInput *in, WeakFormOutput *out)
{
  return SizedAssemble(kernels_of(in), in, out);
}

static PetscErrorCode MixedCommit(const WeakFormInput *in, Points *points, LawStatus *status)
{
  return SizedCommit(kernels_of(in), in, points, status);
}

/* Mass over G + 1/K, lumped: B A^-1 B^T of a body with the stiffness 2G against shear is the
 * mass over G up to a factor near 1. */
static void mixed_schur(const WeakFormInput *in, PetscReal *nodes)
{
  const Support *w = in->support;
  const PetscReal scale2 = in->pressure_scale * in->pressure_scale;
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const Material *material = &in->materials[in->points->material[p]];
      const PetscReal softness = 1 / material->elastic.shear + material->compliance;
      for (PetscInt I = 0; I < support_nodes(w, g); ++I)
        nodes[w->node[w->node_start[g] + I]] +=
          scale2 * softness * in->points->real[POINT_VOLUME][p] * support_N(w, g, p)[I];
    }
}

const Formulation formulation_mixed = {
  .name = "mixed",
  .help = "displacements and pressure: for nearly or exactly incompressible materials",
  .pressure = PETSC_TRUE,
  .assemble = MixedAssemble,
  .commit = MixedCommit,
  .schur = mixed_schur,
};
