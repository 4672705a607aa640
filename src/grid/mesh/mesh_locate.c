/* Search of unstructured grids: from neighbour to neighbour beginning in the last known cell, else
 * in the tree of bounding boxes.
 *
 * The first way answers only where x lies well inside a cell; on faces the tree decides among all
 * cells that touch x, so that the answer does not depend on where the search began. A position on a
 * face between ranks belongs to the lower one, a node to its owner. */
#include "grid/mesh/mesh.h"

#define MAX_STEPS 24

/* Positions on a face must be found from both sides, whatever the rounding. */
static void pad(PetscReal bounds[6], PetscInt dim)
{
  PetscReal extent = 0;
  for (PetscInt d = 0; d < dim; ++d) extent = PetscMax(extent, bounds[d + 3] - bounds[d]);
  for (PetscInt d = 0; d < dim; ++d) {
    const PetscReal margin = 1e-9 * extent + 1e-14 * PetscMax(PetscAbsReal(bounds[d]), PetscAbsReal(bounds[d + 3]));
    bounds[d] -= margin;
    bounds[d + 3] += margin;
  }
}

PetscErrorCode MeshCellTree(const Grid *grid, BoxTree **tree)
{
  PetscReal(*bounds)[6], x[3 * CELL_MAX_NODES];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc(sizeof *bounds * (size_t)grid->n_cells, &bounds));
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    grid_cell_x(grid, c, x);
    box_around(grid->dim, grid->nodes_per_cell, x, bounds[c]);
    pad(bounds[c], grid->dim);
  }
  PetscCall(BoxTreeCreate(grid->n_cells, bounds, tree));
  PetscFunctionReturn(0);
}

/* For each side, the share of the nodes that do not belong to it: 0 on the side, 1 opposite,
 * negative beyond. */
static void side_distances(CellType type, const PetscReal *N, PetscReal *distance)
{
  const Cell *shape = cells + type;
  for (PetscInt f = 0; f < shape->faces; ++f) {
    distance[f] = 1.0;
    for (PetscInt i = 0; i < shape->face_nodes; ++i) distance[f] -= N[shape->face[f][i]];
  }
}

/* Does a position on the rim of this cell belong to this rank? Ranks differ in their rounding, so
 * the margin here is far below the one within which the other rank takes it. */
static PetscBool claims(const Grid *grid, PetscInt cell, const PetscReal *xi)
{
  const CellType type = grid_cell_type(grid, cell);
  const PetscInt n_faces = cells[type].faces, *neighbour = grid->mesh->neighbour + cell * mesh_faces(grid);
  const PetscReal margin = 0.01 * grid->mesh->tolerance;
  PetscReal N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES], distance[6];
  PetscMPIInt rank;
  (void)MPI_Comm_rank(grid->comm, &rank);
  cell_shape(type, xi, N, dN);
  for (PetscInt i = 0; i < cells[type].nodes; ++i)
    if (N[i] >= 1.0 - 3.0 * margin) return grid->cell_node[cell * grid->nodes_per_cell + i] < grid->n_owned;
  side_distances(type, N, distance);
  for (PetscInt f = 0; f < n_faces; ++f)
    if (distance[f] <= margin && neighbour[f] <= -2 && -2 - neighbour[f] < rank) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* How far x lies outside the cell, and where in it. */
static PetscReal try_cell(const Grid *grid, PetscInt cell, const PetscReal *x, PetscReal *xi)
{
  PetscReal nodes[3 * CELL_MAX_NODES];
  const CellType type = grid_cell_type(grid, cell);
  grid_cell_x(grid, cell, nodes);
  return cell_inverse_map(type, nodes, x, xi) ? cell_outside(type, xi) : PETSC_MAX_REAL;
}

/* The cell that surely holds x, stepping through the side that x lies most beyond; -1 if the
 * way ends elsewhere. */
static PetscInt step_through_faces(const Grid *grid, const PetscReal *x, PetscInt cell, PetscReal *xi)
{
  for (int step = 0; step < MAX_STEPS && cell >= 0; ++step) {
    PetscReal N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES], distance[6];
    PetscInt worst = 0;
    const PetscReal outside = try_cell(grid, cell, x, xi);
    if (outside < -grid->mesh->tolerance) return cell;
    if (outside <= grid->mesh->tolerance || outside == PETSC_MAX_REAL) return -1;
    const CellType type = grid_cell_type(grid, cell);
    cell_shape(type, xi, N, dN);
    side_distances(type, N, distance);
    for (PetscInt f = 1; f < cells[type].faces; ++f)
      if (distance[f] < distance[worst]) worst = f;
    cell = grid->mesh->neighbour[cell * mesh_faces(grid) + worst];
  }
  return -1;
}

typedef struct {
  const Grid *grid;
  const PetscReal *x;
  PetscInt cell;
  PetscReal outside, *xi;
} Deepest;

/* Keep the cell that x lies deepest in, the lowest of equals. */
static PetscBool try_candidate(void *context, PetscInt cell)
{
  Deepest *best = context;
  PetscReal xi[3];
  const PetscReal outside = try_cell(best->grid, cell, best->x, xi);
  if (outside > best->outside || (outside == best->outside && cell > best->cell)) return PETSC_TRUE;
  best->cell = cell;
  best->outside = outside;
  for (PetscInt d = 0; d < best->grid->dim; ++d) best->xi[d] = xi[d];
  return outside >= -best->grid->mesh->tolerance; /* well inside: no other cell can hold it */
}

PetscInt mesh_locate(const Grid *grid, const PetscReal *x, PetscInt guess, PetscReal *xi)
{
  const PetscReal at[3] = {x[0], x[1], grid->dim == 3 ? x[2] : 0};
  Deepest best = {grid, x, -1, PETSC_MAX_REAL, xi};
  if (guess >= 0 && guess < grid->n_cells) {
    const PetscInt cell = step_through_faces(grid, x, guess, xi);
    if (cell >= 0) return cell;
  }
  box_tree_holding(grid->mesh->cell_tree, at, try_candidate, &best);
  if (best.cell < 0 || best.outside > grid->mesh->tolerance) return -1;
  if (best.outside < -grid->mesh->tolerance) return best.cell;
  return claims(grid, best.cell, xi) ? best.cell : -1;
}

PetscInt mesh_candidates(const Grid *grid, const PetscReal *x, PetscInt max, PetscMPIInt *ranks)
{
  PetscMPIInt rank, size;
  PetscInt n = 0;
  (void)MPI_Comm_rank(grid->comm, &rank);
  (void)MPI_Comm_size(grid->comm, &size);
  for (PetscMPIInt r = 0; r < size && n < max; ++r) {
    PetscBool inside = r != rank;
    for (PetscInt d = 0; d < grid->dim; ++d) {
      const PetscReal margin = 1e-9 * (grid->max[d] - grid->min[d]);
      if (!(x[d] >= grid->rank_bounds[r][d] - margin && x[d] <= grid->rank_bounds[r][d + 3] + margin))
        inside = PETSC_FALSE;
    }
    if (inside) ranks[n++] = r;
  }
  return n;
}
