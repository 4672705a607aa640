/* Nodes and points that stand for the bodies, and what ties them: all that a method works on. */
#pragma once
#include "boundary/boundary.h"
#include "boundary/loads.h"
#include "material/law.h"
#include "method/nodal_fields.h"
#include "solve/forces/constraints.h"
#include "support/basis.h"

typedef struct Discretisation {
  const Case *c;
  Grid *grid;
  Points *points, *tracers;
  Boundary *boundary;
  Loads *loads;
  const Material *materials;
  NodalFields *nodes;
  const Basis *basis;
  Support *support;
  const struct Transfer *transfer; /* of methods that restore their grid */
  Constraints *constraints;        /* none: prescribed motion is that of the nodes themselves */
  PetscBool started;               /* has phase a run before? */
  PetscBool present;               /* do support and nodal fields belong to where points are now? */
  unsigned char *filled;           /* n_cells: does the cell hold points? */
  PetscReal *volume;               /* n_cells, of grids that are restored: 0 where nobody has asked for it, m3 */
  PetscReal *whole;                /* n_nodes, of such a grid: the node's share of the cells, m3; NULL: not asked for */
  PetscReal *unroomed;             /* points as they were before DiscretisationRoom; NULL: it was not called */
  struct Extension *extension;     /* which nodes follow others, of points with domains; see extend/extend.h */
  PetscBool alone;                 /* does no node follow, while accelerations are taken over? */
  unsigned char *rim;              /* BasisInput.rim of the last support, of a basis that asks; else NULL */
  unsigned char *reached;          /* n_nodes: touched, or follows; NULL: none follows */
  /* of a point's velocity beyond the nodes': what damping takes in the step */
  PetscReal fade;
  PetscInt group_capacity;
  PetscReal *lumping, *soft, *tie; /* per group, see WeakFormInput */
  PetscReal *pressure_tie;         /* mixed: per group, see WeakFormInput */
  struct MassRows *mass_rows;      /* of the step's mass matrix, if transfers have summed it up; see transfer/mass.h */
  PetscInt n_lost;                 /* points that left the grid in the last convection, all ranks */
  LostPoint *lost;                 /* at most 16 of them */
  void *own;                       /* what the method alone knows, see Method.destroy */
} Discretisation;

/* parts: case, grid, points, tracers, boundary, loads and materials, which stay the caller's. */
PetscErrorCode DiscretisationCreate(const Discretisation *parts, Discretisation **space);
PetscErrorCode DiscretisationDestroy(Discretisation **space);

/* Steps that methods share. */
/* touched, and in grids of cells filled, from the support. */
PetscErrorCode DiscretisationTouch(Discretisation *space);
/* n_nodes: those that carry tracers and loads, because material touches them or they follow such nodes. */
const unsigned char *reached_nodes(const Discretisation *space);
/* m_I = sum N m_p, on all copies. */
PetscErrorCode DiscretisationMass(Discretisation *space);
/* p_I = sum N m_p p / m_I (thesis eq. 5.20), on all copies; after DiscretisationMass. */
PetscErrorCode DiscretisationPressure(Discretisation *space);
/* Of a basis whose points are groups of their own in a grid: soft and pressure_tie of points with a node that is hardly
 * reached and follows no others, or, where none can, is less than half full; after DiscretisationExtend. */
PetscErrorCode DiscretisationCuts(Discretisation *space);
/* Of each node, on all copies: the volume of the material around it (n_nodes), points having `ratio` of theirs at the
 * start (NULL: 1), and in `whole` that of its share of the cells. */
PetscErrorCode DiscretisationVolumes(Discretisation *space, const PetscReal *ratio, PetscReal *volume);
/* Of each point, in grids of cells: the volume that points around ask for, `ratio` of that at the start (NULL: 1), over
 * the room that they have; collective. */
PetscErrorCode DiscretisationDensities(Discretisation *space, const PetscReal *ratio, PetscReal *density);
/* The same by what they ask for. */
PetscErrorCode DiscretisationCrowding(Discretisation *space, PetscReal *density);
/* Of its volume at the start. What has opened asks for no more than that: laws forget what has closed again, and
 * dilatancy is left alone, as far as it has room. */
static inline PetscReal point_asks(const Points *points, PetscInt p) { return PetscMin(1, points->real[POINT_J][p]); }
/* Of a method that restores its grid: no point remembers more of an opening, and has a larger J, than its surroundings
 * have room for, and what flows closer together than its volume allows is pressed (docs/theory.md, "The room that
 * points have"); between initialise and the solve. shared: do points of a cell share their change of volume? made: by
 * that, on this rank, J. */
PetscErrorCode DiscretisationRoom(Discretisation *space, PetscBool shared, PetscReal *made);
/* A step that is given up leaves its points as they were before they heard of their room, if they did. */
void discretisation_room_back(Discretisation *space);
/* Nodes that keep their history take the velocity of their body where they stand; m and touched
 * must be known. */
PetscErrorCode DiscretisationBodyVelocity(Discretisation *space);
/* impulse and lost_force where prescribed motion changes v and a of its nodes alone. */
void discretisation_impulses(Discretisation *space);
/* Points, tracers or carriers follow the field: by the basis where it is that of places, else in their cells, and the
 * same with clouds. */
PetscErrorCode DiscretisationMoveCarried(Discretisation *space, Points *carried);
PetscErrorCode DiscretisationMoveClouds(Discretisation *space, Points *carried, const Support *support);
/* Method.carries of grids of cells: until a cell beyond the grid's edge. */
PetscBool cell_carries(const Discretisation *space, const Points *followers, PetscInt p);
