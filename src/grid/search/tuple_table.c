/* A hash table of small sets of nodes, by which the two cells of a face find each other. */
#include "grid/search/tuple_table.h"

struct TupleTable {
  PetscInt width, n;
  size_t mask;
  PetscInt *slot; /* id + 1, 0: empty */
  PetscInt *key;  /* n x width, each sorted */
};

PetscErrorCode TupleTableCreate(PetscInt width, PetscInt capacity, TupleTable **out)
{
  TupleTable *table;
  size_t slots = 16;

  PetscFunctionBeginUser;
  while (slots < 2 * (size_t)capacity) slots *= 2;
  PetscCall(PetscNew(&table));
  table->width = width;
  table->mask = slots - 1;
  PetscCall(PetscCalloc1(slots, &table->slot));
  PetscCall(PetscMalloc1((size_t)capacity * (size_t)width, &table->key));
  *out = table;
  PetscFunctionReturn(0);
}

PetscErrorCode TupleTableDestroy(TupleTable **table)
{
  PetscFunctionBeginUser;
  if (!*table) PetscFunctionReturn(0);
  PetscCall(PetscFree((*table)->slot));
  PetscCall(PetscFree((*table)->key));
  PetscCall(PetscFree(*table));
  PetscFunctionReturn(0);
}

static void sort_small(PetscInt n, const PetscInt *from, PetscInt *to)
{
  for (PetscInt i = 0; i < n; ++i) {
    PetscInt k = i;
    for (; k > 0 && to[k - 1] > from[i]; --k) to[k] = to[k - 1];
    to[k] = from[i];
  }
}

static size_t hash(PetscInt n, const PetscInt *key)
{
  uint64_t h = 0x9e3779b97f4a7c15u;
  for (PetscInt i = 0; i < n; ++i) {
    h = (h ^ (uint64_t)key[i]) * 0xff51afd7ed558ccdu;
    h ^= h >> 32;
  }
  return (size_t)h;
}

/* The slot of a key: its own or the empty one where it would go. */
static size_t find_slot(const TupleTable *table, const PetscInt *key)
{
  size_t s = hash(table->width, key) & table->mask;
  for (; table->slot[s]; s = (s + 1) & table->mask)
    if (!memcmp(table->key + (table->slot[s] - 1) * table->width, key, (size_t)table->width * sizeof *key)) break;
  return s;
}

PetscInt tuple_find(const TupleTable *table, const PetscInt *nodes)
{
  PetscInt key[TUPLE_MAX_WIDTH];
  sort_small(table->width, nodes, key);
  return table->slot[find_slot(table, key)] - 1;
}

PetscInt tuple_add(TupleTable *table, const PetscInt *nodes)
{
  PetscInt *key = table->key + table->n * table->width;
  PetscInt sorted[TUPLE_MAX_WIDTH];
  sort_small(table->width, nodes, sorted);
  const size_t s = find_slot(table, sorted);
  if (table->slot[s]) return table->slot[s] - 1;
  memcpy(key, sorted, (size_t)table->width * sizeof *key);
  table->slot[s] = ++table->n;
  return table->n - 1;
}

PetscInt tuple_count(const TupleTable *table) { return table->n; }
