/* Walls at the start of a model, and those that a stage brings: what of the material touches them. */
#include <string.h>
#include "model/stage/stage_private.h"

#define THROUGH 1e-9 /* of a cell: material that reaches deeper into a wall at the start is a mistake */
#define TOUCHES 1e-6 /* of a cell: what is so near is in contact (contact_find.c) */
#define FITS 1e-3    /* of the distance of a wall: so near to it ends what stands on it */
#define PART 0.5     /* likewise, as its volume and its share of the surface tell it */
#define SHARP 0.9    /* distance of a wall over the least radius of the level surface there: 1 before an edge */
#define AMIDST 0.1   /* of a cell: what is so deep in a wall that appears would be thrown out of it */
#define DENT 0.01    /* of a cell: a surface that is taken back by more to fit a wall may be one, too */

/* The worst of something over points: how much, 0 if there is none, and where. */
typedef struct {
  PetscReal depth, x[3];
} Worst;

static void take_worse(const Model *m, PetscReal depth, const PetscReal *x, Worst *worst)
{
  if (depth <= worst->depth) return;
  worst->depth = depth;
  for (PetscInt d = 0; d < m->dim; ++d) worst->x[d] = x[d];
}

/* Collective. Of all ranks. */
static PetscErrorCode FindWorst(const Model *m, Worst *worst)
{
  struct {
    double depth;
    int rank;
  } local, all;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  local.depth = (double)worst->depth, local.rank = rank;
  PetscCallMPI(MPI_Allreduce(&local, &all, 1, MPI_DOUBLE_INT, MPI_MAXLOC, m->comm));
  worst->depth = (PetscReal)all.depth;
  PetscCallMPI(MPI_Bcast(worst->x, 3, MPIU_REAL, all.rank, m->comm));
  PetscFunctionReturn(0);
}

/* Does the part that the point stands for end there? */
static PetscBool reaches_wall(const Model *m, PetscInt p, const WallPlace *place)
{
  const PetscReal weight = kinematics_weight(m->c->kinematics, point_real(m->points, POINT_X, p)[0]);
  const PetscReal face = contact_face(m->points, p, place->normal);
  const PetscReal half = face > 0 ? 0.5 * m->points->real[POINT_VOLUME][p] / (weight * face) : 0;
  return (PetscBool)(PetscAbsReal(place->gap - half) < PART * half);
}

/* Is it an edge or a corner of the wall that is nearest? Around these distances are those of circles and balls. */
static PetscBool is_sharp(const WallPlace *place) { return (PetscBool)(wall_bend(place) * place->gap > SHARP); }

/* At an edge of a body its surface is elsewhere for each wall: does the body end at this one straight before the point,
 * although that is nearer to another side? Nothing stands on a wall's own edge. */
static PetscBool stands_on(const Model *m, PetscInt p, const WallPlace *place)
{
  const BodySpec *body = m->c->bodies + m->points->body[p];
  const PetscReal *x = point_real(m->points, POINT_X, p);
  PetscReal within[3], beyond[3];
  if (!body->has_shape || body->mesh || place->gap <= contact_reach_of(m->points, p, place->normal)) return PETSC_FALSE;
  if (is_sharp(place) || !reaches_wall(m, p, place)) return PETSC_FALSE;
  for (PetscInt d = 0; d < m->dim; ++d) {
    within[d] = x[d] - (1 - FITS) * place->gap * place->normal[d];
    beyond[d] = x[d] - (1 + FITS) * place->gap * place->normal[d];
  }
  return (PetscBool)(shape_contains(&body->shape, m->dim, within, 0) &&
                     !shape_contains(&body->shape, m->dim, beyond, 0));
}

/* Point p ends at that side of wall k. */
static void reach_out(Model *m, PetscInt k, PetscInt side, PetscInt p, const WallPlace *place)
{
  const PetscInt sides = contact_sides(m->c);
  PetscReal *kept = contact_kept(m->points, p, k, sides, side);
  kept[KEPT_REACH] = place->gap;
  contact_keep_normal(kept, m->dim, sides, place->normal);
  contact_let_reach(m->points, p, place->normal, place->gap);
}

/* Does point p touch that side of wall k, as contact will see it? */
static PetscBool touches(const Model *m, PetscInt k, PetscInt side, PetscInt p, const WallPlace *place)
{
  const PetscReal kept = contact_kept(m->points, p, k, contact_sides(m->c), side)[KEPT_REACH];
  const PetscReal reach = kept > 0 ? kept : contact_reach_of(m->points, p, place->normal);
  return (PetscBool)(place->gap - reach <= TOUCHES * m->grid->smallest);
}

/* What stands nearer to a wall than its cell's side does touches it: the body was made to fit, and its surface is taken
 * back (dent) to the wall. A point inside the wall is a mistake (inside). Says whether any touches it. `from`, if it is
 * not NULL, is the stage before, and bodies that were there are not looked at. */
static PetscBool look_at_wall(Model *m, PetscInt k, PetscBool fits, const Case *from, Worst *inside, Worst *dent)
{
  WallPlace place[WALL_SIDES];
  PetscBool any = PETSC_FALSE;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p);
    if (!contact_meets_body(m->c, k, m->points->body[p])) continue;
    if (from && !body_comes(m->c, from, m->points->body[p])) continue;
    const int side = wall_side(m->walls, k, m->time, x);
    const PetscReal far = PetscMax(contact_farthest(m->points, p), fits ? m->grid->smallest : 0);
    const PetscInt n = wall_sides(m->walls, k, m->time, x, far, side, place);
    for (PetscInt i = 0; i < n; ++i) {
      if (fits && !m->c->stage && stands_on(m, p, &place[i])) reach_out(m, k, i, p, &place[i]);
      take_worse(m, -place[i].gap, x, inside);
      any = any || touches(m, k, i, p, &place[i]);
      const PetscReal reach = contact_reach_of(m->points, p, place[i].normal);
      if (!fits || place[i].gap <= THROUGH * m->grid->smallest || place[i].gap >= reach) continue;
      take_worse(m, reach - place[i].gap, x, dent);
      contact_take_back(m->points, p, place[i].normal, place[i].gap);
    }
  }
  return any;
}

static PetscErrorCode TellThrough(const Model *m, PetscInt k, Worst *inside, Diag *diag)
{
  char path[64];

  PetscFunctionBeginUser;
  PetscCall(FindWorst(m, inside));
  if (inside->depth <= 0) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "walls[%d]", (int)k));
  diag_error(diag, path,
             "wall '%s' goes through a body at the start%s: the point at (%g, %g, %g) m is %.3g m inside it",
             m->c->walls[k].name, m->c->stage ? " of the stage" : "", (double)inside->x[0], (double)inside->x[1],
             (double)inside->x[2], (double)inside->depth);
  if (inside->depth <= AMIDST * m->grid->smallest)
    diag_hint(
      diag,
      "an overlap that round bodies want in statics? What of it lies beyond a line of the grid has points of its "
      "own: let the wall stand amidst a row of cells, the grid half a cell aside");
  PetscFunctionReturn(0);
}

/* How deep nodes of bodies are in the wall. */
static void look_at_nodes(const Model *m, PetscInt k, Worst *inside)
{
  WallPlace place;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    const PetscReal *x = m->grid->x + node * m->dim;
    if (wall_near(m->walls, k, m->time, x, 0, 0, &place)) take_worse(m, -place.gap, x, inside);
  }
}

/* Meshes that move with their body know where that ends. (In a corner one side of a point's cell is nearer to it than
 * the other: only where nodes are in the wall, too, is there a dent.) */
static PetscErrorCode TellDent(const Model *m, PetscInt k, Worst *dent, Diag *diag)
{
  Worst inside = {0};
  char path[64];

  PetscFunctionBeginUser;
  if (m->method->restores_grid) PetscFunctionReturn(0);
  look_at_nodes(m, k, &inside);
  PetscCall(FindWorst(m, dent));
  PetscCall(FindWorst(m, &inside));
  if (PetscMin(dent->depth, inside.depth) <= DENT * m->grid->smallest) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "walls[%d]", (int)k));
  diag_warning(
    diag, path,
    "wall '%s' cuts into a body at the start, by %.3g m near (%g, %g, %g) m, %.2g of a cell: its surface there "
    "is taken to be made to fit, with a dent of that depth",
    m->c->walls[k].name, (double)dent->depth, (double)dent->x[0], (double)dent->x[1], (double)dent->x[2],
    (double)(dent->depth / m->grid->smallest));
  PetscFunctionReturn(0);
}

/* Is there nothing yet that could touch it? */
static PetscBool waits(const Model *m, PetscInt k)
{
  for (PetscInt b = 0; b < m->c->n_bodies; ++b)
    if (!m->c->bodies[b].absent && contact_meets_body(m->c, k, b)) return PETSC_FALSE;
  return m->c->walls[k].waits;
}

PetscErrorCode TellUntouched(const Model *m, PetscInt k, PetscBool any, Diag *diag)
{
  const WallSpec *wall = m->c->walls + k;
  char path[64];

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &any, 1, MPIU_BOOL, MPI_LOR, m->comm));
  if (any || wall->contact != CONTACT_BONDED || wall->absent || wall->from > m->c->start) PetscFunctionReturn(0);
  if (waits(m, k)) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "walls[%d].contact", (int)k));
  diag_warning(diag, path,
               "nothing touches wall '%s' at the start%s: what is bonded is held if it does, and nothing is",
               wall->name, m->c->stage ? " of the stage" : "");
  diag_hint(diag, "let a body's surface and the wall's be the same; `stick` holds what comes to it later");
  PetscFunctionReturn(0);
}

PetscErrorCode WallsStart(Model *m, Diag *diag)
{
  PetscFunctionBeginUser;
  if (!m->c->n_walls && !m->c->n_interfaces) PetscFunctionReturn(0);
  PetscCall(WallsCreate(m->c, diag, &m->walls));
  PetscCall(ContactCreate(m->c, m->walls, diag, &m->contact));
  strength_of_contact(m);
  rigid_check(m, diag);
  PetscCall(InterfacesStart(m, diag));
  for (PetscInt k = 0; k < m->c->n_walls; ++k) {
    Worst inside = {0}, dent = {0};
    const PetscBool any = look_at_wall(m, k, PETSC_TRUE, NULL, &inside, &dent);
    if (m->c->stage) continue; /* bodies are elsewhere */
    PetscCall(TellUntouched(m, k, any, diag));
    PetscCall(TellThrough(m, k, &inside, diag));
    PetscCall(TellDent(m, k, &dent, diag));
  }
  PetscCall(InterfacesSettle(m));
  PetscFunctionReturn(0);
}

PetscBool wall_stood(const WallSpec *wall, const Case *c, const Case *from)
{
  for (const WallSpec *w = from->walls; w < from->walls + from->n_walls; ++w)
    if (!strcmp(w->name, wall->name)) return !w->absent && wall->since < c->stage;
  return PETSC_FALSE;
}

PetscErrorCode WallsCome(Model *m, const Case *from, Diag *diag)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_walls; ++k) {
    Worst inside = {0}, dent = {0};
    if (m->c->walls[k].absent) continue;
    const Case *stood = wall_stood(&m->c->walls[k], m->c, from) ? from : NULL;
    (void)look_at_wall(m, k, PETSC_FALSE, stood, &inside, &dent);
    PetscCall(TellThrough(m, k, &inside, diag));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode WallsAppear(const Model *m, StepReport *report)
{
  const PetscReal t = m->time;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; m->walls && k < m->c->n_walls && report->outcome == STEP_ACCEPTED; ++k) {
    Worst inside = {0};
    WallPlace place;
    if (!(m->c->walls[k].from > 0) || !wall_comes(m->walls, k, t) || wall_stands(m->walls, k, t)) continue;
    for (PetscInt p = 0; p < m->points->n; ++p) {
      const PetscReal *x = point_real(m->points, POINT_X, p);
      if (!contact_meets_body(m->c, k, m->points->body[p])) continue;
      if (wall_near(m->walls, k, t, x, 0, 0, &place)) take_worse(m, -place.gap, x, &inside);
    }
    PetscCall(FindWorst(m, &inside));
    if (inside.depth <= AMIDST * m->grid->smallest) continue;
    report->outcome = STEP_TOO_SMALL;
    snprintf(report->reason, sizeof report->reason,
             "wall '%s' comes at t = %g s where material is: the point at (%g, %g, %g) m is %.3g m inside it",
             m->c->walls[k].name, (double)t, (double)inside.x[0], (double)inside.x[1], (double)inside.x[2],
             (double)inside.depth);
  }
  PetscFunctionReturn(0);
}
