/* PETSc's start, the same for the program and the library. */
#pragma once
#include <petscsys.h>

/* PetscInitialize with our memory (base/process/memory.h), and without the files petscrc and
 * .petscrc of the working directory and of the home: a folder from somebody else must not set
 * options, some of which load code. Options are read from argv and from PETSC_OPTIONS; argc and
 * argv may be NULL. */
PetscErrorCode StartPetsc(int *argc, char ***argv);
/* The file of options that is passed over, "" if there is none or the words for PETSc show that its
 * user knows. */
const char *start_unread_file(int argc, char **argv, char path[PETSC_MAX_PATH_LEN]);
