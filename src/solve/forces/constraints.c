#include "solve/forces/nodal_force.h"

#define LEAST 0.1 /* of the field must be left, where nodes are left out */

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
    PetscCall(PetscRealloc((size_t)(c->capacity_nodes * c->dim) * sizeof *c->N, &c->N));
    PetscCall(PetscRealloc((size_t)c->capacity_nodes * 2 * sizeof *c->slot, &c->slot));
  }
  c->at[c->n] = at;
  c->twin[c->n] = twin;
  PetscCall(PetscArraycpy(c->node + first, node, nn));
  for (PetscInt i = 0; i < nn * c->dim; ++i) c->N[first * c->dim + i] = N[i / c->dim];
  c->start[++c->n] = first + nn;
  PetscFunctionReturn(0);
}

/* Component d of constraint k. */
static void leave_out(Constraints *c, PetscInt k, PetscInt d, const unsigned char *touched, const unsigned char *held)
{
  PetscReal rest = 0;
  PetscBool all = PETSC_TRUE;
  for (PetscInt e = c->start[k]; e < c->start[k + 1]; ++e) {
    const PetscBool moves = (PetscBool)(touched[c->node[e]] || held[c->node[e] * c->dim + d]);
    if (moves) rest += c->N[e * c->dim + d];
    else all = PETSC_FALSE;
  }
  if (all || rest < LEAST) return;
  for (PetscInt e = c->start[k]; e < c->start[k + 1]; ++e)
    c->N[e * c->dim + d] *= touched[c->node[e]] || held[c->node[e] * c->dim + d] ? 1 / rest : 0;
}

void constraints_leave_out(Constraints *c, const unsigned char *touched, const unsigned char *held)
{
  for (PetscInt k = 0; k < c->n; ++k)
    for (PetscInt d = 0; d < c->dim; ++d) leave_out(c, k, d, touched, held);
}

PetscBool constraints_find_slots(Constraints *c, const System *system)
{
  PetscInt missing = 0;
  for (PetscInt k = 0; k < c->n; ++k)
    for (PetscInt e = c->start[k]; e < c->start[k + 1]; ++e) {
      c->slot[2 * e] = system_pair(system, c->node[e], c->twin[k]);
      c->slot[2 * e + 1] = system_pair(system, c->twin[k], c->node[e]);
      missing += c->slot[2 * e] < 0 || c->slot[2 * e + 1] < 0;
    }
  return !missing;
}

/* One component of one constraint. */
static void assemble_component(const Constraints *c, PetscInt k, PetscInt d, const NodalScene *scene,
                               const NodalOutput *out)
{
  const PetscInt dim = c->dim, twin = c->twin[k] * dim + d;
  const PetscReal mu = scene->du[twin];
  PetscReal gap = -scene->prescribed[c->at[k] * dim + d];
  for (PetscInt e = c->start[k]; e < c->start[k + 1]; ++e) {
    const PetscInt i = c->node[e] * dim + d;
    const PetscReal N = c->N[e * dim + d], weight = c->scale * N;
    gap += N * scene->du[i];
    out->force[i] -= weight * mu;
    nodal_add_tangent(out, dim, c->slot[2 * e], i, twin, -weight);
    nodal_add_tangent(out, dim, c->slot[2 * e + 1], twin, i, -weight);
  }
  out->force[twin] -= c->scale * gap;
}

void constraints_assemble(const Constraints *c, const NodalScene *scene, const NodalOutput *out)
{
  for (PetscInt k = 0; k < c->n; ++k)
    for (PetscInt d = 0; d < c->dim; ++d)
      if (!scene->fixed[c->twin[k] * c->dim + d]) assemble_component(c, k, d, scene, out);
}

void constraints_relax(const Constraints *c, const unsigned char *held, const PetscReal *target, PetscReal *v,
                       PetscReal *correction)
{
  for (PetscInt k = 0; k < c->n; ++k)
    for (PetscInt d = 0; d < c->dim; ++d) {
      const PetscInt at = c->at[k] * c->dim + d;
      PetscReal gap = target[at], share = 0;
      for (PetscInt e = c->start[k]; e < c->start[k + 1]; ++e) {
        const PetscReal N = c->N[e * c->dim + d];
        gap -= N * v[c->node[e] * c->dim + d];
        if (held[c->node[e] * c->dim + d]) share += PetscAbsReal(N);
      }
      correction[at] = held[at] && share > 0.1 ? gap / share : 0;
    }
  for (PetscInt k = 0; k < c->n; ++k)
    for (PetscInt at = c->at[k] * c->dim; at < (c->at[k] + 1) * c->dim; ++at) {
      v[at] += correction[at];
      correction[at] = 0;
    }
}

static PetscErrorCode Create(const NodalScene *scene, Diag *diag, void **data)
{
  (void)diag;
  PetscFunctionBeginUser;
  *data = scene->constraints;
  PetscFunctionReturn(0);
}

static PetscErrorCode Assemble(void *data, const NodalScene *scene, const NodalOutput *out)
{
  PetscFunctionBeginUser;
  constraints_assemble(data, scene, out);
  PetscFunctionReturn(0);
}

static PetscBool find_slots(void *data, const System *system) { return constraints_find_slots(data, system); }
static const Constraints *itself(const void *data) { return data; }

const NodalForce nodal_force_constraints = {
  .name = "constraints",
  .help = "what holds a cloud of nodes where motion is prescribed",
  .create = Create,
  .find_slots = find_slots,
  .assemble = Assemble,
  .constraints = itself,
};
