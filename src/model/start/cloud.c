/* From cells to a cloud: what gmm does once, before the first step. */
#include "model/model_private.h"

/* Nodes of cells that hold points, and nodes whose motion is prescribed: obstacles, and the body's
 * own boundary. The axis is no obstacle where the body has no nodes on it. Owners know of all ranks'
 * cells. */
static PetscErrorCode MarkNodes(const Model *m, unsigned char *marked, unsigned char *twin)
{
  const Grid *mesh = m->grid;
  const PetscInt nn = mesh->nodes_per_cell;
  PetscReal *mark;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes, &mark));
  for (PetscInt p = 0; p < m->points->n; ++p)
    for (PetscInt I = 0; I < nn; ++I) mark[mesh->cell_node[m->points->cell[p] * nn + I]] = 1;
  PetscCall(GridSumToOwners(mesh, 1, mark));
  for (PetscInt i = 0; i < mesh->n_owned; ++i) {
    twin[i] = 0;
    for (PetscInt d = 0; d < m->dim; ++d) twin[i] |= m->boundary->fixed[i * m->dim + d];
    if (mark[i] <= 0 && boundary_slides_on_axis(m->boundary, i)) twin[i] = 0;
    marked[i] = mark[i] > 0 ? CLOUD_BODY : (twin[i] ? CLOUD_OBSTACLE : 0);
  }
  PetscCall(PetscFree(mark));
  PetscFunctionReturn(0);
}

/* Points keep the number of the cell where they were born: it orders them in memory, and they stay
 * together. */
static void leave_cells(const Grid *mesh, Points *points)
{
  for (PetscInt p = 0; p < points->n; ++p) points->cell[p] = mesh->global_cell[points->cell[p]];
}

PetscErrorCode ModelToCloud(Model *m)
{
  Grid *cloud;
  Boundary *boundary;
  PetscReal spacing;
  unsigned char *marked, *twin;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m->grid->n_owned, &marked, m->grid->n_owned, &twin));
  PetscCall(MarkNodes(m, marked, twin));
  if (!basis_needs_constraints(&m->c->basis)) PetscCall(PetscArrayzero(twin, m->grid->n_owned));
  PetscCall(LoadsLeaveCells(m->loads, m->grid, m->points));
  PetscCall(GridSpacing(m->grid, m->points->n, m->points->cell, &spacing));
  PetscCall(GridCreateCloud(m->grid, spacing, marked, twin, &cloud));
  PetscCall(BoundaryToCloud(m->boundary, m->grid, marked, cloud, &boundary));
  leave_cells(m->grid, m->points);
  leave_cells(m->grid, m->tracers);
  leave_cells(m->grid, m->loads->carriers);
  PetscCall(PetscFree2(marked, twin));
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

/* Points whose clouds reach prescribed nodes that the body's cells do not touch hang on them
 * without strain, so that to come off takes a force. Where the body stands on prescribed nodes of
 * its own that is as it should be. */
PetscErrorCode ModelWarnOfObstacles(const Model *m, Diag *diag)
{
  const Support *w = m->space->support;
  PetscInt *count;
  char path[64];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->c->n_bodies, &count));
  for (PetscInt p = 0; p < w->n_groups; ++p) {
    PetscBool near = PETSC_FALSE, stands = PETSC_FALSE;
    for (PetscInt i = w->node_start[p]; i < w->node_start[p + 1]; ++i) {
      const PetscBool obstacle = m->grid->cloud->obstacle[w->node[i]] > 0;
      near |= obstacle;
      stands |= !obstacle && is_held(m, w->node[i]);
    }
    count[m->points->body[p]] += near && !stands;
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, count, (PetscMPIInt)m->c->n_bodies, MPIU_INT, MPI_SUM, m->comm));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) {
    if (!count[b]) continue;
    snprintf(path, sizeof path, "bodies[%d]", (int)b);
    diag_warning(
      diag, path,
      "%d points of '%s' have prescribed nodes in their clouds which the body does not touch: it sticks to them",
      (int)count[b], m->c->bodies[b].name);
    diag_hint(diag,
              "a body that is to slide or come off meets `walls:` on its surface; of prescribed nodes it must start "
              "farther away than its clouds reach: %g m",
              (double)(m->c->basis.radius * m->grid->cloud->spacing));
  }
  PetscCall(PetscFree(count));
  PetscFunctionReturn(0);
}
