#include "run/report/price.h"
#include <math.h>
#include "model/explicit/critical.h"

/* Does matter flow whose strength is its pressure? Whatever opens and closes costs iterations, the more the stiffer it
 * is. */
static PetscBool has_grains(const Model *m)
{
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if (m->materials[i].law->yields && !m->materials[i].law->symmetric) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Substeps that cost as much as an implicit step of the same model, whichever of both the case has, in which there are
 * n of them (docs/decisions.md [371]). */
static PetscReal substeps_of_a_step(const Model *m, PetscReal n)
{
  /* in the plane, in space; linear functions and gimp by arithmetic, what takes its functions from nodes */
  static const PetscReal elastic[2][3] = {{15, 12, 5}, {20, 8, 10}}, grains[2][3] = {{10, 6, 4}, {20, 12, 30}};
  const int space = m->dim == 3, functions = !explicit_by_arithmetic(m) ? 2 : m->space->basis->domains ? 1 : 0;
  return has_grains(m) ? grains[space][functions] * (1 + n / 8) : elastic[space][functions];
}

/* Known to a factor of two: how many iterations a step takes only its run knows. */
static const char *price_of(PetscReal share)
{
  return share > 2 ? "dearer than" : share < 0.5 ? "cheaper than" : "about as dear as";
}

PetscErrorCode PriceTell(const Model *m, size_t size, char *told)
{
  const PetscBool explicit = m->c->analysis.type == ANALYSIS_EXPLICIT;
  PetscReal critical, crossing, fastest;

  PetscFunctionBeginUser;
  told[0] = 0;
  if (!m->scheme->inertia || !m->method->restores_grid || m->formulation->pressure) PetscFunctionReturn(0);
  PetscCall(ExplicitCritical(m, &critical, &crossing, &fastest));
  const PetscReal substep = case_courant(&m->c->analysis) * critical, n = PetscCeilReal(m->control.next / substep);
  const PetscReal share = n / substeps_of_a_step(m, n);
  snprintf(told, size, "%.3g s a substep, %.0f %s in a step of %g s: %s an implicit step (about %.2g of it)",
           (double)substep, (double)n, explicit ? "of them" : "with `type: explicit`", (double)m->control.next,
           price_of(share), (double)share);
  PetscFunctionReturn(0);
}
