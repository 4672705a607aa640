/* The surface of a body in a cell that it cuts: in its midst, and along the sides of the cell. */
#include "points/seed/parts_private.h"

#define FLUSH 1e-5 /* of half a cell: the surface is there */
#define FLAT 1e-12 /* of the reference cell: a place on one of its sides */

/* Where the surface crosses the edges of a simplex, one after the other around it; returns how many. */
static PetscInt crossings(const Measure *m, const Simplex *s, PetscReal at[4][3])
{
  PetscInt n = 0;
  PetscReal xi[3];
  for (PetscInt i = 0, turn = 0; i <= m->dim; ++i) {
    if (!s->inside[i]) continue;
    for (PetscInt k = 0; k <= m->dim; ++k) {
      const PetscInt j = turn ? m->dim - k : k; /* back and forth: a quadrilateral's corners follow each other */
      if (s->inside[j]) continue;
      measure_cross(m, s->xi[i], s->xi[j], xi);
      measure_place(m, xi, at[n++]);
    }
    turn = !turn;
  }
  return n;
}

/* Does the surface go through the middle of n places on it? Chips of simplices that hold an edge are inside. */
static PetscBool is_plane(const Measure *m, PetscInt n, PetscReal at[4][3], const PetscReal *area)
{
  PetscReal in[3] = {0}, out[3] = {0}, size = 0;
  for (PetscInt d = 0; d < m->dim; ++d) size += PetscSqr(area[d]);
  size = PetscSqrtReal(size);
  for (PetscInt d = 0; d < m->dim && size > 0; ++d) {
    PetscReal middle = 0;
    for (PetscInt i = 0; i < n; ++i) middle += at[i][d] / (PetscReal)n;
    in[d] = middle - FLUSH * m->half[d] * area[d] / size;
    out[d] = middle + FLUSH * m->half[d] * area[d] / size;
  }
  return (PetscBool)(size > 0 && shape_contains(m->shape, m->dim, in, 0) && !shape_contains(m->shape, m->dim, out, 0));
}

/* Does the body go on, as one that it sticks to, beyond the middle of n places on its surface? out: outwards. */
static PetscBool goes_on(const Measure *m, PetscInt n, PetscReal at[4][3], const PetscReal *out)
{
  PetscReal beyond[3] = {0}, square = 0;
  for (PetscInt d = 0; d < m->dim; ++d) square += PetscSqr(out[d]);
  for (PetscInt d = 0; d < m->dim && square > 0; ++d) {
    for (PetscInt i = 0; i < n; ++i) beyond[d] += at[i][d] / (PetscReal)n;
    beyond[d] += SEED_BEYOND * m->half[d] * out[d] / PetscSqrtReal(square);
  }
  return (PetscBool)(square > 0 && seed_is_held(m->seeding, beyond));
}

void measure_face(const Measure *m, const Simplex *s, Sum *sum)
{
  PetscReal at[4][3] = {{0}}, out[3] = {0, 0, 0}, area[3] = {0, 0, 0}, position[3], along = 0;
  const PetscInt n = crossings(m, s, at);
  for (PetscInt i = 0; i <= m->dim; ++i) {
    measure_place(m, s->xi[i], position);
    for (PetscInt d = 0; d < m->dim; ++d) out[d] += (s->inside[i] ? -1 : 1) * (position[d] - at[0][d]);
  }
  if (m->dim == 2) area[0] = at[1][1] - at[0][1], area[1] = at[0][0] - at[1][0];
  for (PetscInt k = 1; k + 1 < n && m->dim == 3; ++k)
    for (int d = 0; d < 3; ++d) {
      const int i = (d + 1) % 3, j = (d + 2) % 3;
      area[d] +=
        0.5 * ((at[k][i] - at[0][i]) * (at[k + 1][j] - at[0][j]) - (at[k][j] - at[0][j]) * (at[k + 1][i] - at[0][i]));
    }
  for (PetscInt d = 0; d < m->dim; ++d) along += area[d] * out[d];
  for (PetscInt d = 0; d < m->dim; ++d) area[d] *= along < 0 ? -1 : 1;
  if (goes_on(m, n, at, area)) return;
  for (PetscInt d = 0; d < m->dim; ++d) sum->face[d] += area[d];
  if (is_plane(m, n, at, area)) seed_add_plane(&sum->planes, m->dim, area);
}

/* Of a segment or triangle with the corners a, b (and c). */
static PetscReal size_of(PetscInt dim, const PetscReal *a, const PetscReal *b, const PetscReal *c)
{
  PetscReal e[3] = {0}, f[3] = {0, 0, 2}, square = 0;
  for (PetscInt d = 0; d < dim; ++d) e[d] = b[d] - a[d], f[d] = dim == 3 ? c[d] - a[d] : f[d];
  for (int d = 0; d < 3; ++d)
    square += PetscSqr(0.5 * (e[(d + 1) % 3] * f[(d + 2) % 3] - e[(d + 2) % 3] * f[(d + 1) % 3]));
  return PetscSqrtReal(square);
}

/* How much of such a one, with these corners of a simplex, lies inside. */
static PetscReal size_inside(const Measure *m, const Simplex *s, const PetscInt *corner)
{
  PetscReal at[3][3] = {{0}};
  PetscInt n = 0, alone = 0;
  for (PetscInt i = 0; i < m->dim; ++i) n += s->inside[corner[i]] ? 1 : 0;
  const PetscReal all =
    size_of(m->dim, s->xi[corner[0]], s->xi[corner[1]], m->dim == 3 ? s->xi[corner[2]] : s->xi[corner[1]]);
  if (n == 0 || n == m->dim) return n ? all : 0;
  const PetscBool one = (PetscBool)(n == 1);
  while (s->inside[corner[alone]] != one) ++alone;
  for (PetscInt i = 0; i < m->dim; ++i) {
    const PetscReal *a = s->xi[corner[alone]], *b = s->xi[corner[i]];
    if (i == alone)
      for (PetscInt d = 0; d < m->dim; ++d) at[i][d] = a[d];
    else measure_cross(m, one ? a : b, one ? b : a, at[i]);
  }
  const PetscReal cut = size_of(m->dim, at[0], at[1], at[m->dim - 1]);
  return one ? cut : all - cut;
}

/* Is the side of the simplex without its corner `without` along side k of the cell? Its corners. */
static PetscBool is_along(const Measure *m, const Simplex *s, PetscInt without, PetscInt k, PetscInt *corner)
{
  PetscInt n = 0;
  for (PetscInt i = 0; i <= m->dim; ++i) {
    PetscReal away = -m->place[k];
    if (i == without) continue;
    for (PetscInt d = 0; d < m->dim; ++d) away += m->normal[k][d] * s->xi[i][d];
    if (PetscAbsReal(away) > FLAT) return PETSC_FALSE;
    corner[n++] = i;
  }
  return PETSC_TRUE;
}

void measure_sides(const Measure *m, const Simplex *s, PetscReal *side)
{
  PetscReal at[4][3] = {{0}};
  PetscInt corner[3];
  for (PetscInt k = 0; k < cells[m->type].faces; ++k)
    for (PetscInt without = 0; without <= m->dim; ++without) {
      if (!is_along(m, s, without, k, corner)) continue;
      for (PetscInt i = 0; i < m->dim; ++i) measure_place(m, s->xi[corner[i]], at[i]);
      if (!goes_on(m, m->dim, at, m->out[k])) side[k] += size_inside(m, s, corner) / m->size[k];
    }
}

void measure_begin_sides(Measure *m)
{
  const Cell *cell = cells + m->type;
  PetscReal x[CELL_MAX_NODES * 3] = {0}, area[3];
  for (PetscInt i = 0; i < cell->nodes; ++i)
    for (PetscInt d = 0; d < m->dim; ++d) x[i * m->dim + d] = cell->reference[i][d];
  for (PetscInt k = 0; k < cell->faces; ++k) {
    cell_side_area(m->type, k, m->x, m->out[k]);
    cell_side_area(m->type, k, x, area);
    m->size[k] = PetscSqrtReal(area[0] * area[0] + area[1] * area[1] + area[2] * area[2]);
    m->place[k] = 0;
    for (PetscInt d = 0; d < m->dim; ++d) {
      m->normal[k][d] = area[d] / m->size[k];
      m->place[k] += m->normal[k][d] * x[cell->face[k][0] * m->dim + d];
    }
  }
}
