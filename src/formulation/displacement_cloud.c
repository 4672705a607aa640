/* Displacement formulation of points with a cloud of nodes each, as many as the basis chose.
 *
 * Nothing is gathered per group, so a point's blocks go straight into the matrix values, in either
 * precision. The innermost unit is one block of a pair of nodes: with S_l[I] = sum_j g_j[I] modulus_jl,
 * which stays in registers along the row I, it is sum_l S_l[I] g_l[J] plus the mass. */
#include "formulation/displacement_cloud.h"
#include "formulation/kernels/cloud_kernels.h"

#define NUMBER PetscReal
#define FOUR Row4
#define EIGHT Row8
#define PRECISE(name) name##_double
#include "formulation/kernels/cloud_blocks.h"
#define NUMBER float
#define FOUR Single4
#define EIGHT Single8
#define PRECISE(name) name##_single
#include "formulation/kernels/cloud_blocks.h"

KERNEL void cloud_matrix(const int dim, const PetscBool hoop, const PetscBool half, const PetscInt *slot, CloudWork *w,
                         const WeakFormOutput *out)
{
  if (dim == 2 && out->singles) cloud_matrix_2d_single(hoop, half, slot, w, out->singles);
  else if (dim == 2) cloud_matrix_2d_double(hoop, half, slot, w, out->values);
  else if (out->singles) cloud_matrix_3d_single(half, slot, w, out->singles);
  else cloud_matrix_3d_double(half, slot, w, out->values);
}

KERNEL void cloud_point(const int dim, const PetscBool hoop, const WeakFormInput *in, const Batch *b, PetscInt k,
                        PetscInt slot, CloudWork *w, WeakFormOutput *out)
{
  const PetscInt p = b->first + k;
  const PetscReal volume = in->points->real[POINT_VOLUME][p];
  cloud_load(dim, hoop, in, p, b->dF + 9 * k, w);
  cloud_force(dim, hoop, in, b->s.tau + 6 * k, volume, w, out->force);
  if (w->soft > 0) cloud_hold(dim, in, w, out->force);
  if (!wants_tangent(out)) return;
  cloud_gradients(dim, hoop, w);
  for (int j = 0; j < gradient_rows(dim, hoop); ++j)
    cloud_moduli(dim, gradient_rows(dim, hoop), j, b->s.tau + 6 * k, b->s.c + 36 * k, volume, w->modulus[j]);
  if (in->half) cloud_matrix(dim, hoop, PETSC_TRUE, out->slot + slot, w, out);
  else cloud_matrix(dim, hoop, PETSC_FALSE, out->slot + slot, w, out);
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
    if (!batch_is_good(&b, batch_update(dim, nn, hoop, in, wants_tangent(out), &b), out)) return;
    for (PetscInt k = 0; k < b.n; ++k) {
      cloud_point(dim, hoop, in, &b, k, slot, &w, out);
      slot += w.nn * w.nn;
    }
  }
}

CLOUD_SIZES(SIZED_KERNELS)

const SizedKernels displacement_cloud_kernels[] = {CLOUD_SIZES(SIZED_ROW){0}};
