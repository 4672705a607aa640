/* Where everything stands in a VTKHDF file.
 *
 * HDF5 lays the file out once, on one rank, in memory: groups, attributes and the place of every
 * dataset. The numbers themselves are written by each rank at the offsets found here. So the HDF5
 * library never meets a full disk (it cannot close a file that it cannot flush), every error has its
 * errno, and no rank waits for another in the middle of a write. */
#pragma once
#include <petscsys.h>

typedef enum { VTK_SLAB_REAL, VTK_SLAB_INT64, VTK_SLAB_BYTE } VtkSlabType;

/* A dataset of all ranks, of which this one holds `rows` rows from `first` on. */
typedef struct {
  char path[256];   /* below the group VTKHDF: "PointData/velocity" */
  const char *unit; /* attribute of the dataset; NULL or "": none */
  VtkSlabType type;
  PetscInt components; /* numbers a row */
  PetscBool matrix;    /* two-dimensional even with one component */
  PetscInt64 rows, first, total;
  const void *data;  /* rows x components */
  PetscInt64 offset; /* in the file, bytes; -1: nothing to write */
} VtkSlab;

static inline PetscInt64 vtk_row_bytes(const VtkSlab *slab)
{
  const PetscInt64 size[] = {sizeof(double), sizeof(PetscInt64), 1};
  return size[slab->type] * slab->components;
}

/* The file but for its numbers: the first `n` bytes, and how long it is as a whole. */
typedef struct {
  char *bytes; /* of malloc */
  size_t n;
  PetscInt64 size;
} VtkFrame;

/* Lay out the datasets (path, unit, type, components, total) and find their offsets. frame->bytes is to
 * be freed. PETSC_FALSE if HDF5 would not; then there is nothing to free. Not collective. */
PetscBool vtk_layout(PetscInt n, VtkSlab *slabs, PetscReal time, VtkFrame *frame);
