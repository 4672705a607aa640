/* A Gmsh file as it stands, and the serial mesh made of it. Both live on rank 0 only. */
#pragma once
#include "grid/grid_private.h"

#define MSH_MAX_NODES 8

typedef struct {
  const char *name;
  PetscInt code, dim, nodes; /* code: Gmsh's number; nodes: 0 for types that talus does not know */
} MshType;

typedef struct {
  PetscInt dim, tag;
  char *name;
} MshName;

/* All elements of all dimensions, in the order of the file. Nodes are named by their index in x. */
typedef struct {
  PetscInt n_nodes, *node_tag;
  PetscReal *x; /* n_nodes x 3 */
  PetscInt n_elements;
  const MshType **type;
  PetscInt *tag, *entity; /* entity: the geometric curve, surface or volume it meshes */
  PetscInt *node;         /* n_elements x MSH_MAX_NODES */
  PetscInt n_marks, mark_capacity, *mark_element,
    *mark_group; /* element mark_element[k] is in physical group mark_group[k] */
  PetscInt n_names;
  MshName *names;
} MshFile;

/* Read versions 2.2 and 4.1, ASCII or binary. Not collective. On a mistake in the file *msh is NULL
 * and `message` says where and what; the file is called `shown` in it. */
PetscErrorCode MshRead(const char *path, const char *shown, MshFile **msh, size_t size, char *message);
PetscErrorCode MshDestroy(MshFile **msh);

/* Run gmsh on a .geo (not collective); `output` gets the name of a temporary file that the caller
 * removes. */
PetscErrorCode GeoRun(const char *path, PetscInt dim, PetscInt n_parameters, const NamedValue *parameters, size_t size,
                      char *output, size_t message_size, char *message);

/* Cells of one type, nodes that they use, and their neighbours. */
typedef struct {
  PetscInt dim;
  CellType type;
  PetscInt n_cells, n_nodes;
  PetscInt *cell_node, *number; /* number: Gmsh's element number */
  PetscReal *x;                 /* n_nodes x dim */
  PetscInt *neighbour;          /* n_cells x faces: the cell beyond, -1 outside */
  PetscInt n_sets;
  GridSet *sets;
} SerialMesh;

/* Pick the cells of a file and check them; mistakes go to diag at `path` and *mesh stays NULL. Not
 * collective. */
PetscErrorCode SerialMeshCreate(const MshFile *msh, PetscInt dim, const char *path, Diag *diag, SerialMesh **mesh);
PetscErrorCode SerialMeshDestroy(SerialMesh **mesh);
/* An error, with two of the cells and where, if any lie in one another. */
PetscErrorCode SerialMeshCheckOverlap(const SerialMesh *mesh, const char *path, Diag *diag);
/* Named sets of the physical groups. face_at: for each face id of the table, cell * faces + side. */
typedef struct TupleTable TupleTable;
PetscErrorCode SerialMeshSets(SerialMesh *mesh, const MshFile *msh, const PetscInt *node_of, const PetscInt *cell_of,
                              const TupleTable *faces, const PetscInt *face_at);

/* The rank of each cell. Not collective; weights as in GridCreate. */
PetscErrorCode SerialMeshPartition(const SerialMesh *mesh, PetscMPIInt size, GridWeight weight, void *context,
                                   PetscInt *owner);
/* Hand out the parts. Collective; mesh and owner matter on rank 0 only. */
PetscErrorCode GridDistribute(MPI_Comm comm, const SerialMesh *mesh, const PetscInt *owner, Grid **grid);

/* tuple_table.c: ids of sets of nodes (cells, faces), whatever their order. */
PetscErrorCode TupleTableCreate(PetscInt width, PetscInt capacity, TupleTable **table);
PetscErrorCode TupleTableDestroy(TupleTable **table);
/* The id of a tuple, which is new if it equals the number of those before. */
PetscInt tuple_add(TupleTable *table, const PetscInt *nodes);
/* -1: unknown. */
PetscInt tuple_find(const TupleTable *table, const PetscInt *nodes);
PetscInt tuple_count(const TupleTable *table);
