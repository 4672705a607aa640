/* A cloud: a grid without cells, whose nodes move, change their neighbours and may change their
 * rank.
 *
 * It fills the struct Grid like the other builders (owned nodes first, ghosts behind, node_sf), so
 * that all that works on nodes works on clouds. What others keep per node follows along: they
 * register their arrays, and a change of ghosts or owners moves the contents. */
#pragma once
#include "base/table/table.h"
#include "grid/cloud/matter.h"
#include "grid/grid.h"

#define CLOUD_MAX_FIELDS 32

enum { CLOUD_BODY = 1, CLOUD_OBSTACLE };

/* An array of n_nodes x components that somebody else holds. */
typedef struct {
  PetscReal **data;
  PetscInt components;
  const char *name, *unit; /* of what is kept: in checkpoints, too; NULL: only the size follows */
  PetscBool new;           /* zero where the state of a stage before knows nothing of it */
} CloudField;

typedef struct GridCloud {
  PetscInt *id;        /* n_nodes: for life, whatever the ranks */
  PetscInt first_twin; /* ids from here on are twins */
  PetscReal spacing;   /* of nodes in the body, at the start, m: unit of length of clouds */
  PetscReal *around;   /* n_nodes: the same around each, where cells differ much in size; NULL: `spacing` everywhere */
  PetscReal widest;    /* of these */
  PetscReal *x0;       /* n_nodes x dim: positions at the start, m */
  /* n_nodes: 1 if the node was prescribed at the start and no cell with material had it; else 0 */
  PetscReal *obstacle;
  /* Velocity fields: points find their nodes among those of their own alone; 1 where no bodies meet. */
  PetscInt n_motions;
  PetscReal *motion;   /* n_nodes: the field of each; NULL: there is one */
  CloudMatter *matter; /* which places are joined through material; NULL: all that are near */
  PetscInt n_fields;
  CloudField field[CLOUD_MAX_FIELDS];
  PetscMPIInt *ghost_rank;  /* of each ghost: its owner, */
  PetscInt *ghost_index;    /* and its local number there; ascending */
  PetscInt layouts;         /* how often ghosts or owners changed */
  PetscInt balanced_ghosts; /* over all ranks after the last change of owners; 0: not counted yet */
  PetscInt n_cells_left;    /* cells of the grid that it was made of */
} GridCloud;

/* Owned nodes of other ranks in this rank's box, ascending by rank and index. */
typedef struct {
  PetscInt n;
  PetscMPIInt *rank;
  PetscInt *index;
  PetscInt *field;  /* velocity field */
  PetscReal *x;     /* n x dim */
  PetscReal *start; /* n x dim: as cloud_start() */
} RemoteNodes;

/* What of a mesh becomes a cloud, for each of its owned nodes. */
typedef struct {
  PetscReal spacing;           /* of the cloud, */
  const PetscReal *around;     /* and around each node of the mesh; NULL: the same everywhere */
  const unsigned char *marked; /* CLOUD_BODY, or CLOUD_OBSTACLE; 0: it is left out */
  /* It gets a twin: a second node at the same place that carries the multipliers of a constraint and never is a
   * neighbour. */
  const unsigned char *twin;
  PetscInt n_motions;     /* velocity fields, */
  const PetscInt *motion; /* and that of each node, -1: it comes once in each field; NULL: there is one */
} CloudSource;

/* Collective. Spacing of nodes in the cells listed (of all ranks, each counted as often as it is
 * listed): the edge of a square or cube of their mean volume, of which a triangle is half and a
 * tetrahedron a sixth; on a box of equal cells its cell size. */
PetscErrorCode GridSpacing(const Grid *mesh, PetscInt n, const PetscInt *cell, PetscReal *spacing);
/* Collective. The same around each local node of the mesh, where cells differ much in size: *around is NULL where they
 * do not, and whoever asks frees it. */
PetscErrorCode GridSpacingAround(const Grid *mesh, PetscReal spacing, PetscReal **around);
/* Collective. The cloud of the owned nodes of a mesh that are marked. */
PetscErrorCode GridCreateCloud(const Grid *mesh, const CloudSource *source, Grid **cloud);

static inline PetscBool cloud_is_twin(const Grid *grid, PetscInt node)
{
  return grid->cloud->id[node] >= grid->cloud->first_twin;
}
/* As long as owned nodes stand as they were made: the local node of the mesh that one of them came from. */
static inline PetscInt cloud_origin(const Grid *grid, const Grid *mesh, PetscInt node)
{
  return grid->cloud->id[node] % mesh->n_nodes_global - mesh->global_node[0];
}
static inline PetscInt cloud_motion(const Grid *grid, PetscInt node)
{
  return grid->cloud->motion ? (PetscInt)grid->cloud->motion[node] : 0;
}

/* Spacing of nodes around a node at the start, m. */
static inline PetscReal cloud_spacing_around(const Grid *grid, PetscInt node)
{
  return grid->cloud->around ? grid->cloud->around[node] : grid->cloud->spacing;
}

/* Where a node was at the start; an obstacle is MATTER_ANYWHERE. */
static inline PetscReal cloud_start(const Grid *grid, PetscInt node, PetscInt d)
{
  return grid->cloud->obstacle[node] > 0 ? MATTER_ANYWHERE : grid->cloud->x0[node * grid->dim + d];
}

/* Let *field.data (n_nodes x components, from PetscMalloc1) follow the nodes; without a name its contents
 * are lost when they change. */
PetscErrorCode GridCloudFollow(const Grid *grid, CloudField field);
/* The one that followed last does no more. */
static inline void grid_cloud_forget(const Grid *grid) { --grid->cloud->n_fields; }

/* Collective. Nodes of others between box[0..2] and box[3..5]; twins left out. */
PetscErrorCode GridCloudRemote(const Grid *grid, const PetscReal box[6], RemoteNodes *remote);
PetscErrorCode GridCloudRemoteDestroy(RemoteNodes *remote);
/* Local number of each candidate if it is a ghost already, else -1. */
void cloud_find_ghosts(const Grid *grid, const RemoteNodes *remote, PetscInt *local);
/* Collective. From now on the remote with use[k] are the ghosts. */
PetscErrorCode GridCloudSetGhosts(Grid *grid, const RemoteNodes *remote, const PetscBool *use);
/* Collective. Send every owned node to the rank owner[node]; no ghosts remain. */
PetscErrorCode GridCloudMigrate(Grid *grid, const PetscMPIInt *owner);
/* Collective. So many owned nodes and no ghosts in place of what is there; what follows them is
 * zero. */
PetscErrorCode GridCloudReplace(Grid *grid, PetscInt n_owned, const PetscInt *id);

/* Nodes with all that is kept of them, and ghosts, as tables. */
PetscErrorCode CloudToTables(const Grid *grid, Tables *tables);
/* Collective. Back again: the rows of each rank become its nodes. Ghosts only come back if all rows
 * are with the ranks that wrote them. */
PetscErrorCode CloudFromTables(Grid *grid, const Tables *tables, PetscBool home, char reason[256]);
