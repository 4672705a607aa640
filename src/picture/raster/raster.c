#include "picture/raster/raster.h"
#include <math.h>

/* The viridis colour map (public domain, CC0) at ten places. */
const unsigned char palette_stops[PALETTE_STOPS][3] = {{68, 1, 84},    {72, 40, 120},  {62, 74, 137},  {49, 104, 142},
                                                       {38, 130, 142}, {31, 158, 137}, {53, 183, 121}, {109, 205, 89},
                                                       {180, 222, 44}, {253, 231, 37}};

void palette_colour(PetscReal value, PetscReal rgb[3])
{
  const PetscReal s = PetscMin(PetscMax(value, 0), 1) * (PALETTE_STOPS - 1);
  const int k = PetscMin((int)s, PALETTE_STOPS - 2);
  for (int c = 0; c < 3; ++c) rgb[c] = palette_stops[k][c] + (s - k) * (palette_stops[k + 1][c] - palette_stops[k][c]);
  if (PetscIsNanReal(value)) rgb[0] = rgb[1] = rgb[2] = 160;
}

/* Several samples a pixel along each axis make edges smooth. */
enum { SAMPLES = 3 };

typedef struct {
  int width, height; /* samples */
  PetscReal scale;   /* samples a metre */
  float *front;      /* what is nearest to the eye */
  PetscInt *point;   /* whose it is; -1: nothing */
} Canvas;

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

/* Centre and radius of a ball in samples; never so small that it falls between them. */
static void place(const RasterScene *scene, const Canvas *canvas, PetscInt p, PetscReal centre[2], PetscReal *radius)
{
  centre[0] = (scene->x[3 * p] - scene->min[0]) * canvas->scale - 0.5;
  centre[1] = (scene->x[3 * p + 1] - scene->min[1]) * canvas->scale - 0.5;
  *radius = PetscMax(scene->radius[p] * canvas->scale, 0.6 * SAMPLES);
}

static void draw_ball(const RasterScene *scene, Canvas *canvas, PetscInt p)
{
  PetscReal c[2], radius;
  place(scene, canvas, p, c, &radius);
  if (!(fabs(c[0]) < 1e8 && fabs(c[1]) < 1e8)) return;
  const PetscReal depth = scene->x[3 * p + 2] * canvas->scale;
  const int i0 = PetscMax((int)ceil(c[0] - radius), 0), i1 = PetscMin((int)floor(c[0] + radius), canvas->width - 1);
  const int j0 = PetscMax((int)ceil(c[1] - radius), 0), j1 = PetscMin((int)floor(c[1] + radius), canvas->height - 1);
  for (int j = j0; j <= j1; ++j)
    for (int i = i0; i <= i1; ++i) {
      const PetscReal h2 = radius * radius - (i - c[0]) * (i - c[0]) - (j - c[1]) * (j - c[1]);
      const size_t at = (size_t)j * (size_t)canvas->width + (size_t)i;
      if (h2 < 0) continue;
      const float front = (float)(depth + sqrt(h2));
      if (canvas->point[at] >= 0 && canvas->front[at] >= front) continue;
      canvas->front[at] = front;
      canvas->point[at] = p;
    }
}

/* Fills of gaps are kept apart from balls until they are known to stay: point p is noted as -2 -
 * p. */
static PetscInt fill_of(PetscInt p) { return -2 - p; }

/* Claim the empty samples within `reach` of the ball for its point, the nearest point winning. The
 * border of the image stays empty, so that the body ends there. */
static void claim_around(const RasterScene *scene, Canvas *canvas, PetscInt p, PetscReal reach)
{
  PetscReal c[2], radius;
  place(scene, canvas, p, c, &radius);
  if (!(fabs(c[0]) < 1e8 && fabs(c[1]) < 1e8)) return;
  radius += reach;
  const int i0 = PetscMax((int)ceil(c[0] - radius), 1), i1 = PetscMin((int)floor(c[0] + radius), canvas->width - 2);
  const int j0 = PetscMax((int)ceil(c[1] - radius), 1), j1 = PetscMin((int)floor(c[1] + radius), canvas->height - 2);
  for (int j = j0; j <= j1; ++j)
    for (int i = i0; i <= i1; ++i) {
      const PetscReal d2 = (i - c[0]) * (i - c[0]) + (j - c[1]) * (j - c[1]);
      const size_t at = (size_t)j * (size_t)canvas->width + (size_t)i;
      if (canvas->point[at] >= 0 || d2 > radius * radius) continue;
      if (canvas->point[at] <= fill_of(0) && canvas->front[at] <= (float)d2) continue;
      canvas->front[at] = (float)d2;
      canvas->point[at] = fill_of(p);
    }
}

/* Is the sample empty, with a claimed one beside it? */
static PetscBool is_rim(const Canvas *canvas, int i, int j)
{
  const PetscInt *point = canvas->point + (size_t)j * (size_t)canvas->width + (size_t)i;
  if (*point != -1) return PETSC_FALSE;
  return (i > 0 && point[-1] < -1) || (i + 1 < canvas->width && point[1] < -1) ||
         (j > 0 && point[-canvas->width] < -1) || (j + 1 < canvas->height && point[canvas->width] < -1);
}

/* Mark the claims within `reach` of a sample that stayed empty: they lie outside the body, not in a
 * gap. */
static void withdraw(Canvas *canvas, int i, int j, int reach, unsigned char *outside)
{
  for (int b = PetscMax(j - reach, 0); b <= PetscMin(j + reach, canvas->height - 1); ++b)
    for (int a = PetscMax(i - reach, 0); a <= PetscMin(i + reach, canvas->width - 1); ++a)
      if ((a - i) * (a - i) + (b - j) * (b - j) <= reach * reach)
        outside[(size_t)b * (size_t)canvas->width + (size_t)a] = 1;
}

/* Where flow has drawn points apart, the body between them is shown too: grown by the gap, then
 * shrunk by it. */
static PetscErrorCode FillGaps(const RasterScene *scene, Canvas *canvas)
{
  const PetscReal gap = PetscMin(scene->gap * canvas->scale, 30 * SAMPLES);
  const size_t n = (size_t)canvas->width * (size_t)canvas->height;
  unsigned char *outside;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &outside));
  for (PetscInt p = 0; p < scene->n; ++p) claim_around(scene, canvas, p, gap);
  for (int j = 0; j < canvas->height; ++j)
    for (int i = 0; i < canvas->width; ++i)
      if (is_rim(canvas, i, j)) withdraw(canvas, i, j, (int)ceil(gap), outside);
  for (size_t i = 0; i < n; ++i)
    if (canvas->point[i] < -1) canvas->point[i] = outside[i] ? -1 : fill_of(canvas->point[i]);
  PetscCall(PetscFree(outside));
  PetscFunctionReturn(0);
}

/* Light from the upper left, in front. */
static PetscReal raster_shade(const RasterScene *scene, const Canvas *canvas, PetscInt p, int i, int j)
{
  PetscReal c[2], radius;
  if (!scene->shaded) return 1;
  place(scene, canvas, p, c, &radius);
  const PetscReal a = (i - c[0]) / radius, b = (j - c[1]) / radius, h = sqrt(PetscMax(1 - a * a - b * b, 0));
  return 0.72 + 0.28 * PetscMax(-0.35 * a + 0.50 * b + 0.79 * h, 0);
}

/* Mean colour of a pixel's samples, and how many of them are covered. */
static void raster_pixel(const RasterScene *scene, const Canvas *canvas, int column, int row, unsigned char rgba[4])
{
  PetscReal sum[3] = {0}, rgb[3];
  int covered = 0;
  for (int j = row * SAMPLES; j < (row + 1) * SAMPLES; ++j)
    for (int i = column * SAMPLES; i < (column + 1) * SAMPLES; ++i) {
      const PetscInt p = canvas->point[(size_t)j * (size_t)canvas->width + (size_t)i];
      if (p < 0) continue;
      const PetscReal shade = raster_shade(scene, canvas, p, i, j);
      palette_colour(scene->value[p], rgb);
      for (int c = 0; c < 3; ++c) sum[c] += shade * rgb[c];
      ++covered;
    }
  for (int c = 0; c < 3; ++c) rgba[c] = (unsigned char)lround(covered ? sum[c] / covered : 255);
  rgba[3] = (unsigned char)(covered * 255 / (SAMPLES * SAMPLES));
}

PetscErrorCode RasterDraw(const RasterScene *scene, unsigned char *rgba)
{
  Canvas canvas;

  PetscFunctionBeginUser;
  PetscCall(CanvasCreate(scene, &canvas));
  for (PetscInt p = 0; p < scene->n; ++p) draw_ball(scene, &canvas, p);
  if (scene->gap > 0 && !scene->shaded) PetscCall(FillGaps(scene, &canvas));
  for (int row = 0; row < scene->height; ++row)
    for (int column = 0; column < scene->width; ++column)
      raster_pixel(scene, &canvas, column, row, rgba + 4 * ((size_t)row * (size_t)scene->width + (size_t)column));
  PetscCall(PetscFree2(canvas.front, canvas.point));
  PetscFunctionReturn(0);
}
