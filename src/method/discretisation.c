#include "method/extend/extend.h"
#include "method/transfer/mass.h"
#include "method/transfer/transfer.h"

PetscErrorCode DiscretisationCreate(const Discretisation *parts, Discretisation **space)
{
  Discretisation *s;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(space));
  s = *space;
  *s = *parts;
  PetscCall(NodalFieldsCreate(s->grid, case_is_mixed(s->c), &s->nodes));
  s->basis = basis_find(s->c->basis.kind);
  s->transfer = transfer_find(s->c->analysis.transfer);
  PetscCall(SupportCreate(&s->support));
  PetscCall(ConstraintsCreate(s->grid->dim, &s->constraints));
  PetscCall(PetscCalloc1(s->grid->n_cells, &s->filled));
  PetscFunctionReturn(0);
}

PetscErrorCode DiscretisationDestroy(Discretisation **space)
{
  Discretisation *s = *space;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  s->loads->support = NULL; /* a method's, or the extension's */
  PetscCall(NodalFieldsDestroy(&s->nodes));
  PetscCall(SupportDestroy(&s->support));
  PetscCall(ConstraintsDestroy(&s->constraints));
  PetscCall(PetscFree(s->filled));
  PetscCall(PetscFree(s->volume));
  PetscCall(PetscFree(s->whole));
  PetscCall(PetscFree(s->unroomed));
  PetscCall(PetscFree(s->rim));
  PetscCall(PetscFree(s->reached));
  PetscCall(ExtensionDestroy(&s->extension));
  PetscCall(PetscFree(s->lumping));
  PetscCall(PetscFree(s->soft));
  PetscCall(PetscFree(s->tie));
  PetscCall(PetscFree(s->pressure_tie));
  PetscCall(PetscFree(s->lost));
  PetscCall(MassRowsDestroy(&s->mass_rows));
  PetscCall(PetscFree(*space));
  PetscFunctionReturn(0);
}

/* Of nodes that carry others than points. */
static PetscErrorCode Reach(Discretisation *s)
{
  const PetscInt n = s->grid->n_nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->reached));
  if (!s->extension || !s->extension->any) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n, &s->reached));
  for (PetscInt i = 0; i < n; ++i) s->reached[i] = s->nodes->touched[i] || s->extension->ways[i] > 0;
  PetscFunctionReturn(0);
}

const unsigned char *reached_nodes(const Discretisation *s) { return s->reached ? s->reached : s->nodes->touched; }

PetscErrorCode DiscretisationTouch(Discretisation *s)
{
  PetscReal *count;
  const PetscInt n = s->grid->n_nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &count));
  const PetscInt entries = s->support->node_start ? s->support->node_start[s->support->n_groups] : 0;
  for (PetscInt i = 0; i < entries; ++i) count[s->support->node[i]] = 1;
  PetscCall(GridSumToOwners(s->grid, 1, count));
  PetscCall(GridToGhosts(s->grid, 1, count));
  for (PetscInt i = 0; i < n; ++i) s->nodes->touched[i] = count[i] > 0;
  PetscCall(PetscArrayzero(s->filled, s->grid->n_cells));
  for (PetscInt g = 0; !s->grid->cloud && g < s->support->n_groups; ++g)
    s->filled[s->points->cell[s->support->point_start[g]]] = 1;
  PetscCall(PetscFree(count));
  PetscCall(Reach(s));
  PetscFunctionReturn(0);
}

PetscErrorCode DiscretisationMass(Discretisation *s)
{
  const Support *w = s->support;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(s->nodes->mass, s->grid->n_nodes));
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt nn = w->node_start[g + 1] - w->node_start[g], *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *N = w->N + w->value_start[g] + (p - w->point_start[g]) * nn, m = s->points->real[POINT_MASS][p];
      for (PetscInt I = 0; I < nn; ++I) s->nodes->mass[node[I]] += N[I] * m;
    }
  }
  PetscCall(GridSumToOwners(s->grid, 1, s->nodes->mass));
  PetscCall(GridToGhosts(s->grid, 1, s->nodes->mass));
  PetscFunctionReturn(0);
}

PetscErrorCode DiscretisationPressure(Discretisation *s)
{
  NodalFields *n = s->nodes;
  const Support *w = s->support;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(n->pressure, s->grid->n_nodes));
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt nn = w->node_start[g + 1] - w->node_start[g], *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *N = w->N + w->value_start[g] + (p - w->point_start[g]) * nn;
      const PetscReal mp = s->points->real[POINT_MASS][p] * s->points->real[POINT_PRESSURE][p];
      for (PetscInt I = 0; I < nn; ++I) n->pressure[node[I]] += N[I] * mp;
    }
  }
  PetscCall(GridSumToOwners(s->grid, 1, n->pressure));
  for (PetscInt node = 0; node < s->grid->n_owned; ++node)
    n->pressure[node] = n->mass[node] > 1e-300 ? n->pressure[node] / n->mass[node] : 0;
  PetscCall(GridToGhosts(s->grid, 1, n->pressure));
  PetscFunctionReturn(0);
}

/* A projection from points would flatten a rotation at the boundary. A node of several bodies takes
 * the mean by mass. */
PetscErrorCode DiscretisationBodyVelocity(Discretisation *s)
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
  for (PetscInt i = 0; i < n * dim; ++i) s->nodes->v[i] = weight[i / dim] > 0 ? q[i] / weight[i / dim] : 0;
  PetscCall(PetscFree2(q, weight));
  PetscFunctionReturn(0);
}

void discretisation_impulses(Discretisation *s)
{
  NodalFields *n = s->nodes;
  const PetscInt dim = s->grid->dim;
  for (PetscInt node = 0, i = 0; node < s->grid->n_owned; ++node)
    for (PetscInt d = 0; d < dim; ++d, ++i) {
      n->impulse[i] = n->mass[node] * (n->v[i] - n->v_points[i]);
      n->lost_force[i] = n->mass[node] * (n->a[i] - n->a_points[i]);
    }
}

/* One carried point with its shape functions: position and displacement add up, velocity and
 * acceleration are those of the field. */
static void move_carried(const Discretisation *s, Points *carried, PetscInt p, PetscInt nn, const PetscInt *node,
                         const PetscReal *N)
{
  const NodalFields *n = s->nodes;
  const PetscInt dim = s->grid->dim;
  PetscReal *x = point_real(carried, POINT_X, p), *u = point_real(carried, POINT_U, p);
  PetscReal *v = point_real(carried, POINT_V, p), *a = point_real(carried, POINT_A, p);
  for (PetscInt d = 0; d < dim; ++d) {
    v[d] = a[d] = 0;
    for (PetscInt I = 0; I < nn; ++I) {
      const PetscInt i = node[I] * dim + d;
      u[d] += N[I] * n->du[i];
      x[d] += N[I] * n->du[i];
      v[d] += N[I] * n->v1[i];
      a[d] += N[I] * n->a1[i];
    }
  }
}

PetscErrorCode DiscretisationMoveClouds(Discretisation *s, Points *carried, const Support *support)
{
  PetscReal N[CLOUD_MAX_NODES];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < carried->n; ++p)
    if (p < support->n_groups && support_touched(support, p, reached_nodes(s), N))
      move_carried(s, carried, p, support_nodes(support, p), support->node + support->node_start[p], N);
  PetscFunctionReturn(0);
}

/* The ends of its edges, which pieces beside it have too, move with the field; it stays in their middle. */
static void move_piece(const Discretisation *s, Points *carriers, PetscInt p)
{
  const PetscInt dim = s->grid->dim;
  CarrierShape shape;
  PetscReal grown[6] = {0};
  carrier_shape(s->loads, s->grid, p, reached_nodes(s), &shape);
  if (!shape.n) return;
  move_carried(s, carriers, p, shape.n, shape.node, shape.M);
  for (PetscInt I = 0; I < shape.n; ++I)
    for (PetscInt k = 0; k < carriers->components[POINT_EDGE]; ++k) {
      const PetscReal *e = point_real(carriers, POINT_EDGE, p) + k / dim * dim, *dN = shape.dN + 3 * I;
      for (PetscInt d = 0; d < dim; ++d) grown[k] += dN[d] * e[d] * s->nodes->du[shape.node[I] * dim + k % dim];
    }
  for (PetscInt k = 0; k < carriers->components[POINT_EDGE]; ++k) point_real(carriers, POINT_EDGE, p)[k] += grown[k];
}

PetscErrorCode DiscretisationMoveCarried(Discretisation *s, Points *carried)
{
  const Grid *grid = s->grid;
  const PetscInt nn = grid->nodes_per_cell;
  const Support *seen = followers_see(s, carried);
  PetscReal N[CELL_MAX_NODES];

  PetscFunctionBeginUser;
  if (carried->components[POINT_EDGE] && s->loads->support) {
    for (PetscInt p = 0; p < carried->n; ++p) move_piece(s, carried, p);
    PetscFunctionReturn(0);
  }
  if (seen) {
    PetscCall(DiscretisationMoveClouds(s, carried, seen));
    PetscFunctionReturn(0);
  }
  for (PetscInt p = 0; p < carried->n; ++p) {
    const PetscInt cell = carried->cell[p];
    if (cell >= 0 && touched_shape(grid, cell, point_real(carried, POINT_XI, p), reached_nodes(s), N))
      move_carried(s, carried, p, nn, grid->cell_node + cell * nn, N);
  }
  PetscFunctionReturn(0);
}
