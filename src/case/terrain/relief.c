#include "case/terrain/relief.h"
#include <math.h>

PetscErrorCode ReliefDestroy(Relief **relief)
{
  PetscFunctionBeginUser;
  if (*relief) PetscCall(PetscFree((*relief)->height));
  PetscCall(PetscFree(*relief));
  PetscFunctionReturn(0);
}

/* The square that x is in, and where: 0 to 1. */
static PetscBool find(const Relief *r, const PetscReal x[2], PetscReal tolerance, PetscInt square[2], PetscReal at[2])
{
  for (int d = 0; d < 2; ++d) {
    const PetscReal along = (x[d] - r->low[d]) / r->step, slack = PetscAbsReal(tolerance) / r->step;
    if (!(along >= -slack && along <= (PetscReal)(r->n[d] - 1) + slack)) return PETSC_FALSE;
    square[d] = PetscMax(0, PetscMin(r->n[d] - 2, (PetscInt)floor(along)));
    at[d] = along - (PetscReal)square[d];
  }
  return PETSC_TRUE;
}

PetscBool relief_contains(const Relief *r, const PetscReal x[3], PetscReal tolerance)
{
  PetscInt s[2];
  PetscReal u[2];
  if (!find(r, x, tolerance, s, u)) return PETSC_FALSE;
  const PetscReal a = relief_post(r, s[0], s[1]), c = relief_post(r, s[0] + 1, s[1] + 1);
  const PetscReal b = u[0] >= u[1] ? relief_post(r, s[0] + 1, s[1]) : relief_post(r, s[0], s[1] + 1);
  const PetscReal far = PetscMax(u[0], u[1]), near = PetscMin(u[0], u[1]);
  const PetscReal slope = PetscSqrtReal(PetscSqr(b - a) + PetscSqr(c - b)) / r->step;
  const PetscReal height = a + far * (b - a) + near * (c - b);
  /* a comparison with NaN is false */
  return x[2] <= height + tolerance * PetscSqrtReal(1 + slope * slope) && x[2] >= r->bottom - tolerance;
}

/* Slopes along x and y of the triangle of square s that is on this side of its diagonal. */
static void slopes(const Relief *r, const PetscInt s[2], PetscBool below, PetscReal slope[2])
{
  const PetscReal a = relief_post(r, s[0], s[1]), c = relief_post(r, s[0] + 1, s[1] + 1);
  const PetscReal b = below ? relief_post(r, s[0] + 1, s[1]) : relief_post(r, s[0], s[1] + 1);
  slope[below ? 0 : 1] = (b - a) / r->step;
  slope[below ? 1 : 0] = (c - b) / r->step;
}

PetscReal relief_distance(const Relief *r, const PetscReal x[3], PetscReal gradient[3])
{
  PetscInt s[2];
  PetscReal u[2], slope[2];
  gradient[0] = gradient[1] = 0, gradient[2] = 1;
  if (!find(r, x, 0, s, u)) return PETSC_MAX_REAL;
  slopes(r, s, (PetscBool)(u[0] >= u[1]), slope);
  const PetscReal height = relief_post(r, s[0], s[1]) + r->step * (u[0] * slope[0] + u[1] * slope[1]);
  const PetscReal scale = 1 / PetscSqrtReal(1 + slope[0] * slope[0] + slope[1] * slope[1]);
  if (isnan(height)) return PETSC_MAX_REAL;
  gradient[0] = -scale * slope[0], gradient[1] = -scale * slope[1], gradient[2] = scale;
  return scale * (x[2] - height);
}

PetscReal relief_steepness(const Relief *r)
{
  PetscReal steepest = 0, slope[2];
  for (PetscInt j = 0; j + 1 < r->n[1]; ++j)
    for (PetscInt i = 0; i + 1 < r->n[0]; ++i)
      for (int below = 0; below < 2; ++below) {
        slopes(r, (PetscInt[]){i, j}, (PetscBool)below, slope);
        const PetscReal square = slope[0] * slope[0] + slope[1] * slope[1];
        if (!isnan(square)) steepest = PetscMax(steepest, square);
      }
  return PetscSqrtReal(1 + steepest);
}

void relief_bounds(const Relief *r, PetscReal min[3], PetscReal max[3])
{
  for (int d = 0; d < 3; ++d) min[d] = PETSC_MAX_REAL, max[d] = -PETSC_MAX_REAL;
  for (PetscInt i = 0; i < r->n[0] * r->n[1]; ++i) {
    if (isnan(r->height[i])) continue;
    const PetscInt row = i / r->n[0], column = i % r->n[0];
    const PetscReal x[3] = {r->low[0] + (PetscReal)column * r->step, r->low[1] + (PetscReal)row * r->step,
                            r->height[i]};
    for (int d = 0; d < 3; ++d) min[d] = PetscMin(min[d], x[d]), max[d] = PetscMax(max[d], x[d]);
  }
  min[2] = r->bottom;
}

/* The highest place of one triangle of square s in the part of the square from low to high (0 to 1): it is flat, so
 * that is a corner of what they share. Those are corners of the part, or lie on the diagonal. */
static PetscReal highest_of_triangle(const Relief *r, const PetscInt s[2], PetscBool below, const PetscReal low[2],
                                     const PetscReal high[2])
{
  PetscReal slope[2], most = -PETSC_MAX_REAL;
  slopes(r, s, below, slope);
  for (int k = 0; k < 8; ++k) {
    PetscReal u[2] = {k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1]};
    if (k >= 4) u[0] = u[1] = k & 1 ? high[k / 2 - 2] : low[k / 2 - 2];
    if (below ? u[0] < u[1] : u[0] > u[1]) continue;
    if (u[0] < low[0] || u[0] > high[0] || u[1] < low[1] || u[1] > high[1]) continue;
    const PetscReal height = relief_post(r, s[0], s[1]) + r->step * (u[0] * slope[0] + u[1] * slope[1]);
    if (height > most) most = height; /* not of a post without one */
  }
  return most;
}

PetscReal relief_highest(const Relief *r, const PetscReal min[2], const PetscReal max[2])
{
  PetscReal from[2], to[2], highest = -PETSC_MAX_REAL;
  PetscInt first[2], last[2], s[2];
  for (int d = 0; d < 2; ++d) {
    const PetscReal end = (PetscReal)(r->n[d] - 1);
    from[d] = PetscMax(0, PetscMin(end, (PetscMax(min[d], -1e150) - r->low[d]) / r->step));
    to[d] = PetscMax(0, PetscMin(end, (PetscMin(max[d], 1e150) - r->low[d]) / r->step));
    first[d] = PetscMin(r->n[d] - 2, (PetscInt)floor(from[d]));
    last[d] = PetscMin(r->n[d] - 2, (PetscInt)floor(to[d]));
  }
  for (s[1] = first[1]; s[1] <= last[1]; ++s[1])
    for (s[0] = first[0]; s[0] <= last[0]; ++s[0]) {
      PetscReal low[2], high[2];
      for (int d = 0; d < 2; ++d) {
        low[d] = PetscMax(0, from[d] - (PetscReal)s[d]);
        high[d] = PetscMin(1, to[d] - (PetscReal)s[d]);
      }
      for (int below = 0; below < 2; ++below)
        highest = PetscMax(highest, highest_of_triangle(r, s, (PetscBool)below, low, high));
    }
  return highest;
}

PetscReal relief_lowest(const Relief *r, const PetscReal min[2], const PetscReal max[2])
{
  PetscInt from[2], to[2];
  PetscReal lowest = PETSC_MAX_REAL, at[2];
  if (!find(r, min, 1e-9 * r->step, from, at) || !find(r, max, 1e-9 * r->step, to, at)) return r->bottom;
  for (PetscInt j = from[1]; j <= to[1] + 1; ++j)
    for (PetscInt i = from[0]; i <= to[0] + 1; ++i) {
      if (isnan(relief_post(r, i, j))) return r->bottom;
      lowest = PetscMin(lowest, relief_post(r, i, j));
    }
  return lowest;
}
