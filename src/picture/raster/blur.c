/* Values that go over from one ball to the next, in the plane: the mean of what pixels around show of balls. */
#include <math.h>
#include "picture/raster/raster_private.h"

/* sum[i] = sum of a triangle of 2 wide - 1 pixels around i along a line, twice the running mean of `wide`. */
static void blur_line(int n, int step, int wide, float *x, float *work)
{
  const int before[2] = {(wide - 1) / 2, wide / 2}, after[2] = {wide / 2, (wide - 1) / 2};
  for (int pass = 0; pass < 2; ++pass) {
    double sum = 0;
    for (int i = 0; i < n; ++i) work[i] = x[i * step];
    for (int i = 0; i < PetscMin(after[pass], n); ++i) sum += work[i];
    for (int i = 0; i < n; ++i) {
      if (i + after[pass] < n) sum += work[i + after[pass]];
      if (i - before[pass] - 1 >= 0) sum -= work[i - before[pass] - 1];
      x[i * step] = (float)sum;
    }
  }
}

static void blur(int width, int height, int wide, float *x, float *work)
{
  for (int row = 0; row < height; ++row) blur_line(width, 1, wide, x + (size_t)row * (size_t)width, work);
  for (int column = 0; column < width; ++column) blur_line(height, width, wide, x + column, work);
}

/* What balls show in each pixel: how much of it, and that times their value. */
static void take_values(const RasterScene *scene, const Canvas *canvas, float *shown, float *value)
{
  for (int j = 0; j < canvas->height; ++j)
    for (int i = 0; i < canvas->width; ++i) {
      const PetscInt p = canvas->point[canvas_at(canvas, i, j)];
      const int at = j / SAMPLES * scene->width + i / SAMPLES;
      if (p < 0 || p >= scene->n || PetscIsNanReal(scene->value[p])) continue;
      shown[at] += 1;
      value[at] += (float)scene->value[p];
    }
}

PetscErrorCode CanvasBlur(const RasterScene *scene, const Canvas *canvas, float *value)
{
  const int n = scene->width * scene->height;
  const int wide = PetscMax(1, (int)(scene->blur * canvas->scale / SAMPLES + 0.5));
  float *shown, *work;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, &shown, PetscMax(scene->width, scene->height), &work));
  PetscCall(PetscArrayzero(value, n));
  take_values(scene, canvas, shown, value);
  blur(scene->width, scene->height, wide, shown, work);
  blur(scene->width, scene->height, wide, value, work);
  for (int i = 0; i < n; ++i) value[i] = shown[i] > 0.5f ? value[i] / shown[i] : NAN;
  PetscCall(PetscFree2(shown, work));
  PetscFunctionReturn(0);
}
