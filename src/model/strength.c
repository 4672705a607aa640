/* Strength divided by a factor (docs/theory.md, "Factor of safety"): which materials take part, and a
 * step to the equilibrium with another factor. */
#include "model/model_private.h"

static PetscBool is_reduced(const ReductionSpec *spec, const BodySpec *body)
{
  for (PetscInt k = 0; k < spec->n_bodies; ++k)
    if (!strcmp(spec->bodies[k], body->name)) return PETSC_TRUE;
  return spec->n_bodies == 0;
}

/* Is the strength of material i divided? */
static PetscBool material_is_reduced(const Model *m, PetscInt i)
{
  const Case *c = m->c;
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (is_reduced(&c->analysis.reduction, &c->bodies[b]) && !strcmp(c->bodies[b].material, c->materials[i].name))
      return PETSC_TRUE;
  return PETSC_FALSE;
}

void strength_set(Model *m, PetscReal factor)
{
  m->strength.factor = factor;
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if (material_is_reduced(m, i)) material_reduce(&m->materials[i], factor);
}

/* A body that keeps its strength cannot share its material with one that does not. */
static void check_body(const Model *m, PetscInt b, Diag *diag)
{
  const Case *c = m->c;
  const BodySpec *body = &c->bodies[b];
  const PetscBool reduced = is_reduced(&c->analysis.reduction, body);
  char path[256];
  for (PetscInt i = 0; i < c->n_materials; ++i) {
    if (strcmp(body->material, c->materials[i].name)) continue;
    const Law *law = m->materials[i].law;
    snprintf(path, sizeof path, "materials.%s.law", c->materials[i].name);
    if (reduced && !law->reduce) {
      diag_error(diag, path, "the law %s of '%s' has no strength that could be divided by a factor of safety",
                 law->name, body->name);
      diag_hint(diag, "name the bodies that may fail: analysis: {reduction: {bodies: [...]}}");
    }
    snprintf(path, sizeof path, "bodies[%d].material", (int)b);
    if (!reduced && material_is_reduced(m, i))
      diag_error(diag, path, "'%s' is to keep its strength, but its material '%s' is that of a body that is reduced",
                 body->name, body->material);
  }
}

/* Measured (docs/theory.md): the first slope of cases/factor-of-safety stands with 1.5 and more. */
static void warn_of_locking(const Model *m, Diag *diag)
{
  if (m->formulation->pressure || m->formulation->cells) return;
  diag_warning(diag, "formulation",
               "with displacements as the only unknowns what yields without a change of volume locks: the factor of "
               "safety comes out too large, or nothing fails at all");
  diag_hint(diag, "%s",
            m->method->takes_pressure ? "`formulation: mixed` does not lock; it is the default of factor-of-safety"
                                      : "mpm and fem take `formulation: mixed`, which does not lock");
}

void strength_start(Model *m, Diag *diag)
{
  m->strength = (Strength){.factor = 1, .lower = NAN, .upper = NAN, .value = NAN};
  if (m->c->analysis.type != ANALYSIS_FACTOR) return;
  warn_of_locking(m, diag);
  const PetscInt before = diag_errors(diag);
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) check_body(m, b, diag);
  if (diag_errors(diag) == before) strength_set(m, 0);
}

PetscErrorCode LargestIncrement(const Model *m, PetscReal *largest)
{
  PetscReal local = 0;

  PetscFunctionBeginUser;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    PetscReal square = 0;
    if (m->system->row[node] < 0) continue;
    for (PetscInt d = 0; d < m->dim; ++d) square += PetscSqr(m->nodes->du[node * m->dim + d]);
    local = PetscMax(local, square);
  }
  PetscCall(MPIU_Allreduce(&local, largest, 1, MPIU_REAL, MPIU_MAX, m->comm));
  *largest = PetscSqrtReal(*largest);
  PetscFunctionReturn(0);
}

PetscErrorCode StrengthJudge(Model *m, StepReport *report)
{
  PetscReal moved;

  PetscFunctionBeginUser;
  if (!m->strength.trying) PetscFunctionReturn(0);
  PetscCall(LargestIncrement(m, &moved));
  if (moved <= m->strength.reach) PetscFunctionReturn(0);
  snprintf(report->leap, sizeof report->leap, "it slides: %.3g m, for %.3g m that what stands moves at most",
           (double)moved, (double)m->strength.reach);
  report->newton.converged = PETSC_FALSE;
  report->newton.reason = report->leap;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelTryFactor(Model *m, PetscReal factor, StepReport *report, PetscReal *moved)
{
  const PetscReal stable = m->strength.factor;
  const StepControl control = m->control;
  const PetscInt cuts = m->cuts;

  PetscFunctionBeginUser;
  strength_set(m, factor);
  m->strength.trying = PETSC_TRUE;
  m->control.next = factor - stable;
  PetscCall(ModelStep(m, factor - stable, report));
  m->strength.trying = PETSC_FALSE;
  m->control = control;
  m->cuts = cuts;
  PetscCall(LargestIncrement(m, moved));
  if (report->outcome != STEP_ACCEPTED) strength_set(m, stable);
  PetscFunctionReturn(0);
}
