/* Which sides of a body's cells are its surface. */
#include "base/gather.h"
#include "grid/search/tuple_table.h"
#include "points/seed/outline.h"

/* Nodes of a side, by their numbers of all ranks if so asked. */
static void side_nodes(const Grid *source, PetscInt cell, PetscInt side, PetscBool global, PetscInt key[4])
{
  const Cell *type = grid_cell(source, cell);
  const PetscInt *node = source->cell_node + cell * source->nodes_per_cell;
  for (PetscInt i = 0; i < type->face_nodes; ++i) {
    key[i] = node[type->face[side][i]];
    if (global) key[i] = source->global_node[key[i]];
  }
}

PetscErrorCode OutlineSides(const Grid *source, PetscInt n_cells, const PetscInt *chosen, unsigned char *outer)
{
  TupleTable *seen;
  PetscInt *times, *id, key[4];

  PetscFunctionBeginUser;
  PetscCall(TupleTableCreate(cells[source->type].face_nodes, n_cells * CELL_MOST_SIDES, &seen));
  PetscCall(PetscCalloc1(n_cells * CELL_MOST_SIDES, &times));
  PetscCall(PetscMalloc1(n_cells * CELL_MOST_SIDES, &id));
  for (PetscInt k = 0; k < n_cells * CELL_MOST_SIDES; ++k) {
    const PetscInt cell = chosen[k / CELL_MOST_SIDES], side = k % CELL_MOST_SIDES;
    id[k] = -1;
    if (side >= grid_cell(source, cell)->faces) continue;
    side_nodes(source, cell, side, PETSC_FALSE, key);
    id[k] = tuple_add(seen, key);
    ++times[id[k]];
  }
  for (PetscInt k = 0; k < n_cells * CELL_MOST_SIDES; ++k) outer[k] = id[k] >= 0 && times[id[k]] == 1;
  PetscCall(PetscFree(times));
  PetscCall(PetscFree(id));
  PetscCall(TupleTableDestroy(&seen));
  PetscFunctionReturn(0);
}

PetscErrorCode OutlineSidesOfAll(const Grid *source, PetscInt n_cells, const PetscInt *chosen, unsigned char *outer)
{
  const PetscInt width = cells[source->type].face_nodes;
  PetscInt n = 0, n_all, *mine, *all, *times, key[4];
  TupleTable *seen;

  PetscFunctionBeginUser;
  PetscCall(OutlineSides(source, n_cells, chosen, outer));
  PetscCall(PetscMalloc1(n_cells * CELL_MOST_SIDES * width, &mine));
  for (PetscInt k = 0; k < n_cells * CELL_MOST_SIDES; ++k)
    if (outer[k]) side_nodes(source, chosen[k / CELL_MOST_SIDES], k % CELL_MOST_SIDES, PETSC_TRUE, mine + width * n++);
  PetscCall(GatherAll(source->comm, (size_t)width * sizeof *mine, n, mine, &n_all, &all));
  PetscCall(TupleTableCreate(width, n_all, &seen));
  PetscCall(PetscCalloc1(n_all, &times));
  for (PetscInt k = 0; k < n_all; ++k) ++times[tuple_add(seen, all + width * k)];
  for (PetscInt k = 0; k < n_cells * CELL_MOST_SIDES; ++k) {
    if (!outer[k]) continue;
    side_nodes(source, chosen[k / CELL_MOST_SIDES], k % CELL_MOST_SIDES, PETSC_TRUE, key);
    outer[k] = times[tuple_find(seen, key)] == 1;
  }
  PetscCall(PetscFree(mine));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(times));
  PetscCall(TupleTableDestroy(&seen));
  PetscFunctionReturn(0);
}
