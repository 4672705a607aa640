/* How walls with mass go on with a stage: one that comes begins as the stage says. One that was there stays where it is
 * unless it is drawn anew, and keeps its velocity and spin, whatever its mass is now, but for what the stage says where
 * the one before said nothing, or in other numbers. */
#include "model/stage/stage_private.h"
#include <string.h>

/* The same wall in the stage before, if it was there. */
static const RigidWall *wall_before(const Model *before, const char *name)
{
  for (PetscInt k = 0; before->contact && k < before->contact->n_rigid; ++k) {
    const WallSpec *w = before->c->walls + before->contact->rigid[k].wall;
    if (!w->absent && !strcmp(w->name, name)) return before->contact->rigid + k;
  }
  return NULL;
}

static PetscBool differ(const PetscReal a[3], const PetscReal b[3])
{
  return (PetscBool)(a[0] != b[0] || a[1] != b[1] || a[2] != b[2]);
}

/* What the stage says of its motion; of what it does not say, nothing changes. */
static void take_word(RigidWall *b, const WallMassSpec *is, const WallMassSpec *was)
{
  const PetscBool moves = is->has_velocity && (!was->has_velocity || differ(is->velocity, was->velocity));
  const PetscBool spins = is->has_spin && (!was->has_spin || differ(is->spin, was->spin));
  PetscReal omega[3];
  rigid_spin(b, omega);
  rigid_move(b, moves ? is->velocity : b->now.v, spins ? is->spin : omega);
}

void walls_go_on(Model *m, const Model *before)
{
  for (PetscInt k = 0; m->contact && k < m->contact->n_rigid; ++k) {
    RigidWall *b = m->contact->rigid + k;
    const WallSpec *wall = m->c->walls + b->wall;
    const RigidWall *was = wall_before(before, wall->name);
    if (!was) rigid_start(b, m->c);
    else if (wall->drawn == m->c->stage) rigid_redraw(b, was);
    else rigid_go_on(b, was);
    if (was && stands_still(m)) rigid_stop(b);
    if (was && m->scheme->inertia) take_word(b, &wall->mass, &before->c->walls[was->wall].mass);
    rigid_restore(b, m->walls);
  }
}
