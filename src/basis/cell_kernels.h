/* Shape functions and gradients with the cell type known at compile time.
 *
 * Hot loops of other rooms switch on the type once, outside, and call these with a literal
 * CellType: the compiler then unrolls everything. cell.h has the same functions for any type. */
#pragma once
#include "basis/cell.h"

#define CELL_INLINE static inline __attribute__((always_inline))

/* Constants that the compiler folds; `cells[type].nodes` says the same but from memory. */
CELL_INLINE int cell_kernel_dim(CellType type) { return type == CELL_TRIANGLE || type == CELL_QUADRILATERAL ? 2 : 3; }
CELL_INLINE int cell_kernel_nodes(CellType type)
{
  return type == CELL_TRIANGLE ? 3 : (type == CELL_HEXAHEDRON ? 8 : 4);
}
CELL_INLINE PetscBool cell_kernel_affine(CellType type) { return type == CELL_TRIANGLE || type == CELL_TETRAHEDRON; }

CELL_INLINE void cell_kernel_simplex(int dim, const PetscReal *xi, PetscReal *N, PetscReal *dN)
{
  N[0] = 1.0;
  for (int d = 0; d < dim; ++d) {
    N[0] -= xi[d];
    N[d + 1] = xi[d];
    dN[d] = -1.0;
    for (int a = 0; a < dim; ++a) dN[(a + 1) * dim + d] = a == d ? 1.0 : 0.0;
  }
}

CELL_INLINE void cell_kernel_quadrilateral(const PetscReal *xi, PetscReal *N, PetscReal *dN)
{
  const PetscReal xm = 0.5 * (1.0 - xi[0]), xp = 0.5 * (1.0 + xi[0]);
  const PetscReal ym = 0.5 * (1.0 - xi[1]), yp = 0.5 * (1.0 + xi[1]);
  const PetscReal x[4] = {xm, xp, xp, xm}, y[4] = {ym, ym, yp, yp};
  const PetscReal dx[4] = {-0.5, 0.5, 0.5, -0.5}, dy[4] = {-0.5, -0.5, 0.5, 0.5};
  for (int a = 0; a < 4; ++a) {
    N[a] = x[a] * y[a];
    dN[2 * a] = dx[a] * y[a];
    dN[2 * a + 1] = x[a] * dy[a];
  }
}

CELL_INLINE void cell_kernel_hexahedron(const PetscReal *xi, PetscReal *N, PetscReal *dN)
{
  PetscReal M[4], dM[8]; /* bottom and top are the quadrilateral times a line in z */
  const PetscReal z[2] = {0.5 * (1.0 - xi[2]), 0.5 * (1.0 + xi[2])}, dz[2] = {-0.5, 0.5};
  cell_kernel_quadrilateral(xi, M, dM);
  for (int k = 0; k < 2; ++k)
    for (int a = 0; a < 4; ++a) {
      const int b = 4 * k + a;
      N[b] = M[a] * z[k];
      dN[3 * b] = dM[2 * a] * z[k];
      dN[3 * b + 1] = dM[2 * a + 1] * z[k];
      dN[3 * b + 2] = M[a] * dz[k];
    }
}

/* N (nodes) and reference gradients dN (nodes x dim). */
CELL_INLINE void cell_kernel_shape(CellType type, const PetscReal *xi, PetscReal *N, PetscReal *dN)
{
  switch (type) {
  case CELL_TRIANGLE: cell_kernel_simplex(2, xi, N, dN); break;
  case CELL_TETRAHEDRON: cell_kernel_simplex(3, xi, N, dN); break;
  case CELL_QUADRILATERAL: cell_kernel_quadrilateral(xi, N, dN); break;
  case CELL_HEXAHEDRON: cell_kernel_hexahedron(xi, N, dN); break;
  }
}

/* Jacobian dx/dxi (dim x dim, row: component of x) from node positions and reference gradients. */
CELL_INLINE void cell_kernel_jacobian(CellType type, const PetscReal *x, const PetscReal *dN, PetscReal *jacobian)
{
  const int dim = cell_kernel_dim(type), nodes = cell_kernel_nodes(type);
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) {
      PetscReal sum = 0.0;
      for (int a = 0; a < nodes; ++a) sum += x[a * dim + i] * dN[a * dim + j];
      jacobian[i * dim + j] = sum;
    }
}

/* inverse = jacobian^-1, returns its determinant. */
CELL_INLINE PetscReal cell_kernel_invert(int dim, const PetscReal *jacobian, PetscReal *inverse)
{
  if (dim == 3) return tensor_inverse(jacobian, inverse);
  const PetscReal det = jacobian[0] * jacobian[3] - jacobian[1] * jacobian[2], s = 1.0 / det;
  inverse[0] = jacobian[3] * s;
  inverse[1] = -jacobian[1] * s;
  inverse[2] = -jacobian[2] * s;
  inverse[3] = jacobian[0] * s;
  return det;
}

/* N and spatial gradients dNdx (nodes x dim); returns det dx/dxi. */
CELL_INLINE PetscReal cell_kernel_gradients(CellType type, const PetscReal *x, const PetscReal *xi, PetscReal *N,
                                            PetscReal *dNdx)
{
  const int dim = cell_kernel_dim(type), nodes = cell_kernel_nodes(type);
  PetscReal dN[CELL_MAX_NODES * 3], jacobian[9], inverse[9];
  cell_kernel_shape(type, xi, N, dN);
  cell_kernel_jacobian(type, x, dN, jacobian);
  const PetscReal det = cell_kernel_invert(dim, jacobian, inverse);
  for (int a = 0; a < nodes; ++a)
    for (int i = 0; i < dim; ++i) {
      PetscReal sum = 0.0;
      for (int j = 0; j < dim; ++j) sum += dN[a * dim + j] * inverse[j * dim + i];
      dNdx[a * dim + i] = sum;
    }
  return det;
}
