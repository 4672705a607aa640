/* Lists that measures keep (values for a rate, events), one behind the other, as tables; runs without
 * such have none. */
#include "model/measure/measure.h"
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
  const PetscInt64 *length = lists ? table_data(lists, "length", COLUMN_INT64, 1, reason) : NULL;
  const PetscReal *number = numbers ? table_data(numbers, "number", COLUMN_REAL, 1, reason) : NULL;
  PetscInt64 left = numbers ? numbers->rows : 0;

  PetscFunctionBeginUser;
  if (lists && lists->rows != m->c->n_measures) snprintf(reason, 256, "%s has %d rows", lists->name, (int)lists->rows);
  for (PetscInt k = 0; k < m->c->n_measures && !reason[0]; ++k) {
    const PetscInt64 n = length ? length[k] : 0;
    m->memory[k].n_list = 0; /* what the start brought */
    if (n > left || !measure_list_fits(m, k, n)) snprintf(reason, 256, "what measure %d keeps is not there", (int)k);
    else if (n > 0) {
      PetscCall(MemoryAppend(&m->memory[k], (PetscInt)n, number));
      number += n;
    }
    left -= n;
  }
  PetscFunctionReturn(0);
}
