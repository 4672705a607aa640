#include "boundary/normals.h"
#include "base/math/vector.h"
#include "base/math/eigen.h"
#include "boundary/bodies.h"

#define SIDES 6 /* a cell has at most */

typedef struct {
  PetscInt n, *cell, *side;
} Walls;

static PetscBool slides(const MotionSpec *entry) { return (PetscBool)(entry->component[NORMAL] && !entry->absent); }

/* Of one entry, or of all (< 0): sides that several of them take count once. */
static PetscErrorCode CollectSides(const Grid *grid, const Case *c, PetscInt only, Walls *walls)
{
  unsigned char *seen;
  PetscInt n, *cell, *side;

  PetscFunctionBeginUser;
  *walls = (Walls){0};
  PetscCall(PetscCalloc1(grid->n_cells * SIDES, &seen));
  for (PetscInt k = 0; k < c->n_boundary; ++k) {
    if (!slides(c->boundary + k) || (only >= 0 && k != only)) continue;
    PetscCall(GridSelectFaces(grid, &c->boundary[k].on, &n, &cell, &side));
    PetscCall(PetscRealloc((size_t)(walls->n + n) * sizeof(PetscInt), &walls->cell));
    PetscCall(PetscRealloc((size_t)(walls->n + n) * sizeof(PetscInt), &walls->side));
    for (PetscInt f = 0; f < n; ++f) {
      if (seen[cell[f] * SIDES + side[f]]++) continue;
      walls->cell[walls->n] = cell[f];
      walls->side[walls->n++] = side[f];
    }
    PetscCall(PetscFree(cell));
    PetscCall(PetscFree(side));
  }
  PetscCall(PetscFree(seen));
  PetscFunctionReturn(0);
}

/* Of an edge: N linear, and the circle 2 pi r linear, too. */
static void edge_normals(const Case *c, PetscReal x[4][3], PetscReal normal[4][3])
{
  const PetscReal a[2] = {kinematics_weight(c->kinematics, x[0][0]), kinematics_weight(c->kinematics, x[1][0])};
  for (int i = 0; i < 2; ++i) {
    const PetscReal weight = a[i] / 3 + a[1 - i] / 6;
    normal[i][0] = weight * (x[1][1] - x[0][1]);
    normal[i][1] = -weight * (x[1][0] - x[0][0]);
    normal[i][2] = 0;
  }
}

/* Of a face in space. On a quadrilateral x_s x x_t = m + u s + v t, exactly. */
static void face_normals(int nodes, PetscReal x[4][3], PetscReal normal[4][3])
{
  static const PetscReal s[4] = {-1, 1, 1, -1}, t[4] = {-1, -1, 1, 1};
  PetscReal a[3], b[3], c[3], m[3], u[3], v[3];
  for (int d = 0; d < 3; ++d) {
    a[d] = nodes == 3 ? x[1][d] - x[0][d] : (-x[0][d] + x[1][d] + x[2][d] - x[3][d]) / 4;
    b[d] = nodes == 3 ? x[2][d] - x[0][d] : (-x[0][d] - x[1][d] + x[2][d] + x[3][d]) / 4;
    c[d] = nodes == 3 ? 0 : (x[0][d] - x[1][d] + x[2][d] - x[3][d]) / 4;
  }
  vector_cross(a, b, m);
  vector_cross(a, c, u);
  vector_cross(c, b, v);
  for (int i = 0; i < nodes; ++i)
    for (int d = 0; d < 3; ++d) normal[i][d] = nodes == 3 ? m[d] / 6 : m[d] + (s[i] * u[d] + t[i] * v[d]) / 3;
}

/* The integrals of N_I n over a side of the walls, one way or the other; returns how many nodes it
 * has. */
static PetscInt side_normals(const Grid *grid, const Case *c, const Walls *walls, PetscInt f, PetscInt *node,
                             PetscReal normal[4][3])
{
  const Cell *cell = grid_cell(grid, walls->cell[f]);
  PetscReal x[4][3] = {{0}};
  for (PetscInt i = 0; i < cell->face_nodes; ++i) {
    node[i] = grid->cell_node[walls->cell[f] * grid->nodes_per_cell + cell->face[walls->side[f]][i]];
    for (PetscInt d = 0; d < 3; ++d) x[i][d] = d < grid->dim ? grid->x[node[i] * grid->dim + d] : 0;
  }
  if (grid->dim == 2) edge_normals(c, x, normal);
  else face_normals(cell->face_nodes, x, normal);
  return cell->face_nodes;
}

static PetscReal product(const PetscReal *a, const PetscReal *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void make_unit(PetscReal *v)
{
  const PetscReal norm = PetscSqrtReal(product(v, v));
  for (int d = 0; d < 3 && norm > 0; ++d) v[d] /= norm;
}

/* spread (n_nodes x 7): the sum of n n^T over the sides at each node, all alike, and their
 * number. */
static PetscErrorCode GatherSpread(const Grid *grid, const Case *c, const Walls *walls, PetscReal *spread)
{
  PetscInt node[4];
  PetscReal normal[4][3];

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < walls->n; ++f) {
    const PetscInt n = side_normals(grid, c, walls, f, node, normal);
    PetscReal mean[3] = {0, 0, 0};
    for (PetscInt i = 0; i < n; ++i)
      for (int d = 0; d < 3; ++d) mean[d] += normal[i][d];
    make_unit(mean);
    if (product(mean, mean) == 0) continue; /* on the axis: a circle of no length */
    for (PetscInt i = 0; i < n; ++i) {
      PetscReal *at = spread + node[i] * 7;
      for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b) at[voigt_of[a][b]] += mean[a] * mean[b];
      at[6] += 1;
    }
  }
  PetscCall(GridSumToOwners(grid, 7, spread));
  PetscCall(GridToGhosts(grid, 7, spread));
  PetscFunctionReturn(0);
}

/* normal (n_nodes x 3): the sum of the sides' integrals, each turned to that side of the wall to
 * which the main direction at the node points: walls inside the grid have cells on both. */
static PetscErrorCode GatherNormals(const Grid *grid, const Case *c, const Walls *walls, const PetscReal *spread,
                                    PetscReal *normal)
{
  PetscInt node[4];
  PetscReal side[4][3], value[3], v[9];

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < walls->n; ++f) {
    const PetscInt n = side_normals(grid, c, walls, f, node, side);
    for (PetscInt i = 0; i < n; ++i) {
      sym_eigen(spread + node[i] * 7, value, v);
      const PetscReal along = side[i][0] * v[0] + side[i][1] * v[3] + side[i][2] * v[6];
      for (int d = 0; d < 3; ++d) normal[node[i] * 3 + d] += along < 0 ? -side[i][d] : side[i][d];
    }
  }
  PetscCall(GridSumToOwners(grid, 3, normal));
  PetscCall(GridToGhosts(grid, 3, normal));
  PetscFunctionReturn(0);
}

/* Where the sides' normals spread in one direction only, that is the normal; where they spread in
 * more, these directions. Two walls at an angle have the shares cos2 and sin2 of its half. */
static void set_directions(PetscInt dim, const PetscReal *spread, const PetscReal *normal, WallNode *node)
{
  const PetscReal half = PetscSinReal(WALL_CORNER / 2);
  PetscReal value[3], v[9];
  if (spread[6] == 0) return;
  sym_eigen(spread, value, v);
  for (node->n = 1; node->n < dim && value[node->n] > half * half * spread[6];) ++node->n;
  for (PetscInt k = 0; k < node->n; ++k)
    for (int d = 0; d < 3; ++d) node->direction[3 * k + d] = v[3 * d + k];
  if (node->n > 1 || product(normal, normal) == 0) return;
  for (int d = 0; d < 3; ++d) node->direction[d] = normal[d];
  make_unit(node->direction);
}

/* Nodes of entries that slide, ascending, with the first such entry. */
static PetscErrorCode ListNodes(const Grid *grid, const Case *c, const PetscInt *field, PetscInt *n, WallNode **list)
{
  PetscInt *entry, n_selected, *node;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_nodes, &entry));
  for (PetscInt i = 0; i < grid->n_nodes; ++i) entry[i] = -1;
  *n = 0;
  for (PetscInt k = 0; k < c->n_boundary; ++k) {
    if (!slides(c->boundary + k)) continue;
    PetscCall(EntryNodes(grid, c, c->boundary + k, field, &n_selected, &node));
    for (PetscInt i = 0; i < n_selected; ++i) {
      if (entry[node[i]] >= 0) continue;
      entry[node[i]] = k;
      ++*n;
    }
    PetscCall(PetscFree(node));
  }
  PetscCall(PetscCalloc1(*n, list));
  for (PetscInt i = 0, k = 0; i < grid->n_nodes; ++i)
    if (entry[i] >= 0) (*list)[k++] = (WallNode){.node = i, .entry = entry[i]};
  PetscCall(PetscFree(entry));
  PetscFunctionReturn(0);
}

PetscErrorCode WallNormals(const Grid *grid, const Case *c, const PetscInt *field, PetscInt *n, WallNode **nodes)
{
  PetscReal *spread, *normal;
  Walls walls;
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  *n = 0;
  *nodes = NULL;
  for (PetscInt k = 0; k < c->n_boundary; ++k) any |= slides(c->boundary + k);
  if (!any) PetscFunctionReturn(0);
  PetscCall(ListNodes(grid, c, field, n, nodes));
  PetscCall(CollectSides(grid, c, -1, &walls));
  PetscCall(PetscCalloc2(grid->n_nodes * 7, &spread, grid->n_nodes * 3, &normal));
  PetscCall(GatherSpread(grid, c, &walls, spread));
  PetscCall(GatherNormals(grid, c, &walls, spread, normal));
  for (PetscInt k = 0; k < *n; ++k) {
    WallNode *at = *nodes + k;
    set_directions(grid->dim, spread + at->node * 7, normal + at->node * 3, at);
  }
  PetscCall(PetscFree2(spread, normal));
  PetscCall(PetscFree(walls.cell));
  PetscCall(PetscFree(walls.side));
  PetscFunctionReturn(0);
}

/* Of one entry at the nodes that it shares with others. Appends. */
static PetscErrorCode AddSides(const Grid *grid, const Case *c, const PetscInt *field, PetscInt entry,
                               const PetscInt *shared, PetscInt *n, WallSide **sides)
{
  PetscReal *spread, *normal;
  PetscInt n_selected, *node;
  Walls walls;

  PetscFunctionBeginUser;
  PetscCall(CollectSides(grid, c, entry, &walls));
  PetscCall(PetscCalloc2(grid->n_nodes * 7, &spread, grid->n_nodes * 3, &normal));
  PetscCall(GatherSpread(grid, c, &walls, spread));
  PetscCall(GatherNormals(grid, c, &walls, spread, normal));
  PetscCall(EntryNodes(grid, c, c->boundary + entry, field, &n_selected, &node));
  PetscCall(PetscRealloc((size_t)(*n + n_selected) * sizeof **sides, sides));
  for (PetscInt k = 0; k < n_selected; ++k) {
    PetscReal *at = normal + node[k] * 3;
    if (shared[node[k]] < 2 || product(at, at) == 0) continue;
    make_unit(at);
    (*sides)[(*n)++] = (WallSide){.node = node[k], .entry = entry, .normal = {at[0], at[1], at[2]}};
  }
  PetscCall(PetscFree2(spread, normal));
  PetscCall(PetscFree(node));
  PetscCall(PetscFree(walls.cell));
  PetscCall(PetscFree(walls.side));
  PetscFunctionReturn(0);
}

static int compare_sides(const void *a, const void *b)
{
  const WallSide *x = a, *y = b;
  if (x->node != y->node) return x->node < y->node ? -1 : 1;
  return x->entry < y->entry ? -1 : x->entry > y->entry;
}

PetscErrorCode WallSides(const Grid *grid, const Case *c, const PetscInt *field, PetscInt *n, WallSide **sides)
{
  PetscInt n_entries = 0, n_selected, *node, *shared;

  PetscFunctionBeginUser;
  *n = 0;
  *sides = NULL;
  for (PetscInt k = 0; k < c->n_boundary; ++k) n_entries += slides(c->boundary + k);
  if (n_entries < 2) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(grid->n_nodes, &shared));
  for (PetscInt k = 0; k < c->n_boundary; ++k) {
    if (!slides(c->boundary + k)) continue;
    PetscCall(EntryNodes(grid, c, c->boundary + k, field, &n_selected, &node));
    for (PetscInt i = 0; i < n_selected; ++i) ++shared[node[i]];
    PetscCall(PetscFree(node));
  }
  for (PetscInt k = 0; k < c->n_boundary; ++k)
    if (slides(c->boundary + k)) PetscCall(AddSides(grid, c, field, k, shared, n, sides));
  if (*n) qsort(*sides, (size_t)*n, sizeof **sides, compare_sides);
  PetscCall(PetscFree(shared));
  PetscFunctionReturn(0);
}
