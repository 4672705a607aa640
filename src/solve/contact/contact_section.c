/* The surface that a material point stands for before a wall. */
#include "solve/contact/contact.h"

#define LEAST 0.25 /* of the side of a square of the point's volume: what stands before a wall is no smaller */
#define TORN 0.5   /* change of an edge's length, or of an angle, beyond which nobody knows where a surface looks */

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

/* Of a cell as seen along n, m2. */
static PetscReal shadow(CellType type, const PetscReal *x, const PetscReal n[3])
{
  PetscReal sum = 0, area[3];
  for (PetscInt side = 0; side < cells[type].faces; ++side) {
    cell_side_area(type, side, x, area);
    sum += 0.5 * PetscAbsReal(area[0] * n[0] + area[1] * n[1] + area[2] * n[2]);
  }
  return sum;
}

PetscReal contact_face(const Points *points, PetscInt p, const PetscReal n[3])
{
  const PetscInt dim = points->components[POINT_FACE];
  PetscReal F[9], N[3], along = 0, length = 0;
  if (!dim) return 0;
  const PetscReal *face = point_real(points, POINT_FACE, p);
  point_F(points, p, F);
  for (int i = 0; i < 3; ++i) {
    N[i] = F[i] * n[0] + F[3 + i] * n[1] + F[6 + i] * n[2];
    length += N[i] * N[i];
  }
  for (PetscInt d = 0; d < dim; ++d) along -= N[d] * face[d];
  const PetscReal grown = PetscPowReal(points->real[POINT_J][p], (PetscReal)(dim - 1) / (PetscReal)dim);
  return PetscMax(0, along / PetscSqrtReal(length) * grown);
}

/* Was the point given some of its body's surface, and is that where it was? */
static PetscBool knows_its_face(const Points *points, PetscInt p)
{
  const PetscInt dim = points->components[POINT_FACE];
  PetscReal F[9], given = 0, most = 0;
  if (!dim) return PETSC_FALSE;
  point_F(points, p, F);
  for (PetscInt d = 0; d < dim; ++d) given += PetscAbsReal(point_real(points, POINT_FACE, p)[d]);
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      PetscReal C = i == j ? -1 : 0;
      for (int k = 0; k < 3; ++k) C += F[3 * k + i] * F[3 * k + j];
      most = PetscMax(most, PetscAbsReal(C));
    }
  return (PetscBool)(given > 0 && most < TORN);
}

/* What of its body's surface the point was given, if it was. Else a part of the point's volume
 * that has the shape of its cell; without one, of a square or cube. */
PetscReal contact_section(const NodalScene *scene, PetscInt p, const PetscReal n[3])
{
  const Grid *grid = scene->grid;
  const Points *points = scene->points;
  const BodySpec *body = scene->c->bodies + points->body[p];
  const PetscReal round = kinematics_weight(scene->c->kinematics, point_real(points, POINT_X, p)[0]); /* of the ring */
  const PetscReal volume = points->real[POINT_J][p] * points->real[POINT_VOLUME][p] / round;
  const PetscReal power = (PetscReal)(grid->dim - 1) / (PetscReal)grid->dim;
  const PetscReal square = PetscPowReal(volume, power), face = contact_face(points, p, n);
  PetscReal x[CELL_MAX_NODES * 3];
  if (face > 0 || knows_its_face(points, p)) return PetscMax(face, LEAST * square) * round;
  if (grid->cloud || points->cell[p] < 0 || body->mesh) return square * round;
  const Cell *cell = grid_cell(grid, points->cell[p]);
  grid_cell_x(grid, points->cell[p], x);
  const PetscReal whole = cell_volume(grid_cell_type(grid, points->cell[p]), x);
  const PetscReal share = (PetscReal)body->points_per_cell * volume / whole;
  return shadow(grid_cell_type(grid, points->cell[p]), x, n) / points_at_side(cell, body->points_per_cell) *
         PetscPowReal(share, power) * round;
}
