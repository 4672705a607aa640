/* Clay that is pulled: a law that must begin under pressure knows no tension, and may bear some all the same (modified
 * Cam clay on the dry side of its ellipse, docs/theory.md, "Laws"). */
#include "base/math/eigen.h"
#include "run/report/warn/warn.h"

#define TENSION_ALLOWED 0.01 /* of the largest pressure in such material */

/* Of a material: its mass, and that of it which is pulled, kg; the largest pressure and tension along an axis, Pa. */
typedef struct {
  PetscReal mass, pulled, pressure, tension;
} Pull;

/* Of this rank's points; limit: the tension beyond which they are pulled, Pa. */
static void add(const Model *m, PetscInt material, PetscReal limit, Pull *pull)
{
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal mass = m->points->real[POINT_MASS][p], J = m->points->real[POINT_J][p];
    PetscReal tau[6], principal[3];
    if (m->points->material[p] != material) continue;
    point_tau(m->points, p, tau);
    sym_eigenvalues(tau, principal);
    pull->mass += mass;
    pull->pulled += principal[0] / J > limit ? mass : 0;
    pull->pressure = PetscMax(pull->pressure, -principal[2] / J);
    pull->tension = PetscMax(pull->tension, principal[0] / J);
  }
}

static PetscErrorCode WarnOf(const Model *m, PetscInt material, Diag *diag)
{
  Pull most = {0}, sum = {0};
  char path[256];

  PetscFunctionBeginUser;
  add(m, material, 0, &most);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &most.pressure, 2, MPIU_REAL, MPIU_MAX, m->comm));
  const PetscReal limit = TENSION_ALLOWED * most.pressure;
  if (!(most.tension > limit)) PetscFunctionReturn(0);
  add(m, material, limit, &sum);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &sum.mass, 2, MPIU_REAL, MPIU_SUM, m->comm));
  PetscCall(PetscSNPrintf(path, sizeof path, "materials.%s.law", m->materials[material].name));
  diag_warning(diag, path,
               "%.3g %% of '%s' is pulled at the end, by up to %.3g Pa: soil bears no tension, but its yield surface "
               "does",
               (double)(100 * sum.pulled / sum.mass), m->materials[material].name, (double)most.tension);
  diag_hint(diag, "soil that opens instead is `mohr-coulomb` with `tension_cutoff: 0` (docs/guide/limits.md)");
  PetscFunctionReturn(0);
}

PetscErrorCode WarnOfPull(const Model *m, Diag *diag)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if (m->materials[i].law->needs_stress) PetscCall(WarnOf(m, i, diag));
  PetscFunctionReturn(0);
}
