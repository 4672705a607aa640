/* Bodies that come in a mesh bring their velocity to its nodes: those that are theirs alone have it, and what is there
 * already meets it there as in an impact without rebound. */
#include "model/stage/stage_private.h"

/* Mass and momentum that they bring, kg and kg m/s, n_nodes x (1 + dim), on all copies. */
static PetscErrorCode SumBrought(const Model *m, const Case *from, PetscReal *brought)
{
  const Support *w = m->space->support;
  const PetscInt dim = m->dim, width = 1 + dim;
  PetscReal v[3];

  PetscFunctionBeginUser;
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      if (!body_comes(m->c, from, m->points->body[p])) continue;
      for (PetscInt I = 0; I < support_nodes(w, g); ++I) {
        const PetscInt node = w->node[w->node_start[g] + I];
        const PetscReal mass = support_N(w, g, p)[I] * m->points->real[POINT_MASS][p];
        body_velocity(&m->c->bodies[m->points->body[p]], dim, m->grid->x + node * dim, v);
        brought[node * width] += mass;
        for (PetscInt d = 0; d < dim; ++d) brought[node * width + 1 + d] += mass * v[d];
      }
    }
  PetscCall(GridSumToOwners(m->grid, width, brought));
  PetscCall(GridToGhosts(m->grid, width, brought));
  PetscFunctionReturn(0);
}

#define ALONE 1e-9 /* of a node's mass that was there before: none */

/* Momentum is kept; what was left at a node that no material had reached is none of it. */
static PetscErrorCode Meet(const Model *m, const PetscReal *brought)
{
  NodalFields *n = m->nodes;
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;

  PetscFunctionBeginUser;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    const PetscReal *brings = brought + node * (1 + dim), mass = n->mass[node];
    const PetscReal was = mass - brings[0] > ALONE * mass ? mass - brings[0] : 0;
    for (PetscInt d = 0, i = node * dim; d < dim && brings[0] > 0; ++d, ++i) {
      n->v[i] = (was * n->v[i] + brings[1 + d]) / (was + brings[0]);
      if (was == 0) n->a[i] = n->echo[i] = 0;
    }
  }
  PetscCall(GridToGhosts(m->grid, dim, n->v));
  PetscCall(GridToGhosts(m->grid, dim, n->a));
  PetscCall(GridToGhosts(m->grid, dim, n->echo));
  PetscCall(PetscArraycpy(n->v_points, n->v, dofs));
  PetscCall(PetscArraycpy(n->a_points, n->a, dofs));
  PetscFunctionReturn(0);
}

/* Points of cells at such nodes move with them. Kinetic energy that this took, J, on this rank. */
static PetscReal follow(const Model *m, const PetscReal *brought)
{
  const Support *w = m->space->support;
  const PetscInt dim = m->dim;
  PetscReal lost = 0;
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt nn = support_nodes(w, g), *node = w->node + w->node_start[g];
    PetscBool met = PETSC_FALSE;
    for (PetscInt I = 0; I < nn; ++I) met |= brought[node[I] * (1 + dim)] > 0;
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1] && met; ++p)
      for (PetscInt d = 0; d < dim; ++d) {
        PetscReal *v = point_real(m->points, POINT_V, p) + d, field = 0;
        for (PetscInt I = 0; I < nn; ++I) field += support_N(w, g, p)[I] * m->nodes->v[node[I] * dim + d];
        lost += 0.5 * m->points->real[POINT_MASS][p] * (PetscSqr(*v) - PetscSqr(field));
        *v = field;
      }
  }
  return lost;
}

PetscErrorCode BodiesBringMotion(Model *m, const Case *from)
{
  PetscReal *brought, lost, all;

  PetscFunctionBeginUser;
  if (m->method->restores_grid || m->method->clouds || stands_still(m)) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(m->grid->n_nodes * (1 + m->dim), &brought));
  PetscCall(SumBrought(m, from, brought));
  PetscCall(Meet(m, brought));
  lost = follow(m, brought);
  PetscCall(MPIU_Allreduce(&lost, &all, 1, MPIU_REAL, MPI_SUM, m->comm));
  m->transfer_energy += all;
  PetscCall(PetscFree(brought));
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesBeginAcceleration(Model *m, const Case *from)
{
  NodalFields *n = m->nodes;
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  PetscReal *brought, *a, *lacks, size;

  PetscFunctionBeginUser;
  if (m->balanced || m->method->restores_grid || m->method->clouds) PetscFunctionReturn(0);
  if (!accelerations_go_on(m->c, from)) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(m->grid->n_nodes * (1 + dim), &brought));
  PetscCall(PetscMalloc2(dofs, &a, dofs, &lacks));
  PetscCall(SumBrought(m, from, brought));
  PetscCall(BalancedAcceleration(m, a, lacks, &size));
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) {
    const PetscReal brings = brought[i / dim * (1 + dim)], mass = n->mass[i / dim];
    if (brings > 0 && mass - brings <= ALONE * mass) n->a[i] = a[i];
  }
  PetscCall(GridToGhosts(m->grid, dim, n->a));
  PetscCall(PetscArraycpy(n->a_points, n->a, dofs));
  PetscCall(PetscFree2(a, lacks));
  PetscCall(PetscFree(brought));
  PetscFunctionReturn(0);
}
