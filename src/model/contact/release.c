/* What is remembered as acceleration is of walls' forces what stays: of what rests all that there is. The rest is
 * taken out at the nodes that felt it. */
#include "method/transfer/mass.h"
#include "model/model_private.h"

#define RELEASED 1e-3 /* of what walls have given too much may stay; at rest that is nothing */
#define MOST_SWEEPS 100
#define LUMPED_SHARE 0.1 /* between the mass matrix and the lumped one */

/* lack = what of walls' forces the acceleration at the end of the step has more than their mean, in rates of
 * momentum; accelerations of prescribed dofs stay. */
static PetscErrorCode SumExcess(const Model *m, MassSolve *c)
{
  const Contact *s = m->contact;
  const PetscInt dim = m->dim;

  PetscFunctionBeginUser;
  for (const ContactPoint *p = s->point; p < s->point + s->n; ++p) {
    PetscReal f[3];
    contact_excess(s, p, f);
    for (PetscInt e = p->first; e < p->first + p->n; ++e)
      for (PetscInt d = 0; d < dim; ++d) c->lack[s->node[e] * c->width + ACCELERATION * dim + d] += s->N[e] * f[d];
  }
  PetscCall(GridSumToOwners(m->grid, c->width, c->lack));
  mass_turn(c, c->lack);
  for (PetscInt i = 0; i < m->grid->n_owned * c->width; ++i)
    if (m->nodes->fixed[i / c->width * dim + i % dim]) c->inverse[i] = 0;
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

/* What prescribed dofs do not let go of walls' forces, and what the other nodes let go there, the boundary bears. */
static void release_boundary(Model *m, MassSolve *c, PetscReal lag)
{
  NodalFields *n = m->nodes;
  const PetscInt dim = m->dim;
  for (PetscInt i = 0; i < m->grid->n_owned * c->width; ++i)
    if (!n->fixed[i / c->width * dim + i % dim]) c->lack[i] = 0;
  mass_turn(c, c->lack);
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) {
    const PetscReal more = c->lack[i / dim * c->width + ACCELERATION * dim + i % dim];
    n->rate[i] += more;
    n->held[i] += (1 - lag) * more;
  }
}

PetscErrorCode ContactRelease(Model *m, PetscReal dt)
{
  const PetscReal lag = m->scheme->weights(&m->c->analysis, dt).lag;
  PetscReal enough[MOTIONS], *lumping;
  Discretisation space;
  PetscBool any;
  MassSolve c;

  PetscFunctionBeginUser;
  if (!contact_holds(m)) PetscFunctionReturn(0);
  PetscCall(ContactTouches(m->contact, m->comm, &any));
  if (!any) PetscFunctionReturn(0);
  PetscCall(MassOfExcess(m, &space, &lumping));
  PetscCall(MassSolveCreate(&space, &c));
  c.framed = PETSC_TRUE;
  PetscCall(SumExcess(m, &c));
  PetscCall(MassLack(&c, enough));
  enough[ACCELERATION] *= PetscSqr(RELEASED);
  PetscCall(MassSolveRun(&c, enough, MOST_SWEEPS));
  PetscCall(MassSolveClose(&c));
  release_boundary(m, &c, lag);
  mass_turn(&c, c.x);
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i) {
    const PetscReal excess = c.x[i / m->dim * c.width + ACCELERATION * m->dim + i % m->dim];
    m->nodes->a1[i] -= excess;
    m->nodes->echo[i] -= lag * excess;
  }
  PetscCall(MassSolveDestroy(&c));
  PetscCall(PetscFree(lumping));
  PetscFunctionReturn(0);
}
