/* Bodies of revolution: x is the radius, y the axis. Pictures show the section on both sides of the
 * axis, or the body itself with a quarter cut out. */
#pragma once
#include <petscsys.h>

/* Was the run axisymmetric, as its case.yaml says? PETSC_FALSE where there is none. */
PetscErrorCode PlotIsRevolution(const char *run, PetscBool *is);

/* A section turned about its axis, seen by parallel rays. */
typedef struct {
  /* of the section: width x height x 4 from the lower left corner row by row, pixels of `pixel` m
   * squared, the axis at x = 0 */
  const unsigned char *section;
  int section_width, section_height;
  PetscReal section_min[2], pixel;
  PetscReal smooth; /* m: bumps of the surface up to this size are no shape of the body */
  /* Columns of a rotation: what right, up and towards the eye are of the axes in the plane (x, to
   * the one side, and z, to the eye's) and of the axis y. */
  PetscReal x[3], y[3], z[3];
  PetscReal min[2], max[2]; /* what the image shows, right and up, m */
  int width, height;        /* pixels */
} TurnedScene;

/* rgba: width x height x 4 as in RasterDraw. The quarter x > 0, z > 0 is cut out; light comes from
 * the upper left, in front. */
PetscErrorCode TurnedDraw(const TurnedScene *scene, unsigned char *rgba);
