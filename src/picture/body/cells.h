/* Cells of a mesh as the files of states have them. */
#pragma once
#include "output/vtk/vtk_read.h"

#define CELL_MOST_CORNERS 8

/* Polygons that bound a cell in space, or that it is itself in the plane; -1 ends one of three corners. */
typedef struct {
  PetscInt n;
  const int (*face)[4];
} CellFaces;

/* Of a VTK type; n = 0 for those that are not drawn. */
CellFaces cell_faces(int vtk_type);

/* cell (n): in which cell each of n points (x 3) is, or next to which; -1: in none. Time and memory grow with the
 * numbers of both. */
PetscErrorCode CellsOfPoints(const VtkCells *cells, const PetscReal *node, PetscInt dim, PetscInt n, const PetscReal *x,
                             PetscInt *cell);
