/* Circular cones in plane strain: one that meets Mohr-Coulomb's pyramid in triaxial tests bears much more there, or
 * less (docs/theory.md, "Laws"). */
#include "material/strength.h"
#include "model/model_private.h"

#define ALLOWED 0.05 /* of the strength */
#define DEGREES (180 / PETSC_PI)

/* By how much is a strength more or less than what is given, over it? */
static PetscReal off(PetscReal strength, PetscReal given) { return given > 0 ? PetscAbsReal(strength / given - 1) : 0; }

static void advise_cone(const Material *material, Diag *diag)
{
  const PetscReal *given = material->given;
  PetscReal strength[2];
  char path[256];
  material->law->in_plane(given, strength);
  const PetscReal friction = off(tan(strength[0]), tan(given[FRICTION])), cohesion = off(strength[1], given[COHESION]);
  if (PetscMax(friction, cohesion) <= ALLOWED) return;
  PetscSNPrintf(path, sizeof path, "materials.%s.law", material->name);
  if (strength[0] * DEGREES > 90 - 1e-6)
    diag_warning(
      diag, path,
      "in plane strain '%s' bears any load: the circular cone has the strength that is given, friction_angle "
      "%.4g and cohesion %.4g Pa, in triaxial tests alone",
      material->name, (double)(given[FRICTION] * DEGREES), (double)given[COHESION]);
  else
    diag_warning(diag, path,
                 "in plane strain '%s' is as strong as friction_angle %.4g and cohesion %.4g Pa: the circular cone has "
                 "the strength that is given, %.4g and %.4g Pa, in triaxial tests alone",
                 material->name, (double)(strength[0] * DEGREES), (double)strength[1],
                 (double)(given[FRICTION] * DEGREES), (double)given[COHESION]);
  diag_hint(diag, "`match: plane-strain` has it in plane strain");
}

void advise_cones(const Model *m, Diag *diag)
{
  for (PetscInt i = 0; kinematics_is_plane(m->c->kinematics) && i < m->c->n_materials; ++i)
    if (m->materials[i].law->in_plane) advise_cone(m->materials + i, diag);
}
