/* Search of unstructured grids: a walk over face neighbours from the last known cell, else the tree
 * of bounding boxes.
 *
 * The walk answers only where x lies well inside a cell; on faces the tree decides among all cells
 * that touch x, so that the answer does not depend on where the search began. A position on a face
 * between ranks belongs to the lower one, a node to its owner. */
#include "grid/grid_private.h"

#define MAX_WALK 24

PetscErrorCode GridBinsDestroy(GridBins **bins)
{
  PetscFunctionBeginUser;
  if (!*bins) PetscFunctionReturn(0);
  PetscCall(PetscFree((*bins)->neighbour));
  PetscCall(PetscFree((*bins)->far_cell));
  PetscCall(PetscFree((*bins)->file_node));
  PetscCall(BoxTreeDestroy(&(*bins)->cell_tree));
  PetscCall(BoxTreeDestroy(&(*bins)->face_tree));
  PetscCall(PetscFree(*bins));
  PetscFunctionReturn(0);
}

static void grow(PetscReal bounds[6], PetscInt dim, const PetscReal *x)
{
  for (PetscInt d = 0; d < dim; ++d) {
    bounds[d] = PetscMin(bounds[d], x[d]);
    bounds[d + 3] = PetscMax(bounds[d + 3], x[d]);
  }
}

static void start_bounds(PetscReal bounds[6], PetscInt dim)
{
  for (PetscInt d = 0; d < 3; ++d) {
    bounds[d] = d < dim ? PETSC_MAX_REAL : 0;
    bounds[d + 3] = d < dim ? -PETSC_MAX_REAL : 0;
  }
}

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

static PetscErrorCode CellTree(const Grid *grid, BoxTree **tree)
{
  const PetscInt nn = grid->nodes_per_cell, dim = grid->dim;
  PetscReal(*bounds)[6];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc(sizeof *bounds * (size_t)grid->n_cells, &bounds));
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    start_bounds(bounds[c], dim);
    for (PetscInt i = 0; i < nn; ++i) grow(bounds[c], dim, grid->x + grid->cell_node[c * nn + i] * dim);
    pad(bounds[c], dim);
  }
  PetscCall(BoxTreeCreate(grid->n_cells, bounds, tree));
  PetscFunctionReturn(0);
}

static inline const PetscReal *face_node_x(const Grid *grid, PetscInt face, PetscInt i)
{
  const GridSet *outer = &grid->outer;
  const PetscInt local = cells[grid->type].face[outer->face_side[face]][i];
  return grid->x + grid->cell_node[outer->face_cell[face] * grid->nodes_per_cell + local] * grid->dim;
}

static PetscErrorCode FaceTree(const Grid *grid, BoxTree **tree)
{
  PetscReal(*bounds)[6];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc(sizeof *bounds * (size_t)grid->outer.n_faces, &bounds));
  for (PetscInt f = 0; f < grid->outer.n_faces; ++f) {
    start_bounds(bounds[f], grid->dim);
    for (PetscInt i = 0; i < cells[grid->type].face_nodes; ++i) grow(bounds[f], grid->dim, face_node_x(grid, f, i));
  }
  PetscCall(BoxTreeCreate(grid->outer.n_faces, bounds, tree));
  PetscFunctionReturn(0);
}

PetscErrorCode GridBinsCreate(Grid *grid, PetscInt *neighbour, PetscInt *far_cell, PetscInt *file_node)
{
  PetscReal size = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&grid->bins));
  grid->bins->neighbour = neighbour;
  grid->bins->far_cell = far_cell;
  grid->bins->file_node = file_node;
  for (PetscInt d = 0; d < grid->dim; ++d) size = PetscMax(size, grid->max[d] - grid->min[d]);
  grid->bins->tolerance = PetscMax(1e-10, 2e-12 * size / grid->smallest);
  PetscCall(CellTree(grid, &grid->bins->cell_tree));
  PetscCall(FaceTree(grid, &grid->bins->face_tree));
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
  const PetscInt n_faces = cells[grid->type].faces, *neighbour = grid->bins->neighbour + cell * n_faces;
  const PetscReal margin = 0.01 * grid->bins->tolerance;
  PetscReal N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES], distance[6];
  PetscMPIInt rank;
  (void)MPI_Comm_rank(grid->comm, &rank);
  cell_shape(grid->type, xi, N, dN);
  for (PetscInt i = 0; i < grid->nodes_per_cell; ++i)
    if (N[i] >= 1.0 - 3.0 * margin) return grid->cell_node[cell * grid->nodes_per_cell + i] < grid->n_owned;
  side_distances(grid->type, N, distance);
  for (PetscInt f = 0; f < n_faces; ++f)
    if (distance[f] <= margin && neighbour[f] <= -2 && -2 - neighbour[f] < rank) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* How far x lies outside the cell, and where in it. */
static PetscReal try_cell(const Grid *grid, PetscInt cell, const PetscReal *x, PetscReal *xi)
{
  PetscReal nodes[3 * CELL_MAX_NODES];
  grid_cell_x(grid, cell, nodes);
  return cell_inverse_map(grid->type, nodes, x, xi) ? cell_outside(grid->type, xi) : PETSC_MAX_REAL;
}

/* The cell that surely holds x, stepping through the side that x lies most beyond; -1 if the walk
 * ends elsewhere. */
static PetscInt walk(const Grid *grid, const PetscReal *x, PetscInt cell, PetscReal *xi)
{
  const PetscInt n_faces = cells[grid->type].faces;
  for (int step = 0; step < MAX_WALK && cell >= 0; ++step) {
    PetscReal N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES], distance[6];
    PetscInt worst = 0;
    const PetscReal outside = try_cell(grid, cell, x, xi);
    if (outside < -grid->bins->tolerance) return cell;
    if (outside <= grid->bins->tolerance || outside == PETSC_MAX_REAL) return -1;
    cell_shape(grid->type, xi, N, dN);
    side_distances(grid->type, N, distance);
    for (PetscInt f = 1; f < n_faces; ++f)
      if (distance[f] < distance[worst]) worst = f;
    cell = grid->bins->neighbour[cell * n_faces + worst];
  }
  return -1;
}

typedef struct {
  const Grid *grid;
  const PetscReal *x;
  PetscInt cell;
  PetscReal outside, *xi;
} Best;

/* Keep the cell that x lies deepest in, the lowest of equals. */
static PetscBool try_candidate(void *context, PetscInt cell)
{
  Best *best = context;
  PetscReal xi[3];
  const PetscReal outside = try_cell(best->grid, cell, best->x, xi);
  if (outside > best->outside || (outside == best->outside && cell > best->cell)) return PETSC_TRUE;
  best->cell = cell;
  best->outside = outside;
  for (PetscInt d = 0; d < best->grid->dim; ++d) best->xi[d] = xi[d];
  return outside >= -best->grid->bins->tolerance; /* well inside: no other cell can hold it */
}

PetscInt mesh_locate(const Grid *grid, const PetscReal *x, PetscInt guess, PetscReal *xi)
{
  const PetscReal at[3] = {x[0], x[1], grid->dim == 3 ? x[2] : 0};
  Best best = {grid, x, -1, PETSC_MAX_REAL, xi};
  if (guess >= 0 && guess < grid->n_cells) {
    const PetscInt cell = walk(grid, x, guess, xi);
    if (cell >= 0) return cell;
  }
  box_tree_holding(grid->bins->cell_tree, at, try_candidate, &best);
  if (best.cell < 0 || best.outside > grid->bins->tolerance) return -1;
  if (best.outside < -grid->bins->tolerance) return best.cell;
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

/* --- the nearest boundary --- */

static inline PetscReal dot(const PetscReal *a, const PetscReal *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static PetscReal squared_gap(const PetscReal *a, const PetscReal *b)
{
  const PetscReal d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return dot(d, d);
}

static void nearest_on_segment(const PetscReal *a, const PetscReal *b, const PetscReal *x, PetscReal *nearest)
{
  const PetscReal e[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, r[3] = {x[0] - a[0], x[1] - a[1], x[2] - a[2]};
  const PetscReal t = PetscMin(PetscMax(dot(e, r) / dot(e, e), 0.0), 1.0);
  for (int d = 0; d < 3; ++d) nearest[d] = a[d] + t * e[d];
}

static void keep_nearer(const PetscReal *x, const PetscReal *trial, PetscReal *nearest, PetscReal *least)
{
  const PetscReal gap = squared_gap(x, trial);
  if (gap >= *least) return;
  *least = gap;
  for (int d = 0; d < 3; ++d) nearest[d] = trial[d];
}

/* The foot of the perpendicular if it lies in the triangle, else the nearest position of its edges. */
static void nearest_on_triangle(const PetscReal *const v[3], const PetscReal *x, PetscReal *nearest, PetscReal *least)
{
  PetscReal e[3], g[3], r[3], trial[3];
  for (int d = 0; d < 3; ++d) e[d] = v[1][d] - v[0][d], g[d] = v[2][d] - v[0][d], r[d] = x[d] - v[0][d];
  const PetscReal ee = dot(e, e), eg = dot(e, g), gg = dot(g, g), er = dot(e, r), gr = dot(g, r);
  const PetscReal det = ee * gg - eg * eg, s = (gg * er - eg * gr) / det, t = (ee * gr - eg * er) / det;
  if (s >= 0 && t >= 0 && s + t <= 1) {
    for (int d = 0; d < 3; ++d) trial[d] = v[0][d] + s * e[d] + t * g[d];
    keep_nearer(x, trial, nearest, least);
    return;
  }
  for (int k = 0; k < 3; ++k) {
    nearest_on_segment(v[k], v[(k + 1) % 3], x, trial);
    keep_nearer(x, trial, nearest, least);
  }
}

/* The nearest position of a boundary face; a quadrilateral counts as two triangles. */
static PetscReal nearest_on_face(const Grid *grid, PetscInt face, const PetscReal *x, PetscReal *nearest)
{
  const PetscInt n = cells[grid->type].face_nodes;
  PetscReal v[4][3] = {{0}}, least = PETSC_MAX_REAL;
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt d = 0; d < grid->dim; ++d) v[i][d] = face_node_x(grid, face, i)[d];
  if (n == 2) {
    nearest_on_segment(v[0], v[1], x, nearest);
    return squared_gap(x, nearest);
  }
  for (PetscInt t = 2; t < n; ++t) {
    const PetscReal *const triangle[3] = {v[0], v[t - 1], v[t]};
    nearest_on_triangle(triangle, x, nearest, &least);
  }
  return least;
}

typedef struct {
  const Grid *grid;
  const PetscReal *x;
} Probe;

static PetscReal probe_face(void *context, PetscInt face)
{
  const Probe *probe = context;
  PetscReal nearest[3];
  return nearest_on_face(probe->grid, face, probe->x, nearest);
}

/* Move a reference position into the reference cell. */
static void clamp_reference(const Grid *grid, PetscReal *xi)
{
  const PetscBool simplex = grid->nodes_per_cell == grid->dim + 1;
  PetscReal sum = 0;
  for (PetscInt d = 0; d < grid->dim; ++d) {
    xi[d] = simplex ? PetscMax(xi[d], 0.0) : PetscMin(PetscMax(xi[d], -1.0), 1.0);
    sum += xi[d];
  }
  for (PetscInt d = 0; d < grid->dim && simplex && sum > 1.0; ++d) xi[d] /= sum;
}

void mesh_clamp(const Grid *grid, PetscReal *x)
{
  const PetscReal at[3] = {x[0], x[1], grid->dim == 3 ? x[2] : 0};
  const Probe probe = {grid, at};
  PetscReal xi[3], nearest[3], nodes[3 * CELL_MAX_NODES], N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES];
  if (mesh_locate(grid, x, -1, xi) >= 0) return;
  const PetscInt face = box_tree_nearest(grid->bins->face_tree, at, probe_face, (void *)&probe);
  if (face < 0) return;
  (void)nearest_on_face(grid, face, at, nearest);
  for (PetscInt d = 0; d < grid->dim; ++d) x[d] = nearest[d];
  /* A warped face is not where its triangles are: the cell itself has the last word. */
  grid_cell_x(grid, grid->outer.face_cell[face], nodes);
  if (!cell_inverse_map(grid->type, nodes, nearest, xi)) return;
  clamp_reference(grid, xi);
  cell_shape(grid->type, xi, N, dN);
  for (PetscInt d = 0; d < grid->dim; ++d) {
    x[d] = 0;
    for (PetscInt i = 0; i < grid->nodes_per_cell; ++i) x[d] += N[i] * nodes[i * grid->dim + d];
  }
}
