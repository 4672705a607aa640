/* Support of the points: which nodes each point sees, with N and dN/dx at the start of the step.
 *
 * All that a method hands to the solve; a basis (support/basis.h) fills it. Points with the same
 * nodes may stand together in groups (a cell's points), so that the work for a group is scattered
 * once; where supports differ from point to point each is a group of its own. */
#pragma once
#include "basis/cloud/cloud_support.h"
#include "points/points.h"

/* Groups of local nodes: those of group g are node[start[g]] .. node[start[g + 1] - 1]. */
typedef struct {
  PetscInt n, *start, *node;
  PetscInt room_groups, room_nodes;
} NodeGroups;

PetscErrorCode NodeGroupsCreate(PetscInt expected,
                                /* with room for so many groups, to begin with */
                                NodeGroups *groups);
PetscErrorCode NodeGroupsAdd(NodeGroups *groups, PetscInt n, const PetscInt *node); /* one more */
PetscErrorCode NodeGroupsDestroy(NodeGroups *groups);

/* How the choice of clouds went, over all points. */
typedef struct {
  PetscInt level[SUPPORT_EMPTY + 1]; /* points of each level */
  PetscInt nodes;                    /* of all clouds together */
  /* points that are nearer to a node of what no material joins to them than to any of theirs, and the first of them */
  PetscInt entered, first_entered;
} CloudTally;

/* Groups first .. end - 1, all of as many nodes. A grid of one kind of cells has one run, a mixed
 * mesh one for each kind, clouds none. */
typedef struct {
  PetscInt nodes, first, end;
} SupportRun;

#define SUPPORT_MAX_RUNS 2

typedef struct Support {
  PetscInt n_groups;
  PetscInt capacity_groups, capacity_nodes, capacity_values;
  /* n_groups + 1: points of group g are point_start[g] .. point_start[g+1]-1 */
  PetscInt *point_start;
  PetscInt *node_start; /* n_groups + 1: its nodes are node[node_start[g] ..] */
  /* local nodes of the grid or cloud; ascending in groups of single points */
  PetscInt *node;
  /* n_groups + 1: N of point k of group g at value_start[g] + k * nn, dN at dim times that */
  PetscInt *value_start;
  PetscReal *N, *dN;
  PetscInt n_runs; /* 0 where every point is a group of its own, with as many nodes as it likes */
  SupportRun run[SUPPORT_MAX_RUNS];
  CloudTally tally; /* of clouds */
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

PetscErrorCode SupportCreate(Support **support);
PetscErrorCode SupportDestroy(Support **support);
/* Room for so many groups, their nodes and values; what is there is lost. */
PetscErrorCode SupportReserve(Support *support, PetscInt groups, PetscInt nodes, PetscInt values, PetscInt dim);
/* Shape functions of a group of one point among touched nodes only, scaled to sum to one (room for
 * CLOUD_MAX_NODES); PETSC_FALSE if there is none. */
PetscBool support_touched(const Support *support, PetscInt group, const unsigned char *touched, PetscReal *N);
