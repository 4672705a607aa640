/* Sums over the nodes of an entry, in which what several entries hold at a node counts once. */
#include "boundary/boundary.h"

/* Directions that are held at a node, each by an entry. */
typedef struct {
  PetscInt n, entry[3];
  PetscReal along[3][3], unit[3][3], part[3][3]; /* along[k] = sum over j <= k of part[j][k] unit[j] */
} Held;

/* Unless those before it span it, but for the angle of a corner. */
static void add_direction(Held *h, PetscInt entry, const PetscReal *direction)
{
  PetscReal rest[3] = {direction[0], direction[1], direction[2]}, part[3], square = 0;
  for (PetscInt j = 0; j < h->n; ++j) {
    part[j] = 0;
    for (int d = 0; d < 3; ++d) part[j] += h->unit[j][d] * rest[d];
    for (int d = 0; d < 3; ++d) rest[d] -= part[j] * h->unit[j][d];
  }
  for (int d = 0; d < 3; ++d) square += rest[d] * rest[d];
  if (h->n == 3 || square < PetscSqr(PetscSinReal(WALL_CORNER))) return;
  part[h->n] = PetscSqrtReal(square);
  for (PetscInt j = 0; j <= h->n; ++j) h->part[j][h->n] = part[j];
  for (int d = 0; d < 3; ++d) h->along[h->n][d] = direction[d], h->unit[h->n][d] = rest[d] / part[h->n];
  h->entry[h->n++] = entry;
}

/* The force along each of the directions, and what is left of it. */
static void resolve(const Held *h, const PetscReal force[3], PetscReal along[3], PetscReal rest[3])
{
  for (int d = 0; d < 3; ++d) rest[d] = force[d];
  for (PetscInt k = h->n - 1; k >= 0; --k) {
    along[k] = 0;
    for (int d = 0; d < 3; ++d) along[k] += h->unit[k][d] * rest[d];
    along[k] /= h->part[k][k];
    for (int d = 0; d < 3; ++d) rest[d] -= along[k] * h->along[k][d];
  }
}

/* Where walls of several entries meet: each pushes along its normal, entries that hold axes along these. */
static void share_at_corner(const Boundary *b, const WallSide *side, PetscInt n, PetscInt entry, const PetscReal *force,
                            PetscReal *share)
{
  const PetscInt first = side->node * b->dim;
  PetscReal full[3] = {0, 0, 0}, along[3], rest[3];
  Held h = {.n = 0};
  for (PetscInt d = 0; d < b->dim; ++d) {
    const PetscReal axis[3] = {d == 0, d == 1, d == 2};
    const PetscInt holds = b->entry[first + d];
    if (boundary_holds(b, side->node, d)) full[d] = force[d];
    if (holds >= 0 && (holds == boundary_axis(b) || !b->c->boundary[holds].component[NORMAL]))
      add_direction(&h, holds, axis);
  }
  for (PetscInt k = 0; k < n; ++k) add_direction(&h, side[k].entry, side[k].normal);
  resolve(&h, full, along, rest);
  for (PetscInt d = 0; d < b->dim; ++d) share[d] = entry == side->entry ? rest[d] : 0;
  for (PetscInt k = 0; k < h.n; ++k)
    for (PetscInt d = 0; d < b->dim && h.entry[k] == entry; ++d) share[d] += along[k] * h.along[k][d];
}

/* Sides of walls at a node that several entries share: *n of them. */
static const WallSide *sides_at(const Boundary *b, PetscInt node, PetscInt *n)
{
  PetscInt low = 0, high = b->n_sides;
  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;
    if (b->sides[middle].node < node) low = middle + 1;
    else high = middle;
  }
  for (*n = 0; low + *n < b->n_sides && b->sides[low + *n].node == node;) ++*n;
  return b->sides + low;
}

/* What the entry gives of the force on a node: elsewhere the components that it prescribes, in the node's frame. */
static void share_of_entry(const Boundary *b, PetscInt node, PetscInt entry, const PetscReal *force, PetscReal *share)
{
  const PetscReal *w = frame_of(&b->frames, node);
  PetscInt n = 0;
  const WallSide *side = b->n_sides ? sides_at(b, node, &n) : NULL;
  if (n) {
    share_at_corner(b, side, n, entry, force, share);
    return;
  }
  for (PetscInt d = 0; d < b->dim; ++d) share[d] = force[d];
  if (w) frame_turn(b->dim, w, share);
  for (PetscInt d = 0; d < b->dim; ++d)
    if (b->entry[node * b->dim + d] != entry) share[d] = 0;
  if (w) frame_turn(b->dim, w, share);
}

PetscErrorCode BoundarySum(const Boundary *b, const Grid *grid, PetscInt entry, const PetscReal *force,
                           PetscReal sum[3])
{
  PetscReal local[3] = {0, 0, 0}, share[3];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < b->motion[entry].n; ++k) {
    const PetscInt node = b->motion[entry].node[k];
    if (node >= grid->n_owned) continue;
    share_of_entry(b, node, entry, force + node * b->dim, share);
    for (PetscInt d = 0; d < b->dim; ++d) local[d] += share[d];
  }
  PetscCall(MPIU_Allreduce(local, sum, 3, MPIU_REAL, MPI_SUM, grid->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode BoundaryHasOwn(const Boundary *b, const Grid *grid, PetscInt entry, PetscBool *has)
{
  PetscBool own = PETSC_FALSE, any[2];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < b->motion[entry].n; ++k) {
    const PetscInt node = b->motion[entry].node[k];
    for (PetscInt d = 0; d < b->dim && node < grid->n_owned; ++d) own |= b->entry[node * b->dim + d] == entry;
  }
  for (PetscInt s = 0; s < b->n_sides; ++s) own |= b->sides[s].entry == entry;
  any[0] = own, any[1] = b->motion[entry].n > 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, any, 2, MPIU_BOOL, MPI_LOR, grid->comm));
  *has = any[0] || !any[1];
  PetscFunctionReturn(0);
}
