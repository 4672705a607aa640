/* What each point does alone in the plane, four points at a time: for the walks over boxes whose functions are linear
 * (plane.c) and for those of gimp (smooth.c). */
#pragma once
#include "model/explicit/kernels/four.h"

/* x and y of four points from two registers in which they follow each other. */
KERNEL void part(const Four pair[2], Four xy[2])
{
  xy[0] = __builtin_shufflevector(pair[0], pair[1], 0, 2, 4, 6);
  xy[1] = __builtin_shufflevector(pair[0], pair[1], 1, 3, 5, 7);
}

/* Mass, momentum and force of n points of a batch from `first`; tau: -V_0 times the stress. */
typedef struct {
  PetscReal mass[LAW_BATCH], momentum[2 * LAW_BATCH], tau[4][LAW_BATCH];
} Given;

KERNEL void weigh(const Points *points, PetscInt first, PetscInt n, Given *g)
{
  const PetscReal *v = point_real(points, POINT_V, first), *mass = points->real[POINT_MASS] + first;
  for (PetscInt k = 0; k < n; ++k) {
    g->mass[k] = mass[k];
    g->momentum[2 * k] = mass[k] * v[2 * k];
    g->momentum[2 * k + 1] = mass[k] * v[2 * k + 1];
  }
}

/* -V_0 times the stress of n points. */
KERNEL void load(const Points *points, PetscInt first, PetscInt n, Given *g)
{
  const PetscReal *tau = point_real(points, POINT_TAU, first), *volume = points->real[POINT_VOLUME] + first;
  for (PetscInt k = 0; k < n; ++k)
    for (int i = 0; i < 4; ++i) g->tau[i][k] = -volume[k] * tau[4 * k + i];
}

/* Points k and k + 1 of a batch gain velocity: `left` numbers from v on are the batch's. */
KERNEL void speed_up(const Explicit *e, const Four *felt, const Four *mass, PetscInt left, PetscReal *v, PetscReal *a,
                     PetscReal *momentum, Four *damped)
{
  const PetscReal kept = 1 - e->fade;
  const Four gained = __builtin_shufflevector(felt[0], felt[1], 2, 3, 6, 7),
             seen = __builtin_shufflevector(felt[0], felt[1], 0, 1, 4, 5);
  Four old;
  take(v, left, &old);
  Four now = kept * old + gained;
  if (e->slopes) now += e->unseen * (seen - now);
  *damped += *mass * (old * (e->fading[0] * old + e->fading[1] * gained) + e->fading[2] * gained * gained);
  put(&now, left, v);
  FOUR(momentum) = *mass * now;
  if (!e->ends) return;
  const Four acceleration = gained * (1 / e->act);
  put(&acceleration, left, a);
}

/* ... and all of them. */
KERNEL void speed_up_all(const Points *points, PetscInt first, PetscInt n, const Explicit *e, const Four *felt,
                         PetscReal *momentum, Four *damped)
{
  PetscReal *v = point_real(points, POINT_V, first), *a = point_real(points, POINT_A, first);
  for (PetscInt k = 0; k < n; k += 4) {
    Four mass;
    take(points->real[POINT_MASS] + first + k, n - k, &mass);
    const Four low = __builtin_shufflevector(mass, mass, 0, 0, 1, 1),
               high = __builtin_shufflevector(mass, mass, 2, 2, 3, 3);
    speed_up(e, felt + k, &low, 2 * (n - k), v + 2 * k, a + 2 * k, momentum + 2 * k, damped);
    speed_up(e, felt + k + 2, &high, 2 * (n - k) - 4, v + 2 * k + 4, a + 2 * k + 4, momentum + 2 * k + 4, damped);
  }
}

/* Strain increments dF - 1 of a batch: rows xx yx xy yy a point, and zz where that is a ring; and by how much the
 * points move. */
typedef struct {
  Four A[LAW_BATCH], move[LAW_BATCH];
  PetscReal ring[LAW_BATCH];
} Strain;

/* F of one point after dF. */
KERNEL void deform(const Four *A, PetscReal *F)
{
  const Four f = FOUR(F), left = __builtin_shufflevector(*A, *A, 0, 0, 1, 1),
             right = __builtin_shufflevector(*A, *A, 2, 2, 3, 3);
  const Four upper = __builtin_shufflevector(f, f, 0, 1, 0, 1), lower = __builtin_shufflevector(f, f, 2, 3, 2, 3);
  FOUR(F) = f + left * upper + right * lower;
}

/* Four points from p on move; F, J and the law's dF. n: as many of them are the batch's. */
KERNEL void move_on(const PetscBool hoop, Points *points, PetscInt p, PetscInt n, const Explicit *e, Strain *s,
                    PetscInt k, Batch *b)
{
  PetscReal *x = point_real(points, POINT_X, p), *F = point_real(points, POINT_F, p);
  Four A[4], pair, J, ring = {0};
  for (int i = 0; i < 2; ++i) {
    take(x + 4 * i, 2 * n - 4 * i, &pair);
    pair += e->dt * __builtin_shufflevector(s->move[k + 2 * i], s->move[k + 2 * i + 1], 0, 1, 4, 5);
    put(&pair, 2 * n - 4 * i, x + 4 * i);
  }
  for (PetscInt i = 0; i < PetscMin(n, 4); ++i) {
    deform(&s->A[k + i], F + 5 * i);
    if (hoop) F[5 * i + 4] += s->ring[k + i] * F[5 * i + 4];
  }
  if (hoop) ring = FOUR(s->ring + k);
  for (int i = 0; i < 4; ++i) A[i] = s->A[k + i];
  turn(A);
  take(points->real[POINT_J] + p, n, &J);
  J *= ((1 + A[0]) * (1 + A[3]) - A[1] * A[2]) * (1 + ring);
  put(&J, n, points->real[POINT_J] + p);
  FOUR(b->dF[0] + k) = 1 + A[0];
  FOUR(b->dF[1] + k) = A[2];
  FOUR(b->dF[2] + k) = A[1];
  FOUR(b->dF[3] + k) = 1 + A[3];
  FOUR(b->dF[4] + k) = 1 + ring;
}

/* Stress of four points from p on, and its work, as `keep` of points.c has them. */
KERNEL void keep(const PetscBool hoop, Points *points, PetscInt p, PetscInt n, const Batch *b, PetscInt k, Given *g)
{
  PetscReal *stress = point_real(points, POINT_TAU, p);
  Four old[4], tau[4], volume, work, part_of = {0};
  for (int i = 0; i < 4; ++i) take(stress + 4 * i, n > i ? 4 : 0, &old[i]);
  turn(old);
  for (int i = 0; i < 4; ++i) tau[i] = FOUR_OF(b->tau[i] + k);
  const Four xx = FOUR_OF(b->dF[0] + k) - 1, xy = FOUR_OF(b->dF[1] + k), yx = FOUR_OF(b->dF[2] + k);
  const Four yy = FOUR_OF(b->dF[3] + k) - 1, across = xy * yx, shear = xy + yx;
  if (hoop) {
    const Four ring = FOUR_OF(b->dF[4] + k) - 1;
    part_of = old[2] * ring + tau[2] * (ring - ring * ring);
  }
  part_of += old[0] * xx + old[1] * yy + old[3] * shear + tau[0] * (xx - xx * xx - across) +
             tau[1] * (yy - yy * yy - across) + tau[3] * (shear - (xx + yy) * shear);
  take(points->real[POINT_VOLUME] + p, n, &volume);
  take(points->real[POINT_WORK] + p, n, &work);
  work += 0.5 * volume * part_of;
  put(&work, n, points->real[POINT_WORK] + p);
  for (int i = 0; i < 4; ++i) FOUR(g->tau[i] + k) = -volume * tau[i];
  turn(tau);
  for (int i = 0; i < 4 && i < n; ++i) FOUR(stress + 4 * i) = tau[i];
}

/* Gradients that points carry go after those that have strained them. */
KERNEL void slopes_follow(const Points *points, PetscInt first, PetscInt n, const Explicit *e, const Strain *s)
{
  for (PetscInt k = 0; e->slopes && k < n; ++k) {
    const PetscReal A[3][3] = {{s->A[k][0], s->A[k][2]}, {s->A[k][1], s->A[k][3]}};
    slope_follow(2, e, A, point_real(points, POINT_SLOPE, first + k));
  }
}

/* Lanes behind the last point of a batch are strained by nothing. */
KERNEL void rest_of_batch(PetscInt n, Strain *s)
{
  for (PetscInt k = n; k < LAW_BATCH; ++k) {
    s->A[k] = (Four){0};
    s->ring[k] = 0;
  }
}

KERNEL void batch_begin(Batch *b)
{
  for (int k = 0; k < LAW_BATCH; ++k) b->dF[0][k] = b->dF[3][k] = b->dF[4][k] = 1;
}

/* n points from `first` on: they move, are stressed, and keep that. */
KERNEL void strain_batch(const PetscBool hoop, const Model *m, Explicit *e, PetscInt first, PetscInt n, Strain *s,
                         Batch *b, Given *g)
{
  for (PetscInt k = 0; k < n; k += 4) move_on(hoop, m->points, first + k, n - k, e, s, k, b);
  const LawStatus status = batch_stress(m, first, n, b);
  e->status = PetscMax(e->status, status);
  for (PetscInt k = 0; k < n; k += 4) keep(hoop, m->points, first + k, n - k, b, k, g);
  slopes_follow(m->points, first, n, e, s);
}
