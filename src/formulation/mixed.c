/* Mixed formulation: displacements and a pressure at the same nodes, stabilised by polynomial pressure projection (docs/theory.md).
 *
 *   R_I  = sum_p V0 tau grad N_I + inertia          tau with the interpolated pressure
 *   R_pI = sum_p V0 N_I (theta - p / K) - sum_cells (alpha / G) V0 int (N_I - mean)(p - mean)
 *
 * The unknown is p over a scale of Pa/m, and the second equation is multiplied by it: then all unknowns are m and all equations N, and
 * the tangent is symmetric where the law's is. Points run in batches of one material as in displacement.c. */
#include "formulation/sizes.h"
#include "formulation/mixed_kernels.h"
#include "formulation/walk.h"
#include "material/pressure.h"

/* What one cell gathers before it is scattered; rows as in displacement_kernels.h. */
typedef struct {
  PetscReal du[3 * CELL_MAX_NODES], p[CELL_MAX_NODES], a[3 * CELL_MAX_NODES];
  PetscReal f[3 * CELL_MAX_NODES], fp[CELL_MAX_NODES];
  PetscReal M[CELL_MAX_NODES * CELL_MAX_NODES];
  PetscReal K[9 * CELL_MAX_NODES * CELL_MAX_NODES];
  PetscReal Kup[3 * CELL_MAX_NODES * CELL_MAX_NODES], Kpu[3 * CELL_MAX_NODES * CELL_MAX_NODES];
  PetscReal Kpp[CELL_MAX_NODES * CELL_MAX_NODES];
  PetscReal hold; /* what holds pressures that vary inside the cell, m3/Pa */
} CellWork;

typedef struct {
  PetscInt n, first, group; /* points first .. first + n - 1; the group of the first */
  PetscReal dF[9 * LAW_BATCH], p[LAW_BATCH];
  PetscReal old[LAW_MAX_STATE * LAW_BATCH], state[LAW_MAX_STATE * LAW_BATCH];
  PressureStress s;
} Batch;

KERNEL void cell_load(const int dim, const int nn, const WeakFormInput *in, PetscInt group, CellWork *w)
{
  const PetscInt *node = in->support->node + group * nn;
  const int width = row_width(nn);
  for (int I = 0; I < nn; ++I) {
    w->p[I] = in->pressure[node[I]];
    for (int d = 0; d < dim; ++d) {
      const PetscInt k = node[I] * dim + d;
      w->du[I * dim + d] = in->du[k];
      w->a[d * width + I] = in->inertia * in->du[k] + in->history[k];
    }
  }
  for (int i = 0; i < dim * width; ++i) w->f[i] = 0;
  for (int i = 0; i < width; ++i) w->fp[i] = 0;
  for (int i = 0; i < nn * width; ++i) w->M[i] = w->Kpp[i] = 0;
  for (int i = 0; i < dim * nn * width; ++i) w->Kup[i] = w->Kpu[i] = 0;
  for (int i = 0; i < dim * dim * nn * width; ++i) w->K[i] = 0;
  w->hold = in->pressure_tie ? in->pressure_tie[group] : 0;
}

/* Ties the nodes of a hardly filled cell: s (du_I - mean), no force on a translation. */
KERNEL void cell_soften(const int dim, const int nn, PetscReal s, CellWork *w)
{
  const int width = row_width(nn);
  for (int d = 0; d < dim; ++d) {
    PetscReal mean = 0;
    for (int I = 0; I < nn; ++I) mean += w->du[I * dim + d] / nn;
    for (int I = 0; I < nn; ++I) {
      w->f[d * width + I] += s * (w->du[I * dim + d] - mean);
      for (int J = 0; J < nn; ++J) w->K[((I * dim + d) * dim + d) * width + J] += s * ((I == J) - 1.0 / nn);
    }
  }
}

/* The projection's integral is that over the cell, whatever the number of its points. */
KERNEL void cell_project(const int dim, const int nn, PetscReal scale, CellWork *w)
{
  const PetscReal hold = w->hold * scale * scale;
  for (int I = 0; I < nn; ++I)
    for (int J = 0; J < nn; ++J) {
      const PetscReal entry = hold * projection_entry(dim, nn, I, J);
      w->fp[I] -= entry * w->p[J];
      w->Kpp[I * row_width(nn) + J] -= entry;
    }
}

/* Rows and columns of prescribed displacements are cut; lifting moves their columns to the right-hand side. */
KERNEL void cell_cut(const int dim, const int nn, const WeakFormInput *in, const PetscInt *node, CellWork *w)
{
  const int width = row_width(nn);
  for (int J = 0; J < nn; ++J)
    for (int b = 0; b < dim; ++b) {
      const PetscInt column = node[J] * dim + b;
      if (!in->fixed[column]) continue;
      const PetscReal lift = in->lift ? in->lift[column] : 0;
      for (int I = 0; I < nn; ++I) {
        PetscReal *kp = &w->Kpu[(I * dim + b) * width + J];
        for (int a = 0; a < dim; ++a) {
          PetscReal *k = &w->K[((I * dim + a) * dim + b) * width + J];
          if (!in->fixed[node[I] * dim + a]) w->f[a * width + I] += *k * lift;
          *k = 0;
          w->K[((J * dim + b) * dim + a) * width + I] = 0;
        }
        w->fp[I] += *kp * lift;
        *kp = 0;
        w->Kup[(J * dim + b) * width + I] = 0;
      }
    }
}

/* Blocks of (dim + 1)^2 entries: displacements first, the pressure last. */
KERNEL void cell_scatter(const int dim, const int nn, const PetscInt *slot, const CellWork *w, PetscReal *values)
{
  const int size = dim + 1, width = row_width(nn);
  for (int I = 0; I < nn; ++I)
    for (int J = 0; J < nn; ++J) {
      PetscReal *restrict block = values + slot[I * nn + J] * size * size;
      for (int a = 0; a < dim; ++a) {
        for (int b = 0; b < dim; ++b) block[a * size + b] += w->K[((I * dim + a) * dim + b) * width + J];
        block[a * size + dim] += w->Kup[(I * dim + a) * width + J];
        block[dim * size + a] += w->Kpu[(I * dim + a) * width + J];
      }
      block[dim * size + dim] += w->Kpp[I * width + J];
    }
}

KERNEL void cell_store(const int dim, const int nn, const WeakFormInput *in, PetscInt group, CellWork *w,
                       WeakFormOutput *out)
{
  const PetscInt *node = in->support->node + group * nn;
  const int width = row_width(nn);
  if (in->soft && in->soft[group] > 0) cell_soften(dim, nn, in->soft[group], w);
  if (in->tie && in->tie[group] > 0) add_tie(dim, nn, in->tie[group], w->a, w->f, w->M);
  cell_project(dim, nn, in->pressure_scale, w);
  if (out->values) {
    int cut = 0;
    for (int I = 0; I < nn; ++I)
      for (int d = 0; d < dim; ++d) {
        cut |= in->fixed[node[I] * dim + d];
        for (int J = 0; J < nn; ++J) w->K[((I * dim + d) * dim + d) * width + J] += in->inertia * w->M[I * width + J];
      }
    if (cut) cell_cut(dim, nn, in, node, w);
    cell_scatter(dim, nn, out->slot + group * nn * nn, w, out->values);
  }
  for (int I = 0; I < nn; ++I) {
    for (int d = 0; d < dim; ++d) out->force[node[I] * dim + d] += w->f[d * width + I];
    if (out->volume) out->volume[node[I]] += w->fp[I];
  }
}

KERNEL LawStatus batch_update(const int dim, const int nn, const WeakFormInput *in, PetscBool tangent, Batch *b)
{
  const Points *points = in->points;
  const Support *support = in->support;
  const Material *material = &in->materials[points->material[b->first]];
  const PetscInt n_state = material->law->n_state, stride = points->components[POINT_STATE];
  const PetscReal *old = points->real[POINT_STATE] + b->first * stride;
  PetscReal du[3 * CELL_MAX_NODES], pressure[CELL_MAX_NODES] = {0};
  PetscInt group = -1, next = b->group;

  for (PetscInt k = 0; k < b->n; ++k) {
    const PetscInt p = b->first + k;
    while (group < 0 || p >= support->point_start[group + 1]) {
      group = next++;
      for (int I = 0; I < nn; ++I) {
        const PetscInt node = support->node[group * nn + I];
        pressure[I] = in->pressure_scale * in->pressure[node];
        for (int d = 0; d < dim; ++d) du[I * dim + d] = in->du[node * dim + d];
      }
    }
    increment_rows(dim, nn, support->dN + p * nn * dim, du, b->dF + 9 * k);
    b->p[k] = 0;
    for (int I = 0; I < nn; ++I) b->p[k] += support->N[p * nn + I] * pressure[I];
  }
  if (stride != n_state) {
    for (PetscInt k = 0; k < b->n; ++k)
      for (PetscInt s = 0; s < n_state; ++s) b->old[k * n_state + s] = old[k * stride + s];
    old = b->old;
  }
  return pressure_update(material, b->n, b->dF, b->p, old, b->state, tangent, &b->s);
}

/* Point k of the batch into its cell. */
KERNEL void add_point(const int dim, const int nn, const WeakFormInput *in, PetscBool tangent, const Batch *b,
                      PetscInt k, PetscReal lumping, CellWork *w)
{
  const PetscInt p = b->first + k;
  const Points *points = in->points;
  const Material *material = &in->materials[points->material[p]];
  const PetscReal volume = points->real[POINT_VOLUME][p], mass = points->real[POINT_MASS][p];
  const PetscReal scaled = in->pressure_scale * volume;
  PetscReal g[3 * CELL_MAX_NODES], N[CELL_MAX_NODES];
  row_load(nn, 1, in->support->N + p * nn, N);
  current_gradients(dim, nn, in->support->dN + p * nn * dim, b->dF + 9 * k, g);
  add_internal_force(dim, nn, g, b->s.tau + 6 * k, volume, w->f);
  add_inertia_force(dim, nn, N, w->a, mass, lumping, w->f);
  row_add(nn, scaled * (b->s.theta[k] - b->p[k] * material->compliance), N, w->fp);
  w->hold += in->alpha / material->elastic.shear * volume;
  if (!tangent) return;
  PointRun run = {.n = 1, .tau = {b->s.tau + 6 * k}, .c = {b->s.c + 36 * k}, .volume = {volume}};
  for (int j = 0; j < dim; ++j) row_copy(nn, g + j * row_width(nn), run.g[0] + j * row_width(nn));
  add_stiffness(dim, nn, PETSC_FALSE, &run, w->K);
  add_pressure_force(dim, nn, g, b->s.coupling + 6 * k, N, scaled, w->Kup);
  add_dilation(dim, nn, g, N, scaled * b->s.rate[k], w->Kpu);
  for (int I = 0; I < nn; ++I)
    row_add(nn, -scaled * in->pressure_scale * material->compliance * N[I], N, w->Kpp + I * row_width(nn));
  if (in->inertia > 0) add_mass(nn, N, mass, lumping, w->M);
}

KERNEL void assemble_points(const int dim, const int nn, const WeakFormInput *in, WeakFormOutput *out)
{
  const Support *support = in->support;
  const PetscBool tangent = out->values != NULL;
  const PetscInt n = points_in_groups(support);
  PetscInt group = 0;
  CellWork w;
  Batch b;

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
    for (PetscInt k = 0; k < b.n; ++k) {
      while (first + k >= support->point_start[group + 1]) {
        cell_store(dim, nn, in, group++, &w, out);
        cell_load(dim, nn, in, group, &w);
      }
      add_point(dim, nn, in, tangent, &b, k, in->lumping ? in->lumping[group] : 0, &w);
    }
  }
  cell_store(dim, nn, in, group, &w, out);
}

KERNEL LawStatus commit_points(const int dim, const int nn, const WeakFormInput *in, Points *points)
{
  const PetscInt stride = points->components[POINT_STATE], n = points_in_groups(in->support);
  Batch b;
  for (PetscInt first = 0, group = 0; first < n; first += b.n) {
    while (first >= in->support->point_start[group + 1]) ++group;
    b.first = first;
    b.group = group;
    b.n = batch_length(points, first, n);
    const LawStatus status = batch_update(dim, nn, in, PETSC_FALSE, &b);
    if (status != LAW_OK) return status;
    const PetscInt n_state = in->materials[points->material[first]].law->n_state;
    for (PetscInt k = 0; k < b.n; ++k) {
      commit_point(points, first + k, b.dF + 9 * k, b.s.tau + 6 * k);
      points->real[POINT_PRESSURE][first + k] = b.s.pressure[k];
      PetscReal *state = points->real[POINT_STATE] + (first + k) * stride;
      for (PetscInt i = 0; i < n_state; ++i) state[i] = b.state[k * n_state + i];
    }
  }
  return LAW_OK;
}

SIZED_KERNELS(2, 3)
SIZED_KERNELS(2, 4)
SIZED_KERNELS(3, 4)
SIZED_KERNELS(3, 8)

static const SizedKernels kernels[] = {
  SIZED_ROW(2, 3), SIZED_ROW(2, 4), SIZED_ROW(3, 4), SIZED_ROW(3, 8), {0},
};

static PetscErrorCode MixedAssemble(const WeakFormInput *in, WeakFormOutput *out)
{
  return SizedAssemble(kernels, in, out);
}

static PetscErrorCode MixedCommit(const WeakFormInput *in, Points *points, LawStatus *status)
{
  return SizedCommit(kernels, in, points, status);
}

/* Mass over G + 1/K, lumped: B A^-1 B^T of a body with the stiffness 2G against shear is the mass over G up to a factor near 1. */
static void mixed_schur(const WeakFormInput *in, PetscReal *nodes)
{
  const Support *w = in->support;
  const PetscReal scale2 = in->pressure_scale * in->pressure_scale;
  for (PetscInt g = 0, nn = w->uniform; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const Material *material = &in->materials[in->points->material[p]];
      const PetscReal softness = 1 / material->elastic.shear + material->compliance;
      for (PetscInt I = 0; I < nn; ++I)
        nodes[w->node[g * nn + I]] += scale2 * softness * in->points->real[POINT_VOLUME][p] * w->N[p * nn + I];
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
