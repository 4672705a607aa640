/* How deep points stand below the surface of a body that cuts their cells. */
#include "points/seed/seed.h"

#define AHEAD 0.1 /* of the side of a point's part: so far a surface is looked for in front of it */
#define HALVINGS 40
#define FLUSH 1e-6 /* of the side of a point's part: the surface is there */

/* From a place in the body to where it ends along a unit vector, and bodies that it sticks to do; `most` at most. */
static PetscReal way_out(const Seeding *s, const PetscReal *position, const PetscReal *along, PetscReal most)
{
  PetscReal low = 0, high = most, at[3] = {0};
  for (int k = 0; k <= HALVINGS; ++k) {
    const PetscReal middle = k ? 0.5 * (low + high) : most;
    for (PetscInt d = 0; d < s->source->dim; ++d) at[d] = position[d] + middle * along[d];
    if (seed_is_inside(s, at)) low = middle;
    else high = middle;
  }
  return low;
}

/* Is what is nearest of the shape's surface, at this depth, where the body sticks to another one? */
static PetscBool is_nearest_to_seam(const Seeding *s, const PetscReal *position, PetscReal depth, PetscReal side)
{
  const PetscInt dim = s->source->dim;
  PetscReal out[3] = {0}, at[3] = {0}, square = 0;
  if (!s->n_mates || depth >= side) return PETSC_FALSE;
  for (PetscInt d = 0; d < dim; ++d) at[d] = position[d];
  for (PetscInt d = 0; d < dim; ++d) {
    at[d] = position[d] + 0.5 * depth;
    out[d] = depth - shape_depth(&s->body->shape, dim, at, side);
    at[d] = position[d];
    square += out[d] * out[d];
  }
  for (PetscInt d = 0; d < dim && square > 0; ++d)
    at[d] += (depth + SEED_BEYOND * side) * out[d] / PetscSqrtReal(square);
  return (PetscBool)(square > 0 && seed_is_held(s, at));
}

/* How deep a place is below the surface, as far as that is no seam; face: the surface that its part was given. */
static PetscReal depth_below(const Seeding *s, const PetscReal *face, const PetscReal *position, PetscReal side)
{
  const PetscInt dim = s->source->dim;
  const PetscReal depth = shape_depth(&s->body->shape, dim, position, side);
  PetscReal along[3], square = 0;
  for (PetscInt d = 0; d < dim; ++d) square += face[d] * face[d];
  if (!is_nearest_to_seam(s, position, depth, side)) return depth;
  if (square == 0) return side;
  for (PetscInt d = 0; d < dim; ++d) along[d] = face[d] / PetscSqrtReal(square);
  return way_out(s, position, along, side);
}

PetscReal seed_depth(const Seeding *s, const SeedPart *part, const PetscReal *position, PetscReal usual, PetscReal side)
{
  const PetscInt dim = s->source->dim;
  const PetscReal depth = depth_below(s, part->face, position, side);
  PetscReal square = 0, ahead[3];
  for (PetscInt d = 0; d < dim; ++d) square += part->face[d] * part->face[d];
  if (part->whole && PetscAbsReal(depth - side / 2) < FLUSH * side) return depth;
  if (depth <= usual || square == 0) return PetscMin(depth, usual);
  for (PetscInt d = 0; d < dim; ++d) ahead[d] = position[d] + AHEAD * side * part->face[d] / PetscSqrtReal(square);
  const PetscReal nearer = depth - depth_below(s, part->face, ahead, side);
  return nearer > 0.5 * AHEAD * side ? depth : usual;
}
