/* How much of a point lies in a shape.
 *
 * A point that counts by its position alone enters at once with all its mass: a flow through a plane
 * then comes in portions, one or several for each row of points. So its domain is sampled: a square or cube
 * of its volume, along the axes. Samples stand on a lattice (Korobov's) on which no two share a
 * coordinate, so that an edge along an axis passes them one by one. */
#include "model/measure/measure.h"

#define SAMPLES 31

/* Places of the samples along each axis, in SAMPLESths. */
static const PetscInt multiplier[3] = {1, 12, 20};

static PetscReal domain_side(const Model *m, PetscInt p, const PetscReal *x)
{
  const PetscReal volume = measure_solid_volume(m, p);
  return m->dim == 3 ? PetscCbrtReal(volume)
                     : PetscSqrtReal(volume / PetscMax(kinematics_weight(m->c->kinematics, x[0]), PETSC_SMALL));
}

PetscReal measure_share_in(const Model *m, const Shape *shape, PetscInt p)
{
  const PetscReal *x = point_real(m->points, POINT_X, p), side = domain_side(m, p, x);
  const PetscReal reach = 0.5 * side * PetscSqrtReal((PetscReal)m->dim);
  PetscInt hits = 0;
  if (!shape_contains(shape, m->dim, x, reach)) return 0;
  if (shape_contains(shape, m->dim, x, -reach)) return 1;
  for (PetscInt k = 0; k < SAMPLES; ++k) {
    PetscReal at[3] = {0};
    for (PetscInt d = 0; d < m->dim; ++d)
      at[d] = x[d] + side * (((PetscReal)(k * multiplier[d] % SAMPLES) + 0.5) / SAMPLES - 0.5);
    if (m->c->kinematics->hoop) at[0] = PetscAbsReal(at[0]);
    hits += shape_contains(shape, m->dim, at, 0);
  }
  return (PetscReal)hits / SAMPLES;
}
