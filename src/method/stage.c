#include "method/method.h"

PetscErrorCode StageCreate(const Case *c, Grid *grid, Points *points, Points *tracers, Loads *loads,
                           const Material *materials, Stage **stage)
{
  Stage *s;
  const PetscInt dofs = grid->n_nodes * grid->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  s->c = c;
  s->grid = grid;
  s->points = points;
  s->tracers = tracers;
  s->loads = loads;
  s->materials = materials;
  PetscCall(SupportCreate(&s->support));
  PetscCall(PetscCalloc1(grid->n_cells, &s->filled));
  PetscCall(PetscCalloc1(grid->n_nodes, &s->touched));
  PetscCall(PetscCalloc1(grid->n_nodes, &s->mass));
  PetscCall(PetscCalloc5(dofs, &s->v, dofs, &s->a, dofs, &s->v_points, dofs, &s->v1, dofs, &s->a1));
  if (case_is_mixed(c)) PetscCall(PetscCalloc1(grid->n_nodes, &s->pressure));
  *stage = s;
  PetscFunctionReturn(0);
}

PetscErrorCode StageDestroy(Stage **stage)
{
  Stage *s = *stage;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  PetscCall(SupportDestroy(&s->support));
  PetscCall(PetscFree(s->filled));
  PetscCall(PetscFree(s->touched));
  PetscCall(PetscFree(s->mass));
  PetscCall(PetscFree5(s->v, s->a, s->v_points, s->v1, s->a1));
  PetscCall(PetscFree3(s->lumping, s->soft, s->tie));
  PetscCall(PetscFree(s->pressure));
  PetscCall(PetscFree(s->pressure_tie));
  PetscCall(PetscFree(s->lost));
  PetscCall(PetscFree(*stage));
  PetscFunctionReturn(0);
}

PetscErrorCode StageTouch(Stage *s)
{
  PetscReal *count;
  const PetscInt n = s->grid->n_nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &count));
  const PetscInt entries = s->support->node_start ? s->support->node_start[s->support->n_groups] : 0;
  for (PetscInt i = 0; i < entries; ++i) count[s->support->node[i]] = 1;
  PetscCall(GridSumToOwners(s->grid, 1, count));
  PetscCall(GridToGhosts(s->grid, 1, count));
  for (PetscInt i = 0; i < n; ++i) s->touched[i] = count[i] > 0;
  PetscCall(PetscArrayzero(s->filled, s->grid->n_cells));
  for (PetscInt g = 0; g < s->support->n_groups; ++g) s->filled[s->points->cell[s->support->point_start[g]]] = 1;
  PetscCall(PetscFree(count));
  PetscFunctionReturn(0);
}

PetscErrorCode StageNodalMass(Stage *s)
{
  const Support *w = s->support;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(s->mass, s->grid->n_nodes));
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt nn = w->node_start[g + 1] - w->node_start[g], *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *N = w->N + w->value_start[g] + (p - w->point_start[g]) * nn, m = s->points->real[POINT_MASS][p];
      for (PetscInt I = 0; I < nn; ++I) s->mass[node[I]] += N[I] * m;
    }
  }
  PetscCall(GridSumToOwners(s->grid, 1, s->mass));
  PetscCall(GridToGhosts(s->grid, 1, s->mass));
  PetscFunctionReturn(0);
}

PetscErrorCode StageNodalPressure(Stage *s)
{
  const Support *w = s->support;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(s->pressure, s->grid->n_nodes));
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt nn = w->node_start[g + 1] - w->node_start[g], *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *N = w->N + w->value_start[g] + (p - w->point_start[g]) * nn;
      const PetscReal mp = s->points->real[POINT_MASS][p] * s->points->real[POINT_PRESSURE][p];
      for (PetscInt I = 0; I < nn; ++I) s->pressure[node[I]] += N[I] * mp;
    }
  }
  PetscCall(GridSumToOwners(s->grid, 1, s->pressure));
  for (PetscInt node = 0; node < s->grid->n_owned; ++node)
    s->pressure[node] = s->mass[node] > 1e-300 ? s->pressure[node] / s->mass[node] : 0;
  PetscCall(GridToGhosts(s->grid, 1, s->pressure));
  PetscFunctionReturn(0);
}

PetscErrorCode StageMoveCarried(Stage *s, Points *carried, const PetscReal *du)
{
  const Grid *grid = s->grid;
  const PetscInt dim = grid->dim, nn = grid->nodes_per_cell;
  PetscReal N[CELL_MAX_NODES];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < carried->n; ++p) {
    const PetscInt cell = carried->cell[p];
    if (cell < 0) continue;
    const PetscInt *node = grid->cell_node + cell * nn;
    if (!touched_shape(grid, cell, point_real(carried, POINT_XI, p), s->touched, N)) continue;
    PetscReal *x = point_real(carried, POINT_X, p), *u = point_real(carried, POINT_U, p);
    PetscReal *v = point_real(carried, POINT_V, p), *a = point_real(carried, POINT_A, p);
    for (PetscInt d = 0; d < dim; ++d) {
      v[d] = a[d] = 0;
      for (PetscInt I = 0; I < nn; ++I) {
        const PetscInt i = node[I] * dim + d;
        u[d] += N[I] * du[i];
        x[d] += N[I] * du[i];
        v[d] += N[I] * s->v1[i];
        a[d] += N[I] * s->a1[i];
      }
    }
  }
  PetscFunctionReturn(0);
}
