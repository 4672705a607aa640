/* A solved step becomes the state: phase (c) of the thesis, and what is told of the step. */
#include "method/extend/extend.h"
#include "model/model_private.h"

/* Where a constraint holds a node, its multiplier is the force there. */
static void set_multipliers(Model *m)
{
  const Constraints *c = m->space->constraints;
  for (PetscInt k = 0; k < c->n; ++k)
    for (PetscInt d = 0; d < m->dim; ++d)
      if (!m->nodes->fixed[c->twin[k] * m->dim + d])
        m->nodes->force[c->at[k] * m->dim + d] = c->scale * m->nodes->du[c->twin[k] * m->dim + d];
}

/* Reactions: in statics what the balance lacks on prescribed dofs; with inertia the mean over
 * the step, so that times dt it is all momentum that came from the boundary. The scheme weighs
 * the forces of both ends, its lag gives each an echo of those before, and what prescribed
 * motion replaced of the nodes' own at the start of the step is an impulse (docs/theory.md,
 * "Reactions"). */
static void store_reactions(Model *m, PetscReal dt)
{
  const TimeWeights w = m->scheme->weights(&m->c->analysis, dt);
  NodalFields *n = m->nodes;
  PetscReal *vectors[] = {n->force, n->rate, n->impulse, n->lost_force, n->held, n->reaction};
  const Frames *frames = &m->boundary->frames;
  for (int k = 0; k < 4; ++k) frames_turn(frames, m->dim, vectors[k]);
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    const PetscReal before = n->rate[i] + n->lost_force[i];
    const PetscBool fixed = m->boundary->fixed[i] != 0;
    n->reaction[i] = n->held[i] = fixed ? n->force[i] : 0;
    if (!m->scheme->inertia) continue;
    n->rate[i] = fixed ? (n->held[i] - w.lag * before) / (1 - w.lag) : 0;
    if (!fixed) continue;
    n->reaction[i] = (1 - w.mean) * before + w.mean * n->rate[i] + n->impulse[i] / dt;
  }
  for (int k = 0; k < 6; ++k) frames_turn(frames, m->dim, vectors[k]);
  let_go_settle(m, &w);
}

/* Velocities and accelerations of the nodes at the end of the step. */
static void end_motion(Model *m, PetscReal dt)
{
  const AnalysisSpec *analysis = &m->c->analysis;
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  NodalFields *n = m->nodes;
  m->scheme->end(analysis, dt, dofs, n->du, n->v, n->a, n->v1, n->a1);
  m->space->fade = 1 - PetscExpReal(-model_damping(m) * dt);
}

/* For the next step; until then it is what the last one had held back. */
static void keep_echo(const Model *m, PetscReal dt)
{
  const PetscReal lag = m->scheme->weights(&m->c->analysis, dt).lag;
  NodalFields *n = m->nodes;
  if (lag == 0 && m->method->restores_grid) return; /* it is 0 */
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i) n->echo[i] = lag * (n->a1[i] - n->a[i]);
}

const PetscReal *model_state_field(const Model *m, PetscInt p, const char *name)
{
  const PetscReal *state = point_real(m->points, POINT_STATE, p);
  for (const LawField *f = m->materials[m->points->material[p]].law->fields; f->name; ++f) {
    if (!strcmp(f->name, name)) return state;
    state += f->components;
  }
  return NULL;
}

void note_flow(Model *m, PetscReal sign)
{
  for (PetscInt p = 0; m->points->components[POINT_FLOW] && p < m->points->n; ++p) {
    const PetscReal *strain = model_state_field(m, p, "equivalent_plastic_strain");
    PetscReal *flow = point_real(m->points, POINT_FLOW, p);
    if (strain) *flow = sign * *strain + (sign > 0 ? *flow : 0);
  }
}

PetscErrorCode CommitStep(Model *m, PetscReal dt, EnergyStep *energy)
{
  LawStatus status;
  PetscLogDouble clock;
  PetscReal *before;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&clock));
  const PetscReal solved = time_solved(m->scheme);
  for (PetscInt i = 0; solved != 1 && i < m->grid->n_nodes * m->dim; ++i) m->nodes->prescribed[i] /= solved;
  end_motion(m, dt);
  PetscCall(DiscretisationFollow(m->space));
  set_multipliers(m);
  PetscCall(EnergyOfNodes(m, dt, energy));
  keep_echo(m, dt);
  PetscCall(ContactEnd(m, dt, energy)); /* what that takes is lost in the transfer */
  store_reactions(m, dt);
  PetscCall(ContactForces(m, dt));
  PetscCall(GuessLearn(m, dt));
  PetscCall(LimitWatch(m, dt));
  PetscCall(NoteEntered(m));
  PetscCall(NoteSway(m)); /* of where it began: what is lost then acts in this step */
  WeakFormInput in = weak_form_of(m, 0);
  note_flow(m, -1);
  PetscCall(PassedBegin(m, &before));
  PetscCall(m->formulation->commit(&in, m->points, &status));
  note_flow(m, 1);
  PetscCall(PassedEnd(m, &before));
  PetscCheck(status == LAW_OK, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a converged state could not be committed");
  for (PetscInt node = 0; m->nodes->pressure && node < m->grid->n_nodes; ++node)
    m->nodes->pressure[node] = m->pressure_scale * m->nodes->scaled_pressure[node];
  const NodalScene scene = nodal_scene(m, m->time + dt, m->nodes->du);
  PetscCall(NodalForcesCommit(&m->forces, &scene));
  PetscCall(ContactSurvey(m, dt));
  PetscCall(PhaseEnd(m->seconds, PHASE_COMMIT, &clock));
  PetscFunctionReturn(0);
}

/* Before points move (sign -1) and after it: what they moved by, over dt. Those that have changed their rank, or
 * their place in the list, have taken it with them. */
static void note_mechanism(Model *m, PetscReal sign, PetscReal dt)
{
  for (PetscInt p = 0; m->points->components[POINT_MECHANISM] && p < m->points->n; ++p)
    for (PetscInt d = 0; d < m->dim; ++d) {
      PetscReal *moved = point_real(m->points, POINT_MECHANISM, p) + d;
      *moved = (sign * point_real(m->points, POINT_U, p)[d] + (sign > 0 ? *moved : 0)) / (sign > 0 ? dt : 1);
    }
}

/* A force that is raised beyond what a column bears finds it straight, if the step leads past the place where it begins
 * to bend. */
static void note_unstable(Model *m, PetscReal before, const NewtonReport *newton)
{
  if (m->c->analysis.type != ANALYSIS_STATIC) return;
  const PetscBool goes_on =
    (PetscBool)(m->unstable.ways > 0 && PetscAbsReal(m->unstable.last - before) < 1e-9 * (m->time - before) &&
                newton->negative < 0);
  if (goes_on) m->unstable.last = m->time; /* where nothing changes nobody asks */
  if (newton->negative <= 0) return;
  if (!m->unstable.ways) m->unstable.first = m->time;
  m->unstable.last = m->time;
  m->unstable.ways = PetscMax(m->unstable.ways, newton->negative);
}

/* Sums of steps miss the end by their rounding, and what is short of it by so little is it. Of dynamics, which may go
 * on to a later end, times stay the sums that they would be then. */
static PetscReal time_after(const Model *m, PetscReal dt)
{
  const PetscReal t = m->time + dt, end = m->c->analysis.end;
  return !m->scheme->inertia && t < end && t >= end * (1 - 1e-12) ? end : t;
}

PetscErrorCode ConvectStep(Model *m, PetscReal dt, EnergyStep *energy, StepReport *report)
{
  PetscLogDouble clock;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&clock));
  const PetscBool stays = equilibrium_stays(m);
  note_mechanism(m, -1, dt);
  if (!stays) PetscCall(m->method->convect(m->space));
  note_mechanism(m, 1, dt);
  if (!stays || !m->formulation->pressure) m->space->present = PETSC_FALSE; /* pressures are those of the nodes now */
  PetscCall(PhaseEnd(m->seconds, PHASE_MOVE, &clock));
  m->time = time_after(m, dt);
  ++m->step;
  PetscCall(EnergyClose(m, energy));
  PetscCall(NoteUnloaded(m));
  PetscCall(OutsideAdd(m, report));
  PetscCall(PhaseEnd(m->seconds, PHASE_COMMIT, &clock));
  note_unstable(m, m->time - dt, &report->newton);
  report->outcome = STEP_ACCEPTED;
  report->dt = dt;
  PetscFunctionReturn(0);
}

/* The step in which the fastest point travels as far as it may; without limit where points stay
 * in their cells. */
static PetscReal reach_of(const Model *m, PetscReal speed)
{
  const AnalysisSpec *a = &m->c->analysis;
  const PetscBool flows = m->method->restores_grid && m->scheme->inertia;
  return flows && a->travel > 0 && speed > 0 ? a->travel * m->grid->smallest / speed : PETSC_MAX_REAL;
}

PetscErrorCode ChooseNextStep(Model *m, PetscBool shortened, PetscBool returning, const StepReport *report)
{
  PetscReal fastest = 0, speed;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *v = point_real(m->points, POINT_V, p);
    PetscReal square = 0;
    for (PetscInt d = 0; d < m->dim; ++d) square += v[d] * v[d];
    fastest = PetscMax(fastest, square);
  }
  fastest = PetscMax(fastest, PetscSqr(rigid_fastest(m)));
  PetscCall(MPIU_Allreduce(&fastest, &speed, 1, MPIU_REAL, MPIU_MAX, m->comm));
  const StepTaken taken = {.dt = report->dt,
                           .iterations = report->newton.iterations,
                           .shortened = shortened,
                           .returning = returning,
                           .reach = reach_of(m, PetscSqrtReal(speed))};
  step_control_accept(&m->control, &m->c->analysis, m->c->newton.ease, &taken);
  PetscFunctionReturn(0);
}
