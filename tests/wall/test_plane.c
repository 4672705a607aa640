/* Walls in the plane against clouds of samples of their surface, and against differences. */
#include "samples.h"

#define SPACING 2e-4

static double zigzag[] = {-0.6, -0.5, 0.7, -0.4, 0.1, 0.1, 0.8, 0.7, -0.7, 0.5}; /* not convex, clockwise in part */

static void sample_line(Samples *s, int n, const double *v, int closed)
{
  for (int i = 0; i < n - !closed; ++i) {
    const double *p = v + 2 * i, *q = v + 2 * ((i + 1) % n), a[3] = {p[0], p[1], 0}, b[3] = {q[0], q[1], 0};
    sample_segment(s, a, b, SPACING);
  }
}

/* Distances from the samples, signs from the even-odd rule of the case, both ways round and as a
 * container. */
static void check_solid(const Shape *shape, const Samples *samples)
{
  for (int inside = 0; inside < 2; ++inside) {
    OneWall one;
    wall_open(&one, &kinematics_plane_strain, (WallSpec){.shape = *shape, .inside = inside});
    assert_int_equal(diag_errors(one.diag), 0);
    compare_distances(&one, samples, 2, 400, SPACING, -1.2, 1.2);
    compare_derivatives(&one, 2, 0, 400, -1.2, 1.2);
    for (int q = 0; q < 400; ++q) {
      double x[3];
      WallPlace place;
      random_in(2, -1.2, 1.2, x);
      assert_true(wall_near(one.walls, 0, 0, x, PETSC_MAX_REAL, 0, &place));
      assert_int_equal(place.gap < 0, shape_contains(shape, 2, x, 0) ^ inside);
      assert_int_equal(wall_side(one.walls, 0, 0, x), 0);
    }
    wall_close(&one);
  }
}

static void Box(void **state)
{
  const Shape shape = {.kind = SHAPE_BOX, .min = {-0.5, -0.3}, .max = {0.4, 0.6}};
  const double corners[] = {-0.5, -0.3, 0.4, -0.3, 0.4, 0.6, -0.5, 0.6};
  Samples samples;
  (void)state;
  samples_open(&samples);
  sample_line(&samples, 4, corners, 1);
  check_solid(&shape, &samples);
  samples_close(&samples);
}

static void Circle(void **state)
{
  const Shape shape = {.kind = SHAPE_BALL, .centre = {0.1, -0.2}, .radius = 0.5};
  Samples samples;
  (void)state;
  samples_open(&samples);
  sample_arc(&samples, 0.1, -0.2, 0.5, 0, 2 * M_PI, SPACING);
  check_solid(&shape, &samples);
  samples_close(&samples);
}

static void Polygon(void **state)
{
  Shape shape = {.kind = SHAPE_POLYGON, .n_vertices = 5, .vertices = zigzag};
  double turned[12];
  Samples samples;
  (void)state;
  samples_open(&samples);
  sample_line(&samples, 5, zigzag, 1);
  check_solid(&shape, &samples);
  /* the other way round, and the first corner once more at the end */
  for (int i = 0; i < 6; ++i)
    for (int d = 0; d < 2; ++d) turned[2 * i + d] = zigzag[2 * ((5 - i) % 5) + d];
  shape.vertices = turned;
  shape.n_vertices = 6;
  check_solid(&shape, &samples);
  samples_close(&samples);
}

static void HalfPlane(void **state)
{
  const Shape shape = {.kind = SHAPE_HALF_SPACE, .point = {0.1, 0.2}, .normal = {-3, 4}};
  const double a[3] = {0.1 - 4 * 0.8, 0.2 - 4 * 0.6, 0}, b[3] = {0.1 + 4 * 0.8, 0.2 + 4 * 0.6, 0};
  Samples samples;
  (void)state;
  samples_open(&samples);
  sample_segment(&samples, a, b, SPACING);
  check_solid(&shape, &samples);
  samples_close(&samples);
}

/* A thin line: the distance from either side, behind it negative; round ends. */
static void Line(void **state)
{
  OneWall one;
  Samples samples;
  WallPlace place, other;
  (void)state;
  samples_open(&samples);
  sample_line(&samples, 5, zigzag, 0);
  wall_open(&one, &kinematics_plane_strain,
            (WallSpec){.shape = {.kind = SHAPE_LINE, .n_vertices = 5, .vertices = zigzag}});
  compare_distances(&one, &samples, 2, 400, SPACING, -1.2, 1.2);
  for (int side = -1; side < 2; ++side) compare_derivatives(&one, 2, side, 400, -1.2, 1.2);
  for (int q = 0; q < 400; ++q) {
    double x[3];
    random_in(2, -1.2, 1.2, x);
    const int side = wall_side(one.walls, 0, 0, x);
    assert_true(wall_near(one.walls, 0, 0, x, 9, side, &place) && place.gap > 0);
    assert_true(wall_near(one.walls, 0, 0, x, 9, -side, &other));
    /* from behind, but for its ends */
    if (side && other.gap < 0) ASSERT_NEAR(other.gap, -place.gap, 0), ASSERT_NEAR(other.normal[0], -place.normal[0], 0);
    else ASSERT_NEAR(other.gap, place.gap, 0);
  }
  /* straight on beyond its first corner neither side is behind the other; above it there is one */
  const double t[2] = {1.3 / hypot(1.3, 0.1), 0.1 / hypot(1.3, 0.1)};
  const double beyond[2] = {-0.6 - 0.1 * t[0], -0.5 - 0.1 * t[1]};
  const double above[2] = {-0.6 - 0.1 * t[1] - 0.01 * t[0], -0.5 + 0.1 * t[0] - 0.01 * t[1]};
  const double below[2] = {-0.6 + 0.1 * t[1] - 0.01 * t[0], -0.5 - 0.1 * t[0] - 0.01 * t[1]};
  assert_int_equal(wall_side(one.walls, 0, 0, beyond), 0);
  assert_int_equal(wall_side(one.walls, 0, 0, above) * wall_side(one.walls, 0, 0, below), -1);
  wall_close(&one);
  samples_close(&samples);
}

static void Thickness(void **state)
{
  OneWall thin, thick;
  WallSpec spec = {.shape = {.kind = SHAPE_LINE, .n_vertices = 5, .vertices = zigzag}};
  WallPlace a, b;
  (void)state;
  wall_open(&thin, &kinematics_plane_strain, spec);
  spec.thickness = 0.1;
  wall_open(&thick, &kinematics_plane_strain, spec);
  for (int q = 0; q < 200; ++q) {
    double x[3];
    random_in(2, -1.2, 1.2, x);
    const int side = wall_side(thin.walls, 0, 0, x);
    assert_true(wall_near(thin.walls, 0, 0, x, 9, side, &a));
    assert_int_equal(wall_near(thick.walls, 0, 0, x, 0.3, side, &b), a.gap <= 0.35);
    if (a.gap > 0.35) continue;
    ASSERT_NEAR(b.gap, a.gap - 0.05, 1e-15);
    ASSERT_NEAR(b.curvature[1], a.curvature[1], 0);
  }
  wall_close(&thin);
  wall_close(&thick);
}

static void Arc(void **state)
{
  static const double angles[][2] = {{-30, 100}, {200, 530}, {90, 91}};
  (void)state;
  for (int k = 0; k < 3; ++k) {
    OneWall one;
    Samples samples;
    samples_open(&samples);
    sample_arc(&samples, 0.1, 0.2, 0.6, angles[k][0] * M_PI / 180, angles[k][1] * M_PI / 180, SPACING);
    wall_open(
      &one, &kinematics_plane_strain,
      (WallSpec){
        .shape = {.kind = SHAPE_ARC, .centre = {0.1, 0.2}, .radius = 0.6, .angle = {angles[k][0], angles[k][1]}}});
    compare_distances(&one, &samples, 2, 400, SPACING, -1.2, 1.2);
    for (int side = -1; side < 2; ++side) compare_derivatives(&one, 2, side, 200, -1.2, 1.2);
    wall_close(&one);
    samples_close(&samples);
  }
}

/* A plate with a notch and a lens: where one surface alone is near, distances are exact, and the
 * sign is right everywhere. */
static void Combined(void **state)
{
  Shape parts[2] = {{.kind = SHAPE_BOX, .min = {-0.8, -0.5}, .max = {0.8, 0.5}},
                    {.kind = SHAPE_BALL, .centre = {0.2, 0.5}, .radius = 0.4}};
  (void)state;
  for (int kind = SHAPE_UNION; kind <= SHAPE_INTERSECTION; ++kind)
    for (int inside = 0; inside < 2; ++inside) {
      const Shape shape = {.kind = (ShapeKind)kind, .n_children = 2, .children = parts};
      OneWall one;
      wall_open(&one, &kinematics_plane_strain, (WallSpec){.shape = shape, .inside = inside});
      compare_derivatives(&one, 2, 0, 200, -1.2, 1.2);
      for (int q = 0; q < 500; ++q) {
        double x[3];
        WallPlace place, found;
        random_in(2, -1.2, 1.2, x);
        assert_true(wall_near(one.walls, 0, 0, x, PETSC_MAX_REAL, 0, &place));
        assert_int_equal(place.gap < 0, shape_contains(&shape, 2, x, 0) ^ inside);
        /* within some reach the answer is the same or none */
        assert_int_equal(wall_near(one.walls, 0, 0, x, 0.1, 0, &found), place.gap <= 0.1);
        if (place.gap <= 0.1) ASSERT_NEAR(found.gap, place.gap, 0);
      }
      wall_close(&one);
    }
}

/* In axisymmetry what stands on the axis has no surface there: it is as if mirrored. */
static void OnTheAxis(void **state)
{
  double half[] = {0, -0.5, 0.5, -0.5, 0.3, 0.4, 0, 0.7},
         whole[] = {-0.5, -0.5, 0.5, -0.5, 0.3, 0.4, 0, 0.7, -0.3, 0.4};
  const Shape shapes[][2] = {
    {{.kind = SHAPE_POLYGON, .n_vertices = 4, .vertices = half},
     {.kind = SHAPE_POLYGON, .n_vertices = 5, .vertices = whole}},
    {{.kind = SHAPE_BOX, .min = {0, -0.2}, .max = {0.4, 0.3}},
     {.kind = SHAPE_BOX, .min = {-0.4, -0.2}, .max = {0.4, 0.3}}},
    {{.kind = SHAPE_LINE, .n_vertices = 3, .vertices = half + 2},
     {.kind = SHAPE_LINE, .n_vertices = 4, .vertices = whole + 2}},
  };
  (void)state;
  for (int k = 0; k < 3; ++k) {
    OneWall a, b;
    wall_open(&a, &kinematics_axisymmetric, (WallSpec){.shape = shapes[k][0]});
    wall_open(&b, &kinematics_plane_strain, (WallSpec){.shape = shapes[k][1]});
    assert_int_equal(diag_errors(a.diag), 0);
    for (int q = 0; q < 500; ++q) {
      double x[3];
      WallPlace p, r;
      random_in(2, -1, 1, x);
      x[0] = fabs(x[0]) * (q % 10 != 0);
      assert_true(wall_near(a.walls, 0, 0, x, 9, 0, &p) && wall_near(b.walls, 0, 0, x, 9, 0, &r));
      ASSERT_NEAR(p.gap, r.gap, 1e-15);
      if (x[0] > 0) ASSERT_NEAR(p.normal[0], r.normal[0], 1e-14), ASSERT_NEAR(p.curvature[1], r.curvature[1], 1e-12);
    }
    wall_close(&a);
    wall_close(&b);
  }
}

/* A half-space is a cone there: the wedge of two of them. */
static void ConeOfAHalfSpace(void **state)
{
  Shape sides[2] = {{.kind = SHAPE_HALF_SPACE, .point = {0.2, 0.1}, .normal = {1, 2}},
                    {.kind = SHAPE_HALF_SPACE, .point = {-0.2, 0.1}, .normal = {-1, 2}}};
  double wedge[] = {0, 0.2, 20, -9.8, -20, -9.8};
  (void)state;
  for (int inside = 0; inside < 2; ++inside) {
    OneWall a, b;
    wall_open(&a, &kinematics_axisymmetric, (WallSpec){.shape = sides[0], .inside = inside});
    wall_open(&b, &kinematics_plane_strain,
              (WallSpec){.shape = {.kind = SHAPE_POLYGON, .n_vertices = 3, .vertices = wedge}, .inside = inside});
    for (int q = 0; q < 500; ++q) {
      double x[3];
      WallPlace p, r;
      random_in(2, -1, 1, x);
      x[0] = fabs(x[0]);
      assert_true(wall_near(a.walls, 0, 0, x, 9, 0, &p) && wall_near(b.walls, 0, 0, x, 9, 0, &r));
      ASSERT_NEAR(p.gap, r.gap, 1e-14);
      ASSERT_NEAR(p.normal[1], r.normal[1], 1e-13);
      ASSERT_NEAR(p.curvature[0], r.curvature[0], 1e-11);
    }
    wall_close(&a);
    wall_close(&b);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Box),       cmocka_unit_test(Circle),
                                     cmocka_unit_test(Polygon),   cmocka_unit_test(HalfPlane),
                                     cmocka_unit_test(Line),      cmocka_unit_test(Thickness),
                                     cmocka_unit_test(Arc),       cmocka_unit_test(Combined),
                                     cmocka_unit_test(OnTheAxis), cmocka_unit_test(ConeOfAHalfSpace)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
