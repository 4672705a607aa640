/* Where the body was in the beginning: places without their displacements, whose outline is drawn as a line. */
#include <math.h>
#include <string.h>
#include "picture/raster/raster.h"
#include "picture/raster/spacing.h"
#include "picture/scene/scene.h"

/* Pixels. */
#define LEAST_WAY 4
/* A picture grows by so much of its size for the outline, and else shows a part of it. */
#define MOST_GROWTH 0.3
enum { GREY = 60 };

PetscErrorCode PlotReadDisplacement(VtkFile *file, PetscReal **u, char reason[256])
{
  const VtkFieldInfo *fields;
  const PetscInt n = vtk_read_fields(file, &fields);

  PetscFunctionBeginUser;
  *u = NULL;
  for (PetscInt i = 0; i < n; ++i) {
    if (strcmp(fields[i].name, "displacement") != 0 || fields[i].components != 3) continue;
    if (VtkReadField(file, &fields[i], u, reason)) *u = NULL;
    break;
  }
  PetscFunctionReturn(0);
}

/* Sizes of points among those of their own part. */
static PetscErrorCode SpacingOfParts(const PlotFrame *f, const PetscReal *x, PetscReal *radius)
{
  PetscReal *own, *size;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(3 * f->n, &own, f->n, &size));
  for (PetscInt part = 0; part < f->n_parts; ++part) {
    PetscInt n = 0;
    for (PetscInt i = 0; i < f->n; ++i)
      if (f->part[i] == part) memcpy(own + 3 * n++, x + 3 * i, 3 * sizeof *x);
    PetscCall(PlotSpacing(2, n, own, size));
    for (PetscInt i = f->n; i-- > 0;)
      if (f->part[i] == part) radius[i] = size[--n];
  }
  PetscCall(PetscFree2(own, size));
  PetscFunctionReturn(0);
}

/* Bodies that are apart have outlines of their own, and sizes of points among their own. */
static PetscErrorCode SizeParts(PlotFrame *f)
{
  PetscFunctionBeginUser;
  if (f->n_parts < 2) PetscFunctionReturn(0);
  PetscCall(SpacingOfParts(f, f->x, f->radius));
  if (f->n_first == f->n) PetscCall(SpacingOfParts(f, f->first, f->first_radius));
  PetscFunctionReturn(0);
}

static void include(const PetscReal *x, PetscInt n, PetscReal min[2], PetscReal max[2])
{
  for (PetscInt i = 0; i < n; ++i)
    for (int d = 0; d < 2; ++d) min[d] = PetscMin(min[d], x[3 * i + d]), max[d] = PetscMax(max[d], x[3 * i + d]);
}

PetscErrorCode PlotFirstShape(PlotScene *scene)
{
  PetscReal min[2] = {scene->box_min[0], scene->box_min[1]}, max[2] = {scene->box_max[0], scene->box_max[1]};

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < scene->n_frames; ++k) {
    PlotFrame *f = &scene->frames[k];
    if (f->first && !f->first_corner) PetscCall(PlotSpacing(2, f->n_first, f->first, f->first_radius));
    if (!f->first_corner) PetscCall(SizeParts(f));
    if (f->first && !f->first_corner) PetscCall(PlotShapes(scene->walled, scene->contours, f));
    if (scene->bare || scene->turned) continue;
    if (f->first && !f->first_corner) include(f->first, f->n_first, min, max);
    if (f->first_corner) include(f->first_corner, 3 * f->n_triangles, min, max);
  }
  const PetscReal size = PetscMax(scene->box_max[0] - scene->box_min[0], scene->box_max[1] - scene->box_min[1]);
  for (int d = 0; d < 2; ++d) {
    if (scene->box_min[d] - min[d] < MOST_GROWTH * size) scene->box_min[d] = min[d];
    if (max[d] - scene->box_max[d] < MOST_GROWTH * size) scene->box_max[d] = max[d];
  }
  PetscFunctionReturn(0);
}

/* Bodies that hardly moved cover their outline, and of one that began beside the page a piece would tell nothing. */
static PetscBool shows_first(const PlotFrame *f, const PlotPage *page)
{
  const PetscBool cells = f->first_corner != NULL;
  const PetscReal *from = cells ? f->first_corner : f->first, *to = cells ? f->corner : f->x;
  const PetscInt n = cells ? 3 * f->n_triangles : f->n_first;
  PetscReal way = 0, min[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, max[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL};
  for (PetscInt i = 0; i < n; ++i) way = PetscMax(way, hypot(to[3 * i] - from[3 * i], to[3 * i + 1] - from[3 * i + 1]));
  include(from, n, min, max);
  for (int d = 0; d < 2; ++d)
    if (min[d] + max[d] < 2 * page->min[d] || min[d] + max[d] > 2 * page->max[d]) return PETSC_FALSE;
  return (PetscBool)(way >= LEAST_WAY * (page->max[0] - page->min[0]) / page->w);
}

/* A line where the image goes over from full to empty: how steep it is there, of both neighbours along each axis. */
static PetscReal edge_at(const unsigned char *rgba, int w, int h, int column, int row)
{
  const int left = PetscMax(column - 1, 0), right = PetscMin(column + 1, w - 1), low = PetscMax(row - 1, 0),
            high = PetscMin(row + 1, h - 1);
  const double across = rgba[4 * (row * w + right) + 3] - rgba[4 * (row * w + left) + 3],
               up = rgba[4 * (high * w + column) + 3] - rgba[4 * (low * w + column) + 3];
  return PetscMin(hypot(across, up) / 255., 1) * 0.6;
}

/* Where points have left the grid, those that are there began in a part of their body: the whole of it, in an image
 * with samples as the rasters' are. */
static void fill_whole(const PlotOutline *outline, const RasterScene *raster, unsigned char *rgba)
{
  enum { FINE = 3 };
  const PetscReal step = (raster->max[0] - raster->min[0]) / raster->width / FINE;
  for (int row = 0; row < raster->height; ++row)
    for (int column = 0; column < raster->width; ++column) {
      int held = 0;
      for (int k = 0; k < FINE * FINE; ++k) {
        const int across = column * FINE + k % FINE, up = row * FINE + k / FINE;
        const PetscReal x[3] = {raster->min[0] + (across + 0.5) * step, raster->min[1] + (up + 0.5) * step, 0};
        held += plot_bodies_hold(outline, x);
      }
      unsigned char *alpha = rgba + 4 * ((size_t)row * (size_t)raster->width + (size_t)column) + 3;
      *alpha = (unsigned char)PetscMax(*alpha, 255 * held / (FINE * FINE));
    }
}

/* The body as it was at first, on the page and around it: what the page cuts has no outline along the cut. */
static PetscErrorCode DrawFirst(const PlotScene *scene, const PlotFrame *f, const PlotPage *page, int around,
                                unsigned char *rgba)
{
  const PetscReal pixel = (page->max[0] - page->min[0]) / page->w;
  const PlotOutline outline = {.c = scene->walled, .contours = scene->contours, .frame = f, .first = PETSC_TRUE};
  RasterScene raster = {.width = page->w + 2 * around, .height = page->h + 2 * around};
  PetscReal *zero;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(PetscMax(f->n_first, 3 * f->n_triangles), &zero));
  for (int d = 0; d < 2; ++d)
    raster.min[d] = page->min[d] - around * pixel, raster.max[d] = page->max[d] + around * pixel;
  raster.gap = scene->gap;
  raster.n_parts = f->n_parts, raster.part = f->part;
  raster.knows = f->shape, raster.holds = plot_shape_holds, raster.of = &outline;
  if (f->first_corner) raster.n_triangles = f->n_triangles, raster.corner = f->first_corner, raster.corner_value = zero;
  else raster.n = f->n_first, raster.x = f->first, raster.radius = f->first_radius, raster.value = zero;
  PetscCall(RasterDraw(&raster, rgba));
  if (scene->walled->grid.outside == OUTSIDE_REMOVE && f->n) fill_whole(&outline, &raster, rgba);
  PetscCall(PetscFree(zero));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotFirstDraw(const PlotScene *scene, const PlotFrame *f, const PlotPage *page, unsigned char *rgba)
{
  const PetscReal pixel = (page->max[0] - page->min[0]) / page->w;
  const int around = 2 + (int)PetscMin(2 * scene->gap / pixel, page->w);
  const int w = page->w + 2 * around, h = page->h + 2 * around;
  unsigned char *first;

  PetscFunctionBeginUser;
  if (scene->bare || (!f->first && !f->first_corner) || !shows_first(f, page)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1((size_t)w * (size_t)h * 4, &first));
  PetscCall(DrawFirst(scene, f, page, around, first));
  for (int row = 0; row < page->h; ++row)
    for (int column = 0; column < page->w; ++column)
      plot_blend(rgba + 4 * ((size_t)row * (size_t)page->w + (size_t)column), GREY,
                 edge_at(first, w, h, column + around, row + around));
  PetscCall(PetscFree(first));
  PetscFunctionReturn(0);
}
