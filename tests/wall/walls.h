/* Cases of one wall, and positions that look random but are the same everywhere. */
#pragma once
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>
#include "wall/wall.h"

#define ASSERT_NEAR(a, b, tolerance) assert_near(#a, a, b, tolerance)

static inline void assert_near(const char *what, double a, double b, double tolerance)
{
  if (!(fabs(a - b) <= tolerance)) fail_msg("%s = %.15g, not %.15g within %g", what, a, b, tolerance);
}

typedef struct {
  Case c;
  WallSpec spec;
  Diag *diag;
  Walls *walls;
} OneWall;

static inline void wall_open(OneWall *one, const Kinematics *kinematics, WallSpec spec)
{
  *one = (OneWall){.c = {.kinematics = kinematics, .grid = {.kind = GRID_MESH}, .n_walls = 1}, .spec = spec};
  one->c.walls = &one->spec;
  one->c.analysis.type = ANALYSIS_DYNAMIC;
  assert_int_equal(DiagCreate(&one->diag), 0);
  assert_int_equal(WallsCreate(&one->c, one->diag, &one->walls), 0);
}

static inline void wall_close(OneWall *one)
{
  assert_int_equal(WallsDestroy(&one->walls), 0);
  assert_int_equal(DiagDestroy(&one->diag), 0);
}

/* In [0, 1). */
static inline double uniform(void)
{
  static uint64_t state = 88172645463325252u;
  state ^= state << 13, state ^= state >> 7, state ^= state << 17;
  return (double)(state >> 11) / 9007199254740992.0;
}

static inline void random_in(int dim, double low, double high, double x[3])
{
  for (int d = 0; d < 3; ++d) x[d] = d < dim ? low + (high - low) * uniform() : 0;
}
