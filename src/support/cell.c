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

/* Cells of the lesser kind stand first, and so do their groups: returns how many these are. */
static PetscInt fill_groups(Support *s, const Points *points, const Grid *grid, PetscInt located)
{
  PetscInt g = 0, nn = 0, nodes = 0, values = 0, n_first = 0;
  for (PetscInt p = 0, last = -1; p < located; ++p, values += nn) {
    const PetscInt cell = points->cell[p];
    if (cell == last) continue;
    last = cell;
    nn = grid_cell(grid, cell)->nodes;
    n_first += cell < grid->n_first;
    s->point_start[g] = p;
    s->node_start[g] = nodes;
    s->value_start[g++] = values;
    for (PetscInt i = 0; i < nn; ++i) s->node[nodes++] = grid->cell_node[cell * grid->nodes_per_cell + i];
  }
  s->point_start[g] = located;
  s->node_start[g] = nodes;
  s->value_start[g] = values;
  return n_first;
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

CELL_INLINE void evaluate(CellType type, const Support *s, const SupportRun *run, const PetscReal *grid_x,
                          const PetscReal *xi)
{
  const int dim = cell_kernel_dim(type), nn = cell_kernel_nodes(type);
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt *node = s->node + s->node_start[g], first = s->point_start[g], n = s->point_start[g + 1] - first;
    PetscReal x[CELL_MAX_NODES * 3];
    for (int i = 0; i < nn; ++i)
      for (int d = 0; d < dim; ++d) x[i * dim + d] = grid_x[node[i] * dim + d];
    evaluate_group(type, x, xi + first * dim, n, s->N + s->value_start[g], s->dN + s->value_start[g] * dim);
  }
}

static void add_run(Support *s, CellType type, PetscInt first, PetscInt end, const PetscReal *x, const PetscReal *xi)
{
  SupportRun *run = &s->run[s->n_runs++];
  *run = (SupportRun){.nodes = cells[type].nodes, .first = first, .end = end};
  switch (type) { /* a literal in each case: the kernels are compiled for that cell */
  case CELL_TRIANGLE: evaluate(CELL_TRIANGLE, s, run, x, xi); break;
  case CELL_QUADRILATERAL: evaluate(CELL_QUADRILATERAL, s, run, x, xi); break;
  case CELL_TETRAHEDRON: evaluate(CELL_TETRAHEDRON, s, run, x, xi); break;
  case CELL_HEXAHEDRON: evaluate(CELL_HEXAHEDRON, s, run, x, xi); break;
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
  const PetscInt n_first = fill_groups(support, points, grid, located);
  support->n_groups = groups;
  support->n_runs = 0;
  if (n_first) add_run(support, grid->first_type, 0, n_first, grid->x, xi);
  if (!n_first || n_first < groups) add_run(support, grid->type, n_first, groups, grid->x, xi);
  PetscFunctionReturn(0);
}

static PetscErrorCode CellCouplings(const BasisInput *in, const BasisSites *sites, NodeGroups *groups)
{
  const Grid *grid = in->grid;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < grid->n_cells; ++c)
    if (sites->cell[c])
      PetscCall(NodeGroupsAdd(groups, grid_cell(grid, c)->nodes, grid->cell_node + c * grid->nodes_per_cell));
  PetscFunctionReturn(0);
}

const Basis basis_cell = {
  .nodes = BASIS_OF_CELLS,
  .holds_boundary = PETSC_TRUE,
  .support = CellSupport,
  .couplings = CellCouplings,
};
