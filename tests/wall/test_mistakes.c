/* Walls that cannot be: each is told with what is wrong and where. */
#include <sys/stat.h>
#include "stl_files.h"

/* What is said of a wall, to be freed. */
static char *said_of(WallSpec spec, const Kinematics *kinematics, double grid)
{
  Case c = {
    .kinematics = kinematics, .grid = {.kind = GRID_BOX, .max = {grid, grid, grid}}, .n_walls = 1, .walls = &spec};
  Walls *walls;
  Diag *diag;
  char *text;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(WallsCreate(&c, diag, &walls), 0);
  const double x[3] = {0.1, 0.1, 0.1};
  WallPlace place;
  if (diag_errors(diag)) { /* whoever goes on asking gets an answer */
    (void)wall_near(walls, 0, 0, x, 1, 0, &place);
    (void)wall_side(walls, 0, 0, x);
  }
  assert_int_equal(WallsDestroy(&walls), 0);
  assert_int_equal(DiagFlush(diag, out), 0);
  assert_int_equal(DiagDestroy(&diag), 0);
  fclose(out);
  return text;
}

static void expect(WallSpec spec, const Kinematics *kinematics, const char *first, const char *second)
{
  char *text = said_of(spec, kinematics, 1);
  const char *words[2] = {first, second};
  for (int k = 0; k < 2; ++k)
    if (words[k] && !strstr(text, words[k])) fail_msg("'%s' is not in:\n%s", words[k], text);
  if (!first) assert_string_equal(text, "");
  free(text);
}

static void expect_surface(const char *path, const char *first, const char *second)
{
  expect(surface_of(path), &kinematics_3d, first, second);
}

static const char *write_text(const char *name, const char *text, size_t length)
{
  const char *path = soup_path(name);
  FILE *out = fopen(path, "wb");
  fwrite(text, 1, length, out);
  fclose(out);
  return path;
}

static void NoSurface(void **state)
{
  static const char facet[] = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
  char text[400];
  (void)state;
  expect_surface(soup_path("nowhere.stl"), "cannot read '", "No such file");
  expect_surface(folder, "is neither a .stl nor a .msh file", NULL);
  mkdir(soup_path("folder.stl"), 0700);
  expect_surface(soup_path("folder.stl"), "this is a directory", NULL);
  expect_surface(soup_path("wall.geo"), "is neither", "hint: make a mesh of it first: gmsh -2");
  expect_surface(write_text("empty.stl", "", 0), "is no STL file", NULL);
  expect_surface(write_text("nothing.stl", "solid\nendsolid\n", 15), "has no triangles", NULL);
  expect_surface(write_text("cut.stl", facet, strlen(facet)), "ends inside of a facet: it is truncated", NULL);
  snprintf(text, sizeof text, "%sendloop\nendfacet\n", facet);
  expect_surface(write_text("two.stl", text, strlen(text)), "two.stl:7: a facet has three vertices, not 2", NULL);
  snprintf(text, sizeof text, "%svertex 0 one 0\n", facet);
  expect_surface(write_text("word.stl", text, strlen(text)), "word.stl:6: a vertex needs three numbers, not 'one'",
                 NULL);
  snprintf(text, sizeof text, "%svertex 0 nan 0\n", facet);
  expect_surface(write_text("nan.stl", text, strlen(text)), "not 'nan'", NULL);
  snprintf(text, sizeof text, "%svertex 0 0", facet);
  expect_surface(write_text("end.stl", text, strlen(text)), "a vertex needs three numbers, not ''", NULL);
  memset(text, 7, sizeof text);
  expect_surface(write_text("noise.stl", text, sizeof text), "as a binary one with 117901063 triangles it had",
                 "bytes, not 400");
  expect_surface(write_text("noise.msh", text, sizeof text), "noise.msh", NULL);
}

static void BadTriangles(void **state)
{
  const double min[3] = {0, 0, 0}, max[3] = {1, 1, 1}, out[3] = {0.5, 2, -1}, p[3] = {0.25, 0.5, 0.5};
  Soup soup;
  (void)state;
  soup_open(&soup);
  soup_add_box(&soup, min, max);
  expect_surface(write_binary(&soup, "box.stl"), NULL, NULL);
  soup.corner[3][1][2] = NAN;
  expect_surface(write_binary(&soup, "nan.stl"), "triangle 4 has a corner that is no number", NULL);
  soup.n = 0;
  soup_add_box(&soup, min, max);
  soup.n = 11;
  expect_surface(write_binary(&soup, "open.stl"),
                 "is open: 3 edges have a triangle on one side alone, the first near (",
                 "hint: close it; or `open: true` makes it a thin wall");
  soup.n = 12;
  soup_add(&soup, min, soup.corner[4][1], out); /* a fin on an edge */
  expect_surface(write_binary(&soup, "fin.stl"), "at 1 edges more than two triangles meet, at the first 3",
                 "(0.5, 0, 0)");
  soup.n = 0;
  soup_add(&soup, p, p, max);
  expect_surface(write_binary(&soup, "point.stl"), "has no triangles with an area", NULL);
  soup.n = 0;
  soup_add(&soup, min, p, max);
  soup_add(&soup, min, max, p);
  expect_surface(write_binary(&soup, "sheet.stl"), "encloses no volume", NULL);
  soup.n = 0;
  soup_add_box(&soup, min, max);
  WallSpec spec = surface_of(write_msh(&soup, 6, "group.msh"));
  spec.shape.group = (char *)"rist";
  expect(spec, &kinematics_3d, "has no physical surface 'rist'", "did you mean 'rest'");
  spec = surface_of(write_binary(&soup, "group.stl"));
  spec.shape.group = (char *)"lid";
  expect(spec, &kinematics_3d, "an STL has none", NULL);
  soup_close(&soup);
}

enum { LONGEST = 8000 };

/* One to six bytes, words or pieces of a file are not what they were. Returns its length. */
static size_t damage(char *data, size_t n, PetscBool same_length)
{
  const size_t whole = n;
  for (int k = (int)(1 + 6 * uniform()); k > 0; --k) {
    const size_t at = (size_t)(uniform() * (double)n), piece = (size_t)(60 * uniform());
    const double what = uniform();
    if (what < 0.3) data[at] = (char)(256 * uniform());
    else if (what < 0.7) data[at] = "0123456789.-e+ \nvf"[(int)(18 * uniform())];
    else if (at + piece < n) memmove(data + at, data + at + piece, n - at - piece), n -= piece;
  }
  return same_length ? whole : n;
}

/* Whatever is in a file: an error, or a wall that answers with numbers. */
static void DamagedFiles(void **state)
{
  const double min[3] = {0, 0, 0}, max[3] = {1, 1, 1};
  char data[LONGEST];
  int walls = 0;
  Soup soup;
  (void)state;
  soup_open(&soup);
  soup_add_box(&soup, min, max);
  for (int k = 0; k < 900; ++k) {
    const char *path = k % 3 == 0   ? write_binary(&soup, "damaged.stl")
                       : k % 3 == 1 ? write_ascii(&soup, "damaged.stl")
                                    : write_msh(&soup, 6, "damaged.msh");
    FILE *file = fopen(path, "rb");
    const size_t n = damage(data, fread(data, 1, LONGEST, file), k % 3 == 0);
    fclose(file);
    WallSpec spec = surface_of(write_text(strrchr(path, '/') + 1, data, n));
    OneWall one;
    spec.shape.open = uniform() < 0.5;
    wall_open(&one, &kinematics_3d, spec);
    walls += !diag_errors(one.diag);
    for (int q = 0; q < 20; ++q) {
      double x[3];
      WallPlace place;
      random_in(3, -1, 2, x);
      if (!wall_near(one.walls, 0, 0, x, 1e300, 0, &place)) continue;
      assert_true(isfinite(place.gap) && isfinite(place.normal[0]) && isfinite(place.curvature[0]));
    }
    wall_close(&one);
  }
  assert_true(walls > 50 && walls < 850);
  soup_close(&soup);
}

/* A band with half a turn. */
static void Moebius(void **state)
{
  enum { N = 24 };
  Soup soup;
  (void)state;
  soup_open(&soup);
  for (int k = 0; k < N; ++k) {
    double v[4][3];
    for (int j = 0; j < 4; ++j) {
      const int at = k + (j == 1 || j == 2);
      const double a = 2 * M_PI * at / N, half = (j < 2 ? -0.2 : 0.2), r = 0.5 + half * cos(a / 2);
      v[j][0] = 0.5 + r * cos(a), v[j][1] = 0.5 + r * sin(a), v[j][2] = 0.5 + half * sin(a / 2);
    }
    soup_add_quad(&soup, v[0], v[1], v[2], v[3]);
  }
  WallSpec spec = surface_of(write_binary(&soup, "band.stl"));
  spec.shape.open = PETSC_TRUE;
  expect(spec, &kinematics_3d, "has one side only", NULL);
  soup_close(&soup);
}

static void Sizes(void **state)
{
  const double min[3] = {0, 0, 0}, max[3] = {400, 200, 100};
  Soup soup;
  (void)state;
  soup_open(&soup);
  soup_add_box(&soup, min, max);
  WallSpec spec = surface_of(write_binary(&soup, "mm.stl"));
  expect(spec, &kinematics_3d, "warning: the surface is 400 m large, and the grid 1 m",
         "hint: if the file is in mm: scale: 0.001");
  spec.shape.scale = 0.001;
  expect(spec, &kinematics_3d, NULL, NULL);
  soup_close(&soup);
}

static void Lines(void **state)
{
  double bow[] = {0, 0, 1, 1, 1, 0, 0, 1}, left[] = {-0.1, 0, 1, 0, 1, 1}, point[] = {0, 0.4, 0, 0.4};
  const Shape polygon = {.kind = SHAPE_POLYGON, .n_vertices = 4, .vertices = bow};
  Shape both[2] = {{.kind = SHAPE_BALL, .centre = {0.5, 0.5}, .radius = 0.2}, polygon};
  (void)state;
  expect((WallSpec){.shape = polygon}, &kinematics_plane_strain,
         "the polygon crosses itself: its edges from corner 1 and from corner 3", NULL);
  expect((WallSpec){.shape = {.kind = SHAPE_UNION, .n_children = 2, .children = both}}, &kinematics_plane_strain,
         "the polygon crosses itself", NULL);
  expect((WallSpec){.shape = {.kind = SHAPE_LINE, .n_vertices = 4, .vertices = bow}}, &kinematics_plane_strain,
         "the line crosses itself", NULL);
  expect((WallSpec){.shape = {.kind = SHAPE_LINE, .n_vertices = 2, .vertices = point}}, &kinematics_plane_strain,
         "all corners of the line are one place", NULL);
  expect((WallSpec){.shape = {.kind = SHAPE_REVOLVED, .n_vertices = 3, .vertices = left, .normal = {0, 0, 1}}},
         &kinematics_3d, "a corner lies beyond the axis", NULL);
}

static void BeyondTheAxis(void **state)
{
  double left[] = {-0.1, 0, 1, 0, 1, 1};
  const struct {
    Shape shape;
    const char *said;
  } walls[] = {
    {{.kind = SHAPE_BOX, .min = {-0.1, 0}, .max = {1, 1}}, "the box begins beyond the axis"},
    {{.kind = SHAPE_BALL, .centre = {0.1, 0}, .radius = 0.2}, "part of the circle lies beyond the axis"},
    {{.kind = SHAPE_BALL, .centre = {0, 0.5}, .radius = 0.2}, NULL},
    {{.kind = SHAPE_BALL, .centre = {0.5, 0.5}, .radius = 0.5}, NULL},
    {{.kind = SHAPE_ARC, .centre = {0, 0.5}, .radius = 0.2, .angle = {-90, 90}}, NULL},
    {{.kind = SHAPE_ARC, .centre = {0.1, 0.5}, .radius = 0.2, .angle = {0, 170}}, "the arc ends beyond the axis"},
    {{.kind = SHAPE_ARC, .centre = {0.1, 0.5}, .radius = 0.2, .angle = {90, 270}}, "the arc goes beyond the axis"},
    {{.kind = SHAPE_LINE, .n_vertices = 3, .vertices = left}, "a corner lies beyond the axis"},
    {{.kind = SHAPE_HALF_SPACE, .point = {0, 1}, .normal = {1, 0}}, "its surface lies beyond the axis"},
    {{.kind = SHAPE_HALF_SPACE, .point = {0, 1}, .normal = {1, 1}}, NULL},
  };
  (void)state;
  for (size_t k = 0; k < sizeof walls / sizeof *walls; ++k) {
    expect((WallSpec){.shape = walls[k].shape}, &kinematics_axisymmetric, walls[k].said,
           walls[k].said ? "hint: give the half on the right of the axis" : NULL);
    if (walls[k].shape.kind != SHAPE_HALF_SPACE)
      expect((WallSpec){.shape = walls[k].shape}, &kinematics_plane_strain, NULL, NULL);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(NoSurface),    cmocka_unit_test(BadTriangles),
                                     cmocka_unit_test(Moebius),      cmocka_unit_test(DamagedFiles),
                                     cmocka_unit_test(Sizes),        cmocka_unit_test(Lines),
                                     cmocka_unit_test(BeyondTheAxis)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
