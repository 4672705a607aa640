/* Displacement formulation of points with a cloud of nodes each, as many as the basis chose.
 *
 * Nothing is gathered per group, so a point's blocks go straight into the matrix values. The innermost unit is one block of a pair of
 * nodes: with T_j[J] = sum_l modulus_jl g_l[J], a block is sum_j g_j[I] T_j[J] plus the mass, and in the plane it fills one register. */
#include "formulation/displacement_cloud.h"
#include "formulation/displacement_points.h"

#define KERNEL static inline __attribute__((always_inline))

typedef PetscReal Four __attribute__((vector_size(4 * sizeof(PetscReal)), aligned(8), may_alias));

/* What one point needs of its cloud. */
typedef struct {
  PetscInt nn;
  const PetscInt *node;
  const PetscReal *N;
  PetscReal mass, inertia, lumping, soft; /* inertia: mass times c0 */
  PetscReal g[3 * CLOUD_MAX_NODES];       /* nn x dim, gradients at x_(n+1) */
  PetscReal T[3 * 9 * CLOUD_MAX_NODES];   /* dim x nn blocks */
} CloudWork;

KERNEL void cloud_increment(const int dim, const WeakFormInput *in, PetscInt p, PetscReal dF[9])
{
  const Support *s = in->support;
  const PetscInt first = s->node_start[p], nn = s->node_start[p + 1] - first, *node = s->node + first;
  const PetscReal *dN = s->dN + s->value_start[p] * dim;
  PetscReal H[9] = {0};
  for (PetscInt I = 0; I < nn; ++I) {
    const PetscReal *du = in->du + node[I] * dim;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) H[i * dim + j] += du[i] * dN[I * dim + j];
  }
  for (int i = 0; i < 9; ++i) dF[i] = i % 4 == 0;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) dF[3 * i + j] += H[i * dim + j];
}

KERNEL void cloud_gradients(const int dim, const PetscReal *restrict dN, const PetscReal *dF, CloudWork *w)
{
  PetscReal inverse[9];
  tensor_inverse(dF, inverse);
  for (PetscInt I = 0; I < w->nn; ++I)
    for (int j = 0; j < dim; ++j) {
      PetscReal g = 0;
      for (int i = 0; i < dim; ++i) g += inverse[3 * i + j] * dN[I * dim + i];
      w->g[I * dim + j] = g;
    }
}

/* f_I += V0 tau g_I + m N_I ((1 - lumping) a_h + lumping a_I) + soft (du_I - mean) */
KERNEL void cloud_force(const int dim, const WeakFormInput *in, const PetscReal *tau, PetscReal volume,
                        const CloudWork *w, PetscReal *force)
{
  const PetscReal part = 1 / (PetscReal)w->nn;
  PetscReal mean_a[3] = {0, 0, 0}, mean_u[3] = {0, 0, 0};
  for (PetscInt I = 0; I < w->nn; ++I)
    for (int d = 0; d < dim; ++d) {
      const PetscInt k = w->node[I] * dim + d;
      mean_a[d] += w->N[I] * (in->inertia * in->du[k] + in->history[k]);
      mean_u[d] += in->du[k] * part;
    }
  for (PetscInt I = 0; I < w->nn; ++I)
    for (int d = 0; d < dim; ++d) {
      const PetscInt k = w->node[I] * dim + d;
      const PetscReal a = in->inertia * in->du[k] + in->history[k];
      PetscReal f =
        w->mass * w->N[I] * ((1 - w->lumping) * mean_a[d] + w->lumping * a) + w->soft * (in->du[k] - mean_u[d]);
      for (int j = 0; j < dim; ++j) f += volume * tau[voigt_of[d][j]] * w->g[I * dim + j];
      force[k] += f;
    }
}

/* T_j[J] = V0 sum_l (c_ajbl + delta_ab tau_jl) g_l[J], a block of dim x dim. */
KERNEL void cloud_products(const int dim, const PetscReal *tau, const PetscReal *c, PetscReal volume, CloudWork *w)
{
  for (int j = 0; j < dim; ++j) {
    PetscReal modulus[3][9];
    for (int l = 0; l < dim; ++l)
      for (int a = 0; a < dim; ++a)
        for (int b = 0; b < dim; ++b)
          modulus[l][a * dim + b] =
            volume * (c[6 * voigt_of[a][j] + voigt_of[b][l]] + (a == b ? tau[voigt_of[j][l]] : 0.0));
    for (PetscInt J = 0; J < w->nn; ++J) {
      PetscReal *T = w->T + (j * w->nn + J) * dim * dim;
      if (dim == 2) {
        *(Four *)T = *(const Four *)modulus[0] * w->g[J * dim] + *(const Four *)modulus[1] * w->g[J * dim + 1];
        continue;
      }
      for (int e = 0; e < dim * dim; ++e) {
        T[e] = 0;
        for (int l = 0; l < dim; ++l) T[e] += modulus[l][e] * w->g[J * dim + l];
      }
    }
  }
}

KERNEL void cloud_block(const int dim, const CloudWork *w, PetscInt I, PetscInt J, PetscReal *restrict block)
{
  const PetscReal *T = w->T + J * dim * dim;
  PetscReal mass = w->inertia * (1 - w->lumping) * w->N[I] * w->N[J] - w->soft / (PetscReal)w->nn;
  if (I == J) mass += w->inertia * w->lumping * w->N[I] + w->soft;
  for (int e = 0; e < dim * dim; ++e) {
    PetscReal k = e % (dim + 1) == 0 ? mass : 0;
    for (int j = 0; j < dim; ++j) k += w->g[I * dim + j] * T[j * w->nn * dim * dim + e];
    block[e] += k;
  }
}

/* In the plane a block is g_x[I] T_x[J] + g_y[I] T_y[J] + mass, four numbers at a time. */
KERNEL void cloud_matrix_2d(const PetscBool half, const PetscInt *slot, const CloudWork *w, PetscReal *values)
{
  const PetscReal soft = w->soft / (PetscReal)w->nn, share = w->inertia * (1 - w->lumping);
  const Four diagonal = {1, 0, 0, 1};
  for (PetscInt I = 0; I < w->nn; ++I) {
    const Four gx = diagonal * 0 + w->g[2 * I], gy = diagonal * 0 + w->g[2 * I + 1],
               mass = diagonal * (share * w->N[I]), none = diagonal * soft;
    for (PetscInt J = half ? I : 0; J < w->nn; ++J) {
      Four *block = (Four *)(values + (size_t)slot[I * w->nn + J] * 4);
      const Four Tx = *(const Four *)(w->T + J * 4), Ty = *(const Four *)(w->T + (w->nn + J) * 4);
      *block += (gx * Tx + gy * Ty) + (mass * w->N[J] - none);
    }
    *(Four *)(values + (size_t)slot[I * w->nn + I] * 4) += diagonal * (w->inertia * w->lumping * w->N[I] + w->soft);
  }
}

KERNEL void cloud_matrix(const int dim, const WeakFormInput *in, const PetscInt *slot, const CloudWork *w,
                         WeakFormOutput *out)
{
  if (dim == 2 && in->half) cloud_matrix_2d(PETSC_TRUE, slot, w, out->values);
  else if (dim == 2) cloud_matrix_2d(PETSC_FALSE, slot, w, out->values);
  else
    for (PetscInt I = 0; I < w->nn; ++I)
      for (PetscInt J = in->half ? I : 0; J < w->nn; ++J)
        cloud_block(dim, w, I, J, out->values + (size_t)slot[I * w->nn + J] * dim * dim);
}

KERNEL void cloud_point(const int dim, const WeakFormInput *in, const Batch *b, PetscInt k, const PetscInt *slot,
                        CloudWork *w, WeakFormOutput *out)
{
  const Support *s = in->support;
  const PetscInt p = b->first + k;
  const PetscReal volume = in->points->real[POINT_VOLUME][p];
  w->nn = s->node_start[p + 1] - s->node_start[p];
  w->node = s->node + s->node_start[p];
  w->N = s->N + s->value_start[p];
  w->mass = in->points->real[POINT_MASS][p];
  w->inertia = w->mass * in->inertia;
  w->lumping = in->lumping ? in->lumping[p] : 0;
  w->soft = in->soft ? in->soft[p] : 0;
  cloud_gradients(dim, s->dN + s->value_start[p] * dim, b->dF + 9 * k, w);
  cloud_force(dim, in, b->tau + 6 * k, volume, w, out->force);
  if (!out->values) return;
  cloud_products(dim, b->tau + 6 * k, b->c + 36 * k, volume, w);
  cloud_matrix(dim, in, slot, w, out);
}

KERNEL LawStatus cloud_batch(const int dim, const WeakFormInput *in, PetscInt first, PetscInt end, PetscBool tangent,
                             Batch *b)
{
  b->first = first;
  b->n = batch_length(in->points, first, end);
  for (PetscInt k = 0; k < b->n; ++k) cloud_increment(dim, in, first + k, b->dF + 9 * k);
  return batch_law(in, tangent, b);
}

KERNEL void cloud_points(const int dim, const WeakFormInput *in, WeakFormOutput *out)
{
  const PetscInt n = points_in_groups(in->support);
  const PetscInt *slot = out->slot;
  Batch b;
  CloudWork w;
  for (PetscInt first = 0; first < n; first += b.n) {
    const LawStatus status = cloud_batch(dim, in, first, n, out->values != NULL, &b);
    if (status > out->status) {
      out->status = status;
      out->bad_point = first;
    }
    if (out->status != LAW_OK) return; /* the step is cut, nothing here counts */
    for (PetscInt k = 0; k < b.n; ++k) {
      cloud_point(dim, in, &b, k, slot, &w, out);
      slot += w.nn * w.nn;
    }
  }
}

void displacement_assemble_cloud(const WeakFormInput *in, WeakFormOutput *out)
{
  if (in->points->dim == 2) cloud_points(2, in, out);
  else cloud_points(3, in, out);
}

LawStatus displacement_commit_cloud(const WeakFormInput *in, Points *points)
{
  const PetscInt n = points_in_groups(in->support);
  Batch b;
  for (PetscInt first = 0; first < n; first += b.n) {
    const LawStatus status =
      points->dim == 2 ? cloud_batch(2, in, first, n, PETSC_FALSE, &b) : cloud_batch(3, in, first, n, PETSC_FALSE, &b);
    if (status != LAW_OK) return status;
    batch_commit(in, &b, points);
  }
  return LAW_OK;
}
