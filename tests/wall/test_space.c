/* Walls in space against clouds of samples of their surface, and against differences. */
#include "samples.h"

#define SPACING 0.01
#define QUERIES 150

static const double axis[3] = {2. / 3, -1. / 3, 2. / 3}, across[3] = {1. / 3, -2. / 3, -2. / 3},
                    third[3] = {2. / 3, 2. / 3, -1. / 3}, base[3] = {-0.2, 0.1, -0.3};

static void sample_line(Samples *s, int n, const double *v, int closed)
{
  for (int i = 0; i < n - !closed; ++i) {
    const double *p = v + 2 * i, *q = v + 2 * ((i + 1) % n);
    if (p[0] > 0 || q[0] > 0) sample_revolved(s, base, axis, across, third, p[0], p[1], q[0], q[1], SPACING / 2);
  }
}

/* inside_of: a position of the shape's own; NULL: the shape's. */
static void check_solid(const Shape *shape, const Samples *samples, PetscBool (*inside_of)(const double *))
{
  for (int inside = 0; inside < 2; ++inside) {
    OneWall one;
    wall_open(&one, &kinematics_3d, (WallSpec){.shape = *shape, .inside = inside});
    assert_int_equal(diag_errors(one.diag), 0);
    compare_distances(&one, samples, 3, QUERIES, SPACING, -1.2, 1.2);
    compare_derivatives(&one, 3, 0, QUERIES, -1.2, 1.2);
    for (int q = 0; q < 400; ++q) {
      double x[3];
      WallPlace place;
      random_in(3, -1.2, 1.2, x);
      assert_true(wall_near(one.walls, 0, 0, x, PETSC_MAX_REAL, 0, &place));
      const PetscBool is = inside_of ? inside_of(x) : shape_contains(shape, 3, x, 0);
      assert_int_equal(place.gap < 0, is ^ inside);
    }
    wall_close(&one);
  }
}

static void check_thin(const Shape *shape, const Samples *samples)
{
  OneWall one;
  wall_open(&one, &kinematics_3d, (WallSpec){.shape = *shape});
  assert_int_equal(diag_errors(one.diag), 0);
  compare_distances(&one, samples, 3, QUERIES, SPACING, -1.2, 1.2);
  for (int side = -1; side < 2; ++side) compare_derivatives(&one, 3, side, QUERIES, -1.2, 1.2);
  wall_close(&one);
}

static void Box(void **state)
{
  const Shape shape = {.kind = SHAPE_BOX, .min = {-0.5, -0.3, -0.6}, .max = {0.4, 0.6, 0.1}};
  Samples samples;
  (void)state;
  samples_open(&samples);
  for (int d = 0; d < 3; ++d) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    double u[3] = {0, 0, 0}, v[3] = {0, 0, 0}, a[3];
    u[e] = shape.max[e] - shape.min[e], v[f] = shape.max[f] - shape.min[f];
    for (int k = 0; k < 3; ++k) a[k] = shape.min[k];
    sample_patch(&samples, a, u, v, SPACING);
    a[d] = shape.max[d];
    sample_patch(&samples, a, u, v, SPACING);
  }
  check_solid(&shape, &samples, NULL);
  samples_close(&samples);
}

static void Sphere(void **state)
{
  const Shape shape = {.kind = SHAPE_BALL, .centre = {-0.2, 0.1, -0.3}, .radius = 0.7};
  Samples samples;
  (void)state;
  samples_open(&samples);
  for (int k = 0; k <= 600; ++k) { /* circles of latitude */
    const double r = 0.7 * sin(k * M_PI / 600), h = 0.7 * cos(k * M_PI / 600);
    sample_revolved(&samples, base, axis, across, third, r, h, r, h, SPACING / 2);
  }
  check_solid(&shape, &samples, NULL);
  samples_close(&samples);
}

static void Cylinder(void **state)
{
  const Shape shape = {
    .kind = SHAPE_CYLINDER, .point = {-0.2, 0.1, -0.3}, .normal = {4, -2, 4}, .length = 0.8, .radii = {0.3, 0.3}};
  const double section[] = {0, 0, 0.3, 0, 0.3, 0.8, 0, 0.8};
  Samples samples;
  (void)state;
  samples_open(&samples);
  sample_line(&samples, 4, section, 1);
  check_solid(&shape, &samples, NULL);
  samples_close(&samples);
}

static void Cones(void **state)
{
  static const double radii[][2] = {{0.5, 0.2}, {0, 0.4}, {0.4, 0}};
  (void)state;
  for (int k = 0; k < 3; ++k) {
    const Shape shape = {.kind = SHAPE_CONE,
                         .point = {-0.2, 0.1, -0.3},
                         .normal = {4, -2, 4},
                         .length = 0.8,
                         .radii = {radii[k][0], radii[k][1]}};
    const double section[] = {0, 0, radii[k][0], 0, radii[k][1], 0.8, 0, 0.8};
    Samples samples;
    samples_open(&samples);
    sample_line(&samples, 4, section, 1);
    check_solid(&shape, &samples, NULL);
    samples_close(&samples);
  }
}

static void HalfSpace(void **state)
{
  const Shape shape = {.kind = SHAPE_HALF_SPACE, .point = {-0.2, 0.1, -0.3}, .normal = {4, -2, 4}};
  const double u[3] = {5 * across[0], 5 * across[1], 5 * across[2]}, v[3] = {5 * third[0], 5 * third[1], 5 * third[2]};
  double a[3];
  Samples samples;
  (void)state;
  for (int d = 0; d < 3; ++d) a[d] = base[d] - u[d] / 2 - v[d] / 2;
  samples_open(&samples);
  sample_patch(&samples, a, u, v, SPACING);
  check_solid(&shape, &samples, NULL);
  samples_close(&samples);
}

static void Disks(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    const Shape shape = {
      .kind = SHAPE_DISK, .centre = {-0.2, 0.1, -0.3}, .normal = {4, -2, 4}, .radii = {0.3 * k, 0.7}};
    const double section[] = {0.3 * k, 0, 0.7, 0},
                 above[3] = {base[0] + 0.2 * axis[0] + 0.5 * across[0], base[1] + 0.2 * axis[1] + 0.5 * across[1],
                             base[2] + 0.2 * axis[2] + 0.5 * across[2]};
    OneWall one;
    Samples samples;
    samples_open(&samples);
    sample_line(&samples, 2, section, 0);
    check_thin(&shape, &samples);
    wall_open(&one, &kinematics_3d, (WallSpec){.shape = shape});
    assert_int_equal(wall_side(one.walls, 0, 0, above), 1);
    wall_close(&one);
    samples_close(&samples);
  }
}

/* A hopper: thin, a cone on a tube, open at both ends; and as thick as its closed section. */
static double hopper[] = {0.1, 0, 0.1, 0.2, 0.6, 0.5, 0.6, 0.9};
static double casting[] = {0.1, 0, 0.2, 0, 0.2, 0.1, 0.7, 0.5, 0.6, 0.9, 0.1, 0.2};

static PetscBool in_casting(const double *x)
{
  const Shape section = {.kind = SHAPE_POLYGON, .n_vertices = 6, .vertices = casting};
  double height = 0, square = 0, at[2];
  for (int d = 0; d < 3; ++d) height += (x[d] - base[d]) * axis[d];
  for (int d = 0; d < 3; ++d) square += PetscSqr(x[d] - base[d]);
  at[0] = sqrt(square - height * height), at[1] = height;
  return shape_contains(&section, 2, at, 0);
}

static void Revolved(void **state)
{
  Shape shape = {.kind = SHAPE_REVOLVED,
                 .point = {-0.2, 0.1, -0.3},
                 .normal = {4, -2, 4},
                 .n_vertices = 4,
                 .vertices = hopper,
                 .open = PETSC_TRUE};
  Samples samples;
  (void)state;
  samples_open(&samples);
  sample_line(&samples, 4, hopper, 0);
  check_thin(&shape, &samples);
  samples.n = 0;
  sample_line(&samples, 6, casting, 1);
  shape.open = PETSC_FALSE, shape.n_vertices = 6, shape.vertices = casting;
  check_solid(&shape, &samples, in_casting);
  samples_close(&samples);
}

/* The Hessian stays what it is on the axis itself, where directions across it have no name. */
static void OnTheAxis(void **state)
{
  const Shape shape = {
    .kind = SHAPE_CONE, .point = {-0.2, 0.1, -0.3}, .normal = {4, -2, 4}, .length = 0.8, .radii = {0.4, 0}};
  OneWall one;
  WallPlace on, beside;
  double x[3], y[3];
  (void)state;
  for (int d = 0; d < 3; ++d) x[d] = base[d] + 1.1 * axis[d], y[d] = x[d] + 1e-9 * across[d];
  wall_open(&one, &kinematics_3d, (WallSpec){.shape = shape});
  assert_true(wall_near(one.walls, 0, 0, x, 9, 0, &on) && wall_near(one.walls, 0, 0, y, 9, 0, &beside));
  ASSERT_NEAR(on.gap, 0.3, 1e-15);
  for (int d = 0; d < 3; ++d) ASSERT_NEAR(on.normal[d], axis[d], 1e-14);
  for (int k = 0; k < 9; ++k) ASSERT_NEAR(on.curvature[k], beside.curvature[k], 1e-7);
  ASSERT_NEAR(on.curvature[0] + on.curvature[4] + on.curvature[8], 2 / 0.3, 1e-12);
  wall_close(&one);
}

/* Before an edge or a corner the largest curvature is one over the distance, also before the rim of a hole, along which
 * the level surface bends the other way; before what is round it is less. */
static void Bends(void **state)
{
  static const double at[][2] = {{0.25, 0.1}, {0.1, -0.2}, {0.8, 0.05}, {0.5, 0.1}};
  const Shape disk = {.kind = SHAPE_DISK, .centre = {-0.2, 0.1, -0.3}, .normal = {4, -2, 4}, .radii = {0.3, 0.7}};
  const Shape box = {.kind = SHAPE_BOX, .min = {-1, -1, -1}, .max = {0, 0, 0}},
              ball = {.kind = SHAPE_BALL, .radius = 2};
  const double corner[3] = {0.1, 0.2, 0.3}, over[3] = {1, 2, 2};
  OneWall one;
  WallPlace place;
  (void)state;
  wall_open(&one, &kinematics_3d, (WallSpec){.shape = disk});
  for (int k = 0; k < 4; ++k) {
    double x[3];
    for (int d = 0; d < 3; ++d) x[d] = base[d] + at[k][0] * across[d] + at[k][1] * axis[d];
    assert_true(wall_near(one.walls, 0, 0, x, 9, 0, &place));
    ASSERT_NEAR(wall_bend(&place) * place.gap, k < 3, 1e-12);
  }
  wall_close(&one);
  for (int k = 0; k < 2; ++k) {
    wall_open(&one, &kinematics_3d, (WallSpec){.shape = k ? ball : box});
    assert_true(wall_near(one.walls, 0, 0, k ? over : corner, 9, 0, &place));
    ASSERT_NEAR(wall_bend(&place) * place.gap, k ? 1. / 3 : 1, 1e-7); /* the root of what rounding leaves */
    wall_close(&one);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(Box),      cmocka_unit_test(Sphere),    cmocka_unit_test(Cylinder),
    cmocka_unit_test(Cones),    cmocka_unit_test(HalfSpace), cmocka_unit_test(Disks),
    cmocka_unit_test(Revolved), cmocka_unit_test(OnTheAxis), cmocka_unit_test(Bends)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
