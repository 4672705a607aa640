/* Modified Cam Clay in large strains (Borja and Tamagnini 1998; docs/theory.md, "Laws"), in the
 * invariants of logarithmic elastic strains and Kirchhoff stresses, here with pressure positive:
 *
 *   x = -tr eps^e, y = sqrt(2/3) |dev eps^e|,  psi = kappa p + 3/2 mu y^2
 *   p = p_r exp(x / kappa),  q = 3 mu y
 *   f = q^2 / M^2 + p (p - p_c) <= 0, associated,  d ln p_c = d v / (lambda - kappa), v plastic volume lost
 *
 * The return keeps the direction of the deviator. With v = x_tr - x and a = 2 p - p_c the flow
 * rule and the yield condition are two equations in x and y,
 *
 *   (y_tr - y) a = v 2 q / M^2,   f(x, y) = 0.
 *
 * The first gives y(x), and f then changes its sign between the trial state and the x at which a
 * = 0: the critical state bounds the root, which cannot be missed. Newton's method in both
 * unknowns begins there. A shear modulus that goes with the pressure would have to move the
 * pressure with shear, too, to be elastic, and could then bear no more than q / p = 1.2 sqrt(G /
 * K). State: b^e, p_c, plastic shear strain. */
#include "material/algebra/hencky.h"

enum { STRESS_RATIO, LAMBDA, KAPPA, SPECIFIC_VOLUME, SHEAR, PRECONSOLIDATION, OCR, PRESSURE };

/* Packed. */
enum { CC_M2, CC_LAMBDA, CC_KAPPA, CC_MU, CC_PC, CC_OCR };

#define REFERENCE 1e5 /* Pa: where x is 0; no result depends on it */

#define LEAST 1e-30 /* Pa: pressures beyond which a step is refused */
#define MOST 1e30

enum { PC, FLOW, SCALARS };

static inline PetscReal pressure(const PetscReal *m, PetscReal x) { return REFERENCE * exp(x / m[CC_KAPPA]); }

/* A trial, and what solves it. */
typedef struct {
  PetscReal x_tr, y_tr, pc_old;    /* given */
  PetscReal x, y, p, q, pc, ratio; /* ratio: y / y_tr, also where both are 0 */
  PetscReal residual[2], J[4];     /* of both equations over p_c and p_c^2, by x and y */
} Clay;

/* Both equations at (x, y). Returns the sum of squares. */
static inline PetscReal clay_residual(const PetscReal *m, PetscReal x, PetscReal y, Clay *s)
{
  const PetscReal scale = 1.0 / s->pc_old, hardening = m[CC_LAMBDA] - m[CC_KAPPA], v = s->x_tr - x;
  s->x = x;
  s->y = y;
  s->pc = s->pc_old * exp(v / hardening);
  s->p = pressure(m, x);
  s->q = 3.0 * m[CC_MU] * y;
  const PetscReal a = 2.0 * s->p - s->pc, p_x = s->p / m[CC_KAPPA], pc_x = -s->pc / hardening,
                  b = 6.0 * m[CC_MU] / m[CC_M2];
  s->residual[0] = scale * ((s->y_tr - y) * a - v * b * y);
  s->residual[1] = scale * scale * (0.5 * b * y * s->q + s->p * (s->p - s->pc));
  s->J[0] = scale * ((s->y_tr - y) * (2.0 * p_x - pc_x) + b * y);
  s->J[1] = scale * (-a - v * b);
  s->J[2] = scale * scale * (p_x * a - s->p * pc_x);
  s->J[3] = scale * scale * b * s->q;
  s->ratio = a / (a + b * v);
  return s->residual[0] * s->residual[0] + s->residual[1] * s->residual[1];
}

/* y at x by the flow rule; f there, and its slope. */
static inline PetscReal clay_shear(const PetscReal *m, PetscReal x, const Clay *s, PetscReal *f, PetscReal *slope)
{
  const PetscReal v = s->x_tr - x, rest = m[CC_LAMBDA] - m[CC_KAPPA], pc = s->pc_old * exp(v / rest),
                  p = pressure(m, x);
  const PetscReal a = 2.0 * p - pc, a_x = 2.0 * p / m[CC_KAPPA] + pc / rest, b = 6.0 * m[CC_MU] / m[CC_M2];
  const PetscReal below = a + b * v, y = s->y_tr * a / below, y_x = s->y_tr * b * (a_x * v + a) / (below * below);
  *f = 1.5 * m[CC_MU] * b * y * y + p * (p - pc);
  *slope = 3.0 * m[CC_MU] * b * y * y_x + p * a / m[CC_KAPPA] + p * pc / rest;
  return y;
}

/* Where Newton in both begins: Newton in x between the trial state and the x at which the flow is
 * critical, halves of the way where it leaves them. */
static inline void clay_start(const PetscReal *m, const Clay *s, PetscReal *x, PetscReal *y)
{
  const PetscReal kappa = m[CC_KAPPA], rest = m[CC_LAMBDA] - kappa;
  PetscReal out = s->x_tr, in = (log(0.5 * s->pc_old / REFERENCE) + s->x_tr / rest) / (1.0 / kappa + 1.0 / rest);
  PetscReal f, slope, step = INFINITY;
  *x = 0.5 * (out + in);
  for (int k = 0; k < 60 && fabs(step) > 1e-3 * kappa && fabs(out - in) > 1e-3 * kappa; ++k) {
    clay_shear(m, *x, s, &f, &slope);
    if (f > 0.0) out = *x;
    else in = *x;
    step = -f / slope;
    if (!((*x + step - out) * (*x + step - in) < 0.0)) step = 0.5 * (out + in) - *x;
    *x += step;
  }
  *y = clay_shear(m, *x, s, &f, &slope);
  /* close to the critical state the flow rule says little: there the ellipse tells y */
  const PetscReal p = pressure(m, *x), pc = s->pc_old * exp((s->x_tr - *x) / rest), square = p * (pc - p);
  if (square > 0.1 * pc * pc) *y = PetscMin(s->y_tr, sqrt(m[CC_M2] * square) / (3.0 * m[CC_MU]));
}

/* Newton's method with halved steps. */
static inline PetscBool clay_solve(const PetscReal *m, Clay *s)
{
  PetscReal x, y, size;
  clay_start(m, s, &x, &y);
  size = clay_residual(m, x, y, s);
  for (int iteration = 0; iteration < 60; ++iteration) {
    const PetscReal det = s->J[0] * s->J[3] - s->J[1] * s->J[2];
    const PetscReal dx = (-s->residual[0] * s->J[3] + s->residual[1] * s->J[1]) / det;
    const PetscReal dy = (-s->residual[1] * s->J[0] + s->residual[0] * s->J[2]) / det;
    PetscReal share = PetscMin(1.0, m[CC_KAPPA] / (fabs(dx) + 1e-300)), next = size;
    const Clay before = *s;
    if (!(size < INFINITY) || !isfinite(dx + dy)) return PETSC_FALSE;
    for (int cut = 0; cut < 30; ++cut, share *= 0.5) {
      next = clay_residual(m, x + share * dx, PetscMax(0.0, y + share * dy), s);
      if (next < size) break;
    }
    if (!(next < size)) { /* as close as rounding lets it come */
      *s = before;
      break;
    }
    x = s->x;
    y = s->y;
    size = next;
  }
  return sqrt(size) < 1e-10 * (1.0 + 1.0 / m[CC_KAPPA]) && s->p > LEAST && s->p < MOST && s->pc < MOST;
}

/* d(p, q) by (x_tr, y_tr): of both equations, whose own slopes by them are in `by`. */
static inline void clay_slopes(const PetscReal *m, const Clay *s, PetscReal slope[4])
{
  const PetscReal scale = 1.0 / s->pc_old, pc_v = s->pc / (m[CC_LAMBDA] - m[CC_KAPPA]);
  const PetscReal by[4] = {scale * (-(s->y_tr - s->y) * pc_v - 2.0 / m[CC_M2] * s->q), scale * (2.0 * s->p - s->pc),
                           -scale * scale * s->p * pc_v, 0.0};
  const PetscReal det = s->J[0] * s->J[3] - s->J[1] * s->J[2];
  for (int k = 0; k < 2; ++k) {
    slope[k] = s->p / m[CC_KAPPA] * (-by[k] * s->J[3] + by[2 + k] * s->J[1]) / det;
    slope[2 + k] = 3.0 * m[CC_MU] * (-by[2 + k] * s->J[0] + by[k] * s->J[2]) / det;
  }
}

/* One point: trial invariants in s, d(p, q) by them out. PETSC_FALSE: no stress. */
static inline PetscBool clay_return(const PetscReal *m, Clay *s, PetscBool *plastic, PetscReal slope[4])
{
  const PetscReal noise = 64.0 * PETSC_MACHINE_EPSILON * (1.0 + 1.0 / m[CC_KAPPA]), q = 3.0 * m[CC_MU] * s->y_tr;
  *plastic = PETSC_FALSE;
  s->x = s->x_tr;
  s->y = s->y_tr;
  s->p = pressure(m, s->x);
  s->q = q;
  s->pc = s->pc_old;
  s->ratio = 1.0;
  if (!(s->p > LEAST && s->p < MOST && s->pc > LEAST)) return PETSC_FALSE; /* p_c = 0: nobody gave it a stress */
  if (!(m[CC_LAMBDA] > m[CC_KAPPA])) return PETSC_FALSE; /* lambda has fallen below the kappa of the step's start */
  slope[0] = s->p / m[CC_KAPPA];
  slope[1] = slope[2] = 0.0;
  slope[3] = 3.0 * m[CC_MU];
  if (q * q / m[CC_M2] + s->p * (s->p - s->pc) <= noise * (s->pc * PetscMax(s->pc, s->p) + m[CC_MU] / m[CC_M2] * q))
    return PETSC_TRUE;
  *plastic = PETSC_TRUE;
  if (!clay_solve(m, s)) return PETSC_FALSE;
  clay_slopes(m, s, slope);
  return PETSC_TRUE;
}

/* c of principal axes: n the unit deviator, moduli as derived in docs/theory.md. */
static inline void clay_moduli(const PetscReal *m, const Clay *s, const PetscReal n[3], const PetscReal slope[4],
                               PetscReal D[9])
{
  const PetscReal root = sqrt(2.0 / 3.0), twice = 2.0 * m[CC_MU] * s->ratio;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      D[3 * i + j] = slope[0] - root * slope[1] * n[j] - root * slope[2] * n[i] +
                     (2.0 / 3.0 * slope[3] - twice) * n[i] * n[j] + twice * ((i == j ? 1.0 : 0.0) - 1.0 / 3.0);
}

LANES_INLINE void clay_point(const PetscReal *m, PetscBool moduli, int l, const Lanes e[3], const Lanes *before,
                             Lanes *after, HenckyReturn *r)
{
  const PetscReal trace = e[0][l] + e[1][l] + e[2][l];
  PetscReal n[3], slope[4] = {0}, D[9], norm = 0.0;
  PetscBool plastic;
  for (int k = 0; k < 3; ++k) {
    n[k] = e[k][l] - trace / 3.0;
    norm += n[k] * n[k];
  }
  norm = sqrt(norm);
  for (int k = 0; k < 3; ++k) n[k] = norm > 0.0 ? n[k] / norm : 0.0;
  Clay s = {.x_tr = -trace, .y_tr = sqrt(2.0 / 3.0) * norm, .pc_old = before[PC][l]};
  r->good[l] = clay_return(m, &s, &plastic, slope) ? -1 : 0;
  r->plastic[l] = plastic ? -1 : 0;
  for (int k = 0; k < 3; ++k) {
    r->tau[k][l] = sqrt(2.0 / 3.0) * s.q * n[k] - s.p;
    r->elastic[k][l] = sqrt(1.5) * s.y * n[k] - s.x / 3.0;
    r->r[k][l] = 2.0 * m[CC_MU] * s.ratio;
  }
  after[PC][l] = s.pc;
  after[FLOW][l] = before[FLOW][l] + s.y_tr - s.y;
  if (!moduli) return;
  clay_moduli(m, &s, n, slope, D);
  for (int k = 0; k < 9; ++k) r->D[k][l] = D[k];
}

LANES_INLINE void cam_clay(const PetscReal *m, PetscBool moduli, const Lanes e[3], const Lanes *before, Lanes *after,
                           HenckyReturn *r)
{
  for (int l = 0; l < LANES; ++l) clay_point(m, moduli, l, e, before, after, r);
}

HENCKY_UPDATE(cam_clay, SCALARS)

/* kappa p + 3/2 mu y^2. */
static PetscReal energy(const PetscReal *m, const PetscReal *state)
{
  PetscReal stretch2[3], v[9], e[3], trace = 0.0, norm2 = 0.0;
  sym_eigen(state, stretch2, v);
  for (int a = 0; a < 3; ++a) {
    e[a] = 0.5 * log(stretch2[a]);
    trace += e[a];
  }
  for (int a = 0; a < 3; ++a) norm2 += PetscSqr(e[a] - trace / 3.0);
  return m[CC_KAPPA] * pressure(m, -trace) + m[CC_MU] * norm2;
}

/* b^e under the stress tau, and its principal deviator; p > 0. */
static void clay_elastic(const PetscReal *m, const PetscReal tau[6], PetscReal p, PetscReal s[3], PetscReal *b)
{
  PetscReal stretch2[3], v[9], basis[36];
  sym_eigen(tau, s, v);
  principal_basis(v, basis);
  for (int a = 0; a < 3; ++a) {
    s[a] += p;
    stretch2[a] = exp(s[a] / m[CC_MU] - 2.0 / 3.0 * m[CC_KAPPA] * log(p / REFERENCE));
  }
  principal_tensor(stretch2, basis, b);
}

static PetscBool bear(const PetscReal *m, const PetscReal tau[6], PetscReal *state)
{
  const PetscReal p = -(tau[0] + tau[1] + tau[2]) / 3.0;
  PetscReal s[3];
  if (p > 0.0) clay_elastic(m, tau, p, s, state);
  return (PetscBool)(p > 0.0);
}

/* The body is as large as it is: tau = sigma, J = 1. p_c by ocr that of the ellipse through the
 * stress, times it. PETSC_FALSE without pressure, or outside the yield surface. */
static PetscBool initial_stress(const PetscReal *m, const PetscReal sigma[6], PetscReal *state)
{
  const PetscReal p = -(sigma[0] + sigma[1] + sigma[2]) / 3.0;
  PetscReal s[3], norm2 = 0.0;
  if (!(p > 0.0)) return PETSC_FALSE;
  clay_elastic(m, sigma, p, s, state);
  for (int a = 0; a < 3; ++a) norm2 += s[a] * s[a];
  const PetscReal through = p + 1.5 * norm2 / (m[CC_M2] * p);
  state[6 + PC] = isnan(m[CC_PC]) ? m[CC_OCR] * through : m[CC_PC];
  state[6 + FLOW] = 0.0;
  return state[6 + PC] >= through * (1.0 - 64.0 * PETSC_MACHINE_EPSILON);
}

/* Slopes of ln v over ln p, of Cauchy stresses, to those over Kirchhoff's, whose pressure has the
 * factor v too. */
static PetscReal kirchhoff(PetscReal slope) { return slope / (1.0 - slope); }

static void prepare(const Elasticity *elastic, const PetscReal *given, PetscReal *m)
{
  (void)elastic;
  m[CC_M2] = given[STRESS_RATIO] * given[STRESS_RATIO];
  m[CC_LAMBDA] = kirchhoff(given[LAMBDA] / given[SPECIFIC_VOLUME]);
  m[CC_KAPPA] = kirchhoff(given[KAPPA] / given[SPECIFIC_VOLUME]);
  m[CC_MU] = given[SHEAR];
  m[CC_PC] = given[PRECONSOLIDATION];
  m[CC_OCR] = given[OCR];
}

/* At the reference pressure. */
static void elastic_at(const PetscReal *given, PetscReal value[2])
{
  value[0] = given[PRESSURE] / kirchhoff(given[KAPPA] / given[SPECIFIC_VOLUME]);
  value[1] = given[SHEAR];
}

static const char *check(const PetscReal *given)
{
  if (given[KAPPA] >= given[LAMBDA]) return "lambda must be larger than kappa";
  if (given[LAMBDA] >= given[SPECIFIC_VOLUME]) return "lambda must be smaller than the specific volume";
  if (!isnan(given[PRECONSOLIDATION]) && given[OCR] != 1.0) return "takes either preconsolidation or ocr";
  return NULL;
}

#define POSITIVE 0, PETSC_MAX_REAL, .min_open = PETSC_TRUE

static const LawParameter parameters[] = {
  {"critical_stress_ratio", "", "M: q / p at the critical state", POSITIVE, .fallback = NAN},
  {"lambda", "", "slope of the virgin compression line, specific volume over ln p", POSITIVE, .fallback = NAN},
  {"kappa", "", "slope of swelling lines, specific volume over ln p", POSITIVE, .fallback = NAN},
  {"specific_volume", "", "1 + e for which both slopes are given; 1: they are those of ln v over ln p", 1, 100,
   .fallback = 1},
  {"shear_modulus", "Pa", "shear modulus, a constant", POSITIVE, .fallback = NAN},
  {"preconsolidation", "Pa", "largest isotropic pressure so far, p_c (Kirchhoff, J times the true one)", POSITIVE,
   .fallback = NAN, .absent = "ocr", .at_start = PETSC_TRUE},
  {"ocr", "", "p_c over that of the yield surface through the initial stress; 1: normally consolidated", 1,
   PETSC_MAX_REAL, .fallback = 1, .at_start = PETSC_TRUE},
  {"reference_pressure", "Pa", "pressure whose stiffness stands for the material's in time scales and stabilisation",
   POSITIVE, .fallback = 1e5},
  {.name = NULL},
};

static const LawField fields[] = {
  {"elastic_strain", "", "elastic left Cauchy-Green tensor b; 1 at a pressure of 1e5 Pa", 6, {1, 1, 1, 0, 0, 0}},
  {"preconsolidation", "Pa", "largest isotropic pressure so far, p_c (Kirchhoff, J times the true one)", 1, {0}},
  {"equivalent_plastic_strain", "", "accumulated sqrt(2/3) |dev d eps^p|", 1, {0}},
  {.name = NULL},
};

static void scale(PetscInt n, const PetscReal *factor, PetscReal *state) { scale_b(n, 6 + SCALARS, factor, state); }

const Law law_modified_cam_clay = {
  .name = "modified-cam-clay",
  .help =
    "clay that hardens and softens with its volume (Roscoe and Burland), stiffness by pressure; starts from a stress",
  .parameters = parameters,
  .fields = fields,
  .n_state = 6 + SCALARS,
  .symmetric = PETSC_FALSE, /* the exponential hardening makes it so, at finite steps */
  .yields = PETSC_TRUE,
  .spares_state = PETSC_TRUE,
  .needs_stress = PETSC_TRUE,
  .elastic = elastic_at,
  .update = update,
  .march_plane = cam_clay_march_plane,
  .march_space = cam_clay_march_space,
  .energy = energy,
  .initial_stress = initial_stress,
  .bear = bear,
  .scale = scale,
  .prepare = prepare,
  .check = check,
};
