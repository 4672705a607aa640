/* PETSc's matrix of a System, row by row. Its pattern is that of node pairs, so one place says where all numbers of
 * a pair go: 4 bytes a pair, where a list of single numbers (MatSetValuesCOO) keeps 16 for each of them. */
#pragma once
#include "solve/system/forms/shared_rows.h"

typedef struct Assembled {
  Mat own, others;   /* of this rank's rows: columns that it owns, and those of others (NULL on one rank) */
  SharedRows shared; /* pairs that other ranks assemble for rows of this one */
  PetscReal *incoming;
  MPI_Datatype pair;
  /* of pairs of owned rows, then of incoming ones: where their first number stands among the values of `own`, or
   * -1 - place among those of `others` */
  PetscInt *place;
} Assembled;

/* Collective. Of the system's pattern, which must live on. */
PetscErrorCode AssembledCreate(const System *system, Assembled **assembled, Mat *matrix);
/* Collective. The system's values -> matrix. */
PetscErrorCode AssembledFill(Assembled *assembled, const System *system, Mat matrix);
PetscErrorCode AssembledDestroy(Assembled **assembled);
