/* What Newton's method found is an equilibrium; whether it is the one that follows from the last
 * state is another question. An implicit step may leap to a solution far away, where a body lies
 * turned over or drawn out to many times its length, and all balances hold there. Such a step is
 * cut: on a shorter one the solution that is connected with the last state is the nearer one
 * (docs/theory.md, "Steps that leap"). */
#include "base/math/tensor.h"
#include "model/model_private.h"

/* in one step, or to that part: a soft column under its weight may be pressed to an eighth; what
 * moves in time stays below 1.5 */
#define MOST_STRETCH 10
#define MOST_STRETCH_IN_TIME 3
#define AWAY 1 /* of the distance in which walls are looked for */
/* of a cell: nothing can be stretched that much */
#define HARDLY_MOVED 0.2
#define HARDLY_MOVED_IN_TIME 0.1

static PetscReal least_motion(const Model *m)
{
  return (m->scheme->inertia ? HARDLY_MOVED_IN_TIME : HARDLY_MOVED) * m->grid->smallest;
}

static PetscReal square_norm(const PetscReal a[9])
{
  PetscReal sum = 0;
  for (int i = 0; i < 9; ++i) sum += a[i] * a[i];
  return sum;
}

/* How much the step stretches or shortens a line at the point, at most: from the sum of squares of
 * all three stretches or their inverses, of which the two others are about 1. */
static PetscReal stretch_of(const Model *m, PetscInt g, PetscInt p)
{
  const Support *w = m->space->support;
  const PetscInt dim = m->dim, nn = support_nodes(w, g), *node = w->node + w->node_start[g];
  const PetscReal *dN = support_dN(w, g, p, dim);
  PetscReal dF[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, inverse[9];
  for (PetscInt I = 0; I < nn; ++I)
    for (PetscInt i = 0; i < dim; ++i)
      for (PetscInt j = 0; j < dim; ++j) dF[3 * i + j] += m->nodes->du[node[I] * dim + i] * dN[I * dim + j];
  tensor_inverse(dF, inverse);
  return PetscSqrtReal(PetscMax(1, PetscMax(square_norm(dF), square_norm(inverse)) - 2));
}

/* Do its nodes move together? Where the step carries all alike nothing is stretched either. */
static PetscBool moves_as_one(const Model *m, PetscInt g)
{
  const Support *w = m->space->support;
  const PetscInt *node = w->node + w->node_start[g];
  PetscReal least[3], most[3], widest = 0;
  for (PetscInt d = 0; d < m->dim; ++d) least[d] = most[d] = m->nodes->du[node[0] * m->dim + d];
  for (PetscInt I = 1; I < support_nodes(w, g); ++I)
    for (PetscInt d = 0; d < m->dim; ++d) {
      const PetscReal du = m->nodes->du[node[I] * m->dim + d];
      least[d] = PetscMin(least[d], du);
      most[d] = PetscMax(most[d], du);
    }
  for (PetscInt d = 0; d < m->dim; ++d) widest = PetscMax(widest, most[d] - least[d]);
  return !m->method->clouds && widest < 2 * least_motion(m);
}

static PetscBool hardly_moved(const Model *m)
{
  PetscReal largest = 0;
  for (PetscInt k = 0; k < m->system->n_active; ++k)
    for (PetscInt d = 0, i = m->system->active[k] * m->dim; d < m->dim; ++d, ++i)
      largest = PetscMax(largest, PetscAbsReal(m->nodes->du[i]));
  return !m->method->clouds && largest < least_motion(m);
}

/* In statics nothing but the length of the step bounds how far a body goes, and walls are looked for within a cell of
 * where it was: beyond that it may have come through one. */
static PetscErrorCode JudgeContact(const Model *m, StepReport *report)
{
  const Contact *s = m->contact;
  PetscReal farthest = 0;

  PetscFunctionBeginUser;
  if (!s || m->scheme->inertia) PetscFunctionReturn(0);
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    farthest = PetscMax(farthest, contact_went(s, c, m->nodes->du));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &farthest, 1, MPIU_REAL, MPIU_MAX, m->comm));
  if (farthest <= AWAY * s->near) PetscFunctionReturn(0);
  snprintf(report->leap, sizeof report->leap,
           "it leapt: what was near a wall or another body went %.3g m, %.2g cells, in one step", (double)farthest,
           (double)(farthest / s->near));
  report->newton.converged = PETSC_FALSE;
  report->newton.reason = report->leap;
  PetscFunctionReturn(0);
}

PetscErrorCode JudgeStep(const Model *m, StepReport *report)
{
  const Support *w = m->space->support;
  struct {
    double stretch;
    int rank;
  } local = {1, 0}, worst;
  PetscInt at = -1;
  PetscReal x[3] = {0, 0, 0};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  local.rank = rank;
  const PetscInt groups = hardly_moved(m) ? 0 : w->n_groups;
  for (PetscInt g = 0; g < groups; ++g) {
    if (moves_as_one(m, g)) continue;
    const PetscBool alike = support_nodes(w, g) == m->dim + 1 && w->n_runs; /* triangles, tetrahedra */
    const PetscInt first = w->point_start[g], end = alike ? first + 1 : w->point_start[g + 1];
    for (PetscInt p = first; p < end; ++p) {
      const PetscReal stretch = stretch_of(m, g, p);
      if (stretch <= local.stretch) continue;
      local.stretch = stretch;
      at = p;
    }
  }
  PetscCallMPI(MPI_Allreduce(&local, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, m->comm));
  if (worst.stretch <= (m->scheme->inertia ? MOST_STRETCH_IN_TIME : MOST_STRETCH)) {
    PetscCall(JudgeContact(m, report));
    PetscFunctionReturn(0);
  }
  for (PetscInt d = 0; d < m->dim && rank == worst.rank; ++d) x[d] = point_real(m->points, POINT_X, at)[d];
  PetscCallMPI(MPI_Bcast(x, 3, MPIU_REAL, worst.rank, m->comm));
  snprintf(report->leap, sizeof report->leap,
           "it leapt: material at (%g, %g, %g) m was stretched %.3g times in one step", (double)x[0], (double)x[1],
           (double)x[2], worst.stretch);
  report->newton.converged = PETSC_FALSE;
  report->newton.reason = report->leap;
  PetscFunctionReturn(0);
}
