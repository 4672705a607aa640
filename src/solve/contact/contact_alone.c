/* How far penalties of what is bonded may rise.
 *
 * Where more points are bonded than nodes can follow, some gaps stay whatever holds them, and a higher penalty locks
 * nodes that bodies need for their strain. Others only seem to stay: beside the end of a wall a node may have one point
 * in contact alone, by a fifth of its function, and feels a twenty-fifth of the penalty, so that the gap falls by a
 * fifth with each change of the multipliers. Taken for one of the first kind it was left, and its multiplier went on
 * from step to step and grew with it: a spring that comes late, and makes energy (docs/theory.md, section 86). A node
 * with one point has nothing else to follow. There the penalty may rise, and as far beside it, at the nodes that are
 * pushed back by what such a point has to bear. */
#include "solve/contact/contact.h"

#define ALONE 0.9   /* of what all points together oppose to the node: one in the plane, */
#define IN_A_ROW 2  /* and in space two that face each other along the wall's edge */
#define FEELS 100   /* times its usual penalty a node may feel from that point; of a whole foot it feels 0.3 to 1.8 */
#define BESIDE 0.2  /* of what opposes to a node: such points hold it where the others push it; */
#define WIDE 0.05   /* functions of clouds reach farther, and share that among more points */
#define HIGHEST 1e4 /* by more no penalty rises: of nodes with a hundredth of their function nothing is asked */

static PetscReal opposed(const ContactPoint *c, PetscReal N) { return c->law.penalty * N * N; }

static PetscErrorCode SumAtNodes(const Grid *grid, PetscReal *of)
{
  PetscFunctionBeginUser;
  PetscCall(GridSumToOwners(grid, 1, of));
  PetscCall(GridToGhosts(grid, 1, of));
  PetscFunctionReturn(0);
}

/* What points in contact oppose to each node, N/m. */
static void oppose(const Contact *s, PetscReal *all)
{
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    for (PetscInt e = c->first; e < c->first + c->n && contact_touched(c); ++e) all[s->node[e]] += opposed(c, s->N[e]);
}

/* By how much more than its penalty that of a point may rise where it is alone. */
static PetscReal rises_alone(const Contact *s, const ContactPoint *c, const PetscReal *all)
{
  const PetscReal alone = s->dim == 3 ? ALONE / IN_A_ROW : ALONE;
  PetscReal most = 0;
  for (PetscInt e = c->first; e < c->first + c->n && c->law.kind == CONTACT_BONDED; ++e) {
    const PetscReal square = s->N[e] * s->N[e];
    if (square * HIGHEST >= 1 && opposed(c, s->N[e]) >= alone * all[s->node[e]]) most = PetscMax(most, FEELS / square);
  }
  return most;
}

/* It tells the nodes that it holds. */
static void tell_nodes(const Contact *s, PetscReal beside, const PetscReal *all, PetscReal *times)
{
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const PetscReal more = rises_alone(s, c, all);
    for (PetscInt e = c->first; e < c->first + c->n && more > 0; ++e)
      if (opposed(c, s->N[e]) >= beside * all[s->node[e]]) times[s->node[e]] += more;
  }
}

/* And they what else holds them. */
static PetscReal rises(const Contact *s, const ContactPoint *c, PetscReal beside, const PetscReal *all,
                       const PetscReal *times)
{
  PetscReal most = 1;
  for (PetscInt e = c->first; e < c->first + c->n; ++e)
    if (opposed(c, s->N[e]) >= beside * all[s->node[e]]) most = PetscMax(most, times[s->node[e]]);
  return PetscMin(most, HIGHEST);
}

PetscErrorCode ContactFindAlone(Contact *s, const Grid *grid, PetscBool wide)
{
  const PetscReal beside = wide ? WIDE : BESIDE;
  PetscReal *all, *times;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(grid->n_nodes, &all, grid->n_nodes, &times));
  oppose(s, all);
  PetscCall(SumAtNodes(grid, all));
  tell_nodes(s, beside, all, times);
  PetscCall(SumAtNodes(grid, times));
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c)
    if (c->law.kind == CONTACT_BONDED)
      c->stiffest = PetscMax(c->stiffest, rises(s, c, beside, all, times) * c->law.penalty);
  PetscCall(PetscFree2(all, times));
  PetscFunctionReturn(0);
}
