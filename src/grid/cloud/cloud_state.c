/* Nodes of a cloud as tables, and back. They have no numbers that any number of ranks would agree
 * on: rows are this rank's own, and where they come back to other ranks whoever cuts space sends
 * them on. */
#include "grid/cloud/cloud.h"
#include "grid/search/directory.h"

PetscErrorCode CloudToTables(const Grid *grid, Tables *tables)
{
  const GridCloud *c = grid->cloud;
  const PetscInt n_ghosts = grid->n_nodes - grid->n_owned;
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  PetscCall(TablesAdd(tables, "nodes", PETSC_FALSE, grid->n_owned, &table));
  PetscCall(TableAdd(table, "id", NULL, COLUMN_INT64, 1, NULL, &column));
  for (PetscInt i = 0; i < grid->n_owned; ++i) ((PetscInt64 *)column->data)[i] = c->id[i];
  for (PetscInt f = 0; f < c->n_fields; ++f)
    if (c->field[f].name && c->field[f].components)
      PetscCall(TableAdd(table, c->field[f].name, c->field[f].unit, COLUMN_REAL, c->field[f].components,
                         grid->n_owned ? *c->field[f].data : NULL, NULL));
  PetscCall(TablesAdd(tables, "ghosts", PETSC_FALSE, n_ghosts, &table));
  /* rank, and place there */
  PetscCall(TableAdd(table, "owner", NULL, COLUMN_INT64, 2, NULL, &column));
  for (PetscInt k = 0; k < n_ghosts; ++k) {
    ((PetscInt64 *)column->data)[2 * k] = c->ghost_rank[k];
    ((PetscInt64 *)column->data)[2 * k + 1] = c->ghost_index[k];
  }
  PetscFunctionReturn(0);
}

/* Their names, and as many as there are rows. */
static PetscErrorCode Identify(Grid *grid, const Table *table, char reason[256])
{
  const PetscInt n = (PetscInt)table->rows;
  const PetscInt64 *wide = table_data(table, "id", COLUMN_INT64, 1, reason);
  PetscInt *id;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &id));
  for (PetscInt i = 0; i < n && wide; ++i) {
    if (wide[i] < 0 || wide[i] >= 2 * (PetscInt64)grid->cloud->first_twin)
      snprintf(reason, 256, "nodes/id: there is no such node");
    else id[i] = (PetscInt)wide[i];
  }
  PetscCall(ReasonShare(grid->comm, reason));
  if (!reason[0]) PetscCall(GridCloudReplace(grid, n, id));
  PetscCall(PetscFree(id));
  PetscFunctionReturn(0);
}

/* Numbers that are not finite would put a node nowhere. */
static void fill_fields(Grid *grid, const Table *table, char reason[256])
{
  const GridCloud *c = grid->cloud;
  for (PetscInt f = 0; f < c->n_fields; ++f) {
    const PetscInt n = grid->n_owned * c->field[f].components;
    if (!c->field[f].name || !c->field[f].components) continue;
    if (c->field[f].new && !table_has(table, c->field[f].name)) continue;
    const PetscReal *data = table_data(table, c->field[f].name, COLUMN_REAL, c->field[f].components, reason);
    for (PetscInt i = 0; i < n && data; ++i) {
      if (PetscIsInfOrNanReal(data[i])) snprintf(reason, 256, "nodes/%s is not finite", c->field[f].name);
      (*c->field[f].data)[i] = data[i];
    }
  }
}

/* Ascending by rank and place, of nodes that their owners have. */
static PetscErrorCode FillGhosts(Grid *grid, const Table *table, char reason[256])
{
  const PetscInt64 *owner = table_data(table, "owner", COLUMN_INT64, 2, reason);
  RemoteNodes remote = {.n = owner ? (PetscInt)table->rows : 0};
  PetscMPIInt rank, size;
  PetscInt *owned;
  PetscBool *use;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  PetscCall(PetscMalloc4(remote.n, &remote.rank, remote.n, &remote.index, remote.n, &use, size, &owned));
  PetscCallMPI(MPI_Allgather(&grid->n_owned, 1, MPIU_INT, owned, 1, MPIU_INT, grid->comm));
  for (PetscInt k = 0; owner && k < remote.n && !reason[0]; ++k) {
    const PetscInt64 r = owner[2 * k], i = owner[2 * k + 1];
    const PetscBool next = !k || r > owner[2 * k - 2] || (r == owner[2 * k - 2] && i > owner[2 * k - 1]);
    if (r < 0 || r >= size || r == rank || i < 0 || i >= owned[r] || !next)
      snprintf(reason, 256, "ghosts/owner: there is no such node");
    remote.rank[k] = (PetscMPIInt)r;
    remote.index[k] = (PetscInt)i;
    use[k] = PETSC_TRUE;
  }
  PetscCall(ReasonShare(grid->comm, reason));
  if (!reason[0]) PetscCall(GridCloudSetGhosts(grid, &remote, use));
  PetscCall(PetscFree4(remote.rank, remote.index, use, owned));
  PetscFunctionReturn(0);
}

PetscErrorCode CloudFromTables(Grid *grid, const Tables *tables, PetscBool home, char reason[256])
{
  const Table *nodes = tables_find(tables, "nodes");

  PetscFunctionBeginUser;
  PetscCall(Identify(grid, nodes, reason));
  if (reason[0]) PetscFunctionReturn(0);
  fill_fields(grid, nodes, reason);
  PetscCall(ReasonShare(grid->comm, reason));
  if (home && !reason[0]) PetscCall(FillGhosts(grid, tables_find(tables, "ghosts"), reason));
  PetscFunctionReturn(0);
}
