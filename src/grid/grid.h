/* The background grid (mpm) or the mesh (fem): cells, nodes, regions, and who owns what.
 *
 * Each rank holds its own cells and every node they touch. Local nodes are numbered owned first,
 * ghosts after; `node_sf` ties the ghosts to their owners. A box fills the struct by arithmetic (no
 * rank ever holds more than its part), a mesh from a file that rank 0 reads. */
#pragma once
#include <petscsf.h>
#include <petscdmplex.h>
#include "basis/cell.h"
#include "base/diag/diag.h"
#include "base/table/table.h"
#include "case/case.h"

/* A named set: of nodes and faces (boundary) or of cells (region). A box has left right (x), bottom
 * top (y) and in 3D front (lowest z) back (highest z); a mesh has its physical groups. */
typedef struct {
  char *name;
  PetscInt n_nodes, *nodes; /* local nodes, ghosts too */
  /* local cell and its side; each face on one rank only */
  PetscInt n_faces, *face_cell, *face_side;
  PetscInt n_cells, *cells;
} GridSet;

typedef struct GridOps GridOps; /* what this kind of grid can do */
/* What only one kind has: counts and lines of a box, search and neighbours of a mesh, what follows
 * a cloud's nodes. */
typedef struct GridBox GridBox;
typedef struct GridMesh GridMesh;
typedef struct GridCloud GridCloud;

typedef struct Grid {
  MPI_Comm comm;
  PetscInt dim;
  /* velocity fields: cells and nodes stand so many times, field by field, each where the others are;
   * 0 of a mesh or cloud, which has one */
  PetscInt n_fields;
  CellType type;             /* of cells; where a mesh mixes two, the one with more nodes */
  CellType first_type;       /* and the other one, the same if there is none: */
  PetscInt n_first;          /* as many of its cells stand before those of `type` on this rank */
  PetscInt nodes_per_cell;   /* of `type` */
  PetscInt n_cells;          /* of this rank */
  PetscInt n_owned, n_nodes; /* nodes owned; owned and ghosts */
  PetscInt n_cells_global, n_nodes_global;
  /* n_cells x nodes_per_cell, local nodes; a cell of fewer repeats its last one */
  PetscInt *cell_node;
  PetscReal *x;          /* n_nodes x dim; fem moves them */
  PetscInt *global_node; /* n_nodes: owner's first + its local number */
  /* n_cells: its place in the file, or in the box (x fastest), from 0; whatever the ranks */
  PetscInt *global_cell;
  PetscSF node_sf; /* roots: owned nodes; leaves: ghosts, as local nodes */
  PetscInt n_sets;
  GridSet *sets;            /* same names in the same order on every rank */
  GridSet outer;            /* the whole outer boundary: nodes and faces; has no name */
  PetscReal min[3], max[3]; /* of the whole grid */
  PetscReal smallest;       /* smallest cell size over all ranks, m */
  /* per rank: min[3], max[3] of its cells; who might know a lost point */
  PetscReal (*rank_bounds)[6];
  const GridOps *ops;
  GridBox *box; /* these are NULL but for the kind that it is */
  GridMesh *mesh;
  GridCloud *cloud; /* has no cells, sets and search of cells */
} Grid;

/* Weight of a cell with this centre in the partition (points it will carry); NULL: all alike. */
typedef PetscReal (*GridWeight)(void *context, const PetscReal *centre);

/* Collective. Mistakes of the user (unreadable mesh, inverted cells...) go to diag, and *grid stays
 * NULL. */
PetscErrorCode GridCreate(MPI_Comm comm, const Case *c, GridWeight weight, void *context, Diag *diag, Grid **grid);
/* The same from a mesh file alone (spec->mesh, spec->parameters); mistakes are reported at `path`
 * of the case: for bodies that bring their own mesh. Collective. */
PetscErrorCode GridCreateMesh(MPI_Comm comm, const GridSpec *spec, PetscInt dim, const char *path, GridWeight weight,
                              void *context, Diag *diag, Grid **grid);
/* Collective. A mesh that reaches beyond the axis of these kinematics is a mistake, told at `path`:
 * *grid is then NULL. */
PetscErrorCode GridCheckAxis(const Kinematics *kinematics, const char *path, Diag *diag, Grid **grid);
/* Collective. The same grid, shared alike, in its place, where each rank knows so many layers of
 * nodes beyond those of its cells: of a box; of a mesh all nodes of the cells at its outer boundary, if
 * any. On several ranks; clouds stay as they are. */
PetscErrorCode GridWiden(Grid **grid, PetscInt layers);
PetscErrorCode GridDestroy(Grid **grid);

/* Collective. The grid that `old` is, shared among the ranks by `weight` of its local cells (>= 0;
 * 0: empty). *reached: the largest weight of a rank over the mean that such a sharing has; if that
 * is more than `worst` there is no use in it, and *grid stays NULL. `old` stays as it is. Not for
 * clouds. */
PetscErrorCode GridRepartition(const Grid *old, const PetscReal *weight, PetscReal worst, PetscReal *reached,
                               Grid **grid);
/* Collective. Who has what, as a table, and the same grid shared in that way by as many ranks.
 * reason is left empty, or says on every rank why not. */
PetscErrorCode GridPartitionToTable(const Grid *grid, Tables *tables);
PetscErrorCode GridFromPartition(const Grid *old, const Table *table, Grid **grid, char reason[256]);

const GridSet *grid_find_set(const Grid *grid, const char *name);
/* Names of all sets, NULL-terminated, to be freed with PetscFree (not the names). */
PetscErrorCode GridSetNames(const Grid *grid, const char ***names);
/* Collective. Is the name that of a boundary? If not, an error at path, with those that there are. */
PetscErrorCode GridCheckBoundary(const Grid *grid, const char *name, const char *path, Diag *diag, PetscBool *good);

/* Local nodes that the selector takes (sorted). With no condition at all: the whole outer
 * boundary. */
PetscErrorCode GridSelectNodes(const Grid *grid, const Selector *on, PetscInt *n, PetscInt **nodes);
/* Does a place in space, that is, the selector's ranges and shape, hold x? */
PetscBool grid_takes(const Grid *grid, const Selector *on, const PetscReal *x);
/* Faces on the outer boundary that the selector takes, each on one rank only. */
PetscErrorCode GridSelectFaces(const Grid *grid, const Selector *on, PetscInt *n, PetscInt **cell, PetscInt **side);

/* The search below stands on the positions that the nodes had when the grid was made: do not use it
 * once fem has moved them.
 *
 * Local cell that holds the position x, or -1; `guess` is tried first (-1: none). xi gets the
 * reference position (dim). A position on a face between cells belongs to one of them, the same at
 * every call. Of several fields the cell is that of the first. */
PetscInt grid_locate(const Grid *grid, const PetscReal *x, PetscInt guess, PetscReal *xi);
/* The nearest position inside the grid as a whole (for `outside: keep-on-boundary`): of a box
 * exactly; of a mesh the nearest boundary face of this rank. */
void grid_clamp(const Grid *grid, PetscReal *x);
/* Ranks other than this one whose cells may hold x, at most `max`; returns how many. O(1) on
 * boxes. */
PetscInt grid_candidates(const Grid *grid, const PetscReal *x, PetscInt max, PetscMPIInt *ranks);

/* Do its sides lie across the axes? */
PetscBool grid_is_aligned(const Grid *grid);
/* The name of the side of a box across an axis (0 1 2), the lower or the upper one. */
const char *box_side_name(PetscInt axis, int high);
/* Is it always shared in the same way among as many ranks, when it is made for the same case? */
PetscBool grid_starts_alike(const Grid *grid);
/* Are all cells cut from squares or cubes of one size? */
PetscBool grid_cells_alike(const Grid *grid);

/* Ghost exchange for an array of n_nodes x components: owner to ghosts, and the sum of all copies
 * to the owner (the ghosts keep their part). Collective. */
PetscErrorCode GridToGhosts(const Grid *grid, PetscInt components, PetscReal *values);
PetscErrorCode GridSumToOwners(const Grid *grid, PetscInt components, PetscReal *values);

/* The cell in another field than the first, and the field of a cell. */
static inline PetscInt grid_cell_in(const Grid *grid, PetscInt cell, PetscInt field)
{
  return field && cell >= 0 ? cell + field * (grid->n_cells / grid->n_fields) : cell;
}
static inline PetscInt grid_field_of(const Grid *grid, PetscInt cell)
{
  return grid->n_fields > 1 ? cell / (grid->n_cells / grid->n_fields) : 0;
}

static inline PetscBool grid_is_mixed(const Grid *grid) { return grid->first_type != grid->type; }

static inline CellType grid_cell_type(const Grid *grid, PetscInt cell)
{
  return cell < grid->n_first ? grid->first_type : grid->type;
}

static inline const Cell *grid_cell(const Grid *grid, PetscInt cell) { return cells + grid_cell_type(grid, cell); }

/* Node positions of a cell, nodes_per_cell x dim. */
static inline void grid_cell_x(const Grid *grid, PetscInt cell, PetscReal *x)
{
  const PetscInt nn = grid->nodes_per_cell, dim = grid->dim, *node = grid->cell_node + cell * nn;
  for (PetscInt i = 0; i < nn; ++i)
    for (PetscInt d = 0; d < dim; ++d) x[i * dim + d] = grid->x[node[i] * dim + d];
}
/* Mean of its nodes; a third coordinate that the grid does not have is 0. */
void grid_cell_centre(const Grid *grid, PetscInt cell, PetscReal centre[3]);
/* Shape functions N (nodes_per_cell) of the cell at xi; 0 for those nodes that a cell of fewer
 * repeats. */
void grid_shape(const Grid *grid, PetscInt cell, const PetscReal *xi, PetscReal *N);
