#include "wall/facets/facets.h"
#include "base/math/vector.h"
#include <math.h>

/* The nearest position of a facet: in its face, or on corner 0 1 2 or on edge 3 + (0 1 2). It is known by the way from
 * there to x, a sum of differences: far from the origin (maps have 5e6 m) a place of its own would be rounded to
 * 1e-9 m, and each facet's gaps to another one. */
typedef struct {
  PetscReal square, way[3];
  PetscInt facet;
  int feature;
} Foot;
enum { FACE = -1, EDGE = 3 };

#define STRAIGHT 1e-12 /* sine squared between a way and the normal that it follows */

typedef struct {
  const Facets *facets;
  const PetscReal *x;
  Foot nearest;
} Probe;

static inline void difference(const PetscReal a[3], const PetscReal b[3], PetscReal c[3])
{
  for (int d = 0; d < 3; ++d) c[d] = a[d] - b[d];
}

static void foot_on_segment(const PetscReal corner[3][3], const PetscReal x[3], Foot *foot)
{
  PetscReal e[3], v[3];
  difference(corner[1], corner[0], e);
  difference(x, corner[0], v);
  const PetscReal s = vector_dot(v, e) / vector_dot(e, e);
  foot->feature = s <= 0 ? 0 : s >= 1 ? 1 : FACE;
  if (s >= 1) difference(x, corner[1], foot->way);
  for (int d = 0; d < 3 && s < 1; ++d) foot->way[d] = s <= 0 ? v[d] : v[d] - s * e[d];
}

/* In which of the seven regions around a triangle x is, and the nearest position as weights of the
 * corners (Ericson, Real-Time Collision Detection, 5.1.5). */
static int nearest_weights(const PetscReal corner[3][3], const PetscReal x[3], PetscReal w[3])
{
  PetscReal ab[3], ac[3], v[3];
  difference(corner[1], corner[0], ab);
  difference(corner[2], corner[0], ac);
  difference(x, corner[0], v);
  const PetscReal a1 = vector_dot(ab, v), a2 = vector_dot(ac, v);
  w[0] = w[1] = w[2] = 0;
  if (a1 <= 0 && a2 <= 0) return w[0] = 1, 0;
  difference(x, corner[1], v);
  const PetscReal b1 = vector_dot(ab, v), b2 = vector_dot(ac, v);
  if (b1 >= 0 && b2 <= b1) return w[1] = 1, 1;
  const PetscReal vc = a1 * b2 - b1 * a2;
  if (vc <= 0 && a1 >= 0 && b1 <= 0) return w[1] = a1 / (a1 - b1), w[0] = 1 - w[1], EDGE;
  difference(x, corner[2], v);
  const PetscReal c1 = vector_dot(ab, v), c2 = vector_dot(ac, v);
  if (c2 >= 0 && c1 <= c2) return w[2] = 1, 2;
  const PetscReal vb = c1 * a2 - a1 * c2;
  if (vb <= 0 && a2 >= 0 && c2 <= 0) return w[2] = a2 / (a2 - c2), w[0] = 1 - w[2], EDGE + 2;
  const PetscReal va = b1 * c2 - c1 * b2, to_c = b2 - b1, to_b = c1 - c2;
  if (va <= 0 && to_c >= 0 && to_b >= 0) return w[2] = to_c / (to_c + to_b), w[1] = 1 - w[2], EDGE + 1;
  w[1] = vb / (va + vb + vc), w[2] = vc / (va + vb + vc), w[0] = 1 - w[1] - w[2];
  return FACE;
}

static void foot_on_triangle(const PetscReal corner[3][3], const PetscReal x[3], Foot *foot)
{
  PetscReal w[3];
  foot->feature = nearest_weights(corner, x, w);
  const PetscReal *origin = corner[w[1] == 1 ? 1 : w[2] == 1 ? 2 : 0];
  for (int d = 0; d < 3; ++d) {
    foot->way[d] = x[d] - origin[d];
    for (int k = 0; k < 3; ++k) foot->way[d] -= w[k] * (corner[k][d] - origin[d]);
  }
}

/* Squared distance of x from facet i, which is kept if it is the least. */
static PetscReal probe_facet(void *context, PetscInt i)
{
  Probe *probe = context;
  const Facets *f = probe->facets;
  Foot foot = {.facet = i};
  if (f->dim == 2) foot_on_segment((const PetscReal(*)[3])f->corner[i], probe->x, &foot);
  else foot_on_triangle((const PetscReal(*)[3])f->corner[i], probe->x, &foot);
  foot.square = vector_dot(foot.way, foot.way);
  if (foot.square < probe->nearest.square) probe->nearest = foot;
  return foot.square;
}

static const PetscReal *feature_normal(const Facets *f, const Foot *foot)
{
  if (foot->feature == FACE) return f->normal[foot->facet];
  if (foot->feature < EDGE) return f->vertex_normal[f->vertex[foot->facet][foot->feature]];
  return f->edge_normal[f->edge[foot->facet][foot->feature - EDGE]];
}

static Nearness nearness(const Facets *f, const Foot *foot)
{
  const PetscReal *n = feature_normal(f, foot);
  if (foot->feature == FACE) return NEAR;
  if (foot->feature < EDGE ? !f->vertex_rim[f->vertex[foot->facet][foot->feature]]
                           : !f->edge_rim[f->edge[foot->facet][foot->feature - EDGE]])
    return NEAR;
  return PetscSqr(vector_dot(foot->way, n)) > PetscSqr(RIM_COSINE) * foot->square ? NEAR_OVER_RIM : NEAR_RIM;
}

/* The distance from a corner has the Hessian (1 - n n) / r, from an edge along t
 * (1 - n n - t t) / r; in the plane 1 has two axes. */
static void curve(const Facets *f, const Foot *foot, WallPlace *place)
{
  const PetscReal *n = place->normal;
  PetscReal t[3] = {0, 0, 0};
  if (foot->feature >= EDGE) {
    const PetscReal(*corner)[3] = (const PetscReal(*)[3])f->corner[foot->facet];
    const int k = foot->feature - EDGE;
    difference(corner[(k + 1) % 3], corner[k], t);
    const PetscReal length = PetscSqrtReal(vector_dot(t, t));
    for (int d = 0; d < 3; ++d) t[d] /= length;
  }
  for (int i = 0; i < f->dim; ++i)
    for (int j = 0; j < f->dim; ++j) place->curvature[3 * i + j] = ((i == j) - n[i] * n[j] - t[i] * t[j]) / place->gap;
}

static void describe(const Facets *f, const Foot *foot, WallPlace *place)
{
  const PetscReal *normal = feature_normal(f, foot);
  const PetscReal along = vector_dot(foot->way, normal), distance = PetscSqrtReal(foot->square);
  *place = (WallPlace){.gap = along < 0 ? -distance : distance};
  /* On the feature itself, where its distance has no direction, and in a face. */
  const PetscBool flat = foot->feature == FACE || distance <= 1e-12 * (f->bounds[3] - f->bounds[0] + f->bounds[4] -
                                                                       f->bounds[1] + f->bounds[5] - f->bounds[2]);
  for (int d = 0; d < 3; ++d) place->normal[d] = flat ? normal[d] : foot->way[d] / place->gap;
  if (flat && foot->feature == FACE) place->gap = along;
  if (!flat) curve(f, foot, place);
}

Nearness facets_search(const Facets *f, const PetscReal x[3], PetscReal least, WallPlace *place)
{
  const PetscReal within = least < 1e150 ? least * least : PETSC_MAX_REAL;
  Probe probe = {.facets = f, .x = x, .nearest = {.square = within, .facet = -1}};
  box_tree_nearest(f->tree, x, within, probe_facet, &probe);
  if (probe.nearest.facet < 0) return NEAR_NOT;
  describe(f, &probe.nearest, place);
  return nearness(f, &probe.nearest);
}

/* Is x so far away that flip times the distance exceeds `high`? Else no facet need be looked for
 * farther than `least`. */
static PetscBool is_far(const Facets *f, const PetscReal x[3], int flip, PetscBool thin, PetscReal high,
                        PetscReal *least)
{
  PetscReal gap, away;
  *least = thin ? high : PETSC_MAX_REAL;
  if ((thin || flip > 0) && high < 1e150) {
    const PetscReal square = box_squared_distance(f->bounds, x);
    if (high < 0 ? square > 0 : square > high * high) return PETSC_TRUE;
    if (square > 0) *least = high;
  }
  if (!f->far || !far_field_at(f->far, x, &gap, &away)) return PETSC_FALSE;
  const PetscReal size = PetscAbsReal(gap), sure = size - away;
  const PetscBool outside = thin || flip * gap > 0;
  if (sure > 0 && outside && sure > high) return PETSC_TRUE;
  *least = PetscMin(*least, size + away);
  if (sure > 0 && outside) *least = PetscMin(*least, high);
  return PETSC_FALSE;
}

Nearness facets_near(const Facets *f, const PetscReal x[3], int flip, PetscBool thin, PetscReal high, WallPlace *place)
{
  WallPlace found;
  PetscReal least;
  if (is_far(f, x, flip, thin, high, &least)) return NEAR_NOT;
  /* what lies just at the limit counts, too */
  const Nearness near = facets_search(f, x, least < 1e150 ? least * (1 + 1e-12) : least, &found);
  if (near == NEAR_NOT || (thin ? PetscAbsReal(found.gap) : flip * found.gap) > high) return NEAR_NOT;
  *place = found;
  if (flip > 0) return near;
  place->gap = -found.gap;
  for (int d = 0; d < 3; ++d) place->normal[d] = -found.normal[d];
  for (int k = 0; k < 9; ++k) place->curvature[k] = -found.curvature[k];
  return near;
}

typedef struct {
  Probe probe;
  int flip;
  PetscReal within;
  WallSides *sides;
} Gathering;

/* A facet that x stands straight before is a side, on its edge, too; nothing is narrowed by it. Most are like a nearer
 * one. */
static PetscReal gather_facet(void *context, PetscInt i)
{
  Gathering *all = context;
  const Facets *f = all->probe.facets;
  PetscReal v[3];
  WallPlace place = {.gap = 0};
  difference(all->probe.x, f->corner[i][0], v);
  place.gap = all->flip * vector_dot(v, f->normal[i]);
  for (int d = 0; d < 3; ++d) place.normal[d] = all->flip * f->normal[i][d];
  if (place.gap <= 0 || place.gap > all->within || sides_have(all->sides, &place)) return PETSC_MAX_REAL;
  all->probe.nearest.square = PETSC_MAX_REAL;
  const PetscReal square = probe_facet(&all->probe, i);
  if (square - PetscSqr(place.gap) <= STRAIGHT * square) sides_add(all->sides, &place);
  return PETSC_MAX_REAL;
}

void facets_sides(const Facets *f, const PetscReal x[3], int flip, PetscReal high, WallSides *sides)
{
  const PetscReal square = high < 1e150 ? high * high * (1 + 1e-12) : PETSC_MAX_REAL;
  Gathering all = {.probe = {.facets = f, .x = x}, .flip = flip, .within = high, .sides = sides};
  box_tree_nearest(f->tree, x, square, gather_facet, &all);
}
