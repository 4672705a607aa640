/* What is moved at once when dynamics begin, in the first step however short that is: hardly ever meant, and said. What
 * an earlier stage moves has come there. */
#include "case/motion.h"
#include "model/model_private.h"

#define INSTANT 1e-9 /* of a step */

/* So soon after the start that what moves at a speed has not gone anywhere. */
static PetscReal soon(const Model *m)
{
  return m->time + PetscMax(INSTANT * m->c->analysis.step, 8 * PETSC_MACHINE_EPSILON * PetscAbsReal(m->time));
}

static PetscBool is_far(const Model *m, PetscReal way) { return (PetscBool)(way > 1e-6 * m->grid->smallest); }

static void hint_smooth(const Model *m, Diag *diag)
{
  const PetscReal span = m->c->analysis.end - m->c->start;
  diag_hint(diag, "an amplitude that begins with 0 lets it start smoothly: amplitude: [[0, 0], [%g, 1]]",
            (double)(span / 10));
}

/* A wall hits what is near. */
static void advise_wall(const Model *m, PetscInt k, Diag *diag)
{
  const WallSpec *wall = m->c->walls + k;
  const PetscReal t = m->time;
  PetscReal min[3], max[3], x[3] = {0, 0, 0}, way[3] = {0, 0, 0}, far = 0;
  char path[64];
  if (!wall->n_motions || wall->has_mass || wall->absent || wall->since < m->c->stage) return;
  wall_bounds(m->walls, k, t, min, max);
  for (int corner = 0; corner < 2; ++corner) {
    for (PetscInt d = 0; d < m->dim; ++d)
      x[d] = PetscMin(PetscMax(corner ? max[d] : min[d], m->grid->min[d]), m->grid->max[d]);
    wall_motion(m->walls, k, t, soon(m), x, way);
    far = PetscMax(far, PetscSqrtReal(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]));
  }
  if (!is_far(m, far)) return;
  PetscSNPrintf(path, sizeof path, "walls[%d].motion", (int)k);
  diag_warning(diag, path, "wall '%s' jumps by %g m at the start: what it meets there is hit at any speed", wall->name,
               (double)far);
  hint_smooth(m, diag);
}

/* Nodes that are held. Only a displacement can do so, which is the same for all of them. */
static void advise_motion(const Model *m, PetscInt k, Diag *diag)
{
  const MotionSpec *motion = m->c->boundary + k;
  const PetscReal nowhere[3] = {0, 0, 0};
  PetscReal far = 0;
  char path[64];
  if (motion->absent || motion->kind != MOTION_DISPLACEMENT || motion->amplitude.since < m->c->stage) return;
  for (PetscInt d = 0; d < m->dim; ++d) {
    if (!motion->component[d]) continue;
    const PetscReal way = motion_increment(m->c, motion, nowhere, d, m->time, soon(m));
    far = PetscSqrtReal(far * far + way * way);
  }
  if (!is_far(m, far)) return;
  PetscSNPrintf(path, sizeof path, "boundary[%d].%s", (int)k, motion->amplitude.n ? "amplitude" : "displacement");
  diag_warning(diag, path,
               "what this prescribes jumps by %g m at the start: all of it comes in the first step, the faster the "
               "shorter that is",
               (double)far);
  hint_smooth(m, diag);
}

void advise_jumps(const Model *m, Diag *diag)
{
  if (!m->scheme->inertia) return;
  for (PetscInt k = 0; m->walls && k < m->c->n_walls; ++k) advise_wall(m, k, diag);
  for (PetscInt k = 0; k < m->c->n_boundary; ++k) advise_motion(m, k, diag);
}
