/* The surface of a body that brings a mesh of its own: sides of that mesh, in parts that are small beside a cell of the
 * grid, and what the selector takes of each. */
#include "base/gather.h"
#include "boundary/sides/box_side.h"
#include "boundary/sides/side_keys.h"
#include "boundary/surface/surface.h"
#include "points/seed/outline.h"

#define PARTS_A_CELL 4 /* along an edge */
#define MOST_PARTS 64
#define INWARDS 1e-6 /* of a cell: a part on a line of the grid belongs to the cell that holds the material */
#define NOTHING 1e-8 /* of a part: round-off, and the selector's tolerance */

Bearer body_bearer(const BodySpec *body, PetscBool fills)
{
  if (body->mesh) return BORNE_BY_MESH;
  return body_fills_shape(body, fills) ? BORNE_BY_SHAPE : BORNE_BY_CELLS;
}

typedef struct {
  PetscInt n, capacity;
  FacePoint *point;
} Parts;

static PetscErrorCode Add(Parts *parts, const FacePoint *part)
{
  PetscFunctionBeginUser;
  if (parts->n == parts->capacity) {
    parts->capacity = PetscMax(256, 2 * parts->capacity);
    PetscCall(PetscRealloc((size_t)parts->capacity * sizeof *part, &parts->point));
  }
  parts->point[parts->n++] = *part;
  PetscFunctionReturn(0);
}

/* The cells of the mesh that the body has: of its region, and with their middle in its shape. */
static PetscErrorCode ChooseCells(const Grid *own, const BodySpec *body, PetscInt *n, PetscInt **list)
{
  const GridSet *set = body->region ? grid_find_set(own, body->region) : NULL;
  PetscReal centre[3];

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(own->n_cells, list));
  for (PetscInt k = 0; k < (set ? set->n_cells : own->n_cells); ++k) {
    const PetscInt cell = set ? set->cells[k] : k;
    grid_cell_centre(own, cell, centre);
    if (!body->has_shape || shape_contains(&body->shape, own->dim, centre, 0)) (*list)[(*n)++] = cell;
  }
  PetscFunctionReturn(0);
}

/* Sides of the body's cells that are its surface, and of the boundary of this name, if one is named. */
static PetscErrorCode ChooseSides(const Grid *own, const BodySpec *body, const char *boundary, PetscInt *n,
                                  PetscInt **cell, PetscInt **side)
{
  PetscInt n_cells, *list;
  unsigned char *outer;

  PetscFunctionBeginUser;
  PetscCall(ChooseCells(own, body, &n_cells, &list));
  PetscCall(PetscMalloc1(n_cells * CELL_MOST_SIDES, &outer));
  PetscCall(PetscMalloc1(n_cells * CELL_MOST_SIDES, cell));
  PetscCall(PetscMalloc1(n_cells * CELL_MOST_SIDES, side));
  PetscCall(OutlineSidesOfAll(own, n_cells, list, outer));
  *n = 0;
  for (PetscInt k = 0; k < n_cells * CELL_MOST_SIDES; ++k)
    if (outer[k]) (*cell)[*n] = list[k / CELL_MOST_SIDES], (*side)[(*n)++] = k % CELL_MOST_SIDES;
  if (boundary) PetscCall(SidesNamed(own, boundary, n, *cell, *side));
  PetscCall(PetscFree(list));
  PetscCall(PetscFree(outer));
  PetscFunctionReturn(0);
}

typedef PetscReal Corners[4][3];

static PetscReal longest_edge(PetscInt nodes, const Corners x)
{
  PetscReal most = 0;
  for (PetscInt i = 0; i < nodes; ++i) {
    PetscReal square = 0;
    for (int d = 0; d < 3; ++d) square += PetscSqr(x[(i + 1) % nodes][d] - x[i][d]);
    most = PetscMax(most, square);
  }
  return PetscSqrtReal(most);
}

/* A place of an edge, a triangle or a quadrilateral, (0, 0) at its first corner. */
static void place_at(PetscInt nodes, const Corners x, PetscReal s, PetscReal t, PetscReal *at)
{
  for (int d = 0; d < 3; ++d) {
    at[d] = x[0][d] + s * (x[1][d] - x[0][d]);
    if (nodes > 2) at[d] += t * (x[nodes - 1][d] - x[0][d]);
    if (nodes == 4) at[d] += s * t * (x[0][d] - x[1][d] + x[2][d] - x[3][d]);
  }
}

/* Part (i, j) of a side whose edges are cut into n; turned: the triangle beside it that points the other way. */
static void cut_part(PetscInt nodes, const Corners x, PetscInt n, PetscInt i, PetscInt j, PetscBool turned,
                     Corners part)
{
  static const PetscInt square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                        triangle[2][3][2] = {{{0, 0}, {1, 0}, {0, 1}}, {{1, 1}, {0, 1}, {1, 0}}};
  const PetscInt(*at)[2] = nodes == 3 ? triangle[turned] : square;
  for (PetscInt k = 0; k < nodes; ++k)
    place_at(nodes, x, (PetscReal)(i + at[k][0]) / (PetscReal)n, (PetscReal)(j + at[k][1]) / (PetscReal)n, part[k]);
}

/* The piece that stands for a part: its middle and half edges, of a triangle those of a parallelogram of its area. */
static void find_edges(PetscInt nodes, const Corners x, FacePoint *part)
{
  const PetscReal half = nodes == 3 ? 0.5 / PETSC_SQRT2 : 0.5;
  for (int d = 0; d < 3; ++d) {
    const PetscReal low = x[1][d] - x[0][d], left = nodes > 2 ? x[nodes - 1][d] - x[0][d] : 0;
    const PetscReal twist = nodes == 4 ? 0.5 * (x[0][d] - x[1][d] + x[2][d] - x[3][d]) : 0;
    part->edge[0][d] = half * (low + twist);
    part->edge[1][d] = half * (left + twist);
    part->x[d] = 0;
    for (PetscInt i = 0; i < nodes; ++i) part->x[d] += x[i][d] / (PetscReal)nodes;
  }
}

/* What its edges span, outwards. */
static void find_vector(PetscInt dim, FacePoint *part)
{
  const PetscReal thick[3] = {0, 0, 0.5}, *u = part->edge[0], *v = dim == 2 ? thick : part->edge[1];
  part->area = 0;
  for (int d = 0; d < 3; ++d) {
    part->vector[d] = 4 * (u[(d + 1) % 3] * v[(d + 2) % 3] - u[(d + 2) % 3] * v[(d + 1) % 3]);
    part->area += PetscSqr(part->vector[d]);
  }
  part->area = PetscSqrtReal(part->area);
}

typedef struct {
  const Kinematics *kinematics;
  const Grid *grid, *own;
  const Selector *on;
  Selector ranges;     /* the same without its shape */
  BodySurface surface; /* the sides of the mesh, bounded by no shape */
} Cutting;

/* Of the corners, from the middle. */
static PetscReal reach_of(PetscInt nodes, const Corners x, const PetscReal *middle)
{
  PetscReal most = 0;
  for (PetscInt i = 0; i < nodes; ++i) {
    PetscReal square = 0;
    for (int d = 0; d < 3; ++d) square += PetscSqr(x[i][d] - middle[d]);
    most = PetscMax(most, square);
  }
  return PetscSqrtReal(most);
}

/* What a selector takes of a part. */
static PieceSum sum_taken(const Cutting *c, const Selector *on, PetscInt nodes, const Corners x, const FacePoint *part)
{
  const PetscInt dim = c->own->dim;
  BodySurface surface = c->surface;
  const Trim trim = {.body = &surface, .k = -1};
  PieceSum sum = {.origin = {part->x[0], part->x[1], part->x[2]}};
  surface.on = on;
  for (PetscInt k = 0; k + dim <= nodes; ++k) {
    Facet facet = {{0}};
    for (int d = 0; d < 3; ++d) facet[0][d] = x[0][d], facet[1][d] = x[k + 1][d];
    for (int d = 0; d < 3 && dim == 3; ++d) facet[2][d] = x[k + 2][d];
    surface_trim(&trim, facet, part->vector, &sum);
  }
  return sum;
}

/* Where the selector ends within a part, a piece with the area, middle and spread of what it takes is left of that;
 * where it does not, the part itself or nothing. To look for a shape's end costs a hundred times what ranges do. */
static void select_part(const Cutting *c, PetscInt nodes, const Corners x, FacePoint *part)
{
  const PetscInt dim = c->own->dim;
  const Shape *shape = c->on->has_shape ? &c->on->shape : NULL;
  const PetscReal whole = part->area, reach = reach_of(nodes, x, part->x);
  part->area = 0;
  if (shape && !shape_contains(shape, dim, part->x, reach)) return;
  const PetscBool within = (PetscBool)(!shape || shape_contains(shape, dim, part->x, -reach));
  const PieceSum sum = sum_taken(c, within ? &c->ranges : c->on, nodes, x, part);
  if (sum.area < NOTHING * whole) return;
  part->area = whole;
  if (sum.area < (1 - NOTHING) * whole) surface_piece(dim, &sum, part);
}

static PetscErrorCode AddPart(const Cutting *c, PetscInt nodes, const Corners x, Parts *parts)
{
  FacePoint part = {.area = 0};

  PetscFunctionBeginUser;
  find_edges(nodes, x, &part);
  find_vector(c->own->dim, &part);
  select_part(c, nodes, x, &part);
  const PetscReal weight = kinematics_weight(c->kinematics, part.x[0]);
  part.area *= weight; /* as wide as the circle is long in a ring */
  for (int d = 0; d < 3; ++d) part.vector[d] *= weight;
  if (part.area > 0) PetscCall(Add(parts, &part));
  PetscFunctionReturn(0);
}

static PetscErrorCode CutSide(const Cutting *c, PetscInt cell, PetscInt side, Parts *parts)
{
  const Cell *type = grid_cell(c->own, cell);
  const PetscInt *node = c->own->cell_node + cell * c->own->nodes_per_cell, nodes = type->face_nodes;
  Corners x = {{0}}, part = {{0}};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < nodes; ++i)
    for (PetscInt d = 0; d < c->own->dim; ++d) x[i][d] = c->own->x[node[type->face[side][i]] * c->own->dim + d];
  const PetscReal wanted = PetscCeilReal(PARTS_A_CELL * longest_edge(nodes, x) / c->grid->smallest * (1 - 1e-6));
  const PetscInt n = (PetscInt)PetscMin(MOST_PARTS, wanted), rows = nodes == 2 ? 1 : n;
  for (PetscInt j = 0; j < rows; ++j)
    for (PetscInt i = 0; i < (nodes == 3 ? n - j : n); ++i) {
      cut_part(nodes, x, n, i, j, PETSC_FALSE, part);
      PetscCall(AddPart(c, nodes, part, parts));
      if (nodes != 3 || i + j > n - 2) continue;
      cut_part(nodes, x, n, i, j, PETSC_TRUE, part);
      PetscCall(AddPart(c, nodes, part, parts));
    }
  PetscFunctionReturn(0);
}

/* Each part has the cell in which it is, on the first rank that has this cell; what lies outside of the grid none. */
static PetscErrorCode Locate(const Grid *grid, PetscInt field, Parts *parts, PetscInt *cell)
{
  PetscMPIInt rank, size, *first;
  PetscReal at[3], xi[3], x[CELL_MAX_NODES * 3];
  PetscInt kept = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  PetscCall(PetscMalloc1(parts->n, &first));
  for (PetscInt k = 0; k < parts->n; ++k) {
    const FacePoint *part = parts->point + k;
    for (int d = 0; d < 3; ++d) at[d] = part->x[d] - INWARDS * grid->smallest * part->vector[d] / part->area;
    cell[k] = grid_cell_in(grid, grid_locate(grid, at, -1, xi), field);
    first[k] = cell[k] >= 0 ? rank : size;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, first, (PetscMPIInt)parts->n, MPI_INT, MPI_MIN, grid->comm));
  for (PetscInt k = 0; k < parts->n; ++k) {
    if (first[k] != rank) continue;
    FacePoint *part = parts->point + kept;
    *part = parts->point[k];
    cell[kept] = cell[k];
    grid_cell_x(grid, cell[kept], x);
    (void)cell_inverse_map(grid_cell_type(grid, cell[kept++]), x, part->x, part->xi);
  }
  parts->n = kept;
  PetscCall(PetscFree(first));
  PetscFunctionReturn(0);
}

/* Parts of sides, or, where the body fills a shape of which the mesh is a part, the shape's surface in it. */
static PetscErrorCode CollectParts(const Cutting *cut, const Case *c, PetscInt body, PetscBool fills, PetscBool pieces,
                                   Parts *parts)
{
  PetscInt n, *cell, *side;

  PetscFunctionBeginUser;
  if (fills && c->bodies[body].has_shape) {
    PetscCall(BodySurfacePoints(cut->own, c, body, cut->on, pieces, &n, &cell, &parts->point));
    parts->n = n;
    PetscCall(PetscFree(cell));
    PetscFunctionReturn(0);
  }
  PetscCall(ChooseSides(cut->own, c->bodies + body, cut->on->boundary, &n, &cell, &side));
  for (PetscInt f = 0; f < n; ++f) PetscCall(CutSide(cut, cell[f], side[f], parts));
  PetscCall(PetscFree(cell));
  PetscCall(PetscFree(side));
  PetscFunctionReturn(0);
}

PetscErrorCode BodyMeshAgain(const Grid *grid, const Case *c, PetscInt body, Grid **own)
{
  Diag *told;

  PetscFunctionBeginUser;
  *own = NULL;
  PetscCall(DiagCreate(&told));
  PetscCall(BodyMeshCreate(grid->comm, c, body, told, own));
  PetscCall(DiagDestroy(&told));
  PetscFunctionReturn(0);
}

/* A name that the mesh has for sides means these, whatever the grid has of that name. */
static PetscErrorCode ResolveName(const Grid *grid, const Grid *own, PetscBool of_shape, Selector *on)
{
  const GridSet *set = on->boundary && !of_shape ? grid_find_set(own, on->boundary) : NULL;
  PetscInt faces = set ? set->n_faces : 0;

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &faces, 1, MPIU_INT, MPI_MAX, grid->comm));
  if (!faces) put_on_side(grid, on);
  PetscFunctionReturn(0);
}

PetscErrorCode BodyMeshPoints(const Grid *grid, const Case *c, PetscInt body, const Selector *on, PetscBool fills,
                              PetscBool pieces, PetscInt *n, PetscInt **cell, FacePoint **point)
{
  Selector at = *on;
  Cutting cut = {.kinematics = c->kinematics, .grid = grid, .on = &at};
  Parts parts = {0}, all = {0}; /* of this rank, and of all */
  Grid *own;

  PetscFunctionBeginUser;
  PetscCall(BodyMeshAgain(grid, c, body, &own));
  cut.own = own;
  if (own) PetscCall(ResolveName(grid, own, (PetscBool)(fills && c->bodies[body].has_shape), &at));
  cut.ranges = at;
  cut.ranges.has_shape = PETSC_FALSE;
  cut.surface = (BodySurface){.grid = own, .kinematics = &kinematics_3d};
  if (own) surface_set_steps(&cut.surface, own->smallest);
  if (own) PetscCall(CollectParts(&cut, c, body, fills, pieces, &parts));
  PetscCall(GridDestroy(&own));
  PetscCall(GatherAll(grid->comm, sizeof(FacePoint), parts.n, parts.point, &all.n, &all.point));
  PetscCall(PetscFree(parts.point));
  PetscCall(PetscMalloc1(all.n, cell));
  PetscCall(Locate(grid, grid->n_fields > 1 ? case_field(c, body) : 0, &all, *cell));
  *n = all.n;
  *point = all.point;
  PetscFunctionReturn(0);
}
