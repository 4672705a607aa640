#include "support/support.h"

PetscErrorCode SupportCreate(Support **support)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(support));
  PetscFunctionReturn(0);
}

PetscErrorCode SupportDestroy(Support **support)
{
  Support *s = *support;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  PetscCall(PetscFree3(s->point_start, s->node_start, s->value_start));
  PetscCall(PetscFree(s->node));
  PetscCall(PetscFree2(s->N, s->dN));
  PetscCall(PetscFree(*support));
  PetscFunctionReturn(0);
}

/* Half more than is needed or was there, so that a slowly growing table is not copied at every
 * step. */
static inline PetscInt grown(PetscInt needed, PetscInt capacity) { return PetscMax(needed, capacity + capacity / 2); }

/* Nothing is kept: the arrays are filled anew at every step. */
PetscErrorCode SupportReserve(Support *s, PetscInt groups, PetscInt nodes, PetscInt values, PetscInt dim)
{
  PetscFunctionBeginUser;
  if (groups > s->capacity_groups || !s->point_start) {
    const PetscInt n = s->capacity_groups = grown(groups, s->capacity_groups);
    PetscCall(PetscFree3(s->point_start, s->node_start, s->value_start));
    PetscCall(PetscMalloc3(n + 1, &s->point_start, n + 1, &s->node_start, n + 1, &s->value_start));
  }
  if (nodes > s->capacity_nodes) {
    s->capacity_nodes = grown(nodes, s->capacity_nodes);
    PetscCall(PetscFree(s->node));
    PetscCall(PetscMalloc1(s->capacity_nodes, &s->node));
  }
  if (values > s->capacity_values) {
    s->capacity_values = grown(values, s->capacity_values);
    PetscCall(PetscFree2(s->N, s->dN));
    PetscCall(PetscMalloc2(s->capacity_values, &s->N, (size_t)s->capacity_values * (size_t)dim, &s->dN));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode NodeGroupsCreate(PetscInt expected, NodeGroups *groups)
{
  PetscFunctionBeginUser;
  *groups = (NodeGroups){.room_groups = expected + 1, .room_nodes = 16 * expected};
  PetscCall(PetscCalloc1(groups->room_groups, &groups->start));
  PetscCall(PetscMalloc1(groups->room_nodes, &groups->node));
  PetscFunctionReturn(0);
}

PetscErrorCode NodeGroupsAdd(NodeGroups *groups, PetscInt n, const PetscInt *node)
{
  PetscFunctionBeginUser;
  if (groups->n + 2 > groups->room_groups) {
    groups->room_groups = grown(groups->n + 2, groups->room_groups);
    PetscCall(PetscRealloc((size_t)groups->room_groups * sizeof *groups->start, &groups->start));
  }
  const PetscInt first = groups->start[groups->n];
  if (first + n > groups->room_nodes) {
    groups->room_nodes = grown(first + n, groups->room_nodes);
    PetscCall(PetscRealloc((size_t)groups->room_nodes * sizeof *groups->node, &groups->node));
  }
  PetscCall(PetscArraycpy(groups->node + first, node, n));
  groups->start[++groups->n] = first + n;
  PetscFunctionReturn(0);
}

PetscErrorCode NodeGroupsDestroy(NodeGroups *groups)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(groups->start));
  PetscCall(PetscFree(groups->node));
  PetscFunctionReturn(0);
}

PetscBool support_touched(const Support *s, PetscInt group, const unsigned char *touched, PetscReal *N)
{
  const PetscInt nn = support_nodes(s, group), *node = s->node + s->node_start[group];
  PetscReal sum = 0;
  for (PetscInt I = 0; I < nn; ++I) {
    N[I] = touched[node[I]] ? s->N[s->value_start[group] + I] : 0;
    sum += N[I];
  }
  if (sum <= 1e-12) return PETSC_FALSE;
  for (PetscInt I = 0; I < nn; ++I) N[I] /= sum;
  return PETSC_TRUE;
}
