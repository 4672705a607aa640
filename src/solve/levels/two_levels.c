#include "solve/levels/two_levels.h"
#include "solve/blocks/blocks.h"
#include "solve/levels/coarse_product.h"
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
  PetscReal *inverse;  /* of each row's scale */
  unsigned char *held; /* fixed as it was when the box was made */
  CoarseBox *box;
  Mat coarse;
  KSP solver;
  Vec fine, rest, correction; /* of the unknowns; of the coarse ones */
} TwoLevels;

/* What stands as long as the same unknowns are prescribed. */
static PetscErrorCode ClearCoarse(TwoLevels *t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(t->held));
  PetscCall(CoarseBoxDestroy(&t->box));
  PetscCall(VecDestroy(&t->fine));
  PetscCall(VecDestroy(&t->rest));
  PetscCall(VecDestroy(&t->correction));
  PetscFunctionReturn(0);
}

/* What belongs to one tangent. */
static PetscErrorCode ClearFine(TwoLevels *t)
{
  PetscFunctionBeginUser;
  PetscCall(BlocksDestroy(&t->blocks));
  PetscCall(PetscFree(t->inverse));
  PetscCall(KSPDestroy(&t->solver));
  PetscCall(MatDestroy(&t->coarse));
  PetscFunctionReturn(0);
}

/* The tangent as it is now, cut and closed, in blocks. */
static PetscErrorCode FillBlocks(TwoLevels *t)
{
  System s = *t->system;

  PetscFunctionBeginUser;
  s.singles = NULL; /* of values in double precision */
  PetscCall(BlocksCreate(&s, t->symmetric, &t->blocks));
  PetscCall(BlocksFill(t->blocks, &s));
  PetscCall(PetscMalloc1(s.dim * s.dim * t->blocks->n, &t->inverse));
  if (!t->blocks->singular) blocks_invert_scales(t->blocks, t->inverse);
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

/* Is what is prescribed the same as before, and are the axes of its nodes (frames)? Collective. */
static PetscErrorCode StillHolds(const TwoLevels *t, PetscBool *holds)
{
  const PetscInt n = t->grid->n_nodes * t->system->dim;
  PetscBool own = (PetscBool)(t->box && !t->system->frames);

  PetscFunctionBeginUser;
  if (own && n) PetscCall(PetscMemcmp(t->held, t->fixed, (size_t)n, &own));
  PetscCall(MPIU_Allreduce(&own, holds, 1, MPIU_BOOL, MPI_LAND, t->system->comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateCoarse(TwoLevels *t)
{
  const PetscInt n = t->grid->n_nodes * t->system->dim;

  PetscFunctionBeginUser;
  PetscCall(ClearCoarse(t));
  PetscCall(PetscMalloc1(n, &t->held));
  PetscCall(PetscArraycpy(t->held, t->fixed, n));
  PetscCall(CoarseBoxCreate(t->system, t->grid, t->fixed, &t->box));
  PetscCall(MatCreateVecs(t->box->interpolation, &t->rest, &t->fine));
  PetscCall(VecDuplicate(t->rest, &t->correction));
  PetscFunctionReturn(0);
}

static PetscErrorCode SetUp(PC pc)
{
  PetscBool holds;
  TwoLevels *t;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &t));
  PetscCall(ClearFine(t));
  PetscCall(FillBlocks(t));
  if (t->blocks->singular) PetscCall(PCSetFailedReason(pc, PC_SUBPC_ERROR));
  if (t->blocks->singular) PetscFunctionReturn(0);
  PetscCall(StillHolds(t, &holds));
  if (!holds) PetscCall(CreateCoarse(t));
  PetscCall(CoarseProduct(t->system->gathered, t->box, t->fixed, &t->coarse));
  if (t->symmetric) PetscCall(MatSetOption(t->coarse, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatSetNearNullSpace(t->coarse, t->box->motions));
  PetscCall(CreateSolver(t, pc));
  PetscFunctionReturn(0);
}

/* r = -S^-1 (U + O) x: what a sweep forward from nothing leaves. */
KERNEL void left_by_sweep(const int dim, const TwoLevels *t, const float *x, PetscReal *r)
{
  const Blocks *m = t->blocks;
  PetscInt outer = 0;
  for (PetscInt k = 0; k < m->n; ++k) {
    Lanes v = row_add(dim, &m->upper, k, x, (Lanes){0, 0, 0, 0});
    if (outer < m->n_outer && m->outer_row[outer] == k) v = row_add(dim, &m->outer, outer++, x, v);
    const PetscReal *S = t->inverse + dim * dim * k;
    for (int i = 0; i < dim; ++i) {
      PetscReal sum = 0;
      for (int j = 0; j < dim; ++j) sum -= S[dim * i + j] * (PetscReal)v[j];
      r[dim * k + i] = sum;
    }
  }
}

/* x += T^-1 e */
KERNEL void add_correction(const int dim, const TwoLevels *t, const PetscReal *e, float *x)
{
  for (PetscInt k = 0; k < t->blocks->n; ++k)
    for (int i = 0; i < dim; ++i) {
      PetscReal sum = t->symmetric ? 0 : e[dim * k + i];
      for (int j = 0; t->symmetric && j < dim; ++j) sum += t->inverse[(dim * k + j) * dim + i] * e[dim * k + j];
      x[block_stride(dim) * k + i] += (float)sum;
    }
}

/* v = S b factor - (L + O) x: what a sweep back begins with. */
KERNEL void right_side(const int dim, const Blocks *m, const PetscReal *b, PetscReal factor, const float *x, float *v)
{
  PetscInt outer = 0;
  for (PetscInt k = 0; k < m->n; ++k) {
    const float *S = m->scale + dim * dim * k;
    PetscReal sum[3] = {0, 0, 0};
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) sum[i] += (PetscReal)S[dim * i + j] * b[dim * k + j];
    Lanes from = row_forward(dim, &m->lower, k, x, node_from_doubles(dim, sum, factor));
    if (outer < m->n_outer && m->outer_row[outer] == k) from = row_forward(dim, &m->outer, outer++, x, from);
    node_store(dim, from, v + block_stride(dim) * k);
  }
}

static PetscErrorCode Correct(const TwoLevels *t, float *x)
{
  const PetscReal *e;
  PetscReal *r;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayWrite(t->fine, &r));
  if (t->system->dim == 2) left_by_sweep(2, t, x, r);
  else left_by_sweep(3, t, x, r);
  PetscCall(VecRestoreArrayWrite(t->fine, &r));
  PetscCall(MatMultTranspose(t->box->interpolation, t->fine, t->rest));
  PetscCall(KSPSolve(t->solver, t->rest, t->correction));
  PetscCall(MatMult(t->box->interpolation, t->correction, t->fine));
  PetscCall(VecGetArrayRead(t->fine, &e));
  if (t->system->dim == 2) add_correction(2, t, e, x);
  else add_correction(3, t, e, x);
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
  if (t->blocks->singular) PetscCall(VecSetInf(y)); /* some methods ask although the set-up has failed */
  if (t->blocks->singular) PetscFunctionReturn(0);
  const PetscInt dim = t->system->dim;
  const BlockSweeps *sweeps = block_sweeps(dim);
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
  if (dim == 2) right_side(2, t->blocks, in, 1 / size, x, v);
  else right_side(3, t->blocks, in, 1 / size, x, v);
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
  PetscCall(ClearFine(t));
  PetscCall(ClearCoarse(t));
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
