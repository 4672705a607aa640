/* The files that a case reads besides itself, and what they were when a run read them: files.txt in its directory, a
 * line for each,
 *
 *   grid.mesh = 1a2b3c4d 12345 /cases/block.msh
 *
 * with the place in the case, CRC-32, bytes, and the path: meshes (with what a .geo includes), terrains, surfaces,
 * laws of shared libraries, and the run that another one starts from. */
#pragma once
#include "case/case.h"
#include "output/directory/run_dir.h"
#include "output/seal.h"

typedef struct {
  char key[512], path[PETSC_MAX_PATH_LEN];
  FileSeal seal;
} Input;

typedef struct {
  PetscInt n;
  Input *input;
} Inputs;

/* Collective. Write the files of the case (with all its stages) into the directory of the run that reads them; nothing
 * where there are none. Errors as for the history. */
PetscErrorCode InputsWrite(MPI_Comm comm, RunDir *dir, const Case *whole);
/* Collective. Write into that directory where its run, which goes on, has its files now; what they were stays. */
PetscErrorCode InputsMoved(MPI_Comm comm, RunDir *dir, const Case *whole);
/* Of one process: what the run in the folder has read; n = 0 where it has not told. To be cleared. */
PetscErrorCode InputsRead(const char *folder, Inputs *inputs);
PetscErrorCode InputsClear(Inputs *inputs);
/* The files are where the case names them now, and what a .geo includes has moved with it. */
void inputs_move(Inputs *inputs, const Case *c);
/* Is the file another one now? Not one that is gone, of which nobody knows. */
PetscBool input_changed(const Input *input);
/* Is it a run that another one starts from? */
PetscBool input_is_run(const Input *input);
