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
  s->basis = basis_find(c->basis.kind);
  PetscCall(SupportCreate(&s->support));
  PetscCall(PetscCalloc1(grid->n_cells, &s->filled));
  PetscCall(PetscCalloc1(grid->n_nodes, &s->touched));
  PetscCall(PetscCalloc1(grid->n_nodes, &s->mass));
  PetscReal **const motion[] = {&s->v,        &s->a,  &s->v_points,
                                &s->a_points, &s->v1, &s->a1}; /* a cloud changes their size */
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(motion); ++k) PetscCall(PetscCalloc1(dofs, motion[k]));
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
  PetscReal **const motion[] = {&s->v, &s->a, &s->v_points, &s->a_points, &s->v1, &s->a1};
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(motion); ++k) PetscCall(PetscFree(*motion[k]));
  PetscCall(ConstraintsDestroy(&s->constraints));
  PetscCall(PetscFree(s->dof));
  PetscCall(PetscFree(s->lumping));
  PetscCall(PetscFree(s->soft));
  PetscCall(PetscFree(s->tie));
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
  for (PetscInt g = 0; !s->grid->cloud && g < s->support->n_groups; ++g)
    s->filled[s->points->cell[s->support->point_start[g]]] = 1;
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

/* A projection from points would flatten a rotation at the boundary. A node of several bodies takes the mean by mass. */
PetscErrorCode StageBodyVelocity(Stage *s)
{
  const PetscInt dim = s->grid->dim, n = s->grid->n_nodes;
  const Support *w = s->support;
  PetscReal *q, *weight, v[3];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n * dim, &q, n, &weight));
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
      for (PetscInt I = 0; I < support_nodes(w, g); ++I) {
        const PetscInt node = w->node[w->node_start[g] + I];
        const PetscReal m = PetscAbsReal(support_N(w, g, p)[I]) * s->points->real[POINT_MASS][p];
        body_velocity(&s->c->bodies[s->points->body[p]], dim, s->grid->x + node * dim, v);
        weight[node] += m;
        for (PetscInt d = 0; d < dim; ++d) q[node * dim + d] += m * v[d];
      }
  PetscCall(GridSumToOwners(s->grid, dim, q));
  PetscCall(GridSumToOwners(s->grid, 1, weight));
  PetscCall(GridToGhosts(s->grid, dim, q));
  PetscCall(GridToGhosts(s->grid, 1, weight));
  for (PetscInt i = 0; i < n * dim; ++i) s->v[i] = weight[i / dim] > 0 ? q[i] / weight[i / dim] : 0;
  PetscCall(PetscFree2(q, weight));
  PetscFunctionReturn(0);
}

/* One carried point with its shape functions: position and displacement add up, velocity and acceleration are those of the field. */
static void move_carried(const Stage *s, Points *carried, PetscInt p, PetscInt nn, const PetscInt *node,
                         const PetscReal *N, const PetscReal *du)
{
  const PetscInt dim = s->grid->dim;
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

PetscErrorCode StageMoveClouds(Stage *s, Points *carried, const Support *support, const PetscReal *du)
{
  PetscReal N[CLOUD_MAX_NODES];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < carried->n; ++p)
    if (support_touched(support, p, s->touched, N))
      move_carried(s, carried, p, support_nodes(support, p), support->node + support->node_start[p], N, du);
  PetscFunctionReturn(0);
}

PetscErrorCode StageMoveCarried(Stage *s, Points *carried, const PetscReal *du)
{
  const Grid *grid = s->grid;
  const PetscInt nn = grid->nodes_per_cell;
  PetscReal N[CELL_MAX_NODES];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < carried->n; ++p) {
    const PetscInt cell = carried->cell[p];
    if (cell >= 0 && touched_shape(grid, cell, point_real(carried, POINT_XI, p), s->touched, N))
      move_carried(s, carried, p, nn, grid->cell_node + cell * nn, N, du);
  }
  PetscFunctionReturn(0);
}
