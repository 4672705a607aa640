/* Contact as walls with mass feel it: forces and torques, and the borders of the tangent. */
#include "solve/contact/contact.h"
#include "base/math/svd.h"
#include "base/math/vector.h"

#define SUMS (RIGID + 4)
#define DIGITS 100   /* round-off of a tangent whose parts cancel */
#define NOTHING 1e-6 /* share of all loads: what acts no more than that is round-off, too */

static void cross_axis(int axis, const PetscReal r[3], PetscReal c[3])
{
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  c[axis] = 0, c[j] = -r[k], c[k] = r[j];
}

/* What a unit of unknown i moves at the end of an arm. */
static void motion_of(int i, const PetscReal arm[3], PetscReal motion[3])
{
  motion[0] = motion[1] = motion[2] = 0;
  if (i < 3) motion[i] = 1;
  else cross_axis(i - 3, arm, motion);
}

PetscErrorCode RigidSums(Contact *s, const NodalScene *scene)
{
  PetscReal *sum;

  PetscFunctionBeginUser;
  if (!s->n_rigid) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(SUMS * s->n_rigid, &sum));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const RigidWall *b = contact_rigid(s, c);
    PetscReal f[3], x[3], lever[3], motion[3], force = 0, torque = 0;
    if (!b) continue;
    PetscReal *own = sum + SUMS * (b - s->rigid);
    contact_acts(c, f);
    contact_place(s, c, scene->du, scene->whole, x);
    rigid_lever(b, c->x, x, lever);
    own[RIGID + 2] += c->law.penalty;
    own[RIGID + 3] += c->law.penalty * vector_dot(lever, lever);
    for (int i = 0; i < RIGID; ++i) {
      motion_of(i, lever, motion);
      const PetscReal along = vector_dot(motion, f);
      own[i] += along;
      if (i < 3) force += along * along;
      else torque += along * along;
    }
    own[RIGID] += PetscSqrtReal(force);
    own[RIGID + 1] += PetscSqrtReal(torque);
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(SUMS * s->n_rigid), MPIU_REAL, MPI_SUM, scene->grid->comm));
  for (PetscInt k = 0; k < s->n_rigid; ++k) {
    RigidWall *b = s->rigid + k;
    for (int i = 0; i < RIGID; ++i) b->contact[i] = sum[SUMS * k + i];
    for (int i = 0; i < 2; ++i) b->size[i] = sum[SUMS * k + RIGID + i];
    b->stiff = sum[SUMS * k + RIGID + 2];
    b->twist = sum[SUMS * k + RIGID + 3];
  }
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(0);
}

PetscErrorCode RigidHold(Contact *s, const NodalScene *scene)
{
  PetscReal *bears;

  PetscFunctionBeginUser;
  if (!s || !s->n_rigid) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(RIGID * s->n_rigid, &bears));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const RigidWall *b = contact_rigid(s, c);
    PetscReal arm[3], motion[3];
    if (!b || c->before == CONTACT_OPEN || c->gone) continue;
    rigid_arm(b, PETSC_TRUE, c->x, arm);
    for (int i = 0; i < RIGID; ++i) {
      motion_of(i, arm, motion);
      bears[RIGID * (b - s->rigid) + i] += vector_dot(motion, c->last);
    }
  }
  PetscCall(
    MPIU_Allreduce(MPI_IN_PLACE, bears, (PetscMPIInt)(RIGID * s->n_rigid), MPIU_REAL, MPI_SUM, scene->grid->comm));
  for (PetscInt k = 0; k < s->n_rigid; ++k) rigid_hold(s->rigid + k, scene->c, scene->t, bears + RIGID * k);
  PetscCall(PetscFree(bears));
  PetscFunctionReturn(0);
}

/* One contact point: its force f, tangent, and levers. */
typedef struct {
  const ContactPoint *c;
  ContactTangent tangent;
  PetscReal f[3], motion[RIGID][3], arm[RIGID][3], change[RIGID][3]; /* arm: by the lever of torques */
} Touch;

static PetscBool touch_of(const Contact *s, ContactPoint *c, const RigidWall *b, const NodalScene *scene, Touch *t)
{
  PetscReal x[3], at[3], lever[3];
  if (!contact_meets(s, c, scene, &t->tangent)) return PETSC_FALSE;
  t->c = c;
  contact_force(c, t->f);
  contact_place(s, c, scene->du, scene->whole, x);
  rigid_arm(b, PETSC_FALSE, x, at);
  rigid_lever(b, c->x, x, lever);
  for (int i = 0; i < RIGID; ++i) {
    PetscReal axis[3] = {0, 0, 0}, let[3], counts[3], turned[3];
    if (i > 2) rigid_turns(b, i - 3, axis);
    vector_cross(axis, at, t->motion[i]);
    if (i < 3) t->motion[i][i] = 1;
    motion_of(i, lever, t->arm[i]);
    vector_cross(axis, c->normal, turned); /* with the wall, and the force with it */
    contact_lets(c, t->motion[i], let);
    for (int d = 0; d < 3; ++d) counts[d] = t->motion[i][d] - let[d];
    for (int d = 0; d < 3; ++d)
      t->change[i][d] = vector_dot(t->tangent.K + 3 * d, counts) - vector_dot(t->tangent.turn + 3 * d, turned);
  }
  return PETSC_TRUE;
}

/* Of the wall's own residual what forces change by: without their levers. */
static void add_resistance(const RigidWall *b, const Touch *t, PetscReal M[RIGID * RIGID])
{
  for (int i = 0; i < RIGID; ++i)
    for (int j = 0; j < RIGID; ++j)
      if (rigid_has(b, i) && rigid_has(b, j)) M[RIGID * i + j] += b->share * vector_dot(t->arm[i], t->change[j]);
}

/* By the wall's unknowns j: forces on nodes, and its own residual. */
static void add_columns(const Contact *s, const RigidWall *b, const Touch *t, PetscInt dofs, PetscReal *B, PetscReal *D)
{
  const PetscInt n = RIGID * s->n_rigid, first = RIGID * (b - s->rigid);
  for (int j = 0; j < RIGID; ++j) {
    if (!rigid_has(b, j)) continue;
    for (PetscInt e = t->c->first; e < t->c->first + t->c->n; ++e)
      for (PetscInt d = 0; d < s->dim; ++d)
        B[(first + j) * dofs + s->node[e] * s->dim + d] -= s->N[e] * t->change[j][d];
    for (int i = 0; i < RIGID; ++i) {
      PetscReal more[3] = {0, 0, 0}; /* the lever is shorter by what the centre has moved */
      if (j < 3 && i > 2) cross_axis(j, t->f, more);
      D[(first + i) * n + first + j] +=
        b->share * (vector_dot(t->arm[i], t->change[j]) - b->part * (i > 2 ? more[i - 3] : 0));
    }
  }
}

/* Of the wall's residual i: by the increments of nodes. */
static void add_rows(const Contact *s, const RigidWall *b, const Touch *t, PetscReal whole, PetscInt dofs, PetscReal *C)
{
  const PetscInt first = RIGID * (b - s->rigid);
  for (int i = 0; i < RIGID; ++i)
    for (PetscInt d = 0; d < s->dim; ++d) {
      const PetscReal *K = t->tangent.K, column[3] = {K[d], K[3 + d], K[6 + d]};
      PetscReal longer[3] = {0, 0, 0};
      if (!rigid_has(b, i)) continue;
      if (i > 2) cross_axis((int)d, t->f, longer);
      const PetscReal rate = b->share * whole * (b->part * (i > 2 ? longer[i - 3] : 0) - vector_dot(t->arm[i], column));
      for (PetscInt e = t->c->first; e < t->c->first + t->c->n; ++e)
        C[(first + i) * dofs + s->node[e] * s->dim + d] += s->N[e] * rate;
    }
}

/* What makes a length of a rotation: the usual lever of what is near, m. */
static PetscReal lever_of(const RigidWall *b, int i)
{
  return i > 2 && b->stiff > 0 && b->twist > 0 ? PetscSqrtReal(b->twist / b->stiff) : 1;
}

/* By how many digits levers are wrong where the origin is far away. */
static PetscReal digits_of(const RigidWall *b)
{
  PetscReal centre[3];
  for (int d = 0; d < 3; ++d) centre[d] = b->body.centre[d] + b->now.moved[d];
  return DIGITS * PETSC_MACHINE_EPSILON * (1 + PetscSqrtReal(vector_dot(centre, centre)) / lever_of(b, 3));
}

/* Do loads act along v as the wall was drawn, or only since it has tilted? */
static PetscBool acts_as_drawn(const RigidWall *b, const PetscReal v[RIGID])
{
  PetscReal drawn[RIGID], along = 0, acts = 0;
  rigid_as_drawn(b, v, drawn);
  rigid_as_drawn(b, v + 3, drawn + 3);
  for (int i = 0; i < RIGID; ++i) {
    along += drawn[i] * b->load[1][i] / lever_of(b, i);
    acts += PetscAbsReal(b->load[1][i]) / lever_of(b, i);
  }
  return (PetscBool)(PetscAbsReal(along) > NOTHING * acts);
}

/* v, of unit length where rotations are lengths, is held. What acts along it is told; but for what does so as the wall
 * tilts, which a hold bears. */
static void hold_motion(RigidWall *b, const PetscReal v[RIGID], PetscInt n, PetscReal *D)
{
  const PetscBool acts = acts_as_drawn(b, v);
  PetscReal r[RIGID], along = 0;
  rigid_residual(b, r);
  for (int i = 0; i < RIGID; ++i) along += v[i] * r[i] / lever_of(b, i);
  for (int i = 0; i < RIGID; ++i) {
    if (acts) b->adrift[i] -= along * v[i] * lever_of(b, i);
    for (int j = 0; j < RIGID; ++j) {
      D[i * n + j] += b->stiff * v[i] * lever_of(b, i) * v[j] * lever_of(b, j);
      if (!acts) b->borne[RIGID * i + j] += v[i] * lever_of(b, i) * v[j] / lever_of(b, j);
    }
  }
}

/* In statics: motions that change forces of contact, M (6 x 6), by no more than digits are held where they are, as if
 * what is near pushed them back, in D (rows of n numbers). That levers change is no resistance: a plate that tilts went
 * along itself to where it does not tilt, an equilibrium on its head. */
static void hold(RigidWall *b, const PetscReal M[RIGID * RIGID], PetscInt n, PetscReal *D)
{
  PetscReal A[RIGID * RIGID], V[RIGID * RIGID], v[RIGID];
  for (int i = 0; i < RIGID; ++i) {
    b->adrift[i] = 0;
    for (int j = 0; j < RIGID; ++j) b->borne[RIGID * i + j] = 0;
    for (int j = 0; j < RIGID; ++j) A[RIGID * i + j] = M[RIGID * i + j] / (lever_of(b, i) * lever_of(b, j));
  }
  svd_turn(RIGID, A, V);
  for (int j = 0; j < RIGID && b->dt == 0; ++j) {
    PetscReal square = 0;
    for (int i = 0; i < RIGID; ++i) square += PetscSqr(A[RIGID * i + j]), v[i] = V[RIGID * i + j];
    if (rigid_has(b, j) && square <= PetscSqr(digits_of(b) * b->stiff)) hold_motion(b, v, n, D);
  }
}

int rigid_adrift(const RigidWall *b)
{
  PetscReal acts = 0;
  int most = -1;
  for (int i = 0; i < RIGID; ++i) acts += PetscAbsReal(b->load[1][i]) / lever_of(b, i);
  for (int i = 0; i < RIGID && b->dt == 0 && acts > 0; ++i) {
    const PetscReal so = PetscAbsReal(b->adrift[i]) / lever_of(b, i);
    if (so > NOTHING * acts && (most < 0 || so > PetscAbsReal(b->adrift[most]) / lever_of(b, most))) most = i;
  }
  return most;
}

PetscErrorCode RigidTangent(Contact *s, const NodalScene *scene, PetscReal *B, PetscReal *C, PetscReal *D)
{
  const PetscInt n = RIGID * s->n_rigid, dofs = scene->grid->n_nodes * s->dim;

  PetscReal *M;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(D, n * n));
  PetscCall(PetscCalloc1(RIGID * n, &M));
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const RigidWall *b = contact_rigid(s, c);
    Touch t;
    if (!b || !touch_of(s, c, b, scene, &t)) continue;
    add_resistance(b, &t, M + RIGID * RIGID * (b - s->rigid));
    add_columns(s, b, &t, dofs, B, D);
    add_rows(s, b, &t, scene->whole, dofs, C);
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, D, (PetscMPIInt)(n * n), MPIU_REAL, MPI_SUM, scene->grid->comm));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, M, (PetscMPIInt)(RIGID * n), MPIU_REAL, MPI_SUM, scene->grid->comm));
  for (PetscInt k = 0; k < s->n_rigid; ++k) {
    RigidWall *b = s->rigid + k;
    PetscReal own[RIGID * RIGID];
    hold(b, M + RIGID * RIGID * k, n, D + RIGID * k * (n + 1));
    rigid_inertia(b, own);
    for (int i = 0; i < RIGID; ++i)
      for (int j = 0; j < RIGID; ++j) {
        PetscReal *entry = D + (RIGID * k + i) * n + RIGID * k + j;
        if (rigid_has(b, i) && rigid_has(b, j)) *entry += own[RIGID * i + j];
        else *entry = i == j;
      }
  }
  PetscCall(PetscFree(M));
  PetscFunctionReturn(0);
}
