#include "solve/newton/line_search.h"

#define MAX_TRIES 6
#define EXPLODED 1000 /* growth of the residual that no good step shows after the first */
#define STALE 3       /* iterations without progress that mean a cycle */

/* A search of SNES. */
typedef struct {
  SNES snes;
  const LineSearchMemory *memory;
  Vec x, f, y, w; /* start, residual, direction (x - lambda y is the new place), work */
} Search;

static PetscReal beside(const Search *s) { return s->memory->beside ? s->memory->beside(s->memory->context) : 0; }

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
  const PetscInt block = s->memory->block;
  if (!block) {
    PetscCall(VecDot(s->y, f, &dot));
    *work = PetscRealPart(dot) + beside(s);
    PetscFunctionReturn(0);
  }
  PetscCall(VecGetLocalSize(f, &n));
  PetscCall(VecGetArrayRead(f, &fv));
  PetscCall(VecGetArrayRead(s->y, &yv));
  for (PetscInt i = 0; i < n; ++i) local += (i % block == block - 1 ? -1 : 1) * fv[i] * yv[i];
  PetscCall(VecRestoreArrayRead(s->y, &yv));
  PetscCall(VecRestoreArrayRead(f, &fv));
  PetscCall(MPIU_Allreduce(&local, work, 1, MPIU_REAL, MPI_SUM, PetscObjectComm((PetscObject)f)));
  *work += beside(s);
  PetscFunctionReturn(0);
}

static PetscErrorCode EvaluateAt(void *context, PetscReal lambda, PetscReal *norm, PetscReal *slope)
{
  const Search *s = context;

  PetscFunctionBeginUser;
  PetscCall(VecWAXPY(s->w, -lambda, s->y, s->x));
  if (s->memory->place) s->memory->place(s->memory->context, lambda);
  if (s->memory->settle) PetscCall(s->memory->settle(s->memory->context, s->w));
  PetscCall(SNESComputeFunction(s->snes, s->w, s->f));
  PetscCall(VecNorm(s->f, NORM_2, norm));
  if (!PetscIsInfOrNanReal(*norm)) PetscCall(WorkAlong(s, s->f, slope));
  PetscFunctionReturn(0);
}

PetscErrorCode LineTry(Line *line, PetscReal lambda)
{
  PetscFunctionBeginUser;
  line->lambda = lambda;
  PetscCall(line->evaluate(line->context, lambda, &line->norm, &line->slope));
  if (PetscIsInfOrNanReal(line->norm)) line->norm = line->slope = PETSC_INFINITY;
  PetscFunctionReturn(0);
}

/* Is there too much left along the direction, or did the residual across it explode? */
static PetscBool is_too_far(const Line *line, PetscReal slope0, PetscReal norm0)
{
  return PetscAbsReal(line->slope) > line->enough * PetscAbsReal(slope0) || line->norm > EXPLODED * norm0;
}

/* Is where the slope vanishes farther away? Of a wary search a slope of the same sign that has grown lies beyond it: a
 * direction of Newton's begins with slope0 (1 - lambda), whatever its tangent is. */
static PetscBool is_before(const Line *line, PetscReal slope0, PetscReal norm0)
{
  const PetscBool grown = PetscAbsReal(line->slope) > PetscAbsReal(slope0);
  return line->slope * slope0 > 0 && !(line->wary && grown) && line->norm <= EXPLODED * norm0;
}

/* Find where the slope vanishes between low (is_before) and high (any other, or the law fails there). */
PetscErrorCode LineShorten(Line *line, PetscReal slope0, PetscReal norm0)
{
  PetscReal low = 0, slope_low = slope0, high = line->lambda, slope_high = line->slope;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < MAX_TRIES && is_too_far(line, slope0, norm0); ++k) {
    const PetscReal share =
      slope_high == PETSC_INFINITY || slope_low * slope_high >= 0 ? 0.5 : slope_low / (slope_low - slope_high);
    PetscCall(LineTry(line, low + PetscMax(0.1, PetscMin(0.9, share)) * (high - low)));
    if (is_before(line, slope0, norm0)) low = line->lambda, slope_low = line->slope;
    else high = line->lambda, slope_high = line->slope;
  }
  for (PetscInt k = 0; k < MAX_TRIES && line->norm == PETSC_INFINITY; ++k) PetscCall(LineTry(line, 0.5 * line->lambda));
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
  Search s = {.memory = memory};
  Line line = {.evaluate = EvaluateAt, .context = &s, .enough = s.memory->enough, .wary = s.memory->wary};
  Vec unused;
  PetscInt iteration;
  PetscReal xnorm, ynorm, norm0, slope0;

  PetscFunctionBeginUser;
  PetscCall(SNESLineSearchGetSNES(search, &s.snes));
  PetscCall(SNESLineSearchGetVecs(search, &s.x, &s.f, &s.y, &s.w, &unused));
  PetscCall(SNESGetIterationNumber(s.snes, &iteration));
  if (s.memory->begin) PetscCall(s.memory->begin(s.memory->context, s.x, s.y));
  PetscCall(WorkAlong(&s, s.f, &slope0));
  PetscCall(VecNorm(s.f, NORM_2, &norm0));
  if (s.memory->choose) PetscCall(s.memory->choose(s.memory->context, iteration, s.f, norm0));
  PetscCall(LineTry(&line, first_length(memory, iteration, norm0)));
  if (iteration || line.wary || line.norm == PETSC_INFINITY) PetscCall(LineShorten(&line, slope0, norm0));
  if (line.norm == PETSC_INFINITY) {
    PetscCall(SNESLineSearchSetReason(search, SNES_LINESEARCH_FAILED_NANORINF));
    PetscFunctionReturn(0);
  }
  if (s.memory->end) s.memory->end(s.memory->context, line.lambda);
  PetscCall(VecCopy(s.w, s.x));
  PetscCall(VecNorm(s.x, NORM_2, &xnorm));
  PetscCall(VecNorm(s.y, NORM_2, &ynorm));
  PetscCall(SNESLineSearchSetNorms(search, xnorm, line.norm, line.lambda * ynorm));
  PetscCall(SNESLineSearchSetLambda(search, line.lambda));
  PetscCall(SNESLineSearchSetReason(search, SNES_LINESEARCH_SUCCEEDED));
  PetscFunctionReturn(0);
}
