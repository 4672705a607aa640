/* Laws in explicit dynamics: no tangent, and points component by component. */
#include "material/law.h"

/* Where rows of the plane stand among 3 x 3. */
static const int plane_place[5] = {0, 1, 3, 4, 8};

LawStatus march_by_update(LawUpdate update, PetscInt n_state, PetscBool plane, const PetscReal *parameters, PetscInt n,
                          const LawMarch *march)
{
  const int rows = plane ? 5 : 9, components = plane ? 4 : 6;
  PetscReal dF[9 * LAW_BATCH] = {0}, tau[6 * LAW_BATCH];
  PetscReal old[LAW_MAX_STATE * LAW_BATCH] = {0}, now[LAW_MAX_STATE * LAW_BATCH];
  for (PetscInt k = 0; k < n; ++k) {
    for (int i = 0; i < rows; ++i) dF[9 * k + (plane ? plane_place[i] : i)] = march->dF[i * LAW_BATCH + k];
    for (PetscInt i = 0; i < n_state; ++i) old[k * n_state + i] = march->state[k * march->stride + i];
  }
  const LawStatus status = update(parameters, n, dF, old, now, tau, NULL);
  for (PetscInt k = 0; k < n; ++k) {
    for (int i = 0; i < components; ++i) march->tau[i * LAW_BATCH + k] = tau[6 * k + i];
    for (PetscInt i = 0; i < n_state; ++i) march->state[k * march->stride + i] = now[k * n_state + i];
  }
  return status;
}

LawStatus law_march(const Law *law, PetscBool plane, const PetscReal *parameters, PetscInt n, const LawMarch *march)
{
  const LawMarching own = plane ? law->march_plane : law->march_space;
  if (own) return own(parameters, n, march);
  return march_by_update(law->update, law->n_state, plane, parameters, n, march);
}
