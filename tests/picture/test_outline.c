/* Outlines: a body whose shape the case tells is drawn with it, smooth and as large as it is, at the start and after
 * it has been turned, stretched and bent; corners stay corners. */
#include "../output/test_output.h"
#include <math.h>
#include "picture/raster/raster.h"
#include "picture/raster/spacing.h"
#include "picture/scene/scene.h"

enum { W = 400, MOST = 5000 };
#define H 0.1 /* cells */

typedef struct {
  Case c;
  BodySpec body;
  PlotContours *contours;
  PlotFrame f;
  PetscReal zero[MOST];
} Drawing;

/* A bend that stands for another motion: pressed down to a quarter of the height. */
#define PRESSED (-9)

/* Where material goes: turned by 40 degrees, stretched, and bent by so much. */
static void move(PetscReal bend, const PetscReal *X, PetscReal *x)
{
  if (bend == PRESSED) {
    x[0] = X[0], x[1] = X[1] / 4, x[2] = 0;
    return;
  }
  const PetscReal c = cos(40 * PETSC_PI / 180), s = sin(40 * PETSC_PI / 180), a = 1.25 * X[0],
                  b = 0.8 * X[1] + bend * X[0] * X[0];
  x[0] = c * a - s * b, x[1] = s * a + c * b, x[2] = 0;
}

static void move_back(PetscReal bend, const PetscReal *x, PetscReal *X)
{
  const PetscReal c = cos(40 * PETSC_PI / 180), s = sin(40 * PETSC_PI / 180);
  X[0] = (c * x[0] + s * x[1]) / 1.25;
  X[1] = (-s * x[0] + c * x[1] - bend * X[0] * X[0]) / 0.8;
}

/* Edges of a ring, both of whose circles are polygons of n corners. */
enum { CORNERS = 40 };
static const PetscReal ring_middle[2] = {0.013, -0.021}, ring_radius[2] = {0.62, 0.27};

static void ring_corner(int circle, int k, PetscReal *x)
{
  const PetscReal angle = 2 * PETSC_PI * k / CORNERS;
  x[0] = ring_middle[0] + ring_radius[circle] * cos(angle), x[1] = ring_middle[1] + ring_radius[circle] * sin(angle);
}

static PlotContours *create_ring(void)
{
  PlotContours *ring;
  PetscReal(*edge)[4];
  assert_int_equal(PetscNew(&ring), 0);
  assert_int_equal(PetscCalloc1(1, &ring->body), 0);
  assert_int_equal(PetscMalloc1(2 * CORNERS, &edge), 0);
  ring->n = 1;
  for (int k = 0; k < 2 * CORNERS; ++k) {
    ring_corner(k / CORNERS, k, edge[k]);
    ring_corner(k / CORNERS, k + 1, edge[k] + 2);
  }
  assert_int_equal(ContourCreate(2 * CORNERS, edge, ring->body), 0);
  return ring;
}

/* Points as cut cells have them: in the middle of what of a quarter of a cell lies in the shape. */
static void seed(Drawing *d)
{
  enum { FINE = 16 };
  const Shape *shape = &d->body.shape;
  for (int j = -20; j < 20; ++j)
    for (int i = -20; i < 20; ++i) {
      PetscReal sum[2] = {0, 0};
      int n = 0;
      for (int k = 0; k < FINE * FINE; ++k) {
        const PetscReal x[3] = {H / 2 * (i + (k % FINE + 0.5) / FINE), H / 2 * (j + (k / FINE + 0.5) / FINE), 0};
        if (!shape_contains(shape, 2, x, 0)) continue;
        sum[0] += x[0], sum[1] += x[1], ++n;
      }
      if (n < FINE * FINE / 10) continue;
      PetscReal *first = d->f.first + 3 * d->f.n++;
      first[0] = sum[0] / n, first[1] = sum[1] / n, first[2] = 0;
    }
  d->f.n_first = d->f.n;
}

static Drawing *create(Shape shape)
{
  Drawing *d;
  assert_int_equal(PetscNew(&d), 0);
  d->body = (BodySpec){.name = "body", .has_shape = PETSC_TRUE, .shape = shape};
  d->c = (Case){.kinematics = &kinematics_plane_strain, .method = "mpm", .n_bodies = 1, .bodies = &d->body};
  assert_int_equal(PetscMalloc3(3 * MOST, &d->f.x, MOST, &d->f.value, MOST, &d->f.radius), 0);
  assert_int_equal(PetscMalloc2(3 * MOST, &d->f.first, MOST, &d->f.first_radius), 0);
  seed(d);
  return d;
}

static void destroy(Drawing *d)
{
  assert_int_equal(PetscFree3(d->f.x, d->f.value, d->f.radius), 0);
  assert_int_equal(PetscFree2(d->f.first, d->f.first_radius), 0);
  assert_int_equal(PetscFree3(d->f.shape, d->f.knows, d->f.back), 0);
  assert_int_equal(PetscFree(d->f.there), 0);
  assert_int_equal(PetscFree(d), 0);
}

/* The image of the moved body; how much of a square of 2 m a side it covers, m2. */
static PetscReal draw(Drawing *d, PetscReal bend, PetscBool moved, PetscBool known, unsigned char *rgba)
{
  PlotFrame *f = &d->f;
  PetscReal gap, area = 0;
  for (PetscInt i = 0; i < f->n; ++i) {
    if (moved) move(bend, f->first + 3 * i, f->x + 3 * i);
    else memcpy(f->x + 3 * i, f->first + 3 * i, 3 * sizeof *f->x);
  }
  assert_int_equal(PlotSpacing(2, f->n, f->x, f->radius), 0);
  assert_int_equal(PlotSpacing(2, f->n, f->first, f->first_radius), 0);
  assert_int_equal(PlotQuantile(f->n, f->radius, 0.5, &gap), 0);
  if (known && !f->shape) assert_int_equal(PlotShapes(&d->c, d->contours, f), 0);
  const PlotOutline outline = {.c = &d->c, .contours = d->contours, .frame = f};
  const RasterScene scene = {.n = f->n,
                             .x = f->x,
                             .radius = f->radius,
                             .value = d->zero,
                             .gap = gap,
                             .knows = known ? f->knows : NULL,
                             .holds = plot_shape_holds,
                             .of = &outline,
                             .min = {-1, -1},
                             .max = {1, 1},
                             .width = W,
                             .height = W};
  assert_int_equal(RasterDraw(&scene, rgba), 0);
  for (int k = 0; k < W * W; ++k) area += rgba[4 * k + 3] / 255. * 4 / (W * W);
  return area;
}

/* Along a ray from the origin in direction (ex, ey), from a place in the body on: how far that is drawn, m. */
static PetscReal reach(const unsigned char *rgba, PetscReal from, PetscReal ex, PetscReal ey)
{
  PetscReal sum = from;
  const PetscReal step = 0.1 * 2. / W;
  for (PetscReal r = from; r < 1; r += step) {
    const int i = (int)((r * ex + 1) / 2 * W), j = (int)((r * ey + 1) / 2 * W);
    if (i >= 0 && j >= 0 && i < W && j < W) sum += rgba[4 * (j * W + i) + 3] / 255. * step;
  }
  return sum;
}

static const Shape disk = {.kind = SHAPE_BALL, .centre = {0.013, -0.021, 0}, .radius = 0.62};

/* How far a place is out of the disk, or of a polygon with its corners on it, m. */
static PetscReal outside(const PetscReal *X, PetscInt corners)
{
  const PetscReal r[2] = {X[0] - disk.centre[0], X[1] - disk.centre[1]},
                  sector = 2 * PETSC_PI / (corners ? corners : 1);
  const PetscReal angle = atan2(r[1], r[0]), off = angle - (floor(angle / sector) + 0.5) * sector;
  return corners ? hypot(r[0], r[1]) * cos(off) - disk.radius * cos(sector / 2) : hypot(r[0], r[1]) - disk.radius;
}

/* The outline at 360 angles, moved back: the largest distance from that of the body. */
static PetscReal uneven(PetscInt corners, PetscReal bend, PetscBool moved, const unsigned char *rgba)
{
  PetscReal worst = 0;
  for (int k = 0; k < 360; ++k) {
    const PetscReal e[2] = {cos(k * PETSC_PI / 180), sin(k * PETSC_PI / 180)};
    const PetscReal r = reach(rgba, corners ? 0.45 : 0, e[0], e[1]), x[2] = {r * e[0], r * e[1]};
    PetscReal X[2] = {x[0], x[1]};
    if (moved) move_back(bend, x, X);
    worst = PetscMax(worst, PetscAbsReal(outside(X, corners)));
  }
  return worst;
}

static void test_disk(void **state)
{
  static unsigned char rgba[4 * W * W];
  const PetscReal area = PETSC_PI * disk.radius * disk.radius, pixel = 2. / W;
  (void)state;
  for (int k = 0; k < 3; ++k) {
    const PetscBool moved = (PetscBool)(k > 0);
    const PetscReal bend = k == 2 ? 0.25 : 0;
    Drawing *d = create(disk);
    const PetscReal balls = draw(d, bend, moved, PETSC_FALSE, rgba), scallops = uneven(0, bend, moved, rgba);
    const PetscReal drawn = draw(d, bend, moved, PETSC_TRUE, rgba), off = uneven(0, bend, moved, rgba);
    printf("disk %d: area off %.2g (balls %.2g), radius %.2g (%.2g) of a cell\n", k, (double)(drawn / area - 1),
           (double)(balls / area - 1), (double)(off / H), (double)(scallops / H));
    assert_true(fabs(drawn / area - 1) < 2e-3); /* motion keeps areas */
    assert_true(off < 0.6 * pixel + (k == 2 ? 0.02 * H : 0));
    assert_true(scallops > 0.1 * H); /* what it was */
    destroy(d);
  }
}

/* Corners off the grid's lines are those of the box. */
static void test_corners(void **state)
{
  static unsigned char rgba[4 * W * W];
  const Shape box = {.kind = SHAPE_BOX, .min = {-0.53, -0.41, 0}, .max = {0.47, 0.33, 0}};
  (void)state;
  for (int moved = 0; moved < 2; ++moved) {
    Drawing *d = create(box);
    const PetscReal area = draw(d, 0, (PetscBool)moved, PETSC_TRUE, rgba), pixel = 2. / W;
    printf("box: area off %.2g\n", (double)(area / 0.74 - 1));
    assert_true(fabs(area / 0.74 - 1) < 2e-3);
    for (int k = 0; k < 4; ++k)
      for (int out = 0; out < 2; ++out) { /* two pixels inside a corner there is body, two outside there is none */
        PetscReal X[3] = {k & 1 ? 0.47 : -0.53, k & 2 ? 0.33 : -0.41, 0}, x[3];
        X[0] += (k & 1 ? 1 : -1) * (out ? 2 : -2) * pixel, X[1] += (k & 2 ? 1 : -1) * (out ? 2 : -2) * pixel;
        memcpy(x, X, sizeof x);
        if (moved) move(0, X, x);
        const int i = (int)((x[0] + 1) / 2 * W), j = (int)((x[1] + 1) / 2 * W);
        assert_int_equal(rgba[4 * (j * W + i) + 3], out ? 0 : 255);
      }
    destroy(d);
  }
}

/* Points of a box in space: in the middle of what of the eighths of cells lies in it; returns how many. */
static PetscInt seed_box(const Shape *box, PetscReal *x)
{
  PetscReal at[3][32];
  PetscInt count[3] = {0, 0, 0}, n = 0;
  for (int d = 0; d < 3; ++d)
    for (int k = -12; k < 12; ++k) {
      const PetscReal low = PetscMax(H / 2 * k, box->min[d]), high = PetscMin(H / 2 * (k + 1), box->max[d]);
      if (high - low > 0.1 * H / 2) at[d][count[d]++] = (low + high) / 2;
    }
  for (PetscInt k = 0; k < count[2]; ++k)
    for (PetscInt j = 0; j < count[1]; ++j)
      for (PetscInt i = 0; i < count[0]; ++i, ++n)
        x[3 * n] = at[0][i], x[3 * n + 1] = at[1][j], x[3 * n + 2] = at[2][k];
  return n;
}

/* A box off the grid's lines, stretched and turned to the eye: its silhouette has the area of the sum of its faces'
 * shadows, and there is the light of three planes on it. */
static void test_space(void **state)
{
  static unsigned char rgba[4 * W * W];
  const Shape box = {.kind = SHAPE_BOX, .min = {-0.37, -0.33, -0.29}, .max = {0.41, 0.27, 0.23}};
  const PetscReal stretch[3] = {1.15, 0.9, 1.05}, a = 0.6, b = -0.4;
  const PetscReal R[3][3] = {
    {cos(a), sin(a), 0}, {-sin(b) * sin(a), sin(b) * cos(a), cos(b)}, {cos(b) * sin(a), -cos(b) * cos(a), sin(b)}};
  PetscReal length[3], area[2], exact = 0;
  (void)state;
  Drawing *d = create(disk);
  PlotFrame *f = &d->f;
  d->c.kinematics = &kinematics_3d;
  d->body.shape = box;
  f->n = f->n_first = seed_box(&box, f->first);
  assert_true(f->n < MOST);
  for (PetscInt p = 0; p < f->n; ++p)
    for (int i = 0; i < 3; ++i) {
      f->x[3 * p + i] = 0;
      for (int j = 0; j < 3; ++j) f->x[3 * p + i] += R[i][j] * stretch[j] * f->first[3 * p + j];
    }
  assert_int_equal(PlotSpacing(3, f->n, f->x, f->radius), 0);
  assert_int_equal(PlotSpacing(3, f->n, f->first, f->first_radius), 0);
  assert_int_equal(PlotShapes(&d->c, NULL, f), 0);
  for (int known = 0; known < 2; ++known) {
    const PlotOutline outline = {.c = &d->c, .frame = f};
    const RasterScene scene = {.n = f->n,
                               .x = f->x,
                               .radius = f->radius,
                               .value = d->zero,
                               .gap = f->radius[0],
                               .knows = known ? f->knows : NULL,
                               .holds = plot_shape_holds,
                               .of = &outline,
                               .shaded = PETSC_TRUE,
                               .min = {-1, -1},
                               .max = {1, 1},
                               .width = W,
                               .height = W};
    assert_int_equal(RasterDraw(&scene, rgba), 0);
    area[known] = 0;
    for (int k = 0; k < W * W; ++k) area[known] += rgba[4 * k + 3] / 255. * 4 / (W * W);
  }
  for (int i = 0; i < 3; ++i) length[i] = stretch[i] * (box.max[i] - box.min[i]);
  for (int i = 0; i < 3; ++i) exact += PetscAbsReal(R[2][i]) * length[(i + 1) % 3] * length[(i + 2) % 3];
  printf("box in space: area off %.2g (balls %.2g)\n", (double)(area[1] / exact - 1), (double)(area[0] / exact - 1));
  assert_true(fabs(area[1] / exact - 1) < 5e-3);
  destroy(d);
}

/* Bodies of whole cells are drawn as these, and points that have been torn apart know nothing of an outline. */
static void test_unknown(void **state)
{
  static unsigned char rgba[4 * W * W];
  PetscInt knowing = 0;
  (void)state;
  Drawing *d = create(disk);
  d->body.fill = FILL_CELLS;
  (void)draw(d, 0, PETSC_FALSE, PETSC_TRUE, rgba);
  assert_null(d->f.shape);
  destroy(d);
  d = create(disk);
  for (PetscInt i = 0; i < d->f.n; ++i) /* each goes another way */
    for (int k = 0; k < 3; ++k)
      d->f.x[3 * i + k] = d->f.first[3 * i + k] + (k == 2 ? 0 : H * ((i * (k ? 7 : 11)) % 13 - 6) / 6);
  assert_int_equal(PlotSpacing(2, d->f.n, d->f.x, d->f.radius), 0);
  assert_int_equal(PlotSpacing(2, d->f.n, d->f.first, d->f.first_radius), 0);
  assert_int_equal(PlotShapes(&d->c, NULL, &d->f), 0);
  for (PetscInt i = 0; i < d->f.n; ++i) knowing += d->f.knows[i];
  printf("torn: %d of %d points know\n", (int)knowing, (int)d->f.n);
  assert_true(knowing < d->f.n / 20);
  destroy(d);
}

/* Points of a mesh between two circles: four in each cell, as Gauss's rule has them. */
static void seed_ring(Drawing *d)
{
  enum { LAYERS = 4 };
  const PetscReal gauss[2] = {0.5 - sqrt(3) / 6, 0.5 + sqrt(3) / 6};
  PetscReal a[2], b[2], in[2], out[2];
  d->f.n = 0;
  for (int k = 0; k < CORNERS * 2; ++k)
    for (int l = 0; l < LAYERS * 2; ++l) {
      const PetscReal t = gauss[k % 2], s = (l / 2 + gauss[l % 2]) / LAYERS;
      PetscReal *first = d->f.first + 3 * d->f.n++;
      for (int circle = 0; circle < 2; ++circle) {
        ring_corner(circle, k / 2, a), ring_corner(circle, k / 2 + 1, b);
        for (int i = 0; i < 2; ++i) (circle ? in : out)[i] = (1 - t) * a[i] + t * b[i];
      }
      for (int i = 0; i < 2; ++i) first[i] = (1 - s) * out[i] + s * in[i];
      first[2] = 0;
    }
  d->f.n_first = d->f.n;
}

/* What has come together along one axis keeps its sides along the other. */
static void test_pressed(void **state)
{
  static unsigned char rgba[4 * W * W];
  const Shape box = {.kind = SHAPE_BOX, .min = {-0.53, -0.41, 0}, .max = {0.47, 0.33, 0}};
  (void)state;
  Drawing *d = create(box);
  const PetscReal balls = draw(d, PRESSED, PETSC_TRUE, PETSC_FALSE, rgba),
                  area = draw(d, PRESSED, PETSC_TRUE, PETSC_TRUE, rgba);
  printf("pressed: area off %.2g (balls %.2g)\n", (double)(area / (0.74 / 4) - 1), (double)(balls / (0.74 / 4) - 1));
  /* corners are beyond what balls reach together */
  assert_true(fabs(area / (0.74 / 4) - 1) < 0.01 && fabs(balls / (0.74 / 4) - 1) > 0.03);
  destroy(d);
}

/* A body of its own mesh has the outline of that, inside and outside. */
static void test_mesh(void **state)
{
  static unsigned char rgba[4 * W * W];
  const PetscReal size = 0.5 * CORNERS * sin(2 * PETSC_PI / CORNERS), inner = ring_radius[1] * ring_radius[1],
                  area = size * (ring_radius[0] * ring_radius[0] - inner), cell = 2 * PETSC_PI * 0.62 / CORNERS;
  (void)state;
  for (int k = 0; k < 3; ++k) {
    const PetscBool moved = (PetscBool)(k > 0);
    const PetscReal bend = k == 2 ? 0.25 : 0;
    Drawing *d = create((Shape){.kind = SHAPE_BALL, .centre = {9, 9, 0}, .radius = 0.1});
    d->body.has_shape = PETSC_FALSE, d->body.mesh = (char *)(uintptr_t) "ring.msh";
    seed_ring(d);
    const PetscReal balls = draw(d, bend, moved, PETSC_FALSE, rgba), scallops = uneven(CORNERS, bend, moved, rgba);
    d->contours = create_ring();
    const PetscReal drawn = draw(d, bend, moved, PETSC_TRUE, rgba), off = uneven(CORNERS, bend, moved, rgba);
    printf("ring %d: area off %.2g (balls %.2g), radius %.2g (%.2g) of a cell\n", k, (double)(drawn / area - 1),
           (double)(balls / area - 1), (double)(off / cell), (double)(scallops / cell));
    assert_true(fabs(drawn / area - 1) < 2e-3);
    assert_true(off < 0.6 * 2. / W + (k == 2 ? 0.03 * cell : 0));
    const PlotOutline all = {.c = &d->c, .contours = d->contours, .frame = &d->f, .first = PETSC_TRUE};
    assert_false(plot_bodies_hold(&all, (PetscReal[]){ring_middle[0], ring_middle[1], 0})); /* the hole */
    assert_true(plot_bodies_hold(&all, (PetscReal[]){ring_middle[0] + 0.45, ring_middle[1], 0}));
    d->f.there[0] = 0; /* nothing of it is left */
    assert_false(plot_bodies_hold(&all, (PetscReal[]){ring_middle[0] + 0.45, ring_middle[1], 0}));
    assert_int_equal(PlotContoursDestroy(&d->contours), 0);
    destroy(d);
  }
}

/* Whole cells of a box bound a body as stairs, and neither the grid's other cells nor borders within it do. */
static void test_cells(void **state)
{
  BodySpec body = {.name = "disk", .has_shape = PETSC_TRUE, .shape = disk, .fill = FILL_CELLS};
  const Case c = {.kinematics = &kinematics_plane_strain,
                  .method = (char *)(uintptr_t) "mpm",
                  .n_bodies = 1,
                  .bodies = &body,
                  .grid = {.kind = GRID_BOX,
                           .cell = CELL_QUADRILATERAL,
                           .min = {-1, -1},
                           .max = {1, 1},
                           .counts = {20, 20},
                           .grading = {1, 1, 1}}};
  PlotContours *contours;
  PetscReal length = 0, stairs = 0;
  (void)state;
  assert_int_equal(PlotContoursCreate(&c, &contours), 0);
  const Contour *contour = &contours->body[0];
  for (PetscInt i = 0; i < contour->n; ++i) {
    const PetscReal *e = contour->edge[i];
    length += hypot(e[2] - e[0], e[3] - e[1]);
  }
  for (int k = 0; k < 400; ++k) { /* middles of cells are held as the shape holds them */
    const PetscReal x[3] = {-1 + H * (k % 20 + 0.5), -1 + H * (k / 20 + 0.5), 0};
    const PetscBool in = shape_contains(&disk, 2, x, 0);
    assert_int_equal(contour_holds(contour, x), in);
    assert_false(contour_near(contour, x, 0.49 * H));
    for (int side = 0; side < 2; ++side) {
      PetscReal next[3] = {x[0], x[1], 0};
      next[side] += H;
      stairs += in != shape_contains(&disk, 2, next, 0) ? H : 0;
    }
  }
  assert_true(fabs(length - stairs) < 1e-12);
  assert_int_equal(PlotContoursDestroy(&contours), 0);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_disk),    cmocka_unit_test(test_corners),
                                     cmocka_unit_test(test_pressed), cmocka_unit_test(test_mesh),
                                     cmocka_unit_test(test_cells),   cmocka_unit_test(test_space),
                                     cmocka_unit_test(test_unknown)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char **argv) { return TestMain(argc, argv, Tests); }
