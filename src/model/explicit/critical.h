/* How short the substeps of explicit dynamics must be. */
#pragma once
#include "model/model.h"

/* Collective. The longest substep in which no wave crosses a cell, s, and the speed of the fastest point, m/s:
 * with moduli and stress of the points as they are now. */
PetscErrorCode ExplicitCritical(const Model *model, PetscReal *critical, PetscReal *fastest);
/* Share of it that the case takes. */
static inline PetscReal explicit_courant(const Case *c) { return c->analysis.courant > 0 ? c->analysis.courant : 0.6; }
