/* Conjugate gradients and BiCGStab on Blocks, as a KSP: tolerances, monitors and views are PETSc's.
 *
 * Both work on the matrix between the two halves of Gauss-Seidel and on the right-hand side divided
 * by its norm, which keeps single precision within its range. Sums are double. PETSc's own methods
 * on a shell of that matrix, with vectors in double, take as many iterations and 1.6 times as long:
 * 6 % of a step of the falling block, 5 % of the granular column. A method tells its iterations and
 * its reason through PETSc's private header alone. */
#include <petsc/private/kspimpl.h>
#include "base/process/denormals.h"
#include "solve/blocks/block_vectors.h"
#include "solve/blocks/blocks.h"
#include "solve/blocks/projection.h"

enum { WORK_R, WORK_P, WORK_T, WORK_Y, WORK_X, WORK_SHADOW, WORK_V };

typedef struct {
  Blocks *m;
  const BlockSweeps *sweeps;
  PetscInt n;     /* numbers of a vector */
  PetscReal size; /* of the right-hand side */
  float *r, *p, *t, *y, *x, *shadow, *v;
} Solve;

static PetscErrorCode Sum(const Solve *s, int n, double *values)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, n, MPI_DOUBLE, MPI_SUM, s->m->comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode Report(KSP ksp, const Solve *s, double norm2, PetscBool *stop)
{
  PetscFunctionBeginUser;
  ksp->rnorm = s->size * PetscSqrtReal(norm2);
  PetscCall(KSPLogResidualHistory(ksp, ksp->rnorm));
  PetscCall(KSPMonitor(ksp, ksp->its, ksp->rnorm));
  PetscCall((*ksp->converged)(ksp, ksp->its, ksp->rnorm, &ksp->reason, ksp->cnvP));
  if (!ksp->reason && ksp->its >= ksp->max_it) ksp->reason = KSP_DIVERGED_ITS;
  *stop = ksp->reason != 0;
  PetscFunctionReturn(0);
}

/* t, y with t + y = (1 + L)^-1 A (1 + U)^-1 p for p = r + beta p; dot = q . (t + y). */
static PetscErrorCode Apply(const Solve *s, const float *r, double beta, float *p, const float *q, double *dot)
{
  PetscFunctionBeginUser;
  s->sweeps->backward(s->m, r, beta, p, s->t);
  PetscCall(BlocksExchange(s->m, s->t));
  *dot = s->sweeps->forward(s->m, p, s->t, q, s->y);
  PetscFunctionReturn(0);
}

static PetscErrorCode ConjugateGradients(KSP ksp, Solve *s, double rr)
{
  PetscBool stop;
  double last = 1, pw;

  PetscFunctionBeginUser;
  PetscCall(Report(ksp, s, rr, &stop));
  while (!stop) {
    PetscCall(Apply(s, s->r, ksp->its ? rr / last : 0, s->p, s->p, &pw));
    PetscCall(Sum(s, 1, &pw));
    if (!(pw > 0)) {
      ksp->reason = pw <= 0 ? KSP_DIVERGED_INDEFINITE_MAT : KSP_DIVERGED_NANORINF;
      break;
    }
    last = rr;
    rr = vectors_step(s->n, (float)(rr / pw), s->p, s->t, s->y, s->x, s->r);
    PetscCall(Sum(s, 1, &rr));
    ++ksp->its;
    PetscCall(Report(ksp, s, rr, &stop));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode BiCGStab(KSP ksp, Solve *s, double rr)
{
  PetscBool stop;
  double sums[2] = {rr, rr}, last = 1, alpha = 0, omega = 1, dots[2];
  float *none;

  PetscFunctionBeginUser;
  PetscCall(BlocksWork(s->m, WORK_SHADOW, &s->shadow));
  PetscCall(BlocksWork(s->m, WORK_V, &s->v));
  PetscCall(PetscArraycpy(s->shadow, s->r, s->n));
  PetscCall(PetscCalloc1(s->m->n_columns * block_stride((int)s->m->dim), &none));
  PetscCall(Report(ksp, s, rr, &stop));
  while (!stop) {
    const double rho = sums[1];
    PetscCall(Apply(s, s->r, ksp->its ? rho / last * (alpha / omega) : 0, s->p, s->shadow, &dots[0]));
    PetscCall(Sum(s, 1, dots));
    ksp->reason = dots[0] == 0 || rho == 0 ? KSP_DIVERGED_BREAKDOWN : KSP_CONVERGED_ITERATING;
    if (ksp->reason) break;
    alpha = rho / dots[0];
    vectors_half_step(s->n, (float)alpha, s->t, s->y, s->v, s->r);
    PetscCall(Apply(s, none, 1, s->r, s->r, &dots[0]));
    dots[1] = vectors_norm2(s->n, s->t, s->y);
    PetscCall(Sum(s, 2, dots));
    omega = dots[1] > 0 ? dots[0] / dots[1] : 0;
    vectors_full_step(s->n, (float)alpha, (float)omega, s->t, s->y, s->v, s->shadow, s->x, s->r, s->p, sums);
    PetscCall(Sum(s, 2, sums));
    last = rho;
    ++ksp->its;
    PetscCall(Report(ksp, s, sums[0], &stop));
    if (!stop && omega == 0) {
      ksp->reason = KSP_DIVERGED_BREAKDOWN;
      break;
    }
  }
  PetscCall(PetscFree(none));
  PetscFunctionReturn(0);
}

/* x = 0, and the residual r with its square. */
static PetscErrorCode Start(Solve *s, const PetscReal *b, double *norm2)
{
  PetscFunctionBeginUser;
  PetscCall(BlocksWork(s->m, WORK_R, &s->r));
  PetscCall(BlocksWork(s->m, WORK_P, &s->p));
  PetscCall(BlocksWork(s->m, WORK_T, &s->t));
  PetscCall(BlocksWork(s->m, WORK_Y, &s->y));
  PetscCall(BlocksWork(s->m, WORK_X, &s->x));
  *norm2 = s->sweeps->start(s->m, b, 1 / s->size, s->r);
  PetscCall(Sum(s, 1, norm2));
  PetscFunctionReturn(0);
}

/* One solve from u = 0; *indefinite: conjugate gradients met a matrix that is not theirs, BiCGStab
 * went on. */
static PetscErrorCode SolveOnBlocks(KSP ksp, Blocks *m, const PetscReal *b, PetscReal *u, PetscBool *indefinite)
{
  Solve s = {.m = m, .sweeps = block_sweeps(m->dim), .n = m->n * block_stride((int)m->dim)};
  double norm2;

  PetscFunctionBeginUser;
  norm2 = s.sweeps->scaled_norm2(m, b);
  PetscCall(Sum(&s, 1, &norm2));
  s.size = PetscSqrtReal(norm2);
  if (!(s.size > 0) || PetscIsInfReal(s.size)) {
    ksp->reason = s.size == 0 ? KSP_CONVERGED_ATOL : KSP_DIVERGED_NANORINF;
    ksp->rnorm = s.size;
    PetscCall(PetscArrayzero(u, m->n * m->dim));
    PetscFunctionReturn(0);
  }
  PetscCall(Start(&s, b, &norm2));
  if (m->symmetric && !*indefinite) PetscCall(ConjugateGradients(ksp, &s, norm2));
  if (ksp->reason == KSP_DIVERGED_INDEFINITE_MAT) {
    *indefinite = PETSC_TRUE;
    ksp->reason = KSP_CONVERGED_ITERATING;
    PetscCall(Start(&s, b, &norm2));
  }
  if (!ksp->reason) PetscCall(BiCGStab(ksp, &s, norm2));
  s.sweeps->finish(m, s.x, s.size, s.t, u);
  PetscFunctionReturn(0);
}

/* On an indefinite matrix residuals grow by orders on their way, and in single precision the one
 * that BiCGStab carries along is no longer that of its solution. So what is left is looked at and,
 * unless it is as small as asked for, solved for once more. */
static PetscErrorCode Refine(KSP ksp, Blocks *m, Mat A)
{
  PetscBool indefinite = PETSC_TRUE;
  const PetscReal *r;
  PetscReal *more, left, whole;
  Vec rest, correction;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(ksp->vec_sol, &rest));
  PetscCall(VecDuplicate(ksp->vec_sol, &correction));
  PetscCall(MatMult(A, ksp->vec_sol, rest));
  PetscCall(VecAYPX(rest, -1, ksp->vec_rhs));
  PetscCall(VecNorm(rest, NORM_2, &left));
  PetscCall(VecNorm(ksp->vec_rhs, NORM_2, &whole));
  if (left > ksp->rtol * whole) {
    const KSPConvergedReason reached = ksp->reason;
    ksp->reason = KSP_CONVERGED_ITERATING;
    PetscCall(VecGetArrayRead(rest, &r));
    PetscCall(VecGetArrayWrite(correction, &more));
    PetscCall(SolveOnBlocks(ksp, m, r, more, &indefinite));
    PetscCall(VecRestoreArrayWrite(correction, &more));
    PetscCall(VecRestoreArrayRead(rest, &r));
    if (ksp->reason > 0) PetscCall(VecAXPY(ksp->vec_sol, 1, correction));
    ksp->reason = reached;
  }
  PetscCall(VecDestroy(&rest));
  PetscCall(VecDestroy(&correction));
  PetscFunctionReturn(0);
}

/* What the iteration did not solve, by factors; KSP_CONVERGED_ITS tells it (LinearSolved in solve/newton). */
static PetscErrorCode Rescue(KSP ksp, Blocks *m, const PetscReal *b, PetscReal *u)
{
  PetscBool solved;

  PetscFunctionBeginUser;
  PetscCall(BlocksFactorSolve(m, b, u, &solved));
  if (solved) ksp->reason = KSP_CONVERGED_ITS;
  PetscFunctionReturn(0);
}

static PetscErrorCode KSPSolve_Blocks(KSP ksp)
{
  Blocks *m;
  Mat A;
  const PetscReal *b;
  PetscReal *u;
  PetscBool indefinite = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(KSPGetOperators(ksp, &A, NULL));
  PetscCall(MatShellGetContext(A, &m));
  ksp->its = 0;
  ksp->reason = KSP_CONVERGED_ITERATING;
  if (m->singular || (m->projection && m->projection->singular)) {
    PetscCall(VecZeroEntries(ksp->vec_sol));
    ksp->reason = KSP_DIVERGED_INDEFINITE_PC;
    PetscFunctionReturn(0);
  }
  PetscCall(VecGetArrayRead(ksp->vec_rhs, &b));
  PetscCall(VecGetArrayWrite(ksp->vec_sol, &u));
  const unsigned mode = denormals_flush();
  if (m->projection) PetscCall(BlocksSolveProjected(ksp, m, b, u, &ksp->its, &ksp->reason));
  else PetscCall(SolveOnBlocks(ksp, m, b, u, &indefinite));
  if (ksp->reason < 0 && *(PetscBool *)ksp->data && !m->projection) PetscCall(Rescue(ksp, m, b, u));
  PetscCall(VecRestoreArrayWrite(ksp->vec_sol, &u));
  PetscCall(VecRestoreArrayRead(ksp->vec_rhs, &b));
  if (indefinite && ksp->reason > 0 && ksp->reason != KSP_CONVERGED_ITS) PetscCall(Refine(ksp, m, A));
  denormals_restore(mode);
  PetscFunctionReturn(0);
}

static PetscErrorCode KSPSetUp_Blocks(KSP ksp)
{
  Mat A;
  PetscBool shell;

  PetscFunctionBeginUser;
  PetscCall(KSPGetOperators(ksp, &A, NULL));
  PetscCall(PetscObjectTypeCompare((PetscObject)A, MATSHELL, &shell));
  PetscCheck(shell, PetscObjectComm((PetscObject)ksp), PETSC_ERR_SUP, "%s works on blocks only", KSPBLOCKS);
  PetscFunctionReturn(0);
}

static PetscErrorCode KSPView_Blocks(KSP ksp, PetscViewer viewer)
{
  PetscBool text;

  PetscFunctionBeginUser;
  (void)ksp;
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &text));
  if (text) PetscCall(PetscViewerASCIIPrintf(viewer, "  symmetric Gauss-Seidel on blocks in single precision\n"));
  PetscFunctionReturn(0);
}

static PetscErrorCode KSPCreate_Blocks(KSP ksp)
{
  PetscBool *may_factor;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&may_factor));
  ksp->data = may_factor;
  PetscCall(KSPSetSupportedNorm(ksp, KSP_NORM_PRECONDITIONED, PC_LEFT, 2));
  PetscCall(KSPSetSupportedNorm(ksp, KSP_NORM_NONE, PC_LEFT, 1));
  ksp->ops->setup = KSPSetUp_Blocks;
  ksp->ops->solve = KSPSolve_Blocks;
  ksp->ops->destroy = KSPDestroyDefault;
  ksp->ops->view = KSPView_Blocks;
  ksp->ops->buildsolution = KSPBuildSolutionDefault;
  ksp->ops->buildresidual = KSPBuildResidualDefault;
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksRegister(void)
{
  PetscFunctionBeginUser;
  PetscCall(KSPRegister(KSPBLOCKS, KSPCreate_Blocks));
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksMayFactor(KSP ksp, PetscBool may)
{
  PetscFunctionBeginUser;
  *(PetscBool *)ksp->data = may;
  PetscFunctionReturn(0);
}
