/* Which bodies an entry of the boundary is for: nodes stand at one place once for each velocity field. */
#pragma once
#include "grid/grid.h"
#include "points/points.h"

/* Collective. field (n_nodes): the velocity field of each local node; a box has nodes of its own for each field, of a
 * mesh it is that of the body whose cells they are of, and -1 where there is none. */
PetscErrorCode NodeFields(const Grid *grid, const Case *c, const Points *points, PetscInt *field);

/* Local nodes that the entry takes (sorted): of its place, those of the fields of its bodies; field NULL: of all. */
PetscErrorCode EntryNodes(const Grid *grid, const Case *c, const MotionSpec *entry, const PetscInt *field, PetscInt *n,
                          PetscInt **nodes);
/* Is the entry for bodies alone that are not there yet? */
PetscBool bodies_come_later(const Case *c, const MotionSpec *entry);

/* Entries that name a body and leave out another one that has the same nodes. */
void bodies_check(const Case *c, Diag *diag);
