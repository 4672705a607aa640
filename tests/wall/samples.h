/* Surfaces as clouds of positions: the oracle of distances. Each sampler covers its piece so that
 * no position of it is farther than `spacing` from a sample. */
#pragma once
#include "walls.h"

#define MOST_SAMPLES 2000000

typedef struct {
  size_t n;
  double (*x)[3];
} Samples;

static inline void samples_open(Samples *s) { *s = (Samples){0, malloc(MOST_SAMPLES * sizeof *s->x)}; }
static inline void samples_close(Samples *s) { free(s->x); }

static inline void sample_point(Samples *s, const double x[3])
{
  assert_true(s->n < MOST_SAMPLES);
  for (int d = 0; d < 3; ++d) s->x[s->n][d] = x[d];
  ++s->n;
}

/* a + s u + t v, s and t in [0, 1]; with v = 0 a segment. */
static inline void sample_patch(Samples *s, const double a[3], const double u[3], const double v[3], double spacing)
{
  const double lu = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]), lv = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const int n = (int)ceil(lu / spacing) + 1, m = (int)ceil(lv / spacing) + 1;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= (lv > 0 ? m : 0); ++j) {
      double x[3];
      for (int d = 0; d < 3; ++d) x[d] = a[d] + (double)i / n * u[d] + (double)j / m * v[d];
      sample_point(s, x);
    }
}

static inline void sample_segment(Samples *s, const double a[3], const double b[3], double spacing)
{
  const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, none[3] = {0, 0, 0};
  sample_patch(s, a, u, none, spacing);
}

static inline void sample_arc(Samples *s, double cx, double cy, double radius, double from, double to, double spacing)
{
  const int n = (int)ceil(radius * fabs(to - from) / spacing) + 1;
  for (int i = 0; i <= n; ++i) {
    const double angle = from + (to - from) * i / n, x[3] = {cx + radius * cos(angle), cy + radius * sin(angle), 0};
    sample_point(s, x);
  }
}

/* The section from (r0, h0) to (r1, h1), turned about the axis through base along the unit vector
 * axis; e and f are unit vectors across it. */
static inline void sample_revolved(Samples *s, const double base[3], const double axis[3], const double e[3],
                                   const double f[3], double r0, double h0, double r1, double h1, double spacing)
{
  const int n = (int)ceil(hypot(r1 - r0, h1 - h0) / spacing) + 1;
  for (int i = 0; i <= n; ++i) {
    const double r = r0 + (r1 - r0) * i / n, h = h0 + (h1 - h0) * i / n;
    const int m = (int)ceil(2 * M_PI * r / spacing) + 1;
    for (int j = 0; j < m; ++j) {
      const double angle = 2 * M_PI * j / m;
      double x[3];
      for (int d = 0; d < 3; ++d) x[d] = base[d] + h * axis[d] + r * (cos(angle) * e[d] + sin(angle) * f[d]);
      sample_point(s, x);
    }
  }
}

static inline double distance_to_samples(const Samples *s, const double x[3])
{
  double least = 1e300;
  for (size_t i = 0; i < s->n; ++i) {
    const double a = x[0] - s->x[i][0], b = x[1] - s->x[i][1], c = x[2] - s->x[i][2], square = a * a + b * b + c * c;
    if (square < least) least = square;
  }
  return sqrt(least);
}

/* |gap| is the distance to the cloud, which is at most `spacing` more than that to the surface. */
static inline void compare_distances(const OneWall *one, const Samples *s, int dim, int queries, double spacing,
                                     double low, double high)
{
  for (int q = 0; q < queries; ++q) {
    double x[3];
    WallPlace place;
    random_in(dim, low, high, x);
    const double oracle = distance_to_samples(s, x);
    assert_true(wall_near(one->walls, 0, 0, x, PETSC_MAX_REAL, 0, &place));
    if (fabs(place.gap) > oracle + 1e-12 || fabs(place.gap) < oracle - spacing)
      fail_msg("at (%g, %g, %g) gap %.9g, samples say %.9g", x[0], x[1], x[2], place.gap, oracle);
  }
}

/* normal = d gap / dx, curvature = d normal / dx. */
static inline void compare_derivatives(const OneWall *one, int dim, int side, int queries, double low, double high)
{
  const double h = 1e-6;
  for (int q = 0; q < queries; ++q) {
    double x[3];
    WallPlace place, plus, minus;
    random_in(dim, low, high, x);
    assert_true(wall_near(one->walls, 0, 0, x, PETSC_MAX_REAL, side, &place));
    for (int d = 0; d < dim; ++d) {
      const double kept = x[d];
      x[d] = kept + h;
      assert_true(wall_near(one->walls, 0, 0, x, PETSC_MAX_REAL, side, &plus));
      x[d] = kept - h;
      assert_true(wall_near(one->walls, 0, 0, x, PETSC_MAX_REAL, side, &minus));
      x[d] = kept;
      ASSERT_NEAR((plus.gap - minus.gap) / (2 * h), place.normal[d], 1e-7);
      for (int e = 0; e < 3; ++e)
        ASSERT_NEAR((plus.normal[e] - minus.normal[e]) / (2 * h), place.curvature[3 * e + d],
                    1e-6 * (1 + fabs(place.curvature[3 * e + d])) / PetscMin(1, PetscSqr(place.gap) + 0.01));
    }
  }
}
