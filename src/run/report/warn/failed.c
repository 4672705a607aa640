/* Statics that went on behind a limit load. */
#include "run/report/warn/warn.h"

/* Plastic flow that took so many times what is stored is no settling, but something that has failed. */
#define FAILED 100

/* Does a law get stronger as it flows, so that it may flow on and on? */
static PetscBool grows_stronger(const Model *m)
{
  PetscReal yield, slope = 0;
  for (PetscInt i = 0; i < m->c->n_materials && slope <= 0; ++i)
    if (m->materials[i].law->hardens) m->materials[i].law->hardens(m->materials[i].parameters, &yield, &slope);
  return (PetscBool)(slope > 0);
}

/* Statics have an equilibrium behind a limit load where what fails stiffens by its change of shape, as a cut that leans
 * on its own foot: nothing else tells that it has failed. What is pushed by its boundary is meant to. */
PetscErrorCode WarnOfFailed(Model *m, Diag *diag)
{
  Energies e;

  PetscFunctionBeginUser;
  if (m->c->analysis.type != ANALYSIS_STATIC || !specs_yield(m->c->n_materials, m->c->materials))
    PetscFunctionReturn(0);
  if (!PetscIsNanReal(m->raised.value) || grows_stronger(m)) PetscFunctionReturn(0);
  PetscCall(ModelEnergies(m, &e));
  const PetscBool pushed = (PetscBool)(PetscAbsReal(e.boundary) > 0.01 * PetscAbsReal(e.external));
  if (pushed || e.elastic <= 0 || e.dissipated <= FAILED * e.elastic) PetscFunctionReturn(0);
  diag_warning(
    diag, NULL,
    "plastic flow took %.0f times what is stored: something has failed on the way, and stands only by how far "
    "it went",
    (double)(e.dissipated / e.elastic));
  diag_hint(diag,
            "the load at which it fails is found by `analysis: {type: limit-load}`, and how far a slope is from it "
            "by `factor-of-safety`; a fall has inertia (`type: dynamic`)");
  PetscFunctionReturn(0);
}
