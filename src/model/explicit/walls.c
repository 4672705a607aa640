/* Rigid walls in explicit dynamics: springs between their surface and that of the material.
 *
 * Contact points are those of implicit dynamics (solve/contact), and so is the law; but nothing is
 * solved for. What has gone into a wall is pushed by
 *
 *   p = - r g,    t = t of the substep before - r s, at most friction p + bond,    r = A M / h,
 *
 * g < 0 the gap, s the slip since then, A the surface that the point stands for. So a wall is as stiff as a
 * cell of the material before it: the critical substep stays as it is, material sinks in by a cell's
 * strain, and nothing drifts that sticks. */
#include "model/explicit/explicit.h"
#include "solve/contact/contact.h"

#define FITS 1e-6 /* of a force: what it may differ by from that of its spring */

static PetscReal dot(const PetscReal a[3], const PetscReal b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Another scheme has left a force and no gap: the surface is where the spring has that force. */
static void take_over(ContactPoint *c)
{
  const PetscReal pressure = dot(c->last, c->normal), off = pressure / c->law.penalty + c->open;
  if (c->before == CONTACT_OPEN || pressure <= 0 || off * c->law.penalty <= FITS * pressure) return;
  c->reach += off;
  c->open -= off;
}

/* Force of one wall on one point. */
static void push(const Model *m, const Explicit *e, ContactPoint *c)
{
  const WallPlace place = {.gap = c->open, .normal = {c->normal[0], c->normal[1], c->normal[2]}};
  static const PetscReal nowhere[3] = {0, 0, 0};
  const PetscReal pressure = dot(c->last, c->normal);
  ContactForce before = {0};
  for (int d = 0; d < 3; ++d) before.shear[d] = c->last[d] - pressure * c->normal[d];
  c->law.bond = c->bond;
  c->state = CONTACT_OPEN;
  c->now = (ContactForce){0};
  c->gap = place.gap;
  if (e->dt > 0) wall_motion(m->walls, c->wall, e->time, e->time + e->dt, c->x, c->swept);
  if (c->gone && e->dt > 0) return;
  c->state = contact_law(&c->law, &place, nowhere, &before, &c->now, NULL);
}

PetscErrorCode WallsPush(Model *m, Explicit *e)
{
  const PetscInt dim = m->dim;
  Contact *s = m->contact;
  PetscReal f[3];

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    c->law.penalty = c->section * c->modulus[0] / s->length;
    if (e->first) take_over(c);
    push(m, e, c);
    if (c->state == CONTACT_OPEN) continue;
    contact_force(c, f);
    for (PetscInt k = c->first; k < c->first + c->n; ++k)
      for (PetscInt d = 0; d < dim; ++d) e->sum[s->node[k] * e->width + 1 + dim + d] += s->N[k] * f[d];
    for (int d = 0; d < 3; ++d) f[d] *= e->kick / e->step;
    contact_add(c, dim, f, e->pushed + c->wall);
  }
  e->first = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* What its place on the surface moves by: with its point, and beyond that with what strains it. lead: along the normal, of
 * that alone. */
static void move_of(const Model *m, const Explicit *e, const ContactPoint *c, PetscReal move[3], PetscReal *lead)
{
  const Contact *s = m->contact;
  *lead = move[0] = move[1] = move[2] = 0;
  for (PetscInt k = c->first; k < c->first + c->n; ++k)
    for (PetscInt d = 0; d < m->dim; ++d) {
      const PetscReal beyond = e->dt * s->lead[k] * e->straining[s->node[k] * m->dim + d];
      move[d] += e->dt * (s->N[k] - s->lead[k]) * e->motion[s->node[k] * 2 * m->dim + d] + beyond;
      *lead += c->normal[d] * beyond;
    }
}

void walls_follow(Model *m, Explicit *e)
{
  const PetscInt dim = m->dim;
  const Contact *s = m->contact;
  if (!s) return;
  for (PetscInt i = 0; i < m->points->n * m->points->components[POINT_CONTACT]; ++i)
    m->points->real[POINT_CONTACT][i] = 0;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    PetscReal *kept = point_real(m->points, POINT_CONTACT, c->owner) + c->wall * CONTACT_KEPT(dim);
    const PetscReal first = m->points->real[POINT_REACH][c->owner];
    PetscReal move[3], lead, f[3];
    move_of(m, e, c, move, &lead);
    contact_force(c, f);
    kept[0] = (PetscReal)c->state;
    kept[1] = PetscMax(THINNEST * first, PetscMin(THICKEST * first, c->reach - lead));
    for (int d = 0; d < 3; ++d) move[d] -= c->swept[d];
    const PetscReal closing = dot(move, c->normal), pressure = dot(f, c->normal);
    for (PetscInt d = 0; d < dim && c->state != CONTACT_OPEN; ++d) {
      const PetscReal slip = move[d] - closing * c->normal[d], shear = f[d] - pressure * c->normal[d];
      kept[2 + d] = f[d] - (c->law.kind == CONTACT_FRICTIONLESS ? 0 : c->law.penalty * slip);
      e->rubbed[c->wall] -= shear * slip;
      e->boundary += f[d] * c->swept[d];
    }
  }
}

/* What measures ask of each wall after a step of the run. */
PetscErrorCode WallsAccount(Model *m, Explicit *e)
{
  Contact *s = m->contact;
  PetscReal *area, *deepest;

  PetscFunctionBeginUser;
  e->friction = 0;
  if (!s) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(s->n_partners, &area, s->n_partners, &deepest));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    if (c->state != CONTACT_OPEN) area[c->wall] += c->section;
    if (c->state != CONTACT_OPEN) deepest[c->wall] = PetscMax(deepest[c->wall], -c->gap);
  }
  for (PetscInt k = 0; k < s->n_partners; ++k) e->friction += e->rubbed[k];
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, area, (PetscMPIInt)s->n_partners, MPIU_REAL, MPI_SUM, m->comm));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, deepest, (PetscMPIInt)s->n_partners, MPIU_REAL, MPI_MAX, m->comm));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, e->rubbed, (PetscMPIInt)s->n_partners, MPIU_REAL, MPI_SUM, m->comm));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, e->pushed, (PetscMPIInt)(s->n_partners * (PetscInt)(sizeof(ContactSum) / sizeof(PetscReal))),
                           MPIU_REAL, MPI_SUM, m->comm));
  for (PetscInt k = 0; k < s->n_partners; ++k) {
    s->wall[k].mean = e->pushed[k];
    s->wall[k].friction += e->rubbed[k];
    s->wall[k].area = area[k];
    s->wall[k].deepest = deepest[k];
    s->wall[k].rate = e->pushed[k];
  }
  PetscCall(PetscFree2(area, deepest));
  PetscFunctionReturn(0);
}
