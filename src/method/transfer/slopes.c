#include "method/transfer/slopes.h"
#include "base/math/tensor.h"
#include "method/transfer/loops.h"
#include "method/transfer/mass.h"

/* Rows of a point's gradients: of its velocity, and of its acceleration where no law yields. */
static PetscInt rows_of(const Discretisation *s, PetscInt dim)
{
  return materials_yield(s->c->n_materials, s->materials) ? dim : MOTIONS * dim;
}

/* sum += factor G x */
UNROLLED void add_linear(const PetscInt dim, PetscInt rows, PetscReal factor, const PetscReal *G, const PetscReal *x,
                         PetscReal *sum)
{
  for (PetscInt k = 0; k < rows; ++k)
    for (PetscInt d = 0; d < dim; ++d) sum[k] += factor * G[k * dim + d] * x[d];
}

/* The tie of a group, which holds its nodes to their mean: G is the mean of its points. */
UNROLLED void add_tied(const PetscInt dim, const PetscInt nn, PetscInt rows, const Discretisation *s, PetscReal tie,
                       const PetscInt *node, const PetscReal *G, PetscReal *sum)
{
  PetscReal mean[3] = {0, 0, 0}, from[3];
  for (PetscInt I = 0; I < nn; ++I)
    for (PetscInt d = 0; d < dim; ++d) mean[d] += s->grid->x[node[I] * dim + d] / (PetscReal)nn;
  for (PetscInt I = 0; I < nn; ++I) {
    for (PetscInt d = 0; d < dim; ++d) from[d] = s->grid->x[node[I] * dim + d] - mean[d];
    add_linear(dim, rows, tie, G, from, sum + node[I] * 2 * dim);
  }
}

UNROLLED void gather_slopes(const PetscInt dim, const PetscInt fixed_nn, const SupportRun *run, const Discretisation *s,
                            PetscReal *sum)
{
  const Support *w = s->support;
  const PetscInt rows = rows_of(s, dim);
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt nn = fixed_nn ? fixed_nn : support_nodes(w, g), *node = w->node + w->node_start[g];
    PetscReal mean[18] = {0}, mass = 0, from[3];
    if (s->lumping[g] == 0 && s->tie[g] == 0) continue;
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *N = w->N + w->value_start[g] + (p - w->point_start[g]) * nn, m = s->points->real[POINT_MASS][p];
      const PetscReal *G = point_real(s->points, POINT_SLOPE, p), *x = point_real(s->points, POINT_X, p);
      mass += m;
      for (PetscInt k = 0; k < 2 * dim * dim; ++k) mean[k] += m * G[k];
      for (PetscInt I = 0; I < nn; ++I) {
        for (PetscInt d = 0; d < dim; ++d) from[d] = s->grid->x[node[I] * dim + d] - x[d];
        add_linear(dim, rows, s->lumping[g] * m * N[I], G, from, sum + node[I] * 2 * dim);
      }
    }
    if (s->tie[g] > 0) add_tied(dim, nn, rows, s, s->tie[g] / mass, node, mean, sum);
  }
}

void slopes_gather(const Discretisation *s, PetscReal *sum) { WITH_SIZES(gather_slopes, s, s, sum); }

/* rows x dim: of the motion x of nodes, sum += factor x_I dN_I */
UNROLLED void add_gradient(const PetscInt dim, PetscReal factor, const PetscReal *x, const PetscReal *dN,
                           PetscReal *sum)
{
  for (PetscInt i = 0; i < dim; ++i)
    for (PetscInt j = 0; j < dim; ++j) sum[i * dim + j] += factor * x[i] * dN[j];
}

/* sum += m N x and m N v of the points. */
UNROLLED void gather_means(const PetscInt dim, const PetscInt fixed_nn, const SupportRun *run, const Discretisation *s,
                           PetscReal *sum)
{
  const Support *w = s->support;
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt nn = fixed_nn ? fixed_nn : support_nodes(w, g), *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *N = w->N + w->value_start[g] + (p - w->point_start[g]) * nn, m = s->points->real[POINT_MASS][p];
      const PetscReal *x = point_real(s->points, POINT_X, p), *v = point_real(s->points, POINT_V, p);
      for (PetscInt I = 0; I < nn; ++I)
        for (PetscInt d = 0; d < dim; ++d) {
          sum[node[I] * 2 * dim + d] += m * N[I] * x[d];
          sum[node[I] * 2 * dim + dim + d] += m * N[I] * v[d];
        }
    }
  }
}

#define FLATTEST 1e-3 /* of the means' stretch: of what is flatter the gradient is not asked */

/* A node's mean velocity is that of its mean place: where motion is linear G = grad v (grad x)^-1. Points that nodes
 * see only in the mean (transfer thesis) move linearly nowhere, and that would be their noise: they get grad v. */
UNROLLED void start_slopes(const PetscInt dim, const PetscInt fixed_nn, const SupportRun *run, Discretisation *s,
                           PetscBool linear, const PetscReal *mean)
{
  const Support *w = s->support;
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt nn = fixed_nn ? fixed_nn : support_nodes(w, g), *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *dN = w->dN + dim * (w->value_start[g] + (p - w->point_start[g]) * nn);
      PetscReal place[9] = {0}, speed[9] = {0}, stretch[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, inverse[9];
      PetscReal *G = point_real(s->points, POINT_SLOPE, p);
      for (PetscInt I = 0; I < nn; ++I) {
        add_gradient(dim, 1, mean + node[I] * 2 * dim, dN + I * dim, place);
        add_gradient(dim, 1, mean + node[I] * 2 * dim + dim, dN + I * dim, speed);
      }
      for (PetscInt k = 0; k < dim * dim && linear; ++k) stretch[3 * (k / dim) + k % dim] = place[k];
      for (PetscInt k = 0; k < MOTIONS * dim * dim; ++k) G[k] = 0;
      if (tensor_det(stretch) < FLATTEST) continue;
      tensor_inverse(stretch, inverse);
      for (PetscInt k = 0; k < dim * dim; ++k)
        for (PetscInt j = 0; j < dim; ++j) G[k / dim * dim + j] += speed[k] * inverse[3 * (k % dim) + j];
    }
  }
}

PetscErrorCode SlopesStart(Discretisation *s, PetscBool linear)
{
  const PetscInt width = 2 * s->grid->dim;
  const PetscReal *mass = s->nodes->mass;
  PetscReal *mean;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->grid->n_nodes * width, &mean));
  WITH_SIZES(gather_means, s, s, mean);
  PetscCall(GridSumToOwners(s->grid, width, mean));
  for (PetscInt i = 0; i < s->grid->n_owned * width; ++i) mean[i] = mass[i / width] > 0 ? mean[i] / mass[i / width] : 0;
  PetscCall(GridToGhosts(s->grid, width, mean));
  WITH_SIZES(start_slopes, s, s, linear, mean);
  PetscCall(PetscFree(mean));
  PetscFunctionReturn(0);
}

/* The gradients at the step's start are those with respect to places that dF moves on. Of the velocity's what no node
 * has seen stays, as a point's own velocity does, to the share in which it has energy. */
UNROLLED void give_slopes(const PetscInt dim, const PetscInt fixed_nn, const SupportRun *run, Discretisation *s)
{
  const Support *w = s->support;
  const NodalFields *n = s->nodes;
  const PetscInt square = dim * dim;
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt nn = fixed_nn ? fixed_nn : support_nodes(w, g), *node = w->node + w->node_start[g];
    const PetscReal lumped = s->lumping[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *dN = w->dN + dim * (w->value_start[g] + (p - w->point_start[g]) * nn);
      PetscReal moved[9] = {0}, dF[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, inverse[9], end[18] = {0};
      PetscReal *G = point_real(s->points, POINT_SLOPE, p);
      for (PetscInt k = 0; k < 2 * square; ++k) G[k] *= k < square ? lumped : 0;
      for (PetscInt I = 0; I < nn; ++I) {
        const PetscInt at = node[I] * dim;
        add_gradient(dim, 1, n->du + at, dN + I * dim, moved);
        add_gradient(dim, 1, n->v1 + at, dN + I * dim, end);
        add_gradient(dim, 1, n->a1 + at, dN + I * dim, end + square);
        add_gradient(dim, -lumped, n->v_points + at, dN + I * dim, G);
      }
      for (PetscInt k = 0; k < square; ++k) dF[3 * (k / dim) + k % dim] += moved[k];
      tensor_inverse(dF, inverse);
      for (PetscInt k = 0; k < 2 * square; ++k)
        for (PetscInt j = 0; j < dim; ++j) G[k / dim * dim + j] += end[k] * inverse[3 * (k % dim) + j];
    }
  }
}

void slopes_give(Discretisation *s) { WITH_SIZES(give_slopes, s, s); }
