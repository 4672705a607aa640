/* Two, four or eight numbers in a register, wherever in memory they stand, and what a node has in one. */
#pragma once
#include <petscsys.h>

#define ROW(numbers) __attribute__((vector_size(numbers * sizeof(PetscReal)), aligned(sizeof(PetscReal)), may_alias))
typedef PetscReal Row2 ROW(2);
typedef PetscReal Row4 ROW(4);
typedef PetscReal Row8 ROW(8);
#undef ROW

#define ROW_INLINE static inline __attribute__((always_inline))

/* What a node has, dim numbers, with zeros behind them. */
ROW_INLINE Row4 node_row(const int dim, const PetscReal *x)
{
  return dim == 2 ? (Row4){x[0], x[1], 0, 0} : (Row4){x[0], x[1], x[2], 0};
}

/* The same added to what it has. */
ROW_INLINE void node_add(const int dim, Row4 more, PetscReal *x)
{
  *(Row2 *)x += (Row2){more[0], more[1]};
  if (dim > 2) x[2] += more[2];
}

ROW_INLINE PetscReal row_sum(Row4 row) { return (row[0] + row[1]) + (row[2] + row[3]); }
