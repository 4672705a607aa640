#include "model/start/initial_stress.h"
#include <string.h>
#include "material/pressure.h"

/* of the stress: what a law makes of it beyond round-off was beyond its strength */
#define SAME 1e-9
/* of the stiffness: stresses below are none */
#define NOTHING 1e-13

static const PetscReal identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/* A state, its Kirchhoff stress, and its volume over the undeformed one. */
typedef struct {
  PetscReal *state, tau[6], J;
} Carried;

static PetscReal product(const PetscReal a[6], const PetscReal b[6])
{
  PetscReal sum = 0;
  for (int k = 0; k < 6; ++k) sum += (k < 3 ? 1 : 2) * a[k] * b[k];
  return sum;
}

/* Volume of a state, with which its stress is tau = J sigma. */
static PetscReal volume_of(const Law *law, const PetscReal *state, const PetscReal sigma[6], const PetscReal tau[6])
{
  PetscReal J = 1;
  if (law->volume) law->volume(1, state, &J);
  else if (product(sigma, sigma) > 0) J = product(tau, sigma) / product(sigma, sigma);
  return J;
}

/* The parameters of all of the law, or of the shape alone, where pressure is an unknown. */
static const PetscReal *parameters_of(const Material *m, PetscBool shape)
{
  return shape ? m->deviatoric : m->parameters;
}

/* Is this a state of sigma that the law leaves as it is? */
static PetscBool is_carried(const Material *material, PetscBool shape, const PetscReal sigma[6], Carried *c)
{
  const Law *law = material->law;
  const PetscReal *parameters = parameters_of(material, shape);
  const PetscReal nothing = NOTHING * (shape ? material->wave_modulus : material_confined(material));
  PetscReal after[LAW_MAX_STATE], lack[6];
  if (!law->initial_stress(parameters, sigma, c->state)) return PETSC_FALSE;
  if (law->update(parameters, 1, identity, c->state, after, c->tau, NULL) != LAW_OK) return PETSC_FALSE;
  c->J = volume_of(law, c->state, sigma, c->tau);
  for (int k = 0; k < 6; ++k) lack[k] = c->tau[k] - c->J * sigma[k];
  return product(lack, lack) <= SAME * SAME * product(c->tau, c->tau) + nothing * nothing;
}

/* What the strength leaves of sigma: the elastic state of it, returned; then a state of that stress, which
 * has no history of flow. */
static StressOutcome project(const Material *material, PetscBool shape, const PetscReal sigma[6], Carried *c)
{
  const Law *law = material->law;
  PetscReal trial[LAW_MAX_STATE], allowed[6];
  Material elastic = *material;
  if (!law->reduce) return STRESS_REFUSED;
  material_reduce(&elastic, 0);
  if (!law->initial_stress(parameters_of(&elastic, shape), sigma, trial)) return STRESS_REFUSED;
  if (law->update(parameters_of(material, shape), 1, identity, trial, c->state, c->tau, NULL) != LAW_OK)
    return STRESS_REFUSED;
  c->J = volume_of(law, c->state, sigma, c->tau);
  for (int k = 0; k < 6; ++k) allowed[k] = c->tau[k] / c->J;
  memcpy(trial, c->state, sizeof(PetscReal) * (size_t)law->n_state);
  if (is_carried(material, shape, allowed, c)) return STRESS_BEYOND;
  for (int k = 0; k < 6; ++k) c->tau[k] = allowed[k] * c->J;
  memcpy(c->state, trial, sizeof(PetscReal) * (size_t)law->n_state);
  return STRESS_BEYOND;
}

static StressOutcome carry(const Material *material, PetscBool shape, const PetscReal sigma[6], Carried *c)
{
  return is_carried(material, shape, sigma, c) ? STRESS_CARRIED : project(material, shape, sigma, c);
}

void point_lengthen(Points *points, PetscInt p, PetscReal longer)
{
  const PetscReal wider = points->dim == 2 ? longer : longer * longer;
  for (PetscInt d = 0; d < points->components[POINT_DOMAIN]; ++d) point_real(points, POINT_DOMAIN, p)[d] *= longer;
  for (PetscInt d = 0; d < points->components[POINT_FACE]; ++d) point_real(points, POINT_FACE, p)[d] *= wider;
  for (PetscInt d = 0; d < points->components[POINT_CORNER]; ++d) point_real(points, POINT_CORNER, p)[d] *= longer;
  if (points->components[POINT_REACH]) points->real[POINT_REACH][p] *= longer;
}

void point_compress(Points *points, PetscInt p, PetscReal before, PetscReal J)
{
  const PetscReal stretch = PetscPowReal(J, 1.0 / 3.0), F[9] = {stretch, 0, 0, 0, stretch, 0, 0, 0, stretch};
  point_set_F(points, p, F);
  points->real[POINT_J][p] = J;
  points->real[POINT_VOLUME][p] *= before / J;
  point_lengthen(points, p, PetscPowReal(before / J, 1.0 / 3.0));
}

static void deviator_of(const PetscReal sigma[6], PetscReal deviator[6])
{
  const PetscReal mean = (sigma[0] + sigma[1] + sigma[2]) / 3;
  for (int k = 0; k < 6; ++k) deviator[k] = sigma[k] - (k < 3 ? mean : 0);
}

/* Is pressure an unknown that no volume goes with? */
static PetscBool is_incompressible(const Points *points, const Material *material)
{
  return (PetscBool)(points->components[POINT_PRESSURE] && material->compliance == 0);
}

/* Shape alone carries the deviator, the pressure the mean: nothing is compressed. */
static StressOutcome stress_incompressible(Points *points, PetscInt p, const Material *material,
                                           const PetscReal sigma[6])
{
  const PetscReal mean = (sigma[0] + sigma[1] + sigma[2]) / 3;
  Carried c = {.state = point_real(points, POINT_STATE, p)};
  PetscReal deviator[6];
  deviator_of(sigma, deviator);
  points->real[POINT_PRESSURE][p] = mean;
  const StressOutcome outcome = carry(material, PETSC_TRUE, deviator, &c);
  for (int k = 0; k < 3; ++k) c.tau[k] += mean;
  point_set_tau(points, p, c.tau);
  return outcome;
}

StressOutcome stress_point(Points *points, PetscInt p, const Material *material, const PetscReal sigma[6])
{
  Carried c = {.state = point_real(points, POINT_STATE, p)};
  for (int k = 0; k < 6; ++k)
    if (PetscIsInfOrNanReal(sigma[k])) return STRESS_REFUSED;
  if (!material->law->initial_stress) return STRESS_REFUSED;
  if (is_incompressible(points, material)) return stress_incompressible(points, p, material, sigma);
  const StressOutcome outcome = carry(material, PETSC_FALSE, sigma, &c);
  if (outcome == STRESS_REFUSED || product(sigma, sigma) == 0) return outcome;
  if (points->components[POINT_PRESSURE]) points->real[POINT_PRESSURE][p] = pressure_of_state(material, c.state, c.tau);
  point_set_tau(points, p, c.tau);
  point_compress(points, p, 1, c.J);
  return outcome;
}

PetscBool stress_is_beyond(const Points *points, PetscInt p, const Material *material, const PetscReal sigma[6])
{
  const PetscBool shape = is_incompressible(points, material);
  PetscReal state[LAW_MAX_STATE], deviator[6];
  Carried c = {.state = state};
  memcpy(state, point_real(points, POINT_STATE, p), sizeof(PetscReal) * (size_t)material->law->n_state);
  deviator_of(sigma, deviator);
  return (PetscBool)!is_carried(material, shape, shape ? deviator : sigma, &c);
}
