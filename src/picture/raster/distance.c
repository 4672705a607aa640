/* Euclidean distances of the pixels of an image: exact, in time proportional to their number
 * (Felzenszwalb and Huttenlocher 2012): along columns, then along rows as the lower envelope of
 * parabolas. */
#include <math.h>
#include "picture/raster/distance.h"

/* Where the parabolas over q and r, which begin at f[q] and f[r], cross. */
static double crossing(const float *f, int q, int r)
{
  return ((double)f[q] + (double)q * q - ((double)f[r] + (double)r * r)) / (2.0 * (q - r));
}

/* Of each place i of a line the q with the least f[q] + (i - q)^2; -1 if f, INFINITY where there is
 * nothing, is so everywhere. vertex, from: room for n. Where f is 0 that is the place itself, and between two others
 * of 0 it is the nearest to no other place. */
static void envelope(int n, const float *f, int *vertex, double *from, int *best)
{
  int k = -1;
  for (int q = 0; q < n; ++q) {
    double at = -INFINITY;
    if (f[q] == INFINITY || (f[q] == 0 && q > 0 && f[q - 1] == 0 && q + 1 < n && f[q + 1] == 0)) continue;
    while (k >= 0 && (at = crossing(f, q, vertex[k])) <= from[k]) --k;
    vertex[++k] = q;
    from[k] = at;
  }
  for (int i = 0, j = 0; i < n; ++i) {
    if (f[i] == 0) {
      best[i] = i;
      continue;
    }
    while (j < k && from[j + 1] < i) ++j;
    best[i] = k < 0 ? -1 : vertex[j];
  }
}

/* Of each pixel the row of the nearest one of its column that is `in`, the lower one of two; -1 if none is. Row by row,
 * as they lie in memory. */
static void along_columns(int width, int height, const unsigned char *in, int *row)
{
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) row[j * width + i] = in[j * width + i] ? j : j ? row[(j - 1) * width + i] : -1;
  for (int j = height - 2; j >= 0; --j)
    for (int i = 0; i < width; ++i) {
      const int below = row[j * width + i], above = row[(j + 1) * width + i];
      if (above > j && (below < 0 || above - j < j - below)) row[j * width + i] = above;
    }
}

PetscErrorCode DistanceTo(int width, int height, const unsigned char *in, float *distance, int *nearest)
{
  int *vertex, *best, *of_column;
  float *f;
  double *from;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(width, &vertex, width, &best, width, &f, width, &from, width * height, &of_column));
  along_columns(width, height, in, of_column);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const int q = of_column[j * width + i];
      f[i] = q < 0 ? INFINITY : (float)((q - j) * (q - j));
    }
    envelope(width, f, vertex, from, best);
    for (int i = 0; i < width; ++i) {
      const int b = best[i];
      distance[j * width + i] = b < 0 ? INFINITY : sqrtf(f[b] + (float)((i - b) * (i - b)));
      nearest[j * width + i] = b < 0 ? -1 : of_column[j * width + b] * width + b;
    }
  }
  PetscCall(PetscFree5(vertex, best, f, from, of_column));
  PetscFunctionReturn(0);
}
