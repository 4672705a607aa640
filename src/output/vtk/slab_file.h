/* One HDF5 file written by all ranks at once: laid out by rank 0, reserved on the disk, filled by
 * every rank with its own rows, and put in place when it is complete. */
#pragma once
#include "output/vtk/slab_layout.h"

/* Writes into the first bytes of the laid-out file (its user block), on rank 0. */
typedef void (*SlabPreface)(const SlabHead *head, PetscInt n, const Slab *slabs, SlabFrame *frame);

/* Collective. The slabs come with path, unit, type, components, matrix, rows and data. Errors of
 * the file system come back as PETSC_ERR_FILE_WRITE on every rank with a reason, and nothing is
 * left behind. durable: the directory is flushed too, so that the file's name outlives a power
 * failure. preface: NULL for none. */
PetscErrorCode SlabFileWrite(MPI_Comm comm, const char *path, const SlabHead *head, PetscInt n, Slab *slabs,
                             SlabPreface preface, PetscBool durable, char reason[256]);

/* CRC-32 (as zlib has it) of the parts of this comm's ranks one behind the other, for n pieces at
 * once; on rank 0. Collective. */
PetscErrorCode SlabChecksums(MPI_Comm comm, PetscInt n, const void *const *data, const PetscInt64 *bytes,
                             uint32_t *crc);
