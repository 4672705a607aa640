#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "output/checkpoint/checkpoint.h"
#include "output/checkpoint/checkpoint_contents.h"
#include "output/directory/run_dir_files.h"
#include "output/vtk/slab_file.h"

/* Rank 0: the list at the start of the file. */
static PetscErrorCode ReadContents(const char *path, Contents *contents, char reason[256])
{
  char *bytes = NULL;
  struct stat info;
  PetscErrorCode code = 0;
  const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  int error = fd < 0 || fstat(fd, &info) ? errno : 0;

  PetscFunctionBeginUser;
  reason[0] = 0;
  if (!error && !S_ISREG(info.st_mode)) error = EISDIR;
  const size_t n = error ? 0 : (size_t)PetscMin(info.st_size, CONTENTS_MAX);
  if (!error) bytes = malloc(n + 1);
  if (!error && !bytes) error = ENOMEM;
  if (!error) error = file_read_at(fd, bytes, n, 0);
  if (error) {
    snprintf(reason, 256, "%s", strerror(error));
    code = PETSC_ERR_FILE_OPEN;
  } else if (!contents_read(bytes, n, (PetscInt64)info.st_size, contents, reason)) code = PETSC_ERR_FILE_UNEXPECTED;
  if (fd >= 0) close(fd);
  free(bytes);
  PetscFunctionReturn(code);
}

/* The same list on all ranks. */
static PetscErrorCode ShareContents(MPI_Comm comm, const char *path, Contents *c, PetscErrorCode *code,
                                    char reason[256])
{
  PetscMPIInt rank, bytes;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  *c = (Contents){0};
  *code = rank ? 0 : ReadContents(path, c, reason);
  PetscCallMPI(MPI_Bcast(code, 1, MPI_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(reason, 256, MPI_CHAR, 0, comm));
  if (*code) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Bcast(&c->n, 1, MPIU_INT, 0, comm));
  if (rank) c->entries = calloc((size_t)c->n + 1, sizeof *c->entries);
  PetscCheck(c->entries, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the contents of a checkpoint");
  PetscCall(PetscMPIIntCast(c->n * (PetscInt)sizeof *c->entries, &bytes));
  PetscCallMPI(MPI_Bcast(c->entries, bytes, MPI_BYTE, 0, comm));
  PetscFunctionReturn(0);
}

/* This rank's share of so many rows. */
static void share(PetscMPIInt rank, PetscMPIInt size, PetscInt64 rows, PetscInt64 *first, PetscInt64 *n)
{
  *first = rows / size * rank + PetscMin(rank, rows % size);
  *n = rows / size + (rank < rows % size ? 1 : 0);
}

/* Tables with room for this rank's share, and the place of each column in the file. */
static PetscErrorCode MakeTables(MPI_Comm comm, const Contents *c, Tables **tables, void **data, PetscInt64 *bytes,
                                 PetscInt64 *offset)
{
  PetscMPIInt rank, size;
  Table *table = NULL;
  Column *column;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(TablesCreate(tables));
  for (PetscInt i = 0; i < c->n; ++i) {
    const ContentsEntry *e = &c->entries[i];
    PetscInt64 first = 0, rows = e->rows;
    if (!e->everywhere) share(rank, size, e->rows, &first, &rows);
    if (!table || strcmp(table->name, e->table)) PetscCall(TablesAdd(*tables, e->table, e->everywhere, rows, &table));
    PetscCall(TableAdd(table, e->column, NULL, e->type, e->components, NULL, &column));
    const PetscInt64 row = (PetscInt64)column_type_bytes(e->type) * e->components;
    data[i] = column->data;
    bytes[i] = rows * row;
    offset[i] = e->offset + first * row;
  }
  PetscFunctionReturn(0);
}

/* Read this rank's shares; the worst errno of all ranks. */
static PetscErrorCode ReadShares(MPI_Comm comm, const char *path, PetscInt n, void **data, const PetscInt64 *bytes,
                                 const PetscInt64 *offset, int *error)
{
  PetscFunctionBeginUser;
  const int fd = open(path, O_RDONLY | O_CLOEXEC);
  *error = fd < 0 ? errno : 0;
  for (PetscInt i = 0; i < n && !*error; ++i) *error = file_read_at(fd, data[i], (size_t)bytes[i], (off_t)offset[i]);
  if (fd >= 0) close(fd);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, error, 1, MPI_INT, MPI_MAX, comm));
  PetscFunctionReturn(0);
}

/* Compare all checksums; a table that is everywhere counts once, on rank 0, and is the same on the
 * others, who read the same bytes. */
static PetscErrorCode Verify(MPI_Comm comm, const Contents *c, void **data, PetscInt64 *bytes, PetscErrorCode *code,
                             char reason[256])
{
  PetscMPIInt rank;
  uint32_t *crc;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMalloc1(c->n, &crc));
  for (PetscInt i = 0; rank && i < c->n; ++i)
    if (c->entries[i].everywhere) bytes[i] = 0;
  PetscCall(SlabChecksums(comm, c->n, (const void *const *)data, bytes, crc));
  for (PetscInt i = 0; !rank && i < c->n && !*code; ++i) {
    const ContentsEntry *e = &c->entries[i];
    if (crc[i] == e->crc) continue;
    snprintf(reason, 256, "the checksum of %s/%s is wrong", e->table, e->column);
    *code = PETSC_ERR_FILE_UNEXPECTED;
  }
  PetscCall(PetscFree(crc));
  PetscCallMPI(MPI_Bcast(code, 1, MPI_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(reason, 256, MPI_CHAR, 0, comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadTables(MPI_Comm comm, const char *path, const Contents *c, Tables **tables,
                                 PetscErrorCode *code, char reason[256])
{
  void **data;
  PetscInt64 *bytes, *offset;
  int error;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(c->n, &data, c->n, &bytes, c->n, &offset));
  PetscCall(MakeTables(comm, c, tables, data, bytes, offset));
  PetscCall(ReadShares(comm, path, c->n, data, bytes, offset, &error));
  if (error) {
    snprintf(reason, 256, "%s", strerror(error));
    *code = PETSC_ERR_FILE_OPEN;
  } else PetscCall(Verify(comm, c, data, bytes, code, reason));
  PetscCall(PetscFree3(data, bytes, offset));
  if (*code) PetscCall(TablesDestroy(tables));
  PetscFunctionReturn(0);
}

PetscErrorCode CheckpointRead(MPI_Comm comm, const char *path, Tables **tables, char reason[256])
{
  Contents c;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  *tables = NULL;
  memset(reason, 0, 256);
  PetscCall(ShareContents(comm, path, &c, &code, reason));
  if (!code) PetscCall(ReadTables(comm, path, &c, tables, &code, reason));
  free(c.entries);
  PetscFunctionReturn(code);
}
