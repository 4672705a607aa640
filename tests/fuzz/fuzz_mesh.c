/* Any bytes as a Gmsh file, and the mesh made of it in two and three dimensions. */
#include "fuzz.h"
#include "grid/mesh/file_mesh.h"

static FILE *nowhere;

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc, (void)argv;
  fuzz_start();
  nowhere = fopen("/dev/null", "w");
  return 0;
}

static void fill(const MshFile *msh, PetscInt dim)
{
  FileMesh mesh;
  Diag *diag;
  FUZZ_CALL(DiagCreate(&diag));
  FUZZ_CALL(FileMeshCreate(PETSC_COMM_SELF, &grid_mesh, dim, &mesh));
  FUZZ_CALL(FileMeshFill(&mesh, msh, "grid.mesh", diag));
  if (!mesh.grid->n_cells && !diag_errors(diag)) abort();
  FUZZ_CALL(DiagFlush(diag, nowhere));
  FUZZ_CALL(DiagDestroy(&diag));
  FUZZ_CALL(FileMeshDestroy(&mesh));
}

static void fuzz_one(const uint8_t *data, size_t n)
{
  char path[64], message[512] = "";
  MshFile *msh = NULL;
  const int fd = fuzz_file(data, n, path);
  FUZZ_CALL(MshRead(path, path, &msh, sizeof message, message));
  if (!msh && !message[0]) abort();
  if (msh) {
    fill(msh, 2);
    fill(msh, 3);
    FUZZ_CALL(MshDestroy(&msh));
  }
  close(fd);
}
