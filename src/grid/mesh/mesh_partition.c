/* The rank of each cell of a mesh: PT-Scotch through PETSc, on the graph of face neighbours,
 * weighted like the box's voxels. */
#include <petscmat.h>
#include <stdlib.h>
#include "grid/mesh/file_mesh.h"

static PetscErrorCode DualGraph(const Grid *grid, Mat *graph)
{
  const PetscInt n_faces = mesh_faces(grid);
  PetscInt *start, *column, n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_cells + 1, &start));
  PetscCall(PetscMalloc1(grid->n_cells * n_faces, &column));
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    start[c] = n;
    for (PetscInt f = 0; f < n_faces; ++f)
      if (grid->mesh->neighbour[c * n_faces + f] >= 0) column[n++] = grid->mesh->neighbour[c * n_faces + f];
    PetscCall(PetscSortInt(n - start[c], column + start[c]));
  }
  start[grid->n_cells] = n;
  PetscCall(
    /* owns the arrays */
    MatCreateMPIAdj(PETSC_COMM_SELF, grid->n_cells, grid->n_cells, start, column, NULL, graph));
  PetscFunctionReturn(0);
}

/* Whole numbers, the mean loaded cell near 100 and the empty one at 5. */
static PetscErrorCode CellWeights(const Grid *grid, GridWeight weight, void *context, PetscInt **out)
{
  PetscReal *w, sum = 0, loaded = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_cells, out));
  PetscCall(PetscMalloc1(grid->n_cells, &w));
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    PetscReal centre[3];
    grid_cell_centre(grid, c, centre);
    w[c] = PetscMax(weight(context, centre), 0.0);
    sum += w[c];
    loaded += w[c] > 0;
  }
  const PetscReal scale = sum > 0 ? 100.0 * loaded / sum : 0.0;
  for (PetscInt c = 0; c < grid->n_cells; ++c) (*out)[c] = (PetscInt)PetscMin(PetscMax(w[c] * scale, 5.0), 10000.0);
  PetscCall(PetscFree(w));
  PetscFunctionReturn(0);
}

/* Scotch takes a thread for each core, and then its partition is another one at every run: neither
 * a run nor one taken up on the way would repeat itself. One thread, unless the user says
 * otherwise. */
static PetscErrorCode ApplyAlone(MatPartitioning partitioning, IS *is)
{
  static const char threads[] = "SCOTCH_PTHREAD_NUMBER";
  const PetscBool told = getenv(threads) != NULL;

  PetscFunctionBeginUser;
  if (!told) (void)setenv(threads, "1", 1);
  PetscCall(MatPartitioningApply(partitioning, is));
  if (!told) (void)unsetenv(threads);
  PetscFunctionReturn(0);
}

PetscErrorCode FileMeshPartition(const Grid *grid, PetscMPIInt size, GridWeight weight, void *context,
                                 PetscMPIInt *owner)
{
  Mat graph;
  MatPartitioning partitioning;
  IS is;
  const PetscInt *part;

  PetscFunctionBeginUser;
  /* Few cells: a cell or none on each rank. One rank: the same without a graph. */
  for (PetscInt c = 0; c < grid->n_cells; ++c) owner[c] = size == 1 ? 0 : (PetscMPIInt)c;
  if (size == 1 || grid->n_cells <= size) PetscFunctionReturn(0);
  PetscCall(DualGraph(grid, &graph));
  PetscCall(MatPartitioningCreate(PETSC_COMM_SELF, &partitioning));
  PetscCall(MatPartitioningSetAdjacency(partitioning, graph));
#if defined(PETSC_HAVE_PTSCOTCH)
  PetscCall(MatPartitioningSetType(partitioning, MATPARTITIONINGPTSCOTCH));
#else
  PetscCall(MatPartitioningSetType(partitioning, MATPARTITIONINGAVERAGE));
#endif
  PetscCall(MatPartitioningSetNParts(partitioning, size));
  if (weight) {
    PetscInt *weights;
    PetscCall(CellWeights(grid, weight, context, &weights));
    PetscCall(MatPartitioningSetVertexWeights(partitioning, weights)); /* owns them */
  }
  PetscCall(ApplyAlone(partitioning, &is));
  PetscCall(ISGetIndices(is, &part));
  for (PetscInt c = 0; c < grid->n_cells; ++c) owner[c] = (PetscMPIInt)part[c];
  PetscCall(ISRestoreIndices(is, &part));
  PetscCall(ISDestroy(&is));
  PetscCall(MatPartitioningDestroy(&partitioning));
  PetscCall(MatDestroy(&graph));
  PetscFunctionReturn(0);
}
