/* Triangles and lines into the samples of an image. */
#include <math.h>
#include "picture/raster/raster_private.h"

/* Half the width of lines, samples. */
#define LINE_HALF (0.4 * SAMPLES)

/* Shares of the corners at a place; their sum is 1. PETSC_FALSE for a triangle without an area. */
static PetscBool shares(PetscReal at[3][3], PetscReal x, PetscReal y, PetscReal share[3])
{
  const PetscReal ax = at[1][0] - at[0][0], ay = at[1][1] - at[0][1], bx = at[2][0] - at[0][0],
                  by = at[2][1] - at[0][1], area = ax * by - ay * bx;
  if (!(fabs(area) > 1e-12)) return PETSC_FALSE;
  share[1] = ((x - at[0][0]) * by - (y - at[0][1]) * bx) / area;
  share[2] = (ax * (y - at[0][1]) - ay * (x - at[0][0])) / area;
  share[0] = 1 - share[1] - share[2];
  return PETSC_TRUE;
}

static void corners(const RasterScene *scene, const Canvas *canvas, const PetscReal *corner, PetscReal at[3][3])
{
  for (int k = 0; k < 3; ++k) canvas_place(scene, canvas, corner + 3 * k, at[k]);
}

/* Samples from the least to the largest of three coordinates. */
static void span(PetscReal a, PetscReal b, PetscReal c, int last, int range[2])
{
  range[0] = (int)PetscMax(ceil(PetscMin(PetscMin(a, b), c) - 1e-6), 0);
  range[1] = (int)PetscMin(floor(PetscMax(PetscMax(a, b), c) + 1e-6), last);
}

void canvas_each(const RasterScene *scene, const Canvas *canvas, const PetscReal *corner,
                 void (*visit)(void *context, int i, int j, float front), void *context)
{
  PetscReal at[3][3], share[3];
  int i[2], j[2];
  corners(scene, canvas, corner, at);
  span(at[0][0], at[1][0], at[2][0], canvas->width - 1, i);
  span(at[0][1], at[1][1], at[2][1], canvas->height - 1, j);
  for (int b = j[0]; b <= j[1]; ++b)
    for (int a = i[0]; a <= i[1]; ++a)
      if (shares(at, a, b, share) && share[0] >= -1e-9 && share[1] >= -1e-9 && share[2] >= -1e-9)
        visit(context, a, b, (float)(share[0] * at[0][2] + share[1] * at[1][2] + share[2] * at[2][2]));
}

typedef struct {
  Canvas *canvas;
  PetscInt index;
} Triangle;

static void draw(void *context, int i, int j, float front)
{
  const Triangle *t = context;
  const size_t k = canvas_at(t->canvas, i, j);
  if (t->canvas->point[k] != -1 && t->canvas->front[k] >= front) return;
  t->canvas->front[k] = front;
  t->canvas->point[k] = t->index;
}

void canvas_triangles(const RasterScene *scene, Canvas *canvas)
{
  for (PetscInt t = 0; t < scene->n_triangles; ++t) {
    Triangle triangle = {.canvas = canvas, .index = scene->n + t};
    canvas_each(scene, canvas, scene->corner + 9 * t, draw, &triangle);
  }
}

PetscReal triangle_value(const RasterScene *scene, const Canvas *canvas, PetscInt t, int i, int j, PetscBool *line)
{
  const PetscReal *value = scene->corner_value + 3 * t;
  PetscReal at[3][3], share[3];
  corners(scene, canvas, scene->corner + 9 * t, at);
  *line = PETSC_FALSE;
  if (!shares(at, i, j, share)) return value[0];
  const PetscReal area =
    fabs((at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) - (at[1][1] - at[0][1]) * (at[2][0] - at[0][0]));
  for (int k = 0; k < 3 && scene->side; ++k) {
    const int next = (k + 1) % 3, across = (k + 2) % 3;
    const PetscReal length = hypot(at[next][0] - at[k][0], at[next][1] - at[k][1]);
    /* the distance from a side is its corner's share of the height above it */
    if (scene->side[t] >> k & 1 && share[across] * area < LINE_HALF * length) *line = PETSC_TRUE;
  }
  return scene->named ? value[0] : share[0] * value[0] + share[1] * value[1] + share[2] * value[2];
}

PetscReal triangle_light(const RasterScene *scene, const PetscReal *c)
{
  static const PetscReal towards[3] = {-0.35, 0.50, 0.79};
  PetscReal a[3], b[3];
  if (!scene->shaded) return 1;
  for (int d = 0; d < 3; ++d) a[d] = c[3 + d] - c[d], b[d] = c[6 + d] - c[d];
  PetscReal n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  const PetscReal length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), side = n[2] < 0 ? -1 : 1;
  if (!(length > 0)) return 1;
  const PetscReal light = side * (n[0] * towards[0] + n[1] * towards[1] + n[2] * towards[2]) / length;
  return 0.62 + 0.38 * PetscMax(light, 0);
}

/* A dot of a line where nothing is in front of it. */
static void dot(Canvas *canvas, const PetscReal at[3])
{
  const PetscReal half = LINE_HALF;
  int i[2], j[2];
  span(at[0] - half, at[0], at[0] + half, canvas->width - 1, i);
  span(at[1] - half, at[1], at[1] + half, canvas->height - 1, j);
  for (int b = j[0]; b <= j[1]; ++b)
    for (int a = i[0]; a <= i[1]; ++a) {
      const size_t k = canvas_at(canvas, a, b);
      if (canvas->point[k] != -1 && canvas->front[k] > (float)(at[2] + 2 * SAMPLES)) continue;
      canvas->point[k] = CANVAS_LINE;
      canvas->front[k] = (float)at[2];
    }
}

void canvas_lines(const RasterScene *scene, Canvas *canvas)
{
  for (PetscInt l = 0; l < scene->n_lines; ++l) {
    PetscReal from[3], to[3];
    canvas_place(scene, canvas, scene->line + 6 * l, from);
    canvas_place(scene, canvas, scene->line + 6 * l + 3, to);
    const PetscReal length = PetscMax(fabs(to[0] - from[0]), fabs(to[1] - from[1]));
    if (!(length < 1e6)) continue;
    const int steps = (int)ceil(length) + 1;
    for (int k = 0; k <= steps; ++k) {
      PetscReal at[3];
      for (int d = 0; d < 3; ++d) at[d] = from[d] + (to[d] - from[d]) * k / steps;
      if (at[0] > -SAMPLES && at[1] > -SAMPLES && at[0] < canvas->width + SAMPLES && at[1] < canvas->height + SAMPLES)
        dot(canvas, at);
    }
  }
}
