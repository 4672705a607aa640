/* Mixed formulation of points with nodes of their own: the equations of mixed.c, with the basis's
 * functions for displacements and pressures alike.
 *
 * The projection stays that of cells: with the pressures at a cell's corners as coefficients of its
 * linear functions it sees every pressure that varies, wherever points stand. Pressures of nodes
 * that hardly any material reaches are held to the linear part of what a point sees. */
#include "formulation/mixed_cloud.h"
#include "formulation/kernels/cloud_kernels.h"
#include "formulation/kernels/mixed_kernels.h"

/* What one point adds beside what it adds without a pressure. */
typedef struct {
  CloudWork u;
  PetscReal T[3 * 9 * CLOUD_MAX_NODES];    /* T_j[J] = sum_l modulus_jl g_l[J]: blocks of each row and node */
  PetscReal force[3 * CLOUD_MAX_NODES];    /* nn x dim: d force / d p at the point, m2, times Pa/m */
  PetscReal dilation[3 * CLOUD_MAX_NODES]; /* nn x dim: d theta / d u, 1/m, times V0 Pa/m */
} MixedPoint;

KERNEL void point_products(const int dim, const PetscBool hoop, MixedPoint *w)
{
  const int rows = gradient_rows(dim, hoop), size = dim * dim;
  for (int j = 0; j < rows; ++j)
    for (PetscInt J = 0; J < w->u.nn; ++J)
      for (int e = 0; e < size; ++e) {
        PetscReal sum = 0;
        for (int l = 0; l < rows; ++l) sum += w->u.modulus[j][l][e] * w->u.g[J * rows + l];
        w->T[(j * w->u.nn + J) * size + e] = sum;
      }
}

/* V0 s t_aj g_j and V0 s theta' div of each node and component. */
KERNEL void point_couplings(const int dim, const PetscBool hoop, const PetscReal *t, PetscReal rate, PetscReal scaled,
                            MixedPoint *w)
{
  const int rows = gradient_rows(dim, hoop);
  for (PetscInt I = 0; I < w->u.nn; ++I) {
    const PetscReal *g = w->u.g + I * rows;
    for (int a = 0; a < dim; ++a) {
      PetscReal sum = 0;
      for (int j = 0; j < rows; ++j)
        if (is_felt(dim, a, j)) sum += g[j] * t[strain_of(dim, a, j)];
      w->force[I * dim + a] = scaled * sum;
      w->dilation[I * dim + a] = scaled * rate * (g[a] + (hoop && a == 0 ? g[dim] : 0));
    }
  }
}

/* Block of the nodes I and J; pp: what N_I N_J is multiplied by between pressures. */
KERNEL void mixed_block(const int dim, const PetscBool hoop, MixedPoint *w, PetscInt I, PetscInt J, PetscReal pp,
                        PetscReal *restrict block)
{
  const int size = dim + 1, rows = gradient_rows(dim, hoop);
  CloudWork *u = &w->u;
  const PetscReal *T = w->T + J * dim * dim;
  const PetscReal held = u->soft > 0 ? u->soft * held_part(u->n_free, u->free, I, J) : 0;
  const PetscReal mass = u->inertia * ((1 - u->lumping) * u->N[I] * u->N[J] + (I == J ? u->lumping * u->N[I] : 0));
  for (int a = 0; a < dim; ++a) {
    for (int b = 0; b < dim; ++b) {
      PetscReal k = a == b ? mass + held : 0;
      for (int j = 0; j < rows; ++j) k += u->g[I * rows + j] * T[j * u->nn * dim * dim + a * dim + b];
      block[a * size + b] += k;
    }
    block[a * size + dim] += w->force[I * dim + a] * u->N[J];
    block[dim * size + a] += u->N[I] * w->dilation[J * dim + a];
  }
  block[dim * size + dim] += pp * u->N[I] * u->N[J];
}

/* entry: of the pressures of local nodes I and J, N/m. */
KERNEL void hold_pressure(const int dim, const WeakFormInput *in, const PetscInt *slot, const CloudWork *w, PetscInt I,
                          PetscInt J, PetscReal entry, WeakFormOutput *out)
{
  const int size = dim + 1;
  if (out->volume) out->volume[w->node[I]] -= entry * in->pressure[w->node[J]];
  if (out->values) out->values[((size_t)slot[I * w->nn + J] + 1) * size * size - 1] -= entry;
}

/* The corners of the point's cell, which are among its nodes, and what pressures bear at the point, per mass. */
typedef struct {
  PetscInt at[CELL_MAX_NODES]; /* there */
  PetscReal weight[3], radius[CELL_MAX_NODES], depth[CELL_MAX_NODES];
} Corners;

/* The same of the weight that these pressures bear, N over what acts per mass times length: corners k and l. */
KERNEL void weigh_pressure(const int dim, const WeakFormInput *in, const PetscInt *slot, const CloudWork *w,
                           const Corners *c, int k, int l, PetscReal entry, WeakFormOutput *out)
{
  const int size = dim + 1;
  if (out->volume) out->volume[w->node[c->at[k]]] -= entry * c->depth[l];
  if (!out->values || in->symmetric) return;
  PetscReal *row = out->values + (size_t)slot[c->at[k] * w->nn + c->at[l]] * size * size + dim * size;
  for (int d = 0; d < dim; ++d) row[d] -= entry * c->weight[d];
}

KERNEL void find_corners(const int dim, const WeakFormInput *in, PetscInt p, const CloudWork *w, Corners *c)
{
  const int corners = 1 << dim;
  const PetscInt *node = in->cell_node + in->points->cell[p] * corners;
  point_weight(dim, in, p, c->weight);
  for (int k = 0; k < corners; ++k) {
    c->at[k] = 0;
    while (w->node[c->at[k]] != node[k]) ++c->at[k];
    c->radius[k] = in->x[node[k] * dim];
    c->depth[k] = pressure_depth(dim, c->weight, in->x + node[k] * dim, in->du + node[k] * dim);
  }
}

/* The point's part of the projection in its cell. */
KERNEL void point_project(const int dim, const PetscBool hoop, const WeakFormInput *in, PetscInt p, PetscReal softness,
                          const PetscInt *slot, const CloudWork *w, WeakFormOutput *out)
{
  const int corners = 1 << dim;
  const PetscReal volume = in->points->real[POINT_VOLUME][p];
  const PetscReal mass = in->points->real[POINT_MASS][p], scale = in->pressure_scale;
  Corners c;
  PetscReal ring[CELL_MAX_NODES * CELL_MAX_NODES];
  find_corners(dim, in, p, w, &c);
  if (hoop) ring_projection(corners, c.radius, ring);
  for (int k = 0; k < corners; ++k)
    for (int l = 0; l < corners; ++l) {
      const PetscReal share = softness * scale * (hoop ? ring[k * corners + l] : projection_entry(dim, corners, k, l));
      weigh_pressure(dim, in, slot, w, &c, k, l, share * mass, out);
      hold_pressure(dim, in, slot, w, c.at[k], c.at[l], share * volume * scale, out);
    }
}

static void hold_cut(const int dim, const WeakFormInput *in, PetscReal hold, const PetscInt *slot, const CloudWork *w,
                     WeakFormOutput *out)
{
  CloudRow part[4];
  const int n = free_parts(dim, dim, w, in->x, part);
  for (PetscInt I = 0; I < w->nn; ++I)
    for (PetscInt J = 0; J < w->nn; ++J) hold_pressure(dim, in, slot, w, I, J, hold * held_part(n, part, I, J), out);
}

KERNEL void mixed_point(const int dim, const PetscBool hoop, const WeakFormInput *in, const Batch *b, PetscInt k,
                        PetscInt slot, MixedPoint *w, WeakFormOutput *out)
{
  const PetscInt p = b->first + k;
  const Material *material = batch_material(in, b);
  const PetscReal volume = in->points->real[POINT_VOLUME][p], scale = in->pressure_scale, scaled = scale * volume;
  const PetscReal tie = in->pressure_tie ? in->pressure_tie[p] : 0;
  CloudWork *u = &w->u;
  cloud_load(dim, hoop, in, p, b->dF + 9 * k, u);
  cloud_gradients(dim, hoop, u);
  cloud_force(dim, hoop, in, b->s.tau + 6 * k, volume, u, out->force);
  for (PetscInt I = 0; out->volume && I < u->nn; ++I)
    out->volume[u->node[I]] += scaled * (b->s.theta[k] - b->p[k] * material->compliance) * u->N[I];
  if (u->soft > 0) cloud_hold(dim, in, u, out->force);
  point_project(dim, hoop, in, p, point_softness(in, material, p), out->slot + slot, u, out);
  if (tie > 0) hold_cut(dim, in, tie * scale * scale, out->slot + slot, u, out);
  if (!out->values) return;
  for (int j = 0; j < gradient_rows(dim, hoop); ++j)
    cloud_moduli(dim, gradient_rows(dim, hoop), j, b->s.tau + 6 * k, b->s.c + 36 * k, volume, u->modulus[j]);
  point_products(dim, hoop, w);
  point_couplings(dim, hoop, b->s.coupling + 6 * k, b->s.rate[k], scaled, w);
  for (PetscInt I = 0; I < u->nn; ++I)
    for (PetscInt J = 0; J < u->nn; ++J)
      mixed_block(dim, hoop, w, I, J, -scaled * scale * material->compliance,
                  out->values + (size_t)out->slot[slot + I * u->nn + J] * (dim + 1) * (dim + 1));
}

KERNEL LawStatus batch_update(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in,
                              PetscBool tangent, Batch *b)
{
  const Support *s = in->support;
  (void)nn;
  for (PetscInt k = 0, p = b->first; k < b->n; ++k, ++p) {
    cloud_increment(dim, hoop, in, p, b->dF + 9 * k);
    b->p[k] = 0;
    for (PetscInt i = s->node_start[p]; i < s->node_start[p + 1]; ++i)
      b->p[k] += in->pressure_scale * s->N[i - s->node_start[p] + s->value_start[p]] * in->pressure[s->node[i]];
  }
  return batch_pressure_law(in, tangent, b);
}

KERNEL void assemble_points(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in,
                            const SupportRun *run, PetscInt slot, WeakFormOutput *out)
{
  Batch b;
  MixedPoint w;
  batch_begin(run, in->support, PETSC_FALSE, &b);
  while (batch_next(in, &b)) {
    if (!batch_is_good(&b, batch_update(dim, nn, hoop, in, out->values != NULL, &b), out)) return;
    for (PetscInt k = 0; k < b.n; ++k) {
      mixed_point(dim, hoop, in, &b, k, slot, &w, out);
      slot += w.u.nn * w.u.nn;
    }
  }
}

CLOUD_SIZES(SIZED_KERNELS)

const SizedKernels mixed_cloud_kernels[] = {CLOUD_SIZES(SIZED_ROW){0}};
