#include "wall/wall_private.h"
#include "base/math/tensor.h"
#include "case/motion.h"

/* Rodrigues: R = cos a 1 + sin a [n]x + (1 - cos a) n n. */
static void rotation_matrix(const PetscReal n[3], PetscReal angle, PetscReal R[9])
{
  const PetscReal c = PetscCosReal(angle), s = PetscSinReal(angle), h = PetscSinReal(angle / 2);
  for (int k = 0; k < 9; ++k) R[k] = 2 * h * h * n[k / 3] * n[k % 3] + (k % 4 == 0 ? c : 0);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    R[3 * j + k] -= s * n[i];
    R[3 * k + j] += s * n[i];
  }
}

static void turn(const MotionSpec *m, PetscReal angle, Frame *frame)
{
  PetscReal n[3], R[9], before[9], r[3], norm = 0;
  for (int d = 0; d < 3; ++d) norm += m->axis[d] * m->axis[d];
  for (int d = 0; d < 3; ++d) n[d] = m->axis[d] / PetscSqrtReal(norm), r[d] = frame->T[d] - m->centre[d];
  rotation_matrix(n, angle, R);
  for (int k = 0; k < 9; ++k) before[k] = frame->R[k];
  tensor_multiply(R, before, frame->R);
  for (int d = 0; d < 3; ++d) frame->T[d] = m->centre[d] + R[3 * d] * r[0] + R[3 * d + 1] * r[1] + R[3 * d + 2] * r[2];
}

void frame_at(const Case *c, const WallSpec *wall, PetscReal t, Frame *frame)
{
  *frame = (Frame){.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  for (PetscInt k = 0; k < wall->n_motions; ++k) {
    const MotionSpec *m = wall->motions + k;
    PetscReal moved[3];
    if (m->kind == MOTION_ROTATION) turn(m, motion_angle(c, m, t), frame);
    else {
      motion_increments(c, m, frame->T, m->amplitude.origin, t, moved);
      for (PetscInt d = 0; d < 3; ++d) frame->T[d] += moved[d];
    }
  }
}

void frame_origin(const Frame *frame, const PetscReal x[3], PetscReal X[3])
{
  const PetscReal *R = frame->R, *T = frame->T, r[3] = {x[0] - T[0], x[1] - T[1], x[2] - T[2]};
  for (int d = 0; d < 3; ++d) X[d] = R[d] * r[0] + R[3 + d] * r[1] + R[6 + d] * r[2];
}

void frame_turn(const Frame *frame, const PetscReal V[3], PetscReal v[3])
{
  const PetscReal *R = frame->R;
  for (int d = 0; d < 3; ++d) v[d] = R[3 * d] * V[0] + R[3 * d + 1] * V[1] + R[3 * d + 2] * V[2];
}

void frame_turn_tensor(const Frame *frame, const PetscReal A[9], PetscReal a[9])
{
  PetscReal RA[9];
  tensor_multiply(frame->R, A, RA);
  for (int i = 0; i < 3; ++i) frame_turn(frame, RA + 3 * i, a + 3 * i);
}

/* Motion m turns the increment of those before it. */
static void carry(const Case *c, const MotionSpec *m, PetscReal t1, PetscReal increment[3])
{
  const PetscReal before[3] = {increment[0], increment[1], increment[2]};
  Frame step = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  if (m->kind != MOTION_ROTATION) return;
  turn(m, motion_angle(c, m, t1), &step);
  frame_turn(&step, before, increment);
}

/* Motion k takes y[k] to y[k + 1]. With another increment before it, d, its own is R d and what it
 * adds at y[k + 1]: d' = R d + m(y[k + 1]). Follow x back to where it was before motion n - 1 and all
 * earlier ones, then add increments on the way forth. */
static void increment_of(const Case *c, const WallSpec *wall, PetscInt n, PetscReal t0, PetscReal t1,
                         const PetscReal x[3], PetscReal increment[3])
{
  const PetscInt dim = kinematics_dim(c->kinematics);
  PetscReal before[3] = {0, 0, 0}, own[3];
  for (int d = 0; d < 3; ++d) increment[d] = 0;
  if (!n) return;
  const MotionSpec *last = wall->motions + n - 1;
  if (n > 1) { /* else nothing stood elsewhere before it */
    motion_origin(c, last, x, t0, before);
    for (PetscInt d = dim; d < 3; ++d) before[d] = x[d];
    increment_of(c, wall, n - 1, t0, t1, before, increment);
    carry(c, last, t1, increment);
  }
  motion_increments(c, last, x, t0, t1, own);
  for (int d = 0; d < 3; ++d) increment[d] += own[d];
}

void frame_increment(const Case *c, const WallSpec *wall, PetscReal t0, PetscReal t1, const PetscReal x[3],
                     PetscReal increment[3])
{
  increment_of(c, wall, wall->n_motions, t0, t1, x, increment);
}

PetscInt walls_with_mass(const Case *c)
{
  PetscInt n = 0;
  for (PetscInt k = 0; k < c->n_walls; ++k) n += c->walls[k].has_mass;
  return n;
}

void wall_put(Walls *walls, PetscInt k, const PetscReal R[9], const PetscReal T[3])
{
  Frame *frame = &walls->wall[k].frame;
  for (int i = 0; i < 9; ++i) frame->R[i] = R[i];
  for (int d = 0; d < 3; ++d) frame->T[d] = T[d];
}

void walls_get_frames(const Walls *walls, PetscReal *frames)
{
  for (PetscInt k = 0; k < walls->c->n_walls; ++k) {
    if (!walls->wall[k].spec->has_mass) continue;
    for (int i = 0; i < 12; ++i) *frames++ = i < 9 ? walls->wall[k].frame.R[i] : walls->wall[k].frame.T[i - 9];
  }
}

void walls_put_frames(Walls *walls, const PetscReal *frames)
{
  for (PetscInt k = 0; k < walls->c->n_walls; ++k) {
    if (!walls->wall[k].spec->has_mass) continue;
    wall_put(walls, k, frames, frames + 9);
    frames += 12;
  }
}
