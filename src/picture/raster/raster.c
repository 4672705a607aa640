#include <math.h>
#include "picture/raster/raster_private.h"

/* The viridis colour map (public domain, CC0) at ten places. */
const unsigned char palette_stops[PALETTE_STOPS][3] = {{68, 1, 84},    {72, 40, 120},  {62, 74, 137},  {49, 104, 142},
                                                       {38, 130, 142}, {31, 158, 137}, {53, 183, 121}, {109, 205, 89},
                                                       {180, 222, 44}, {253, 231, 37}};

/* Okabe and Ito's colours, told apart by everybody, and lighter ones of some. */
const unsigned char palette_names[PALETTE_NAMES][3] = {{0, 114, 178},   {230, 159, 0},  {0, 158, 115},  {204, 121, 167},
                                                       {86, 180, 233},  {213, 94, 0},   {240, 228, 66}, {110, 110, 110},
                                                       {158, 202, 225}, {161, 217, 155}};

void palette_colour(PetscReal value, PetscReal rgb[3])
{
  const PetscReal s = PetscMin(PetscMax(value, 0), 1) * (PALETTE_STOPS - 1);
  const int k = PetscMin((int)s, PALETTE_STOPS - 2);
  for (int c = 0; c < 3; ++c) rgb[c] = palette_stops[k][c] + (s - k) * (palette_stops[k + 1][c] - palette_stops[k][c]);
  if (PetscIsNanReal(value)) rgb[0] = rgb[1] = rgb[2] = 160;
}

/* Steps through a ball to its first place in the body, and halvings of the last one. */
enum { MARCH = 16, BISECT = 8 };
#define FACE_GREY 235 /* in full light */
#define SAME 0.3      /* of a ball's radius: places of one surface are no farther apart along a ray */

static PetscErrorCode CanvasCreate(const RasterScene *scene, Canvas *canvas)
{
  PetscFunctionBeginUser;
  canvas->width = scene->width * SAMPLES;
  canvas->height = scene->height * SAMPLES;
  canvas->scale = canvas->width / (scene->max[0] - scene->min[0]);
  const size_t n = (size_t)canvas->width * (size_t)canvas->height;
  PetscCall(PetscMalloc2(n, &canvas->front, n, &canvas->point));
  for (size_t i = 0; i < n; ++i) canvas->point[i] = -1;
  PetscFunctionReturn(0);
}

/* Where the body begins along the ray of a sample, from the front of a ball that knows it to its back, in samples;
 * PETSC_FALSE: nowhere. */
static PetscBool find_surface(const RasterScene *scene, const Canvas *canvas, PetscInt p, int i, int j, PetscReal half,
                              float *front)
{
  PetscReal x[3] = {(i + 0.5) / canvas->scale + scene->min[0], (j + 0.5) / canvas->scale + scene->min[1]}, out, in;
  int step = 0;
  for (; step <= MARCH; ++step) {
    x[2] = scene->x[3 * p + 2] + half * (1 - 2. * step / MARCH);
    if (scene->holds(scene->of, p, x) != RASTER_OUTSIDE) break;
  }
  if (step > MARCH) return PETSC_FALSE;
  in = x[2], out = step ? in + half * 2. / MARCH : in;
  for (int k = 0; k < BISECT && step; ++k) {
    x[2] = (in + out) / 2;
    if (scene->holds(scene->of, p, x) != RASTER_OUTSIDE) in = x[2];
    else out = x[2];
  }
  *front = (float)(in * canvas->scale);
  return PETSC_TRUE;
}

static PetscReal square_distance(const RasterScene *scene, const Canvas *canvas, PetscInt p, int i, int j, float front)
{
  PetscReal c[3];
  canvas_place(scene, canvas, scene->x + 3 * p, c);
  return PetscSqr(i - c[0]) + PetscSqr(j - c[1]) + PetscSqr((PetscReal)front - c[2]);
}

/* Does another ball know the same surface there, nearer to its middle? Whose colour it has is not left to round-off. */
static PetscBool is_others(const RasterScene *scene, const Canvas *canvas, PetscInt p, int i, int j, float front)
{
  const size_t at = canvas_at(canvas, i, j);
  const PetscInt q = canvas->point[at];
  if (q < 0) return PETSC_FALSE;
  if (!scene->knows[q] || fabsf(front - canvas->front[at]) > SAME * canvas_radius(scene, canvas, p))
    return (PetscBool)(canvas->front[at] >= front);
  return (PetscBool)(square_distance(scene, canvas, p, i, j, front) >=
                     square_distance(scene, canvas, q, i, j, canvas->front[at]));
}

static void draw_ball(const RasterScene *scene, Canvas *canvas, PetscInt p)
{
  const PetscBool cut = (PetscBool)(scene->shaded && scene->knows && scene->knows[p]);
  PetscReal c[3];
  canvas_place(scene, canvas, scene->x + 3 * p, c);
  if (!(fabs(c[0]) < 1e8 && fabs(c[1]) < 1e8)) return;
  const PetscReal radius = canvas_radius(scene, canvas, p);
  const int i0 = PetscMax((int)ceil(c[0] - radius), 0), i1 = PetscMin((int)floor(c[0] + radius), canvas->width - 1);
  const int j0 = PetscMax((int)ceil(c[1] - radius), 0), j1 = PetscMin((int)floor(c[1] + radius), canvas->height - 1);
  for (int j = j0; j <= j1; ++j)
    for (int i = i0; i <= i1; ++i) {
      const PetscReal h2 = radius * radius - (i - c[0]) * (i - c[0]) - (j - c[1]) * (j - c[1]);
      const size_t at = canvas_at(canvas, i, j);
      if (h2 < 0) continue;
      float front = (float)(c[2] + sqrt(h2));
      if (canvas->point[at] >= 0 && canvas->front[at] >= front) continue;
      if (cut && (!find_surface(scene, canvas, p, i, j, sqrt(h2) / canvas->scale, &front) ||
                  is_others(scene, canvas, p, i, j, front)))
        continue;
      canvas->front[at] = front;
      canvas->point[at] = p;
    }
}

static void value_colour(const RasterScene *scene, PetscReal value, PetscReal rgb[3])
{
  if (!scene->named || !(value >= 0)) {
    palette_colour(value, rgb);
    return;
  }
  for (int c = 0; c < 3; ++c) rgb[c] = palette_names[(PetscInt)(value + 0.5) % PALETTE_NAMES][c];
}

/* The colour of a sample that shows something. */
static void sample_colour(const RasterScene *scene, const Canvas *canvas, int i, int j, PetscReal rgb[3])
{
  const PetscInt p = canvas->point[canvas_at(canvas, i, j)], t = p - scene->n;
  PetscReal light = 1;
  PetscBool line = PETSC_FALSE;
  if (p == CANVAS_LINE) {
    rgb[0] = rgb[1] = rgb[2] = 70;
    return;
  }
  if (t < 0) {
    const int pixel = j / SAMPLES * scene->width + i / SAMPLES;
    const PetscBool own = (PetscBool)(!canvas->value || PetscIsNanReal(scene->value[p]));
    value_colour(scene, own ? scene->value[p] : (PetscReal)canvas->value[pixel], rgb);
    light = canvas->light ? canvas->light[pixel] : 1;
  } else if (t >= scene->n_triangles) {
    rgb[0] = rgb[1] = rgb[2] = FACE_GREY;
    light = triangle_light(scene, scene->face + 9 * (t - scene->n_triangles));
  } else {
    value_colour(scene, triangle_value(scene, canvas, t, i, j, &line), rgb);
    light = triangle_light(scene, scene->corner + 9 * t);
  }
  if (line) light *= 0.55;
  for (int c = 0; c < 3; ++c) rgb[c] *= light;
}

/* Mean colour of a pixel's samples, and how many of them are covered. */
static void raster_pixel(const RasterScene *scene, const Canvas *canvas, int column, int row, unsigned char rgba[4])
{
  PetscReal sum[3] = {0}, rgb[3];
  int covered = 0;
  for (int j = row * SAMPLES; j < (row + 1) * SAMPLES; ++j)
    for (int i = column * SAMPLES; i < (column + 1) * SAMPLES; ++i) {
      if (canvas->point[canvas_at(canvas, i, j)] == -1) continue;
      sample_colour(scene, canvas, i, j, rgb);
      for (int c = 0; c < 3; ++c) sum[c] += rgb[c];
      ++covered;
    }
  for (int c = 0; c < 3; ++c) rgba[c] = (unsigned char)lround(covered ? sum[c] / covered : 255);
  rgba[3] = (unsigned char)(covered * 255 / (SAMPLES * SAMPLES));
}

/* All balls, or those of one part. */
static void draw_balls(const RasterScene *scene, Canvas *canvas, PetscInt part)
{
  for (PetscInt p = 0; p < scene->n; ++p)
    if (part < 0 || scene->part[p] == part) draw_ball(scene, canvas, p);
}

static PetscBool meets_other(const RasterScene *scene, PetscInt p, PetscInt q)
{
  return (PetscBool)(p >= 0 && q >= 0 && scene->part[p] != scene->part[q]);
}

/* A line of one pixel or so where a body meets another one. */
static void line_between_parts(const RasterScene *scene, const PetscInt *of, Canvas *canvas)
{
  for (int j = 0; j + 2 < canvas->height; ++j)
    for (int i = 0; i + 2 < canvas->width; ++i) {
      const PetscInt p = of[canvas_at(canvas, i, j)];
      for (int k = 1; k <= 2; ++k)
        if (meets_other(scene, p, of[canvas_at(canvas, i + k, j)]) ||
            meets_other(scene, p, of[canvas_at(canvas, i, j + k)]))
          canvas->point[canvas_at(canvas, i, j)] = CANVAS_LINE;
    }
}

/* Bodies that are apart are drawn apart, each with its own outline: the corner between two of them is no gap. */
static PetscErrorCode DrawParts(const RasterScene *scene, Canvas *canvas)
{
  const size_t n = (size_t)canvas->width * (size_t)canvas->height;
  PetscInt *all;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &all));
  for (size_t i = 0; i < n; ++i) all[i] = -1;
  for (PetscInt part = 0; part < scene->n_parts; ++part) {
    for (size_t i = 0; i < n; ++i) canvas->point[i] = -1;
    draw_balls(scene, canvas, part);
    PetscCall(CanvasShape(scene, canvas));
    for (size_t i = 0; i < n; ++i)
      if (all[i] < 0) all[i] = canvas->point[i];
  }
  PetscCall(PetscArraycpy(canvas->point, all, n));
  line_between_parts(scene, all, canvas);
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

PetscErrorCode RasterDraw(const RasterScene *scene, unsigned char *rgba)
{
  Canvas canvas = {0};

  PetscFunctionBeginUser;
  PetscCall(CanvasCreate(scene, &canvas));
  const PetscBool shaped = scene->gap > 0;
  if (shaped && !scene->shaded && scene->n_parts > 1) PetscCall(DrawParts(scene, &canvas));
  else {
    draw_balls(scene, &canvas, -1);
    if (shaped) PetscCall(CanvasShape(scene, &canvas));
  }
  if (scene->shaded && scene->n) {
    PetscCall(PetscMalloc1(scene->width * scene->height, &canvas.light));
    PetscCall(CanvasRelief(scene, &canvas, canvas.light));
  }
  if (scene->blur > 0 && !scene->shaded && !scene->named) {
    PetscCall(PetscMalloc1(scene->width * scene->height, &canvas.value));
    PetscCall(CanvasBlur(scene, &canvas, canvas.value));
  }
  canvas_triangles(scene, &canvas);
  canvas_faces(scene, &canvas);
  canvas_lines(scene, &canvas);
  for (int row = 0; row < scene->height; ++row)
    for (int column = 0; column < scene->width; ++column)
      raster_pixel(scene, &canvas, column, row, rgba + 4 * ((size_t)row * (size_t)scene->width + (size_t)column));
  PetscCall(PetscFree2(canvas.front, canvas.point));
  PetscCall(PetscFree(canvas.light));
  PetscCall(PetscFree(canvas.value));
  PetscFunctionReturn(0);
}
