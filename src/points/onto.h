/* Points of another grid. */
#pragma once
#include "points/points.h"

/* Collective. As PointsTake, from a table of points of another grid: they keep their places, and each is given
 * the cell that is there. reason tells of a point that no cell holds. */
PetscErrorCode PointsTakeOnto(Points *points, const Grid *grid, const Table *table, const PointsChange *change,
                              char reason[256]);
