/* Iterative solution of the mixed formulation's linear system, for problems too large to factorise.
 *
 * GMRES with a block triangular preconditioner: multigrid for the displacements, and for the
 * pressures the Schur complement's stand-in. In statics that is the mass matrix over G, lumped,
 * with the pressure's own stiffness; where inertia counts the complement is built with the diagonal
 * of the displacements' block in place of its inverse. */
#pragma once
#include "solve/system/linear.h"
#include "solve/system/system.h"

typedef struct {
  Mat schur; /* diagonal stand-in of the Schur complement; NULL in dynamics */
} Saddle;

/* Collective. Set the solver up on ksp, whose operators are the system's matrix. The near-null
 * space of the displacements is taken from the places of the nodes. */
PetscErrorCode SaddleConfigure(Saddle *saddle, KSP ksp, const System *system, const Grid *grid, PetscBool dynamic);
/* Collective. New numbers for the stand-in: per local node, owners count, positive, in units of the
 * pressure equation's diagonal. */
PetscErrorCode SaddleUpdate(Saddle *saddle, const System *system, const PetscReal *nodes);
PetscErrorCode SaddleClear(Saddle *saddle);
