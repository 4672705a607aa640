#include <stdint.h>
#include <string.h>
#include "solve/system/forms/gathered.h"
#include "solve/system/forms/shared_rows.h"

#define KERNEL static inline __attribute__((always_inline))

#define AHEAD 24 /* pairs */

typedef double Four __attribute__((vector_size(32), aligned(8), may_alias));
typedef double Two __attribute__((vector_size(16), aligned(8), may_alias));

PetscErrorCode GatheredCreate(const System *s, PetscBool symmetric, Gathered **gathered)
{
  const PetscInt stride = gathered_stride((int)s->dim), pairs = s->row_start[s->n_rows];
  Gathered *g;

  PetscFunctionBeginUser;
  PetscCheck(s->block == s->dim, s->comm, PETSC_ERR_SUP, "blocks with a pressure");
  PetscCall(PetscNew(&g));
  g->s = s;
  g->symmetric = symmetric;
  PetscCall(GhostRows(s, &g->ghosts));
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)stride, MPIU_REAL, &g->vector));
  PetscCallMPI(MPI_Type_commit(&g->vector));
  PetscCall(PetscMalloc3(s->n_rows + 1, &g->start, pairs + AHEAD, &g->pair, pairs, &g->column));
  PetscCall(PetscCalloc2(s->n_rows * stride, &g->x, s->n_rows * stride, &g->y));
  g->start[0] = 0;
  *gathered = g;
  PetscFunctionReturn(0);
}

PetscErrorCode GatheredDestroy(Gathered **gathered)
{
  Gathered *g = *gathered;

  PetscFunctionBeginUser;
  if (!g) PetscFunctionReturn(0);
  PetscCall(PetscSFDestroy(&g->ghosts));
  PetscCallMPI(MPI_Type_free(&g->vector));
  PetscCall(PetscFree3(g->start, g->pair, g->column));
  PetscCall(PetscFree2(g->x, g->y));
  PetscCall(PetscFree(*gathered));
  PetscFunctionReturn(0);
}

/* Not for numbers: bits. */
KERNEL PetscBool is_zero(const int size, const PetscReal *values)
{
  uint64_t number[9], any = 0;
  memcpy(number, values, (size_t)size * sizeof *number);
  for (int k = 0; k < size; ++k) any |= number[k];
  return !any;
}

KERNEL void find_pairs(const int size, Gathered *g)
{
  const System *s = g->s;
  PetscInt n = 0;
  for (PetscInt r = 0; r < s->n_rows; ++r) {
    const PetscInt first = g->symmetric ? s->diagonal[r] : s->row_start[r];
    const PetscBool empty = g->symmetric && s->matter && s->matter[r] != ROW_FILLED; /* but for its diagonal */
    for (PetscInt k = first; k < (empty ? first + 1 : s->row_start[r + 1]); ++k) {
      if (k != s->diagonal[r] && is_zero(size, s->values + (size_t)k * (size_t)size)) continue;
      g->pair[n] = k;
      g->column[n++] = s->row[s->column[k]];
    }
    g->start[r + 1] = n;
  }
  for (int k = 0; k < AHEAD; ++k) g->pair[n + k] = 0; /* fetched, not read */
}

PetscErrorCode GatheredFill(Gathered *g, Mat matrix)
{
  PetscFunctionBeginUser;
  if (g->s->dim == 2) find_pairs(4, g);
  else find_pairs(9, g);
  PetscCall(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Of a row half the values are read, or fewer: what comes next is fetched, since no stream of addresses tells. */
KERNEL void fetch(const Gathered *g, const int size, PetscInt e)
{
  const PetscReal *next = g->s->values + size * (size_t)g->pair[e + AHEAD];
  __builtin_prefetch(next);
  if (size > 8) __builtin_prefetch(next + size - 1);
}

/* y += A x; the half behind the diagonals counts twice. Registers read a number too many, of the next block: it meets
 * a zero of x, or goes where nobody reads. */
KERNEL void add_product_3d(const Gathered *g, const PetscBool symmetric)
{
  const PetscReal *values = g->s->values, *x = g->x;
  PetscReal *y = g->y;
  for (PetscInt r = 0; r < g->s->n_rows; ++r) {
    const Four own = *(const Four *)(x + 4 * r);
    Four sum[3] = {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}};
    for (PetscInt e = g->start[r]; e < g->start[r + 1]; ++e) {
      const PetscReal *K = values + 9 * (size_t)g->pair[e];
      fetch(g, 9, e);
      const Four row[3] = {*(const Four *)K, *(const Four *)(K + 3), *(const Four *)(K + 6)};
      const Four other = *(const Four *)(x + 4 * g->column[e]);
      for (int i = 0; i < 3; ++i) sum[i] += row[i] * other;
      if (symmetric && e > g->start[r])
        *(Four *)(y + 4 * g->column[e]) += row[0] * own[0] + row[1] * own[1] + row[2] * own[2];
    }
    for (int i = 0; i < 3; ++i) y[4 * r + i] += sum[i][0] + sum[i][1] + sum[i][2];
  }
}

KERNEL void add_product_2d(const Gathered *g, const PetscBool symmetric)
{
  const PetscReal *values = g->s->values, *x = g->x;
  PetscReal *y = g->y;
  for (PetscInt r = 0; r < g->s->n_rows; ++r) {
    const Four own = {x[2 * r], x[2 * r], x[2 * r + 1], x[2 * r + 1]};
    Four sum = {0, 0, 0, 0};
    for (PetscInt e = g->start[r]; e < g->start[r + 1]; ++e) {
      const Four K = *(const Four *)(values + 4 * (size_t)g->pair[e]);
      fetch(g, 4, e);
      const Two other = *(const Two *)(x + 2 * g->column[e]);
      sum += K * __builtin_shufflevector(other, other, 0, 1, 0, 1);
      if (!symmetric || e == g->start[r]) continue;
      const Four back = K * own;
      *(Two *)(y + 2 * g->column[e]) +=
        __builtin_shufflevector(back, back, 0, 1) + __builtin_shufflevector(back, back, 2, 3);
    }
    y[2 * r] += sum[0] + sum[1];
    y[2 * r + 1] += sum[2] + sum[3];
  }
}

static void add_product(const Gathered *g)
{
  if (g->s->dim == 2 && g->symmetric) add_product_2d(g, PETSC_TRUE);
  else if (g->s->dim == 2) add_product_2d(g, PETSC_FALSE);
  else if (g->symmetric) add_product_3d(g, PETSC_TRUE);
  else add_product_3d(g, PETSC_FALSE);
}

static PetscErrorCode ToGhosts(Gathered *g, PetscReal *x)
{
  PetscFunctionBeginUser;
  if (!g->ghosts) PetscFunctionReturn(0);
  PetscReal *ghost = x + g->s->n_active * gathered_stride((int)g->s->dim);
  PetscCall(PetscSFBcastBegin(g->ghosts, g->vector, x, ghost, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(g->ghosts, g->vector, x, ghost, MPI_REPLACE));
  PetscFunctionReturn(0);
}

/* y of owned rows -> out, with what other ranks have for them. */
static PetscErrorCode SumToOwners(Gathered *g, Vec out)
{
  const PetscInt dim = g->s->dim, stride = gathered_stride((int)dim);
  PetscReal *v;

  PetscFunctionBeginUser;
  if (g->ghosts) {
    const PetscReal *ghost = g->y + g->s->n_active * stride;
    PetscCall(PetscSFReduceBegin(g->ghosts, g->vector, ghost, g->y, MPI_SUM));
    PetscCall(PetscSFReduceEnd(g->ghosts, g->vector, ghost, g->y, MPI_SUM));
  }
  PetscCall(VecGetArrayWrite(out, &v));
  for (PetscInt r = 0; r < g->s->n_active; ++r)
    for (PetscInt d = 0; d < dim; ++d) v[r * dim + d] = g->y[r * stride + d];
  PetscCall(VecRestoreArrayWrite(out, &v));
  PetscFunctionReturn(0);
}

PetscErrorCode GatheredMultiply(Gathered *g, Vec x, Vec y)
{
  const PetscInt dim = g->s->dim, stride = gathered_stride((int)dim);
  const PetscReal *v;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(x, &v));
  for (PetscInt r = 0; r < g->s->n_active; ++r)
    for (PetscInt d = 0; d < dim; ++d) g->x[r * stride + d] = v[r * dim + d];
  PetscCall(VecRestoreArrayRead(x, &v));
  PetscCall(ToGhosts(g, g->x));
  PetscCall(PetscArrayzero(g->y, g->s->n_rows * stride));
  add_product(g);
  PetscCall(SumToOwners(g, y));
  PetscFunctionReturn(0);
}

PetscErrorCode GatheredDiagonal(Gathered *g, Vec diagonal)
{
  const PetscInt dim = g->s->dim, stride = gathered_stride((int)dim);

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(g->y, g->s->n_rows * stride));
  for (PetscInt r = 0; r < g->s->n_rows; ++r)
    for (PetscInt d = 0; d < dim; ++d) g->y[r * stride + d] = g->s->values[(g->s->diagonal[r] * dim + d) * dim + d];
  PetscCall(SumToOwners(g, diagonal));
  PetscFunctionReturn(0);
}
