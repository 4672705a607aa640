/* A law for talus: a metal with von Mises' yield condition whose yield stress rises from yield_stress to saturation
 * with the plastic strain alpha,
 *
 *   k(alpha) = saturation - (saturation - yield_stress) exp(-rate alpha),   q = sqrt(3/2) |dev tau| <= k(alpha)
 *
 *     cc -shared -fPIC -O2 -o voce.so voce.c
 *     talus run bar.yaml --law voce=./voce.so
 */
#include <math.h>
#include <talus/law.h>

enum { BULK, SHEAR, YIELD, SATURATION, RATE }; /* bulk and shear come first: TALUS_LAW_ELASTIC */

static const TalusLawParameter parameters[] = {
  {"yield_stress", "Pa", "yield stress of the virgin metal", 0, 1e30, NAN, TALUS_LAW_OPEN_MIN},
  {"saturation", "Pa", "yield stress after much flow", 0, 1e30, NAN, TALUS_LAW_OPEN_MIN},
  {"rate", "", "how fast it is reached: 1 over a plastic strain", 0, 1e6, 10, 0},
  {.name = 0},
};

static const TalusLawState state_fields[] = {
  {"equivalent_plastic_strain", "", "accumulated sqrt(2/3) |d eps^p|", 1, {0}},
  {.name = 0},
};

static double strength(const double *p, double alpha, double *slope)
{
  const double rest = (p[SATURATION] - p[YIELD]) * exp(-p[RATE] * alpha);
  *slope = p[RATE] * rest;
  return p[SATURATION] - rest;
}

/* q_trial - 3 G d = k(alpha + d): Newton from d = 0. The left side is above, and both are monotone. */
static int flow(const double *p, double q, double alpha, double *d, double *slope)
{
  *d = 0;
  for (int i = 0; i < 50; ++i) {
    const double rest = q - 3 * p[SHEAR] * *d - strength(p, alpha + *d, slope);
    if (fabs(rest) <= 1e-14 * q) return TALUS_LAW_OK;
    *d += rest / (3 * p[SHEAR] + *slope);
  }
  return fabs(q - 3 * p[SHEAR] * *d - strength(p, alpha + *d, slope)) <= 1e-11 * q ? TALUS_LAW_OK
                                                                                   : TALUS_LAW_NOT_CONVERGED;
}

/* D = K 1 x 1 + 2 G f (I - 1 x 1 / 3) + g n x n, n = dev tau / |dev tau|. */
static void tangent(const double *p, double f, double g, const double n[6], double *D)
{
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const double volume = i < 3 && j < 3 ? p[BULK] - 2.0 / 3.0 * p[SHEAR] * f : 0;
      D[6 * i + j] = volume + (i == j ? (i < 3 ? 2 : 1) * p[SHEAR] * f : 0) + g * n[i] * n[j];
    }
}

static int update(const double *p, const TalusLawStep *step, const double strain[6], const double *old, double *state,
                  double tau[6], double elastic[6], double *D)
{
  const double trace = strain[0] + strain[1] + strain[2];
  double s[6], n[6], norm2 = 0, slope, d = 0, f = 1, g = 0;
  (void)step; /* it does not know of time */
  for (int k = 0; k < 6; ++k) {
    s[k] = 2 * p[SHEAR] * (strain[k] - (k < 3 ? trace / 3 : 0));
    norm2 += (k < 3 ? 1 : 2) * s[k] * s[k];
  }
  const double norm = sqrt(norm2), q = sqrt(1.5) * norm;
  state[0] = old[0];
  if (q > strength(p, old[0], &slope) * (1 + 1e-14)) {
    if (flow(p, q, old[0], &d, &slope)) return TALUS_LAW_NOT_CONVERGED;
    state[0] = old[0] + d;
    f = 1 - 3 * p[SHEAR] * d / q;
    g = 2 * p[SHEAR] * (3 * p[SHEAR] * d / q - 3 * p[SHEAR] / (3 * p[SHEAR] + slope));
  }
  for (int k = 0; k < 6; ++k) {
    n[k] = norm > 0 ? s[k] / norm : 0;
    tau[k] = f * s[k] + (k < 3 ? p[BULK] * trace : 0);
    if (d > 0) elastic[k] = f * s[k] / (2 * p[SHEAR]) + (k < 3 ? trace / 3 : 0);
  }
  if (D) tangent(p, f, g, n, D);
  return TALUS_LAW_OK;
}

static double energy(const double *p, const double strain[6], const double *state)
{
  const double trace = strain[0] + strain[1] + strain[2];
  double sum = 0;
  (void)state;
  for (int k = 0; k < 6; ++k) {
    const double e = strain[k] - (k < 3 ? trace / 3 : 0);
    sum += (k < 3 ? 1 : 2) * e * e;
  }
  return p[BULK] / 2 * trace * trace + p[SHEAR] * sum;
}

static const char *check(const double *given)
{
  return given[SATURATION - YIELD] < given[0] ? "saturation must not be below yield_stress" : 0;
}

static const TalusLaw law = {
  .version = TALUS_LAW_VERSION,
  .size = sizeof(TalusLaw),
  .help = "von Mises, yield stress that saturates (Voce)",
  .parameters = parameters,
  .state = state_fields,
  .flags = TALUS_LAW_ELASTIC | TALUS_LAW_TANGENT | TALUS_LAW_SYMMETRIC | TALUS_LAW_YIELDS,
  .update_strain = update,
  .energy = energy,
  .check = check,
};

const TalusLaw *talus_law(void) { return &law; }
