/* The Krylov methods of blocks_ksp.c where constraints hold: Gauss-Seidel between two projections, sums and vectors in double. */
#include <petsc/private/kspimpl.h>
#include "solve/blocks/blocks.h"
#include "solve/blocks/projection.h"

enum { VECTOR_R, VECTOR_Z, VECTOR_P, VECTOR_Q, VECTOR_SHADOW, VECTOR_S, VECTORS };

typedef struct {
  Blocks *m;
  Projection *projection;
  const BlockSweeps *sweeps;
  BlocksProduct product;
  PetscInt n;
  PetscReal size; /* of the right-hand side: keeps single precision within its range */
  float *x, *t;
  PetscReal *v[VECTORS];
} Solve;

static PetscErrorCode Dot(const Solve *s, const PetscReal *a, const PetscReal *b, PetscReal *dot)
{
  PetscReal sum = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n; ++i) sum += a[i] * b[i];
  PetscCall(MPIU_Allreduce(&sum, dot, 1, MPIU_REAL, MPI_SUM, s->m->comm));
  PetscFunctionReturn(0);
}

/* z = P M^-1 r for a projected r */
static PetscErrorCode Precondition(const Solve *s, const PetscReal *r, PetscReal *z)
{
  PetscFunctionBeginUser;
  (void)s->sweeps->start(s->m, r, 1 / s->size, s->x);
  s->sweeps->finish(s->m, s->x, s->size, s->t, z);
  PetscCall(ProjectionMotion(s->projection, z));
  PetscFunctionReturn(0);
}

/* q = P^T K z for the z that Precondition gave last */
static PetscErrorCode Apply(const Solve *s, const PetscReal *z, PetscReal *q)
{
  PetscFunctionBeginUser;
  PetscCall(BlocksProductApply(&s->product, s->size, z, s->x, s->t, q));
  projection_weaken(s->projection, z, q);
  PetscCall(ProjectionForces(s->projection, q));
  PetscFunctionReturn(0);
}

static PetscErrorCode Report(KSP ksp, PetscReal norm2, PetscBool *stop)
{
  PetscFunctionBeginUser;
  ksp->rnorm = PetscSqrtReal(PetscMax(norm2, 0));
  PetscCall(KSPLogResidualHistory(ksp, ksp->rnorm));
  PetscCall(KSPMonitor(ksp, ksp->its, ksp->rnorm));
  PetscCall((*ksp->converged)(ksp, ksp->its, ksp->rnorm, &ksp->reason, ksp->cnvP));
  if (!ksp->reason && ksp->its >= ksp->max_it) ksp->reason = KSP_DIVERGED_ITS;
  *stop = ksp->reason != 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode ConjugateGradients(KSP ksp, const Solve *s, PetscReal *y)
{
  PetscReal *r = s->v[VECTOR_R], *z = s->v[VECTOR_Z], *p = s->v[VECTOR_P], *q = s->v[VECTOR_Q], *Kz = s->v[VECTOR_S];
  PetscReal rz, last = 1, pq;
  PetscBool stop;

  PetscFunctionBeginUser;
  PetscCall(Precondition(s, r, z));
  PetscCall(Dot(s, r, z, &rz));
  PetscCall(Report(ksp, rz, &stop));
  while (!stop) {
    const PetscReal beta = ksp->its ? rz / last : 0;
    PetscCall(Apply(s, z, Kz));
    for (PetscInt i = 0; i < s->n; ++i) p[i] = z[i] + beta * p[i], q[i] = Kz[i] + beta * q[i];
    PetscCall(Dot(s, p, q, &pq));
    if (!(pq > 0)) {
      ksp->reason = pq <= 0 ? KSP_DIVERGED_INDEFINITE_MAT : KSP_DIVERGED_NANORINF;
      break;
    }
    const PetscReal alpha = rz / pq;
    for (PetscInt i = 0; i < s->n; ++i) y[i] += alpha * p[i], r[i] -= alpha * q[i];
    PetscCall(Precondition(s, r, z));
    last = rz;
    PetscCall(Dot(s, r, z, &rz));
    ++ksp->its;
    PetscCall(Report(ksp, rz, &stop));
  }
  PetscFunctionReturn(0);
}

/* With the preconditioner on the right; the norm is that of the preconditioned residual where an iteration begins. */
static PetscErrorCode BiCGStab(KSP ksp, const Solve *s, PetscReal *y)
{
  PetscReal *r = s->v[VECTOR_R], *z = s->v[VECTOR_Z], *p = s->v[VECTOR_P], *q = s->v[VECTOR_Q],
            *shadow = s->v[VECTOR_SHADOW], *t = s->v[VECTOR_S];
  PetscReal rho, last = 1, alpha = 0, omega = 1, dot, square, norm2;
  PetscBool stop;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(shadow, r, s->n));
  PetscCall(PetscArrayzero(q, s->n));
  norm2 = s->sweeps->scaled_norm2(s->m, r);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &norm2, 1, MPIU_REAL, MPI_SUM, s->m->comm));
  PetscCall(Report(ksp, norm2, &stop));
  while (!stop) {
    PetscCall(Dot(s, shadow, r, &rho));
    const PetscReal beta = ksp->its ? rho / last * (alpha / omega) : 0;
    for (PetscInt i = 0; i < s->n; ++i) p[i] = r[i] + (ksp->its ? beta * (p[i] - omega * q[i]) : 0);
    PetscCall(Precondition(s, p, z));
    PetscCall(Apply(s, z, q));
    PetscCall(Dot(s, shadow, q, &dot));
    ksp->reason = dot == 0 || rho == 0 ? KSP_DIVERGED_BREAKDOWN : KSP_CONVERGED_ITERATING;
    if (ksp->reason) break;
    alpha = rho / dot;
    for (PetscInt i = 0; i < s->n; ++i) y[i] += alpha * z[i], r[i] -= alpha * q[i];
    PetscCall(Precondition(s, r, z));
    PetscCall(Apply(s, z, t));
    PetscCall(Dot(s, t, r, &dot));
    PetscCall(Dot(s, t, t, &square));
    omega = square > 0 ? dot / square : 0;
    for (PetscInt i = 0; i < s->n; ++i) y[i] += omega * z[i], r[i] -= omega * t[i];
    last = rho;
    ++ksp->its;
    norm2 = s->sweeps->scaled_norm2(s->m, r);
    PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &norm2, 1, MPIU_REAL, MPI_SUM, s->m->comm));
    PetscCall(Report(ksp, norm2, &stop));
    if (!stop && omega == 0) {
      ksp->reason = KSP_DIVERGED_BREAKDOWN;
      break;
    }
  }
  PetscFunctionReturn(0);
}

/* r = f - K y without what stands on the twins */
static PetscErrorCode Residual(const Solve *s, const PetscReal *f, const PetscReal *y, PetscReal *r)
{
  PetscFunctionBeginUser;
  PetscCall(ProjectionMultiply(s->projection, y, r));
  for (PetscInt i = 0; i < s->n; ++i) r[i] = f[i] - r[i];
  for (PetscInt k = 0; k < s->projection->n_own; ++k) r[s->projection->twin[k]] = 0;
  PetscFunctionReturn(0);
}

/* y closes the gaps, r is what is left then, s->size its norm. */
static PetscErrorCode Start(Solve *s, const PetscReal *f, PetscReal *y)
{
  PetscReal norm2;

  PetscFunctionBeginUser;
  for (int k = 0; k < VECTORS; ++k) PetscCall(PetscArrayzero(s->v[k], s->n));
  PetscCall(ProjectionCloseGaps(s->projection, f, y));
  PetscCall(Residual(s, f, y, s->v[VECTOR_R]));
  PetscCall(ProjectionForces(s->projection, s->v[VECTOR_R]));
  norm2 = s->sweeps->scaled_norm2(s->m, s->v[VECTOR_R]);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &norm2, 1, MPIU_REAL, MPI_SUM, s->m->comm));
  s->size = PetscSqrtReal(norm2);
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksSolveProjected(KSP ksp, Blocks *m, const PetscReal *f, PetscReal *y)
{
  Solve s = {.m = m, .projection = m->projection, .sweeps = block_sweeps(m->dim), .n = m->n * m->dim};

  PetscFunctionBeginUser;
  PetscCall(BlocksWork(m, 0, &s.x));
  PetscCall(BlocksWork(m, 1, &s.t));
  for (int k = 0; k < VECTORS; ++k) PetscCall(PetscMalloc1(s.n, &s.v[k]));
  PetscCall(BlocksProductCreate(m, m->projection->n_dofs, m->projection->place, &s.product));
  PetscCall(Start(&s, f, y));
  if (!(s.size > 0) || PetscIsInfReal(s.size)) ksp->reason = s.size == 0 ? KSP_CONVERGED_ATOL : KSP_DIVERGED_NANORINF;
  if (!ksp->reason && m->symmetric) PetscCall(ConjugateGradients(ksp, &s, y));
  if (blocks_are_indefinite(ksp)) PetscCall(Start(&s, f, y));
  if (!ksp->reason) PetscCall(BiCGStab(ksp, &s, y));
  PetscCall(Residual(&s, f, y, s.v[VECTOR_R]));
  PetscCall(ProjectionMultipliers(s.projection, s.v[VECTOR_R], y));
  for (int k = 0; k < VECTORS; ++k) PetscCall(PetscFree(s.v[k]));
  PetscCall(BlocksProductDestroy(&s.product));
  PetscFunctionReturn(0);
}
