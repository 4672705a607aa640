/* Corners of one wall: which of its sides a position meets, against planes that are written down here, in every form
 * that a wall may have; and that a side goes along with its wall. */
#include "stl_files.h"

#define WITHIN 0.35

/* What the material is on the positive side of: a point of it and the unit normal. */
typedef struct {
  double point[3], n[3];
} Plane;

static double above(const Plane *plane, const double x[3])
{
  double sum = 0;
  for (int d = 0; d < 3; ++d) sum += (x[d] - plane->point[d]) * plane->n[d];
  return sum;
}

/* Does x stand straight before some place of that plane that all others leave free? */
static int sees(const Plane *plane, int n, const Plane *room, const double x[3])
{
  double foot[3];
  for (int d = 0; d < 3; ++d) foot[d] = x[d] - above(plane, x) * plane->n[d];
  for (int k = 0; k < n; ++k)
    if (room + k != plane && above(room + k, foot) < 0) return 0;
  return 1;
}

/* The planes before x in the order of their distance, as many as there are axes. */
static int expected(int dim, int n, const Plane *room, const double x[3], const Plane *found[])
{
  int count = 0;
  for (double last = 0; count < dim;) {
    const Plane *next = NULL;
    for (int k = 0; k < n; ++k) {
      const double gap = above(room + k, x);
      if (gap > last && gap <= WITHIN && sees(room + k, n, room, x) && (!next || gap < above(next, x))) next = room + k;
    }
    if (!next) break;
    last = above(next, x);
    found[count++] = next;
  }
  return count;
}

/* From everywhere in the room; corners are those of `most` sides. */
static void check_room(const Kinematics *kinematics, int dim, WallSpec spec, int side, int n, const Plane *room)
{
  OneWall one;
  int most = 0;
  wall_open(&one, kinematics, spec);
  assert_int_equal(diag_errors(one.diag), 0);
  assert_true(wall_has_corners(&one.spec));
  for (int q = 0; q < 2000; ++q) {
    const Plane *plane[3];
    WallPlace place[WALL_SIDES];
    double x[3];
    int in = 1;
    random_in(dim, -0.6, 0.6, x);
    for (int k = 0; k < n; ++k) in &= above(room + k, x) > 1e-6;
    if (!in) continue;
    const int sides = expected(dim, n, room, x, plane);
    assert_int_equal(wall_sides(one.walls, 0, 0, x, WITHIN, side, place), sides);
    for (int i = 0; i < sides; ++i) {
      ASSERT_NEAR(place[i].gap, above(plane[i], x), 1e-14);
      for (int d = 0; d < 3; ++d) ASSERT_NEAR(place[i].normal[d], plane[i]->n[d], 1e-14);
    }
    most = sides > most ? sides : most;
  }
  assert_int_equal(most, dim);
  wall_close(&one);
}

static const Plane square[] = {{{0, -0.5}, {0, 1}}, {{-0.5, 0}, {1, 0}}, {{0, 0.5}, {0, -1}}, {{0.5, 0}, {-1, 0}}};

static void Rooms(void **state)
{
  static double corners[] = {-0.5, -0.5, 0.5, -0.5, 0.5, 0.5, -0.5, 0.5};
  static double trough[] = {-0.5, 0.9, -0.5, -0.5, 0.5, -0.5, 0.5, 0.9};
  static double around[] = {-0.9, 0.9, -0.9, -0.9, 0.9, -0.9, 0.9, 0.9, 0.5, 0.9, 0.5, -0.5, -0.5, -0.5, -0.5, 0.9};
  Shape half[] = {{.kind = SHAPE_HALF_SPACE, .point = {0, -0.5}, .normal = {0, 1}},
                  {.kind = SHAPE_HALF_SPACE, .point = {-0.5, 0}, .normal = {1, 0}},
                  {.kind = SHAPE_HALF_SPACE, .point = {0.5, 0}, .normal = {-1, 0}}};
  const Plane three[] = {square[0], square[1], square[3]};
  const Kinematics *plane = &kinematics_plane_strain;
  (void)state;
  const WallSpec box = {.shape = {.kind = SHAPE_BOX, .min = {-0.5, -0.5}, .max = {0.5, 0.5}}, .inside = PETSC_TRUE};
  check_room(plane, 2, box, 0, 4, square);
  const WallSpec polygon = {.shape = {.kind = SHAPE_POLYGON, .n_vertices = 4, .vertices = corners},
                            .inside = PETSC_TRUE};
  check_room(plane, 2, polygon, 0, 4, square);
  const WallSpec line = {.shape = {.kind = SHAPE_LINE, .n_vertices = 4, .vertices = trough}};
  check_room(plane, 2, line, -1, 3, three);
  const WallSpec frame = {.shape = {.kind = SHAPE_POLYGON, .n_vertices = 8, .vertices = around}};
  check_room(plane, 2, frame, 0, 3, three);
  const WallSpec sum = {.shape = {.kind = SHAPE_UNION, .n_children = 3, .children = half}};
  check_room(plane, 2, sum, 0, 3, three);
}

/* Two sides at an angle a on either side of the axis upwards: less and more than a right angle between them. */
static void Notches(void **state)
{
  (void)state;
  for (int k = 1; k <= 5; ++k) {
    const double a = k * 15 * M_PI / 180, s = sin(a), c = cos(a);
    double line[] = {-3 * s, 3 * c - 0.5, 0, -0.5, 3 * s, 3 * c - 0.5};
    const Plane sides[] = {{{0, -0.5}, {c, s}}, {{0, -0.5}, {-c, s}}};
    Shape half[] = {{.kind = SHAPE_HALF_SPACE, .point = {0, -0.5}, .normal = {c, s}},
                    {.kind = SHAPE_HALF_SPACE, .point = {0, -0.5}, .normal = {-c, s}}};
    const WallSpec thin = {.shape = {.kind = SHAPE_LINE, .n_vertices = 3, .vertices = line}};
    check_room(&kinematics_plane_strain, 2, thin, -1, 2, sides);
    const WallSpec sum = {.shape = {.kind = SHAPE_UNION, .n_children = 2, .children = half}};
    check_room(&kinematics_plane_strain, 2, sum, 0, 2, sides);
  }
}

static void Space(void **state)
{
  const double min[3] = {-0.5, -0.5, -0.5}, max[3] = {0.5, 0.5, 0.5};
  Plane cube[6];
  Soup soup;
  (void)state;
  memset(cube, 0, sizeof cube);
  for (int k = 0; k < 6; ++k) cube[k].point[k / 2] = k % 2 ? 0.5 : -0.5, cube[k].n[k / 2] = k % 2 ? -1 : 1;
  WallSpec box = {.shape = {.kind = SHAPE_BOX, .min = {-0.5, -0.5, -0.5}, .max = {0.5, 0.5, 0.5}},
                  .inside = PETSC_TRUE};
  check_room(&kinematics_3d, 3, box, 0, 6, cube);
  soup_open(&soup);
  soup_add_box(&soup, min, max);
  WallSpec read = {.shape = {.kind = SHAPE_SURFACE, .scale = 1}, .inside = PETSC_TRUE};
  read.shape.file = (char *)write_binary(&soup, "room.stl");
  check_room(&kinematics_3d, 3, read, 0, 6, cube);
  soup_close(&soup);
}

/* Straight before the edge between two triangles of one side, and before the corner of four. */
static void Diagonals(void **state)
{
  const double min[3] = {-0.5, -0.5, -0.5}, max[3] = {0.5, 0.5, 0.5}, x[3] = {-0.375, -0.375, -0.25};
  WallPlace place[WALL_SIDES];
  OneWall one;
  Soup soup;
  (void)state;
  soup_open(&soup);
  soup_add_box(&soup, min, max);
  WallSpec read = {.shape = {.kind = SHAPE_SURFACE, .scale = 1}, .inside = PETSC_TRUE};
  read.shape.file = (char *)write_binary(&soup, "diagonal.stl");
  wall_open(&one, &kinematics_3d, read);
  assert_int_equal(wall_sides(one.walls, 0, 0, x, WITHIN, 0, place), 3);
  for (int i = 0; i < 3; ++i) ASSERT_NEAR(place[i].gap, i < 2 ? 0.125 : 0.25, 1e-15);
  wall_close(&one);
  soup_close(&soup);
}

/* A cup: its bottom is flat, its side is round. */
static void Cup(void **state)
{
  const double low[3] = {0, 0, -0.5};
  WallSpec spec = {
    .shape = {.kind = SHAPE_CYLINDER, .point = {0, 0, -0.5}, .normal = {0, 0, 1}, .length = 2, .radii = {0.5, 0.5}},
    .inside = PETSC_TRUE};
  OneWall one;
  int both = 0;
  (void)state;
  wall_open(&one, &kinematics_3d, spec);
  for (int q = 0; q < 500; ++q) {
    WallPlace place[WALL_SIDES];
    double x[3];
    random_in(3, -0.5, 0.5, x);
    const double r = hypot(x[0], x[1]), side = 0.5 - r, bottom = x[2] - low[2];
    if (side <= 0 || bottom <= 0) continue;
    const int n = wall_sides(one.walls, 0, 0, x, WITHIN, 0, place);
    assert_int_equal(n, (side <= WITHIN) + (bottom <= WITHIN));
    for (int i = 0; i < n; ++i) {
      const int flat = fabs(place[i].normal[2]) > 0.5;
      ASSERT_NEAR(place[i].gap, flat ? bottom : side, 1e-14);
      ASSERT_NEAR(place[i].normal[0], flat ? 0 : -x[0] / r, 1e-13);
    }
    both += n == 2;
  }
  assert_true(both > 50);
  wall_close(&one);
}

/* What has no corners where the material is, and what hides another side. */
static void OneSide(void **state)
{
  static double ring[128], thin[] = {-0.5, -0.5, 0.5, -0.5, 0.5, -0.49, -0.5, -0.49};
  static double bent[] = {-0.5, -0.5, 0, 0, 0.5, -0.5}; /* a roof, seen from above */
  WallPlace place[WALL_SIDES];
  OneWall one;
  double x[3];
  (void)state;
  for (int k = 0; k < 64; ++k) ring[2 * k] = 0.5 * cos(k * M_PI / 32), ring[2 * k + 1] = 0.5 * sin(k * M_PI / 32);
  const WallSpec round = {.shape = {.kind = SHAPE_POLYGON, .n_vertices = 64, .vertices = ring}, .inside = PETSC_TRUE};
  const WallSpec plate = {.shape = {.kind = SHAPE_POLYGON, .n_vertices = 4, .vertices = thin}};
  const WallSpec post = {.shape = {.kind = SHAPE_BOX, .min = {-0.2, -0.2}, .max = {0.2, 0.2}}};
  const WallSpec roof = {.shape = {.kind = SHAPE_LINE, .n_vertices = 3, .vertices = bent}};
  assert_false(wall_has_corners(&round));
  assert_false(wall_has_corners(&plate));
  assert_false(wall_has_corners(&post));
  wall_open(&one, &kinematics_plane_strain, roof);
  assert_true(wall_has_corners(&one.spec));
  for (int q = 0; q < 300; ++q) {
    random_in(2, -0.4, 0.4, x);
    if (x[1] < -fabs(x[0]) + 1e-3) continue;
    const int n = wall_sides(one.walls, 0, 0, x, 9, wall_side(one.walls, 0, 0, x), place);
    assert_true(n == 1);
  }
  wall_close(&one);
}

static MotionSpec turn[] = {
  {.kind = MOTION_ROTATION, .component = {1, 1}, .centre = {0.3, -0.1}, .axis = {0, 0, 1}, .rate = 0.7},
  {.kind = MOTION_VELOCITY, .component = {1, 1}, .value = {0.2, -0.5}}};

/* Flat sides keep their gaps from what goes along, and tell those of what does not. */
static void Along(void **state)
{
  const WallSpec box = {.shape = {.kind = SHAPE_BOX, .min = {-0.5, -0.5}, .max = {0.5, 0.5}},
                        .inside = PETSC_TRUE,
                        .n_motions = 2,
                        .motions = turn};
  const double x0[3] = {-0.4, -0.3, 0}, off[2] = {0.05, -0.2};
  WallPlace place[WALL_SIDES], later;
  WallAnchor anchor;
  double step[3], x1[3] = {0, 0, 0};
  OneWall one;
  (void)state;
  wall_open(&one, &kinematics_plane_strain, box);
  assert_int_equal(wall_sides(one.walls, 0, 0, x0, WITHIN, 0, place), 2);
  wall_motion(one.walls, 0, 0, 1.5, x0, step);
  const double c = cos(0.7 * 1.5), s = sin(0.7 * 1.5);
  for (int i = 0; i < 2; ++i) {
    const double n[2] = {c * place[i].normal[0] - s * place[i].normal[1],
                         s * place[i].normal[0] + c * place[i].normal[1]};
    wall_anchor(one.walls, 0, 0, x0, &place[i], &anchor);
    for (int d = 0; d < 2; ++d) x1[d] = x0[d] + step[d] + off[d];
    wall_from_anchor(one.walls, 0, 1.5, x1, &anchor, &later);
    ASSERT_NEAR(later.gap, place[i].gap + off[0] * n[0] + off[1] * n[1], 1e-14);
    for (int d = 0; d < 2; ++d) ASSERT_NEAR(later.normal[d], n[d], 1e-14);
  }
  wall_close(&one);
}

/* Round sides to second order: a way half as long is off by an eighth. */
static void Bent(void **state)
{
  const WallSpec cup = {
    .shape = {.kind = SHAPE_CYLINDER, .point = {0, 0, -0.5}, .normal = {0, 0, 1}, .length = 2, .radii = {0.5, 0.5}},
    .inside = PETSC_TRUE};
  const double x0[3] = {0.3, 0.2, 0};
  WallPlace place, later;
  WallAnchor anchor;
  double error[2];
  OneWall one;
  (void)state;
  wall_open(&one, &kinematics_3d, cup);
  assert_true(wall_near(one.walls, 0, 0, x0, 9, 0, &place));
  wall_anchor(one.walls, 0, 0, x0, &place, &anchor);
  for (int k = 0; k < 2; ++k) {
    const double h = k ? 0.02 : 0.04, x[3] = {x0[0] - 0.3 * h, x0[1] + h, x0[2] + h};
    wall_from_anchor(one.walls, 0, 0, x, &anchor, &later);
    error[k] = later.gap - (0.5 - hypot(x[0], x[1]));
  }
  assert_true(fabs(error[0]) < 1e-4 && error[0] != 0);
  ASSERT_NEAR(error[0] / error[1], 8, 0.8);
  wall_close(&one);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Rooms),     cmocka_unit_test(Notches), cmocka_unit_test(Space),
                                     cmocka_unit_test(Diagonals), cmocka_unit_test(Cup),     cmocka_unit_test(OneSide),
                                     cmocka_unit_test(Along),     cmocka_unit_test(Bent)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
