/* Another material at a point that is there. */
#include "model/stage/stage_private.h"
#include "material/pressure.h"
#include "model/start/initial_stress.h"

/* Numbers of history that both laws know by the same name, but for what this one counts by itself; are there any? */
static PetscBool keep_history(const Law *was, const PetscReal *before, const Law *is, PetscReal *state)
{
  const PetscReal *counted = is->followed ? state + is->followed : NULL;
  PetscBool any = PETSC_FALSE;
  for (const LawField *f = is->fields; f->name; state += f++->components) {
    const PetscReal *old = before;
    for (const LawField *g = was->fields; g->name; old += g++->components)
      if (f->components == 1 && g->components == 1 && !strcmp(f->name, g->name)) {
        if (state != counted) *state = *old;
        any = PETSC_TRUE;
      }
  }
  return any;
}

/* The state of another law with the history that it shares, before anything is said of its elastic part. */
static PetscBool begin_state(const Law *was, const PetscReal *before, const Material *is, const PetscReal tau[6],
                             PetscReal *state)
{
  law_initial_state(is->law, state);
  if (is->law->initial_stress) (void)is->law->initial_stress(is->parameters, tau, state);
  return keep_history(was, before, is->law, state);
}

/* By how much more pressures are held that vary inside a cell. What is held at one point of a cell need not be a
 * multiple of p there, and its sums stay in balance where all of it goes with 1 / G: that is so wherever both flow, or
 * neither. */
static PetscReal how_much_softer(const Points *points, PetscInt p, const Material *was, const Material *is,
                                 const PetscReal tau[6], const PetscReal *state)
{
  if (!was->flow == !is->flow) return was->elastic.shear / is->elastic.shear;
  return pressure_softness(is, state, tau) / pressure_softness(was, point_real(points, POINT_STATE, p), tau);
}

/* Volumetric strain of the state before that its pressure does not explain: what the stabilisation of the mixed
 * formulation holds there, a multiple of p / G, or more in what flows. It stays with p. state: as it will be. */
static PetscReal held_strain(const Points *points, PetscInt p, const Material *was, const Material *is,
                             const PetscReal tau[6], const PetscReal *state)
{
  PetscReal J;
  if (!was->mixed) return 0;
  was->law->volume(1, point_real(points, POINT_STATE, p), &J);
  const PetscReal strain = was->volume == VOLUME_LINEAR ? J - 1 : PetscLogReal(J);
  const PetscReal softer = how_much_softer(points, p, was, is, tau, state);
  return (strain - points->real[POINT_PRESSURE][p] * was->compliance) * softer;
}

/* Pressure and shape apart: *pressure and the state's volume J fit each other, and the mean of tau stays. */
static PetscBool bear_apart(const Material *is, PetscReal held, const PetscReal tau[6], PetscReal *state,
                            PetscReal *pressure)
{
  const PetscReal q = (tau[0] + tau[1] + tau[2]) / 3, J0 = 1 + held, c = is->compliance;
  const PetscBool linear = (PetscBool)(is->volume == VOLUME_LINEAR);
  PetscReal own[6];
  *pressure = linear ? 2 * q / (J0 + PetscSqrtReal(J0 * J0 + 4 * q * c)) : q; /* J p = q, J = J0 + p c */
  const PetscReal strain = held + *pressure * c, mean = is->elastic.shear * strain * (linear ? 1 + strain : 1);
  for (int k = 0; k < 6; ++k) own[k] = tau[k] - (k < 3 ? q - mean : 0);
  return is->law->bear(is->deviatoric, own, state);
}

static PetscBool bear_coupled(const Material *is, PetscReal held, const PetscReal tau[6], PetscReal *state,
                              PetscReal *pressure)
{
  const PetscReal longer = PetscExpReal(held / 3);
  if (!is->law->bear(is->parameters, tau, state)) return PETSC_FALSE;
  *pressure = pressure_of_state(is, state, tau);
  is->law->scale(1, &longer, state);
  return PETSC_TRUE;
}

/* Where history goes on, strength is counted from the same undeformed state: all that the point knows of it stays, and
 * the elastic part of its state is another. */
static PetscBool bear_point(Points *points, PetscInt p, const Material *was, const Material *is, const PetscReal tau[6],
                            PetscReal *state)
{
  PetscBool bears;
  if (is->mixed) {
    const PetscReal held = held_strain(points, p, was, is, tau, state);
    bears = (is->volume == VOLUME_COUPLED ? bear_coupled : bear_apart)(is, held, tau, state,
                                                                       points->real[POINT_PRESSURE] + p);
  } else bears = is->law->bear(is->parameters, tau, state);
  for (PetscInt i = 0; bears && i < is->law->n_state; ++i) point_real(points, POINT_STATE, p)[i] = state[i];
  return bears;
}

/* The state of a law that knows nothing of what was before: undeformed is what has the point's present volume, less
 * what the stress does to it. */
static PetscBool begin_anew(Points *points, PetscInt p, const Material *was, const Material *is)
{
  PetscReal *J = points->real[POINT_J] + p, *volume = points->real[POINT_VOLUME] + p;
  PetscReal before[LAW_MAX_STATE], F[9], tau[6], sigma[6];
  const PetscReal J_was = *J;
  PetscReal *state = point_real(points, POINT_STATE, p);
  point_tau(points, p, tau);
  for (PetscInt i = 0; i < points->components[POINT_F]; ++i) F[i] = point_real(points, POINT_F, p)[i];
  for (int k = 0; k < 6; ++k) sigma[k] = tau[k] / J_was;
  for (PetscInt i = 0; i < LAW_MAX_STATE; ++i) before[i] = i < was->law->n_state ? state[i] : 0;
  *volume *= J_was;
  *J = 1;
  law_initial_state(is->law, state);
  if (stress_point(points, p, is, sigma) == STRESS_REFUSED) return PETSC_FALSE;
  (void)keep_history(was->law, before, is->law, state);
  const PetscReal stretch = PetscPowReal(*J / J_was, 1.0 / 3.0);
  for (PetscInt i = 0; i < points->components[POINT_F]; ++i) point_real(points, POINT_F, p)[i] = stretch * F[i];
  point_lengthen(points, p, PetscPowReal(J_was, 1.0 / 3.0)); /* the new stress has taken out its own J alone */
  return PETSC_TRUE;
}

PetscBool point_swap(Points *points, PetscInt p, const Material *was, const Material *is)
{
  const PetscReal *before = point_real(points, POINT_STATE, p);
  PetscReal state[LAW_MAX_STATE], tau[6];
  if (!is->law->bear) return begin_anew(points, p, was, is);
  point_tau(points, p, tau);
  for (PetscInt i = 0; i < is->law->n_state; ++i) state[i] = before[i];
  const PetscBool goes_on = (PetscBool)(was->law == is->law || begin_state(was->law, before, is, tau, state));
  if (goes_on && bear_point(points, p, was, is, tau, state)) return PETSC_TRUE;
  return begin_anew(points, p, was, is);
}
