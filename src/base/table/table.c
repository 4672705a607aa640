#include "base/table/table.h"
#include <string.h>

PetscErrorCode TablesCreate(Tables **tables)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(tables));
  PetscFunctionReturn(0);
}

PetscErrorCode TablesDestroy(Tables **tables)
{
  PetscFunctionBeginUser;
  if (!*tables) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < (*tables)->n; ++i) {
    Table *t = (*tables)->table[i];
    for (PetscInt k = 0; k < t->n; ++k)
      if (t->column[k].owned) PetscCall(PetscFree(t->column[k].data));
    PetscCall(PetscFree(t));
  }
  PetscCall(PetscFree((*tables)->table));
  PetscCall(PetscFree(*tables));
  PetscFunctionReturn(0);
}

PetscErrorCode TablesAdd(Tables *tables, const char *name, PetscBool everywhere, PetscInt64 rows, Table **table)
{
  PetscFunctionBeginUser;
  if (tables->n == tables->capacity) {
    tables->capacity = 2 * tables->capacity + 8;
    PetscCall(PetscRealloc((size_t)tables->capacity * sizeof(Table *), &tables->table));
  }
  PetscCall(PetscNew(table));
  PetscCall(PetscStrncpy((*table)->name, name, TABLE_NAME));
  (*table)->everywhere = everywhere;
  (*table)->rows = rows;
  tables->table[tables->n++] = *table;
  PetscFunctionReturn(0);
}

Table *tables_find(const Tables *tables, const char *name)
{
  for (PetscInt i = 0; i < tables->n; ++i)
    if (!strcmp(tables->table[i]->name, name)) return tables->table[i];
  return NULL;
}

PetscErrorCode TableAdd(Table *table, const char *name, const char *unit, ColumnType type, PetscInt components,
                        void *data, Column **out)
{
  PetscFunctionBeginUser;
  PetscCheck(table->n < TABLE_MAX_COLUMNS, PETSC_COMM_SELF, PETSC_ERR_PLIB, "table %s has too many columns",
             table->name);
  Column *column = &table->column[table->n++];
  PetscCall(PetscStrncpy(column->name, name, TABLE_NAME));
  column->unit = unit;
  column->type = type;
  column->components = components;
  column->data = data;
  if (!data) {
    column->owned = PETSC_TRUE;
    PetscCall(PetscCalloc1(column_type_bytes(type) * (size_t)table->rows * (size_t)components, (char **)&column->data));
  }
  if (out) *out = column;
  PetscFunctionReturn(0);
}

PetscBool table_has(const Table *table, const char *name)
{
  for (PetscInt k = 0; k < table->n; ++k)
    if (!strcmp(table->column[k].name, name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

void *table_data(const Table *table, const char *name, ColumnType type, PetscInt components, char reason[256])
{
  for (PetscInt k = 0; k < table->n; ++k) {
    const Column *column = &table->column[k];
    if (strcmp(column->name, name)) continue;
    if (column->type == type && column->components == components) return column->data;
    snprintf(reason, 256, "%s/%s is of another kind: %d numbers a row instead of %d", table->name, name,
             (int)column->components, (int)components);
    return NULL;
  }
  snprintf(reason, 256, "%s/%s is missing", table->name, name);
  return NULL;
}
