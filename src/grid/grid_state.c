/* Nodal fields and sets of cells as tables, and back on any number of ranks. */
#include "grid/search/directory.h"

static PetscErrorCode CountNumbers(const Grid *grid, PetscInt *n)
{
  PetscFunctionBeginUser;
  PetscCheck(grid->n_cells_global <= PETSC_MAX_INT / grid->nodes_per_cell, grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "%" PetscInt_FMT " cells are too many for this PETSc's integers", grid->n_cells_global);
  *n = grid->n_cells_global * grid->nodes_per_cell;
  PetscFunctionReturn(0);
}

PetscErrorCode GridNodeNumbers(const Grid *grid, PetscInt *number)
{
  const PetscInt nn = grid->nodes_per_cell;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < grid->n_nodes; ++i) number[i] = PETSC_MAX_INT;
  for (PetscInt i = 0; i < grid->n_cells * nn; ++i)
    number[grid->cell_node[i]] = PetscMin(number[grid->cell_node[i]], grid->global_cell[i / nn] * nn + i % nn);
  PetscCall(PetscSFReduceBegin(grid->node_sf, MPIU_INT, number, number, MPI_MIN));
  PetscCall(PetscSFReduceEnd(grid->node_sf, MPIU_INT, number, number, MPI_MIN));
  PetscCall(PetscSFBcastBegin(grid->node_sf, MPIU_INT, number, number, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(grid->node_sf, MPIU_INT, number, number, MPI_REPLACE));
  PetscFunctionReturn(0);
}

PetscErrorCode NodesToTable(const Grid *grid, const unsigned char *take, PetscInt n_fields, const NodalField *fields,
                            const char *name, Tables *tables)
{
  PetscInt *number, rows = 0;
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_nodes, &number));
  PetscCall(GridNodeNumbers(grid, number));
  for (PetscInt i = 0; i < grid->n_owned; ++i) rows += !take || take[i];
  PetscCall(TablesAdd(tables, name, PETSC_FALSE, rows, &table));
  PetscCall(TableAdd(table, "node", NULL, COLUMN_INT64, 1, NULL, &column));
  for (PetscInt i = 0, k = 0; i < grid->n_owned; ++i)
    if (!take || take[i]) ((PetscInt64 *)column->data)[k++] = number[i];
  for (PetscInt f = 0; f < n_fields; ++f) {
    const PetscInt n = fields[f].components;
    PetscCall(TableAdd(table, fields[f].name, fields[f].unit, COLUMN_REAL, n, take ? NULL : fields[f].values, &column));
    PetscReal *next = column->data;
    for (PetscInt i = 0; take && i < grid->n_owned * n; ++i)
      if (take[i / n]) *next++ = fields[f].values[i];
  }
  PetscCall(PetscFree(number));
  PetscFunctionReturn(0);
}

/* Row numbers of a table as PetscInt, within 0 .. n - 1. */
static PetscErrorCode Numbers(const Table *table, const char *name, PetscInt n, PetscInt **number, char reason[256])
{
  const PetscInt64 *wide = table_data(table, name, COLUMN_INT64, 1, reason);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((size_t)table->rows, number));
  for (PetscInt64 i = 0; i < table->rows; ++i) {
    (*number)[i] = wide && wide[i] >= 0 && wide[i] < n ? (PetscInt)wide[i] : -1;
    if (wide && (*number)[i] < 0) snprintf(reason, 256, "%s/%s: there is no such %s", table->name, name, name);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode FillField(const Grid *grid, PetscSF sf, const NodalField *field, const Table *table,
                                char reason[256])
{
  const PetscReal *rows = table_data(table, field->name, COLUMN_REAL, field->components, reason);
  PetscMPIInt n;
  MPI_Datatype type;

  PetscFunctionBeginUser;
  PetscCall(ReasonShare(grid->comm, reason));
  if (reason[0]) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(field->values, grid->n_nodes * field->components));
  PetscCall(PetscMPIIntCast(field->components, &n));
  PetscCallMPI(MPI_Type_contiguous(n, MPIU_REAL, &type));
  PetscCallMPI(MPI_Type_commit(&type));
  PetscCall(PetscSFBcastBegin(sf, type, rows, field->values, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, type, rows, field->values, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&type));
  PetscCall(GridToGhosts(grid, field->components, field->values));
  PetscFunctionReturn(0);
}

/* Roots: the table's rows on all ranks; leaves: this rank's owned nodes that are among them. */
static PetscErrorCode RowGraph(const Grid *grid, const Table *table, const DirectoryPlace *place, PetscBool all,
                               PetscSF *sf, char reason[256])
{
  PetscInt *local, n = 0;
  PetscSFNode *remote;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(grid->n_owned, &local, grid->n_owned, &remote));
  for (PetscInt i = 0; i < grid->n_owned; ++i) {
    if (place[i].rank < 0) {
      if (all) snprintf(reason, 256, "%s: a node of the grid is missing", table->name);
      continue;
    }
    local[n] = i;
    remote[n++] = (PetscSFNode){.rank = place[i].rank, .index = place[i].index};
  }
  PetscCall(PetscSFCreate(grid->comm, sf));
  PetscCall(PetscSFSetGraph(*sf, (PetscInt)table->rows, n, local, PETSC_COPY_VALUES, remote, PETSC_COPY_VALUES));
  PetscCall(PetscFree2(local, remote));
  PetscFunctionReturn(0);
}

PetscErrorCode NodesFromTable(const Grid *grid, PetscBool all, PetscInt n_fields, const NodalField *fields,
                              const Table *table, char reason[256])
{
  PetscInt n, *have, *want;
  DirectoryPlace *place;
  PetscSF sf;

  PetscFunctionBeginUser;
  PetscCall(CountNumbers(grid, &n));
  PetscCall(Numbers(table, "node", n, &have, reason));
  PetscCall(PetscMalloc2(grid->n_nodes, &want, grid->n_nodes, &place));
  PetscCall(GridNodeNumbers(grid, want));
  PetscCall(DirectoryFind(grid->comm, n, (PetscInt)table->rows, have, grid->n_owned, want, place));
  PetscCall(RowGraph(grid, table, place, all, &sf, reason));
  PetscCall(ReasonShare(grid->comm, reason));
  for (PetscInt f = 0; f < n_fields && !reason[0]; ++f) PetscCall(FillField(grid, sf, &fields[f], table, reason));
  PetscCall(PetscSFDestroy(&sf));
  PetscCall(PetscFree2(want, place));
  PetscCall(PetscFree(have));
  PetscFunctionReturn(0);
}

PetscErrorCode CellsToTable(const Grid *grid, const unsigned char *flag, const char *name, Tables *tables)
{
  PetscInt rows = 0;
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < grid->n_cells; ++c) rows += flag[c] != 0;
  PetscCall(TablesAdd(tables, name, PETSC_FALSE, rows, &table));
  PetscCall(TableAdd(table, "cell", NULL, COLUMN_INT64, 1, NULL, &column));
  for (PetscInt c = 0, k = 0; c < grid->n_cells; ++c)
    if (flag[c]) ((PetscInt64 *)column->data)[k++] = grid->global_cell[c];
  PetscFunctionReturn(0);
}

PetscErrorCode CellsFromTable(const Grid *grid, unsigned char *flag, const Table *table, char reason[256])
{
  const PetscInt rows = (PetscInt)table->rows;
  PetscInt *want, *one, *count, n = 0;
  DirectoryPlace *place;
  PetscSFNode *remote;
  PetscSF sf;

  PetscFunctionBeginUser;
  PetscCall(Numbers(table, "cell", grid->n_cells_global, &want, reason));
  PetscCall(PetscMalloc3(rows, &place, rows, &remote, rows, &one));
  PetscCall(DirectoryFind(grid->comm, grid->n_cells_global, grid->n_cells, grid->global_cell, rows, want, place));
  for (PetscInt i = 0; i < rows; ++i) {
    if (place[i].rank >= 0) remote[n++] = (PetscSFNode){.rank = place[i].rank, .index = place[i].index};
    one[i] = 1;
  }
  PetscCall(PetscCalloc1(grid->n_cells, &count));
  PetscCall(PetscSFCreate(grid->comm, &sf));
  PetscCall(PetscSFSetGraph(sf, grid->n_cells, n, NULL, PETSC_COPY_VALUES, remote, PETSC_COPY_VALUES));
  PetscCall(PetscSFReduceBegin(sf, MPIU_INT, one, count, MPI_SUM));
  PetscCall(PetscSFReduceEnd(sf, MPIU_INT, one, count, MPI_SUM));
  for (PetscInt c = 0; c < grid->n_cells; ++c) flag[c] = count[c] > 0;
  PetscCall(PetscSFDestroy(&sf));
  PetscCall(PetscFree(count));
  PetscCall(PetscFree3(place, remote, one));
  PetscCall(PetscFree(want));
  PetscCall(ReasonShare(grid->comm, reason));
  PetscFunctionReturn(0);
}
