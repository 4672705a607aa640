#include "run/watch/until.h"
#include "base/hash.h"
#include <string.h>

PetscErrorCode UntilCreate(const Case *c, Until *u)
{
  PetscFunctionBeginUser;
  *u = (Until){.n = c->analysis.n_until};
  PetscCall(PetscCalloc2(u->n, &u->was_off, u->n, &u->since));
  for (PetscInt k = 0; k < u->n; ++k) u->since[k] = -1;
  PetscFunctionReturn(0);
}

PetscErrorCode UntilDestroy(Until *u)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(u->was_off, u->since));
  PetscFunctionReturn(0);
}

static PetscInt measure_of(const Case *c, const UntilSpec *spec)
{
  for (PetscInt k = 0; k < c->n_measures; ++k)
    if (!strcmp(c->measures[k].name, spec->measure)) return k;
  return -1; /* the case was checked */
}

/* A measure that has no value fulfils nothing. */
static PetscBool holds(const UntilSpec *spec, PetscReal value)
{
  switch (spec->kind) {
  case UNTIL_BELOW: return value < spec->value;
  case UNTIL_ABOVE: return value > spec->value;
  case UNTIL_COUNT: return value >= (PetscReal)spec->count;
  }
  return PETSC_FALSE;
}

static void look(Until *u, PetscInt k, const UntilSpec *spec, PetscReal time, PetscReal value)
{
  const PetscBool counts = (PetscBool)(time >= spec->after * (1 - 1e-9));
  if (PetscIsNanReal(value)) return;
  if (!holds(spec, value)) {
    u->was_off[k] = 1;
    u->since[k] = -1;
  } else if (!counts) u->was_off[k] = 0; /* it is there before that time, and must leave first */
  else if (u->since[k] < 0 && (u->was_off[k] > 0 || spec->kind == UNTIL_COUNT)) u->since[k] = time;
  if (u->since[k] >= 0 && time - u->since[k] >= spec->duration * (1 - 1e-9) && !u->ended) u->ended = k + 1;
}

PetscErrorCode UntilLook(Until *u, Model *m)
{
  PetscReal value;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < u->n; ++k) {
    const UntilSpec *spec = &m->c->analysis.until[k];
    const PetscInt index = measure_of(m->c, spec);
    PetscCall(ModelMeasure(m, &m->c->measures[index], index, &value));
    PetscCallMPI(MPI_Bcast(&value, 1, MPIU_REAL, 0, m->comm)); /* all ranks end together */
    look(u, k, spec, case_time(m->c, m->time), value);
  }
  PetscFunctionReturn(0);
}

static void describe(const Case *c, const UntilSpec *spec, size_t size, char *text)
{
  const char *unit = measure_unit(&c->measures[measure_of(c, spec)]);
  if (spec->kind == UNTIL_COUNT) snprintf(text, size, "%s came to %d", spec->measure, (int)spec->count);
  else
    snprintf(text, size, "%s %s %g%s%s", spec->measure, spec->kind == UNTIL_BELOW ? "fell below" : "rose above",
             (double)spec->value, unit[0] ? " " : "", unit);
  const size_t used = strlen(text);
  if (spec->duration > 0 && used < size) snprintf(text + used, size - used, " for %g s", (double)spec->duration);
}

void until_reason(const Until *u, const Case *c, char reason[256])
{
  reason[0] = 0;
  if (u->ended) describe(c, &c->analysis.until[u->ended - 1], 256, reason);
}

/* Tells these conditions from others. */
static PetscInt64 fingerprint(const Case *c)
{
  PetscInt64 sum = 0;
  char text[256], more[64];
  for (PetscInt k = 0; k < c->analysis.n_until; ++k) {
    describe(c, &c->analysis.until[k], sizeof text, text);
    snprintf(more, sizeof more, " %d %.17g %.17g", (int)k, (double)c->analysis.until[k].value,
             (double)c->analysis.until[k].after);
    sum ^= (PetscInt64)(hash_text(text) ^ (hash_text(more) << 1));
  }
  return sum;
}

PetscErrorCode UntilToTables(const Until *u, const Case *c, Tables *tables)
{
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  if (!u->n) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "until", PETSC_TRUE, u->n, &table));
  PetscCall(TableAdd(table, "off_since", NULL, COLUMN_REAL, 2, NULL, &column));
  for (PetscInt k = 0; k < u->n; ++k)
    PetscCall(PetscArraycpy((PetscReal *)column->data + 2 * k, ((PetscReal[]){u->was_off[k], u->since[k]}), 2));
  PetscCall(TableAdd(table, "which_ended", NULL, COLUMN_INT64, 2, NULL, &column));
  for (PetscInt k = 0; k < u->n; ++k)
    PetscCall(PetscArraycpy((PetscInt64 *)column->data + 2 * k, ((PetscInt64[]){fingerprint(c), u->ended}), 2));
  PetscFunctionReturn(0);
}

void until_from_tables(Until *u, const Case *c, const Tables *tables, char reason[256])
{
  const Table *table = tables_find(tables, "until");
  if (!table || !u->n || reason[0]) return;
  const PetscReal *kept = table_data(table, "off_since", COLUMN_REAL, 2, reason);
  const PetscInt64 *which = table_data(table, "which_ended", COLUMN_INT64, 2, reason);
  if (reason[0] || table->rows != u->n || which[0] != fingerprint(c)) return;
  if (which[1] < 0 || which[1] > u->n) snprintf(reason, 256, "%s makes no sense", table->name);
  else u->ended = (PetscInt)which[1];
  for (PetscInt k = 0; k < u->n; ++k) u->was_off[k] = kept[2 * k], u->since[k] = kept[2 * k + 1];
}
