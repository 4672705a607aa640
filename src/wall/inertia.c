/* Volume, centre and moments of inertia of a wall's shape: integrals over what it encloses, made into
 * integrals over its surface, which are exact for corners, triangles and sections. */
#include "wall/wall_private.h"
#include <math.h>
#include <string.h>
#include "base/math/tensor.h"

/* Volume, and of density 1: integrals of x and of x x^T about a place of the shape's own. About the origin of a map
 * what is small would be a difference of what is large. */
typedef struct {
  PetscReal about[3], volume, first[3], second[9];
} Moments;

/* Sum into m what the simplex of that place and `corners` corners, seen from there, holds, of volume v. */
static void add_simplex(int corners, const PetscReal (*x)[3], PetscReal v, Moments *m)
{
  const PetscReal n = corners + 1;
  PetscReal sum[3] = {0, 0, 0};
  for (int k = 0; k < corners; ++k)
    for (int d = 0; d < 3; ++d) sum[d] += x[k][d];
  m->volume += v;
  for (int d = 0; d < 3; ++d) m->first[d] += v * sum[d] / n;
  for (int i = 0; i < 9; ++i) {
    PetscReal own = sum[i / 3] * sum[i % 3];
    for (int k = 0; k < corners; ++k) own += x[k][i / 3] * x[k][i % 3];
    m->second[i] += v * own / (n * (n + 1));
  }
}

/* Closed facets, their normals outwards. */
static void of_facets(const Facets *f, Moments *m)
{
  for (PetscInt d = 0; d < f->dim && f->n; ++d) m->about[d] = f->corner[0][0][d];
  for (PetscInt i = 0; i < f->n; ++i) {
    PetscReal x[3][3] = {{0}}, along = 0, area[3];
    for (PetscInt k = 0; k < f->dim; ++k)
      for (PetscInt d = 0; d < f->dim; ++d) x[k][d] = f->corner[i][k][d] - m->about[d];
    if (f->dim == 2) {
      const PetscReal side = hypot(x[1][0] - x[0][0], x[1][1] - x[0][1]);
      for (int d = 0; d < 2; ++d) along += x[0][d] * f->normal[i][d];
      add_simplex(2, (const PetscReal(*)[3])x, along * side / 2, m);
      continue;
    }
    for (int d = 0; d < 3; ++d) {
      const int j = (d + 1) % 3, k = (d + 2) % 3;
      area[d] = (x[1][j] - x[0][j]) * (x[2][k] - x[0][k]) - (x[1][k] - x[0][k]) * (x[2][j] - x[0][j]);
      along += area[d] * x[0][d];
    }
    add_simplex(3, (const PetscReal(*)[3])x, along / 6, m);
  }
}

/* Sections (radius, height) turned about the axis, of which x = height along direction + base. Integrals over
 * the circle are those of r^2, r^2 z, r^2 z^2 and r^4 along the section's edges, for which three places suffice. */
static void of_section(const Form *f, Moments *m)
{
  static const PetscReal place[] = {0.1127016653792583, 0.5, 0.8872983346207417},
                         weight[] = {5. / 18, 8. / 18, 5. / 18};
  PetscReal along[3] = {0, 0, 0}, across = 0;
  for (PetscInt i = 0; i < f->facets->n; ++i) {
    const PetscReal(*x)[3] = (const PetscReal(*)[3])f->facets->corner[i];
    const PetscReal side = hypot(x[1][0] - x[0][0], x[1][1] - x[0][1]);
    for (int k = 0; k < 3; ++k) {
      const PetscReal r = x[0][0] + place[k] * (x[1][0] - x[0][0]), z = x[0][1] + place[k] * (x[1][1] - x[0][1]);
      const PetscReal dr = weight[k] * side * f->facets->normal[i][0]; /* outwards along the radius, times the edge */
      for (int power = 0; power < 3; ++power) along[power] += PETSC_PI * r * r * PetscPowRealInt(z, power) * dr;
      across += PETSC_PI / 4 * r * r * r * r * dr;
    }
  }
  const PetscReal *a = f->direction;
  m->volume += along[0];
  for (int d = 0; d < 3; ++d) m->about[d] = f->base[d], m->first[d] += along[1] * a[d];
  for (int i = 0; i < 9; ++i) {
    const int d = i / 3, e = i % 3;
    m->second[i] += across * ((d == e) - a[d] * a[e]) + along[2] * a[d] * a[e];
  }
}

static void of_box(const Form *f, Moments *m)
{
  m->volume = 1;
  for (PetscInt d = 0; d < f->dim; ++d) {
    m->volume *= f->shape->max[d] - f->shape->min[d];
    m->about[d] = (f->shape->max[d] + f->shape->min[d]) / 2;
  }
  for (PetscInt d = 0; d < f->dim; ++d)
    m->second[4 * d] = m->volume * PetscSqr(f->shape->max[d] - f->shape->min[d]) / 12;
}

static void of_ball(const Form *f, Moments *m)
{
  const PetscReal r = f->shape->radius;
  m->volume = f->dim == 2 ? PETSC_PI * r * r : 4. / 3 * PETSC_PI * r * r * r;
  for (int d = 0; d < f->dim; ++d) {
    m->about[d] = f->shape->centre[d];
    m->second[4 * d] = m->volume * r * r / (f->dim + 2);
  }
}

/* In axisymmetry: the whole ring, and its centre on the axis. */
static void of_ring(const Form *f, Moments *m)
{
  const Shape *s = f->shape;
  const PetscReal r = s->radius, *a = s->min, *b = s->max;
  if (s->kind == SHAPE_BALL) {
    const PetscBool whole = fabs(s->centre[0]) < 1e-9 * r;
    m->volume = whole ? 4. / 3 * PETSC_PI * r * r * r : 2 * PETSC_PI * PETSC_PI * s->centre[0] * r * r;
    m->first[1] = m->volume * s->centre[1];
  } else if (s->kind == SHAPE_BOX) {
    m->volume = PETSC_PI * (b[0] * b[0] - a[0] * a[0]) * (b[1] - a[1]);
    m->first[1] = m->volume * (a[1] + b[1]) / 2;
  } else {
    Form section = *f;
    section.direction[1] = 1;
    of_section(&section, m);
  }
}

static PetscBool moments_of(const Form *f, Moments *m)
{
  const ShapeKind kind = f->shape->kind;
  *m = (Moments){0};
  if (f->thin || f->n || kind == SHAPE_HALF_SPACE || kind == SHAPE_TERRAIN) return PETSC_FALSE;
  if (f->axis) of_ring(f, m);
  else if (kind == SHAPE_BOX) of_box(f, m);
  else if (kind == SHAPE_BALL) of_ball(f, m);
  else if (form_is_flat(f)) of_facets(f->facets, m);
  else of_section(f, m);
  return m->volume > 0;
}

PetscBool wall_volume(const Walls *walls, PetscInt k, WallInertia *inertia)
{
  const Form *f = walls->wall[k].form;
  Moments m;
  *inertia = (WallInertia){0};
  if (!f || walls->wall[k].spec->inside || !moments_of(f, &m)) return PETSC_FALSE;
  inertia->mass = m.volume;
  for (int d = 0; d < 3; ++d) inertia->centre[d] = m.about[d] + m.first[d] / m.volume;
  if (f->axis) return PETSC_TRUE; /* which does not turn */
  for (int i = 0; i < 9; ++i) m.second[i] -= m.first[i / 3] * m.first[i % 3] / m.volume;
  const PetscReal trace = m.second[0] + m.second[4] + m.second[8];
  for (int i = 0; i < 9; ++i) inertia->inertia[i] = (i % 4 ? 0 : trace) - m.second[i];
  return PETSC_TRUE;
}

/* Does anybody ask where the centre of mass is? What only goes along needs none. */
static PetscBool needs_centre(const Case *c, const WallSpec *w)
{
  for (const MeasureSpec *s = c->measures; s < c->measures + c->n_measures; ++s)
    if (!strcmp(s->kind, "wall_position") && s->wall && !strcmp(s->wall, w->name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void lacks(const WallSpec *w, PetscInt k, const char *what, Diag *diag)
{
  char path[64];
  snprintf(path, sizeof path, "walls[%d].mass", (int)k);
  diag_error(diag, path, "the %s of wall '%s' cannot be computed from its shape", what, w->name);
  diag_hint(diag, w->mass.has_density ? "give mass: {mass: .., centre: .., inertia: ..}, or a shape with a volume: "
                                        "box, circle, polygon, sphere, cylinder, cone, closed surface"
                  : !w->mass.free[3]  ? "give `centre`: `wall_position` is where that goes"
                                      : "give `centre` and `inertia`, or leave rotation out of `free`");
}

void wall_inertia(const Walls *walls, PetscInt k, Diag *diag, WallInertia *inertia)
{
  const WallSpec *w = walls->c->walls + k;
  const PetscBool known = wall_volume(walls, k, inertia);
  if (!walls->wall[k].form) return; /* told already */
  if (!known && w->mass.has_density) lacks(w, k, "volume", diag);
  else if (!known && w->mass.free[3] && !(w->mass.has_inertia && w->mass.has_centre)) lacks(w, k, "inertia", diag);
  else if (!known && !w->mass.has_centre && needs_centre(walls->c, w)) lacks(w, k, "centre of mass", diag);
  const PetscReal density = w->mass.has_density ? w->mass.density : known ? w->mass.total / inertia->mass : 0;
  inertia->mass = w->mass.has_density ? density * inertia->mass : w->mass.total;
  for (int i = 0; i < 9; ++i) {
    inertia->inertia[i] *= density;
    if (w->mass.has_inertia) inertia->inertia[i] = i % 4 ? 0 : w->mass.inertia[i / 4];
  }
  for (int d = 0; d < 3 && w->mass.has_centre; ++d) inertia->centre[d] = w->mass.centre[d];
}
