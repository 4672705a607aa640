/* Is a static run about to reach the load that its bodies can just carry? They then move ever
 * farther under the same increment of load, and no step is small enough in the end. */
#include "model/model_private.h"

/* times as far per increment as at its stiffest: what hardens, or fails for reasons of its own,
 * does not get there */
#define SOFTENED 5
/* the same of the last try of a tiny step that had no solution: all of a body may yield at once */
#define RAN_AWAY 4

static PetscBool weighs(const Case *c) { return c->gravity[0] != 0 || c->gravity[1] != 0 || c->gravity[2] != 0; }

/* Does any load grow at time t, over a step that led there or away from it? */
static PetscBool loads_grow(const Case *c, PetscReal t, PetscReal dt)
{
  PetscBool grow = PETSC_FALSE;
  for (PetscInt k = -1; k < c->n_loads; ++k) {
    const Amplitude *a = k < 0 ? &c->gravity_amplitude : &c->loads[k].amplitude;
    if (k < 0 && !weighs(c)) continue;
    grow |= PetscAbsReal(case_factor(c, a, t + dt)) > PetscAbsReal(case_factor(c, a, t));
  }
  return grow;
}

/* How far the increments move all nodes, over the time that they take, m/s. */
static PetscErrorCode Rate(const Model *m, PetscReal dt, PetscReal *rate)
{
  PetscReal local = 0, all;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i)
    if (m->system->row[i / m->dim] >= 0) local += m->nodes->du[i] * m->nodes->du[i];
  PetscCall(MPIU_Allreduce(&local, &all, 1, MPIU_REAL, MPIU_SUM, m->comm));
  *rate = PetscSqrtReal(all) / dt;
  PetscFunctionReturn(0);
}

PetscErrorCode LimitWatch(Model *m, PetscReal dt)
{
  Softening *limit = &m->limit;

  PetscFunctionBeginUser;
  if (m->scheme->inertia) PetscFunctionReturn(0);
  limit->before = limit->last;
  PetscCall(Rate(m, dt, &limit->last));
  if (limit->least == 0 || limit->last < limit->least) limit->least = limit->last;
  PetscFunctionReturn(0);
}

/* "at load factor 0.98", or the factor of each load if they differ. */
static void factors_text(const Case *c, PetscReal t, char *text, size_t size)
{
  const PetscInt n = case_acting_loads(c);
  PetscBool same = PETSC_TRUE;
  PetscReal first = weighs(c) ? case_factor(c, &c->gravity_amplitude, t) : case_factor(c, &c->loads[0].amplitude, t);
  char path[64];
  size_t used;
  for (PetscInt k = 0; k < n; ++k)
    if (case_factor(c, &c->loads[k].amplitude, t) != first) same = PETSC_FALSE;
  if (same) {
    snprintf(text, size, "at load factor %.4g", (double)first);
    return;
  }
  used = (size_t)snprintf(text, size, "at factors");
  if (weighs(c)) used += (size_t)snprintf(text + used, size - used, " %.4g of gravity", (double)first);
  for (PetscInt k = 0; k < n && used < size; ++k)
    used += (size_t)snprintf(text + used, size - used, "%s %.4g of %s", used > strlen("at factors") ? "," : "",
                             (double)case_factor(c, &c->loads[k].amplitude, t), case_load_path(c, k, path));
}

/* A body that softened, step by step; or, where all of it yields at once, one whose nodes ran away
 * in the last try of a small step that had no solution: but not because Newton was not let go
 * on. */
static PetscBool looks_like_limit(const Model *m, const StepReport *report, PetscReal tried)
{
  const Softening *limit = &m->limit;
  const PetscBool small = report->dt <= m->c->analysis.step / 128;
  if (limit->before == 0) return PETSC_FALSE; /* fewer than two steps */
  if (limit->last >= SOFTENED * limit->least && limit->last >= limit->before) return PETSC_TRUE;
  return small && materials_yield(m->c->n_materials, m->materials) && report->newton.status == LAW_OK &&
         tried >= RAN_AWAY * limit->least && tried <= PETSC_MAX_REAL;
}

PetscErrorCode LimitDescribe(const Model *m, StepReport *report)
{
  const size_t used = strlen(report->reason);
  char factors[256];
  PetscReal tried;

  PetscFunctionBeginUser;
  if (m->scheme->inertia || m->raised.rising || !loads_grow(m->c, m->time, report->dt)) PetscFunctionReturn(0);
  PetscCall(Rate(m, report->dt, &tried));
  if (!looks_like_limit(m, report, tried)) PetscFunctionReturn(0);
  factors_text(m->c, m->time, factors, sizeof factors);
  snprintf(report->reason + used, sizeof report->reason - used,
           ". This may be a limit load, %s: for a little more load the body moves %.3g times as far as at first",
           factors, (double)(PetscMax(m->limit.last, tried) / m->limit.least));
  PetscFunctionReturn(0);
}
