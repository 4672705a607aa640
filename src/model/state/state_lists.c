/* Lists that measures keep (values for a rate, events), one behind the other, as tables; runs without
 * such have none. */
#include "model/state/state_private.h"

PetscErrorCode StateListsToTables(const Model *m, Tables *tables)
{
  PetscInt total = 0;
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_measures; ++k) total += m->memory[k].n_list;
  if (!total) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "measure_lists", PETSC_TRUE, m->c->n_measures, &table));
  PetscCall(TableAdd(table, "length", NULL, COLUMN_INT64, 1, NULL, &column));
  for (PetscInt k = 0; k < m->c->n_measures; ++k) ((PetscInt64 *)column->data)[k] = m->memory[k].n_list;
  PetscCall(TablesAdd(tables, "measure_numbers", PETSC_TRUE, total, &table));
  PetscCall(TableAdd(table, "number", NULL, COLUMN_REAL, 1, NULL, &column));
  for (PetscInt k = 0, at = 0; k < m->c->n_measures; at += m->memory[k++].n_list)
    PetscCall(PetscArraycpy((PetscReal *)column->data + at, m->memory[k].list, m->memory[k].n_list));
  PetscFunctionReturn(0);
}

PetscErrorCode StateListsFromTables(Model *m, const Tables *tables, char reason[256])
{
  const Table *lists = tables_find(tables, "measure_lists"), *numbers = tables_find(tables, "measure_numbers");

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_measures; ++k) m->memory[k].n_list = 0; /* what the start brought */
  if (!lists || !numbers || reason[0]) PetscFunctionReturn(0);
  if (lists->rows != m->c->n_measures) snprintf(reason, 256, "%s has %d rows", lists->name, (int)lists->rows);
  const PetscInt64 *length = table_data(lists, "length", COLUMN_INT64, 1, reason);
  const PetscReal *number = table_data(numbers, "number", COLUMN_REAL, 1, reason);
  PetscInt64 left = numbers->rows;
  for (PetscInt k = 0; k < m->c->n_measures && !reason[0]; left -= length[k], ++k) {
    if (length[k] < 0 || length[k] > left) snprintf(reason, 256, "%s makes no sense", lists->name);
    else PetscCall(MemoryAppend(&m->memory[k], (PetscInt)length[k], number + (numbers->rows - left)));
  }
  PetscFunctionReturn(0);
}
