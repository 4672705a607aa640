/* Who holds what, by numbers that do not depend on how the grid is shared among the ranks: for
 * state that comes back from a file. */
#pragma once
#include "base/table/table.h"
#include "grid/grid.h"

/* Where a number was found. */
typedef struct {
  PetscInt rank, index; /* -1: nowhere */
} DirectoryPlace;

/* Collective. Every rank registers the numbers that it has (have[i] at its index i) and learns
 * where those that it wants are. Numbers lie in 0 .. n_numbers - 1; a wanted one may be -1, which
 * is nowhere. No number may be had twice. */
PetscErrorCode DirectoryFind(MPI_Comm comm, PetscInt n_numbers, PetscInt n_have, const PetscInt *have, PetscInt n_want,
                             const PetscInt *want, DirectoryPlace *place);

/* Collective. The lowest rank that has each of these numbers; several may have one, and each asks
 * for what it has. */
PetscErrorCode DirectoryLowest(MPI_Comm comm, PetscInt n_numbers, PetscInt n, const PetscInt *number, PetscInt *lowest);

/* A nodal array that outlives the step. */
typedef struct {
  const char *name, *unit;
  PetscInt components;
  PetscReal *values; /* n_nodes x components; owners' values count */
} NodalField;

/* Collective. Numbers of the local nodes that are the same for any number of ranks: of all (cell,
 * corner) that are the node, the first. */
PetscErrorCode GridNodeNumbers(const Grid *grid, PetscInt *number);
/* Collective. A table of the owned nodes with take[node] != 0 (NULL: all) and their fields. */
PetscErrorCode NodesToTable(const Grid *grid, const unsigned char *take, PetscInt n_fields, const NodalField *fields,
                            const char *name, Tables *tables);
/* Collective. The fields from such a table, however it is shared; nodes that it does not have get
 * 0, or are a mistake if `all` is asked for. Ghosts are filled. reason is left empty, or says on
 * every rank what is wrong. */
PetscErrorCode NodesFromTable(const Grid *grid, PetscBool all, PetscInt n_fields, const NodalField *fields,
                              const Table *table, char reason[256]);
/* Collective. The cells with flag[cell] != 0 as a table, and back. */
PetscErrorCode CellsToTable(const Grid *grid, const unsigned char *flag, const char *name, Tables *tables);
PetscErrorCode CellsFromTable(const Grid *grid, unsigned char *flag, const Table *table, char reason[256]);

/* Collective. Did any rank find something wrong? Then the first one's reason goes to all. */
PetscErrorCode ReasonShare(MPI_Comm comm, char reason[256]);
