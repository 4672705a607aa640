/* Neo-Hookean solid split into shape and volume (thesis 3.43):
 *
 *   Psi = K U(J) + mu/2 (tr bbar - 3),  bbar = J^(-2/3) b
 *   tau = q I + s,  q = J p = K J U',  s = mu dev bbar
 *   c   = dq I x I - 2 q I_sym + m (I_sym - I x I / 3) - 2/3 (s x I + I x s)
 *
 * with dq = J dq/dJ = J (p + J dp/dJ) and m = 2/3 mu tr bbar. (The thesis' 3.51 holds the pressure
 * fixed, as a mixed formulation does; the term J^2 dp/dJ makes it the tangent of displacements.)
 * Two laws, by their volumetric part:
 *
 *   neo-hookean-split       U = (J - 1)^2 / 2    p = K (J - 1)
 *   neo-hookean-split-log   U = (ln J)^2 / 2     p = K ln J / J */
#include "material/algebra/volume.h"

/* c = a I x I + 2 g I_sym - 2/3 (s x I + I x s) of one point. */
LANES_INLINE void tangent_point(PetscReal a, PetscReal g, const PetscReal s[6], PetscReal *c)
{
  PetscReal r[6];
  for (int k = 0; k < 6; ++k) r[k] = -2.0 / 3.0 * s[k];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      c[6 * i + j] = a + r[i] + r[j] + (i == j ? 2.0 * g : 0.0);
      c[6 * i + j + 3] = r[j + 3];
      c[6 * (i + 3) + j] = r[i + 3];
      c[6 * (i + 3) + j + 3] = i == j ? g : 0.0;
    }
}

LANES_INLINE LawStatus update_lanes(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                                    PetscReal *state, PetscReal *tau, PetscReal *c)
{
  const PetscReal mu = parameters[SPLIT_SHEAR];
  Lanes f[9], b_old[6], b[6], s[6], t[9], det_f, det_b, J, root, q, dq;
  lanes_load(9, n, dF, f);
  lanes_load(6, n, old, b_old);
  lanes_push_forward(f, b_old, b);
  lanes_det(f, &det_f);
  lanes_sym_det(b, &det_b);
  lanes_cbrt(&det_b, &root);
  lanes_sqrt(&det_b, &J);
  volume_lanes(parameters, &J, &q, &dq);
  const Lanes scale = mu / root, m = (b[0] + b[1] + b[2]) * scale * (2.0 / 3.0);
  for (int k = 0; k < 3; ++k) {
    s[k] = scale * b[k] - 0.5 * m;
    s[k + 3] = scale * b[k + 3];
    t[k] = s[k] + q;
    t[k + 3] = s[k + 3];
  }
  if (state) lanes_store(6, n, b, state);
  lanes_store(6, n, t, tau);
  const Lanes a = dq - m / 3.0, g = 0.5 * m - q;
  if (c) {
    const PetscInt count = n < LANES ? n : LANES;
    PetscReal point[LANES * 6];
    lanes_store(6, LANES, s, point);
    for (PetscInt l = 0; l < count; ++l) tangent_point(a[l], g[l], point + 6 * l, c + 36 * l);
  }
  t[6] = a;
  return lanes_status(&det_f, 7, t);
}

static LawStatus update(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                        PetscReal *state, PetscReal *tau, PetscReal *c)
{
  return lanes_update(update_lanes, 6, parameters, n, dF, old, state, tau, c);
}

static PetscReal energy(const PetscReal *parameters, const PetscReal *b)
{
  const PetscReal det = sym_det(b);
  return volume_energy(split_volume(parameters), parameters[SPLIT_BULK], sqrt(det)) +
         0.5 * parameters[SPLIT_SHEAR] * ((b[0] + b[1] + b[2]) / cbrt(det) - 3.0);
}

static PetscBool initial_stress(const PetscReal *parameters, const PetscReal sigma[6], PetscReal *b)
{
  const PetscReal p = (sigma[0] + sigma[1] + sigma[2]) / 3.0;
  const PetscReal J = volume_from_pressure(split_volume(parameters), parameters[SPLIT_BULK], p);
  if (!(J > 0.0) || !shape_from_stress(parameters[SPLIT_SHEAR], J, sigma, b)) return PETSC_FALSE;
  for (int k = 0; k < 6; ++k) b[k] *= cbrt(J * J);
  return PETSC_TRUE;
}

static PetscBool bear(const PetscReal *parameters, const PetscReal tau[6], PetscReal *b)
{
  const PetscReal q = (tau[0] + tau[1] + tau[2]) / 3.0;
  const PetscReal J = volume_from_kirchhoff(split_volume(parameters), parameters[SPLIT_BULK], q, sqrt(sym_det(b)));
  if (!(J > 0.0) || !shape_from_stress(parameters[SPLIT_SHEAR], 1.0, tau, b)) return PETSC_FALSE;
  for (int k = 0; k < 6; ++k) b[k] *= cbrt(J * J);
  return PETSC_TRUE;
}

static void prepare_linear(const Elasticity *elastic, const PetscReal *given, PetscReal *packed)
{
  (void)given;
  split_prepare(VOLUME_LINEAR, elastic, packed);
}

static void prepare_log(const Elasticity *elastic, const PetscReal *given, PetscReal *packed)
{
  (void)given;
  split_prepare(VOLUME_LOG, elastic, packed);
}

static void volume(PetscInt n, const PetscReal *state, PetscReal *J) { volume_of_b(n, 6, state, J); }

static const LawParameter parameters_none[] = {{.name = NULL}};
static const LawField fields[] = {{"elastic_strain", "", "elastic left Cauchy-Green tensor b", 6, {1, 1, 1, 0, 0, 0}},
                                  {.name = NULL}};

#define NEO_HOOKEAN_SPLIT(...)                                                                                      \
  {                                                                                                                 \
    .parameters = parameters_none, .fields = fields, .n_state = 6, .symmetric = PETSC_TRUE, .update = update,       \
    .energy = energy, .initial_stress = initial_stress, .bear = bear, .volume = volume, .volume_law = split_volume, \
    __VA_ARGS__                                                                                                     \
  }

const Law law_neo_hookean_split = NEO_HOOKEAN_SPLIT(.name = "neo-hookean-split", .prepare = prepare_linear,
                                                    .help = "Neo-Hookean solid, shape and volume apart, p = K (J - 1)");
const Law law_neo_hookean_split_log =
  NEO_HOOKEAN_SPLIT(.name = "neo-hookean-split-log", .prepare = prepare_log,
                    .help = "Neo-Hookean solid, shape and volume apart, p = K ln J / J");
