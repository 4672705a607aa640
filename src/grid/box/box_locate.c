/* Where a position lies in a box grid: the voxel by its coordinate lines, then the cell within the
 * voxel. */
#include "grid/box/box.h"

/* The dimension is a constant where all points of a step are located. */
#define UNROLLED static inline __attribute__((always_inline))

PetscMPIInt box_owner(const GridBox *box, const PetscInt ijk[LATTICE])
{
  return voxel_owner(box->size, box->cut_axis, box->cut, ijk);
}

/* The interval with line[i] <= x < line[i + 1]; the ends take what lies beyond them. */
UNROLLED PetscInt interval_of(const GridBox *box, PetscInt axis, PetscReal x)
{
  const PetscReal *line = box->line[axis];
  const PetscInt n = box->counts[axis];
  PetscInt lo = 0, hi = n;
  if (box->per_length[axis] > 0) {
    const PetscReal guess = (x - line[0]) * box->per_length[axis];
    lo = guess > 0 ? (PetscInt)PetscMin(guess, (PetscReal)(n - 1)) : 0;
    /* Rounding may miss by one: the lines decide, as they do for the nodes. */
    if (lo > 0 && x < line[lo]) --lo;
    else if (lo < n - 1 && x >= line[lo + 1]) ++lo;
    return lo;
  }
  while (hi - lo > 1) {
    const PetscInt middle = lo + (hi - lo) / 2;
    if (x < line[middle]) hi = middle;
    else lo = middle;
  }
  return lo;
}

/* The voxel that holds x; PETSC_FALSE outside the grid. */
UNROLLED PetscBool box_voxel(const PetscInt dim, const GridBox *box, const PetscReal *x, PetscInt ijk[LATTICE])
{
  ijk[2] = ijk[3] = 0;
  for (PetscInt d = 0; d < dim; ++d) {
    const PetscReal *line = box->line[d];
    /* Written so that NaN is outside. */
    if (!(x[d] >= line[0] - box->tolerance && x[d] <= line[box->counts[d]] + box->tolerance)) return PETSC_FALSE;
    ijk[d] = interval_of(box, d, x[d]);
  }
  return PETSC_TRUE;
}

/* How far a reference position lies outside the simplex. */
static inline PetscReal simplex_outside(PetscInt dim, const PetscReal xi[3])
{
  PetscReal worst = -1.0;
  for (PetscInt d = 0; d < dim; ++d) {
    worst += xi[d];
  }
  for (PetscInt d = 0; d < dim; ++d) worst = PetscMax(worst, -xi[d]);
  return worst;
}

static inline void simplex_xi(const VoxelPattern *pattern, PetscInt cell, PetscInt dim, const PetscReal s[3],
                              PetscReal xi[3])
{
  const PetscReal *o = pattern->origin[cell], *m = pattern->inverse[cell];
  for (PetscInt d = 0; d < dim; ++d) {
    xi[d] = 0;
    for (PetscInt e = 0; e < dim; ++e) xi[d] += m[3 * d + e] * (s[e] - o[e]);
  }
}

/* The first simplex of the voxel that holds s, or the nearest where rounding leaves s in none. */
static PetscInt pick_simplex(const VoxelPattern *pattern, PetscInt dim, const PetscReal s[3], PetscReal *xi)
{
  PetscInt best = 0;
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt c = 0; c < pattern->n_cells && least > 0; ++c) {
    PetscReal trial[3];
    simplex_xi(pattern, c, dim, s, trial);
    const PetscReal outside = simplex_outside(dim, trial);
    if (outside >= least) continue;
    least = outside;
    best = c;
    for (PetscInt d = 0; d < dim; ++d) xi[d] = trial[d];
  }
  return best;
}

UNROLLED PetscInt locate(const PetscInt dim, const Grid *grid, const PetscReal *x, PetscReal *xi)
{
  const GridBox *box = grid->box;
  const VoxelBlock *block = box->block + box->rank;
  PetscInt ijk[LATTICE];
  PetscReal s[3] = {0, 0, 0}; /* position in the unit voxel */

  if (!box_voxel(dim, box, x, ijk) || !block_has(block, ijk)) return -1;
  for (PetscInt d = 0; d < dim; ++d) {
    const PetscReal *line = box->line[d] + ijk[d];
    s[d] = (x[d] - line[0]) / (line[1] - line[0]);
  }
  const VoxelPattern *pattern = box_pattern(box, ijk);
  const PetscInt first = block_index(block, ijk) * pattern->n_cells;
  if (grid->nodes_per_cell == dim + 1) return first + pick_simplex(pattern, dim, s, xi);
  for (PetscInt d = 0; d < dim; ++d) xi[d] = 2.0 * s[d] - 1.0;
  return first;
}

PetscInt box_locate(const Grid *grid, const PetscReal *x, PetscInt guess, PetscReal *xi)
{
  (void)guess;
  return grid->dim == 2 ? locate(2, grid, x, xi) : locate(3, grid, x, xi);
}

/* The first and last voxel along an axis that touch x. */
static void touching(const GridBox *box, PetscInt axis, PetscReal x, PetscInt voxel, PetscInt range[2])
{
  const PetscReal *line = box->line[axis];
  range[0] = range[1] = voxel;
  if (voxel > 0 && x <= line[voxel] + box->tolerance) --range[0];
  if (voxel < box->counts[axis] - 1 && x >= line[voxel + 1] - box->tolerance) ++range[1];
}

static PetscInt add_rank(PetscMPIInt rank, PetscInt n, PetscInt max, PetscMPIInt *ranks)
{
  for (PetscInt r = 0; r < n; ++r)
    if (ranks[r] == rank) return n;
  if (n < max) ranks[n++] = rank;
  return n;
}

void box_clamp(const Grid *grid, PetscReal *x)
{
  for (PetscInt d = 0; d < grid->dim; ++d) x[d] = PetscMin(PetscMax(x[d], grid->min[d]), grid->max[d]);
}

PetscInt box_candidates(const Grid *grid, const PetscReal *x, PetscInt max, PetscMPIInt *ranks)
{
  const GridBox *box = grid->box;
  PetscInt ijk[LATTICE], range[3][2] = {{0, 0}, {0, 0}, {0, 0}}, v[LATTICE] = {0}, n = 0;
  if (!box_voxel(box->dim, box, x, ijk)) return 0;
  /* grid_locate takes the position on its owner, which therefore comes first. */
  const PetscMPIInt owner = box_owner(box, ijk);
  if (owner != box->rank) n = add_rank(owner, n, max, ranks);
  for (PetscInt d = 0; d < box->dim; ++d) touching(box, d, x[d], ijk[d], range[d]);
  for (v[2] = range[2][0]; v[2] <= range[2][1]; ++v[2])
    for (v[1] = range[1][0]; v[1] <= range[1][1]; ++v[1])
      for (v[0] = range[0][0]; v[0] <= range[0][1]; ++v[0]) {
        const PetscMPIInt rank = box_owner(box, v);
        if (rank != box->rank) n = add_rank(rank, n, max, ranks);
      }
  return n;
}
