/* How short the substeps of explicit dynamics must be, and whether they are quick. */
#pragma once
#include "model/model.h"

/* Collective. The critical substep, s, the time that a wave takes to cross a cell along all its axes, s, and the speed
 * of the fastest point, m/s: with moduli and stress of the points as they are now. */
PetscErrorCode ExplicitCritical(const Model *model, PetscReal *critical, PetscReal *crossing, PetscReal *fastest);
/* Do points find their functions by arithmetic, and are sorted once for many substeps? A substep costs a third then. */
PetscBool explicit_by_arithmetic(const Model *model);
