/* Which linear solver suits the problem: `linear: auto`.
 *
 * Measured (docs/experiments/linear-solvers.md): statics wants a direct solver as long as it is
 * small, in space much less long than in the plane; dynamics whose step is short beside the time a
 * wave takes through a cell has a matrix ruled by the mass, and conjugate gradients win. */
#pragma once
#include <petscksp.h>
#include "case/case.h"
#include "solve/system/system.h"

typedef struct {
  LinearChoice choice;
  PetscInt dim, unknowns;
  PetscReal pairs; /* of nodes that see each other, each with itself too */
  PetscInt block;  /* unknowns of a node */
  PetscBool symmetric, dynamic;
  PetscBool failing;      /* is it asked for the load, or the strength, at which material fails? */
  PetscBool levels;       /* has the grid coarse nodes (solve/levels)? */
  PetscBool mixed;        /* is the last unknown of every block a pressure? */
  PetscBool undetermined; /* mixed without stabilisation: some pressures may be anything */
  PetscBool idle_ranks;   /* does a rank hold no unknowns? */
  PetscBool multipliers;  /* are there constraints? then the matrix is not definite */
  PetscReal courant;      /* wave speed * dt / h */
  PetscReal memory;       /* of the machines, bytes; 0: not known */
  PetscInt room;          /* for factors beyond their estimate, percent; 0: as MUMPS has it */
} LinearProblem;

/* Bytes of a factorisation with all that goes with it, within about a tenth (docs/experiments/linear-solvers.md). */
PetscReal linear_factor_bytes(const LinearProblem *problem);
/* Is there room for it? */
PetscBool linear_factor_fits(const LinearProblem *problem);
/* Is that a factorisation? */
PetscBool linear_factorises(const LinearProblem *problem);
/* What that solver works on: blocks where our own conjugate gradients or BiCGStab run, values as they were gathered
 * where two levels of a box precondition, unless options ask PETSc for a solver of its own. */
PetscErrorCode LinearForm(const LinearProblem *problem, SystemForm *form);
/* Choose a solver, set it on ksp, whose operators are known (the options database still overrides
 * it); `what` gets a short name for the log. */
PetscErrorCode LinearConfigure(KSP ksp, const LinearProblem *problem, PetscBool *direct, const char **what);
/* Algebraic multigrid for displacements. */
PetscErrorCode LinearMultigrid(PC pc);
/* Collective. After the options were read and with the matrix of the system: what needs its
 * blocks. */
PetscErrorCode LinearRefine(KSP ksp, Mat matrix, const LinearProblem *problem);
