#include "case/motion.h"

/* Displacement that the entry asks for at time t, in component d; zero at the start whatever the
 * amplitude. */
static PetscReal displacement_at(const Case *c, const MotionSpec *m, PetscInt d, PetscReal t)
{
  if (t <= m->amplitude.origin) return 0;
  return m->value[d] * case_factor(c, &m->amplitude, t);
}

/* Integral of the amplitude up to time t; what moves in another way than it is sought stands still then. */
static PetscReal span_until(const Case *c, const MotionSpec *m, PetscReal t)
{
  return amplitude_integral(&m->amplitude, case_time(c, t), 1);
}

/* Turn x about the axis through centre by the angle: displacement. */
static void rotation(const MotionSpec *m, PetscInt dim, const PetscReal *x, PetscReal angle, PetscReal u[3])
{
  PetscReal r[3] = {0, 0, 0}, axis[3] = {0, 0, 1}, norm = 0, along = 0;
  for (PetscInt i = 0; i < dim; ++i) r[i] = x[i] - m->centre[i];
  if (dim == 3)
    for (PetscInt i = 0; i < 3; ++i) axis[i] = m->axis[i];
  for (PetscInt i = 0; i < 3; ++i) norm += axis[i] * axis[i];
  norm = PetscSqrtReal(norm);
  for (PetscInt i = 0; i < 3; ++i) along += (axis[i] /= norm) * r[i];
  /* Rodrigues: r' = r cos + (n x r) sin + n (n.r)(1 - cos); 1 - cos without cancellation */
  const PetscReal s = PetscSinReal(angle / 2), sine = PetscSinReal(angle), one_less_cos = 2 * s * s;
  for (PetscInt d = 0; d < 3; ++d) {
    const PetscInt j = (d + 1) % 3, k = (d + 2) % 3;
    const PetscReal cross = axis[j] * r[k] - axis[k] * r[j];
    u[d] = sine * cross + one_less_cos * (axis[d] * along - r[d]);
  }
}

PetscReal motion_angle(const Case *c, const MotionSpec *m, PetscReal t) { return m->rate * span_until(c, m, t); }

/* Of what does not turn: wherever it is. */
static PetscReal shift(const Case *c, const MotionSpec *m, PetscInt d, PetscReal t0, PetscReal t1)
{
  if (m->kind == MOTION_DISPLACEMENT) return displacement_at(c, m, d, t1) - displacement_at(c, m, d, t0);
  return m->kind == MOTION_VELOCITY ? m->value[d] * (span_until(c, m, t1) - span_until(c, m, t0)) : 0;
}

void motion_increments(const Case *c, const MotionSpec *m, const PetscReal *x, PetscReal t0, PetscReal t1,
                       PetscReal increment[3])
{
  if (m->kind == MOTION_ROTATION) {
    const PetscReal angle = m->rate * (span_until(c, m, t1) - span_until(c, m, t0));
    rotation(m, kinematics_dim(c->kinematics), x, angle, increment);
    return;
  }
  for (PetscInt d = 0; d < 3; ++d) increment[d] = shift(c, m, d, t0, t1);
}

PetscReal motion_increment(const Case *c, const MotionSpec *m, const PetscReal *x, PetscInt d, PetscReal t0,
                           PetscReal t1)
{
  PetscReal increment[3];
  if (m->kind != MOTION_ROTATION) return shift(c, m, d, t0, t1);
  motion_increments(c, m, x, t0, t1, increment);
  return increment[d];
}

void motion_origin(const Case *c, const MotionSpec *m, const PetscReal *x, PetscReal t, PetscReal *X)
{
  const PetscInt dim = kinematics_dim(c->kinematics);
  const PetscReal span = span_until(c, m, t);
  PetscReal moved[3] = {0, 0, 0};
  if (m->kind == MOTION_ROTATION) rotation(m, dim, x, -m->rate * span, moved); /* back */
  for (PetscInt d = 0; d < dim; ++d) {
    if (m->kind == MOTION_DISPLACEMENT && m->component[d]) moved[d] = -displacement_at(c, m, d, t);
    if (m->kind == MOTION_VELOCITY && m->component[d]) moved[d] = -m->value[d] * span;
    X[d] = x[d] + moved[d];
  }
}
