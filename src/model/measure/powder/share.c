/* How much of a point lies in a shape.
 *
 * A point that counts by its position alone enters at once with all its mass: a flow through a plane
 * then comes in portions, one or several for each row of points. So its domain is sampled: a square or cube
 * of its volume, along the axes. Samples stand on a lattice (Korobov's) on which no two share a
 * coordinate, so that an edge along an axis passes them one by one, and on its images in mirrors, so that
 * what is seen in a mirror is the same. */
#include "model/measure/measure.h"

#define SAMPLES 31

/* Places of the samples along each axis, in SAMPLESths from the middle: the opposite of one is another. */
static const PetscInt multiplier[2][3] = {{1, 12, 0}, {1, 5, 25}};

static PetscReal domain_side(const Model *m, PetscInt p)
{
  return m->dim == 3 ? PetscCbrtReal(measure_solid_volume(m, p)) : PetscSqrtReal(measure_solid_area(m, p));
}

/* Sample k of an image: bit 0 changes x and y, the others mirror all axes but the last. */
static void sample_at(PetscInt dim, PetscInt k, PetscInt image, PetscReal offset[3])
{
  for (PetscInt d = 0; d < dim; ++d) {
    const PetscInt axis = d < 2 && image % 2 ? 1 - d : d;
    const PetscInt place = (multiplier[dim - 2][d] * (k + 1) + SAMPLES / 2) % SAMPLES - SAMPLES / 2;
    offset[axis] = (d + 1 < dim && image >> (d + 1) & 1 ? -1 : 1) * (PetscReal)place / SAMPLES;
  }
}

PetscReal measure_share_in(const Model *m, const Shape *shape, PetscInt p)
{
  const PetscReal *x = point_real(m->points, POINT_X, p), side = domain_side(m, p);
  const PetscReal reach = 0.5 * side * PetscSqrtReal((PetscReal)m->dim);
  const PetscInt images = 1 << m->dim;
  PetscInt hits = 0;
  if (!shape_contains(shape, m->dim, x, reach)) return 0;
  if (shape_contains(shape, m->dim, x, -reach)) return 1;
  for (PetscInt k = 0; k < SAMPLES * images; ++k) {
    PetscReal at[3] = {0}, offset[3] = {0};
    sample_at(m->dim, k % SAMPLES, k / SAMPLES, offset);
    for (PetscInt d = 0; d < m->dim; ++d) at[d] = x[d] + side * offset[d];
    if (m->c->kinematics->hoop) at[0] = PetscAbsReal(at[0]);
    hits += shape_contains(shape, m->dim, at, 0);
  }
  return (PetscReal)hits / (PetscReal)(SAMPLES * images);
}
