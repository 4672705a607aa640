/* Shapes: what belongs to them, and the boxes around them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "case/case.h"
#include "case/shape_volume.h"

#define ASSERT_NEAR(a, b, tolerance) assert_true(PetscAbsReal((a) - (b)) <= (tolerance))

static const PetscReal tolerance = 1e-10;

static PetscBool In2(const Shape *s, PetscReal x, PetscReal y)
{
  const PetscReal p[3] = {x, y, 0};
  return shape_contains(s, 2, p, tolerance);
}

static void Box(void **state)
{
  const Shape s = {.kind = SHAPE_BOX, .min = {0, 0}, .max = {2, 1}};
  (void)state;
  assert_true(In2(&s, 1, 0.5));
  assert_true(In2(&s, 2, 1));
  assert_true(In2(&s, 2 + 1e-11, 1));
  assert_false(In2(&s, 2 + 1e-9, 1));
  assert_false(In2(&s, -0.1, 0.5));
}

static void Ball(void **state)
{
  const Shape s = {.kind = SHAPE_BALL, .centre = {1, 1, 1}, .radius = 2};
  const PetscReal on[3] = {1, 3, 1}, off[3] = {2.5, 2.5, 1};
  PetscReal min[3], max[3];
  (void)state;
  assert_true(shape_contains(&s, 3, on, tolerance));
  assert_false(shape_contains(&s, 3, off, tolerance));
  shape_bounds(&s, 3, min, max);
  ASSERT_NEAR(min[2], -1, 0);
  ASSERT_NEAR(max[0], 3, 0);
}

/* An L: not convex, and its corner at (1, 1) points inward. */
static void Polygon(void **state)
{
  PetscReal corners[] = {0, 0, 2, 0, 2, 1, 1, 1, 1, 2, 0, 2};
  const Shape s = {.kind = SHAPE_POLYGON, .n_vertices = 6, .vertices = corners};
  PetscReal min[3], max[3];
  (void)state;
  assert_true(In2(&s, 0.5, 1.5));
  assert_true(In2(&s, 1.5, 0.5));
  assert_false(In2(&s, 1.5, 1.5));
  assert_true(In2(&s, 1, 1));
  assert_true(In2(&s, 1.5, 1));
  assert_true(In2(&s, 2, 0));
  assert_false(In2(&s, 2.1, 0));
  shape_bounds(&s, 2, min, max);
  ASSERT_NEAR(max[0], 2, 0);
  ASSERT_NEAR(max[1], 2, 0);
  ASSERT_NEAR(min[0], 0, 0);
}

static void HalfSpace(void **state)
{
  const Shape slope = {.kind = SHAPE_HALF_SPACE, .point = {0, 1}, .normal = {3, 4}};
  const Shape ground = {.kind = SHAPE_HALF_SPACE, .point = {7, 1}, .normal = {0, 2}};
  PetscReal min[3], max[3];
  (void)state;
  assert_true(In2(&slope, 0, 1));
  assert_true(In2(&slope, -4, 4));
  assert_false(In2(&slope, 0.1, 1));
  assert_true(
    /* a distance, whatever the normal's length */
    In2(&slope, 0.6 * 0.9 * tolerance, 1 + 0.8 * 0.9 * tolerance));
  assert_false(In2(&slope, 0.6 * 1.1 * tolerance, 1 + 0.8 * 1.1 * tolerance));
  shape_bounds(&slope, 2, min, max);
  assert_true(max[0] == PETSC_MAX_REAL && max[1] == PETSC_MAX_REAL);
  shape_bounds(&ground, 2, min, max);
  ASSERT_NEAR(max[1], 1, 0);
  assert_true(min[1] == -PETSC_MAX_REAL && max[0] == PETSC_MAX_REAL);
}

/* Along the diagonal of the plane z = 1: a tolerance is a distance from the slanted surface, too. */
static void CylinderAndCone(void **state)
{
  const Shape cylinder = {
    .kind = SHAPE_CYLINDER, .point = {1, 1, 1}, .normal = {3, 4, 0}, .length = 5, .radii = {2, 2}};
  const Shape cone = {.kind = SHAPE_CONE, .point = {0, 0, 0}, .normal = {0, 0, 7}, .length = 4, .radii = {3, 0}};
  const PetscReal end[3] = {4, 5, 1}, side[3] = {1 - 0.8 * 2, 1 + 0.6 * 2, 1}, beyond[3] = {4.1, 5.1, 1};
  const PetscReal n[2] = {0.8, 0.6}; /* of the cone, in the plane of radius and height */
  PetscReal min[3], max[3];
  (void)state;
  assert_true(shape_contains(&cylinder, 3, end, tolerance) && shape_contains(&cylinder, 3, side, tolerance));
  assert_false(shape_contains(&cylinder, 3, beyond, tolerance));
  shape_bounds(&cylinder, 3, min, max);
  ASSERT_NEAR(min[0], 1 - 2 * 0.8, 1e-15);
  ASSERT_NEAR(max[1], 5 + 2 * 0.6, 1e-15);
  ASSERT_NEAR(max[2], 3, 1e-15);
  for (int k = 0; k < 2; ++k) {
    const PetscReal away = (k ? 1.1 : 0.9) * tolerance, x[3] = {0, 1.5 + away * n[0], 2 + away * n[1]};
    assert_int_equal(shape_contains(&cone, 3, x, tolerance), k == 0);
  }
  shape_bounds(&cone, 3, min, max);
  ASSERT_NEAR(min[0], -3, 0);
  ASSERT_NEAR(max[2], 4, 0);
}

/* A plate with a hole; the rim of the hole belongs to the plate. */
static void Difference(void **state)
{
  Shape parts[2] = {{.kind = SHAPE_BOX, .min = {-2, -2}, .max = {2, 2}},
                    {.kind = SHAPE_BALL, .centre = {0, 0}, .radius = 1}};
  const Shape s = {.kind = SHAPE_DIFFERENCE, .n_children = 2, .children = parts};
  PetscReal min[3], max[3];
  (void)state;
  assert_false(In2(&s, 0, 0));
  assert_true(In2(&s, 1, 0));
  assert_true(In2(&s, 1.5, 1.5));
  assert_false(In2(&s, 2.5, 0));
  shape_bounds(&s, 2, min, max);
  ASSERT_NEAR(max[0], 2, 0);
}

static void UnionAndIntersection(void **state)
{
  Shape parts[2] = {{.kind = SHAPE_BOX, .min = {0, 0}, .max = {2, 1}},
                    {.kind = SHAPE_BOX, .min = {1, 0}, .max = {3, 4}}};
  const Shape both = {.kind = SHAPE_UNION, .n_children = 2, .children = parts};
  const Shape common = {.kind = SHAPE_INTERSECTION, .n_children = 2, .children = parts};
  PetscReal min[3], max[3];
  (void)state;
  assert_true(In2(&both, 0.5, 0.5) && In2(&both, 2.5, 3));
  assert_false(In2(&both, 0.5, 2));
  assert_true(In2(&common, 1.5, 0.5));
  assert_false(In2(&common, 0.5, 0.5));
  shape_bounds(&both, 2, min, max);
  ASSERT_NEAR(min[0], 0, 0);
  ASSERT_NEAR(max[1], 4, 0);
  shape_bounds(&common, 2, min, max);
  ASSERT_NEAR(min[0], 1, 0);
  ASSERT_NEAR(max[0], 2, 0);
  ASSERT_NEAR(max[1], 1, 0);
}

/* Half-spaces askew cut a box to something smaller: a square on its corner, in the plane and as a prism; a tetrahedron. */
static void Askew(void **state)
{
  Shape parts[5] = {{.kind = SHAPE_BOX, .min = {-5, -5, 0}, .max = {9, 9, 2}},
                    {.kind = SHAPE_HALF_SPACE, .point = {1, 0, 0}, .normal = {1, 1, 0}},
                    {.kind = SHAPE_HALF_SPACE, .point = {1, 0, 0}, .normal = {1, -1, 0}},
                    {.kind = SHAPE_HALF_SPACE, .point = {-1, 0, 0}, .normal = {-2, 2, 0}},
                    {.kind = SHAPE_HALF_SPACE, .point = {-1, 0, 0}, .normal = {-1, -1, 0}}};
  const Shape square = {.kind = SHAPE_INTERSECTION, .n_children = 5, .children = parts};
  Shape corner[2] = {{.kind = SHAPE_BOX, .min = {0, 0, 0}, .max = {4, 4, 1}},
                     {.kind = SHAPE_HALF_SPACE, .point = {0, 0, 3}, .normal = {1, 1, 1}}};
  const Shape cut = {.kind = SHAPE_INTERSECTION, .n_children = 2, .children = corner};
  PetscReal min[3], max[3];
  (void)state;
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    shape_bounds(&square, dim, min, max);
    for (int d = 0; d < 2; ++d) {
      ASSERT_NEAR(min[d], -1, 1e-14);
      ASSERT_NEAR(max[d], 1, 1e-14);
    }
    ASSERT_NEAR(max[2], dim == 3 ? 2 : 0, 0);
    const PetscReal area = shape_volume(&square, dim == 2 ? &kinematics_plane_strain : &kinematics_3d, min, max);
    ASSERT_NEAR(area, dim == 3 ? 4 : 2, 1e-3);
  }
  shape_bounds(&cut, 3, min, max);
  ASSERT_NEAR(max[0], 3, 1e-14);
  ASSERT_NEAR(max[1], 3, 1e-14);
  ASSERT_NEAR(max[2], 1, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Askew),      cmocka_unit_test(Box),
                                     cmocka_unit_test(Ball),       cmocka_unit_test(Polygon),
                                     cmocka_unit_test(HalfSpace),  cmocka_unit_test(CylinderAndCone),
                                     cmocka_unit_test(Difference), cmocka_unit_test(UnionAndIntersection)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
