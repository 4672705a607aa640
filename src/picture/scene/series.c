/* Which states of a run there are to draw. */
#include "output/directory/run_dir_files.h"
#include "output/vtk/vtk_read.h"
#include "picture/scene/scene.h"

/* Has all material left the grid by then? What cannot be read is told where it is drawn. */
static PetscErrorCode IsEmpty(const char *run, const VtkState *state, PetscBool *empty)
{
  char path[FILE_PATH + VTK_SERIES_NAME], reason[256];
  VtkFile *file;

  PetscFunctionBeginUser;
  *empty = PETSC_FALSE;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", run, state->file));
  if (VtkReadOpen(path, &file, reason)) PetscFunctionReturn(0);
  *empty = (PetscBool)(vtk_read_points(file) == 0);
  PetscCall(VtkReadClose(&file));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotSeriesRead(const PlotOptions *options, Diag *diag, VtkSeries *series, PetscInt *empty)
{
  char reason[256];
  PetscReal first = 0;
  PetscInt n = 0;
  PetscBool is;

  PetscFunctionBeginUser;
  *empty = 0;
  if (VtkSeriesRead(options->run, "points", series, reason)) {
    diag_error(diag, NULL, "cannot read '%s/points.hdf.series': %s", options->run, reason);
    *series = (VtkSeries){0};
    PetscFunctionReturn(0);
  }
  for (PetscInt k = 0; k < series->n; ++k) {
    PetscCall(IsEmpty(options->run, &series->states[k], &is));
    if (is && !(*empty)++) first = series->states[k].time;
    if (!is) series->states[n++] = series->states[k];
  }
  series->n = n;
  if (*empty && !options->even) /* which comes beside another picture */
    diag_warning(diag, NULL, "states without points are not drawn: %d of %d, the first at %.9g s", (int)*empty,
                 (int)(n + *empty), (double)first);
  PetscFunctionReturn(0);
}
