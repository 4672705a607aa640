/* What the displacement formulation does point by point, whatever the number of nodes: batches of one law, and their acceptance. */
#pragma once
#include "formulation/formulation.h"

typedef struct {
  PetscInt n, first, group; /* points first .. first + n - 1; the group of the first */
  PetscReal dF[9 * LAW_BATCH], tau[6 * LAW_BATCH], c[36 * LAW_BATCH];
  PetscReal old[LAW_MAX_STATE * LAW_BATCH], state[LAW_MAX_STATE * LAW_BATCH];
} Batch;

/* Lost points stand last and are in no group. */
static inline PetscInt points_in_groups(const Support *support)
{
  return support->n_groups ? support->point_start[support->n_groups] : 0;
}

/* As many points as one call of the law takes, all of one material. */
static inline PetscInt batch_length(const Points *points, PetscInt first, PetscInt end)
{
  PetscInt n = 1;
  while (n < LAW_BATCH && first + n < end && points->material[first + n] == points->material[first]) ++n;
  return n;
}

/* Call the law on the increments b->dF. */
static inline LawStatus batch_law(const WeakFormInput *in, PetscBool tangent, Batch *b)
{
  const Points *points = in->points;
  const Material *material = &in->materials[points->material[b->first]];
  const PetscInt n_state = material->law->n_state, stride = points->components[POINT_STATE];
  const PetscReal *old = points->real[POINT_STATE] + b->first * stride;
  if (stride != n_state) {
    for (PetscInt k = 0; k < b->n; ++k)
      for (PetscInt s = 0; s < n_state; ++s) b->old[k * n_state + s] = old[k * stride + s];
    old = b->old;
  }
  return material->law->update(material->parameters, b->n, b->dF, old, b->state, b->tau, tangent ? b->c : NULL);
}

/* Work of the stress per undeformed volume by the trapezoidal rule along the straight path of the step: at both ends the velocity gradient
 * times dt is (dF - 1) dF_end^-1. It is the work of the nodal forces at t_n and t_(n+1), so that Newmark's trapezoidal rule closes the
 * balance of energy. */
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

static inline void commit_point(Points *points, PetscInt p, const PetscReal dF[9], const PetscReal tau[6])
{
  PetscReal F[9], updated[9], old[6];
  point_tau(points, p, old);
  point_F(points, p, F);
  tensor_multiply(dF, F, updated);
  point_set_F(points, p, updated);
  points->real[POINT_J][p] *= tensor_det(dF);
  points->real[POINT_WORK][p] += points->real[POINT_VOLUME][p] * stress_work(dF, old, tau);
  point_set_tau(points, p, tau);
}

/* Write the batch's new state into the points. */
static inline void batch_commit(const WeakFormInput *in, const Batch *b, Points *points)
{
  const PetscInt stride = points->components[POINT_STATE];
  const PetscInt n_state = in->materials[points->material[b->first]].law->n_state;
  for (PetscInt k = 0; k < b->n; ++k) {
    commit_point(points, b->first + k, b->dF + 9 * k, b->tau + 6 * k);
    PetscReal *state = points->real[POINT_STATE] + (b->first + k) * stride;
    for (PetscInt i = 0; i < n_state; ++i) state[i] = b->state[k * n_state + i];
  }
}
