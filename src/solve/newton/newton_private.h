/* Newton's own state, and what its parts ask of each other: for the files of newton*.c alone. */
#pragma once
#include "solve/newton/patches/eliminate.h"
#include "solve/newton/line_search.h"
#include "solve/newton/newton.h"
#include "solve/blocks/projection.h"
#include "solve/system/saddle.h"

struct Newton {
  MPI_Comm comm;
  NewtonSpec spec;
  SNES snes;
  Vec x, f;
  PetscInt built;    /* system->builds that snes was set up for */
  PetscReal courant; /* of the step that it was set up in */
  /* the preconditioner keeps something of earlier matrices: it is made anew for every solve */
  PetscBool learns;
  PetscBool spoilt; /* a factorisation of it has failed: PETSc would make no other */
  /* newton_forcing.c: does a preconditioner stay for several solves of this step? Solves since its set-up; is the
   * next one with it not the first? Iterations a digit of the first; the tolerance, and did the user set it? */
  PetscBool keeps;
  PetscInt solves;
  PetscBool stale;
  PetscReal rate, forcing;
  PetscBool asked_tolerance;
  PetscBool anew; /* one that stayed has failed in this step: all of it with set-ups of their own */
  /* system->builds whose solver was chosen with this courant before a checkpoint; -1: none */
  PetscInt remembered;
  LineSearchMemory search;
  Elimination elimination;
  Saddle saddle;
  PetscBool direct;
  /* does the linear solver keep constraints by projections? else by multipliers in its matrix */
  PetscBool projects;
  Projection *projection;
  PetscInt failures; /* of the iterative solver, not yet forgiven */
  PetscInt since;    /* steps since the last of them */
  PetscInt rescues;  /* solves of this step that a factorisation ended */
  PetscInt negative; /* NewtonReport.negative */
  PetscBool retry;   /* this try takes the direct solver */
  PetscBool calm;    /* did the first iteration of the last solve leave next to nothing (newton_fell)? */
  PetscBool idle;    /* was the last first guess the solution? */
  PetscInt room;     /* what LinearProblem calls so */
  const char *linear;
  StepProblem *problem;
  /* n_nodes x dim, what prescribed dofs have still to go at this assembly; NULL: nothing */
  const PetscReal *lift;
  NewtonReport *report;
  PetscBool asked;              /* did any rank want the run to end, at the last assembly? */
  PetscReal reaction, external; /* norms at the last assembly, N */
  /* norms of the residual one iteration ago, and two, N; before: 0 if there was none */
  PetscReal last, before;
  /* of multipliers in this solve (NodalForce.augment), and the iteration of the last one */
  PetscInt changes, changed;
  PetscReal *rigid;  /* of walls with mass: where the direction begins, and it: pairs */
  char loose[512];   /* what is told of one that nothing holds, or of nodes that nothing resists at */
  PetscBool tangent; /* do the system's values belong to du? */
  double t_points, t_matrix, t_linear, t_newton;
  double solving; /* when the linear solve that is going on began */
};

/* newton_setup.c. Everything made for one pattern of the system; does nothing if it is there
 * already. Times count as `matrix`. Collective. */
PetscErrorCode NewtonSetUp(Newton *n, StepProblem *p, const LinearProblem *linear);
PetscErrorCode NewtonReset(Newton *n);

/* newton_forcing.c. After a set-up; before every linear solve: its tolerance, and whether the preconditioner stays. */
PetscErrorCode NewtonForcingSetUp(Newton *n);
PetscErrorCode NewtonForcing(Newton *n);

/* newton_residual.c. Residual (and tangent values) at problem->du. A point that fails makes the
 * status of all ranks bad. Collective. */
PetscErrorCode NewtonAssemble(Newton *n, PetscBool tangent);
/* newton_augment.c. Multipliers nearer to what they shall be, and residual and tangent with them, at the du that
 * there is; *again: must the iteration go on? Collective. */
PetscErrorCode NewtonAugment(Newton *n, PetscBool *again);
/* Norms of reactions, those of walls too, and of external forces, over owned dofs. Collective. */
PetscErrorCode NewtonWeigh(Newton *n);
/* Values -> matrix; where constraints are projections they have no part in it. */
PetscErrorCode NewtonFillMatrix(Newton *n);
/* Forces of the last assembly -> residual; infinite if a point had failed. */
PetscErrorCode NewtonGetResidual(Newton *n, Vec f);
/* Vectors (n_nodes x dim) into the frames of their nodes, or out of them. */
void newton_turn(const StepProblem *p, PetscReal *vectors);
/* du and pressure -> unknowns. */
PetscErrorCode NewtonGetUnknowns(const Newton *n, Vec x);
/* Unknowns -> du and pressure, keeping what is prescribed. */
PetscErrorCode NewtonSetIncrements(Newton *n, Vec x);
/* Where no unknowns are, a step has no forces, and only what is prescribed moves. */
void newton_rest_without_unknowns(const StepProblem *p);
/* The same as SNES asks for it; context: the Newton. */
PetscErrorCode NewtonFunction(SNES snes, Vec x, Vec f, void *context);
PetscErrorCode NewtonJacobian(SNES snes, Vec x, Mat matrix, Mat preconditioner, void *context);

/* newton_trust.c. Has the iterative solver failed so often that the next step is left to a factorisation? */
PetscBool newton_distrusts(const Newton *n);
/* A try of the step has ended; the step has: `again`, after more than one of them. */
void newton_count_failure(Newton *n, const NewtonReport *report);
void newton_count_step(Newton *n, const NewtonReport *report, PetscBool again);
/* Collective. After a factorisation that failed: may the next one have more memory? */
PetscErrorCode NewtonLeaveMoreRoom(Newton *n, PetscBool *more);

/* newton_eliminate.c. May it, for this problem? And what the line search then does; context: the Newton. */
PetscBool newton_eliminates(const StepProblem *p, const LinearProblem *linear);
PetscErrorCode NewtonChoose(void *context, PetscInt iteration, Vec f, PetscReal norm);
PetscErrorCode NewtonSettle(void *context, Vec x);

/* newton_border.c. What the line search does where a load is unknown: to a direction that begins at x; to a
 * place along it, and to the one that is taken. */
PetscErrorCode NewtonBorderBegin(void *context, Vec x, Vec y);
void newton_border_place(void *context, PetscReal length);
void newton_border_end(void *context, PetscReal length);
/* Does the load do the work that it must do in this step? */
PetscBool newton_border_met(const Newton *n);

/* newton_rigid.c. The same of walls with mass; what a try begins with; do they balance? */
PetscErrorCode NewtonRigidBegin(Newton *n, Vec y);
void newton_rigid_place(const Newton *n, PetscReal length);
void newton_rigid_get(const Newton *n, PetscReal *q);
void newton_rigid_set(const Newton *n, const PetscReal *q);
/* Work that their residual still does along the direction, with the sign of that of the nodes; context: the Newton. */
PetscReal newton_rigid_work(void *context);
PetscBool newton_rigid_met(const Newton *n);
/* Why no solution was found, if it is that a wall with mass touches nothing in statics, or that something acts on it
 * where nothing resists; else NULL. */
const char *newton_rigid_reason(Newton *n);

/* newton_loose.c. The same, if it is that nothing resists at some nodes in statics. Collective. */
PetscErrorCode NewtonLooseReason(Newton *n, const char **reason);
/* The same, of an increment that is out of all bounds: what it moves, and where. Collective. */
PetscErrorCode NewtonFarReason(Newton *n, const char **reason);

/* newton_converge.c. The norm below which a residual has converged, N. */
PetscReal newton_tolerance(const Newton *n);
/* Will this residual be the last? If it falls by the same factor once more it is
 * far below the tolerance: no tangent will be asked for. The first one is if the step before took no
 * iteration. */
PetscBool newton_is_last(const Newton *n);
/* newton_forcing.c. Did the last iteration leave so little that its tangent is good for another? Will the next one
 * leave so, so that no tangent need be made along with its residual? Does the tangent that there is stay? */
PetscBool newton_fell(const Newton *n);
PetscBool newton_will_keep(const Newton *n);
PetscBool newton_keeps(const Newton *n);
/* The convergence test of SNES; context: the Newton. Writes the report's residuals and its
 * reference. */
PetscErrorCode NewtonConverged(SNES snes, PetscInt it, PetscReal xnorm, PetscReal snorm, PetscReal fnorm,
                               SNESConvergedReason *reason, void *context);
/* Why it stopped, in words. */
const char *newton_reason(SNESConvergedReason reason, LawStatus status);
