#include "points/seed/seed.h"

#define SLIVER 0.1 /* of what a point has in a whole cell: less joins its neighbour, */
#define LEVER 0.5  /* but not if that takes the surface of the cell's parts aside by so much of half of a part's side */

static PetscBool is_sliver(const SeedPart *part, PetscInt n)
{
  return (PetscBool)(part->share > 0 && part->share < SLIVER / (PetscReal)n);
}

static PetscReal square_between(const SeedPart *a, const SeedPart *b, PetscInt dim)
{
  PetscReal square = 0;
  for (PetscInt d = 0; d < dim; ++d) square += PetscSqr(a->xi[d] - b->xi[d]);
  return square;
}

/* Parts that are no slivers and have their middles nearest to that of this one, all that are as near; returns how
 * many. */
static PetscInt neighbours_of(const SeedPart *part, PetscInt n, PetscInt dim, PetscInt of, PetscInt *near)
{
  PetscReal least = PETSC_MAX_REAL;
  PetscInt n_near = 0;
  for (PetscInt q = 0; q < n; ++q)
    if (part[q].share > 0 && !is_sliver(part + q, n)) least = PetscMin(least, square_between(part + q, part + of, dim));
  for (PetscInt q = 0; q < n; ++q)
    if (part[q].share > 0 && !is_sliver(part + q, n) && square_between(part + q, part + of, dim) < least + SEED_NOTHING)
      near[n_near++] = q;
  return n_near;
}

static PetscReal square_of(const PetscReal *a, PetscInt dim)
{
  PetscReal square = 0;
  for (PetscInt d = 0; d < dim; ++d) square += PetscSqr(a[d]);
  return square;
}

/* Would a pressure on its surface act beside where it does if the part joined the n_near others? The middle of a thin
 * one lies where it is thickest, and that of its neighbour farther still along the surface. */
static PetscBool goes_aside(const SeedPart *part, PetscInt n, PetscInt dim, PetscInt of, const PetscInt *near,
                            PetscInt n_near)
{
  const PetscReal *face = part[of].face, square = square_of(face, dim);
  PetscReal way[3], ahead = 0, all = 0;
  if (square == 0) return PETSC_FALSE;
  for (PetscInt q = 0; q < n; ++q) all += PetscSqrtReal(square_of(part[q].face, dim));
  for (PetscInt d = 0; d < dim; ++d) {
    way[d] = -part[of].xi[d];
    for (PetscInt k = 0; k < n_near; ++k) way[d] += part[near[k]].xi[d] / (PetscReal)n_near;
    ahead += way[d] * face[d];
  }
  const PetscReal aside = PetscSqrtReal(PetscMax(0, square_of(way, dim) * square - PetscSqr(ahead)));
  return (PetscBool)(aside > LEVER * PetscPowReal((PetscReal)n, -1 / (PetscReal)dim) * all);
}

/* A share of what `from` was before it goes to `to`, with its moment. */
static void give(const SeedPart *from, PetscReal share, PetscInt dim, SeedPart *to)
{
  const PetscReal volume = share * from->share, sum = to->share + volume, a = to->share / sum, b = volume / sum;
  for (PetscInt d = 0; d < dim; ++d) {
    to->spread[d] = a * to->spread[d] + b * from->spread[d] + a * b * PetscSqr(to->xi[d] - from->xi[d]);
    to->face[d] += share * from->face[d];
    to->xi[d] = (to->share * to->xi[d] + volume * from->xi[d]) / sum;
  }
  for (PetscInt k = 0; k < CELL_MOST_SIDES; ++k) to->side[k] += share * from->side[k];
  seed_add_planes(&to->planes, dim, share, &from->planes);
  to->share = sum;
  to->whole = PETSC_FALSE;
}

void seed_join_slivers(SeedPart *part, PetscInt n, PetscInt dim, PetscBool walls)
{
  SeedPart before[SEED_MAX_RULE];
  PetscInt near[SEED_MAX_RULE], first = -1;
  for (PetscInt q = 0; q < n; ++q) before[q] = part[q];
  for (PetscInt q = 0; q < n; ++q) {
    if (!is_sliver(before + q, n)) continue;
    PetscInt n_near = neighbours_of(before, n, dim, q, near);
    if (!n_near && first < 0) {
      first = q;
      continue;
    }
    if (!n_near) near[n_near++] = first;
    if (walls && goes_aside(before, n, dim, q, near, n_near)) continue;
    for (PetscInt k = 0; k < n_near; ++k) give(before + q, 1 / (PetscReal)n_near, dim, part + near[k]);
    part[q].share = 0;
  }
}

/* Of the nodes of the rule, as parts without anything have no place of their own. */
static PetscReal square_of_rule(const SeedRule *rule, PetscInt dim, PetscInt p, PetscInt q)
{
  PetscReal square = 0;
  for (PetscInt d = 0; d < dim; ++d) square += PetscSqr(rule->xi[p * dim + d] - rule->xi[q * dim + d]);
  return square;
}

void seed_hand_on_faces(SeedPart *part, const SeedRule *rule, PetscInt dim)
{
  for (PetscInt q = 0; q < rule->n; ++q) {
    PetscInt to = -1;
    if (part[q].share > 0) continue;
    for (PetscInt p = 0; p < rule->n; ++p)
      if (part[p].share > 0 &&
          (to < 0 || square_of_rule(rule, dim, p, q) < square_of_rule(rule, dim, to, q) - SEED_NOTHING))
        to = p;
    for (PetscInt d = 0; d < dim && to >= 0; ++d) part[to].face[d] += part[q].face[d];
    for (PetscInt k = 0; k < CELL_MOST_SIDES && to >= 0; ++k) part[to].side[k] += part[q].side[k];
    if (to >= 0) seed_add_planes(&part[to].planes, dim, 1, &part[q].planes);
    part[q].planes.n = 0;
    for (PetscInt d = 0; d < dim; ++d) part[q].face[d] = 0;
    for (PetscInt k = 0; k < CELL_MOST_SIDES; ++k) part[q].side[k] = 0;
  }
}
