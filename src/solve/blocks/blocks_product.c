/* The product with the matrix that a method with projections needs right after Gauss-Seidel: by
 * Eisenstat's trick
 *   A^ t = x + L t + O t,   t = (1 + U)^-1 x,
 * and only rows beside constrained nodes, where the projection has changed t, take their whole
 * length. */
#include "base/math/tensor.h"
#include "solve/blocks/blocks.h"

void blocks_invert_scales(const Blocks *m, PetscReal *inverse)
{
  const PetscInt dim = m->dim, size = dim * dim;
  for (PetscInt r = 0; r < m->n; ++r) {
    PetscReal full[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, other[9];
    for (PetscInt i = 0; i < size; ++i) full[3 * (i / dim) + i % dim] = (PetscReal)m->scale[r * size + i];
    (void)tensor_inverse(full, other);
    for (PetscInt i = 0; i < size; ++i) inverse[r * size + i] = other[3 * (i / dim) + i % dim];
  }
}

static PetscBool meets(const BlockRows *rows, PetscInt k, PetscInt stride, const float *changed)
{
  for (PetscInt e = rows->start[k]; e < rows->start[k + 1]; ++e)
    if (changed[rows->column[e] * stride] > 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode BlocksProductCreate(Blocks *m, PetscInt n_changed, const PetscInt *changed, BlocksProduct *p)
{
  const PetscInt stride = block_stride((int)m->dim);
  float *mark;

  PetscFunctionBeginUser;
  *p = (BlocksProduct){.m = m, .n_changed = n_changed, .changed = changed};
  PetscCall(PetscMalloc2(m->n, &p->whole, m->n * m->dim * m->dim, &p->inverse));
  blocks_invert_scales(m, p->inverse);
  PetscCall(BlocksWork(m, BLOCKS_PRODUCT_WORK, &mark));
  for (PetscInt i = 0; i < n_changed; ++i)
    if (changed[i] >= 0) mark[changed[i] / m->dim * stride] = 1;
  PetscCall(BlocksExchange(m, mark));
  for (PetscInt r = 0, outer = 0; r < m->n; ++r) {
    p->whole[r] = mark[r * stride] > 0 || meets(&m->lower, r, stride, mark) || meets(&m->upper, r, stride, mark);
    if (outer < m->n_outer && m->outer_row[outer] == r) p->whole[r] |= meets(&m->outer, outer++, stride, mark);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksProductDestroy(BlocksProduct *p)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(p->whole, p->inverse));
  PetscFunctionReturn(0);
}

/* t of the changed nodes anew: t = T^-1 z factor, with T = S^T or 1. */
static void renew_changed(const BlocksProduct *p, const PetscReal *z, PetscReal factor, float *t)
{
  const Blocks *m = p->m;
  const PetscInt dim = m->dim, stride = block_stride((int)dim);
  for (PetscInt k = 0; k < p->n_changed; ++k) {
    if (p->changed[k] < 0) continue;
    const PetscInt r = p->changed[k] / dim;
    for (PetscInt i = 0; i < dim; ++i) {
      PetscReal sum = m->symmetric ? 0 : z[r * dim + i];
      for (PetscInt j = 0; j < dim && m->symmetric; ++j) sum += p->inverse[(r * dim + j) * dim + i] * z[r * dim + j];
      t[r * stride + i] = (float)(factor * sum);
    }
  }
}

/* q = factor S^-1 A^ t */
KERNEL void product(const int dim, const BlocksProduct *p, const float *x, const float *t, PetscReal factor,
                    PetscReal *q)
{
  const Blocks *m = p->m;
  const BlockRows lower = m->lower, upper = m->upper, outer = m->outer;
  const int stride = block_stride(dim);
  for (PetscInt r = 0, k = 0; r < m->n; ++r) {
    Lanes v = -node_load(dim, (p->whole[r] ? t : x) + r * stride);
    v = row_forward(dim, &lower, r, t, v);
    if (p->whole[r]) v = row_forward(dim, &upper, r, t, v);
    if (k < m->n_outer && m->outer_row[k] == r) v = row_forward(dim, &outer, k++, t, v);
    for (int i = 0; i < dim; ++i) {
      PetscReal sum = 0;
      for (int j = 0; j < dim; ++j) sum -= p->inverse[(r * dim + i) * dim + j] * (PetscReal)v[j];
      q[r * dim + i] = factor * sum;
    }
  }
}

PetscErrorCode BlocksProductApply(const BlocksProduct *p, PetscReal size, const PetscReal *z, const float *x, float *t,
                                  PetscReal *q)
{
  PetscFunctionBeginUser;
  renew_changed(p, z, 1 / size, t);
  PetscCall(BlocksExchange(p->m, t));
  if (p->m->dim == 2) product(2, p, x, t, size, q);
  else product(3, p, x, t, size, q);
  PetscFunctionReturn(0);
}
