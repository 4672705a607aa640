/* The nearest position inside a mesh: on the nearest face of the outer boundary that this rank
 * knows. */
#include "grid/mesh/mesh.h"
#include "base/math/vector.h"

/* Positions of a face's nodes; returns how many there are. */
static PetscInt face_x(const Grid *grid, PetscInt face, PetscReal x[4][3])
{
  const Cell *shape = grid_cell(grid, grid->outer.face_cell[face]);
  const PetscInt *node = grid->cell_node + grid->outer.face_cell[face] * grid->nodes_per_cell;
  for (PetscInt i = 0; i < shape->face_nodes; ++i)
    for (PetscInt d = 0; d < 3; ++d)
      x[i][d] = d < grid->dim ? grid->x[node[shape->face[grid->outer.face_side[face]][i]] * grid->dim + d] : 0;
  return shape->face_nodes;
}

PetscErrorCode MeshFaceTree(const Grid *grid, BoxTree **tree)
{
  PetscReal(*bounds)[6], x[4][3];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc(sizeof *bounds * (size_t)grid->outer.n_faces, &bounds));
  for (PetscInt f = 0; f < grid->outer.n_faces; ++f) {
    const PetscInt n = face_x(grid, f, x);
    box_around(3, n, x[0], bounds[f]);
  }
  PetscCall(BoxTreeCreate(grid->outer.n_faces, bounds, tree));
  PetscFunctionReturn(0);
}

static PetscReal squared_gap(const PetscReal *a, const PetscReal *b)
{
  const PetscReal d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return vector_dot(d, d);
}

static void nearest_on_segment(const PetscReal *a, const PetscReal *b, const PetscReal *x, PetscReal *nearest)
{
  const PetscReal e[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, r[3] = {x[0] - a[0], x[1] - a[1], x[2] - a[2]};
  const PetscReal t = PetscMin(PetscMax(vector_dot(e, r) / vector_dot(e, e), 0.0), 1.0);
  for (int d = 0; d < 3; ++d) nearest[d] = a[d] + t * e[d];
}

static void keep_nearer(const PetscReal *x, const PetscReal *trial, PetscReal *nearest, PetscReal *least)
{
  const PetscReal gap = squared_gap(x, trial);
  if (gap >= *least) return;
  *least = gap;
  for (int d = 0; d < 3; ++d) nearest[d] = trial[d];
}

/* The foot of the perpendicular if it lies in the triangle, else the nearest position of its
 * edges. */
static void nearest_on_triangle(const PetscReal *const v[3], const PetscReal *x, PetscReal *nearest, PetscReal *least)
{
  PetscReal e[3], g[3], r[3], trial[3];
  for (int d = 0; d < 3; ++d) e[d] = v[1][d] - v[0][d], g[d] = v[2][d] - v[0][d], r[d] = x[d] - v[0][d];
  const PetscReal ee = vector_dot(e, e), eg = vector_dot(e, g), gg = vector_dot(g, g), er = vector_dot(e, r),
                  gr = vector_dot(g, r);
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
  PetscReal v[4][3], least = PETSC_MAX_REAL;
  const PetscInt n = face_x(grid, face, v);
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
static void clamp_reference(const Cell *shape, PetscReal *xi)
{
  const PetscBool simplex = shape->nodes == shape->dim + 1;
  PetscReal sum = 0;
  for (PetscInt d = 0; d < shape->dim; ++d) {
    xi[d] = simplex ? PetscMax(xi[d], 0.0) : PetscMin(PetscMax(xi[d], -1.0), 1.0);
    sum += xi[d];
  }
  for (PetscInt d = 0; d < shape->dim && simplex && sum > 1.0; ++d) xi[d] /= sum;
}

void mesh_clamp(const Grid *grid, PetscReal *x)
{
  const PetscReal at[3] = {x[0], x[1], grid->dim == 3 ? x[2] : 0};
  const Probe probe = {grid, at};
  PetscReal xi[3], nearest[3], nodes[3 * CELL_MAX_NODES], N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES];
  if (mesh_locate(grid, x, -1, xi) >= 0) return;
  const PetscInt face = box_tree_nearest(grid->mesh->face_tree, at, PETSC_MAX_REAL, probe_face, (void *)&probe);
  if (face < 0) return;
  (void)nearest_on_face(grid, face, at, nearest);
  for (PetscInt d = 0; d < grid->dim; ++d) x[d] = nearest[d];
  /* A warped face is not where its triangles are: the cell itself has the last word. */
  const CellType type = grid_cell_type(grid, grid->outer.face_cell[face]);
  grid_cell_x(grid, grid->outer.face_cell[face], nodes);
  if (!cell_inverse_map(type, nodes, nearest, xi)) return;
  clamp_reference(cells + type, xi);
  cell_shape(type, xi, N, dN);
  for (PetscInt d = 0; d < grid->dim; ++d) {
    x[d] = 0;
    for (PetscInt i = 0; i < cells[type].nodes; ++i) x[d] += N[i] * nodes[i * grid->dim + d];
  }
}
