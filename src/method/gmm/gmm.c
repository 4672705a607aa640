/* Galerkin meshfree method (thesis algorithm 2): nodes and points both move with the material, and
 * nodes keep their history as in fem. Cells give nodes and points at the start and mean nothing
 * afterwards. */
#include "method/gmm/gmm.h"
#include "method/transfer/mass.h"
#include "method/transfer/transfer.h"
#include "support/cloud.h"

#define KEEP_OFF 0.25 /* spacings between nodes, at least */

static PetscErrorCode GmmStart(Discretisation *s)
{
  Gmm *g;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&g));
  s->own = g;
  g->constraints = basis_needs_constraints(&s->c->basis);
  PetscCall(SupportCreate(&g->tracers));
  PetscCall(SupportCreate(&g->carriers));
  PetscCall(SupportCreate(&g->nodes));
  g->layouts = -1;
  s->loads->support = g->carriers;
  PetscFunctionReturn(0);
}

static PetscBool is_held(const Discretisation *s, PetscInt node)
{
  for (PetscInt d = 0; d < s->grid->dim; ++d)
    if (s->boundary->fixed[node * s->grid->dim + d]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Does it not matter what a node would do without mass? One that is held along all axes does nothing; in statics, where
 * nothing is flung, one that is held along some is left alone, but on the axis, on which all of a ring hangs. */
static PetscBool needs_no_mass(const Discretisation *s, PetscInt node)
{
  PetscInt held = 0;
  for (PetscInt d = 0; d < s->grid->dim; ++d) held += s->boundary->fixed[node * s->grid->dim + d] != 0;
  if (held == 0 || held == s->grid->dim) return (PetscBool)(held > 0);
  return (PetscBool)(case_is_static(&s->c->analysis) && !boundary_slides_on_axis(s->boundary, node));
}

/* How much of the mass is missing that even a node at the corner of a body would have; 0: none, 1:
 * all. A corner at the axis weighs as much as a ring of a third of a spacing. */
static PetscReal starved(const Discretisation *s, PetscInt node, PetscReal density)
{
  const PetscInt dim = s->grid->dim;
  const PetscReal h = cloud_spacing_around(s->grid, node), corner = dim == 3 ? h * h * h / 16 : h * h / 8;
  const PetscReal round = kinematics_weight(s->c->kinematics, PetscMax(s->grid->x[node * dim], h / 3));
  if (needs_no_mass(s, node)) return 0;
  return PetscMax(0, 1 - PetscMax(0, s->nodes->mass[node]) / (density * corner * round));
}

/* Where a node has hardly any mass its force still counts in full, as in cells that are not full,
 * and the same helps: the points that reach it lump part of their mass and tie their nodes by a
 * weak stiffness. */
static PetscErrorCode Stabilise(Discretisation *s)
{
  const Support *w = s->support;

  PetscFunctionBeginUser;
  if (w->n_groups > s->group_capacity) {
    PetscCall(PetscFree(s->lumping));
    PetscCall(PetscFree(s->soft));
    s->group_capacity = w->n_groups + w->n_groups / 4;
    PetscCall(PetscMalloc1(s->group_capacity, &s->lumping));
    PetscCall(PetscMalloc1(s->group_capacity, &s->soft));
  }
  for (PetscInt p = 0; p < w->n_groups; ++p) {
    const Material *material = &s->materials[s->points->material[p]];
    const PetscReal h = cloud_spacing_of(s->points, p, s->grid->cloud->spacing), length = s->grid->dim == 3 ? h : 1;
    PetscReal lack = 0;
    for (PetscInt i = w->node_start[p]; i < w->node_start[p + 1]; ++i)
      lack = PetscMax(lack, starved(s, w->node[i], material->density));
    s->lumping[p] = s->c->analysis.mass == MASS_LUMPED ? 1 : s->c->stabilisation.mass * lack;
    s->soft[p] = s->c->stabilisation.stiffness * lack * material->wave_modulus * length *
                 kinematics_weight(s->c->kinematics, *point_real(s->points, POINT_X, p));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode GmmInitialise(Discretisation *s)
{
  PetscFunctionBeginUser;
  if (!s->started) PetscCall(GmmStart(s));
  PetscCall(GmmBalance(s));
  PetscCall(MassRowsDestroy(&s->mass_rows)); /* of other nodes, whose number changes with the ghosts */
  PetscCall(GmmGather(s));
  PetscCall(DiscretisationMass(s));
  if (!s->started) PetscCall(DiscretisationBodyVelocity(s));
  s->started = PETSC_TRUE;
  PetscCall(Stabilise(s));
  PetscFunctionReturn(0);
}

/* Free nodes feel no impulse when what is prescribed jumps, be it at a knot of an amplitude. */
static PetscErrorCode GmmHold(Discretisation *s)
{
  PetscFunctionBeginUser;
  PetscCall(transfer_find("consistent")->hold(s));
  PetscFunctionReturn(0);
}

/* The field at node i, whose cloud is number k. */
static PetscReal motion_of_node(const Discretisation *s, PetscInt i, PetscInt k, PetscInt d)
{
  const Support *w = gmm_of(s)->nodes;
  const PetscInt dim = s->grid->dim, nn = support_nodes(w, k), *node = w->node + w->node_start[k];
  const PetscReal *N = w->N + w->value_start[k], *du = s->nodes->du;
  PetscReal move = 0, sum = 0;
  for (PetscInt I = 0; I < nn; ++I) {
    if (!s->nodes->touched[node[I]] && !s->boundary->fixed[node[I] * dim + d]) continue;
    move += N[I] * du[node[I] * dim + d];
    sum += N[I];
  }
  return sum > 1e-12 ? move / sum : du[i * dim + d];
}

/* Move x away from those nodes of a cloud that are too near: half of the way that is missing, all
 * of it from a node that is held. */
static void keep_off(const Discretisation *s, PetscInt n, const PetscInt *node, PetscInt self, const PetscReal *old,
                     PetscReal *x)
{
  const PetscInt dim = s->grid->dim;
  for (PetscInt e = 0; e < n; ++e) {
    const PetscReal least =
      KEEP_OFF * PetscMin(cloud_spacing_around(s->grid, self), cloud_spacing_around(s->grid, node[e]));
    const PetscReal *other = old + node[e] * dim;
    PetscReal square = 0;
    for (PetscInt d = 0; d < dim; ++d) square += PetscSqr(x[d] - other[d]);
    if (node[e] == self || square == 0 || square >= least * least) continue;
    const PetscReal distance = PetscSqrtReal(square), share = is_held(s, node[e]) ? 1 : 0.5;
    for (PetscInt d = 0; d < dim; ++d) x[d] += share * (least - distance) / distance * (x[d] - other[d]);
  }
}

/* Two nodes at one place share their part of the field, and nothing resists when their coefficients
 * go against each other: the stiffness of that falls with the square of their distance. So nodes
 * keep off each other; places of nodes are free, coefficients stay. */
static PetscErrorCode KeepNodesApart(Discretisation *s)
{
  const Grid *grid = s->grid;
  const Support *w = gmm_of(s)->nodes;
  PetscReal *old;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_nodes * grid->dim, &old));
  PetscCall(PetscArraycpy(old, grid->x, grid->n_nodes * grid->dim));
  for (PetscInt i = 0, k = -1; i < grid->n_owned; ++i) {
    if (cloud_is_twin(grid, i)) continue;
    ++k;
    if (!is_held(s, i)) keep_off(s, support_nodes(w, k), w->node + w->node_start[k], i, old, grid->x + i * grid->dim);
  }
  PetscCall(PetscFree(old));
  PetscFunctionReturn(0);
}

/* Prescribed components move as prescribed, nodes that nothing touches stay. All others move with
 * the field at their place, as points do, and not with their own coefficient (as thesis algorithm 2
 * suggests): then nodes keep their order among points whatever a node with little mass does, and do
 * not cross a wall on which the field vanishes. */
static PetscErrorCode MoveNodes(Discretisation *s)
{
  const Grid *grid = s->grid;
  const PetscInt dim = grid->dim;

  PetscFunctionBeginUser;
  for (PetscInt i = 0, k = -1; i < grid->n_owned; ++i) {
    if (cloud_is_twin(grid, i)) continue;
    ++k;
    for (PetscInt d = 0; d < dim; ++d) {
      PetscReal *x = &grid->x[i * dim + d];
      if (s->boundary->fixed[i * dim + d]) *x += s->nodes->prescribed[i * dim + d];
      else if (s->nodes->touched[i]) *x += motion_of_node(s, i, k, d);
    }
  }
  PetscCall(GridToGhosts(grid, dim, grid->x));
  PetscCall(KeepNodesApart(s));
  /* twins stand with their nodes, and go to the same rank */
  for (PetscInt i = 0; i < grid->n_owned; ++i)
    for (PetscInt d = 0; d < dim && gmm_of(s)->twin[i] >= 0; ++d)
      grid->x[gmm_of(s)->twin[i] * dim + d] = grid->x[i * dim + d];
  PetscCall(GridToGhosts(grid, dim, grid->x));
  PetscFunctionReturn(0);
}

static PetscErrorCode GmmConvect(Discretisation *s)
{
  NodalFields *n = s->nodes;
  const PetscInt dofs = s->grid->n_nodes * s->grid->dim;

  PetscFunctionBeginUser;
  PetscCall(DiscretisationMoveClouds(s, s->points, s->support));
  PetscCall(DiscretisationMoveClouds(s, s->tracers, gmm_of(s)->tracers));
  PetscCall(DiscretisationMoveClouds(s, s->loads->carriers, gmm_of(s)->carriers));
  PetscCall(MoveNodes(s));
  for (PetscInt i = 0; i < dofs; ++i) { /* a node that nothing touched stays where it is */
    n->v[i] = n->touched[i / s->grid->dim] || s->boundary->fixed[i] ? n->v1[i] : 0;
    n->a[i] = n->touched[i / s->grid->dim] || s->boundary->fixed[i] ? n->a1[i] : 0;
  }
  PetscFunctionReturn(0);
}

static PetscBool cloud_carries(const Discretisation *s, const Points *followers, PetscInt p)
{
  PetscReal N[CLOUD_MAX_NODES];
  const Support *cloud = followers == s->tracers ? gmm_of(s)->tracers : gmm_of(s)->carriers;
  return support_touched(cloud, p, s->nodes->touched, N);
}

static PetscErrorCode GmmDestroy(Discretisation *s)
{
  Gmm *g = gmm_of(s);

  PetscFunctionBeginUser;
  if (!g) PetscFunctionReturn(0);
  PetscCall(SupportDestroy(&g->tracers));
  PetscCall(SupportDestroy(&g->carriers));
  PetscCall(SupportDestroy(&g->nodes));
  PetscCall(PetscFree(g->twin));
  PetscCall(PetscFree(s->own));
  PetscFunctionReturn(0);
}

const Method method_gmm = {
  .name = "gmm",
  .help = "Galerkin meshfree method: a cloud of nodes and points moves, without cells",
  .bases = {"lme"},
  .clouds = PETSC_TRUE,
  .initialise = GmmInitialise,
  .begin = GmmCarry,
  .hold = GmmHold,
  .convect = GmmConvect,
  .carries = cloud_carries,
  .destroy = GmmDestroy,
  .couplings = GmmCouplings,
  .redistribute = GmmRedistribute,
};
