/* The critical substep: that in which the fastest wave crosses a cell.
 *
 * Waves run at sqrt((c_1111 + tau_11) / rho_0) through a point as it is now, with the tangent c of its law
 * against Kirchhoff stress, and ride on the point; its cell is that of the grid, which stays as it is. Of a
 * rectangular cell 1 / h^2 is the sum over its sides: the highest frequency of its linear functions with
 * lumped mass is at most 2 c / h. */
#include "grid/box/box.h"
#include "model/explicit/explicit.h"

/* Of n points of one material: wave = the largest (c_aaaa + tau_aa) per density, m2/s2. Point by point, for ranks not
 * to matter. */
static void fastest_waves(const Model *m, PetscInt first, PetscInt n, PetscReal *wave)
{
  static const PetscReal one[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const Material *material = &m->materials[m->points->material[first]];
  const PetscInt n_state = material->law->n_state, stride = m->points->components[POINT_STATE];
  const int axes = kinematics_is_plane(m->c->kinematics) ? 2 : 3;
  PetscReal dF[9 * LAW_BATCH], old[LAW_MAX_STATE * LAW_BATCH], state[LAW_MAX_STATE * LAW_BATCH];
  PetscReal tau[6 * LAW_BATCH], c[36 * LAW_BATCH];
  for (PetscInt k = 0; k < n; ++k) {
    for (int i = 0; i < 9; ++i) dF[9 * k + i] = one[i];
    for (PetscInt s = 0; s < n_state; ++s)
      old[k * n_state + s] = m->points->real[POINT_STATE][(first + k) * stride + s];
  }
  law_update_in(material->law, m->c->kinematics)(material->parameters, n, dF, old, state, tau, c);
  for (PetscInt k = 0; k < n; ++k) {
    PetscReal most = material->wave_modulus;
    for (int a = 0; a < axes; ++a)
      most = PetscMax(most, PetscMax(c[36 * k + 7 * a], material->wave_modulus) + PetscMax(tau[6 * k + a], 0));
    wave[k] = most / material->density;
  }
}

/* Of cells cut into triangles or graded: their smallest height. */
static PetscReal cell_length(const Model *m)
{
  const GridBox *box = m->grid->box;
  PetscReal sum = 0, size = m->grid->smallest;
  if (box && m->grid->nodes_per_cell == (m->dim == 2 ? 4 : 8)) {
    for (PetscInt d = 0; d < m->dim; ++d) {
      PetscReal least = PETSC_MAX_REAL;
      for (PetscInt i = 0; i < box->counts[d]; ++i) least = PetscMin(least, box->line[d][i + 1] - box->line[d][i]);
      sum += 1 / PetscSqr(least);
    }
    return 1 / PetscSqrtReal(sum);
  }
  return size / PetscSqrtReal((PetscReal)m->dim);
}

PetscErrorCode ExplicitCritical(const Model *m, PetscReal *critical, PetscReal *fastest)
{
  PetscReal local[2] = {0, 0}, all[2], wave[LAW_BATCH];

  PetscFunctionBeginUser;
  for (PetscInt p = 0, n; p < m->points->n; p += n) {
    n = batch_points(m->points, p);
    fastest_waves(m, p, n, wave);
    for (PetscInt k = p; k < p + n; ++k) {
      const PetscReal *v = point_real(m->points, POINT_V, k);
      PetscReal square = 0;
      for (PetscInt d = 0; d < m->dim; ++d) square += v[d] * v[d];
      local[0] = PetscMax(local[0], PetscSqrtReal(wave[k - p]) + PetscSqrtReal(square));
      local[1] = PetscMax(local[1], PetscSqrtReal(square));
    }
  }
  PetscCall(MPIU_Allreduce(local, all, 2, MPIU_REAL, MPIU_MAX, m->comm));
  *critical = all[0] > 0 ? cell_length(m) / all[0] : PETSC_MAX_REAL;
  *fastest = all[1];
  PetscFunctionReturn(0);
}
