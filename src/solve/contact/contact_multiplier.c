/* Penalties and multipliers of contact points: those that a step begins with, and when Newton's method gets others. */
#include "solve/contact/contact.h"

/* Penalty of a contact point, over the stiffness and inertia that a cell opposes to it. Gaps fall by
 * about this factor with every change of the multipliers. With 100 the sides of the law hand Newton's
 * iteration back and forth (docs/decisions.md, 106). */
#define STIFFER 5
/* The same along the wall where grains rub and flow, and points come to stick or begin to slide in every step: what is
 * wrongly held there throws the iteration back by as much as it is held (docs/theory.md, section 71). */
#define ALONG_FLOWS 2

#define CLOSED 1e-5 /* of a cell: gaps and slips that remain of contact, */
/* but no more than that share of what it moves by in the step, or its wall: a block that is squeezed by less than such
 * a gap would bear any force. Less than so much, of a cell, counts for nothing, unless it is more than a share as large
 * of what the largest force there takes: stiff bodies under little are squeezed by less. The last is round-off. */
#define MOVING 1e-3
#define SWINGS 3e-3 /* the same of what swings on a wall, or a body, by more than what counts for nothing */
#define STANDING 1e-9
#define ROUND_OFF 1e-16
#define TRIES 6        /* changes in which that is sought: a step must not fail for it */
#define BARELY 1e-16   /* of a cell: what touches at the start is pressed as by such a gap: less than any load */
#define NO_FORCE 1e-10 /* likewise: what is pressed by no more may have been left by round-off */
/* Where grains flow, that share of what the surface moves in the step, up to so much of a cell. */
#define MOVED 3e-3
#define FLOWING 5e-4
#define SLIPS \
  0.2 /* slips of friction that stay there, over such gaps: more let a column go 1 % too far along its floor */
#define LENT 1e-3  /* of the largest bond: who has lent so much more bears something else */
#define RESTS 1e-3 /* of a cell: what moves by no more along its wall in a step may be at rest */
#define MOST_CHANGES 40
/* Where more points touch than nodes can follow, gaps of some stay, and their multipliers would grow
 * against each other for ever: a gap that falls no faster may stay, up to so much of a cell. */
#define STALLS 0.5
#define ALLOWED 1e-3
/* Of what is bonded that happens where strains change from point to point, at ends of a clamped edge, and the whole run
 * would end there: after so many changes so many times as much may stay. */
#define PATIENCE 8
#define BONDED_ALLOWED 10
/* Of a mixed formulation the penalty is measured by shear, which is what a free surface feels; where
 * matter is locked in it feels its volume, and gaps fall slowly: then the penalty rises until they fall
 * by about so much, up to what volume opposes. */
#define FALLS 10
/* Of what rubs it rises so many times where it must: a slip that stays of what sticks does work. Where nothing but a
 * gap stays it is left as it is: which of more points than nodes can follow bear the force is nobody's choice, and a
 * higher penalty takes some of them away; what is bonded all points would lock, but where one is alone at a node:
 * contact_alone.c. */
#define RUBS 10
#define HIGHER 1.01 /* a penalty that could rise by less has risen: moduli that are alike differ by round-off */

/* In statics: with less a block that is pressed to half its height between plates askew to the grid loses its way
 * earlier, with more energy is made (docs/theory.md, section 73). */
#define GOES_ON 0.8

/* Of what is bonded more points ask than nodes can follow: what they cannot have stays as a slip, and from step to step
 * forces of those points grow against each other. They are none to the nodes until points have moved, and then neither
 * statics nor the midpoint rule takes anything of the energy that they make: so these begin anew in dynamics, and fade
 * in statics. */
static PetscReal goes_on(const Contact *s, const ContactPoint *c)
{
  if (c->law.kind != CONTACT_BONDED) return 1;
  if (s->share.moves) return s->share.inertia ? 1 : 0;
  return s->share.fades ? GOES_ON : 1;
}

/* Is it pressed by so little that this may be what round-off has left? In statics a body may slide on all of that. */
static PetscBool is_idle(const Contact *s, const ContactPoint *c)
{
  const PetscReal least = (NO_FORCE * s->length + PetscMax(c->open, 0)) * c->law.penalty;
  return (PetscBool)(!s->share.moves && c->law.kind != CONTACT_BONDED && c->multiplier.pressure <= least);
}

/* Those of the last step, and as much more or less as the gap that it left takes away: of a stiff body that
 * is no little force, and if it let go everywhere at once nothing would hold it; and what rests is to stay
 * where it is. What had none and touches the wall gets one so small that it counts for nothing, and as much more as the
 * gap that there is takes away (in dynamics one of round-off): it is in contact from the first iteration on. So is what
 * is idle, and where that slid it begins anew to do so. */
static void first_multiplier(const Contact *s, ContactPoint *c)
{
  const PetscReal whole = goes_on(s, c) / s->share.mean;
  const PetscReal bridged = PetscMin(s->share.moves ? NO_FORCE * s->length : PETSC_MAX_REAL, PetscMax(c->open, 0));
  const PetscReal barely = (BARELY * s->length + bridged) * c->law.penalty;
  c->multiplier = (ContactForce){0};
  for (int d = 0; d < 3; ++d) c->multiplier.pressure += whole * c->last[d] * c->normal[d];
  for (int d = 0; d < 3; ++d) c->multiplier.shear[d] = whole * c->last[d] - c->multiplier.pressure * c->normal[d];
  if (c->before != CONTACT_OPEN && c->open > -CLOSED * s->length) c->multiplier.pressure += c->law.penalty * c->open;
  if (!c->touches || (c->before != CONTACT_OPEN && !is_idle(s, c))) return;
  if (c->before == CONTACT_OPEN) c->multiplier.pressure = barely;
  c->multiplier.pressure = PetscMax(c->multiplier.pressure, barely);
  for (int d = 0; d < 3 && c->before != CONTACT_STICKS; ++d) c->multiplier.shear[d] = 0;
}

/* What a cell of one material opposes to a pressure, N/m3; of two that stand behind each other. */
static PetscReal stiffness_of(const ContactPoint *c, PetscReal h, PetscReal inertia)
{
  const PetscReal k = c->modulus[0] / h + inertia * c->density[0] * h;
  const PetscReal other = c->modulus[1] / h + inertia * c->density[1] * h;
  return other > 0 ? k * other / (k + other) : k;
}

/* Grains that flow have gaps of their own (FLOWING). */
static PetscReal stiffest_of(const Contact *s, const ContactPoint *c)
{
  const PetscBool rubs = c->law.kind == CONTACT_FRICTION || c->law.kind == CONTACT_STICK;
  return PetscMax(c->stiffer, rubs && !s->share.flows ? RUBS : 1) * c->law.penalty;
}

static PetscReal spread_of(const Contact *s, const ContactPoint *c)
{
  PetscReal sum = 0;
  for (PetscInt e = c->first; e < c->first + c->n; ++e) sum += PetscAbsReal(s->N[e]);
  return sum;
}

/* What is bonded goes along with its wall in all directions: which of them is called normal is all the same. */
static PetscBool pushes_halfway(const Contact *s, const ContactPoint *c)
{
  return (PetscBool)(s->share.moves && c->law.kind != CONTACT_BONDED && c->wall < s->n_walls && s->turns[c->wall]);
}

void contact_prepare(Contact *s, PetscReal t, PetscReal dt, PetscReal inertia, ContactShare share)
{
  s->share = share;
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    c->cell = c->section * stiffness_of(c, s->length, inertia);
    c->law.penalty = STIFFER * c->cell;
    c->law.along = (share.yields && c->law.kind == CONTACT_FRICTION ? ALONG_FLOWS : STIFFER) * c->softer * c->cell;
    c->stiffest = stiffest_of(s, c);
    c->ahead = c->reach;
    c->left = 0;
    c->spread = spread_of(s, c);
    for (int d = 0; d < 3; ++d) c->struck[d] = c->lent[d] = 0;
    for (int d = 0; d < 3 && c->before == CONTACT_OPEN; ++d) c->last[d] = 0; /* explicit dynamics keeps slips there */
    c->law.bond = c->bond / share.mean;
    c->halfway = pushes_halfway(s, c);
    if (c->wall < s->n_walls && !contact_rigid(s, c)) wall_motion(s->walls, c->wall, t, t + dt, c->x, c->swept);
    first_multiplier(s, c);
  }
}

/* As the step began, but for what slips oppose. */
static void soften(const Contact *s, ContactPoint *c)
{
  c->law.penalty = STIFFER * c->cell;
  c->law.along = ALONG_FLOWS * c->softer * c->cell / PetscMax(1, c->law.friction);
  c->left = 0;
  first_multiplier(s, c);
}

PetscErrorCode ContactSoften(Contact *s, MPI_Comm comm, PetscBool *softer)
{
  PetscBool jams = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    jams |= c->law.kind != CONTACT_BONDED && c->law.friction > 1 && contact_touched(c);
  PetscCallMPI(MPI_Allreduce(&jams, softer, 1, MPIU_BOOL, MPI_LOR, comm));
  for (ContactPoint *c = s->point; c < s->point + s->n && *softer; ++c)
    if (c->law.kind != CONTACT_BONDED) soften(s, c);
  PetscFunctionReturn(0);
}

/* Motion of what is in contact against its wall. */
static PetscReal motion_of(const ContactPoint *c)
{
  if (c->state == CONTACT_OPEN) return 0;
  return PetscSqrtReal(PetscSqr(c->slip[0]) + PetscSqr(c->slip[1]) + PetscSqr(c->slip[2]));
}

/* Farther than friction lets it slip before it slides. */
static PetscBool is_carried(const Contact *s, const ContactPoint *c)
{
  PetscReal along = 0, square = 0, pressure = 0;
  if (!contact_touched(c) || c->law.kind == CONTACT_BONDED) return PETSC_FALSE;
  for (int d = 0; d < 3; ++d) along += c->swept[d] * c->facing[d], pressure += c->last[d] * c->facing[d];
  if (-along * c->law.penalty > pressure + 1e-9 * s->length * c->law.penalty) return PETSC_TRUE; /* it goes away */
  if (c->law.kind == CONTACT_FRICTIONLESS) return PETSC_FALSE;
  for (int d = 0; d < 3; ++d) square += PetscSqr(c->swept[d] - along * c->facing[d]);
  return (PetscBool)(PetscSqrtReal(square) * c->law.along >
                     contact_most(&c->law, pressure) + 1e-9 * s->length * c->law.along);
}

PetscErrorCode ContactCarries(const Contact *s, MPI_Comm comm, PetscBool *carries)
{
  PetscBool here = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n && !s->share.moves; ++c) here |= is_carried(s, c);
  PetscCallMPI(MPI_Allreduce(&here, carries, 1, MPIU_BOOL, MPI_LOR, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactMoves(const Contact *s, MPI_Comm comm, PetscBool *moves)
{
  PetscBool here = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) here |= motion_of(c) > RESTS * s->length;
  PetscCallMPI(MPI_Allreduce(&here, moves, 1, MPIU_BOOL, MPI_LOR, comm));
  PetscFunctionReturn(0);
}

PetscReal contact_unresolved(const Contact *s, PetscReal size)
{
  PetscReal sum = 0;
  for (PetscInt k = 0; s && k < s->n_partners; ++k) {
    const PetscReal *f = s->wall[k].mean.force;
    sum += CLOSED * size * PetscSqrtReal(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
  }
  return sum;
}

/* What its forces leave of a gap, m, */
static PetscReal gap_of(const ContactPoint *c)
{
  if (c->state == CONTACT_OPEN) return 0;
  return PetscAbsReal(c->now.pressure - c->multiplier.pressure) / c->law.penalty;
}

/* and of a slip: what the law would make of them once more, less what they are, over its stiffness. Where nothing
 * slides that is the slip; of what slides it is that against the way that friction acts, or across it. */
static PetscReal slip_of(const ContactPoint *c)
{
  PetscReal again[3], away = 0, square = 0, left = 0;
  if (c->state == CONTACT_OPEN || c->law.kind == CONTACT_FRICTIONLESS) return 0;
  for (int d = 0; d < 3; ++d) away += c->slip[d] * c->push[d];
  for (int d = 0; d < 3; ++d) {
    again[d] = c->now.shear[d] - c->law.along * (c->slip[d] - away * c->push[d]);
    square += PetscSqr(again[d]);
  }
  const PetscReal most = c->law.kind == CONTACT_BONDED ? PETSC_MAX_REAL : contact_most(&c->law, c->now.pressure);
  const PetscReal part = PetscSqrtReal(square) > most ? most / PetscSqrtReal(square) : 1;
  for (int d = 0; d < 3; ++d) left = PetscMax(left, PetscAbsReal(part * again[d] - c->now.shear[d]));
  return left / c->law.along;
}

static PetscReal left_of(const ContactPoint *c) { return PetscMax(gap_of(c), slip_of(c)); }

/* Does what is left fall slowly, although the penalty may rise? */
static PetscBool is_soft(const ContactPoint *c, PetscReal left)
{
  return c->left > 0 && left > STALLS * c->left && HIGHER * c->law.penalty < c->stiffest;
}

/* Gaps fall by 1 + penalty / stiffness of what is pressed: what is measured says which that is. */
static void stiffen(ContactPoint *c, PetscReal left)
{
  const PetscReal rate = PetscMin(left / c->left, 0.9), before = c->law.penalty;
  c->law.penalty = PetscMin(c->stiffest, before * (FALLS - 1) * rate / (1 - rate));
  c->law.along *= c->law.penalty / before;
}

/* Of a motion, what a gap may be compared with: in statics none along the wall, which a body may be dragged by while it
 * is pressed by next to nothing. */
static PetscReal counts_of(const Contact *s, const ContactPoint *c, const PetscReal motion[3])
{
  PetscReal square = 0, along = 0;
  for (int d = 0; d < 3; ++d) square += motion[d] * motion[d], along += motion[d] * c->normal[d];
  const PetscBool slips = c->law.kind == CONTACT_FRICTIONLESS || c->law.kind == CONTACT_FRICTION;
  return slips && !s->share.moves ? PetscAbsReal(along) : PetscSqrtReal(square);
}

/* How far its body, or its wall, takes a contact point in the step, m. In dynamics what rests with a gap would be
 * shaken, and what flies has its force of its inertia: there walls count that are moved, and what is bonded. */
static PetscReal travel_of(const Contact *s, const ContactPoint *c, const NodalScene *scene)
{
  const PetscBool driven = c->wall < s->n_walls && !contact_rigid(s, c);
  PetscReal own[3] = {0};
  if (c->state == CONTACT_OPEN) return 0;
  if (s->share.moves && c->law.kind != CONTACT_BONDED) return driven ? counts_of(s, c, c->swept) : 0;
  for (PetscInt e = c->first; e < c->first + c->own; ++e)
    for (PetscInt d = 0; d < s->dim; ++d) own[d] += scene->whole * s->N[e] * scene->du[s->node[e] * s->dim + d];
  return PetscMax(counts_of(s, c, own), counts_of(s, c, c->swept));
}

/* Newmark's rule remembers what small gaps take, and shakes what rests on a bonded body, which may slide. What is
 * bonded alone swings for ever, and such gaps would add to its energy in each step, or take of it. */
static PetscBool is_remembered(const Contact *s, const ContactPoint *c)
{
  return (PetscBool)(s->share.moves && s->share.inertia && c->law.kind == CONTACT_BONDED);
}

/* The most that anything moves by in the step, m, on this rank. */
static PetscReal swing_of(const Contact *s, const NodalScene *scene)
{
  PetscReal most = 0;
  for (PetscInt i = 0; i < scene->grid->n_owned * s->dim; ++i) most = PetscMax(most, PetscAbsReal(scene->du[i]));
  return scene->whole * most;
}

/* Each change leaves a fifth of a gap, or so. */
static PetscInt tries(const Contact *s)
{
  return TRIES + (PetscInt)PetscCeilReal(PetscLogReal(1 / s->share.asked) / PetscLogReal(STIFFER));
}

/* Of gaps, while these are sought. Where nothing was in contact before pressures are small, in dynamics, and such a gap
 * would take a hundredth of them: there it is a share of what they take away. */
static PetscReal closed_by(const Contact *s, PetscInt change, PetscReal pressed)
{
  const PetscReal most = CLOSED * s->length;
  if (!s->begins || !s->share.moves || s->share.yields || change >= tries(s)) return most;
  return PetscMin(most, MOVING * pressed);
}

/* What counts against ALLOWED where gaps stall. */
static PetscReal stalled_of(const ContactPoint *c, PetscInt change, PetscReal left)
{
  return c->law.kind == CONTACT_BONDED && change >= PATIENCE ? left / BONDED_ALLOWED : left;
}

/* Who bears has changed, and with it who adheres. */
static PetscErrorCode LendAgain(Contact *s, const Grid *grid, PetscBool *again)
{
  PetscReal changed;

  PetscFunctionBeginUser;
  PetscCall(ContactLend(s, grid, PETSC_FALSE, &changed));
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) c->law.bond = c->bond / s->share.mean;
  if (changed > LENT) *again = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* The largest of all points and ranks: */
enum {
  OF_GAPS,        /* and of slips of what does not rub, m */
  OF_SOFT,        /* gaps and slips of what may be stiffened, m, */
  OF_BONDS,       /* of that those of what is bonded */
  OF_MOTIONS,     /* motion_of, m */
  OF_STALLED,     /* stalled_of, m */
  OF_SLIPS,       /* of what rubs, m */
  OF_TRAVELS,     /* travel_of, m, */
  OF_REMEMBERED,  /* and that of what is_remembered */
  OF_PRESSED,     /* what pressures take away, m */
  OF_SWING,       /* swing_of, m */
  WAS_IN_CONTACT, /* was any before the step? */
  RUBS_NOW,       /* does any rub, */
  SLIDES_NOW,     /* and slide, or is it two bodies? */
  OF_ALL
};

/* Of what rubs: it slides, or rests on another body, where parts of it slide now and then. */
static PetscBool may_slide(const Contact *s, const ContactPoint *c)
{
  return (PetscBool)(c->state == CONTACT_SLIDES || c->wall >= s->n_walls);
}

static PetscErrorCode LookAt(const Contact *s, const NodalScene *scene, PetscInt change, PetscReal most[OF_ALL])
{
  PetscReal w[OF_ALL] = {0};

  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const PetscReal left = left_of(c);
    const PetscBool rubs = c->law.kind == CONTACT_FRICTION;
    const int travels = is_remembered(s, c) ? OF_REMEMBERED : OF_TRAVELS;
    w[OF_GAPS] = PetscMax(w[OF_GAPS], rubs ? gap_of(c) : left);
    w[OF_SLIPS] = PetscMax(w[OF_SLIPS], rubs ? slip_of(c) : 0);
    if (is_soft(c, left)) w[OF_SOFT] = PetscMax(w[OF_SOFT], left);
    if (is_soft(c, left) && c->law.kind == CONTACT_BONDED) w[OF_BONDS] = PetscMax(w[OF_BONDS], left);
    w[OF_MOTIONS] = PetscMax(w[OF_MOTIONS], motion_of(c));
    w[OF_STALLED] = PetscMax(w[OF_STALLED], stalled_of(c, change, left));
    w[travels] = PetscMax(w[travels], travel_of(s, c, scene));
    w[OF_PRESSED] = PetscMax(w[OF_PRESSED], PetscAbsReal(c->now.pressure) / c->law.penalty);
    w[WAS_IN_CONTACT] = PetscMax(w[WAS_IN_CONTACT], c->before != CONTACT_OPEN);
    w[RUBS_NOW] = PetscMax(w[RUBS_NOW], rubs && c->state != CONTACT_OPEN);
    w[SLIDES_NOW] = PetscMax(w[SLIDES_NOW], rubs && may_slide(s, c));
  }
  w[OF_SWING] = swing_of(s, scene);
  PetscCall(MPIU_Allreduce(w, most, OF_ALL, MPIU_REAL, MPIU_MAX, scene->grid->comm));
  PetscFunctionReturn(0);
}

/* What may stay of gaps, or of slips, which `times` as much may. A gap that is taken away while the pressure is high,
 * and let be while it is low, gives energy to what swings on a wall: where nothing slides it is a share of what swings.
 * What rests would be shaken by that, and between bodies that rub on each other what rests slides here or there. */
static PetscReal allowed(const Contact *s, PetscInt change, const PetscReal most[OF_ALL], PetscReal times)
{
  const PetscReal closed = closed_by(s, change, most[OF_PRESSED]), asked = s->share.asked;
  const PetscReal still = PetscMax(ROUND_OFF * s->length, PetscMin(STANDING * s->length, MOVING * most[OF_PRESSED]));
  const PetscReal travelled = PetscMax(most[OF_TRAVELS], most[RUBS_NOW] > 0 ? 0 : most[OF_REMEMBERED]);
  const PetscReal swing = most[SLIDES_NOW] > 0 ? 0 : most[OF_SWING];
  const PetscBool sought = (PetscBool)(!s->share.yields && change < tries(s));
  PetscReal stays = closed;
  if (s->share.flows) stays = PetscMax(closed, times * PetscMin(MOVED * most[OF_MOTIONS], FLOWING * s->length));
  else if (sought && !(s->share.moves && travelled == 0)) stays = PetscMin(closed, MOVING * travelled);
  else if (sought && SWINGS * swing > STANDING * s->length) stays = PetscMin(closed, SWINGS * swing);
  return PetscMax(still, asked * stays);
}

/* Multipliers become the forces that there are, and the balance is sought again, unless gaps and
 * slips of what is in contact have all but vanished. */
PetscErrorCode ContactAugment(void *data, const NodalScene *scene, PetscInt change, PetscBool *again)
{
  Contact *s = data;
  PetscReal most[OF_ALL];

  PetscFunctionBeginUser;
  PetscCall(LookAt(s, scene, change, most));
  s->begins = most[WAS_IN_CONTACT] == 0;
  const PetscReal all = PetscMax(most[OF_GAPS], most[OF_SLIPS]);
  const PetscReal closed = s->begins ? s->share.asked * closed_by(s, change, most[OF_PRESSED]) : CLOSED * s->length;
  const PetscReal asked = allowed(s, change, most, 1);
  /* a bond that could close what its step asks for would go on with it */
  const PetscBool soft = most[OF_SOFT] > closed || most[OF_BONDS] > asked;
  const PetscBool slow = change > 0 && all > STALLS * s->worst;
  const PetscBool stalls = slow && !soft && most[OF_STALLED] <= ALLOWED * s->length;
  const PetscBool stay = most[OF_GAPS] <= asked && most[OF_SLIPS] <= allowed(s, change, most, SLIPS);
  *again = !stay && change < MOST_CHANGES && !stalls;
  s->worst = all;
  if (s->adheres && change < TRIES) PetscCall(LendAgain(s, scene->grid, again));
  if (!*again) PetscFunctionReturn(0);
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const PetscReal left = left_of(c);
    if (is_soft(c, left)) stiffen(c, left);
    c->multiplier = c->now;
    c->left = left;
  }
  PetscFunctionReturn(0);
}
