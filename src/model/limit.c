/* Is a static run about to reach the load that its bodies can just carry? They then move ever farther under the same increment of load, and
 * no step is small enough in the end. */
#include "model/model_private.h"

#define SOFTENED \
  5 /* times as far per increment as at its stiffest: what hardens, or fails for reasons of its own, does not get there */

static PetscReal load_at(const Case *c, const Amplitude *amplitude, PetscReal t)
{
  return amplitude_value(amplitude, t, t / c->analysis.end);
}

static PetscBool weighs(const Case *c)
{
  return c->gravity[0] != 0 || c->gravity[1] != 0 || c->gravity[2] != 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Does any load grow at time t, over a step that led there or away from it? */
static PetscBool loads_grow(const Case *c, PetscReal t, PetscReal dt)
{
  PetscBool grow = PETSC_FALSE;
  for (PetscInt k = -1; k < c->n_loads; ++k) {
    const Amplitude *a = k < 0 ? &c->gravity_amplitude : &c->loads[k].amplitude;
    if (k < 0 && !weighs(c)) continue;
    grow |= PetscAbsReal(load_at(c, a, t + dt)) > PetscAbsReal(load_at(c, a, t)) ? PETSC_TRUE : PETSC_FALSE;
  }
  return grow;
}

PetscErrorCode LimitWatch(Model *m, PetscReal dt)
{
  PetscReal local = 0, all;

  PetscFunctionBeginUser;
  if (m->c->analysis.type != ANALYSIS_STATIC) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i)
    if (m->system->row[i / m->dim] >= 0) local += m->du[i] * m->du[i];
  PetscCall(MPIU_Allreduce(&local, &all, 1, MPIU_REAL, MPIU_SUM, m->comm));
  m->limit.before = m->limit.last;
  m->limit.last = PetscSqrtReal(all) / dt;
  if (m->limit.least == 0 || m->limit.last < m->limit.least) m->limit.least = m->limit.last;
  PetscFunctionReturn(0);
}

/* "at load factor 0.98", or the factor of each load if they differ. */
static void factors_text(const Case *c, PetscReal t, char *text, size_t size)
{
  PetscBool same = PETSC_TRUE;
  PetscReal first = weighs(c) ? load_at(c, &c->gravity_amplitude, t) : load_at(c, &c->loads[0].amplitude, t);
  size_t used;
  for (PetscInt k = 0; k < c->n_loads; ++k)
    if (load_at(c, &c->loads[k].amplitude, t) != first) same = PETSC_FALSE;
  if (same) {
    snprintf(text, size, "at load factor %.4g", (double)first);
    return;
  }
  used = (size_t)snprintf(text, size, "at factors");
  if (weighs(c)) used += (size_t)snprintf(text + used, size - used, " %.4g of gravity", (double)first);
  for (PetscInt k = 0, number[2] = {0, 0}; k < c->n_loads && used < size; ++k) {
    const LoadSpec *load = &c->loads[k];
    used += (size_t)snprintf(text + used, size - used, "%s %.4g of loads.%s[%d]",
                             used > strlen("at factors") ? "," : "", (double)load_at(c, &load->amplitude, t),
                             load->kind == LOAD_POINT ? "points" : "tractions", (int)number[load->kind]++);
  }
}

void limit_describe(const Model *m, StepReport *report)
{
  const size_t used = strlen(report->reason);
  char factors[256];
  if (m->c->analysis.type != ANALYSIS_STATIC || !loads_grow(m->c, m->time, report->dt)) return;
  if (m->limit.last < SOFTENED * m->limit.least || m->limit.last < m->limit.before) return;
  factors_text(m->c, m->time, factors, sizeof factors);
  snprintf(
    report->reason + used, sizeof report->reason - used,
    ". This may be a limit load, %s: the last step moved the body %.3g times as far per increment of load as the "
    "stiffest",
    factors, (double)(m->limit.last / m->limit.least));
}
