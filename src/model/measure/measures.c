/* The measures of a case: their values, and what they remember. */
#include "model/measure/measure.h"
#include "model/model_private.h"
#include <string.h>

PetscInt measure_body(const Model *m, const MeasureSpec *s)
{
  for (PetscInt b = 0; s->body && b < m->c->n_bodies; ++b)
    if (!strcmp(m->c->bodies[b].name, s->body)) return b;
  return -1;
}

static PetscErrorCode PointSum(const Model *m, const MeasureSpec *s, const MeasureNumber *number, PetscReal *value)
{
  const PetscInt body = measure_body(m, s);
  PetscReal sum[2] = {number->sum(m, s, body), 0}; /* the last: points */

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) sum[1] += measure_takes_point(m, body, p);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  *value = body >= 0 && sum[1] == 0 ? NAN : sum[0];
  PetscFunctionReturn(0);
}

PetscErrorCode ModelMeasure(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const MeasureNumber *number = measure_number(s);

  PetscFunctionBeginUser;
  PetscCall(ModelInitialise(m));
  if (number->value) PetscCall(number->value(m, s, index, value));
  else if (number->sum) PetscCall(PointSum(m, s, number, value));
  else *value = ((const PetscReal *)((const char *)m + number->kept))[number->word ? 0 : s->component];
  PetscFunctionReturn(0);
}

PetscErrorCode MeasuresStart(Model *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->c->n_measures, &m->memory));
  PetscCall(MeasuresRemember(m, 0));
  PetscFunctionReturn(0);
}

PetscErrorCode MeasuresRemember(Model *m, PetscReal dt)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_measures; ++k) {
    const MeasureSpec *s = &m->c->measures[k];
    const Measure *measure = measure_find(s->kind);
    if (measure->remember) PetscCall(measure->remember(m, s, dt, m->memory[k].kept));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelCountPoints(const Model *m, PetscInt *n)
{
  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(&m->points->n, n, 1, MPIU_INT, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelPointStress(const Model *m, PetscInt p, PetscReal sigma[6])
{
  PetscFunctionBeginUser;
  point_tau(m->points, p, sigma);
  for (int k = 0; k < 6; ++k) sigma[k] /= m->points->real[POINT_J][p];
  PetscFunctionReturn(0);
}
