/* What is moved at once when dynamics begin, in the first step however short that is: hardly ever meant, and said. What
 * an earlier stage moves has come there. In statics it is meant where nothing came before; in a state that goes on, an
 * amplitude that begins with 1 wants to hold what has been moved, and moves it once more. */
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

static void tell_wall(const Model *m, PetscInt k, PetscReal far, Diag *diag)
{
  char path[64];
  PetscSNPrintf(path, sizeof path, "walls[%d].motion", (int)k);
  if (m->scheme->inertia) {
    diag_warning(diag, path, "wall '%s' jumps by %g m at the start: what it meets there is hit at any speed",
                 m->c->walls[k].name, (double)far);
    hint_smooth(m, diag);
    return;
  }
  diag_warning(diag, path,
               "wall '%s' jumps by %g m at the start: it begins where its shape is, whatever moved it before, and all "
               "of its way comes in the first step",
               m->c->walls[k].name, (double)far);
  diag_hint(diag,
            "to hold it leave it out here, or draw its shape where it is by now, without a motion; to move it on "
            "give the way from there, with an amplitude that begins with 0");
}

/* A wall hits what is near. */
static void advise_wall(const Model *m, PetscInt k, Diag *diag)
{
  const WallSpec *wall = m->c->walls + k;
  const PetscReal t = m->time;
  PetscReal min[3], max[3], x[3] = {0, 0, 0}, way[3] = {0, 0, 0}, far = 0;
  if (!wall->n_motions || wall->has_mass || wall->absent || wall->since < m->c->stage) return;
  wall_bounds(m->walls, k, t, min, max);
  for (int corner = 0; corner < 2; ++corner) {
    for (PetscInt d = 0; d < m->dim; ++d)
      x[d] = PetscMin(PetscMax(corner ? max[d] : min[d], m->grid->min[d]), m->grid->max[d]);
    wall_motion(m->walls, k, t, soon(m), x, way);
    far = PetscMax(far, PetscSqrtReal(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]));
  }
  if (is_far(m, far)) tell_wall(m, k, far, diag);
}

static void tell_motion(const Model *m, PetscInt k, PetscReal far, Diag *diag)
{
  char path[64];
  PetscSNPrintf(path, sizeof path, "boundary[%d].%s", (int)k,
                m->c->boundary[k].amplitude.n ? "amplitude" : "displacement");
  if (m->scheme->inertia) {
    diag_warning(diag, path,
                 "what this prescribes jumps by %g m at the start: all of it comes in the first step, the faster the "
                 "shorter that is",
                 (double)far);
    hint_smooth(m, diag);
    return;
  }
  diag_warning(diag, path,
               "what this prescribes jumps by %g m at the start: it counts from where nodes are by now, and all of it "
               "comes in the first step",
               (double)far);
  diag_hint(diag,
            "to hold them leave it out here, or say `fix`; to move them on give the way from there, with an "
            "amplitude that begins with 0");
}

/* Nodes that are held. Only a displacement can do so, which is the same for all of them. */
static void advise_motion(const Model *m, PetscInt k, Diag *diag)
{
  const MotionSpec *motion = m->c->boundary + k;
  const PetscReal nowhere[3] = {0, 0, 0};
  PetscReal far = 0;
  if (motion->absent || motion->kind != MOTION_DISPLACEMENT || motion->amplitude.since < m->c->stage) return;
  for (PetscInt d = 0; d < m->dim; ++d) {
    if (!motion->component[d]) continue;
    const PetscReal way = motion_increment(m->c, motion, nowhere, d, m->time, soon(m));
    far = PetscSqrtReal(far * far + way * way);
  }
  if (is_far(m, far)) tell_motion(m, k, far, diag);
}

void advise_jumps(const Model *m, Diag *diag)
{
  if (!m->scheme->inertia && !case_goes_on(m->c)) return;
  for (PetscInt k = 0; m->walls && k < m->c->n_walls; ++k) advise_wall(m, k, diag);
  for (PetscInt k = 0; k < m->c->n_boundary; ++k) advise_motion(m, k, diag);
}
