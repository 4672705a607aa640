/* Tractions along a wall. More points may touch it than nodes can follow, and how they share the force of a
 * node is theirs alone: so forces and surfaces are both handed to the nodes by the shape functions, divided
 * there, and taken back. A uniform traction stays as it is, to the edge of the contact. */
#include "solve/contact/contact.h"

#define HAIR 4e-3  /* of a cell */
#define BESIDE 0.5 /* of its functions */

/* A shape function of the material point; those that dip below zero would divide by little. */
static PetscReal weight_of(const Contact *s, PetscInt e) { return PetscMax(0, s->N[e] - s->lead[e]); }

/* Surface of what bears something at each node, before each partner: n_nodes x n_partners. */
static PetscErrorCode Bearing(const Contact *s, const Grid *grid, PetscReal *nodes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(nodes, grid->n_nodes * s->n_partners));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    for (PetscInt e = c->first; e < c->first + c->own && c->state != CONTACT_OPEN; ++e)
      nodes[s->node[e] * s->n_partners + c->wall] += weight_of(s, e) * c->section;
  PetscCall(GridSumToOwners(grid, s->n_partners, nodes));
  PetscCall(GridToGhosts(grid, s->n_partners, nodes));
  PetscFunctionReturn(0);
}

/* Of more points than nodes can follow some bear nothing, a hair off the wall (along an edge that a wedge has turned it
 * was each second one). The share of such a one's functions that is at nodes where others bear something. */
static PetscReal beside(const Contact *s, const ContactPoint *c, PetscReal gap, const PetscReal *nodes)
{
  PetscReal sum = 0, borne = 0;
  if (c->state != CONTACT_OPEN || !(gap <= HAIR * s->length)) return 0;
  for (PetscInt e = c->first; e < c->first + c->own; ++e) {
    sum += weight_of(s, e);
    if (nodes[s->node[e] * s->n_partners + c->wall] > 0) borne += weight_of(s, e);
  }
  return sum > 0 ? borne / sum : 0;
}

PetscErrorCode ContactCover(Contact *s, const Grid *grid)
{
  PetscReal *nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_nodes * s->n_partners, &nodes));
  PetscCall(Bearing(s, grid, nodes));
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c)
    c->covered = (PetscBool)(c->state != CONTACT_OPEN || beside(s, c, c->gap, nodes) >= BESIDE);
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
      if (bearing[s->node[e] * s->n_partners + c->wall] > 0) sum += weight_of(s, e);
    for (PetscInt e = c->first; e < c->first + c->own; ++e) {
      const PetscInt at = s->node[e] * s->n_partners + c->wall;
      if (bearing[at] > 0) lent[at] += c->own_bond * weight_of(s, e) / sum;
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
      if (bearing[at] > 0) c->bond += weight_of(s, e) * c->section * lent[at] / bearing[at];
    }
    most[0] = PetscMax(most[0], PetscAbsReal(c->bond - before[k]));
    most[1] = PetscMax(most[1], c->bond);
  }
  PetscCall(PetscFree3(bearing, lent, before));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPIU_MAX, grid->comm));
  *changed = most[1] > 0 ? most[0] / most[1] : 0;
  PetscFunctionReturn(0);
}

static PetscBool takes_part(const ContactPoint *c, PetscInt wall)
{
  return c->wall == wall && c->covered ? PETSC_TRUE : PETSC_FALSE;
}

/* Force and surface at each node: n_nodes x 4. */
static PetscErrorCode ToNodes(const Contact *s, const Grid *grid, PetscInt wall, PetscReal share, PetscReal *nodes)
{
  PetscReal f[3];

  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    if (!takes_part(c, wall)) continue;
    contact_force(c, f);
    for (PetscInt e = c->first; e < c->first + c->n; ++e) {
      PetscReal *at = nodes + 4 * s->node[e];
      for (int d = 0; d < 3; ++d) at[d] += weight_of(s, e) * share * f[d];
      at[3] += weight_of(s, e) * c->section;
    }
  }
  PetscCall(GridSumToOwners(grid, 4, nodes));
  PetscCall(GridToGhosts(grid, 4, nodes));
  PetscFunctionReturn(0);
}

static void from_nodes(const Contact *s, const ContactPoint *c, const PetscReal *nodes, ContactTraction *t)
{
  PetscReal sum = 0, traction[3] = {0, 0, 0};
  for (PetscInt e = c->first; e < c->first + c->n; ++e) {
    const PetscReal *at = nodes + 4 * s->node[e], weight = weight_of(s, e);
    if (!(at[3] > 0)) continue;
    sum += weight;
    for (int d = 0; d < 3; ++d) traction[d] += weight * at[d] / at[3];
  }
  t->pressure = 0;
  for (int d = 0; d < 3; ++d) t->normal[d] = c->normal[d], t->pressure += traction[d] * c->normal[d] / sum;
  for (int d = 0; d < 3; ++d) t->shear[d] = traction[d] / sum - t->pressure * c->normal[d];
}

PetscErrorCode ContactTractions(const Contact *s, const Grid *grid, PetscInt wall, const PetscReal *du, PetscReal share,
                                PetscInt *n, ContactTraction **tractions)
{
  PetscReal *nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(4 * grid->n_nodes, &nodes));
  PetscCall(PetscMalloc1(s->n, tractions));
  PetscCall(ToNodes(s, grid, wall, share, nodes));
  *n = 0;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    ContactTraction *t = *tractions + *n;
    if (!takes_part(c, wall)) continue;
    from_nodes(s, c, nodes, t);
    contact_place(s, c, du, 1, t->x);
    contact_force(c, t->force);
    for (int d = 0; d < 3; ++d) t->force[d] *= share;
    t->section = c->section;
    ++*n;
  }
  PetscCall(PetscFree(nodes));
  PetscFunctionReturn(0);
}
