/* One prescribed motion: its increment at a place, and where the things that it moves stood at the
 * start. */
#pragma once
#include "case/case.h"

/* Increment over [t0, t1] of a node that stands at x (dim), m. */
void motion_increments(const Case *c, const MotionSpec *m, const PetscReal *x, PetscReal t0, PetscReal t1,
                       PetscReal increment[3]);
/* In component d. */
PetscReal motion_increment(const Case *c, const MotionSpec *m, const PetscReal *x, PetscInt d, PetscReal t0,
                           PetscReal t1);
/* Of a rotation at time t: what has been turned since its start, rad. */
PetscReal motion_angle(const Case *c, const MotionSpec *m, PetscReal t);
/* X: where what stands at x at time t stood at the start, if it moves as prescribed; components
 * left free do not move. */
void motion_origin(const Case *c, const MotionSpec *m, const PetscReal *x, PetscReal t, PetscReal *X);
