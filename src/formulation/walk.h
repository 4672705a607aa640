/* What the formulations share in their walk over the points: batches of one material, and the acceptance of a step. */
#pragma once
#include "base/math/tensor.h"
#include "formulation/formulation.h"

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
