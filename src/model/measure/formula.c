/* What comes of other measures by arithmetic: a coefficient, a sum of forces, a share. */
#include "base/formula.h"
#include "model/measure/measure.h"
#include <string.h>

typedef struct {
  Model *m;
  PetscInt before;     /* those before it count: none can need itself */
  PetscBool over_step; /* is one of them the mean over the last step? */
} Lookup;

static PetscErrorCode Evaluate(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value, PetscBool *over_step);

static PetscErrorCode Other(void *context, const char *name, PetscBool *known, PetscReal *value)
{
  Lookup *l = context;

  PetscFunctionBeginUser;
  *known = PETSC_FALSE;
  for (PetscInt k = 0; k < l->before && !*known; ++k) {
    const MeasureSpec *s = &l->m->c->measures[k];
    PetscBool over_step = measure_number(s)->over_step;
    if (strcmp(s->name, name) != 0) continue;
    *known = PETSC_TRUE;
    if (measure_has_window(s) || strcmp(s->kind, "formula") != 0) PetscCall(ModelMeasure(l->m, s, k, value));
    else PetscCall(Evaluate(l->m, s, k, value, &over_step));
    l->over_step |= over_step && !measure_has_window(s);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Evaluate(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value, PetscBool *over_step)
{
  Lookup lookup = {.m = m, .before = index};
  Formula formula = {.value = Other, .context = &lookup, .at = s->word};

  PetscFunctionBeginUser;
  PetscCall(FormulaValue(&formula, value));
  *over_step = lookup.over_step;
  PetscFunctionReturn(0);
}

PetscErrorCode FormulaOverStep(Model *m, const MeasureSpec *s, PetscBool *is)
{
  PetscReal value;

  PetscFunctionBeginUser;
  PetscCall(Evaluate(m, s, (PetscInt)(s - m->c->measures), &value, is));
  PetscFunctionReturn(0);
}

static PetscErrorCode Value(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  PetscBool over_step;

  PetscFunctionBeginUser;
  PetscCall(Evaluate(m, s, index, value, &over_step));
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
