/* From cells to a cloud: what gmm does once, before the first step. */
#include "boundary/bodies.h"
#include "model/model_private.h"

#define TAKEN (-1) /* of a node that no body of its velocity field has, but one of another field */

/* What a body has that others meet at an interface is no obstacle to these: the body is before it, however thin. */
static void mark_taken(const Grid *mesh, PetscReal *mark)
{
  const PetscInt nn = mesh->nodes_per_cell, entries = mesh->n_fields > 1 ? mesh->n_cells / mesh->n_fields * nn : 0;
  for (PetscInt e = 0; e < entries; ++e) {
    PetscReal most = 0;
    for (PetscInt f = 0; f < mesh->n_fields; ++f) most = PetscMax(most, mark[mesh->cell_node[f * entries + e]]);
    for (PetscInt f = 0; f < mesh->n_fields && most > 0; ++f)
      if (mark[mesh->cell_node[f * entries + e]] <= 0) mark[mesh->cell_node[f * entries + e]] = TAKEN;
  }
}

/* Nodes of cells that hold points, and nodes whose motion is prescribed: obstacles, and the body's
 * own boundary. The axis is no obstacle where the body has no nodes on it. Owners know of all ranks'
 * cells. */
static PetscErrorCode MarkNodes(const Model *m, unsigned char *marked, unsigned char *twin)
{
  const Grid *mesh = m->grid;
  const PetscInt nn = mesh->nodes_per_cell;
  PetscReal *mark;
  unsigned char *beyond;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes, &mark));
  PetscCall(PetscMalloc1(mesh->n_owned, &beyond));
  for (PetscInt p = 0; p < m->points->n; ++p)
    for (PetscInt I = 0; I < nn; ++I) mark[mesh->cell_node[m->points->cell[p] * nn + I]] = 1;
  PetscCall(GridSumToOwners(mesh, 1, mark));
  PetscCall(GridToGhosts(mesh, 1, mark));
  PetscCall(CloudBeyondFaces(m, mark, beyond));
  mark_taken(mesh, mark);
  for (PetscInt i = 0; i < mesh->n_owned; ++i) {
    twin[i] = 0;
    for (PetscInt d = 0; d < m->dim && mark[i] != TAKEN; ++d) twin[i] |= m->boundary->fixed[i * m->dim + d];
    if (beyond[i] || (mark[i] <= 0 && boundary_slides_on_axis(m->boundary, i))) twin[i] = 0;
    marked[i] = mark[i] > 0 ? CLOUD_BODY : (twin[i] ? CLOUD_OBSTACLE : 0);
  }
  PetscCall(PetscFree(mark));
  PetscCall(PetscFree(beyond));
  PetscFunctionReturn(0);
}

/* Followers in a mesh go with the nodes of their cell; beside all bodies with the nearest point. */
static void follow_fields(const Model *m, const PetscInt *field, Points *followers)
{
  const Grid *mesh = m->grid;
  for (PetscInt p = 0; p < followers->n; ++p) {
    PetscInt mine = -1;
    for (PetscInt I = 0; I < mesh->nodes_per_cell && mine < 0; ++I)
      mine = field[mesh->cell_node[followers->cell[p] * mesh->nodes_per_cell + I]];
    if (mine < 0) mine = points_field_near(m->points, point_real(followers, POINT_X, p));
    followers->real[POINT_FIELD][p] = (PetscReal)mine;
  }
}

/* Fields of a mesh are those of its bodies; a box has told its points. */
static void tell_points(const Model *m, const PetscInt *field)
{
  if (m->grid->n_fields > 1) return;
  for (PetscInt p = 0; p < m->points->n; ++p)
    m->points->real[POINT_FIELD][p] = (PetscReal)case_field(m->c, m->points->body[p]);
  follow_fields(m, field, m->tracers);
  follow_fields(m, field, m->loads->carriers);
}

/* Points keep the number of the cell where they were born: it orders them in memory, and they stay
 * together. */
static void leave_cells(const Grid *mesh, Points *points)
{
  for (PetscInt p = 0; p < points->n; ++p) points->cell[p] = mesh->global_cell[points->cell[p]];
}

/* A follower on the rim of a body may be in the cell beside it: it is of that of the nearest point. */
static PetscErrorCode StandInMatter(const Model *m, Points *followers)
{
  const Points *points = m->points;
  PetscBool *full;
  PetscReal square;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->grid->n_cells, &full));
  for (PetscInt p = 0; p < points->n; ++p) full[points->cell[p]] = PETSC_TRUE;
  for (PetscInt p = 0; p < followers->n; ++p) {
    if (followers->cell[p] >= 0 && full[followers->cell[p]]) continue;
    const PetscInt near = points_near(points, point_real(followers, POINT_X, p), &square);
    if (near >= 0) followers->cell[p] = points->cell[near];
  }
  PetscCall(PetscFree(full));
  PetscFunctionReturn(0);
}

/* What of nodes is around a point where it begins. A follower beside all cells goes by the mean. */
static PetscErrorCode TakeSpacing(const Grid *mesh, const PetscReal *around, Points *points)
{
  const PetscInt nn = mesh->nodes_per_cell;
  PetscReal N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES];

  PetscFunctionBeginUser;
  points->components[POINT_SPACING] = 1;
  PetscCall(PetscMalloc1(points->capacity, &points->real[POINT_SPACING]));
  for (PetscInt p = 0; p < points->n; ++p) {
    PetscReal *spacing = point_real(points, POINT_SPACING, p);
    *spacing = 0;
    if (points->cell[p] < 0) continue;
    cell_shape(grid_cell_type(mesh, points->cell[p]), point_real(points, POINT_XI, p), N, dN);
    for (PetscInt I = 0; I < nn; ++I) *spacing += N[I] * around[mesh->cell_node[points->cell[p] * nn + I]];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelToCloud(Model *m)
{
  Grid *cloud;
  Boundary *boundary;
  unsigned char *marked, *twin;
  PetscInt *field = NULL;
  PetscReal *around;
  CloudSource source = {.n_motions = case_fields(m->c)};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m->grid->n_owned, &marked, m->grid->n_owned, &twin));
  PetscCall(MarkNodes(m, marked, twin));
  if (!basis_needs_constraints(&m->c->basis)) PetscCall(PetscArrayzero(twin, m->grid->n_owned));
  PetscCall(LoadsLeaveCells(m->loads, m->grid, m->points));
  if (source.n_motions > 1) {
    PetscCall(PetscMalloc1(m->grid->n_nodes, &field));
    PetscCall(NodeFields(m->grid, m->c, m->points, field));
    tell_points(m, field);
  }
  source.marked = marked, source.twin = twin, source.motion = field;
  PetscCall(GridSpacing(m->grid, m->points->n, m->points->cell, &source.spacing));
  PetscCall(GridSpacingAround(m->grid, source.spacing, &around));
  source.around = around;
  if (around) {
    PetscCall(TakeSpacing(m->grid, around, m->points));
    PetscCall(TakeSpacing(m->grid, around, m->tracers));
    PetscCall(TakeSpacing(m->grid, around, m->loads->carriers));
  }
  PetscCall(GridCreateCloud(m->grid, &source, &cloud));
  PetscCall(BoundaryToCloud(m->boundary, m->grid, cloud, &boundary));
  PetscCall(CloudMatterCreate(m->grid, source.spacing, source.n_motions, m->points->n, m->points->cell,
                              source.n_motions > 1 ? m->points->real[POINT_FIELD] : NULL, &cloud->cloud->matter));
  PetscCall(StandInMatter(m, m->tracers));
  PetscCall(StandInMatter(m, m->loads->carriers));
  leave_cells(m->grid, m->points);
  leave_cells(m->grid, m->tracers);
  leave_cells(m->grid, m->loads->carriers);
  PetscCall(PetscFree2(marked, twin));
  PetscCall(PetscFree(field));
  PetscCall(PetscFree(around));
  PetscCall(BoundaryDestroy(&m->boundary));
  PetscCall(GridDestroy(&m->grid));
  m->boundary = boundary;
  m->grid = cloud;
  PetscFunctionReturn(0);
}

static PetscBool is_held(const Model *m, PetscInt node)
{
  for (PetscInt d = 0; d < m->dim; ++d)
    if (m->boundary->fixed[node * m->dim + d]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* How many points of a body have prescribed nodes of no body in their clouds: and hang on them, or go along the same
 * boundary that holds the body, where these nodes may move and have nothing that moves them. */
typedef struct {
  PetscInt hang, glide;
} Met;

static PetscBool is_free(const Model *m, PetscInt node)
{
  for (PetscInt d = 0; d < m->dim; ++d)
    if (!m->boundary->fixed[node * m->dim + d] && !frame_of(&m->boundary->frames, node)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void meet(const Model *m, PetscInt group, Met *met)
{
  const Support *w = m->space->support;
  PetscBool near = PETSC_FALSE, stands = PETSC_FALSE, loose = PETSC_FALSE;
  for (PetscInt i = w->node_start[group]; i < w->node_start[group + 1]; ++i) {
    const PetscBool obstacle = m->grid->cloud->obstacle[w->node[i]] > 0;
    near |= obstacle;
    stands |= !obstacle && is_held(m, w->node[i]);
    loose |= obstacle && is_free(m, w->node[i]);
  }
  met->hang += near && !stands;
  met->glide += stands && loose;
}

/* Points whose clouds reach prescribed nodes that the body's cells do not touch hang on them
 * without strain, so that to come off takes a force. Where the body stands on prescribed nodes of
 * its own that is as it should be. */
static void tell_met(const Model *m, PetscInt b, const Met *met, Diag *diag)
{
  const PetscReal reach = m->c->basis.radius * m->grid->cloud->spacing;
  char path[64];
  snprintf(path, sizeof path, "bodies[%d]", (int)b);
  if (met->hang) {
    diag_warning(
      diag, path,
      "%d points of '%s' have prescribed nodes in their clouds which the body does not touch: it sticks to them",
      (int)met->hang, m->c->bodies[b].name);
    diag_hint(diag,
              "a body that is to slide or come off meets `walls:` on its surface; of prescribed nodes it must start "
              "farther away than its clouds reach: %g m",
              (double)reach);
  }
  if (met->glide) {
    diag_warning(diag, path,
                 "%d points of '%s' have nodes in their clouds where no body has any, which the boundary holds in some "
                 "directions and leaves free in others: what moves towards these comes out wrong",
                 (int)met->glide, m->c->bodies[b].name);
    diag_hint(diag,
              "hold what the body has and no more, as by on: {x: 0, y: [0, 1]}, unless it is to come there; nodes "
              "farther away than %g m do no harm",
              (double)reach);
  }
}

PetscErrorCode ModelWarnOfObstacles(const Model *m, Diag *diag)
{
  Met *met;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->c->n_bodies, &met));
  for (PetscInt p = 0; p < m->space->support->n_groups; ++p) meet(m, p, met + m->points->body[p]);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, met, (PetscMPIInt)(2 * m->c->n_bodies), MPIU_INT, MPI_SUM, m->comm));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) tell_met(m, b, met + b, diag);
  PetscCall(PetscFree(met));
  PetscFunctionReturn(0);
}
