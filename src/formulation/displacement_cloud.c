/* Displacement formulation of points with a cloud of nodes each, as many as the basis chose.
 *
 * Nothing is gathered per group, so a point's blocks go straight into the matrix values. The
 * innermost unit is one block of a pair of nodes: with T_j[J] = sum_l modulus_jl g_l[J], a block
 * is sum_j g_j[I] T_j[J] plus the mass, and in the plane it fills one register. */
#include "formulation/displacement_cloud.h"
#include "formulation/kernels/cloud_kernels.h"

/* In the plane a block is g_x[I] T_x[J] + g_y[I] T_y[J] + mass, four numbers at a time. */
KERNEL void cloud_matrix_2d(const PetscBool hoop, const PetscBool half, const PetscInt *slot, const CloudWork *w,
                            PetscReal *values)
{
  const int rows = gradient_rows(2, hoop);
  const PetscReal share = w->inertia * (1 - w->lumping);
  const Row4 diagonal = {1, 0, 0, 1};
  for (PetscInt I = 0; I < w->nn; ++I) {
    const Row4 mass = diagonal * (share * w->N[I]);
    Row4 g[3];
    for (int j = 0; j < rows; ++j) g[j] = diagonal * 0 + w->g[rows * I + j];
    for (PetscInt J = half ? I : 0; J < w->nn; ++J) {
      Row4 sum = g[0] * *(const Row4 *)(w->T + J * 4);
      for (int j = 1; j < rows; ++j) sum += g[j] * *(const Row4 *)(w->T + (j * w->nn + J) * 4);
      *(Row4 *)(values + (size_t)slot[I * w->nn + J] * 4) += sum + mass * w->N[J];
    }
    *(Row4 *)(values + (size_t)slot[I * w->nn + I] * 4) += diagonal * (w->inertia * w->lumping * w->N[I]);
  }
}

/* In space a block has nine numbers: eight in a register, and the last. mass: of the diagonal. */
KERNEL void cloud_matrix_3d(const PetscBool half, const PetscInt *slot, const CloudWork *w, PetscReal *values)
{
  const PetscReal share = w->inertia * (1 - w->lumping);
  const Row8 diagonal = {1, 0, 0, 0, 1, 0, 0, 0};
  for (PetscInt I = 0; I < w->nn; ++I) {
    const PetscReal *g = w->g + 3 * I;
    for (PetscInt J = half ? I : 0; J < w->nn; ++J) {
      const PetscReal *x = w->T + J * 9, *y = x + w->nn * 9, *z = y + w->nn * 9;
      const PetscReal mass = share * w->N[I] * w->N[J] + (I == J ? w->inertia * w->lumping * w->N[I] : 0);
      PetscReal *block = values + (size_t)slot[I * w->nn + J] * 9;
      *(Row8 *)block += g[0] * *(const Row8 *)x + g[1] * *(const Row8 *)y + g[2] * *(const Row8 *)z + mass * diagonal;
      block[8] += g[0] * x[8] + g[1] * y[8] + g[2] * z[8] + mass;
    }
  }
}

KERNEL void cloud_matrix(const int dim, const PetscBool hoop, const PetscBool half, const PetscInt *slot,
                         const CloudWork *w, PetscReal *values)
{
  if (dim == 2) cloud_matrix_2d(hoop, half, slot, w, values);
  else cloud_matrix_3d(half, slot, w, values);
}

KERNEL void cloud_point(const int dim, const PetscBool hoop, const WeakFormInput *in, const Batch *b, PetscInt k,
                        PetscInt slot, CloudWork *w, WeakFormOutput *out)
{
  const Support *s = in->support;
  const PetscInt p = b->first + k;
  const PetscReal volume = in->points->real[POINT_VOLUME][p];
  cloud_load(in, p, w);
  cloud_gradients(dim, hoop, s->dN + s->value_start[p] * dim, *point_real(in->points, POINT_X, p), b->dF + 9 * k, w);
  cloud_force(dim, hoop, in, b->s.tau + 6 * k, volume, w, out->force);
  if (w->soft > 0) cloud_hold(dim, dim, in, out->slot + slot, w, out);
  if (!out->values) return;
  cloud_products(dim, hoop, b->s.tau + 6 * k, b->s.c + 36 * k, volume, w);
  if (in->half) cloud_matrix(dim, hoop, PETSC_TRUE, out->slot + slot, w, out->values);
  else cloud_matrix(dim, hoop, PETSC_FALSE, out->slot + slot, w, out->values);
}

KERNEL LawStatus batch_update(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in,
                              PetscBool tangent, Batch *b)
{
  (void)nn;
  for (PetscInt k = 0; k < b->n; ++k) cloud_increment(dim, hoop, in, b->first + k, b->dF + 9 * k);
  return batch_law(in, tangent, b);
}

KERNEL void assemble_points(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in,
                            const SupportRun *run, PetscInt slot, WeakFormOutput *out)
{
  Batch b;
  CloudWork w;
  batch_begin(run, in->support, PETSC_FALSE, &b);
  while (batch_next(in, &b)) {
    if (!batch_is_good(&b, batch_update(dim, nn, hoop, in, out->values != NULL, &b), out)) return;
    for (PetscInt k = 0; k < b.n; ++k) {
      cloud_point(dim, hoop, in, &b, k, slot, &w, out);
      slot += w.nn * w.nn;
    }
  }
}

CLOUD_SIZES(SIZED_KERNELS)

const SizedKernels displacement_cloud_kernels[] = {CLOUD_SIZES(SIZED_ROW){0}};
