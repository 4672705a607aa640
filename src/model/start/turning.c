/* Statics of bodies in smooth walls, or held along normals of sides, that are round about one axis: nothing holds the
 * turn about it, while every direction is held (advice/held.c). What is known of motions and holds is that of unheld.c
 * (docs/theory.md, section 60). */
#include "model/start/unheld_private.h"

/* As much of all loads at the size of the body neither pushes it nor brings it back. */
#define NEUTRAL 1e-3

/* By a motion, a place moves by u, and after that by w x u, if it turns by w: work of its force along both. */
static void add_work(const Model *m, const UnheldGroup *g, const PetscReal motion[RIGID], PetscInt node,
                     const PetscReal *force, PetscReal work[2])
{
  PetscReal w[3] = {0, 0, 0}, u[3] = {0, 0, 0};
  for (PetscInt k = m->dim; k < g->n; ++k) w[m->dim == 3 ? k - 3 : 2] = motion[k];
  for (PetscInt d = 0; d < m->dim; ++d) {
    PetscReal row[RIGID] = {0};
    unheld_row(m, g, node, d, NULL, row);
    for (PetscInt k = 0; k < g->n; ++k) u[d] += row[k] * motion[k];
  }
  const PetscReal then[3] = {w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0]};
  for (PetscInt d = 0; d < m->dim; ++d) {
    work[0] += force[d] * u[d];
    work[1] += force[d] * then[d];
  }
}

/* Do the loads of the first step leave it where it is along its free motions, and where it is put along them? What they
 * turn, or hold as a pendulum, has an answer, and what nothing pushes stays where its boundary has it. */
static PetscErrorCode LoadsLeave(const Model *m, const UnheldGroup *g, PetscBool *leave)
{
  PetscReal sums[2 * RIGID + 1] = {0}, pull[3], most = 0;

  PetscFunctionBeginUser;
  gravity_at(m->c, raised_time(m, m->time + m->c->analysis.step), pull);
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    PetscReal force[3] = {0, 0, 0};
    if (!unheld_is_of(g, node)) continue;
    for (PetscInt d = 0; d < m->dim; ++d) force[d] = unheld_load(m, pull, node * m->dim + d);
    for (PetscInt d = 0; d < m->dim; ++d) sums[2 * RIGID] += PetscAbsReal(force[d]);
    for (PetscInt f = 0; f < g->n_free; ++f) add_work(m, g, g->free[f], node, force, sums + 2 * f);
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sums, 2 * RIGID + 1, MPIU_REAL, MPIU_SUM, m->comm));
  for (PetscInt k = 0; k < 2 * RIGID; ++k) most = PetscMax(most, PetscAbsReal(sums[k]));
  *leave = (PetscBool)(most <= NEUTRAL * sums[2 * RIGID] && (m->contact || sums[2 * RIGID] > 0));
  PetscFunctionReturn(0);
}

/* Of all walls as they stand, touched or not: what they would hold if the body came into them anywhere. */
static void add_all_places(const Model *m, const UnheldGroup *g, PetscInt p, PetscReal *sum)
{
  const Walls *walls = m->contact->walls;
  const PetscReal *x = point_real(m->points, POINT_X, p);
  WallPlace place;
  for (PetscInt k = 0; k < m->c->n_walls; ++k) {
    if (!contact_meets_body(m->c, k, m->points->body[p])) continue;
    const int side = wall_side(walls, k, m->time, x);
    if (wall_near(walls, k, m->time, x, PETSC_MAX_REAL, side, &place))
      unheld_add_place(m, g, x, place.normal, m->c->walls[k].contact != CONTACT_FRICTIONLESS, sum);
  }
}

static PetscErrorCode WallsWouldHold(const Model *m, UnheldGroup *g)
{
  const Support *w = m->space->support;
  PetscReal sum[RIGID * RIGID] = {0};

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < w->n_groups; ++s)
    for (PetscInt p = w->point_start[s]; p < w->point_start[s + 1]; ++p)
      if (unheld_is_of(g, w->node[w->node_start[s]])) add_all_places(m, g, p, sum);
  PetscCall(UnheldTake(m, g, sum));
  PetscFunctionReturn(0);
}

/* Is there no other body that it could come to touch? */
static PetscErrorCode IsAlone(const Model *m, const UnheldGroup *g, PetscBool *alone)
{
  PetscInt others = 0;

  PetscFunctionBeginUser;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) others |= g->of[node] != 0 && !unheld_is_of(g, node);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &others, 1, MPIU_INT, MPI_MAX, m->comm));
  *alone = (PetscBool)!others;
  PetscFunctionReturn(0);
}

/* Is every motion that is left to it a turn? Directions have been looked at (advice/held.c). */
static PetscBool only_turns(const Model *m, const UnheldGroup *g)
{
  for (PetscInt f = 0; f < g->n_free; ++f) {
    PetscReal turns = 0;
    for (PetscInt k = m->dim; k < g->n; ++k) turns += PetscSqr(g->free[f][k]);
    if (turns < 0.1) return PETSC_FALSE;
  }
  return (PetscBool)(g->n_free > 0);
}

static PetscErrorCode RefuseTurning(Model *m, UnheldGroup *g, Diag *diag)
{
  PetscBool alone = PETSC_FALSE, leave = PETSC_FALSE;
  char path[64];

  PetscFunctionBeginUser;
  PetscCall(IsAlone(m, g, &alone));
  if (!alone) PetscFunctionReturn(0);
  if (m->contact) PetscCall(WallsWouldHold(m, g));
  if (!only_turns(m, g)) PetscFunctionReturn(0);
  PetscCall(LoadsLeave(m, g, &leave));
  if (!leave) PetscFunctionReturn(0);
  snprintf(path, sizeof path, "bodies[%d]", (int)g->body);
  diag_error(diag, path, "nothing holds '%s' from turning%s: a static analysis has no answer",
             m->c->bodies[g->body].name, m->contact ? " in its smooth round walls" : "");
  diag_hint(diag, "analysis: {unheld: hold} keeps it from that by nodes that bear nothing; or %s",
            m->contact ? "friction: 0.01 on a wall" : "fix a boundary at one more node");
  PetscFunctionReturn(0);
}

PetscErrorCode UnheldTurning(Model *m, Diag *diag)
{
  const PetscReal end = m->time + m->c->analysis.step;
  const NodalScene scene = nodal_scene(m, end, m->nodes->du);

  PetscFunctionBeginUser;
  if (m->c->analysis.type != ANALYSIS_STATIC || m->method->clouds || m->c->n_interfaces ||
      (m->contact && m->contact->n_rigid))
    PetscFunctionReturn(0);
  for (PetscInt k = 0; m->contact && k < m->c->n_walls; ++k) /* one that comes later may hold it */
    if (!wall_comes(m->contact->walls, k, m->time)) PetscFunctionReturn(0);
  PetscCall(NodalForcesBegin(&m->forces, &scene));
  PetscCall(NodalForcesExternal(&m->forces, &scene, PETSC_TRUE, m->nodes->external));
  PetscCall(UnheldEach(m, MEET_NONE, diag, RefuseTurning));
  PetscFunctionReturn(0);
}
