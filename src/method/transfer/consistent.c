/* Nodes take the motion that has the momentum of the points by the mass matrix M of the balance, and
 * prescribed ones stop them with the least loss:
 *
 *   M v~ = sum_p N m_p v_p (+ slopes),    M_ff (v - v~)_f = - M_fc (v - v~)_c
 *
 * f free, c prescribed dofs; likewise a. So the work of the step's forces is what the points' energy
 * changes by (docs/theory.md, "What points and nodes hand each other"). */
#include "method/time/time_scheme.h"
#include "method/transfer/mass.h"
#include "method/transfer/slopes.h"
#include "method/transfer/transfer.h"

#define MAX_SWEEPS 200

/* Of what is lacking before the solve may be left; momentum does not depend on it. Without
 * lumped mass nodes that points hardly reach are nearly free, and what is left moves them most. */
static PetscReal tolerance_of(const Discretisation *s) { return s->points->components[POINT_SLOPE] ? 1e-6 : 1e-10; }

/* A scheme that looks back on no acceleration may have any. */
static PetscErrorCode WhatMayLack(MassSolve *c, PetscReal enough[MOTIONS])
{
  PetscFunctionBeginUser;
  PetscCall(MassLack(c, enough));
  for (int f = 0; f < MOTIONS; ++f) enough[f] *= PetscSqr(tolerance_of(c->s));
  if (time_scheme_of(&c->s->c->analysis)->middle) enough[ACCELERATION] = PETSC_MAX_REAL;
  PetscFunctionReturn(0);
}

/* From the means by mass. */
static PetscErrorCode ConsistentGather(Discretisation *s)
{
  NodalFields *n = s->nodes;
  PetscReal enough[MOTIONS];
  MassSolve c;

  PetscFunctionBeginUser;
  PetscCall(MassSolveCreate(s, &c));
  mass_keep(&c, &s->mass_rows);
  if (s->points->components[POINT_SLOPE]) slopes_gather(s, c.lack);
  PetscCall(GridSumToOwners(s->grid, c.width, c.lack));
  PetscCall(TransferSum(s));
  mass_pack(&c, n->v_points, n->a_points, c.product);
  for (PetscInt i = 0; i < s->grid->n_owned * c.width; ++i) c.lack[i] += c.product[i];
  PetscCall(WhatMayLack(&c, enough));
  PetscCall(MassSolveClose(&c));
  mass_unpack(&c, c.x, n->v_mean, n->a_points);
  PetscCall(MassSubtract(&c));
  PetscCall(MassSolveRun(&c, enough, MAX_SWEEPS));
  PetscCall(MassSolveClose(&c));
  mass_unpack(&c, c.x, n->v_points, n->a_points);
  PetscCall(MassSolveDestroy(&c));
  PetscFunctionReturn(0);
}

/* x = what prescribed dofs have changed by, 0 at the others, whatever an earlier try of the step has
 * left there; in the frames. */
static void changes_of_prescribed(MassSolve *c)
{
  const NodalFields *n = c->s->nodes;
  const unsigned char *fixed = c->s->boundary->fixed;
  mass_pack(c, n->v, n->a, c->x);
  mass_pack(c, n->v_points, n->a_points, c->product);
  for (PetscInt i = 0; i < c->size; ++i) c->x[i] -= c->product[i];
  mass_turn(c, c->x);
  for (PetscInt node = 0; node < c->s->grid->n_nodes; ++node)
    for (PetscInt d = 0; d < c->dim; ++d) {
      PetscReal *gone = fixed[node * c->dim + d] ? c->inverse : c->x;
      gone[mass_at(c, node, VELOCITY, d)] = gone[mass_at(c, node, ACCELERATION, d)] = 0;
    }
}

/* Has prescribed motion changed any node, on any rank? In flight it has not. */
static PetscErrorCode IsHeld(const Discretisation *s, PetscBool *held)
{
  const NodalFields *n = s->nodes;
  const PetscInt dim = s->grid->dim;
  PetscBool here = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt node = 0; node < s->grid->n_nodes && !here; ++node) {
    PetscBool fixed = PETSC_FALSE, other = PETSC_FALSE;
    for (PetscInt i = node * dim; i < (node + 1) * dim; ++i) {
      fixed |= s->boundary->fixed[i] != 0;
      other |= n->v[i] != n->v_points[i] || n->a[i] != n->a_points[i];
    }
    here = fixed && other;
  }
  PetscCallMPI(MPI_Allreduce(&here, held, 1, MPIU_BOOL, MPI_LOR, s->grid->comm));
  PetscFunctionReturn(0);
}

/* Nodes keep what their points gave them. */
static PetscErrorCode LetGo(Discretisation *s)
{
  NodalFields *n = s->nodes;
  const PetscInt dofs = s->grid->n_nodes * s->grid->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(n->v, n->v_points, dofs));
  PetscCall(PetscArraycpy(n->a, n->a_points, dofs));
  PetscCall(PetscArrayzero(n->impulse, dofs));
  PetscCall(PetscArrayzero(n->lost_force, dofs));
  PetscFunctionReturn(0);
}

/* No impulse acts on free nodes when prescribed ones are set to their motion. What the rows of the
 * others lack is the boundary's. */
static PetscErrorCode ConsistentHold(Discretisation *s)
{
  NodalFields *n = s->nodes;
  PetscReal enough[MOTIONS];
  MassSolve c;
  PetscBool held;

  PetscFunctionBeginUser;
  PetscCall(IsHeld(s, &held));
  if (!held) {
    PetscCall(LetGo(s));
    PetscFunctionReturn(0);
  }
  PetscCall(MassSolveCreate(s, &c));
  mass_keep(&c, &s->mass_rows);
  c.framed = PETSC_TRUE;
  changes_of_prescribed(&c);
  PetscCall(MassSubtract(&c));
  PetscCall(WhatMayLack(&c, enough));
  PetscCall(MassSolveRun(&c, enough, MAX_SWEEPS));
  PetscCall(MassSolveClose(&c));
  for (PetscInt i = 0; i < s->grid->n_owned; ++i)
    for (PetscInt k = 0; k < c.width; ++k)
      c.lack[i * c.width + k] = s->boundary->fixed[i * c.dim + k % c.dim] ? -c.lack[i * c.width + k] : 0;
  mass_turn(&c, c.x);
  mass_turn(&c, c.lack);
  mass_pack(&c, n->v_points, n->a_points, c.direction);
  for (PetscInt i = 0; i < c.size; ++i) c.x[i] += c.direction[i];
  mass_unpack(&c, c.x, n->v, n->a);
  mass_unpack(&c, c.lack, n->impulse, n->lost_force);
  PetscCall(MassSolveDestroy(&c));
  PetscFunctionReturn(0);
}

static PetscErrorCode ConsistentGive(Discretisation *s)
{
  PetscFunctionBeginUser;
  PetscCall(TransferGiveChange(s));
  if (s->points->components[POINT_SLOPE]) slopes_give(s);
  PetscFunctionReturn(0);
}

const Transfer transfer_consistent = {
  .name = "consistent",
  .help =
    "nodes take the momentum of their points by the mass matrix of the balance, points their gradient: rotation "
    "is kept, and most of the energy",
  .slopes = PETSC_TRUE,
  .gather = ConsistentGather,
  .hold = ConsistentHold,
  .give = ConsistentGive,
};
