#include "material/pressure.h"
#include "material/algebra/invariants.h"
#include "material/algebra/shape.h"

/* J^e before the flow of this increment, from the old state. */
static LawStatus trial_volumes(const Law *law, PetscInt n, const PetscReal *dF, const PetscReal *old, PetscReal *J)
{
  LawStatus worst = LAW_OK;
  law->volume(n, old, J);
  for (PetscInt k = 0; k < n; ++k) {
    const PetscReal det = tensor_det(dF + 9 * k);
    J[k] *= det;
    if (det <= 0) worst = PetscMax(worst, LAW_INVERTED);
    else if (!isfinite(J[k]) || !(J[k] > 0)) worst = LAW_NOT_FINITE;
  }
  return worst;
}

/* The law's own mean stress q and its slope J dq/dJ are taken away, those of p put in their place.
 * Where nothing but J moves q, 1 : c : 1 = 9 J dq/dJ - 6 q, whatever the law. */
static void replace_mean(VolumeLaw law, PetscReal q_p, PetscReal tau[6], PetscReal *c)
{
  const PetscReal q = (tau[0] + tau[1] + tau[2]) / 3.0, g = q - q_p;
  for (int i = 0; i < 3; ++i) tau[i] -= g;
  if (!c) return;
  PetscReal sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum += c[6 * i + j];
  const PetscReal a = (law == VOLUME_LINEAR ? q_p : 0.0) - (sum + 6.0 * q) / 9.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) c[6 * i + j] += a;
    c[7 * i] += 2.0 * g;
    c[7 * (i + 3)] += g;
  }
}

static LawStatus update_apart(const Material *m, LawUpdate update, PetscInt n, const PetscReal *dF, const PetscReal *p,
                              const PetscReal *old, PetscReal *state, PetscBool tangent, PressureStress *s)
{
  const LawStatus status = update(m->deviatoric, n, dF, old, state, s->tau, tangent ? s->c : NULL);
  if (status != LAW_OK) return status;
  for (PetscInt k = 0; k < n; ++k) {
    const PetscReal J = s->theta[k]; /* left there by the caller */
    s->pressure[k] = p[k];
    s->rate[k] = m->volume == VOLUME_LINEAR ? J : 1.0;
    s->theta[k] = m->volume == VOLUME_LINEAR ? J - 1.0 : log(J);
    replace_mean(m->volume, s->rate[k] * p[k], s->tau + 6 * k, tangent ? s->c + 36 * k : NULL);
    for (int i = 0; i < 6; ++i) s->coupling[6 * k + i] = i < 3 ? s->rate[k] : 0.0;
  }
  return LAW_OK;
}

/* With dF~ = f dF, f = (exp(p / K) / J^e)^(1/3), the law feels d - tr d I / 3 and the spin, and d
 * ln f = dp / 3K at constant dF: c = c~ - (c~ : I / 3 + 2/3 tau) x I,  dtau/dp = (c~ : I + 2 tau) /
 * 3K. */
static void couple(PetscReal compliance, const PetscReal tau[6], PetscReal *c, PetscReal coupling[6])
{
  for (int i = 0; i < 6; ++i) {
    const PetscReal mean = (c[6 * i] + c[6 * i + 1] + c[6 * i + 2] + 2.0 * tau[i]) / 3.0;
    coupling[i] = compliance * mean;
    for (int j = 0; j < 3; ++j) c[6 * i + j] -= mean;
  }
}

static LawStatus update_coupled(const Material *m, LawUpdate update, PetscInt n, const PetscReal *dF,
                                const PetscReal *p, const PetscReal *old, PetscReal *state, PetscBool tangent,
                                PressureStress *s)
{
  PetscReal scaled[9 * LAW_BATCH], back[LAW_BATCH];
  for (PetscInt k = 0; k < n; ++k) {
    s->theta[k] = log(s->theta[k]);
    s->rate[k] = 1.0;
    const PetscReal factor = exp((p[k] * m->compliance - s->theta[k]) / 3.0);
    back[k] = 1.0 / factor;
    for (int i = 0; i < 9; ++i) scaled[9 * k + i] = factor * dF[9 * k + i];
  }
  const LawStatus status = update(m->parameters, n, scaled, old, state, s->tau, tangent ? s->c : NULL);
  if (status != LAW_OK) return status;
  m->law->volume(n, state, s->pressure);
  for (PetscInt k = 0; k < n; ++k) s->pressure[k] = log(s->pressure[k]) / m->compliance;
  m->law->scale(n, back, state); /* the state keeps the volume of the displacements */
  for (PetscInt k = 0; tangent && k < n; ++k) couple(m->compliance, s->tau + 6 * k, s->c + 36 * k, s->coupling + 6 * k);
  return LAW_OK;
}

LawStatus pressure_update(const Material *m, LawUpdate update, PetscInt n, const PetscReal *dF, const PetscReal *p,
                          const PetscReal *old, PetscReal *state, PetscBool tangent, PressureStress *s)
{
  const LawStatus status = trial_volumes(m->law, n, dF, old, s->theta);
  if (status != LAW_OK) return status;
  if (m->volume == VOLUME_COUPLED) return update_coupled(m, update, n, dF, p, old, state, tangent, s);
  return update_apart(m, update, n, dF, p, old, state, tangent, s);
}

PetscReal pressure_of_state(const Material *m, const PetscReal *state, const PetscReal tau[6])
{
  const PetscReal q = (tau[0] + tau[1] + tau[2]) / 3.0;
  PetscReal J;
  m->law->volume(1, state, &J);
  if (m->volume == VOLUME_COUPLED) return log(J) / m->compliance;
  return m->volume == VOLUME_LINEAR ? q / J : q;
}

PetscReal pressure_softness(const Material *m, const PetscReal *state, const PetscReal tau[6])
{
  const PetscReal shear = m->elastic.shear, flow = m->flow ? 3 * shear * state[m->flow - 1] : 0;
  if (!(flow > 0)) return 1 / shear;
  return (1 + PetscMin(flow / stress_deviatoric(tau), MOST_SOFTENED - 1)) / shear;
}

PetscReal pressure_energy(const Material *m, const PetscReal *state, PetscReal p)
{
  PetscReal J, copy[LAW_MAX_STATE];
  m->law->volume(1, state, &J);
  if (m->volume != VOLUME_COUPLED)
    return m->law->energy(m->deviatoric, state) - volume_energy(m->volume, m->elastic.shear, J) +
           0.5 * p * p * m->compliance;
  const PetscReal factor = exp((p * m->compliance - log(J)) / 3.0);
  for (PetscInt k = 0; k < m->law->n_state; ++k) copy[k] = state[k];
  m->law->scale(1, &factor, copy);
  return m->law->energy(m->parameters, copy);
}
