/* Points are found in bins, in which cells stand by their boxes. */
#include "picture/body/cells.h"
#include <math.h>

static const int triangle[1][4] = {{0, 1, 2, -1}}, quadrilateral[1][4] = {{0, 1, 2, 3}},
                 tetrahedron[4][4] = {{0, 1, 2, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {0, 2, 3, -1}},
                 hexahedron[6][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                     {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

CellFaces cell_faces(int vtk_type)
{
  switch (vtk_type) {
  case 5: return (CellFaces){1, triangle};
  case 9: return (CellFaces){1, quadrilateral};
  case 10: return (CellFaces){4, tetrahedron};
  case 12: return (CellFaces){6, hexahedron};
  default: return (CellFaces){0, NULL};
  }
}

typedef struct {
  const VtkCells *cells;
  const PetscReal *node;
  PetscInt dim, counts[3], *start, *item;
  PetscReal min[3], size[3]; /* of a bin */
} Bins;

static const PetscReal *corner(const Bins *b, PetscInt c, PetscInt k)
{
  return b->node + 3 * b->cells->node[b->cells->start[c] + k];
}

static PetscInt n_corners(const Bins *b, PetscInt c) { return b->cells->start[c + 1] - b->cells->start[c]; }

static void cell_box(const Bins *b, PetscInt c, PetscReal min[3], PetscReal max[3])
{
  for (PetscInt k = 0; k < n_corners(b, c); ++k)
    for (PetscInt d = 0; d < b->dim; ++d) {
      const PetscReal x = corner(b, c, k)[d];
      min[d] = k ? PetscMin(min[d], x) : x;
      max[d] = k ? PetscMax(max[d], x) : x;
    }
}

static PetscInt bin_along(const Bins *b, PetscInt d, PetscReal x)
{
  return (PetscInt)PetscMin(PetscMax(floor((x - b->min[d]) / b->size[d]), 0), (PetscReal)(b->counts[d] - 1));
}

/* The bins that a box touches: first and last along each axis; how many they are. */
static PetscInt bins_of(const Bins *b, const PetscReal min[3], const PetscReal max[3], PetscInt from[3], PetscInt to[3])
{
  PetscInt n = 1;
  for (PetscInt d = 0; d < 3; ++d) {
    from[d] = to[d] = 0;
    if (d < b->dim) from[d] = bin_along(b, d, min[d]), to[d] = bin_along(b, d, max[d]);
    n *= to[d] - from[d] + 1;
  }
  return n;
}

static PetscInt bin_number(const Bins *b, const PetscInt from[3], const PetscInt to[3], PetscInt k)
{
  const PetscInt wide = to[0] - from[0] + 1, deep = to[1] - from[1] + 1;
  return from[0] + k % wide + b->counts[0] * (from[1] + k / wide % deep + b->counts[1] * (from[2] + k / wide / deep));
}

/* Some two bins for a cell, as many along each axis as the box is long beside the others. */
static void lay_out(Bins *b)
{
  PetscReal max[3] = {0}, low[3], high[3], volume = 1;
  for (PetscInt c = 0; c < b->cells->n; ++c) {
    cell_box(b, c, low, high);
    for (PetscInt d = 0; d < b->dim; ++d) {
      b->min[d] = c ? PetscMin(b->min[d], low[d]) : low[d];
      max[d] = c ? PetscMax(max[d], high[d]) : high[d];
    }
  }
  for (PetscInt d = 0; d < b->dim; ++d) volume *= PetscMax(max[d] - b->min[d], 1e-300);
  const PetscReal edge = PetscPowReal(volume / (2. * (PetscReal)b->cells->n), 1. / (PetscReal)b->dim);
  for (PetscInt d = 0; d < 3; ++d) {
    b->counts[d] = 1, b->size[d] = 1;
    if (d >= b->dim || !(edge > 0)) continue;
    b->counts[d] = (PetscInt)PetscMin(PetscMax(ceil((max[d] - b->min[d]) / edge), 1), 2048);
    b->size[d] = PetscMax((max[d] - b->min[d]) / (PetscReal)b->counts[d], 1e-300);
  }
}

static PetscErrorCode BinsCreate(const VtkCells *cells, const PetscReal *node, PetscInt dim, Bins *b)
{
  PetscReal min[3], max[3];
  PetscInt from[3], to[3];

  PetscFunctionBeginUser;
  *b = (Bins){.cells = cells, .node = node, .dim = dim};
  lay_out(b);
  const PetscInt n_bins = b->counts[0] * b->counts[1] * b->counts[2];
  PetscCall(PetscCalloc1(n_bins + 2, &b->start));
  for (int pass = 0; pass < 2; ++pass) {
    for (PetscInt c = 0; c < cells->n; ++c) {
      cell_box(b, c, min, max);
      for (PetscInt k = 0, n = bins_of(b, min, max, from, to); k < n; ++k) {
        const PetscInt bin = bin_number(b, from, to, k);
        if (pass) b->item[b->start[bin + 1]++] = c;
        else ++b->start[bin + 2];
      }
    }
    if (pass) break;
    for (PetscInt k = 0; k < n_bins; ++k) b->start[k + 2] += b->start[k + 1];
    PetscCall(PetscMalloc1(b->start[n_bins + 1], &b->item));
  }
  PetscFunctionReturn(0);
}

/* How far x is inside of the line or plane through corners of a cell whose middle is `middle`, m. */
static PetscReal inside_of(PetscInt dim, const PetscReal *a, const PetscReal *b, const PetscReal *c,
                           const PetscReal middle[3], const PetscReal *x)
{
  PetscReal n[3] = {a[1] - b[1], b[0] - a[0], 0}, side = 0, is = 0, length = 0;
  if (dim == 3) {
    PetscReal u[3], v[3];
    for (int d = 0; d < 3; ++d) u[d] = b[d] - a[d], v[d] = c[d] - a[d];
    for (int d = 0; d < 3; ++d) n[d] = u[(d + 1) % 3] * v[(d + 2) % 3] - u[(d + 2) % 3] * v[(d + 1) % 3];
  }
  for (PetscInt d = 0; d < dim; ++d) {
    side += n[d] * (middle[d] - a[d]), is += n[d] * (x[d] - a[d]);
    length += n[d] * n[d];
  }
  return length > 0 ? (side < 0 ? -is : is) / sqrt(length) : -PETSC_MAX_REAL;
}

/* How far x is inside of a cell; less than 0 outside, m. */
static PetscReal inside_cell(const Bins *b, PetscInt c, const PetscReal *x)
{
  const CellFaces faces = cell_faces(b->cells->type[c]);
  const PetscInt n = n_corners(b, c);
  PetscReal middle[3] = {0}, least = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < n; ++k)
    for (PetscInt d = 0; d < b->dim; ++d) middle[d] += corner(b, c, k)[d] / (PetscReal)n;
  if (b->dim == 2)
    for (PetscInt k = 0; k < n; ++k)
      least = PetscMin(least, inside_of(2, corner(b, c, k), corner(b, c, (k + 1) % n), NULL, middle, x));
  for (PetscInt f = 0; f < faces.n && b->dim == 3; ++f) {
    const int *k = faces.face[f];
    least = PetscMin(least, inside_of(3, corner(b, c, k[0]), corner(b, c, k[1]), corner(b, c, k[2]), middle, x));
  }
  return least;
}

PetscErrorCode CellsOfPoints(const VtkCells *cells, const PetscReal *node, PetscInt dim, PetscInt n, const PetscReal *x,
                             PetscInt *cell)
{
  Bins bins;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) cell[i] = -1;
  if (!cells->n) PetscFunctionReturn(0);
  PetscCall(BinsCreate(cells, node, dim, &bins));
  for (PetscInt i = 0; i < n; ++i) {
    PetscInt from[3], to[3];
    PetscReal best = -PETSC_MAX_REAL;
    (void)bins_of(&bins, x + 3 * i, x + 3 * i, from, to);
    const PetscInt bin = bin_number(&bins, from, from, 0);
    for (PetscInt k = bins.start[bin]; k < bins.start[bin + 1]; ++k) {
      const PetscReal inside = inside_cell(&bins, bins.item[k], x + 3 * i);
      if (inside > best) best = inside, cell[i] = bins.item[k];
    }
  }
  PetscCall(PetscFree(bins.start));
  PetscCall(PetscFree(bins.item));
  PetscFunctionReturn(0);
}
