/* Equilibrium before the first step (docs/theory.md, "Initial state"): time stands still, and what forces
 * lack of balance is taken away, all at once or, where Newton's method does not follow, part by part. */
#include "model/model_private.h"
#include "model/start/initial_stress.h"

#define ROUNDS 60
#define LEAST 1e-3 /* share of what is lacking that is taken away at once */
/* another round that leaves more of what was lacking brings nothing: on a grid that is restored points
 * that have moved give other nodes what they bear */
#define WORTH 0.5

/* What forces lack at nodes that are free, before anything moves: n_nodes x dim, owners count. */
static PetscErrorCode Lack(Model *m, StepProblem *p, PetscReal *force, PetscReal *lack)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  PetscReal *acting, *external;
  WeakFormOutput out = {.force = force};

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(dofs, &acting, dofs, &external));
  pressure_guess(m);
  PetscCall(m->formulation->assemble(&p->in, &out));
  PetscCall(NodalForcesAssemble(p->forces, &p->scene, &(NodalOutput){.force = external}));
  for (PetscInt i = 0; i < dofs; ++i) force[i] += external[i];
  PetscCall(GridSumToOwners(m->grid, m->dim, force));
  PetscCall(GridSumToOwners(m->grid, m->dim, external));
  PetscCall(NodalForcesExternal(p->forces, &p->scene, PETSC_TRUE, acting));
  frames_turn(&m->boundary->frames, m->dim, force);
  frames_turn(&m->boundary->frames, m->dim, external);
  frames_turn(&m->boundary->frames, m->dim, acting);
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    force[i] -= p->external[i];
    external[i] = p->external[i] - external[i];
  }
  PetscCall(LackOfBalance(m, &(AtRest){p->fixed, force, external, acting, p->weight}, lack));
  PetscCall(PetscFree2(acting, external));
  PetscFunctionReturn(0);
}

PetscErrorCode EquilibriumPrepare(Model *m, StepProblem *p)
{
  PetscReal *force;

  PetscFunctionBeginUser;
  if (!m->initial.seeking) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(m->grid->n_nodes * m->dim, &force));
  PetscCall(Lack(m, p, force, &m->initial.left));
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) m->nodes->external[i] += (1 - m->initial.share) * force[i];
  PetscCall(PetscFree(force));
  PetscFunctionReturn(0);
}

PetscBool equilibrium_stays(const Model *m) { return m->initial.seeking && m->c->initial.reset; }

/* Of point p in the step, m2. */
static PetscReal motion2(const Model *m, PetscInt g, PetscInt p)
{
  const Support *w = m->space->support;
  const PetscInt *node = w->node + w->node_start[g];
  PetscReal square = 0;
  for (PetscInt d = 0; d < m->dim; ++d) {
    PetscReal move = 0;
    for (PetscInt i = 0; i < support_nodes(w, g); ++i)
      move += support_N(w, g, p)[i] * m->nodes->du[node[i] * m->dim + d];
    square += move * move;
  }
  return square;
}

/* The farthest that material has moved in the step. On a grid that is restored nodes are not material: those outside of
 * the body, which splines reach far away from it, move more than it does. */
static PetscErrorCode LargestMotion(const Model *m, PetscReal *largest)
{
  const Support *w = m->space->support;
  PetscReal square = 0;

  PetscFunctionBeginUser;
  if (!m->method->restores_grid) {
    PetscCall(LargestIncrement(m, largest));
    PetscFunctionReturn(0);
  }
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) square = PetscMax(square, motion2(m, g, p));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &square, 1, MPIU_REAL, MPIU_MAX, m->comm));
  *largest = PetscSqrtReal(square);
  PetscFunctionReturn(0);
}

/* Points that stay where they are keep their volume: the J of their strain belongs to a smaller or larger
 * undeformed one. */
static PetscErrorCode Close(Model *m, const PetscReal *J)
{
  PetscReal moved;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n && m->c->initial.reset; ++p)
    point_compress(m->points, p, J[p], m->points->real[POINT_J][p]);
  PetscCall(LargestMotion(m, &moved));
  m->initial.moved += moved;
  m->initial.parts += 1;
  PetscFunctionReturn(0);
}

/* One step in which no time passes. */
static PetscErrorCode Round(Model *m, StepReport *report)
{
  PetscReal *J;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m->points->n, &J));
  PetscCall(PetscArraycpy(J, m->points->real[POINT_J], m->points->n));
  m->control.next = m->c->analysis.step;
  PetscCall(ModelStep(m, m->control.next, report));
  m->time = 0;
  m->step = 0;
  m->initial.iterations += (PetscReal)(report->newton.iterations + report->newton.lost);
  if (report->outcome == STEP_ACCEPTED) PetscCall(Close(m, J));
  PetscCall(PetscFree(J));
  PetscFunctionReturn(0);
}

/* Until nothing is lacking, in shares of what is. *lacked: at the start of it. */
static PetscErrorCode Settle(Model *m, PetscReal *lacked, StepReport *report)
{
  InitialState *s = &m->initial;
  PetscReal before = PETSC_MAX_REAL;
  PetscInt rounds = 0;

  PetscFunctionBeginUser;
  s->share = 1;
  for (PetscBool first = PETSC_TRUE;; first = PETSC_FALSE) {
    PetscCall(Round(m, report));
    if (first) *lacked = s->left;
    if (report->outcome == STEP_INTERRUPTED || report->outcome == STEP_POINTS_LOST) break;
    if (report->outcome != STEP_ACCEPTED) {
      if (s->share <= LEAST) break;
      s->share *= 0.5;
      continue;
    }
    if (s->left <= m->c->newton.residual || ++rounds >= ROUNDS / s->share) break;
    if (s->left > WORTH * before && (!m->c->initial.reset || rounds > ROUNDS / 4)) break;
    before = s->share == 1 ? s->left : PETSC_MAX_REAL;
    s->share = PetscMin(1, 2 * s->share);
  }
  PetscFunctionReturn(0);
}

/* First the equilibrium of bodies that do not yield: it always exists, and what the strength takes away
 * from its stresses is the rest. */
static PetscErrorCode SettleElastic(Model *m, PetscReal *lacked, StepReport *report)
{
  const size_t size = sizeof *m->materials * (size_t)m->c->n_materials;
  Material *kept;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc(size, &kept));
  PetscCall(PetscMemcpy(kept, m->materials, size));
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if (m->materials[i].law->reduce) material_reduce(&m->materials[i], 0);
  PetscCall(Settle(m, lacked, report));
  PetscCall(PetscMemcpy(m->materials, kept, size));
  PetscCall(PetscFree(kept));
  PetscFunctionReturn(0);
}

/* All accounts begin with this state. */
static PetscErrorCode Begin(Model *m)
{
  PetscFunctionBeginUser;
  m->external_work = m->boundary_work = m->damped_energy = m->transfer_energy = m->friction_energy = 0;
  m->numerical_energy = m->held_energy = m->open_energy = 0;
  for (PetscInt k = 0; m->contact && k < m->contact->n_partners; ++k) m->contact->wall[k].friction = 0;
  m->limit = (Softening){0};
  m->guess = (Guess){0};
  m->cuts = 0;
  m->tries = (Tries){0};
  newton_forget(m->newton, m->system, &(NewtonMemory){.courant = -1}); /* its matrix had no inertia */
  step_control_start(&m->control, m->c->analysis.step);
  if (m->method->restores_grid) m->space->present = PETSC_FALSE;
  PetscCall(ModelInitialise(m));
  if (m->scheme->inertia) {
    PetscCall(PetscArrayzero(m->points->real[POINT_A], m->points->n * m->dim));
    PetscCall(InitialAcceleration(m));
  }
  PetscCall(EnergyStart(m));
  PetscCall(ContactStand(m));
  for (PetscInt k = 0; k < m->c->n_measures; ++k) PetscCall(MeasureBegin(m, k)); /* they have seen what was given */
  PetscFunctionReturn(0);
}

PetscErrorCode ModelEquilibrate(Model *m, StepReport *report)
{
  const TimeScheme *scheme = m->scheme;
  PetscReal lacked;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(report, sizeof *report));
  if (m->c->initial.equilibrium <= EQUILIBRIUM_NONE) PetscFunctionReturn(0);
  m->scheme = time_scheme_of(&(AnalysisSpec){.type = ANALYSIS_STATIC});
  m->initial.seeking = PETSC_TRUE;
  m->initial.moved = 0;
  if (m->c->initial.equilibrium == EQUILIBRIUM_ELASTIC_FIRST) {
    PetscCall(SettleElastic(m, &m->initial.lacked, report));
    m->initial.elastic_parts = m->initial.parts;
    if (report->outcome == STEP_ACCEPTED) PetscCall(Settle(m, &lacked, report));
  } else PetscCall(Settle(m, &m->initial.lacked, report));
  m->initial.seeking = PETSC_FALSE;
  m->scheme = scheme;
  if (report->outcome == STEP_ACCEPTED) PetscCall(Begin(m));
  PetscFunctionReturn(0);
}

/* Laws whose strength nobody can take away go through the first half as they are. */
static void warn_of_yielding(const Model *m, Diag *diag)
{
  for (PetscInt i = 0; i < m->c->n_materials && m->c->initial.equilibrium == EQUILIBRIUM_ELASTIC_FIRST; ++i) {
    const Law *law = m->materials[i].law;
    if (!law->yields || law->reduce) continue;
    diag_warning(diag, "initial.equilibrium", "'%s' yields from the start: the law %s has no form that does not yield",
                 m->c->materials[i].name, law->name);
    diag_hint(diag, "for it `elastic-plastic` is `direct`");
  }
}

void equilibrium_check(const Model *m, Diag *diag)
{
  const Case *c = m->c;
  char path[64];
  if (!case_equilibrates(c)) return;
  warn_of_yielding(m, diag);
  if (m->method->clouds)
    diag_error(diag, "initial.equilibrium",
               "method %s does not seek an equilibrium before its first step: mpm and fem do", m->method->name);
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    const BodySpec *body = &c->bodies[b];
    PetscReal moves = 0;
    if (body->absent) continue;
    for (int d = 0; d < 3; ++d) moves += PetscAbsReal(body->velocity[d]) + PetscAbsReal(body->spin[d]);
    PetscSNPrintf(path, sizeof path, "bodies[%d]", (int)b);
    if (moves > 0) diag_error(diag, path, "'%s' moves at the start: what moves is in no equilibrium", body->name);
  }
}
