/* What a point sees, or a node follows, as a sum over nodes. */
#pragma once
#include "grid/box/box.h"
#include "basis/cloud/cloud.h"

#define WAYS 27 /* to the nodes around: -1, 0 or 1 along each axis */

/* Nodes ascend, as in groups of single points. */
typedef struct {
  PetscInt n, node[CLOUD_MAX_NODES];
  PetscReal N[CLOUD_MAX_NODES], dN[4 * CLOUD_MAX_NODES];
} Row;

void way_of(PetscInt way, PetscInt step[3]);
/* How many these bits are. */
PetscInt ways_many(PetscInt ways);
/* The local node one step from here, -1 if this rank knows none there. */
PetscInt node_beside(const GridBox *box, const PetscInt at[LATTICE], const PetscInt step[3]);
/* share times N and dN (so many slopes) more of a node. */
void row_add(Row *row, PetscInt slopes, PetscInt node, PetscReal share, PetscReal N, const PetscReal *dN);
/* The same of what a node at this place follows on one way; PETSC_FALSE where this rank does not know all of it. lean:
 * of each node the share of the slope that it gives as the one behind; NULL: all of it. */
PetscBool row_add_way(Row *row, PetscInt slopes, const GridBox *box, const PetscInt at[LATTICE], const PetscInt step[3],
                      const PetscReal *lean, PetscReal share, PetscReal N, const PetscReal *dN);
/* The same of a node at this place that follows on these ways (bits), from all of them alike; PETSC_FALSE where this
 * rank does not know all nodes that it follows. */
PetscBool row_add_follower(Row *row, PetscInt slopes, const GridBox *box, const PetscInt at[LATTICE], PetscInt ways,
                           PetscReal N, const PetscReal *dN);
