/* How a voxel is cut into cells: quadrilaterals and hexahedra as they are, triangles by a diagonal,
 * tetrahedra by Kuhn.
 *
 * Kuhn's six tetrahedra follow the paths along the edges from the lowest corner to the highest one,
 * one for each order of the axes. All voxels are cut alike and opposite faces get the same
 * diagonal, so neighbours conform. */
#include "grid/box/box.h"

static const PetscInt quadrilateral[1][4] = {{0, 1, 3, 2}};
static const PetscInt hexahedron[1][8] = {{0, 1, 3, 2, 4, 5, 7, 6}};
static const PetscInt right[2][3] = {{0, 1, 3}, {0, 3, 2}};
static const PetscInt left[2][3] = {{0, 1, 2}, {1, 3, 2}};
static const PetscInt crossed[4][3] = {
  {0, 1, VOXEL_CENTRE}, {1, 3, VOXEL_CENTRE}, {3, 2, VOXEL_CENTRE}, {2, 0, VOXEL_CENTRE}};
/* Even orders of the axes run 0 -> first -> second -> 7; odd ones swap the middle two to keep the
 * volume positive. */
static const PetscInt kuhn[6][4] = {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 6, 4, 7}};

static PetscReal code_position(PetscInt code, PetscInt axis)
{
  return code == VOXEL_CENTRE ? 0.5 : (PetscReal)(code >> axis & 1);
}

/* Origin and inverse edge matrix of a simplex in the unit voxel. */
static void invert_simplex(PetscInt dim, const PetscInt *code, PetscReal origin[3], PetscReal inverse[9])
{
  PetscReal edges[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (PetscInt d = 0; d < dim; ++d) {
    origin[d] = code_position(code[0], d);
    for (PetscInt i = 0; i < dim; ++i) edges[3 * d + i] = code_position(code[i + 1], d) - origin[d];
  }
  (void)tensor_inverse(edges, inverse);
}

static void pattern_fill(VoxelPattern *pattern, PetscInt n_cells, PetscInt n_nodes, PetscInt dim, const PetscInt *codes)
{
  pattern->n_cells = n_cells;
  for (PetscInt c = 0; c < n_cells; ++c) {
    for (PetscInt i = 0; i < n_nodes; ++i) pattern->code[c][i] = codes[c * n_nodes + i];
    if (n_nodes == dim + 1) invert_simplex(dim, pattern->code[c], pattern->origin[c], pattern->inverse[c]);
  }
}

void voxel_patterns(CellType type, Diagonal diagonal, VoxelPattern pattern[2])
{
  for (int odd = 0; odd < 2; ++odd) {
    const PetscBool rising = diagonal == DIAGONAL_RIGHT || (diagonal == DIAGONAL_ALTERNATING && !odd);
    if (type == CELL_QUADRILATERAL) pattern_fill(pattern + odd, 1, 4, 2, quadrilateral[0]);
    else if (type == CELL_HEXAHEDRON) pattern_fill(pattern + odd, 1, 8, 3, hexahedron[0]);
    else if (type == CELL_TETRAHEDRON) pattern_fill(pattern + odd, 6, 4, 3, kuhn[0]);
    else if (diagonal == DIAGONAL_CROSSED) pattern_fill(pattern + odd, 4, 3, 2, crossed[0]);
    else pattern_fill(pattern + odd, 2, 3, 2, rising ? right[0] : left[0]);
  }
}
