/* Scripts of Gmsh from somebody else: one that acts on the system is refused before Gmsh sees
 * it. */
#pragma once
#include "base/diag/diag.h"

/* Read a .geo, what Gmsh reads with it (its options beside it, files named in Include and Merge,
 * and those that these name), and tell of the first thing that runs programs, writes files or
 * cannot be told, with its file, line and column. Not collective. PETSC_TRUE in *safe: nothing was
 * found. */
PetscErrorCode GeoCheck(const char *path, Diag *diag, PetscBool *safe);
