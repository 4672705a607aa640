/* Walls with mass in the accounts of a model. */
#include "model/model_private.h"

static PetscInt count(const Model *m) { return m->contact ? m->contact->n_rigid : 0; }

/* Of one that is there, and not to come with a later stage; told where the wall gets its mass, since what asks may
 * stand nowhere in the file. */
static void refuse(const Model *m, const char *what, const char *instead, Diag *diag)
{
  char path[64];
  for (PetscInt k = 0; k < count(m); ++k) {
    const WallSpec *wall = &m->c->walls[m->contact->rigid[k].wall];
    if (wall->absent) continue;
    snprintf(path, sizeof path, "walls[%d].mass", (int)m->contact->rigid[k].wall);
    diag_error(diag, path, "%s knows nothing of walls with mass, as '%s' is", what, wall->name);
    diag_hint(diag, "%s", instead);
    return;
  }
}

void rigid_check(const Model *m, Diag *diag)
{
  if (case_seeks(&m->c->analysis))
    refuse(m, "the search for a factor of safety or a limit load",
           "without `mass` it stands where it is, or moves as `motion` says", diag);
  if (case_equilibrates(m->c))
    refuse(m, "an initial equilibrium",
           "let it come with the next stage (`absent: true` until then), or begin without one: "
           "`initial: {equilibrium: none}`",
           diag);
}

/* Does it stand as the last step ends, or the next one begins? What meets it then sees it, too (wall_near). */
static PetscBool is_there(const Model *m, PetscInt wall)
{
  return (PetscBool)(wall_stands(m->walls, wall, m->time) || wall_comes(m->walls, wall, m->time));
}

/* Of those that are there, or of the others; what stages have left out is neither. */
static PetscReal motion_of(const Model *m, PetscBool there)
{
  PetscReal sum = 0;
  for (PetscInt k = 0; k < count(m) && m->scheme->inertia; ++k) {
    const PetscInt wall = m->contact->rigid[k].wall;
    if (!m->c->walls[wall].absent && is_there(m, wall) == there) sum += rigid_kinetic(m->contact->rigid + k);
  }
  return sum;
}

PetscReal rigid_motion(const Model *m) { return motion_of(m, PETSC_TRUE); }

PetscReal rigid_away(const Model *m) { return motion_of(m, PETSC_FALSE); }

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

PetscReal rigid_fastest(const Model *m)
{
  PetscReal fastest = 0;
  for (PetscInt k = 0; k < count(m); ++k) {
    const PetscReal *v = m->contact->rigid[k].now.v;
    fastest = PetscMax(fastest, PetscSqrtReal(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  }
  return fastest;
}
