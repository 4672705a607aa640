/* How a material point finds the surface of another body: gaps and normals of lattices whose surfaces
 * are known, at any angle, staggered, with corners and curved. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>
#include "solve/contact/surface/surface.h"

#define MOST 600

typedef struct {
  SurfacePoint point[MOST];
  Surface surface;
} Body;

static void add(Body *b, PetscReal x, PetscReal y, PetscReal size)
{
  SurfacePoint *p = b->point + b->surface.n++;
  assert_true(b->surface.n <= MOST);
  *p = (SurfacePoint){.id = b->surface.n,
                      .x = {x, y},
                      .F = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                      .first = 0.5 * size,
                      .reach = 0.5 * size,
                      .size = size,
                      .own = size};
}

static void close_body(Body *b)
{
  b->surface.dim = 2;
  b->surface.point = b->point;
  surface_sort(&b->surface);
}

/* More points: along (c, s) from u0 to u1, from w0 to w1 across; turned about the origin. */
static void add_block(Body *b, PetscReal angle, PetscReal u0, PetscReal u1, PetscReal w0, PetscReal w1, PetscReal size)
{
  const PetscReal c = PetscCosReal(angle), s = PetscSinReal(angle);
  for (PetscReal u = u0 + 0.5 * size; u < u1; u += size)
    for (PetscReal w = w0 + 0.5 * size; w < w1; w += size) add(b, c * u - s * w, s * u + c * w, size);
}

static void block(Body *b, PetscReal angle, PetscReal u0, PetscReal u1, PetscReal w0, PetscReal w1, PetscReal size)
{
  b->surface.n = 0;
  add_block(b, angle, u0, u1, w0, w1, size);
  close_body(b);
}

/* A block over another one, their points in lattices that do not fit, at any angle: the first row of the upper block,
 * and `alone` that, meets the lower one, with the gap and the normal of the plane between them. */
static void face(PetscReal gap, int alone)
{
  static Body upper, lower;
  const PetscReal h = 0.25;
  for (int k = 0; k < 24; ++k) {
    const PetscReal angle = 0.27 * k, c = PetscCosReal(angle), s = PetscSinReal(angle);
    int met = 0;
    block(&lower, angle, -1.5, 1.5, -0.5, 0, 0.125);
    block(&upper, angle, -0.57 + 0.01 * k, 0.5, gap, 0.5, 0.1);
    for (const SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p) {
      SurfacePair pair;
      const int first = -s * p->x[0] + c * p->x[1] < gap + 0.1;
      const PetscBool meets = surface_meet(&upper.surface, p, &lower.surface, h, &pair);
      if (alone) assert_int_equal(meets, first);
      if (!meets || !first) continue;
      ++met;
      assert_true(PetscAbsReal(pair.normal[0] + s) < 1e-9 && PetscAbsReal(pair.normal[1] - c) < 1e-9);
      assert_true(PetscAbsReal(pair.gap - p->reach - gap) < 1e-9);
    }
    assert_true(met >= 8);
  }
}

static void test_planes(void **state)
{
  (void)state;
  face(0.01, 1);
}

/* Blocks that have sunk into each other, by more than a row of points: their centres, too. */
static void test_sunk(void **state)
{
  (void)state;
  face(-0.15, 0);
}

/* A block that stands on its corner: the flat body gives the normal, and the corner alone is near. */
static void test_corner(void **state)
{
  static Body upper, lower;
  const PetscReal corner = PetscSqrtReal(0.5) * 0.125; /* of its lowest point's part, below its middle */
  PetscReal least = 1;
  (void)state;
  block(&lower, 0, -1.5, 1.5, -0.5, 0, 0.125);
  block(&upper, PETSC_PI / 4, 0, 1, 0, 1, 0.125);
  for (SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p) p->x[1] += 0.05;
  for (const SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p) {
    SurfacePair pair;
    if (!surface_meet(&upper.surface, p, &lower.surface, 0.25, &pair)) continue;
    assert_true(PetscAbsReal(pair.normal[0]) < 1e-9 && pair.normal[1] > 0);
    least = PetscMin(least, pair.gap);
  }
  assert_true(PetscAbsReal(least - 0.05 - corner) < 1e-9);
}

/* Two circles of points: before their line of centres the normal is along it, and the gap that of the
 * circles, both within what polygons of so many corners are off. */
static void test_circles(void **state)
{
  static Body left, right;
  const PetscReal R = 1, size = PETSC_PI / 40, centre = 2 * R + 0.02;
  PetscReal least = 1, turned = 0;
  (void)state;
  for (int shift = 0; shift < 5; ++shift) {
    left.surface.n = right.surface.n = 0;
    for (int k = 0; k < 80; ++k)
      for (int ring = 0; ring < 3; ++ring) {
        const PetscReal r = R - (0.5 + ring) * size, a = (k + 0.2 * shift) * size, b = k * size;
        add(&left, r * PetscCosReal(a), r * PetscSinReal(a), size);
        add(&right, centre - r * PetscCosReal(b), r * PetscSinReal(b), size);
      }
    close_body(&left);
    close_body(&right);
    for (const SurfacePoint *p = left.point; p < left.point + left.surface.n; ++p) {
      SurfacePair pair;
      if (PetscAbsReal(p->x[1]) > size || !surface_meet(&left.surface, p, &right.surface, 0.15, &pair)) continue;
      turned = PetscMax(turned, PetscAbsReal(pair.normal[1]));
      least = PetscMin(least, pair.gap - p->reach);
    }
  }
  print_message("circles: normal off by %.3g, least gap %.5g of 0.02\n", (double)turned, (double)least);
  assert_true(turned < 0.04 && PetscAbsReal(least - 0.02) < 0.005 * size);
}

/* Beside the other body there is nothing to meet, and where bodies overlap there is still an answer. */
static void test_edges(void **state)
{
  static Body upper, lower;
  SurfacePair pair;
  (void)state;
  block(&lower, 0, -0.5, 0, -0.5, 0, 0.125);
  block(&upper, 0, 0.25, 1, 0.01, 0.5, 0.125);
  for (const SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p)
    if (surface_meet(&upper.surface, p, &lower.surface, 0.25, &pair)) assert_true(pair.gap > p->reach + 0.1);
  block(&upper, 0, -0.5, 0, -0.25, 0.25, 0.125);
  PetscReal deepest = 0;
  for (const SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p)
    if (surface_meet(&upper.surface, p, &lower.surface, 0.25, &pair)) deepest = PetscMin(deepest, pair.gap - p->reach);
  assert_true(deepest < -0.1);
}

/* The lengths over which two rows of points meet, as each of them counts: the first from 0 to 1, the other shifted by
 * `shift` and of its own length, in lattices that do not fit, at any angle. */
static PetscReal met_by(const Body *a, const Body *b)
{
  PetscReal sum = 0;
  SurfacePair pair;
  for (const SurfacePoint *p = a->point; p < a->point + a->surface.n; ++p)
    if (surface_meet(&a->surface, p, &b->surface, 0.25, &pair)) sum += pair.cover * p->size;
  return sum;
}

static void test_cover(void **state)
{
  static Body upper, lower;
  (void)state;
  for (int k = 0; k < 24; ++k) {
    const PetscReal angle = 0.27 * k, shift = 0.04 * k - 0.4, length = 0.6, size = 0.1;
    const PetscReal both = PetscMin(1, shift + length) - PetscMax(0, shift);
    block(&lower, angle, 0, 1, -0.5, 0, 0.125);
    block(&upper, angle, shift, shift + length - 1e-9, 0.001, 0.5, size);
    assert_true(PetscAbsReal(met_by(&upper, &lower) - both) < 0.02 * size + 1e-6);
    assert_true(PetscAbsReal(met_by(&lower, &upper) - both) < 0.02 * 0.125 + 1e-6);
  }
}

/* Squares of a lattice along the axes, as far as they lie in a slab: from `low` to `high` along (-s, c), its ends far
 * away. A point stands in the middle of what its square has of that. */
static void cut_slab(Body *b, PetscReal angle, PetscReal low, PetscReal high, PetscReal shift, PetscReal size)
{
  enum { FINE = 20 };
  const PetscReal c = PetscCosReal(angle), s = PetscSinReal(angle), fine = size / FINE;
  b->surface.n = 0;
  for (PetscReal x0 = shift - 1; x0 < 1; x0 += size)
    for (PetscReal y0 = shift - 1; y0 < 1; y0 += size) {
      PetscReal x = 0, y = 0;
      int n = 0;
      for (int k = 0; k < FINE * FINE; ++k) {
        const PetscReal u = x0 + (0.5 + k % FINE) * fine, v = y0 + (0.5 + (PetscReal)(k / FINE)) * fine;
        if (c * v - s * u < low || c * v - s * u > high) continue;
        x += u, y += v, ++n;
      }
      if (n < FINE * FINE / 10) continue; /* slivers join others */
      x /= n, y /= n;
      add(b, x, y, size * PetscSqrtReal(n) / FINE);
      SurfacePoint *p = b->point + b->surface.n - 1;
      p->reach = p->first = PetscMin(0.5 * size, PetscMin(high - (c * y - s * x), c * y - s * x - low));
    }
  close_body(b);
}

/* A plane face that cuts cells is one whichever it cuts, and however deep in the body the points are that stand for it:
 * whatever touches has its normal. */
static void test_cut(void **state)
{
  static Body upper, lower;
  SurfacePair pair;
  (void)state;
  for (int k = 0; k < 48; ++k) {
    const PetscReal angle = 0.27 * k, c = PetscCosReal(angle), s = PetscSinReal(angle);
    int met = 0;
    cut_slab(&lower, angle, -0.4, 0.0025 * k, 0, 0.125);
    cut_slab(&upper, angle, 0.0025 * k, 0.6, 0.021, 0.125);
    for (const SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p) {
      if (PetscAbsReal(p->x[0]) > 0.7 || PetscAbsReal(p->x[1]) > 0.7) continue;
      if (!surface_meet(&upper.surface, p, &lower.surface, 0.25, &pair) || pair.gap - p->reach > 0.02) continue;
      assert_true(PetscAbsReal(pair.normal[0] + s) < 1e-9 && PetscAbsReal(pair.normal[1] - c) < 1e-9);
      met += PetscAbsReal(pair.gap - p->reach) < 1e-9 ? 1 : 0;
    }
    assert_true(met >= 6);
  }
}

/* Of those that are near: all across one of three sides, at the distance that it has. */
static void check_trough(const Body *a, const Body *b, PetscReal angle, PetscReal left, PetscReal below,
                         PetscReal right)
{
  const PetscReal c = PetscCosReal(angle), s = PetscSinReal(angle);
  SurfacePair pair;
  int sides[3] = {0, 0, 0};
  for (const SurfacePoint *p = a->point; p < a->point + a->surface.n; ++p) {
    if (!surface_meet(&a->surface, p, &b->surface, 0.2, &pair) || pair.gap > 0.5 * p->size + 0.11) continue;
    const PetscReal n[2] = {c * pair.normal[0] + s * pair.normal[1], c * pair.normal[1] - s * pair.normal[0]};
    const int side = PetscAbsReal(n[1]) > 0.9 ? 1 : n[0] * (left < 0 ? -1 : 1) > 0 ? 0 : 2;
    const PetscReal gap = side == 1 ? PetscAbsReal(below) : side ? PetscAbsReal(right) : PetscAbsReal(left);
    assert_true(PetscMin(PetscAbsReal(n[0]), PetscAbsReal(n[1])) < 1e-9);
    assert_true(PetscAbsReal(pair.gap - p->reach - gap) < 1e-9);
    ++sides[side];
  }
  for (int k = 0; k < 3; ++k) assert_true(sides[k] >= 6);
}

/* A block that stands in a trough: the corners of one are in those of the other, at any angle, fitting and not, and
 * whichever comes first. */
static void test_trough(void **state)
{
  static Body core, trough;
  static const PetscReal gaps[] = {0, 0.02, 0.1};
  (void)state;
  for (int k = 0; k < 24; ++k)
    for (int g = 0; g < 3; ++g) {
      const PetscReal angle = 0.27 * k, gap = gaps[g];
      block(&core, angle, 0, 0.8 - 1e-9, 0, 0.8, 0.1);
      trough.surface.n = 0;
      add_block(&trough, angle, -gap - 0.3, -gap - 1e-9, -gap - 0.3, 0.9, 0.1);
      add_block(&trough, angle, 0.8 + gap, 1.1 + gap, -gap - 0.3, 0.9, 0.1);
      add_block(&trough, angle, -gap, 0.8 + gap - 1e-9, -gap - 0.3, -gap - 1e-9, 0.1);
      close_body(&trough);
      check_trough(&core, &trough, angle, gap, gap, gap);
      check_trough(&trough, &core, angle, -gap, gap, gap);
    }
}

/* A block of cells of so many metres a side, each with the four points of Gauss's rule, as meshes are seeded. */
static void add_cells(Body *b, PetscReal angle, const PetscReal *low, const int *n, const PetscReal *side)
{
  const PetscReal c = PetscCosReal(angle), s = PetscSinReal(angle), gauss = 0.5 - 0.5 / PetscSqrtReal(3);
  const PetscReal narrow = 0.5 * PetscMin(side[0], side[1]);
  for (int k = 0; k < 4 * n[0] * n[1]; ++k) {
    const int cell[2] = {k / 2 % n[0], k / 4 / n[0]}, half[2] = {k % 2, k / 2 / n[0] % 2};
    PetscReal at[2], corner[2] = {0, 0}, beside[2] = {0, 0}, first = 0.5 * PetscSqrtReal(side[0] * side[1]);
    for (int d = 0; d < 2; ++d) {
      const PetscReal away = gauss * side[d];
      const int outer = half[d] ? cell[d] == n[d] - 1 : cell[d] == 0;
      at[d] = low[d] + cell[d] * side[d] + (half[d] ? side[d] - away : away);
      if (outer) beside[d] = half[d] ? 1 : -1, corner[d] = beside[d] * away, first = PetscMin(first, away);
    }
    add(b, c * at[0] - s * at[1], s * at[0] + c * at[1], PetscSqrtReal(side[0] * side[1]) / 2);
    SurfacePoint *p = b->point + b->surface.n - 1;
    p->first = p->reach =
      beside[0] != 0 || beside[1] != 0 ? PetscMin(first, narrow) : gauss * PetscMin(side[0], side[1]);
    p->corner[0] = c * corner[0] - s * corner[1], p->corner[1] = s * corner[0] + c * corner[1];
    p->shift[0] = p->corner[0] - p->first * (c * beside[0] - s * beside[1]);
    p->shift[1] = p->corner[1] - p->first * (s * beside[0] + c * beside[1]);
  }
}

/* Points at corners of cells that are taller than wide are nearer to the end of their body than to its foot, and are no
 * less of the plane that this is: blocks of any cells on bases of any. */
static void test_tall_cells(void **state)
{
  static Body upper, lower;
  static const PetscReal sides[][2] = {{0.16, 0.2}, {0.1, 0.3}, {0.2, 0.3}, {0.2, 0.1}};
  SurfacePair pair;
  (void)state;
  for (int k = 0; k < 24; ++k)
    for (int i = 0; i < 4; ++i) {
      const PetscReal angle = 0.27 * k, c = PetscCosReal(angle), s = PetscSinReal(angle), tall = sides[i][1];
      int met = 0;
      upper.surface.n = lower.surface.n = 0;
      add_cells(&lower, angle, (PetscReal[]){-1, -0.5}, (int[]){12, 4}, (PetscReal[]){0.275, 0.125});
      add_cells(&upper, angle, (PetscReal[]){-0.367 + 0.01 * k, 0}, (int[]){5, 2}, sides[i]);
      close_body(&lower);
      close_body(&upper);
      for (const SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p) {
        const PetscReal height = c * p->x[1] - s * p->x[0];
        if (height > 0.25 * tall) continue;
        assert_true(surface_meet(&upper.surface, p, &lower.surface, PetscMin(0.125, sides[i][0]), &pair));
        assert_true(PetscAbsReal(pair.normal[0] + s) < 1e-9 && PetscAbsReal(pair.normal[1] - c) < 1e-9);
        assert_true(PetscAbsReal(pair.gap - height) < 1e-9);
        ++met;
      }
      assert_true(met == 10);
    }
}

/* The foremost corner of a block of cut cells on a slope of 25 degrees: the point of its front has no side of the slope
 * before it, however its few neighbours stand (it met one that leant by 22 degrees, and held the block there). */
static void test_front(void **state)
{
  static const PetscReal block[][3] = {
    {1.17523, 0.52525, 0.02901}, {1.18692, 0.49390, 0.00553}, {1.225, 0.575, 0.025}, {1.225, 0.525, 0.025},
    {1.22824, 0.48426, 0.01426}, {1.275, 0.525, 0.025},       {1.275, 0.575, 0.025}, {1.27682, 0.47294, 0.02453},
    {1.31089, 0.47697, 0.00987}, {1.3226, 0.5272, 0.02048},   {1.325, 0.575, 0.025},
  };
  static const PetscReal slope[][3] = {
    {1.173, 0.47183, 0.02035},   {1.175, 0.425, 0.025}, {1.22015, 0.46115, 0.0101},  {1.225, 0.375, 0.025},
    {1.225, 0.425, 0.025},       {1.275, 0.325, 0.025}, {1.27292, 0.42385, 0.02161}, {1.275, 0.375, 0.025},
    {1.32507, 0.41169, 0.01059}, {1.325, 0.375, 0.025}, {1.37398, 0.37371, 0.02434}, {1.375, 0.325, 0.025},
    {1.42137, 0.36423, 0.0129},  {1.325, 0.325, 0.025},
  };
  const PetscReal c = PetscCosReal(25 * PETSC_PI / 180), s = PetscSinReal(25 * PETSC_PI / 180);
  static Body upper, lower;
  SurfacePair pair;
  (void)state;
  upper.surface.n = lower.surface.n = 0;
  for (size_t k = 0; k < sizeof block / sizeof *block; ++k) add(&upper, block[k][0], block[k][1], 0.05);
  for (size_t k = 0; k < sizeof slope / sizeof *slope; ++k) add(&lower, slope[k][0], slope[k][1], 0.05);
  for (int k = 0; k < upper.surface.n; ++k) upper.point[k].first = upper.point[k].reach = block[k][2];
  for (int k = 0; k < lower.surface.n; ++k) {
    SurfacePoint *p = lower.point + k;
    p->first = p->reach = slope[k][2];
    if (slope[k][2] != 0.025) p->face[0] = 0.05 * s, p->face[1] = 0.05 * c; /* cells that are cut */
  }
  upper.point[8].own = 0.0336; /* a corner of a cell is left of its part */
  close_body(&upper);
  close_body(&lower);
  for (const SurfacePoint *p = upper.point; p < upper.point + upper.surface.n; ++p)
    if (surface_meet(&upper.surface, p, &lower.surface, 0.1, &pair))
      assert_true(PetscAbsReal(pair.normal[0] - s) < 1e-3 && PetscAbsReal(pair.normal[1] - c) < 1e-3);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_planes), cmocka_unit_test(test_corner), cmocka_unit_test(test_circles),
    cmocka_unit_test(test_sunk),   cmocka_unit_test(test_edges),  cmocka_unit_test(test_cover),
    cmocka_unit_test(test_trough), cmocka_unit_test(test_cut),    cmocka_unit_test(test_tall_cells),
    cmocka_unit_test(test_front),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
