/* What a stage lets go of, a wall or a body may bear from then on (docs/theory.md, "Stages"). */
#include "base/math/vector.h"
#include "model/stage/stage_private.h"

#define REACHES 0.05 /* a function of less on the surface is one of nodes beside it */

/* Springs of explicit dynamics take nothing over. */
PetscBool inertia_is_known(const Model *m, const Case *from)
{
  const TimeScheme *before = time_scheme_of(&from->analysis);
  if (m->c->analysis.type == ANALYSIS_EXPLICIT) return PETSC_FALSE;
  if (stands_still(m) || case_is_static(&from->analysis)) return PETSC_TRUE;
  return (PetscBool)(!before->middle && before != &time_scheme_explicit);
}

/* What free nodes lack for the acceleration that they have, N: n_nodes x dim, on all copies. */
static PetscErrorCode FindLacks(const Model *m, const PetscReal *residual, PetscReal *lacks)
{
  const PetscBool lacks_inertia = (PetscBool)(m->scheme->inertia && !m->remainder); /* else it is out of them */

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i)
    lacks[i] = residual[i] + (lacks_inertia ? m->nodes->mass[i / m->dim] * m->nodes->a[i] : 0);
  keep_free(m, lacks);
  PetscCall(GridToGhosts(m->grid, m->dim, lacks));
  PetscFunctionReturn(0);
}

/* Does it touch a partner that moves as it is told, and bears nothing there? */
static PetscBool bears_nothing(const Model *m, const ContactPoint *c)
{
  if (c->gone || contact_rigid(m->contact, c) || vector_dot(c->last, c->last) > 0) return PETSC_FALSE;
  return (PetscBool)(PetscAbsReal(c->open) <= CONTACT_HAIR * m->grid->smallest);
}

/* How much entry e of a contact point counts at its node, m2: the first body's nodes have positive functions, the
 * other's negative ones, and of those that do not reach the surface round-off, or what strain makes of it, is left. */
static PetscReal share_of(const Contact *s, const ContactPoint *c, PetscInt e, int sign)
{
  return sign * s->N[e] > REACHES ? c->section * PetscAbsReal(s->N[e]) : 0;
}

/* Area of each node that the partner's contact points stand for which take over (takes: of each of them), m2, on all
 * copies. any: are there such? */
static PetscErrorCode NodeAreas(const Model *m, PetscInt partner, int sign, PetscBool *takes, PetscReal *area,
                                PetscBool *any)
{
  const Contact *s = m->contact;

  PetscFunctionBeginUser;
  *any = PETSC_FALSE;
  for (PetscInt k = 0; k < s->n; ++k) {
    const ContactPoint *c = s->point + k;
    takes[k] = (PetscBool)(c->wall == partner && bears_nothing(m, c));
    *any |= takes[k];
    for (PetscInt e = c->first; e < c->first + c->n && takes[k]; ++e) area[s->node[e]] += share_of(s, c, e, sign);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, any, 1, MPIU_BOOL, MPI_LOR, m->comm));
  if (!*any) PetscFunctionReturn(0);
  PetscCall(GridSumToOwners(m->grid, 1, area));
  PetscCall(GridToGhosts(m->grid, 1, area));
  PetscFunctionReturn(0);
}

/* f = A sum N_I t_I, of the tractions t_I = R_I / A_I of its nodes: all points together bear the sum of R_I, and each
 * the same traction where nodes have one. given: what nodes get of it. */
static void press(const Model *m, ContactPoint *c, int sign, const PetscReal *lacks, const PetscReal *area,
                  PetscReal *given)
{
  const Contact *s = m->contact;
  PetscReal f[3] = {0};
  for (PetscInt e = c->first; e < c->first + c->n; ++e) {
    const PetscReal share = share_of(s, c, e, sign);
    for (PetscInt d = 0; d < m->dim && share > 0; ++d)
      f[d] += sign * share / area[s->node[e]] * lacks[s->node[e] * m->dim + d];
  }
  contact_press(c, f);
  for (PetscInt e = c->first; e < c->first + c->n; ++e)
    for (PetscInt d = 0; d < m->dim; ++d) given[s->node[e] * m->dim + d] += s->N[e] * c->last[d];
}

/* It stands where its force was borne, with neither gap nor overlap. */
static void keep(const Model *m, const ContactPoint *c)
{
  PetscReal *kept = contact_kept_of(m->contact, m->points, c);
  kept[KEPT_STATE] = (PetscReal)c->before + (c->let_in ? CONTACT_LET_IN : 0);
  kept[KEPT_REACH] = c->reach + c->open;
  kept[KEPT_PASSED(m->dim)] = c->behind;
  kept[KEPT_STAYS(m->dim)] = c->stays;
  for (PetscInt d = 0; d < m->dim; ++d) kept[KEPT_FORCE + d] = c->last[d];
  contact_keep_normal(kept, m->dim, m->contact->sides, c->facing);
}

static PetscErrorCode Subtract(const Model *m, PetscReal *given, PetscReal *lacks)
{
  PetscFunctionBeginUser;
  PetscCall(GridSumToOwners(m->grid, m->dim, given));
  keep_free(m, given);
  PetscCall(GridToGhosts(m->grid, m->dim, given));
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i) lacks[i] -= given[i];
  PetscFunctionReturn(0);
}

/* What has just been bonded, and moves, is stopped by the step, and by no impulse before that: it counts as what
 * slides, whatever it bears (contact/bonds.c). */
static void stay_new(const Model *m, ContactState was, ContactPoint *c)
{
  if (m->scheme->inertia && c->law.kind == CONTACT_BONDED && was == CONTACT_SLIDES) c->before = CONTACT_SLIDES;
}

/* Contact points of one partner bear what nodes lack of one of its bodies, which lack it no more. */
static PetscErrorCode PartnerTakes(const Model *m, PetscInt partner, int sign, PetscReal *lacks, PetscBool *taken)
{
  const Contact *s = m->contact;
  const PetscInt nodes = m->grid->n_nodes, dofs = nodes * m->dim;
  PetscReal *area, *given;
  PetscBool *takes, any;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(nodes, &area, dofs, &given, s->n, &takes));
  PetscCall(NodeAreas(m, partner, sign, takes, area, &any));
  for (PetscInt k = 0; k < s->n; ++k) {
    if (!takes[k]) continue;
    const ContactState was = s->point[k].before;
    press(m, s->point + k, sign, lacks, area, given);
    stay_new(m, was, s->point + k);
    if (s->point[k].before == CONTACT_OPEN) continue;
    keep(m, s->point + k);
    *taken = PETSC_TRUE;
  }
  if (any) PetscCall(Subtract(m, given, lacks));
  PetscCall(PetscFree3(area, given, takes));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactTakesOver(const Model *m, const Case *from, const PetscReal *residual, PetscBool *taken)
{
  const Contact *s = m->contact;
  PetscReal *lacks;

  PetscFunctionBeginUser;
  *taken = PETSC_FALSE;
  if (!s || !inertia_is_known(m, from)) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(m->grid->n_nodes * m->dim, &lacks));
  PetscCall(FindLacks(m, residual, lacks));
  for (PetscInt k = 0; k < s->n_partners; ++k)
    for (int sign = 1; sign >= (k < s->n_walls ? 1 : -1); sign -= 2) PetscCall(PartnerTakes(m, k, sign, lacks, taken));
  PetscCall(PetscFree(lacks));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, taken, 1, MPIU_BOOL, MPI_LOR, m->comm));
  PetscFunctionReturn(0);
}
