/* Another material at a point that is there. */
#include "model/stage/stage_private.h"
#include "model/start/initial_stress.h"

PetscBool material_as_stiff(const Material *a, const Material *b)
{
  return a->law == b->law && a->elastic.bulk == b->elastic.bulk && a->elastic.shear == b->elastic.shear;
}

/* Numbers of history that both laws know by the same name. The volume that bears a stress is none: with other elastic
 * constants it is another. */
static void keep_history(const Law *was, const PetscReal *before, const Law *is, PetscReal *state)
{
  for (const LawField *f = is->fields; f->name; state += f++->components) {
    const PetscReal *old = before;
    if (is->of_stress && !strcmp(f->name, is->of_stress)) continue;
    for (const LawField *g = was->fields; g->name; old += g++->components)
      if (f->components == 1 && g->components == 1 && !strcmp(f->name, g->name)) *state = *old;
  }
}

PetscBool point_swap(Points *points, PetscInt p, const Material *was, const Material *is)
{
  PetscReal *J = points->real[POINT_J] + p, *volume = points->real[POINT_VOLUME] + p;
  PetscReal before[LAW_MAX_STATE], F[9], tau[6], sigma[6];
  const PetscReal J_was = *J;
  PetscReal *state = point_real(points, POINT_STATE, p);
  point_tau(points, p, tau);
  for (PetscInt i = 0; i < points->components[POINT_F]; ++i) F[i] = point_real(points, POINT_F, p)[i];
  for (int k = 0; k < 6; ++k) sigma[k] = tau[k] / J_was;
  for (PetscInt i = 0; i < LAW_MAX_STATE; ++i) before[i] = i < was->law->n_state ? state[i] : 0;
  *volume *= J_was;
  *J = 1;
  law_initial_state(is->law, state);
  if (stress_point(points, p, is, sigma) == STRESS_REFUSED) return PETSC_FALSE;
  keep_history(was->law, before, is->law, state);
  const PetscReal stretch = PetscPowReal(*J / J_was, 1.0 / 3.0);
  for (PetscInt i = 0; i < points->components[POINT_F]; ++i) point_real(points, POINT_F, p)[i] = stretch * F[i];
  point_lengthen(points, p, PetscPowReal(J_was, 1.0 / 3.0)); /* the new stress has taken out its own J alone */
  return PETSC_TRUE;
}
