/* A node follows along as few axes as need be: one step on such a way stands a node that leads, and one more step along
 * each of its axes another one. Who leads with whom is found by the owner of the first of them, who knows the nodes
 * around it; the owner of the follower asks no further than one step, too. */
#include "method/extend/choose.h"
#include "method/extend/row.h"

/* Of half its share of the cells: what a node has at least that leads. */
#define LEADS 0.1
/* The same in explicit steps, whose nodes have lumped masses: of less, more runs away from the body in each substep
 * than points bring back; of more, the node behind would have to give more mass than it has. */
#define LEADS_BY_MASS 0.4
/* In space the corner of a full body, an eighth of a full node, has as much as it needs. */
#define LEADS_BY_MASS_IN_SPACE 0.24

/* Is what holds the first held in the same way in the second, too, so that the first can follow it? */
static PetscBool is_held_as(const Boundary *b, PetscInt one, PetscInt other)
{
  for (PetscInt d = 0; d < b->dim; ++d) {
    const PetscInt i = one * b->dim + d, j = other * b->dim + d;
    if (!b->fixed[i]) continue;
    if (!b->fixed[j] || b->entry[i] != b->entry[j]) return PETSC_FALSE;
    if (frame_of(&b->frames, one) || frame_of(&b->frames, other)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscBool is_held(const Boundary *b, PetscInt node)
{
  for (PetscInt d = 0; d < b->dim; ++d)
    if (b->fixed[node * b->dim + d]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* A node leads along axis d, with the one above it or below: all nodes, and those that are held as it is. */
static PetscInt leads_bit(PetscInt d, PetscBool above, PetscBool held)
{
  return 1 << (4 * d + (above ? 2 : 0) + (held ? 1 : 0));
}

/* What `fill` is where half of a node's share of the cells is full. Mass says only how it is to that of the nodes
 * around: of these the fullest counts as full. */
static PetscReal half_full(const Discretisation *s, const Extension *e, const PetscInt at[LATTICE])
{
  PetscReal most = 0;
  PetscInt step[3];
  for (PetscInt way = 0; e->by_mass && way < WAYS; ++way) {
    way_of(way, step);
    const PetscInt beside = s->grid->dim == 3 || !step[2] ? node_beside(s->grid->box, at, step) : -1;
    if (beside >= 0) most = PetscMax(most, e->fill[beside]);
  }
  return e->by_mass ? 0.5 * most : 1;
}

static PetscReal leads_by_mass(const Discretisation *s)
{
  return s->grid->dim == 3 ? LEADS_BY_MASS_IN_SPACE : LEADS_BY_MASS;
}

/* By mass, what is enough depends on the place: who wants to follow by its own measure, which is in `ways` meanwhile,
 * leads nobody by another's. What is handed on to it would be handed on no further, nor would it from where there is
 * nothing around, which is enough there. */
static PetscBool may_lead(const Extension *e, PetscInt node, PetscReal enough)
{
  return (PetscBool)(e->fill[node] > 0 && e->fill[node] >= enough && !(e->by_mass && e->ways[node] > 0));
}

static PetscReal find_leads(const Discretisation *s, const Extension *e, PetscInt node, const PetscInt at[LATTICE])
{
  const PetscReal least = e->by_mass ? leads_by_mass(s) : PetscMax(LEADS, s->c->stabilisation.follow);
  const PetscReal enough = least * half_full(s, e, at);
  PetscInt bits = 0;
  for (PetscInt k = 0; k < 2 * s->grid->dim && may_lead(e, node, enough); ++k) {
    PetscInt step[3] = {0, 0, 0};
    const PetscBool above = k % 2 ? PETSC_TRUE : PETSC_FALSE;
    step[k / 2] = above ? 1 : -1;
    const PetscInt behind = node_beside(s->grid->box, at, step);
    if (behind < 0 || !may_lead(e, behind, enough)) continue;
    bits |= leads_bit(k / 2, above, PETSC_FALSE);
    if (is_held_as(s->boundary, node, behind)) bits |= leads_bit(k / 2, above, PETSC_TRUE);
  }
  return (PetscReal)bits;
}

static PetscBool is_led(const Discretisation *s, const Extension *e, PetscInt node, const PetscInt at[LATTICE],
                        const PetscInt step[3])
{
  const PetscInt next = node_beside(s->grid->box, at, step);
  if (next < 0 || !is_held_as(s->boundary, node, next)) return PETSC_FALSE;
  const PetscInt bits = (PetscInt)e->leads[next];
  const PetscBool held = is_held(s->boundary, node);
  for (PetscInt d = 0; d < s->grid->dim; ++d)
    if (step[d] && !(bits & leads_bit(d, step[d] > 0 ? PETSC_TRUE : PETSC_FALSE, held))) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscBool node_needs_lead(const Extension *e, PetscInt node)
{
  return (PetscBool)(e->loaded[node] > 0 && e->fill[node] < LEADS);
}

/* Does a node with so little follow, if others lead it? Where a load acts more is asked for: a node has to have
 * stiffness for what it bears, and that it has no material at all is no hindrance. */
static PetscBool wants_lead(const Discretisation *s, const Extension *e, PetscInt node, const PetscInt at[LATTICE])
{
  const PetscReal least = s->c->stabilisation.follow;
  if (e->by_mass) return (PetscBool)(e->loaded[node] > 0 && e->fill[node] < leads_by_mass(s) * half_full(s, e, at));
  if (e->loaded[node] > 0) return (PetscBool)(e->fill[node] < PetscMax(LEADS, least));
  return (PetscBool)(e->fill[node] > 0 && e->fill[node] < least);
}

static PetscReal find_wants(const Discretisation *s, const Extension *e, PetscInt node, const PetscInt at[LATTICE])
{
  return wants_lead(s, e, node, at) ? 1 : 0;
}

static PetscReal find_ways(const Discretisation *s, const Extension *e, PetscInt node, const PetscInt at[LATTICE])
{
  const PetscInt dim = s->grid->dim;
  PetscInt bits = 0, step[3];
  if (!wants_lead(s, e, node, at)) return 0;
  for (PetscInt axes = 1; axes <= dim && !bits; ++axes)
    for (PetscInt way = 0; way < WAYS; ++way) {
      way_of(way, step);
      const PetscInt of_way = PetscAbsInt(step[0]) + PetscAbsInt(step[1]) + PetscAbsInt(step[2]);
      if ((dim == 3 || !step[2]) && of_way == axes && is_led(s, e, node, at, step)) bits |= 1 << way;
    }
  return (PetscReal)bits;
}

/* What `find` says of each node of a list (NULL: the first n) that this rank owns; others are told. */
static PetscErrorCode Find(const Discretisation *s, const Extension *e, PetscInt n, const PetscInt *list,
                           PetscReal (*find)(const Discretisation *s, const Extension *e, PetscInt node,
                                             const PetscInt at[LATTICE]),
                           PetscReal *value)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt node = list ? list[k] : k;
    if (node >= s->grid->n_owned) continue;
    value[node] = find(s, e, node, e->place[node]);
  }
  PetscCall(GridToGhosts(s->grid, 1, value));
  PetscFunctionReturn(0);
}

PetscErrorCode ChooseWays(const Discretisation *s, Extension *e)
{
  PetscFunctionBeginUser;
  PetscCall(Find(s, e, s->grid->n_owned, NULL, find_leads, e->leads));
  PetscCall(Find(s, e, s->grid->n_owned, NULL, find_ways, e->ways));
  PetscFunctionReturn(0);
}

PetscErrorCode ChooseWaysAmong(const Discretisation *s, Extension *e, PetscInt n_leaders, const PetscInt *leader,
                               PetscInt n, const PetscInt *node)
{
  PetscFunctionBeginUser;
  PetscCall(Find(s, e, n, node, find_wants, e->ways));
  PetscCall(Find(s, e, n_leaders, leader, find_leads, e->leads));
  PetscCall(Find(s, e, n, node, find_ways, e->ways));
  PetscFunctionReturn(0);
}
