/* Where points began, of runs that do not write displacements: the same points in the state at time 0. */
#include <string.h>
#include "picture/scene/scene.h"

/* Numbers of the points of a file, which doubles hold exactly; NULL without them. */
static PetscErrorCode ReadNumbers(VtkFile *file, PetscReal **id)
{
  const VtkFieldInfo *fields;
  const PetscInt n = vtk_read_fields(file, &fields);
  char reason[256];

  PetscFunctionBeginUser;
  *id = NULL;
  for (PetscInt i = 0; i < n && !*id; ++i)
    if (!strcmp(fields[i].name, "id") && fields[i].components == 1 && VtkReadField(file, &fields[i], id, reason))
      *id = NULL;
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadState(VtkFile *file, PlotOrigin *origin)
{
  const PetscInt n = vtk_read_points(file);
  char reason[256];

  PetscFunctionBeginUser;
  PetscCall(ReadNumbers(file, &origin->id));
  if (!origin->id) PetscFunctionReturn(0);
  if (VtkReadCoordinates(file, &origin->x, reason)) {
    PetscCall(PetscFree(origin->id));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc1(n, &origin->place));
  for (PetscInt i = 0; i < n; ++i) origin->place[i] = i;
  PetscCall(PetscSortRealWithArrayInt(n, origin->id, origin->place));
  origin->n = n;
  PetscFunctionReturn(0);
}

PetscErrorCode PlotOriginRead(const char *run, PlotOrigin *origin)
{
  char path[PETSC_MAX_PATH_LEN + VTK_SERIES_NAME], reason[256];
  VtkSeries series;
  VtkFile *file;

  PetscFunctionBeginUser;
  if (VtkSeriesRead(run, "points", &series, reason)) PetscFunctionReturn(0);
  if (series.n && series.states[0].time == 0) {
    PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", run, series.states[0].file));
    if (!VtkReadOpen(path, &file, reason)) {
      PetscCall(ReadState(file, origin));
      PetscCall(VtkReadClose(&file));
    }
  }
  PetscCall(VtkSeriesFree(&series));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotOriginFree(PlotOrigin *origin)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(origin->id));
  PetscCall(PetscFree(origin->x));
  PetscCall(PetscFree(origin->place));
  PetscFunctionReturn(0);
}

/* Where a number stands in the state at time 0; NULL: nowhere. */
static const PetscReal *began_at(const PlotOrigin *origin, PetscReal id)
{
  PetscInt low = 0, high = origin->n;
  while (low < high) {
    const PetscInt middle = (low + high) / 2;
    if (origin->id[middle] < id) low = middle + 1;
    else high = middle;
  }
  return low < origin->n && origin->id[low] == id ? origin->x + 3 * origin->place[low] : NULL;
}

PetscErrorCode PlotOriginDisplacement(const PlotOrigin *origin, VtkFile *file, const PetscReal *x, PetscReal **u)
{
  const PetscInt n = vtk_read_points(file);
  PetscReal *id;

  PetscFunctionBeginUser;
  *u = NULL;
  if (!origin->n) PetscFunctionReturn(0);
  PetscCall(ReadNumbers(file, &id));
  if (!id) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(3 * n, u));
  for (PetscInt i = 0; i < n && *u; ++i) {
    const PetscReal *began = began_at(origin, id[i]);
    for (int d = 0; d < 3 && began; ++d) (*u)[3 * i + d] = x[3 * i + d] - began[d];
    if (!began) PetscCall(PetscFree(*u));
  }
  PetscCall(PetscFree(id));
  PetscFunctionReturn(0);
}
