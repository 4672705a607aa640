/* The surface that a material point stands for before a wall. */
#include "solve/contact/contact.h"

#define LEAST \
  0.25 /* of the side of a square of the point's volume: what stands before a wall that its surface does not look \
                    at is no smaller */
#define AWAY 0.1   /* cosine: a surface that looks elsewhere, for that */
#define ASIDE 1e-3 /* cosine: a surface that looks elsewhere */
#define LOOKS 0.5 /* of how far the nearest side is: what stands beside one that looks at n is about as far behind it */
#define TORN 0.5  /* change of an edge's length, or of an angle, beyond which nobody knows where a surface looks */

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

/* F^T n: across planes of the undeformed body that look at n now, and as much longer as they are nearer now. */
static void pull_back(const PetscReal F[9], const PetscReal n[3], PetscReal N[3])
{
  for (int i = 0; i < 3; ++i) N[i] = F[i] * n[0] + F[3 + i] * n[1] + F[6 + i] * n[2];
}

/* Along which a surface looked at the start that looks at n now; of what has flowed nobody knows. */
static void looked_along(const Points *points, PetscInt p, const PetscReal n[3], PetscBool torn, PetscReal N[3])
{
  PetscReal F[9], square = 0;
  point_F(points, p, F);
  pull_back(F, n, N);
  for (int i = 0; i < 3; ++i) square += PetscSqr(N[i]);
  for (int i = 0; i < 3; ++i) N[i] = torn ? n[i] : N[i] / PetscSqrtReal(square);
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
  pull_back(F, n, N);
  for (int i = 0; i < 3; ++i) length += N[i] * N[i];
  for (PetscInt d = 0; d < dim; ++d) along -= N[d] * face[d];
  return PetscMax(0, along / PetscSqrtReal(length));
}

PetscBool contact_is_strained(const Points *points, PetscInt p, PetscReal limit)
{
  PetscReal F[9], most = 0;
  point_F(points, p, F);
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      PetscReal C = i == j ? -1 : 0;
      for (int k = 0; k < 3; ++k) C += F[3 * k + i] * F[3 * k + j];
      most = PetscMax(most, PetscAbsReal(C));
    }
  return (PetscBool)(most >= limit);
}

/* Has its matter flowed? Then nobody knows where a surface looks that it had. */
static PetscBool is_torn(const NodalScene *scene, PetscInt p)
{
  return (PetscBool)(scene->passes && scene->materials[scene->points->material[p]].law->yields &&
                     contact_is_strained(scene->points, p, TORN));
}

/* How much of its body's surface the point was given, as a vector, m2. */
static PetscReal given_face(const Points *points, PetscInt p)
{
  PetscReal square = 0;
  for (PetscInt d = 0; d < points->components[POINT_FACE]; ++d)
    square += PetscSqr(point_real(points, POINT_FACE, p)[d]);
  return PetscSqrtReal(square);
}

/* Does it stand beside the surface that looks at n? Of cells whose sides are at right angles the corner tells. */
static PetscBool stands_before(const NodalScene *scene, PetscInt p, const PetscReal n[3])
{
  const Points *points = scene->points;
  const PetscReal *corner = point_real(points, POINT_CORNER, p);
  PetscReal F[9], N[3], ahead = 0, square = 0;
  point_F(points, p, F);
  pull_back(F, n, N);
  for (PetscInt d = 0; d < points->dim; ++d) ahead -= corner[d] * N[d], square += PetscSqr(corner[d]);
  if (square == 0) return PETSC_FALSE;
  const Cell *cell = scene->grid->cloud || points->cell[p] < 0 ? NULL : grid_cell(scene->grid, points->cell[p]);
  if (!cell || cell->nodes != 1 << points->dim) return PETSC_TRUE;
  return (PetscBool)(ahead > ASIDE * PetscSqrtReal(square));
}

PetscBool contact_is_surface(const NodalScene *scene, PetscInt p, const PetscReal n[3])
{
  return (PetscBool)(is_torn(scene, p) || contact_face(scene->points, p, n) > 0 || stands_before(scene, p, n));
}

ContactDepth contact_depth(const NodalScene *scene, PetscInt p, const PetscReal n[3])
{
  static const PetscReal none[3] = {0, 0, 0};
  const Points *points = scene->points;
  const PetscReal given = given_face(points, p), first = points->real[POINT_REACH][p];
  PetscReal F[9];
  if (is_torn(scene, p)) return CONTACT_ANYWHERE;
  if (given > 0 && contact_face(points, p, n) > AWAY * given) return CONTACT_OUTSIDE;
  point_F(points, p, F);
  const PetscReal ahead = contact_reach(F, n, 0, point_real(points, POINT_CORNER, p), points->dim);
  return ahead > LOOKS * contact_reach(F, n, first, none, points->dim) ? CONTACT_OUTSIDE : CONTACT_INSIDE;
}

/* By how much more a surface of it that looks at n is than it was at the start: Nanson's J |F^-T N|, N along F^T n. In
 * the plane that is a length, whatever the thickness, or the circle, has grown by. */
static PetscReal growth_of(const Points *points, PetscInt p, const PetscReal n[3])
{
  static const PetscReal none[3] = {0, 0, 0};
  PetscReal F[9];
  point_F(points, p, F);
  return points->real[POINT_J][p] / ((points->dim == 2 ? F[8] : 1) * contact_reach(F, n, 1, none, 0));
}

/* A piece of matter in the section (in space: of it), of the volume of the point, as it was at the start; of what has
 * flowed one that has no shape, as it is now. */
static PetscReal piece_of(const Points *points, PetscInt p, PetscBool torn)
{
  PetscReal F[9];
  point_F(points, p, F);
  return (torn ? points->real[POINT_J][p] : points->dim == 2 ? F[8] : 1) * points->real[POINT_VOLUME][p];
}

/* What of its body's surface the point was given, if it was. Else a part of the point's volume that has the shape of
 * its cell, and has turned with the matter; without one, of a square or cube. Either has grown with the matter; but
 * of what has flowed, and stood before no surface that looks at n now, nobody knows by how much. */
PetscReal contact_section(const NodalScene *scene, PetscInt p, const PetscReal n[3], const PetscReal radius[2])
{
  const Grid *grid = scene->grid;
  const Points *points = scene->points;
  const BodySpec *body = scene->c->bodies + points->body[p];
  const PetscReal power = (PetscReal)(grid->dim - 1) / (PetscReal)grid->dim;
  const PetscReal face = contact_face(points, p, n), given = given_face(points, p);
  const PetscBool looks = (PetscBool)(face > AWAY * given);
  const PetscBool torn = (PetscBool)(is_torn(scene, p) && !looks && !stands_before(scene, p, n));
  PetscReal x[CELL_MAX_NODES * 3], N[3];
  const PetscReal volume = piece_of(points, p, torn) / kinematics_weight(scene->c->kinematics, radius[0]);
  const PetscReal square = PetscPowReal(volume, power);
  const PetscReal grown = (torn ? 1 : growth_of(points, p, n)) *
                          kinematics_weight(scene->c->kinematics, PetscMax(radius[1], LEAST * radius[0]));
  if (looks) return face * grown;
  if (given > 0 && !torn) return PetscMax(face, LEAST * square) * grown;
  if (grid->cloud || points->cell[p] < 0 || body->mesh) return square * grown;
  const Cell *cell = grid_cell(grid, points->cell[p]);
  grid_cell_x(grid, points->cell[p], x);
  const PetscReal whole = cell_volume(grid_cell_type(grid, points->cell[p]), x);
  const PetscReal share = (PetscReal)body->points_per_cell * volume / whole;
  looked_along(points, p, n, torn, N);
  return shadow(grid_cell_type(grid, points->cell[p]), x, N) / points_at_side(cell, body->points_per_cell) *
         PetscPowReal(share, power) * grown;
}
