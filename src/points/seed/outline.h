/* The surface of the bodies as they are seeded, cells with their faces, and how much material
 * stands above a position: in cells that a body fills with its shape, what of them lies in that.
 *
 * A face is an edge in 2D; in 3D a triangle (quadrilaterals are cut in two, in the same way by
 * both cells that share one). */
#pragma once
#include "grid/grid.h"

typedef struct {
  PetscReal x[9];    /* corners, dim x dim, outward by the right-hand rule */
  PetscReal density; /* of the material inside, kg/m3 */
  PetscInt body;
} OutlineFace;

/* Of this rank's cells: borders to other ranks' parts are faces, too, and cancel in all that is
 * asked of them. */
typedef struct {
  PetscInt n, capacity;
  OutlineFace *face;
  PetscInt n_bodies;
  const Shape **shape; /* n_bodies: that which the body fills, or NULL: whole cells. Of the case */
} Outline;

/* outer (n_cells x CELL_MOST_SIDES): is the side of the chosen cell no side of another one of
 * this rank? */
#define CELL_MOST_SIDES 6 /* of a cell, at most */
PetscErrorCode OutlineSides(const Grid *source, PetscInt n_cells, const PetscInt *chosen, unsigned char *outer);
/* Collective. The same, of other ranks neither. */
PetscErrorCode OutlineSidesOfAll(const Grid *source, PetscInt n_cells, const PetscInt *chosen, unsigned char *outer);

/* Add the faces that belong to one of these cells alone. */
PetscErrorCode OutlineAdd(Outline *outline, const Grid *source, PetscInt n_cells, const PetscInt *chosen, PetscInt body,
                          PetscReal density);
/* This body fills its shape. */
PetscErrorCode OutlineShape(Outline *outline, PetscInt n_bodies, PetscInt body, const Shape *shape);
PetscErrorCode OutlineClear(Outline *outline);

typedef struct Overburden Overburden;

/* Collective. The outline of all ranks, ready to be asked along `up` (a unit vector). Another
 * body counts as lying on what is below it if the space between them is no wider than `gap`, m:
 * half a cell. The outline must live as long. */
PetscErrorCode OverburdenCreate(MPI_Comm comm, PetscInt dim, const PetscReal up[3], PetscReal gap, PetscInt n_bodies,
                                const Outline *outline, Overburden **overburden);
PetscErrorCode OverburdenDestroy(Overburden **overburden);
/* Mass above x, inside `body`, per area across `up`, kg/m2: of the body itself wherever it is, and
 * of others that lie on it, or on what lies on it. *top: height of the highest of it, m. */
PetscErrorCode OverburdenAt(Overburden *overburden, PetscInt body, const PetscReal *x, PetscReal *mass, PetscReal *top);
/* Is x inside the body, as cells with their faces have it? */
PetscBool overburden_holds(Overburden *overburden, PetscInt body, const PetscReal *x);
