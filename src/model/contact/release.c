/* What is remembered as acceleration is of walls' forces what stays: of what rests all that there is. The rest is
 * taken out at the nodes that felt it. */
#include "method/transfer/mass.h"
#include "model/model_private.h"

#define RELEASED 1e-3 /* of what walls have given too much may stay; at rest that is nothing */
#define MOST_SWEEPS 100
#define LUMPED_SHARE 0.1 /* between the mass matrix and the lumped one */

/* lack = what of walls' forces the acceleration at the end of the step has more than their mean, in rates of
 * momentum, on owners and in the frames. */
static PetscErrorCode SumExcess(const Model *m, PetscReal *lack)
{
  const Contact *s = m->contact;
  const PetscInt dim = m->dim;

  PetscFunctionBeginUser;
  for (const ContactPoint *p = s->point; p < s->point + s->n; ++p) {
    PetscReal f[3];
    contact_excess(s, p, f);
    for (PetscInt e = p->first; e < p->first + p->n; ++e)
      for (PetscInt d = 0; d < dim; ++d) lack[s->node[e] * dim + d] += s->N[e] * f[d];
  }
  PetscCall(GridSumToOwners(m->grid, dim, lack));
  frames_turn(&m->boundary->frames, dim, lack);
  PetscFunctionReturn(0);
}

/* The mass matrix of the balance; where points carry accelerations to other nodes somewhat lumped, since
 * single forces would be accelerations of both signs of nodes that are hardly reached. */
static PetscErrorCode MassOfExcess(const Model *m, Discretisation *space, PetscReal **lumping)
{
  const PetscInt n = m->space->support->n_groups;

  PetscFunctionBeginUser;
  *space = *m->space;
  *lumping = NULL;
  if (!m->method->restores_grid || !space->lumping) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n, lumping));
  for (PetscInt g = 0; g < n; ++g) (*lumping)[g] = space->lumping[g] + LUMPED_SHARE * (1 - space->lumping[g]);
  space->lumping = *lumping;
  PetscFunctionReturn(0);
}

/* excess = M^-1 lack where nothing is prescribed, in the frames; what is lacking elsewhere stays. */
static PetscErrorCode LetGoByMatrix(const Model *m, PetscReal *lack, PetscReal *excess)
{
  const PetscInt dim = m->dim;
  PetscReal enough[MOTIONS], *lumping;
  Discretisation space;
  MassSolve c;

  PetscFunctionBeginUser;
  PetscCall(MassOfExcess(m, &space, &lumping));
  PetscCall(MassSolveCreate(&space, &c));
  c.framed = PETSC_TRUE;
  for (PetscInt k = 0; k < c.n_reached_owned; ++k)
    for (PetscInt d = 0, i = c.reached[k] * dim; d < dim; ++d, ++i) {
      const PetscInt at = mass_at(&c, c.reached[k], ACCELERATION, d);
      c.lack[at] = lack[i];
      if (m->nodes->fixed[i]) c.inverse[at] = 0;
    }
  PetscCall(MassLack(&c, enough));
  enough[ACCELERATION] *= PetscSqr(RELEASED);
  PetscCall(MassSolveRun(&c, enough, MOST_SWEEPS));
  PetscCall(MassSolveClose(&c));
  for (PetscInt k = 0; k < c.n_reached; ++k)
    for (PetscInt d = 0, i = c.reached[k] * dim; d < dim; ++d, ++i) {
      excess[i] = c.x[mass_at(&c, c.reached[k], ACCELERATION, d)];
      lack[i] = m->nodes->fixed[i] ? c.lack[mass_at(&c, c.reached[k], ACCELERATION, d)] : 0;
    }
  PetscCall(MassSolveDestroy(&c));
  PetscCall(PetscFree(lumping));
  PetscFunctionReturn(0);
}

/* The same by the lumped mass. */
static PetscErrorCode LetGoByNodes(const Model *m, PetscReal *lack, PetscReal *excess)
{
  PetscFunctionBeginUser;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node)
    for (PetscInt i = node * m->dim; i < (node + 1) * m->dim; ++i) {
      if (lack[i] == 0 || m->nodes->fixed[i]) continue;
      excess[i] = lack[i] / m->nodes->mass[node];
      lack[i] = 0;
    }
  PetscCall(GridToGhosts(m->grid, m->dim, excess));
  PetscFunctionReturn(0);
}

/* What prescribed dofs do not let go of walls' forces, and what the other nodes let go there, the boundary bears. */
PetscErrorCode ContactRelease(Model *m, PetscReal dt)
{
  const PetscReal lag = m->scheme->weights(&m->c->analysis, dt).lag;
  const PetscInt nodes = m->grid->n_nodes, dofs = nodes * m->dim;
  PetscReal *lack, *excess;
  PetscBool any;

  PetscFunctionBeginUser;
  if (!contact_holds(m)) PetscFunctionReturn(0);
  PetscCall(ContactTouches(m->contact, m->comm, &any));
  if (!any) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(dofs, &lack, dofs, &excess));
  PetscCall(SumExcess(m, lack));
  if (m->c->analysis.mass == MASS_LUMPED) PetscCall(LetGoByNodes(m, lack, excess));
  else PetscCall(LetGoByMatrix(m, lack, excess));
  frames_turn(&m->boundary->frames, m->dim, lack);
  frames_turn(&m->boundary->frames, m->dim, excess);
  for (PetscInt i = 0; i < dofs; ++i) { /* both are 0 at most nodes */
    if (lack[i] != 0 && i < m->grid->n_owned * m->dim) {
      m->nodes->rate[i] += lack[i];
      m->nodes->held[i] += (1 - lag) * lack[i];
    }
    if (excess[i] == 0) continue;
    m->nodes->a1[i] -= excess[i];
    m->nodes->echo[i] -= lag * excess[i];
  }
  PetscCall(PetscFree2(lack, excess));
  PetscFunctionReturn(0);
}
