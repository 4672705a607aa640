/* What a MassSolve aims with along the lines of a box. */
#pragma once
#include "method/transfer/mass.h"

/* Is this a box whose ranks know the nodes beside theirs, as functions that are wider than a cell want it? */
PetscBool mass_lines_work(const Discretisation *space);
PetscErrorCode MassLinesCreate(const Grid *grid, MassLines **lines);
PetscErrorCode MassLinesDestroy(MassLines **lines);
/* Collective. Takes what the matrix has between neighbours; half: each pair once, a node first in its row. */
PetscErrorCode MassLinesUpdate(const Grid *grid, const MassPairs *half, MassLines *lines);
/* Collective. aim = D^-1 lack becomes nearly M^-1 lack, on owners; both are nodal arrays like x. */
PetscErrorCode MassLinesAim(MassSolve *solve, const MassLines *lines, PetscReal *spare, PetscReal *aim);
