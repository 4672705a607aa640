#include "picture/walls/walls.h"
#include <math.h>
#include "input/case_file.h"
#include "picture/curves/runs.h"

enum { FILL = 214, LINE = 50 };
#define LINE_WIDTH 2.0 /* pixels */

PetscErrorCode PlotWallsOpen(const char *run, Diag *diag, PlotScene *scene)
{
  Diag *own; /* a run may be drawn whatever became of its case */

  PetscFunctionBeginUser;
  PetscCall(CaseReadKept(PETSC_COMM_SELF, run, &scene->walled));
  PetscCall(DiagCreate(&own));
  if (scene->walled && scene->walled->n_walls) PetscCall(WallsCreate(scene->walled, own, &scene->walls));
  if (scene->walls && diag_errors(own)) {
    diag_warning(diag, NULL, "the walls are not drawn: '%s/case.yaml' names files that cannot be read any more", run);
    PetscCall(WallsDestroy(&scene->walls));
  }
  PetscCall(DiagDestroy(&own));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotWallsClose(PlotScene *scene)
{
  PetscFunctionBeginUser;
  PetscCall(WallsDestroy(&scene->walls));
  PetscCall(CaseDestroy(&scene->walled));
  PetscFunctionReturn(0);
}

/* Along axis d from low to high, as far as the grid goes; along one without an end nothing. */
static void extend(PlotScene *scene, int d, PetscReal low, PetscReal high)
{
  const GridSpec *grid = &scene->walled->grid;
  if (low < -1e30 || high > 1e30) return;
  if (grid->kind == GRID_BOX) low = PetscMax(low, grid->min[d]), high = PetscMin(high, grid->max[d]);
  scene->box_min[d] = PetscMin(scene->box_min[d], low);
  scene->box_max[d] = PetscMax(scene->box_max[d], high);
}

void plot_walls_extend(PlotScene *scene)
{
  if (!scene->walls || scene->turned) return;
  for (PetscInt f = 0; f < scene->n_frames; ++f) {
    if (scene->frames[f].walls) walls_put_frames(scene->walls, scene->frames[f].walls);
    for (PetscInt k = 0; k < scene->walled->n_walls; ++k) {
      PetscReal min[3], max[3];
      if (!wall_stands(scene->walls, k, scene->frames[f].time)) continue;
      wall_bounds(scene->walls, k, scene->frames[f].time, min, max);
      for (int d = 0; d < scene->dim; ++d) extend(scene, d, min[d], max[d]);
    }
  }
  if (scene->mirrored) scene->box_min[0] = -scene->box_max[0];
}

static PetscReal share(PetscReal pixels) { return PetscMin(PetscMax(pixels + 0.5, 0), 1); }

/* How much of the pixel at x is wall, and how much outline. */
static void cover(const PlotScene *scene, PetscReal t, const PetscReal x[2], PetscReal pixel, PetscReal *fill,
                  PetscReal *line)
{
  *fill = *line = 0;
  for (PetscInt k = 0; k < scene->walled->n_walls; ++k) {
    WallPlace place;
    if (!wall_near(scene->walls, k, t, x, 2 * LINE_WIDTH * pixel, 0, &place)) continue;
    *fill = PetscMax(*fill, share(-place.gap / pixel));
    *line = PetscMax(*line, share(0.5 * LINE_WIDTH - fabs(place.gap) / pixel));
  }
}

PetscErrorCode PlotWallsMask(const PlotScene *scene, const PlotFrame *frame, const PlotPage *page, unsigned char **mask)
{
  const PetscReal pixel = (page->max[0] - page->min[0]) / page->w;
  PetscReal line, fill;

  PetscFunctionBeginUser;
  *mask = NULL;
  if (!scene->walls || scene->dim != 2) PetscFunctionReturn(0);
  if (frame->walls) walls_put_frames(scene->walls, frame->walls);
  PetscCall(PetscMalloc1(page->w * page->h, mask));
  for (int i = 0; i < page->w * page->h; ++i) {
    const int column = i % page->w, row = i / page->w;
    PetscReal x[2] = {page->min[0] + (column + 0.5) * pixel, page->min[1] + (row + 0.5) * pixel};
    if (scene->mirrored) x[0] = fabs(x[0]);
    cover(scene, frame->time, x, pixel, &fill, &line);
    (*mask)[i] = fill > 0.5;
  }
  PetscFunctionReturn(0);
}

void plot_walls_draw(const PlotScene *scene, const PlotFrame *frame, const PlotPage *page, unsigned char *rgba)
{
  const PetscReal pixel = (page->max[0] - page->min[0]) / page->w;
  if (!scene->walls || scene->dim != 2) return;
  if (frame->walls) walls_put_frames(scene->walls, frame->walls);
  for (int row = 0; row < page->h; ++row)
    for (int column = 0; column < page->w; ++column, rgba += 4) {
      PetscReal x[2] = {page->min[0] + (column + 0.5) * pixel, page->min[1] + (row + 0.5) * pixel}, fill, line;
      if (scene->mirrored) x[0] = fabs(x[0]);
      cover(scene, frame->time, x, pixel, &fill, &line);
      plot_blend(rgba, FILL, fill);
      plot_blend(rgba, LINE, line);
    }
}
