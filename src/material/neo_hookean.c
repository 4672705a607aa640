/* Neo-Hookean solid whose stress couples shape and volume:
 *
 *   Psi = lambda/2 (ln J)^2 - mu ln J + mu/2 (tr b - 3)
 *   tau = lambda ln J I + mu (b - I)                          (thesis 3.25)
 *   c   = lambda I x I + 2 (mu - lambda ln J) I_sym           (thesis 3.35)
 *
 * State: the elastic left Cauchy-Green tensor b; J comes from its determinant. Use this file as the
 * starting point for a law of your own: the kernel for eight points at once is `update_lanes`, the
 * rest is what every law has. */
#include "material/algebra/lanes.h"
#include "material/algebra/shape.h"

enum { LAMBDA, MU };

/* c of one point: three normal rows and three shears on the diagonal. */
LANES_INLINE void tangent_point(PetscReal lambda, PetscReal g, PetscReal *c)
{
  for (int k = 0; k < 36; ++k) c[k] = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) c[6 * i + j] = lambda;
    c[7 * i] = lambda + 2.0 * g;
    c[7 * (i + 3)] = g;
  }
}

/* b after dF = f, the Kirchhoff stress, det f and ln J. */
LANES_INLINE void stretch(const PetscReal *parameters, const Lanes f[9], const Lanes old[6], Lanes b[6], Lanes t[6],
                          Lanes *det_f, Lanes *log_J)
{
  const PetscReal lambda = parameters[LAMBDA], mu = parameters[MU];
  Lanes det_b;
  lanes_push_forward(f, old, b);
  lanes_det(f, det_f);
  lanes_sym_det(b, &det_b);
  lanes_log(&det_b, log_J);
  *log_J *= 0.5;
  for (int k = 0; k < 3; ++k) {
    t[k] = lambda * *log_J + mu * (b[k] - 1.0);
    t[k + 3] = mu * b[k + 3];
  }
}

LANES_INLINE LawStatus update_lanes(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                                    PetscReal *state, PetscReal *tau, PetscReal *c)
{
  Lanes f[9], b_old[6], b[6], t[6], det_f, log_J;
  lanes_load(9, n, dF, f);
  lanes_load(6, n, old, b_old);
  stretch(parameters, f, b_old, b, t, &det_f, &log_J);
  if (state) lanes_store(6, n, b, state);
  lanes_store(6, n, t, tau);
  if (c) {
    const Lanes g = parameters[MU] - parameters[LAMBDA] * log_J;
    const PetscInt m = n < LANES ? n : LANES;
    for (PetscInt l = 0; l < m; ++l) tangent_point(parameters[LAMBDA], g[l], c + 36 * l);
  }
  return lanes_status(&det_f, 6, t);
}

LANES_INLINE LawStatus neo_hookean_march(const PetscBool plane, const PetscReal *parameters, PetscInt n,
                                         const LawMarch *march)
{
  Lanes f[9], old[6], b[6], t[6], det_f, log_J;
  lanes_march_dF(plane, march, f);
  lanes_load_apart(6, march->stride, n, march->state, old);
  stretch(parameters, f, old, b, t, &det_f, &log_J);
  lanes_store_apart(6, march->stride, n, b, march->state);
  lanes_march_tau(plane, t, march);
  return lanes_status(&det_f, 6, t);
}

LANES_MARCHES(neo_hookean)

static LawStatus update(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                        PetscReal *state, PetscReal *tau, PetscReal *c)
{
  return lanes_update(update_lanes, 6, parameters, n, dF, old, state, tau, c);
}

static PetscReal energy(const PetscReal *parameters, const PetscReal *b)
{
  const PetscReal log_J = 0.5 * log(sym_det(b));
  return log_J * (0.5 * parameters[LAMBDA] * log_J - parameters[MU]) +
         0.5 * parameters[MU] * (b[0] + b[1] + b[2] - 3.0);
}

/* A stress whose b is looked for: Cauchy's grows to tau with J, Kirchhoff's is tau. */
typedef struct {
  const PetscReal *stress;
  PetscBool cauchy;
} Aim;

static PetscReal growth(const Aim *aim, PetscReal log_J) { return aim->cauchy ? exp(log_J) : 1.0; }

/* b = I + (tau - lambda ln J I) / mu. */
static void b_of_volume(const PetscReal *parameters, const Aim *aim, PetscReal log_J, PetscReal *b)
{
  const PetscReal J = growth(aim, log_J), lambda = parameters[LAMBDA], mu = parameters[MU];
  for (int k = 0; k < 6; ++k) b[k] = J * aim->stress[k] / mu;
  for (int k = 0; k < 3; ++k) b[k] += 1.0 - lambda * log_J / mu;
}

/* Residual ln det b - 2 ln J and its slope in ln J; PETSC_FALSE where b is not positive
 * definite. */
static PetscBool volume_residual(const PetscReal *parameters, const Aim *aim, PetscReal log_J, PetscReal *residual,
                                 PetscReal *slope)
{
  PetscReal b[6], full[9], inverse[9], slope_b[9], stress[9];
  b_of_volume(parameters, aim, log_J, b);
  sym_to_full(b, full);
  const PetscReal det = tensor_inverse(full, inverse), J_slope = aim->cauchy ? exp(log_J) : 0.0;
  if (!(b[0] > 0.0 && b[0] * b[1] - b[3] * b[3] > 0.0 && det > 0.0)) return PETSC_FALSE;
  sym_to_full(aim->stress, stress);
  for (int k = 0; k < 9; ++k) slope_b[k] = J_slope * stress[k] / parameters[MU];
  for (int k = 0; k < 9; k += 4) slope_b[k] -= parameters[LAMBDA] / parameters[MU];
  *residual = log(det) - 2.0 * log_J;
  *slope = -2.0;
  for (int k = 0; k < 9; ++k) *slope += inverse[k] * slope_b[k];
  /* a rising residual: past the limit load in tension, where a state may be, but none that is looked for */
  return isfinite(*residual) && (*slope < 0.0 || !aim->cauchy);
}

/* The volume whose b carries the stress: Newton in ln J from that of a state (a stress so large that b
 * is indefinite there: from a smaller volume), steps halved back into b > 0. */
static PetscBool b_of_stress(const PetscReal *parameters, const Aim *aim, PetscReal log_J, PetscReal *b)
{
  PetscReal residual, slope;
  while (!volume_residual(parameters, aim, log_J, &residual, &slope))
    if (!((log_J = log_J > 0.0 ? 0.0 : 1.5 * log_J - 0.05) > -50.0)) return PETSC_FALSE;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const PetscReal step = -residual / slope;
    PetscReal damping = 1.0;
    while (!volume_residual(parameters, aim, log_J + damping * step, &residual, &slope))
      if ((damping *= 0.5) < 1e-6) return PETSC_FALSE;
    log_J += damping * step;
    if (fabs(step) <= 4.0 * PETSC_MACHINE_EPSILON * (1.0 + fabs(log_J))) break;
  }
  const PetscReal cancels = fabs(parameters[LAMBDA] * log_J / parameters[MU]); /* in b, which is 1 or so */
  if (!(fabs(residual) <= 1e-12 * (1.0 + cancels))) return PETSC_FALSE;
  b_of_volume(parameters, aim, log_J, b);
  return PETSC_TRUE;
}

static PetscBool initial_stress(const PetscReal *parameters, const PetscReal sigma[6], PetscReal *b)
{
  return b_of_stress(parameters, &(Aim){sigma, PETSC_TRUE}, 0.0, b); /* from none */
}

static PetscBool bear(const PetscReal *parameters, const PetscReal tau[6], PetscReal *b)
{
  return b_of_stress(parameters, &(Aim){tau, PETSC_FALSE}, 0.5 * log(sym_det(b)), b);
}

static void volume(PetscInt n, const PetscReal *state, PetscReal *J) { volume_of_b(n, 6, state, J); }

static void scale(PetscInt n, const PetscReal *factor, PetscReal *state) { scale_b(n, 6, factor, state); }

/* The mean stress of the term mu (b - I) depends on shape. */
static VolumeLaw volume_law(const PetscReal *parameters)
{
  (void)parameters;
  return VOLUME_COUPLED;
}

static void prepare(const Elasticity *elastic, const PetscReal *given, PetscReal *packed)
{
  (void)given;
  packed[LAMBDA] = elastic->lame;
  packed[MU] = elastic->shear;
}

const Law law_neo_hookean = {
  .name = "neo-hookean",
  .help = "Neo-Hookean solid, tau = lambda ln J I + mu (b - I)",
  .parameters = (const LawParameter[]){{.name = NULL}},
  .fields = (const LawField[]){{"elastic_strain", "", "elastic left Cauchy-Green tensor b", 6, {1, 1, 1, 0, 0, 0}},
                               {.name = NULL}},
  .n_state = 6,
  .symmetric = PETSC_TRUE,
  .spares_state = PETSC_TRUE,
  .update = update,
  .march_plane = neo_hookean_march_plane,
  .march_space = neo_hookean_march_space,
  .energy = energy,
  .initial_stress = initial_stress,
  .bear = bear,
  .volume = volume,
  .volume_law = volume_law,
  .scale = scale,
  .prepare = prepare,
};
