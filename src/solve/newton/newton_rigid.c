/* Walls with mass: a few unknowns more, q, and as many equations.
 *
 *   R(u, q) = 0,   r(u, q) = inertia(q) - loads + contact = 0
 *
 * Each direction of Newton's method takes them along, with K y = R and K Z = B = dR/dq:
 *
 *   (D - C Z) dq = -r + C y,   du = -(y + Z dq),   C = dr/du, D = dr/dq,
 *
 * a solve more for each unknown of a wall that something touches, with the factors that are there. */
#include "solve/contact/contact.h"
#include "solve/newton/newton_private.h"
#include <petsctime.h>

typedef struct {
  PetscInt n;
  PetscReal *B, *C, *D; /* n x dofs twice, n x n */
  PetscReal *r;
  PetscBool *touched; /* n: does the unknown move any node? */
  Vec *Z, c;
} Border;

static PetscInt unknowns(const Newton *n)
{
  const Contact *s = n->problem->scene.contact;
  return s ? RIGID * s->n_rigid : 0;
}

/* Nodal vectors of all ranks as one of unknowns. */
static PetscErrorCode ToVec(const Newton *n, PetscReal *nodes, Vec v)
{
  const StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim, block = p->system->block;
  PetscReal *to;

  PetscFunctionBeginUser;
  PetscCall(GridSumToOwners(p->grid, dim, nodes));
  newton_turn(p, nodes);
  PetscCall(VecSet(v, 0));
  PetscCall(VecGetArray(v, &to));
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt d = 0, i = p->system->active[k] * dim; d < dim; ++d, ++i)
      to[k * block + d] = p->fixed[i] ? 0 : nodes[i];
  PetscCall(VecRestoreArray(v, &to));
  PetscFunctionReturn(0);
}

/* D - C Z, and -r + C y. */
static PetscErrorCode Condense(Newton *n, Border *b, Vec y)
{
  const PetscInt dofs = n->problem->grid->n_nodes * n->problem->grid->dim;
  PetscReal value;
  KSP ksp;

  PetscFunctionBeginUser;
  PetscCall(SNESGetKSP(n->snes, &ksp));
  for (PetscInt j = 0; j < b->n; ++j) {
    PetscCall(ToVec(n, b->B + j * dofs, b->c));
    PetscCall(VecNorm(b->c, NORM_INFINITY, &value));
    b->touched[j] = value > 0;
    if (!b->touched[j]) continue;
    PetscCall(VecDuplicate(b->c, &b->Z[j]));
    PetscCall(PetscTime(&n->solving));
    PetscCall(KSPSolve(ksp, b->c, b->Z[j]));
  }
  for (PetscInt i = 0; i < b->n; ++i) {
    PetscCall(ToVec(n, b->C + i * dofs, b->c));
    PetscCall(VecDot(b->c, y, &value));
    b->r[i] = value - b->r[i];
    for (PetscInt j = 0; j < b->n; ++j) {
      if (!b->touched[j]) continue;
      PetscCall(VecDot(b->c, b->Z[j], &value));
      b->D[i * b->n + j] -= value;
    }
  }
  PetscFunctionReturn(0);
}

/* Gauss with pivots: r := D^-1 r. What nothing holds, and nothing is near to, stays where it is. */
static void solve_dense(PetscInt n, PetscReal *D, PetscReal *r)
{
  for (PetscInt k = 0; k < n; ++k) {
    PetscInt pivot = k;
    for (PetscInt i = k + 1; i < n; ++i)
      if (PetscAbsReal(D[i * n + k]) > PetscAbsReal(D[pivot * n + k])) pivot = i;
    for (PetscInt j = 0; j < n; ++j) {
      const PetscReal swap = D[k * n + j];
      D[k * n + j] = D[pivot * n + j], D[pivot * n + j] = swap;
    }
    const PetscReal swap = r[k];
    r[k] = r[pivot], r[pivot] = swap;
    for (PetscInt i = k + 1; i < n && D[k * n + k] != 0; ++i) {
      const PetscReal factor = D[i * n + k] / D[k * n + k];
      for (PetscInt j = k; j < n; ++j) D[i * n + j] -= factor * D[k * n + j];
      r[i] -= factor * r[k];
    }
  }
  for (PetscInt k = n - 1; k >= 0; --k) {
    for (PetscInt j = k + 1; j < n; ++j) r[k] -= D[k * n + j] * r[j];
    r[k] = D[k * n + k] != 0 ? r[k] / D[k * n + k] : 0;
  }
}

PetscErrorCode NewtonRigidBegin(Newton *n, Vec y)
{
  StepProblem *p = n->problem;
  const PetscInt all = unknowns(n), dofs = p->grid->n_nodes * p->grid->dim;
  Contact *s = p->scene.contact;
  Border b = {.n = all};

  PetscFunctionBeginUser;
  if (!all) PetscFunctionReturn(0);
  PetscCall(PetscCalloc6(all * dofs, &b.B, all * dofs, &b.C, all * all, &b.D, all, &b.r, all, &b.touched, all, &b.Z));
  PetscCall(VecDuplicate(n->x, &b.c));
  PetscCall(RigidTangent(s, &p->scene, b.B, b.C, b.D)); /* which says what is held */
  for (PetscInt k = 0; k < s->n_rigid; ++k) rigid_residual(s->rigid + k, b.r + RIGID * k);
  PetscCall(Condense(n, &b, y));
  solve_dense(all, b.D, b.r);
  PetscCall(PetscRealloc((size_t)(2 * all) * sizeof *n->rigid, &n->rigid));
  for (PetscInt j = 0; j < all; ++j) {
    n->rigid[2 * j] = s->rigid[j / RIGID].q[j % RIGID];
    n->rigid[2 * j + 1] = b.r[j];
    if (!b.touched[j]) continue;
    PetscCall(VecAXPY(y, b.r[j], b.Z[j]));
    PetscCall(VecDestroy(&b.Z[j]));
  }
  PetscCall(VecDestroy(&b.c));
  PetscCall(PetscFree6(b.B, b.C, b.D, b.r, b.touched, b.Z));
  PetscFunctionReturn(0);
}

void newton_rigid_place(const Newton *n, PetscReal length)
{
  const PetscInt all = unknowns(n);
  for (PetscInt j = 0; j < all; ++j)
    n->problem->scene.contact->rigid[j / RIGID].q[j % RIGID] = n->rigid[2 * j] + length * n->rigid[2 * j + 1];
  newton_rigid_set(n, NULL);
}

void newton_rigid_get(const Newton *n, PetscReal *q)
{
  const PetscInt all = unknowns(n);
  for (PetscInt j = 0; j < all; ++j) q[j] = n->problem->scene.contact->rigid[j / RIGID].q[j % RIGID];
}

void newton_rigid_set(const Newton *n, const PetscReal *q)
{
  Contact *s = n->problem->scene.contact;
  const PetscInt all = unknowns(n);
  for (PetscInt j = 0; q && j < all; ++j) s->rigid[j / RIGID].q[j % RIGID] = q[j];
  for (PetscInt k = 0; k < all / RIGID; ++k) rigid_place(s->rigid + k, s->walls);
}

PetscReal newton_rigid_work(void *context)
{
  const Newton *n = context;
  const Contact *s = n->problem->scene.contact;
  PetscReal sum = 0, r[RIGID];
  for (PetscInt k = 0; s && k < s->n_rigid; ++k) {
    rigid_residual(s->rigid + k, r);
    for (int i = 0; i < RIGID; ++i) sum -= n->rigid[2 * (RIGID * k + i) + 1] * r[i] / s->rigid[k].share;
  }
  return sum;
}

PetscBool newton_rigid_met(const Newton *n)
{
  const Contact *s = n->problem->scene.contact;
  const Grid *grid = n->problem->grid;
  PetscReal size = 0;
  for (PetscInt d = 0; d < grid->dim; ++d)
    size = PetscMax(size, PetscMax(PetscAbsReal(grid->min[d]), PetscAbsReal(grid->max[d])));
  for (PetscInt k = 0; s && k < s->n_rigid; ++k)
    if (!rigid_balances(s->rigid + k, n->spec.residual, PETSC_MACHINE_EPSILON * size)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Does nothing hold the wall, and has nothing done so in the last step? A footing that is near its body may have lost
 * it on the way. */
static PetscBool is_loose(const Contact *s, const RigidWall *wall)
{
  const PetscReal *f = s->wall[wall->wall].mean.force;
  const PetscBool held = (PetscBool)(f[0] != 0 || f[1] != 0 || f[2] != 0);
  return (PetscBool)(rigid_floats(wall) && (wall->stiff == 0 || !held));
}

/* What it is near to may not hold it, or the iteration has lost what would. */
static void tell_loose(const RigidWall *wall, const char *name, size_t room, char *text)
{
  snprintf(text, room, "the wall with mass '%s' touches nothing%s", name,
           wall->stiff > 0
             ? " where the iteration ended, near as it is to a body: nothing holds it, it slides off, or it "
               "needs its weight before what friction holds (an `amplitude` that begins later)"
             : ", and in statics nothing else holds it");
}

static void tell_adrift(int i, const char *name, size_t room, char *text)
{
  snprintf(text, room, "a %s %c acts on the wall with mass '%s', and in statics nothing resists it",
           i < 3 ? "force along" : "torque about", "xyz"[i % 3], name);
}

const char *newton_rigid_reason(Newton *n)
{
  const Contact *s = n->problem->scene.contact;
  for (PetscInt k = 0; s && k < s->n_rigid; ++k) {
    const RigidWall *wall = s->rigid + k;
    const char *name = n->problem->scene.c->walls[wall->wall].name;
    const int adrift = rigid_floats(wall) ? -1 : rigid_adrift(wall);
    if (is_loose(s, wall)) tell_loose(wall, name, sizeof n->loose, n->loose);
    else if (adrift >= 0) tell_adrift(adrift, name, sizeof n->loose, n->loose);
    else continue;
    return n->loose;
  }
  return NULL;
}
