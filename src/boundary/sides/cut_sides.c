#include "boundary/sides/cut_sides.h"

#define RASTER 1024 /* along an edge; a face in space has so many squares */
#define ACROSS 32   /* of these along each side */
#define ALIKE 0.1   /* share of the load's sides that must look along a side's normal, squared cosines */

/* May a range take more of the side than an edge of it? */
static PetscBool meets(const Grid *grid, const Selector *on, PetscReal tolerance, PetscInt n, PetscReal x[4][3])
{
  for (PetscInt d = 0; d < grid->dim; ++d) {
    PetscReal low = x[0][d], high = x[0][d];
    for (PetscInt i = 1; i < n; ++i) low = PetscMin(low, x[i][d]), high = PetscMax(high, x[i][d]);
    const PetscReal flat = high - low <= tolerance ? -tolerance : tolerance;
    if (on->has[d] && PetscMin(high, on->max[d]) - PetscMax(low, on->min[d]) < flat) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The k-th place of the raster: on an edge, in a triangle (what lies beyond is folded back), in a quadrilateral. */
static void raster_place(PetscInt n, PetscInt dim, PetscInt k, PetscReal x[4][3], PetscReal at[3])
{
  PetscReal s = (0.5 + (PetscReal)(n == 2 ? k : k % ACROSS)) / (n == 2 ? RASTER : ACROSS), t = 0,
            N[4] = {1 - s, s, 0, 0};
  const PetscInt row = k / ACROSS;
  if (n > 2) t = (0.5 + (PetscReal)row) / ACROSS;
  if (n == 3) {
    if (s + t > 1) s = 1 - s, t = 1 - t;
    N[0] = 1 - s - t, N[1] = s, N[2] = t;
  } else if (n == 4) {
    N[0] = (1 - s) * (1 - t), N[1] = s * (1 - t), N[2] = s * t, N[3] = (1 - s) * t;
  }
  for (PetscInt d = 0; d < dim; ++d) {
    at[d] = 0;
    for (PetscInt i = 0; i < n; ++i) at[d] += N[i] * x[i][d];
  }
}

PetscReal side_share(const Grid *grid, const Selector *on, PetscInt cell, PetscInt side)
{
  const PetscReal tolerance = 1e-9 * PetscMax(grid->max[0] - grid->min[0], grid->max[1] - grid->min[1]);
  const Cell *type = grid_cell(grid, cell);
  const PetscInt n = type->face_nodes, *node = grid->cell_node + cell * grid->nodes_per_cell;
  PetscReal x[4][3] = {{0}}, at[3];
  PetscInt taken = 0;
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt d = 0; d < grid->dim; ++d) x[i][d] = grid->x[node[type->face[side][i]] * grid->dim + d];
    taken += grid_takes(grid, on, x[i]);
  }
  if (taken == n) return 1;
  if (!meets(grid, on, tolerance, n, x)) return 0;
  taken = 0;
  for (PetscInt k = 0; k < RASTER; ++k) {
    raster_place(n, grid->dim, k, x, at);
    taken += grid_takes(grid, on, at);
  }
  return PetscMin(taken, RASTER - 1) / (PetscReal)RASTER;
}

/* Area of a side, and its vector. */
static PetscReal side_area(const Kinematics *kinematics, const Grid *grid, PetscInt cell, PetscInt side,
                           PetscReal vector[3])
{
  FacePoint q[FACE_MAX_POINTS];
  const PetscInt n = face_quadrature(kinematics, grid, cell, side, q);
  PetscReal area = 0;
  for (int d = 0; d < 3; ++d) vector[d] = 0;
  for (PetscInt k = 0; k < n; ++k) {
    area += q[k].area;
    for (int d = 0; d < 3; ++d) vector[d] += q[k].vector[d];
  }
  return area;
}

PetscErrorCode CutSides(const Kinematics *kinematics, const Grid *grid, const Selector *on, PetscInt n,
                        const PetscInt *cell, const PetscInt *side, PetscInt n_cut, const PetscInt *cut_cell,
                        const PetscInt *cut_side, PetscReal *borne, PetscReal *cut)
{
  PetscReal looks[10] = {0}, v[3]; /* area, and the sum of area n n^T */

  PetscFunctionBeginUser;
  *cut = 0;
  for (PetscInt f = 0; f < n; ++f) {
    const PetscReal area = side_area(kinematics, grid, cell[f], side[f], v);
    looks[9] += area;
    for (int i = 0; i < 9 && area > 0; ++i) looks[i] += v[i / 3] * v[i % 3] / area;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, looks, 10, MPIU_REAL, MPIU_SUM, grid->comm));
  for (PetscInt f = 0; f < n_cut; ++f) {
    const PetscReal area = side_area(kinematics, grid, cut_cell[f], cut_side[f], v);
    PetscReal alike = 0;
    for (int i = 0; i < 9 && area > 0; ++i) alike += v[i / 3] * looks[i] * v[i % 3] / PetscSqr(area);
    if (alike > ALIKE * looks[9]) *cut += area * side_share(grid, on, cut_cell[f], cut_side[f]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, cut, 1, MPIU_REAL, MPIU_SUM, grid->comm));
  *borne = looks[9];
  PetscFunctionReturn(0);
}
