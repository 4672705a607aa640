/* The measures of a case: their values, and what they remember. */
#include "base/text.h"
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

/* Collective. Whatever the spec asks for at this moment. */
static PetscErrorCode Value(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const MeasureNumber *number = measure_number(s);

  PetscFunctionBeginUser;
  PetscCall(ModelInitialise(m));
  if (number->value) PetscCall(number->value(m, s, index, value));
  else if (number->sum) PetscCall(PointSum(m, s, number, value));
  else *value = ((const PetscReal *)((const char *)m + number->kept))[number->word ? 0 : s->component];
  PetscFunctionReturn(0);
}

PetscErrorCode ModelMeasure(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  PetscFunctionBeginUser;
  if (measure_has_window(s)) *value = window_value(s, &m->memory[index]);
  else PetscCall(Value(m, s, index, value));
  PetscFunctionReturn(0);
}

static void outside_grid(const Model *m, const MeasureSpec *s, const char *key, Diag *diag)
{
  char path[256], from[80], to[80];
  PetscSNPrintf(path, sizeof path, "measures.%s.%s", s->name, key);
  diag_error(diag, path, "this is outside the grid, which reaches from %s to %s m: nothing will ever be there",
             text_position(m->dim, m->grid->min, from), text_position(m->dim, m->grid->max, to));
}

/* What places `at` there are: along x, or across gravity. */
static void range_of_at(const Model *m, const MeasureSpec *s, PetscReal *low, PetscReal *high)
{
  PetscReal right[2] = {1, 0}, up[2];
  if (!strcmp(s->kind, "free_surface")) measure_up(m, right, up);
  *low = *high = 0;
  for (int d = 0; d < 2; ++d) {
    *low += PetscMin(right[d] * m->grid->min[d], right[d] * m->grid->max[d]);
    *high += PetscMax(right[d] * m->grid->min[d], right[d] * m->grid->max[d]);
  }
}

/* The weight above is that of shapes: a body without one would weigh nothing there. */
static void check_layers(const Model *m, const MeasureSpec *s, Diag *diag)
{
  char path[256];
  for (PetscInt b = 0; b < m->c->n_bodies && !strcmp(s->kind, "overburden"); ++b) {
    if (m->c->bodies[b].has_shape) continue;
    PetscSNPrintf(path, sizeof path, "measures.%s.overburden", s->name);
    diag_error(diag, path, "the weight of level layers is that of their shapes, and '%s' has none",
               m->c->bodies[b].name);
    diag_hint(diag, "give it a shape, or measure the stress itself: stress: yy, in: {box: ...}");
    return;
  }
}

void measures_check(const Model *m, Diag *diag)
{
  for (PetscInt k = 0; k < m->c->n_measures; ++k) {
    const MeasureSpec *s = &m->c->measures[k];
    const PetscReal *low = m->grid->min, *high = m->grid->max;
    PetscReal min[3], max[3], first, last;
    PetscBool meets = PETSC_TRUE;
    check_layers(m, s, diag);
    range_of_at(m, s, &first, &last);
    if (s->has_at && (s->at < first || s->at > last)) outside_grid(m, s, "at", diag);
    if (!s->has_in) continue;
    shape_bounds(&s->in, m->dim, min, max);
    for (PetscInt d = 0; d < m->dim; ++d) meets = meets && min[d] < high[d] && max[d] > low[d];
    if (!meets) outside_grid(m, s, "in", diag);
  }
}

PetscBool measure_under_way(const Model *m, PetscInt k, PetscReal *since)
{
  const MeasureEvents *events = measure_find(m->c->measures[k].kind)->events;
  if (!events || m->memory[k].list[0] != 1) return PETSC_FALSE;
  *since = m->memory[k].list[events->begun];
  return PETSC_TRUE;
}

PetscBool measure_list_fits(const Model *m, PetscInt k, PetscInt64 length)
{
  const MeasureEvents *events = measure_find(m->c->measures[k].kind)->events;
  if (events) return length >= events->header && (length - events->header) % events->n == 0;
  return measure_has_window(m->c->measures + k) ? window_list_fits(length) : length == 0;
}

PetscInt measure_n_events(const Model *m, PetscInt k)
{
  const MeasureEvents *events = measure_find(m->c->measures[k].kind)->events;
  return events ? (m->memory[k].n_list - events->header) / events->n : 0;
}

const PetscReal *measure_event(const Model *m, PetscInt k, PetscInt i)
{
  const MeasureEvents *events = measure_find(m->c->measures[k].kind)->events;
  return m->memory[k].list + events->header + i * events->n;
}

PetscErrorCode MeasuresStart(Model *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->c->n_measures, &m->memory));
  if (!case_goes_on(m->c)) PetscCall(ContactStand(m)); /* else the state is still to come */
  PetscCall(MeasuresRemember(m, 0));
  PetscFunctionReturn(0);
}

static PetscErrorCode Remember(Model *m, PetscInt k, PetscReal dt)
{
  const MeasureSpec *s = &m->c->measures[k];
  const Measure *measure = measure_find(s->kind);
  PetscReal value;

  PetscFunctionBeginUser;
  if (measure->remember) PetscCall(measure->remember(m, s, dt, m->memory[k].kept));
  PetscCall(RowRemember(m, k, dt));
  if (!measure_has_window(s)) PetscFunctionReturn(0);
  PetscCall(Value(m, s, k, &value));
  PetscCall(WindowRemember(m, s, &m->memory[k], dt, value));
  PetscFunctionReturn(0);
}

PetscErrorCode MeasuresRemember(Model *m, PetscReal dt)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_measures; ++k) PetscCall(Remember(m, k, dt));
  PetscFunctionReturn(0);
}

PetscErrorCode MeasureBegin(Model *m, PetscInt k)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->memory[k].list));
  m->memory[k] = (MeasureMemory){0};
  PetscCall(Remember(m, k, 0));
  PetscFunctionReturn(0);
}

PetscErrorCode MeasuresEnd(Model *m)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; m->memory && k < m->c->n_measures; ++k) PetscCall(PetscFree(m->memory[k].list));
  PetscCall(PetscFree(m->memory));
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
