/* Cells that a body's surface cuts: each point stands for the part of its cell that is nearest to it, as far
 * as that lies in the shape. Parts are measured by samples that no plane meets in rows: a lattice would take
 * faces along the axes for up to half a row off. */
#include <math.h>
#include "points/seed/seed.h"

/* samples: along an axis, to see whether the surface cuts a cell, and in all, to measure what it leaves */
enum { LOOK = 5, MEASURE = 4096 };
#define WITHIN 1e-3 /* the outer ones that look are so far inside: a surface along a side cuts nothing */

typedef struct {
  CellType type;
  const PetscReal *x; /* nodes of the cell */
  PetscInt n;         /* samples */
  PetscInt first;     /* where they begin in the sequence: errors of equal cells shall not add up */
  PetscInt along;     /* of them on a lattice from side to side; 0: a sequence that fills the cell evenly */
} Lattice;

/* Sample k in [0, 1]: of a lattice, or of the additive sequence of the plane or of space (multiples of powers of
 * the root of g^(dim + 1) = g + 1; Roberts 2018). */
static PetscReal along_axis(const Lattice *l, PetscInt dim, PetscInt d, PetscInt k)
{
  const PetscReal g = dim == 2 ? 1.32471795724474602596 : 1.22074408460575947536;
  for (PetscInt e = 0; e < d && l->along; ++e) k /= l->along;
  if (l->along) return WITHIN + (1 - 2 * WITHIN) * (PetscReal)(k % l->along) / (PetscReal)(l->along - 1);
  const PetscReal u = 0.5 + (PetscReal)(l->first + k) * PetscPowReal(g, -(PetscReal)(d + 1));
  return u - floor(u);
}

/* Where sample k is, and the volume that it stands for, but for a factor. Simplices are squares or cubes whose
 * one side is drawn together. */
static PetscReal sample(const Lattice *l, PetscInt k, PetscReal xi[3], PetscReal position[3])
{
  const Cell *cell = cells + l->type;
  const PetscBool simplex = cell->nodes == cell->dim + 1;
  PetscReal N[CELL_MAX_NODES], dN[CELL_MAX_NODES * 3], left = 1, weight = 1;
  for (PetscInt d = 0; d < cell->dim; ++d) {
    const PetscReal u = along_axis(l, cell->dim, d, k);
    xi[d] = simplex ? u * left : 2 * u - 1;
    if (!simplex) continue;
    weight *= PetscPowReal(1 - u, (PetscReal)(cell->dim - 1 - d));
    left *= 1 - u;
  }
  weight *= PetscAbsReal(cell_gradients(l->type, l->x, xi, N, dN));
  for (PetscInt d = 0; d < cell->dim; ++d) {
    position[d] = 0;
    for (PetscInt i = 0; i < cell->nodes; ++i) position[d] += N[i] * l->x[i * cell->dim + d];
  }
  return weight;
}

SeedFill seed_fill(const Seeding *s, PetscInt cell)
{
  PetscReal x[CELL_MAX_NODES * 3], xi[3], position[3];
  const PetscInt n = s->source->dim == 2 ? LOOK * LOOK : LOOK * LOOK * LOOK;
  const Lattice l = {grid_cell_type(s->source, cell), x, n, 0, LOOK};
  PetscInt inside = 0;
  grid_cell_x(s->source, cell, x);
  for (PetscInt k = 0; k < n; ++k) {
    (void)sample(&l, k, xi, position);
    inside += shape_contains(&s->body->shape, s->source->dim, position, 0) ? 1 : 0;
  }
  return inside == n ? SEED_WHOLE : inside ? SEED_CUT : SEED_NONE;
}

static PetscInt nearest_of(const SeedRule *rule, PetscInt dim, const PetscReal *xi)
{
  PetscInt nearest = 0;
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt q = 0; q < rule->n; ++q) {
    PetscReal square = 0;
    for (PetscInt d = 0; d < dim; ++d) square += PetscSqr(xi[d] - rule->xi[q * dim + d]);
    if (square < least) least = square, nearest = q;
  }
  return nearest;
}

void seed_parts(const Seeding *s, PetscInt cell, const SeedRule *rule, SeedPart *part)
{
  PetscReal x[CELL_MAX_NODES * 3], xi[3], position[3], whole[SEED_MAX_RULE] = {0};
  const PetscInt dim = s->source->dim;
  const Lattice l = {grid_cell_type(s->source, cell), x, MEASURE, s->source->global_cell[cell] % 1000 * MEASURE, 0};
  grid_cell_x(s->source, cell, x);
  for (PetscInt q = 0; q < rule->n; ++q) part[q] = (SeedPart){0};
  for (PetscInt k = 0; k < l.n; ++k) {
    const PetscReal weight = sample(&l, k, xi, position);
    const PetscInt q = nearest_of(rule, dim, xi);
    whole[q] += weight;
    if (!shape_contains(&s->body->shape, dim, position, 0)) continue;
    part[q].share += weight;
    for (PetscInt d = 0; d < dim; ++d) part[q].xi[d] += weight * xi[d];
  }
  for (PetscInt q = 0; q < rule->n; ++q) {
    const PetscReal *at = rule->xi + q * dim;
    const PetscBool is_whole = part[q].share >= (1 - 1e-12) * whole[q];
    for (PetscInt d = 0; d < dim && part[q].share > 0; ++d)
      part[q].xi[d] = is_whole ? at[d] : part[q].xi[d] / part[q].share;
    part[q].share = is_whole ? 1 : part[q].share / whole[q];
  }
}
