/* The outline of bodies whose shapes the case tells: a place on the page belongs to one if the place where its material
 * began lies in the shape. Points next to the surface know where that is from those around them. */
#include <math.h>
#include "grid/search/neighbours.h"
#include "method/method.h"
#include "picture/scene/scene.h"

enum { MOST_AROUND = 24, LEAST_AROUND = 4, MOST_BODIES = 250 };
/* Of a ball's radius: how far around it neighbours say how it moved, and how deep points next to the surface began. */
#define AROUND 2.5
#define DEEP 2.2
/* Of the distances at the start: what neighbours may have moved otherwise than evenly. */
#define UNEVEN 0.15
#define MOST_STRETCH 4.

/* Where a place of the section was: on the other side of the axis it is as on this one. */
static PetscBool shape_holds(const Case *c, PetscInt body, const PetscReal *x, PetscReal tolerance)
{
  const PetscReal at[3] = {c->kinematics->hoop ? fabs(x[0]) : x[0], x[1], 0};
  return shape_contains(&c->bodies[body].shape, 2, at, tolerance);
}

/* The body that a point began in, if it fills a shape whose surface is near; -1. */
static PetscInt body_near(const Case *c, const unsigned char *fills, const PetscReal *first, PetscReal deep)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (fills[b] && shape_holds(c, b, first, 0)) return shape_holds(c, b, first, -deep) ? -1 : b;
  return -1;
}

/* Where places around point p began: X = back[0..1] + B (x - x_p), B = back[2..5], from its neighbours
 * by least squares. PETSC_FALSE where they moved in other ways. */
static PetscBool fit(const PlotFrame *f, PetscInt p, PetscInt n, const PetscInt *item, const PetscReal *square,
                     PetscReal most, PetscReal *back)
{
  PetscReal M[3] = {0, 0, 0}, C[4] = {0, 0, 0, 0}, all = 0, off = 0;
  for (PetscInt k = 0; k < n; ++k) {
    const PetscReal w = PetscSqr(1 - square[k] / most), *x = f->x + 3 * item[k], *X = f->first + 3 * item[k];
    const PetscReal r[2] = {x[0] - f->x[3 * p], x[1] - f->x[3 * p + 1]};
    const PetscReal R[2] = {X[0] - f->first[3 * p], X[1] - f->first[3 * p + 1]};
    M[0] += w * r[0] * r[0], M[1] += w * r[0] * r[1], M[2] += w * r[1] * r[1];
    for (int i = 0; i < 4; ++i) C[i] += w * R[i / 2] * r[i % 2];
    all += w * (R[0] * R[0] + R[1] * R[1]);
  }
  const PetscReal det = M[0] * M[2] - M[1] * M[1];
  if (!(det > 1e-3 * PetscSqr(M[0] + M[2]))) return PETSC_FALSE;
  PetscReal *B = back + 2;
  for (int i = 0; i < 2; ++i) {
    back[i] = f->first[3 * p + i];
    B[2 * i] = (C[2 * i] * M[2] - C[2 * i + 1] * M[1]) / det;
    B[2 * i + 1] = (C[2 * i + 1] * M[0] - C[2 * i] * M[1]) / det;
  }
  /* sum w |R - B r|^2 = sum w |R|^2 - C : B, B being the best */
  off = all;
  for (int i = 0; i < 4; ++i) off -= C[i] * B[i];
  const PetscReal stretch = B[0] * B[0] + B[1] * B[1] + B[2] * B[2] + B[3] * B[3];
  return (PetscBool)(off <= PetscSqr(UNEVEN) * all && stretch <= PetscSqr(MOST_STRETCH) &&
                     B[0] * B[3] - B[1] * B[2] > 1 / MOST_STRETCH);
}

/* Points of one body next to its surface. */
static PetscErrorCode FitAll(const Neighbours *points, PlotFrame *f)
{
  PetscInt item[MOST_AROUND];
  PetscReal square[MOST_AROUND];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < f->n; ++p) {
    const PetscReal radius = AROUND * f->radius[p];
    f->knows[p] = 0;
    if (!f->shape[p]) continue;
    const PetscInt n = neighbours_within(points, f->x + 3 * p, radius, MOST_AROUND, item, square);
    f->knows[p] = n >= LEAST_AROUND && fit(f, p, n, item, square, radius * radius, f->back + 6 * p);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PlotShapes(const Case *c, PlotFrame *f)
{
  unsigned char fills[MOST_BODIES] = {0};
  PetscReal *x, far = 0;
  PetscBool any = PETSC_FALSE;
  Neighbours points;

  PetscFunctionBeginUser;
  if (!c || c->n_bodies > MOST_BODIES || f->n != f->n_first || !f->n) PetscFunctionReturn(0);
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    const BodySpec *body = c->bodies + b;
    fills[b] = body_fills_shape(body, method_find(c->method)->restores_grid) && !body->region && !body->mesh;
    any = (PetscBool)(any || fills[b]);
  }
  if (!any) PetscFunctionReturn(0);
  PetscCall(PetscMalloc3(f->n, &f->shape, f->n, &f->knows, 6 * f->n, &f->back));
  PetscCall(PetscMalloc1(2 * f->n, &x));
  for (PetscInt p = 0; p < f->n; ++p) {
    f->shape[p] = (unsigned char)(1 + body_near(c, fills, f->first + 3 * p, DEEP * f->first_radius[p]));
    far = PetscMax(far, f->radius[p]);
    for (int d = 0; d < 2; ++d) x[2 * p + d] = f->x[3 * p + d];
  }
  PetscCall(NeighboursCreate(2, f->n, x, 0, NULL, NULL, far, &points));
  PetscCall(FitAll(&points, f));
  PetscCall(NeighboursDestroy(&points));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(0);
}

PetscBool plot_shape_holds(const void *of, PetscInt p, const PetscReal *x)
{
  const PlotOutline *o = of;
  const PlotFrame *f = o->frame;
  const PetscReal *back = f->back + 6 * p, *B = back + 2;
  const PetscReal r[2] = {x[0] - f->x[3 * p], x[1] - f->x[3 * p + 1]};
  const PetscReal began[2] = {back[0] + B[0] * r[0] + B[1] * r[1], back[1] + B[2] * r[0] + B[3] * r[1]};
  return shape_holds(o->c, f->shape[p] - 1, o->first ? x : began, 0);
}
