/* Does anything determine the level of the pressure? Of what is exactly incompressible and held all around nothing
 * does: a uniform pressure pushes no node that could give way and changes no volume, so that any number added to the
 * answer is an answer, too. */
#include "model/start/unheld_private.h"

/* Of the largest push that nodes get from their points: what a uniform pressure leaves at a free node where it counts
 * as round-off, and as what sums over points are off by. A free side has half of it. */
#define PUSHED 1e-2

/* Forces of a unit pressure, n_nodes x dim, and behind them the sums of their sizes, of this rank's points. */
static void push(const Model *m, PetscReal *force)
{
  const Support *w = m->space->support;
  const PetscInt dim = m->dim, n = m->grid->n_nodes * dim;
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *dN = support_dN(w, g, p, dim), *N = support_N(w, g, p), *x = point_real(m->points, POINT_X, p);
      for (PetscInt i = 0; i < support_nodes(w, g) * dim; ++i) {
        const PetscReal hoop = m->c->kinematics->hoop && i % dim == 0 ? N[i / dim] / x[0] : 0;
        const PetscReal share = m->points->real[POINT_VOLUME][p] * (dN[i] + hoop);
        const PetscInt at = w->node[w->node_start[g] + i / dim] * dim + i % dim;
        force[at] += share;
        force[n + at] += PetscAbsReal(share);
      }
    }
}

/* yields[b]: does the volume of a point change under pressure, of those bodies whose first is b? */
static void find_yielding(const Model *m, const PetscReal *of, PetscInt *yields)
{
  const Support *w = m->space->support;
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
      if (m->materials[m->points->material[p]].compliance > 0) yields[(PetscInt)of[w->node[w->node_start[g]]] - 1] = 1;
}

/* Of each body, and those it is one with: the largest push on a node that may give way, over the largest that nodes
 * get, along the axis in which that is most: across slender cells a pressure has more to push on than along them. */
static PetscErrorCode FindPushed(const Model *m, const PetscReal *of, PetscReal *pushed)
{
  const PetscInt dim = m->dim, n = m->grid->n_nodes * dim, bodies = m->c->n_bodies;
  PetscReal *force, *free, *most;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(2 * n, &force, bodies * dim, &free, bodies * dim, &most));
  push(m, force);
  for (int k = 0; k < 2; ++k) PetscCall(GridSumToOwners(m->grid, dim, force + k * n));
  frames_turn(&m->boundary->frames, dim, force);
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) {
    const PetscInt b = (PetscInt)of[i / dim] - 1, at = b * dim + i % dim;
    if (b < 0) continue;
    most[at] = PetscMax(most[at], force[n + i]);
    if (!m->boundary->fixed[i]) free[at] = PetscMax(free[at], PetscAbsReal(force[i]));
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, free, (PetscMPIInt)(bodies * dim), MPIU_REAL, MPIU_MAX, m->comm));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, most, (PetscMPIInt)(bodies * dim), MPIU_REAL, MPIU_MAX, m->comm));
  for (PetscInt at = 0; at < bodies * dim; ++at)
    pushed[at / dim] = PetscMax(pushed[at / dim], most[at] > 0 ? free[at] / most[at] : 1);
  PetscCall(PetscFree3(force, free, most));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckBodies(Model *m, Diag *diag)
{
  PetscReal *of, *pushed;
  PetscInt *yields;
  char path[64];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(m->grid->n_nodes, &of, m->c->n_bodies, &pushed, m->c->n_bodies, &yields));
  PetscCall(JoinedBodies(m, MEET_NONE, of));
  find_yielding(m, of, yields);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, yields, (PetscMPIInt)m->c->n_bodies, MPIU_INT, MPI_MAX, m->comm));
  PetscCall(FindPushed(m, of, pushed));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) {
    if (yields[b] || pushed[b] > PUSHED) continue;
    PetscSNPrintf(path, sizeof path, "bodies[%d]", (int)b);
    diag_error(
      diag, path,
      "nothing determines the level of the pressure in '%s': it is exactly incompressible and held all around, "
      "so that with any pressure more in all of it it would be in balance, too",
      m->c->bodies[b].name);
    diag_hint(diag, "poisson: 0.4999 has the pressure whose mean is 0; or leave a side of it free");
  }
  PetscCall(PetscFree3(of, pushed, yields));
  PetscFunctionReturn(0);
}

PetscErrorCode CheckLevel(Model *m, Diag *diag)
{
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->c->n_materials; ++i) any |= (PetscBool)(m->materials[i].compliance == 0);
  if (m->formulation->pressure && any) PetscCall(CheckBodies(m, diag));
  PetscFunctionReturn(0);
}
