/* From the balls of a frame to an image of colours. */
#include <math.h>
#include "picture/raster/raster.h"
#include "picture/scene/scene.h"
#include "picture/walls/walls.h"
#include "picture/revolution/revolution.h"

/* Pixels along a section that is turned: more are of no use. */
#define SECTION_PIXELS 2000
#define AIR 0.06 /* of the radius: cells of fem have no gap, and rays must come from outside of the body */
#define BLUR 0.8 /* of the distance from point to point, where fields are smoothed */

void plot_blend(unsigned char *rgba, PetscReal grey, PetscReal alpha)
{
  const PetscReal kept = rgba[3] / 255. * (1 - alpha), all = alpha + kept;
  if (alpha <= 0) return;
  for (int c = 0; c < 3; ++c) rgba[c] = (unsigned char)lround((alpha * grey + kept * rgba[c]) / all);
  rgba[3] = (unsigned char)lround(255 * all);
}

static PetscErrorCode Balls(const PlotScene *scene, const PlotFrame *f, RasterScene *raster, unsigned char *rgba)
{
  const PetscReal low = scene->named ? 0 : scene->low, span = scene->named ? 1 : scene->high - scene->low;
  PetscReal *colour, *corner;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(f->n, &colour, 3 * f->n_triangles, &corner));
  for (PetscInt i = 0; i < f->n; ++i) colour[i] = (f->value[i] - low) / span;
  for (PetscInt i = 0; i < 3 * f->n_triangles; ++i) corner[i] = (f->corner_value[i] - low) / span;
  raster->n = f->n;
  raster->x = f->x, raster->radius = f->radius, raster->value = colour;
  raster->n_triangles = f->n_triangles;
  raster->corner = f->corner, raster->corner_value = corner, raster->side = scene->grid ? f->side : NULL;
  raster->n_parts = f->n_parts, raster->part = f->part;
  raster->n_faces = f->n_faces, raster->face = f->face, raster->face_of = f->face_of;
  raster->n_lines = f->n_lines, raster->line = f->line;
  raster->named = scene->named;
  raster->gap = f->gap;
  raster->blur = scene->smooth ? BLUR * scene->gap : 0;
  const PlotOutline outline = {.c = scene->walled, .contours = scene->contours, .frame = f};
  raster->knows = f->knows, raster->holds = plot_shape_holds, raster->of = &outline;
  PetscCall(RasterDraw(raster, rgba));
  PetscCall(PetscFree2(colour, corner));
  PetscFunctionReturn(0);
}

/* The section as a flat image with air around it, then turned. */
static PetscErrorCode Turned(const PlotScene *scene, const PlotFrame *f, const PlotPage *page, unsigned char *rgba)
{
  const PetscReal *min = scene->box_min, *max = scene->box_max, air = PetscMax(scene->gap, AIR * max[0]);
  const PetscReal wide = max[0] - min[0] + 2 * air, high = max[1] - min[1] + 2 * air;
  const PetscReal pixel = PetscMax((page->max[0] - page->min[0]) / page->w, PetscMax(wide, high) / SECTION_PIXELS);
  RasterScene flat = {.min = {min[0] - air, min[1] - air},
                      .width = PetscMax((int)ceil(wide / pixel), 2),
                      .height = PetscMax((int)ceil(high / pixel), 2)};
  TurnedScene turned = {.section_width = flat.width,
                        .section_height = flat.height,
                        .section_min = {flat.min[0], flat.min[1]},
                        .pixel = pixel,
                        .smooth = 0.35 * scene->gap,
                        .min = {page->min[0], page->min[1]},
                        .max = {page->max[0], page->max[1]},
                        .width = page->w,
                        .height = page->h};
  unsigned char *section;

  PetscFunctionBeginUser;
  flat.max[0] = flat.min[0] + flat.width * pixel, flat.max[1] = flat.min[1] + flat.height * pixel;
  plot_project(scene, (PetscReal[]){1, 0, 0}, turned.x);
  plot_project(scene, (PetscReal[]){0, 1, 0}, turned.y);
  plot_project(scene, (PetscReal[]){0, 0, 1}, turned.z);
  PetscCall(PetscMalloc1((size_t)flat.width * (size_t)flat.height * 4, &section));
  PetscCall(Balls(scene, f, &flat, section));
  turned.section = section;
  PetscCall(TurnedDraw(&turned, rgba));
  PetscCall(PetscFree(section));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotImage(const PlotScene *scene, const PlotFrame *f, const PlotPage *page, unsigned char *rgba)
{
  RasterScene raster = {.shaded = scene->dim == 3,
                        .min = {page->min[0], page->min[1]},
                        .max = {page->max[0], page->max[1]},
                        .width = page->w,
                        .height = page->h};
  unsigned char *solid = NULL;

  PetscFunctionBeginUser;
  if (!scene->turned) PetscCall(PlotWallsMask(scene, f, page, &solid));
  raster.solid = solid;
  if (scene->turned) PetscCall(Turned(scene, f, page, rgba));
  else PetscCall(Balls(scene, f, &raster, rgba));
  if (scene->dim == 2) PetscCall(PlotFirstDraw(scene, f, page, rgba));
  plot_walls_draw(scene, f, page, rgba);
  PetscCall(PetscFree(solid));
  PetscFunctionReturn(0);
}
