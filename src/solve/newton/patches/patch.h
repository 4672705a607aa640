/* Newton's method on a few nodes, while all others stay where they are: only the points around them
 * are asked. */
#pragma once
#include "solve/newton/newton.h"

typedef struct {
  PetscInt n, *node;         /* local nodes without frames whose groups are all on this rank */
  PetscInt n_groups, *group; /* all groups that hold one of them, ascending */
} Patch;

/* Solve for problem->du of these nodes until |F| at them is at most `enough`, N. If that does not
 * come about, du is left where |F| was least. place: n_nodes, -1 before and after; force: n_nodes x
 * dim of scratch. Only forces of stress, inertia and dead loads count. */
PetscErrorCode PatchSolve(const StepProblem *problem, const Patch *patch, PetscReal enough, PetscInt *place,
                          PetscReal *force);
