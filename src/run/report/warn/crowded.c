/* Points that have come together, so that the material fills less room than it has. */
#include "run/report/warn/warn.h"

/* share of the volume: 0.01 to 0.045 in columns, heaps and drums whose heights are right */
#define CROWD_ALLOWED 0.05

/* Volume that the points ask for, and what of it there is no room for, m3. */
static PetscErrorCode AddCrowd(Model *m, PetscReal sum[2])
{
  const Points *points = m->points;
  PetscReal *density;

  PetscFunctionBeginUser;
  PetscCall(ModelInitialise(m));
  PetscCall(PetscMalloc1(points->n, &density));
  PetscCall(DiscretisationCrowding(m->space, density));
  for (PetscInt p = 0; p < points->n; ++p) {
    const PetscReal asked = point_asks(points, p) * points->real[POINT_VOLUME][p];
    sum[0] += asked;
    sum[1] += asked * PetscMax(0, 1 - 1 / density[p]);
  }
  PetscCall(PetscFree(density));
  PetscFunctionReturn(0);
}

/* Points have no size of their own: where flow brings them together the material fills less room than its
 * laws believe, and nothing else tells. */
PetscErrorCode WarnOfCrowd(Model *m, Diag *diag)
{
  PetscReal local[2] = {0, 0}, sum[2];

  PetscFunctionBeginUser;
  if (!m->method->restores_grid) PetscFunctionReturn(0);
  PetscCall(AddCrowd(m, local));
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  if (!(sum[1] > CROWD_ALLOWED * sum[0])) PetscFunctionReturn(0);
  diag_warning(diag, NULL, "points have come together: %.2g %% of the material's volume is more than its cells hold",
               (double)(100 * sum[1] / sum[0]));
  diag_hint(
    diag,
    "heights, densities and stresses are no longer those of the material: %sdisplacements with `basis: gimp` and "
    "nine points a cell, or `{split: ..}`, lessen it most, finer cells do not (docs/guide/limits.md)",
    m->c->stabilisation.room ? "" : "`stabilisation: {room: true}` presses apart what flows; ");
  PetscFunctionReturn(0);
}
