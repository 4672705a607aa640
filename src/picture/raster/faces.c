/* Faces of walls that turn to the eye, into the samples that bodies have left or are behind. */
#include "picture/raster/raster_private.h"

#define MOST_HIDDEN 0.5 /* of the bodies' samples: a wall that hides more is one that they are in */

typedef struct {
  const RasterScene *scene;
  Canvas *canvas;
  PetscInt first, index; /* number of the first face, and of this one, among all that samples show */
  PetscBool behind;      /* nothing of a body is to be hidden */
  PetscInt hidden;       /* samples of bodies that such faces would hide */
} Faces;

static PetscBool is_bodys(const Faces *f, size_t at)
{
  return (PetscBool)(f->canvas->point[at] >= 0 && f->canvas->point[at] < f->first);
}

static void count(void *context, int i, int j, float front)
{
  Faces *f = context;
  const size_t at = canvas_at(f->canvas, i, j);
  f->hidden += is_bodys(f, at) && front > f->canvas->front[at];
}

static void draw(void *context, int i, int j, float front)
{
  const Faces *f = context;
  const size_t at = canvas_at(f->canvas, i, j);
  if (f->canvas->point[at] >= 0 && f->canvas->front[at] >= front) return;
  if (f->behind && is_bodys(f, at)) return;
  f->canvas->front[at] = front;
  f->canvas->point[at] = f->index;
}

/* Of faces from..to-1, of one wall: does it hide so much of the bodies that these must be in it? */
static PetscBool holds_bodies(Faces *f, PetscInt from, PetscInt to)
{
  const Canvas *canvas = f->canvas;
  PetscInt all = 0;
  for (size_t at = 0; at < (size_t)canvas->width * (size_t)canvas->height; ++at) all += is_bodys(f, at);
  f->hidden = 0;
  for (PetscInt k = from; k < to; ++k) canvas_each(f->scene, canvas, f->scene->face + 9 * k, count, f);
  return (PetscBool)((PetscReal)f->hidden > MOST_HIDDEN * (PetscReal)all);
}

void canvas_faces(const RasterScene *scene, Canvas *canvas)
{
  Faces f = {.scene = scene, .canvas = canvas, .first = scene->n + scene->n_triangles};
  for (PetscInt from = 0, to; from < scene->n_faces; from = to) {
    for (to = from; to < scene->n_faces && scene->face_of[to] == scene->face_of[from];) ++to;
    f.behind = holds_bodies(&f, from, to);
    for (PetscInt k = from; k < to; ++k) {
      f.index = f.first + k;
      canvas_each(scene, canvas, scene->face + 9 * k, draw, &f);
    }
  }
}
