/* The outline of bodies whose shapes or meshes the case tells: a place on the page belongs to one if the place where
 * its material began lies in the shape, or in the mesh. Points next to the surface know where that is from those
 * around them. */
#include <math.h>
#include "base/math/tensor.h"
#include "grid/search/neighbours.h"
#include "method/method.h"
#include "picture/scene/scene.h"

enum { MOST_AROUND = 24, LEAST_AROUND = 4, MOST_BODIES = 250 };
enum { INNER = 1, OUTER = 2 }; /* of `knows` */
/* Of a ball's radius: how far around it neighbours say how it moved, how deep points next to the surface began, and the
 * outermost of them. */
#define AROUND 2.5
#define DEEP 2.2
#define OUTERMOST 1.3
/* And of the radius at first: what began so near to one of these is its own. */
#define OWN 1.3
/* Of the neighbours of a point that knows, so many do, too. */
#define OUTER_SHARE 0.35
#define INNER_SHARE 0.2
/* Of the distances at the start: what neighbours may have moved otherwise than evenly. */
#define UNEVEN 0.15
#define MOST_STRETCH 10.
#define MOST_OPENING 4. /* of the volume */

static PetscBool fills_shape(const Case *c, PetscInt body)
{
  return body_fills_shape(&c->bodies[body], method_find(c->method)->restores_grid);
}

static const Contour *contour_of(const PlotContours *contours, PetscInt body)
{
  return contours && contours->body[body].n ? &contours->body[body] : NULL;
}

/* Does the body fill its shape, as far as its mesh or the region goes, if one bounds it? Else that alone bounds it. */
static PetscBool is_known(const Case *c, const PlotContours *contours, PetscInt body)
{
  const BodySpec *spec = &c->bodies[body];
  return (PetscBool)(contour_of(contours, body) || (fills_shape(c, body) && !spec->region && !spec->mesh));
}

/* Was a place of the section in the body, so deep or deeper? On the other side of the axis it is as on this one, and
 * where that cuts the section there is no surface. */
static PetscBool body_holds(const Case *c, const PlotContours *contours, PetscInt body, const PetscReal *x,
                            PetscReal deep)
{
  const PetscInt dim = c->kinematics->dim;
  const PetscReal at[3] = {c->kinematics->hoop ? PetscMax(fabs(x[0]), 1.001 * deep) : x[0], x[1], dim == 3 ? x[2] : 0};
  const Contour *contour = contour_of(contours, body);
  if (fills_shape(c, body) && !shape_contains(&c->bodies[body].shape, dim, at, -deep)) return PETSC_FALSE;
  return (PetscBool)(!contour || (contour_holds(contour, at) && !(deep > 0 && contour_near(contour, at, deep))));
}

/* The body that a point began in, if its outline is known; -1. */
static PetscInt body_of(const Case *c, const PlotContours *contours, const unsigned char *known, const PetscReal *first)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (known[b] && body_holds(c, contours, b, first, 0)) return b;
  return -1;
}

/* Where places around point p began: X = X_p + B (x - x_p), from its neighbours by least squares. In the plane all
 * third coordinates are 0. PETSC_FALSE where they moved in other ways. */
static PetscBool fit(const PlotFrame *f, PetscInt dim, PetscInt p, PetscInt n, const PetscInt *item,
                     const PetscReal *square, PetscReal most, PetscReal *B)
{
  PetscReal M[9] = {0}, C[9] = {0}, inverse[9], all = 0, stretch = 0;
  for (PetscInt k = 0; k < n; ++k) {
    const PetscReal w = PetscSqr(1 - square[k] / most);
    PetscReal r[3], R[3];
    for (int d = 0; d < 3; ++d) {
      r[d] = f->x[3 * item[k] + d] - f->x[3 * p + d];
      R[d] = f->first[3 * item[k] + d] - f->first[3 * p + d];
      all += w * R[d] * R[d];
    }
    for (int i = 0; i < 9; ++i) M[i] += w * r[i / 3] * r[i % 3], C[i] += w * R[i / 3] * r[i % 3];
  }
  const PetscReal mean = (M[0] + M[4] + M[8]) / (PetscReal)dim;
  if (dim == 2) M[8] = mean;
  if (!(tensor_inverse(M, inverse) > 4e-3 * mean * mean * mean)) return PETSC_FALSE;
  tensor_multiply(C, inverse, B);
  /* sum w |R - B r|^2 = sum w |R|^2 - C : B, B being the best */
  PetscReal off = all;
  for (int i = 0; i < 9; ++i) off -= C[i] * B[i], stretch += B[i] * B[i];
  if (dim == 2) B[8] = 1;
  return (PetscBool)(off <= PetscSqr(UNEVEN) * all && stretch <= PetscSqr(MOST_STRETCH) &&
                     tensor_det(B) > 1 / MOST_OPENING);
}

/* Where a place next to a point that knows began. */
static void place_began(const PlotFrame *f, PetscInt p, const PetscReal *x, PetscReal began[3])
{
  const PetscReal *B = f->back + 9 * p, *X = f->first + 3 * p, *at = f->x + 3 * p;
  const PetscReal r[3] = {x[0] - at[0], x[1] - at[1], x[2] - at[2]};
  for (int i = 0; i < 3; ++i) began[i] = X[i] + B[3 * i] * r[0] + B[3 * i + 1] * r[1] + B[3 * i + 2] * r[2];
}

/* What is asked of the points of a frame. */
typedef struct {
  const Case *c;
  const PlotContours *contours;
  const Neighbours *points;
  const unsigned char *body; /* of each point, from 1 */
  PlotFrame *f;
} Fit;

/* Points of its own body so far around p, and their squared distances. */
static PetscInt around(const Fit *of, PetscInt p, PetscReal radius, PetscInt *item, PetscReal *square)
{
  PetscInt kept = 0;
  const PetscInt n = neighbours_within(of->points, of->f->x + 3 * p, radius, MOST_AROUND, item, square);
  for (PetscInt k = 0; k < n; ++k)
    if (of->body[item[k]] == of->body[p]) item[kept] = item[k], square[kept++] = square[k];
  return kept;
}

/* Was the surface as near to a point as it is to the outermost ones, or is it now? */
static PetscBool is_outermost(const Fit *of, PetscInt p)
{
  static const PetscReal half = 0.70710678118654752;
  const PlotFrame *f = of->f;
  const PetscInt dim = of->c->kinematics->dim, body = f->shape[p] - 1;
  const PetscReal way[14][3] = {
    {1, 0, 0},         {-1, 0, 0}, {0, 1, 0},  {0, -1, 0},      {half, half, 0},   {half, -half, 0}, {-half, half, 0},
    {-half, -half, 0}, {0, 0, 1},  {0, 0, -1}, {half, 0, half}, {-half, 0, -half}, {0, half, half},  {0, -half, -half}};
  if (!body_holds(of->c, of->contours, body, f->first + 3 * p, OUTERMOST * f->first_radius[p])) return PETSC_TRUE;
  for (int k = 0; k < (dim == 2 ? 8 : 14); ++k) {
    PetscReal x[3], began[3];
    for (int d = 0; d < 3; ++d) x[d] = f->x[3 * p + d] + OUTERMOST * f->radius[p] * way[k][d];
    place_began(f, p, x, began);
    if (!body_holds(of->c, of->contours, body, began, 0)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Where neighbours that have come together along one axis say nothing about the others, those farther off do. */
static PetscBool fit_around(const Fit *of, PetscInt p)
{
  PetscInt item[MOST_AROUND];
  PetscReal square[MOST_AROUND];
  for (int wide = 1; wide <= 2; ++wide) {
    const PetscReal radius = wide * AROUND * of->f->radius[p];
    const PetscInt n = around(of, p, radius, item, square);
    if (n >= LEAST_AROUND &&
        fit(of->f, of->c->kinematics->dim, p, n, item, square, radius * radius, of->f->back + 9 * p))
      return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Those that began next to the surface, and whose neighbours moved alike. */
static void fit_all(const Fit *of)
{
  PlotFrame *f = of->f;
  for (PetscInt p = 0; p < f->n; ++p) {
    f->knows[p] = 0;
    if (f->shape[p] && fit_around(of, p)) f->knows[p] = is_outermost(of, p) ? OUTER : INNER;
  }
}

/* A surface that flow has made has few points of the first one, each for itself: they know nothing more of it. */
static PetscErrorCode DropLonely(const Fit *of)
{
  PlotFrame *f = of->f;
  unsigned char *before;
  PetscInt item[MOST_AROUND];
  PetscReal square[MOST_AROUND];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(f->n, &before));
  PetscCall(PetscArraycpy(before, f->knows, f->n));
  for (PetscInt p = 0; p < f->n; ++p) {
    PetscInt alike = 0;
    if (!before[p]) continue;
    const PetscInt n = around(of, p, AROUND * f->radius[p], item, square);
    for (PetscInt k = 0; k < n; ++k) alike += before[item[k]] != 0;
    if (alike < (before[p] == OUTER ? OUTER_SHARE : INNER_SHARE) * n) f->knows[p] = 0;
  }
  PetscCall(PetscFree(before));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotShapes(const Case *c, const PlotContours *contours, PlotFrame *f)
{
  unsigned char known[MOST_BODIES] = {0};
  unsigned char *body;
  PetscReal *x, far = 0;
  PetscBool any = PETSC_FALSE;
  Neighbours points;

  PetscFunctionBeginUser;
  if (!c || c->n_bodies > MOST_BODIES || f->n != f->n_first || !f->n) PetscFunctionReturn(0);
  const PetscInt dim = c->kinematics->dim;
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    known[b] = is_known(c, contours, b);
    any = (PetscBool)(any || known[b]);
  }
  if (!any) PetscFunctionReturn(0);
  PetscCall(PetscMalloc3(f->n, &f->shape, f->n, &f->knows, 9 * f->n, &f->back));
  PetscCall(PetscCalloc1(c->n_bodies, &f->there));
  PetscCall(PetscMalloc2(dim * f->n, &x, f->n, &body));
  for (PetscInt p = 0; p < f->n; ++p) {
    const PetscInt of = body_of(c, contours, known, f->first + 3 * p);
    body[p] = (unsigned char)(1 + of);
    if (of >= 0) f->there[of] = 1;
    f->shape[p] = of >= 0 && body_holds(c, contours, of, f->first + 3 * p, DEEP * f->first_radius[p]) ? 0 : body[p];
    far = PetscMax(far, f->radius[p]);
    for (PetscInt d = 0; d < dim; ++d) x[dim * p + d] = f->x[3 * p + d];
  }
  PetscCall(NeighboursCreate(dim, f->n, x, 0, NULL, NULL, far, &points));
  const Fit all = {.c = c, .contours = contours, .points = &points, .body = body, .f = f};
  fit_all(&all);
  PetscCall(DropLonely(&all));
  PetscCall(NeighboursDestroy(&points));
  PetscCall(PetscFree2(x, body));
  PetscFunctionReturn(0);
}

/* Does another body hold the place that sticks to this one, since no interface is between them? */
static PetscBool neighbour_holds(const PlotOutline *o, PetscInt body, const PetscReal *x)
{
  for (PetscInt b = 0; b < o->c->n_bodies; ++b)
    if (b != body && o->frame->there[b] && case_field(o->c, b) == case_field(o->c, body) &&
        body_holds(o->c, o->contours, b, x, 0))
      return PETSC_TRUE;
  return PETSC_FALSE;
}

RasterHeld plot_shape_holds(const void *of, PetscInt p, const PetscReal *x)
{
  const PlotOutline *o = of;
  const PlotFrame *f = o->frame;
  PetscReal began[3];
  place_began(f, p, x, began);
  const PetscReal *at = o->first ? x : began;
  const PetscInt body = f->shape[p] - 1;
  if (!body_holds(o->c, o->contours, body, at, 0)) return neighbour_holds(o, body, at) ? RASTER_NEAR : RASTER_OUTSIDE;
  if (!o->first && f->knows[p] != OUTER) return RASTER_DEEP;
  const PetscReal *X = f->first + 3 * p, away[3] = {at[0] - X[0], at[1] - X[1], at[2] - X[2]};
  const PetscReal square = away[0] * away[0] + away[1] * away[1] + away[2] * away[2];
  return square <= PetscSqr(OWN * f->first_radius[p]) ? RASTER_OWN : RASTER_NEAR;
}

PetscBool plot_bodies_hold(const PlotOutline *o, const PetscReal *x)
{
  for (PetscInt b = 0; o->frame->there && b < o->c->n_bodies; ++b)
    if (o->frame->there[b] && body_holds(o->c, o->contours, b, x, 0)) return PETSC_TRUE;
  return PETSC_FALSE;
}
