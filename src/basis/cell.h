/* Finite-element shape functions at a position of the reference cell, and where Gauss points sit.
 *
 * Reference cells: triangle (0,0) (1,0) (0,1); quadrilateral [-1,1]^2 counter-clockwise from
 * (-1,-1); tetrahedron (0,0,0) (1,0,0) (0,1,0) (0,0,1); hexahedron [-1,1]^3, bottom face
 * counter-clockwise as seen from above, then the top one (the order of VTK). */
#pragma once
#include "case/case.h"
#include "base/math/tensor.h"

#define CELL_MAX_NODES 8

typedef struct {
  const char *name, *help;
  PetscInt dim, nodes, faces, face_nodes;
  PetscReal reference_volume;
  PetscReal reference[CELL_MAX_NODES][3]; /* node positions */
  PetscInt face[6][4];                    /* nodes of each face, outward by the right-hand rule */
  int vtk_type;
} Cell;

extern const Cell cells[4]; /* indexed by CellType */

/* Shape functions N (nodes) and their reference gradients dN (nodes x dim) at xi. */
void cell_shape(CellType type, const PetscReal *xi, PetscReal *N, PetscReal *dN);

/* N and spatial gradients dNdx (nodes x dim) with node positions x (nodes x dim); returns det of
 * dx/dxi. */
PetscReal cell_gradients(CellType type, const PetscReal *x, const PetscReal *xi, PetscReal *N, PetscReal *dNdx);

/* Position (dim) of the reference position xi, with node positions x; and the same with det of dx/dxi. */
void cell_position(CellType type, const PetscReal *x, const PetscReal *xi, PetscReal *position);
PetscReal cell_map(CellType type, const PetscReal *x, const PetscReal *xi, PetscReal *position);

/* Reference position of `point`; PETSC_FALSE if the map could not be inverted. Affine cells
 * exactly, others by Newton. */
PetscBool cell_inverse_map(CellType type, const PetscReal *x, const PetscReal *point, PetscReal *xi);

/* How far xi lies outside the reference cell: <= 0 inside, in reference units. */
PetscReal cell_outside(CellType type, const PetscReal *xi);

PetscReal cell_volume(CellType type, const PetscReal *x);
/* Area of a side as a vector outwards, m2; in the plane its length, m. */
void cell_side_area(CellType type, PetscInt side, const PetscReal *x, PetscReal area[3]);
/* The volume that a cell stands for, m3: its area times the unit thickness, or all round the
 * circle. */
PetscReal cell_volume_in(const Kinematics *kinematics, CellType type, const PetscReal *x);
/* What of it belongs to each node (as many as the cell has), m3: the integral of N; of a cell that is not a ring the
 * same part to each, which is that of a simplex or parallelogram. */
void cell_shares_in(const Kinematics *kinematics, CellType type, const PetscReal *x, PetscReal *share);

/* Gauss rule with n points (triangle 1 3 6 12, quadrilateral 1 4 9 16, tetrahedron 1 4 14 24,
 * hexahedron 1 8 27 64): xi is n x dim, weights sum to the reference volume. PETSC_FALSE if there
 * is no such rule. */
PetscBool cell_quadrature(CellType type, PetscInt n, PetscReal *xi, PetscReal *weight);
/* The same number of points in the middle of equal parts of the cell, where the rule is a product of
 * `side` points a direction; 0 and nothing if it is none. */
PetscInt cell_lattice(CellType type, PetscInt n, PetscReal *xi, PetscReal *weight);
/* The numbers of points for which a rule exists, ended by 0. */
const PetscInt *cell_rules(CellType type);
