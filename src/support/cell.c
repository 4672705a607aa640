/* The linear shape functions of the cell in which a point stands: one group a cell. */
#include "basis/cell_kernels.h"
#include "support/basis.h"

/* Groups and points in cells; lost points stand last and have no group. */
static void count_groups(const Points *points, PetscInt *groups, PetscInt *located)
{
  PetscInt p = 0, n = 0;
  for (PetscInt last = -1; p < points->n && points->cell[p] >= 0; ++p) {
    n += points->cell[p] != last;
    last = points->cell[p];
  }
  *groups = n;
  *located = p;
}

static void fill_groups(Support *s, const Points *points, const Grid *grid, PetscInt located)
{
  const PetscInt nn = grid->nodes_per_cell;
  PetscInt g = 0;
  for (PetscInt p = 0, last = -1; p < located; ++p) {
    const PetscInt cell = points->cell[p];
    if (cell == last) continue;
    last = cell;
    s->point_start[g] = p;
    s->node_start[g] = g * nn;
    s->value_start[g] = p * nn;
    for (PetscInt i = 0; i < nn; ++i) s->node[g * nn + i] = grid->cell_node[cell * nn + i];
    ++g;
  }
  s->point_start[g] = located;
  s->node_start[g] = g * nn;
  s->value_start[g] = located * nn;
}

/* A simplex has one gradient for all its points. */
CELL_INLINE void evaluate_affine(CellType type, const PetscReal *x, const PetscReal *xi, PetscInt n, PetscReal *N,
                                 PetscReal *dN)
{
  const int dim = cell_kernel_dim(type), nn = cell_kernel_nodes(type);
  PetscReal gradient[CELL_MAX_NODES * 3], reference[CELL_MAX_NODES * 3];
  (void)cell_kernel_gradients(type, x, xi, N, gradient);
  for (PetscInt k = 0; k < n; ++k) {
    cell_kernel_shape(type, xi + k * dim, N + k * nn, reference);
    for (int i = 0; i < nn * dim; ++i) dN[k * nn * dim + i] = gradient[i];
  }
}

CELL_INLINE void evaluate_group(CellType type, const PetscReal *x, const PetscReal *xi, PetscInt n, PetscReal *N,
                                PetscReal *dN)
{
  const int dim = cell_kernel_dim(type), nn = cell_kernel_nodes(type);
  if (cell_kernel_affine(type)) {
    evaluate_affine(type, x, xi, n, N, dN);
    return;
  }
  for (PetscInt k = 0; k < n; ++k) (void)cell_kernel_gradients(type, x, xi + k * dim, N + k * nn, dN + k * nn * dim);
}

CELL_INLINE void evaluate(CellType type, const Support *s, const PetscReal *grid_x, const PetscReal *xi)
{
  const int dim = cell_kernel_dim(type), nn = cell_kernel_nodes(type);
  for (PetscInt g = 0; g < s->n_groups; ++g) {
    const PetscInt *node = s->node + g * nn, first = s->point_start[g], n = s->point_start[g + 1] - first;
    PetscReal x[CELL_MAX_NODES * 3];
    for (int i = 0; i < nn; ++i)
      for (int d = 0; d < dim; ++d) x[i * dim + d] = grid_x[node[i] * dim + d];
    evaluate_group(type, x, xi + first * dim, n, s->N + first * nn, s->dN + first * nn * dim);
  }
}

static PetscErrorCode CellSupport(const BasisInput *in, const Points *points, Support *support)
{
  const Grid *grid = in->grid;
  const PetscReal *xi = points->real[POINT_XI];
  PetscInt groups, located;
  PetscFunctionBeginUser;
  PetscCheck(points->dim == grid->dim, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ,
             "points of %" PetscInt_FMT " dimensions in a grid of %" PetscInt_FMT, points->dim, grid->dim);
  count_groups(points, &groups, &located);
  PetscCall(SupportReserve(support, groups, groups * grid->nodes_per_cell, located * grid->nodes_per_cell, grid->dim));
  support->n_groups = groups;
  support->uniform = grid->nodes_per_cell;
  support->n_runs = 1;
  support->run[0] = (SupportRun){.nodes = grid->nodes_per_cell, .first = 0, .end = groups};
  fill_groups(support, points, grid, located);
  switch (grid->type) { /* a literal in each case: the kernels are compiled for that cell */
  case CELL_TRIANGLE: evaluate(CELL_TRIANGLE, support, grid->x, xi); break;
  case CELL_QUADRILATERAL: evaluate(CELL_QUADRILATERAL, support, grid->x, xi); break;
  case CELL_TETRAHEDRON: evaluate(CELL_TETRAHEDRON, support, grid->x, xi); break;
  case CELL_HEXAHEDRON: evaluate(CELL_HEXAHEDRON, support, grid->x, xi); break;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CellCouplings(const BasisInput *in, const BasisSites *sites, NodeGroups *groups)
{
  const PetscInt nn = in->grid->nodes_per_cell;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < in->grid->n_cells; ++c)
    if (sites->cell[c]) PetscCall(NodeGroupsAdd(groups, nn, in->grid->cell_node + c * nn));
  PetscFunctionReturn(0);
}

const Basis basis_cell = {
  .nodes = BASIS_OF_CELLS,
  .holds_boundary = PETSC_TRUE,
  .support = CellSupport,
  .couplings = CellCouplings,
};
