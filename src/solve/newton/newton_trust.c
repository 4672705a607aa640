/* Which solver the next step begins with, from how often the iterative one has failed (docs/decisions.md, 329). All
 * depends on counts that checkpoints hold. */
#include "solve/newton/newton_private.h"

#define FAILURES 3        /* in a row: the direct solver takes over */
#define ISOLATED_AFTER 10 /* steps after which a failure of the iterative solver counts no more */
/* where failures followed each other: steps of the direct solver before the next chance, twice as many each time */
#define DIRECT_FIRST 2
#define DIRECT_MOST 64
/* solves that could be left to factors for what one costs that the iteration tried in vain */
#define RESCUE_COSTS 8
/* percent: LinearProblem.room */
#define FIRST_ROOM 100
#define MOST_ROOM 1000

/* Steps of the direct solver after the last failure: each costs as much as the linear iterations that failed. */
static PetscInt direct_steps(const Newton *n)
{
  if (n->failures < FAILURES) return 0;
  return PetscMin(DIRECT_MOST, DIRECT_FIRST << PetscMin(n->failures - FAILURES, 10));
}

PetscBool newton_distrusts(const Newton *n) { return (PetscBool)(n->since < direct_steps(n)); }

static PetscBool was_rescued_often(const Newton *n, const NewtonReport *report)
{
  return (PetscBool)(n->rescues * RESCUE_COSTS > report->iterations);
}

void newton_count_failure(Newton *n, const NewtonReport *report)
{
  if ((n->retry && !n->anew) || was_rescued_often(n, report)) ++n->failures, n->since = 0;
}

void newton_count_step(Newton *n, const NewtonReport *report, PetscBool again)
{
  if (again || was_rescued_often(n, report)) {
    n->built = -1;
  } else if (n->failures) {
    if (++n->since == direct_steps(n)) n->built = -1; /* iterate again */
    if (n->since >= direct_steps(n) + ISOLATED_AFTER) n->failures = n->since = 0;
  }
}

/* Spread over ranks, factors outgrow the estimate of their size now and then. */
PetscErrorCode NewtonLeaveMoreRoom(Newton *n, PetscBool *more)
{
  KSP ksp;
  PC pc;
  PCFailedReason why;

  PetscFunctionBeginUser;
  PetscCall(SNESGetKSP(n->snes, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCGetFailedReason(pc, &why));
  *more = n->direct && why == PC_FACTOR_OUTMEMORY && n->room < MOST_ROOM;
  if (*more) n->room = n->room ? 3 * n->room : FIRST_ROOM;
  PetscFunctionReturn(0);
}
