/* Where everything stands in an HDF5 file that all ranks write together.
 *
 * HDF5 lays the file out once, on one rank, in memory: groups, attributes and the place of every
 * dataset. The numbers themselves are written by each rank at the offsets found here. So the HDF5
 * library never meets a full disk (it cannot close a file that it cannot flush), every error has
 * its errno, and no rank waits for another in the middle of a write. */
#pragma once
#include "base/table/table.h"

/* A dataset of all ranks, of which this one holds `rows` rows from `first` on. */
typedef struct {
  char path[256];   /* below the group of the head: "PointData/velocity" */
  const char *unit; /* attribute of the dataset; NULL or "": none */
  ColumnType type;
  PetscInt components; /* numbers a row */
  PetscBool matrix;    /* two-dimensional even with one component */
  PetscBool whole;     /* for the writer: every reader wants all rows */
  PetscInt64 rows, first, total;
  const void *data;  /* rows x components */
  PetscInt64 offset; /* in the file, bytes; -1: nothing to write */
  uint32_t crc;      /* CRC-32 of all rows, on rank 0, if the head asks for it */
} Slab;

static inline PetscInt64 slab_row_bytes(const Slab *slab)
{
  return (PetscInt64)column_type_bytes(slab->type) * slab->components;
}

/* An attribute of the head's group: a text, or n numbers. */
typedef struct {
  const char *name, *text; /* text NULL: numbers */
  ColumnType type;
  PetscInt n;
  const void *values;
} SlabAttribute;

/* What a file has besides its datasets. */
typedef struct {
  const char *group;
  const char *const *groups; /* below it, ended by NULL */
  PetscInt n_attributes;
  const SlabAttribute *attributes;
  PetscBool checksums; /* every dataset gets its CRC-32 as an attribute */
  size_t user_block;   /* bytes before HDF5's own: 0, or a power of two >= 512 */
} SlabHead;

/* The file but for its numbers: the first `n` bytes, and how long it is as a whole. */
typedef struct {
  char *bytes; /* of malloc */
  size_t n;
  PetscInt64 size;
} SlabFrame;

/* Lay out the datasets (path, unit, type, components, total, crc) and find their offsets.
 * frame->bytes is to be freed. PETSC_FALSE if HDF5 would not; then there is nothing to free. Not
 * collective. */
PetscBool slab_layout(const SlabHead *head, PetscInt n, Slab *slabs, SlabFrame *frame);
