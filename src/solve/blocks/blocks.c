#include <stdint.h>
#include <string.h>
#include "base/math/tensor.h"
#include "solve/blocks/blocks.h"

#define BLOCK_COPY 9 /* numbers of the largest block */

/* One row of the summed matrix while it is walked: a row that only this rank assembles comes
 * straight from the system. */
typedef struct {
  const System *s;
  const BlocksHalo *halo;
  PetscInt next; /* shared row to come */
  PetscInt n;    /* blocks of this row */
  PetscBool shared;
  const PetscInt *column; /* of a shared row; else the nodes of the columns */
  const float *values;
  const PetscReal *doubles; /* instead of values; NULL: values */
} Row;

static inline void row_take(Row *row, PetscInt r)
{
  const BlocksHalo *h = row->halo;
  const PetscInt bs = row->s->dim * row->s->dim;
  row->doubles = NULL;
  if (row->next < h->n_shared && h->shared_row[row->next] == r) {
    const PetscInt first = h->start[row->next++];
    row->n = h->start[row->next] - first;
    row->shared = PETSC_TRUE;
    row->column = h->column + first;
    row->values = h->values + first * bs;
  } else {
    const PetscInt first = row->s->row_start[r];
    row->n = row->s->row_start[r + 1] - first;
    row->shared = PETSC_FALSE;
    row->column = row->s->column + first;
    if (row->s->singles) row->values = row->s->singles + first * bs;
    else row->doubles = row->s->values + first * bs;
  }
}

/* Numbers of block k, here or in `copy`. */
KERNEL const float *row_block(const int dim, const Row *row, PetscInt k, float copy[BLOCK_COPY])
{
  const PetscInt first = k * dim * dim;
  if (!row->doubles) return row->values + first;
  for (int i = 0; i < dim * dim; ++i) copy[i] = (float)row->doubles[first + i];
  return copy;
}

static inline PetscInt row_column(const Row *row, PetscInt k)
{
  return row->shared ? row->column[k] : row->s->row[row->column[k]];
}

static PetscErrorCode RowsReserve(BlockRows *rows, PetscInt n, PetscInt blocks, PetscInt size)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n + 1, &rows->start, blocks, &rows->column, blocks * size + BLOCK_PADDING, &rows->block));
  PetscCall(PetscArrayzero(rows->block + blocks * size, BLOCK_PADDING));
  rows->start[0] = 0;
  PetscFunctionReturn(0);
}

/* What of a row stands where: columns ascend, first those before the diagonal, last those of other ranks. */
static RowParts row_parts(const Row *row, PetscInt r, PetscInt n)
{
  RowParts parts = {0, 0};
  for (PetscInt k = 0; k < row->n; ++k) {
    const PetscInt c = row_column(row, k);
    parts.before += c < r;
    parts.own += c < n;
  }
  return parts;
}

/* Room for all columns; which of them count is found with their values. */
static PetscErrorCode BlocksPattern(Blocks *m, const System *s)
{
  const PetscInt size = m->dim * m->dim;
  PetscInt n_lower = 0, n_upper = 0, n_outer = 0;

  PetscFunctionBeginUser;
  Row row = {.s = s, .halo = m->halo};
  PetscCall(PetscMalloc2(m->n, &m->parts, m->n, &m->next));
  for (PetscInt r = 0; r < m->n; ++r) {
    row_take(&row, r);
    m->parts[r] = row_parts(&row, r, m->n);
    n_lower += m->parts[r].before;
    n_upper += m->parts[r].own - m->parts[r].before - 1;
    n_outer += row.n - m->parts[r].own;
    m->n_outer += row.n > m->parts[r].own;
  }
  PetscCall(RowsReserve(&m->lower, m->n, PetscMax(n_lower, m->symmetric ? n_upper : 0), size));
  PetscCall(RowsReserve(&m->upper, m->n, n_upper, size));
  PetscCall(RowsReserve(&m->outer, m->n_outer, n_outer, size));
  PetscCall(PetscMalloc1(m->n_outer, &m->outer_row));
  m->n_outer = 0;
  row.next = 0;
  for (PetscInt r = 0, end = 0; r < m->n; ++r) {
    row_take(&row, r);
    if (row.n == m->parts[r].own) continue;
    for (PetscInt k = m->parts[r].own; k < row.n; ++k) m->outer.column[end++] = row_column(&row, k);
    m->outer_row[m->n_outer++] = r;
    m->outer.start[m->n_outer] = end;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksCreate(const System *s, PetscBool symmetric, Blocks **blocks)
{
  Blocks *m;

  PetscFunctionBeginUser;
  PetscCheck(s->dim == 2 || s->dim == 3, s->comm, PETSC_ERR_SUP, "blocks of %d x %d", (int)s->dim, (int)s->dim);
  PetscCall(PetscNew(&m));
  m->comm = s->comm;
  m->dim = s->dim;
  m->n = s->n_active;
  m->symmetric = symmetric;
  PetscCall(BlocksHaloCreate(s, &m->n_columns, &m->halo));
  PetscCall(BlocksPattern(m, s));
  PetscCall(PetscMalloc1(m->n_columns * m->dim * m->dim + BLOCK_PADDING, &m->scale));
  *blocks = m;
  PetscFunctionReturn(0);
}

static PetscErrorCode RowsFree(BlockRows *rows)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(rows->start, rows->column, rows->block));
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksDestroy(Blocks **blocks)
{
  Blocks *m = *blocks;

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(0);
  PetscCall(RowsFree(&m->lower));
  PetscCall(RowsFree(&m->upper));
  PetscCall(RowsFree(&m->outer));
  PetscCall(PetscFree(m->outer_row));
  PetscCall(PetscFree2(m->parts, m->next));
  PetscCall(PetscFree(m->scale));
  PetscCall(BlocksHaloDestroy(&m->halo));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(m->work); ++k) PetscCall(PetscFree(m->work[k]));
  PetscCall(PetscFree(*blocks));
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksWork(Blocks *m, int which, float **vector)
{
  PetscFunctionBeginUser;
  const PetscInt n = m->n_columns * block_stride((int)m->dim);
  if (!m->work[which]) PetscCall(PetscMalloc1(n, &m->work[which]));
  PetscCall(PetscArrayzero(m->work[which], n));
  *vector = m->work[which];
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksExchange(const Blocks *m, float *vector)
{
  float *others = vector + m->n * block_stride((int)m->dim);

  PetscFunctionBeginUser;
  PetscCall(PetscSFBcastBegin(m->halo->columns, m->halo->vector, vector, others, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(m->halo->columns, m->halo->vector, vector, others, MPI_REPLACE));
  PetscFunctionReturn(0);
}

/* S = C^-1 with D = C C^T; false if D is not positive definite. */
KERNEL PetscBool scale_symmetric(const int dim, const PetscReal *D, float *S)
{
  PetscReal C[9], inverse[9], pivot[3];
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j <= i; ++j) {
      PetscReal sum = D[i * dim + j];
      for (int k = 0; k < j; ++k) sum -= C[i * dim + k] * C[j * dim + k];
      if (i == j && !(sum > 0)) return PETSC_FALSE;
      if (i == j) pivot[i] = 1 / PetscSqrtReal(sum);
      else C[i * dim + j] = sum * pivot[j];
    }
  for (int j = 0; j < dim; ++j)
    for (int i = 0; i < dim; ++i) {
      PetscReal sum = i == j;
      for (int k = j; k < i; ++k) sum -= C[i * dim + k] * inverse[k * dim + j];
      inverse[i * dim + j] = i < j ? 0 : sum * pivot[i];
    }
  for (int i = 0; i < dim * dim; ++i) S[i] = (float)inverse[i];
  return PETSC_TRUE;
}

/* S = D^-1. */
KERNEL PetscBool scale_unsymmetric(const int dim, const PetscReal *D, float *S)
{
  PetscReal full[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, inverse[9];
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) full[3 * i + j] = D[i * dim + j];
  const PetscReal det = tensor_inverse(full, inverse);
  if (det == 0 || PetscIsInfOrNanReal(det)) return PETSC_FALSE;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) S[i * dim + j] = (float)inverse[3 * i + j];
  return PETSC_TRUE;
}

KERNEL PetscBool find_scales(const int dim, Blocks *m, const System *s)
{
  Row row = {.s = s, .halo = m->halo};
  PetscBool regular = PETSC_TRUE;
  for (PetscInt r = 0; r < m->n; ++r) {
    PetscReal D[9];
    float copy[BLOCK_COPY];
    row_take(&row, r);
    const float *values = row_block(dim, &row, m->parts[r].before, copy);
    for (int i = 0; i < dim * dim; ++i) D[i] = (PetscReal)values[i];
    float *S = m->scale + r * dim * dim;
    if (m->symmetric ? scale_symmetric(dim, D, S) : scale_unsymmetric(dim, D, S)) continue;
    regular = PETSC_FALSE;
    for (int i = 0; i < dim * dim; ++i) S[i] = 0;
  }
  return regular;
}

/* block = S values other^T for lower triangles S, in four lanes. */
static inline void scale_symmetric_2d(Lanes v, Lanes s, Lanes o, float *block)
{
  const Lanes none = {0, 0, 0, 0};
  const Lanes left = __builtin_shufflevector(s, s, 0, 0, 3, 3) * v +
                     __builtin_shufflevector(s, none, 4, 4, 2, 2) * __builtin_shufflevector(v, v, 0, 1, 0, 1);
  *(Lanes *)block = left * __builtin_shufflevector(o, o, 0, 3, 0, 3) +
                    __builtin_shufflevector(left, none, 4, 0, 4, 2) * __builtin_shufflevector(o, o, 2, 2, 2, 2);
}

/* block = S values. */
static inline void scale_unsymmetric_2d(Lanes v, Lanes s, float *block)
{
  *(Lanes *)block = __builtin_shufflevector(s, s, 0, 0, 2, 2) * __builtin_shufflevector(v, v, 0, 1, 0, 1) +
                    __builtin_shufflevector(s, s, 1, 1, 3, 3) * __builtin_shufflevector(v, v, 2, 3, 2, 3);
}

/* The same for 3 x 3: rows of the block are lanes, and its columns go out one after the other; the
 * fourth lane of a store is 0 and belongs to what comes next. column: those of S. */
static inline void scale_block_3d(const float *values, const Lanes column[3], const float *other, PetscBool symmetric,
                                  float *block)
{
  Lanes left[3];
  for (int j = 0; j < 3; ++j) left[j] = column[0] * values[j] + column[1] * values[3 + j] + column[2] * values[6 + j];
  for (int j = 0; j < 3; ++j) {
    Lanes product = left[j];
    if (symmetric) {
      product = left[0] * other[3 * j];
      for (int k = 1; k <= j; ++k) product += left[k] * other[3 * j + k];
    }
    *(Lanes *)(block + 3 * j) = product;
  }
}

/* S of a row, as the kernels of its blocks want it. */
typedef struct {
  const float *S;
  Lanes column[3];
} RowScale;

KERNEL RowScale row_scale(const int dim, const Blocks *m, PetscInt r)
{
  RowScale scale = {.S = m->scale + r * dim * dim};
  if (dim == 3)
    for (int i = 0; i < 3; ++i) scale.column[i] = (Lanes){scale.S[i], scale.S[3 + i], scale.S[6 + i], 0};
  return scale;
}

/* block = S_row values T_column, in the order of the kernels: 2 x 2 row by row, 3 x 3 column by
 * column. other: S of the column. */
KERNEL void scale_block(const int dim, const RowScale *row, const float *other, const float *values,
                        PetscBool symmetric, float *block)
{
  if (dim == 3) scale_block_3d(values, row->column, other, symmetric, block);
  else if (symmetric) scale_symmetric_2d(*(const Lanes *)values, *(const Lanes *)row->S, *(const Lanes *)other, block);
  else scale_unsymmetric_2d(*(const Lanes *)values, *(const Lanes *)row->S, block);
}

/* Not for numbers: bits. */
KERNEL PetscBool is_zero(const int dim, const float *values)
{
  uint64_t pair[4], any = 0;
  uint32_t last = 0;
  memcpy(pair, values, (size_t)(dim * dim / 2) * sizeof *pair);
  if (dim == 3) memcpy(&last, values + 8, sizeof last);
  for (int k = 0; k < dim * dim / 2; ++k) any |= pair[k];
  return !(any | last);
}

/* Numbers first .. last - 1 of row r of the matrix behind what there is of rows; blocks of zeros, of nodes that no
 * point couples and of prescribed ones, stay away. */
KERNEL void take_blocks(const int dim, const Blocks *m, const Row *row, PetscInt r, PetscInt first, PetscInt last,
                        PetscBool symmetric, BlockRows *rows)
{
  const RowScale scale = row_scale(dim, m, r);
  PetscInt e = rows->start[r];
  float copy[BLOCK_COPY];
  for (PetscInt k = first; k < last; ++k) {
    const float *values = row_block(dim, row, k, copy);
    if (is_zero(dim, values)) continue;
    const PetscInt c = row_column(row, k);
    scale_block(dim, &scale, m->scale + c * dim * dim, values, symmetric, rows->block + e * dim * dim);
    rows->column[e++] = c;
  }
  rows->start[r + 1] = e;
}

/* Where A is symmetric L = U^T, scaled too. */
KERNEL void transpose_upper(const int dim, Blocks *m)
{
  const BlockRows upper = m->upper, lower = m->lower;
  const PetscInt n = m->n, size = dim * dim;
  PetscInt *next = m->next;
  for (PetscInt r = 0; r < n; ++r) next[r] = 0;
  for (PetscInt e = 0; e < upper.start[n]; ++e) ++next[upper.column[e]];
  for (PetscInt r = 0; r < n; ++r) {
    lower.start[r + 1] = lower.start[r] + next[r];
    next[r] = lower.start[r];
  }
  for (PetscInt r = 0; r < n; ++r)
    for (PetscInt e = upper.start[r]; e < upper.start[r + 1]; ++e) {
      const PetscInt to = next[upper.column[e]]++;
      const float *from = upper.block + e * size;
      float *block = lower.block + to * size;
      for (int a = 0; a < dim; ++a)
        for (int b = 0; b < dim; ++b) block[a * dim + b] = from[b * dim + a];
      lower.column[to] = r;
    }
}

KERNEL void fill_rows(const int dim, Blocks *m, const System *s, PetscBool symmetric)
{
  Row row = {.s = s, .halo = m->halo};
  float copy[BLOCK_COPY];
  PetscInt outer = 0;
  for (PetscInt r = 0; r < m->n; ++r) {
    row_take(&row, r);
    const RowParts parts = m->parts[r];
    if (s->matter && s->matter[r] != ROW_FILLED && row.n == parts.own) {
      m->lower.start[r + 1] = m->lower.start[r];
      m->upper.start[r + 1] = m->upper.start[r];
      continue;
    }
    if (!symmetric) take_blocks(dim, m, &row, r, 0, parts.before, symmetric, &m->lower);
    take_blocks(dim, m, &row, r, parts.before + 1, parts.own, symmetric, &m->upper);
    if (row.n == parts.own) continue;
    const RowScale scale = row_scale(dim, m, r);
    const PetscInt first = m->outer.start[outer++];
    for (PetscInt k = parts.own; k < row.n; ++k) {
      const PetscInt e = first + k - parts.own;
      scale_block(dim, &scale, m->scale + m->outer.column[e] * dim * dim, row_block(dim, &row, k, copy), symmetric,
                  m->outer.block + e * dim * dim);
    }
  }
  if (symmetric) transpose_upper(dim, m);
}

static void fill_2d(Blocks *m, const System *s)
{
  if (m->symmetric) fill_rows(2, m, s, PETSC_TRUE);
  else fill_rows(2, m, s, PETSC_FALSE);
}

static void fill_3d(Blocks *m, const System *s)
{
  if (m->symmetric) fill_rows(3, m, s, PETSC_TRUE);
  else fill_rows(3, m, s, PETSC_FALSE);
}

PetscErrorCode BlocksFill(Blocks *m, const System *s)
{
  float *others = m->scale + m->n * m->dim * m->dim;
  PetscInt bad, any;

  PetscFunctionBeginUser;
  PetscCall(BlocksHaloSum(m->halo, s));
  bad = !(m->dim == 2 ? find_scales(2, m, s) : find_scales(3, m, s));
  PetscCall(MPIU_Allreduce(&bad, &any, 1, MPIU_INT, MPI_MAX, m->comm));
  m->singular = any != 0;
  PetscCall(PetscSFBcastBegin(m->halo->columns, m->halo->scale, m->scale, others, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(m->halo->columns, m->halo->scale, m->scale, others, MPI_REPLACE));
  if (m->dim == 2) fill_2d(m, s);
  else fill_3d(m, s);
  PetscFunctionReturn(0);
}

/* z with S z = x. */
static void scale_solve(PetscInt dim, const float *S, const PetscReal *x, PetscReal *z)
{
  PetscReal full[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, inverse[9];
  for (PetscInt i = 0; i < dim; ++i)
    for (PetscInt j = 0; j < dim; ++j) full[3 * i + j] = (PetscReal)S[i * dim + j];
  (void)tensor_inverse(full, inverse);
  for (PetscInt i = 0; i < dim; ++i) {
    z[i] = 0;
    for (PetscInt j = 0; j < dim; ++j) z[i] += inverse[3 * i + j] * x[j];
  }
}

/* sum += row k of rows times x */
static void add_row(PetscInt dim, const BlockRows *rows, PetscInt k, const float *x, PetscReal *sum)
{
  for (PetscInt e = rows->start[k]; e < rows->start[k + 1]; ++e)
    for (PetscInt i = 0; i < dim; ++i)
      for (PetscInt j = 0; j < dim; ++j)
        sum[i] += (PetscReal)rows->block[(e * dim + (dim == 2 ? i : j)) * dim + (dim == 2 ? j : i)] *
                  (PetscReal)x[rows->column[e] * block_stride((int)dim) + j];
}

/* Not for speed: no method of ours needs it. y = S^-1 (1 + L + U + O) T^-1 x. */
PetscErrorCode BlocksMultiply(Blocks *m, Vec x, Vec y)
{
  const PetscInt dim = m->dim, stride = block_stride((int)dim);
  const PetscReal *in;
  PetscReal *out, z[3];
  float *t;

  PetscFunctionBeginUser;
  PetscCall(BlocksWork(m, 0, &t));
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArrayWrite(y, &out));
  for (PetscInt r = 0; r < m->n; ++r) {
    float transposed[9];
    for (PetscInt i = 0; i < dim * dim; ++i)
      transposed[i] = m->symmetric ? m->scale[r * dim * dim + i % dim * dim + i / dim] : (float)(i % (dim + 1) == 0);
    scale_solve(dim, transposed, in + r * dim, z);
    for (PetscInt i = 0; i < dim; ++i) t[r * stride + i] = (float)z[i];
  }
  PetscCall(BlocksExchange(m, t));
  for (PetscInt r = 0, outer = 0; r < m->n; ++r) {
    for (PetscInt i = 0; i < dim; ++i) z[i] = (PetscReal)t[r * stride + i];
    add_row(dim, &m->lower, r, t, z);
    add_row(dim, &m->upper, r, t, z);
    if (outer < m->n_outer && m->outer_row[outer] == r) add_row(dim, &m->outer, outer++, t, z);
    scale_solve(dim, m->scale + r * dim * dim, z, out + r * dim);
  }
  PetscCall(VecRestoreArrayWrite(y, &out));
  PetscCall(VecRestoreArrayRead(x, &in));
  PetscFunctionReturn(0);
}
