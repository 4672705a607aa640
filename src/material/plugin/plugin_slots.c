/* A Law for each slot: its functions get neither the law nor anything else that could tell which
 * library is meant, so each slot has functions of its own. */
#include "material/plugin/plugin.h"
#include <math.h>
#include <string.h>
#include "material/algebra/shape.h"

Plugin plugins[PLUGIN_MOST];

static LawStatus worked(const Plugin *g, const PetscReal *q, const PetscReal dF[9], const PetscReal *old,
                        PetscReal *state, PetscReal tau[6], PetscReal *c)
{
  const PetscReal det = tensor_det(dF);
  if (!isfinite(det)) return LAW_NOT_FINITE;
  if (det <= 0.0) return LAW_INVERTED;
  plugin_busy = g;
  const LawStatus status = g->user.update_strain ? plugin_strain_point(g, q, dF, old, state, tau, c)
                                                 : plugin_gradient_point(g, q, dF, old, state, tau, c);
  plugin_busy = NULL;
  return status;
}

/* Points that failed keep their state and carry no stress. */
static LawStatus update(const Plugin *g, const PetscReal *q, PetscInt n, const PetscReal *dF, const PetscReal *old,
                        PetscReal *state, PetscReal *tau, PetscReal *c)
{
  const PetscInt n_state = g->law.n_state;
  LawStatus worst = LAW_OK;
  for (PetscInt p = 0; p < n; ++p) {
    const LawStatus status =
      worked(g, q, dF + 9 * p, old + n_state * p, state + n_state * p, tau + 6 * p, c ? c + 36 * p : NULL);
    if (status != LAW_OK) {
      memcpy(state + n_state * p, old + n_state * p, (size_t)n_state * sizeof *state);
      memset(tau + 6 * p, 0, 6 * sizeof *tau);
      if (c) memset(c + 36 * p, 0, 36 * sizeof *c);
    }
    worst = PetscMax(worst, status);
  }
  return worst;
}

static PetscReal energy(const Plugin *g, const PetscReal *q, const PetscReal *state)
{
  PetscReal strain[6];
  if (!g->user.update_strain) return g->user.energy(q + PLUGIN_STEP, NULL, state + g->kept);
  plugin_strain_of(state, strain);
  return g->user.energy(q + PLUGIN_STEP, strain, state + g->kept);
}

/* A subroutine that has the stress and no strain gives it back, if it is within its strength. */
static PetscBool umat_stress(const Plugin *g, const PetscReal *q, const PetscReal sigma[6], PetscReal *state)
{
  static const PetscReal identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscReal after[LAW_MAX_STATE], tau[6], size = 0.0, off = 0.0;
  memcpy(state, sigma, 6 * sizeof *state);
  if (plugin_gradient_point(g, q, identity, state, after, tau, NULL) != LAW_OK) return PETSC_FALSE;
  for (int k = 0; k < 6; ++k) {
    size = PetscMax(size, fabs(sigma[k]));
    off = PetscMax(off, fabs(tau[k] - sigma[k]));
  }
  return off <= 1e-10 * size ? PETSC_TRUE : PETSC_FALSE;
}

/* The place of a subroutine's point, and what SDVINI has made of STATEV, stay. */
static PetscBool initial_stress(const Plugin *g, const PetscReal *q, const PetscReal sigma[6], PetscReal *state)
{
  PetscReal begun[LAW_MAX_STATE];
  const size_t own = g->umat.begin ? (size_t)g->own * sizeof *state : 0;
  memcpy(begun, state, (size_t)g->law.n_state * sizeof *state);
  law_initial_state(&g->law, state);
  memcpy(state + g->kept, begun + g->kept, own);
  if (g->umat.call) memcpy(state + UMAT_PLACE, begun + UMAT_PLACE, 3 * sizeof *state);
  if (g->user.update_strain) return plugin_strain_stress(g, q, PETSC_TRUE, sigma, state);
  if (g->umat.call) return umat_stress(g, q, sigma, state);
  return g->user.initial_stress(q + PLUGIN_STEP, sigma, state) ? PETSC_TRUE : PETSC_FALSE;
}

/* A subroutine has no elastic strain: its stress is what it had. */
static PetscBool bear(const Plugin *g, const PetscReal *q, const PetscReal tau[6], PetscReal *state)
{
  PetscReal trial[LAW_MAX_STATE];
  if (g->umat.call) return PETSC_TRUE;
  memcpy(trial, state, (size_t)g->law.n_state * sizeof *state);
  if (!plugin_strain_stress(g, q, PETSC_FALSE, tau, trial)) return PETSC_FALSE;
  memcpy(state, trial, (size_t)g->law.n_state * sizeof *state);
  return PETSC_TRUE;
}

static void prepare(const Plugin *g, const Elasticity *elastic, const PetscReal *given, PetscReal *packed)
{
  PetscInt n = PLUGIN_STEP;
  packed[0] = packed[1] = 0.0;
  if (g->user.flags & TALUS_LAW_ELASTIC) {
    packed[n++] = elastic->bulk;
    packed[n++] = elastic->shear;
  }
  for (PetscInt k = 0; k < g->given; ++k) packed[n++] = given[k];
}

static void place(const Plugin *g, const PetscReal x[3], PetscReal *state)
{
  plugin_busy = g;
  umat_begin(&g->umat, x, state);
  plugin_busy = NULL;
}

static void moved(const PetscReal x[3], PetscReal *state) { memcpy(state + UMAT_PLACE, x, 3 * sizeof *state); }

/* Those that the law tells, or what its tangent at rest has. */
static void elastic(const Plugin *g, const PetscReal *given, PetscReal bulk_and_shear[2])
{
  static const PetscReal identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscReal q[LAW_MAX_PARAMETERS], old[LAW_MAX_STATE], state[LAW_MAX_STATE], tau[6], c[36];
  bulk_and_shear[0] = bulk_and_shear[1] = NAN;
  if (g->user.moduli) {
    g->user.moduli(given, bulk_and_shear);
    return;
  }
  prepare(g, NULL, given, q);
  law_initial_state(&g->law, old);
  if (g->umat.call) place(g, (PetscReal[]){0.0, 0.0, 0.0}, old);
  if (update(g, q, 1, identity, old, state, tau, c) != LAW_OK) return;
  bulk_and_shear[1] = c[6 * 3 + 3];
  bulk_and_shear[0] = c[0] - 4.0 / 3.0 * c[6 * 3 + 3];
}

static const char *check(const Plugin *g, const PetscReal *given)
{
  PetscReal two[2] = {1.0, 1.0};
  const char *complaint = g->user.check ? g->user.check(given) : NULL;
  if (complaint) return complaint;
  if (!(g->user.flags & TALUS_LAW_ELASTIC)) elastic(g, given, two);
  return two[0] > 0.0 && two[1] > 0.0 && isfinite(two[0] + two[1])
           ? NULL
           : "with these parameters the law has no bulk and shear modulus at rest that are positive";
}

static void reduce(const Plugin *g, const PetscReal *given, PetscReal factor, PetscReal *reduced)
{
  memcpy(reduced, given, (size_t)g->given * sizeof *reduced);
  if (factor != 1.0) g->user.reduce(given, factor, reduced);
}

/* Pressure and flow may act on each other: nobody has said that they do not. */
static VolumeLaw volume_law(const PetscReal *q)
{
  (void)q;
  return VOLUME_COUPLED;
}

static void step(PetscReal time, PetscReal dt, PetscReal *q)
{
  q[0] = time;
  q[1] = dt;
}

#define SLOT(k)                                                                                                     \
  static LawStatus update_##k(const PetscReal *q, PetscInt n, const PetscReal *dF, const PetscReal *old,            \
                              PetscReal *state, PetscReal *tau, PetscReal *c)                                       \
  {                                                                                                                 \
    return update(&plugins[k], q, n, dF, old, state, tau, c);                                                       \
  }                                                                                                                 \
  static PetscReal energy_##k(const PetscReal *q, const PetscReal *state) { return energy(&plugins[k], q, state); } \
  static PetscBool initial_stress_##k(const PetscReal *q, const PetscReal *sigma, PetscReal *state)                 \
  {                                                                                                                 \
    return initial_stress(&plugins[k], q, sigma, state);                                                            \
  }                                                                                                                 \
  static PetscBool bear_##k(const PetscReal *q, const PetscReal *tau, PetscReal *state)                             \
  {                                                                                                                 \
    return bear(&plugins[k], q, tau, state);                                                                        \
  }                                                                                                                 \
  static void elastic_##k(const PetscReal *given, PetscReal *two) { elastic(&plugins[k], given, two); }             \
  static void prepare_##k(const Elasticity *e, const PetscReal *given, PetscReal *q)                                \
  {                                                                                                                 \
    prepare(&plugins[k], e, given, q);                                                                              \
  }                                                                                                                 \
  static void volume_##k(PetscInt n, const PetscReal *state, PetscReal *J)                                          \
  {                                                                                                                 \
    volume_of_b(n, plugins[k].law.n_state, state, J);                                                               \
  }                                                                                                                 \
  static void scale_##k(PetscInt n, const PetscReal *factor, PetscReal *state)                                      \
  {                                                                                                                 \
    scale_b(n, plugins[k].law.n_state, factor, state);                                                              \
  }                                                                                                                 \
  static void reduce_##k(const PetscReal *given, PetscReal f, PetscReal *less)                                      \
  {                                                                                                                 \
    reduce(&plugins[k], given, f, less);                                                                            \
  }                                                                                                                 \
  static void place_##k(const PetscReal x[3], PetscReal *state) { place(&plugins[k], x, state); }                   \
  static const char *check_##k(const PetscReal *given) { return check(&plugins[k], given); }

SLOT(0)
SLOT(1)
SLOT(2)
SLOT(3)
SLOT(4)
SLOT(5)
SLOT(6)
SLOT(7)

#define TABLE(k)                                                                                                      \
  {                                                                                                                   \
    .yields = PETSC_TRUE, .update = update_##k, .energy = energy_##k, .initial_stress = initial_stress_##k,           \
    .bear = bear_##k, .elastic = elastic_##k, .prepare = prepare_##k, .volume = volume_##k, .volume_law = volume_law, \
    .scale = scale_##k, .reduce = reduce_##k, .check = check_##k, .place = place_##k, .moved = moved, .step = step    \
  }

static const Law tables[PLUGIN_MOST] = {TABLE(0), TABLE(1), TABLE(2), TABLE(3), TABLE(4), TABLE(5), TABLE(6), TABLE(7)};

void plugin_fill(PetscInt slot)
{
  Plugin *g = &plugins[slot];
  const PetscBool own = !(g->user.flags & TALUS_LAW_ELASTIC), strains = g->user.update_strain != NULL;
  g->law = tables[slot];
  g->law.name = g->name;
  g->law.help = g->user.help;
  g->law.parameters = g->parameters;
  g->law.fields = g->fields;
  g->law.n_state = g->kept + g->own;
  g->law.symmetric = g->user.flags & TALUS_LAW_SYMMETRIC ? PETSC_TRUE : PETSC_FALSE;
  g->law.yields = g->user.flags & TALUS_LAW_YIELDS ? PETSC_TRUE : PETSC_FALSE;
  if (!own) g->law.elastic = NULL;
  if (own || !strains) g->law.volume = NULL;
  if (!strains && !g->umat.call && !g->user.initial_stress) g->law.initial_stress = NULL;
  if (!strains && !g->umat.call) g->law.bear = NULL;
  if (!g->user.energy) g->law.energy = NULL;
  if (!g->umat.call) g->law.place = g->law.moved = NULL;
  if (!g->user.reduce) g->law.reduce = NULL;
}
