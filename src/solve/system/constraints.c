#include "solve/system/constraints.h"

PetscErrorCode ConstraintsCreate(PetscInt dim, Constraints **constraints)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(constraints));
  (*constraints)->dim = dim;
  (*constraints)->scale = 1;
  PetscCall(PetscCalloc1(1, &(*constraints)->start));
  PetscFunctionReturn(0);
}

PetscErrorCode ConstraintsDestroy(Constraints **constraints)
{
  Constraints *c = *constraints;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(0);
  PetscCall(PetscFree(c->start));
  PetscCall(PetscFree(c->at));
  PetscCall(PetscFree(c->twin));
  PetscCall(PetscFree(c->node));
  PetscCall(PetscFree(c->N));
  PetscCall(PetscFree(c->slot));
  PetscCall(PetscFree(*constraints));
  PetscFunctionReturn(0);
}

void constraints_clear(Constraints *c) { c->n = 0; }

PetscErrorCode ConstraintsAdd(Constraints *c, PetscInt at, PetscInt twin, PetscInt nn, const PetscInt *node,
                              const PetscReal *N)
{
  PetscFunctionBeginUser;
  if (c->n == c->capacity) {
    c->capacity += c->capacity / 2 + 64;
    PetscCall(PetscRealloc((size_t)(c->capacity + 1) * sizeof *c->start, &c->start));
    PetscCall(PetscRealloc((size_t)c->capacity * sizeof *c->at, &c->at));
    PetscCall(PetscRealloc((size_t)c->capacity * sizeof *c->twin, &c->twin));
  }
  const PetscInt first = c->start[c->n];
  if (first + nn > c->capacity_nodes) {
    c->capacity_nodes += c->capacity_nodes / 2 + nn + 512;
    PetscCall(PetscRealloc((size_t)c->capacity_nodes * sizeof *c->node, &c->node));
    PetscCall(PetscRealloc((size_t)c->capacity_nodes * sizeof *c->N, &c->N));
    PetscCall(PetscRealloc((size_t)c->capacity_nodes * 2 * sizeof *c->slot, &c->slot));
  }
  c->at[c->n] = at;
  c->twin[c->n] = twin;
  PetscCall(PetscArraycpy(c->node + first, node, nn));
  PetscCall(PetscArraycpy(c->N + first, N, nn));
  c->start[++c->n] = first + nn;
  PetscFunctionReturn(0);
}

/* The pair (I, J) in the pattern; -1 if it is not there. */
static PetscInt find_pair(const System *s, PetscInt I, PetscInt J)
{
  const PetscInt row = s->row[I];
  PetscInt k = -1;
  if (row >= 0) (void)PetscFindInt(J, s->row_start[row + 1] - s->row_start[row], s->column + s->row_start[row], &k);
  return k < 0 ? -1 : s->row_start[row] + k;
}

PetscBool constraints_find_slots(Constraints *c, const System *system)
{
  PetscInt missing = 0;
  for (PetscInt k = 0; k < c->n; ++k)
    for (PetscInt e = c->start[k]; e < c->start[k + 1]; ++e) {
      c->slot[2 * e] = find_pair(system, c->node[e], c->twin[k]);
      c->slot[2 * e + 1] = find_pair(system, c->twin[k], c->node[e]);
      missing += c->slot[2 * e] < 0 || c->slot[2 * e + 1] < 0;
    }
  return !missing;
}

/* One component of one constraint. */
static void assemble_component(const Constraints *c, PetscInt k, PetscInt d, const PetscReal *du,
                               const PetscReal *prescribed, PetscReal *force, PetscReal *values)
{
  const PetscInt dim = c->dim, twin = c->twin[k] * dim + d;
  const PetscReal mu = du[twin];
  PetscReal gap = -prescribed[c->at[k] * dim + d];
  for (PetscInt e = c->start[k]; e < c->start[k + 1]; ++e) {
    const PetscInt i = c->node[e] * dim + d;
    const PetscReal weight = c->scale * c->N[e];
    gap += c->N[e] * du[i];
    force[i] -= weight * mu;
    if (!values) continue;
    values[(c->slot[2 * e] * dim + d) * dim + d] -= weight;
    values[(c->slot[2 * e + 1] * dim + d) * dim + d] -= weight;
  }
  force[twin] -= c->scale * gap;
}

void constraints_assemble(const Constraints *c, const PetscReal *du, const PetscReal *prescribed,
                          const unsigned char *fixed, PetscReal *force, PetscReal *values)
{
  for (PetscInt k = 0; k < c->n; ++k)
    for (PetscInt d = 0; d < c->dim; ++d)
      if (!fixed[c->twin[k] * c->dim + d]) assemble_component(c, k, d, du, prescribed, force, values);
}

void constraints_relax(const Constraints *c, const unsigned char *held, const PetscReal *target, PetscReal scale,
                       PetscReal *v, PetscReal *correction)
{
  for (PetscInt k = 0; k < c->n; ++k)
    for (PetscInt d = 0; d < c->dim; ++d) {
      const PetscInt at = c->at[k] * c->dim + d;
      PetscReal gap = scale * target[at], share = 0;
      for (PetscInt e = c->start[k]; e < c->start[k + 1]; ++e) {
        gap -= c->N[e] * v[c->node[e] * c->dim + d];
        if (held[c->node[e] * c->dim + d]) share += PetscAbsReal(c->N[e]);
      }
      correction[at] = held[at] && share > 0.1 ? gap / share : 0;
    }
  for (PetscInt k = 0; k < c->n; ++k)
    for (PetscInt at = c->at[k] * c->dim; at < (c->at[k] + 1) * c->dim; ++at) {
      v[at] += correction[at];
      correction[at] = 0;
    }
}
