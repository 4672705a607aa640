/* Distorted cells for the tests of this room. */
#pragma once
#include "basis/cell.h"
#include "../conformance/random.h"

/* The reference cell of size 2, sheared by a random amount, its nodes moved by up to `distortion`,
 * its origin at `shift`. */
static inline void distorted_cell(Random *random, CellType type, PetscReal distortion, PetscReal shift, PetscReal *x)
{
  const Cell *cell = &cells[type];
  PetscReal f[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) f[i][j] = (i == j) + random_real(random, -0.25, 0.25);
  for (PetscInt a = 0; a < cell->nodes; ++a)
    for (PetscInt i = 0; i < cell->dim; ++i) {
      PetscReal value = shift + random_real(random, -distortion, distortion);
      for (PetscInt j = 0; j < cell->dim; ++j) value += f[i][j] * cell->reference[a][j];
      x[a * cell->dim + i] = value;
    }
}

/* A position inside the reference cell. */
static inline void random_inside(Random *random, CellType type, PetscReal *xi)
{
  const PetscReal low = type == CELL_TRIANGLE || type == CELL_TETRAHEDRON ? 0 : -1;
  do {
    for (PetscInt d = 0; d < cells[type].dim; ++d) xi[d] = random_real(random, low, 1);
  } while (cell_outside(type, xi) > 0);
}

/* x at xi. */
static inline void sample_position(CellType type, const PetscReal *x, const PetscReal *xi, PetscReal *point)
{
  const PetscInt dim = cells[type].dim;
  PetscReal N[CELL_MAX_NODES], dN[CELL_MAX_NODES * 3];
  cell_shape(type, xi, N, dN);
  for (PetscInt d = 0; d < dim; ++d) {
    point[d] = 0.0;
    for (PetscInt a = 0; a < cells[type].nodes; ++a) point[d] += N[a] * x[a * dim + d];
  }
}
