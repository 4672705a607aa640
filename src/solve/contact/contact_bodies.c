/* Contact points between bodies: those of the first body of an interface, with the nodes that carry them
 * in its field and in that of the second body. */
#include <stdlib.h>
#include <string.h>
#include "solve/contact/contact.h"
#include "solve/contact/surface/surface.h"

#define LEAP 0.02 /* of a cell: a gap that leaps open by more is one, as behind a corner */

/* Local nodes by their numbers in the whole grid: owned ones follow each other, ghosts are sorted. */
typedef struct {
  PetscInt number, node;
} GhostNode;

typedef struct {
  const Grid *grid;
  GhostNode *ghost;
} NodeFinder;

static int compare(const void *a, const void *b)
{
  const GhostNode *x = a, *y = b;
  return (x->number > y->number) - (x->number < y->number);
}

static PetscErrorCode FinderCreate(const Grid *grid, NodeFinder *f)
{
  const PetscInt n = grid->n_nodes - grid->n_owned;

  PetscFunctionBeginUser;
  f->grid = grid;
  PetscCall(PetscMalloc1(n, &f->ghost));
  for (PetscInt k = 0; k < n; ++k)
    f->ghost[k] = (GhostNode){.number = grid->global_node[grid->n_owned + k], .node = grid->n_owned + k};
  if (n) qsort(f->ghost, (size_t)n, sizeof *f->ghost, compare);
  PetscFunctionReturn(0);
}

/* -1: this rank does not know it. */
static PetscInt local_node(const NodeFinder *f, PetscInt number)
{
  const GhostNode key = {.number = number};
  const PetscInt n = f->grid->n_nodes - f->grid->n_owned,
                 place = f->grid->n_owned ? number - f->grid->global_node[0] : -1;
  if (place >= 0 && place < f->grid->n_owned) return place;
  const GhostNode *found = n ? bsearch(&key, f->ghost, (size_t)n, sizeof key, compare) : NULL;
  return found ? found->node : -1;
}

/* What of a gradient is along the surface. */
static void take_turn(PetscInt dim, const PetscReal *dN, const PetscReal n[3], PetscReal *turn)
{
  PetscReal across = 0;
  for (PetscInt d = 0; d < dim; ++d) across += dN[d] * n[d];
  for (PetscInt d = 0; d < dim; ++d) turn[d] = dN[d] - across * n[d];
}

/* Nodes of one body's point with their part of the place x, its field taken on from there. */
static PetscErrorCode Carry(Contact *s, ContactPoint *c, const NodeFinder *f, const Surface *body,
                            const SurfacePoint *p, PetscReal sign, PetscInt first)
{
  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < p->n; ++I) {
    const PetscInt e = c->first + first + I;
    const SurfaceCarrier *carrier = body->carrier + p->first_carrier + I;
    PetscReal change = 0;
    for (PetscInt d = 0; d < s->dim; ++d) {
      const PetscReal way = c->x[d] - p->x[d];
      change += (carrier->dN[d] + (c->let_in ? 0 : 0.5 * carrier->bend[d] * way)) * way; /* see take_lead */
    }
    s->node[e] = local_node(f, carrier->node);
    PetscCheck(s->node[e] >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a body meets another one on an unknown node");
    s->N[e] = sign * (carrier->N + change);
    s->lead[e] = sign * change;
    take_turn(s->dim, carrier->dN, c->normal, s->turn + e * s->dim);
  }
  PetscFunctionReturn(0);
}

/* By what the gap of a point has leapt, m: steps end with no overlap, so what there is at the start of one is a leap,
 * touched or not; its reach has no more to give than is left of it. */
static PetscReal leap_of(const Contact *s, const NodalScene *scene, const ContactPoint *c)
{
  const PetscReal thinnest = THINNEST * scene->points->real[POINT_REACH][c->owner];
  if (c->open < 0) return PetscMax(c->open, PetscMin(0, thinnest - c->reach));
  return c->before != CONTACT_OPEN && c->open <= LEAP * s->length ? c->open : 0;
}

/* Where it slides, a point stands before ever other points of the other body, whose surfaces do not go on into each
 * other: to close what its gap so leaps by would take a force that grows with the square of the step's shortness, and
 * to push out what it leaps into the other body by as much energy. So its reach takes that up, and gives it back as it
 * slides on: what comes under the front of a punch would grow ever thicker, or thinner. */
static void go_on_touching(const Contact *s, const NodalScene *scene, const PetscReal *kept, ContactPoint *c)
{
  c->leapt = kept[KEPT_LEAPT(s->dim)];
  const PetscReal back = kept[KEPT_TAKES(s->dim)] * c->leapt, leap = leap_of(s, scene, c);
  c->leapt += leap;
  c->reach += leap;
  c->open -= leap;
  c->leapt -= back;
  c->reach -= back;
  c->open += back;
}

static PetscErrorCode Meet(Contact *s, const NodalScene *scene, const NodeFinder *f, PetscInt interface,
                           const Surface body[2], const SurfacePoint *p, const SurfacePair *pair)
{
  const PetscInt partner = s->n_walls + interface;
  const PetscReal *kept = contact_kept(scene->points, p->owner, partner, s->sides, 0);
  ContactPoint *c = NULL;

  PetscFunctionBeginUser;
  PetscCall(ContactAdd(s, &c));
  c->owner = p->owner, c->wall = partner;
  c->reach = contact_reach_left(scene, p->owner, kept, pair->normal, pair->gap);
  c->modulus[0] = p->modulus, c->density[0] = p->density;
  c->stiffer = PetscMax(p->stiffer, pair->other->stiffer);
  c->softer = PetscMin(p->softer, pair->other->softer);
  c->modulus[1] = pair->other->modulus, c->density[1] = pair->other->density;
  contact_take_law(s, scene, c);
  contact_remember(c, s->dim, kept, pair->normal);
  c->behind = contact_behind_left(scene, c->law.kind, kept, pair->gap - c->reach);
  c->let_in = contact_let_in(scene, kept, c->behind);
  c->open = pair->gap - c->reach + c->behind;
  if (scene->c->analysis.type == ANALYSIS_DYNAMIC) go_on_touching(s, scene, kept, c);
  if (contact_passes(s, c, c->open, scene->first)) {
    --s->n;
    PetscFunctionReturn(0);
  }
  for (PetscInt d = 0; d < s->dim; ++d) c->x[d] = p->x[d] - c->reach * pair->normal[d];
  c->cover = pair->cover;
  contact_take_section(s, scene, contact_section(scene, p->owner, pair->normal, (PetscReal[]){p->x[0], c->x[0]}), c);
  if (kept[0] == 0) contact_start(scene, c);
  PetscCall(ContactAddNodes(s, c, p->n + pair->other->n));
  c->own = p->n;
  PetscCall(Carry(s, c, f, body, p, 1, 0));
  PetscCall(Carry(s, c, f, body + 1, pair->other, -1, p->n));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactFindBodies(Contact *s, const NodalScene *scene)
{
  const Case *c = scene->c;
  const SurfaceInput in = {.comm = scene->grid->comm,
                           .kinematics = c->kinematics,
                           .grid = scene->grid,
                           .points = scene->points,
                           .materials = scene->materials,
                           .bodies = c->bodies,
                           .support = scene->support,
                           .bends = scene->bends,
                           .bends_context = scene->bends_context};
  NodeFinder finder;
  PetscReal *bounds;
  PetscMPIInt rank;
  Surface body[2];
  SurfacePair pair;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(in.comm, &rank));
  PetscCall(PetscMalloc1(6 * c->n_bodies, &bounds));
  PetscCall(SurfaceBounds(&in, c->n_bodies, bounds));
  PetscCall(FinderCreate(scene->grid, &finder));
  for (PetscInt k = 0; k < c->n_interfaces; ++k) {
    const PetscInt a = case_body(c, c->interfaces[k].between[0]), b = case_body(c, c->interfaces[k].between[1]);
    PetscCall(SurfaceGather(&in, a, bounds + 6 * b, SURFACE_SEARCH * s->length, body));
    PetscCall(SurfaceGather(&in, b, bounds + 6 * a, SURFACE_SEARCH * s->length, body + 1));
    for (const SurfacePoint *p = body[0].point; p < body[0].point + body[0].n; ++p)
      if (p->rank == rank && surface_meet(body, p, body + 1, s->length, &pair))
        PetscCall(Meet(s, scene, &finder, k, body, p, &pair));
    for (int i = 0; i < 2; ++i) PetscCall(SurfaceClear(body + i));
  }
  PetscCall(PetscFree(finder.ghost));
  PetscCall(PetscFree(bounds));
  PetscFunctionReturn(0);
}
