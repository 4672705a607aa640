/* Pseudo-time: a way to an equilibrium that Newton's method has lost (Kelley and Keyes 1998; docs/theory.md, section
 * 77). Nodes go from one place to the next as if their inertia held them back,
 *
 *   R(u_(k+1)) + c0 M (u_(k+1) - y_k) = 0,   y_k = u_k + s / (s + 3) (u_k - u_(k-1)),
 *
 * each of them found by Newton's method, with c0 such that a wave would cross some cells on the way, and more and more
 * of them as long as that is easy; y goes ahead of u (Nesterov 1983; s counts since it began), and begins anew where
 * forces are farther from balance than before. What stands comes to rest, and c0 is taken away; what does not goes
 * farther than what stands would, or on and on for as much as it lacks. Strains are those since the start of the step:
 * which of several equilibria is found may depend on the way, and nothing else does. */
#include "model/model_private.h"

/* cells that a wave crosses: Newton's method converges in nearly all of dynamics with the first; with the least it will
 * not converge at all */
#define FIRST_WAVES 10
#define LEAST_WAVES 0.5
#define FASTER 1.5 /* so many times as far after no more iterations than these, */
#define EASY 9
#define SLOWER (1.0 / 3) /* and where it failed; */
#define RECOVERS 2       /* how far it may go then grows by this after so many successes */
#define RECOVERS_AFTER 3
/* Of what inertia stood in for the last time: more exact need the next place not be. */
#define ROUGHLY 0.1
/* Without inertia the next place is sought where forces lack so much of what they lacked at first, or when that was
 * tried in vain: at once if a place took few iterations, else (contacts take some each time) if they lack far less. */
#define BALANCED 1e-2
#define FAR_LESS 1e-2
#define AT_REST 2
#define MOST 600 /* iterations */
/* What has gone so many times as far as when it was looked at last, and lacks so much of what it lacked then, flows:
 * resisting no more than that, it would come to rest after many times the way, if ever. */
#define FARTHER 4
#define LACKS_AS_MUCH 0.9
#define SEEN_FROM (1.0 / 32) /* of how far it may go: before that stresses only settle */

typedef struct {
  PetscReal *at, *before, *ahead; /* u_k, u_(k-1), y_k: n_nodes x dim, m */
  PetscReal *pressure;            /* mixed: n_nodes */
  PetscReal waves, bound;
  PetscReal lack, first; /* what inertia stands in for, m/s2: the last time, the first */
  PetscReal in_vain;     /* the same when the place without inertia was not found */
  PetscReal force;       /* of the last time, N */
  PetscReal seen[2];     /* how far it had gone, m, and what it lacked, when it was looked at last */
  PetscInt gone, good;   /* since y began, and since one failed */
  PetscBool rests;       /* is the next place sought without inertia? */
} PseudoTime;

static PetscErrorCode Create(const Model *m, PseudoTime *t)
{
  const PetscInt nodes = m->grid->n_nodes, dofs = nodes * m->dim;

  PetscFunctionBeginUser;
  *t = (PseudoTime){.waves = FIRST_WAVES, .bound = PETSC_MAX_REAL, .in_vain = PETSC_MAX_REAL};
  PetscCall(PetscCalloc4(dofs, &t->at, dofs, &t->before, dofs, &t->ahead, nodes, &t->pressure));
  if (m->nodes->scaled_pressure) {
    pressure_guess(m);
    PetscCall(PetscArraycpy(t->pressure, m->nodes->scaled_pressure, nodes));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(PseudoTime *t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(t->at, t->before, t->ahead, t->pressure));
  PetscFunctionReturn(0);
}

static void look_ahead(PetscInt n, PseudoTime *t)
{
  const PetscReal share = t->rests ? 0 : (PetscReal)t->gone / ((PetscReal)t->gone + 3);
  for (PetscInt i = 0; i < n; ++i) t->ahead[i] = t->at[i] + share * (t->at[i] - t->before[i]);
}

/* What stands beside c0 du in the balance of forces (set_history). */
static void hold_back(Model *m, PetscReal inertia, const PetscReal *to)
{
  for (PetscInt node = 0; node < m->grid->n_nodes; ++node) {
    if (!node_moves(m, node)) continue;
    for (PetscInt d = 0, i = node * m->dim; d < m->dim; ++d, ++i)
      m->nodes->history[i] = -m->gravity[d] - inertia * to[i];
  }
}

/* What inertia stands in for: root of the mean square over all mass, and the norm of its forces. */
static PetscErrorCode Lack(const Model *m, PetscReal inertia, const PetscReal *to, PetscReal *lack, PetscReal *force)
{
  PetscReal local[3] = {0, 0, 0}, sum[3];

  PetscFunctionBeginUser;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    const PetscReal mass = m->nodes->mass[node];
    local[0] += mass;
    for (PetscInt d = 0, i = node * m->dim; d < m->dim; ++d, ++i) {
      const PetscReal a = inertia * (m->nodes->du[i] - to[i]);
      local[1] += mass * a * a;
      local[2] += mass * mass * a * a;
    }
  }
  PetscCall(MPIU_Allreduce(local, sum, 3, MPIU_REAL, MPI_SUM, m->comm));
  *lack = sum[0] > 0 ? PetscSqrtReal(sum[1] / sum[0]) : 0;
  *force = PetscSqrtReal(sum[2]);
  PetscFunctionReturn(0);
}

/* Newton's method from y_k on to the next place. */
static PetscErrorCode Seek(Model *m, StepProblem *p, const LinearProblem *linear, PseudoTime *t, StepReport *report)
{
  const PetscInt nodes = m->grid->n_nodes, dofs = nodes * m->dim;

  PetscFunctionBeginUser;
  p->in.inertia = t->rests ? 0 : PetscSqr(m->courant_speed / (t->waves * m->grid->smallest));
  p->enough = t->rests ? 0 : ROUGHLY * t->force;
  look_ahead(dofs, t);
  hold_back(m, p->in.inertia, t->ahead);
  PetscCall(PetscArraycpy(m->nodes->du, t->ahead, dofs));
  if (m->nodes->scaled_pressure) PetscCall(PetscArraycpy(m->nodes->scaled_pressure, t->pressure, nodes));
  PetscCall(NewtonSolve(m->newton, p, linear, &report->newton));
  PetscFunctionReturn(0);
}

static PetscErrorCode GoOn(Model *m, PetscReal inertia, PetscInt iterations, PseudoTime *t)
{
  const PetscInt nodes = m->grid->n_nodes, dofs = nodes * m->dim;
  const PetscReal lacked = t->lack;

  PetscFunctionBeginUser;
  PetscCall(Lack(m, inertia, t->ahead, &t->lack, &t->force));
  PetscCall(PetscArraycpy(t->before, t->at, dofs));
  PetscCall(PetscArraycpy(t->at, m->nodes->du, dofs));
  if (m->nodes->scaled_pressure) PetscCall(PetscArraycpy(t->pressure, m->nodes->scaled_pressure, nodes));
  t->gone = t->first > 0 && t->lack > lacked ? 0 : t->gone + 1;
  if (t->first == 0) t->first = t->lack;
  if (++t->good % RECOVERS_AFTER == 0) t->bound *= RECOVERS;
  if (iterations <= EASY) t->waves = PetscMin(t->bound, FASTER * t->waves);
  const PetscReal little = BALANCED * PetscMin(t->first, t->in_vain);
  t->rests = (PetscBool)(t->lack < (iterations <= AT_REST ? 1 : FAR_LESS) * little);
  PetscFunctionReturn(0);
}

/* Is what inertia stands in for below what the case's own tolerance lets be out of balance, and was the place found as
 * exactly? Where things touch, it may be none that Newton's method finds at once: multipliers begin anew each time. */
static PetscBool is_balanced(const Model *m, const StepProblem *p, const PseudoTime *t)
{
  return (PetscBool)(t->force + p->enough <= m->c->newton.residual * p->weight);
}

static void go_back(PseudoTime *t)
{
  t->gone = t->good = 0;
  if (t->rests) t->in_vain = t->lack;
  else {
    t->waves *= SLOWER;
    t->bound = 2 * t->waves;
  }
  t->rests = PETSC_FALSE;
}

static PetscBool flows(PseudoTime *t, PetscReal moved, PetscReal reach)
{
  if (moved < PetscMax(SEEN_FROM * reach, FARTHER * t->seen[0])) return PETSC_FALSE;
  const PetscBool lacks = (PetscBool)(t->seen[0] > 0 && t->lack > LACKS_AS_MUCH * t->seen[1]);
  t->seen[0] = moved;
  t->seen[1] = t->lack;
  return lacks;
}

/* Farther than what stands? In the first try all that yields moves at once, as far as it has to. */
static PetscBool goes_too_far(Model *m, PetscReal moved, StepReport *report)
{
  const PetscBool first = (PetscBool)(m->strength.by >= m->strength.factor);
  return (PetscBool)(!first && strength_slides(&m->strength, moved, report));
}

static void tell_flow(const PseudoTime *t, PetscReal moved, StepReport *report)
{
  snprintf(report->leap, sizeof report->leap, "it flows: %.2g m/s2 were missing when it had gone %.3g m",
           (double)t->lack, (double)moved);
  report->newton.reason = report->leap;
  report->newton.converged = PETSC_FALSE;
  report->flows = PETSC_TRUE;
}

PetscErrorCode PseudoTimeSolve(Model *m, StepProblem *p, const LinearProblem *linear, StepReport *report)
{
  NewtonReport *newton = &report->newton;
  PetscInt iterations = 0;
  PetscBool found = PETSC_FALSE;
  PetscReal moved;
  PseudoTime t;

  PetscFunctionBeginUser;
  PetscCall(Create(m, &t));
  while (iterations < MOST && t.waves > LEAST_WAVES) {
    const PetscBool rested = t.rests;
    PetscCall(Seek(m, p, linear, &t, report));
    iterations += newton->iterations;
    if (newton->interrupted) break;
    if (!newton->converged) {
      go_back(&t);
      continue;
    }
    PetscCall(LargestIncrement(m, &moved));
    PetscCall(GoOn(m, p->in.inertia, newton->iterations, &t));
    found = (PetscBool)(rested || is_balanced(m, p, &t));
    if (!found && goes_too_far(m, moved, report)) report->flows = PETSC_TRUE;
    else if (!found && flows(&t, moved, m->strength.reach)) tell_flow(&t, moved, report);
    if (found || report->flows) break;
  }
  hold_back(m, 0, t.at);
  newton->iterations = iterations;
  if (!found && !report->flows && !newton->interrupted) newton->reason = "it neither rests nor flows";
  newton->converged = found;
  PetscCall(Destroy(&t));
  PetscFunctionReturn(0);
}
