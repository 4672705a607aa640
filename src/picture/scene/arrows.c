/* Arrows of a vector field in the plane: means over squares, so that they stand apart. */
#include <math.h>
#include "picture/scene/scene.h"

#define ACROSS 44  /* squares along the longer side of the material */
#define LENGTH 1.7 /* of the longest arrow, in squares */

typedef struct {
  PetscReal n, x[2], v[2];
} Square;

/* The square of each point; the sums over its points. */
static PetscReal gather(PetscInt n, const PetscReal *x, PetscInt components, const PetscReal *v, Square *squares)
{
  PetscReal low[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, high[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL};
  for (PetscInt i = 0; i < 2 * n; ++i) {
    low[i % 2] = PetscMin(low[i % 2], x[3 * (i / 2) + i % 2]);
    high[i % 2] = PetscMax(high[i % 2], x[3 * (i / 2) + i % 2]);
  }
  const PetscReal side = PetscMax(high[0] - low[0], high[1] - low[1]) / ACROSS;
  for (PetscInt i = 0; i < n && side > 0; ++i) {
    const int column = (int)((x[3 * i] - low[0]) / side), row = (int)((x[3 * i + 1] - low[1]) / side);
    Square *s = squares + (size_t)row * (ACROSS + 1) + column;
    s->n += 1;
    for (int d = 0; d < 2; ++d) s->x[d] += x[3 * i + d], s->v[d] += v[i * components + d];
  }
  return side;
}

PetscErrorCode PlotFrameArrows(PetscInt n, const PetscReal *x, PetscInt components, const PetscReal *v, PlotFrame *f)
{
  const PetscInt squares = (ACROSS + 1) * (ACROSS + 1);
  PetscReal most = 0;
  Square *square;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(squares, &square));
  PetscCall(PetscMalloc1(4 * squares, &f->arrow));
  const PetscReal side = gather(n, x, components, v, square);
  for (PetscInt k = 0; k < squares; ++k)
    if (square[k].n > 0) most = PetscMax(most, hypot(square[k].v[0], square[k].v[1]) / square[k].n);
  for (PetscInt k = 0; k < squares && most > 0; ++k) {
    const Square *s = square + k;
    if (s->n == 0) continue;
    for (int d = 0; d < 2; ++d) {
      f->arrow[4 * f->n_arrows + d] = s->x[d] / s->n;
      f->arrow[4 * f->n_arrows + 2 + d] = s->v[d] / s->n;
    }
    ++f->n_arrows;
  }
  f->most = most, f->reach = LENGTH * side;
  PetscCall(PetscFree(square));
  PetscFunctionReturn(0);
}

static void choose_scale(PlotScene *scene)
{
  for (PetscInt k = 0; k < scene->n_frames; ++k) {
    const PlotFrame *f = &scene->frames[k];
    if (f->most <= 0) continue;
    const PetscReal own = f->reach / f->most;
    scene->arrow_scale = scene->arrow_most > 0 ? PetscMin(scene->arrow_scale, own) : own;
    scene->arrow_most = PetscMax(scene->arrow_most, f->most);
  }
}

void plot_scale_arrows(PlotScene *scene, const PlotOptions *options)
{
  if (options->arrow_most > 0) scene->arrow_scale = options->arrow_scale, scene->arrow_most = options->arrow_most;
  else choose_scale(scene);
  for (PetscInt k = 0; k < scene->n_frames; ++k)
    for (PetscInt i = 0; i < scene->frames[k].n_arrows; ++i)
      for (int d = 0; d < 2; ++d) scene->frames[k].arrow[4 * i + 2 + d] *= scene->arrow_scale;
}
