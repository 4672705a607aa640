/* What comes of other measures by arithmetic: a coefficient, a sum of forces, a share. */
#include "base/formula.h"
#include "model/measure/measure.h"
#include <string.h>

typedef struct {
  Model *m;
  PetscInt before; /* those before it count: none can need itself */
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
    PetscCall(ModelMeasure(l->m, s, k, value));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Value(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  Lookup lookup = {.m = m, .before = index};
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
