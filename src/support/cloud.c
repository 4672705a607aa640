/* Support of points that each have a cloud of nodes. */
#include "base/count.h"
#include "base/math/tensor.h"
#include "support/cloud.h"

/* F^-T F^-1, dim x dim; PETSC_FALSE where F has lost all meaning. */
static PetscBool metric_of(PetscInt dim, const PetscReal *F, PetscReal *metric)
{
  PetscReal inverse[9], sum = 0;
  tensor_inverse(F, inverse);
  for (PetscInt i = 0; i < dim; ++i)
    for (PetscInt j = 0; j < dim; ++j) {
      metric[i * dim + j] = 0;
      for (PetscInt k = 0; k < dim; ++k) metric[i * dim + j] += inverse[3 * k + i] * inverse[3 * k + j];
      sum += metric[i * dim + j];
    }
  return !PetscIsInfOrNanReal(sum);
}

/* Ascending nodes, with the values that belong to them: each goes behind those with smaller
 * numbers. */
static void sort_cloud(PetscInt dim, PetscInt n, PetscInt *node, PetscReal *N, PetscReal *dN)
{
  PetscInt old_node[CLOUD_MAX_NODES], place[CLOUD_MAX_NODES] = {0};
  PetscReal old_N[CLOUD_MAX_NODES], old_dN[3 * CLOUD_MAX_NODES];
  for (PetscInt i = 0; i < n; ++i) {
    old_node[i] = node[i];
    old_N[i] = N[i];
    for (PetscInt d = 0; d < dim; ++d) old_dN[i * dim + d] = dN[i * dim + d];
  }
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt k = 0; k < n; ++k) place[k] += old_node[i] < old_node[k];
  for (PetscInt i = 0; i < n; ++i) {
    const PetscInt k = place[i];
    node[k] = old_node[i];
    N[k] = old_N[i];
    for (PetscInt d = 0; d < dim; ++d) dN[k * dim + d] = old_dN[i * dim + d];
  }
}

/* A point and the nodes within a reach of it, nearest first. */
typedef struct {
  PetscInt n, place[CLOUD_MAX_NODES];
  PetscReal X[3 * CLOUD_MAX_NODES];
} Surroundings;

static void look_around(const Neighbours *nodes, const NeighboursMap *map, const PetscReal *x, PetscReal reach,
                        Surroundings *s)
{
  const PetscInt dim = nodes->dim;
  PetscReal distance2[CLOUD_MAX_NODES];
  s->n = neighbours_mapped(nodes, map, x, reach, CLOUD_MAX_NODES, s->place, distance2);
  for (PetscInt i = 0; i < s->n; ++i)
    for (PetscInt d = 0; d < dim; ++d) s->X[i * dim + d] = nodes->at[s->place[i] * dim + d];
}

/* Those of them alone that material joins to the point. PETSC_FALSE: the nearest is none. */
static PetscBool keep_joined(PetscInt dim, const CloudRule *rule, const CloudOrigin *origin, Surroundings *s)
{
  PetscReal start[3 * CLOUD_MAX_NODES];
  PetscBool joined[CLOUD_MAX_NODES];
  PetscInt n = 0;
  for (PetscInt i = 0; i < s->n; ++i)
    for (PetscInt d = 0; d < dim; ++d) start[i * dim + d] = rule->start[s->place[i] * dim + d];
  if (!matter_find_joined(rule->matter, origin->field, origin->from, s->n, start, joined)) return PETSC_TRUE;
  for (PetscInt i = 0; i < s->n; ++i) {
    if (!joined[i]) continue;
    s->place[n] = s->place[i];
    for (PetscInt d = 0; d < dim; ++d) s->X[n * dim + d] = s->X[i * dim + d];
    ++n;
  }
  s->n = n;
  return joined[0];
}

/* Do nodes beyond the radius aimed at have no part in a cloud of this radius? They have where links
 * lead through them. */
static PetscBool radius_is_enough(const CloudSupport *s)
{
  return s->rule == SUPPORT_FIXED || s->gap <= 0 || s->radius <= s->gap;
}

/* vectors <- vectors map */
static void apply_map(PetscInt dim, const NeighboursMap *map, PetscInt n, PetscReal *vectors)
{
  for (PetscInt i = 0; i < n; ++i) {
    PetscReal v[3] = {0, 0, 0};
    for (PetscInt k = 0; k < dim; ++k)
      for (PetscInt l = 0; l < dim; ++l) v[k] += map->map[k * dim + l] * vectors[i * dim + l];
    for (PetscInt k = 0; k < dim; ++k) vectors[i * dim + k] = v[k];
  }
}

/* The cloud of a point among the nodes around it, and its functions. In material that is drawn out all of it is done in
 * the mapped space, and gradients come back by the map. Links then need no F: the map has taken its place. */
static SupportReport choose_cloud(const CloudSupport *support, const CloudRule *rule, const NeighboursMap *map,
                                  const PetscReal *F, const PetscReal *x, PetscInt dim, Surroundings *s, int *chosen,
                                  PetscReal *N, PetscReal *dN)
{
  PetscReal metric[9], y[3] = {0, 0, 0};
  const PetscReal *m = F && !map && metric_of(dim, F, metric) ? metric : NULL;
  for (PetscInt d = 0; d < dim; ++d) y[d] = x[d];
  if (map) {
    apply_map(dim, map, s->n, s->X);
    apply_map(dim, map, 1, y);
  }
  const SupportReport report =
    cloud_support(support, &rule->basis, (int)dim, (int)s->n, s->X, rule->h, m, y, chosen, N, dN, NULL);
  if (map) apply_map(dim, map, report.n, dN);
  return report;
}

PetscInt cloud_at(const Neighbours *nodes, const CloudRule *rule, const PetscReal *x, const PetscReal *F,
                  const CloudOrigin *origin, PetscInt *node, PetscReal *N, PetscReal *dN, CloudTally *tally)
{
  const PetscInt dim = nodes->dim;
  const CloudSupport *support = &rule->support;
  int chosen[CLOUD_MAX_NODES];
  NeighboursMap room;
  Surroundings s;
  SupportReport report = {.level = SUPPORT_EMPTY};
  PetscBool apart = PETSC_FALSE;

  const NeighboursMap *map = F && rule->follows ? cloud_stretch(dim, F, &room) : NULL;
  /* few points need to look beyond the radius */
  for (int far = radius_is_enough(support) ? 0 : 1; far < 2; ++far) {
    look_around(nodes, map, x, (far ? support->max_radius : support->radius) * rule->h, &s);
    if (origin && rule->matter) apart = !keep_joined(dim, rule, origin, &s);
    report = choose_cloud(support, rule, map, F, x, dim, &s, chosen, N, dN);
    if (report.level == SUPPORT_NOMINAL) break;
  }
  for (int i = 0; i < report.n; ++i) node[i] = s.place[chosen[i]];
  sort_cloud(dim, report.n, node, N, dN);
  ++tally->level[report.level];
  tally->nodes += report.n;
  tally->entered += apart;
  return report.n;
}

/* Room for the nodes of one more point; what is there stays. */
static PetscErrorCode Grow(Support *s, PetscInt nodes, PetscInt dim)
{
  PetscReal *N, *dN;

  PetscFunctionBeginUser;
  if (nodes + CLOUD_MAX_NODES <= s->capacity_nodes && nodes + CLOUD_MAX_NODES <= s->capacity_values)
    PetscFunctionReturn(0);
  PetscCheck(nodes <= count_most(3) - 16 * CLOUD_MAX_NODES, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "%" PetscInt_FMT " nodes in the clouds of one rank are too many: use more ranks", nodes);
  const PetscInt capacity = PetscMin(nodes + nodes / 2 + 16 * CLOUD_MAX_NODES, count_most(3));
  PetscCall(PetscRealloc((size_t)capacity * sizeof *s->node, &s->node));
  PetscCall(PetscMalloc2(capacity, &N, (size_t)capacity * (size_t)dim, &dN));
  PetscCall(PetscArraycpy(N, s->N, nodes));
  PetscCall(PetscArraycpy(dN, s->dN, count_numbers(nodes, dim)));
  PetscCall(PetscFree2(s->N, s->dN));
  s->N = N;
  s->dN = dN;
  s->capacity_nodes = s->capacity_values = capacity;
  PetscFunctionReturn(0);
}

/* Where a point was at the start: the middle of the cell that it was born in, since displacements may begin anew with a
 * stage; of what knows no cell, places of nodes, where it was. */
static PetscBool born_at(const CloudRule *rule, const Points *points, PetscInt p, PetscReal from[3])
{
  if (!rule->matter || (points->cell && points->cell[p] < 0)) return PETSC_FALSE;
  for (PetscInt d = 0; d < points->dim; ++d)
    from[d] = points->cell ? rule->matter->centre[points->cell[p] * points->dim + d]
                           : point_real(points, POINT_X, p)[d] - point_real(points, POINT_U, p)[d];
  return PETSC_TRUE;
}

PetscErrorCode SupportFromClouds(Support *s, const Points *points, const Neighbours *nodes, const CloudRule *rule)
{
  const PetscInt dim = nodes->dim, n = points->n;
  const PetscBool has_F = points->real[POINT_F] != NULL;
  CloudRule here = *rule;
  PetscReal F[9], from[3];
  PetscInt entries = 0;

  PetscFunctionBeginUser;
  PetscCall(SupportReserve(s, n, 0, 0, dim));
  s->n_groups = n;
  s->n_runs = 0;
  s->tally = (CloudTally){.nodes = 0};
  for (PetscInt p = 0; p < n; ++p) {
    PetscCall(Grow(s, entries, dim));
    s->point_start[p] = p;
    s->node_start[p] = s->value_start[p] = entries;
    if (has_F) point_F(points, p, F);
    if (!s->tally.entered) s->tally.first_entered = p;
    const PetscBool born = born_at(rule, points, p, from);
    const CloudOrigin origin = {.from = from, .field = point_field(points, p)};
    here.h = cloud_spacing_of(points, p, rule->h);
    entries += cloud_at(nodes + origin.field, &here, points->real[POINT_X] + (size_t)p * (size_t)dim, has_F ? F : NULL,
                        born ? &origin : NULL, s->node + entries, s->N + entries, s->dN + entries * dim, &s->tally);
  }
  s->point_start[n] = n;
  s->node_start[n] = s->value_start[n] = entries;
  PetscFunctionReturn(0);
}
