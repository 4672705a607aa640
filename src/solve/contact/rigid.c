#include "solve/contact/rigid.h"
#include "base/math/vector.h"
#include "base/math/tensor.h"
#include "solve/forces/release.h"
#include <math.h>

static void turn(const PetscReal R[9], const PetscReal V[3], PetscReal v[3])
{
  const PetscReal r[3] = {R[0] * V[0] + R[1] * V[1] + R[2] * V[2], R[3] * V[0] + R[4] * V[1] + R[5] * V[2],
                          R[6] * V[0] + R[7] * V[1] + R[8] * V[2]};
  for (int d = 0; d < 3; ++d) v[d] = r[d];
}

static void turn_back(const PetscReal R[9], const PetscReal v[3], PetscReal V[3])
{
  const PetscReal r[3] = {R[0] * v[0] + R[3] * v[1] + R[6] * v[2], R[1] * v[0] + R[4] * v[1] + R[7] * v[2],
                          R[2] * v[0] + R[5] * v[1] + R[8] * v[2]};
  for (int d = 0; d < 3; ++d) V[d] = r[d];
}

/* sin(a) / a and (1 - cos(a)) / a^2, which digits survive of however small an angle. */
static void turn_factors(PetscReal angle, PetscReal *once, PetscReal *twice)
{
  const PetscReal half = angle > 0 ? PetscSinReal(angle / 2) / (angle / 2) : 1;
  *once = angle > 0 ? PetscSinReal(angle) / angle : 1;
  *twice = half * half / 2;
}

static PetscReal size_of(const PetscReal v[3]) { return PetscSqrtReal(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/* exp(t), t the matrix of the cross product by theta: a turn about theta by its size, so that a constant spin turns by
 * what it makes of the time, however long the steps are. */
static void turn_by(const PetscReal theta[3], const PetscReal r[3], PetscReal turned[3])
{
  PetscReal once[3], twice[3], f[2];
  turn_factors(size_of(theta), f, f + 1);
  vector_cross(theta, r, once);
  vector_cross(theta, once, twice);
  for (int d = 0; d < 3; ++d) turned[d] = r[d] + f[0] * once[d] + f[1] * twice[d];
}

static void turn_matrix(const PetscReal theta[3], const PetscReal R[9], PetscReal turned[9])
{
  for (int j = 0; j < 3; ++j) {
    PetscReal column[3] = {R[j], R[3 + j], R[6 + j]};
    turn_by(theta, column, column);
    for (int i = 0; i < 3; ++i) turned[3 * i + j] = column[i];
  }
}

/* --- in space --- */
static PetscBool rotates(const RigidWall *b) { return b->free[5]; } /* all axes that the kinematics have, or none */

/* Spin of a moment of momentum, with the wall turned by R: only about axes that are free. */
static void spin_of(const RigidWall *b, const PetscReal R[9], const PetscReal L[3], PetscReal omega[3])
{
  PetscReal inverse[9], body[3];
  omega[0] = omega[1] = omega[2] = 0;
  if (!rotates(b)) return;
  if (!b->free[3]) {
    omega[2] = L[2] / b->body.inertia[8];
    return;
  }
  tensor_inverse(b->body.inertia, inverse);
  turn_back(R, L, body);
  turn(inverse, body, body);
  turn(R, body, omega);
}

static void moment_of(const RigidWall *b, const PetscReal R[9], const PetscReal omega[3], PetscReal L[3])
{
  PetscReal body[3];
  L[0] = L[1] = L[2] = 0;
  if (!rotates(b)) return;
  if (!b->free[3]) {
    L[2] = b->body.inertia[8] * omega[2];
    return;
  }
  turn_back(R, omega, body);
  turn(b->body.inertia, body, body);
  turn(R, body, L);
}

void rigid_place(const RigidWall *b, Walls *walls)
{
  PetscReal R[9], T[3];
  turn_matrix(b->q + 3, b->now.R, R);
  turn(R, b->body.centre, T);
  for (int d = 0; d < 3; ++d) T[d] = b->body.centre[d] + b->now.moved[d] + b->q[d] - T[d];
  wall_put(walls, b->wall, R, T);
}

void rigid_as_drawn(const RigidWall *b, const PetscReal v[3], PetscReal drawn[3])
{
  PetscReal R[9];
  turn_matrix(b->q + 3, b->now.R, R);
  turn_back(R, v, drawn);
}

static void own_lever(const RigidWall *b, PetscReal part, const PetscReal x[3], PetscReal lever[3])
{
  for (int d = 0; d < 3; ++d) lever[d] = x[d] - b->body.centre[d] - b->now.moved[d] - part * b->q[d];
}

void rigid_arm(const RigidWall *b, PetscBool start, const PetscReal x[3], PetscReal arm[3])
{
  own_lever(b, start ? 0 : 1, x, arm);
}

/* exp(theta + e) = exp(a) exp(theta): a = e + (1 - cos) / |theta|^2 theta x e + (1 - sin / |theta|) / |theta|^2 theta x
 * (theta x e), to first order of e. */
void rigid_turns(const RigidWall *b, int axis, PetscReal a[3])
{
  const PetscReal *theta = b->q + 3, size = size_of(theta), unit[3] = {axis == 0, axis == 1, axis == 2};
  PetscReal once[3], twice[3], f[2];
  turn_factors(size, f, f + 1);
  const PetscReal third = size > 1e-3 ? (1 - f[0]) / (size * size) : 1. / 6 - size * size / 120;
  vector_cross(theta, unit, once);
  vector_cross(theta, once, twice);
  for (int d = 0; d < 3; ++d) a[d] = unit[d] + f[1] * once[d] + third * twice[d];
}

void rigid_lever(const RigidWall *b, const PetscReal x0[3], const PetscReal x1[3], PetscReal lever[3])
{
  PetscReal x[3];
  for (int d = 0; d < 3; ++d) x[d] = x0[d] + b->part * (x1[d] - x0[d]);
  own_lever(b, b->part, x, lever);
}

void rigid_sweep(const RigidWall *b, const PetscReal x0[3], const PetscReal x1[3], PetscReal swept[3])
{
  PetscReal lever[3], turned[3];
  if (b->dt > 0) {
    rigid_lever(b, x0, x1, lever);
    vector_cross(b->q + 3, lever, turned);
    for (int d = 0; d < 3; ++d) swept[d] = b->q[d] + turned[d];
    return;
  }
  own_lever(b, 0, x0, lever);
  turn_by(b->q + 3, lever, turned);
  for (int d = 0; d < 3; ++d) swept[d] = b->q[d] + turned[d] - lever[d];
}

void rigid_velocity(const RigidWall *b, const PetscReal arm[3], PetscReal v[3])
{
  PetscReal omega[3];
  spin_of(b, b->now.R, b->now.L, omega);
  vector_cross(omega, arm, v);
  for (int d = 0; d < 3; ++d) v[d] += b->now.v[d];
}

void rigid_respond(const RigidWall *b, const PetscReal p[RIGID], PetscReal change[RIGID])
{
  for (int d = 0; d < 3; ++d) change[d] = rigid_has(b, d) ? p[d] / b->body.mass : 0;
  spin_of(b, b->now.R, p + 3, change + 3);
  for (int d = 3; d < RIGID; ++d) change[d] *= rigid_has(b, d);
}

PetscReal rigid_kinetic(const RigidWall *b)
{
  PetscReal omega[3], sum = 0;
  spin_of(b, b->now.R, b->now.L, omega);
  for (int d = 0; d < 3; ++d) sum += 0.5 * (b->body.mass * b->now.v[d] * b->now.v[d] + omega[d] * b->now.L[d]);
  return sum;
}

void rigid_push(RigidWall *b, const PetscReal p[RIGID])
{
  const PetscReal before = rigid_kinetic(b);
  for (int d = 0; d < 3; ++d) {
    if (rigid_has(b, d)) b->now.v[d] += p[d] / b->body.mass;
    if (rigid_has(b, d + 3)) b->now.L[d] += p[d + 3];
    b->given[d] -= p[d];
  }
  b->lost += before - rigid_kinetic(b);
}

/* --- a step --- */
static void load_at(const RigidWall *b, const Case *c, PetscReal t, PetscReal load[RIGID])
{
  const WallMassSpec *m = &c->walls[b->wall].mass;
  const PetscReal factor = case_factor(c, &m->amplitude, t), weight = case_factor(c, &c->gravity_amplitude, t);
  const PetscReal share = release_share(c, t);
  for (int d = 0; d < 3; ++d) {
    load[d] = factor * m->force[d] + (m->gravity ? b->body.mass * weight * c->gravity[d] : 0);
    load[d + 3] = factor * m->torque[d];
  }
  for (int i = 0; i < RIGID; ++i) load[i] += share * b->held[i];
}

void rigid_hold(RigidWall *b, const Case *c, PetscReal t, const PetscReal bears[RIGID])
{
  PetscReal load[RIGID];
  for (int i = 0; i < RIGID; ++i) b->held[i] = 0;
  load_at(b, c, t, load);
  for (int i = 0; i < RIGID; ++i) b->held[i] = c->release > 0 ? bears[i] - load[i] : 0;
}

void rigid_begin(RigidWall *b, Walls *walls, const Case *c, PetscReal t, PetscReal dt, PetscReal share,
                 PetscBool middle)
{
  b->dt = case_is_static(&c->analysis) ? 0 : dt;
  b->share = share;
  b->part = b->dt > 0 ? 0.5 : 1;
  b->now.step = dt;
  b->stands = wall_stands(walls, b->wall, t + dt);
  for (int i = 0; i < RIGID * RIGID; ++i) b->borne[i] = 0;
  load_at(b, c, middle ? t + dt / 2 : t, b->load[0]);
  load_at(b, c, middle ? t + dt / 2 : t + dt, b->load[1]);
  rigid_guess(b, walls, PETSC_FALSE);
}

/* Mean of the loads over the step; in statics those of its end. */
static PetscReal load_of(const RigidWall *b, int i)
{
  return b->dt > 0 ? (b->load[0][i] + b->load[1][i]) / 2 : b->load[1][i];
}

void rigid_guess(RigidWall *b, Walls *walls, PetscBool previous)
{
  PetscReal p[RIGID], change[RIGID], omega[3];
  for (int i = 0; i < RIGID; ++i) p[i] = b->dt * load_of(b, i);
  rigid_respond(b, p, change);
  spin_of(b, b->now.R, b->now.L, omega);
  for (int i = 0; i < RIGID; ++i) {
    const PetscReal rate = (i < 3 ? b->now.v[i] : omega[i - 3]) + change[i] / 2;
    b->q[i] = b->dt > 0                       ? b->dt * rate
              : previous && b->start.step > 0 ? b->now.step / b->start.step * b->now.last[i]
                                              : 0;
    if (!rigid_has(b, i)) b->q[i] = 0;
  }
  rigid_place(b, walls);
}

/* R1 J W1 - R J W over dt, of theta = dt (w + w1) / 2. */
static void moment_change(const RigidWall *b, PetscReal rate[3])
{
  PetscReal R1[9], w[3], w1[3], L1[3];
  turn_matrix(b->q + 3, b->now.R, R1);
  spin_of(b, b->now.R, b->now.L, w);
  /* what turns with the wall: W1 = 2 theta / dt - W, and theta is the same before and after */
  turn_by(b->q + 3, w, w1);
  for (int d = 0; d < 3; ++d) w1[d] = 2 * b->q[3 + d] / b->dt - w1[d];
  moment_of(b, R1, w1, L1);
  for (int d = 0; d < 3; ++d) rate[d] = (L1[d] - b->now.L[d]) / b->dt;
}

void rigid_residual(const RigidWall *b, PetscReal r[RIGID])
{
  PetscReal rate[3] = {0, 0, 0}, all[RIGID];
  if (b->dt > 0) moment_change(b, rate);
  for (int i = 0; i < RIGID; ++i) {
    const PetscReal own =
      b->dt > 0 ? (i < 3 ? b->body.mass * 2 * (b->q[i] / b->dt - b->now.v[i]) / b->dt : rate[i - 3]) : 0;
    all[i] = r[i] = rigid_has(b, i) ? own - load_of(b, i) + b->share * b->contact[i] : 0;
  }
  for (int i = 0; i < RIGID * RIGID; ++i) r[i / RIGID] -= b->borne[i] * all[i % RIGID];
}

void rigid_inertia(const RigidWall *b, PetscReal D[RIGID * RIGID])
{
  for (int i = 0; i < RIGID * RIGID; ++i) D[i] = 0;
  if (b->dt == 0) return;
  const PetscReal factor = 2 / (b->dt * b->dt);
  for (int d = 0; d < 3; ++d) D[(RIGID + 1) * d] = factor * b->body.mass;
  for (int j = 0; j < 3; ++j) {
    PetscReal unit[3] = {j == 0, j == 1, j == 2}, L[3];
    moment_of(b, b->now.R, unit, L);
    for (int i = 0; i < 3; ++i) D[RIGID * (3 + i) + 3 + j] = factor * L[i];
  }
}

PetscBool rigid_floats(const RigidWall *b)
{
  PetscReal acts = 0;
  for (int i = 0; i < RIGID; ++i) acts += rigid_has(b, i) ? PetscAbsReal(load_of(b, i)) : 0;
  return b->dt == 0 && acts > 0 && b->size[0] == 0;
}

PetscBool rigid_balances(const RigidWall *b, PetscReal tolerance, PetscReal digit)
{
  PetscReal r[RIGID], lack[2] = {0, 0}, scale[2] = {b->share * b->size[0], b->share * b->size[1]},
                      inertia[RIGID * RIGID];
  rigid_residual(b, r);
  rigid_inertia(b, inertia);
  for (int i = 0; i < RIGID; ++i) {
    lack[i / 3] += r[i] * r[i];
    scale[i / 3] += PetscAbsReal(load_of(b, i));
    /* as far as digits of motion go, whatever acts */
    scale[i / 3] += 1e-12 / tolerance * PetscAbsReal(inertia[(RIGID + 1) * i] * b->q[i]);
  }
  scale[0] += b->share * b->stiff * digit / tolerance;
  scale[1] += scale[0] * (b->body.mass > 0 ? PetscSqrtReal(b->body.inertia[8] / b->body.mass) : 0);
  return PetscSqrtReal(lack[0]) <= tolerance * scale[0] && PetscSqrtReal(lack[1]) <= tolerance * scale[1];
}

/* Its increments become part of where it is. */
static void go(RigidWall *b)
{
  PetscReal R[9];
  turn_matrix(b->q + 3, b->now.R, R);
  for (int i = 0; i < 9; ++i) b->now.R[i] = R[i];
  for (int d = 0; d < 3; ++d) {
    b->now.moved[d] += b->q[d];
    b->now.turned[d] += b->q[3 + d];
  }
  for (int i = 0; i < RIGID; ++i) {
    b->now.last[i] = b->q[i];
    b->q[i] = 0;
  }
}

void rigid_end(RigidWall *b)
{
  PetscReal push[RIGID];
  for (int i = 0; i < RIGID; ++i) {
    const PetscReal load = b->dt > 0 ? load_of(b, i) : (b->load[0][i] + b->load[1][i]) / 2;
    push[i] = b->dt * (load_of(b, i) - b->share * b->contact[i]);
    if (rigid_has(b, i)) b->now.work += load * b->q[i];
  }
  for (int d = 0; d < 3; ++d) {
    if (rigid_has(b, d) && b->dt > 0) b->now.v[d] += push[d] / b->body.mass;
    if (rigid_has(b, d + 3)) b->now.L[d] += push[d + 3];
    b->given[d] += b->dt * b->share * b->contact[d];
  }
  go(b);
}

/* --- when a stage begins --- */
void rigid_move(RigidWall *b, const PetscReal v[3], const PetscReal omega[3])
{
  for (int d = 0; d < 3; ++d) b->now.v[d] = b->free[d] ? v[d] : 0;
  moment_of(b, b->now.R, omega, b->now.L);
  b->start = b->now;
}

/* Where it is drawn. */
static void put(RigidWall *b)
{
  b->now = (RigidState){.work = b->now.work};
  for (int d = 0; d < 3; ++d) b->now.R[4 * d] = 1;
}

/* In statics nothing has a velocity, which dynamics would go on with. */
void rigid_start(RigidWall *b, const Case *c)
{
  const WallMassSpec *mass = &c->walls[b->wall].mass;
  const PetscReal none[3] = {0};
  const PetscBool still = case_is_static(&c->analysis);
  put(b);
  rigid_move(b, still ? none : mass->velocity, still ? none : mass->spin);
}

void rigid_redraw(RigidWall *b, const RigidWall *was)
{
  PetscReal omega[3];
  rigid_spin(was, omega);
  put(b);
  rigid_move(b, was->now.v, omega);
}

/* Its centre of mass may be another one of its matter. */
void rigid_go_on(RigidWall *b, const RigidWall *was)
{
  PetscReal arm[3], v[3], omega[3];
  for (int d = 0; d < 3; ++d) arm[d] = b->body.centre[d] - was->body.centre[d];
  turn(was->now.R, arm, arm);
  rigid_velocity(was, arm, v);
  rigid_spin(was, omega);
  b->now = was->now;
  for (int d = 0; d < 3; ++d) b->now.moved[d] += was->body.centre[d] + arm[d] - b->body.centre[d];
  rigid_move(b, v, omega);
}

void rigid_stop(RigidWall *b)
{
  for (int d = 0; d < 3; ++d) b->now.v[d] = b->now.L[d] = 0;
  for (int i = 0; i < RIGID; ++i) b->now.last[i] = 0;
  b->start = b->now;
}

void rigid_restore(RigidWall *b, Walls *walls)
{
  b->now = b->start;
  for (int i = 0; i < RIGID; ++i) b->q[i] = 0;
  rigid_place(b, walls);
}

/* --- without equations --- */
void rigid_spin(const RigidWall *b, PetscReal omega[3]) { spin_of(b, b->now.R, b->now.L, omega); }

PetscReal rigid_softness(const RigidWall *b, PetscReal lever)
{
  PetscReal inverse[9], square = 0;
  if (!rotates(b)) return 1 / b->body.mass;
  if (!b->free[3]) return 1 / b->body.mass + PetscSqr(lever) / b->body.inertia[8];
  tensor_inverse(b->body.inertia, inverse);
  for (int i = 0; i < 9; ++i) square += PetscSqr(inverse[i]);
  return 1 / b->body.mass + PetscSqr(lever) * PetscSqrtReal(square);
}

void rigid_kick(RigidWall *b, const Case *c, PetscReal t, PetscReal kick)
{
  PetscReal load[RIGID], before[3], after[3];
  load_at(b, c, t, load);
  rigid_spin(b, before);
  for (int d = 0; d < 3; ++d) {
    const PetscReal push = kick * (load[d] - b->contact[d]), v = b->now.v[d];
    if (rigid_has(b, d)) b->now.v[d] += push / b->body.mass;
    if (rigid_has(b, d)) b->now.work += kick * load[d] * (v + b->now.v[d]) / 2;
    if (rigid_has(b, d + 3)) b->now.L[d] += kick * (load[d + 3] - b->contact[d + 3]);
  }
  rigid_spin(b, after);
  for (int d = 0; d < 3; ++d)
    if (rigid_has(b, d + 3)) b->now.work += kick * load[d + 3] * (before[d] + after[d]) / 2;
}

void rigid_drift(RigidWall *b, PetscReal dt)
{
  PetscReal omega[3], half[3], R[9];
  b->dt = dt;
  b->part = 0;
  rigid_spin(b, omega);
  for (int d = 0; d < 3; ++d) half[d] = dt / 2 * omega[d];
  turn_matrix(half, b->now.R, R);
  spin_of(b, R, b->now.L, omega);
  for (int d = 0; d < 3; ++d) {
    b->q[d] = rigid_has(b, d) ? dt * b->now.v[d] : 0;
    b->q[3 + d] = rigid_has(b, d + 3) ? dt * omega[d] : 0;
  }
}

void rigid_go(RigidWall *b, Walls *walls)
{
  go(b);
  rigid_place(b, walls);
}

/* --- making --- */
static void make(RigidWall *b, const Case *c, Walls *walls, Diag *diag)
{
  const WallMassSpec *m = &c->walls[b->wall].mass;
  const PetscBool space = c->kinematics->dim == 3;
  wall_inertia(walls, b->wall, diag, &b->body);
  for (int d = 0; d < 3; ++d) {
    b->free[d] = m->free[d];
    b->free[3 + d] = m->free[3] && (space || d == 2);
  }
  rigid_start(b, c);
}

PetscErrorCode RigidCreate(const Case *c, Walls *walls, Diag *diag, PetscInt *n, RigidWall **rigid)
{
  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt k = 0; k < c->n_walls; ++k) *n += c->walls[k].has_mass;
  PetscCall(PetscCalloc1(*n, rigid));
  *n = 0;
  for (PetscInt k = 0; k < c->n_walls; ++k) {
    if (!c->walls[k].has_mass) continue;
    (*rigid)[*n].wall = k;
    make(*rigid + (*n)++, c, walls, diag);
  }
  PetscFunctionReturn(0);
}
