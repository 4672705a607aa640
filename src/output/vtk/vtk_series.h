/* Reading the list of states that a run has written (NAME.hdf.series). */
#pragma once
#include <petscsys.h>

#define VTK_SERIES_NAME 256

typedef struct {
  char file[VTK_SERIES_NAME]; /* relative to the folder of the series */
  PetscReal time;             /* s */
} VtkState;

typedef struct {
  PetscInt n;
  VtkState *states; /* in the order of time */
} VtkSeries;

/* No file, or one without entries: n = 0. PETSC_ERR_FILE_UNEXPECTED (returned plainly, with a
 * reason) if it is damaged. Not collective. */
PetscErrorCode VtkSeriesRead(const char *folder, const char *name, VtkSeries *series, char reason[256]);
PetscErrorCode VtkSeriesFree(VtkSeries *series);
