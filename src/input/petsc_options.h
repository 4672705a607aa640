/* Which options of PETSc a case file may set: those that choose a solver, set its tolerances or
 * print on the terminal.
 *
 * PETSc's options reach far: viewers write files, draw and open sockets, others load code or start
 * programs. A case file may come from anywhere, so what it may say is listed, not what it may not.
 * On the command line everything is allowed. */
#pragma once
#include <petscsys.h>

typedef enum {
  PETSC_OPTION_UNKNOWN, /* not for case files */
  PETSC_OPTION_VALUE,   /* a word, numbers, true, nothing */
  PETSC_OPTION_VIEW     /* something printed: nothing, true, or a format on the terminal */
} PetscOptionKind;

/* `name` without its dash; prefixes of solvers within solvers (sub_, mg_levels_1_, fieldsplit_0_)
 * may stand before. */
PetscOptionKind petsc_option_kind(const char *name);
/* Why this value may not stand in a case file; NULL if it may. */
const char *petsc_option_refusal(PetscOptionKind kind, const char *value);
/* The listed name nearest to this one, its prefixes taken off if need be; PETSC_FALSE if none is
 * near. */
PetscBool petsc_option_nearest(const char *name, char best[64]);
