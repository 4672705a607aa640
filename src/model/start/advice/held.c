/* Is every body held? In statics a body that nothing prescribed reaches, through other bodies
 * neither, can be anywhere: the tangent is singular, and what a solver makes of that is no
 * answer. */
#include "model/start/unheld_private.h"

PetscErrorCode BodyTouches(const Model *m, PetscInt body, PetscReal *touched)
{
  const Support *w = m->space->support;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(touched, m->grid->n_nodes));
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
      for (PetscInt i = w->node_start[g]; i < w->node_start[g + 1] && m->points->body[p] == body; ++i)
        touched[w->node[i]] = 1;
  PetscCall(GridSumToOwners(m->grid, 1, touched));
  PetscCall(GridToGhosts(m->grid, 1, touched));
  PetscFunctionReturn(0);
}

/* holds (n_nodes x dim): is the node held in this direction, by a prescribed motion or by a nodal force? */
static PetscErrorCode NodesHeld(const Model *m, unsigned char **holds)
{
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  const PetscInt n = m->grid->n_nodes * m->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, holds));
  PetscCall(NodalForcesBegin(&m->forces, &scene));
  for (PetscInt k = 0; k < n; ++k) (*holds)[k] = (unsigned char)boundary_holds(m->boundary, k / m->dim, k % m->dim);
  nodal_forces_hold(&m->forces, &scene, *holds);
  PetscFunctionReturn(0);
}

/* joined (bodies x bodies): do both touch one node? held (bodies x dim): is a node of the body held in this
 * direction? */
static PetscErrorCode Touches(const Model *m, PetscInt *joined, PetscInt *held)
{
  const PetscInt n = m->c->n_bodies, nodes = m->grid->n_nodes;
  PetscReal *touched;
  PetscInt *before; /* n_nodes: the last body that touches it, from 1 on */
  unsigned char *holds;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(nodes, &touched));
  PetscCall(PetscCalloc1(nodes, &before));
  PetscCall(NodesHeld(m, &holds));
  for (PetscInt b = 0; b < n; ++b) {
    PetscCall(BodyTouches(m, b, touched));
    for (PetscInt node = 0; node < nodes; ++node) {
      if (touched[node] == 0) continue;
      for (PetscInt d = 0; d < m->dim; ++d) held[b * m->dim + d] |= holds[node * m->dim + d];
      if (before[node]) joined[b * n + before[node] - 1] = joined[(before[node] - 1) * n + b] = 1;
      before[node] = b + 1;
    }
  }
  PetscCall(PetscFree(touched));
  PetscCall(PetscFree(before));
  PetscCall(PetscFree(holds));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, joined, (PetscMPIInt)(n * n), MPIU_INT, MPI_MAX, m->comm));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, held, (PetscMPIInt)(n * m->dim), MPIU_INT, MPI_MAX, m->comm));
  PetscFunctionReturn(0);
}

/* What holds a body holds all that it touches. */
static void spread(PetscInt n, PetscInt dim, const PetscInt *joined, PetscInt *held)
{
  PetscBool more = PETSC_TRUE;
  while (more) {
    more = PETSC_FALSE;
    for (PetscInt k = 0; k < n * n * dim; ++k) {
      const PetscInt a = k / (n * dim), b = k / dim % n, d = k % dim;
      if (!joined[a * n + b] || !held[b * dim + d] || held[a * dim + d]) continue;
      held[a * dim + d] = 1;
      more = PETSC_TRUE;
    }
  }
}

static void join(PetscInt n, PetscInt a, PetscInt b, PetscInt *joined) { joined[a * n + b] = joined[b * n + a] = 1; }

/* Of walls with mass: those that touch the same one are joined. */
static PetscErrorCode JoinAtRigid(const Model *m, MeetKind meet, PetscInt *joined)
{
  const PetscInt n = m->c->n_bodies;
  const Contact *s = m->contact;
  PetscReal *touched;
  PetscInt *at; /* walls x bodies */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m->grid->n_nodes, &touched));
  PetscCall(PetscCalloc1(m->c->n_walls * n, &at));
  for (PetscInt b = 0; b < n; ++b) {
    PetscCall(BodyTouches(m, b, touched));
    for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
      if (contact_rigid(s, c) && meet_as_one(meet, c) && contact_bears(c) && touched[s->node[c->first]] != 0)
        at[c->wall * n + b] = 1;
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, at, (PetscMPIInt)(m->c->n_walls * n), MPIU_INT, MPI_MAX, m->comm));
  for (PetscInt i = 0; i < m->c->n_walls * n; ++i)
    for (PetscInt b = 0; at[i] && b < n; ++b)
      if (at[i / n * n + b]) join(n, i % n, b, joined);
  PetscCall(PetscFree(touched));
  PetscCall(PetscFree(at));
  PetscFunctionReturn(0);
}

/* Those that move as one at interfaces, or with a wall that has mass, are joined. */
static PetscErrorCode JoinMeeting(const Model *m, MeetKind meet, PetscInt *joined)
{
  const PetscInt n = m->c->n_bodies;
  const Contact *s = m->contact;

  PetscFunctionBeginUser;
  if (!s || meet == MEET_NONE) PetscFunctionReturn(0);
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    if (c->wall < s->n_walls || !meet_as_one(meet, c) || !contact_bears(c)) continue;
    char *const *between = m->c->interfaces[c->wall - s->n_walls].between;
    join(n, case_body(m->c, between[0]), case_body(m->c, between[1]), joined);
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, joined, (PetscMPIInt)(n * n), MPIU_INT, MPI_MAX, m->comm));
  if (s->n_rigid) PetscCall(JoinAtRigid(m, meet, joined));
  PetscFunctionReturn(0);
}

PetscErrorCode JoinedBodies(const Model *m, MeetKind meet, PetscReal *of)
{
  const PetscInt n = m->c->n_bodies, nodes = m->grid->n_nodes;
  PetscInt *joined, *held, *first;
  PetscReal *touched;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(n * n, &joined, n * m->dim, &held, n, &first, nodes, &touched));
  PetscCall(Touches(m, joined, held));
  PetscCall(JoinMeeting(m, meet, joined));
  for (PetscInt b = 0; b < n; ++b) first[b] = b;
  for (PetscInt pass = 0; pass < n; ++pass)
    for (PetscInt k = 0; k < n * n; ++k)
      if (joined[k]) first[k / n] = PetscMin(first[k / n], first[k % n]);
  for (PetscInt b = 0; b < n; ++b) {
    PetscCall(BodyTouches(m, b, touched));
    for (PetscInt node = 0; node < nodes; ++node)
      if (touched[node] != 0) of[node] = (PetscReal)(first[b] + 1);
  }
  PetscCall(PetscFree4(joined, held, first, touched));
  PetscFunctionReturn(0);
}

static void name_directions(PetscInt dim, const PetscInt *held, char text[32])
{
  PetscInt missing = 0;
  text[0] = 0;
  for (PetscInt d = 0; d < dim; ++d) {
    if (held[d]) continue;
    const size_t length = strlen(text);
    snprintf(text + length, 32 - length, "%s%c", missing++ ? " and " : "", "xyz"[d]);
  }
}

/* Does the material come to other nodes as it moves, whatever these are held by and share? */
static PetscBool roams(const Model *m) { return (PetscBool)(m->method->restores_grid || m->method->clouds); }

/* What holds any node of the grid may come to hold what comes there. */
static PetscErrorCode AddElsewhere(const Model *m, PetscInt *joined, PetscInt *held)
{
  const PetscInt n = m->c->n_bodies, dim = m->dim;
  PetscInt any[3] = {0, 0, 0};
  unsigned char *holds;

  PetscFunctionBeginUser;
  PetscCall(NodesHeld(m, &holds));
  for (PetscInt k = 0; k < m->grid->n_nodes * dim; ++k) any[k % dim] |= holds[k];
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, any, 3, MPIU_INT, MPI_MAX, m->comm));
  for (PetscInt k = 0; k < n * dim; ++k) held[k] |= any[k % dim];
  for (PetscInt k = 0; k < n * n; ++k) joined[k] = 1;
  PetscCall(PetscFree(holds));
  PetscFunctionReturn(0);
}

/* Whatever may come to hold a body, wherever it is then: walls that it meets, bodies at interfaces. */
static PetscErrorCode AddChances(const Model *m, PetscInt *joined, PetscInt *held)
{
  const PetscInt n = m->c->n_bodies;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->c->n_walls * n; ++i)
    for (PetscInt d = 0; d < m->dim && !m->c->walls[i / n].absent; ++d)
      held[i % n * m->dim + d] |= contact_meets_body(m->c, i / n, i % n);
  for (const InterfaceSpec *i = m->c->interfaces; i < m->c->interfaces + m->c->n_interfaces; ++i)
    join(n, case_body(m->c, i->between[0]), case_body(m->c, i->between[1]), joined);
  if (roams(m)) PetscCall(AddElsewhere(m, joined, held));
  PetscFunctionReturn(0);
}

PetscErrorCode FindHeld(const Model *m, PetscBool arrived, PetscInt *held)
{
  const PetscInt n = m->c->n_bodies;
  PetscInt *joined;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n * n, &joined));
  PetscCall(Touches(m, joined, held));
  if (!arrived) PetscCall(AddChances(m, joined, held));
  for (PetscInt b = 0; b < n && m->c->kinematics->hoop; ++b) held[b * m->dim] = 1; /* a ring by its hoop */
  spread(n, m->dim, joined, held);
  PetscCall(PetscFree(joined));
  PetscFunctionReturn(0);
}

/* How a body is held whose loads are in balance. What rubs or sticks already does not touch it yet, as where a round
 * body meets a wall in one point. */
static const char *balance_hint(const Model *m)
{
  PetscBool rubs = (PetscBool)(case_has_contact(m->c, CONTACT_STICK) || case_has_contact(m->c, CONTACT_BONDED));
  for (PetscInt k = 0; k < m->c->n_walls; ++k) rubs |= m->c->walls[k].friction > 0;
  for (PetscInt k = 0; k < m->c->n_interfaces; ++k) rubs |= m->c->interfaces[k].friction > 0;
  if (rubs) return "let it reach a few hundredths of a cell into what is to hold it";
  return m->c->n_interfaces || (m->contact && m->contact->n_rigid) ? "friction: 0.01 on what it touches"
                                                                   : "analysis: {unheld: hold}";
}

/* When it is asked what nothing holds: before bodies have arrived (see CheckHeld), then, when the run is over. */
typedef enum { BEFORE, START, END } When;

/* others: what goes with it, so that nothing between them holds it. */
static void tell(const Model *m, PetscInt body, const char *others, const char *which, When when, Diag *diag)
{
  char path[64];
  snprintf(path, sizeof path, "bodies[%d]", (int)body);
  if (when == END) {
    diag_warning(diag, path,
                 "nothing holds '%s'%s %s any more: it has left the walls or bodies that it was pressed against, and "
                 "where a static analysis has put it means nothing",
                 m->c->bodies[body].name, others, which);
    diag_hint(diag,
              "walls push and do not pull: fix a boundary that way, put a wall on the other side, or let it "
              "stick");
    return;
  }
  diag_error(diag, path, "nothing holds '%s'%s %s: a static analysis has no answer", m->c->bodies[body].name, others,
             which);
  diag_hint(diag, "fix a boundary that the body touches that way, or let it move: analysis: {type: dynamic}%s%s",
            others[0] ? "" : "; if its loads are in balance: ", others[0] ? "" : balance_hint(m));
}

/* Directions in which nothing touches it. */
static PetscErrorCode TellLoose(const Model *m, When when, PetscBool *told, Diag *diag)
{
  const PetscInt n = m->c->n_bodies, dim = m->dim;
  PetscInt *held;
  char which[40] = "in ";

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n * dim, &held));
  PetscCall(FindHeld(m, (PetscBool)(when != BEFORE), held));
  for (PetscInt k = 0; k < n * dim; ++k) held[k] |= m->unheld.along[k % dim];
  for (PetscInt b = 0; b < n; ++b) {
    name_directions(dim, held + b * dim, which + 3);
    if (!which[3] || m->c->bodies[b].absent) continue;
    tell(m, b, "", which, when, diag);
    *told = PETSC_TRUE;
  }
  PetscCall(PetscFree(held));
  PetscFunctionReturn(0);
}

/* Ways that are free although something leans towards each axis, as between planes that lie alike. */
static PetscErrorCode TellLine(Model *m, UnheldGroup *g, When when, Diag *diag)
{
  UnheldGroup line = *g;
  char which[64];

  PetscFunctionBeginUser;
  unheld_keep_from_turning(m, &line);
  if (!line.n_free) PetscFunctionReturn(0);
  unheld_name_free(m, &line, which);
  tell(m, g->body, g->meet == MEET_NONE ? "" : " and what it touches", which, when, diag);
  PetscFunctionReturn(0);
}

static PetscErrorCode RefuseLine(Model *m, UnheldGroup *g, Diag *diag) { return TellLine(m, g, START, diag); }

static PetscErrorCode WarnOfLine(Model *m, UnheldGroup *g, Diag *diag) { return TellLine(m, g, END, diag); }

/* Each body by itself, others standing where they are; then those as one that rub on each other or are bonded; then all
 * that touch. */
static PetscErrorCode TellLines(Model *m, When when, Diag *diag)
{
  const PetscInt before = diag_errors(diag) + diag_warnings(diag);
  const MeetKind most = m->contact && (m->c->n_interfaces || m->contact->n_rigid) ? MEET_ALL : MEET_NONE;

  PetscFunctionBeginUser;
  for (MeetKind meet = MEET_NONE; meet <= most && diag_errors(diag) + diag_warnings(diag) == before; ++meet)
    PetscCall(UnheldEach(m, meet, diag, when == END ? WarnOfLine : RefuseLine));
  PetscFunctionReturn(0);
}

PetscErrorCode CheckHeld(Model *m, PetscBool arrived, Diag *diag)
{
  const PetscInt before = diag_errors(diag);
  const PetscBool stands = (PetscBool)(arrived || !(m->contact || roams(m)));
  PetscBool told = PETSC_FALSE;
  PetscInt points;

  PetscFunctionBeginUser;
  if (m->c->analysis.unheld == UNHELD_HOLD) {
    PetscCall(UnheldCheck(m, stands, diag));
    PetscFunctionReturn(0);
  }
  PetscCall(ModelCountPoints(m, &points));
  if ((m->scheme->inertia && !case_equilibrates(m->c)) || !points) PetscFunctionReturn(0);
  PetscCall(TellLoose(m, stands ? START : BEFORE, &told, diag));
  if (!stands) PetscFunctionReturn(0);
  if (!told) PetscCall(TellLines(m, START, diag));
  if (diag_errors(diag) == before) PetscCall(UnheldTurning(m, diag));
  PetscCall(AdviseRests(m, diag));
  PetscFunctionReturn(0);
}

/* Beside the forces inside of each body those of walls and others that it has come off are round-off, however many of
 * them there are. */
static PetscErrorCode TakeLeave(Model *m, const NodalScene *scene)
{
  PetscReal *force;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->c->n_bodies, &force));
  for (PetscInt p = 0; p < m->points->n; ++p)
    force[m->points->body[p]] = PetscMax(force[m->points->body[p]], stress_force(m, p));
  PetscCall(ContactIsOver(m->contact, scene, force));
  PetscCall(PetscFree(force));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelWarnLoose(Model *m, Diag *diag)
{
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  const PetscBool holds = (PetscBool)(m->c->analysis.unheld == UNHELD_HOLD);
  PetscBool told = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!m->contact || m->c->analysis.type != ANALYSIS_STATIC || !m->step) PetscFunctionReturn(0);
  if (holds && !m->unheld.dof) PetscFunctionReturn(0); /* no step was left to take */
  PetscCall(ModelInitialise(m));
  PetscCall(NodalForcesBegin(&m->forces, &scene));
  PetscCall(TakeLeave(m, &scene));
  PetscCall(TellLoose(m, END, &told, diag));
  if (!told && !holds) PetscCall(TellLines(m, END, diag));
  PetscCall(PetscFree(m->contact->least));
  PetscFunctionReturn(0);
}
