/* What touches, and what bears: of more points than nodes can follow some bear nothing, a hair off the wall (along an
 * edge that a wedge has turned it was each second one). Their surface counts as touching, and what it bears by adhesion
 * bear those beside them (docs/theory.md, section 65). */
#include "base/math/vector.h"
#include "solve/contact/touch/weight.h"

#define HAIR 4e-3   /* of a cell */
#define BESIDE 0.5  /* of its functions */
#define POCKET 3e-2 /* of a cell: what bends (a ball of eight cells) leaves as much between two that bear */
#define AMIDST 0.3  /* of a cell from the middle of what bears around it */

/* What bears at a node before a partner: its surface, and that times its place. */
enum { AT_BEARER, AT_PLACE, AT_ALL = 4 };

/* Surface of what bears something at each node, before each partner: n_nodes x n_partners. */
static PetscErrorCode Bearing(const Contact *s, const Grid *grid, PetscReal *nodes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(nodes, grid->n_nodes * s->n_partners));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    for (PetscInt e = c->first; e < c->first + c->own && c->state != CONTACT_OPEN; ++e)
      nodes[s->node[e] * s->n_partners + c->wall] += contact_weight(s, e) * c->section;
  PetscCall(GridSumToOwners(grid, s->n_partners, nodes));
  PetscCall(GridToGhosts(grid, s->n_partners, nodes));
  PetscFunctionReturn(0);
}

/* Where a body ends a hair beyond a line of the grid those behind that are as near, and have none of the surface. */
static PetscBool is_near(const Contact *s, const ContactPoint *c, PetscReal gap)
{
  return (PetscBool)(c->state == CONTACT_OPEN && !c->inner && gap <= HAIR * s->length);
}

/* The share of the functions of one that bears nothing that is at nodes where others bear something. */
static PetscReal beside(const Contact *s, const ContactPoint *c, PetscReal gap, const PetscReal *nodes)
{
  PetscReal sum = 0, borne = 0;
  if (!is_near(s, c, gap)) return 0;
  for (PetscInt e = c->first; e < c->first + c->own; ++e) {
    sum += contact_weight(s, e);
    if (nodes[s->node[e] * s->n_partners + c->wall] > 0) borne += contact_weight(s, e);
  }
  return sum > 0 ? borne / sum : 0;
}

static PetscBool is_over_pocket(const Contact *s, const ContactPoint *c)
{
  return (PetscBool)(c->state == CONTACT_OPEN && !c->inner && c->gap <= POCKET * s->length);
}

/* What bears at each node, and where: n_nodes x n_partners x AT_ALL. */
static PetscErrorCode Bearers(const Contact *s, const Grid *grid, PetscReal *nodes)
{
  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    for (PetscInt e = c->first; e < c->first + c->own && c->state != CONTACT_OPEN; ++e) {
      PetscReal *at = nodes + AT_ALL * (s->node[e] * s->n_partners + c->wall);
      const PetscReal area = contact_weight(s, e) * c->section;
      at[AT_BEARER] += area;
      for (int d = 0; d < 3; ++d) at[AT_PLACE + d] += area * c->x[d];
    }
  PetscCall(GridSumToOwners(grid, AT_ALL * s->n_partners, nodes));
  PetscCall(GridToGhosts(grid, AT_ALL * s->n_partners, nodes));
  PetscFunctionReturn(0);
}

/* Does it stand between others that bear, not beyond the last of them? Then something bears at all of its nodes, on
 * either side: what they can follow of a bent surface leaves it off the wall. Its ring about an axis has the same on
 * the other side. */
static PetscBool is_amidst(const Contact *s, const ContactPoint *c, const PetscReal *nodes)
{
  PetscReal sum = 0, aside[3] = {0, 0, 0};
  for (PetscInt e = c->first; e < c->first + c->own; ++e) {
    const PetscReal *at = nodes + AT_ALL * (s->node[e] * s->n_partners + c->wall), weight = contact_weight(s, e);
    if (weight > 0 && at[AT_BEARER] <= 0) return PETSC_FALSE;
    for (int d = 0; d < 3 && weight > 0; ++d) aside[d] += weight * (at[AT_PLACE + d] / at[AT_BEARER] - c->x[d]);
    sum += weight;
  }
  if (s->hoop && c->x[0] < s->length) aside[0] = PetscMin(0, aside[0]);
  const PetscReal along = vector_dot(aside, c->facing);
  for (int d = 0; d < 3; ++d) aside[d] -= along * c->facing[d];
  return (PetscBool)(vector_dot(aside, aside) <= PetscSqr(AMIDST * s->length * sum));
}

/* Counts those over pockets between others. */
static PetscErrorCode CoverPockets(Contact *s, const Grid *grid)
{
  PetscReal *nodes;
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) any = (PetscBool)(any || is_over_pocket(s, c));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &any, 1, MPIU_BOOL, MPI_LOR, grid->comm));
  if (!any) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(AT_ALL * grid->n_nodes * s->n_partners, &nodes));
  PetscCall(Bearers(s, grid, nodes));
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c)
    c->covered = (PetscBool)(c->covered || (is_over_pocket(s, c) && is_amidst(s, c, nodes)));
  PetscCall(PetscFree(nodes));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactCover(Contact *s, const Grid *grid)
{
  PetscReal *nodes;
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    c->covered = (PetscBool)(c->state != CONTACT_OPEN);
    any = (PetscBool)(any || is_near(s, c, c->gap));
  }
  PetscCall(CoverPockets(s, grid));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &any, 1, MPIU_BOOL, MPI_LOR, grid->comm));
  if (!any) PetscFunctionReturn(0); /* as a rule */
  PetscCall(PetscMalloc1(grid->n_nodes * s->n_partners, &nodes));
  PetscCall(Bearing(s, grid, nodes));
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c)
    c->covered = (PetscBool)(c->covered || beside(s, c, c->gap, nodes) >= BESIDE);
  PetscCall(PetscFree(nodes));
  PetscFunctionReturn(0);
}

/* What bonds are lent at nodes, to each partner's bearers there; who lends has none left. */
static PetscErrorCode Lent(Contact *s, const Grid *grid, PetscBool starts, const PetscReal *bearing, PetscReal *lent)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(lent, grid->n_nodes * s->n_partners));
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const PetscBool may = (PetscBool)(c->own_bond > 0 && c->law.kind == CONTACT_FRICTION);
    const PetscReal share = may ? beside(s, c, starts ? c->open : c->gap, bearing) : 0;
    PetscReal sum = 0;
    c->bond = share < BESIDE ? c->own_bond : 0;
    if (share < BESIDE) continue;
    for (PetscInt e = c->first; e < c->first + c->own; ++e)
      if (bearing[s->node[e] * s->n_partners + c->wall] > 0) sum += contact_weight(s, e);
    for (PetscInt e = c->first; e < c->first + c->own; ++e) {
      const PetscInt at = s->node[e] * s->n_partners + c->wall;
      if (bearing[at] > 0) lent[at] += c->own_bond * contact_weight(s, e) / sum;
    }
  }
  PetscCall(GridSumToOwners(grid, s->n_partners, lent));
  PetscCall(GridToGhosts(grid, s->n_partners, lent));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactLend(Contact *s, const Grid *grid, PetscBool starts, PetscReal *changed)
{
  const PetscInt n = grid->n_nodes * s->n_partners;
  PetscReal *bearing, *lent, *before, most[2] = {0, 0}; /* change, bond */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &bearing, n, &lent, s->n, &before));
  PetscCall(Bearing(s, grid, bearing));
  for (PetscInt k = 0; k < s->n; ++k) before[k] = s->point[k].bond;
  PetscCall(Lent(s, grid, starts, bearing, lent));
  for (PetscInt k = 0; k < s->n; ++k) {
    ContactPoint *c = s->point + k;
    for (PetscInt e = c->first; e < c->first + c->own && c->state != CONTACT_OPEN; ++e) {
      const PetscInt at = s->node[e] * s->n_partners + c->wall;
      if (bearing[at] > 0) c->bond += contact_weight(s, e) * c->section * lent[at] / bearing[at];
    }
    most[0] = PetscMax(most[0], PetscAbsReal(c->bond - before[k]));
    most[1] = PetscMax(most[1], c->bond);
  }
  PetscCall(PetscFree3(bearing, lent, before));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPIU_MAX, grid->comm));
  *changed = most[1] > 0 ? most[0] / most[1] : 0;
  PetscFunctionReturn(0);
}
