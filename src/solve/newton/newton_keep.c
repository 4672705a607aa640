/* A tangent stays for the next iteration where another would hardly bring more (docs/theory.md, section 70). What is
 * kept depends on this step's residuals, and on one bit of the step before, which checkpoints hold. */
#include "solve/contact/contact.h"
#include "solve/newton/newton_private.h"

#define KEPT 1e-2 /* of the residual is left by an iteration whose tangent is good for one more */

/* In dynamics inertia rules the tangent, and with wide functions making one takes longer than several iterations. A
 * load or a wall that is one more unknown takes its directions as exact; what is eliminated reads tangents. */
static PetscBool may_stay(const Newton *n)
{
  const StepProblem *p = n->problem;
  const PetscBool bordered = p->border || (p->scene.contact && p->scene.contact->n_rigid > 0);
  return p->wide && p->in.inertia > 0 && !bordered && !n->elimination.any && !n->lift;
}

PetscBool newton_fell(const Newton *n) { return n->before > 0 && n->last <= KEPT * n->before; }

PetscBool newton_will_keep(const Newton *n)
{
  return may_stay(n) && n->last > 0 && (n->before > 0 ? newton_fell(n) : n->calm);
}

PetscBool newton_keeps(const Newton *n) { return !n->tangent && may_stay(n) && newton_fell(n); }
