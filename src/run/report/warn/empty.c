/* Tracers, loads and measures that have nothing left to follow or to measure. */
#include "base/text.h"
#include "model/measure/measure.h"
#include "run/report/warn/warn.h"

void warn_of_followers(const Model *m, Diag *diag)
{
  char path[256], at[80];
  for (PetscInt k = 0; k < m->c->n_measures; ++k) {
    const MeasureMemory *memory = &m->memory[k];
    if (memory->ended <= 0) continue;
    snprintf(path, sizeof path, "measures.%s.of.tracer", m->c->measures[k].name);
    diag_warning(diag, path,
                 "'%s' is empty (nan) from t = %g s on: no node of the grid carries its tracer, last at %s m",
                 m->c->measures[k].name, (double)memory->ended, text_position(m->dim, memory->where, at));
    diag_hint(diag, "a tracer ends where the material around it has gone, or a cell beyond the edge of the grid");
  }
  for (PetscInt k = 0; k < m->c->n_loads; ++k)
    if (m->load_memory[k].ended > 0)
      diag_warning(
        diag, "loads",
        "the material has left %.0f carriers of load %d behind, the last at t = %g s about %s m: their force is gone",
        (double)m->load_memory[k].carriers, (int)k, (double)m->load_memory[k].ended,
        text_position(m->dim, m->load_memory[k].where, at));
}

/* Of a law from a library. */
static PetscBool lacks_energy(const Model *m)
{
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if (!m->materials[i].law->energy) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Is there anything of what it sums up, or takes the mean of? */
static PetscErrorCode SumsAnything(const Model *m, const MeasureSpec *measure, PetscBool *any)
{
  const PetscBool tensor = (PetscBool)(!strcmp(measure->kind, "stress") || !strcmp(measure->kind, "strain"));
  const PetscInt body = measure_body(m, measure);
  PetscInt n = 0;

  PetscFunctionBeginUser;
  *any = PETSC_FALSE;
  if (!measure_number(measure)->sum && !tensor) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < m->points->n; ++p) n += measure_share(m, measure, body, p) > 0;
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_SUM, m->comm));
  *any = (PetscBool)(n > 0);
  PetscFunctionReturn(0);
}

static const char *why_no_limit(const Model *m)
{
  if (m->raised.unfound) return "the search for it has found none";
  return m->c->analysis.type == ANALYSIS_LIMIT ? "the search for it was not over" : "no limit load was sought";
}

/* any: is there something of what it sums up? */
static const char *why_empty(const Model *m, const MeasureSpec *measure, PetscBool any)
{
  if (!strcmp(measure->kind, "limit_load")) return why_no_limit(m);
  if (measure_has_window(measure)) return "too few steps with a value reach into its window";
  if (measure_find(measure->kind)->events) return "none of what it counts is over";
  if (!strcmp(measure->kind, "formula")) return "its formula has no value there, or a measure in it has none";
  if (!strcmp(measure->kind, "initial")) return "no equilibrium was sought before the first step";
  if (!strncmp(measure->kind, "wall_", 5)) return "a wall without `mass` has no motion of its own";
  if (!strcmp(measure->kind, "energy") && lacks_energy(m)) return "the law of a material tells no energy";
  if (any) return "what it measures is there, and deformed beyond what numbers hold";
  return "no point is left of what it measures";
}

static void warn_of_infinite(const MeasureSpec *measure, PetscReal value, Diag *diag)
{
  char path[256];
  if (!PetscIsInfReal(value)) return;
  snprintf(path, sizeof path, "measures.%s", measure->name);
  diag_warning(diag, path, "'%s' is infinite at the end: its formula divides by nothing, or grows beyond all numbers",
               measure->name);
}

PetscErrorCode WarnOfEmpty(const Model *m, const PetscReal *values, Diag *diag)
{
  char path[256];
  PetscBool any;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_measures; ++k) {
    const MeasureSpec *measure = m->c->measures + k;
    warn_of_infinite(measure, values[k], diag);
    if (!PetscIsNanReal(values[k]) || m->memory[k].ended > 0) continue;
    if (!strcmp(measure->kind, "factor_of_safety")) continue; /* the log says why it has none */
    snprintf(path, sizeof path, "measures.%s", measure->name);
    PetscCall(SumsAnything(m, measure, &any));
    diag_warning(diag, path, "'%s' is empty (nan) at the end: %s", measure->name, why_empty(m, measure, any));
  }
  PetscFunctionReturn(0);
}
