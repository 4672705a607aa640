/* Surfaces from files: the same as the shapes that they are made of. */
#include "case/terrain/relief.h"
#include "samples.h"
#include "stl_files.h"

static void compare_walls(const OneWall *a, const OneWall *b, double gap, double normal, double curvature)
{
  for (int q = 0; q < 3000; ++q) {
    double x[3];
    WallPlace p, r;
    random_in(3, -1.2, 1.2, x);
    assert_true(wall_near(a->walls, 0, 0, x, 9, 0, &p) && wall_near(b->walls, 0, 0, x, 9, 0, &r));
    ASSERT_NEAR(p.gap, r.gap, gap);
    for (int d = 0; d < 3; ++d) ASSERT_NEAR(p.normal[d], r.normal[d], normal);
    for (int k = 0; k < 9; ++k) ASSERT_NEAR(p.curvature[k], r.curvature[k], curvature * (1 + fabs(r.curvature[k])));
    assert_int_equal(wall_near(a->walls, 0, 0, x, 0.2, 0, &p), r.gap <= 0.2);
  }
}

/* Twelve triangles are a box: faces, edges and corners; from every kind of file. */
static void BoxOfTriangles(void **state)
{
  const Shape box = {.kind = SHAPE_BOX, .min = {-0.5, -0.25, -0.625}, .max = {0.375, 0.625, 0.125}};
  Soup soup;
  OneWall exact, read;
  (void)state;
  soup_open(&soup);
  soup_add_box(&soup, box.min, box.max);
  for (int inside = 0; inside < 2; ++inside) {
    wall_open(&exact, &kinematics_3d, (WallSpec){.shape = box, .inside = inside});
    for (int kind = 0; kind < 3; ++kind) {
      WallSpec spec = surface_of(kind == 0   ? write_binary(&soup, "box.stl")
                                 : kind == 1 ? write_ascii(&soup, "box.STL")
                                             : write_msh(&soup, 6, "box.msh"));
      spec.inside = inside;
      wall_open(&read, &kinematics_3d, spec);
      assert_int_equal(diag_errors(read.diag) + diag_warnings(read.diag), 0);
      compare_walls(&read, &exact, 1e-15, 1e-13, 1e-11);
      wall_close(&read);
    }
    wall_close(&exact);
  }
  soup_close(&soup);
}

/* x = scale X + offset. */
static void ScaleAndOffset(void **state)
{
  const double min[3] = {0, 0, 0}, max[3] = {800, 400, 200};
  Soup soup;
  OneWall exact, read;
  (void)state;
  soup_open(&soup);
  soup_add_box(&soup, min, max);
  WallSpec spec = surface_of(write_binary(&soup, "mm.stl"));
  spec.shape.scale = 1e-3;
  spec.shape.offset[0] = -0.5, spec.shape.offset[2] = 0.25;
  wall_open(&read, &kinematics_3d, spec);
  wall_open(&exact, &kinematics_3d,
            (WallSpec){.shape = {.kind = SHAPE_BOX, .min = {-0.5, 0, 0.25}, .max = {0.3, 0.4, 0.45}}});
  compare_walls(&read, &exact, 1e-15, 1e-12, 1e-9);
  wall_close(&exact);
  wall_close(&read);
  soup_close(&soup);
}

/* The chords of a sphere lie inside of it by at most R (1 - cos(edge / R)), and their normals turn
 * by the edge. */
static void Sphere(void **state)
{
  const double centre[3] = {0.1, -0.2, 0.05}, radius = 0.8;
  Soup soup;
  (void)state;
  soup_open(&soup);
  soup_add_sphere(&soup, centre, radius, 5);
  for (int inside = 0; inside < 2; ++inside) {
    WallSpec spec = surface_of(write_binary(&soup, "sphere.stl"));
    OneWall exact, read;
    spec.inside = inside;
    wall_open(&read, &kinematics_3d, spec);
    wall_open(
      &exact, &kinematics_3d,
      (WallSpec){.shape = {.kind = SHAPE_BALL, .centre = {0.1, -0.2, 0.05}, .radius = radius}, .inside = inside});
    const double edge = 0.06 * radius; /* the longest: 1.6 / 32 of a quarter turn more or less */
    for (int q = 0; q < 3000; ++q) {
      double x[3];
      WallPlace p, r;
      random_in(3, -1, 1, x);
      assert_true(wall_near(read.walls, 0, 0, x, 9, 0, &p) && wall_near(exact.walls, 0, 0, x, 9, 0, &r));
      const double sagitta = (inside ? -1 : 1) * (p.gap - r.gap);
      assert_true(sagitta > -1e-7 && sagitta < 0.5 * edge * edge / radius);
      if (fabs(r.gap) < 0.5 * radius)
        for (int d = 0; d < 3; ++d) ASSERT_NEAR(p.normal[d], r.normal[d], 1.5 * edge / radius);
      assert_int_equal(wall_near(read.walls, 0, 0, x, 0.05, 0, &r), p.gap <= 0.05);
    }
    wall_close(&exact);
    wall_close(&read);
  }
  soup_close(&soup);
}

/* Thin blades of a star: dihedral angles of a few degrees, where the normal of the nearest face
 * alone gives wrong signs. Signs from the half-spaces of each tetrahedron, which do not overlap. */
static void Needles(void **state)
{
  static const double v[4][3] = {{0, 0, 0}, {1, 0.02, 0.03}, {1, -0.02, 0.01}, {0.9, 0.01, -0.15}};
  static const int faces[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  Soup soup;
  OneWall read;
  int hits = 0;
  (void)state;
  soup_open(&soup);
  for (int f = 0; f < 4; ++f) soup_add(&soup, v[faces[f][0]], v[faces[f][1]], v[faces[f][2]]);
  wall_open(&read, &kinematics_3d, surface_of(write_ascii(&soup, "needle.stl")));
  for (int q = 0; q < 20000; ++q) {
    double x[3] = {1.4 * uniform() - 0.2, 0.2 * uniform() - 0.1, 0.4 * uniform() - 0.2};
    double inside = 1, reference = 0;
    WallPlace place;
    for (int f = 0; f < 4; ++f) { /* x on the same side as the fourth vertex */
      const double *a = v[faces[f][0]], *b = v[faces[f][1]], *c = v[faces[f][2]],
                   *o = v[6 - faces[f][0] - faces[f][1] - faces[f][2]];
      double volume[2];
      for (int k = 0; k < 2; ++k) {
        const double *p = k ? o : x;
        double m[3][3];
        for (int d = 0; d < 3; ++d) m[0][d] = b[d] - a[d], m[1][d] = c[d] - a[d], m[2][d] = p[d] - a[d];
        volume[k] = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                    m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                    m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
      }
      reference = volume[0] / volume[1];
      if (reference < 0) inside = 0;
    }
    hits += inside > 0;
    assert_true(wall_near(read.walls, 0, 0, x, 9, 0, &place));
    assert_int_equal(place.gap<0, inside> 0);
  }
  assert_true(hits > 50);
  wall_close(&read);
  soup_close(&soup);
}

/* A tube of eight sides without ends: thin, its rims round. The distance from samples, both sides
 * seen from where they are. */
static void OpenTube(void **state)
{
  Soup soup;
  Samples samples;
  OneWall read;
  (void)state;
  soup_open(&soup);
  samples_open(&samples);
  for (int k = 0; k < 8; ++k) {
    const double a = k * M_PI / 4, b = (k + 1) % 8 * M_PI / 4;
    const double v[4][3] = {{0.5 * cos(a), 0.5 * sin(a), -0.4},
                            {0.5 * cos(b), 0.5 * sin(b), -0.4},
                            {0.5 * cos(b), 0.5 * sin(b), 0.3},
                            {0.5 * cos(a), 0.5 * sin(a), 0.3}};
    const double u[3] = {v[1][0] - v[0][0], v[1][1] - v[0][1], 0}, up[3] = {0, 0, 0.7};
    soup_add_quad(&soup, v[0], v[1], v[2], v[3]);
    sample_patch(&samples, v[0], u, up, 0.01);
  }
  WallSpec spec = surface_of(write_ascii(&soup, "tube.stl"));
  spec.shape.open = PETSC_TRUE;
  wall_open(&read, &kinematics_3d, spec);
  assert_int_equal(diag_errors(read.diag) + diag_warnings(read.diag), 0);
  compare_distances(&read, &samples, 3, 400, 0.01, -1, 1);
  for (int side = -1; side < 2; ++side) compare_derivatives(&read, 3, side, 300, -1, 1);
  const double in[3] = {0.4, 0.1, 0}, out[3] = {0.6, 0.1, 0}, beyond[3] = {0.45, 0, 0.6}, over[3] = {0.6, 0, 0.31};
  assert_int_equal(wall_side(read.walls, 0, 0, in) * wall_side(read.walls, 0, 0, out), -1);
  assert_int_equal(wall_side(read.walls, 0, 0, beyond), 0);
  assert_int_equal(wall_side(read.walls, 0, 0, over), wall_side(read.walls, 0, 0, out));
  wall_close(&read);
  samples_close(&samples);
  soup_close(&soup);
}

/* One group of a mesh: the lid alone. */
static void Group(void **state)
{
  const double min[3] = {-0.5, -0.5, -0.5}, max[3] = {0.5, 0.5, 0.5}, x[3] = {0.1, 0.2, -0.6};
  Soup soup;
  OneWall read;
  WallPlace place;
  (void)state;
  soup_open(&soup);
  soup_add_box(&soup, min, max);
  WallSpec spec = surface_of(write_msh(&soup, 2, "group.msh"));
  spec.shape.open = PETSC_TRUE, spec.shape.group = (char *)"rest"; /* the face below */
  wall_open(&read, &kinematics_3d, spec);
  assert_true(wall_near(read.walls, 0, 0, x, 9, 0, &place));
  ASSERT_NEAR(place.gap, 0.1, 1e-15);
  wall_close(&read);
  soup_close(&soup);
}

/* Every so many of its triangles face the other way. */
static void turn_some(Soup *soup, int every)
{
  for (int i = 0; i < soup->n; i += every)
    for (int d = 0; d < 3; ++d) {
      const double kept = soup->corner[i][1][d];
      soup->corner[i][1][d] = soup->corner[i][2][d], soup->corner[i][2][d] = kept;
    }
}

/* Triangles that are turned, or all of them: the same wall, and a warning where that says something. */
static void Turned(void **state)
{
  const double min[3] = {-0.5, -0.5, -0.5}, max[3] = {0.5, 0.5, 0.5};
  const Shape box = {.kind = SHAPE_BOX, .min = {-0.5, -0.5, -0.5}, .max = {0.5, 0.5, 0.5}};
  OneWall exact, read;
  (void)state;
  wall_open(&exact, &kinematics_3d, (WallSpec){.shape = box});
  for (int kind = 0; kind < 6; ++kind) {
    const int gmsh = kind % 2;
    Soup soup;
    soup_open(&soup);
    soup_add_box(&soup, min, max);
    turn_some(&soup, 1 + kind / 2);
    wall_open(&read, &kinematics_3d,
              surface_of(gmsh ? write_msh(&soup, 6, "turned.msh") : write_binary(&soup, "turned.stl")));
    assert_int_equal(diag_errors(read.diag), 0);
    assert_int_equal(diag_warnings(read.diag), !gmsh);
    compare_walls(&read, &exact, 1e-15, 1e-13, 1e-11);
    wall_close(&read);
    soup_close(&soup);
  }
  wall_close(&exact);
}

/* Of a mesh with two pieces the way they face tells a cavity from a body. */
static void TurnedCavity(void **state)
{
  const double min[3] = {-0.5, -0.5, -0.5}, max[3] = {0.5, 0.5, 0.5}, low[3] = {-0.2, -0.2, -0.2},
               high[3] = {0.2, 0.2, 0.2};
  OneWall read;
  Soup soup;
  (void)state;
  soup_open(&soup);
  soup_add_box(&soup, min, max);
  soup_add_box(&soup, low, high);
  turn_some(&soup, 3);
  wall_open(&read, &kinematics_3d, surface_of(write_msh(&soup, 6, "cavity.msh")));
  assert_int_equal(diag_errors(read.diag), 0);
  assert_int_equal(diag_warnings(read.diag), 1);
  wall_close(&read);
  soup_close(&soup);
}

/* A sliver without area on an edge of the box, corners that differ by the last digit of single
 * precision, and a triangle that is a point: still a box. */
static void Untidy(void **state)
{
  const double min[3] = {-0.5, -0.5, -0.5}, max[3] = {0.5, 0.5, 0.5}, middle[3] = {0, -0.5, -0.5};
  const Shape box = {.kind = SHAPE_BOX, .min = {-0.5, -0.5, -0.5}, .max = {0.5, 0.5, 0.5}};
  OneWall exact, read;
  Soup soup;
  (void)state;
  soup_open(&soup);
  soup_add_box(&soup, min, max);
  /* the edge between corners 0 and 1 gets a third one, on one of its two sides alone */
  for (int i = 0; i < 12; ++i)
    if (i == 4) {
      double a[3][3];
      memcpy(a, soup.corner[i], sizeof a); /* 0 1 5 */
      memcpy(soup.corner[i][1], middle, sizeof middle);
      soup_add(&soup, middle, a[1], a[2]);
      soup_add(&soup, a[1], middle, a[0]);
    }
  soup_add(&soup, middle, middle, max);
  for (int i = 0; i < soup.n; ++i) soup.corner[i][i % 3][0] += 1e-8 * (i % 5);
  wall_open(&exact, &kinematics_3d, (WallSpec){.shape = box});
  wall_open(&read, &kinematics_3d, surface_of(write_ascii(&soup, "untidy.stl")));
  assert_int_equal(diag_errors(read.diag), 0);
  assert_int_equal(diag_warnings(read.diag), 1);
  for (int q = 0; q < 3000; ++q) {
    double x[3];
    WallPlace p, r;
    random_in(3, -1, 1, x);
    assert_true(wall_near(read.walls, 0, 0, x, 9, 0, &p) && wall_near(exact.walls, 0, 0, x, 9, 0, &r));
    ASSERT_NEAR(p.gap, r.gap, 1e-7);
  }
  wall_close(&exact);
  wall_close(&read);
  soup_close(&soup);
}

/* Terrain that is a ridge is the intersection of two half-spaces, far from its rim. */
static void Ridge(void **state)
{
  PetscReal height[41 * 41];
  Relief relief = {.n = {41, 41}, .low = {-2, -2}, .step = 0.1, .height = height, .bottom = -9};
  Shape sides[2] = {{.kind = SHAPE_HALF_SPACE, .point = {0.2, 0, 0.7}, .normal = {0.5, 0.1, 1}},
                    {.kind = SHAPE_HALF_SPACE, .point = {0.2, 0, 0.7}, .normal = {-0.25, 0.1, 1}}};
  const Shape roof = {.kind = SHAPE_INTERSECTION, .n_children = 2, .children = sides};
  OneWall exact, read;
  (void)state;
  for (int j = 0; j < 41; ++j)
    for (int i = 0; i < 41; ++i) {
      const double x = -2 + 0.1 * i - 0.2, y = -2 + 0.1 * j;
      height[41 * j + i] = 0.7 - fmax(0.5 * x, -0.25 * x) - 0.1 * y;
    }
  wall_open(&read, &kinematics_3d,
            (WallSpec){.shape = {.kind = SHAPE_TERRAIN, .file = (char *)"ridge.asc", .relief = &relief}});
  wall_open(&exact, &kinematics_3d, (WallSpec){.shape = roof});
  assert_int_equal(diag_errors(read.diag) + diag_warnings(read.diag), 0);
  for (int q = 0; q < 3000; ++q) {
    double x[3];
    WallPlace p, r;
    random_in(3, -0.8, 0.9, x);
    assert_true(wall_near(read.walls, 0, 0, x, 9, 0, &p) && wall_near(exact.walls, 0, 0, x, 9, 0, &r));
    if (fabs(r.gap) > 1 || (r.gap > 0 && fabs(x[0] - 0.2) < r.gap))
      continue; /* its rim; its edge, where combined shapes are not exact */
    ASSERT_NEAR(p.gap, r.gap, 1e-12);
    for (int d = 0; d < 3; ++d) ASSERT_NEAR(p.normal[d], r.normal[d], 1e-9);
  }
  wall_close(&exact);
  wall_close(&read);
  height[7] = NAN;
  wall_open(&read, &kinematics_3d,
            (WallSpec){.shape = {.kind = SHAPE_TERRAIN, .file = (char *)"ridge.asc", .relief = &relief}});
  assert_int_equal(diag_errors(read.diag), 1);
  wall_close(&read);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(BoxOfTriangles), cmocka_unit_test(ScaleAndOffset),
                                     cmocka_unit_test(Sphere),         cmocka_unit_test(Needles),
                                     cmocka_unit_test(OpenTube),       cmocka_unit_test(Group),
                                     cmocka_unit_test(Turned),         cmocka_unit_test(TurnedCavity),
                                     cmocka_unit_test(Untidy),         cmocka_unit_test(Ridge)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
