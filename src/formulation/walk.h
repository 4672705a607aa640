/* What the formulations share in their walk over the points: batches of one material, and the
 * acceptance of a step. */
#pragma once
#include "base/math/tensor.h"
#include "formulation/formulation.h"
#include "material/pressure.h"

/* Points of one material, as many as one call of the law takes. */
typedef struct {
  PetscInt first, n, end; /* points first .. first + n - 1; no further than end */
  PetscInt group;         /* of the first */
  PetscBool keeps_state;  /* will the new state be asked for? */
  PetscReal dF[9 * LAW_BATCH], p[LAW_BATCH];
  PetscReal arc[9 * LAW_BATCH]; /* what the law gets of dF in the middle of a step */
  PetscReal old[LAW_MAX_STATE * LAW_BATCH], state[LAW_MAX_STATE * LAW_BATCH];
  PressureStress s; /* without an unknown pressure tau and c alone */
} Batch;

/* Before the first batch of a run. */
static inline void batch_begin(const SupportRun *run, const Support *support, PetscBool keeps_state, Batch *b)
{
  b->first = support->point_start[run->first];
  b->end = support->point_start[run->end];
  b->group = run->first;
  b->n = 0;
  b->keeps_state = keeps_state;
}

/* PETSC_FALSE if there is none. */
static inline PetscBool batch_next(const WeakFormInput *in, Batch *b)
{
  const PetscInt *material = in->points->material;
  b->first += b->n;
  if (b->first >= b->end) return PETSC_FALSE;
  while (b->first >= in->support->point_start[b->group + 1]) ++b->group;
  for (b->n = 1; b->n < LAW_BATCH && b->first + b->n < b->end; ++b->n)
    if (material[b->first + b->n] != material[b->first]) break;
  return PETSC_TRUE;
}

static inline const Material *batch_material(const WeakFormInput *in, const Batch *b)
{
  return &in->materials[in->points->material[b->first]];
}

/* State at the start of the step, packed. */
static inline const PetscReal *batch_old(const WeakFormInput *in, Batch *b)
{
  const PetscInt n_state = batch_material(in, b)->law->n_state, stride = in->points->components[POINT_STATE];
  const PetscReal *old = in->points->real[POINT_STATE] + b->first * stride;
  if (stride == n_state) return old;
  for (PetscInt k = 0; k < b->n; ++k)
    for (PetscInt s = 0; s < n_state; ++s) b->old[k * n_state + s] = old[k * stride + s];
  return b->old;
}

/* Would a ring of the batch turn inside out across its axis? */
static inline PetscBool batch_crosses_axis(const WeakFormInput *in, const Batch *b)
{
  for (PetscInt k = 0; in->kinematics->hoop && k < b->n; ++k)
    if (b->dF[9 * k + 8] <= 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* What a rotation makes of the middle of a chord, cos(theta / 2) R(theta / 2), back to the middle of the arc. With w,
 * the axial vector of the increment's spin at the middle, |w| = tan(theta / 2), it is (1 + w.w - w w^T)^(1/2) dF: what
 * stretches without a turn stays (docs/theory.md, "The midpoint rule"). */
static inline void chord_to_arc(const PetscReal dF[9], PetscReal arc[9])
{
  PetscReal inverse[9];
  tensor_inverse(dF, inverse);
  const PetscReal w[3] = {0.5 * (inverse[5] - inverse[7]), 0.5 * (inverse[6] - inverse[2]),
                          0.5 * (inverse[1] - inverse[3])};
  const PetscReal square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2], more = 1 / (1 + PetscSqrtReal(1 + square));
  for (int j = 0; j < 3; ++j) {
    const PetscReal along = w[0] * dF[j] + w[1] * dF[3 + j] + w[2] * dF[6 + j];
    for (int i = 0; i < 3; ++i) arc[3 * i + j] = dF[3 * i + j] + more * (square * dF[3 * i + j] - along * w[i]);
  }
}

/* What the law gets of the increments b->dF. */
static inline const PetscReal *batch_strains(const WeakFormInput *in, Batch *b)
{
  if (!in->middle) return b->dF;
  for (PetscInt k = 0; k < b->n; ++k) chord_to_arc(b->dF + 9 * k, b->arc + 9 * k);
  return b->arc;
}

/* Call the law on the increments b->dF. */
static inline LawStatus batch_law(const WeakFormInput *in, PetscBool tangent, Batch *b)
{
  if (batch_crosses_axis(in, b)) return LAW_INVERTED;
  const Material *material = batch_material(in, b);
  const LawUpdate update = law_update_in(material->law, in->kinematics);
  PetscReal *state = b->keeps_state || !material->law->spares_state ? b->state : NULL;
  return update(material->parameters, b->n, batch_strains(in, b), batch_old(in, b), state, b->s.tau,
                tangent ? b->s.c : NULL);
}

/* The same with the pressures b->p. */
static inline LawStatus batch_pressure_law(const WeakFormInput *in, PetscBool tangent, Batch *b)
{
  if (batch_crosses_axis(in, b)) return LAW_INVERTED;
  const Law *law = batch_material(in, b)->law;
  const LawUpdate update = in->kinematics->hoop && law->update_hoop ? law->update_hoop : law->update;
  return pressure_update(batch_material(in, b), update, b->n, b->dF, b->p, batch_old(in, b), b->state, tangent, &b->s);
}

/* The worst status so far; PETSC_FALSE if it is bad: the step is cut, and nothing counts any
 * more. */
static inline PetscBool batch_is_good(const Batch *b, LawStatus status, WeakFormOutput *out)
{
  if (status > out->status) {
    out->status = status;
    out->bad_point = b->first;
  }
  return out->status == LAW_OK;
}

/* Work of the stress per undeformed volume by the trapezoidal rule along the straight path of
 * the step: at both ends the velocity gradient times dt is (dF - 1) dF_end^-1. It is the work of
 * the nodal forces at t_n and t_(n+1), so that Newmark's trapezoidal rule closes the balance of
 * energy. */
static inline PetscReal stress_work(const PetscReal dF[9], const PetscReal old[6], const PetscReal tau[6])
{
  PetscReal inverse[9], work = 0;
  tensor_inverse(dF, inverse);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int k = voigt_of[i][j], one = i == j;
      work += 0.5 * (old[k] * (dF[3 * i + j] - one) + tau[k] * (one - inverse[3 * i + j]));
    }
  return work;
}

/* F and J at the end of a step in which the volume grew by the factor `ratio`. */
static inline void commit_deformation(Points *points, PetscInt p, const PetscReal dF[9], PetscReal ratio)
{
  PetscReal F[9], updated[9];
  point_F(points, p, F);
  tensor_multiply(dF, F, updated);
  point_set_F(points, p, updated);
  points->real[POINT_J][p] *= ratio;
}

static inline void commit_point(Points *points, PetscInt p, const PetscReal dF[9], const PetscReal tau[6])
{
  PetscReal old[6];
  point_tau(points, p, old);
  commit_deformation(points, p, dF, tensor_det(dF));
  points->real[POINT_WORK][p] += points->real[POINT_VOLUME][p] * stress_work(dF, old, tau);
  point_set_tau(points, p, tau);
}

static inline void batch_commit_state(const WeakFormInput *in, const Batch *b, PetscInt k, Points *points)
{
  const PetscInt n_state = batch_material(in, b)->law->n_state, stride = points->components[POINT_STATE];
  for (PetscInt i = 0; i < n_state; ++i)
    points->real[POINT_STATE][(b->first + k) * stride + i] = b->state[k * n_state + i];
}

/* Write the batch's new state into the points. */
static inline void batch_commit(const WeakFormInput *in, const Batch *b, Points *points)
{
  for (PetscInt k = 0, p = b->first; k < b->n; ++k, ++p) {
    commit_point(points, p, b->dF + 9 * k, b->s.tau + 6 * k);
    if (in->pressure) points->real[POINT_PRESSURE][p] = b->s.pressure[k];
    batch_commit_state(in, b, k, points);
  }
}
