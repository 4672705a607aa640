/* Newton's method on one step, through PETSc SNES.
 *
 * Residual and tangent come from the same pass over the points. Full steps, halved only where a
 * point would be turned inside out: from rest a good iteration lets the residual grow by two orders
 * before it falls (docs/decisions.md). */
#pragma once
#include <petscsnes.h>
#include "formulation/formulation.h"
#include "solve/forces/nodal_force.h"
#include "solve/system/linear.h"
#include "solve/system/system.h"

#define NEWTON_HISTORY 64

/* A load whose factor is one more unknown, and the work that it must do in the step: increments by which it
 * is raised follow from displacements, so that the load may stand still or fall (newton_border.c). */
typedef struct {
  const PetscReal *load; /* n_nodes x dim, N per unit of its factor, in the frames of the nodes; owners count */
  PetscReal start;       /* factor of it that stands in `external` */
  PetscReal factor;      /* in: first guess; out: solution */
  PetscReal work;        /* load . du that the step must bring, J */
  /* load . du for a factor of 1 at the first tangent, J: work is a share of it if unit is 0 */
  PetscReal unit;
  PetscReal lacks; /* share of the work that is still lacking */
  PetscReal from, along;
  /* of a load that follows the surface: its forces are assembled with the others, for the time `time` + factor;
   * `load` are those of the step's start */
  PetscBool follows;
  PetscReal time;
} LoadBorder;

/* The step to be solved; arrays are n_nodes x dim over local nodes. */
typedef struct {
  const Grid *grid;
  System *system;
  const Formulation *formulation;
  const NodalForces *forces; /* all that act besides stress; the dead ones stand in external */
  NodalScene scene;          /* for them, at the end of the step */
  WeakFormInput in;          /* du and pressure are set here by Newton */
  /* prescribed, or on a node that no material touches; in the frames of the nodes, like
   * prescribed (boundary.h) */
  const unsigned char *fixed;
  const PetscReal *prescribed; /* increment of fixed dofs, m */
  /* dead nodal forces, N, in the frames of the nodes; owners' values count */
  const PetscReal *external;
  PetscReal *du; /* in: first guess; out: solution */
  /* out: residual with the rows of fixed dofs: reactions, on owners */
  PetscReal *force;
  /* mixed: n_nodes, like du; m, see WeakFormInput. NULL: displacements alone, as the next two */
  PetscReal *pressure;
  PetscReal *volume;         /* mixed: n_nodes, residual of the pressure equation, N */
  const unsigned char *idle; /* mixed: n_nodes, no material touches the node: no pressure there */
  LoadBorder *border;        /* NULL: all loads are known */
  /* does somebody want the run to end? asked on every rank; NULL: nobody ever does */
  PetscBool (*asked)(void);
  /* Matter that yields, and waves that cross many cells in the step: points all over it open and close between
   * two iterations, and none shortens the step of all (docs/theory.md, "Stiff matter that yields"). So is what is
   * pressed to its limit. */
  PetscBool stiff;
  /* Has strength fallen since the last step? What yields does so at the first guess already, and the first direction
   * is not an elastic one, but may go as far as any (docs/theory.md, "Factor of safety"). */
  PetscBool weaker;
  PetscReal enough; /* a residual that is small enough whatever the case asks for, N; 0: none is */
  PetscBool grips;  /* does the first guess go along with walls, whatever friction bears? */
  /* Do points see more nodes than those of a cell? Then a tangent takes many times as long as a residual. */
  PetscBool wide;
  /* what the last digit of a coordinate makes of the force at a node, N */
  PetscReal round_off;
  /* Norms of nodal gravity, of the inertia that would stop the motion and of the present one, N:
   * scales. */
  PetscReal weight, inertia, motion;
} StepProblem;

typedef struct {
  PetscBool converged;
  PetscBool interrupted; /* somebody asked, on any rank, before it converged */
  PetscInt iterations, linear_iterations;
  PetscInt tangents; /* that were made for them: one may stay for several (docs/theory.md, section 70) */
  /* iterations before them, until the iterative linear solver failed */
  PetscInt lost;
  /* |R| / reference after each iteration; [0] at the first guess */
  PetscReal residual[NEWTON_HISTORY];
  PetscReal reference; /* N */
  const char *reason;  /* why it stopped, in words */
  LawStatus status;
  PetscInt bad_point; /* local, of that status; -1 */
  /* ways in which the last tangent that was factorised as a symmetric one is negative: an equilibrium in which nothing
   * stays, if there are any; -1 where nobody knows */
  PetscInt negative;
} NewtonReport;

typedef struct Newton Newton;

PetscErrorCode NewtonCreate(MPI_Comm comm, const NewtonSpec *spec, Newton **newton);
PetscErrorCode NewtonDestroy(Newton **newton);
/* Collective. Solve; du and force hold the solution only if report->converged. */
PetscErrorCode NewtonSolve(Newton *newton, StepProblem *problem, const LinearProblem *linear, NewtonReport *report);
/* Collective. |R| over all unknowns at problem->du, N; PETSC_MAX_REAL where a law fails. */
PetscErrorCode NewtonMiss(Newton *newton, StepProblem *problem, PetscReal *norm);
/* What Newton's method remembers from step to step: which linear solver it chose when the pattern
 * was made, how often the iterative one failed, and whether the first iteration left next to nothing. */
typedef struct {
  PetscReal courant;        /* that the choice was made with; < 0: the next step chooses anew */
  PetscInt failures, since; /* of the iterative solver, and steps since the last */
  PetscBool calm;           /* did the first iteration of the last solve leave next to nothing? */
} NewtonMemory;

void newton_get_memory(const Newton *newton, const System *system, NewtonMemory *memory);
/* For a Newton that has solved nothing yet, and the pattern that the system has now. */
void newton_set_memory(Newton *newton, const System *system, const NewtonMemory *memory);
/* Back to what was remembered before a solve that is given up, on the same pattern. */
void newton_forget(Newton *newton, const System *system, const NewtonMemory *memory);
/* Name of the linear solver in use, for the log. */
const char *newton_linear_name(const Newton *newton);
/* Seconds spent so far: points and scatter, matrix filling, linear solves, and the rest of Newton's
 * method. */
void newton_times(const Newton *newton, PetscReal *points, PetscReal *matrix, PetscReal *linear, PetscReal *rest);
