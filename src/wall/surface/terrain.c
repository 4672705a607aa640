/* Triangles of the solid below terrain. */
#include <math.h>
#include "case/terrain/relief.h"
#include "wall/surface/triangles.h"

typedef PetscReal Corners[3][3];

static void post(const Relief *r, PetscInt i, PetscInt j, PetscReal x[3])
{
  x[0] = r->low[0] + (PetscReal)i * r->step;
  x[1] = r->low[1] + (PetscReal)j * r->step;
  x[2] = relief_post(r, i, j);
}

/* Two for each square, seen from above counter-clockwise, cut as case/terrain/relief.h says. */
static Corners *add_top(const Relief *r, Corners *t)
{
  for (PetscInt j = 0; j + 1 < r->n[1]; ++j)
    for (PetscInt i = 0; i + 1 < r->n[0]; ++i, t += 2) {
      post(r, i, j, t[0][0]), post(r, i + 1, j, t[0][1]), post(r, i + 1, j + 1, t[0][2]);
      post(r, i, j, t[1][0]), post(r, i + 1, j + 1, t[1][1]), post(r, i, j + 1, t[1][2]);
    }
  return t;
}

/* Between two neighbours on the rim, counter-clockwise from above: the side below them, and their share of
 * the bottom. */
static Corners *add_side(const Relief *r, const PetscInt from[2], const PetscInt to[2], Corners *t)
{
  PetscReal x[4][3], middle[3];
  post(r, from[0], from[1], x[0]), post(r, to[0], to[1], x[1]);
  for (int d = 0; d < 3; ++d) {
    x[2][d] = d < 2 ? x[1][d] : r->bottom;
    x[3][d] = d < 2 ? x[0][d] : r->bottom;
    middle[d] = d < 2 ? r->low[d] + (PetscReal)(r->n[d] - 1) * r->step / 2 : r->bottom;
  }
  for (int d = 0; d < 3; ++d) {
    t[0][0][d] = x[0][d], t[0][1][d] = x[3][d], t[0][2][d] = x[2][d];
    t[1][0][d] = x[0][d], t[1][1][d] = x[2][d], t[1][2][d] = x[1][d];
    t[2][0][d] = x[3][d], t[2][1][d] = middle[d], t[2][2][d] = x[2][d];
  }
  return t + 3;
}

static void add_rim(const Relief *r, Corners *t)
{
  const PetscInt corner[4][2] = {{0, 0}, {r->n[0] - 1, 0}, {r->n[0] - 1, r->n[1] - 1}, {0, r->n[1] - 1}};
  static const PetscInt way[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  for (int side = 0; side < 4; ++side)
    for (PetscInt k = 0; k + 1 < r->n[side % 2]; ++k) {
      PetscInt at[2][2];
      for (int e = 0; e < 2; ++e)
        for (int d = 0; d < 2; ++d) at[e][d] = corner[side][d] + (k + e) * way[side][d];
      t = add_side(r, at[0], at[1], t);
    }
}

PetscErrorCode TerrainTriangles(const Relief *r, Triangles *t, size_t size, char *message)
{
  const PetscInt squares = (r->n[0] - 1) * (r->n[1] - 1), rim = 2 * (r->n[0] + r->n[1] - 2);

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->n[0] * r->n[1]; ++i) {
    if (!isnan(r->height[i])) continue;
    PetscReal x[3];
    post(r, i % r->n[0], i / r->n[0], x);
    (void)snprintf(message, size, "terrain that is a wall needs a height everywhere, and has none at (%g, %g)",
                   (double)x[0], (double)x[1]);
    PetscFunctionReturn(0);
  }
  PetscCall(TrianglesAllocate(2 * squares + 3 * rim, t));
  t->epsilon = PETSC_MACHINE_EPSILON; /* maps are far from their origin */
  add_rim(r, add_top(r, t->corner));
  PetscFunctionReturn(0);
}
