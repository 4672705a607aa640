/* The free surface of a body in two dimensions: height over x, from the volume of its points.
 *
 * Each point shares its volume between the two nearest stations by linear weights, so that the profile integrates to the volume of the body's
 * material (J at most 1) exactly and does not jump when a point crosses a station. Stations stand one cell apart from the grid's lowest x on. */
#pragma once
#include "model/model.h"

typedef struct {
  PetscInt n;
  PetscReal x0, dx;  /* station i stands at x0 + i dx, m */
  PetscReal *height; /* n, m of solid material above the station */
} SurfaceProfile;

/* Collective. body < 0: all. */
PetscErrorCode SurfaceProfileCreate(const Model *model, PetscInt body, SurfaceProfile *profile);
PetscErrorCode SurfaceProfileDestroy(SurfaceProfile *profile);

/* Height at x, linear between stations. */
PetscReal surface_height(const SurfaceProfile *profile, PetscReal x);
/* The farthest x at which the surface is still half a station spacing high. */
PetscReal surface_front(const SurfaceProfile *profile);
/* Angle (rad, positive if it falls towards +x) of the line fitted by least squares to the surface between 20 % and 80 % of the way from its
 * highest station to the front. */
PetscReal surface_slope(const SurfaceProfile *profile);
