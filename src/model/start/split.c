/* Is what is asked of points that are split sensible? */
#include "model/model_private.h"
#include "points/split.h"

#define FINEST 0.2 /* cells: 25 points in a quadrilateral */

PetscErrorCode SplitCheck(const Model *m, Diag *diag)
{
  const PetscReal split = m->c->basis.split;
  PetscReal apart = 0;

  PetscFunctionBeginUser;
  if (split == 0) PetscFunctionReturn(0);
  if (split < FINEST) {
    diag_error(diag, "basis.gimp.split", "points are split at %g cells at the least, or never (0)", FINEST);
    PetscFunctionReturn(0);
  }
  if (m->points->components[POINT_DOMAIN]) apart = points_farthest(m->points, m->grid);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &apart, 1, MPIU_REAL, MPIU_MAX, m->comm));
  if (apart <= split) PetscFunctionReturn(0);
  diag_warning(diag, "basis.gimp.split",
               "points stand %.3g cells apart at the start already: they are split in the first steps", (double)apart);
  diag_hint(diag, "begin with more points_per_cell, or with a larger value");
  PetscFunctionReturn(0);
}
