/* The passes of a Krylov method over the blocks; each reads what it needs once. */
#include "solve/blocks/blocks.h"

/* S b factor */
KERNEL Lanes scaled(const int dim, const float *S, const PetscReal *b, PetscReal factor)
{
  PetscReal sum[3] = {0, 0, 0};
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) sum[i] += (PetscReal)S[i * dim + j] * b[j];
  return node_from_doubles(dim, sum, factor);
}

KERNEL double scaled_norm2(const int dim, const Blocks *m, const PetscReal *b)
{
  double norm2 = 0;
  for (PetscInt r = 0; r < m->n; ++r)
    for (int i = 0; i < dim; ++i) {
      PetscReal sum = 0;
      for (int j = 0; j < dim; ++j) sum += (PetscReal)m->scale[(r * dim + i) * dim + j] * b[r * dim + j];
      norm2 += sum * sum;
    }
  return norm2;
}

KERNEL double start(const int dim, const Blocks *m, const PetscReal *b, PetscReal factor, float *x)
{
  const BlockRows lower =
    /* copies: a store to a vector might change what m points to, as far as the compiler knows */
    m->lower;
  const int stride = block_stride(dim);
  const PetscInt n = m->n;
  double norm2 = 0;
  for (PetscInt r = 0; r < n; ++r) {
    const Lanes v = row_forward(dim, &lower, r, x, scaled(dim, m->scale + r * dim * dim, b + r * dim, factor));
    node_store(dim, v, x + r * stride);
    norm2 += node_dot(dim, v, v);
  }
  return norm2;
}

KERNEL void backward(const int dim, const Blocks *m, const float *x, PetscReal beta, float *p, float *t)
{
  const BlockRows upper = m->upper;
  const int stride = block_stride(dim);
  const float factor = (float)beta;
  for (PetscInt r = m->n; r-- > 0;) {
    const Lanes v = node_load(dim, x + r * stride) + factor * node_load(dim, p + r * stride);
    node_store(dim, v, p + r * stride);
    node_store(dim, row_backward(dim, &upper, r, t, v), t + r * stride);
  }
}

KERNEL double forward(const int dim, const Blocks *m, const float *p, const float *t, const float *q, float *y)
{
  const BlockRows lower = m->lower;
  const int stride = block_stride(dim);
  const PetscInt n = m->n, n_outer = m->n_outer, *outer_row = m->outer_row;
  double dot = 0;
  for (PetscInt r = 0, outer = 0; r < n; ++r) {
    const Lanes from = node_load(dim, t + r * stride);
    Lanes v = node_load(dim, p + r * stride) - from;
    if (outer < n_outer && outer_row[outer] == r) v = row_add(dim, &m->outer, outer++, t, v);
    v = row_forward(dim, &lower, r, y, v);
    node_store(dim, v, y + r * stride);
    dot += node_dot(dim, from + v, node_load(dim, q + r * stride));
  }
  return dot;
}

KERNEL void finish(const int dim, const Blocks *m, const float *x, PetscReal factor, float *t, PetscReal *u)
{
  const BlockRows upper = m->upper;
  const int stride = block_stride(dim);
  for (PetscInt r = m->n; r-- > 0;) {
    const Lanes v = row_backward(dim, &upper, r, t, node_load(dim, x + r * stride));
    const float *S = m->scale + r * dim * dim;
    node_store(dim, v, t + r * stride);
    for (int i = 0; i < dim; ++i) {
      PetscReal sum = m->symmetric ? 0 : (PetscReal)v[i];
      if (m->symmetric)
        for (int k = i; k < dim; ++k) sum += (PetscReal)S[k * dim + i] * (PetscReal)v[k];
      u[r * dim + i] = factor * sum;
    }
  }
}

#define SWEEPS(dim)                                                                                      \
  static double norm2_##dim(const Blocks *m, const PetscReal *b) { return scaled_norm2(dim, m, b); }     \
  static double start_##dim(const Blocks *m, const PetscReal *b, PetscReal factor, float *x)             \
  {                                                                                                      \
    return start(dim, m, b, factor, x);                                                                  \
  }                                                                                                      \
  static void backward_##dim(const Blocks *m, const float *x, PetscReal beta, float *p, float *t)        \
  {                                                                                                      \
    backward(dim, m, x, beta, p, t);                                                                     \
  }                                                                                                      \
  static double forward_##dim(const Blocks *m, const float *p, const float *t, const float *q, float *y) \
  {                                                                                                      \
    return forward(dim, m, p, t, q, y);                                                                  \
  }                                                                                                      \
  static void finish_##dim(const Blocks *m, const float *x, PetscReal factor, float *t, PetscReal *u)    \
  {                                                                                                      \
    finish(dim, m, x, factor, t, u);                                                                     \
  }                                                                                                      \
  static const BlockSweeps sweeps_##dim = {norm2_##dim, start_##dim, backward_##dim, forward_##dim, finish_##dim};
SWEEPS(2)
SWEEPS(3)

const BlockSweeps *block_sweeps(PetscInt dim) { return dim == 2 ? &sweeps_2 : &sweeps_3; }
