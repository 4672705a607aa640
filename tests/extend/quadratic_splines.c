/* A basis from outside: quadratic B-splines on a box of equal squares, for mpm in the plane.
 *
 * In each direction the function of node i is the mean of its hat over a window of one cell, so a
 * point sees the node next to it and the two beside that, in two directions nine nodes. Where one
 * of them would lie outside the box, the field there is the linear extrapolation of the two nodes
 * inside, which leaves linear functions between the edge and the middle of its cell: sums and
 * linear fields stay exact, and what is prescribed at the edge's nodes holds on the edge. */
#include "support/basis.h"

/* Cells of the box in each direction, from the numbering of cells: x runs fastest. */
static void count_cells(const Grid *grid, PetscInt count[2])
{
  count[0] = 1;
  while (count[0] < grid->n_cells && grid->x[2 * grid->cell_node[4 * count[0]]] > grid->x[2 * grid->cell_node[0]])
    ++count[0];
  count[1] = grid->n_cells / count[0];
}

static const char *spline_misfit(const GridSpec *grid)
{
  const PetscReal width = (grid->max[0] - grid->min[0]) / (PetscReal)grid->counts[0];
  const PetscReal height = (grid->max[1] - grid->min[1]) / (PetscReal)grid->counts[1];
  PetscMPIInt size;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  if (size > 1) return "runs on one rank: at its border it reaches nodes that others have";
  if (grid->kind == GRID_BOX && grid->cell == CELL_QUADRILATERAL && PetscAbsReal(width - height) < 1e-9 * width &&
      PetscMax(grid->grading[0], grid->grading[1]) <= 1)
    return NULL;
  return "needs a box of equal squares";
}

/* Lattice nodes that carry the coordinate t in [0, 1] of cell i of n, with N and dN/dt; returns how
 * many. */
static int line_functions(PetscInt i, PetscInt n, PetscReal t, PetscInt *first, PetscReal N[3], PetscReal dN[3])
{
  const PetscInt nearest = t < 0.5 ? i : i + 1;
  const PetscReal s = t - (PetscReal)(nearest - i); /* from there, in [-1/2, 1/2] */
  *first = nearest - 1;
  N[0] = 0.5 * PetscSqr(0.5 - s), N[1] = 0.75 - s * s, N[2] = 0.5 * PetscSqr(0.5 + s);
  dN[0] = s - 0.5, dN[1] = -2 * s, dN[2] = s + 0.5;
  if (nearest > 0 && nearest < n) return 3;
  const PetscReal inward =
    nearest ? -s : s; /* what the node outside had goes to the edge twice, less once to the next */
  *first = nearest ? n - 1 : 0;
  N[0] = nearest ? inward : 1 - inward, N[1] = 1 - N[0];
  dN[0] = -1, dN[1] = 1;
  return 2;
}

/* Nodes of a point, ascending, since on one rank they count like cells; N and dN/dx. Returns how
 * many. */
static PetscInt spline_at(const Grid *grid, const PetscInt count[2], PetscInt cell, const PetscReal *xi, PetscInt *node,
                          PetscReal *N, PetscReal *dN)
{
  const PetscInt place[2] = {cell % count[0], cell / count[0]};
  PetscInt first[2], n = 0;
  PetscReal f[2][3], slope[2][3];
  int many[2];
  for (int d = 0; d < 2; ++d)
    many[d] = line_functions(place[d], count[d], 0.5 * (1 + xi[d]), &first[d], f[d], slope[d]);
  for (int j = 0; j < many[1]; ++j)
    for (int i = 0; i < many[0]; ++i, ++n) {
      node[n] = (first[1] + j) * (count[0] + 1) + first[0] + i;
      N[n] = f[0][i] * f[1][j];
      dN[2 * n] = slope[0][i] * f[1][j] / grid->smallest;
      dN[2 * n + 1] = f[0][i] * slope[1][j] / grid->smallest;
    }
  return n;
}

static PetscErrorCode SplineSupport(const BasisInput *in, const Points *points, Support *s)
{
  PetscInt count[2], n = 0, p = 0;

  PetscFunctionBeginUser;
  count_cells(in->grid, count);
  PetscCall(SupportReserve(s, points->n, 9 * points->n, 9 * points->n, 2));
  for (; p < points->n && points->cell[p] >= 0; ++p) {
    s->point_start[p] = p;
    s->node_start[p] = s->value_start[p] = n;
    n += spline_at(in->grid, count, points->cell[p], point_real(points, POINT_XI, p), s->node + n, s->N + n,
                   s->dN + 2 * n);
  }
  s->n_groups = s->point_start[p] = p;
  s->node_start[p] = s->value_start[p] = n;
  s->n_runs = 0;
  PetscFunctionReturn(0);
}

/* A point anywhere in a cell sees the cell's nodes and those around them. */
static PetscErrorCode SplineCouplings(const BasisInput *in, const BasisSites *sites, NodeGroups *groups)
{
  PetscInt count[2], node[16];

  PetscFunctionBeginUser;
  count_cells(in->grid, count);
  for (PetscInt c = 0; c < in->grid->n_cells; ++c) {
    const PetscInt i = c % count[0], j = c / count[0];
    PetscInt n = 0;
    for (PetscInt v = PetscMax(j - 1, 0); v <= PetscMin(j + 2, count[1]); ++v)
      for (PetscInt u = PetscMax(i - 1, 0); u <= PetscMin(i + 2, count[0]); ++u) node[n++] = v * (count[0] + 1) + u;
    if (sites->cell[c]) PetscCall(NodeGroupsAdd(groups, n, node));
  }
  PetscFunctionReturn(0);
}

const Basis basis_quadratic_splines = {
  .nodes = BASIS_OF_GRID,
  .across = 2,
  .holds_boundary = PETSC_TRUE,
  .misfit = spline_misfit,
  .support = SplineSupport,
  .couplings = SplineCouplings,
};
