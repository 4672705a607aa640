/* Phase a of gmm: which nodes each point has now, over all ranks. */
#include "method/gmm/gmm.h"
#include "support/cloud.h"

#define SHARE 0.1 /* of a constrained node in the field at its place, at least */
/* ghosts and couplings are kept for clouds so much wider, so that they serve several steps */
#define SKIN 1.15
/* couplings of multipliers: they are few, and material comes upon them at full speed */
#define SKIN_HELD 1.4

/* Nodes as this rank sees them while it searches: owned ones by their numbers, remote of other
 * ranks behind. */
typedef struct {
  RemoteNodes remote;
  MeetingPlaces meeting;
  Neighbours *nodes; /* of each velocity field */
  PetscInt *ghost;   /* per candidate: local number, -1 if it is no ghost yet */
  PetscBool *use;    /* per candidate: does a cloud need it? */
  PetscReal *start;  /* per node: as cloud_start() */
} Search;

/* The radius aimed at where nodes are as far apart as in the mean, m. */
static PetscReal radius_of(const Discretisation *s) { return s->c->basis.radius * s->grid->cloud->spacing; }

/* The same for a point. */
static PetscReal radius_at(const Discretisation *s, const Points *points, PetscInt p)
{
  return s->c->basis.radius * cloud_spacing_of(points, p, s->grid->cloud->spacing);
}

/* What yields flows before its stress could make clouds uneven, and its F need not tell neighbours; the thesis's clouds
 * stay as they are. */
static PetscBool clouds_follow(const Discretisation *s)
{
  return (PetscBool)(s->c->basis.choice == CLOUD_CHOICE_ADAPTIVE && !materials_yield(s->c->n_materials, s->materials));
}

static void widen_box(PetscInt dim, PetscInt n, const PetscReal *x, PetscReal reach, PetscReal box[6])
{
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt d = 0; d < dim; ++d) {
      box[d] = PetscMin(box[d], x[i * dim + d] - reach);
      box[3 + d] = PetscMax(box[3 + d], x[i * dim + d] + reach);
    }
}

/* In spacings around a point how far it may look for nodes. */
static PetscReal farthest_of(const Discretisation *s)
{
  return SKIN * PetscMax(s->c->basis.radius, s->c->basis.max_radius);
}

/* Points in material that is drawn out look farther. */
static void widen_for_points(const Discretisation *s, const Points *points, PetscReal box[6])
{
  const PetscBool follows = clouds_follow(s);
  NeighboursMap room;
  for (PetscInt p = 0; p < points->n; ++p) {
    const NeighboursMap *map = cloud_stretch_of(follows, points, p, &room);
    const PetscReal reach = farthest_of(s) * cloud_spacing_of(points, p, s->grid->cloud->spacing);
    widen_box(points->dim, 1, point_real(points, POINT_X, p), (map ? map->longest : 1) * reach, box);
  }
}

/* The box in which this rank's points and nodes look for nodes. */
static void search_box(const Discretisation *s, const MeetingPlaces *meeting, PetscReal box[6])
{
  const PetscInt dim = s->grid->dim;
  for (int d = 0; d < 3; ++d) box[d] = PETSC_MAX_REAL, box[3 + d] = -PETSC_MAX_REAL;
  widen_for_points(s, s->points, box);
  widen_for_points(s, s->tracers, box);
  widen_for_points(s, s->loads->carriers, box);
  for (PetscInt i = 0; i < s->grid->n_owned; ++i)
    widen_box(dim, 1, s->grid->x + i * dim, farthest_of(s) * cloud_spacing_around(s->grid, i), box);
  widen_box(dim, meeting->n, meeting->x, SKIN * meeting_reach(s), box);
}

/* The first n nodes, and then remote ones, each in the search of its velocity field; twins in none. */
static PetscErrorCode NodesByField(const Grid *grid, PetscInt n, const RemoteNodes *remote, PetscReal size,
                                   Neighbours **nodes)
{
  unsigned char *skip;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->cloud->n_motions, nodes));
  PetscCall(PetscMalloc1(n + remote->n, &skip));
  for (PetscInt f = 0; f < grid->cloud->n_motions; ++f) {
    for (PetscInt i = 0; i < n; ++i) skip[i] = cloud_is_twin(grid, i) || cloud_motion(grid, i) != f;
    for (PetscInt k = 0; k < remote->n; ++k) skip[n + k] = remote->field[k] != f;
    PetscCall(NeighboursCreate(grid->dim, n, grid->x, remote->n, remote->x, skip, size, *nodes + f));
  }
  PetscCall(PetscFree(skip));
  PetscFunctionReturn(0);
}

static PetscErrorCode NodesByFieldDestroy(const Grid *grid, Neighbours **nodes)
{
  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < grid->cloud->n_motions; ++f) PetscCall(NeighboursDestroy(*nodes + f));
  PetscCall(PetscFree(*nodes));
  PetscFunctionReturn(0);
}

static PetscErrorCode FindStarts(const Grid *grid, Search *search)
{
  const PetscInt own = grid->n_owned * grid->dim, others = search->remote.n * grid->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(own + others, &search->start));
  for (PetscInt i = 0; i < own; ++i) search->start[i] = cloud_start(grid, i / grid->dim, i % grid->dim);
  PetscCall(PetscArraycpy(search->start + own, search->remote.start, others));
  PetscFunctionReturn(0);
}

static PetscErrorCode SearchBegin(const Discretisation *s, Search *search)
{
  const Grid *grid = s->grid;
  PetscReal box[6];

  PetscFunctionBeginUser;
  PetscCall(MeetingPlacesFind(s, &search->meeting));
  search_box(s, &search->meeting, box);
  PetscCall(GridCloudRemote(grid, box, &search->remote));
  const PetscInt n = search->remote.n;
  PetscCall(NodesByField(grid, grid->n_owned, &search->remote, radius_of(s), &search->nodes));
  PetscCall(FindStarts(grid, search));
  PetscCall(PetscMalloc1(n, &search->ghost));
  PetscCall(PetscCalloc1(n, &search->use));
  cloud_find_ghosts(grid, &search->remote, search->ghost);
  PetscFunctionReturn(0);
}

static PetscErrorCode SearchEnd(const Grid *grid, Search *search)
{
  PetscFunctionBeginUser;
  PetscCall(NodesByFieldDestroy(grid, &search->nodes));
  PetscCall(MeetingPlacesDestroy(&search->meeting));
  PetscCall(GridCloudRemoteDestroy(&search->remote));
  PetscCall(PetscFree(search->ghost));
  PetscCall(PetscFree(search->use));
  PetscCall(PetscFree(search->start));
  PetscFunctionReturn(0);
}

static void mark_used(const Discretisation *s, Search *search, PetscInt n, const PetscInt *node)
{
  for (PetscInt i = 0; i < n; ++i)
    if (node[i] >= s->grid->n_owned) search->use[node[i] - s->grid->n_owned] = PETSC_TRUE;
}

static void rename_nodes(const Discretisation *s, const Search *search, PetscInt n, PetscInt *node)
{
  for (PetscInt i = 0; i < n; ++i)
    if (node[i] >= s->grid->n_owned) node[i] = search->ghost[node[i] - s->grid->n_owned];
}

/* All lists of nodes found by this search. */
typedef struct {
  PetscInt n[5], *node[5];
} Lists;

static Lists lists_of(const Discretisation *s)
{
  const Support *w[4] = {s->support, gmm_of(s)->tracers, gmm_of(s)->carriers, gmm_of(s)->nodes};
  Lists l;
  for (int k = 0; k < 4; ++k) {
    l.n[k] = w[k]->node_start[w[k]->n_groups];
    l.node[k] = w[k]->node;
  }
  l.n[4] = s->constraints->start[s->constraints->n];
  l.node[4] = s->constraints->node;
  return l;
}

/* New ghosts: remote in use, and those that will be soon. */
static PetscErrorCode Relayout(Discretisation *s, Search *search)
{
  const PetscInt dim = s->grid->dim, n_owned = s->grid->n_owned;
  const PetscBool follows = clouds_follow(s);
  PetscInt near[CLOUD_MAX_NODES];
  PetscReal distance2[CLOUD_MAX_NODES];
  NeighboursMap room;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < s->points->n; ++p) {
    const PetscInt n = neighbours_mapped(
      search->nodes + point_field(s->points, p), cloud_stretch_of(follows, s->points, p, &room),
      s->points->real[POINT_X] + p * dim, SKIN * radius_at(s, s->points, p), CLOUD_MAX_NODES, near, distance2);
    mark_used(s, search, n, near);
  }
  PetscCall(MeetingPlacesUse(&search->meeting, s, SKIN * meeting_reach(s), &search->remote, search->use));
  PetscCall(GridCloudSetGhosts(s->grid, &search->remote, search->use));
  for (PetscInt k = 0, g = n_owned; k < search->remote.n; ++k) search->ghost[k] = search->use[k] ? g++ : -1;
  PetscFunctionReturn(0);
}

/* After ghosts or owners changed: arrays that do not follow by themselves. */
static PetscErrorCode Follow(Discretisation *s)
{
  const Grid *grid = s->grid;
  Gmm *g = gmm_of(s);
  PetscInt *id;
  PetscInt *order;

  PetscFunctionBeginUser;
  if (g->layouts == grid->cloud->layouts) PetscFunctionReturn(0);
  g->layouts = grid->cloud->layouts;
  PetscCall(NodalFlagsFollow(s->nodes));
  PetscCall(BoundaryFollow(s->boundary, grid));
  PetscCall(PetscFree(g->twin));
  PetscCall(PetscMalloc1(grid->n_owned, &g->twin));
  PetscCall(PetscMalloc2(grid->n_owned, &id, grid->n_owned, &order));
  for (PetscInt i = 0; i < grid->n_owned; ++i) {
    id[i] = grid->cloud->id[i];
    order[i] = i;
    g->twin[i] = -1;
  }
  PetscCall(PetscSortIntWithArray(grid->n_owned, id, order));
  /* twins stand last, in the order of their nodes */
  for (PetscInt i = 0, k = 0; i < grid->n_owned; ++i) {
    if (id[i] < grid->cloud->first_twin) continue;
    while (id[k] < id[i] - grid->cloud->first_twin) ++k;
    g->twin[order[k]] = order[i];
  }
  PetscCall(PetscFree2(id, order));
  PetscFunctionReturn(0);
}

/* Places of nodes, as points of their velocity fields; there is room for so many. */
static PetscErrorCode PlacesCreate(const Grid *grid, PetscInt n, Points *places)
{
  PetscFunctionBeginUser;
  *places = (Points){.dim = grid->dim, .components[POINT_X] = grid->dim, .components[POINT_U] = grid->dim};
  PetscCall(PetscMalloc1(n * grid->dim, &places->real[POINT_X]));
  PetscCall(PetscMalloc1(n * grid->dim, &places->real[POINT_U]));
  if (grid->cloud->around) {
    places->components[POINT_SPACING] = 1;
    PetscCall(PetscMalloc1(n, &places->real[POINT_SPACING]));
  }
  if (grid->cloud->n_motions == 1) PetscFunctionReturn(0);
  places->components[POINT_FIELD] = 1;
  PetscCall(PetscMalloc1(n, &places->real[POINT_FIELD]));
  PetscFunctionReturn(0);
}

static void add_place(const Grid *grid, PetscInt node, Points *places)
{
  const PetscInt n = places->n++;
  for (PetscInt d = 0; d < grid->dim; ++d) {
    point_real(places, POINT_X, n)[d] = grid->x[node * grid->dim + d];
    point_real(places, POINT_U, n)[d] = grid->x[node * grid->dim + d] - cloud_start(grid, node, d);
  }
  if (grid->cloud->around) places->real[POINT_SPACING][n] = grid->cloud->around[node];
  if (places->components[POINT_FIELD]) places->real[POINT_FIELD][n] = (PetscReal)cloud_motion(grid, node);
}

static PetscErrorCode PlacesDestroy(Points *places)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(places->real[POINT_X]));
  PetscCall(PetscFree(places->real[POINT_U]));
  PetscCall(PetscFree(places->real[POINT_SPACING]));
  PetscCall(PetscFree(places->real[POINT_FIELD]));
  PetscFunctionReturn(0);
}

/* The field at the places of nodes: it moves those near prescribed ones, and is held where a node
 * has a twin. */
static PetscErrorCode GatherNodes(Discretisation *s, const Search *search)
{
  const Grid *grid = s->grid;
  const Support *w = gmm_of(s)->nodes;
  const BasisInput basis = {.spec = &s->c->basis,
                            .grid = grid,
                            .nodes = search->nodes,
                            .start = search->start,
                            .follows = clouds_follow(s),
                            .on_hull = PETSC_TRUE};
  Points places;

  PetscFunctionBeginUser;
  PetscCall(PlacesCreate(grid, grid->n_owned, &places));
  for (PetscInt i = 0; i < grid->n_owned; ++i)
    if (!cloud_is_twin(grid, i)) add_place(grid, i, &places);
  PetscCall(s->basis->support(&basis, &places, gmm_of(s)->nodes));
  PetscCall(PlacesDestroy(&places));
  constraints_clear(s->constraints);
  for (PetscInt i = 0, k = -1; i < grid->n_owned; ++i) {
    if (cloud_is_twin(grid, i)) continue;
    ++k;
    if (gmm_of(s)->twin[i] >= 0)
      PetscCall(ConstraintsAdd(s->constraints, i, gmm_of(s)->twin[i], support_nodes(w, k), w->node + w->node_start[k],
                               w->N + w->value_start[k]));
  }
  PetscFunctionReturn(0);
}

/* Share of the node in the field at its own place. */
static PetscReal own_share(const Constraints *c, PetscInt k)
{
  for (PetscInt i = c->start[k]; i < c->start[k + 1]; ++i)
    if (c->node[i] == c->at[k]) return c->N[i * c->dim];
  return 0;
}

/* A node that no material touches and nothing holds along an axis has no motion there: it is no part of the field, as
 * where nodes move with that (gmm.c), or what it takes of a constraint's force nobody would feel.
 *
 * Constraints act where material reaches the node; elsewhere it moves as prescribed by itself. So
 * it does where other nodes crowd it: its coefficient, with a small share in the field, would have
 * to be huge. */
static PetscErrorCode Release(Discretisation *s)
{
  const PetscInt dim = s->grid->dim;
  Constraints *c = s->constraints;
  PetscReal *state;

  PetscFunctionBeginUser;
  if (!gmm_of(s)->constraints) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(s->grid->n_nodes * dim, &state));
  for (PetscInt k = 0; k < c->n; ++k) {
    const PetscBool active = s->nodes->touched[c->at[k]] && own_share(c, k) > SHARE;
    s->nodes->touched[c->twin[k]] = active;
    for (PetscInt d = 0; d < dim; ++d) {
      const PetscBool held = s->boundary->fixed[c->at[k] * dim + d] != 0;
      state[c->at[k] * dim + d] = active && held ? DOF_RELEASED : DOF_USUAL;
      state[c->twin[k] * dim + d] = held ? DOF_USUAL : DOF_UNUSED;
    }
  }
  constraints_leave_out(c, s->nodes->touched, s->boundary->fixed);
  PetscCall(GridToGhosts(s->grid, dim, state));
  for (PetscInt i = 0; i < s->grid->n_nodes * dim; ++i) s->nodes->dof[i] = (unsigned char)state[i];
  PetscCall(PetscFree(state));
  PetscFunctionReturn(0);
}

PetscErrorCode GmmGather(Discretisation *s)
{
  Gmm *g = gmm_of(s);
  Search search;
  BasisInput basis = {.spec = &s->c->basis, .grid = s->grid, .follows = clouds_follow(s)};
  PetscBool missing = PETSC_FALSE, any;

  PetscFunctionBeginUser;
  PetscCall(Follow(s));
  PetscCall(SearchBegin(s, &search));
  basis.nodes = search.nodes;
  basis.start = search.start;
  PetscCall(s->basis->support(&basis, s->points, s->support));
  PetscCall(s->basis->support(&basis, s->tracers, g->tracers));
  basis.on_hull = PETSC_TRUE;
  PetscCall(s->basis->support(&basis, s->loads->carriers, g->carriers));
  PetscCall(GatherNodes(s, &search));
  const Lists lists = lists_of(s);
  for (int k = 0; k < 5; ++k) mark_used(s, &search, lists.n[k], lists.node[k]);
  PetscCall(MeetingPlacesUse(&search.meeting, s, meeting_reach(s), &search.remote, search.use));
  for (PetscInt k = 0; k < search.remote.n; ++k)
    if (search.use[k] && search.ghost[k] < 0) missing = PETSC_TRUE;
  PetscCallMPI(MPI_Allreduce(&missing, &any, 1, MPIU_BOOL, MPI_LOR, s->grid->comm));
  if (any) PetscCall(Relayout(s, &search));
  for (int k = 0; k < 5; ++k) rename_nodes(s, &search, lists.n[k], lists.node[k]);
  PetscCall(SearchEnd(s->grid, &search));
  PetscCall(Follow(s));
  PetscCall(DiscretisationTouch(s));
  PetscCall(Release(s));
  PetscFunctionReturn(0);
}

/* The constraints as a support: places of their nodes, and the nodes that hold these, the twin
 * among them. */
static PetscErrorCode CoupleConstraints(const Discretisation *s, const BasisInput *basis, NodeGroups *groups)
{
  const Constraints *c = s->constraints;
  Points places;
  Support now = {.n_groups = c->n};
  const BasisSites sites = {.points = &places, .now = &now, .skin = SKIN_HELD};

  PetscFunctionBeginUser;
  PetscCall(PlacesCreate(s->grid, c->n, &places));
  PetscCall(PetscMalloc2(c->n + 1, &now.node_start, c->start[c->n] + c->n, &now.node));
  now.node_start[0] = 0;
  for (PetscInt k = 0, n = 0; k < c->n; ++k) {
    add_place(s->grid, c->at[k], &places);
    for (PetscInt i = c->start[k]; i < c->start[k + 1]; ++i) now.node[n++] = c->node[i];
    now.node[n++] = c->twin[k];
    now.node_start[k + 1] = n;
  }
  PetscCall(s->basis->couplings(basis, &sites, groups));
  PetscCall(PetscFree2(now.node_start, now.node));
  PetscCall(PlacesDestroy(&places));
  PetscFunctionReturn(0);
}

PetscErrorCode GmmCouplings(const Discretisation *s, NodeGroups *groups)
{
  const Grid *grid = s->grid;
  const BasisSites sites = {.points = s->points, .now = s->support, .skin = SKIN};
  const RemoteNodes none = {.n = 0};
  Neighbours *nodes;

  PetscFunctionBeginUser;
  PetscCall(NodesByField(grid, grid->n_nodes, &none, SKIN * radius_of(s), &nodes));
  const BasisInput basis = {.spec = &s->c->basis, .grid = grid, .nodes = nodes, .follows = clouds_follow(s)};
  PetscCall(s->basis->couplings(&basis, &sites, groups));
  PetscCall(CoupleConstraints(s, &basis, groups));
  PetscCall(NodesByFieldDestroy(grid, &nodes));
  PetscFunctionReturn(0);
}
