/* Grains that bear, and are farther apart by their law than by their places, since what has opened and closed again is
 * forgotten, or than they were at the start (docs/theory.md, "The room that points have"). */
#include <math.h>
#include "run/report/warn/warn.h"

#define TOO_SMALL 0.05 /* stress, of what it is */
#define SWOLLEN 1.5    /* volume of what bears, of that at the start: heaps of sand that forgets have 1.1 to 1.3 */

/* Of points under pressure, by what they bear: all, what of it Cauchy's stress tau / J leaves out where J is more than
 * the room that they have, 1 / density, and ln J. */
typedef struct {
  PetscReal all, out, swollen;
} Apart;

static void add(const Model *m, const PetscReal *density, Apart *sum)
{
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal J = m->points->real[POINT_J][p];
    PetscReal tau[6];
    if (!m->materials[m->points->material[p]].law->yields) continue;
    point_tau(m->points, p, tau);
    const PetscReal pressure = PetscMax(0, -(tau[0] + tau[1] + tau[2]) / 3);
    const PetscReal bears = pressure * m->points->real[POINT_VOLUME][p] * density[p];
    sum->all += bears;
    sum->out += bears * PetscMax(0, 1 - 1 / (J * density[p]));
    sum->swollen += bears * log(J);
  }
}

/* What helps, of a run that has no `room`. */
static const char forgets[] =
  "what has opened and closed again is forgotten: `stabilisation: {room: true}`, with `opening_memory: 1` of law "
  "mohr-coulomb, has volumes and stresses right (docs/guide/limits.md)";

static void tell(const Model *m, const Apart *sum, Diag *diag)
{
  const PetscBool swollen = (PetscBool)(sum->swollen > log(SWOLLEN) * sum->all);
  const PetscBool small = (PetscBool)(sum->out > TOO_SMALL * sum->all);
  if (swollen)
    diag_warning(diag, NULL, "what has flowed is swollen: what bears counts as %.2g times its volume at the start",
                 (double)exp(sum->swollen / sum->all));
  if (small)
    diag_warning(
      diag, NULL,
      "stresses of what has flowed are too small, by %.2g %% in the mean: by its law it fills more room than "
      "there is around its points",
      (double)(100 * sum->out / sum->all));
  if (!swollen && !small) return;
  if (!m->c->stabilisation.room) diag_hint(diag, forgets);
  else if (swollen)
    diag_hint(diag,
              "a law that forgets what has opened, or dilates for ever, makes it: "
              "`opening_memory: 1` of law mohr-coulomb, a smaller `dilatancy_angle`");
  else diag_hint(diag, "more points a cell, or displacements with `basis: gimp`, lessen it (docs/guide/limits.md)");
}

PetscErrorCode WarnOfApart(Model *m, Diag *diag)
{
  Apart local = {0, 0, 0}, sum;
  PetscReal *density;

  PetscFunctionBeginUser;
  if (!m->method->restores_grid || !materials_yield(m->c->n_materials, m->materials)) PetscFunctionReturn(0);
  PetscCall(ModelInitialise(m));
  PetscCall(PetscMalloc1(m->points->n, &density));
  PetscCall(DiscretisationDensities(m->space, NULL, density));
  add(m, density, &local);
  PetscCall(PetscFree(density));
  PetscCall(MPIU_Allreduce(&local, &sum, 3, MPIU_REAL, MPI_SUM, m->comm));
  tell(m, &sum, diag);
  PetscFunctionReturn(0);
}
