/* Projects of other programs as cases. */
#pragma once
#include <petscsys.h>
#include "base/diag/diag.h"

/* Not collective. Read the Kratos project at `path` (a folder with ProjectParameters.json, or that
 * file by whatever name) and write the folder `out`: case.yaml, grid.msh, body.msh and, if the
 * project knows its answers, reference.yaml. `out` NULL: a folder with the problem's name; it must
 * not be there. Mistakes, and what talus lacks, go to diag: then *folder is empty and nothing is
 * written. */
PetscErrorCode ImportKratos(const char *path, const char *out, Diag *diag, char folder[PETSC_MAX_PATH_LEN]);
