/* What the displacement formulation does point by point, whatever the number of nodes: batches of one law, and their acceptance. */
#pragma once
#include "formulation/formulation.h"
#include "formulation/walk.h"

typedef struct {
  PetscInt n, first, group; /* points first .. first + n - 1; the group of the first */
  PetscReal dF[9 * LAW_BATCH], tau[6 * LAW_BATCH], c[36 * LAW_BATCH];
  PetscReal old[LAW_MAX_STATE * LAW_BATCH], state[LAW_MAX_STATE * LAW_BATCH];
} Batch;

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
  const PetscBool plane = in->kinematics == KINEMATICS_PLANE_STRAIN && material->law->update_plane;
  return (plane ? material->law->update_plane : material->law->update)(material->parameters, b->n, b->dF, old, b->state,
                                                                       b->tau, tangent ? b->c : NULL);
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
