#include "solve/newton/line_search.h"

#define MAX_TRIES 6
#define GOOD_ENOUGH 0.8 /* share of the slope at the start that may remain */
#define EXPLODED 1000   /* growth of the residual that no good step shows after the first */
#define STALE 3         /* iterations without progress that mean a cycle */

typedef struct {
  SNES snes;
  PetscInt block;         /* see LineSearchMemory */
  Vec x, f, y, w;         /* start, residual, direction (x - lambda y is the new place), work */
  PetscReal lambda, norm; /* the last place tried; norm infinite where the law fails */
  PetscReal slope;        /* y . F there: the work that is left along the direction */
} Search;

/* Work of F along y. A saddle point has no minimum: with the sign of the pressure equations turned
 * the tangent is positive semi-definite where that of the displacements is, and the work left over
 * falls with the length as it does without pressures. */
static PetscErrorCode WorkAlong(const Search *s, Vec f, PetscReal *work)
{
  const PetscReal *fv, *yv;
  PetscInt n;
  PetscReal local = 0;
  PetscScalar dot;

  PetscFunctionBeginUser;
  if (!s->block) {
    PetscCall(VecDot(s->y, f, &dot));
    *work = PetscRealPart(dot);
    PetscFunctionReturn(0);
  }
  PetscCall(VecGetLocalSize(f, &n));
  PetscCall(VecGetArrayRead(f, &fv));
  PetscCall(VecGetArrayRead(s->y, &yv));
  for (PetscInt i = 0; i < n; ++i) local += (i % s->block == s->block - 1 ? -1 : 1) * fv[i] * yv[i];
  PetscCall(VecRestoreArrayRead(s->y, &yv));
  PetscCall(VecRestoreArrayRead(f, &fv));
  PetscCall(MPIU_Allreduce(&local, work, 1, MPIU_REAL, MPI_SUM, PetscObjectComm((PetscObject)f)));
  PetscFunctionReturn(0);
}

static PetscErrorCode EvaluateAt(Search *s, PetscReal lambda)
{
  PetscFunctionBeginUser;
  s->lambda = lambda;
  PetscCall(VecWAXPY(s->w, -lambda, s->y, s->x));
  PetscCall(SNESComputeFunction(s->snes, s->w, s->f));
  PetscCall(VecNorm(s->f, NORM_2, &s->norm));
  s->slope = PETSC_INFINITY;
  if (PetscIsInfOrNanReal(s->norm)) {
    s->norm = PETSC_INFINITY;
    PetscFunctionReturn(0);
  }
  PetscCall(WorkAlong(s, s->f, &s->slope));
  PetscFunctionReturn(0);
}

/* Is there too much left along the direction, or did the residual across it explode? */
static PetscBool is_too_far(const Search *s, PetscReal slope0, PetscReal norm0)
{
  return PetscAbsReal(s->slope) > GOOD_ENOUGH * PetscAbsReal(slope0) || s->norm > EXPLODED * norm0;
}

/* Find where the slope vanishes between low (slope of the sign of slope0) and high (the other sign,
 * or the law fails there). */
static PetscErrorCode Bracket(Search *s, PetscReal slope0, PetscReal norm0)
{
  PetscReal low = 0, slope_low = slope0, high = s->lambda, slope_high = s->slope;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < MAX_TRIES && is_too_far(s, slope0, norm0); ++k) {
    const PetscReal share =
      slope_high == PETSC_INFINITY || slope_low * slope_high >= 0 ? 0.5 : slope_low / (slope_low - slope_high);
    PetscCall(EvaluateAt(s, low + PetscMax(0.1, PetscMin(0.9, share)) * (high - low)));
    if (s->slope * slope0 > 0 && s->norm <= EXPLODED * norm0) low = s->lambda, slope_low = s->slope;
    else high = s->lambda, slope_high = s->slope;
  }
  for (PetscInt k = 0; k < MAX_TRIES && s->norm == PETSC_INFINITY; ++k) PetscCall(EvaluateAt(s, 0.5 * s->lambda));
  PetscFunctionReturn(0);
}

/* First length to try, from the residual at the start of this iteration. */
static PetscReal first_length(LineSearchMemory *memory, PetscInt iteration, PetscReal norm)
{
  if (!iteration || norm < 0.9 * memory->best) {
    memory->best = norm;
    memory->stale = 0;
  } else ++memory->stale;
  return memory->stale >= STALE ? 0.5 : 1;
}

PetscErrorCode LineSearchDescend(SNESLineSearch search, void *memory)
{
  Search s;
  Vec unused;
  PetscInt iteration;
  PetscReal xnorm, ynorm, norm0, slope0;

  PetscFunctionBeginUser;
  PetscCall(SNESLineSearchGetSNES(search, &s.snes));
  PetscCall(SNESLineSearchGetVecs(search, &s.x, &s.f, &s.y, &s.w, &unused));
  PetscCall(SNESGetIterationNumber(s.snes, &iteration));
  s.block = ((LineSearchMemory *)memory)->block;
  PetscCall(WorkAlong(&s, s.f, &slope0));
  PetscCall(VecNorm(s.f, NORM_2, &norm0));
  PetscCall(EvaluateAt(&s, first_length(memory, iteration, norm0)));
  if (iteration || s.norm == PETSC_INFINITY) PetscCall(Bracket(&s, slope0, norm0));
  if (s.norm == PETSC_INFINITY) {
    PetscCall(SNESLineSearchSetReason(search, SNES_LINESEARCH_FAILED_NANORINF));
    PetscFunctionReturn(0);
  }
  PetscCall(VecCopy(s.w, s.x));
  PetscCall(VecNorm(s.x, NORM_2, &xnorm));
  PetscCall(VecNorm(s.y, NORM_2, &ynorm));
  PetscCall(SNESLineSearchSetNorms(search, xnorm, s.norm, s.lambda * ynorm));
  PetscCall(SNESLineSearchSetLambda(search, s.lambda));
  PetscCall(SNESLineSearchSetReason(search, SNES_LINESEARCH_SUCCEEDED));
  PetscFunctionReturn(0);
}
