/* The surface that balls in space make together: how far in front it is, without the bumps of single balls, and the
 * light on it. What is far behind a place is another surface, and has no part in it. */
#include <math.h>
#include "picture/raster/raster_private.h"
#include "picture/raster/spacing.h"

/* Of a ball's radius: how far around a place the surface is smoothed, and how far behind it another one begins. */
#define WIDE 1.1
#define BEHIND 2.0
enum { PASSES = 2, MOST_WIDE = 24, EXACT_WIDE = 2 }; /* pixels; of surfaces that points know */

typedef struct {
  int w, h, wide;
  float behind, *depth, *next; /* pixels; -INFINITY where there is no ball */
  unsigned char *exact;        /* does the ball know the surface? */
  float weight[MOST_WIDE + 1];
} Relief;

static PetscErrorCode ReliefCreate(const RasterScene *scene, const Canvas *canvas, Relief *r)
{
  PetscReal radius;

  PetscFunctionBeginUser;
  PetscCall(PlotQuantile(scene->n, scene->radius, 0.5, &radius));
  const double pixels = (double)(radius * canvas->scale / SAMPLES);
  *r = (Relief){.w = scene->width, .h = scene->height, .behind = (float)(BEHIND * pixels)};
  r->wide = (int)PetscMin(PetscMax(ceil(WIDE * pixels), 1), MOST_WIDE);
  for (int k = 0; k <= r->wide; ++k) r->weight[k] = expf(-2.f * (float)(k * k) / (float)(r->wide * r->wide));
  PetscCall(PetscMalloc2(r->w * r->h, &r->depth, r->w * r->h, &r->next));
  PetscCall(PetscCalloc1(r->w * r->h, &r->exact));
  for (int at = 0; at < r->w * r->h; ++at) r->depth[at] = -INFINITY;
  for (int j = 0; j < canvas->height; ++j)
    for (int i = 0; i < canvas->width; ++i) {
      const size_t sample = canvas_at(canvas, i, j);
      const PetscInt p = canvas->point[sample];
      const int at = j / SAMPLES * r->w + i / SAMPLES;
      if (p < 0 || canvas->front[sample] / SAMPLES <= r->depth[at]) continue;
      r->depth[at] = canvas->front[sample] / SAMPLES;
      r->exact[at] = scene->knows && scene->knows[p];
    }
  PetscFunctionReturn(0);
}

/* Mean along one axis of what belongs to the same surface. */
static float smooth_at(const Relief *r, int column, int row, int across)
{
  const float here = r->depth[row * r->w + column];
  const int wide = r->exact[row * r->w + column] ? PetscMin(r->wide, EXACT_WIDE) : r->wide;
  float sum = 0, all = 0;
  for (int k = -wide; k <= wide; ++k) {
    const int i = column + (across ? k : 0), j = row + (across ? 0 : k);
    if (i < 0 || j < 0 || i >= r->w || j >= r->h) continue;
    const float depth = r->depth[j * r->w + i], weight = r->weight[abs(k)];
    if (!(fabsf(depth - here) < r->behind)) continue;
    sum += weight * depth, all += weight;
  }
  return all > 0 ? sum / all : here;
}

static void smooth(Relief *r)
{
  for (int pass = 0; pass < 2 * PASSES; ++pass) {
    for (int j = 0; j < r->h; ++j)
      for (int i = 0; i < r->w; ++i)
        r->next[j * r->w + i] = isinf(r->depth[j * r->w + i]) ? -INFINITY : smooth_at(r, i, j, pass % 2);
    float *swap = r->depth;
    r->depth = r->next, r->next = swap;
  }
}

/* How steep the surface is along an axis: between both neighbours, or to the one of the same surface. */
static float steep(const Relief *r, int at, PetscBool before, PetscBool after, int step)
{
  const float here = r->depth[at], low = before ? r->depth[at - step] : -INFINITY,
              high = after ? r->depth[at + step] : -INFINITY;
  const int lower = fabsf(here - low) < r->behind, higher = fabsf(high - here) < r->behind;
  return lower + higher ? ((higher ? high : here) - (lower ? low : here)) / (float)(lower + higher) : 0;
}

PetscErrorCode CanvasRelief(const RasterScene *scene, const Canvas *canvas, float *light)
{
  Relief r;

  PetscFunctionBeginUser;
  PetscCall(ReliefCreate(scene, canvas, &r));
  smooth(&r);
  for (int j = 0; j < r.h; ++j)
    for (int i = 0; i < r.w; ++i) {
      const int at = j * r.w + i;
      const float a = -steep(&r, at, i > 0, i + 1 < r.w, 1), b = -steep(&r, at, j > 0, j + 1 < r.h, r.w);
      light[at] = (float)canvas_light(a, b, 1);
    }
  PetscCall(PetscFree2(r.depth, r.next));
  PetscCall(PetscFree(r.exact));
  PetscFunctionReturn(0);
}
