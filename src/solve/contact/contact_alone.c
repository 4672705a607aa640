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

#define ALONE 0.9  /* of what all points together oppose to the node: one in the plane, */
#define IN_A_ROW 2 /* and in space two that face each other along the wall's edge */
#define HARDLY 0.3 /* of the usual penalty: less does a node feel there than of a whole foot, which is up to 1.8; */
#define FEELS 100  /* times the usual penalty it may feel from that point then */

/* beside: of what opposes to a node: points that oppose so much hold it where others push it. highest: by more no
 * penalty rises, and nothing is asked of nodes with less than its inverse of the square of a function. */
typedef struct {
  PetscReal beside, highest;
} Bounds;

/* Clouds reach farther than to the nodes of a cell, and share what holds a node among more points. They are others in
 * the next step, too, and make energy of what penalties of points that hardly reach a node have held there. */
static const Bounds of_cells = {.beside = 0.2, .highest = 1e4}, of_clouds = {.beside = 0.05, .highest = 100};

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
static PetscReal rises_alone(const Contact *s, const ContactPoint *c, Bounds bounds, const PetscReal *all)
{
  const PetscReal alone = s->dim == 3 ? ALONE / IN_A_ROW : ALONE;
  PetscReal most = 0;
  for (PetscInt e = c->first; e < c->first + c->n && c->law.kind == CONTACT_BONDED; ++e) {
    const PetscReal square = s->N[e] * s->N[e];
    if (square * bounds.highest < 1 || all[s->node[e]] > HARDLY * c->law.penalty) continue;
    if (opposed(c, s->N[e]) >= alone * all[s->node[e]]) most = PetscMax(most, FEELS / square);
  }
  return most;
}

/* It tells the nodes that it holds. */
static void tell_nodes(const Contact *s, Bounds bounds, const PetscReal *all, PetscReal *times)
{
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const PetscReal more = rises_alone(s, c, bounds, all);
    for (PetscInt e = c->first; e < c->first + c->n && more > 0; ++e)
      if (opposed(c, s->N[e]) >= bounds.beside * all[s->node[e]]) times[s->node[e]] += more;
  }
}

/* And they what else holds them. */
static PetscReal rises(const Contact *s, const ContactPoint *c, Bounds bounds, const PetscReal *all,
                       const PetscReal *times)
{
  PetscReal most = 1;
  for (PetscInt e = c->first; e < c->first + c->n; ++e)
    if (opposed(c, s->N[e]) >= bounds.beside * all[s->node[e]]) most = PetscMax(most, times[s->node[e]]);
  return PetscMin(most, bounds.highest);
}

PetscErrorCode ContactFindAlone(Contact *s, const Grid *grid, PetscBool wide)
{
  const Bounds bounds = wide ? of_clouds : of_cells;
  PetscReal *all, *times;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(grid->n_nodes, &all, grid->n_nodes, &times));
  oppose(s, all);
  PetscCall(SumAtNodes(grid, all));
  tell_nodes(s, bounds, all, times);
  PetscCall(SumAtNodes(grid, times));
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c)
    if (c->law.kind == CONTACT_BONDED)
      c->stiffest = PetscMax(c->stiffest, rises(s, c, bounds, all, times) * c->law.penalty);
  PetscCall(PetscFree2(all, times));
  PetscFunctionReturn(0);
}
