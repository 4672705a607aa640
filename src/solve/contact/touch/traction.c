/* Tractions along a wall. More points may touch it than nodes can follow, and how they share the force of a
 * node is theirs alone: so forces and surfaces are both handed to the nodes by the shape functions, divided
 * there, and taken back. A uniform traction stays as it is, to the edge of the contact. */
#include "solve/contact/touch/weight.h"

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
      for (int d = 0; d < 3; ++d) at[d] += contact_weight(s, e) * share * f[d];
      at[3] += contact_weight(s, e) * c->section;
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
    const PetscReal *at = nodes + 4 * s->node[e], weight = contact_weight(s, e);
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
