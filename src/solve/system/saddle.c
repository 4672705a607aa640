#include "solve/system/saddle.h"
#include "solve/system/forms/assembled.h"
#include "solve/system/rigid_motions.h"

/* Global numbers of components first .. first + n - 1 of every active node. */
static PetscErrorCode UnknownsOf(const System *s, PetscInt first, PetscInt n, IS *field)
{
  PetscInt *index, start;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(s->matrix, &start, NULL));
  PetscCall(PetscMalloc1(s->n_active * n, &index));
  for (PetscInt k = 0; k < s->n_active; ++k)
    for (PetscInt a = 0; a < n; ++a) index[k * n + a] = start + k * s->block + first + a;
  PetscCall(ISCreateGeneral(s->comm, s->n_active * n, index, PETSC_OWN_POINTER, field));
  PetscCall(ISSetBlockSize(*field, n));
  PetscFunctionReturn(0);
}

static PetscErrorCode SplitFields(PC pc, const System *s, const Grid *grid)
{
  IS displacement, pressure;
  MatNullSpace rigid;

  PetscFunctionBeginUser;
  PetscCall(UnknownsOf(s, 0, s->dim, &displacement));
  PetscCall(UnknownsOf(s, s->dim, 1, &pressure));
  PetscCall(RigidMotions(s, grid, &rigid));
  PetscCall(PetscObjectCompose((PetscObject)displacement, "nearnullspace", (PetscObject)rigid));
  PetscCall(PCFieldSplitSetIS(pc, "u", displacement));
  PetscCall(PCFieldSplitSetIS(pc, "p", pressure));
  PetscCall(MatNullSpaceDestroy(&rigid));
  PetscCall(ISDestroy(&displacement));
  PetscCall(ISDestroy(&pressure));
  PetscFunctionReturn(0);
}

/* One application of a preconditioner each; the options -fieldsplit_u_ and -fieldsplit_p_ still
 * override. */
static PetscErrorCode InnerSolvers(PC pc, PetscBool dynamic)
{
  KSP *inner;
  PetscInt n;
  PC one;

  PetscFunctionBeginUser;
  PetscCall(PCSetUp(pc)); /* the parts exist from here on; their numbers come later */
  PetscCall(PCFieldSplitSchurGetSubKSP(pc, &n, &inner));
  PetscCall(KSPSetType(inner[0], KSPPREONLY));
  PetscCall(KSPGetPC(inner[0], &one));
  PetscCall(LinearMultigrid(one));
  PetscCall(PCGAMGSetReuseInterpolation(one, PETSC_TRUE));
  PetscCall(KSPSetType(inner[1], KSPPREONLY));
  PetscCall(KSPGetPC(inner[1], &one));
  PetscCall(PCSetType(one, dynamic ? PCGAMG : PCJACOBI));
  for (PetscInt k = 0; k < n; ++k) PetscCall(KSPSetFromOptions(inner[k]));
  PetscCall(PetscFree(inner));
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateDiagonal(const System *s, Mat *schur)
{
  PetscInt first;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(s->comm, s->n_active, s->n_active, PETSC_DETERMINE, PETSC_DETERMINE, 1, NULL, 0, NULL, schur));
  PetscCall(MatGetOwnershipRange(*schur, &first, NULL));
  for (PetscInt k = first; k < first + s->n_active; ++k) PetscCall(MatSetValue(*schur, k, k, -1, INSERT_VALUES));
  PetscCall(MatAssemblyBegin(*schur, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*schur, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

PetscErrorCode SaddleConfigure(Saddle *saddle, KSP ksp, const System *s, const Grid *grid, PetscBool dynamic)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(SaddleClear(saddle));
  PetscCall(KSPSetType(ksp, KSPGMRES));
  PetscCall(KSPGMRESSetRestart(ksp, 100));
  PetscCall(KSPSetPCSide(ksp, PC_RIGHT));
  PetscCall(KSPSetTolerances(ksp, 1e-8, PETSC_DEFAULT, PETSC_DEFAULT, 500));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCFIELDSPLIT));
  PetscCall(PCFieldSplitSetType(pc, PC_COMPOSITE_SCHUR));
  PetscCall(PCFieldSplitSetSchurFactType(pc, PC_FIELDSPLIT_SCHUR_FACT_UPPER));
  PetscCall(SplitFields(pc, s, grid));
  if (dynamic) PetscCall(PCFieldSplitSetSchurPre(pc, PC_FIELDSPLIT_SCHUR_PRE_SELFP, NULL));
  else {
    PetscCall(CreateDiagonal(s, &saddle->schur));
    PetscCall(PCFieldSplitSetSchurPre(pc, PC_FIELDSPLIT_SCHUR_PRE_USER, saddle->schur));
  }
  /* a matrix without numbers cannot be split */
  PetscCall(AssembledFill(s->assembled, s, s->matrix));
  PetscCall(InnerSolvers(pc, dynamic));
  PetscFunctionReturn(0);
}

PetscErrorCode SaddleUpdate(Saddle *saddle, const System *s, const PetscReal *nodes)
{
  PetscInt first;

  PetscFunctionBeginUser;
  if (!saddle->schur) PetscFunctionReturn(0);
  PetscCall(MatGetOwnershipRange(saddle->schur, &first, NULL));
  for (PetscInt k = 0; k < s->n_active; ++k) {
    const PetscReal own = nodes[s->active[k]];
    PetscCall(MatSetValue(saddle->schur, first + k, first + k, own > 0 ? -own : -1, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(saddle->schur, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(saddle->schur, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

PetscErrorCode SaddleClear(Saddle *saddle)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&saddle->schur));
  PetscFunctionReturn(0);
}
