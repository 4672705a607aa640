/* Tables of plain numbers whose rows are spread over the ranks: how state travels between the model
 * and a checkpoint.
 *
 * The model knows what it must remember, the file format how numbers are kept; this is all that
 * they say to each other. */
#pragma once
#include <petscsys.h>

typedef enum { COLUMN_REAL, COLUMN_INT64, COLUMN_INT32, COLUMN_BYTE } ColumnType;

#define TABLE_NAME 48
#define TABLE_MAX_COLUMNS 32

typedef struct {
  char name[TABLE_NAME];
  const char *unit; /* or NULL; not read back */
  ColumnType type;
  PetscInt components; /* numbers a row */
  void *data;          /* rows x components */
  PetscBool owned;     /* the table frees data */
} Column;

typedef struct {
  char name[TABLE_NAME];
  PetscBool everywhere; /* the same few rows on every rank; else each rank has its own */
  PetscInt64 rows;      /* of this rank */
  PetscInt n;
  Column column[TABLE_MAX_COLUMNS];
} Table;

typedef struct {
  PetscInt n, capacity;
  Table **table;
} Tables;

static inline size_t column_type_bytes(ColumnType type)
{
  static const size_t bytes[] = {sizeof(PetscReal), sizeof(PetscInt64), sizeof(int32_t), 1};
  return bytes[type];
}

PetscErrorCode TablesCreate(Tables **tables);
PetscErrorCode TablesDestroy(Tables **tables);
/* An empty table at the end; it belongs to tables. */
PetscErrorCode TablesAdd(Tables *tables, const char *name, PetscBool everywhere, PetscInt64 rows, Table **table);
Table *tables_find(const Tables *tables, const char *name);

/* A column over data that stays the caller's, or, with data NULL, over zeros of the table's own.
 * *out may be NULL. */
PetscErrorCode TableAdd(Table *table, const char *name, const char *unit, ColumnType type, PetscInt components,
                        void *data, Column **out);
/* Has it a column of this name, of whatever type? */
PetscBool table_has(const Table *table, const char *name);
/* Data of the column of this name, type and width; NULL, with a reason, if there is none like
 * it. */
void *table_data(const Table *table, const char *name, ColumnType type, PetscInt components, char reason[256]);

/* Collective. An everywhere table "parts" at the end: how many rows of each table are each
 * rank's. */
PetscErrorCode PartsToTable(MPI_Comm comm, Tables *tables);
/* Collective. On as many ranks as wrote the parts (*home) every rank gets its own rows back, in
 * their order. A mistake in the tables is told in reason, on all ranks. */
PetscErrorCode PartsTake(MPI_Comm comm, Tables *tables, PetscBool *home, char reason[256]);
