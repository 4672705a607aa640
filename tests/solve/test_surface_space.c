/* How a material point finds the surface of another body in space: gaps and normals of lattices whose surfaces are
 * known, at any angle, fitting and not, with edges and corners and curved. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>
#include <petsctime.h>
#include "solve/contact/surface/surface.h"

#define MOST 24000
#define ANGLES 8

typedef struct {
  SurfacePoint point[MOST];
  Surface surface;
} Body;

static Body upper, lower;

/* Columns are the axes of a frame that is turned: about z by the first angle, then about x, then about z again. */
typedef struct {
  PetscReal R[9];
} Frame;

static Frame product(const Frame *a, const Frame *b)
{
  Frame c = {{0}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) c.R[3 * i + j] += a->R[3 * i + k] * b->R[3 * k + j];
  return c;
}

static Frame about(int axis, PetscReal angle)
{
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  Frame f = {{0}};
  f.R[4 * axis] = 1;
  f.R[4 * j] = f.R[4 * k] = PetscCosReal(angle);
  f.R[3 * k + j] = PetscSinReal(angle);
  f.R[3 * j + k] = -f.R[3 * k + j];
  return f;
}

/* Several, all over. The first is none. */
static Frame any_frame(int k)
{
  const Frame z = about(2, 0.7 * k), x = about(0, 1.1 * k), last = about(2, 0.4 * k), both = product(&x, &z);
  return product(&last, &both);
}

static void place(const Frame *f, const PetscReal u[3], PetscReal x[3])
{
  for (int i = 0; i < 3; ++i) x[i] = f->R[3 * i] * u[0] + f->R[3 * i + 1] * u[1] + f->R[3 * i + 2] * u[2];
}

/* A vector as the frame sees it. */
static void look(const Frame *f, const PetscReal x[3], PetscReal u[3])
{
  for (int i = 0; i < 3; ++i) u[i] = f->R[i] * x[0] + f->R[3 + i] * x[1] + f->R[6 + i] * x[2];
}

static void add(Body *b, const Frame *f, const PetscReal x[3], PetscReal size)
{
  SurfacePoint *p = b->point + b->surface.n++;
  assert_true(b->surface.n <= MOST);
  *p = (SurfacePoint){.id = b->surface.n, .first = 0.5 * size, .reach = 0.5 * size, .size = size, .own = size};
  for (int i = 0; i < 3; ++i) p->x[i] = x[i];
  for (int i = 0; i < 9; ++i) p->F[i] = f->R[i];
}

static void close_body(Body *b)
{
  b->surface.dim = 3;
  b->surface.point = b->point;
  surface_sort(&b->surface);
}

/* Points in a box of a lattice's frame f, which lies in another one. */
static void add_box(Body *b, const Frame *in, const Frame *f, const PetscReal box[6], PetscReal size)
{
  const Frame all = product(in, f);
  PetscReal x[3];
  for (PetscReal u = box[0] + 0.5 * size; u < box[3]; u += size)
    for (PetscReal v = box[1] + 0.5 * size; v < box[4]; v += size)
      for (PetscReal w = box[2] + 0.5 * size; w < box[5]; w += size) {
        place(&all, (PetscReal[]){u, v, w}, x);
        add(b, &all, x, size);
      }
}

static void box(Body *b, const Frame *in, const Frame *f, const PetscReal box[6], PetscReal size)
{
  b->surface.n = 0;
  add_box(b, in, f, box, size);
  close_body(b);
}

static void move(Body *b, const Frame *in, const PetscReal by[3])
{
  PetscReal way[3];
  place(in, by, way);
  for (SurfacePoint *p = b->point; p < b->point + b->surface.n; ++p)
    for (int i = 0; i < 3; ++i) p->x[i] += way[i];
  close_body(b);
}

/* How far a normal is from the frame's third axis. */
static PetscReal off(const Frame *in, const PetscReal n[3])
{
  PetscReal u[3];
  look(in, n, u);
  return PetscMax(PetscAbsReal(u[2] - 1), PetscMax(PetscAbsReal(u[0]), PetscAbsReal(u[1])));
}

/* A block over another one, turned about their normal by `spin`: the first layer of the upper block, and `alone` that,
 * meets the lower one, with the gap and the normal of the plane between them. */
static void face(PetscReal gap, PetscReal size, PetscReal spin, int alone)
{
  const Frame none = about(2, 0), turned = about(2, spin);
  PetscReal worst[2] = {0, 0}, u[3];
  for (int k = 0; k < ANGLES; ++k) {
    const Frame in = any_frame(k);
    int met = 0;
    box(&lower, &in, &none, (PetscReal[]){-0.75, -0.75, -0.5, 0.75, 0.75, -1e-9}, 0.125);
    box(&upper, &in, &turned, (PetscReal[]){-0.375, -0.375, gap, 0.375 - 1e-9, 0.375 - 1e-9, gap + 0.375 - 1e-9}, size);
    for (const SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p) {
      SurfacePair pair;
      look(&in, p->x, u);
      const int first = u[2] < gap + size;
      const PetscBool meets = surface_meet(&upper.surface, p, &lower.surface, 0.25, &pair);
      if (alone) assert_int_equal(meets, first);
      if (!meets || !first) continue;
      ++met;
      worst[0] = PetscMax(worst[0], off(&in, pair.normal));
      worst[1] = PetscMax(worst[1], PetscAbsReal(pair.gap - p->reach - gap));
    }
    assert_true(met >= 36);
  }
  print_message("faces %g m apart, points of %g m turned by %g: normal off by %.2g, gap by %.2g m\n", (double)gap,
                (double)size, (double)spin, (double)worst[0], (double)worst[1]);
  assert_true(worst[0] < 1e-12 && worst[1] < 1e-9);
}

static void test_planes(void **state)
{
  (void)state;
  face(0, 0.125, 0, 1);
  face(0.01, 0.125, 0, 1);
  face(0.01, 0.1, 0, 1);
  face(0.01, 0.1, 0.3, 1);
  face(0.05, 0.11, PETSC_PI / 4, 1);
}

/* Blocks that have sunk into each other, by more than a layer of points: their centres, too. */
static void test_sunk(void **state)
{
  (void)state;
  face(-0.15, 0.125, 0, 0);
  face(-0.15, 0.1, 0.3, 0);
}

/* A block that stands on a corner of its own, or on an edge: the flat body gives the normal. */
static void test_corner(void **state)
{
  const Frame none = about(2, 0), quarter = about(2, PETSC_PI / 4), tilt = about(0, PetscAtanReal(PetscSqrtReal(2))),
              corner = product(&tilt, &quarter), edge = about(0, PETSC_PI / 4);
  const PetscReal size = 0.125, full[6] = {0, 0, 0, 0.75, 0.75, 0.75};
  const PetscReal below[2] = {0.5 * PetscSqrtReal(3) * size, PetscSqrtReal(0.5) * size};
  (void)state;
  for (int k = 0; k < 2 * ANGLES; ++k) {
    const Frame in = any_frame(k / 2);
    PetscReal least = 1, worst = 0;
    box(&lower, &in, &none, (PetscReal[]){-0.9, -0.9, -0.5, 0.9, 0.9, -1e-9}, 0.125);
    box(&upper, &in, k % 2 ? &edge : &corner, full, size);
    move(&upper, &in, (PetscReal[]){0, 0, 0.05});
    for (const SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p) {
      SurfacePair pair;
      if (!surface_meet(&upper.surface, p, &lower.surface, 0.25, &pair) || pair.gap > 0.25) continue;
      worst = PetscMax(worst, off(&in, pair.normal));
      least = PetscMin(least, pair.gap);
    }
    assert_true(worst < 1e-12);
    assert_true(PetscAbsReal(least - 0.05 - below[k % 2]) < 1e-9);
  }
}

/* Two edges that cross: the normal is across both, the gap that of the points along them. */
static void test_edges(void **state)
{
  const Frame none = about(0, PETSC_PI / 4);
  const PetscReal size = 0.125, apart = 0.03, far = apart + PetscSqrtReal(2) * size - 0.5 * size;
  PetscReal worst[2] = {0, 0};
  (void)state;
  for (int k = 0; k < ANGLES; ++k) {
    const Frame in = any_frame(k), spin = about(2, 0.35 + 0.15 * k), across = product(&spin, &none);
    int met = 0;
    box(&lower, &in, &none, (PetscReal[]){-0.75, -0.625, -0.625, 0.75, -1e-9, -1e-9}, size);
    box(&upper, &in, &across, (PetscReal[]){-0.7, 0, 0, 0.7, 0.625 - 1e-9, 0.625 - 1e-9}, size);
    move(&upper, &in, (PetscReal[]){0, 0, apart});
    for (const SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p) {
      SurfacePair pair;
      if (!surface_meet(&upper.surface, p, &lower.surface, 0.25, &pair) || pair.gap > far + 0.5 * size) continue;
      PetscReal u[3];
      look(&in, p->x, u);
      if (u[2] > apart + size || PetscSqr(u[0]) + PetscSqr(u[1]) > PetscSqr(size)) continue;
      ++met;
      worst[0] = PetscMax(worst[0], off(&in, pair.normal));
      worst[1] = PetscMax(worst[1], PetscAbsReal(pair.gap - far));
    }
    assert_true(met >= 1);
  }
  print_message("crossed edges: normal off by %.2g, gap by %.2g m\n", (double)worst[0], (double)worst[1]);
  assert_true(worst[0] < 1e-9 && worst[1] < 1e-9);
}

/* A ball of layers about `centre`, its points well spread on each. */
static void add_ball(Body *b, const Frame *in, const PetscReal centre[3], PetscReal R, PetscReal size)
{
  const PetscReal golden = PETSC_PI * (3 - PetscSqrtReal(5));
  PetscReal x[3];
  for (int layer = 0; layer < 3; ++layer) {
    const PetscReal r = R - (0.5 + layer) * size;
    const int n = (int)(4 * PETSC_PI * PetscSqr(r / size));
    for (int k = 0; k < n; ++k) {
      const PetscReal z = 1 - (2 * k + 1) / (PetscReal)n, s = PetscSqrtReal(1 - z * z);
      const PetscReal u[3] = {centre[0] + r * s * PetscCosReal(golden * k),
                              centre[1] + r * s * PetscSinReal(golden * k), centre[2] + r * z};
      place(in, u, x);
      add(b, in, x, size);
    }
  }
}

/* Before the line of centres the normal of two balls is along it, and the gap theirs, both within what polyhedra of so
 * many corners are off. */
static void test_balls(void **state)
{
  const PetscReal R = 1, size = PETSC_PI / 40, centre[3] = {0, 0, 0};
  const Frame none = about(2, 0);
  PetscReal turned = 0, furthest = 0, least = 1;
  (void)state;
  for (int k = 0; k < 3; ++k) {
    const Frame in = any_frame(k + 1);
    lower.surface.n = upper.surface.n = 0;
    add_ball(&lower, &in, centre, R, size);
    add_ball(&upper, &none, centre, R, size);
    close_body(&lower);
    move(&upper, &none, (PetscReal[]){0, 0, 2 * R + 0.02});
    for (const SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p) {
      SurfacePair pair;
      if (PetscSqr(p->x[0]) + PetscSqr(p->x[1]) > size * size || p->x[2] > 1.5) continue;
      if (!surface_meet(&upper.surface, p, &lower.surface, 0.15, &pair)) continue;
      turned = PetscMax(turned, PetscSqrtReal(PetscSqr(pair.normal[0]) + PetscSqr(pair.normal[1])));
      least = PetscMin(least, pair.gap - p->reach);
      furthest = PetscMax(furthest, pair.gap - p->reach);
    }
  }
  print_message("balls: normal off by %.3g, gaps from %.5g to %.5g of 0.02\n", (double)turned, (double)least,
                (double)furthest);
  assert_true(turned < 0.04 && PetscAbsReal(least - 0.02) < 0.04 * size);
}

/* A ball on a plane: its normal where the ball is near, and the gap of the lowest point. */
static void test_ball_on_plane(void **state)
{
  const PetscReal R = 0.6, size = 0.08, gap = 0.01;
  const Frame none = about(2, 0);
  (void)state;
  for (int k = 0; k < ANGLES; ++k) {
    const Frame in = any_frame(k);
    PetscReal least = 1, lowest = 1, worst = 0, u[3];
    upper.surface.n = 0;
    add_ball(&upper, &in, (PetscReal[]){0, 0, R + gap}, R, size);
    close_body(&upper);
    box(&lower, &in, &none, (PetscReal[]){-0.7, -0.7, -0.4, 0.7, 0.7, -1e-9}, 0.1);
    for (const SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p) {
      SurfacePair pair;
      look(&in, p->x, u);
      lowest = PetscMin(lowest, u[2]);
      if (!surface_meet(&upper.surface, p, &lower.surface, 0.2, &pair) || pair.gap > size) continue;
      worst = PetscMax(worst, off(&in, pair.normal));
      least = PetscMin(least, pair.gap);
    }
    assert_true(worst < 1e-12 && PetscAbsReal(least - lowest) < 1e-9);
  }
}

/* Three layers of walls about a hole from 0 to 0.8; of the bits of `without` (1, 2, 4: along x, y, z; 8, 16, 32: below,
 * above) there is none. */
static void walls(Body *b, const Frame *in, int without)
{
  const PetscReal size = 0.1;
  PetscReal x[3];
  b->surface.n = 0;
  for (int k = 0; k < 14 * 14 * 14; ++k) {
    const int at[3] = {k % 14, k / 14 % 14, k / 196};
    int beyond = 0, open = 0;
    for (int d = 0; d < 3; ++d) {
      beyond += at[d] < 3 || at[d] > 10;
      open += (at[d] < 3 && without & 1 << d) || (at[d] > 10 && without & 8 << d);
    }
    if (!beyond || open) continue;
    place(in, (PetscReal[]){(at[0] - 2.5) * size, (at[1] - 2.5) * size, (at[2] - 2.5) * size}, x);
    add(b, in, x, size);
  }
  close_body(b);
}

/* All that are near meet across one side, at the distance that it has; each side that there is by some. */
static void check_sides(const Body *a, const Body *b, const Frame *in, PetscReal gap, int sides)
{
  SurfacePair pair;
  int met[6] = {0}, seen = 0;
  for (const SurfacePoint *p = a->point; p < a->point + a->surface.n; ++p) {
    if (!surface_meet(&a->surface, p, &b->surface, 0.2, &pair) || pair.gap > 0.5 * p->size + 0.11) continue;
    PetscReal n[3], largest = 0;
    int side = 0;
    look(in, pair.normal, n);
    for (int d = 0; d < 3; ++d)
      if (PetscAbsReal(n[d]) > largest) largest = PetscAbsReal(n[d]), side = 2 * d + (n[d] > 0);
    assert_true(1 - largest < 1e-12);
    assert_true(PetscAbsReal(pair.gap - p->reach - gap) < 1e-9);
    ++met[side];
  }
  for (int k = 0; k < 6; ++k) seen += met[k] >= 12;
  assert_int_equal(seen, sides);
}

/* A block in a trough, in a corner of three walls, and in a box that is open above: the corners of one are in those of
 * the other, fitting and not, whichever comes first. */
static void test_walls(void **state)
{
  static const PetscReal gaps[] = {0, 0.02, 0.1};
  static const int across[] = {8, 7, 6}, without[] = {2 + 16 + 32, 8 + 16 + 32, 32}, sides[] = {3, 3, 5};
  const Frame none = about(2, 0);
  (void)state;
  for (int k = 0; k < 2; ++k)
    for (int g = 0; g < 3; ++g)
      for (int o = 0; o < 3; ++o) {
        const Frame in = any_frame(k);
        const PetscReal low = gaps[g], high = 0.8 - gaps[g] - 1e-9;
        box(&upper, &in, &none, (PetscReal[]){low, low, low, high, high, high}, (0.8 - 2 * gaps[g]) / across[g]);
        walls(&lower, &in, without[o]);
        check_sides(&upper, &lower, &in, gaps[g], sides[o]);
        check_sides(&lower, &upper, &in, gaps[g], sides[o]);
      }
}

/* The areas over which two layers of points meet, as each of them counts. */
static PetscReal met_by(const Body *a, const Body *b)
{
  PetscReal sum = 0;
  SurfacePair pair;
  for (const SurfacePoint *p = a->point; p < a->point + a->surface.n; ++p)
    if (surface_meet(&a->surface, p, &b->surface, 0.25, &pair)) sum += pair.cover * p->size * p->size;
  return sum;
}

/* The lower block from 0 to 1 along both axes, the upper one of its own length shifted along both. */
static void test_cover(void **state)
{
  const Frame none = about(2, 0);
  PetscReal worst = 0;
  (void)state;
  for (int k = 0; k < 12; ++k) {
    const Frame in = any_frame(k);
    const PetscReal shift[2] = {0.08 * k - 0.4, 0.31 - 0.05 * k}, length = 0.6, size = 0.1;
    PetscReal both = 1;
    for (int d = 0; d < 2; ++d) both *= PetscMin(1, shift[d] + length) - PetscMax(0, shift[d]);
    box(&lower, &in, &none, (PetscReal[]){0, 0, -0.5, 1, 1, -1e-9}, 0.125);
    box(&upper, &in, &none,
        (PetscReal[]){shift[0], shift[1], 0.001, shift[0] + length - 1e-9, shift[1] + length - 1e-9, 0.4}, size);
    const PetscReal first = met_by(&upper, &lower) / both - 1, second = met_by(&lower, &upper) / both - 1;
    worst = PetscMax(worst, PetscMax(PetscAbsReal(first), PetscAbsReal(second)));
  }
  print_message("areas: off by %.2g\n", (double)worst);
  assert_true(worst < 0.02);
}

/* As many points as a run may have, of which a layer meets. */
static void test_many(void **state)
{
  const Frame none = about(2, 0), in = any_frame(1);
  PetscLogDouble start, end;
  int met = 0;
  (void)state;
  box(&lower, &in, &none, (PetscReal[]){0, 0, -0.8, 5 - 1e-9, 5 - 1e-9, -1e-9}, 0.1);
  box(&upper, &in, &none, (PetscReal[]){0, 0, 0.01, 5 - 1e-9, 5 - 1e-9, 0.81 - 1e-9}, 0.1);
  (void)PetscTime(&start);
  close_body(&lower);
  close_body(&upper);
  for (const SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p) {
    SurfacePair pair;
    met += surface_meet(&upper.surface, p, &lower.surface, 0.2, &pair);
  }
  (void)PetscTime(&end);
  print_message("%d points and %d: %d meet, %.3g s\n", (int)upper.surface.n, (int)lower.surface.n, met, end - start);
  assert_int_equal(met, 2500);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_planes), cmocka_unit_test(test_sunk),  cmocka_unit_test(test_corner),
    cmocka_unit_test(test_edges),  cmocka_unit_test(test_balls), cmocka_unit_test(test_ball_on_plane),
    cmocka_unit_test(test_walls),  cmocka_unit_test(test_cover), cmocka_unit_test(test_many),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
