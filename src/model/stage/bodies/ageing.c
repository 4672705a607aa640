/* Materials whose constants change with time (docs/theory.md, "Materials that change with time"). */
#include "model/stage/stage_private.h"

PetscErrorCode MaterialsAt(Model *m, PetscReal t)
{
  Diag *unheard;
  Material then;
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (m->initial.seeking) PetscFunctionReturn(0); /* time stands still, and nothing yields there for a while */
  PetscCall(DiagCreate(&unheard));
  for (PetscInt i = 0; i < m->c->n_materials; ++i) {
    if (!m->c->materials[i].n_amplitudes) continue;
    any = PETSC_TRUE;
    PetscCall(MaterialAt(m->c, i, t, unheard, &then));
    material_take_strength(&m->materials[i], &then);
  }
  PetscCall(DiagDestroy(&unheard));
  if (any && m->strength.factor != 1) strength_set(m, m->strength.factor);
  PetscFunctionReturn(0);
}

PetscErrorCode MaterialsBack(Model *m)
{
  Diag *unheard;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&unheard));
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if (m->c->materials[i].n_amplitudes) PetscCall(MaterialAt(m->c, i, m->time, unheard, &m->materials[i]));
  PetscCall(DiagDestroy(&unheard));
  if (m->strength.factor != 1) strength_set(m, m->strength.factor);
  PetscFunctionReturn(0);
}

/* Points of material i, which was another one; *motion: their kinetic energy is more by that. *lost: a point
 * whose stress the law cannot carry. */
static void settle_points(Model *m, PetscInt i, const Material *was, PetscReal *motion, PetscInt *lost)
{
  const Material *is = &m->materials[i];
  const PetscBool stiff = material_as_stiff(was, is);
  const PetscReal ratio = is->density / was->density;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *v = point_real(m->points, POINT_V, p);
    PetscReal *mass = &m->points->real[POINT_MASS][p], square = 0;
    if (m->points->material[p] != i) continue;
    if (!stiff && !point_swap(m->points, p, was, is)) *lost = p;
    if (!stiff) energy_stress(m, p);
    for (PetscInt d = 0; d < m->dim; ++d) square += v[d] * v[d];
    *motion += 0.5 * *mass * (ratio - 1) * square;
    *mass *= ratio;
  }
}

static PetscErrorCode GiveUp(const Model *m, PetscInt lost, StepReport *report)
{
  PetscInt any;

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(&lost, &any, 1, MPIU_INT, MPI_MAX, m->comm));
  if (any < 0) PetscFunctionReturn(0);
  report->outcome = STEP_TOO_SMALL;
  snprintf(report->reason, sizeof report->reason,
           "elastic constants have changed so that a law has no state any more for the stress that a point has");
  PetscFunctionReturn(0);
}

PetscErrorCode MaterialsSettle(Model *m, StepReport *report)
{
  PetscInt lost = -1, changing = 0;
  PetscReal motion = 0, all;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->c->n_materials; ++i) changing += m->c->materials[i].n_amplitudes;
  if (!changing || m->initial.seeking) PetscFunctionReturn(0);
  Material *was;
  PetscCall(PetscMalloc1(m->c->n_materials, &was));
  PetscCall(PetscArraycpy(was, m->materials, m->c->n_materials));
  PetscCall(MaterialsBack(m));
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if (was[i].density != m->materials[i].density || !material_as_stiff(&was[i], &m->materials[i]))
      settle_points(m, i, &was[i], &motion, &lost);
  PetscCall(PetscFree(was));
  PetscCall(MPIU_Allreduce(&motion, &all, 1, MPIU_REAL, MPI_SUM, m->comm));
  m->start_energy += all;
  PetscCall(GiveUp(m, lost, report));
  PetscFunctionReturn(0);
}
