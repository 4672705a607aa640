/* Points that leave a rank, for this room only. */
#pragma once
#include "points/points.h"

/* Points whose cell this rank does not have. */
typedef struct {
  PetscInt n;
  PetscInt *point;     /* their index */
  PetscInt *last_cell; /* the user's number of the cell where each was; -1: none */
  PetscMPIInt *owner;  /* rank that holds the position; -1: none so far, LEAVER_HERE: this one */
} Leavers;

#define LEAVER_HERE (-2)

/* Points in flight: packed, from several ranks. */
typedef struct {
  PetscInt n;
  char *data; /* one message after the other */
  PetscInt n_messages, *count;
} Arrivals;

static inline PetscBool position_is_finite(PetscInt dim, const PetscReal *x)
{
  PetscReal sum = 0; /* x - x is 0 unless x is infinite or not a number */
  for (PetscInt d = 0; d < dim; ++d) sum += x[d] - x[d];
  return sum == 0;
}

/* Point p is on its way out: before it is dropped or put back, and (gone = -1) after it was put
 * back with what it has kept. */
static inline void tally_outside(Points *points, PetscInt p, PetscReal gone)
{
  OutsideTally *t = &points->outside;
  const PetscReal mass = points->real[POINT_MASS][p];
  for (PetscInt d = 0; d < points->dim; ++d) {
    const PetscReal v = point_real(points, POINT_V, p)[d];
    t->momentum[d] += gone * mass * v;
    t->kinetic += gone * 0.5 * mass * v * v;
  }
  if (gone < 0 || (t->removed + t->held > 0 && points->id[p] > t->first)) return;
  t->first = points->id[p];
  for (PetscInt d = 0; d < points->dim; ++d) t->place[d] = point_real(points, POINT_X, p)[d];
}

/* Collective: ask the ranks that might hold them for the leavers without an owner; the lowest that
 * does becomes owner. */
PetscErrorCode LeaversFindOwners(const Leavers *leavers, const Points *points, const Grid *grid);
/* Collective: move leavers that nobody holds to the nearest position in the grid, and find their
 * owner there. */
PetscErrorCode LeaversClamp(const Leavers *leavers, Points *points, const Grid *grid);
/* Collective: pack the leavers that have an owner and send them; arrivals is what others sent. The
 * points stay in the table. */
PetscErrorCode LeaversSend(const Leavers *leavers, const Points *points, const Grid *grid, Arrivals *arrivals);
/* Append what arrived, each point with its cell and reference position. */
PetscErrorCode ArrivalsUnpack(Arrivals *arrivals, Points *points, const Grid *grid);
/* Collective: send the leavers that have an owner, drop the points with gone[p], and append what
 * arrived as it is: the cells are those of the receiver already. */
PetscErrorCode LeaversMove(const Leavers *leavers, Points *points, const Grid *grid, const PetscBool *gone);
