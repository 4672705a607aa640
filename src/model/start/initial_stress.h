/* A given stress as the state of a point's law. */
#pragma once
#include "model/model_private.h"

/* Beyond: the strength of the law does not allow it, and what it returns to is there instead. */
typedef enum { STRESS_CARRIED, STRESS_BEYOND, STRESS_REFUSED } StressOutcome;

/* Let point p, as it was seeded, carry the Cauchy stress sigma (6, Pa), and no other volume than that. */
StressOutcome stress_point(Points *points, PetscInt p, const Material *material, const PetscReal sigma[6]);
/* Does the strength of the law not allow sigma at point p? */
PetscBool stress_is_beyond(const Points *points, PetscInt p, const Material *material, const PetscReal sigma[6]);
/* The state of point p, whose volume was `before` times the undeformed one, has come to have the volume J:
 * its F and undeformed volume take that J, its undeformed domain, reach and face, too, so that it keeps the
 * volume, the domain and the surface that it has. */
void point_compress(Points *points, PetscInt p, PetscReal before, PetscReal J);
/* What the point knows of lengths in its undeformed state: domain, reach, corner, and face (in space by the square). */
void point_lengthen(Points *points, PetscInt p, PetscReal longer);
