/* Tractions along a wall. More points may touch it than nodes can follow, and how they share the force of a
 * node is theirs alone: so forces and surfaces are both handed to the nodes by the shape functions, divided
 * there, and taken back. A uniform traction stays as it is, to the edge of the contact.
 *
 * Beside a corner of the wall a node has surfaces of more than one side. Their tractions are not alike: they are those
 * of the stress S with S n A = f of all of them, as near as may be. */
#include "base/math/eigen.h"
#include "base/math/tensor.h"
#include "solve/contact/touch/weight.h"

#define ALIKE 0.97 /* what normals add up to, of 1: surfaces of one side, however it is bent */
#define NONE 0.01  /* of the surface that looks along an axis, over the largest: there is none */

/* What a node is handed. */
enum { AT_FORCE, AT_SURFACE = 3, AT_NORMAL, AT_SQUARE = 7, AT_SPREAD = 13, AT_ALL = 22 };

static PetscBool takes_part(const ContactPoint *c, PetscInt wall)
{
  return c->wall == wall && c->covered ? PETSC_TRUE : PETSC_FALSE;
}

/* Of one point to one node: force and surface, and with the normal n of this n A, n n A, and f n. */
static void hand(const ContactPoint *c, PetscReal weight, PetscReal share, const PetscReal f[3], PetscReal *at)
{
  const PetscReal *n = c->push, area = weight * c->section;
  for (int i = 0; i < 3; ++i) {
    at[AT_FORCE + i] += weight * share * f[i];
    at[AT_NORMAL + i] += area * n[i];
    for (int j = 0; j < 3; ++j) at[AT_SPREAD + 3 * i + j] += weight * share * f[i] * n[j];
  }
  for (int k = 0; k < 6; ++k) at[AT_SQUARE + k] += area * n[voigt_row[k]] * n[voigt_column[k]];
  at[AT_SURFACE] += area;
}

/* Where nodes follow others some functions dip below zero, and what is left of them adds up to more than 1. */
static PetscReal all_weights(const Contact *s, const ContactPoint *c)
{
  PetscReal sum = 0;
  for (PetscInt e = c->first; e < c->first + c->n; ++e) sum += contact_weight(s, e);
  return sum;
}

/* What each node has: n_nodes x AT_ALL. */
static PetscErrorCode ToNodes(const Contact *s, const Grid *grid, PetscInt wall, PetscReal share, PetscReal *nodes)
{
  PetscReal f[3];

  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    if (!takes_part(c, wall)) continue;
    const PetscReal whole = all_weights(s, c);
    contact_force(c, f);
    for (PetscInt e = c->first; e < c->first + c->n; ++e)
      hand(c, contact_weight(s, e) / whole, share, f, nodes + AT_ALL * s->node[e]);
  }
  PetscCall(GridSumToOwners(grid, AT_ALL, nodes));
  PetscCall(GridToGhosts(grid, AT_ALL, nodes));
  PetscFunctionReturn(0);
}

/* The traction of a node on a surface with the normal n. */
static void traction_at(const PetscReal *at, const PetscReal n[3], PetscReal traction[3])
{
  PetscReal value[3], v[9], to[3] = {0, 0, 0};
  const PetscReal *sum = at + AT_NORMAL;
  for (int i = 0; i < 3; ++i) traction[i] = at[AT_FORCE + i] / at[AT_SURFACE];
  if (PetscSqrtReal(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) > ALIKE * at[AT_SURFACE]) return;
  sym_eigen(at + AT_SQUARE, value, v);
  const PetscReal largest = PetscMax(value[0], PetscMax(value[1], value[2]));
  for (int k = 0; k < 3; ++k) {
    const PetscReal along = v[k] * n[0] + v[3 + k] * n[1] + v[6 + k] * n[2];
    for (int i = 0; i < 3 && value[k] > NONE * largest; ++i) to[i] += v[3 * i + k] * along / value[k];
  }
  for (int i = 0; i < 3; ++i) {
    traction[i] = 0;
    for (int j = 0; j < 3; ++j) traction[i] += at[AT_SPREAD + 3 * i + j] * to[j];
  }
}

static void from_nodes(const Contact *s, const ContactPoint *c, const PetscReal *nodes, ContactTraction *t)
{
  PetscReal sum = 0, traction[3] = {0, 0, 0}, of_node[3];
  for (PetscInt e = c->first; e < c->first + c->n; ++e) {
    const PetscReal *at = nodes + AT_ALL * s->node[e], weight = contact_weight(s, e);
    if (!(at[AT_SURFACE] > 0)) continue;
    sum += weight;
    traction_at(at, c->push, of_node);
    for (int d = 0; d < 3; ++d) traction[d] += weight * of_node[d];
  }
  t->pressure = 0;
  for (int d = 0; d < 3; ++d) t->normal[d] = c->push[d], t->pressure += traction[d] * c->push[d] / sum;
  for (int d = 0; d < 3; ++d) t->shear[d] = traction[d] / sum - t->pressure * c->normal[d];
}

PetscErrorCode ContactTractions(const Contact *s, const Grid *grid, PetscInt wall, const PetscReal *du, PetscReal share,
                                PetscInt *n, ContactTraction **tractions)
{
  PetscReal *nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(AT_ALL * grid->n_nodes, &nodes));
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
