#include "boundary/frames.h"

PetscErrorCode FramesClear(Frames *f, PetscInt n_nodes)
{
  PetscFunctionBeginUser;
  f->n = 0;
  f->n_nodes = n_nodes;
  PetscCall(PetscFree(f->of));
  PetscFunctionReturn(0);
}

/* w along e + n, not e - n: their sum has no digits to lose where the two are close. */
PetscErrorCode FramesAdd(Frames *f, PetscInt dim, PetscInt node, PetscInt axis, const PetscReal *direction)
{
  PetscReal norm = 0;

  PetscFunctionBeginUser;
  if (f->n == f->capacity) {
    f->capacity += f->capacity / 2 + 64;
    PetscCall(PetscRealloc((size_t)f->capacity * sizeof *f->node, &f->node));
    PetscCall(PetscRealloc((size_t)f->capacity * 3 * sizeof *f->w, &f->w));
  }
  if (!f->of) {
    PetscCall(PetscMalloc1(f->n_nodes, &f->of));
    for (PetscInt i = 0; i < f->n_nodes; ++i) f->of[i] = -1;
  }
  PetscReal *w = f->w + 3 * f->n;
  const PetscReal sign = direction[axis] < 0 ? -1 : 1;
  for (PetscInt d = 0; d < 3; ++d) w[d] = d < dim ? sign * direction[d] + (d == axis) : 0;
  for (PetscInt d = 0; d < dim; ++d) norm += w[d] * w[d];
  norm = PetscSqrtReal(norm);
  for (PetscInt d = 0; d < dim; ++d) w[d] /= norm;
  f->node[f->n] = node;
  f->of[node] = f->n++;
  PetscFunctionReturn(0);
}

PetscErrorCode FramesDestroy(Frames *f)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(f->node));
  PetscCall(PetscFree(f->w));
  PetscCall(PetscFree(f->of));
  *f = (Frames){0};
  PetscFunctionReturn(0);
}
