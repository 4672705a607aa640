/* The mesh of a file before it is shared: a grid of which rank 0 has all cells. */
#pragma once
#include "grid/gmsh/msh.h"
#include "grid/mesh/mesh.h"
#include "grid/search/tuple_table.h"

typedef struct {
  Grid *grid;       /* without what only ranks and searches need */
  PetscInt *number; /* of cells: what Gmsh calls them, for messages */
} FileMesh;

/* Without any cells. */
PetscErrorCode FileMeshCreate(MPI_Comm comm, const GridOps *ops, PetscInt dim, FileMesh *mesh);
PetscErrorCode FileMeshDestroy(FileMesh *mesh);
/* Pick the cells of a file and check them, for an empty grid; mistakes go to diag at `path`. Not
 * collective, as all below. */
PetscErrorCode FileMeshFill(FileMesh *mesh, const MshFile *msh, const char *path, Diag *diag);
/* An error, with two of the cells and where, if any lie in one another. */
PetscErrorCode FileMeshCheckOverlap(const FileMesh *mesh, const char *path, Diag *diag);
/* A warning if nodes stand at one place whose cells nothing joins, no interface of c either; NULL: there is none. */
PetscErrorCode FileMeshTellTorn(const FileMesh *mesh, const Case *c, const char *path, Diag *diag);
/* Named sets of the physical groups. face_at: for each face id of the table, cell * faces +
 * side. */
PetscErrorCode FileMeshSets(Grid *grid, const MshFile *msh, const PetscInt *node_of, const PetscInt *cell_of,
                            const TupleTable *faces, const PetscInt *face_at);
/* A warning for each set of which some sides are those of no cell. */
PetscErrorCode FileMeshTellStrays(Grid *grid, const MshFile *msh, const PetscInt *node_of, const TupleTable *faces,
                                  const char *path, Diag *diag);
/* The rank of each cell; weights as in GridCreate. */
PetscErrorCode FileMeshPartition(const Grid *grid, PetscMPIInt size, GridWeight weight, void *context,
                                 PetscMPIInt *owner);
