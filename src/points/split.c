#include "points/split.h"
#include "base/math/lattice.h"
#include "grid/box/box.h"
#include "points/fields.h"

/* The part of the body that a point stands for, the parallelogram that F has made of its domain: its edges, of whole
 * length, m, and over the sides of its cell. */
typedef struct {
  PetscReal edge[3][3], over[3][3];
} Part;

/* What is open carries nothing, and nobody is to stand in it: where F has gained volume edges count without. */
static PetscReal closed(PetscInt dim, const PetscReal F[9])
{
  const PetscReal in_plane = F[0] * F[4] - F[1] * F[3];
  const PetscReal det = dim == 2 ? in_plane
                                 : F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
                                     F[2] * (F[3] * F[7] - F[4] * F[6]);
  return det > 1 ? PetscPowReal(det, -1 / (PetscReal)dim) : 1;
}

static Part part_of(const Points *points, PetscInt p, const PetscReal *size, PetscBool opens)
{
  const PetscReal *L = point_real(points, POINT_DOMAIN, p);
  PetscReal F[9];
  Part part = {.edge = {{0}}};
  point_F(points, p, F);
  const PetscReal shrunk = opens ? closed(points->dim, F) : 1;
  for (PetscInt k = 0; k < points->dim; ++k)
    for (PetscInt d = 0; d < points->dim; ++d) {
      part.edge[k][d] = 2 * L[k] * shrunk * F[3 * d + k];
      part.over[k][d] = part.edge[k][d] / size[d];
    }
  return part;
}

/* How far neighbours are apart if such parts fill space, edge k being halved (-1: none): neighbours stand in a
 * lattice, and shear alone, which makes edges long, brings others near. */
static LatticeSize spacing(PetscInt dim, const Part *part, PetscInt k)
{
  PetscReal a[3][3] = {{0}};
  for (PetscInt i = 0; i < dim; ++i)
    for (PetscInt d = 0; d < dim; ++d) a[i][d] = (i == k ? 0.5 : 1) * part->over[i][d];
  lattice_reduce(dim, a);
  return lattice_size(dim, a);
}

/* Where both are stretched alike the longest vector stays while one edge is halved. */
static PetscBool is_nearer(LatticeSize a, LatticeSize b)
{
  const PetscReal digit = 1e-9 * b.longest;
  if (PetscAbsReal(a.longest - b.longest) > digit) return (PetscBool)(a.longest < b.longest);
  return (PetscBool)(a.all < b.all - digit);
}

/* The edge to halve; -1: none, or one that shear has made so long that its halves would be put far away. */
static PetscInt edge_to_halve(PetscInt dim, const Part *part, PetscReal most)
{
  LatticeSize least = spacing(dim, part, -1);
  PetscInt k = -1;
  if (!(least.longest > most)) return -1;
  for (PetscInt i = 0; i < dim; ++i) {
    const LatticeSize then = spacing(dim, part, i);
    if (!is_nearer(then, least)) continue;
    least = then;
    k = i;
  }
  return k >= 0 && lattice_dot(dim, part->over[k], part->over[k]) <= PetscSqr(2 * most) ? k : -1;
}

/* What walls and other bodies hold is left whole: how far its surface is away is known for it alone. */
static PetscBool is_touched(const Points *points, PetscInt p)
{
  const PetscReal *kept = point_real(points, POINT_CONTACT, p);
  for (PetscInt i = 0; i < points->components[POINT_CONTACT]; ++i)
    if (kept[i] != 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The share of the whole that a half has whose place at the start is off by so much along the radius: in a ring, R.
 * F_tt stays r / R. x is its place already. */
static PetscReal share_of_ring(Points *points, PetscInt p, PetscReal r, PetscReal off)
{
  const PetscReal half = point_real(points, POINT_X, p)[0], R = half - point_real(points, POINT_U, p)[0];
  const PetscReal stretch = half / R * ((R - off) / r);
  point_real(points, POINT_F, p)[4] *= stretch;
  points->real[POINT_J][p] *= stretch;
  return R / (R - off);
}

/* Point p becomes one of the halves of itself, on this side of its middle. */
static void halve(Points *points, PetscInt p, PetscInt side, PetscInt k, const PetscReal *edge, PetscBool hoop)
{
  PetscReal *x = point_real(points, POINT_X, p), *u = point_real(points, POINT_U, p);
  PetscReal *L = point_real(points, POINT_DOMAIN, p), share = 0.5;
  const PetscReal sign = side ? 1 : -1, r = x[0], off = sign * 0.5 * L[k];
  for (PetscInt d = 0; d < points->dim; ++d) {
    x[d] += sign * 0.25 * edge[d];
    u[d] += sign * 0.25 * edge[d] - (d == k ? off : 0);
  }
  L[k] *= 0.5;
  if (hoop) share *= share_of_ring(points, p, r, k == 0 ? off : 0);
  points->real[POINT_MASS][p] *= share;
  points->real[POINT_VOLUME][p] *= share;
  points->real[POINT_WORK][p] *= share;
  const PetscReal length = PetscPowReal(0.5, 1 / (PetscReal)points->dim);
  for (PetscInt d = 0; d < points->components[POINT_FACE]; ++d)
    point_real(points, POINT_FACE, p)[d] *= PetscPowReal(0.5, (PetscReal)(points->dim - 1) / (PetscReal)points->dim);
  for (PetscInt d = 0; d < points->components[POINT_CORNER]; ++d) point_real(points, POINT_CORNER, p)[d] *= length;
  if (points->components[POINT_REACH]) points->real[POINT_REACH][p] *= length;
  points->id[p] = point_half_id(points->id[p], side);
}

static void cell_size(const Grid *grid, PetscInt cell, PetscReal *size)
{
  PetscInt ijk[LATTICE];
  box_voxel_of(grid, cell, ijk);
  box_voxel_size(grid->box, ijk, size);
}

/* The edge along which the point is to be split; -1: it stays whole. */
static PetscInt edge_of(const Points *points, PetscInt p, const Grid *grid, const SplitRule *rule, Part *part)
{
  PetscReal size[3];
  if (points->cell[p] < 0 || points->id[p] >> POINT_SEED_BITS >> POINT_MOST_SPLITS) return -1;
  cell_size(grid, points->cell[p], size);
  *part = part_of(points, p, size, rule->opens[points->material[p]]);
  const PetscInt k = edge_to_halve(points->dim, part, rule->cells);
  if (k < 0 || is_touched(points, p)) return -1;
  /* no half of a ring crosses the axis */
  if (rule->hoop && point_real(points, POINT_X, p)[0] <= 0.25 * PetscAbsReal(part->edge[k][0])) return -1;
  return k;
}

PetscErrorCode PointsSplit(Points *points, const Grid *grid, const SplitRule *rule, PetscInt *n)
{
  const PetscInt whole = points->n;
  char *copy;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(points_bytes(points), &copy));
  for (PetscInt p = 0; p < whole; ++p) {
    Part part;
    const PetscInt k = edge_of(points, p, grid, rule, &part);
    if (k < 0) continue;
    points_pack(points, 1, &p, copy);
    PetscCall(PointsUnpack(points, 1, copy));
    halve(points, p, 0, k, part.edge[k], rule->hoop);
    halve(points, points->n - 1, 1, k, part.edge[k], rule->hoop);
    ++*n;
  }
  PetscCall(PetscFree(copy));
  PetscFunctionReturn(0);
}

PetscReal points_farthest(const Points *points, const Grid *grid)
{
  PetscReal most = 0, size[3];
  for (PetscInt p = 0; p < points->n; ++p) {
    if (points->cell[p] < 0) continue;
    cell_size(grid, points->cell[p], size);
    const Part part = part_of(points, p, size, PETSC_FALSE);
    most = PetscMax(most, spacing(points->dim, &part, -1).longest);
  }
  return most;
}
