#include "solve/levels/lists.h"

PetscErrorCode ListsCreate(PetscInt n, const PetscInt *count, Lists *l)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n + 1, &l->start));
  l->start[0] = 0;
  for (PetscInt k = 0; k < n; ++k) l->start[k + 1] = l->start[k] + count[k];
  PetscCall(PetscMalloc1(l->start[n], &l->item));
  PetscFunctionReturn(0);
}

PetscErrorCode ListsDestroy(Lists *l)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(l->start));
  PetscCall(PetscFree(l->item));
  PetscFunctionReturn(0);
}

PetscErrorCode ListsTranspose(PetscInt n, const Lists *l, PetscInt n_items, Lists *t)
{
  PetscInt *count;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n_items, &count));
  for (PetscInt e = 0; e < l->start[n]; ++e) ++count[l->item[e]];
  PetscCall(ListsCreate(n_items, count, t));
  PetscCall(PetscArrayzero(count, n_items));
  for (PetscInt k = 0; k < n; ++k)
    for (PetscInt e = l->start[k]; e < l->start[k + 1]; ++e) t->item[t->start[l->item[e]] + count[l->item[e]]++] = k;
  PetscCall(PetscFree(count));
  PetscFunctionReturn(0);
}

/* Of list k: how many, and which, unless item is NULL. last: of each item, the list that had it last. */
static PetscInt unite(PetscInt k, const Lists *names, const Lists *parts, PetscInt *last, PetscInt *item)
{
  PetscInt n = 0;
  for (PetscInt e = names->start[k]; e < names->start[k + 1]; ++e)
    for (PetscInt i = parts->start[names->item[e]]; i < parts->start[names->item[e] + 1]; ++i) {
      const PetscInt it = parts->item[i];
      if (last[it] == k) continue;
      last[it] = k;
      if (item) item[n] = it;
      ++n;
    }
  return n;
}

PetscErrorCode ListsUnite(PetscInt n, const Lists *names, const Lists *parts, PetscInt n_items, Lists *united)
{
  PetscInt *last, *count;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n_items, &last, n, &count));
  for (PetscInt i = 0; i < n_items; ++i) last[i] = -1;
  for (PetscInt k = 0; k < n; ++k) count[k] = unite(k, names, parts, last, NULL);
  PetscCall(ListsCreate(n, count, united));
  for (PetscInt i = 0; i < n_items; ++i) last[i] = -1;
  for (PetscInt k = 0; k < n; ++k) (void)unite(k, names, parts, last, united->item + united->start[k]);
  PetscCall(PetscFree2(last, count));
  PetscFunctionReturn(0);
}

PetscErrorCode ListsMerge(PetscInt n, const Lists *a, const Lists *b, Lists *m)
{
  PetscInt end = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n + 1, &m->start));
  PetscCall(PetscMalloc1(a->start[n] + b->start[n], &m->item));
  for (PetscInt k = 0; k < n; ++k) {
    PetscInt *item = m->item + end, both = 0;
    m->start[k] = end;
    for (PetscInt e = a->start[k]; e < a->start[k + 1]; ++e) item[both++] = a->item[e];
    for (PetscInt e = b->start[k]; e < b->start[k + 1]; ++e) item[both++] = b->item[e];
    PetscCall(PetscSortRemoveDupsInt(&both, item));
    end += both;
  }
  m->start[n] = end;
  PetscFunctionReturn(0);
}
