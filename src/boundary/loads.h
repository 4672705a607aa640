/* Loads: tractions on faces of the grid, and loads carried by points that move with the material.
 *
 * A carrier is a point without mass that holds a force: at the quadrature points of a body's
 * boundary (a traction, a pressure), or at one material position (a point force). Its force goes to the
 * nodes of its cell that hold material. All are dead but pressures, whose force turns and grows with
 * the surface (solve/forces/pressures.c). */
#pragma once
#include "boundary/load_factors.h"
#include "support/support.h"

/* Quadrature points of the faces of the grid under one load. */
typedef struct {
  PetscBool used; /* does the load act on faces, on any rank? else it has carriers */
  PetscInt n, *cell;
  PetscReal *N; /* n x nodes_per_cell: the cell's shape functions times the point's area, m2 */
  PetscReal *x; /* n x 3, undeformed, m */
} LoadFaces;

typedef struct Loads {
  const Case *c;
  PetscInt dim, n_nodes;
  LoadFaces *faces; /* one per load */
  LoadAsked *asked; /* likewise: factors that a caller gives */
  /* POINT_FORCE at amplitude 1, of a pressure on the surface as it is when the step begins; body = index
   * of the load */
  Points *carriers;
  const Support *support; /* nodes that carriers push; NULL: those of their cells */
  PetscInt slopes;        /* numbers of its dN a node: dim, and behind these the middle's N where carriers are pieces */
} Loads;

/* What a carrier sees, among nodes that are touched: N and M sum to one, M gives the motion of its middle (N that of
 * what its force works on), dN, 3 numbers a node, the stretch and turn of its surface. */
typedef struct {
  PetscInt n; /* 0: there is no such node */
  const PetscInt *node;
  PetscReal N[CLOUD_MAX_NODES], M[CLOUD_MAX_NODES], dN[3 * CLOUD_MAX_NODES];
} CarrierShape;

/* Collective. `points` tells which cells each body fills, at the start; fills: do bodies fill their shapes, if they
 * leave that to the method? Loads on these act on the surface of the shape, on others on that of their cells. */
PetscErrorCode LoadsCreate(const Grid *grid, const Case *c, const Points *points, PetscBool fills, Diag *diag,
                           Loads **loads);
/* Collective. Let carriers bear the tractions on faces of the grid too, where its cells hold
 * points: for methods that leave the cells. */
PetscErrorCode LoadsLeaveCells(Loads *loads, const Grid *grid, const Points *points);
PetscErrorCode LoadsDestroy(Loads **loads);
/* Collective. Let the loads stand on `grid`, which is `old` shared among the ranks in another
 * way, and of which the points know their cells. */
PetscErrorCode LoadsRegrid(Loads *loads, const Grid *old, const Grid *grid, const Points *points);

/* Not collective, but on every rank: callers are asked for factors. Subtract the nodal forces of
 * dead loads at time t from residual (n_nodes x dim; sums over ranks come later). Faces of the grid
 * are loaded where their cell is filled[cell] by material: beside a body there is nothing to push.
 * Carried forces go to nodes with touched[node] != 0. */
PetscErrorCode LoadsPush(const Loads *loads, const Grid *grid, PetscReal t, const unsigned char *filled,
                         const unsigned char *touched, PetscReal *residual);

void carrier_shape(const Loads *loads, const Grid *grid, PetscInt p, const unsigned char *touched, CarrierShape *shape);
static inline PetscBool carrier_pushes(const Loads *loads, PetscInt p)
{
  return load_pushes(loads->c->loads + loads->carriers->body[p]);
}

/* Are carriers pieces of a surface, with edges that go with it? */
static inline PetscBool loads_have_pieces(const Loads *loads)
{
  return (PetscBool)(loads->carriers->components[POINT_EDGE] > 0);
}

/* Shape functions of a carrier or tracer among touched nodes only, scaled to sum to one;
 * PETSC_FALSE if there is none. */
PetscBool touched_shape(const Grid *grid, PetscInt cell, const PetscReal *xi, const unsigned char *touched,
                        PetscReal *N);
