/* Interfaces between bodies: what none can be made of, and how bodies stand at the start. */
#include "model/model_private.h"
#include "solve/contact/surface/surface.h"

/* Of its reach: a part of a body that reaches deeper into another body at the start is a mistake; what
 * reaches less was made to fit. */
#define THROUGH 0.1
#define MADE_TO_FIT 0.35 /* of the size of a point: a gap within it is one between polygons */

static void check_method(const Model *m, Diag *diag)
{
  PetscMPIInt size;
  MPI_Comm_size(m->comm, &size);
  if (m->method->clouds)
    diag_error(diag, "interfaces", "method %s has one field for all bodies; mpm and fem let them meet at interfaces",
               m->method->name);
  if (m->dim == 3) diag_error(diag, "interfaces", "bodies meet at interfaces in two dimensions only");
  if (m->grid->n_fields > 1 || m->dim == 3) return;
  if (m->method->restores_grid) {
    diag_error(diag, "interfaces", "a background mesh has one field for all bodies; a box has one for each");
    diag_hint(diag, "give grid.box; the bodies may have meshes of their own");
  } else if (size > 1) diag_error(diag, "interfaces", "bodies of one mesh meet at interfaces on one rank only");
}

/* Bodies of one mesh have fields of their own where they share no node. */
static PetscErrorCode CheckNodes(const Model *m, Diag *diag)
{
  const Grid *grid = m->grid;
  const PetscInt nn = grid->nodes_per_cell;
  PetscInt *body;
  PetscBool first;

  PetscFunctionBeginUser;
  if (grid->n_fields > 1) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(grid->n_nodes, &body));
  for (PetscInt i = 0; i < grid->n_nodes; ++i) body[i] = -1;
  for (PetscInt e = 0; e < m->points->n * nn; ++e) {
    const PetscInt mine = m->points->body[e / nn], node = grid->cell_node[m->points->cell[e / nn] * nn + e % nn];
    if (body[node] >= 0 && body[node] != mine && case_interface(m->c, mine, body[node], &first) >= 0) {
      diag_error(diag, "interfaces", "'%s' and '%s' share nodes of the mesh: the line between them must be there twice",
                 m->c->bodies[mine].name, m->c->bodies[body[node]].name);
      break;
    }
    body[node] = mine;
  }
  PetscCall(PetscFree(body));
  PetscFunctionReturn(0);
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
      diag_hint(diag, "- {name: ..., between: [%s, %s]}", c->bodies[a].name, c->bodies[b].name);
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

/* Point p of interface k ends where the other body begins. */
static void reach_over(Model *m, PetscInt k, PetscInt p, const SurfacePair *pair)
{
  const PetscInt partner = m->c->n_walls + k;
  contact_kept(m->points, p, partner, contact_sides(m->c), 0)[KEPT_REACH] = pair->gap;
  contact_let_reach(m->points, p, pair->normal, pair->gap);
}

/* Surfaces that were made to fit do so but for their polygons: their parts of the first body are made thinner, and
 * where the bodies are bonded thicker, too, or only some of them would be held. *worst: the deepest of this rank that
 * was not. */
static void fit(Model *m, PetscInt k, const Surface *first, const Surface *second, LostPoint *worst, PetscReal *deepest)
{
  const PetscBool bonded = (PetscBool)(m->c->interfaces[k].contact == CONTACT_BONDED);
  SurfacePair pair;
  PetscMPIInt rank;
  MPI_Comm_rank(m->comm, &rank);
  for (const SurfacePoint *p = first->point; p < first->point + first->n; ++p) {
    if (p->rank != rank || !surface_meet(first, p, second, m->grid->smallest, &pair)) continue;
    const PetscReal reach = contact_reach_of(m->points, p->owner, pair.normal), gap = pair.gap - reach;
    if (gap > 0 && gap < MADE_TO_FIT * p->size && bonded) reach_over(m, k, p->owner, &pair);
    if (gap >= 0) continue;
    if (gap > -THROUGH * reach) contact_take_back(m->points, p->owner, pair.normal, pair.gap);
    else if (gap < *deepest) {
      *deepest = gap;
      PetscCallAbort(m->comm, PetscArraycpy(worst->x, p->x, 3));
    }
  }
}

static PetscErrorCode FitInterface(Model *m, const SurfaceInput *in, const PetscReal *bounds, PetscInt k, Diag *diag)
{
  const InterfaceSpec *s = m->c->interfaces + k;
  const PetscInt a = case_body(m->c, s->between[0]), b = case_body(m->c, s->between[1]);
  const PetscReal within = SURFACE_SEARCH * m->grid->smallest;
  PetscReal deepest = 0, all;
  LostPoint worst = {0};
  Surface first, second;
  char path[64];

  PetscFunctionBeginUser;
  PetscCall(SurfaceGather(in, a, bounds + 6 * b, within, &first));
  PetscCall(SurfaceGather(in, b, bounds + 6 * a, within, &second));
  fit(m, k, &first, &second, &worst, &deepest);
  PetscCall(SurfaceClear(&first));
  PetscCall(SurfaceClear(&second));
  PetscCall(MPIU_Allreduce(&deepest, &all, 1, MPIU_REAL, MPIU_MIN, m->comm));
  if (all == 0 || deepest > all) PetscFunctionReturn(0);
  snprintf(path, sizeof path, "interfaces[%d]", (int)k);
  diag_error(diag, path, "'%s' goes through '%s' at the start: its point at (%g, %g) m is %.3g m inside", s->between[0],
             s->between[1], (double)worst.x[0], (double)worst.x[1], (double)-deepest);
  diag_hint(diag, "of a body that stands around the other one, name it first: `between: [%s, %s]`", s->between[1],
            s->between[0]);
  PetscFunctionReturn(0);
}

PetscErrorCode InterfacesStart(Model *m, Diag *diag)
{
  const SurfaceInput in = {
    .comm = m->comm, .kinematics = m->c->kinematics, .grid = m->grid, .points = m->points, .materials = m->materials};
  PetscReal *bounds;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  if (!m->c->n_interfaces) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  if (!rank) check_method(m, diag);
  if (!rank) check_pairs(m->c, diag);
  if (!rank) check_twice(m->c, diag);
  if (m->dim == 3 || m->method->clouds) PetscFunctionReturn(0);
  PetscCall(CheckNodes(m, diag));
  PetscCall(PetscMalloc1(6 * m->c->n_bodies, &bounds));
  PetscCall(SurfaceBounds(&in, m->c->n_bodies, bounds));
  for (PetscInt k = 0; k < m->c->n_interfaces; ++k) PetscCall(FitInterface(m, &in, bounds, k, diag));
  PetscCall(PetscFree(bounds));
  PetscFunctionReturn(0);
}
