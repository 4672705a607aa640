/* Parts of a rectangle or brick that a box along the axes cuts are such themselves: no need to measure them (parts.c),
 * which where edges cross a cell is good to a thousandth of it. */
#include "points/seed/seed.h"

#define SAME 1e-9 /* of half a cell: places so near are one */

typedef struct {
  PetscReal low[3], high[3];
} Brick;

/* What is nearest to point q of the rule, in the reference cell. */
static Brick part_of(const SeedRule *rule, PetscInt dim, PetscInt q)
{
  Brick b = {{-1, -1, -1}, {1, 1, 1}};
  for (PetscInt p = 0; p < rule->n; ++p)
    for (PetscInt d = 0; d < dim; ++d) {
      const PetscReal way = rule->xi[p * dim + d] - rule->xi[q * dim + d], half = rule->xi[q * dim + d] + 0.5 * way;
      if (way > SEED_NOTHING) b.high[d] = PetscMin(b.high[d], half);
      if (way < -SEED_NOTHING) b.low[d] = PetscMax(b.low[d], half);
    }
  return b;
}

static PetscReal size_of(PetscInt dim, const Brick *b)
{
  PetscReal size = 1;
  for (PetscInt d = 0; d < dim; ++d) size *= PetscMax(0, b->high[d] - b->low[d]);
  return size;
}

/* Do the points of the rule stand in a lattice, so that these parts are all of the cell? */
static PetscBool fills_cell(const SeedRule *rule, PetscInt dim)
{
  PetscReal sum = 0;
  for (PetscInt q = 0; q < rule->n; ++q) {
    const Brick b = part_of(rule, dim, q);
    sum += size_of(dim, &b);
  }
  return (PetscBool)(PetscAbsReal(sum - (1 << dim)) < SAME);
}

/* The surface of a part of a brick that is left, at its high or low end along axis d, as far as no body that this one
 * sticks to is beyond; reference: in the reference cell, of a side of which it is a share. */
static PetscReal area_at(const Seeding *s, CellType type, const PetscReal *x, const Brick *left, const PetscReal *half,
                         PetscInt d, PetscBool at_high)
{
  PetscReal area = 1;
  for (PetscInt i = 0; i < s->source->dim; ++i)
    if (i != d) area *= (half ? half[i] : 0.5) * PetscMax(0, left->high[i] - left->low[i]);
  return area > 0 ? area * seed_bare(s, type, x, left->low, left->high, d, at_high) : 0;
}

PetscInt seed_side_of(CellType type, PetscInt d, PetscBool at_high)
{
  const Cell *cell = cells + type;
  PetscInt side = 0;
  for (; side < cell->faces; ++side) {
    PetscBool on = PETSC_TRUE;
    for (PetscInt i = 0; i < cell->face_nodes; ++i)
      if ((cell->reference[cell->face[side][i]][d] > 0) != at_high) on = PETSC_FALSE;
    if (on) break;
  }
  return side;
}

/* The box's own surface in a part, as a vector outwards, and what of the part lies along the cell's sides. */
static void take_face(const Seeding *s, CellType type, const PetscReal *x, const Brick *part, const Brick *box,
                      const Brick *left, const PetscReal *half, SeedPart *to)
{
  for (PetscInt d = 0; d < s->source->dim; ++d) {
    const PetscReal low = box->low[d], high = box->high[d];
    to->face[d] = 0;
    if (high < 1 - SAME && high > part->low[d] + SAME && high < part->high[d] + SAME)
      to->face[d] += area_at(s, type, x, left, half, d, PETSC_TRUE);
    if (low > -1 + SAME && low < part->high[d] - SAME && low > part->low[d] - SAME)
      to->face[d] -= area_at(s, type, x, left, half, d, PETSC_FALSE);
    if (left->high[d] <= left->low[d]) continue;
    if (left->high[d] > 1 - SAME)
      to->side[seed_side_of(type, d, PETSC_TRUE)] = area_at(s, type, x, left, NULL, d, PETSC_TRUE);
    if (left->low[d] < -1 + SAME)
      to->side[seed_side_of(type, d, PETSC_FALSE)] = area_at(s, type, x, left, NULL, d, PETSC_FALSE);
  }
}

/* The body's box in the reference cell; PETSC_FALSE: body and cell are no bricks. */
static PetscBool box_of(const Seeding *s, CellType type, const PetscReal *x, PetscReal *half, Brick *box)
{
  const PetscInt dim = s->source->dim;
  const Shape *shape = &s->body->shape;
  if (shape->kind != SHAPE_BOX || !seed_half_sides(type, x, half)) return PETSC_FALSE;
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal low = x[d];
    for (PetscInt i = 1; i < cells[type].nodes; ++i) low = PetscMin(low, x[i * dim + d]);
    box->low[d] = (shape->min[d] - low) / half[d] - 1;
    box->high[d] = (shape->max[d] - low) / half[d] - 1;
  }
  return PETSC_TRUE;
}

PetscBool seed_box_fill(const Seeding *s, CellType type, const PetscReal *x, PetscReal within, SeedFill *fill)
{
  PetscReal half[3];
  Brick box;
  if (!box_of(s, type, x, half, &box)) return PETSC_FALSE;
  *fill = SEED_WHOLE;
  for (PetscInt d = 0; d < s->source->dim; ++d) {
    const PetscReal length = PetscMin(1, box.high[d]) - PetscMax(-1, box.low[d]);
    if (length <= 2 * within) return *fill = SEED_NONE, PETSC_TRUE;
    if (length < 2 * (1 - within)) *fill = SEED_CUT;
  }
  return PETSC_TRUE;
}

PetscBool seed_box_parts(const Seeding *s, CellType type, const PetscReal *x, const SeedRule *rule, SeedPart *part)
{
  const PetscInt dim = s->source->dim;
  PetscReal half[3];
  Brick box;
  if (!fills_cell(rule, dim) || !box_of(s, type, x, half, &box)) return PETSC_FALSE;
  for (PetscInt q = 0; q < rule->n; ++q) {
    const Brick whole = part_of(rule, dim, q);
    Brick left = whole;
    part[q] = (SeedPart){.whole = PETSC_TRUE};
    for (PetscInt d = 0; d < dim; ++d) {
      if (box.low[d] > left.low[d] + SAME) left.low[d] = box.low[d], part[q].whole = PETSC_FALSE;
      if (box.high[d] < left.high[d] - SAME) left.high[d] = box.high[d], part[q].whole = PETSC_FALSE;
      part[q].xi[d] = 0.5 * (left.low[d] + left.high[d]);
      part[q].spread[d] = PetscSqr(left.high[d] - left.low[d]) / 12;
    }
    part[q].share = size_of(dim, &left) / (1 << dim);
    if (s->faces) take_face(s, type, x, &whole, &box, &left, half, part + q);
  }
  return PETSC_TRUE;
}
