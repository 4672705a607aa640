/* Walls in pictures: grey where they are, over the body, and an outline. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "picture/walls/walls.h"

enum { W = 200, H = 100 };

typedef struct {
  Case c;
  WallSpec walls[2];
  PlotScene scene;
  PlotPage page;
  unsigned char rgba[4 * W * H];
} Picture;

/* A page of 2 m x 1 m around the origin. */
static void open_picture(Picture *p, const Kinematics *kinematics, PetscInt n)
{
  Diag *diag;
  p->c = (Case){.kinematics = kinematics, .n_walls = n, .walls = p->walls};
  p->c.grid = (GridSpec){.kind = GRID_BOX, .min = {-3, -3}, .max = {3, 3}};
  p->page = (PlotPage){.w = W, .h = H, .min = {-1, -0.5}, .max = {1, 0.5}};
  p->scene = (PlotScene){.dim = 2, .n_frames = 1, .walled = &p->c, .mirrored = kinematics->hoop};
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(WallsCreate(&p->c, diag, &p->scene.walls), 0);
  assert_int_equal(diag_errors(diag), 0);
  assert_int_equal(DiagDestroy(&diag), 0);
}

static void close_picture(Picture *p) { assert_int_equal(WallsDestroy(&p->scene.walls), 0); }

static const unsigned char *pixel_at(const Picture *p, PetscReal x, PetscReal y)
{
  return p->rgba + 4 * ((int)((y + 0.5) * H) * W + (int)((x + 1) * W / 2));
}

/* Where an outline of two pixels runs, one whose middle is half a pixel beside it is covered but for
 * less than 1 %. */
static void is_grey(const unsigned char *pixel, int grey, int alpha)
{
  for (int c = 0; c < 3; ++c) assert_in_range(pixel[c], grey - 2, grey + 2);
  assert_in_range(pixel[3], alpha - 2, alpha);
}

/* A circle that moves to the right, over an image whose lower half is full of red. */
static void CircleThatMoves(void **state)
{
  static Picture p;
  MotionSpec motion = {.kind = MOTION_VELOCITY, .component = {1, 0}, .value = {0.5, 0}};
  (void)state;
  p.walls[0] = (WallSpec){
    .shape = {.kind = SHAPE_BALL, .centre = {-0.5, 0.05}, .radius = 0.3}, .n_motions = 1, .motions = &motion};
  open_picture(&p, &kinematics_plane_strain, 1);
  for (int k = 0; k < 2; ++k) {
    const PlotFrame frame = {.time = k};
    const PetscReal centre = -0.5 + 0.5 * k;
    memset(p.rgba, 0, sizeof p.rgba);
    for (int i = 0; i < W * H / 2; ++i) p.rgba[4 * i] = 200, p.rgba[4 * i + 3] = 255;
    plot_walls_draw(&p.scene, &frame, &p.page, p.rgba);
    is_grey(pixel_at(&p, centre, 0.1), 214, 255);
    is_grey(pixel_at(&p, centre + 0.25, 0.1), 214, 255);
    is_grey(pixel_at(&p, centre + 0.301, 0.055), 50, 255); /* the outline */
    assert_int_equal(pixel_at(&p, centre + 0.35, 0.1)[3], 0);
    is_grey(pixel_at(&p, centre, -0.1), 214, 255);  /* over the body, */
    is_grey(pixel_at(&p, centre, -0.249), 50, 255); /* as the outline is */
    assert_int_equal(pixel_at(&p, centre, -0.3)[0], 200);
  }
  /* the page reaches to its ends, those of the frames' times */
  p.scene.box_min[0] = -0.1, p.scene.box_max[0] = 0.1;
  p.scene.frames[0].time = 1;
  plot_walls_extend(&p.scene);
  assert_true(fabs(p.scene.box_min[0] + 0.3) < 1e-14 && fabs(p.scene.box_max[0] - 0.3) < 1e-14);
  assert_true(fabs(p.scene.box_max[1] - 0.35) < 1e-14);
  close_picture(&p);
}

/* A container is grey all around, on both sides of the axis; a gate only while it stands. */
static void ContainerOnBothSides(void **state)
{
  static Picture p;
  double gate[] = {0, -0.2, 0.6, -0.2};
  (void)state;
  p.walls[0] = (WallSpec){.shape = {.kind = SHAPE_BOX, .min = {0, -0.4}, .max = {0.6, 5}}, .inside = PETSC_TRUE};
  p.walls[1] =
    (WallSpec){.shape = {.kind = SHAPE_LINE, .n_vertices = 2, .vertices = gate}, .has_until = PETSC_TRUE, .until = 1};
  open_picture(&p, &kinematics_axisymmetric, 2);
  for (int k = 0; k < 2; ++k) {
    const PlotFrame frame = {.time = 2 * k};
    memset(p.rgba, 0, sizeof p.rgba);
    plot_walls_draw(&p.scene, &frame, &p.page, p.rgba);
    for (int side = -1; side < 2; side += 2) {
      is_grey(pixel_at(&p, side * 0.8, 0.1), 214, 255);
      is_grey(pixel_at(&p, side * 0.2, -0.45), 214, 255);
      assert_int_equal(pixel_at(&p, side * 0.2, 0.1)[3], 0);
      assert_int_equal(pixel_at(&p, side * 0.005, 0.1)[3], 0); /* nothing on the axis */
      if (k == 0) is_grey(pixel_at(&p, side * 0.2, -0.201), 50, 255);
      else assert_int_equal(pixel_at(&p, side * 0.2, -0.201)[3], 0);
    }
  }
  /* as far as the grid goes */
  plot_walls_extend(&p.scene);
  assert_true(p.scene.box_max[1] == 3 && fabs(p.scene.box_max[0] - 0.6) < 1e-14 &&
              p.scene.box_min[0] == -p.scene.box_max[0]);
  close_picture(&p);
}

/* Lines and faces of a wall in space, in a box of 4 m about the origin; to be closed by close_wires. */
static void wires_of(Picture *p, const Shape *shape, PetscBool inside)
{
  p->walls[0] = (WallSpec){.shape = *shape, .inside = inside};
  open_picture(p, &kinematics_3d, 1);
  p->scene.dim = 3, p->scene.up = 2;
  for (int d = 0; d < 3; ++d) p->scene.box_min[d] = -2, p->scene.box_max[d] = 2;
  p->scene.frames[0] = (PlotFrame){0};
  assert_int_equal(PlotWallsLines(&p->scene), 0);
}

static void close_wires(Picture *p)
{
  assert_int_equal(PlotFramesFree(&p->scene), 0);
  close_picture(p);
}

static PetscReal length_of_all(const PlotFrame *f)
{
  PetscReal sum = 0;
  for (PetscInt l = 0; l < f->n_lines; ++l) {
    const PetscReal *e = f->line + 6 * l;
    sum += sqrt(pow(e[3] - e[0], 2) + pow(e[4] - e[1], 2) + pow(e[5] - e[2], 2));
  }
  return sum;
}

/* A box has twelve edges; of a sphere the outline is seen, at its radius from the middle; a plane ends where the
 * picture does. */
static void LinesInSpace(void **state)
{
  static Picture p;
  const Shape box = {.kind = SHAPE_BOX, .min = {-1, -0.5, 0}, .max = {1, 0.5, 0.5}},
              deep = {.kind = SHAPE_BOX, .min = {-1, -0.5, -90}, .max = {1, 0.5, 0.5}},
              ball = {.kind = SHAPE_BALL, .centre = {0.3, 0, 0}, .radius = 0.5},
              plane = {.kind = SHAPE_HALF_SPACE, .normal = {0, 0, 1}};
  PetscReal middle[3];
  (void)state;
  wires_of(&p, &box, PETSC_FALSE);
  assert_true(fabs(length_of_all(&p.scene.frames[0]) - 4 * (2 + 1 + 0.5)) < 1e-9);
  close_wires(&p);
  wires_of(&p, &deep, PETSC_FALSE); /* four sides end at the ground, a hundredth below the box */
  assert_true(fabs(length_of_all(&p.scene.frames[0]) - 2 * (2 + 1) - 4 * (2 + 0.02 * 4 + 0.5)) < 1e-9);
  close_wires(&p);
  wires_of(&p, &plane, PETSC_FALSE); /* a hundredth of the picture beyond its box, on each side */
  assert_true(fabs(length_of_all(&p.scene.frames[0]) - 4 * 4 * 1.04) < 1e-9);
  close_wires(&p);
  wires_of(&p, &ball, PETSC_FALSE);
  plot_project(&p.scene, ball.centre, middle);
  assert_true(p.scene.frames[0].n_lines > 10);
  for (PetscInt k = 0; k < 2 * p.scene.frames[0].n_lines; ++k) {
    const PetscReal *at = p.scene.frames[0].line + 3 * k;
    assert_true(fabs(hypot(at[0] - middle[0], at[1] - middle[1]) - 0.5) < 0.03);
  }
  close_wires(&p);
}

/* Area of the faces on the page. */
static PetscReal area_of_all(const PlotFrame *f)
{
  PetscReal sum = 0;
  for (PetscInt k = 0; k < f->n_faces; ++k) {
    const PetscReal *a = f->face + 9 * k, *b = a + 3, *c = a + 6;
    sum += 0.5 * fabs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
  }
  return sum;
}

/* Of an area with normal n, as the eye sees it; nothing if that turns away. */
static PetscReal seen_area(const Picture *p, PetscReal x, PetscReal y, PetscReal z, PetscReal area)
{
  const PetscReal n[3] = {x, y, z};
  PetscReal towards[3];
  plot_project(&p->scene, n, towards);
  return PetscMax(towards[2], 0) * area;
}

/* Of a box from ground to 0.5 m, 2 m x 1 m, sign -1: of a container, from within. */
static PetscReal seen_box(const Picture *p, PetscReal sign, PetscReal height)
{
  return seen_area(p, sign, 0, 0, height) + seen_area(p, -sign, 0, 0, height) + seen_area(p, 0, sign, 0, 2 * height) +
         seen_area(p, 0, -sign, 0, 2 * height) + seen_area(p, 0, 0, sign, 2);
}

/* What turns to the eye, as far as the picture goes: of a container what is behind its matter, of a thin wall none. */
static void FacesInSpace(void **state)
{
  static Picture p;
  const Shape deep = {.kind = SHAPE_BOX, .min = {-1, -0.5, -90}, .max = {1, 0.5, 0.5}},
              up = {.kind = SHAPE_HALF_SPACE, .normal = {0, 0, 1}},
              down = {.kind = SHAPE_HALF_SPACE, .normal = {0, 0, -1}},
              wide = {.kind = SHAPE_BOX, .min = {-90, -90, -90}, .max = {90, 90, 0.5}};
  (void)state;
  wires_of(&p, &deep, PETSC_FALSE); /* to the ground, a hundredth below the box */
  assert_true(fabs(area_of_all(&p.scene.frames[0]) - seen_box(&p, 1, 2.08 + 0.5)) < 1e-9);
  close_wires(&p);
  wires_of(&p, &deep, PETSC_TRUE); /* its top is within, and turns away: the ground is farther down than is seen */
  assert_true(fabs(area_of_all(&p.scene.frames[0]) - seen_box(&p, -1, 2.08 + 0.5)) < 1e-9);
  close_wires(&p);
  wires_of(&p, &up, PETSC_FALSE);
  assert_true(fabs(area_of_all(&p.scene.frames[0]) - seen_area(&p, 0, 0, 1, 4.16 * 4.16)) < 1e-9);
  close_wires(&p);
  wires_of(&p, &down, PETSC_FALSE);
  assert_int_equal(p.scene.frames[0].n_faces, 0);
  close_wires(&p);
  wires_of(&p, &wide, PETSC_FALSE); /* it ends far away: no farther than the view */
  assert_true(fabs(area_of_all(&p.scene.frames[0]) - seen_area(&p, 0, 0, 1, 4.16 * 4.16)) < 1e-9);
  close_wires(&p);
}

/* A face 1 m before or behind two balls side by side, from x = left on. */
static void draw_face(PetscReal left, PetscReal depth, unsigned char *rgba)
{
  const PetscReal x[] = {-0.5, 0, 0, 0.5, 0, 0}, radius[] = {0.3, 0.3}, value[] = {0, 0};
  const PetscReal face[] = {left, -1, depth, 1, -1, depth, 1, 1, depth, left, -1, depth, 1, 1, depth, left, 1, depth};
  const PetscInt face_of[] = {0, 0};
  const RasterScene scene = {.n = 2,
                             .x = x,
                             .radius = radius,
                             .value = value,
                             .n_faces = 2,
                             .face = face,
                             .face_of = face_of,
                             .min = {-1, -1},
                             .max = {1, 1},
                             .width = 8,
                             .height = 8};
  assert_int_equal(RasterDraw(&scene, rgba), 0);
}

/* A face hides what is behind it, but for one that hides most of all there is. */
static void FacesHide(void **state)
{
  enum { LEFT = 4 * (4 * 8 + 2), RIGHT = 4 * (4 * 8 + 5), CORNER = 4 * 7 };
  unsigned char rgba[4 * 64];
  (void)state;
  draw_face(-1, -1, rgba);
  assert_true(rgba[LEFT] == 68 && rgba[RIGHT] == 68 && rgba[CORNER] == 235);
  draw_face(0.1, 1, rgba);
  assert_true(rgba[LEFT] == 68 && rgba[RIGHT] == 235 && rgba[CORNER] == 235);
  draw_face(-1, 1, rgba);
  assert_true(rgba[LEFT] == 68 && rgba[RIGHT] == 68 && rgba[CORNER] == 235);
}

/* Empty pixels between a square of points (its side 1 m, its lower one at 0) and a wall whose surface is so far below
 * it, in columns well within. */
static PetscInt empty_above(PetscReal below, PetscBool told)
{
  enum { N = 16, PIXELS = 240 };
  static PetscReal x[3 * N * N], radius[N * N], value[N * N];
  static unsigned char rgba[4 * PIXELS * PIXELS], solid[PIXELS * PIXELS];
  const PetscReal size = 1.5, low = -0.25;
  PetscInt empty = 0;
  for (PetscInt k = 0; k < N * N; ++k) {
    x[3 * k] = (k % N + 0.5) / N;
    x[3 * k + 1] = (k / N + 0.5) / N;
    radius[k] = 0.75 / N;
  }
  for (int i = 0; i < PIXELS * PIXELS; ++i) solid[i] = low + (i / PIXELS + 0.5) * size / PIXELS < -below;
  const RasterScene scene = {.n = N * N,
                             .x = x,
                             .radius = radius,
                             .value = value,
                             .gap = 1. / N,
                             .solid = told ? solid : NULL,
                             .min = {low, low},
                             .max = {low + size, low + size},
                             .width = PIXELS,
                             .height = PIXELS};
  assert_int_equal(RasterDraw(&scene, rgba), 0);
  for (int column = 60; column < 180; ++column)
    for (int row = 0; row < PIXELS / 2; ++row)
      empty += !solid[row * PIXELS + column] && rgba[4 * (row * PIXELS + column) + 3] < 128;
  return empty;
}

/* Points that stand a little off a wall leave no white between; what is apart by the distance from point to point is
 * drawn apart. */
static void BodiesReachWalls(void **state)
{
  (void)state;
  assert_true(empty_above(0.2 / 16, PETSC_FALSE) >= 120);
  assert_int_equal(empty_above(0.2 / 16, PETSC_TRUE), 0);
  assert_int_equal(empty_above(0, PETSC_TRUE), 0);
  assert_int_equal(empty_above(1. / 16, PETSC_TRUE), empty_above(1. / 16, PETSC_FALSE));
}

/* Lines where nodes do not move across them, no farther than the grid goes. */
static void FloorOfAGrid(void **state)
{
  static Picture p;
  static char bottom[] = "bottom", left[] = "left";
  MotionSpec boundary[] = {
    {.on = {.boundary = bottom}, .component = {1, 1}},
    {.on = {.boundary = left}, .component = {0, 1}}, /* moves across it */
    {.on = {.has = {1, 1}, .min = {0.5, -1}, .max = {0.5, 0}}, .component = {1}},
    {.on = {.has = {0, 1}, .min = {0, 0.2}, .max = {0, 0.2}}, .kind = MOTION_VELOCITY, .component = {0, 1}}};
  char *text = NULL;
  size_t size;
  (void)state;
  open_picture(&p, &kinematics_plane_strain, 0);
  p.c.grid = (GridSpec){.kind = GRID_BOX, .min = {-0.8, -0.3}, .max = {3, 3}};
  p.c.n_boundary = 4, p.c.boundary = boundary;
  FILE *out = open_memstream(&text, &size);
  plot_floor_draw(out, &p.scene, &p.page);
  p.scene.bare = PETSC_TRUE;
  plot_floor_draw(out, &p.scene, &p.page);
  fclose(out);
  assert_string_equal(text,
                      "set arrow from -0.8,-0.3 to 1,-0.3 nohead front lw 1.5 lc rgb '#505050'\n"
                      "set arrow from 0.5,-0.5 to 0.5,0 nohead front lw 1.5 lc rgb '#505050'\n");
  free(text);
  close_picture(&p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(CircleThatMoves), cmocka_unit_test(ContainerOnBothSides),
                                     cmocka_unit_test(LinesInSpace),    cmocka_unit_test(FacesInSpace),
                                     cmocka_unit_test(FacesHide),       cmocka_unit_test(BodiesReachWalls),
                                     cmocka_unit_test(FloorOfAGrid)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
