/* The cases that came with the program: folders with a case.yaml. */
#pragma once
#include <petscsys.h>

/* Name of case i in the order of the alphabet; PETSC_FALSE behind the last, or if none are found.
 * Not collective. */
PetscBool installed_case(int i, char name[128]);
/* The folder that holds them; PETSC_FALSE if there is none, and `folder` is where it was looked for
 * last. $TALUS_CASES, share/talus/cases beside the program's folder, cases above it. */
PetscBool installed_folder(char folder[PETSC_MAX_PATH_LEN]);
