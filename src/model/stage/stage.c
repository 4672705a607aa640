#include "base/math/vector.h"
#include "method/transfer/slopes.h"
#include "method/transfer/transfer.h"
#include "model/stage/stage_private.h"
#include "grid/search/directory.h"
#include "model/state/state.h"
#include "model/state/state_private.h"

/* Bodies of another run move as they did in it. */
static void check_motion(const Case *c, const Case *from, Diag *diag)
{
  char path[64];
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    const BodySpec *body = &c->bodies[b];
    const PetscBool moves = (PetscBool)(vector_dot(body->velocity, body->velocity) > 0);
    if (body_comes(c, from, b) || (!moves && !(vector_dot(body->spin, body->spin) > 0))) continue;
    snprintf(path, sizeof path, "bodies[%d].%s", (int)b, moves ? "velocity" : "spin");
    diag_error(diag, path, "'%s' comes from the run of `initial` with the velocities that it has there", body->name);
    diag_hint(diag, "leave out its `velocity` and `spin`");
  }
}

/* There, or declared as absent. */
static PetscBool knows_body(const Case *c, const char *name)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (!strcmp(c->bodies[b].name, name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Bodies find their state by their names: who has none begins as drawn, and that of others stays behind. */
static PetscErrorCode CheckNames(const Case *c, const Case *from, Diag *diag)
{
  const char **there;
  char path[64];
  PetscInt goes_on = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(from->n_bodies + 1, &there));
  for (PetscInt b = 0; b < c->n_bodies; ++b) goes_on += !c->bodies[b].absent && !body_comes(c, from, b);
  for (PetscInt b = 0; b < from->n_bodies; ++b) there[b] = from->bodies[b].name;
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    if (c->bodies[b].absent || knows_body(from, c->bodies[b].name)) continue;
    snprintf(path, sizeof path, "bodies[%d].name", (int)b);
    (goes_on ? diag_warning : diag_error)(diag, path, "the run of `initial` has no body '%s': %s", c->bodies[b].name,
                                          goes_on ? "it begins as it is drawn" : "nothing of its state would go on");
    diag_hint_names(diag, c->bodies[b].name, there);
  }
  for (PetscInt b = 0; b < from->n_bodies && goes_on; ++b)
    if (!from->bodies[b].absent && !knows_body(c, there[b]))
      diag_warning(diag, "initial.run", "'%s' of that run is not among the bodies here: it stays behind", there[b]);
  PetscCall(PetscFree(there));
  PetscFunctionReturn(0);
}

/* What no state can be made of, by its name. */
static PetscErrorCode CheckCases(const Model *m, const Case *from, PetscBool next, Diag *diag)
{
  const Case *c = m->c;

  PetscFunctionBeginUser;
  if (strcmp(c->method, from->method))
    diag_error(diag, "method", "the state is one of method %s, and cannot go on with %s", from->method, c->method);
  if (c->kinematics != from->kinematics)
    diag_error(diag, "kinematics", "the state is one of `kinematics: %s`", from->kinematics->name);
  if (!m->method->restores_grid && case_is_mixed(c) != case_is_mixed(from))
    diag_error(diag, "formulation", "nodes of fem carry their pressures or have none: the state is one of `%s`",
               from->formulation);
  PetscCall(RenameCheck(c, from, next, diag));
  if (!next) check_motion(c, from, diag);
  if (!next) PetscCall(CheckNames(c, from, diag));
  PetscFunctionReturn(0);
}

/* Nodes of fem go where they were, and bodies that come find them there. */
static PetscErrorCode TakeMesh(Model *m, const Tables *tables, const Case *from, Diag *diag, char reason[256])
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  PetscReal *drawn;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(dofs, &drawn));
  PetscCall(PetscArraycpy(drawn, m->grid->x, dofs));
  PetscCall(NodalFieldsFromTables(m->nodes, PETSC_TRUE, tables, reason));
  PetscCall(ReasonShare(m->comm, reason));
  if (!reason[0]) PetscCall(BodiesArrive(m, from, drawn, diag));
  PetscCall(PetscFree(drawn));
  PetscFunctionReturn(0);
}

/* What the boundary bears in the state that the case would have begun with. */
static PetscErrorCode ForgetReactions(Model *m)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(m->nodes->held, dofs));
  PetscCall(PetscArrayzero(m->nodes->rate, dofs));
  PetscCall(PetscArrayzero(m->nodes->reaction, dofs));
  PetscFunctionReturn(0);
}

/* What nodes of a box know of the boundary's forces in another run: where its tables do not tell, nothing. */
static PetscErrorCode TakeReactions(Model *m, const Tables *tables)
{
  char unheard[256] = "";

  PetscFunctionBeginUser;
  PetscCall(NodalFieldsFromTables(m->nodes, PETSC_FALSE, tables, unheard));
  PetscCall(ReasonShare(m->comm, unheard));
  if (unheard[0]) PetscCall(ForgetReactions(m));
  PetscFunctionReturn(0);
}

/* Nodes of a cloud came with its parts; home: to the ranks that had them. */
static PetscErrorCode TakeNodes(Model *m, const Tables *tables, const Case *from, PetscBool next, PetscBool home,
                                Diag *diag, char reason[256])
{
  PetscFunctionBeginUser;
  if (m->method->clouds) PetscCall(StateCloudSettle(m, tables, home, reason));
  else if (!m->method->restores_grid) PetscCall(TakeMesh(m, tables, from, diag, reason));
  else if (next) PetscCall(NodalFieldsFromTables(m->nodes, PETSC_FALSE, tables, reason));
  m->guess = (Guess){0};
  if (next && !reason[0]) PetscCall(ForcesFromTables(m, tables, reason));
  PetscFunctionReturn(0);
}

/* Kinetic and stored energy of the points, on this rank. */
static PetscReal stored(const Model *m)
{
  PetscReal sum = 0;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *v = point_real(m->points, POINT_V, p);
    sum += m->points->real[POINT_WORK][p];
    for (PetscInt d = 0; d < m->dim; ++d) sum += 0.5 * m->points->real[POINT_MASS][p] * v[d] * v[d];
  }
  return sum;
}

/* What the tables' points hold, on this rank. */
static PetscReal stored_before(const Tables *tables, PetscInt dim, char reason[256])
{
  const Table *table = tables_find(tables, "points");
  const PetscReal *work = table_data(table, "stress_work", COLUMN_REAL, 1, reason);
  const PetscReal *v = table_data(table, "velocity", COLUMN_REAL, dim, reason);
  const PetscReal *mass = table_data(table, "mass", COLUMN_REAL, 1, reason);
  PetscReal sum = 0;
  for (PetscInt r = 0; r < table->rows && !reason[0]; ++r) {
    sum += work[r];
    for (PetscInt d = 0; d < dim; ++d) sum += 0.5 * mass[r] * v[r * dim + d] * v[r * dim + d];
  }
  return sum;
}

/* What comes and goes with bodies and walls, with motion that ends and mass that changes, is none of the work of the
 * run; of walls that are gone for good their loads' work stays. stored_then: of points, on this rank. */
static PetscErrorCode KeepAccount(Model *m, PetscReal stored_then, const Model *before)
{
  PetscReal local[2] = {stored_then, stored(m)}, sum[2];

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  sum[1] += rigid_motion(m) + rigid_away(m);
  if (before) {
    m->start_energy += sum[1] - sum[0] - rigid_motion(before) - rigid_away(before);
    m->external_work += rigid_work(before) - rigid_work(m);
  } else m->start_energy = sum[1], m->open_energy = 0;
  m->most_energy = PetscMax(before ? m->most_energy : 0, energy_at_start(m) + m->external_work + m->boundary_work);
  PetscFunctionReturn(0);
}

/* Does one of its bodies come, and is the other there? */
static PetscBool meets_who_comes(const Case *c, const Case *from, const InterfaceSpec *s)
{
  const PetscInt a = case_body(c, s->between[0]), b = case_body(c, s->between[1]);
  if (c->bodies[a].absent || c->bodies[b].absent) return PETSC_FALSE;
  return (PetscBool)(body_comes(c, from, a) || body_comes(c, from, b));
}

/* All that the tables give; reason where they make no sense. */
static PetscErrorCode Take(Model *m, Tables *tables, const Case *from, const Model *before, PetscBool onto, Diag *diag,
                           char reason[256])
{
  const PetscReal stored_then = stored_before(tables, m->dim, reason);
  const PetscInt errors = diag_errors(diag);
  const PetscBool next = (PetscBool)(before != NULL);
  PetscBool home = PETSC_TRUE; /* a cloud on other ranks is cut anew */

  PetscFunctionBeginUser;
  PetscCall(ReasonShare(m->comm, reason));
  PetscCall(ForgetReactions(m));
  if (!reason[0] && m->method->clouds) PetscCall(StateCloudNodes(m, tables, &home, reason));
  if (!reason[0] && next) PetscCall(RenameTables(m, from, tables));
  if (!reason[0] && next) PetscCall(StateGoOn(m, tables, reason));
  if (!reason[0]) PetscCall(TakePoints(m, tables, from, onto, diag, reason));
  if (!reason[0] && next) PetscCall(TakeTracers(m, tables, from, reason));
  if (!reason[0]) PetscCall(TakeCarriers(m, tables, from, reason));
  if (!reason[0]) PetscCall(TakeNodes(m, tables, from, next, home, diag, reason));
  if (!next && !onto && m->method->restores_grid && !m->method->clouds) PetscCall(TakeReactions(m, tables));
  PetscCall(ReasonShare(m->comm, reason));
  if (reason[0] || diag_errors(diag) > errors) PetscFunctionReturn(0);
  if (next) walls_go_on(m, before);
  if (m->method->restores_grid || m->grid->n_fields > 1) PetscCall(BodiesStand(m, from, diag));
  for (int pass = 0; next && pass < 2; ++pass) /* what reaches over at one has another surface at the next one */
    for (PetscInt k = 0; k < m->c->n_interfaces; ++k)
      if (meets_who_comes(m->c, from, m->c->interfaces + k)) PetscCall(InterfaceCloses(m, k));
  if (next) PetscCall(BondsBegin(m, from, diag));
  PetscCall(ResetMotion(m, from, next));
  PetscCall(KeepAccount(m, stored_then, before));
  PetscFunctionReturn(0);
}

/* Stresses are those of the laws now: strengths may be others, and pressures of fem are those of its nodes. */
static void settle_stress(Model *m)
{
  const Support *w = m->space->support;
  const PetscReal *pressure = m->method->restores_grid ? NULL : m->nodes->pressure;
  for (PetscInt g = 0; g < w->n_groups && pressure; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      m->points->real[POINT_PRESSURE][p] = 0;
      for (PetscInt k = 0; k < support_nodes(w, g); ++k)
        m->points->real[POINT_PRESSURE][p] += support_N(w, g, p)[k] * pressure[w->node[w->node_start[g] + k]];
    }
  for (PetscInt p = 0; p < m->points->n; ++p) energy_stress(m, p);
}

/* Points go onto any grid; what nodes or contact know does not. */
static PetscBool takes_another_grid(const Model *m, PetscBool next, Diag *diag)
{
  const Case *c = m->c;
  const PetscBool tied = (PetscBool)(c->n_walls || c->n_interfaces || loads_are_carried(c));
  if (!next && m->method->restores_grid && !m->method->clouds && !tied) return PETSC_TRUE;
  diag_error(diag, next ? NULL : "grid", "the grid of the case is not the one of the run%s",
             next                        ? ""
             : !m->method->restores_grid ? ", whose nodes carry the state of fem"
                                         : ", and with walls, interfaces or loads on bodies it needs the same one");
  diag_hint(
    diag, "%s",
    m->method->restores_grid
      ? "give the grid of that run; without walls, interfaces and loads on bodies mpm takes points onto another one"
      : "give the grid of that run, or let both be runs of mpm, whose points go onto any grid");
  return PETSC_FALSE;
}

/* Do points of that run move linearly where their body does? Nodes with lumped mass see them in the mean only. */
static PetscBool moves_linearly(const Case *from)
{
  const PetscBool lumps = (PetscBool)(from->analysis.mass == MASS_LUMPED || from->stabilisation.mass > 0);
  return (PetscBool)(transfer_find(from->analysis.transfer)->slopes &&
                     (from->analysis.type == ANALYSIS_EXPLICIT || !lumps));
}

PetscErrorCode ModelTake(Model *m, Tables *tables, const Case *from, const Model *before, Diag *diag,
                         Imbalance *imbalance)
{
  const PetscBool next = (PetscBool)(before != NULL);
  const PetscInt mistakes = diag_errors(diag);
  char reason[256] = "", other[256] = "";
  PetscInt errors;

  PetscFunctionBeginUser;
  PetscCall(CheckCases(m, from, next, diag));
  if (m->method->clouds && diag_errors(diag) == mistakes) PetscCall(CheckCloud(m, tables, diag, reason));
  state_check_grid(m, tables, other);
  const PetscBool onto = other[0] && diag_errors(diag) == mistakes && takes_another_grid(m, next, diag);
  if (diag_errors(diag) == mistakes) PetscCall(Take(m, tables, from, before, onto, diag, reason));
  if (reason[0]) diag_error(diag, next ? NULL : "initial.run", "the state cannot be taken over: %s", reason);
  PetscCall(DiagReduce(m->comm, diag, &errors));
  if (errors) PetscFunctionReturn(0);
  if (!m->method->clouds) m->space->present = PETSC_FALSE;
  PetscCall(ModelInitialise(m));
  if (!m->method->restores_grid && !m->method->clouds) PetscCall(DiscretisationMass(m->space)); /* of points taken */
  PetscCall(BodiesBringMotion(m, from));
  if (m->points->components[POINT_SLOPE] && !table_has(tables_find(tables, "points"), "slope"))
    PetscCall(SlopesStart(m->space, moves_linearly(from)));
  settle_stress(m);
  stresses_check(m, diag);
  PetscCall(CheckHeld(m, PETSC_TRUE, diag));
  if (next) PetscCall(AdviseHangs(m, diag));
  if (next) PetscCall(AstrideGoOn(m, before));
  PetscCall(AstrideLook(m));
  astride_tell(m, diag);
  if (next) PetscCall(WallsCome(m, from, diag));
  PetscCall(BeginTracers(m, next ? from : NULL, diag));
  PetscCall(DiagReduce(m->comm, diag, &errors));
  if (errors) PetscFunctionReturn(0);
  PetscCall(RemainderTo(m, from, tables, &imbalance->moved));
  PetscCall(HoldImbalance(m, from, imbalance));
  PetscCall(RemainderForget(m));
  if (!next) PetscCall(EnergyStart(m)); /* what was dissipated is the other run's */
  if (!next) PetscCall(ContactTell(m));
  PetscCall(BeginAcceleration(m, from, tables));
  PetscCall(BeginMeasures(m, next ? from : NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelSucceed(const Case *stage, Diag *diag, Model **model, Imbalance *imbalance)
{
  Model *before = *model, *m;
  Tables *tables;
  Diag *unheard;
  PetscInt errors;
  const PetscBool jumps = accelerations_go_on(stage, before->c), rests = remainder_goes_on(stage, before->c);

  PetscFunctionBeginUser;
  before->time = case_time(before->c, before->time); /* a search over, clocks go on from where they stood */
  PetscCall(TablesCreate(&tables));
  if (jumps) PetscCall(JumpFrom(before, tables));
  if (rests) PetscCall(RemainderFrom(before, tables));
  PetscCall(ModelToTables(before, tables));
  PetscCall(OptionsForget(before)); /* the next model has the same */
  PetscCall(DiagCreate(&unheard));  /* all has been said when the run began */
  PetscCall(ModelCreate(before->comm, stage, unheard, &m));
  PetscCall(DiagDestroy(&unheard));
  if (!m) diag_error(diag, NULL, "its model cannot be made");
  if (m && before->body_force) PetscCall(ModelSetBodyForce(m, before->body_force, before->body_force_context));
  if (m) strength_go_on(m, before, diag);
  if (m && jumps) PetscCall(JumpExpect(m));
  if (m && rests) PetscCall(RemainderExpect(m));
  if (m) raised_go_on(m, before);
  if (m) PetscCall(ModelTake(m, tables, before->c, before, diag, imbalance));
  PetscCall(TablesDestroy(&tables));
  PetscCall(DiagReduce(before->comm, diag, &errors));
  if (errors && m) PetscCall(ModelDestroy(&m));
  if (!m) PetscFunctionReturn(0);
  m->asked = before->asked;
  PetscCall(ModelDestroy(model));
  *model = m;
  PetscFunctionReturn(0);
}
