#include "boundary/sides/side_keys.h"
#include <stdlib.h>
#include "base/gather.h"
#include "points/seed/outline.h"

void side_key(const Grid *grid, PetscInt cell, PetscInt side, PetscInt key[SIDE_KEY])
{
  const Cell *type = grid_cell(grid, cell);
  const PetscInt n = type->face_nodes, *node = grid->cell_node + cell * grid->nodes_per_cell;
  for (PetscInt i = 0; i < SIDE_KEY; ++i) key[i] = i < n ? grid->global_node[node[type->face[side][i]]] : -1;
  PetscSortInt(n, key);
}

static int compare(const void *a, const void *b)
{
  const PetscInt *x = a, *y = b;
  for (int i = 0; i < SIDE_KEY; ++i)
    if (x[i] != y[i]) return x[i] < y[i] ? -1 : 1;
  return 0;
}

PetscErrorCode SideKeysGather(MPI_Comm comm, PetscInt n, const PetscInt *keys, PetscInt *n_all, PetscInt **all)
{
  PetscFunctionBeginUser;
  PetscCall(GatherAll(comm, SIDE_KEY * sizeof(PetscInt), n, keys, n_all, all));
  if (*n_all) qsort(*all, (size_t)*n_all, SIDE_KEY * sizeof(PetscInt), compare);
  PetscFunctionReturn(0);
}

PetscInt side_key_find(PetscInt n, const PetscInt *all, const PetscInt key[SIDE_KEY])
{
  const PetscInt *found = n ? bsearch(key, all, (size_t)n, SIDE_KEY * sizeof(PetscInt), compare) : NULL;
  if (!found) return -1;
  PetscInt i = (PetscInt)(found - all) / SIDE_KEY;
  while (i > 0 && !compare(all + SIDE_KEY * (i - 1), key)) --i;
  return i;
}

PetscInt side_key_count(PetscInt n, const PetscInt *all, const PetscInt key[SIDE_KEY])
{
  const PetscInt first = side_key_find(n, all, key);
  PetscInt count = 0;
  while (first >= 0 && first + count < n && !compare(all + SIDE_KEY * (first + count), key)) ++count;
  return count;
}

/* The keys of these sides on all ranks, sorted. */
static PetscErrorCode KeysOf(const Grid *grid, PetscInt n, const PetscInt *cell, const PetscInt *side, PetscInt *n_all,
                             PetscInt **all)
{
  PetscInt *keys;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(SIDE_KEY * n, &keys));
  for (PetscInt f = 0; f < n; ++f) side_key(grid, cell[f], side[f], keys + SIDE_KEY * f);
  PetscCall(SideKeysGather(grid->comm, n, keys, n_all, all));
  PetscCall(PetscFree(keys));
  PetscFunctionReturn(0);
}

PetscErrorCode SidesNamed(const Grid *grid, const char *boundary, PetscInt *n, PetscInt *cell, PetscInt *side)
{
  const GridSet nothing = {0}, *set = grid_find_set(grid, boundary);
  PetscInt n_all, *all, key[SIDE_KEY], kept = 0;

  PetscFunctionBeginUser;
  if (!set) set = &nothing;
  PetscCall(KeysOf(grid, set->n_faces, set->face_cell, set->face_side, &n_all, &all));
  for (PetscInt f = 0; f < *n; ++f) {
    side_key(grid, cell[f], side[f], key);
    if (side_key_find(n_all, all, key) >= 0) cell[kept] = cell[f], side[kept++] = side[f];
  }
  *n = kept;
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Sides of cells of this rank that are among the n_all, each with its place there. */
typedef struct {
  PetscInt n, *cell, *side, *place;
} Looks;

static PetscErrorCode LookFromAll(const Grid *grid, PetscInt n_all, const PetscInt *all, Looks *looks)
{
  PetscInt key[SIDE_KEY];

  PetscFunctionBeginUser;
  looks->n = 0;
  PetscCall(PetscMalloc1(2 * n_all, &looks->cell));
  PetscCall(PetscMalloc1(2 * n_all, &looks->side));
  PetscCall(PetscMalloc1(2 * n_all, &looks->place));
  for (PetscInt c = 0; c < grid->n_cells; ++c)
    for (PetscInt s = 0; s < grid_cell(grid, c)->faces; ++s) {
      side_key(grid, c, s, key);
      const PetscInt place = side_key_find(n_all, all, key);
      if (place < 0) continue;
      looks->cell[looks->n] = c, looks->side[looks->n] = s, looks->place[looks->n++] = place;
    }
  PetscFunctionReturn(0);
}

/* Of each side one cell: the only one that is filled, or else that which it was looked at from. */
static PetscErrorCode Choose(const Grid *grid, const PetscBool *filled, const PetscInt *times, PetscInt n,
                             const PetscInt *cell, const PetscInt *side, Looks *looks)
{
  unsigned char *given;
  PetscInt kept = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_cells * CELL_MOST_SIDES, &given));
  for (PetscInt f = 0; f < n; ++f) given[cell[f] * CELL_MOST_SIDES + side[f]] = 1;
  for (PetscInt k = 0; k < looks->n; ++k) {
    const PetscInt c = looks->cell[k], s = looks->side[k];
    const PetscBool is_given = (PetscBool)given[c * CELL_MOST_SIDES + s];
    if (times[looks->place[k]] == 1 ? filled[c] : is_given) looks->cell[kept] = c, looks->side[kept++] = s;
  }
  looks->n = kept;
  PetscCall(PetscFree(given));
  PetscFunctionReturn(0);
}

PetscErrorCode SidesFromMaterial(const Grid *grid, const PetscBool *filled, PetscInt *n, PetscInt **cell,
                                 PetscInt **side, PetscInt *both)
{
  PetscInt n_all, *all, *times;
  Looks looks;

  PetscFunctionBeginUser;
  *both = 0;
  if (grid->box) PetscFunctionReturn(0); /* its sides have no cell beyond */
  PetscCall(KeysOf(grid, *n, *cell, *side, &n_all, &all));
  PetscCall(LookFromAll(grid, n_all, all, &looks));
  PetscCall(PetscCalloc1(n_all, &times));
  for (PetscInt k = 0; k < looks.n; ++k) times[looks.place[k]] += filled[looks.cell[k]];
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, times, (PetscMPIInt)n_all, MPIU_INT, MPI_SUM, grid->comm));
  for (PetscInt k = 0; k < n_all; ++k) *both += times[k] > 1;
  PetscCall(Choose(grid, filled, times, *n, *cell, *side, &looks));
  PetscCall(PetscFree(*cell));
  PetscCall(PetscFree(*side));
  *n = looks.n, *cell = looks.cell, *side = looks.side;
  PetscCall(PetscFree(looks.place));
  PetscCall(PetscFree(times));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}
