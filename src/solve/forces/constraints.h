/* Linear constraints on nodal increments, sum_I N_I du_I = prescribed increment at a place, by
 * Lagrange multipliers.
 *
 * Each constraint has a node of its own, the twin, whose unknowns mu are the multipliers over
 * `scale`: the system stays one of nodes and symmetric. The force on the body, scale N_I mu at its
 * nodes and scale mu in all, is the reaction. */
#pragma once
#include "solve/system/system.h"

typedef struct Constraints {
  PetscInt dim, n, capacity, capacity_nodes;
  PetscInt *start;     /* n + 1 */
  PetscInt *node;      /* cloud of constraint k: node[start[k]] .. , local */
  PetscReal *N;        /* of each node, dim numbers: nodes may be left out along an axis */
  PetscInt *at, *twin; /* the node whose motion is prescribed, and its twin */
  PetscInt *slot;      /* per node of each cloud: pair (node, twin), pair (twin, node) */
  /* N/m: brings multipliers and gaps to the size of the other unknowns and forces */
  PetscReal scale;
} Constraints;

PetscErrorCode ConstraintsCreate(PetscInt dim, Constraints **constraints);
PetscErrorCode ConstraintsDestroy(Constraints **constraints);
/* Forget all, and append one. */
void constraints_clear(Constraints *constraints);
PetscErrorCode ConstraintsAdd(Constraints *constraints, PetscInt at, PetscInt twin, PetscInt nn, const PetscInt *node,
                              const PetscReal *N);
/* Leave out, along each axis, nodes that are neither touched (n_nodes) nor held (n_nodes x dim) there; the rest of the
 * cloud is the field. */
void constraints_leave_out(Constraints *constraints, const unsigned char *touched, const unsigned char *held);
/* Places of the pairs in the system's pattern; PETSC_FALSE if it lacks any. */
PetscBool constraints_find_slots(Constraints *constraints, const System *system);
/* One sweep that brings the field of v nearer to `target` at the constrained places, by the
 * coefficients of the constrained nodes alone. Each takes its gap over the share of all held nodes,
 * not over its own: slower, but it does not swing up where a node has less of the field than its
 * neighbours. Dofs with held[] only (of the constrained nodes). correction: as long as v, zero at
 * call and return. */
void constraints_relax(const Constraints *constraints, const unsigned char *held, const PetscReal *target, PetscReal *v,
                       PetscReal *correction);
