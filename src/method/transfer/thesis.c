/* The transfer of the thesis (eqs. 2.6-2.9, and 2.16 as docs/theory.md corrects it): nodes take the
 * mean of their points by mass. */
#include "method/transfer/loops.h"
#include "method/transfer/transfer.h"

UNROLLED void gather_motion(const PetscInt dim, const PetscInt fixed_nn, const SupportRun *run, Discretisation *s)
{
  NodalFields *n = s->nodes;
  const Support *w = s->support;
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt nn = fixed_nn ? fixed_nn : support_nodes(w, g), *node = w->node + w->node_start[g];
    PetscReal momentum[3 * CLOUD_MAX_NODES], force[3 * CLOUD_MAX_NODES];
    for (PetscInt i = 0; i < nn * dim; ++i) momentum[i] = force[i] = 0;
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *v = point_real(s->points, POINT_V, p), *a = point_real(s->points, POINT_A, p);
      const PetscReal *N = w->N + w->value_start[g] + (p - w->point_start[g]) * nn;
      for (PetscInt I = 0; I < nn; ++I) {
        const PetscReal m = N[I] * s->points->real[POINT_MASS][p];
        for (PetscInt d = 0; d < dim; ++d) {
          momentum[I * dim + d] += m * v[d];
          force[I * dim + d] += m * a[d];
        }
      }
    }
    for (PetscInt I = 0; I < nn; ++I)
      for (PetscInt d = 0; d < dim; ++d) {
        n->v_points[node[I] * dim + d] += momentum[I * dim + d];
        n->a_points[node[I] * dim + d] += force[I * dim + d];
      }
  }
}

PetscErrorCode TransferSum(Discretisation *s)
{
  NodalFields *n = s->nodes;
  const PetscInt dim = s->grid->dim, dofs = s->grid->n_nodes * dim;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(n->v_points, dofs));
  PetscCall(PetscArrayzero(n->a_points, dofs));
  WITH_SIZES(gather_motion, s, s);
  PetscCall(GridSumToOwners(s->grid, dim, n->v_points));
  PetscCall(GridSumToOwners(s->grid, dim, n->a_points));
  PetscFunctionReturn(0);
}

PetscErrorCode TransferMean(Discretisation *s)
{
  NodalFields *n = s->nodes;
  const PetscInt dim = s->grid->dim;

  PetscFunctionBeginUser;
  PetscCall(TransferSum(s));
  for (PetscInt node = 0; node < s->grid->n_owned; ++node) {
    if (n->mass[node] == 0) continue;
    const PetscReal inverse = n->mass[node] > 1e-300 ? 1 / n->mass[node] : 0;
    for (PetscInt i = node * dim; i < (node + 1) * dim; ++i) {
      n->v_points[i] *= inverse;
      n->a_points[i] *= inverse;
    }
  }
  PetscCall(GridToGhosts(s->grid, dim, n->v_points));
  PetscCall(GridToGhosts(s->grid, dim, n->a_points));
  PetscFunctionReturn(0);
}

/* Points take the change of the nodes' velocity, measured from what the points had given them:
 * where the boundary stops a node, it stops its points too (eq. 2.16 as printed would let them keep
 * their velocity for ever; docs/theory.md). Rayleigh damping acts on all motion: on what nodes
 * carry through the balance, on the rest of a point's velocity, which no node sees, here. */
UNROLLED void give_change(const PetscInt dim, const PetscInt fixed_nn, const SupportRun *run, Discretisation *s)
{
  const Support *w = s->support;
  const NodalFields *n = s->nodes;
  const PetscBool fades = s->fade != 0;
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt nn = fixed_nn ? fixed_nn : support_nodes(w, g), *node = w->node + w->node_start[g];
    PetscReal change[3 * CLOUD_MAX_NODES], a1[3 * CLOUD_MAX_NODES];
    for (PetscInt I = 0; I < nn; ++I)
      for (PetscInt d = 0, k = I * dim, i = node[I] * dim; d < dim; ++d, ++k, ++i) {
        change[k] = n->v1[i] - n->v_points[i];
        a1[k] = n->a1[i];
      }
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *N = w->N + w->value_start[g] + (p - w->point_start[g]) * nn;
      PetscReal *v = point_real(s->points, POINT_V, p), *a = point_real(s->points, POINT_A, p);
      for (PetscInt d = 0; d < dim; ++d) {
        PetscReal gain = 0, acceleration = 0, seen = 0;
        for (PetscInt I = 0; I < nn; ++I) {
          gain += N[I] * change[I * dim + d];
          acceleration += N[I] * a1[I * dim + d];
          if (fades) seen += N[I] * n->v_points[node[I] * dim + d];
        }
        v[d] += fades ? gain - s->fade * (v[d] - seen) : gain;
        a[d] = acceleration;
      }
    }
  }
}

PetscErrorCode TransferGiveChange(Discretisation *s)
{
  PetscFunctionBeginUser;
  WITH_SIZES(give_change, s, s);
  PetscFunctionReturn(0);
}

static PetscErrorCode ThesisGather(Discretisation *s)
{
  PetscFunctionBeginUser;
  PetscCall(TransferMean(s));
  PetscCall(PetscArraycpy(s->nodes->v_mean, s->nodes->v_points, s->grid->n_nodes * s->grid->dim));
  PetscFunctionReturn(0);
}

/* Free nodes stay as they are. */
static PetscErrorCode ThesisHold(Discretisation *s)
{
  PetscFunctionBeginUser;
  discretisation_impulses(s);
  PetscFunctionReturn(0);
}

const Transfer transfer_thesis = {
  .name = "thesis",
  .help = "nodes take the mean of their points by mass: smooth, but rotation and energy are lost",
  .keeps_velocity = PETSC_TRUE,
  .gather = ThesisGather,
  .hold = ThesisHold,
  .give = TransferGiveChange,
};
