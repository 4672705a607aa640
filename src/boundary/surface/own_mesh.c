/* The surface of a body that brings a mesh of its own: sides of that mesh, in parts that are small beside a cell of the
 * grid. */
#include "base/gather.h"
#include "boundary/sides/box_side.h"
#include "boundary/sides/side_keys.h"
#include "boundary/surface/surface.h"
#include "points/seed/outline.h"

#define PARTS_A_CELL 4 /* along an edge */
#define MOST_PARTS 64
#define INWARDS 1e-6 /* of a cell: a part on a line of the grid belongs to the cell that holds the material */

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

/* Part (i, j) of an edge, or of a quadrilateral, each cut into n along its edges. */
static void cut_square(PetscInt nodes, const Corners x, PetscInt n, PetscInt i, PetscInt j, FacePoint *part)
{
  const PetscReal s = ((PetscReal)i + 0.5) / (PetscReal)n, t = nodes == 2 ? 0 : ((PetscReal)j + 0.5) / (PetscReal)n;
  const PetscInt far[2] = {nodes == 2 ? 1 : 2, nodes == 2 ? 0 : 3};
  for (int d = 0; d < 3; ++d) {
    const PetscReal low = x[1][d] - x[0][d], high = x[far[0]][d] - x[far[1]][d];
    const PetscReal left = x[far[1]][d] - x[0][d], right = x[far[0]][d] - x[1][d];
    part->edge[0][d] = 0.5 * (nodes == 2 ? low : (1 - t) * low + t * high) / (PetscReal)n;
    part->edge[1][d] = nodes == 2 ? 0 : 0.5 * ((1 - s) * left + s * right) / (PetscReal)n;
    part->x[d] = x[0][d] + s * low + t * ((1 - s) * left + s * right);
  }
}

/* Triangle (i, j) of those into which one is cut, or the one that points the other way beside it. The parallelogram
 * that stands for it has its area. */
static void cut_triangle(const Corners x, PetscInt n, PetscInt i, PetscInt j, PetscBool turned, FacePoint *part)
{
  const PetscReal off = turned ? 2. / 3 : 1. / 3;
  const PetscReal s = ((PetscReal)i + off) / (PetscReal)n, t = ((PetscReal)j + off) / (PetscReal)n;
  for (int d = 0; d < 3; ++d) {
    const PetscReal u = x[1][d] - x[0][d], v = x[2][d] - x[0][d];
    part->x[d] = x[0][d] + s * u + t * v;
    part->edge[0][d] = u / (2 * PETSC_SQRT2 * (PetscReal)n);
    part->edge[1][d] = v / (2 * PETSC_SQRT2 * (PetscReal)n);
  }
}

/* What its edges span, outwards, and as wide as the circle is long in a ring. */
static void weigh(const Kinematics *kinematics, PetscInt dim, FacePoint *part)
{
  const PetscReal weight = kinematics_weight(kinematics, part->x[0]), *u = part->edge[0];
  const PetscReal thick[3] = {0, 0, 0.5}, *v = dim == 2 ? thick : part->edge[1];
  part->area = 0;
  for (int d = 0; d < 3; ++d) {
    part->vector[d] = 4 * weight * (u[(d + 1) % 3] * v[(d + 2) % 3] - u[(d + 2) % 3] * v[(d + 1) % 3]);
    part->area += PetscSqr(part->vector[d]);
  }
  part->area = PetscSqrtReal(part->area);
}

typedef struct {
  const Kinematics *kinematics;
  const Grid *grid, *own;
  const Selector *on;
} Cutting;

static PetscErrorCode AddPart(const Cutting *c, FacePoint *part, Parts *parts)
{
  PetscFunctionBeginUser;
  weigh(c->kinematics, c->own->dim, part);
  if (part->area > 0 && grid_takes(c->own, c->on, part->x)) PetscCall(Add(parts, part));
  PetscFunctionReturn(0);
}

static PetscErrorCode CutSide(const Cutting *c, PetscInt cell, PetscInt side, Parts *parts)
{
  const Cell *type = grid_cell(c->own, cell);
  const PetscInt *node = c->own->cell_node + cell * c->own->nodes_per_cell, nodes = type->face_nodes;
  FacePoint part = {.area = 0};
  Corners x = {{0}};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < nodes; ++i)
    for (PetscInt d = 0; d < c->own->dim; ++d) x[i][d] = c->own->x[node[type->face[side][i]] * c->own->dim + d];
  const PetscReal wanted = PetscCeilReal(PARTS_A_CELL * longest_edge(nodes, x) / c->grid->smallest * (1 - 1e-6));
  const PetscInt n = (PetscInt)PetscMin(MOST_PARTS, wanted), rows = nodes == 2 ? 1 : n;
  for (PetscInt j = 0; j < rows; ++j)
    for (PetscInt i = 0; i < (nodes == 3 ? n - j : n); ++i) {
      if (nodes == 3) cut_triangle(x, n, i, j, PETSC_FALSE, &part);
      else cut_square(nodes, x, n, i, j, &part);
      PetscCall(AddPart(c, &part, parts));
      if (nodes != 3 || i + j > n - 2) continue;
      cut_triangle(x, n, i, j, PETSC_TRUE, &part);
      PetscCall(AddPart(c, &part, parts));
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
