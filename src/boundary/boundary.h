/* Prescribed motion of grid nodes and the reactions to it.
 *
 * Motions are increments over a step. On a grid that is restored every step (mpm) they belong to
 * places, which stay or take part in the motion (`moves`); on a mesh that moves (fem) to the nodes
 * selected at the start. Either way a rotation turns the node's present position about its
 * centre.
 *
 * Nodes that slide along walls (`fix: [normal]`) may have frames of their own: `fixed` and `entry`
 * are of the components in the frame. Their prescribed increments are zero but for axes that the
 * frame leaves as they are, so that these are components along the axes, too. */
#pragma once
#include "boundary/frames.h"
#include "boundary/normals.h"
#include "grid/cloud/cloud.h"
#include "points/points.h"

typedef struct {
  PetscInt n, *node; /* local nodes, ghosts too */
  PetscInt faces; /* the axis across the plane in which all of them stand at the start, -1: there is none, or several */
} MotionNodes;

/* Increment over [t0, t1] of a node that stands at x (dim) at t0, m, in place of what the case
 * prescribes: a field of motion that no list of entries could give, such as a uniform
 * deformation. */
typedef void (*MotionField)(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment);

typedef struct Boundary {
  const Case *c;
  PetscInt dim, n_nodes;
  PetscInt *body_field; /* n_nodes: the velocity field of each; NULL: no entry names bodies, or nodes are a cloud's */
  MotionNodes *motion;  /* one per entry of the case's boundary; in axisymmetry the axis behind them */
  unsigned char *fixed; /* n_nodes x dim */
  /* n_nodes x dim: the entry that prescribes the dof, -1 if none; of several the first one that faces along it, or the
   * first of all */
  PetscInt *entry;
  PetscInt n_walls; /* nodes that slide */
  WallNode *walls;
  PetscInt n_sides; /* of those at which several entries meet */
  WallSide *sides;
  Frames frames; /* of those that need one */
  /* of a cloud: n_nodes x entries, 1 where the entry took the node at the start; follows the
   * nodes */
  PetscReal *member;
  MotionField field; /* NULL: as the case says; not where nodes slide */
  void *field_context;
} Boundary;

/* Collective. Points tell whose nodes are whose. Unknown boundaries, entries that select nothing, and contradictory
 * entries go to diag. */
PetscErrorCode BoundaryCreate(const Grid *grid, const Case *c, const Points *points, Diag *diag, Boundary **boundary);
/* Collective. Carry a boundary of the mesh over to the cloud that has just been made of its owned nodes. */
PetscErrorCode BoundaryToCloud(const Boundary *of_mesh, const Grid *mesh, Grid *cloud, Boundary **boundary);
/* Lists and marks anew from `member`, after the cloud's ghosts or owners changed. */
PetscErrorCode BoundaryFollow(Boundary *boundary, const Grid *cloud);
/* Collective. The same boundary on `grid`, which is the grid that it was made for, shared among the
 * ranks in another way, with its points. */
PetscErrorCode BoundaryRegrid(Boundary **boundary, const Grid *grid, const Points *points);
PetscErrorCode BoundaryDestroy(Boundary **boundary);

/* Which of `motion` is the axis, whose nodes the program holds along x; -1: there is none. */
PetscInt boundary_axis(const Boundary *boundary);
/* Is the node held by the axis alone? It slides along it. */
PetscBool boundary_slides_on_axis(const Boundary *boundary, PetscInt node);

/* For a grid that is restored: choose anew, at time t, the nodes of the places that move. Where
 * entries have come to overlap, the first of them prescribes. */
PetscErrorCode BoundaryMove(Boundary *boundary, const Grid *grid, PetscReal t);

/* Where on a grid of a box what is held ends: rim (n_nodes), bit d for nodes of an entry, whose place stays
 * where it is, beside which along axis d stands a node that is not of it; ghosts too, but for those at the edge
 * of what this rank knows. */
PetscErrorCode BoundaryRims(const Boundary *boundary, const Grid *grid, unsigned char *rim);

/* Increments over [t0, t1] of all prescribed dofs (others untouched), n_nodes x dim, m. */
void boundary_increments(const Boundary *boundary, const Grid *grid, PetscReal t0, PetscReal t1, PetscReal *increment);

/* May the boundary hold the node along this axis, in its frame or as it is? */
static inline PetscBool boundary_holds(const Boundary *boundary, PetscInt node, PetscInt axis)
{
  return boundary->fixed[node * boundary->dim + axis] || frame_of(&boundary->frames, node);
}

/* (x, y) or (x, y, z) */
void boundary_place(PetscInt dim, const PetscReal *x, char text[64]);

/* Collective. Sum over the nodes of one entry of nodal forces (n_nodes x dim, owners count), N. A component that
 * several entries prescribe is that of one of them alone (Boundary.entry). */
PetscErrorCode BoundarySum(const Boundary *boundary, const Grid *grid, PetscInt entry, const PetscReal *force,
                           PetscReal sum[3]);
/* Collective. Does the entry bear anything (Boundary.entry), or has it no nodes at all? */
PetscErrorCode BoundaryHasOwn(const Boundary *boundary, const Grid *grid, PetscInt entry, PetscBool *has);
