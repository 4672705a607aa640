/* Support of the points: which nodes each point sees, with N and dN/dx at the start of the step.
 *
 * All that a method hands to the solve. Points with the same nodes stand together in groups (a cell's points in fem and mpm, single
 * points in gmm), so that the work for a group is scattered once. */
#pragma once
#include "basis/cloud_support.h"
#include "grid/neighbours.h"
#include "points/points.h"

/* Groups of local nodes: those of group g are node[start[g]] .. node[start[g + 1] - 1]. */
typedef struct {
  PetscInt n, *start, *node;
} NodeGroups;

/* Groups first .. end - 1, all of as many nodes. A grid of one kind of cells has one run, a mixed mesh one for each kind, clouds none. */
typedef struct {
  PetscInt nodes, first, end;
} SupportRun;

#define SUPPORT_MAX_RUNS 2

typedef struct Support {
  PetscInt n_groups;
  PetscInt capacity_groups, capacity_nodes, capacity_values;
  PetscInt *point_start; /* n_groups + 1: points of group g are point_start[g] .. point_start[g+1]-1 */
  PetscInt *node_start;  /* n_groups + 1: its nodes are node[node_start[g] ..] */
  PetscInt *node;        /* local nodes of the grid or cloud */
  PetscInt *value_start; /* n_groups + 1: N of point k of group g at value_start[g] + k * nn, dN at dim times that */
  PetscReal *N, *dN;
  PetscInt n_runs; /* 0 where every point is a group of its own, with as many nodes as it likes */
  SupportRun run[SUPPORT_MAX_RUNS];
} Support;

/* Number of nodes of a group, and the shape functions of one of its points. */
static inline PetscInt support_nodes(const Support *s, PetscInt g) { return s->node_start[g + 1] - s->node_start[g]; }

static inline const PetscReal *support_N(const Support *s, PetscInt g, PetscInt p)
{
  return s->N + s->value_start[g] + (p - s->point_start[g]) * support_nodes(s, g);
}

/* nn x dim. */
static inline const PetscReal *support_dN(const Support *s, PetscInt g, PetscInt p, PetscInt dim)
{
  return s->dN + dim * (s->value_start[g] + (p - s->point_start[g]) * support_nodes(s, g));
}

/* Room for so many groups, their nodes and values; what is there is lost. */
PetscErrorCode SupportReserve(Support *support, PetscInt groups, PetscInt nodes, PetscInt values, PetscInt dim);
PetscErrorCode SupportCreate(Support **support);
PetscErrorCode SupportDestroy(Support **support);
/* Cells as groups: points must be sorted by cell and located (xi known). Uses grid->x. */
/* How clouds are chosen and what stands in them. */
typedef struct {
  CloudBasis basis;
  CloudSupport support;
  PetscReal h; /* m: unit of their lengths */
} CloudRule;

/* How it went, over the points of one call. */
typedef struct {
  PetscInt level[SUPPORT_EMPTY + 1]; /* points of each level */
  PetscInt nodes;                    /* of all clouds together */
} CloudTally;

/* A cloud for each point, as a group of its own; nodes are numbered as in `nodes` and ascend. Points without a node near have an empty
 * group. */
PetscErrorCode SupportFromClouds(Support *support, const Points *points, const Neighbours *nodes, const CloudRule *rule,
                                 CloudTally *tally);
/* The same for n positions x (n x dim), F = 1. */
PetscErrorCode SupportFromPositions(Support *support, PetscInt n, const PetscReal *x, const Neighbours *nodes,
                                    const CloudRule *rule, CloudTally *tally);
/* Shape functions of a cloud among touched nodes only, scaled to sum to one (room for CLOUD_MAX_NODES); PETSC_FALSE if there is none. */
PetscBool support_touched(const Support *support, PetscInt group, const unsigned char *touched, PetscReal *N);
/* The cloud of one position: node and N have room for CLOUD_MAX_NODES, dN for dim times that; returns the number of nodes. F: its
 * deformation gradient, or NULL. */
PetscInt cloud_at(const Neighbours *nodes, const CloudRule *rule, const PetscReal *x, const PetscReal *F,
                  PetscInt *node, PetscReal *N, PetscReal *dN, CloudTally *tally);

PetscErrorCode SupportFromCells(Support *support, const Points *points, const Grid *grid);
