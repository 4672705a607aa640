/* Cells that a body's surface cuts: each point stands for the part of its cell that is nearest
 * to it, as far as that lies in the shape. Cells are cut in halves until their simplices lie on
 * one side of the surface or are small; what that leaves of these is cut off by a plane. */
#include "points/seed/parts_private.h"

enum { LOOK = 5, LOOK_TETRAHEDRON = 8 }; /* samples along an axis: is the cell cut? */
#define WITHIN 1e-3                      /* of the cell: so far inside its sides a surface along them cuts nothing */

/* Halvings of a cell's simplices: so many before they are believed to lie on one side, the sides
 * of a square or cube then being eighths or quarters, and so many at most; halvings of an edge
 * that the surface crosses. */
static const PetscInt trusted[4] = {0, 0, 6, 6}, most[4] = {0, 0, 10, 9};
#define CROSSINGS 40

/* Ends of parts along an axis, where an odd number of points stands their middles, too: of six points at most in the
 * plane, four in space. */
#define MOST_LINES 11
#define MOST_CROSSINGS 343

static PetscBool is_simplex(CellType type) { return cells[type].nodes == cells[type].dim + 1; }

SeedFill seed_fill(const Seeding *s, PetscInt cell)
{
  const CellType type = grid_cell_type(s->source, cell);
  const PetscInt dim = s->source->dim, look = type == CELL_TETRAHEDRON ? LOOK_TETRAHEDRON : LOOK;
  const PetscInt n = dim == 2 ? look * look : look * look * look;
  PetscReal x[CELL_MAX_NODES * 3], xi[3], position[3];
  PetscInt inside = 0;
  SeedFill fill;
  grid_cell_x(s->source, cell, x);
  if (seed_box_fill(s, type, x, WITHIN, &fill)) return fill;
  for (PetscInt k = 0; k < n; ++k) {
    PetscReal left = 1;
    for (PetscInt d = 0, rest = k; d < dim; ++d, rest /= look) {
      const PetscReal u = WITHIN + (1 - 2 * WITHIN) * (PetscReal)(rest % look) / (PetscReal)(look - 1);
      xi[d] = is_simplex(type) ? u * left : 2 * u - 1;
      left *= 1 - u;
    }
    cell_position(type, x, xi, position);
    inside += shape_contains(&s->body->shape, dim, position, 0) ? 1 : 0;
  }
  return inside == n ? SEED_WHOLE : inside ? SEED_CUT : SEED_NONE;
}

static PetscInt nearest_of(const SeedRule *rule, PetscInt dim, const PetscReal *xi)
{
  PetscInt nearest = 0;
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt q = 0; q < rule->n; ++q) {
    PetscReal square = 0;
    for (PetscInt d = 0; d < dim; ++d) square += PetscSqr(xi[d] - rule->xi[q * dim + d]);
    if (square < least) least = square, nearest = q;
  }
  return nearest;
}

static PetscBool is_whole(const Measure *m, PetscInt q)
{
  return (PetscBool)(m->fine[q].volume >= (1 - SEED_NOTHING) * m->whole[q].volume);
}

/* Squares and cubes of a box need no shape functions: places are asked for by the thousand. */
static void look_whether_straight(Measure *m)
{
  const Cell *cell = cells + m->type;
  m->straight = PETSC_TRUE;
  for (PetscInt d = 0; d < m->dim; ++d) {
    PetscReal low = m->x[d], high = m->x[d];
    for (PetscInt I = 1; I < cell->nodes; ++I) {
      low = PetscMin(low, m->x[I * m->dim + d]);
      high = PetscMax(high, m->x[I * m->dim + d]);
    }
    m->middle[d] = 0.5 * (low + high);
    m->half[d] = 0.5 * (high - low);
  }
  for (PetscInt I = 0; I < cell->nodes; ++I)
    for (PetscInt d = 0; d < m->dim; ++d)
      m->straight &=
        PetscAbsReal(m->middle[d] + cell->reference[I][d] * m->half[d] - m->x[I * m->dim + d]) <= m->slack ? 1 : 0;
}

void measure_place(const Measure *m, const PetscReal *xi, PetscReal *position)
{
  for (PetscInt d = 0; m->straight && d < m->dim; ++d) position[d] = m->middle[d] + xi[d] * m->half[d];
  if (!m->straight) cell_position(m->type, m->x, xi, position);
}

/* det dx/dxi. */
static PetscReal stretch_at(const Measure *m, const PetscReal *xi)
{
  PetscReal position[3], product = 1;
  for (PetscInt d = 0; d < m->dim; ++d) product *= m->half[d];
  return m->straight ? product : PetscAbsReal(cell_map(m->type, m->x, xi, position));
}

static PetscBool is_inside(const Measure *m, const PetscReal *xi)
{
  PetscReal position[3];
  measure_place(m, xi, position);
  return shape_contains(m->shape, m->dim, position, m->slack);
}

static void centre_of(PetscInt dim, PetscReal corner[4][3], PetscReal centre[3])
{
  for (PetscInt d = 0; d < 3; ++d) centre[d] = 0;
  for (PetscInt d = 0; d < dim; ++d) {
    for (PetscInt i = 0; i <= dim; ++i) centre[d] += corner[i][d] / (PetscReal)(dim + 1);
  }
}

/* Adds a simplex, or takes it away: sign. */
static void add(const Measure *m, PetscReal corner[4][3], PetscReal sign, Sum *sum)
{
  PetscReal e[3][3] = {{0}, {0}, {0, 0, 1}}, centre[3] = {0, 0, 0};
  for (PetscInt k = 0; k < m->dim; ++k)
    for (PetscInt d = 0; d < m->dim; ++d) e[k][d] = corner[k + 1][d] - corner[0][d];
  const PetscReal det = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                        e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                        e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
  centre_of(m->dim, corner, centre);
  const PetscReal volume = sign * PetscAbsReal(det) / (m->dim == 2 ? 2 : 6) * stretch_at(m, centre);
  sum->volume += volume;
  for (PetscInt d = 0; d < m->dim; ++d) {
    PetscReal square = 0;
    for (PetscInt i = 0; i <= m->dim; ++i) square += PetscSqr(corner[i][d] - centre[d]);
    sum->moment[d] += volume * centre[d];
    sum->second[d] += volume * (PetscSqr(centre[d]) + square / (PetscReal)((m->dim + 1) * (m->dim + 2)));
  }
}

void measure_cross(const Measure *m, const PetscReal *inside, const PetscReal *outside, PetscReal *at)
{
  PetscReal low = 0, high = 1;
  for (int k = 0; k < CROSSINGS; ++k) {
    const PetscReal middle = 0.5 * (low + high);
    for (PetscInt d = 0; d < m->dim; ++d) at[d] = (1 - middle) * inside[d] + middle * outside[d];
    if (is_inside(m, at)) low = middle;
    else high = middle;
  }
}

/* The corner `at` of a simplex up to the surface: a simplex, too. */
static void corner_at(const Measure *m, const Simplex *s, PetscInt at, PetscReal corner[4][3])
{
  PetscInt n = 1;
  for (PetscInt d = 0; d < 3; ++d) corner[0][d] = s->xi[at][d];
  for (PetscInt i = 0; i <= m->dim; ++i) {
    if (i == at) continue;
    if (s->inside[at]) measure_cross(m, s->xi[at], s->xi[i], corner[n++]);
    else measure_cross(m, s->xi[i], s->xi[at], corner[n++]);
  }
}

/* Two corners a, b of a tetrahedron inside, c, d outside: a prism, three tetrahedra. */
static void add_prism(const Measure *m, const Simplex *s, Sum *sum)
{
  PetscReal corner[6][3] = {{0}}, piece[4][3]; /* a, ac, ad, b, bc, bd */
  static const int pieces[3][4] = {{0, 1, 2, 5}, {0, 1, 4, 5}, {0, 3, 4, 5}};
  PetscInt n = 0;
  for (PetscInt i = 0; i < 4; ++i) {
    if (!s->inside[i]) continue;
    for (int d = 0; d < 3; ++d) corner[n][d] = s->xi[i][d];
    ++n;
    for (PetscInt j = 0; j < 4; ++j)
      if (!s->inside[j]) measure_cross(m, s->xi[i], s->xi[j], corner[n++]);
  }
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 4; ++i)
      for (int d = 0; d < 3; ++d) piece[i][d] = corner[pieces[k][i]][d];
    add(m, piece, 1, sum);
  }
}

/* What of a simplex lies inside, its surface there taken as plane. */
static void add_inside(const Measure *m, Simplex *s, PetscInt n_inside, Sum *sum)
{
  PetscReal corner[4][3] = {{0}};
  if (n_inside == 2 && m->dim == 3) {
    add_prism(m, s, sum);
    return;
  }
  if (n_inside > 1) add(m, s->xi, 1, sum);
  if (n_inside > m->dim) return;
  const PetscBool one = (PetscBool)(n_inside == 1);
  PetscInt at = 0;
  while (s->inside[at] != one) ++at;
  corner_at(m, s, at, corner);
  add(m, corner, one ? 1 : -1, sum);
}

/* Halves a simplex at its longest edge. */
static void halve(const Measure *m, const Simplex *s, Simplex half[2])
{
  PetscReal longest = 0, middle[3] = {0, 0, 0};
  PetscInt edge[2] = {0, 1};
  for (PetscInt i = 0; i <= m->dim; ++i)
    for (PetscInt j = i + 1; j <= m->dim; ++j) {
      PetscReal square = 0;
      for (PetscInt d = 0; d < m->dim; ++d) square += PetscSqr(s->xi[i][d] - s->xi[j][d]);
      if (square > longest * (1 + 1e-9)) longest = square, edge[0] = i, edge[1] = j;
    }
  for (PetscInt d = 0; d < m->dim; ++d) middle[d] = 0.5 * (s->xi[edge[0]][d] + s->xi[edge[1]][d]);
  const PetscBool inside = is_inside(m, middle);
  for (int k = 0; k < 2; ++k) {
    half[k] = *s;
    for (int d = 0; d < 3; ++d) half[k].xi[edge[k]][d] = middle[d];
    half[k].inside[edge[k]] = inside;
  }
}

static void measure(Measure *m, Simplex *s, PetscInt depth)
{
  PetscInt n_inside = 0;
  PetscReal centre[3];
  Simplex half[2];
  for (PetscInt i = 0; i <= m->dim; ++i) n_inside += s->inside[i] ? 1 : 0;
  const PetscBool mixed = n_inside > 0 && n_inside <= m->dim;
  const PetscBool ends = depth == most[m->dim] || (depth >= trusted[m->dim] && !mixed);
  centre_of(m->dim, s->xi, centre);
  const PetscInt q = m->owner >= 0 ? m->owner : nearest_of(m->rule, m->dim, centre);
  if (n_inside && (ends ? depth <= most[m->dim] - m->dim : depth == most[m->dim] - m->dim))
    add_inside(m, s, n_inside, m->coarse + q);
  if (ends) {
    add(m, s->xi, 1, m->whole + q);
    if (n_inside) add_inside(m, s, n_inside, m->fine + q);
    if (mixed && m->faces) measure_face(m, s, m->fine + q);
    if (n_inside && m->faces) measure_sides(m, s, m->fine[q].side);
    return;
  }
  halve(m, s, half);
  for (int k = 0; k < 2; ++k) measure(m, half + k, depth + 1);
}

static void measure_simplex(Measure *m)
{
  Simplex s = {.xi = {{0}}};
  m->owner = -1;
  for (PetscInt i = 0; i <= m->dim; ++i) {
    if (i) s.xi[i][i - 1] = 1;
    s.inside[i] = is_inside(m, s.xi[i]);
  }
  measure(m, &s, 0);
}

/* Ends of the parts of a square or cube along an axis, one after the other; if these are odd their middles, too, so
 * that the cell's is among them. Returns how many lines there are. */
static PetscInt find_lines(const Measure *m, PetscReal line[MOST_LINES])
{
  PetscReal at[MOST_LINES], end[MOST_LINES];
  PetscInt n = 0;
  for (PetscInt q = 0; q < m->rule->n; ++q) {
    PetscInt k = n;
    while (k > 0 && at[k - 1] > m->rule->xi[q * m->dim] - SEED_NOTHING) --k;
    if (k < n && at[k] < m->rule->xi[q * m->dim] + SEED_NOTHING) continue;
    for (PetscInt i = n++; i > k; --i) at[i] = at[i - 1];
    at[k] = m->rule->xi[q * m->dim];
  }
  const PetscInt each = n % 2 ? 2 : 1;
  for (PetscInt k = 0; k <= n; ++k) end[k] = k == 0 ? -1 : k == n ? 1 : 0.5 * (at[k - 1] + at[k]);
  for (PetscInt k = 0; k < each * n; ++k)
    line[k] = k % each ? 0.5 * (end[k / each] + end[k / each + 1]) : end[k / each];
  line[each * n] = 1;
  return each * n + 1;
}

/* The places where lines cross. */
typedef struct {
  PetscInt n; /* lines along an axis */
  PetscReal line[MOST_LINES];
  PetscBool inside[MOST_CROSSINGS];
} Lattice;

static PetscInt crossing_at(const Measure *m, const Lattice *l, const PetscInt ijk[3], PetscReal *xi)
{
  for (PetscInt d = 0; d < m->dim; ++d) xi[d] = l->line[ijk[d]];
  return ijk[0] + l->n * (ijk[1] + (m->dim == 3 ? l->n * ijk[2] : 0));
}

/* The simplices of a box between lines, one for each order in which a way along the axes goes from the corner next to
 * the middle of the cell to the one across: those of its image in a mirror are their images. */
static void measure_box(Measure *m, const Lattice *l, const PetscInt box[3], PetscInt depth)
{
  static const int order[6][3] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  PetscReal middle[3];
  for (PetscInt d = 0; d < m->dim; ++d) middle[d] = 0.5 * (l->line[box[d]] + l->line[box[d] + 1]);
  m->owner = nearest_of(m->rule, m->dim, middle);
  for (PetscInt k = 0; k < (m->dim == 2 ? 2 : 6); ++k) {
    Simplex s = {.xi = {{0}}};
    PetscInt at[3] = {0};
    for (PetscInt d = 0; d < m->dim; ++d) at[d] = box[d] + (2 * box[d] + 1 < l->n ? 1 : 0);
    for (PetscInt i = 0; i <= m->dim; ++i) {
      if (i) at[order[k][i - 1]] += at[order[k][i - 1]] > box[order[k][i - 1]] ? -1 : 1;
      s.inside[i] = l->inside[crossing_at(m, l, at, s.xi[i])];
    }
    measure(m, &s, depth);
  }
}

/* Part by part: pieces that reach beyond the side of one would give its neighbours of it by the way in which the cell
 * was cut. */
static void measure_parts(Measure *m)
{
  Lattice l;
  PetscReal xi[3];
  PetscInt halved = 0, ijk[3] = {0, 0, 0};
  l.n = find_lines(m, l.line);
  const PetscInt n = l.n - 1, n_z = m->dim == 3 ? n : 0;
  for (ijk[2] = 0; ijk[2] <= n_z; ++ijk[2])
    for (ijk[1] = 0; ijk[1] <= n; ++ijk[1])
      for (ijk[0] = 0; ijk[0] <= n; ++ijk[0]) {
        const PetscInt k = crossing_at(m, &l, ijk, xi);
        l.inside[k] = is_inside(m, xi);
      }
  while (2 << halved <= n && (halved + 2) * m->dim <= most[m->dim]) ++halved;
  for (ijk[2] = 0; ijk[2] < PetscMax(1, n_z); ++ijk[2])
    for (ijk[1] = 0; ijk[1] < n; ++ijk[1])
      for (ijk[0] = 0; ijk[0] < n; ++ijk[0]) measure_box(m, &l, ijk, halved * m->dim);
}

/* What planes leave out goes with the square of their size: by how much the parts that are cut
 * grow in the limit (Richardson). Where parts meet coarse ones are not those of fine ones, but
 * their sums are. */
static PetscReal growth(const Measure *m)
{
  PetscReal cut = 0, more = 0;
  for (PetscInt q = 0; q < m->rule->n; ++q) {
    more += (m->fine[q].volume - m->coarse[q].volume) / 3;
    if (!is_whole(m, q)) cut += m->fine[q].volume;
  }
  return PetscAbsReal(more) < 0.1 * cut ? 1 + more / cut : 1;
}

/* Parts of any shape in any cell. */
static void measure_all(const Seeding *s, CellType type, const PetscReal *x, const SeedRule *rule, SeedPart *part)
{
  const PetscInt dim = s->source->dim;
  PetscReal whole = 0;
  Measure m = {.seeding = s, .rule = rule, .type = type, .dim = dim, .x = x, .faces = s->faces};
  m.shape = &s->body->shape;
  m.slack = 1e-10 * PetscPowReal(cell_volume(type, x), 1 / (PetscReal)dim);
  look_whether_straight(&m);
  measure_begin_sides(&m);
  if (is_simplex(type)) measure_simplex(&m);
  else measure_parts(&m);
  const PetscReal factor = growth(&m);
  for (PetscInt q = 0; q < rule->n; ++q) whole += m.whole[q].volume;
  for (PetscInt q = 0; q < rule->n; ++q) {
    const Sum *sum = m.fine + q;
    part[q] = (SeedPart){.share = (is_whole(&m, q) ? 1 : factor) * sum->volume / whole, .whole = is_whole(&m, q)};
    for (PetscInt d = 0; d < dim; ++d) part[q].face[d] = sum->face[d];
    part[q].planes = sum->planes;
    for (PetscInt k = 0; k < CELL_MOST_SIDES; ++k) part[q].side[k] = sum->side[k];
    for (PetscInt d = 0; d < dim && part[q].share >= SEED_NOTHING; ++d) {
      part[q].xi[d] = sum->moment[d] / sum->volume;
      part[q].spread[d] = PetscMax(0, sum->second[d] / sum->volume - PetscSqr(part[q].xi[d]));
    }
  }
}

SeedFill seed_parts(const Seeding *s, PetscInt cell, const SeedRule *rule, SeedPart *part)
{
  const CellType type = grid_cell_type(s->source, cell);
  PetscReal x[CELL_MAX_NODES * 3], inside = 0;
  grid_cell_x(s->source, cell, x);
  if (!seed_box_parts(s, type, x, rule, part)) measure_all(s, type, x, rule, part);
  for (PetscInt q = 0; q < rule->n; ++q) {
    if (part[q].share < SEED_NOTHING) part[q].share = 0;
    inside += part[q].share;
  }
  seed_hand_on_faces(part, rule, s->source->dim);
  /* between bodies that rub a thin part would bear what its neighbours should */
  seed_join_slivers(part, rule->n, s->source->dim, (PetscBool)(s->c->n_walls && !s->c->n_interfaces));
  return inside <= 0 ? SEED_NONE : inside >= 1 - SEED_NOTHING ? SEED_WHOLE : SEED_CUT;
}
