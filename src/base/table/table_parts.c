/* Which rows of a table were which rank's: state without numbers of its own goes back to the same
 * ranks, in the same order. */
#include "base/table/table.h"
#include <petscsf.h>

PetscErrorCode PartsToTable(MPI_Comm comm, Tables *tables)
{
  const PetscInt n = tables->n;
  PetscMPIInt size;
  Table *parts;
  Column *column;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(TablesAdd(tables, "parts", PETSC_TRUE, size, &parts));
  for (PetscInt i = 0; i < n; ++i) {
    const Table *table = tables->table[i];
    if (table->everywhere) continue;
    PetscCall(TableAdd(parts, table->name, NULL, COLUMN_INT64, 1, NULL, &column));
    PetscCallMPI(MPI_Allgather(&table->rows, 1, MPIU_INT64, column->data, 1, MPIU_INT64, comm));
  }
  PetscFunctionReturn(0);
}

/* Rows first .. first + n - 1 of the whole table become this rank's. */
static PetscErrorCode Slice(MPI_Comm comm, Table *table, PetscInt first, PetscInt n)
{
  PetscLayout layout;
  PetscInt *remote;
  PetscSF sf;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &remote));
  for (PetscInt i = 0; i < n; ++i) remote[i] = first + i;
  PetscCall(PetscLayoutCreateFromSizes(comm, (PetscInt)table->rows, PETSC_DECIDE, 1, &layout));
  PetscCall(PetscSFCreate(comm, &sf));
  PetscCall(PetscSFSetGraphLayout(sf, layout, n, NULL, PETSC_OWN_POINTER, remote));
  PetscCall(PetscFree(remote));
  PetscCall(PetscLayoutDestroy(&layout));
  for (PetscInt k = 0; k < table->n; ++k) {
    Column *column = &table->column[k];
    const size_t bytes = column_type_bytes(column->type) * (size_t)column->components;
    MPI_Datatype type;
    char *data;
    PetscCall(PetscMalloc1(bytes * (size_t)n, &data));
    PetscCallMPI(MPI_Type_contiguous((int)bytes, MPI_BYTE, &type));
    PetscCallMPI(MPI_Type_commit(&type));
    PetscCall(PetscSFBcastBegin(sf, type, column->data, data, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(sf, type, column->data, data, MPI_REPLACE));
    PetscCallMPI(MPI_Type_free(&type));
    if (column->owned) PetscCall(PetscFree(column->data));
    column->data = data;
    column->owned = PETSC_TRUE;
  }
  table->rows = n;
  PetscCall(PetscSFDestroy(&sf));
  PetscFunctionReturn(0);
}

/* Where this rank's rows begin and how many there are; do the parts add up to the table? */
static PetscBool part_of(const PetscInt64 *parts, PetscMPIInt rank, PetscMPIInt size, PetscInt64 total,
                         PetscInt64 *first)
{
  PetscInt64 sum = 0;
  *first = 0;
  for (PetscMPIInt r = 0; r < size; ++r) {
    if (parts[r] < 0 || parts[r] > total - sum) return PETSC_FALSE;
    sum += parts[r];
    if (r < rank) *first = sum;
  }
  return sum == total;
}

PetscErrorCode PartsTake(MPI_Comm comm, Tables *tables, PetscBool *home, char reason[256])
{
  const Table *parts = tables_find(tables, "parts");
  PetscMPIInt rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  *home = parts->rows == size;
  for (PetscInt k = 0; k < parts->n && *home && !reason[0]; ++k) {
    Table *table = tables_find(tables, parts->column[k].name);
    const PetscInt64 *count = table_data(parts, parts->column[k].name, COLUMN_INT64, 1, reason);
    PetscInt64 rows, first = 0;
    if (!table) snprintf(reason, 256, "%s is missing", parts->column[k].name);
    if (!table || reason[0]) break; /* all ranks know the same */
    PetscCallMPI(MPI_Allreduce(&table->rows, &rows, 1, MPIU_INT64, MPI_SUM, comm));
    if (table->everywhere || rows > PETSC_MAX_INT || !part_of(count, rank, size, rows, &first))
      snprintf(reason, 256, "the parts of %s do not add up", table->name);
    else PetscCall(Slice(comm, table, (PetscInt)first, (PetscInt)count[rank]));
  }
  PetscFunctionReturn(0);
}
