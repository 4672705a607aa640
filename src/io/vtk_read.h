/* Reading a VTKHDF file back on one process: all partitions joined. */
#pragma once
#include <petscsys.h>

typedef struct VtkFile VtkFile;

typedef struct {
  char name[128], unit[64]; /* unit "": none */
  PetscInt components;
} VtkFieldInfo;

/* PETSC_ERR_FILE_OPEN (returned plainly, with a reason) if there is no such file or it is no complete
 * VTKHDF file. */
PetscErrorCode VtkReadOpen(const char *path, VtkFile **file, char reason[256]);
PetscErrorCode VtkReadClose(VtkFile **file);

PetscInt VtkReadPoints(const VtkFile *file); /* number of points */
PetscInt VtkReadCells(const VtkFile *file);
PetscReal VtkReadTime(const VtkFile *file);
PetscInt VtkReadFields(const VtkFile *file, const VtkFieldInfo **fields); /* of the points */

/* To be freed with PetscFree. */
PetscErrorCode VtkReadCoordinates(VtkFile *file, PetscReal **x);                /* points x 3 */
PetscErrorCode VtkReadField(VtkFile *file, const char *name, PetscReal **data); /* points x components */
/* Cells: start has VtkReadCells + 1 entries; node numbers are those of the joined points. */
PetscErrorCode VtkReadTopology(VtkFile *file, PetscInt **start, PetscInt **node, int **vtk_type);
