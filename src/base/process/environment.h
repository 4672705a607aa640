/* The environment for a program that we start. */
#pragma once
#include <petscsys.h>

/* Our own without what the MPI launcher, or our own MPI, has left in it: the program would take
 * itself for a rank of ours. What the user set for MPI stays, unless a launcher started us. An
 * array ended by NULL, to be freed, of strings that stay where they are; room for `more` strings
 * behind them. */
PetscErrorCode EnvironmentForChild(PetscInt more, char ***out);
