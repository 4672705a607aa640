/* Bodies without an interface between them share nodes, so they stick: where they touch is no surface. */
#include "points/seed/seed.h"

#define SAMPLES 8 /* along an axis of a side */

/* Do bodies that share the grid stick to each other for good? One that a later stage takes away leaves a surface
 * behind. */
static PetscBool sticks_to(const Seeding *s, PetscInt b)
{
  const BodySpec *other = s->c->bodies + b;
  if (b == s->b || other->absent || other->leaves || other->mesh || s->body->mesh) return PETSC_FALSE;
  return (PetscBool)(s->grid->n_fields <= 1 || case_field(s->c, b) == s->field);
}

/* Where a body that fills its shape is, that says; a region of the mesh may end it elsewhere. */
static PetscBool is_where_shape_is(const Seeding *s, const BodySpec *body)
{
  return (PetscBool)(body_fills_shape(body, s->equal) && !body->region);
}

PetscErrorCode SeedFindMates(Seeding *s)
{
  PetscFunctionBeginUser;
  s->n_mates = 0;
  PetscCall(PetscMalloc1(s->c->n_bodies, &s->mate));
  for (PetscInt b = 0; b < s->c->n_bodies; ++b)
    if (sticks_to(s, b) && is_where_shape_is(s, s->c->bodies + b)) s->mate[s->n_mates++] = &s->c->bodies[b].shape;
  PetscFunctionReturn(0);
}

PetscBool seed_is_held(const Seeding *s, const PetscReal *position)
{
  for (PetscInt k = 0; k < s->n_mates; ++k)
    if (shape_contains(s->mate[k], s->source->dim, position, 0)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool seed_is_inside(const Seeding *s, const PetscReal *position)
{
  return (PetscBool)(shape_contains(&s->body->shape, s->source->dim, position, 0) || seed_is_held(s, position));
}

PetscReal seed_bare(const Seeding *s, CellType type, const PetscReal *x, const PetscReal *low, const PetscReal *high,
                    PetscInt d, PetscBool at_high)
{
  const PetscInt dim = s->source->dim, n = dim == 2 ? SAMPLES : SAMPLES * SAMPLES;
  PetscReal xi[3], position[3];
  PetscInt bare = 0;
  if (!s->n_mates) return 1;
  for (PetscInt k = 0; k < n; ++k) {
    for (PetscInt i = 0, rest = k; i < dim; ++i) {
      if (i == d) continue;
      xi[i] = low[i] + (high[i] - low[i]) * ((PetscReal)(rest % SAMPLES) + 0.5) / SAMPLES;
      rest /= SAMPLES;
    }
    xi[d] = at_high ? high[d] + SEED_BEYOND : low[d] - SEED_BEYOND;
    cell_position(type, x, xi, position);
    bare += seed_is_held(s, position) ? 0 : 1;
  }
  return (PetscReal)bare / (PetscReal)n;
}

/* The sides of this body's cells that no other one of its own has, nor one of those that it sticks to: of all, or of
 * those that are where their cells are. */
static PetscErrorCode SidesAmong(const Seeding *all, PetscInt n, const Seeding *s, PetscBool shapes,
                                 unsigned char *outer)
{
  PetscInt n_chosen = s->n_cells, *chosen;
  PetscBool *in;
  unsigned char *sides;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->source->n_cells, &in));
  PetscCall(PetscMalloc1(s->source->n_cells, &chosen));
  for (PetscInt k = 0; k < s->n_cells; ++k) chosen[k] = s->cells[k], in[s->cells[k]] = PETSC_TRUE;
  for (const Seeding *other = all; other < all + n; ++other) {
    if (!other->ready || !sticks_to(s, other->b) || (!shapes && is_where_shape_is(s, other->body))) continue;
    for (PetscInt k = 0; k < other->n_cells; ++k) {
      if (!in[other->cells[k]]) chosen[n_chosen++] = other->cells[k];
      in[other->cells[k]] = PETSC_TRUE;
    }
  }
  PetscCall(PetscMalloc1(n_chosen * CELL_MOST_SIDES, &sides));
  PetscCall(OutlineSidesOfAll(s->source, n_chosen, chosen, sides));
  PetscCall(PetscArraycpy(outer, sides, s->n_cells * CELL_MOST_SIDES));
  PetscCall(PetscFree(in));
  PetscCall(PetscFree(chosen));
  PetscCall(PetscFree(sides));
  PetscFunctionReturn(0);
}

static PetscErrorCode FindSidesOf(const Seeding *all, PetscInt n, Seeding *s)
{
  PetscBool sticks = PETSC_FALSE;
  unsigned char *by_cells, *by_shapes;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n_cells * CELL_MOST_SIDES, &s->outer));
  PetscCall(OutlineSidesOfAll(s->source, s->n_cells, s->cells, s->outer));
  for (const Seeding *other = all; other < all + n; ++other) sticks |= other->ready && sticks_to(s, other->b);
  if (!sticks) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(s->n_cells * CELL_MOST_SIDES, &by_cells, s->n_cells * CELL_MOST_SIDES, &by_shapes));
  PetscCall(SidesAmong(all, n, s, PETSC_FALSE, by_cells));
  PetscCall(SidesAmong(all, n, s, PETSC_TRUE, by_shapes));
  for (PetscInt k = 0; k < s->n_cells * CELL_MOST_SIDES; ++k)
    if (s->outer[k]) s->outer[k] = !by_cells[k] ? SIDE_INNER : by_shapes[k] ? SIDE_OUTER : SIDE_SHARED;
  PetscCall(PetscFree2(by_cells, by_shapes));
  PetscFunctionReturn(0);
}

PetscErrorCode SeedFindSides(Seeding *all, PetscInt n)
{
  PetscFunctionBeginUser;
  for (Seeding *s = all; s < all + n; ++s)
    if (s->ready) PetscCall(FindSidesOf(all, n, s));
  PetscFunctionReturn(0);
}

void seed_sides_at(const Seeding *s, PetscInt k, const PetscReal *x, const PetscReal *xi, unsigned char *outer)
{
  const CellType type = grid_cell_type(s->source, s->cells[k]);
  PetscReal position[3];
  for (PetscInt side = 0; side < CELL_MOST_SIDES; ++side) {
    const unsigned char is = s->outer[k * CELL_MOST_SIDES + side];
    outer[side] = is != SIDE_INNER;
    if (is != SIDE_SHARED) continue;
    seed_place_at_side(type, x, side, xi, SEED_BEYOND, position);
    outer[side] = !seed_is_held(s, position);
  }
}
