/* A region that is a millionth of the ranges, bent, or in several pieces: in levels, each of the tenth
 * of the points that is nearest. From each of those a walk makes ten points that fill the level as
 * evenly as those before filled theirs (Metropolis's; its steps are between two points of the level,
 * as in differential evolution, so as long as that is, and along it where it is thin). Each level so
 * has a tenth of the volume of the one before. */
#include "calibrate/region_private.h"

enum { LEVELS = 24, STEPS = 10, KEPT = REGION_CLOUD / STEPS };

typedef struct {
  Region *r;
  const PetscReal *off; /* of the points: what is to become 1 */
  PetscReal limit;      /* of this level */
  PetscReal *start;     /* the nearest of the level before, in order */
  PetscReal *key;       /* for sorting */
  PetscInt *order;
  unsigned long long state; /* of the random numbers, which are the same each time */
} Walk;

static PetscReal chance(Walk *w)
{
  w->state ^= w->state << 13;
  w->state ^= w->state >> 7;
  w->state ^= w->state << 17;
  return (PetscReal)(w->state >> 11) / 9007199254740992.0;
}

/* The places of the nearest points, in order. */
static PetscErrorCode Sort(Walk *w, PetscInt most)
{
  const Region *r = w->r;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->n; ++i) w->key[i] = w->off[i], w->order[i] = i;
  PetscCall(PetscSortRealWithArrayInt(r->n, w->key, w->order));
  for (PetscInt k = 0; k < most; ++k)
    PetscCall(PetscArraycpy(w->start + k * r->dim, r->x + w->order[k] * r->dim, r->dim));
  PetscFunctionReturn(0);
}

/* x = from + a share of the way between two points; PETSC_FALSE if that is out of the ranges. */
static PetscBool propose(Walk *w, const PetscReal *from, PetscReal *x)
{
  const PetscInt dim = w->r->dim;
  const PetscReal *a = w->start + (PetscInt)(chance(w) * KEPT) * dim,
                  *b = w->start + (PetscInt)(chance(w) * KEPT) * dim;
  const PetscReal share = 1.7 / PetscSqrtReal((PetscReal)dim) * chance(w);
  PetscBool within = PETSC_TRUE;
  for (PetscInt d = 0; d < dim; ++d) {
    x[d] = from[d] + share * (a[d] - b[d]);
    within = within && x[d] >= 0 && x[d] <= 1;
  }
  return within;
}

/* Point i of a walk whose last one is i - 1: another one, or the same again. */
static void go(Walk *w, PetscInt i)
{
  Region *r = w->r;
  const PetscReal *from = r->x + (i - 1) * r->dim;
  PetscReal *x = r->x + i * r->dim;
  const PetscBool within = propose(w, from, x);
  if (within) region_evaluate(r, i);
  if (within && w->off[i] <= w->limit) return;
  for (PetscInt d = 0; d < r->dim; ++d) x[d] = from[d];
  for (PetscInt k = 0; k < r->n_targets; ++k) {
    r->value[i * r->n_targets + k] = r->value[(i - 1) * r->n_targets + k];
    r->error[i * r->n_targets + k] = r->error[(i - 1) * r->n_targets + k];
  }
  r->miss[i] = r->miss[i - 1], r->doubt[i] = r->doubt[i - 1], r->far[i] = r->far[i - 1];
}

/* To the next level. PETSC_FALSE: it is no nearer. */
static PetscErrorCode Level(Walk *w, PetscBool *nearer)
{
  Region *r = w->r;
  const PetscReal before = w->limit;

  PetscFunctionBeginUser;
  PetscCall(Sort(w, KEPT));
  w->limit = PetscMax(w->key[KEPT - 1], 1);
  *nearer = (PetscBool)(w->limit < (1 - 1e-3) * before);
  for (PetscInt i = 0; i < r->n; ++i) {
    if (i % STEPS) {
      go(w, i);
      continue;
    }
    PetscCall(PetscArraycpy(r->x + i * r->dim, w->start + i / STEPS * r->dim, r->dim));
    region_evaluate(r, i);
  }
  region_judge(r);
  PetscFunctionReturn(0);
}

/* Points at which a walk stayed count once. */
static PetscErrorCode KeepDistinct(Walk *w)
{
  Region *r = w->r;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(Sort(w, r->n));
  for (PetscInt i = 0; i < r->n; ++i) {
    PetscBool same = PETSC_FALSE;
    if (i) PetscCall(PetscArraycmp(w->start + i * r->dim, w->start + (i - 1) * r->dim, r->dim, &same));
    if (same) continue;
    PetscCall(PetscArraycpy(r->x + n * r->dim, w->start + i * r->dim, r->dim));
    region_evaluate(r, n++);
  }
  r->n = n;
  region_judge(r);
  PetscFunctionReturn(0);
}

PetscErrorCode RegionWalk(Region *r, const PetscReal *off)
{
  Walk w = {.r = r, .off = off, .limit = PETSC_MAX_REAL, .state = 88172645463325252ULL};
  PetscReal share = 1;
  PetscBool nearer = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(r->n * r->dim, &w.start, r->n, &w.key, r->n, &w.order));
  for (int level = 0; level < LEVELS && nearer && r->inside < REGION_ENOUGH; ++level, share /= STEPS)
    PetscCall(Level(&w, &nearer));
  r->volume = share * (PetscReal)r->inside / (PetscReal)r->n;
  PetscCall(KeepDistinct(&w));
  PetscCall(PetscFree3(w.start, w.key, w.order));
  PetscFunctionReturn(0);
}
