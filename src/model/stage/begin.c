/* Measures that begin with a stage, and walls that come with it, where the material now is. */
#include "model/measure/measure.h"
#include "model/stage/stage_private.h"

PetscErrorCode PutAside(Points *points, PetscInt dim, const PetscBool *take, Points **begun)
{
  PetscFunctionBeginUser;
  PetscCall(PointsCreate(dim, 0, 0, begun));
  PetscCall(PetscArraycpy((*begun)->components, points->components, POINT_N_REAL));
  PetscCall(PointsCopy(points, take, *begun));
  points->n = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode PutBack(Points **begun, const char reason[256], Points *points)
{
  PetscBool *take;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((*begun)->n, &take));
  for (PetscInt p = 0; p < (*begun)->n; ++p) take[p] = PETSC_TRUE;
  if (!reason[0]) PetscCall(PointsCopy(*begun, take, points));
  PetscCall(PetscFree(take));
  PetscCall(PointsDestroy(begun));
  PetscFunctionReturn(0);
}

PetscErrorCode TakeTracers(Model *m, const Tables *tables, const Case *from, char reason[256])
{
  PetscInt *now;
  PetscBool *take;
  Points *begun;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(from->n_measures, &now));
  for (PetscInt k = 0; k < from->n_measures; ++k) now[k] = -1;
  PetscCall(PetscMalloc1(m->tracers->n, &take));
  for (PetscInt p = 0; p < m->tracers->n; ++p) take[p] = measure_before(m->c, m->tracers->body[p], from) < 0;
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    if (measure_before(m->c, k, from) >= 0) now[measure_before(m->c, k, from)] = k;
  const PointsChange change = {.n_bodies = from->n_measures, .n_materials = PETSC_MAX_INT, .body = now};
  PetscCall(PutAside(m->tracers, m->dim, take, &begun));
  PetscCall(PetscFree(take));
  PetscCall(PointsTake(m->tracers, m->grid, tables_find(tables, "tracers"), &change, reason));
  PetscCall(PutBack(&begun, reason, m->tracers));
  for (PetscInt p = 0; p < m->tracers->n; ++p) m->tracers->id[p] = m->tracers->body[p];
  PetscCall(PetscFree(now));
  PetscFunctionReturn(0);
}

/* Where the material is now: nodes of fem have moved with it. */
static void place_tracer(Model *m, PetscInt p)
{
  const Grid *grid = m->grid;
  const PetscInt nn = grid->nodes_per_cell, *node = grid->cell_node + m->tracers->cell[p] * nn;
  PetscReal N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES], *x = point_real(m->tracers, POINT_X, p);
  cell_shape(grid_cell_type(grid, m->tracers->cell[p]), point_real(m->tracers, POINT_XI, p), N, dN);
  for (PetscInt d = 0; d < m->dim; ++d) {
    x[d] = 0;
    for (PetscInt i = 0; i < nn; ++i) x[d] += N[i] * grid->x[node[i] * m->dim + d];
  }
}

PetscErrorCode BeginTracers(Model *m, const Case *from, Diag *diag)
{
  char path[512];

  PetscFunctionBeginUser;
  if (m->method->clouds) PetscFunctionReturn(0); /* there none begins: clouds.c */
  for (PetscInt p = 0; p < m->tracers->n; ++p) {
    const PetscInt k = m->tracers->body[p];
    if ((from && measure_before(m->c, k, from) >= 0) || m->tracers->cell[p] < 0) continue;
    if (!m->method->restores_grid) place_tracer(m, p);
    if (m->method->carries(m->space, m->tracers, p)) continue;
    snprintf(path, sizeof path, "measures.%s.of.tracer", m->c->measures[k].name);
    diag_error(diag, path, "no material carries the tracer: where it begins none is left");
    if (m->method->restores_grid) diag_hint(diag, "a place where the material is now, and not where it was drawn");
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BeginMeasures(Model *m, const Case *from)
{
  PetscFunctionBeginUser;
  PetscCall(ContactStand(m));
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    if (!from || measure_before(m->c, k, from) < 0) PetscCall(MeasureBegin(m, k));
  PetscFunctionReturn(0);
}
