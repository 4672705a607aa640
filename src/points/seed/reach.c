/* How far a point is from its body's surface, and which part of that it stands for. */
#include "points/seed/seed.h"

#define NEXT 1.5    /* times the distance of the nearest points: layers of a rule are farther apart */
#define WITHIN 1e-3 /* of the cell: so far inside a side the body is asked for */
#define ALONG 1e-6  /* square of the sine between sides: these are parallel */

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
  if (!simplex && surface < PETSC_MAX_REAL) return PetscMin(surface, half);
  return surface < PETSC_MAX_REAL ? surface : reach;
}

/* corner: the nearest place in n planes; `across` are unit vectors, each along all planes before it. It goes on to the
 * nearest one in another plane, too, which is `away` along its normal; PETSC_FALSE: that is parallel to them. */
static PetscBool meet_plane(PetscInt dim, PetscInt n, PetscReal across[3][3], const PetscReal *normal, PetscReal away,
                            PetscReal *corner)
{
  PetscReal *next = across[n], square = 0;
  for (PetscInt d = 0; d < dim; ++d) next[d] = normal[d], away -= normal[d] * corner[d];
  for (PetscInt k = 0; k < n; ++k) {
    PetscReal along = 0;
    for (PetscInt d = 0; d < dim; ++d) along += normal[d] * across[k][d];
    for (PetscInt d = 0; d < dim; ++d) next[d] -= along * across[k][d];
  }
  for (PetscInt d = 0; d < dim; ++d) square += next[d] * next[d];
  if (square < ALONG) return PETSC_FALSE;
  for (PetscInt d = 0; d < dim; ++d) corner[d] += away / square * next[d];
  for (PetscInt d = 0; d < dim; ++d) next[d] /= PetscSqrtReal(square);
  return PETSC_TRUE;
}

void seed_corner(CellType type, const PetscReal *x, const PetscReal *position, const SeedRule *rule, PetscInt q,
                 const unsigned char *outer, PetscReal *corner)
{
  const Cell *cell = cells + type;
  PetscReal across[3][3] = {{0}}, normal[3], at[3] = {0, 0, 0};
  PetscInt n = 0;
  for (PetscInt side = 0; side < cell->faces; ++side) {
    PetscReal square = 0;
    if (!outer[side] || !is_next_to(cell, side, rule, q)) continue;
    cell_side_area(type, side, x, normal);
    for (PetscInt d = 0; d < cell->dim; ++d) square += normal[d] * normal[d];
    for (PetscInt d = 0; d < cell->dim; ++d) normal[d] /= PetscSqrtReal(square);
    if (n == cell->dim) return;
    if (!meet_plane(cell->dim, n++, across, normal, distance_to_side(cell, side, x, position), at)) return;
  }
  for (PetscInt d = 0; d < cell->dim; ++d) corner[d] = at[d];
}

/* Does the body reach side `side` beside a place xi of the cell? */
static PetscBool reaches(const Seeding *s, CellType type, const PetscReal *x, PetscInt side, const PetscReal *xi)
{
  const Cell *cell = cells + type;
  const PetscInt dim = cell->dim;
  PetscReal normal[3], reference[CELL_MAX_NODES * 3] = {0}, at[3], position[3], square = 0, along = 0;
  for (PetscInt i = 0; i < cell->nodes; ++i)
    for (PetscInt d = 0; d < dim; ++d) reference[i * dim + d] = cell->reference[i][d];
  cell_side_area(type, side, reference, normal);
  for (PetscInt d = 0; d < dim; ++d) {
    square += normal[d] * normal[d];
    along += normal[d] * (reference[cell->face[side][0] * dim + d] - xi[d]);
  }
  for (PetscInt d = 0; d < dim; ++d) at[d] = xi[d] + (1 - WITHIN) * along / square * normal[d];
  cell_position(type, x, at, position);
  return shape_contains(&s->body->shape, dim, position, 0);
}

void seed_face(const Seeding *s, PetscInt cell, const PetscReal *x, PetscInt q, const SeedPart *part,
               const unsigned char *outer, PetscReal *face)
{
  const CellType type = grid_cell_type(s->source, cell);
  const SeedRule *rule = seed_rule(s, cell);
  for (PetscInt d = 0; d < cells[type].dim; ++d) face[d] = part ? part->face[d] : 0;
  for (PetscInt side = 0; side < cells[type].faces; ++side) {
    PetscReal area[3];
    PetscInt beside = 0;
    if (!outer[side] || !is_next_to(cells + type, side, rule, q)) continue;
    if (part && !reaches(s, type, x, side, part->xi)) continue;
    for (PetscInt p = 0; p < rule->n; ++p) beside += is_next_to(cells + type, side, rule, p) ? 1 : 0;
    cell_side_area(type, side, x, area);
    const PetscReal share = (part ? PetscMin(1, part->share * (PetscReal)rule->n) : 1) / (PetscReal)beside;
    for (PetscInt d = 0; d < cells[type].dim; ++d) face[d] += share * area[d];
  }
}
