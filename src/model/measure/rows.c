/* What rows of the history hold of means over a step: where not every step has a row, the mean since the last one, so
 * that a row times the time since then is the impulse, however few rows there are. A formula is that of the row:
 * friction over a row is the ratio of impulses, which the mean of ratios is not. */
#include "model/measure/measure.h"
#include <string.h>

/* With a row for each step it is that of the step. */
static PetscBool skips_steps(const Case *c) { return c->output.history != -1; }

static PetscBool is_formula(const MeasureSpec *s)
{
  return (PetscBool)(!strcmp(s->kind, "formula") && !measure_has_window(s));
}

/* One step alone leaves its value to the last digit. A step without a value (nan) leaves none to the row: a mean of the
 * others would not be that since the row before. */
static void add_step(RowMean *row, PetscReal dt, PetscReal value)
{
  if (row->given) *row = (RowMean){0};
  const PetscReal before = row->time;
  row->time += dt;
  row->mean = before > 0 ? row->mean + dt / row->time * (value - row->mean) : value;
}

PetscErrorCode MeasureRowIsMean(const Case *c, PetscInt k, PetscBool *is)
{
  PetscFunctionBeginUser;
  *is = PETSC_FALSE;
  if (k >= 0 && !measure_has_window(c->measures + k)) PetscCall(MeasureOverStep(c, k, is));
  PetscFunctionReturn(0);
}

PetscErrorCode RowRemember(Model *m, PetscInt k, PetscReal dt)
{
  const MeasureSpec *s = &m->c->measures[k];
  PetscBool is_mean;
  PetscReal value;

  PetscFunctionBeginUser;
  if (!dt || !skips_steps(m->c) || is_formula(s)) PetscFunctionReturn(0);
  PetscCall(MeasureRowIsMean(m->c, k, &is_mean));
  if (!is_mean) PetscFunctionReturn(0);
  PetscCall(ModelMeasure(m, s, k, &value));
  add_step(&m->memory[k].row, dt, value);
  PetscFunctionReturn(0);
}

PetscErrorCode ModelMeasureRow(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const RowMean *row = &m->memory[index].row;

  PetscFunctionBeginUser;
  if (is_formula(s)) PetscCall(FormulaOfRow(m, s, index, value));
  else if (row->time > 0) *value = row->mean;
  else PetscCall(ModelMeasure(m, s, index, value));
  PetscFunctionReturn(0);
}

/* Its mean stays known until the next step: a run that ends here asks for it once more. */
void model_row_given(Model *m)
{
  for (PetscInt k = 0; k < m->c->n_measures; ++k) m->memory[k].row.given = 1;
}
