#include "boundary/loads.h"
#include "boundary/sides/box_side.h"
#include "boundary/sides/faces.h"
#include "boundary/sides/load_sides.h"
#include "boundary/surface/surface.h"
#include "support/basis.h"

PetscBool touched_shape(const Grid *grid, PetscInt cell, const PetscReal *xi, const unsigned char *touched,
                        PetscReal *N)
{
  const PetscInt nn = grid->nodes_per_cell, *node = grid->cell_node + cell * nn;
  PetscReal sum = 0;
  grid_shape(grid, cell, xi, N);
  for (PetscInt I = 0; I < nn; ++I) {
    if (!touched[node[I]]) N[I] = 0;
    sum += N[I];
  }
  if (sum <= 1e-12) return PETSC_FALSE;
  for (PetscInt I = 0; I < nn; ++I) N[I] /= sum;
  return PETSC_TRUE;
}

/* At the ends of a piece the functions are others than their means over it. */
static void scale_middle(const unsigned char *touched, CarrierShape *s)
{
  PetscReal sum = 0;
  for (PetscInt I = 0; I < s->n; ++I) sum += s->M[I] = touched[s->node[I]] ? s->M[I] : 0;
  for (PetscInt I = 0; I < s->n; ++I) s->M[I] = sum > 1e-12 ? s->M[I] / sum : s->N[I];
}

/* Scaled to sum to one. */
static void among_touched(const unsigned char *touched, CarrierShape *s)
{
  PetscReal sum = 0, slope[3] = {0, 0, 0};
  for (PetscInt I = 0; I < s->n; ++I) {
    if (!touched[s->node[I]]) s->N[I] = 0;
    for (PetscInt d = 0; d < 3; ++d) {
      if (!touched[s->node[I]]) s->dN[3 * I + d] = 0;
      slope[d] += s->dN[3 * I + d];
    }
    sum += s->N[I];
  }
  if (sum <= 1e-12) s->n = 0;
  for (PetscInt I = 0; I < s->n; ++I) {
    s->N[I] /= sum;
    for (PetscInt d = 0; d < 3; ++d) s->dN[3 * I + d] = (s->dN[3 * I + d] - s->N[I] * slope[d]) / sum;
  }
  scale_middle(touched, s);
}

static void shape_of_support(const Loads *l, PetscInt p, CarrierShape *s)
{
  const Support *w = l->support;
  if (p >= w->n_groups) return;
  s->n = support_nodes(w, p);
  s->node = w->node + w->node_start[p];
  for (PetscInt I = 0; I < s->n; ++I) {
    const PetscReal *dN = support_dN(w, p, p, l->slopes) + l->slopes * I;
    s->N[I] = support_N(w, p, p)[I];
    s->M[I] = l->slopes > l->dim ? dN[l->dim] : s->N[I];
    for (PetscInt d = 0; d < 3; ++d) s->dN[3 * I + d] = d < l->dim ? dN[d] : 0;
  }
}

static void shape_of_cell(const Loads *l, const Grid *grid, PetscInt p, CarrierShape *s)
{
  const PetscInt cell = l->carriers->cell[p], dim = l->dim;
  PetscReal x[CELL_MAX_NODES * 3], dN[3 * CELL_MAX_NODES];
  if (cell < 0) return;
  s->n = grid_cell(grid, cell)->nodes;
  s->node = grid->cell_node + cell * grid->nodes_per_cell;
  grid_cell_x(grid, cell, x);
  (void)cell_gradients(grid_cell_type(grid, cell), x, point_real(l->carriers, POINT_XI, p), s->N, dN);
  for (PetscInt I = 0; I < s->n; ++I) {
    s->M[I] = s->N[I];
    for (PetscInt d = 0; d < 3; ++d) s->dN[3 * I + d] = d < dim ? dN[dim * I + d] : 0;
  }
}

void carrier_shape(const Loads *l, const Grid *grid, PetscInt p, const unsigned char *touched, CarrierShape *shape)
{
  shape->n = 0;
  if (l->support) shape_of_support(l, p, shape);
  else shape_of_cell(l, grid, p, shape);
  among_touched(touched, shape);
}

static PetscErrorCode AddCarrier(Loads *loads, const Grid *grid, PetscInt load, PetscInt cell, const FacePoint *at,
                                 const PetscReal *force)
{
  Points *p = loads->carriers;
  PetscInt i;

  PetscFunctionBeginUser;
  PetscCall(PointsAppend(p, &i));
  p->cell[i] = cell;
  p->body[i] = load;
  p->id[i] = ((PetscInt64)load << 40) + i;
  if (p->components[POINT_FIELD]) p->real[POINT_FIELD][i] = (PetscReal)grid_field_of(grid, cell);
  for (PetscInt d = 0; d < loads->dim; ++d) {
    point_real(p, POINT_X, i)[d] = at->x[d];
    point_real(p, POINT_XI, i)[d] = at->xi[d];
    point_real(p, POINT_FORCE, i)[d] = force[d];
  }
  for (PetscInt k = 0; k < p->components[POINT_EDGE]; ++k)
    point_real(p, POINT_EDGE, i)[k] = at->edge[k / loads->dim][k % loads->dim];
  for (PetscInt d = 0; d < p->components[POINT_LEAN]; ++d)
    point_real(p, POINT_LEAN, i)[d] = load_lean(at->x, at->edge[0], d);
  PetscFunctionReturn(0);
}

#define BESIDE 0.02 /* of a cell: a force on the surface of a shape, by the digits that a user writes */

/* Does the force act beside all bodies, those that come later among them? PETSC_FALSE, too, where bodies do not end
 * where shapes do: there the cell tells. */
static PetscBool is_beside_all(const Case *c, const Grid *grid, const PetscReal *at, PetscBool fills)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    const BodySpec *body = c->bodies + b;
    if (body_bearer(body, fills) != BORNE_BY_SHAPE || body->region) return PETSC_FALSE;
    if (shape_contains(&body->shape, grid->dim, at, BESIDE * grid->smallest)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static void tell_beside(const char *path, Diag *diag)
{
  diag_error(diag, path, "no material carries the force: it acts outside of all bodies");
  diag_hint(diag, "a place in a body, or on its surface: bodies end where their shapes do");
}

/* A point force: the lowest rank that holds the position carries it. */
static PetscErrorCode PointLoad(Loads *loads, const Grid *grid, const Points *points, PetscInt load, PetscBool fills,
                                const char *path, Diag *diag)
{
  const LoadSpec *spec = &loads->c->loads[load];
  FacePoint at = {.x = {spec->at[0], spec->at[1], spec->at[2]}};
  PetscMPIInt rank, mine, first, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  const PetscInt cell = grid_cell_in(grid, grid_locate(grid, spec->at, -1, at.xi), points_field_near(points, spec->at));
  mine = cell >= 0 ? rank : size;
  PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, grid->comm));
  if (first == rank) PetscCall(AddCarrier(loads, grid, load, cell, &at, spec->value));
  if (first == size) diag_error(diag, path, "the force acts at a position outside the grid");
  else if (is_beside_all(loads->c, grid, spec->at, fills)) tell_beside(path, diag);
  PetscFunctionReturn(0);
}

static PetscErrorCode FacesFree(LoadFaces *faces)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(faces->cell));
  PetscCall(PetscFree(faces->N));
  PetscCall(PetscFree(faces->x));
  faces->n = 0;
  PetscFunctionReturn(0);
}

/* The quadrature points of a face; there is room for them. */
static void add_face(LoadFaces *faces, const Grid *grid, PetscInt cell, PetscInt n, const FacePoint *q)
{
  const PetscInt nn = grid->nodes_per_cell;
  PetscReal N[CELL_MAX_NODES];
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt i = faces->n++;
    faces->cell[i] = cell;
    grid_shape(grid, cell, q[k].xi, N);
    for (PetscInt I = 0; I < nn; ++I) faces->N[i * nn + I] = N[I] * q[k].area;
    for (PetscInt d = 0; d < grid->dim; ++d) faces->x[3 * i + d] = q[k].x[d];
  }
}

static PetscErrorCode GridTraction(Loads *loads, const Grid *grid, const Points *points, PetscInt load,
                                   PetscInt *n_faces)
{
  LoadFaces *faces = &loads->faces[load];
  PetscInt n, *cell, *side;
  FacePoint q[FACE_MAX_POINTS];

  PetscFunctionBeginUser;
  PetscCall(FacesFree(faces));
  PetscCall(SidesOfGrid(grid, points, &loads->c->loads[load].on, &n, &cell, &side));
  PetscCall(PetscMalloc1(n * FACE_MAX_POINTS, &faces->cell));
  PetscCall(PetscCalloc1(n * FACE_MAX_POINTS * grid->nodes_per_cell, &faces->N));
  PetscCall(PetscCalloc1(n * FACE_MAX_POINTS * 3, &faces->x));
  faces->used = PETSC_TRUE;
  for (PetscInt f = 0; f < n; ++f)
    add_face(faces, grid, cell[f], face_quadrature(loads->c->kinematics, grid, cell[f], side[f], q), q);
  PetscCall(MPIU_Allreduce(&n, n_faces, 1, MPIU_INT, MPI_SUM, grid->comm));
  PetscCall(PetscFree(cell));
  PetscCall(PetscFree(side));
  PetscFunctionReturn(0);
}

/* The load's force on the surface around a quadrature point: a pressure pushes into the material. */
static void force_on(const LoadSpec *load, const FacePoint *q, PetscReal force[3])
{
  const PetscBool pushes = load->kind == LOAD_PRESSURE;
  for (int d = 0; d < 3; ++d) force[d] = pushes ? -load->value[0] * q->vector[d] : q->area * load->value[d];
}

static PetscErrorCode CarryFaces(Loads *loads, const Grid *grid, PetscInt load, PetscInt n, const PetscInt *cell,
                                 const PetscInt *side)
{
  FacePoint q[FACE_MAX_POINTS];
  PetscReal force[3];

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < n; ++f) {
    const PetscInt nq = loads_have_pieces(loads) ? face_pieces(loads->c->kinematics, grid, cell[f], side[f], q)
                                                 : face_quadrature(loads->c->kinematics, grid, cell[f], side[f], q);
    for (PetscInt k = 0; k < nq; ++k) {
      if (!(q[k].area > 0)) continue; /* on the axis of rings */
      force_on(&loads->c->loads[load], &q[k], force);
      PetscCall(AddCarrier(loads, grid, load, cell[f], &q[k], force));
    }
  }
  PetscFunctionReturn(0);
}

/* On the surface of a shape that cells do not follow, or of a mesh of the body's own. */
static PetscErrorCode CarrySurface(Loads *loads, const Grid *grid, PetscInt load, PetscInt body, PetscBool fills,
                                   PetscInt *n)
{
  const LoadSpec *spec = &loads->c->loads[load];
  const PetscBool pieces = loads_have_pieces(loads);
  Selector on = spec->on;
  FacePoint *q = NULL;
  PetscInt *cell = NULL;
  PetscReal force[3];

  PetscFunctionBeginUser;
  *n = 0;
  put_on_side(grid, &on);
  if (body_bearer(loads->c->bodies + body, fills) == BORNE_BY_MESH)
    PetscCall(BodyMeshPoints(grid, loads->c, body, &spec->on, fills, pieces, n, &cell, &q));
  else if (!on.boundary) PetscCall(BodySurfacePoints(grid, loads->c, body, &on, pieces, n, &cell, &q));
  for (PetscInt k = 0; k < *n; ++k) {
    force_on(spec, &q[k], force);
    PetscCall(AddCarrier(loads, grid, load, cell[k], &q[k], force));
  }
  PetscCall(PetscFree(cell));
  PetscCall(PetscFree(q));
  PetscFunctionReturn(0);
}

/* Carriers on the boundary of a body. */
static PetscErrorCode BodyTraction(Loads *loads, const Grid *grid, const Points *points, PetscInt load, PetscBool fills,
                                   PetscInt *n_faces)
{
  const LoadSpec *spec = &loads->c->loads[load];
  const PetscInt body = case_body(loads->c, spec->on.body);
  PetscInt n, *cell, *side;

  PetscFunctionBeginUser;
  if (body_bearer(loads->c->bodies + body, fills) != BORNE_BY_CELLS) {
    PetscCall(CarrySurface(loads, grid, load, body, fills, &n));
  } else {
    PetscCall(BodyFaces(grid, points, body, &spec->on, PETSC_FALSE, &n, &cell, &side));
    PetscCall(CarryFaces(loads, grid, load, n, cell, side));
    PetscCall(PetscFree(cell));
    PetscCall(PetscFree(side));
  }
  PetscCall(MPIU_Allreduce(&n, n_faces, 1, MPIU_INT, MPI_SUM, grid->comm));
  PetscFunctionReturn(0);
}

/* Carriers on the faces of the grid whose cells hold points. */
static PetscErrorCode CarryBoundary(Loads *loads, const Grid *grid, const Points *points, PetscInt load,
                                    PetscInt *n_faces)
{
  PetscInt n, both, *cell, *side;

  PetscFunctionBeginUser;
  PetscCall(FilledSides(grid, points, &loads->c->loads[load].on, &n, &cell, &side, &both));
  PetscCall(CarryFaces(loads, grid, load, n, cell, side));
  PetscCall(MPIU_Allreduce(&n, n_faces, 1, MPIU_INT, MPI_SUM, grid->comm));
  PetscCall(PetscFree(cell));
  PetscCall(PetscFree(side));
  PetscFunctionReturn(0);
}

PetscErrorCode LoadsCreate(const Grid *grid, const Case *c, const Points *points, PetscBool fills, Diag *diag,
                           Loads **loads)
{
  Loads *l;
  PetscInt faces;
  Diag *unheard;
  char list[64], path[80];

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&unheard)); /* of what waits the stage tells in which it begins */
  PetscCall(PetscNew(&l));
  l->c = c;
  l->dim = grid->dim;
  l->n_nodes = grid->n_nodes;
  l->slopes = grid->dim;
  PetscCall(PetscCalloc1(c->n_loads, &l->faces));
  PetscCall(PetscCalloc1(c->n_loads, &l->asked));
  PetscCall(FollowersCreate(l->dim, l->dim, &l->carriers));
  l->carriers->components[POINT_FIELD] = points->components[POINT_FIELD];
  if (basis_find(c->basis.kind)->carry) l->carriers->components[POINT_EDGE] = l->dim * (l->dim - 1);
  if (l->carriers->components[POINT_EDGE] && c->kinematics->hoop) l->carriers->components[POINT_LEAN] = l->dim;
  for (PetscInt k = 0; k < c->n_loads; ++k) {
    const LoadKind kind = c->loads[k].kind;
    Diag *tell = c->loads[k].waits ? unheard : diag;
    PetscCall(PetscSNPrintf(path, sizeof path, "%s.%s", case_load_path(c, k, list), kind == LOAD_POINT ? "at" : "on"));
    if (kind == LOAD_POINT) {
      PetscCall(PointLoad(l, grid, points, k, fills, path, tell));
      continue;
    }
    if (c->loads[k].on.body) PetscCall(BodyTraction(l, grid, points, k, fills, &faces));
    else if (kind == LOAD_PRESSURE) PetscCall(CarryBoundary(l, grid, points, k, &faces));
    else PetscCall(GridTraction(l, grid, points, k, &faces));
    PetscCall(LoadSidesTell(grid, c, points, k, fills, faces, path, tell));
  }
  PetscCall(PointsSort(l->carriers));
  PetscCall(LoadFactorsCheck(l, grid->comm, diag));
  PetscCall(DiagDestroy(&unheard));
  *loads = l;
  PetscFunctionReturn(0);
}

PetscErrorCode LoadsLeaveCells(Loads *l, const Grid *grid, const Points *points)
{
  PetscInt faces;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < l->c->n_loads; ++k) {
    const LoadSpec *load = l->c->loads + k;
    PetscCall(FacesFree(&l->faces[k]));
    l->faces[k].used = PETSC_FALSE;
    if (load->kind == LOAD_TRACTION && !load->on.body) PetscCall(CarryBoundary(l, grid, points, k, &faces));
  }
  PetscCall(PointsSort(l->carriers));
  PetscFunctionReturn(0);
}

PetscErrorCode LoadsRegrid(Loads *l, const Grid *old, const Grid *grid, const Points *points)
{
  PetscInt faces, moved = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < l->c->n_loads; ++k) {
    if (l->c->loads[k].kind != LOAD_TRACTION || l->c->loads[k].on.body) continue;
    PetscCall(GridTraction(l, grid, points, k, &faces));
  }
  PetscCall(PointsRepartition(l->carriers, old, grid, &moved));
  l->n_nodes = grid->n_nodes;
  PetscFunctionReturn(0);
}

PetscErrorCode LoadsDestroy(Loads **loads)
{
  PetscFunctionBeginUser;
  if (!*loads) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < (*loads)->c->n_loads; ++k) PetscCall(FacesFree(&(*loads)->faces[k]));
  PetscCall(PetscFree((*loads)->faces));
  PetscCall(PetscFree((*loads)->asked));
  PetscCall(PointsDestroy(&(*loads)->carriers));
  PetscCall(PetscFree(*loads));
  PetscFunctionReturn(0);
}

/* factors: n x 3, or NULL */
static void push_faces(const LoadFaces *faces, const Grid *grid, const PetscReal *value, PetscReal factor,
                       const PetscReal *factors, const unsigned char *filled, PetscReal *residual)
{
  const PetscInt nn = grid->nodes_per_cell, dim = grid->dim;
  for (PetscInt f = 0; f < faces->n; ++f) {
    const PetscInt *node = grid->cell_node + faces->cell[f] * nn;
    PetscReal traction[3];
    if (!filled[faces->cell[f]]) continue;
    for (PetscInt d = 0; d < dim; ++d) traction[d] = factor * value[d] * (factors ? factors[3 * f + d] : 1);
    for (PetscInt I = 0; I < nn; ++I)
      for (PetscInt d = 0; d < dim; ++d) residual[node[I] * dim + d] -= faces->N[f * nn + I] * traction[d];
  }
}

/* factors: three, or NULL */
static void push_carrier(const Loads *l, const Grid *grid, PetscInt p, PetscReal factor, const PetscReal *factors,
                         const unsigned char *touched, PetscReal *residual)
{
  const PetscInt dim = l->dim, cell = l->carriers->cell[p], *node;
  PetscInt nn = grid->nodes_per_cell;
  PetscReal N[CLOUD_MAX_NODES];
  if (l->support) {
    if (p >= l->support->n_groups) return;
    nn = support_nodes(l->support, p);
    node = l->support->node + l->support->node_start[p];
    if (!support_touched(l->support, p, touched, N)) return;
  } else {
    node = grid->cell_node + cell * nn;
    if (cell < 0 || !touched_shape(grid, cell, point_real(l->carriers, POINT_XI, p), touched, N)) return;
  }
  for (PetscInt I = 0; I < nn; ++I)
    for (PetscInt d = 0; d < dim; ++d)
      residual[node[I] * dim + d] -=
        factor * N[I] * point_real(l->carriers, POINT_FORCE, p)[d] * (factors ? factors[d] : 1);
}

PetscErrorCode LoadsPush(const Loads *l, const Grid *grid, PetscReal t, const unsigned char *filled,
                         const unsigned char *touched, PetscReal *residual)
{
  PetscReal *factors;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < l->c->n_loads; ++k) {
    PetscCall(LoadFactorsOfFaces(l, k, t, &factors));
    push_faces(&l->faces[k], grid, l->c->loads[k].value, case_factor(l->c, &l->c->loads[k].amplitude, t), factors,
               filled, residual);
    PetscCall(PetscFree(factors));
  }
  PetscCall(LoadFactorsOfCarriers(l, PETSC_FALSE, t, &factors));
  for (PetscInt p = 0; p < l->carriers->n; ++p) {
    const LoadSpec *load = l->c->loads + l->carriers->body[p];
    if (load->kind != LOAD_PRESSURE)
      push_carrier(l, grid, p, case_factor(l->c, &load->amplitude, t), factors ? factors + 3 * p : NULL, touched,
                   residual);
  }
  PetscCall(PetscFree(factors));
  PetscFunctionReturn(0);
}
