#include "solve/levels/two_levels.h"
#include "base/math/tensor.h"
#include "solve/blocks/blocks.h"
#include "solve/system/linear.h"

/* unknowns of the coarse nodes up to which they are factorised */
#define FACTORISE_COARSE 6000

enum { WORK_X, WORK_V, WORK_T };

typedef struct {
  const System *system;
  const Grid *grid;
  const unsigned char *fixed;
  PetscBool symmetric;
  Blocks *blocks;
  float *singles;
  PetscReal *inverse; /* of each row's scale */
  Mat interpolation, coarse;
  KSP solver;
  Vec fine, rest, correction; /* of the unknowns; of the coarse ones */
} TwoLevels;

static PetscErrorCode Clear(TwoLevels *t)
{
  PetscFunctionBeginUser;
  PetscCall(BlocksDestroy(&t->blocks));
  PetscCall(PetscFree(t->singles));
  PetscCall(PetscFree(t->inverse));
  PetscCall(MatDestroy(&t->interpolation));
  PetscCall(MatDestroy(&t->coarse));
  PetscCall(KSPDestroy(&t->solver));
  PetscCall(VecDestroy(&t->fine));
  PetscCall(VecDestroy(&t->rest));
  PetscCall(VecDestroy(&t->correction));
  PetscFunctionReturn(0);
}

/* The tangent as it is now, cut and closed, in blocks. */
static PetscErrorCode FillBlocks(TwoLevels *t)
{
  System s = *t->system;
  const PetscInt n = s.row_start[s.n_rows] * 9;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &t->singles));
  for (PetscInt i = 0; i < n; ++i) t->singles[i] = (float)s.values[i];
  s.singles = t->singles;
  PetscCall(BlocksCreate(&s, t->symmetric, &t->blocks));
  PetscCall(BlocksFill(t->blocks, &s));
  PetscCall(PetscFree(t->singles));
  PetscCall(PetscMalloc1(9 * t->blocks->n, &t->inverse));
  for (PetscInt r = 0; r < t->blocks->n && !t->blocks->singular; ++r) {
    PetscReal S[9];
    for (int i = 0; i < 9; ++i) S[i] = (PetscReal)t->blocks->scale[9 * r + i];
    (void)tensor_inverse(S, t->inverse + 9 * r);
  }
  PetscFunctionReturn(0);
}

/* Displacements of coarse nodes that no unknown follows stand alone. */
static PetscErrorCode CloseCoarse(Mat coarse)
{
  PetscReal *d, largest = 0, all;
  PetscInt n;
  Vec diagonal;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(coarse, &diagonal, NULL));
  PetscCall(MatGetDiagonal(coarse, diagonal));
  PetscCall(VecGetLocalSize(diagonal, &n));
  PetscCall(VecGetArray(diagonal, &d));
  for (PetscInt i = 0; i < n; ++i) largest = PetscMax(largest, d[i]);
  PetscCall(MPIU_Allreduce(&largest, &all, 1, MPIU_REAL, MPIU_MAX, PetscObjectComm((PetscObject)coarse)));
  for (PetscInt i = 0; i < n; ++i) d[i] = d[i] == 0 ? all : d[i];
  PetscCall(VecRestoreArray(diagonal, &d));
  PetscCall(MatDiagonalSet(coarse, diagonal, INSERT_VALUES));
  PetscCall(VecDestroy(&diagonal));
  PetscFunctionReturn(0);
}

/* Factorised while that is cheap, else one cycle of algebraic multigrid. */
static PetscErrorCode CreateSolver(TwoLevels *t, PC outer)
{
  PCFailedReason failed;
  const char *prefix;
  PetscInt unknowns;
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(t->coarse, &unknowns, NULL));
  PetscCall(KSPCreate(t->system->comm, &t->solver));
  PetscCall(PCGetOptionsPrefix(outer, &prefix));
  PetscCall(KSPSetOptionsPrefix(t->solver, prefix));
  PetscCall(KSPAppendOptionsPrefix(t->solver, "coarse_"));
  PetscCall(KSPSetType(t->solver, KSPPREONLY));
  PetscCall(KSPSetOperators(t->solver, t->coarse, t->coarse));
  PetscCall(KSPGetPC(t->solver, &pc));
  if (unknowns > FACTORISE_COARSE) PetscCall(LinearMultigrid(pc));
  else {
    PetscCall(PCSetType(pc, t->symmetric ? PCCHOLESKY : PCLU));
    PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  }
  PetscCall(KSPSetFromOptions(t->solver));
  PetscCall(KSPSetUp(t->solver));
  PetscCall(PCGetFailedReason(pc, &failed));
  if (failed) PetscCall(PCSetFailedReason(outer, PC_SUBPC_ERROR)); /* a factorisation of all takes over */
  PetscFunctionReturn(0);
}

static PetscErrorCode SetUp(PC pc)
{
  MatNullSpace motions;
  TwoLevels *t;
  Mat A;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &t));
  PetscCall(PCGetOperators(pc, NULL, &A));
  PetscCall(Clear(t));
  PetscCall(FillBlocks(t));
  if (t->blocks->singular) PetscCall(PCSetFailedReason(pc, PC_SUBPC_ERROR));
  if (t->blocks->singular) PetscFunctionReturn(0);
  PetscCall(CoarseBoxInterpolation(t->system, t->grid, t->fixed, &t->interpolation, &motions));
  PetscCall(MatPtAP(A, t->interpolation, MAT_INITIAL_MATRIX, 1, &t->coarse));
  PetscCall(MatSetBlockSize(t->coarse, 3));
  PetscCall(CloseCoarse(t->coarse));
  if (t->symmetric) PetscCall(MatSetOption(t->coarse, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatSetNearNullSpace(t->coarse, motions));
  PetscCall(MatNullSpaceDestroy(&motions));
  PetscCall(MatCreateVecs(t->interpolation, &t->rest, &t->fine));
  PetscCall(VecDuplicate(t->rest, &t->correction));
  PetscCall(CreateSolver(t, pc));
  PetscFunctionReturn(0);
}

/* r = -S^-1 (U + O) x: what a sweep forward from nothing leaves. */
static PetscErrorCode LeftBySweep(const TwoLevels *t, const float *x, PetscReal *r)
{
  const Blocks *m = t->blocks;
  PetscInt outer = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->n; ++k) {
    Lanes v = row_add(3, &m->upper, k, x, (Lanes){0, 0, 0, 0});
    if (outer < m->n_outer && m->outer_row[outer] == k) v = row_add(3, &m->outer, outer++, x, v);
    const PetscReal *S = t->inverse + 9 * k;
    for (int i = 0; i < 3; ++i)
      r[3 * k + i] = -(S[3 * i] * (PetscReal)v[0] + S[3 * i + 1] * (PetscReal)v[1] + S[3 * i + 2] * (PetscReal)v[2]);
  }
  PetscFunctionReturn(0);
}

/* x += T^-1 e */
static void add_correction(const TwoLevels *t, const PetscReal *e, float *x)
{
  for (PetscInt k = 0; k < t->blocks->n; ++k)
    for (int i = 0; i < 3; ++i) {
      PetscReal sum = t->symmetric ? 0 : e[3 * k + i];
      for (int j = 0; t->symmetric && j < 3; ++j) sum += t->inverse[9 * k + 3 * j + i] * e[3 * k + j];
      x[4 * k + i] += (float)sum;
    }
}

/* v = S b factor - (L + O) x: what a sweep back begins with. */
static void right_side(const Blocks *m, const PetscReal *b, PetscReal factor, const float *x, float *v)
{
  PetscInt outer = 0;
  for (PetscInt k = 0; k < m->n; ++k) {
    const float *S = m->scale + 9 * k;
    PetscReal sum[3] = {0, 0, 0};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum[i] += (PetscReal)S[3 * i + j] * b[3 * k + j];
    Lanes from = row_forward(3, &m->lower, k, x, node_from_doubles(3, sum, factor));
    if (outer < m->n_outer && m->outer_row[outer] == k) from = row_forward(3, &m->outer, outer++, x, from);
    node_store(3, from, v + 4 * k);
  }
}

static PetscErrorCode Correct(const TwoLevels *t, float *x)
{
  const PetscReal *e;
  PetscReal *r;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayWrite(t->fine, &r));
  PetscCall(LeftBySweep(t, x, r));
  PetscCall(VecRestoreArrayWrite(t->fine, &r));
  PetscCall(MatMultTranspose(t->interpolation, t->fine, t->rest));
  PetscCall(KSPSolve(t->solver, t->rest, t->correction));
  PetscCall(MatMult(t->interpolation, t->correction, t->fine));
  PetscCall(VecGetArrayRead(t->fine, &e));
  add_correction(t, e, x);
  PetscCall(VecRestoreArrayRead(t->fine, &e));
  PetscFunctionReturn(0);
}

static PetscErrorCode Apply(PC pc, Vec b, Vec y)
{
  const PetscReal *in;
  PetscReal *out, size;
  float *x, *v, *w;
  TwoLevels *t;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &t));
  const BlockSweeps *sweeps = block_sweeps(3);
  PetscCall(BlocksWork(t->blocks, WORK_X, &x));
  PetscCall(BlocksWork(t->blocks, WORK_V, &v));
  PetscCall(BlocksWork(t->blocks, WORK_T, &w));
  PetscCall(VecNorm(b, NORM_2, &size));
  if (size == 0) size = 1;
  PetscCall(VecGetArrayRead(b, &in));
  (void)sweeps->start(t->blocks, in, 1 / size, x);
  PetscCall(BlocksExchange(t->blocks, x));
  PetscCall(Correct(t, x));
  PetscCall(BlocksExchange(t->blocks, x));
  right_side(t->blocks, in, 1 / size, x, v);
  PetscCall(VecRestoreArrayRead(b, &in));
  PetscCall(VecGetArrayWrite(y, &out));
  sweeps->finish(t->blocks, v, size, w, out);
  PetscCall(VecRestoreArrayWrite(y, &out));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(PC pc)
{
  TwoLevels *t;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &t));
  PetscCall(Clear(t));
  PetscCall(PetscFree(t));
  PetscFunctionReturn(0);
}

PetscErrorCode TwoLevelsConfigure(PC pc, const System *system, const Grid *grid, const unsigned char *fixed,
                                  PetscBool symmetric)
{
  TwoLevels *t;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&t));
  t->system = system;
  t->grid = grid;
  t->fixed = fixed;
  t->symmetric = symmetric;
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, t));
  PetscCall(PCShellSetName(pc, "two levels in a box"));
  PetscCall(PCShellSetSetUp(pc, SetUp));
  PetscCall(PCShellSetApply(pc, Apply));
  PetscCall(PCShellSetDestroy(pc, Destroy));
  PetscFunctionReturn(0);
}
