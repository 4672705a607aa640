/* What acts on nodes besides stress: loads, constraints; walls, springs, pressures that follow. To
 * add one: a file with its table, and a line in nodal_forces.inc. The model makes the list of those
 * that a case asks for, and Newton's method walks it. */
#pragma once
#include "boundary/loads.h"
#include "material/law.h"
#include "solve/forces/constraints.h"

/* Body force per mass of n points at time t, m/s2, besides gravity: a centrifuge, a manufactured
 * solution. X, x: undeformed and present positions, m; b: result, zero on entry; n x 3 each, in the
 * plane too. */
typedef void (*BodyForce)(void *context, PetscInt n, const PetscReal *X, const PetscReal *x, PetscReal t, PetscReal *b);

/* The body as these forces see it; arrays go over local nodes. */
typedef struct {
  const Case *c;
  const Grid *grid;
  const Points *points;
  const Support *support;
  const PetscInt *seen; /* the point of each of its groups, where it has some points alone; NULL: all */
  /* n_cells, n_nodes: does material fill the cell, and reach the node? */
  const unsigned char *filled, *touched;
  /* n_nodes x dim: prescribed, or on a node that no material touches */
  const unsigned char *fixed;
  /* n_nodes x dim: increments over the step of what is prescribed, m */
  const PetscReal *prescribed;
  /* n_nodes x dim: increments since the start of the step, m */
  const PetscReal *du;
  const PetscReal *soft; /* per group, see WeakFormInput */
  PetscReal t;           /* with these increments, s */
  /* increments of the whole step over du, and its end, s: of schemes that balance in the middle */
  PetscReal whole, end;
  PetscBool first;  /* is it the first step of all? */
  PetscBool moves;  /* does matter resist by inertia? */
  PetscBool passes; /* does matter go through cells, or points of a cloud, that stay? */
  PetscBool stays;  /* is the step's motion forgotten with it, so that surfaces stay as they are, too? */
  const Material *materials;
  /* Basis.bends of point p, on its n nodes in the support, n x dim; PETSC_FALSE: they do not. NULL: nor do others. */
  PetscBool (*bends)(const void *context, PetscInt p, PetscInt n, PetscReal *bend);
  const void *bends_context;
  struct Contact *contact; /* NULL: there are no walls */
  const Loads *loads;
  Constraints *constraints; /* NULL: prescribed motion is that of the nodes themselves */
  BodyForce body_force;     /* NULL: none */
  void *body_force_context;
} NodalScene;

/* What the caller's body force, which there is, gives the points of this rank: n x 3, zero on entry, m/s2. */
PetscErrorCode BodyForceAsk(const NodalScene *scene, PetscReal *b);

/* Where forces go. The sum over ranks comes later: a node that several ranks know gets its force
 * from one of them. */
typedef struct {
  PetscReal *force; /* residual, n_nodes x dim, N: what pushes a node is subtracted */
  System *system;   /* gets the tangent; NULL: forces alone */
  PetscBool away;   /* both are taken out again, not put in: of what has multipliers */
} NodalOutput;

/* One kind of such forces; functions may be NULL but for create and assemble. */
typedef struct {
  const char *name, *help;
  /* the same whatever du is: gathered once in a step, and its norm scales the residual */
  PetscBool dead;
  /* their work has an account of its own (model/contact/contact.c; dead: that of what holds,
   * model/measure/energy/energy.c) */
  PetscBool apart;
  /* Collective. *data stays NULL where the case asks for nothing of the kind; the user's mistakes
   * go to diag (NULL: sought before). */
  PetscErrorCode (*create)(const NodalScene *scene, Diag *diag, void **data);
  PetscErrorCode (*destroy)(void **data); /* NULL: data belongs to others */
  /* Points and their nodes are known: what a step starts with, before find_slots. */
  PetscErrorCode (*begin)(void *data, const NodalScene *scene);
  /* Mark the dofs (n_nodes x dim) that it holds in place as well as a boundary could. */
  void (*hold)(const void *data, const NodalScene *scene, unsigned char *held);
  /* Append the groups of nodes that it couples beyond those of the support, by NodeGroupsAdd: the
   * system gets their pairs. */
  PetscErrorCode (*couple)(const void *data, const NodalScene *scene, NodeGroups *groups);
  /* The support or the system's pattern is new: find slots; PETSC_FALSE if the pattern lacks
   * any. */
  PetscBool (*find_slots)(void *data, const System *system);
  /* Collective. Add forces and, through nodal_add_tangent, what they change by with du. */
  PetscErrorCode (*assemble)(void *data, const NodalScene *scene, const NodalOutput *out);
  /* Collective. Newton's method has converged, for the change-th time: forces that are found by
   * multipliers bring them nearer to what they shall be, and say whether it must go on. */
  PetscErrorCode (*augment)(void *data, const NodalScene *scene, PetscInt change, PetscBool *again);
  /* Mark the nodes (n_nodes) that it may act on in this step: others may be settled without it. A force that lives and
   * does not say is taken to act everywhere. */
  void (*mark)(const void *data, unsigned char *node);
  /* Collective. The step is accepted: friction remembers; points have not moved yet. */
  PetscErrorCode (*commit)(void *data, const NodalScene *scene);
  /* Collective. What outlives a step, in tables of its own for checkpoints and new partitions, and
   * back into data just created. */
  PetscErrorCode (*to_tables)(const void *data, const NodalScene *scene, Tables *tables);
  PetscErrorCode (*from_tables)(void *data, const NodalScene *scene, const Tables *tables, char reason[256]);
  /* The linear constraints whose multipliers these forces are: a linear solver may keep them by
   * projections, and their work is that of the boundary. */
  const Constraints *(*constraints)(const void *data);
} NodalForce;

extern const NodalForce *const nodal_forces[]; /* ended by NULL */
extern const NodalForce nodal_force_loads, nodal_force_pressures, nodal_force_rest;

/* Slots (n x n) of the pairs of n local nodes; PETSC_FALSE if the pattern lacks any. */
static inline PetscBool nodal_find_slots(const System *system, PetscInt n, const PetscInt *node, PetscInt *slot)
{
  PetscBool all = PETSC_TRUE;
  for (PetscInt k = 0; k < n * n; ++k) {
    slot[k] = system_pair(system, node[k / n], node[k % n]);
    all = all && slot[k] >= 0;
  }
  return all;
}

/* Add d residual[row] / d du[column], for dofs node * dim + component of the pair of nodes at
 * `slot` of the system. What is prescribed is cut later. */
static inline void nodal_add_tangent(const NodalOutput *out, PetscInt dim, PetscInt slot, PetscInt row, PetscInt column,
                                     PetscReal value)
{
  if (!out->system) return;
  const PetscInt block = out->system->block, place = (slot * block + row % dim) * block + column % dim;
  if (out->away) value = -value;
  if (out->system->single) out->system->singles[place] += (float)value;
  else out->system->values[place] += value;
}

/* The same for all components of the pair of nodes at `slot`: `weight` times K, 3 numbers a row. */
static inline void nodal_add_tangents(const NodalOutput *out, PetscInt dim, PetscInt slot, PetscReal weight,
                                      const PetscReal *K)
{
  const System *system = out->system;
  if (!system) return;
  const PetscInt block = system->block, place = slot * block * block;
  if (out->away) weight = -weight;
  for (PetscInt k = 0; system->single && k < dim * dim; ++k)
    system->singles[place + k / dim * block + k % dim] += (float)(weight * K[3 * (k / dim) + k % dim]);
  for (PetscInt k = 0; !system->single && k < dim * dim; ++k)
    system->values[place + k / dim * block + k % dim] += weight * K[3 * (k / dim) + k % dim];
}

/* The forces of constraints; a component whose twin is fixed is none. */
void constraints_assemble(const Constraints *constraints, const NodalScene *scene, const NodalOutput *out);

/* Those that a case asks for, in the order of nodal_forces. */
typedef struct {
  PetscInt n;
  struct {
    const NodalForce *kind;
    void *data;
  } * one;
} NodalForces;

/* Collective. The list starts empty. */
PetscErrorCode NodalForcesCreate(const NodalScene *scene, Diag *diag, NodalForces *forces);
PetscErrorCode NodalForcesDestroy(NodalForces *forces);
PetscErrorCode NodalForcesCouple(const NodalForces *forces, const NodalScene *scene, NodeGroups *groups);
void nodal_forces_hold(const NodalForces *forces, const NodalScene *scene, unsigned char *held);
PetscBool nodal_forces_find_slots(const NodalForces *forces, const System *system);
/* NULL: there are none. */
const Constraints *nodal_forces_constraints(const NodalForces *forces);
/* Is it known of all that are not dead where they act? */
PetscBool nodal_forces_are_local(const NodalForces *forces);
/* node: n_nodes, zero on entry; 1 where one of them may act. */
void nodal_forces_mark(const NodalForces *forces, unsigned char *node);
/* Collective. All that are not dead, in every iteration. */
PetscErrorCode NodalForcesAssemble(const NodalForces *forces, const NodalScene *scene, const NodalOutput *out);
PetscErrorCode NodalForcesBegin(const NodalForces *forces, const NodalScene *scene);
/* Collective. Those alone that NodalForcesAugment changes. */
PetscErrorCode NodalForcesAssembleAugmented(const NodalForces *forces, const NodalScene *scene, const NodalOutput *out);
/* Collective. *again: does any of them want Newton's method to go on? */
PetscErrorCode NodalForcesAugment(const NodalForces *forces, const NodalScene *scene, PetscInt change,
                                  PetscBool *again);
/* Collective. Dead forces, and all others but those of constraints and walls if so asked, summed over ranks
 * with the sign of loads: n_nodes x dim, zero where others own the node. */
PetscErrorCode NodalForcesExternal(const NodalForces *forces, const NodalScene *scene, PetscBool all,
                                   PetscReal *external);
PetscErrorCode NodalForcesCommit(const NodalForces *forces, const NodalScene *scene);
PetscErrorCode NodalForcesToTables(const NodalForces *forces, const NodalScene *scene, Tables *tables);
PetscErrorCode NodalForcesFromTables(const NodalForces *forces, const NodalScene *scene, const Tables *tables,
                                     char reason[256]);
