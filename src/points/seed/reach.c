/* How far a point is from its body's surface, and which part of that it stands for. */
#include "points/seed/seed.h"

#define NEXT 1.5    /* times the distance of the nearest points: layers of a rule are farther apart */
#define WITHIN 1e-3 /* of the cell: so far inside a side the body is asked for */
#define ABOUT 0.1   /* of half a part's side: what measures its sides is off by less */
#define STRAIGHT 1e-3
#define HALVINGS 30
#define HALVINGS_OUT 40
#define AHEAD 0.1  /* of the side of a point's part: so far a surface is looked for in front of it */
#define FLUSH 1e-6 /* of the side of a point's part: the surface is there */
#define ALONG 1e-6 /* cosine between normals of sides: these are not at right angles */
#define BLUNT 0.5  /* likewise: both look at a wall between them */
#define ROUNDS 30  /* each leaves a quarter, at most, of what the one before did */

/* From the line or plane of a side: through its first nodes. */
static PetscReal distance_to_side(const Cell *cell, PetscInt side, const PetscReal *x, const PetscReal *position)
{
  const PetscInt dim = cell->dim;
  const PetscReal *a = x + cell->face[side][0] * dim, *b = x + cell->face[side][1] * dim;
  const PetscReal *c = x + cell->face[side][dim - 1] * dim;
  PetscReal e[3] = {0, 0, 0}, f[3] = {0, 0, 1}, r[3] = {0, 0, 0}, normal[3], along = 0, square = 0;
  for (PetscInt d = 0; d < dim; ++d) e[d] = b[d] - a[d], r[d] = position[d] - a[d];
  for (PetscInt d = 0; d < dim && dim == 3; ++d) f[d] = c[d] - a[d];
  for (int d = 0; d < 3; ++d) normal[d] = e[(d + 1) % 3] * f[(d + 2) % 3] - e[(d + 2) % 3] * f[(d + 1) % 3];
  for (int d = 0; d < 3; ++d) along += normal[d] * r[d], square += normal[d] * normal[d];
  return PetscAbsReal(along) / PetscSqrtReal(square);
}

/* Is the q-th point of the rule in the layer of its cell that is next to this side? */
static PetscBool is_next_to(const Cell *cell, PetscInt side, const SeedRule *rule, PetscInt q)
{
  PetscReal x[CELL_MAX_NODES * 3], nearest = PETSC_MAX_REAL;
  for (PetscInt i = 0; i < cell->nodes; ++i)
    for (PetscInt d = 0; d < cell->dim; ++d) x[i * cell->dim + d] = cell->reference[i][d];
  for (PetscInt p = 0; p < rule->n; ++p)
    nearest = PetscMin(nearest, distance_to_side(cell, side, x, rule->xi + p * cell->dim));
  return distance_to_side(cell, side, x, rule->xi + q * cell->dim) < NEXT * nearest;
}

/* The narrowest way through the part of a cell that one of its points stands for. */
static PetscReal narrowest(const Cell *cell, const PetscReal *x, const SeedRule *rule)
{
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt side = 0; side < cell->faces; ++side) {
    PetscReal most = 0;
    for (PetscInt i = 0; i < cell->nodes; ++i)
      most = PetscMax(most, distance_to_side(cell, side, x, x + i * cell->dim));
    least = PetscMin(least, most);
  }
  return least / (PetscReal)rule->side;
}

PetscReal seed_reach(CellType type, const PetscReal *x, const PetscReal *position, PetscReal section,
                     const SeedRule *rule, PetscInt q, const unsigned char *outer)
{
  const Cell *cell = cells + type;
  const PetscReal half = 0.5 * PetscPowReal(section, 1 / (PetscReal)cell->dim);
  const PetscBool simplex = (PetscBool)(cell->nodes == cell->dim + 1);
  PetscReal reach = half, surface = PETSC_MAX_REAL;
  for (PetscInt side = 0; side < cell->faces; ++side) {
    const PetscReal distance = distance_to_side(cell, side, x, position);
    reach = PetscMin(reach, distance);
    if (outer[side] && is_next_to(cell, side, rule, q)) surface = PetscMin(surface, distance);
  }
  if (!simplex && surface < PETSC_MAX_REAL) return PetscMin(surface, narrowest(cell, x, rule));
  return surface < PETSC_MAX_REAL ? surface : reach;
}

/* Sides that are not at right angles, as where a curved surface ends at a plane of symmetry, have no corner that
 * counts: towards a wall between their normals it would be farther ahead than the surface of the points beside is,
 * which know of none, by the angle. The nearest side is what the point's reach is, so the farthest is kept: with the
 * nearest alone a point beside a plane of symmetry that is nearer than the curved surface stood off the wall there, and
 * had none of the force that its stress asks for. */
void seed_corner(CellType type, const PetscReal *x, const PetscReal *position, const SeedRule *rule, PetscInt q,
                 const unsigned char *outer, PetscReal *corner, PetscReal *beside)
{
  const Cell *cell = cells + type;
  PetscReal normal[3][3] = {{0}}, away[3], square, along;
  PetscInt n = 0, farthest = 0;
  PetscBool square_on = PETSC_TRUE;
  for (PetscInt side = 0; side < cell->faces; ++side) {
    if (!outer[side] || !is_next_to(cell, side, rule, q)) continue;
    if (n == cell->dim) return;
    cell_side_area(type, side, x, normal[n]);
    square = 0;
    for (PetscInt d = 0; d < cell->dim; ++d) square += normal[n][d] * normal[n][d];
    for (PetscInt d = 0; d < cell->dim; ++d) normal[n][d] /= PetscSqrtReal(square);
    away[n] = distance_to_side(cell, side, x, position);
    for (PetscInt k = 0; k < n; ++k) {
      along = 0;
      for (PetscInt d = 0; d < cell->dim; ++d) along += normal[n][d] * normal[k][d];
      if (PetscAbsReal(along) > ALONG) square_on = PETSC_FALSE;
    }
    if (away[n] > away[farthest]) farthest = n;
    ++n;
  }
  for (PetscInt d = 0; d < cell->dim; ++d) corner[d] = 0;
  for (PetscInt k = 0; k < n; ++k)
    for (PetscInt d = 0; d < cell->dim && (square_on || k == farthest); ++d) {
      corner[d] += away[k] * normal[k][d];
      if (beside) beside[d] += normal[k][d];
    }
}

PetscBool seed_half_sides(CellType type, const PetscReal *x, PetscReal *half)
{
  const Cell *cell = cells + type;
  if (cell->nodes != 1 << cell->dim) return PETSC_FALSE;
  for (PetscInt d = 0; d < cell->dim; ++d) {
    PetscReal low = x[d], high = x[d];
    for (PetscInt i = 1; i < cell->nodes; ++i)
      low = PetscMin(low, x[i * cell->dim + d]), high = PetscMax(high, x[i * cell->dim + d]);
    half[d] = 0.5 * (high - low);
    for (PetscInt i = 0; i < cell->nodes; ++i)
      if (PetscAbsReal(0.5 * (low + high) + half[d] * cell->reference[i][d] - x[i * cell->dim + d]) > ALONG * half[d])
        return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Does the body, or one that it sticks to, have what is so far from a place along a unit vector? */
static PetscBool has_at(const Seeding *s, const PetscReal *position, const PetscReal *along, PetscReal far)
{
  PetscReal at[3] = {0};
  for (PetscInt d = 0; d < s->source->dim; ++d) at[d] = position[d] + far * along[d];
  return seed_is_inside(s, at);
}

/* Where it ends, between low and high. */
static void halve(const Seeding *s, const PetscReal *position, const PetscReal *along, int times, PetscReal *low,
                  PetscReal *high)
{
  for (int k = 0; k < times; ++k) {
    const PetscReal middle = 0.5 * (*low + *high);
    if (has_at(s, position, along, middle)) *low = middle;
    else *high = middle;
  }
}

/* How far the body goes on from a place along axis d, if it ends at about `away`; 0: it does not end there. */
static PetscReal end_near(const Seeding *s, const PetscReal *position, PetscInt d, PetscReal away)
{
  PetscReal along[3] = {0}, low = (1 - ABOUT) * away, high = (1 + ABOUT) * away;
  along[d] = 1;
  if (!has_at(s, position, along, low) || has_at(s, position, along, high)) return 0;
  halve(s, position, along, HALVINGS, &low, &high);
  return 0.5 * (low + high);
}

/* The same where it ends straight across the axis: beside the place as it does before it. */
static PetscReal straight_end(const Seeding *s, const PetscReal *position, PetscInt d, PetscReal away,
                              const PetscReal *aside)
{
  const PetscReal end = end_near(s, position, d, away);
  PetscReal at[3] = {0};
  for (PetscInt i = 0; i < s->source->dim; ++i) at[i] = position[i];
  for (PetscInt i = 0; i < s->source->dim && end != 0; ++i)
    for (int side = -1; side <= 1 && i != d; side += 2) {
      at[i] = position[i] + 0.5 * side * aside[i];
      if (PetscAbsReal(end_near(s, at, d, away) - end) > STRAIGHT * PetscAbsReal(end)) return 0;
      at[i] = position[i];
    }
  return end;
}

/* Is a place along axis d, `away` from one in a rectangle or brick, beyond a side that is not the body's surface? What
 * the body has there is of other points. */
static PetscBool is_beyond(CellType type, const PetscReal *x, const PetscReal *position, PetscInt d, PetscReal away,
                           const unsigned char *outer)
{
  const PetscInt dim = cells[type].dim, side = seed_side_of(type, d, away > 0);
  const PetscReal end = x[cells[type].face[side][0] * dim + d] - position[d];
  return (PetscBool)(!outer[side] && PetscAbsReal(away) > (1 + SEED_NOTHING) * PetscAbsReal(end));
}

/* To ends straight across the axes. */
static void corner_along_axes(const Seeding *s, CellType type, const PetscReal *x, const PetscReal *half,
                              const PetscReal *position, const unsigned char *outer, PetscReal *corner)
{
  for (PetscInt d = 0; d < s->source->dim; ++d) {
    PetscReal low = straight_end(s, position, d, -half[d], half), high = straight_end(s, position, d, half[d], half);
    if (low != 0 && is_beyond(type, x, position, d, low, outer)) low = 0;
    if (high != 0 && is_beyond(type, x, position, d, high, outer)) high = 0;
    corner[d] = low != 0 && high != 0 ? 0 : low + high;
  }
}

void seed_corner_of_part(const Seeding *s, CellType type, const PetscReal *x, const SeedPart *part,
                         const PetscReal *position, PetscReal reach, const unsigned char *outer, PetscReal *corner)
{
  const PetscInt dim = s->source->dim;
  PetscReal half[3], square = 0, across = 0;
  if (!seed_half_sides(type, x, half)) return;
  for (PetscInt d = 0; d < dim; ++d) across += PetscSqr(2 * half[d]);
  for (PetscInt d = 0; d < dim; ++d) half[d] *= PetscSqrtReal(3 * part->spread[d]); /* of what fills its part evenly */
  if (!seed_corner_of_planes(s, &part->planes, position, PetscSqrtReal(across), corner))
    corner_along_axes(s, type, x, half, position, outer, corner);
  for (PetscInt d = 0; d < dim; ++d) square += PetscSqr(corner[d]);
  for (PetscInt d = 0; d < dim && square <= PetscSqr((1 + WITHIN) * reach); ++d) corner[d] = 0;
}

void seed_place_at_side(CellType type, const PetscReal *x, PetscInt side, const PetscReal *xi, PetscReal beyond,
                        PetscReal *position)
{
  const Cell *cell = cells + type;
  const PetscInt dim = cell->dim;
  PetscReal normal[3], reference[CELL_MAX_NODES * 3] = {0}, at[3], square = 0, along = 0;
  for (PetscInt i = 0; i < cell->nodes; ++i)
    for (PetscInt d = 0; d < dim; ++d) reference[i * dim + d] = cell->reference[i][d];
  cell_side_area(type, side, reference, normal);
  for (PetscInt d = 0; d < dim; ++d) {
    square += normal[d] * normal[d];
    along += normal[d] * (reference[cell->face[side][0] * dim + d] - xi[d]);
  }
  for (PetscInt d = 0; d < dim; ++d) at[d] = xi[d] + (along / square + beyond / PetscSqrtReal(square)) * normal[d];
  cell_position(type, x, at, position);
}

static PetscReal product(PetscInt dim, const PetscReal *a, const PetscReal *b)
{
  PetscReal sum = 0;
  for (PetscInt d = 0; d < dim; ++d) sum += a[d] * b[d];
  return sum;
}

/* The sum of n pieces of surface (n x dim) stands before a wall along the normal of one of them with its size alone if
 * they are at right angles. If they are nearly so, it is turned until it does: a piece of a plane of symmetry has no
 * part in a wall that stands round the surface beside it. (Sides that are blunter than that look at one wall both.) */
static void part_sides(PetscInt dim, PetscInt n, const PetscReal *side, PetscReal *face)
{
  PetscReal most = 0;
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt k = 0; k < i; ++k) {
      const PetscReal *a = side + i * dim, *b = side + k * dim;
      const PetscReal sizes = PetscSqrtReal(product(dim, a, a) * product(dim, b, b));
      most = PetscMax(most, PetscAbsReal(product(dim, a, b)) / sizes);
    }
  if (most <= ALONG || most > BLUNT) return;
  for (int round = 0; round < ROUNDS; ++round)
    for (PetscInt i = 0; i < n; ++i) {
      const PetscReal *a = side + i * dim, lacks = 1 - product(dim, face, a) / product(dim, a, a);
      for (PetscInt d = 0; d < dim; ++d) face[d] += lacks * a[d];
    }
}

void seed_face(const Seeding *s, PetscInt cell, const PetscReal *x, PetscInt q, const SeedPart *part,
               const unsigned char *outer, PetscReal *face)
{
  const CellType type = grid_cell_type(s->source, cell);
  const SeedRule *rule = seed_rule(s, cell);
  const PetscInt dim = cells[type].dim;
  PetscReal given[3 * 6] = {0};
  PetscInt n = 0;
  for (PetscInt d = 0; d < dim; ++d) face[d] = part ? part->face[d] : 0;
  for (PetscInt side = 0; side < cells[type].faces; ++side) {
    PetscReal area[3];
    PetscInt beside = 0;
    if (!outer[side] || (!part && !is_next_to(cells + type, side, rule, q))) continue;
    for (PetscInt p = 0; p < rule->n; ++p) beside += is_next_to(cells + type, side, rule, p) ? 1 : 0;
    cell_side_area(type, side, x, area);
    const PetscReal share = part ? part->side[side] : 1 / (PetscReal)beside;
    for (PetscInt d = 0; d < dim; ++d) face[d] += given[n * dim + d] = share * area[d];
    ++n;
  }
  if (!part) part_sides(dim, n, given, face);
}

PetscReal seed_way_out(const Seeding *s, const PetscReal *position, const PetscReal *along, PetscReal most)
{
  PetscReal low = 0, high = most;
  if (has_at(s, position, along, most)) return most;
  halve(s, position, along, HALVINGS_OUT, &low, &high);
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
  return seed_way_out(s, position, along, side);
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
