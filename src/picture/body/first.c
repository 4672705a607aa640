/* Where the body was in the beginning: places without their displacements, whose outline is drawn as a line. */
#include <math.h>
#include <string.h>
#include "picture/raster/raster.h"
#include "picture/raster/spacing.h"
#include "picture/scene/scene.h"

/* Bodies that moved less, in pixels, cover their outline. */
#define LEAST_WAY 4
/* A picture grows by so much of its size for the outline, and else shows a part of it. */
#define MOST_GROWTH 0.3
enum { GREY = 60, MOST_PARTS = 16 };

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

/* Of bodies between which there are interfaces: the first whose shape held the place where a point began. Bodies that
 * are regions of a mesh have no shape to tell. */
static PetscErrorCode FindParts(const Case *c, PlotFrame *f)
{
  PetscFunctionBeginUser;
  if (!c->n_interfaces || c->n_bodies > MOST_PARTS || f->n != f->n_first) PetscFunctionReturn(0);
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (!c->bodies[b].has_shape) PetscFunctionReturn(0);
  f->n_parts = c->n_bodies;
  PetscCall(PetscMalloc1(f->n, &f->part));
  for (PetscInt i = 0; i < f->n; ++i) {
    const PetscReal at[3] = {fabs(f->first[3 * i]), f->first[3 * i + 1], 0};
    const PetscReal *x = c->kinematics->hoop ? at : f->first + 3 * i;
    PetscInt b = 0;
    while (b + 1 < c->n_bodies && !shape_contains(&c->bodies[b].shape, 2, x, 0)) ++b;
    f->part[i] = (unsigned char)b;
  }
  PetscCall(SpacingOfParts(f, f->x, f->radius));
  PetscCall(SpacingOfParts(f, f->first, f->first_radius));
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
    if (f->first && !f->first_corner) PetscCall(FindParts(scene->walled, f));
    if (f->first && !f->first_corner) PetscCall(PlotShapes(scene->walled, f));
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

/* The longest way on the page, m. */
static PetscReal longest_way(const PlotFrame *f)
{
  const PetscBool cells = f->first_corner != NULL;
  const PetscReal *from = cells ? f->first_corner : f->first, *to = cells ? f->corner : f->x;
  PetscReal way = 0;
  for (PetscInt i = 0; i < (cells ? 3 * f->n_triangles : f->n_first); ++i)
    way = PetscMax(way, hypot(to[3 * i] - from[3 * i], to[3 * i + 1] - from[3 * i + 1]));
  return way;
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

PetscErrorCode PlotFirstDraw(const PlotScene *scene, const PlotFrame *f, const PlotPage *page, unsigned char *rgba)
{
  const PetscReal pixel = (page->max[0] - page->min[0]) / page->w;
  const PetscBool cells = f->first_corner != NULL;
  PetscReal *zero;
  unsigned char *first;

  PetscFunctionBeginUser;
  if (scene->bare || (!f->first && !cells) || longest_way(f) < LEAST_WAY * pixel) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(PetscMax(f->n_first, 3 * f->n_triangles), &zero));
  PetscCall(PetscMalloc1((size_t)page->w * (size_t)page->h * 4, &first));
  RasterScene raster = {
    .min = {page->min[0], page->min[1]}, .max = {page->max[0], page->max[1]}, .width = page->w, .height = page->h};
  raster.gap = scene->gap;
  raster.n_parts = f->n_parts, raster.part = f->part;
  const PlotOutline outline = {.c = scene->walled, .frame = f, .first = PETSC_TRUE};
  raster.knows = f->shape, raster.holds = plot_shape_holds, raster.of = &outline;
  if (cells) raster.n_triangles = f->n_triangles, raster.corner = f->first_corner, raster.corner_value = zero;
  else raster.n = f->n_first, raster.x = f->first, raster.radius = f->first_radius, raster.value = zero;
  PetscCall(RasterDraw(&raster, first));
  for (int row = 0; row < page->h; ++row)
    for (int column = 0; column < page->w; ++column)
      plot_blend(rgba + 4 * ((size_t)row * (size_t)page->w + (size_t)column), GREY,
                 edge_at(first, page->w, page->h, column, row));
  PetscCall(PetscFree(first));
  PetscCall(PetscFree(zero));
  PetscFunctionReturn(0);
}
