/* Interfaces between bodies: what none can be made of, and how bodies stand at the start. */
#include <string.h>
#include "model/model_private.h"
#include "base/math/vector.h"
#include "base/text.h"
#include "grid/cloud/cloud.h"
#include "solve/contact/surface/surface.h"

/* Of its reach: a part of a body that reaches deeper into another body at the start is a mistake; what
 * reaches less was made to fit. */
#define THROUGH 0.1
#define SLIVER 0.03 /* of a cell: and of what is thinner */
#define CLOSES 0.1  /* of a cell: a wider gap is told of (stage/gaps.c) */
/* surfaces that are fitted have other normals, for which they do not quite fit: what is left would be met again by what
 * comes back there */
#define FITTINGS 8
#define FITS 1e-9        /* of a cell */
#define MADE_TO_FIT 0.35 /* of the size of a point: a gap within it is one between polygons */

static void check_method(const Model *m, Diag *diag)
{
  if (m->grid->n_fields > 1) return;
  if (m->method->restores_grid) {
    diag_error(diag, "interfaces", "a background mesh has one field for all bodies; a box has one for each");
    diag_hint(diag, "give grid.box; the bodies may have meshes of their own");
  }
}

PetscErrorCode SharingPairs(const Model *m, int *share)
{
  const Grid *grid = m->grid;
  const PetscInt nn = grid->nodes_per_cell, bodies = m->c->n_bodies;
  PetscReal *here, *there; /* the body that has a node: on this rank, on its owner */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(grid->n_nodes, &here, grid->n_nodes, &there));
  for (PetscInt i = 0; i < grid->n_nodes; ++i) here[i] = -1;
  for (PetscInt e = 0; e < m->points->n * nn; ++e) {
    const PetscInt p = e / nn, mine = m->points->body[p];
    PetscReal *body = here + grid->cell_node[m->points->cell[p] * nn + e % nn];
    if (*body >= 0) share[mine * bodies + (PetscInt)*body] = 1;
    *body = (PetscReal)mine;
  }
  PetscCall(PetscArraycpy(there, here, grid->n_nodes));
  PetscCall(GridToGhosts(grid, 1, there));
  for (PetscInt i = grid->n_owned; i < grid->n_nodes; ++i)
    if (here[i] >= 0 && there[i] >= 0) share[(PetscInt)here[i] * bodies + (PetscInt)there[i]] = 1;
  PetscCall(PetscFree2(here, there));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, share, (PetscMPIInt)(bodies * bodies), MPI_INT, MPI_MAX, m->comm));
  PetscFunctionReturn(0);
}

/* Bodies of one mesh have fields of their own where they share no node: a pair that does, -1 if there is none. */
static PetscInt tied_pair(const Model *m, const int *share)
{
  const PetscInt bodies = m->c->n_bodies;
  PetscInt pair = bodies * bodies - 1;
  PetscBool first;
  if (m->grid->n_fields > 1) return -1;
  while (pair >= 0 && !(share[pair] && case_interface(m->c, pair / bodies, pair % bodies, &first) >= 0)) --pair;
  return pair;
}

static void tell_tied(const Model *m, PetscInt pair, Diag *diag)
{
  const PetscInt bodies = m->c->n_bodies;
  diag_error(diag, "interfaces", "'%s' and '%s' share nodes of the mesh: the %s between them must be there twice",
             m->c->bodies[pair / bodies].name, m->c->bodies[pair % bodies].name, m->dim == 2 ? "line" : "surface");
}

/* Bodies of one field stick; those of two need an interface. */
static void check_pairs(const Case *c, Diag *diag)
{
  PetscBool first;
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    for (PetscInt a = 0; a < b; ++a) {
      if (case_interface(c, a, b, &first) >= 0 || case_field(c, a) == case_field(c, b)) continue;
      diag_error(diag, "interfaces", "nothing says how '%s' and '%s' meet: other interfaces keep them apart",
                 c->bodies[a].name, c->bodies[b].name);
      diag_hint(diag, "- {name: ..., between: [%s, %s]}, of any law if they never touch", c->bodies[a].name,
                c->bodies[b].name);
    }
}

static void check_twice(const Case *c, Diag *diag)
{
  char path[64];
  PetscBool first;
  for (PetscInt k = 0; k < c->n_interfaces; ++k) {
    const InterfaceSpec *s = c->interfaces + k;
    const PetscInt other = case_interface(c, case_body(c, s->between[0]), case_body(c, s->between[1]), &first);
    snprintf(path, sizeof path, "interfaces[%d]", (int)k);
    if (other != k)
      diag_error(diag, path, "'%s' and '%s' meet at interface '%s' already", s->between[0], s->between[1],
                 c->interfaces[other].name);
  }
}

/* How far point p reaches at interface k, m, as contact will have it; 0: nothing has said so. */
static PetscReal *reach_at(const Model *m, PetscInt k, PetscInt p)
{
  return contact_kept(m->points, p, m->c->n_walls + k, contact_sides(m->c), 0) + KEPT_REACH;
}

/* Point p of interface k ends where the other body begins. */
static void reach_over(Model *m, PetscInt k, PetscInt p, const SurfacePair *pair)
{
  *reach_at(m, k, p) = pair->gap;
  contact_let_reach(m->points, p, pair->normal, pair->gap);
}

/* Of a point with so much between its surface and the other body (reach: what it has of its own): was that made to
 * fit? Bodies that are bonded more generously, or only some of what is at their polygons would be held. */
static PetscBool is_fitted(const Model *m, PetscInt k, const SurfacePoint *p, PetscReal reach, PetscReal gap)
{
  const PetscBool bonded = (PetscBool)(m->c->interfaces[k].contact == CONTACT_BONDED);
  const PetscReal through = PetscMin(PetscMax(THROUGH * reach, SLIVER * m->grid->smallest), (1 - THROUGH) * reach);
  return (PetscBool)(gap > -through && gap < (bonded ? MADE_TO_FIT * p->size : CONTACT_HAIR * m->grid->smallest));
}

/* Surfaces that were made to fit do so but for their polygons: their parts of the first body are made thinner, and
 * where the bodies are bonded thicker, too. *worst: the deepest of this rank that was not made to fit. Returns the
 * largest change, m: of what has changed normals have, too. */
static PetscReal fit(Model *m, PetscInt k, const Surface *first, const Surface *second, LostPoint *worst,
                     PetscReal *deepest)
{
  PetscReal changed = 0;
  SurfacePair pair;
  PetscMPIInt rank;
  MPI_Comm_rank(m->comm, &rank);
  for (const SurfacePoint *p = first->point; p < first->point + first->n; ++p) {
    if (p->rank != rank || !surface_meet(first, p, second, m->grid->smallest, &pair)) continue;
    const PetscReal reach = contact_reach_of(m->points, p->owner, pair.normal), gap = pair.gap - reach;
    const PetscBool fitted = is_fitted(m, k, p, reach, gap);
    if (fitted) changed = PetscMax(changed, PetscAbsReal(gap));
    if (fitted && gap < 0) contact_take_back(m->points, p->owner, pair.normal, pair.gap);
    if (fitted) reach_over(m, k, p->owner, &pair);
    if (gap >= 0 || fitted || gap >= *deepest) continue;
    *deepest = gap;
    PetscCallAbort(m->comm, PetscArraycpy(worst->x, p->x, 3));
  }
  return changed;
}

/* What was made to fit begins with neither gap nor overlap: its points end where the other body is found to begin, now
 * that nothing of either surface changes any more. */
static void settle(Model *m, PetscInt k, const Surface *first, const Surface *second)
{
  SurfacePair pair;
  PetscMPIInt rank;
  MPI_Comm_rank(m->comm, &rank);
  for (const SurfacePoint *p = first->point; p < first->point + first->n; ++p) {
    if (p->rank != rank || *reach_at(m, k, p->owner) == 0) continue;
    if (surface_meet(first, p, second, m->grid->smallest, &pair) && pair.gap > 0) *reach_at(m, k, p->owner) = pair.gap;
  }
}

/* What the bodies of interface k have near each other. */
static PetscErrorCode GatherBoth(const Model *m, const SurfaceInput *in, const PetscReal *bounds, PetscInt k,
                                 Surface body[2])
{
  const InterfaceSpec *s = m->c->interfaces + k;
  const PetscInt a = case_body(m->c, s->between[0]), b = case_body(m->c, s->between[1]);
  const PetscReal within = SURFACE_SEARCH * m->grid->smallest;

  PetscFunctionBeginUser;
  PetscCall(SurfaceGather(in, a, bounds + 6 * b, within, body));
  PetscCall(SurfaceGather(in, b, bounds + 6 * a, within, body + 1));
  PetscFunctionReturn(0);
}

static PetscErrorCode FitInterface(Model *m, const SurfaceInput *in, const PetscReal *bounds, PetscInt k, Diag *diag)
{
  const InterfaceSpec *s = m->c->interfaces + k;
  PetscReal deepest = 0, all = 0, changed = PETSC_MAX_REAL;
  LostPoint worst = {0};
  Surface body[2];
  char path[64], at[80];

  PetscFunctionBeginUser;
  for (int pass = 0; pass < FITTINGS && all == 0 && changed > FITS * m->grid->smallest; ++pass) {
    PetscCall(GatherBoth(m, in, bounds, k, body));
    changed = fit(m, k, body, body + 1, &worst, &deepest);
    for (int i = 0; i < 2; ++i) PetscCall(SurfaceClear(body + i));
    PetscCall(MPIU_Allreduce(&deepest, &all, 1, MPIU_REAL, MPIU_MIN, m->comm));
    PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &changed, 1, MPIU_REAL, MPIU_MAX, m->comm));
  }
  if (all == 0 || deepest > all) PetscFunctionReturn(0);
  snprintf(path, sizeof path, "interfaces[%d]", (int)k);
  diag_error(diag, path, "'%s' goes through '%s' at the start: its point at %s m is %.3g m inside", s->between[0],
             s->between[1], text_position(m->dim, worst.x, at), (double)-deepest);
  diag_hint(diag, "of a body that stands around the other one, name it first: `between: [%s, %s]`", s->between[1],
            s->between[0]);
  PetscFunctionReturn(0);
}

/* What surfaces are gathered from; nodes are not wanted. */
static SurfaceInput surface_input(const Model *m)
{
  return (SurfaceInput){.comm = m->comm,
                        .kinematics = m->c->kinematics,
                        .grid = m->grid,
                        .points = m->points,
                        .materials = m->materials,
                        .bodies = m->c->bodies};
}

PetscErrorCode InterfacesStart(Model *m, Diag *diag)
{
  const SurfaceInput in = surface_input(m);
  PetscReal *bounds;
  PetscMPIInt rank;
  int *share;

  PetscFunctionBeginUser;
  if (!m->c->n_interfaces) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  if (!rank) check_method(m, diag);
  if (!rank) check_pairs(m->c, diag);
  if (!rank) check_twice(m->c, diag);
  PetscCall(PetscCalloc1(m->c->n_bodies * m->c->n_bodies, &share));
  PetscCall(SharingPairs(m, share));
  const PetscInt tied = tied_pair(m, share);
  if (tied >= 0 && !rank) tell_tied(m, tied, diag);
  PetscCall(PetscMalloc1(6 * m->c->n_bodies, &bounds));
  PetscCall(SurfaceBounds(&in, m->c->n_bodies, bounds));
  for (PetscInt k = 0; k < m->c->n_interfaces && tied < 0; ++k) PetscCall(FitInterface(m, &in, bounds, k, diag));
  PetscCall(PetscFree(bounds));
  PetscCall(PetscFree(share));
  PetscFunctionReturn(0);
}

PetscErrorCode InterfacesSettle(Model *m)
{
  const SurfaceInput in = surface_input(m);
  PetscReal *bounds;
  Surface body[2];

  PetscFunctionBeginUser;
  if (!m->c->n_interfaces) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(6 * m->c->n_bodies, &bounds));
  PetscCall(SurfaceBounds(&in, m->c->n_bodies, bounds));
  for (PetscInt k = 0; k < m->c->n_interfaces; ++k) {
    PetscCall(GatherBoth(m, &in, bounds, k, body));
    settle(m, k, body, body + 1);
    for (int i = 0; i < 2; ++i) PetscCall(SurfaceClear(body + i));
  }
  PetscCall(PetscFree(bounds));
  PetscFunctionReturn(0);
}

PetscErrorCode InterfaceSurfaces(const Model *m, PetscInt k, Surface *body)
{
  const SurfaceInput in = surface_input(m);
  PetscReal *bounds;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(6 * m->c->n_bodies, &bounds));
  PetscCall(SurfaceBounds(&in, m->c->n_bodies, bounds));
  PetscCall(GatherBoth(m, &in, bounds, k, body));
  PetscCall(PetscFree(bounds));
  PetscFunctionReturn(0);
}

PetscErrorCode InterfaceCloses(Model *m, PetscInt k)
{
  const PetscReal hair = CLOSES * m->grid->smallest;
  PetscMPIInt rank;
  Surface body[2];
  SurfacePair pair;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  PetscCall(InterfaceSurfaces(m, k, body));
  for (const SurfacePoint *p = body[0].point; p < body[0].point + body[0].n; ++p) {
    if (p->rank != rank || !surface_meet(body, p, body + 1, m->grid->smallest, &pair)) continue;
    const PetscReal gap = pair.gap - contact_reach_of(m->points, p->owner, pair.normal);
    if (!(PetscAbsReal(gap) < hair && pair.gap > 0)) continue;
    reach_over(m, k, p->owner, &pair);
    if (m->c->interfaces[k].contact == CONTACT_BONDED) /* holds what touches when it begins, or goes on to touch */
      contact_kept(m->points, p->owner, m->c->n_walls + k, contact_sides(m->c), 0)[KEPT_STATE] = CONTACT_STICKS;
  }
  for (int i = 0; i < 2; ++i) PetscCall(SurfaceClear(body + i));
  PetscFunctionReturn(0);
}

/* Has the stage before bonded its bodies? */
static PetscBool was_bonded(const InterfaceSpec *now, const Case *from)
{
  for (const InterfaceSpec *s = from->interfaces; s < from->interfaces + from->n_interfaces; ++s)
    if (!strcmp(s->name, now->name)) return (PetscBool)(s->contact == CONTACT_BONDED);
  return PETSC_FALSE;
}

PetscErrorCode InterfacesBond(Model *m, const Case *from)
{
  PetscMPIInt rank;
  Surface body[2];
  SurfacePair pair;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  for (PetscInt k = 0; k < m->c->n_interfaces; ++k) {
    if (m->c->interfaces[k].contact != CONTACT_BONDED || was_bonded(m->c->interfaces + k, from)) continue;
    PetscCall(InterfaceSurfaces(m, k, body));
    for (const SurfacePoint *p = body[0].point; p < body[0].point + body[0].n; ++p) {
      if (p->rank != rank || !surface_meet(body, p, body + 1, m->grid->smallest, &pair)) continue;
      PetscReal *kept = contact_kept(m->points, p->owner, m->c->n_walls + k, contact_sides(m->c), 0);
      contact_bond(m, p->owner, pair.normal, pair.gap, kept, kept);
    }
    for (int i = 0; i < 2; ++i) PetscCall(SurfaceClear(body + i));
  }
  PetscFunctionReturn(0);
}
