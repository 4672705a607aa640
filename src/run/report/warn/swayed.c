/* Stress that makes bodies stiffer or softer as they bend and sway, and points that lose that (docs/theory.md, section
 * 97). */
#include "run/report/warn/warn.h"

/* over the stiffness: displacements and frequencies of columns, strings and surfaces are off by about half of it */
#define SWAY_ALLOWED 0.1
/* A body sways along an axis where its spin, squared, is so many times its strain, and where the work of its stress is
 * at least this share of all but what is alike everywhere: a column under a load is strained far more along it. */
#define SPIN_LEAST 10
#define WORK_LEAST 0.1

/* Does the boundary alone hold what sways? Else a turn of all of it does no harm. */
static PetscBool is_held(const Model *m) { return (PetscBool)(m->c->n_boundary > 0 && !m->contact); }

static PetscReal share_of(const Model *m)
{
  const Sway *s = &m->sway;
  PetscReal share = PetscMin(s->lost / s->strained, s->lost_apart / s->strained_apart);
  for (int j = 0; is_held(m) && j < 3; ++j)
    if (s->along[j].spin > SPIN_LEAST * s->along[j].strain && s->along[j].work > WORK_LEAST * s->strained_apart)
      share = PetscMax(share, s->along[j].lost / s->along[j].work);
  return share;
}

void warn_of_sway(const Model *m, Diag *diag)
{
  const PetscReal least = m->sway.steps * m->least_energy;
  if (!(m->sway.strained > least && m->sway.strained_apart > least)) return;
  const PetscReal share = share_of(m);
  if (!(share > SWAY_ALLOWED)) return;
  diag_warning(diag, "basis",
               "the stress that bodies bear is %.2g %% of their stiffness where they bend or sway, and points without "
               "an extent lose that from step to step: displacements may be off by about half as much",
               (double)(100 * share));
  diag_hint(diag, "%s%s (docs/guide/limits.md)",
            m->grid->box ? "`basis: {gimp: {}}` on quadrilaterals or hexahedra, or `method: fem`" : "`method: fem`",
            m->scheme->inertia ? "" : "; in statics fewer, longer steps lessen it");
}
