/* Sweeps over rows of small blocks in single precision, with the size of a block known at compile
 * time.
 *
 * A node's numbers are one register of four lanes. 2 x 2 blocks are stored row by row and fill it;
 * 3 x 3 blocks are stored column by column, and the fourth lane is zeroed in the end: vectors keep
 * four numbers a node then, and every array of blocks ends with room for one load too many.
 * Registers are the compiler's vectors, as in formulation/displacement_kernels.h. */
#pragma once
#include <petscsys.h>

#define KERNEL static inline __attribute__((always_inline))

typedef float Lanes __attribute__((vector_size(16), aligned(4), may_alias));
typedef double Doubles __attribute__((vector_size(32)));
/* 2D: both numbers of a node, moved at once */
typedef double TwoLanes __attribute__((aligned(4), may_alias));
typedef double TwoTwice __attribute__((vector_size(16)));

#define BLOCK_PADDING 4

/* Rows of blocks: those of row r are start[r] .. start[r + 1] - 1. */
typedef struct {
  PetscInt *start, *column;
  float *block;
} BlockRows;

KERNEL int block_stride(const int dim) { return dim == 2 ? 2 : 4; }

/* A node's numbers in lanes 0 .. dim - 1. */
KERNEL Lanes node_load(const int dim, const float *x)
{
  if (dim == 2) return (Lanes)(TwoTwice){*(const TwoLanes *)x, 0};
  return *(const Lanes *)x;
}

KERNEL void node_store(const int dim, Lanes v, float *x)
{
  if (dim == 2) *(TwoLanes *)x = ((TwoTwice)v)[0];
  else *(Lanes *)x = v;
}

KERNEL Lanes node_from_doubles(const int dim, const PetscReal *x, PetscReal factor)
{
  return (Lanes){(float)(factor * x[0]), (float)(factor * x[1]), dim == 3 ? (float)(factor * x[dim - 1]) : 0, 0};
}

KERNEL double node_dot(const int dim, Lanes a, Lanes b)
{
  const Doubles x = __builtin_convertvector(a * b, Doubles);
  return dim == 2 ? x[0] + x[1] : x[0] + x[1] + x[2];
}

/* A sum of products of blocks with nodes. 3D sums the columns apart, so that an addition need not
 * wait for the one before. */
typedef struct {
  Lanes part[3];
} BlockSum;

KERNEL BlockSum sum_start(const int dim, Lanes v)
{
  const Lanes none = {0, 0, 0, 0};
  if (dim == 2) return (BlockSum){{__builtin_shufflevector(v, none, 0, 4, 1, 5)}};
  return (BlockSum){{v, none, none}};
}

KERNEL void sum_subtract(const int dim, const float *block, const float *x, BlockSum *s)
{
  if (dim == 2) {
    const TwoLanes both = *(const TwoLanes *)x;
    s->part[0] -= *(const Lanes *)block * (Lanes)(TwoTwice){both, both};
  } else
    for (int b = 0; b < 3; ++b) s->part[b] -= *(const Lanes *)(block + 3 * b) * x[b];
}

KERNEL Lanes sum_end(const int dim, const BlockSum *s)
{
  const Lanes none = {0, 0, 0, 0};
  if (dim == 3) return __builtin_shufflevector(s->part[0] + s->part[1] + s->part[2], none, 0, 1, 2, 7);
  const Lanes v = s->part[0] + __builtin_shufflevector(s->part[0], s->part[0], 1, 0, 3, 2);
  return __builtin_shufflevector(v, v, 0, 2, 1, 3);
}

/* v - (row r of rows) x. Towards the diagonal, since the neighbour there is what the sweep has just
 * computed. */
KERNEL Lanes row_forward(const int dim, const BlockRows *rows, PetscInt r, const float *x, Lanes v)
{
  BlockSum s = sum_start(dim, v);
  for (PetscInt k = rows->start[r]; k < rows->start[r + 1]; ++k)
    sum_subtract(dim, rows->block + k * dim * dim, x + rows->column[k] * block_stride(dim), &s);
  return sum_end(dim, &s);
}

KERNEL Lanes row_backward(const int dim, const BlockRows *rows, PetscInt r, const float *x, Lanes v)
{
  BlockSum s = sum_start(dim, v);
  for (PetscInt k = rows->start[r + 1]; k-- > rows->start[r];)
    sum_subtract(dim, rows->block + k * dim * dim, x + rows->column[k] * block_stride(dim), &s);
  return sum_end(dim, &s);
}

/* v + (row r of rows) x */
KERNEL Lanes row_add(const int dim, const BlockRows *rows, PetscInt r, const float *x, Lanes v)
{
  return -row_forward(dim, rows, r, x, -v);
}
