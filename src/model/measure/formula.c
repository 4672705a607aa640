/* What comes of other measures by arithmetic: a coefficient, a sum of forces, a share. */
#include "base/formula.h"
#include "model/measure/measure.h"
#include <string.h>

typedef struct {
  Model *m;
  PetscInt before; /* those before it count: none can need itself */
  PetscErrorCode (*measure)(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value);
} Lookup;

static PetscErrorCode Other(void *context, const char *name, PetscBool *known, PetscReal *value)
{
  const Lookup *l = context;

  PetscFunctionBeginUser;
  *known = PETSC_FALSE;
  for (PetscInt k = 0; k < l->before && !*known; ++k) {
    const MeasureSpec *s = &l->m->c->measures[k];
    if (strcmp(s->name, name) != 0) continue;
    *known = PETSC_TRUE;
    PetscCall(l->measure(l->m, s, k, value));
  }
  PetscFunctionReturn(0);
}

typedef struct {
  const Case *c;
  PetscInt before;
  PetscBool over_step; /* is one of those that it takes the mean over the last step? */
} Kinds;

static PetscErrorCode Kind(void *context, const char *name, PetscBool *known, PetscReal *value)
{
  Kinds *kinds = context;
  PetscBool over_step;

  PetscFunctionBeginUser;
  *known = PETSC_FALSE;
  *value = 1;
  for (PetscInt k = 0; k < kinds->before && !*known; ++k) {
    const MeasureSpec *s = &kinds->c->measures[k];
    if (strcmp(s->name, name) != 0) continue;
    *known = PETSC_TRUE;
    PetscCall(MeasureOverStep(kinds->c, k, &over_step));
    kinds->over_step |= over_step && !measure_has_window(s);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MeasureOverStep(const Case *c, PetscInt k, PetscBool *is)
{
  const MeasureSpec *s = &c->measures[k];
  Kinds kinds = {.c = c, .before = k};
  Formula formula = {.value = Kind, .context = &kinds, .at = s->word};
  PetscReal value;

  PetscFunctionBeginUser;
  if (strcmp(s->kind, "formula") != 0) kinds.over_step = measure_number(s)->over_step;
  else PetscCall(FormulaValue(&formula, &value));
  *is = (PetscBool)(kinds.over_step && !case_is_static(&c->analysis));
  PetscFunctionReturn(0);
}

static PetscErrorCode Value(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  Lookup lookup = {.m = m, .before = index, .measure = ModelMeasure};
  Formula formula = {.value = Other, .context = &lookup, .at = s->word};

  PetscFunctionBeginUser;
  PetscCall(FormulaValue(&formula, value));
  PetscFunctionReturn(0);
}

PetscErrorCode FormulaOfRow(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  Lookup lookup = {.m = m, .before = index, .measure = ModelMeasureRow};
  Formula formula = {.value = Other, .context = &lookup, .at = s->word};

  PetscFunctionBeginUser;
  PetscCall(FormulaValue(&formula, value));
  PetscFunctionReturn(0);
}

const Measure measure_formula = {
  .key = "formula",
  .takes = MEASURE_TEXT,
  .number = {.unit = "",
             .help = "of measures above it by their names, in their units: " FORMULA_SIGNS
                     " (angles in rad), such as left + right + floor",
             .of = OF_MODEL,
             .value = Value}};
