/* VTKHDF 1.0 UnstructuredGrid files (.hdf) and their time series (.hdf.series), as ParaView 5.11
 * opens them.
 *
 * All ranks write one file collectively, one partition each (empty ones too). A file is written
 * under a temporary name and renamed when it is complete: a reader never sees half of one. */
#pragma once
#include <petscsys.h>

typedef struct {
  const char *name, *unit; /* the unit becomes an attribute */
  PetscInt components;
  const PetscReal *data; /* n x components of this rank */
} VtkField;

typedef struct {
  PetscInt n_points;
  const PetscReal *x; /* n_points x 3 */
  PetscInt n_cells;
  /* n_cells x nodes_per_cell, local points; NULL: one vertex a point */
  const PetscInt *connectivity;
  PetscInt nodes_per_cell;
  int vtk_type; /* of the cells, but for */
  PetscInt n_first, first_nodes;
  int first_type; /* the first few, if they are of another type and have fewer nodes */
  PetscInt n_point_fields, n_cell_fields;
  const VtkField *point_fields, *cell_fields;
  const PetscInt64 *point_id; /* field "id", or NULL */
  PetscReal time;             /* s, kept as an attribute too */
  PetscInt64 stage;           /* of the run, from 1 on: FieldData/Stage; 0: it has none */
  /* n_frames x 12, of rank 0: where walls with mass are, R (3 x 3) and T of x = R X + T: FieldData/WallFrames */
  PetscInt n_frames;
  const PetscReal *frames;
} VtkData;

/* Collective. Errors of the file system (full disk, no permission) come back as
 * PETSC_ERR_FILE_WRITE on every rank, with the unfinished file removed; the caller reports and goes
 * on or stops. `reason` (256 characters) says why. */
PetscErrorCode VtkWrite(MPI_Comm comm, const char *path, const VtkData *data, char reason[256]);
/* Resume: keep the entries of DIR/NAME.hdf.series of states before number n, and forget the others; atomic. all:
 * there must be n of them.
 * Collective. No file is fine if n = 0. */
PetscErrorCode VtkSeriesKeep(MPI_Comm comm, const char *folder, const char *name, PetscInt n, PetscBool all,
                             char reason[256]);
/* Append (or replace from its number on; without numbers from this time on) an entry of DIR/NAME.hdf.series; atomic.
 * Rank 0 writes. Collective. file NULL: only forget the entries from this time on. */
PetscErrorCode VtkSeriesAppend(MPI_Comm comm, const char *folder, const char *name, const char *file, PetscReal time,
                               char reason[256]);
