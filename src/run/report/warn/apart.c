/* Grains that bear, and are farther apart by their law than by their places: what has opened and closed again, forgotten
 * (docs/theory.md, "The room that points have"). */
#include <math.h>
#include "run/report/warn/warn.h"

#define TOO_SMALL 0.05 /* stress, of what it is */

/* By the volume that points under pressure bear it in, J: what they bear, and what of it Cauchy's stress tau / J leaves
 * out where J is more than the room that they have, 1 / density. */
static void add(const Model *m, const PetscReal *density, PetscReal sum[2])
{
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal J = m->points->real[POINT_J][p], room = 1 / density[p];
    PetscReal tau[6];
    if (!m->materials[m->points->material[p]].law->yields) continue;
    point_tau(m->points, p, tau);
    const PetscReal bears = PetscMax(0, -(tau[0] + tau[1] + tau[2]) / 3) * m->points->real[POINT_VOLUME][p];
    sum[0] += bears / room;
    sum[1] += bears * PetscMax(0, 1 / room - 1 / J);
  }
}

PetscErrorCode WarnOfApart(Model *m, Diag *diag)
{
  PetscReal local[2] = {0, 0}, sum[2], *density;

  PetscFunctionBeginUser;
  if (!m->method->restores_grid || !materials_yield(m->c->n_materials, m->materials)) PetscFunctionReturn(0);
  PetscCall(ModelInitialise(m));
  PetscCall(PetscMalloc1(m->points->n, &density));
  PetscCall(DiscretisationDensities(m->space, NULL, density));
  add(m, density, local);
  PetscCall(PetscFree(density));
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  if (!(sum[1] > TOO_SMALL * sum[0])) PetscFunctionReturn(0);
  diag_warning(
    diag, NULL,
    "stresses of what has flowed are too small, by %.2g %% in the mean: by its law it fills more room than there "
    "is around its points",
    (double)(100 * sum[1] / sum[0]));
  diag_hint(
    diag, "%s (docs/guide/limits.md)",
    m->c->stabilisation.room
      ? "more points a cell, or displacements with `basis: gimp`, lessen it"
      : "what has opened and closed again is forgotten: `stabilisation: {room: true}`, with `opening_memory: 1` of "
        "law mohr-coulomb, has volumes and stresses right");
  PetscFunctionReturn(0);
}
