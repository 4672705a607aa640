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

/* joined (bodies x bodies): do both touch one node? held (bodies x dim): is a node of the body held
 * in this direction, by a prescribed motion or by a nodal force? */
static PetscErrorCode Touches(const Model *m, PetscInt *joined, PetscInt *held)
{
  const PetscInt n = m->c->n_bodies, nodes = m->grid->n_nodes;
  PetscReal *touched;
  PetscInt *before;     /* n_nodes: the last body that touches it, from 1 on */
  unsigned char *holds; /* n_nodes x dim */
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(nodes, &touched));
  PetscCall(PetscCalloc1(nodes, &before));
  PetscCall(PetscCalloc1(nodes * m->dim, &holds));
  PetscCall(NodalForcesBegin(&m->forces, &scene));
  for (PetscInt k = 0; k < nodes * m->dim; ++k) holds[k] |= boundary_holds(m->boundary, k / m->dim, k % m->dim);
  nodal_forces_hold(&m->forces, &scene, holds);
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

/* Those that touch at interfaces are joined. */
static PetscErrorCode JoinMeeting(const Model *m, PetscInt *joined)
{
  const PetscInt n = m->c->n_bodies;
  const Contact *s = m->contact;

  PetscFunctionBeginUser;
  for (const ContactPoint *c = s ? s->point : NULL; s && c < s->point + s->n; ++c) {
    if (c->wall < s->n_walls || !contact_touched(c)) continue;
    char *const *between = m->c->interfaces[c->wall - s->n_walls].between;
    const PetscInt a = case_body(m->c, between[0]), b = case_body(m->c, between[1]);
    joined[a * n + b] = joined[b * n + a] = 1;
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, joined, (PetscMPIInt)(n * n), MPIU_INT, MPI_MAX, m->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode JoinedBodies(const Model *m, PetscBool meet, PetscReal *of)
{
  const PetscInt n = m->c->n_bodies, nodes = m->grid->n_nodes;
  PetscInt *joined, *held, *first;
  PetscReal *touched;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(n * n, &joined, n * m->dim, &held, n, &first, nodes, &touched));
  PetscCall(Touches(m, joined, held));
  if (meet) PetscCall(JoinMeeting(m, joined));
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

PetscErrorCode FindHeld(const Model *m, PetscInt *held)
{
  const PetscInt n = m->c->n_bodies;
  PetscInt *joined;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n * n, &joined));
  PetscCall(Touches(m, joined, held));
  for (PetscInt b = 0; b < n && m->c->kinematics->hoop; ++b) held[b * m->dim] = 1; /* a ring by its hoop */
  spread(n, m->dim, joined, held);
  PetscCall(PetscFree(joined));
  PetscFunctionReturn(0);
}

/* How a body is held whose loads are in balance. What rubs already does not touch it yet, as where a round body meets a
 * wall in one point. */
static const char *balance_hint(const Model *m)
{
  PetscBool rubs = case_has_contact(m->c, CONTACT_STICK);
  for (PetscInt k = 0; k < m->c->n_walls; ++k) rubs |= m->c->walls[k].friction > 0;
  for (PetscInt k = 0; k < m->c->n_interfaces; ++k) rubs |= m->c->interfaces[k].friction > 0;
  if (rubs) return "let it reach a few hundredths of a cell into what is to hold it by friction";
  return m->c->n_interfaces || (m->contact && m->contact->n_rigid) ? "friction: 0.01 on what it touches"
                                                                   : "analysis: {unheld: hold}";
}

/* What nothing holds: a mistake at the start, a warning at the end. */
static PetscErrorCode TellLoose(const Model *m, PetscBool ends, Diag *diag)
{
  const PetscInt n = m->c->n_bodies, dim = m->dim;
  PetscInt *held;
  char path[64], directions[32];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n * dim, &held));
  PetscCall(FindHeld(m, held));
  for (PetscInt k = 0; k < n * dim; ++k) held[k] |= m->unheld.along[k % dim];
  for (PetscInt b = 0; b < n; ++b) {
    const char *name = m->c->bodies[b].name;
    name_directions(dim, held + b * dim, directions);
    if (!directions[0] || m->c->bodies[b].absent) continue;
    snprintf(path, sizeof path, "bodies[%d]", (int)b);
    if (ends) {
      diag_warning(
        diag, path,
        "nothing holds '%s' in %s any more: it has left the walls or bodies that it was pressed against, and "
        "where a static analysis has put it means nothing",
        name, directions);
      diag_hint(diag, "walls push and do not pull: fix a boundary in %s, put a wall on the other side, or let it stick",
                directions);
    } else {
      diag_error(diag, path, "nothing holds '%s' in %s: a static analysis has no answer", name, directions);
      diag_hint(diag,
                "fix a boundary that the body touches in %s, or let it move: analysis: {type: dynamic}; if its loads "
                "are in balance: %s",
                directions, balance_hint(m));
    }
  }
  PetscCall(PetscFree(held));
  PetscFunctionReturn(0);
}

/* A way that is free although something leans towards each axis, as between planes that lie alike. */
static PetscErrorCode RefuseLine(Model *m, UnheldGroup *g, Diag *diag)
{
  UnheldGroup line = *g;
  char path[64], text[64];

  PetscFunctionBeginUser;
  unheld_keep_from_turning(m, &line);
  if (!line.n_free) PetscFunctionReturn(0);
  unheld_name_free(m, &line, text);
  snprintf(path, sizeof path, "bodies[%d]", (int)g->body);
  diag_error(diag, path, "nothing holds '%s'%s %s: a static analysis has no answer", m->c->bodies[g->body].name,
             g->meet ? " and what it touches" : "", text);
  diag_hint(diag,
            "fix a boundary that the body touches that way, or let it move: analysis: {type: dynamic}; if its loads "
            "are in balance: %s",
            balance_hint(m));
  PetscFunctionReturn(0);
}

/* Each body by itself, others standing where they are; then all that touch at interfaces as one. */
static PetscErrorCode TellLines(Model *m, Diag *diag)
{
  const PetscInt before = diag_errors(diag);

  PetscFunctionBeginUser;
  PetscCall(UnheldEach(m, PETSC_FALSE, diag, RefuseLine));
  if (m->c->n_interfaces && diag_errors(diag) == before) PetscCall(UnheldEach(m, PETSC_TRUE, diag, RefuseLine));
  PetscFunctionReturn(0);
}

PetscErrorCode CheckHeld(Model *m, Diag *diag)
{
  const PetscInt before = diag_errors(diag);
  PetscInt points;

  PetscFunctionBeginUser;
  if (m->c->analysis.unheld == UNHELD_HOLD) {
    PetscCall(UnheldCheck(m, diag));
    PetscFunctionReturn(0);
  }
  PetscCall(ModelCountPoints(m, &points));
  if ((m->scheme->inertia && !case_equilibrates(m->c)) || !points) PetscFunctionReturn(0);
  PetscCall(TellLoose(m, PETSC_FALSE, diag));
  if (diag_errors(diag) == before) PetscCall(TellLines(m, diag));
  if (diag_errors(diag) == before) PetscCall(UnheldTurning(m, diag));
  PetscCall(AdviseRests(m, diag));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelWarnLoose(Model *m, Diag *diag)
{
  PetscFunctionBeginUser;
  if (!m->contact || m->c->analysis.type != ANALYSIS_STATIC || !m->step) PetscFunctionReturn(0);
  PetscCall(ModelInitialise(m));
  m->contact->over = PETSC_TRUE;
  PetscCall(TellLoose(m, PETSC_TRUE, diag));
  m->contact->over = PETSC_FALSE;
  PetscFunctionReturn(0);
}
