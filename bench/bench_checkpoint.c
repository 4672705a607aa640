/* A checkpoint of an elastic block that falls: seconds to write and to read it back, bytes a point.
 *
 *   mpiexec -n 2 build/bench/bench_checkpoint [-dim 2] [-points 1000000] [-folder /tmp] [-repeat
 *   3] */
#include "bench.h"
#include "output/checkpoint/checkpoint.h"
#include "model/state/state.h"

/* Best times of several, over the slowest rank: the clock's, and this process's own work. */
typedef struct {
  PetscReal write, write_work, read, read_work, restore;
} Times;

static PetscErrorCode Write(Model *m, const char *path, Times *best)
{
  Tables *tables;
  char reason[256];
  PetscReal t[2];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
  const PetscReal start = seconds_now(), worked = processor_now();
  PetscCall(TablesCreate(&tables));
  PetscCall(ModelToTables(m, tables));
  const PetscErrorCode code = CheckpointWrite(PETSC_COMM_WORLD, path, tables, reason);
  PetscCheck(!code, PETSC_COMM_WORLD, PETSC_ERR_FILE_WRITE, "%s: %s", path, reason);
  PetscCall(TablesDestroy(&tables));
  t[0] = seconds_now() - start, t[1] = processor_now() - worked;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, t, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  best->write = PetscMin(best->write, t[0]);
  best->write_work = PetscMin(best->write_work, t[1]);
  PetscFunctionReturn(0);
}

static PetscErrorCode Read(Model *m, const char *path, Times *best)
{
  Tables *tables;
  char reason[256];
  PetscReal t[3];

  PetscFunctionBeginUser;
  const PetscReal start = seconds_now(), worked = processor_now();
  const PetscErrorCode code = CheckpointRead(PETSC_COMM_WORLD, path, &tables, reason);
  PetscCheck(!code, PETSC_COMM_WORLD, PETSC_ERR_FILE_READ, "%s: %s", path, reason);
  t[0] = seconds_now() - start, t[1] = processor_now() - worked;
  PetscCall(ModelFromTables(m, tables, reason));
  PetscCheck(!reason[0], PETSC_COMM_WORLD, PETSC_ERR_FILE_READ, "%s: %s", path, reason);
  PetscCall(TablesDestroy(&tables));
  t[2] = seconds_now() - start - t[0];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, t, 3, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  best->read = PetscMin(best->read, t[0]);
  best->read_work = PetscMin(best->read_work, t[1]);
  best->restore = PetscMin(best->restore, t[2]);
  PetscFunctionReturn(0);
}

static PetscErrorCode Measure(PetscInt dim, PetscInt points, PetscInt repeats, const char *folder)
{
  const PetscReal filled = (PetscReal)points / (dim == 2 ? 4 : 8);
  const PetscInt n = (PetscInt)(PetscPowReal(filled, 1.0 / (PetscReal)dim) + 0.5);
  Times t = {1e30, 1e30, 1e30, 1e30, 1e30};
  char path[PETSC_MAX_PATH_LEN];
  BenchCase b;
  Subject s;
  FILE *file;

  PetscFunctionBeginUser;
  bench_block(&b, dim, n, n / 2);
  PetscCall(SubjectCreate(&b.c, &s));
  PetscCall(ModelActivate(s.model));
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/bench_checkpoint.h5", folder));
  for (PetscInt k = 0; k < repeats; ++k) {
    PetscCall(Write(s.model, path, &t));
    PetscCall(Read(s.model, path, &t));
  }
  PetscCheck((file = fopen(path, "r")), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s", path);
  fseeko(file, 0, SEEK_END);
  const double bytes = (double)ftello(file), megabytes = bytes / 1e6;
  fclose(file);
  PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
  unlink(path);
  PetscCall(
    PetscPrintf(PETSC_COMM_WORLD,
                "  %dD, %d points: %.0f bytes a point [target 400], %.0f MB; write %.2f s [target 2 s for 1M], of "
                "which work %.2f; read %.2f s (work %.2f), restore %.2f s\n",
                (int)dim, (int)s.points, bytes / (double)s.points, megabytes, (double)t.write, (double)t.write_work,
                (double)t.read, (double)t.read_work, (double)t.restore));
  PetscCall(ModelDestroy(&s.model));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscInt dim = 2, points = 1000000, repeats = 3;
  char folder[PETSC_MAX_PATH_LEN] = "/tmp";

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-dim", &dim, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-points", &points, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-repeat", &repeats, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-folder", folder, sizeof folder, NULL));
  PetscCall(Measure(dim, points, repeats, folder));
  PetscCall(PetscFinalize());
  return 0;
}
