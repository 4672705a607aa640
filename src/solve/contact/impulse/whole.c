/* Impulses by the whole mass matrix, that of the balance, so that the change of motion is that of least energy
 * there: lumped it would be less, and bodies of few cells would gain what the difference is.
 *
 *   1/2 d M d + 1/2 q W q + 1/2 p S p -> min,    S p = lack - (A d - B q),
 *
 * d of nodes, q of walls with mass W, S the softening: conjugate gradients over d and q, of
 *
 *   M d = A^T p,    W q = -B^T p. */
#include "solve/contact/impulse/impulse.h"

#define MOST_SWEEPS 400
#define ENOUGH 1e-9 /* of what is lacking, in the norm of the preconditioner */

/* Over nodes, n_nodes x dim, and over walls: changes of motion and, `pushed`, times W. */
typedef struct {
  PetscReal *nodes, *walls, *pushed;
} Change;

typedef struct {
  Projection *w;
  PetscInt dofs, walls;
  Change found, lack, direction, product, step; /* step: the preconditioned lack */
  PetscReal *inverse;                           /* n_nodes x dim: of the diagonal */
  PetscReal *z;                                 /* 3 per contact point */
  PetscBool coupled;                            /* or M alone */
} Whole;

static PetscErrorCode Create(Projection *w, PetscBool coupled, Whole *x)
{
  PetscFunctionBeginUser;
  *x = (Whole){.w = w, .coupled = coupled, .dofs = w->m->grid->n_nodes * w->s->dim, .walls = RIGID * w->s->n_rigid};
  Change *all[] = {&x->found, &x->lack, &x->direction, &x->product, &x->step};
  for (int k = 0; k < 5; ++k)
    PetscCall(PetscCalloc3(x->dofs, &all[k]->nodes, x->walls, &all[k]->walls, x->walls, &all[k]->pushed));
  PetscCall(PetscCalloc2(x->dofs, &x->inverse, 3 * w->s->n, &x->z));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Whole *x)
{
  Change *all[] = {&x->found, &x->lack, &x->direction, &x->product, &x->step};

  PetscFunctionBeginUser;
  for (int k = 0; k < 5; ++k) PetscCall(PetscFree3(all[k]->nodes, all[k]->walls, all[k]->pushed));
  PetscCall(PetscFree2(x->inverse, x->z));
  PetscFunctionReturn(0);
}

/* Of the matrix, and of what impulses oppose. */
static PetscErrorCode FindDiagonal(Whole *x)
{
  const Contact *s = x->w->s;
  const PetscInt dim = s->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(x->inverse, x->dofs));
  for (PetscInt k = 0; k < s->n && x->coupled; ++k) {
    const ContactPoint *c = s->point + k;
    const PetscReal hard = x->w->held[k] ? 1 / (x->w->softened * x->w->own[k]) : 0;
    for (PetscInt e = c->first; e < c->first + c->n; ++e)
      for (PetscInt d = 0; d < dim; ++d)
        x->inverse[s->node[e] * dim + d] +=
          hard * PetscSqr(s->N[e]) * (x->w->held[k] == 3 ? 1 : PetscSqr(c->normal[d]));
  }
  PetscCall(GridSumToOwners(x->w->m->grid, dim, x->inverse));
  for (PetscInt i = 0; i < x->w->m->grid->n_owned * dim; ++i) {
    const PetscReal diagonal = x->w->m->whole->diagonal[i / dim];
    x->inverse[i] = diagonal > 1e-300 ? 1 / (diagonal + x->inverse[i]) : 0;
  }
  PetscFunctionReturn(0);
}

/* What impulses make of such changes: z = (`of` lack - (A nodes - B walls)) / S. */
static void impulses_of(const Whole *x, PetscReal of, const PetscReal *nodes, const PetscReal *walls, PetscReal *z)
{
  const Projection *w = x->w;
  for (PetscInt k = 0; k < w->s->n; ++k) {
    PetscReal moves[3], answer[3], lack[3];
    for (int d = 0; d < 3; ++d) z[3 * k + d] = 0;
    if (!w->held[k]) continue;
    for (int d = 0; d < 3; ++d) lack[d] = of * w->lack[3 * k + d];
    impulse_hold(w, k, lack);
    impulse_gather(w, nodes, k, moves);
    impulse_answer(w, walls, k, answer);
    for (int d = 0; d < 3; ++d) z[3 * k + d] = (lack[d] - moves[d] + answer[d]) / (w->softened * w->own[k]);
  }
}

/* to += A^T z, on owners; `product` of the walls: -B^T z. */
static PetscErrorCode Spread(Whole *x, const PetscReal *z, PetscReal *to, PetscReal *pushed)
{
  Projection *w = x->w;
  const Contact *s = w->s;
  PetscReal *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(x->dofs, &sum));
  for (PetscInt k = 0; k < s->n; ++k)
    for (PetscInt e = s->point[k].first; w->held[k] && e < s->point[k].first + s->point[k].n; ++e)
      for (PetscInt d = 0; d < s->dim; ++d) sum[s->node[e] * s->dim + d] += s->N[e] * z[3 * k + d];
  PetscCall(GridSumToOwners(w->m->grid, s->dim, sum));
  for (PetscInt i = 0; i < w->m->grid->n_owned * s->dim; ++i) to[i] += sum[i];
  PetscCall(PetscFree(sum));
  PetscCall(ImpulsesToWalls(w, z));
  PetscCall(PetscArraycpy(pushed, w->push, x->walls));
  PetscFunctionReturn(0);
}

static PetscErrorCode Multiply(Whole *x, const Change *c, Change *product)
{
  const ContactMass *whole = x->w->m->whole;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(product->nodes, x->dofs));
  if (x->coupled) {
    impulses_of(x, 0, c->nodes, c->walls, x->z);
    PetscCall(Spread(x, x->z, product->nodes, product->pushed));
  }
  PetscCall(whole->multiply(whole->context, c->nodes, x->step.nodes));
  for (PetscInt i = 0; i < x->w->m->grid->n_owned * x->w->s->dim; ++i)
    product->nodes[i] = x->step.nodes[i] - product->nodes[i];
  for (PetscInt i = 0; i < x->walls && x->coupled; ++i) product->pushed[i] = c->pushed[i] - product->pushed[i];
  impulse_free(x->w->m, x->w->s->dim, product->nodes);
  PetscFunctionReturn(0);
}

/* sum = a b, of walls in motion and momentum. */
static PetscErrorCode Dot(const Whole *x, const Change *a, const Change *b, PetscReal *sum)
{
  const PetscReal local = impulse_dot(x->w->m->grid->n_owned * x->w->s->dim, a->nodes, b->nodes);

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(&local, sum, 1, MPIU_REAL, MPI_SUM, x->w->m->grid->comm));
  if (x->coupled) *sum += impulse_dot(x->walls, a->walls, b->pushed);
  PetscFunctionReturn(0);
}

/* step = lack over the diagonal. */
static void precondition(Whole *x)
{
  const Contact *s = x->w->s;
  for (PetscInt i = 0; i < x->w->m->grid->n_owned * s->dim; ++i) x->step.nodes[i] = x->inverse[i] * x->lack.nodes[i];
  impulse_free(x->w->m, s->dim, x->step.nodes);
  for (PetscInt k = 0; k < s->n_rigid; ++k)
    rigid_respond(s->rigid + k, x->lack.pushed + RIGID * k, x->step.walls + RIGID * k);
  for (PetscInt i = 0; i < x->walls; ++i) x->step.pushed[i] = x->lack.pushed[i];
}

static void add_to(const Whole *x, PetscReal factor, const Change *a, Change *sum)
{
  for (PetscInt i = 0; i < x->dofs; ++i) sum->nodes[i] += factor * a->nodes[i];
  for (PetscInt i = 0; i < x->walls && x->coupled; ++i) {
    sum->walls[i] += factor * a->walls[i];
    sum->pushed[i] += factor * a->pushed[i];
  }
}

/* From the lack that there is, until it is so little of what `all` was, its square at the beginning. */
static PetscErrorCode Sweeps(Whole *x, PetscReal all)
{
  const Projection *w = x->w;
  PetscReal rr, pq, before = 0;

  PetscFunctionBeginUser;
  for (int sweep = 0; sweep < MOST_SWEEPS; ++sweep) {
    precondition(x);
    PetscCall(Dot(x, &x->step, &x->lack, &rr));
    if (rr <= ENOUGH * ENOUGH * all) break;
    const PetscReal grow = before > 0 ? rr / before : 0;
    before = rr;
    for (PetscInt i = 0; i < x->dofs; ++i) x->direction.nodes[i] *= grow;
    for (PetscInt i = 0; i < x->walls; ++i) x->direction.walls[i] *= grow, x->direction.pushed[i] *= grow;
    add_to(x, 1, &x->step, &x->direction);
    PetscCall(GridToGhosts(w->m->grid, w->s->dim, x->direction.nodes));
    PetscCall(Multiply(x, &x->direction, &x->product));
    PetscCall(Dot(x, &x->direction, &x->product, &pq));
    if (pq <= 0) break;
    add_to(x, rr / pq, &x->direction, &x->found);
    add_to(x, -rr / pq, &x->product, &x->lack);
  }
  PetscFunctionReturn(0);
}

/* lack = A^T p, and the norm that ends the sweeps. */
static PetscErrorCode Begin(Whole *x, const PetscReal *p, PetscReal *all)
{
  PetscFunctionBeginUser;
  PetscCall(FindDiagonal(x));
  PetscCall(Spread(x, p, x->lack.nodes, x->lack.pushed));
  impulse_free(x->w->m, x->w->s->dim, x->lack.nodes);
  precondition(x);
  PetscCall(Dot(x, &x->step, &x->lack, all));
  PetscFunctionReturn(0);
}

PetscErrorCode ImpulsesWhole(Projection *w)
{
  PetscReal all;
  Whole x;

  PetscFunctionBeginUser;
  PetscCall(Create(w, PETSC_TRUE, &x));
  impulses_of(&x, 1, x.found.nodes, x.found.walls, w->p);
  PetscCall(Begin(&x, w->p, &all));
  PetscCall(Sweeps(&x, all));
  impulses_of(&x, 1, x.found.nodes, x.found.walls, w->p);
  PetscCall(PetscArraycpy(w->nodes, x.found.nodes, x.dofs));
  PetscCall(Destroy(&x));
  PetscFunctionReturn(0);
}

/* What the solve leaves goes to the nodes by their lumped mass: so momentum is that of the impulses. */
static void close_momentum(Whole *x)
{
  const ContactMotion *m = x->w->m;
  const PetscInt dim = x->w->s->dim;
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i)
    if (m->mass[i / dim] > 1e-300) x->found.nodes[i] += x->lack.nodes[i] / m->mass[i / dim];
}

PetscErrorCode ImpulsesWholeSpread(Projection *w, const PetscReal *p)
{
  PetscReal all;
  Whole x;

  PetscFunctionBeginUser;
  PetscCall(Create(w, PETSC_FALSE, &x));
  PetscCall(Begin(&x, p, &all));
  PetscCall(PetscArraycpy(x.found.nodes, w->nodes, x.dofs));
  PetscCall(Multiply(&x, &x.found, &x.product));
  add_to(&x, -1, &x.product, &x.lack);
  PetscCall(Sweeps(&x, all));
  close_momentum(&x);
  PetscCall(PetscArraycpy(w->nodes, x.found.nodes, x.dofs));
  PetscCall(GridToGhosts(w->m->grid, w->s->dim, w->nodes));
  PetscCall(Destroy(&x));
  PetscFunctionReturn(0);
}
