/* The four cells: tables, and the kernels for a type known only at run time. */
#include "basis/cell_kernels.h"

const Cell cells[4] = {
  [CELL_TRIANGLE] = {.name = "triangle",
                     .help = "3 nodes, constant strain",
                     .dim = 2,
                     .nodes = 3,
                     .faces = 3,
                     .face_nodes = 2,
                     .reference_volume = 0.5,
                     .reference = {{0, 0}, {1, 0}, {0, 1}},
                     .face = {{0, 1}, {1, 2}, {2, 0}},
                     .vtk_type = 5},
  [CELL_QUADRILATERAL] = {.name = "quadrilateral",
                          .help = "4 nodes, bilinear",
                          .dim = 2,
                          .nodes = 4,
                          .faces = 4,
                          .face_nodes = 2,
                          .reference_volume = 4.0,
                          .reference = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}},
                          .face = {{0, 1}, {1, 2}, {2, 3}, {3, 0}},
                          .vtk_type = 9},
  [CELL_TETRAHEDRON] = {.name = "tetrahedron",
                        .help = "4 nodes, constant strain",
                        .dim = 3,
                        .nodes = 4,
                        .faces = 4,
                        .face_nodes = 3,
                        .reference_volume = 1.0 / 6.0,
                        .reference = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                        .face = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}},
                        .vtk_type = 10},
  [CELL_HEXAHEDRON] =
    {.name = "hexahedron",
     .help = "8 nodes, trilinear",
     .dim = 3,
     .nodes = 8,
     .faces = 6,
     .face_nodes = 4,
     .reference_volume = 8.0,
     .reference = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}},
     .face = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}},
     .vtk_type = 12},
};

/* Each case hands a literal to the kernel, which is then compiled for that cell alone. */
void cell_shape(CellType type, const PetscReal *xi, PetscReal *N, PetscReal *dN)
{
  switch (type) {
  case CELL_TRIANGLE: cell_kernel_shape(CELL_TRIANGLE, xi, N, dN); break;
  case CELL_QUADRILATERAL: cell_kernel_shape(CELL_QUADRILATERAL, xi, N, dN); break;
  case CELL_TETRAHEDRON: cell_kernel_shape(CELL_TETRAHEDRON, xi, N, dN); break;
  case CELL_HEXAHEDRON: cell_kernel_shape(CELL_HEXAHEDRON, xi, N, dN); break;
  }
}

PetscReal cell_gradients(CellType type, const PetscReal *x, const PetscReal *xi, PetscReal *N, PetscReal *dNdx)
{
  switch (type) {
  case CELL_TRIANGLE: return cell_kernel_gradients(CELL_TRIANGLE, x, xi, N, dNdx);
  case CELL_QUADRILATERAL: return cell_kernel_gradients(CELL_QUADRILATERAL, x, xi, N, dNdx);
  case CELL_TETRAHEDRON: return cell_kernel_gradients(CELL_TETRAHEDRON, x, xi, N, dNdx);
  case CELL_HEXAHEDRON: return cell_kernel_gradients(CELL_HEXAHEDRON, x, xi, N, dNdx);
  }
  return 0.0;
}

/* The kernel computes all, and the compiler leaves out what nobody asks for. */
CELL_INLINE PetscReal map(CellType type, const PetscReal *x, const PetscReal *xi, PetscReal *position)
{
  const int dim = cell_kernel_dim(type), nodes = cell_kernel_nodes(type);
  PetscReal N[CELL_MAX_NODES], dN[CELL_MAX_NODES * 3], jacobian[9], inverse[9];
  cell_kernel_shape(type, xi, N, dN);
  for (int d = 0; d < dim; ++d) {
    PetscReal sum = 0.0;
    for (int i = 0; i < nodes; ++i) sum += N[i] * x[i * dim + d];
    position[d] = sum;
  }
  cell_kernel_jacobian(type, x, dN, jacobian);
  return cell_kernel_invert(dim, jacobian, inverse);
}

PetscReal cell_map(CellType type, const PetscReal *x, const PetscReal *xi, PetscReal *position)
{
  switch (type) {
  case CELL_TRIANGLE: return map(CELL_TRIANGLE, x, xi, position);
  case CELL_QUADRILATERAL: return map(CELL_QUADRILATERAL, x, xi, position);
  case CELL_TETRAHEDRON: return map(CELL_TETRAHEDRON, x, xi, position);
  case CELL_HEXAHEDRON: return map(CELL_HEXAHEDRON, x, xi, position);
  }
  return 0.0;
}

void cell_position(CellType type, const PetscReal *x, const PetscReal *xi, PetscReal *position)
{
  switch (type) {
  case CELL_TRIANGLE: (void)map(CELL_TRIANGLE, x, xi, position); break;
  case CELL_QUADRILATERAL: (void)map(CELL_QUADRILATERAL, x, xi, position); break;
  case CELL_TETRAHEDRON: (void)map(CELL_TETRAHEDRON, x, xi, position); break;
  case CELL_HEXAHEDRON: (void)map(CELL_HEXAHEDRON, x, xi, position); break;
  }
}

static PetscReal simplex_outside(PetscInt dim, const PetscReal *xi)
{
  PetscReal sum = -1.0, outside = -PETSC_MAX_REAL;
  for (PetscInt d = 0; d < dim; ++d) {
    sum += xi[d];
    outside = PetscMax(outside, -xi[d]);
  }
  return PetscMax(outside, sum);
}

static PetscReal cube_outside(PetscInt dim, const PetscReal *xi)
{
  PetscReal outside = -1.0;
  for (PetscInt d = 0; d < dim; ++d) outside = PetscMax(outside, PetscAbsReal(xi[d]) - 1.0);
  return outside;
}

PetscReal cell_outside(CellType type, const PetscReal *xi)
{
  const PetscInt dim = cells[type].dim;
  return cell_kernel_affine(type) ? simplex_outside(dim, xi) : cube_outside(dim, xi);
}

/* det dx/dxi is constant, linear or at most quadratic in each direction: these rules are exact. */
PetscReal cell_volume(CellType type, const PetscReal *x)
{
  const PetscInt n = type == CELL_HEXAHEDRON ? 8 : 1;
  PetscReal xi[8 * 3], weight[8], N[CELL_MAX_NODES], dNdx[CELL_MAX_NODES * 3], volume = 0.0;
  cell_quadrature(type, n, xi, weight);
  for (PetscInt p = 0; p < n; ++p) volume += weight[p] * cell_gradients(type, x, xi + p * cells[type].dim, N, dNdx);
  return volume;
}

/* Of a triangle half the product of two edges, of a quadrilateral that of its diagonals. */
void cell_side_area(CellType type, PetscInt side, const PetscReal *x, PetscReal area[3])
{
  const Cell *cell = cells + type;
  const PetscInt dim = cell->dim, *face = cell->face[side], quadrilateral = cell->face_nodes == 4;
  PetscReal e[3] = {0, 0, 0}, f[3] = {0, 0, 2};
  for (PetscInt d = 0; d < dim; ++d) {
    e[d] = x[face[dim == 2 ? 1 : quadrilateral ? 2 : 1] * dim + d] - x[face[0] * dim + d];
    if (dim == 3) f[d] = x[face[quadrilateral ? 3 : 2] * dim + d] - x[face[quadrilateral ? 1 : 0] * dim + d];
  }
  for (int d = 0; d < 3; ++d) area[d] = 0.5 * (e[(d + 1) % 3] * f[(d + 2) % 3] - e[(d + 2) % 3] * f[(d + 1) % 3]);
}

/* r det dx/dxi is linear in a triangle, at most quadratic in each direction in a quadrilateral:
 * these rules are exact, too. */
PetscReal cell_volume_in(const Kinematics *kinematics, CellType type, const PetscReal *x)
{
  const PetscInt n = type == CELL_TRIANGLE ? 3 : 4;
  PetscReal xi[4 * 2], weight[4], N[CELL_MAX_NODES], dNdx[CELL_MAX_NODES * 3], volume = 0.0;
  if (!kinematics->hoop) return cell_volume(type, x);
  cell_quadrature(type, n, xi, weight);
  for (PetscInt p = 0; p < n; ++p) {
    const PetscReal area = weight[p] * cell_gradients(type, x, xi + 2 * p, N, dNdx);
    PetscReal radius = 0;
    for (PetscInt i = 0; i < cells[type].nodes; ++i) radius += N[i] * x[2 * i];
    volume += area * kinematics_weight(kinematics, radius);
  }
  return volume;
}

void cell_shares_in(const Kinematics *kinematics, CellType type, const PetscReal *x, PetscReal *share)
{
  const PetscInt nn = cells[type].nodes, n = type == CELL_TRIANGLE ? 3 : 4;
  PetscReal xi[4 * 2], weight[4], N[CELL_MAX_NODES], dNdx[CELL_MAX_NODES * 3];
  for (PetscInt i = 0; i < nn; ++i) share[i] = kinematics->hoop ? 0 : cell_volume(type, x) / (PetscReal)nn;
  if (!kinematics->hoop) return;
  cell_quadrature(type, n, xi, weight);
  for (PetscInt p = 0; p < n; ++p) {
    const PetscReal area = weight[p] * cell_gradients(type, x, xi + 2 * p, N, dNdx);
    PetscReal radius = 0;
    for (PetscInt i = 0; i < nn; ++i) radius += N[i] * x[2 * i];
    for (PetscInt i = 0; i < nn; ++i) share[i] += N[i] * area * kinematics_weight(kinematics, radius);
  }
}
