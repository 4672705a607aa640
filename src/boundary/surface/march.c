/* A surface in a cell: simplices are halved until it is flat in them. */
#include "boundary/surface/surface.h"

/* Edges of the last simplices, of the radius of what is round: chords leave out 2e-7 of a circle, 3e-5 of a ball. Parts
 * of a cell are halved no more often than so many times along each axis. */
static const PetscReal flat[4] = {0, 0, 0.002, 0.02};
static const PetscInt most[4] = {0, 0, 8, 4};
#define CROSSINGS 60

typedef struct {
  const Trim *trim;
  const Surface *surface;
  PetscInt dim, depth;
  PetscReal slack;
  PieceSum *sum;
} March;

typedef struct {
  PetscReal x[4][3], f[4];
} Simplex;

/* < 0 inside: the surface drawn in. */
static PetscReal inside_by(const March *m, const PetscReal *x)
{
  PetscReal gradient[3];
  return surface_distance(m->surface, m->dim, x, gradient) + m->slack;
}

/* Where the surface crosses an edge from a, inside, to b, outside; drawn out again. By regula falsi, with the value at
 * an end that stays halved. */
static void cross(const March *m, const Simplex *s, PetscInt a, PetscInt b, PetscReal *at)
{
  PetscReal low = 0, high = 1, f_low = s->f[a], f_high = s->f[b], normal[3];
  for (int k = 0, last = 0; k < CROSSINGS; ++k) {
    const PetscReal t = low + (high - low) * f_low / (f_low - f_high);
    for (PetscInt d = 0; d < 3; ++d) at[d] = (1 - t) * s->x[a][d] + t * s->x[b][d];
    const PetscReal f = m->surface->kind == SURFACE_PLANE ? 0 : inside_by(m, at);
    if (PetscAbsReal(f) <= m->slack) break;
    const int side = f < 0 ? -1 : 1;
    if (side < 0) low = t, f_low = f;
    else high = t, f_high = f;
    if (side == last && side < 0) f_high /= 2;
    if (side == last && side > 0) f_low /= 2;
    last = side;
  }
  (void)surface_distance(m->surface, m->dim, at, normal);
  for (PetscInt d = 0; d < 3; ++d) at[d] += m->slack * normal[d];
}

/* What a simplex has of the surface. In space that is a triangle, or where two corners lie inside two of them. */
static void cut(const March *m, const Simplex *s)
{
  PetscInt in[4], out[4], n_in = 0, n_out = 0;
  PetscReal at[4][3] = {{0}}, outward[3] = {0, 0, 0};
  for (PetscInt i = 0; i <= m->dim; ++i) {
    if (s->f[i] < 0) in[n_in++] = i;
    else out[n_out++] = i;
  }
  if (!n_in || !n_out) return;
  for (int d = 0; d < 3; ++d) {
    for (PetscInt i = 0; i < n_out; ++i) outward[d] += s->x[out[i]][d] / (PetscReal)n_out;
    for (PetscInt i = 0; i < n_in; ++i) outward[d] -= s->x[in[i]][d] / (PetscReal)n_in;
  }
  /* round the quadrilateral: ac, bc, bd, ad */
  static const int round[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const PetscBool four = (PetscBool)(n_in == 2 && n_out == 2);
  for (PetscInt k = 0; k < (four ? 4 : m->dim); ++k) {
    const PetscInt i = four ? round[k][0] : n_in == 1 ? 0 : k, j = four ? round[k][1] : n_in == 1 ? k : 0;
    cross(m, s, in[i], out[j], at[k]);
  }
  surface_trim(m->trim, at, outward, m->sum);
  if (!four) return;
  for (int d = 0; d < 3; ++d) at[1][d] = at[2][d], at[2][d] = at[3][d];
  surface_trim(m->trim, at, outward, m->sum);
}

/* The longest edge, and the distance of the corners from their middle at most. */
static PetscReal measure_edges(PetscInt dim, const Simplex *s, PetscInt edge[2])
{
  PetscReal longest = 0;
  for (PetscInt i = 0; i <= dim; ++i)
    for (PetscInt j = i + 1; j <= dim; ++j) {
      PetscReal square = 0;
      for (PetscInt d = 0; d < dim; ++d) square += PetscSqr(s->x[i][d] - s->x[j][d]);
      if (square > longest * (1 + 1e-9)) longest = square, edge[0] = i, edge[1] = j;
    }
  return PetscSqrtReal(longest);
}

static void march(const March *m, const Simplex *s, PetscInt depth)
{
  PetscInt edge[2] = {0, 1};
  Simplex half;
  if (depth == m->depth) {
    cut(m, s);
    return;
  }
  const PetscReal longest = measure_edges(m->dim, s, edge);
  PetscBool near = PETSC_FALSE;
  for (PetscInt i = 0; i <= m->dim; ++i)
    if (PetscAbsReal(s->f[i]) <= longest * m->surface->steepness) near = PETSC_TRUE;
  if (!near) return;
  for (int k = 0; k < 2; ++k) {
    half = *s;
    for (int d = 0; d < 3; ++d) half.x[edge[k]][d] = 0.5 * (s->x[edge[0]][d] + s->x[edge[1]][d]);
    half.f[edge[k]] = inside_by(m, half.x[edge[k]]);
    march(m, &half, depth + 1);
  }
}

/* Halvings until the surface is flat in the simplices of a cell; a simplex takes `dim` of them to be half as long. */
static PetscInt halvings(const Surface *surface, CellType type, const PetscReal *x)
{
  const PetscInt dim = cells[type].dim;
  PetscReal longest = 0;
  PetscInt k = 0;
  if (surface->kind == SURFACE_PLANE) return 0;
  if (surface->kind == SURFACE_RELIEF) return dim * most[dim];
  for (PetscInt i = 1; i < cells[type].nodes; ++i) {
    PetscReal square = 0;
    for (PetscInt d = 0; d < dim; ++d) square += PetscSqr(x[i * dim + d] - x[d]);
    longest = PetscMax(longest, PetscSqrtReal(square));
  }
  while (k < most[dim] && longest > flat[dim] * surface->radius) longest /= 2, ++k;
  return dim * k;
}

/* The node of a square or cube at a corner (0 or 1 along each axis). */
static PetscInt node_at(CellType type, const int corner[3])
{
  PetscInt node = 0;
  for (PetscInt i = 0; i < cells[type].nodes; ++i) {
    PetscBool here = PETSC_TRUE;
    for (PetscInt d = 0; d < cells[type].dim; ++d)
      if ((cells[type].reference[i][d] > 0) != (corner[d] > 0)) here = PETSC_FALSE;
    if (here) node = i;
  }
  return node;
}

/* Simplices of a cell: itself, or one for each order in which a way along the axes goes from corner to corner. */
void surface_march(const Trim *trim, CellType type, const PetscReal *x, PieceSum *sum)
{
  static const int order[6][3] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  const PetscInt dim = cells[type].dim, n = cells[type].nodes == dim + 1 ? 1 : dim == 2 ? 2 : 6;
  const Surface *surface = trim->body->surfaces + trim->k;
  const March m = {.trim = trim,
                   .surface = surface,
                   .dim = dim,
                   .depth = halvings(surface, type, x),
                   .slack = trim->body->slack,
                   .sum = sum};
  for (PetscInt k = 0; k < n; ++k) {
    Simplex s = {.f = {0}};
    int corner[3] = {0, 0, 0};
    for (PetscInt i = 0; i <= dim; ++i) {
      if (i && n > 1) corner[order[k][i - 1]] = 1;
      const PetscInt node = n > 1 ? node_at(type, corner) : i;
      for (PetscInt d = 0; d < dim; ++d) s.x[i][d] = x[node * dim + d];
      s.f[i] = inside_by(&m, s.x[i]);
    }
    march(&m, &s, 0);
  }
}
