/* What an analysis knows besides how things move: how soft statics had become, strengths and loads that are sought or
 * were found, and what the start was like. */
#include "model/model_private.h"
#include "model/state/state_private.h"

/* How soft a static run had become; checkpoints without this table do not know. */
static PetscErrorCode SofteningToTables(Model *m, Tables *tables)
{
  Table *table;

  PetscFunctionBeginUser;
  if (m->scheme->inertia) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "softening", PETSC_TRUE, 1, &table));
  PetscCall(TableAdd(table, "least_last_before", "m/s", COLUMN_REAL, 3, &m->limit, NULL));
  PetscFunctionReturn(0);
}

static void softening_from_table(Model *m, const Table *table, char reason[256])
{
  if (!table || reason[0]) return;
  const PetscReal *kept = table_data(table, "least_last_before", COLUMN_REAL, 3, reason);
  if (!kept) return;
  for (int k = 0; k < 3 && table->rows == 1; ++k)
    if (!(kept[k] >= 0 && kept[k] <= PETSC_MAX_REAL)) snprintf(reason, 256, "softening makes no sense");
  if (table->rows != 1) snprintf(reason, 256, "softening has %d rows", (int)table->rows);
  else if (!reason[0]) m->limit = (Softening){.least = kept[0], .last = kept[1], .before = kept[2]};
}

/* The bracket is known to whoever seeks the factor; later stages keep it. */
static PetscErrorCode StrengthToTables(const Model *m, Tables *tables)
{
  const PetscBool seeks = m->c->analysis.type == ANALYSIS_FACTOR;
  const PetscBool found = !seeks && (m->strength.lower > 0 || m->strength.upper > 0);
  Table *table;

  PetscFunctionBeginUser;
  if (!seeks && !found && m->strength.factor == 1) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "strength", PETSC_TRUE, 1, &table));
  PetscCall(TableAdd(table, "factor", NULL, COLUMN_REAL, 1, (void *)&m->strength.factor, NULL));
  if (found) PetscCall(TableAdd(table, "lower_upper_value", NULL, COLUMN_REAL, 3, (void *)&m->strength.lower, NULL));
  PetscFunctionReturn(0);
}

/* What a stage before has found; whoever raises a load finds it again. */
static PetscErrorCode FoundToTables(const Model *m, Tables *tables)
{
  const PetscReal found[] = {m->raised.value, m->raised.unfound};
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  if (PetscIsNanReal(found[0]) && !m->raised.unfound) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "limit_found", PETSC_TRUE, 1, &table));
  PetscCall(TableAdd(table, "value_unfound", NULL, COLUMN_REAL, 2, NULL, &column));
  PetscCall(PetscArraycpy((PetscReal *)column->data, found, 2));
  PetscFunctionReturn(0);
}

static void found_from_table(Model *m, const Table *table, char reason[256])
{
  if (!table || reason[0]) return;
  const PetscReal *found = table_data(table, "value_unfound", COLUMN_REAL, 2, reason);
  if (found && table->rows != 1) snprintf(reason, 256, "limit_found makes no sense");
  if (!found || reason[0]) return;
  m->raised.value = found[0];
  m->raised.unfound = (PetscBool)(found[1] != 0);
}

static PetscErrorCode RaisedToTables(const Model *m, Tables *tables)
{
  Table *table;

  PetscFunctionBeginUser;
  if (m->c->analysis.type != ANALYSIS_LIMIT) PetscCall(FoundToTables(m, tables));
  if (!m->raised.rising) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "raised", PETSC_TRUE, 1, &table));
  PetscCall(TableAdd(table, "kept", NULL, COLUMN_REAL, RAISED_KEPT, (void *)&m->raised, NULL));
  PetscFunctionReturn(0);
}

static void raised_from_table(Model *m, const Table *table, char reason[256])
{
  if (!table || reason[0]) return;
  const PetscReal *kept = table_data(table, "kept", COLUMN_REAL, RAISED_KEPT, reason);
  for (int k = 0; kept && k < RAISED_KEPT; ++k) ((PetscReal *)&m->raised)[k] = kept[k];
  m->raised.rising = kept != NULL;
}

static PetscErrorCode InitialToTables(const Model *m, Tables *tables)
{
  Table *table;

  PetscFunctionBeginUser;
  if (m->c->initial.equilibrium <= EQUILIBRIUM_NONE && !m->c->stage) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "initial", PETSC_TRUE, 1, &table));
  PetscCall(TableAdd(table, "kept", NULL, COLUMN_REAL, INITIAL_KEPT, (void *)&m->initial, NULL));
  PetscFunctionReturn(0);
}

void state_initial_from_tables(Model *m, const Tables *tables, char reason[256])
{
  const Table *table = tables_find(tables, "initial");
  if (!table || reason[0]) return;
  const PetscReal *kept = table_data(table, "kept", COLUMN_REAL, INITIAL_KEPT, reason);
  for (int k = 0; kept && k < INITIAL_KEPT; ++k) ((PetscReal *)&m->initial)[k] = kept[k];
}

static void strength_from_table(Model *m, const Table *table, char reason[256])
{
  const PetscReal *kept = table && !reason[0] ? table_data(table, "factor", COLUMN_REAL, 1, reason) : NULL;
  const PetscBool divides = m->c->strength.factor > 0 || m->c->strength.beyond_failure > 0;
  char absent[256] = "";
  if (!kept) return;
  if (table->rows != 1 || !(*kept >= 0 && *kept <= PETSC_MAX_REAL)) snprintf(reason, 256, "strength makes no sense");
  else if (divides || m->c->analysis.type == ANALYSIS_FACTOR) strength_set(m, *kept);
  const PetscReal *found = reason[0] ? NULL : table_data(table, "lower_upper_value", COLUMN_REAL, 3, absent);
  if (!found || m->c->analysis.type == ANALYSIS_FACTOR) return;
  m->strength.lower = found[0];
  m->strength.upper = found[1];
  m->strength.value = found[2];
}

PetscErrorCode StateAnalysisToTables(Model *m, Tables *tables)
{
  PetscFunctionBeginUser;
  PetscCall(SofteningToTables(m, tables));
  PetscCall(StrengthToTables(m, tables));
  PetscCall(InitialToTables(m, tables));
  PetscCall(RaisedToTables(m, tables));
  PetscFunctionReturn(0);
}

PetscErrorCode StateAnalysisFromTables(Model *m, const Tables *tables, char reason[256])
{
  PetscFunctionBeginUser;
  softening_from_table(m, tables_find(tables, "softening"), reason);
  strength_from_table(m, tables_find(tables, "strength"), reason);
  PetscCall(MaterialsBack(m));
  raised_from_table(m, tables_find(tables, "raised"), reason);
  found_from_table(m, tables_find(tables, "limit_found"), reason);
  state_initial_from_tables(m, tables, reason);
  PetscFunctionReturn(0);
}
