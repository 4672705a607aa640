/* Walls with mass in explicit dynamics: rigid bodies whose velocities leap from the middle of one substep to that of
 * the next, as those of the nodes do (docs/theory.md, "Explicit dynamics").
 *
 * Their mass hangs on the springs of contact, which a substep has to resolve, too: with r those springs, l their levers
 * about the centre, no frequency is above
 *
 *   omega^2 = sum r (1/M + l^2 |J^-1|).
 *
 * What may come into contact is known only when it is there. As many springs as the box around a wall has room for
 * are counted with when the substep is chosen; if there are more, they are softer. */
#include <math.h>
#include "model/explicit/explicit.h"

#define SUMS (RIGID + 1)

static PetscReal size_of(const PetscReal v[3]) { return PetscSqrtReal(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/* Sides of the box around a wall as far as the grid goes (around the axis they are rings), and its radius about the
 * centre. */
static PetscReal sides_of(const Model *m, const RigidWall *b, PetscReal *radius)
{
  const PetscInt dim = m->dim;
  PetscReal min[3], max[3], l[3] = {1, 1, 1}, far[3] = {0, 0, 0}, all = 0;
  wall_bounds(m->walls, b->wall, m->time, min, max);
  for (PetscInt d = 0; d < dim; ++d) {
    const PetscReal centre = b->body.centre[d] + b->now.moved[d];
    min[d] = PetscMax(min[d], m->grid->min[d]);
    max[d] = PetscMin(max[d], m->grid->max[d]);
    l[d] = PetscMax(max[d] - min[d], 0);
    far[d] = PetscMax(PetscAbsReal(max[d] - centre), PetscAbsReal(min[d] - centre));
  }
  *radius = size_of(far);
  if (m->c->kinematics->hoop) return 2 * PETSC_PI * PetscMax(max[0], 0) * (PetscMax(max[0], 0) + l[1]);
  for (PetscInt d = 0; d < dim; ++d) all += dim == 2 ? 2 * l[d] : 2 * l[d] * l[(d + 1) % 3];
  return all;
}

void heavy_limit(const Model *m, Explicit *e)
{
  PetscReal stiffest = 0;
  e->swing = e->rush = 0;
  if (!m->contact) return;
  for (PetscInt k = 0; k < m->c->n_materials; ++k) stiffest = PetscMax(stiffest, m->materials[k].wave_modulus);
  for (const RigidWall *b = m->contact->rigid; b < m->contact->rigid + m->contact->n_rigid; ++b) {
    PetscReal radius, spin[3];
    const PetscReal area = sides_of(m, b, &radius), soft = rigid_softness(b, radius);
    rigid_spin(b, spin);
    e->swing = PetscMax(e->swing, stiffest / m->contact->length * area * soft);
    e->rush = PetscMax(e->rush, size_of(b->now.v) + size_of(spin) * radius);
  }
}

PetscReal heavy_substep(const Explicit *e)
{
  if (e->swing == 0) return e->critical; /* without points it has no end */
  return 1 / PetscSqrtReal(1 / PetscSqr(e->critical) + 0.25 * e->swing);
}

/* Forces and torques on each, and what their springs come to. */
static PetscErrorCode Sum(const Model *m, PetscReal *sum)
{
  const Contact *s = m->contact;

  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const RigidWall *b = contact_rigid(s, c);
    PetscReal f[3], arm[3];
    if (!b || c->state == CONTACT_OPEN) continue;
    PetscReal *own = sum + SUMS * (b - s->rigid);
    contact_force(c, f);
    rigid_arm(b, PETSC_TRUE, c->x, arm);
    for (int d = 0; d < 3; ++d) {
      const int i = (d + 1) % 3, j = (d + 2) % 3;
      own[d] += f[d];
      own[3 + d] += arm[i] * f[j] - arm[j] * f[i];
    }
    own[RIGID] += c->law.penalty * rigid_softness(b, size_of(arm));
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(SUMS * s->n_rigid), MPIU_REAL, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

/* In a substep that begins. The half kick that closes the run's step is of what was there in that, as in walls.c:
 * one that comes then has none of it yet, one that goes has it still. */
static PetscBool is_there(const Model *m, const Explicit *e, PetscInt wall)
{
  return e->dt > 0 ? wall_comes(m->walls, wall, e->time) : wall_stands(m->walls, wall, e->time);
}

PetscErrorCode HeavyMove(Model *m, Explicit *e)
{
  Contact *s = m->contact;
  PetscReal *sum;

  PetscFunctionBeginUser;
  if (!s->n_rigid) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(SUMS * s->n_rigid, &sum));
  PetscCall(Sum(m, sum));
  for (PetscInt k = 0; k < s->n_rigid; ++k) {
    RigidWall *b = s->rigid + k;
    const PetscReal swing = sum[SUMS * k + RIGID] / e->ease[k];
    for (int i = 0; i < RIGID; ++i) b->contact[i] = sum[SUMS * k + i];
    b->stands = is_there(m, e, b->wall);
    rigid_kick(b, m->c, e->time, e->kick);
    rigid_drift(b, e->dt);
    e->ease[k] = swing > e->swing ? e->swing / swing : 1;
  }
  PetscCall(PetscFree(sum));
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const RigidWall *b = contact_rigid(s, c);
    if (b) rigid_sweep(b, c->x, c->x, c->swept);
  }
  PetscFunctionReturn(0);
}

void heavy_go(Model *m)
{
  for (PetscInt k = 0; k < m->contact->n_rigid; ++k) rigid_go(m->contact->rigid + k, m->walls);
}
