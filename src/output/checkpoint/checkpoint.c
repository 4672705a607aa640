#include "output/checkpoint/checkpoint.h"
#include <stdlib.h>
#include <string.h>
#include "output/checkpoint/checkpoint_contents.h"
#include "output/vtk/slab_file.h"
#include "talus_version.h"

/* A slab per column, in the order of the tables; those of tables that are everywhere come from rank
 * 0 and are marked in `everywhere`. */
static PetscErrorCode MakeSlabs(PetscMPIInt rank, const Tables *tables, PetscInt *n, Slab **slabs)
{
  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt t = 0; t < tables->n; ++t) *n += tables->table[t]->n;
  PetscCall(PetscCalloc1(*n, slabs));
  Slab *slab = *slabs;
  for (PetscInt t = 0; t < tables->n; ++t) {
    const Table *table = tables->table[t];
    for (PetscInt k = 0; k < table->n; ++k, ++slab) {
      const Column *column = &table->column[k];
      snprintf(slab->path, sizeof slab->path, "%s/%s", table->name, column->name);
      slab->unit = column->unit;
      slab->type = column->type;
      slab->components = column->components;
      slab->whole = table->everywhere;
      slab->rows = table->everywhere && rank ? 0 : table->rows;
      slab->data = column->data;
    }
  }
  PetscFunctionReturn(0);
}

static void describe(const Slab *slab, ContentsEntry *e)
{
  const char *slash = strchr(slab->path, '/');
  snprintf(e->table, sizeof e->table, "%.*s", (int)(slash - slab->path), slab->path);
  snprintf(e->column, sizeof e->column, "%.*s", TABLE_NAME - 1, slash + 1);
  e->type = slab->type;
  e->components = slab->components;
  e->everywhere = slab->whole;
  e->rows = slab->total;
  e->offset = PetscMax(slab->offset, 0);
  e->crc = slab->crc;
}

/* The contents list goes into the user block. */
static void write_contents(const SlabHead *head, PetscInt n, const Slab *slabs, SlabFrame *frame)
{
  Contents c = {.file_bytes = frame->size, .n = n, .entries = calloc((size_t)n + 1, sizeof(ContentsEntry))};
  char *text = NULL;
  if (c.entries) {
    for (PetscInt i = 0; i < n; ++i) describe(&slabs[i], &c.entries[i]);
    text = contents_write(&c);
  }
  /* a list that could not be made stays away, and the file counts as damaged */
  if (text && strlen(text) <= head->user_block) memcpy(frame->bytes, text, strlen(text));
  free(text);
  free(c.entries);
}

/* Room for the list: a line of a dataset has 200 bytes at most, and HDF5 wants a power of two. */
static size_t user_block(PetscInt n)
{
  size_t size = 512;
  while (size < 256 + 200 * (size_t)n) size *= 2;
  return size;
}

PetscErrorCode CheckpointWrite(MPI_Comm comm, const char *path, const Tables *tables, char reason[256])
{
  static const PetscInt64 version = CHECKPOINT_VERSION;
  const SlabAttribute attributes[] = {{"version", NULL, COLUMN_INT64, 1, &version},
                                      {"program", "talus " TALUS_VERSION, COLUMN_BYTE, 0, NULL}};
  const char **groups;
  PetscMPIInt rank;
  PetscInt n;
  Slab *slabs;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(MakeSlabs(rank, tables, &n, &slabs));
  PetscCall(PetscCalloc1(tables->n + 1, &groups));
  for (PetscInt t = 0; t < tables->n; ++t) groups[t] = tables->table[t]->name;
  const SlabHead head = {.group = "talus",
                         .groups = groups,
                         .n_attributes = 2,
                         .attributes = attributes,
                         .checksums = PETSC_TRUE,
                         .user_block = user_block(n)};
  const PetscErrorCode code = SlabFileWrite(comm, path, &head, n, slabs, write_contents, PETSC_TRUE, reason);
  PetscCall(PetscFree(groups));
  PetscCall(PetscFree(slabs));
  PetscFunctionReturn(code);
}
