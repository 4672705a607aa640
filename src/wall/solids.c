#include "wall/form.h"
#include <math.h>

/* r from `centre`: the gradient and Hessian of |r|, of which `dim` axes count. */
static void radial(PetscInt dim, const PetscReal r[3], PetscReal length, WallPlace *place)
{
  if (!(length > 0)) { /* in the centre every direction is as good */
    place->normal[0] = 1;
    return;
  }
  for (PetscInt d = 0; d < dim; ++d) place->normal[d] = r[d] / length;
  for (PetscInt i = 0; i < dim; ++i)
    for (PetscInt j = 0; j < dim; ++j)
      place->curvature[3 * i + j] = ((i == j) - place->normal[i] * place->normal[j]) / length;
}

static PetscReal from_centre(const Form *f, const PetscReal *centre, const PetscReal x[3], PetscReal r[3])
{
  PetscReal square = 0;
  for (PetscInt d = 0; d < f->dim; ++d) {
    r[d] = x[d] - centre[d];
    square += r[d] * r[d];
  }
  return PetscSqrtReal(square);
}

void ball_place(const Form *f, const PetscReal x[3], WallPlace *place)
{
  PetscReal r[3] = {0, 0, 0};
  const PetscReal length = from_centre(f, f->shape->centre, x, r);
  *place = (WallPlace){.gap = length - f->shape->radius};
  radial(f->dim, r, length, place);
}

/* beyond[d]: how far x is outside of the two faces along d, negative between them. Outside counts
 * what is positive: a face, an edge or a corner; inside the nearest face. */
void box_place(const Form *f, const PetscReal x[3], WallPlace *place)
{
  PetscReal beyond[3] = {0, 0, 0}, out[3] = {0, 0, 0}, sign[3], square = 0;
  PetscInt nearest = 0, axes = 0;
  for (PetscInt d = 0; d < f->dim; ++d) {
    const PetscReal low = f->bounds[d] - x[d], high = x[d] - f->bounds[d + 3];
    sign[d] = low > high ? -1 : 1;
    beyond[d] = PetscMax(low, high);
    if (beyond[d] > beyond[nearest]) nearest = d;
    if (beyond[d] <= 0) continue;
    out[d] = sign[d] * beyond[d];
    square += out[d] * out[d];
    ++axes;
  }
  *place = (WallPlace){.gap = axes ? PetscSqrtReal(square) : beyond[nearest]};
  if (axes <= 1) {
    place->gap = beyond[nearest];
    place->normal[nearest] = sign[nearest];
    return;
  }
  radial(f->dim, out, place->gap, place);
  for (PetscInt d = 0; d < f->dim; ++d)
    if (out[d] == 0) place->curvature[4 * d] = 0; /* along the edge */
}

/* In axisymmetry a cone, whose tip is on the axis. */
void half_space_place(const Form *f, const PetscReal x[3], WallPlace *place)
{
  const PetscReal *n = f->direction;
  PetscReal along = 0;
  for (PetscInt d = 0; d < f->dim; ++d) along += (x[d] - f->base[d]) * n[d];
  *place = (WallPlace){.gap = along};
  for (PetscInt d = 0; d < f->dim; ++d) place->normal[d] = n[d];
  if (!f->axis || x[0] - along * n[0] >= 0) return;
  const PetscReal tip[3] = {0, f->base[1] + f->base[0] * n[0] / n[1], 0};
  PetscReal r[3] = {0, 0, 0};
  const PetscReal length = from_centre(f, tip, x, r);
  radial(2, r, length, place);
  place->gap = along < 0 ? -length : length;
  for (int k = 0; k < 9 && along < 0; ++k) place->curvature[k] *= -1;
  for (int d = 0; d < 3 && along < 0; ++d) place->normal[d] *= -1;
}

Nearness arc_place(const Form *f, const PetscReal x[3], WallPlace *place)
{
  const Shape *s = f->shape;
  const PetscReal from = s->angle[0] * PETSC_PI / 180, sweep = (s->angle[1] - s->angle[0]) * PETSC_PI / 180;
  PetscReal r[3] = {0, 0, 0}, end[2][3], best = PETSC_MAX_REAL;
  PetscReal angle = fmod(atan2(x[1] - s->centre[1], x[0] - s->centre[0]) - from, 2 * PETSC_PI);
  ball_place(f, x, place);
  if (angle < 0) angle += 2 * PETSC_PI;
  if (angle <= sweep) return NEAR;
  for (int k = 0; k < 2; ++k) {
    const PetscReal at = k ? from + sweep : from;
    PetscReal to[3] = {0, 0, 0};
    end[k][0] = s->centre[0] + s->radius * cos(at), end[k][1] = s->centre[1] + s->radius * sin(at), end[k][2] = 0;
    const PetscReal length = from_centre(f, end[k], x, to);
    if (length >= best) continue;
    best = length;
    for (int d = 0; d < 3; ++d) r[d] = to[d];
  }
  /* towards which of its sides: as if the arc went on */
  const PetscReal over = (r[0] * (x[0] - s->centre[0] - r[0]) + r[1] * (x[1] - s->centre[1] - r[1])) / s->radius;
  const int side = place->gap < 0 ? -1 : 1;
  *place = (WallPlace){.gap = side * best};
  radial(2, r, best, place);
  for (int d = 0; d < 3; ++d) place->normal[d] *= side;
  for (int k = 0; k < 9; ++k) place->curvature[k] *= side;
  return fabs(over) > RIM_COSINE * best ? NEAR_OVER_RIM : NEAR_RIM;
}

/* From (radius, height) to space: the plane's normal and Hessian, and the circle around the axis,
 * which bends by n_r / r; on the axis as much as across it. */
static void revolve(const Form *f, const PetscReal radial_unit[3], PetscReal radius, const WallPlace *section,
                    WallPlace *place)
{
  const PetscReal *e = radial_unit, *a = f->direction, *n = section->normal, *h = section->curvature;
  const PetscReal hoop = radius > 1e-12 * (f->facets->bounds[3] - f->facets->bounds[0]) ? n[0] / radius : h[0];
  *place = (WallPlace){.gap = section->gap};
  for (int i = 0; i < 3; ++i) place->normal[i] = n[0] * e[i] + n[1] * a[i];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      place->curvature[3 * i + j] = h[0] * e[i] * e[j] + h[1] * e[i] * a[j] + h[3] * a[i] * e[j] + h[4] * a[i] * a[j] +
                                    hoop * ((i == j) - e[i] * e[j] - a[i] * a[j]);
}

/* Where x is in the section: radius and height, and which way r leads away from the axis; on it as good as any. */
static void into_section(const Form *f, const PetscReal x[3], PetscReal at[3], PetscReal r[3])
{
  const PetscReal *a = f->direction;
  PetscReal height = 0, square = 0;
  for (int d = 0; d < 3; ++d) height += (x[d] - f->base[d]) * a[d];
  for (int d = 0; d < 3; ++d) {
    r[d] = x[d] - f->base[d] - height * a[d];
    square += r[d] * r[d];
  }
  at[0] = PetscSqrtReal(square), at[1] = height, at[2] = 0;
  if (at[0] > 0) {
    for (int d = 0; d < 3; ++d) r[d] /= at[0];
    return;
  }
  const int least = fabs(a[0]) <= fabs(a[1]) && fabs(a[0]) <= fabs(a[2]) ? 0 : fabs(a[1]) <= fabs(a[2]) ? 1 : 2;
  for (int d = 0; d < 3; ++d) r[d] = (d == least) - a[least] * a[d];
  const PetscReal length = PetscSqrtReal(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  for (int d = 0; d < 3; ++d) r[d] /= length;
}

Nearness revolved_near(const Form *f, const PetscReal x[3], int flip, PetscReal high, WallPlace *place)
{
  PetscReal at[3], r[3];
  WallPlace section;
  into_section(f, x, at, r);
  const Nearness near = facets_near(f->facets, at, flip, f->thin, high, &section);
  if (near != NEAR_NOT) revolve(f, r, at[0], &section, place);
  return near;
}

void revolved_sides(const Form *f, const PetscReal x[3], int flip, PetscReal high, WallSides *sides)
{
  PetscReal at[3], r[3];
  WallSides section = {.n = 0};
  into_section(f, x, at, r);
  facets_sides(f->facets, at, flip, high, &section);
  for (PetscInt i = 0; i < section.n; ++i) {
    WallPlace place;
    revolve(f, r, at[0], &section.place[i], &place);
    sides_add(sides, &place);
  }
}
