#include "solve/contact/contact.h"
#include <string.h>

#define WALL_NUMBERS ((PetscInt)(sizeof(WallState) / sizeof(PetscReal)))
#define RIGID_NUMBERS ((PetscInt)(sizeof(RigidState) / sizeof(PetscReal)))

#define NEXT_TO_NOTHING 1e-6 /* of the largest force on a point of the body, by its stress or by what it touches */
#define LEANS 0.1            /* a normal with such a share of an axis holds along it */
#define TAKEN_BACK 0.25      /* of a cell: on that way of sliding what a gap has leapt by is taken back */

PetscErrorCode ContactCreate(const Case *c, Walls *walls, Diag *diag, Contact **contact)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(contact));
  (*contact)->walls = walls;
  (*contact)->dim = c->kinematics->dim;
  (*contact)->hoop = c->kinematics->hoop;
  (*contact)->n_walls = c->n_walls;
  (*contact)->n_partners = c->n_walls + c->n_interfaces;
  (*contact)->sides = contact_sides(c);
  PetscCall(PetscCalloc1(c->n_walls, &(*contact)->turns));
  for (PetscInt k = 0; k < c->n_walls; ++k) (*contact)->turns[k] = wall_turns(c->walls + k);
  PetscCall(RigidCreate(c, walls, diag, &(*contact)->n_rigid, &(*contact)->rigid));
  PetscCall(PetscCalloc1((*contact)->n_partners, &(*contact)->wall));
  PetscCall(PetscCalloc1((*contact)->n_partners, &(*contact)->impulse));
  PetscCall(PetscCalloc3((*contact)->n_partners, &(*contact)->crosses, (*contact)->n_partners, &(*contact)->crossed,
                         (*contact)->n_partners, &(*contact)->sunk));
  PetscCall(PetscMalloc1((*contact)->n_partners * c->n_bodies, &(*contact)->divisor));
  for (PetscInt i = 0; i < (*contact)->n_partners * c->n_bodies; ++i) (*contact)->divisor[i] = 1;
  (*contact)->share = (ContactShare){.mean = 1, .asked = 1};
  PetscFunctionReturn(0);
}

PetscErrorCode ContactDestroy(Contact **contact)
{
  Contact *s = *contact;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  PetscCall(PetscFree(s->point));
  PetscCall(PetscFree(s->node));
  PetscCall(PetscFree(s->N));
  PetscCall(PetscFree(s->lead));
  PetscCall(PetscFree(s->turn));
  PetscCall(PetscFree(s->anchor));
  PetscCall(PetscFree(s->slot));
  PetscCall(PetscFree(s->divisor));
  PetscCall(PetscFree(s->least));
  PetscCall(PetscFree(s->turns));
  PetscCall(PetscFree(s->wall));
  PetscCall(PetscFree(s->rigid));
  PetscCall(PetscFree(s->impulse));
  PetscCall(PetscFree3(s->crosses, s->crossed, s->sunk));
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(0);
}

void contact_again(Contact *s)
{
  (void)memset(s->impulse, 0, (size_t)s->n_partners * sizeof *s->impulse);
  s->driven = 0;
  for (RigidWall *b = s->rigid; b < s->rigid + s->n_rigid; ++b) {
    b->lost = 0;
    for (int d = 0; d < 3; ++d) b->given[d] = 0;
    rigid_restore(b, s->walls);
  }
}

static PetscBool has_adhesion(const Case *c)
{
  for (PetscInt k = 0; k < c->n_walls; ++k)
    if (c->walls[k].adhesion > 0) return PETSC_TRUE;
  for (PetscInt k = 0; k < c->n_interfaces; ++k)
    if (c->interfaces[k].adhesion > 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* When the run is over. Of an interface: of the body in which less acts, which may lie on the other one. */
static void take_least(Contact *s, const NodalScene *scene)
{
  for (ContactPoint *c = s->point; s->least && c < s->point + s->n; ++c) {
    c->least = s->least[scene->points->body[c->owner]];
    if (c->wall < s->n_walls) continue;
    char *const *between = scene->c->interfaces[c->wall - s->n_walls].between;
    c->least = PetscMin(s->least[case_body(scene->c, between[0])], s->least[case_body(scene->c, between[1])]);
  }
}

static PetscErrorCode Begin(void *data, const NodalScene *scene)
{
  Contact *s = data;
  PetscReal changed;

  PetscFunctionBeginUser;
  for (RigidWall *b = s->rigid; b < s->rigid + s->n_rigid; ++b) b->start = b->now;
  contact_again(s);
  PetscCall(ContactFind(s, scene));
  take_least(s, scene);
  s->adheres = (PetscBool)(scene->c->analysis.type != ANALYSIS_EXPLICIT && has_adhesion(scene->c));
  if (s->adheres) PetscCall(ContactLend(s, scene->grid, PETSC_TRUE, &changed));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactIsOver(Contact *s, const NodalScene *scene, const PetscReal *force)
{
  const PetscInt n = scene->c->n_bodies;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &s->least));
  PetscCall(PetscArraycpy(s->least, force, n));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const PetscInt body = scene->points->body[c->owner];
    s->least[body] = PetscMax(s->least[body], contact_last(c));
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, s->least, (PetscMPIInt)n, MPIU_REAL, MPIU_MAX, scene->grid->comm));
  for (PetscInt b = 0; b < n; ++b) s->least[b] *= NEXT_TO_NOTHING;
  take_least(s, scene);
  PetscFunctionReturn(0);
}

/* What touches a wall cannot leave through it, nor along it if it rubs, as if the wall stood where it is. */
static void hold(const void *data, const NodalScene *scene, unsigned char *held)
{
  const Contact *s = data;
  (void)scene;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    if (!contact_bears(c)) continue;
    const PetscBool slides = c->law.kind == CONTACT_FRICTIONLESS || (s->slips && c->law.kind == CONTACT_FRICTION);
    for (PetscInt e = c->first; e < c->first + c->n; ++e)
      for (PetscInt d = 0; d < s->dim; ++d)
        if (!slides || PetscAbsReal(c->normal[d]) > LEANS) held[s->node[e] * s->dim + d] = 1;
  }
}

static PetscBool find_slots(void *data, const System *system)
{
  Contact *s = data;
  PetscInt missing = 0;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    missing += !nodal_find_slots(system, c->n, s->node + c->first, s->slot + c->slot);
  return !missing;
}

/* Walls couple nodes of the same points, bodies those of two. */
static PetscErrorCode Couple(const void *data, const NodalScene *scene, NodeGroups *groups)
{
  const Contact *s = data;

  (void)scene;
  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    if (c->wall >= s->n_walls) PetscCall(NodeGroupsAdd(groups, c->n, s->node + c->first));
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(const NodalScene *scene, Diag *diag, void **data)
{
  (void)diag;
  PetscFunctionBeginUser;
  *data = scene->contact;
  PetscFunctionReturn(0);
}

/* The normal of contact at the end of the step: that of the wall, or of the surface of a body as it has turned, n less
 * the slope of n . u along the surface. */
static void normal_at_end(const Contact *s, const ContactPoint *c, const PetscReal *du, PetscReal n[3])
{
  PetscReal square = 0;
  for (int d = 0; d < 3; ++d) n[d] = c->normal[d];
  if (c->wall < s->n_walls) return;
  for (PetscInt e = c->first; e < c->first + c->own; ++e) {
    PetscReal along = 0;
    for (PetscInt d = 0; d < s->dim; ++d) along += c->normal[d] * du[s->node[e] * s->dim + d];
    for (PetscInt d = 0; d < s->dim; ++d) n[d] -= s->turn[e * s->dim + d] * along;
  }
  for (int d = 0; d < 3; ++d) square += n[d] * n[d];
  for (int d = 0; d < 3; ++d) n[d] /= PetscSqrtReal(square);
}

/* Distance of the material point from its surface at the end of the step, along the normal there: that of where both
 * have gone, so that the next step starts with the gap that this one ends with. */
static PetscReal reach_at_end(const Contact *s, const ContactPoint *c, const NodalScene *scene)
{
  const PetscReal first = scene->points->real[POINT_REACH][c->owner];
  PetscReal n[3], reach = c->ahead;
  if (scene->stays) return c->reach;
  normal_at_end(s, c, scene->du, n);
  if (c->state == CONTACT_OPEN && c->edge) /* which turns the normal as it goes past, and not the material */
    reach = PetscMax(reach, PetscMin(c->reach, contact_reach_of(scene->points, c->owner, n)));
  if (c->wall >= s->n_walls) reach *= n[0] * c->normal[0] + n[1] * c->normal[1] + n[2] * c->normal[2];
  for (PetscInt e = c->first; e < c->first + c->own; ++e)
    for (PetscInt d = 0; d < s->dim; ++d) reach -= n[d] * s->lead[e] * scene->du[s->node[e] * s->dim + d];
  return PetscMax(THINNEST * first, PetscMin(contact_farthest(scene->points, c->owner), reach));
}

static void mark(const void *data, unsigned char *node)
{
  const Contact *s = data;
  for (PetscInt e = 0; e < s->n_nodes; ++e) node[s->node[e]] = 1;
}

/* Of what its gap has leapt by: all on a quarter of a cell. */
static PetscReal share_taken_back(const Contact *s, const ContactPoint *c)
{
  PetscReal across = 0, square = 0;
  if (c->leapt == 0) return 0;
  for (int d = 0; d < 3; ++d) across += c->slip[d] * c->normal[d], square += PetscSqr(c->slip[d]);
  return PetscMin(1, PetscSqrtReal(PetscMax(0, square - across * across)) / (TAKEN_BACK * s->length));
}

/* What has been let in may stand beyond an open wall: it keeps the side that it came from, as in explicit steps. */
static void keep_side(const ContactPoint *c, PetscInt dim, PetscReal *kept)
{
  if (!c->side || !c->let_in || c->gap == PETSC_MAX_REAL) return;
  kept[KEPT_SIDE(dim)] = c->side;
  kept[KEPT_DISTANCE(dim)] = c->gap - c->passed + kept[KEPT_REACH];
}

/* Carriers keep what acted on them. */
static PetscErrorCode Commit(void *data, const NodalScene *scene)
{
  const Contact *s = data;
  const PetscInt dim = s->dim;
  PetscReal f[3];

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(s->sunk, s->n_partners));
  PetscCall(PetscArrayzero(scene->points->real[POINT_CONTACT],
                           scene->points->n * s->n_partners * contact_kept_partner(dim, s->sides)));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    PetscReal *kept = contact_kept_of(s, scene->points, c);
    kept[KEPT_STATE] = (PetscReal)c->state + (c->let_in ? CONTACT_LET_IN : 0);
    kept[KEPT_REACH] = reach_at_end(s, c, scene);
    contact_force(c, f);
    for (PetscInt d = 0; d < dim && c->state != CONTACT_OPEN; ++d) kept[KEPT_FORCE + d] = s->share.mean * f[d];
    kept[KEPT_STAYS(dim)] = contact_stays(s, c);
    kept[KEPT_LEAPT(dim)] = c->leapt;
    kept[KEPT_TAKES(dim)] = scene->stays ? 0 : share_taken_back(s, c);
    kept[KEPT_PASSED(dim)] = c->passed;
    keep_side(c, dim, kept);
    contact_keep_normal(kept, dim, s->sides, scene->stays ? c->facing : c->normal);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ToTables(const void *data, const NodalScene *scene, Tables *tables)
{
  const Contact *s = data;
  Table *table;
  Column *column;

  (void)scene;
  PetscFunctionBeginUser;
  PetscCall(TablesAdd(tables, "walls", PETSC_TRUE, s->n_partners, &table));
  PetscCall(TableAdd(table, "state", NULL, COLUMN_REAL, WALL_NUMBERS, NULL, &column));
  PetscCall(PetscMemcpy(column->data, s->wall, (size_t)s->n_partners * sizeof *s->wall));
  PetscCall(TableAdd(table, "crossed", NULL, COLUMN_REAL, 1, NULL, &column));
  PetscCall(PetscArraycpy((PetscReal *)column->data, s->crossed, s->n_partners));
  PetscCall(TableAdd(table, "sunk", NULL, COLUMN_REAL, 1, NULL, &column));
  PetscCall(PetscArraycpy((PetscReal *)column->data, s->sunk, s->n_partners));
  if (!s->n_rigid) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "rigid_walls", PETSC_TRUE, s->n_rigid, &table));
  PetscCall(TableAdd(table, "state", NULL, COLUMN_REAL, RIGID_NUMBERS, NULL, &column));
  for (PetscInt k = 0; k < s->n_rigid; ++k)
    PetscCall(PetscMemcpy((PetscReal *)column->data + k * RIGID_NUMBERS, &s->rigid[k].now, sizeof s->rigid->now));
  PetscCall(TableAdd(table, "held", NULL, COLUMN_REAL, RIGID, NULL, &column));
  for (PetscInt k = 0; k < s->n_rigid; ++k)
    PetscCall(PetscArraycpy((PetscReal *)column->data + k * RIGID, s->rigid[k].held, RIGID));
  PetscFunctionReturn(0);
}

/* Walls with mass, and where they are. */
static void rigid_from_tables(Contact *s, const Tables *tables, char reason[256])
{
  const Table *table = tables_find(tables, "rigid_walls");
  const PetscReal *state = table ? table_data(table, "state", COLUMN_REAL, RIGID_NUMBERS, reason) : NULL;
  const PetscReal *held =
    table && table_has(table, "held") ? table_data(table, "held", COLUMN_REAL, RIGID, reason) : NULL;
  if (reason[0]) return;
  if ((table ? table->rows : 0) != s->n_rigid) {
    snprintf(reason, 256, "walls with mass are others");
    return;
  }
  for (PetscInt k = 0; k < s->n_rigid; ++k) {
    (void)memcpy(&s->rigid[k].start, state + k * RIGID_NUMBERS, sizeof s->rigid->start);
    for (int i = 0; i < RIGID && held; ++i) s->rigid[k].held[i] = held[RIGID * k + i];
    rigid_restore(s->rigid + k, s->walls);
  }
}

/* What only explicit steps of walls count; older states have none of it. */
static PetscErrorCode CountFromTable(const Table *table, const char *name, PetscReal *count, char reason[256])
{
  PetscFunctionBeginUser;
  const PetscReal *was = !reason[0] && table_has(table, name) ? table_data(table, name, COLUMN_REAL, 1, reason) : NULL;
  if (was) PetscCall(PetscArraycpy(count, was, table->rows));
  PetscFunctionReturn(0);
}

static PetscErrorCode FromTables(void *data, const NodalScene *scene, const Tables *tables, char reason[256])
{
  Contact *s = data;
  const Table *table = tables_find(tables, "walls");

  (void)scene;
  PetscFunctionBeginUser;
  if (!table) {
    snprintf(reason, 256, "walls is missing");
    PetscFunctionReturn(0);
  }
  const PetscReal *state = table_data(table, "state", COLUMN_REAL, WALL_NUMBERS, reason);
  if (state && table->rows != s->n_partners) snprintf(reason, 256, "walls are others");
  if (state && !reason[0]) PetscCall(PetscMemcpy(s->wall, state, (size_t)s->n_partners * sizeof *s->wall));
  PetscCall(CountFromTable(table, "crossed", s->crossed, reason));
  PetscCall(CountFromTable(table, "sunk", s->sunk, reason));
  if (state && !reason[0]) rigid_from_tables(s, tables, reason);
  PetscFunctionReturn(0);
}

const NodalForce nodal_force_contact = {
  .name = "contact",
  .help = "rigid walls that material meets, and bodies that meet each other, with friction",
  .apart = PETSC_TRUE,
  .create = Create,
  .begin = Begin,
  .hold = hold,
  .couple = Couple,
  .find_slots = find_slots,
  .assemble = ContactAssemble,
  .augment = ContactAugment,
  .mark = mark,
  .commit = Commit,
  .to_tables = ToTables,
  .from_tables = FromTables,
};
