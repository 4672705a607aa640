/* What bounds a body of whole cells in the beginning, in the plane: edges between their nodes. */
#pragma once
#include <petscsys.h>
#include "case/case.h"

typedef struct {
  PetscInt n;
  PetscReal (*edge)[4]; /* n x (x0 y0 x1 y1), m, in no order */
  /* edges by strips of equal height along y: strip k touches item[start[k]] to item[start[k + 1] - 1] */
  PetscInt n_strips, *start, *item;
  PetscReal bottom, height;
} Contour;

/* Of a case's bodies; without edges where the shape tells their outline, or nothing does. */
typedef struct PlotContours {
  PetscInt n;
  Contour *body;
} PlotContours;

/* Sort n edges, which are taken over, into strips. */
PetscErrorCode ContourCreate(PetscInt n, PetscReal (*edge)[4], Contour *contour);
/* Do the edges enclose x? Of edges that stand there twice, none counts. */
PetscBool contour_holds(const Contour *contour, const PetscReal *x);
/* Is there an edge nearer to x than this, m? */
PetscBool contour_near(const Contour *contour, const PetscReal *x, PetscReal distance);

/* Find the cells that bodies of a case in the plane are made of; gmsh runs where meshes are .geo files. Bodies of a
 * file that cannot be read any more have no edges. One process. NULL without a case, and in space. */
PetscErrorCode PlotContoursCreate(const Case *c, PlotContours **contours);
PetscErrorCode PlotContoursDestroy(PlotContours **contours);
