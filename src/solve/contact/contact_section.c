/* The surface that a material point stands for before a wall. */
#include "solve/contact/contact.h"

/* Of n points of a cell the share next to one of its sides: a row of a lattice, or of the triangular
 * numbers of which rules of simplices are made (1 3 6, 1 4 10). */
static PetscReal points_at_side(const Cell *cell, PetscInt n)
{
  const PetscInt dim = cell->dim;
  PetscInt k = 1;
  if (cell->nodes > dim + 1) return PetscPowReal((PetscReal)n, (PetscReal)(dim - 1) / (PetscReal)dim);
  while ((dim == 2 ? (k + 1) * (k + 2) / 2 : (k + 1) * (k + 2) * (k + 3) / 6) <= n) ++k;
  return (PetscReal)(dim == 2 ? k : k * (k + 1) / 2);
}

/* Area of a side as a vector along its normal: of a triangle half the product of two edges, of a
 * quadrilateral that of its diagonals. */
static void side_area(const Cell *cell, PetscInt side, const PetscReal *x, PetscReal area[3])
{
  const PetscInt dim = cell->dim, *face = cell->face[side], quadrilateral = cell->face_nodes == 4;
  PetscReal e[3] = {0, 0, 0}, f[3] = {0, 0, 2};
  for (PetscInt d = 0; d < dim; ++d) {
    e[d] = x[face[dim == 2 ? 1 : quadrilateral ? 2 : 1] * dim + d] - x[face[0] * dim + d];
    if (dim == 3) f[d] = x[face[quadrilateral ? 3 : 2] * dim + d] - x[face[quadrilateral ? 1 : 0] * dim + d];
  }
  for (int d = 0; d < 3; ++d) area[d] = 0.5 * (e[(d + 1) % 3] * f[(d + 2) % 3] - e[(d + 2) % 3] * f[(d + 1) % 3]);
}

/* Of a cell as seen along n, m2. */
static PetscReal shadow(const Cell *cell, const PetscReal *x, const PetscReal n[3])
{
  PetscReal sum = 0, area[3];
  for (PetscInt side = 0; side < cell->faces; ++side) {
    side_area(cell, side, x, area);
    sum += 0.5 * PetscAbsReal(area[0] * n[0] + area[1] * n[1] + area[2] * n[2]);
  }
  return sum;
}

/* A part of the point's volume that has the shape of its cell; without one, of a square or cube. */
PetscReal contact_section(const NodalScene *scene, PetscInt p, const PetscReal n[3])
{
  const Grid *grid = scene->grid;
  const Points *points = scene->points;
  const BodySpec *body = scene->c->bodies + points->body[p];
  const PetscReal round = kinematics_weight(scene->c->kinematics, point_real(points, POINT_X, p)[0]); /* of the ring */
  const PetscReal volume = points->real[POINT_J][p] * points->real[POINT_VOLUME][p] / round;
  const PetscReal power = (PetscReal)(grid->dim - 1) / (PetscReal)grid->dim;
  PetscReal x[CELL_MAX_NODES * 3];
  if (grid->cloud || points->cell[p] < 0 || body->mesh) return PetscPowReal(volume, power) * round;
  const Cell *cell = grid_cell(grid, points->cell[p]);
  grid_cell_x(grid, points->cell[p], x);
  const PetscReal whole = cell_volume(grid_cell_type(grid, points->cell[p]), x);
  const PetscReal share = (PetscReal)body->points_per_cell * volume / whole;
  return shadow(cell, x, n) / points_at_side(cell, body->points_per_cell) * PetscPowReal(share, power) * round;
}
