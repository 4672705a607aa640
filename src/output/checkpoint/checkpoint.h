/* Checkpoints: tables of state in one HDF5 file that checks itself (docs/checkpoint.md).
 *
 * The file begins with a contents list in plain text, in HDF5's user block: every dataset with its
 * type, size, place and CRC-32, and the CRC-32 of the list. Reading needs nothing else, so that a
 * damaged file is found out before anything believes it. */
#pragma once
#include "base/table/table.h"

#define CHECKPOINT_VERSION 10

/* Collective. Written whole or not at all, and on the disk when this returns. PETSC_ERR_FILE_WRITE
 * on every rank with a reason if the file system refuses. */
PetscErrorCode CheckpointWrite(MPI_Comm comm, const char *path, const Tables *tables, char reason[256]);

/* Collective. All tables, every checksum verified; each rank gets an equal share of the rows, in
 * the order of the file, and all rows of the tables that are everywhere. PETSC_ERR_FILE_UNEXPECTED
 * (returned plainly, on every rank, with a reason) for a file that is damaged, cut off or of
 * another version, PETSC_ERR_FILE_OPEN for one that cannot be read; *tables stays NULL then. */
PetscErrorCode CheckpointRead(MPI_Comm comm, const char *path, Tables **tables, char reason[256]);
