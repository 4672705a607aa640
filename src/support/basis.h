/* A basis: which nodes carry a point, with N and dN/dx there, and which nodes that may couple.
 *
 * Methods fill their supports through it and do not care which one it is. To add one: a file with a
 * struct basis_<name>, and a line in bases.inc. */
#pragma once
#include "base/diag/diag.h"
#include "grid/search/neighbours.h"
#include "support/support.h"

typedef enum {
  BASIS_OF_CELLS, /* nodes of the point's cell, of any kind and wherever its nodes have moved */
  /* nodes around the point's cell and its corners, in a grid of quadrilaterals or hexahedra that is
   * restored after every step */
  BASIS_OF_GRID,
  BASIS_OF_CLOUD, /* nodes near the point, in a cloud */
} BasisNodes;

/* What a basis works with. */
typedef struct {
  const BasisSpec *spec;
  const Grid *grid;
  PetscBool hoop;          /* see Kinematics */
  const Neighbours *nodes; /* of clouds: the nodes by their places, of each velocity field */
  const PetscReal *start;  /* of clouds: where these were at the start, as cloud_start(); NULL: clouds ask nothing */
  PetscBool follows;       /* of clouds: do they follow the stretch of the material? */
  /* do the points stand on the hull of all nodes, as nodes themselves and carriers of loads do? */
  PetscBool on_hull;
  /* of a box, for a basis that ends at held nodes: per node, bit d where along axis d what the boundary holds
   * ends; NULL: nowhere */
  const unsigned char *rim;
} BasisInput;

/* Where points of the steps to come may be. */
typedef struct {
  const unsigned char *cell; /* in a grid: 1 for cells that may hold some */
  const Points *points;      /* in a cloud: near these, */
  const Support *now;        /* whose clouds are known, */
  PetscReal skin;            /* so many times as far as they reach */
} BasisSites;

typedef struct {
  BasisNodes nodes;
  PetscInt halo;          /* of a grid: layers of nodes beyond those of the cells that points may see */
  PetscInt across;        /* of a grid: cells that nodes whose points couple them are apart at most, along an axis */
  PetscBool domains;      /* do points have domains (POINT_DOMAIN)? */
  PetscBool ends_at_held; /* does it want to know where what the boundary holds ends? */
  /* do functions of inner nodes vanish on the hull, so that what is prescribed at its nodes holds
   * on it? */
  PetscBool holds_boundary;
  /* are loads on a surface those of its functions there? else of the cell's */
  PetscBool carries;
  /* The same averaged over pieces of a surface (POINT_EDGE), with dim + 1 numbers of dN (Loads.slopes); NULL: carriers
   * are points, and see what points do. */
  PetscErrorCode (*carry)(const BasisInput *in, const Points *carriers, Support *support);
  /* is the field at a place the sum of its functions there, as tracers and carriers see it? else that of the cell's */
  PetscBool has_places;
  /* What the basis lacks in this grid, in words that go on behind its name; NULL: nothing. NULL for
   * the function: it takes every grid. */
  const char *(*misfit)(const GridSpec *grid);
  /* Nodes, N and dN of all points. In a grid they are located (xi known) and sorted by cell, lost
   * ones last, which get nothing; grid->x counts. In a cloud nodes get the numbers of in->nodes. */
  PetscErrorCode (*support)(const BasisInput *in, const Points *points, Support *support);
  /* How the functions of point p bend along each axis, nodes x dim: half the square of a way along an axis times this,
   * more than N and the way times dN, is what they are beyond it; means over a domain so become those at its ends.
   * Nodes as support lists them; returns how many. NULL: they do not bend. */
  PetscInt (*bends)(const BasisInput *in, const Points *points, PetscInt p, PetscInt *node, PetscReal *bend);
  /* Groups of local nodes that points at these sites may couple, added to those that are there. */
  PetscErrorCode (*couplings)(const BasisInput *in, const BasisSites *sites, NodeGroups *groups);
} Basis;

/* A line of bases.inc. */
typedef struct {
  const char *name, *help;
  const Basis *basis;
} BasisName;

extern const BasisName basis_names[]; /* ended by name = NULL */
/* NULL stands for the cell. */
const Basis *basis_find(const char *name);
/* Must constraints hold prescribed motion, or do the nodes themselves? */
PetscBool basis_needs_constraints(const BasisSpec *spec);
