/* A method: how nodes get their kinematics before the solve (phase a), and how the solution
 * moves nodes and points (phase c). Phase b, the solve itself, is shared by all. To add one: a
 * new file, and a line in methods.inc. */
#pragma once
#include "method/discretisation.h"

typedef struct Method {
  const char *name, *help;
  /* of these it has the first that goes with the case, unless that names one; the last always does */
  const char *bases[3];

  /* What it can. */
  /* points carry all motion, through a grid that stays; else nodes keep theirs */
  PetscBool restores_grid;
  /* nodes leave the cells that gave them: ModelToCloud; the functions at the end are needed then */
  PetscBool clouds;
  PetscBool takes_pressure; /* has it the mixed formulation? */

  /* Phase a, collective: sorted points, support, touched, mass, v, a. Called once before every
   * step, or when somebody asks for nodal fields before that; leaves points alone otherwise. */
  PetscErrorCode (*initialise)(Discretisation *space);
  /* Collective. What a step with inertia changes of v and a before its solve, undone if it is
   * not accepted. NULL: nothing. */
  PetscErrorCode (*begin)(Discretisation *space);
  /* Collective, in steps with inertia: v and a of prescribed dofs are those of the boundary now. What
   * the other nodes make of it, and impulse and lost_force; NULL: they go on, and what changed counts with
   * the mass of its node. */
  PetscErrorCode (*hold)(Discretisation *space);
  /* Phase c, collective: the step is accepted, du, v1 and a1 are known. State and F of the
   * points are committed already. */
  PetscErrorCode (*convect)(Discretisation *space);
  /* After initialise: does a node that material touches carry the tracer or carrier of this
   * rank? */
  PetscBool (*carries)(const Discretisation *space, const Points *followers, PetscInt p);
  /* Takes `own` away. NULL: there is none. */
  PetscErrorCode (*destroy)(Discretisation *space);

  /* Of clouds. Collective: groups of nodes that steps to come may couple, added to those that are
   * there. */
  PetscErrorCode (*couplings)(const Discretisation *space, NodeGroups *groups);
  /* Collective. Send nodes and points to ranks by where they are now. */
  PetscErrorCode (*redistribute)(Discretisation *space);
} Method;

extern const Method *const methods[]; /* ended by NULL */
const Method *method_find(const char *name);
/* Do its nodes and points fit the basis? */
PetscBool method_takes(const Method *method, const Basis *basis);
/* May implicit steps of the case have both? */
PetscBool method_transfers(const Case *c, const struct Transfer *transfer, const Basis *basis);
/* The basis of a case that names none. */
const char *method_basis(const Method *method, const Case *c);
/* Which basis the case has, and why if it did not name it: a line for people. */
void method_tell_basis(const Method *method, const Case *c, size_t size, char *text);
/* The same of the transfer, with the scheme that goes with it; no: nodes take no motion from points there. */
PetscBool method_tell_transfer(const Method *method, const Case *c, size_t size, char *text);
/* The same of a scheme that the method chose; no: it is the one that the case names, or that of all methods. */
PetscBool method_tell_scheme(const Method *method, const Case *c, size_t size, char *text);
