/* PETSc's conjugate gradients and BiCGStab where constraints hold, preconditioned by Gauss-Seidel
 * between two projections; sums and vectors in double. Both are used in forms that multiply what
 * the preconditioner gave last: the product takes over half of it (blocks_product.c). */
#include "solve/blocks/blocks.h"
#include "solve/blocks/projection.h"

typedef struct {
  Blocks *m;
  Projection *projection;
  const BlockSweeps *sweeps;
  BlocksProduct product;
  PetscInt n;
  PetscReal size; /* of the right-hand side: keeps single precision within its range */
  float *half, *t;
  Vec r, y; /* what is left of the right-hand side without a motion, and the motion */
} Solve;

/* z = P M^-1 r for a projected r */
static PetscErrorCode Precondition(PC pc, Vec r, Vec z)
{
  Solve *s;
  const PetscReal *in;
  PetscReal *out;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &s));
  PetscCall(VecGetArrayRead(r, &in));
  PetscCall(VecGetArrayWrite(z, &out));
  (void)s->sweeps->start(s->m, in, 1 / s->size, s->half);
  s->sweeps->finish(s->m, s->half, s->size, s->t, out);
  PetscCall(ProjectionMotion(s->projection, out));
  PetscCall(VecRestoreArrayWrite(z, &out));
  PetscCall(VecRestoreArrayRead(r, &in));
  PetscFunctionReturn(0);
}

/* q = P^T K z for the z that Precondition gave last */
static PetscErrorCode Multiply(Mat matrix, Vec z, Vec q)
{
  Solve *s;
  const PetscReal *in;
  PetscReal *out;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(matrix, &s));
  PetscCall(VecGetArrayRead(z, &in));
  PetscCall(VecGetArrayWrite(q, &out));
  PetscCall(BlocksProductApply(&s->product, s->size, in, s->half, s->t, out));
  projection_weaken(s->projection, in, out);
  PetscCall(ProjectionForces(s->projection, out));
  PetscCall(VecRestoreArrayWrite(q, &out));
  PetscCall(VecRestoreArrayRead(z, &in));
  PetscFunctionReturn(0);
}

/* r = f - K u without what stands on the twins */
static PetscErrorCode Residual(const Solve *s, const PetscReal *f, const PetscReal *u, PetscReal *r)
{
  PetscFunctionBeginUser;
  PetscCall(ProjectionMultiply(s->projection, u, r));
  for (PetscInt i = 0; i < s->n; ++i) r[i] = f[i] - r[i];
  for (PetscInt k = 0; k < s->projection->n_own; ++k) r[s->projection->twin[k]] = 0;
  PetscFunctionReturn(0);
}

/* u closes the gaps, r is what is left then, s->size its norm. */
static PetscErrorCode Start(Solve *s, const PetscReal *f, PetscReal *u)
{
  PetscReal *r, norm2;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayWrite(s->r, &r));
  PetscCall(ProjectionCloseGaps(s->projection, f, u));
  PetscCall(Residual(s, f, u, r));
  PetscCall(ProjectionForces(s->projection, r));
  norm2 = s->sweeps->scaled_norm2(s->m, r);
  PetscCall(VecRestoreArrayWrite(s->r, &r));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &norm2, 1, MPIU_REAL, MPI_SUM, s->m->comm));
  s->size = PetscSqrtReal(norm2);
  PetscFunctionReturn(0);
}

static PetscErrorCode Finish(const Solve *s, const PetscReal *f, PetscReal *u)
{
  const PetscReal *y;
  PetscReal *r;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(s->y, &y));
  for (PetscInt i = 0; i < s->n; ++i) u[i] += y[i];
  PetscCall(VecRestoreArrayRead(s->y, &y));
  PetscCall(VecGetArrayWrite(s->r, &r));
  PetscCall(Residual(s, f, u, r));
  PetscCall(ProjectionMultipliers(s->projection, r, u));
  PetscCall(VecRestoreArrayWrite(s->r, &r));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tell(KSP method, PetscInt iteration, PetscReal norm, void *asked)
{
  (void)method;
  PetscFunctionBeginUser;
  PetscCall(KSPMonitor(asked, iteration, norm));
  PetscFunctionReturn(0);
}

/* A method with the tolerances of `asked`, whose monitors it tells. */
static PetscErrorCode CreateMethod(KSP asked, Solve *s, KSP *method)
{
  PetscReal relative, absolute, divergence;
  PetscInt most;
  Mat matrix;
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(MatCreateShell(s->m->comm, s->n, s->n, PETSC_DETERMINE, PETSC_DETERMINE, s, &matrix));
  PetscCall(MatShellSetOperation(matrix, MATOP_MULT, (void (*)(void))Multiply));
  PetscCall(MatCreateVecs(matrix, &s->y, &s->r));
  PetscCall(KSPCreate(s->m->comm, method));
  PetscCall(KSPSetOperators(*method, matrix, matrix));
  PetscCall(MatDestroy(&matrix));
  PetscCall(KSPGetPC(*method, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, s));
  PetscCall(PCShellSetApply(pc, Precondition));
  PetscCall(KSPGetTolerances(asked, &relative, &absolute, &divergence, &most));
  PetscCall(KSPSetTolerances(*method, relative, absolute, divergence, most));
  PetscCall(KSPMonitorSet(*method, Tell, asked, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveBy(KSP method, PetscBool symmetric, Solve *s, PetscInt *its, KSPConvergedReason *reason)
{
  PetscInt more;

  PetscFunctionBeginUser;
  PetscCall(KSPSetType(method, symmetric ? KSPCG : KSPBCGS));
  if (symmetric) PetscCall(KSPCGUseSingleReduction(method, PETSC_TRUE));
  PetscCall(KSPSetNormType(method, symmetric ? KSP_NORM_NATURAL : KSP_NORM_UNPRECONDITIONED));
  PetscCall(KSPSetPCSide(method, symmetric ? PC_LEFT : PC_RIGHT));
  PetscCall(KSPSolve(method, s->r, s->y));
  PetscCall(KSPGetConvergedReason(method, reason));
  PetscCall(KSPGetIterationNumber(method, &more));
  *its += more;
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksSolveProjected(KSP asked, Blocks *m, const PetscReal *f, PetscReal *u, PetscInt *its,
                                    KSPConvergedReason *reason)
{
  Solve s = {.m = m, .projection = m->projection, .sweeps = block_sweeps(m->dim), .n = m->n * m->dim};
  KSP method;

  PetscFunctionBeginUser;
  PetscCall(BlocksWork(m, 0, &s.half));
  PetscCall(BlocksWork(m, 1, &s.t));
  PetscCall(BlocksProductCreate(m, m->projection->n_dofs, m->projection->place, &s.product));
  PetscCall(CreateMethod(asked, &s, &method));
  PetscCall(Start(&s, f, u));
  if (s.size == 0 || PetscIsInfOrNanReal(s.size)) *reason = s.size == 0 ? KSP_CONVERGED_ATOL : KSP_DIVERGED_NANORINF;
  else PetscCall(SolveBy(method, m->symmetric, &s, its, reason));
  if (m->symmetric && *reason == KSP_DIVERGED_INDEFINITE_MAT) PetscCall(SolveBy(method, PETSC_FALSE, &s, its, reason));
  PetscCall(Finish(&s, f, u));
  PetscCall(KSPDestroy(&method));
  PetscCall(VecDestroy(&s.r));
  PetscCall(VecDestroy(&s.y));
  PetscCall(BlocksProductDestroy(&s.product));
  PetscFunctionReturn(0);
}
