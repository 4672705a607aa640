/* Reading a VTKHDF file back on one process: all partitions joined. */
#pragma once
#include <petscsys.h>

typedef struct VtkFile VtkFile;

typedef struct {
  char name[128], unit[64]; /* unit "": none */
  PetscInt components;
} VtkFieldInfo;

/* PETSC_ERR_FILE_OPEN (returned plainly, with a reason) if there is no such file or it is no
 * complete VTKHDF file. */
PetscErrorCode VtkReadOpen(const char *path, VtkFile **file, char reason[256]);
PetscErrorCode VtkReadClose(VtkFile **file);

PetscInt vtk_read_points(const VtkFile *file);                              /* number of points */
PetscInt vtk_read_fields(const VtkFile *file, const VtkFieldInfo **fields); /* of the points */

/* These return PETSC_ERR_FILE_UNEXPECTED plainly, with a reason and nothing to free, if the file is
 * damaged there. What they give is to be
 * freed with PetscFree. */
PetscErrorCode VtkReadCoordinates(VtkFile *file, PetscReal **x, char reason[256]); /* points x 3 */
/* points x components of one of vtk_read_fields */
PetscErrorCode VtkReadField(VtkFile *file, const VtkFieldInfo *field, PetscReal **data, char reason[256]);

/* The stage that it was written in, from 1 on; 0: it does not tell. */
PetscInt vtk_read_stage(const VtkFile *file);
/* The n frames of walls (12 numbers each) that were written with it; PETSC_FALSE if there are not so many. */
PetscBool vtk_read_frames(const VtkFile *file, PetscInt n, PetscReal *frames);

/* Cells: node numbers are those of the joined points. */
typedef struct {
  PetscInt n, *start, *node; /* start: n + 1 entries */
  int *type;                 /* VTK's numbers */
} VtkCells;

PetscErrorCode VtkReadTopology(VtkFile *file, VtkCells *cells, char reason[256]);
PetscErrorCode VtkCellsFree(VtkCells *cells);
