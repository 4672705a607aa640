/* Walls with mass in the accounts of a model. */
#include "model/model_private.h"

static PetscInt count(const Model *m) { return m->contact ? m->contact->n_rigid : 0; }

static void refuse(const Model *m, const char *key, const char *what, Diag *diag)
{
  diag_error(diag, key, "%s knows nothing of walls with mass, as '%s' is", what,
             m->c->walls[m->contact->rigid[0].wall].name);
}

void rigid_check(const Model *m, Diag *diag)
{
  if (!count(m)) return;
  if (case_seeks(&m->c->analysis)) refuse(m, "analysis", "the search for a factor of safety or a limit load", diag);
  if (m->c->initial.equilibrium > EQUILIBRIUM_NONE) refuse(m, "initial", "an initial equilibrium", diag);
}

PetscReal rigid_motion(const Model *m)
{
  PetscReal sum = 0;
  for (PetscInt k = 0; k < count(m); ++k) sum += m->scheme->inertia ? rigid_kinetic(m->contact->rigid + k) : 0;
  return sum;
}

PetscReal rigid_work(const Model *m)
{
  PetscReal sum = 0;
  for (PetscInt k = 0; k < count(m); ++k) sum += m->contact->rigid[k].now.work;
  return sum;
}

PetscReal rigid_lost(const Model *m)
{
  PetscReal sum = 0;
  for (PetscInt k = 0; k < count(m); ++k) sum += m->contact->rigid[k].lost;
  return sum;
}

void rigid_back(Model *m)
{
  for (PetscInt k = 0; k < count(m); ++k) rigid_restore(m->contact->rigid + k, m->walls);
}

PetscReal rigid_halt(Model *m, const Case *from)
{
  PetscReal taken = 0;
  for (PetscInt k = 0; k < count(m); ++k) {
    if (!wall_stood(&m->c->walls[m->contact->rigid[k].wall], m->c, from)) continue;
    taken += rigid_kinetic(m->contact->rigid + k);
    rigid_stop(m->contact->rigid + k);
  }
  return taken;
}

PetscReal rigid_fastest(const Model *m)
{
  PetscReal fastest = 0;
  for (PetscInt k = 0; k < count(m); ++k) {
    const PetscReal *v = m->contact->rigid[k].now.v;
    fastest = PetscMax(fastest, PetscSqrtReal(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  }
  return fastest;
}
