/* Newmark's formulas, for schemes that are built on them (thesis eqs. 2.10-2.13).
 *
 * a1 = (du - dt v) / (beta dt^2) - (1 / (2 beta) - 1) a        v1 = v + dt ((1 - gamma) a +
 * gamma a1) */
#pragma once
#include "method/time/time_scheme.h"

TimeWeights newmark_weights(const AnalysisSpec *analysis, PetscReal dt);
void newmark_end(const AnalysisSpec *analysis, PetscReal dt, PetscInt n, const PetscReal *du, const PetscReal *v,
                 const PetscReal *a, PetscReal *v1, PetscReal *a1);
