/* Kinematics: how many dimensions a case has, and what strains where its nodes move.
 *
 * To add one, copy plane_strain.c and add its name to kinematics.inc: the case file then takes
 * its word. Kernels of all formulations are compiled for the plane, for the plane with a hoop,
 * and for space (formulation/sizes.h), so that nothing is asked inside the loop over points. */
#pragma once
#include <petscsys.h>

typedef struct Kinematics {
  const char *name, *help; /* word of the case file */
  PetscInt dim;            /* of positions and displacements */
  /* x is a radius, y the axis: a ring strains by u_x / x, and volumes go round the full circle */
  PetscBool hoop;
} Kinematics;

/* All kinematics, ended by NULL. */
extern const Kinematics *const kinematics_list[];
const Kinematics *kinematics_find(const char *name);
extern const Kinematics kinematics_plane_strain, kinematics_axisymmetric, kinematics_3d;

static inline PetscInt kinematics_dim(const Kinematics *k) { return k->dim; }

/* Does nothing strain along z? Then laws may take their plane path. */
static inline PetscBool kinematics_is_plane(const Kinematics *k) { return k->dim == 2 && !k->hoop; }

/* Volume per area of the plane (per volume in space) at radius x: the full circle, or a unit of
 * thickness. */
static inline PetscReal kinematics_weight(const Kinematics *k, PetscReal x) { return k->hoop ? 2 * PETSC_PI * x : 1; }
