/* The background grid, or the mesh. */
#pragma once
#include "case/kinematics/kinematics.h"

typedef enum { CELL_TRIANGLE, CELL_QUADRILATERAL, CELL_TETRAHEDRON, CELL_HEXAHEDRON } CellType;
typedef enum { DIAGONAL_RIGHT, DIAGONAL_LEFT, DIAGONAL_ALTERNATING, DIAGONAL_CROSSED } Diagonal;
typedef enum { OUTSIDE_STOP, OUTSIDE_REMOVE, OUTSIDE_KEEP } OutsidePolicy;

typedef struct {
  char *name;
  PetscReal value;
} NamedValue;

typedef enum { GRID_BOX, GRID_MESH } GridKind;

typedef struct {
  GridKind kind;
  CellType cell;
  Diagonal diagonal;
  PetscReal min[3], max[3];
  PetscInt counts[3];    /* cells along each axis, resolved from `size` or `counts` */
  PetscReal grading[3];  /* size of the last cell over the first along each axis, 1 = uniform */
  char *mesh;            /* .msh or .geo, resolved against the folder of the case */
  PetscReal mesh_scale;  /* m for one unit of it; 0 stands for 1 */
  PetscInt n_parameters; /* numbers handed to a .geo */
  NamedValue *parameters;
  OutsidePolicy outside;
  /* may a .geo run programs and write files? Said on the command line, never in the case file */
  PetscBool trusted;
} GridSpec;
