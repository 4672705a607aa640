/* Faces: their quadrature, and the boundary of a body made of whole cells. */
#pragma once
#include "points/points.h"

#define FACE_MAX_POINTS 4

typedef struct {
  PetscReal x[3], xi[3]; /* position, and reference position in the cell */
  PetscReal area;        /* weight, m2: an edge is as thick as one, or goes round the circle */
  PetscReal vector[3];   /* area times the unit normal out of the cell */
  PetscReal edge[2][3];  /* half edges of the piece in whose middle it stands, m; 0 for points of a quadrature */
} FacePoint;

/* Gauss points of a side of a cell (2 on an edge, 3 on a triangle, 4 on a quadrilateral); returns
 * how many. */
PetscInt face_quadrature(const Kinematics *kinematics, const Grid *grid, PetscInt cell, PetscInt side, FacePoint *q);

/* Parts of such a side, of an edge or a quadrilateral that is a parallelogram: halves, quarters. */
PetscInt face_pieces(const Kinematics *kinematics, const Grid *grid, PetscInt cell, PetscInt side, FacePoint *q);

/* Collective. Faces between the cells that hold points of the body and all others, as far as the
 * selector's coordinates and shape take all their nodes, and its boundary is what they are of; cut: those that the
 * coordinates and the shape take in part (cut_sides.h). */
PetscErrorCode BodyFaces(const Grid *grid, const Points *points, PetscInt body, const Selector *on, PetscBool cut,
                         PetscInt *n, PetscInt **cell, PetscInt **side);
