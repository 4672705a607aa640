/* What does a body rest on? A wall beside it that rubs holds it in all directions, as far as anybody knows before the
 * first step; where a gap separates it from the floor, statics find no equilibrium, and do not say why. */
#include "model/model_private.h"

#define PLUMB 0.99 /* of gravity along an axis, else friction on a slope may be all that is meant */
#define LEANS 0.1  /* a wall whose normal has such a share of an axis bears along it */

/* The axis along which gravity acts, -1: none. */
static PetscInt plumb_axis(const Model *m)
{
  const PetscReal *g = m->c->gravity;
  const PetscReal size = PetscSqrtReal(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  for (PetscInt d = 0; d < m->dim && size > 0; ++d)
    if (PetscAbsReal(g[d]) > PLUMB * size) return d;
  return -1;
}

/* The nearest wall below the body: its index and how far it is from the body's points, their size taken off. */
typedef struct {
  PetscReal gap;
  int wall;
} Below;

static void look_below(const Model *m, PetscInt body, PetscInt axis, PetscInt k, Below *below)
{
  const PetscReal up = m->c->gravity[axis] > 0 ? -1 : 1;
  WallPlace place;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p);
    if (m->points->body[p] != body) continue;
    if (!wall_near(m->walls, k, m->time, x, PETSC_MAX_REAL, 0, &place) || up * place.normal[axis] < LEANS) continue;
    const PetscReal half = 0.5 * PetscPowReal(point_real(m->points, POINT_VOLUME, p)[0], 1. / (PetscReal)m->dim);
    if (place.gap - half < below->gap) below->gap = place.gap - half, below->wall = (int)k;
  }
}

static PetscErrorCode FindBelow(const Model *m, PetscInt body, PetscInt axis, Below *below)
{
  struct {
    double gap;
    int wall;
  } least;

  PetscFunctionBeginUser;
  *below = (Below){PETSC_MAX_REAL, -1};
  for (PetscInt k = 0; k < m->c->n_walls; ++k) look_below(m, body, axis, k, below);
  least.gap = (double)below->gap, least.wall = below->wall;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_DOUBLE_INT, MPI_MINLOC, m->comm));
  *below = (Below){(PetscReal)least.gap, least.wall};
  PetscFunctionReturn(0);
}

static PetscErrorCode Tell(const Model *m, PetscInt body, PetscInt axis, Diag *diag)
{
  Below below;
  char path[64];

  PetscFunctionBeginUser;
  PetscCall(FindBelow(m, body, axis, &below));
  PetscCall(PetscSNPrintf(path, sizeof path, "bodies[%d]", (int)body));
  diag_warning(diag, path, "nothing but friction bears the weight of '%s': it rests on nothing",
               m->c->bodies[body].name);
  if (below.wall >= 0)
    diag_hint(diag, "wall '%s' is below, %.2g m away from it", m->c->walls[below.wall].name, (double)below.gap);
  else diag_hint(diag, "put a wall below it, or fix a boundary in %c", "xyz"[axis]);
  PetscFunctionReturn(0);
}

PetscErrorCode AdviseRests(const Model *m, Diag *diag)
{
  const PetscInt n = m->c->n_bodies, axis = plumb_axis(m);
  PetscInt *held, *borne;

  PetscFunctionBeginUser;
  if (axis < 0 || !m->contact) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(n * m->dim, &held, n * m->dim, &borne));
  PetscCall(FindHeld(m, PETSC_TRUE, held));
  m->contact->slips = PETSC_TRUE;
  PetscCall(FindHeld(m, PETSC_TRUE, borne));
  m->contact->slips = PETSC_FALSE;
  for (PetscInt b = 0; b < n; ++b)
    if (held[b * m->dim + axis] && !borne[b * m->dim + axis] && !m->c->bodies[b].absent)
      PetscCall(Tell(m, b, axis, diag));
  PetscCall(PetscFree2(held, borne));
  PetscFunctionReturn(0);
}
