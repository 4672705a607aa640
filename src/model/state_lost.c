/* What was lost on the way, as tables. */
#include "model/state_private.h"

/* One line each, for writing and reading: so many numbers at the offset in a row's struct. */
typedef struct {
  const char *name, *unit;
  size_t offset;
  PetscInt components;
} LostField;

static const LostField account[] = {
  {"most_energy", "J", offsetof(Model, most_energy), 1},
  {"removed", NULL, offsetof(Model, outside.removed), 1},
  {"mass", "kg", offsetof(Model, outside.mass), 1},
  {"held", NULL, offsetof(Model, outside.held), 1},
  {"held_now", NULL, offsetof(Model, outside.held_now), 1},
  {"held_most", NULL, offsetof(Model, outside.held_most), 1},
  {"held_most_mass", "kg", offsetof(Model, outside.held_most_mass), 1},
  {"energy", "J", offsetof(Model, outside.energy), 1},
  {"momentum", "kg m/s", offsetof(Model, outside.momentum), 3},
  {"first", "s", offsetof(Model, outside.first), 1},
  {"last", "s", offsetof(Model, outside.last), 1},
};
static const LostField ended[] = {
  {"ended", "s", offsetof(MeasureMemory, ended), 1},
  {"where", "m", offsetof(MeasureMemory, where), 3},
};
static const LostField ended_loads[] = {
  {"ended", "s", offsetof(LoadMemory, ended), 1},
  {"carriers", NULL, offsetof(LoadMemory, carriers), 1},
  {"force", "N", offsetof(LoadMemory, force), 3},
  {"where", "m", offsetof(LoadMemory, where), 3},
};

/* A table of rows that stand in an array of structs. */
typedef struct {
  const char *name;
  PetscInt rows, n;
  const LostField *field;
  char *data;
  size_t stride;
} LostTable;

static void list_tables(Model *m, LostTable table[3])
{
  table[0] = (LostTable){"account", 1, PETSC_STATIC_ARRAY_LENGTH(account), account, (char *)m, sizeof *m};
  table[1] = (LostTable){"ended", m->c->n_measures,  PETSC_STATIC_ARRAY_LENGTH(ended),
                         ended,   (char *)m->memory, sizeof *m->memory};
  table[2] = (LostTable){"ended_loads", m->c->n_loads,          PETSC_STATIC_ARRAY_LENGTH(ended_loads),
                         ended_loads,   (char *)m->load_memory, sizeof *m->load_memory};
}

static PetscReal *row_of(const LostTable *t, const LostField *f, PetscInt row)
{
  return (PetscReal *)(t->data + t->stride * (size_t)row + f->offset);
}

PetscErrorCode StateLostToTables(Model *m, Tables *tables)
{
  LostTable list[3];
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  list_tables(m, list);
  for (const LostTable *t = list; t < list + 3; ++t) {
    PetscCall(TablesAdd(tables, t->name, PETSC_TRUE, t->rows, &table));
    for (const LostField *f = t->field; f < t->field + t->n; ++f) {
      PetscCall(TableAdd(table, f->name, f->unit, COLUMN_REAL, f->components, NULL, &column));
      for (PetscInt k = 0; k < t->rows; ++k)
        PetscCall(PetscArraycpy((PetscReal *)column->data + k * f->components, row_of(t, f, k), f->components));
    }
  }
  PetscFunctionReturn(0);
}

void state_lost_from_tables(Model *m, const Tables *tables, char reason[256])
{
  LostTable list[3];
  list_tables(m, list);
  for (const LostTable *t = list; t < list + 3; ++t) {
    const Table *table = TablesFind(tables, t->name);
    if (table && (table->rows != t->rows || !table->everywhere)) snprintf(reason, 256, "%s makes no sense", t->name);
    for (const LostField *f = t->field; table && !reason[0] && f < t->field + t->n; ++f) {
      const PetscReal *data = TableData(table, f->name, COLUMN_REAL, f->components, reason);
      for (PetscInt i = 0; data && i < t->rows * f->components; ++i)
        row_of(t, f, i / f->components)[i % f->components] = data[i];
    }
  }
}
