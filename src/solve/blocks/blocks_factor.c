/* One solve by factors, where the iteration on Blocks did not reach its end: a tangent now and then is far from what
 * Gauss-Seidel is good at, and the next is not. What is factorised are the scaled rows as they are, so that the system
 * keeps its form and no iteration of Newton's method is lost. */
#include "solve/blocks/blocks.h"

/* Numbers of the first unknown of every column among those of all ranks. */
static PetscErrorCode NumberColumns(const Blocks *m, PetscInt *number)
{
  PetscInt first = 0, n = m->n * m->dim;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Exscan(&n, &first, 1, MPIU_INT, MPI_SUM, m->comm));
  for (PetscInt r = 0; r < m->n; ++r) number[r] = first + r * m->dim;
  PetscCall(PetscSFBcastBegin(m->halo->columns, MPIU_INT, number, number + m->n, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(m->halo->columns, MPIU_INT, number, number + m->n, MPI_REPLACE));
  PetscFunctionReturn(0);
}

static inline PetscInt length(const BlockRows *rows, PetscInt k) { return rows->start[k + 1] - rows->start[k]; }

/* Row k of rows into row r of the matrix; 3 x 3 blocks are stored column by column. */
static PetscErrorCode SetRow(const Blocks *m, const BlockRows *rows, PetscInt k, PetscInt r, const PetscInt *number,
                             Mat A)
{
  const PetscInt dim = m->dim;

  PetscFunctionBeginUser;
  for (PetscInt e = rows->start[k]; e < rows->start[k + 1]; ++e) {
    const float *block = rows->block + e * dim * dim;
    PetscInt row[3], column[3];
    PetscScalar value[9];
    for (PetscInt i = 0; i < dim; ++i) {
      row[i] = number[r] + i;
      column[i] = number[rows->column[e]] + i;
      for (PetscInt j = 0; j < dim; ++j) value[i * dim + j] = (PetscReal)block[dim == 2 ? i * dim + j : j * dim + i];
    }
    PetscCall(MatSetValues(A, dim, row, dim, column, value, INSERT_VALUES));
  }
  PetscFunctionReturn(0);
}

/* 1 + L + U + O */
static PetscErrorCode MakeMatrix(const Blocks *m, Mat *A)
{
  const PetscInt dim = m->dim, n = m->n * dim;
  PetscInt *number, *own, *others;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(m->n_columns, &number, n, &own, n, &others));
  PetscCall(NumberColumns(m, number));
  for (PetscInt r = 0, outer = 0; r < m->n; ++r) {
    const PetscBool beyond = (PetscBool)(outer < m->n_outer && m->outer_row[outer] == r);
    for (PetscInt i = 0; i < dim; ++i) {
      own[r * dim + i] = 1 + dim * (length(&m->lower, r) + length(&m->upper, r));
      others[r * dim + i] = beyond ? dim * length(&m->outer, outer) : 0;
    }
    outer += beyond;
  }
  PetscCall(MatCreateAIJ(m->comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, 0, own, 0, others, A));
  for (PetscInt r = 0, outer = 0; r < m->n; ++r) {
    for (PetscInt i = 0; i < dim; ++i) PetscCall(MatSetValue(*A, number[r] + i, number[r] + i, 1, INSERT_VALUES));
    PetscCall(SetRow(m, &m->lower, r, r, number, *A));
    PetscCall(SetRow(m, &m->upper, r, r, number, *A));
    if (outer < m->n_outer && m->outer_row[outer] == r) PetscCall(SetRow(m, &m->outer, outer++, r, number, *A));
  }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscFree3(number, own, others));
  PetscFunctionReturn(0);
}

/* out = S in, or S^T in */
static PetscErrorCode Scale(const Blocks *m, PetscBool transposed, const PetscReal *in, PetscReal *out)
{
  const PetscInt dim = m->dim;

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < m->n; ++r)
    for (PetscInt i = 0; i < dim; ++i) {
      PetscReal sum = 0;
      for (PetscInt j = 0; j < dim; ++j)
        sum += (PetscReal)m->scale[(r * dim + (transposed ? j : i)) * dim + (transposed ? i : j)] * in[r * dim + j];
      out[r * dim + i] = sum;
    }
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksFactorSolve(Blocks *m, const PetscReal *b, PetscReal *u, PetscBool *solved)
{
  KSP ksp;
  PC pc;
  Mat A;
  Vec right, left;
  PetscReal *values;
  const PetscReal *z;
  PetscReal size;
  KSPConvergedReason reason;

  PetscFunctionBeginUser;
  PetscCall(MakeMatrix(m, &A));
  PetscCall(MatCreateVecs(A, &left, &right));
  PetscCall(VecGetArrayWrite(right, &values));
  PetscCall(Scale(m, PETSC_FALSE, b, values));
  PetscCall(VecRestoreArrayWrite(right, &values));
  PetscCall(KSPCreate(m->comm, &ksp));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(KSPSolve(ksp, right, left));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  PetscCall(VecNorm(left, NORM_2, &size));
  *solved = (PetscBool)(reason > 0 && !PetscIsInfOrNanReal(size));
  PetscCall(VecGetArrayRead(left, &z));
  if (*solved && m->symmetric) PetscCall(Scale(m, PETSC_TRUE, z, u));
  else if (*solved) PetscCall(PetscArraycpy(u, z, m->n * m->dim));
  PetscCall(VecRestoreArrayRead(left, &z));
  PetscCall(VecDestroy(&left));
  PetscCall(VecDestroy(&right));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}
