/* Support of the points: which nodes each point sees, with N and dN/dx at the start of the step.
 *
 * All that a method hands to the solve. Points with the same nodes stand together in groups (a cell's points in fem and mpm, single
 * points in gmm), so that the work for a group is scattered once. */
#pragma once
#include "points/points.h"

typedef struct Support {
  PetscInt n_groups;
  PetscInt capacity_groups, capacity_nodes, capacity_values;
  PetscInt *point_start; /* n_groups + 1: points of group g are point_start[g] .. point_start[g+1]-1 */
  PetscInt *node_start;  /* n_groups + 1: its nodes are node[node_start[g] ..] */
  PetscInt *node;        /* local nodes of the grid or cloud */
  PetscInt *value_start; /* n_groups + 1: N of point k of group g at value_start[g] + k * nn, dN at dim times that */
  PetscReal *N, *dN;
  PetscInt uniform; /* nodes per group if it is the same for all, else 0 */
} Support;

PetscErrorCode SupportCreate(Support **support);
PetscErrorCode SupportDestroy(Support **support);
/* Cells as groups: points must be sorted by cell and located (xi known). Uses grid->x. */
PetscErrorCode SupportFromCells(Support *support, const Points *points, const Grid *grid);
