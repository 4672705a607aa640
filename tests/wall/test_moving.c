/* Moving walls: what a frame that moves along sees is what it saw at the start. */
#include "walls.h"

typedef struct {
  double R[9], T[3];
} Rigid;

/* exp of the cross product matrix of w, by its series: no formula of Rodrigues. */
static void exponential(const double w[3], double R[9])
{
  const double W[9] = {0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0};
  double term[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, next[9];
  for (int k = 0; k < 9; ++k) R[k] = term[k];
  for (int n = 1; n < 60; ++n) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        next[3 * i + j] = 0;
        for (int k = 0; k < 3; ++k) next[3 * i + j] += term[3 * i + k] * W[3 * k + j] / n;
      }
    for (int k = 0; k < 9; ++k) R[k] += term[k] = next[k];
  }
}

static void apply(const Rigid *m, const double X[3], double x[3])
{
  for (int i = 0; i < 3; ++i) x[i] = m->T[i] + m->R[3 * i] * X[0] + m->R[3 * i + 1] * X[1] + m->R[3 * i + 2] * X[2];
}

static double times[] = {0, 1, 2}, factors[] = {0, 2, 1}; /* integral: t^2, then 1 + 2.5 (t-1) ... */

/* The motion of the tests: turn about (0.3, -0.1, 0.2), fall with the amplitude, turn about the
 * origin. */
static MotionSpec motions[3] = {
  {.kind = MOTION_ROTATION, .component = {1, 1, 1}, .centre = {0.3, -0.1, 0.2}, .axis = {1, 2, -2}, .rate = 0.7},
  {.kind = MOTION_VELOCITY, .component = {1, 0, 1}, .value = {0.2, 0, -0.5}, .amplitude = {3, times, factors}},
  {.kind = MOTION_ROTATION, .component = {1, 1, 1}, .axis = {0, 0, 3}, .rate = -1.1, .amplitude = {3, times, factors}},
};

static double span_of(double t) { return t < 1 ? t * t : 1 + 2 * (t - 1) - 0.5 * (t - 1) * (t - 1); }

static void at_time(double t, Rigid *m)
{
  const double w[3] = {0.7 * t / 3, 1.4 * t / 3, -1.4 * t / 3}, c[3] = {0.3, -0.1, 0.2},
               v[3] = {0, 0, -1.1 * span_of(t)};
  Rigid a = {.T = {0, 0, 0}}, b = {.T = {0, 0, 0}};
  double moved[3];
  exponential(w, a.R);
  exponential(v, b.R);
  apply(&a, c, moved);
  for (int d = 0; d < 3; ++d) a.T[d] = c[d] - moved[d];
  a.T[0] += 0.2 * span_of(t), a.T[2] -= 0.5 * span_of(t);
  apply(&b, a.T, m->T);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      m->R[3 * i + j] = 0;
      for (int k = 0; k < 3; ++k) m->R[3 * i + j] += b.R[3 * i + k] * a.R[3 * k + j];
    }
}

static void Objective(void **state)
{
  const Shape shape = {
    .kind = SHAPE_CONE, .point = {-0.2, 0.1, -0.3}, .normal = {4, -2, 4}, .length = 0.8, .radii = {0.4, 0.1}};
  OneWall still, moving;
  (void)state;
  wall_open(&still, &kinematics_3d, (WallSpec){.shape = shape});
  wall_open(&moving, &kinematics_3d, (WallSpec){.shape = shape, .n_motions = 3, .motions = motions});
  for (int q = 0; q < 300; ++q) {
    const double t = 2 * uniform();
    double X[3], x[3], normal[3], column[3], turned[9];
    WallPlace a, b;
    Rigid m;
    random_in(3, -1, 1, X);
    at_time(t, &m);
    apply(&m, X, x);
    assert_true(wall_near(still.walls, 0, 0, X, 9, 0, &a) && wall_near(moving.walls, 0, t, x, 9, 0, &b));
    ASSERT_NEAR(b.gap, a.gap, 1e-14);
    for (int d = 0; d < 3; ++d) m.T[d] = 0;
    apply(&m, a.normal, normal);
    for (int d = 0; d < 3; ++d) ASSERT_NEAR(b.normal[d], normal[d], 1e-13);
    for (int i = 0; i < 3; ++i) { /* R H, then (R H) R^T */
      double h[3] = {a.curvature[i], a.curvature[3 + i], a.curvature[6 + i]};
      apply(&m, h, column);
      for (int k = 0; k < 3; ++k) turned[3 * k + i] = column[k];
    }
    for (int i = 0; i < 3; ++i) {
      apply(&m, turned + 3 * i, column);
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(b.curvature[3 * i + k], column[k], 1e-11);
    }
  }
  wall_close(&still);
  wall_close(&moving);
}

/* What a wall's matter moves by is the difference of where it is, and what stands on the wall keeps
 * its gap. */
static void Increments(void **state)
{
  const Shape shape = {.kind = SHAPE_BALL, .centre = {0.1, 0.2, 0.3}, .radius = 0.4};
  OneWall one;
  (void)state;
  wall_open(&one, &kinematics_3d, (WallSpec){.shape = shape, .n_motions = 3, .motions = motions});
  for (int q = 0; q < 300; ++q) {
    const double t0 = 2 * uniform(), t1 = q % 2 ? 2 * uniform() : t0 + 1e-9;
    double X[3], x0[3], x1[3], step[3];
    WallPlace a, b;
    Rigid m0, m1;
    random_in(3, -1, 1, X);
    at_time(t0, &m0);
    at_time(t1, &m1);
    apply(&m0, X, x0);
    apply(&m1, X, x1);
    wall_motion(one.walls, 0, t0, t1, x0, step);
    for (int d = 0; d < 3; ++d) ASSERT_NEAR(step[d], x1[d] - x0[d], 3e-15);
    assert_true(wall_near(one.walls, 0, t0, x0, 9, 0, &a));
    for (int d = 0; d < 3; ++d) x0[d] += step[d];
    assert_true(wall_near(one.walls, 0, t1, x0, 9, 0, &b));
    ASSERT_NEAR(a.gap, b.gap, 5e-15);
  }
  wall_close(&one);
}

/* A tiny step keeps its digits: v dt, to rounding of that. */
static void SmallSteps(void **state)
{
  MotionSpec turn = {.kind = MOTION_ROTATION, .component = {1, 1}, .centre = {1, 0}, .axis = {0, 0, 1}, .rate = 2};
  const Shape shape = {.kind = SHAPE_HALF_SPACE, .normal = {0, 1}};
  OneWall one;
  const double x[2] = {4, 0};
  double step[3];
  (void)state;
  wall_open(&one, &kinematics_plane_strain, (WallSpec){.shape = shape, .n_motions = 1, .motions = &turn});
  wall_motion(one.walls, 0, 0.5, 0.5 + 0x1p-40, x, step);
  ASSERT_NEAR(step[1], 6 * 0x1p-40, 1e-14 * 6 * 0x1p-40);
  ASSERT_NEAR(step[0], -6 * 0x1p-40 * 0x1p-40, 1e-25);
  assert_true(step[2] == 0);
  wall_close(&one);
}

/* A displacement is that of the case: with pseudo-time in statics, at once in dynamics. */
static void Displacement(void **state)
{
  MotionSpec push = {.kind = MOTION_DISPLACEMENT, .component = {0, 1}, .value = {0, -0.3}};
  const Shape shape = {.kind = SHAPE_HALF_SPACE, .normal = {0, 1}};
  OneWall one;
  WallPlace place;
  const double x[2] = {4, 1};
  double step[3];
  (void)state;
  wall_open(&one, &kinematics_plane_strain, (WallSpec){.shape = shape, .n_motions = 1, .motions = &push});
  assert_true(wall_near(one.walls, 0, 0, x, 9, 0, &place));
  ASSERT_NEAR(place.gap, 1, 0);
  assert_true(wall_near(one.walls, 0, 0.1, x, 9, 0, &place));
  ASSERT_NEAR(place.gap, 1.3, 1e-15);
  one.c.analysis.type = ANALYSIS_STATIC, one.c.analysis.end = 2;
  assert_true(wall_near(one.walls, 0, 1, x, 9, 0, &place));
  ASSERT_NEAR(place.gap, 1.15, 1e-15);
  wall_motion(one.walls, 0, 0.5, 1.5, x, step);
  ASSERT_NEAR(step[1], -0.15, 1e-16);
  wall_close(&one);
}

/* A gate, and what comes when it goes: never both, never none. */
static void FromUntil(void **state)
{
  const Shape shape = {.kind = SHAPE_HALF_SPACE, .normal = {0, 1}};
  OneWall before, after;
  WallPlace place;
  const double x[2] = {0, 1};
  (void)state;
  wall_open(&before, &kinematics_plane_strain, (WallSpec){.shape = shape, .has_until = 1, .until = 0.3});
  wall_open(&after, &kinematics_plane_strain, (WallSpec){.shape = shape, .from = 0.3});
  for (int k = 0; k <= 100; ++k) { /* 0.01 30 times is not 0.3, but meant so */
    double t = 0;
    for (int i = 0; i < k; ++i) t += 0.01;
    assert_int_equal(wall_stands(before.walls, 0, t), k <= 30);
    assert_int_equal(wall_stands(after.walls, 0, t), k > 30);
    assert_int_equal(wall_comes(before.walls, 0, t), k < 30); /* steps that begin then */
    assert_int_equal(wall_comes(after.walls, 0, t), k >= 30);
    assert_int_equal(wall_is_new(after.walls, 0, t), k <= 30);
    assert_int_equal(wall_near(before.walls, 0, t, x, 9, 0, &place), k <= 30);
    assert_int_equal(wall_near(after.walls, 0, t, x, 9, 0, &place), k >= 30);
    assert_int_equal(walls_until_change(before.walls, t) < 1, k < 30);
    if (k < 30) ASSERT_NEAR(walls_until_change(after.walls, t), 0.3 - t, 1e-14);
  }
  assert_true(wall_is_new(before.walls, 0, 0));
  before.c.stage = 1; /* which has not brought it */
  assert_false(wall_is_new(before.walls, 0, 0));
  wall_close(&before);
  wall_close(&after);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Objective), cmocka_unit_test(Increments),
                                     cmocka_unit_test(SmallSteps), cmocka_unit_test(Displacement),
                                     cmocka_unit_test(FromUntil)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
