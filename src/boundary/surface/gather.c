/* Points that carry what a body's surface bears. */
#include "base/math/eigen.h"
#include "boundary/surface/surface.h"

/* Of a cell: so far a surface is drawn in, so that one along a side belongs to the cell that holds the material; and so
 * far beside a surface the shape is asked. Both more than positions in the grid are rounded by. */
#define SLACK 1e-14
#define STEP 1e-8
#define ROUNDED 4e-16 /* of a coordinate */
#define NOTHING 1e-14 /* of a cell's side */
#define EVEN 1e-6     /* of the variance: by so much the axes of a piece must differ to be its own */

/* Of the middles of two equal halves of a straight piece from its middle, over its deviation. */
#define HALVES (0.5 * PetscSqrtReal(3))

typedef struct {
  const BodySurface *body;
  const Kinematics
    *pieces; /* of the case, where pieces are asked for: these are summed as in the plane; NULL: points */
  PetscInt n, capacity, *cell;
  FacePoint *point;
} Gather;

static PetscErrorCode Reserve(Gather *g)
{
  PetscFunctionBeginUser;
  if (g->n + FACE_MAX_POINTS <= g->capacity) PetscFunctionReturn(0);
  g->capacity = PetscMax(256, 2 * g->capacity);
  PetscCall(PetscRealloc((size_t)g->capacity * sizeof *g->cell, &g->cell));
  PetscCall(PetscRealloc((size_t)g->capacity * sizeof *g->point, &g->point));
  PetscFunctionReturn(0);
}

/* A square spreads alike along all axes of its plane, and round-off would choose among them: the first becomes the
 * grid's that lies nearest to the plane, of several as near the first. */
static void level_axes(PetscReal axis[3][3])
{
  const PetscReal *n = axis[2];
  PetscReal *u = axis[0], *v = axis[1];
  int flat = 0;
  for (int d = 1; d < 3; ++d)
    if (PetscSqr(n[d]) < PetscSqr(n[flat]) - EVEN) flat = d;
  const PetscReal length = PetscSqrtReal(1 - PetscSqr(n[flat]));
  for (int d = 0; d < 3; ++d) u[d] = ((d == flat ? 1 : 0) - n[flat] * n[d]) / length;
  for (int d = 0; d < 3; ++d) v[d] = n[(d + 1) % 3] * u[(d + 2) % 3] - n[(d + 2) % 3] * u[(d + 1) % 3];
}

/* How positions on it spread about the middle. */
static void spread_of(const PieceSum *sum, PetscReal mid[3], PetscReal C[6])
{
  for (int d = 0; d < 3; ++d) mid[d] = sum->first[d] / sum->area;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) C[voigt_of[i][j]] = sum->second[i][j] / sum->area - mid[i] * mid[j];
}

/* Deviations along the axes of the spread, falling. */
static void find_deviations(const PetscReal C[6], PetscReal along[2][3])
{
  PetscReal value[3], v[9], axis[3][3];
  sym_eigen(C, value, v);
  for (int k = 0; k < 3; ++k)
    for (int d = 0; d < 3; ++d) axis[k][d] = v[3 * d + k];
  if (value[0] - value[1] < EVEN * value[0]) level_axes(axis);
  for (int k = 0; k < 2; ++k)
    for (int d = 0; d < 3; ++d) along[k][d] = PetscSqrtReal(PetscMax(0, value[k])) * axis[k][d];
}

/* From the middle of the parallelogram of this spread to those of its quarters. Of all such parallelograms it is the
 * one of which an edge stands across the axis along which the spread is largest: a rectangle along axes is itself, be
 * it a square or not. */
static void find_edges(const PetscReal C[6], PetscReal along[2][3])
{
  PetscReal rest[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rest[i][j] = C[voigt_of[i][j]];
  for (int k = 0; k < 2; ++k) {
    int most = 0;
    for (int d = 1; d < 3; ++d) most = rest[d][d] > rest[most][most] ? d : most;
    const PetscReal root = PetscSqrtReal(PetscMax(0, rest[most][most]));
    for (int d = 0; d < 3; ++d) along[k][d] = root > 0 ? rest[d][most] / root : 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) rest[i][j] -= along[k][i] * along[k][j];
  }
  for (int i = 0; i < 6; ++i) along[i / 3][i % 3] *= HALVES;
}

/* dual[k] . along[k] is 1, dual[k] of the other direction 0; no direction, no dual. */
static void find_duals(PetscReal along[2][3], PetscReal nothing, PetscReal dual[2][3])
{
  PetscReal square[2] = {0, 0}, both = 0;
  for (int d = 0; d < 3; ++d) {
    for (int k = 0; k < 2; ++k) square[k] += PetscSqr(along[k][d]);
    both += along[0][d] * along[1][d];
  }
  for (int k = 0; k < 2; ++k) {
    const PetscBool alone = (PetscBool) !(square[1 - k] > nothing * nothing);
    const PetscReal part = alone ? 0 : both / square[1 - k], rest = square[k] - part * both;
    for (int d = 0; d < 3; ++d)
      dual[k][d] = square[k] > nothing * nothing ? (along[k][d] - part * along[1 - k][d]) / rest : 0;
  }
}

/* By how much vectors change along each direction, as the sum's moment of x and the normal has it. */
static void find_turns(const PieceSum *sum, const PetscReal mid[3], PetscReal dual[2][3], PetscReal turn[2][3])
{
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 3; ++j) {
      turn[k][j] = 0;
      for (int i = 0; i < 3; ++i) turn[k][j] += dual[k][i] * (sum->turn[i][j] - mid[i] * sum->vector[j]);
    }
}

/* A piece has edges, and a weight in a ring. */
static void make_piece(const Gather *g, PetscReal along[2][3], FacePoint *p)
{
  const PetscReal weight = kinematics_weight(g->pieces, p->x[0]);
  p->area *= weight;
  for (int d = 0; d < 3; ++d) p->vector[d] *= weight;
  for (PetscInt k = 0; k < (g->body->grid->dim == 3 ? 2 : 1); ++k)
    for (int d = 0; d < 3; ++d) p->edge[k][d] = along[k][d];
}

void surface_piece(PetscInt dim, const PieceSum *sum, FacePoint *piece)
{
  PetscReal mid[3], C[6], quarter[2][3];
  spread_of(sum, mid, C);
  find_edges(C, quarter);
  *piece = (FacePoint){.area = sum->area};
  for (int d = 0; d < 3; ++d) {
    piece->x[d] = sum->origin[d] + mid[d];
    piece->vector[d] = sum->vector[d];
    for (PetscInt k = 0; k + 1 < dim; ++k) piece->edge[k][d] = 2 * quarter[k][d];
  }
}

/* Is there anything? The end of a surface of the next cell is as wide as round-off or the selector's tolerance, and
 * what lies on the axis of rings has no area. */
static PetscBool is_something(const Gather *g, PetscReal size, const PieceSum *sum)
{
  const PetscReal whole = PetscPowReal(size, (PetscReal)(g->body->grid->dim - 1));
  if (!(sum->area > STEP * whole)) return PETSC_FALSE;
  if (!g->pieces || !g->pieces->hoop) return PETSC_TRUE;
  return (PetscBool)(sum->origin[0] * sum->area + sum->first[0] > STEP * size * sum->area);
}

/* The sum as points: equal areas, a deviation to both sides of the middle, or so far that pieces beside each other have
 * that; vectors differ as much as their moments along the piece say. */
static PetscErrorCode Emit(Gather *g, PetscInt cell, PetscReal size, const PieceSum *sum)
{
  const Grid *grid = g->body->grid;
  const PetscInt along = grid->dim - 1, n = along == 1 ? 2 : 4;
  PetscReal mid[3], C[6], to[2][3], dual[2][3], turn[2][3], x[CELL_MAX_NODES * 3];

  PetscFunctionBeginUser;
  if (!is_something(g, size, sum)) PetscFunctionReturn(0);
  PetscCall(Reserve(g));
  spread_of(sum, mid, C);
  if (g->pieces) find_edges(C, to);
  else find_deviations(C, to);
  for (int d = 0; d < 3 && along == 1; ++d) to[1][d] = 0;
  find_duals(to, NOTHING * size, dual);
  find_turns(sum, mid, dual, turn);
  grid_cell_x(grid, cell, x);
  for (PetscInt q = 0; q < n; ++q) {
    const PetscReal side[2] = {q % 2 ? 1 : -1, q / 2 ? 1 : -1};
    FacePoint *p = g->point + g->n;
    *p = (FacePoint){.area = sum->area / (PetscReal)n};
    for (PetscInt d = 0; d < grid->dim; ++d) {
      p->x[d] = sum->origin[d] + mid[d];
      p->vector[d] = sum->vector[d] / (PetscReal)n;
      for (PetscInt k = 0; k < along; ++k) {
        p->x[d] += side[k] * to[k][d];
        p->vector[d] += side[k] * turn[k][d] / (PetscReal)n;
      }
    }
    if (g->pieces) make_piece(g, to, p);
    (void)cell_inverse_map(grid_cell_type(grid, cell), x, p->x, p->xi);
    g->cell[g->n++] = cell;
  }
  PetscFunctionReturn(0);
}

typedef struct {
  PetscReal x[CELL_MAX_NODES * 3], centre[3], size; /* nodes; half its diagonal */
} CellBox;

static void look_at(const Grid *grid, PetscInt cell, CellBox *box)
{
  grid_cell_x(grid, cell, box->x);
  grid_cell_centre(grid, cell, box->centre);
  box->size = 0;
  for (PetscInt i = 0; i < grid_cell(grid, cell)->nodes; ++i) {
    PetscReal square = 0;
    for (PetscInt d = 0; d < grid->dim; ++d) square += PetscSqr(box->x[i * grid->dim + d] - box->centre[d]);
    box->size = PetscMax(box->size, PetscSqrtReal(square));
  }
}

/* Can a surface be in this cell? */
static PetscBool reaches(const Surface *s, PetscInt dim, const CellBox *box)
{
  PetscReal gradient[3];
  for (PetscInt d = 0; d < dim; ++d)
    if (box->centre[d] + 1.001 * box->size < s->min[d] || box->centre[d] - 1.001 * box->size > s->max[d])
      return PETSC_FALSE;
  return (PetscBool)(PetscAbsReal(surface_distance(s, dim, box->centre, gradient)) <= 1.001 * box->size * s->steepness);
}

void surface_set_steps(BodySurface *body, PetscReal size)
{
  PetscReal largest = 0;
  for (PetscInt d = 0; d < body->grid->dim; ++d)
    largest = PetscMax(largest, PetscMax(PetscAbsReal(body->grid->min[d]), PetscAbsReal(body->grid->max[d])));
  body->slack = SLACK * size + ROUNDED * largest;
  body->step = STEP * size + 100 * ROUNDED * largest;
}

static PetscErrorCode AddCell(Gather *g, BodySurface *body, PetscInt cell)
{
  CellBox box;

  PetscFunctionBeginUser;
  look_at(body->grid, cell, &box);
  surface_set_steps(body, box.size);
  for (PetscInt k = 0; k < body->n_surfaces; ++k) {
    const Trim trim = {.body = body, .k = k};
    PieceSum sum = {.origin = {box.centre[0], box.centre[1], body->grid->dim == 3 ? box.centre[2] : 0}};
    if (!reaches(body->surfaces + k, body->grid->dim, &box)) continue;
    surface_march(&trim, grid_cell_type(body->grid, cell), box.x, &sum);
    PetscCall(Emit(g, cell, box.size, &sum));
  }
  PetscFunctionReturn(0);
}

/* A side at which the grid ends, or the region that the body keeps to: the shape may go on there. */
static PetscErrorCode AddSide(Gather *g, BodySurface *body, PetscInt cell, PetscInt side)
{
  const Cell *type = grid_cell(body->grid, cell);
  const PetscInt dim = body->grid->dim;
  Trim trim = {.body = body, .k = -1};
  PieceSum sum = {.area = 0};
  FacePoint q[FACE_MAX_POINTS];
  CellBox box;

  PetscFunctionBeginUser;
  look_at(body->grid, cell, &box);
  surface_set_steps(body, box.size);
  (void)face_quadrature(&kinematics_3d, body->grid, cell, side, q);
  for (int d = 0; d < 3; ++d) {
    sum.origin[d] = d < dim ? box.centre[d] : 0;
    trim.outward[d] = q[0].vector[d] / q[0].area;
  }
  for (PetscInt k = 0; k + dim <= type->face_nodes; ++k) {
    const PetscInt corner[3] = {0, k + 1, k + 2};
    Facet facet = {{0}};
    for (PetscInt i = 0; i < dim; ++i)
      for (PetscInt d = 0; d < dim; ++d) facet[i][d] = box.x[type->face[side][corner[i]] * dim + d];
    surface_trim(&trim, facet, trim.outward, &sum);
  }
  PetscCall(Emit(g, cell, box.size, &sum));
  PetscFunctionReturn(0);
}

/* Does the cell reach into the box around the shape? */
static PetscBool is_near(const Grid *grid, PetscInt cell, const PetscReal min[3], const PetscReal max[3])
{
  CellBox box;
  look_at(grid, cell, &box);
  for (PetscInt d = 0; d < grid->dim; ++d)
    if (box.centre[d] + 1.001 * box.size < min[d] || box.centre[d] - 1.001 * box.size > max[d]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Cells of this rank that the body may be in. */
static PetscErrorCode CellsNear(const Grid *grid, const BodySpec *body, PetscInt field, PetscInt *n, PetscInt **list)
{
  const GridSet *set = body->region ? grid_find_set(grid, body->region) : NULL;
  PetscReal min[3], max[3];

  PetscFunctionBeginUser;
  shape_bounds(&body->shape, grid->dim, min, max);
  *n = 0;
  PetscCall(PetscMalloc1(set ? set->n_cells : grid->n_cells, list));
  for (PetscInt k = 0; k < (set ? set->n_cells : grid->n_cells); ++k) {
    const PetscInt cell = set ? set->cells[k] : k;
    if (grid_field_of(grid, cell) == field && is_near(grid, cell, min, max)) (*list)[(*n)++] = cell;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BodySurfacePoints(const Grid *grid, const Case *c, PetscInt body, const Selector *on, PetscBool pieces,
                                 PetscInt *n, PetscInt **cell, FacePoint **point)
{
  BodySurface surface = {
    .grid = grid, .kinematics = pieces ? &kinematics_3d : c->kinematics, .shape = &c->bodies[body].shape, .on = on};
  Gather gather = {.body = &surface, .pieces = pieces ? c->kinematics : NULL};
  PetscInt n_cells, *list;
  unsigned char *outer;

  PetscFunctionBeginUser;
  PetscCall(SurfacesCreate(surface.shape, grid->dim, &surface.n_surfaces, &surface.surfaces));
  PetscCall(CellsNear(grid, c->bodies + body, grid->n_fields > 1 ? case_field(c, body) : 0, &n_cells, &list));
  PetscCall(PetscMalloc1(n_cells * CELL_MOST_SIDES, &outer));
  PetscCall(OutlineSidesOfAll(grid, n_cells, list, outer));
  for (PetscInt k = 0; k < n_cells; ++k) {
    PetscCall(AddCell(&gather, &surface, list[k]));
    for (PetscInt side = 0; side < grid_cell(grid, list[k])->faces; ++side)
      if (outer[k * CELL_MOST_SIDES + side]) PetscCall(AddSide(&gather, &surface, list[k], side));
  }
  PetscCall(PetscFree(outer));
  PetscCall(PetscFree(list));
  PetscCall(PetscFree(surface.surfaces));
  *n = gather.n;
  *cell = gather.cell;
  *point = gather.point;
  PetscFunctionReturn(0);
}
