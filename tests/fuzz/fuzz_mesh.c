/* Any bytes as a Gmsh file, and the mesh made of it in two and three dimensions. */
#include "fuzz.h"
#include "grid/gmsh/msh.h"

static FILE *nowhere;

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc, (void)argv;
  fuzz_start();
  nowhere = fopen("/dev/null", "w");
  return 0;
}

static void Serial(const MshFile *msh, PetscInt dim)
{
  SerialMesh *mesh = NULL;
  Diag *diag;
  FUZZ_CALL(DiagCreate(&diag));
  FUZZ_CALL(SerialMeshCreate(msh, dim, "grid.mesh", diag, &mesh));
  if (!mesh && !diag_errors(diag)) abort();
  FUZZ_CALL(DiagFlush(diag, nowhere));
  FUZZ_CALL(DiagDestroy(&diag));
  if (mesh) FUZZ_CALL(SerialMeshDestroy(&mesh));
}

static void fuzz_one(const uint8_t *data, size_t n)
{
  char path[64], message[512] = "";
  MshFile *msh = NULL;
  const int fd = fuzz_file(data, n, path);
  FUZZ_CALL(MshRead(path, path, &msh, sizeof message, message));
  if (!msh && !message[0]) abort();
  if (msh) {
    Serial(msh, 2);
    Serial(msh, 3);
    FUZZ_CALL(MshDestroy(&msh));
  }
  close(fd);
}
