/* From a position in space back to the reference cell: exactly for affine cells, by a safeguarded
 * Newton for the others.
 *
 * All positions are taken relative to the cell's first node, so that a small cell far from the
 * origin loses no digits. */
#include "basis/cell_kernels.h"
#include <math.h>

#define MAX_ITERATIONS 60
#define SMALLEST_DAMPING 1e-3
#define STEP_TOLERANCE 1e-14 /* of 1 + |xi|: nothing smaller can be told from round-off */
/* of the size of the terms that it sums: where an iteration that stalls has arrived */
#define RESIDUAL_TOLERANCE 1e-13
/* reference units: there lies the line where a trapezoid's sides meet */
#define FARTHEST 1e6
/* of the cell's size: worse than this is no inverse, however far outside */
#define LARGEST_RESIDUAL 1e-9

typedef struct {
  PetscReal x[CELL_MAX_NODES * 3]; /* node positions relative to the first */
  PetscReal target[3];
  PetscReal size;
} Map;

CELL_INLINE void map_set_up(CellType type, const PetscReal *x, const PetscReal *point, Map *map)
{
  const int dim = cell_kernel_dim(type), nodes = cell_kernel_nodes(type);
  map->size = 0.0;
  for (int a = 0; a < nodes; ++a)
    for (int d = 0; d < dim; ++d) {
      map->x[a * dim + d] = x[a * dim + d] - x[d];
      map->size = PetscMax(map->size, PetscAbsReal(map->x[a * dim + d]));
    }
  for (int d = 0; d < dim; ++d) map->target[d] = point[d] - x[d];
}

/* What is left between the target and the position of xi; gives the inverse Jacobian there, returns
 * its determinant. */
CELL_INLINE PetscReal map_residual(CellType type, const Map *map, const PetscReal *xi, PetscReal *residual,
                                   PetscReal *inverse)
{
  const int dim = cell_kernel_dim(type), nodes = cell_kernel_nodes(type);
  PetscReal N[CELL_MAX_NODES], dN[CELL_MAX_NODES * 3], jacobian[9];
  cell_kernel_shape(type, xi, N, dN);
  cell_kernel_jacobian(type, map->x, dN, jacobian);
  for (int d = 0; d < dim; ++d) {
    residual[d] = map->target[d];
    for (int a = 1; a < nodes; ++a) residual[d] -= N[a] * map->x[a * dim + d];
  }
  return cell_kernel_invert(dim, jacobian, inverse);
}

CELL_INLINE PetscReal norm_max(int dim, const PetscReal *v)
{
  PetscReal largest = 0.0;
  for (int d = 0; d < dim; ++d)
    if (!(PetscAbsReal(v[d]) <= largest)) largest = PetscAbsReal(v[d]); /* keeps a NaN */
  return largest;
}

CELL_INLINE void apply_inverse(int dim, const PetscReal *inverse, const PetscReal *residual, PetscReal *step)
{
  for (int i = 0; i < dim; ++i) {
    step[i] = 0.0;
    for (int j = 0; j < dim; ++j) step[i] += inverse[i * dim + j] * residual[j];
  }
}

CELL_INLINE PetscBool map_affine(CellType type, const Map *map, PetscReal *xi)
{
  const int dim = cell_kernel_dim(type);
  PetscReal residual[3], inverse[9];
  for (int d = 0; d < dim; ++d) xi[d] = 0.0;
  const PetscReal det = map_residual(type, map, xi, residual, inverse);
  apply_inverse(dim, inverse, residual, xi);
  return det != 0.0 && isfinite(norm_max(dim, xi));
}

/* Go along `step`, halving it until the residual falls and the map keeps its orientation.
 * PETSC_FALSE: nowhere better. */
CELL_INLINE PetscBool map_advance(CellType type, const Map *map, const PetscReal *step, PetscReal *xi,
                                  PetscReal *residual, PetscReal *inverse, PetscReal *det)
{
  const int dim = cell_kernel_dim(type);
  const PetscReal before = norm_max(dim, residual);
  for (PetscReal damping = 1.0; damping >= SMALLEST_DAMPING; damping *= 0.5) {
    PetscReal trial[3], trial_residual[3], trial_inverse[9];
    for (int d = 0; d < dim; ++d) trial[d] = xi[d] + damping * step[d];
    const PetscReal trial_det = map_residual(type, map, trial, trial_residual, trial_inverse);
    if (!(trial_det * *det > 0.0) || !(norm_max(dim, trial_residual) < before)) continue;
    for (int d = 0; d < dim; ++d) xi[d] = trial[d], residual[d] = trial_residual[d];
    for (int k = 0; k < dim * dim; ++k) inverse[k] = trial_inverse[k];
    *det = trial_det;
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Size of the terms N_a x_a: far outside the cell the shape functions grow like |xi|^dim. */
CELL_INLINE PetscReal map_scale(int dim, const Map *map, const PetscReal *xi)
{
  PetscReal scale = map->size;
  for (int d = 0; d < dim; ++d) scale *= 1.0 + norm_max(dim, xi);
  return scale;
}

CELL_INLINE PetscBool map_newton(CellType type, const Map *map, PetscReal *xi)
{
  const int dim = cell_kernel_dim(type);
  PetscReal residual[3], inverse[9], step[3];
  for (int d = 0; d < dim; ++d) xi[d] = 0.0;
  PetscReal det = map_residual(type, map, xi, residual, inverse);
  for (int iteration = 0; iteration < MAX_ITERATIONS; ++iteration) {
    apply_inverse(dim, inverse, residual, step);
    const PetscReal length = norm_max(dim, step);
    if (!isfinite(length)) return PETSC_FALSE;
    if (length <= STEP_TOLERANCE * (1.0 + norm_max(dim, xi))) break;
    if (!map_advance(type, map, step, xi, residual, inverse, &det)) break;
  }
  const PetscReal tolerance = PetscMin(RESIDUAL_TOLERANCE * map_scale(dim, map, xi), LARGEST_RESIDUAL * map->size);
  return norm_max(dim, xi) <= FARTHEST && norm_max(dim, residual) <= tolerance;
}

CELL_INLINE PetscBool invert(CellType type, const PetscReal *x, const PetscReal *point, PetscReal *xi)
{
  Map map;
  map_set_up(type, x, point, &map);
  return cell_kernel_affine(type) ? map_affine(type, &map, xi) : map_newton(type, &map, xi);
}

PetscBool cell_inverse_map(CellType type, const PetscReal *x, const PetscReal *point, PetscReal *xi)
{
  switch (type) {
  case CELL_TRIANGLE: return invert(CELL_TRIANGLE, x, point, xi);
  case CELL_QUADRILATERAL: return invert(CELL_QUADRILATERAL, x, point, xi);
  case CELL_TETRAHEDRON: return invert(CELL_TETRAHEDRON, x, point, xi);
  case CELL_HEXAHEDRON: return invert(CELL_HEXAHEDRON, x, point, xi);
  }
  return PETSC_FALSE;
}
