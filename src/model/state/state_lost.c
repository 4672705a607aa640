/* What was lost on the way, as tables. All of it are real numbers that stand together in their
 * structs, one row each. */
#include "model/state/state_private.h"

#define NUMBERS(type, first) ((PetscInt)((sizeof(type) - offsetof(type, first)) / sizeof(PetscReal)))

typedef struct {
  const char *name, *column;
  PetscInt rows, components;
  char *data; /* the first row's first number */
  size_t stride;
} LostTable;

enum { N_LOST = 7 };

static void list_tables(Model *m, LostTable table[N_LOST])
{
  table[0] = (LostTable){"energy_in", "most", 1, 1, (char *)&m->most_energy, 0};
  table[1] =
    (LostTable){"outside", "points_energy_momentum_times", 1, NUMBERS(Outside, removed), (char *)&m->outside, 0};
  table[2] = (LostTable){"ended",
                         "when_where",
                         m->c->n_measures,
                         1 + 3, /* ended, where */
                         (char *)m->memory + offsetof(MeasureMemory, ended),
                         sizeof *m->memory};
  table[3] = (LostTable){"ended_loads",          "when_carriers_force_where", m->c->n_loads, NUMBERS(LoadMemory, ended),
                         (char *)m->load_memory, sizeof *m->load_memory};
  table[4] = (LostTable){"energy_open", "work", 1, 1, (char *)&m->open_energy, 0};
  table[5] = (LostTable){"energy_kept", "elastic", 1, 1, (char *)&m->kept_energy, 0};
  table[6] = (LostTable){"sway", "steps_sums", 1, NUMBERS(Sway, steps), (char *)&m->sway, 0};
}

static PetscReal *row_of(const LostTable *t, PetscInt row) { return (PetscReal *)(t->data + t->stride * (size_t)row); }

/* Most runs lose nothing: tables of zeros are left out. */
static PetscBool is_empty(const LostTable *t)
{
  for (PetscInt k = 0; k < t->rows; ++k)
    for (PetscInt i = 0; i < t->components; ++i)
      if (row_of(t, k)[i] != 0) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscErrorCode StateLostToTables(Model *m, Tables *tables)
{
  LostTable list[N_LOST];
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  list_tables(m, list);
  for (const LostTable *t = list; t < list + N_LOST; ++t) {
    if (is_empty(t)) continue;
    PetscCall(TablesAdd(tables, t->name, PETSC_TRUE, t->rows, &table));
    PetscCall(TableAdd(table, t->column, NULL, COLUMN_REAL, t->components, NULL, &column));
    for (PetscInt k = 0; k < t->rows; ++k)
      PetscCall(PetscArraycpy((PetscReal *)column->data + k * t->components, row_of(t, k), t->components));
  }
  PetscFunctionReturn(0);
}

void state_lost_from_tables(Model *m, const Tables *tables, char reason[256])
{
  LostTable list[N_LOST];
  list_tables(m, list);
  for (const LostTable *t = list; t < list + N_LOST && !reason[0]; ++t) {
    const Table *table = tables_find(tables, t->name);
    if (!table) continue;
    if (table->rows != t->rows || !table->everywhere) snprintf(reason, 256, "%s makes no sense", t->name);
    const PetscReal *data = reason[0] ? NULL : table_data(table, t->column, COLUMN_REAL, t->components, reason);
    for (PetscInt i = 0; data && i < t->rows * t->components; ++i)
      row_of(t, i / t->components)[i % t->components] = data[i];
  }
}
