/* Cells that a body's surface cuts: each point stands for the part of its cell that is nearest to it, as far
 * as that lies in the shape. Parts are measured by a lattice of samples. */
#include "points/seed/seed.h"

/* samples along an axis: to see whether the surface cuts a cell, and to measure what it leaves */
enum { LOOK = 5, MEASURE_2D = 32, MEASURE_3D = 16 };
#define WITHIN 1e-3 /* the outer ones that look are so far inside: a surface along a side cuts nothing */

typedef struct {
  CellType type;
  const PetscReal *x; /* nodes of the cell */
  PetscInt along;     /* samples along an axis, */
  PetscBool rim;      /* from side to side, or the middles of equal parts */
} Lattice;

/* Sample k: where it is, and the volume that it stands for, but for a factor. Simplices are squares or cubes
 * whose one side is drawn together. */
static PetscReal sample(const Lattice *l, PetscInt k, PetscReal xi[3], PetscReal position[3])
{
  const Cell *cell = cells + l->type;
  const PetscBool simplex = cell->nodes == cell->dim + 1;
  PetscReal N[CELL_MAX_NODES], dN[CELL_MAX_NODES * 3], left = 1, weight = 1;
  for (PetscInt d = 0; d < cell->dim; ++d, k /= l->along) {
    const PetscReal i = (PetscReal)(k % l->along), n = (PetscReal)l->along;
    const PetscReal u = l->rim ? WITHIN + (1 - 2 * WITHIN) * i / (n - 1) : (i + 0.5) / n;
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

static PetscInt n_samples(const Lattice *l)
{
  PetscInt n = 1;
  for (PetscInt d = 0; d < cells[l->type].dim; ++d) n *= l->along;
  return n;
}

SeedFill seed_fill(const Seeding *s, PetscInt cell)
{
  PetscReal x[CELL_MAX_NODES * 3], xi[3], position[3];
  const Lattice l = {grid_cell_type(s->source, cell), x, LOOK, PETSC_TRUE};
  const PetscInt n = n_samples(&l);
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
  const Lattice l = {grid_cell_type(s->source, cell), x, dim == 2 ? MEASURE_2D : MEASURE_3D, PETSC_FALSE};
  grid_cell_x(s->source, cell, x);
  for (PetscInt q = 0; q < rule->n; ++q) part[q] = (SeedPart){0};
  for (PetscInt k = 0; k < n_samples(&l); ++k) {
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
