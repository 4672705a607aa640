/* Slots of clouds. In a step few clouds change their nodes, so what was found in the step before is
 * kept. */
#include "solve/system/system.h"

PetscErrorCode SystemReserveSlots(System *s, PetscInt n)
{
  PetscFunctionBeginUser;
  if (n <= s->n_slots) PetscFunctionReturn(0);
  s->n_slots = n + n / 4;
  PetscCall(PetscRealloc((size_t)s->n_slots * sizeof *s->slot, &s->slot));
  PetscFunctionReturn(0);
}

PetscErrorCode SystemFreeSlots(System *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->slot));
  PetscCall(PetscFree(s->before.start));
  PetscCall(PetscFree(s->before.node));
  PetscCall(PetscFree(s->before.spare));
  PetscFunctionReturn(0);
}

/* Slots of a group whose nodes ascend, by walking along each row once, from its diagonal on if no more is
 * wanted; a pair that the pattern lacks gets -1. Returns how many. */
static PetscInt merge_slots(const System *s, PetscInt nn, const PetscInt *node, PetscInt *slot)
{
  const PetscBool half = s->before.half;
  PetscInt missing = 0;
  for (PetscInt I = 0; I < nn; ++I) {
    const PetscInt row = s->row[node[I]];
    PetscInt k = row < 0 ? 0 : half ? s->diagonal[row] : s->row_start[row];
    const PetscInt end = row < 0 ? 0 : s->row_start[row + 1];
    for (PetscInt J = half ? I : 0; J < nn; ++J) {
      while (k < end && s->column[k] < node[J]) ++k;
      const PetscBool found = k < end && s->column[k] == node[J];
      slot[I * nn + J] = found ? k : -1;
      missing += !found;
    }
  }
  return missing;
}

static PetscBool same_nodes(PetscInt nn, const PetscInt *a, const PetscInt *b)
{
  PetscInt off = 0;
  for (PetscInt i = 0; i < nn; ++i) off |= a[i] ^ b[i];
  return !off;
}

static PetscErrorCode Reserve(PetscInt n, PetscInt *capacity, PetscInt **data)
{
  PetscFunctionBeginUser;
  if (n <= *capacity) PetscFunctionReturn(0);
  *capacity = n + n / 4;
  PetscCall(PetscRealloc((size_t)*capacity * sizeof **data, data));
  PetscFunctionReturn(0);
}

/* Groups from the front on that have as many nodes as before: their slots stay where they are.
 * Returns the first other one; place: that of its slots. */
static PetscInt renew_in_place(System *s, const Support *w, PetscInt *place, PetscInt *missing)
{
  const CloudsBefore *b = &s->before;
  PetscInt g = 0;
  for (; g < PetscMin(w->n_groups, b->n); ++g) {
    const PetscInt nn = support_nodes(w, g), *node = w->node + w->node_start[g];
    if (b->start[g + 1] - b->start[g] != nn) break;
    if (!same_nodes(nn, node, b->node + b->start[g])) *missing += merge_slots(s, nn, node, s->slot + *place);
    *place += nn * nn;
  }
  return g;
}

/* The groups behind them, whose slots move: all slots change over to the other array. */
static PetscErrorCode RenewRest(System *s, const Support *w, PetscInt first, PetscInt place, PetscInt *missing)
{
  CloudsBefore *b = &s->before;
  PetscInt size = place;

  PetscFunctionBeginUser;
  for (PetscInt g = first; g < w->n_groups; ++g) size += PetscSqr(support_nodes(w, g));
  PetscCall(Reserve(size, &b->n_spare, &b->spare));
  PetscCall(PetscArraycpy(b->spare, s->slot, place));
  const PetscInt *old = s->slot + place;
  for (PetscInt g = first; g < w->n_groups; ++g) {
    const PetscInt nn = support_nodes(w, g), *node = w->node + w->node_start[g];
    const PetscInt before = g < b->n ? b->start[g + 1] - b->start[g] : -1;
    if (before == nn && same_nodes(nn, node, b->node + b->start[g]))
      PetscCall(PetscArraycpy(b->spare + place, old, nn * nn));
    else *missing += merge_slots(s, nn, node, b->spare + place);
    place += nn * nn;
    old += before > 0 ? before * before : 0;
  }
  PetscInt *slot = s->slot, n = s->n_slots;
  s->slot = b->spare, s->n_slots = b->n_spare;
  b->spare = slot, b->n_spare = n;
  PetscFunctionReturn(0);
}

static PetscErrorCode RememberClouds(System *s, const Support *w, PetscInt missing)
{
  CloudsBefore *b = &s->before;

  PetscFunctionBeginUser;
  b->n = w->n_groups;
  b->builds = missing ? 0 : s->builds;
  PetscCall(Reserve(b->n + 1, &b->capacity, &b->start));
  PetscCall(Reserve(w->node_start[b->n], &b->capacity_entries, &b->node));
  PetscCall(PetscArraycpy(b->start, w->node_start, b->n + 1));
  PetscCall(PetscArraycpy(b->node, w->node, w->node_start[b->n]));
  PetscFunctionReturn(0);
}

PetscErrorCode SystemCloudSlots(System *s, const Support *support, PetscBool half, PetscBool *complete)
{
  PetscInt missing = 0, place = 0;

  PetscFunctionBeginUser;
  if (s->before.builds != s->builds || s->before.half != half) s->before.n = 0;
  s->before.half = half;
  const PetscInt first = renew_in_place(s, support, &place, &missing);
  if (first < support->n_groups) PetscCall(RenewRest(s, support, first, place, &missing));
  PetscCall(RememberClouds(s, support, missing));
  if (complete) *complete = !missing;
  PetscFunctionReturn(0);
}

PetscInt system_pair(const System *s, PetscInt I, PetscInt J)
{
  const PetscInt row = s->row[I];
  PetscInt k = -1;
  if (row >= 0) (void)PetscFindInt(J, s->row_start[row + 1] - s->row_start[row], s->column + s->row_start[row], &k);
  return k < 0 ? -1 : s->row_start[row] + k;
}

/* Behind the diagonals of all rows: the first columns that are rows from `first` on. */
static void find_columns(const System *s, PetscInt first, PetscInt *next)
{
  for (PetscInt r = 0; r < s->n_rows; ++r) {
    next[r] = s->diagonal[r] + 1;
    while (next[r] < s->row_start[r + 1] && s->row[s->column[next[r]]] < first) ++next[r];
  }
}

/* Rows come in the order of their nodes, so that those that have a node as a column before their
 * diagonal come in the order of the columns behind the diagonal of that node's own row. */
static inline __attribute__((always_inline)) void mirror(const System *s, const int size, const PetscBool single,
                                                         PetscInt first, PetscInt *next)
{
  for (PetscInt r = first; r < s->n_rows; ++r)
    for (PetscInt k = s->row_start[r]; k < s->diagonal[r]; ++k) {
      const size_t from = (size_t)next[s->row[s->column[k]]]++ * (size_t)(size * size);
      const size_t to = (size_t)k * (size_t)(size * size);
      for (int a = 0; a < size; ++a)
        for (int b = 0; b < size; ++b) {
          if (single) s->singles[to + (size_t)(a * size + b)] = s->singles[from + (size_t)(b * size + a)];
          else s->values[to + (size_t)(a * size + b)] = s->values[from + (size_t)(b * size + a)];
        }
    }
}

PetscErrorCode SystemMirror(System *s, PetscInt first)
{
  PetscInt *next;

  PetscFunctionBeginUser;
  if (first == s->n_rows) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(s->n_rows, &next));
  find_columns(s, first, next);
  if (s->single && s->block == 2) mirror(s, 2, PETSC_TRUE, first, next);
  else if (s->single) mirror(s, 3, PETSC_TRUE, first, next);
  else if (s->block == 2) mirror(s, 2, PETSC_FALSE, first, next);
  else if (s->block == 3) mirror(s, 3, PETSC_FALSE, first, next);
  else mirror(s, 4, PETSC_FALSE, first, next);
  PetscCall(PetscFree(next));
  PetscFunctionReturn(0);
}
