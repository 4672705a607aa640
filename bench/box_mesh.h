/* The box of a benchmark as a Gmsh file of the same cells. */
#pragma once
#include "bench.h"

static inline void write_mesh(const Grid *grid, FILE *out)
{
  static const int msh_type[] = {2, 3, 4, 5};
  fprintf(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", (int)grid->n_nodes);
  for (PetscInt i = 0; i < grid->n_nodes; ++i) {
    fprintf(out, "%d", (int)i + 1);
    for (PetscInt d = 0; d < 3; ++d) fprintf(out, " %.17g", d < grid->dim ? grid->x[i * grid->dim + d] : 0.0);
    fprintf(out, "\n");
  }
  fprintf(out, "$EndNodes\n$Elements\n%d\n", (int)grid->n_cells);
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    fprintf(out, "%d %d 2 0 1", (int)c + 1, msh_type[grid->type]);
    for (PetscInt i = 0; i < grid->nodes_per_cell; ++i)
      fprintf(out, " %d", (int)grid->cell_node[c * grid->nodes_per_cell + i] + 1);
    fprintf(out, "\n");
  }
  fprintf(out, "$EndElements\n");
}

/* Collective. Rank 0 writes the file; it is to be removed after the grid was made. */
static inline PetscErrorCode BoxToMesh(BenchCase *b, size_t size, char *path)
{
  PetscMPIInt rank;
  Diag *diag;
  Grid *grid;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  if (!rank) {
    snprintf(path, size, "/tmp/talus-bench-%ld.msh", (long)getpid());
    PetscCall(DiagCreate(&diag));
    PetscCall(GridCreate(PETSC_COMM_SELF, &b->c, NULL, NULL, diag, &grid));
    FILE *out = fopen(path, "w");
    PetscCheck(grid && out, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write %s", path);
    write_mesh(grid, out);
    fclose(out);
    PetscCall(GridDestroy(&grid));
    PetscCall(DiagDestroy(&diag));
  }
  PetscCallMPI(MPI_Bcast(path, (PetscMPIInt)size, MPI_CHAR, 0, PETSC_COMM_WORLD));
  b->c.grid.kind = GRID_MESH;
  b->c.grid.mesh = path;
  PetscFunctionReturn(0);
}
