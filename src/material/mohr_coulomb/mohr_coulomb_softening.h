/* A strength that changes with the plastic strain: phi, psi and c by straight lines from the
 * initial values over those of the peak to the residual ones, and the return of one point that
 * finds its own strain.
 *
 *   kappa = kappa_n + sqrt(2/3) |dev(eps_tr - D^-1 tau(eps_tr, s kappa))|
 *
 * is one equation in kappa, which the return at the old strength brackets from below. s is the
 * size of the point's cell over the size for which the strains of the table hold. Of a nonlocal
 * strain the table is entered with o + s kappa: o = m times the mean around the point when the step
 * began, s = 1 - m (docs/theory.md). */
#pragma once
#include "material/mohr_coulomb/mohr_coulomb_return.h"

/* Packed parameters: the table's columns at 0, the peak's strain, the residual strain. */
enum {
  SOFT_LAMBDA,
  SOFT_MU,
  SOFT_PHI,
  SOFT_PSI = SOFT_PHI + 3,
  SOFT_COHESION = SOFT_PSI + 3,
  SOFT_PEAK = SOFT_COHESION + 3,
  SOFT_RESIDUAL,
  SOFT_CUT,
  SOFT_SIZE,
  SOFT_LENGTH,
  SOFT_WEIGHT,
  SOFT_N
};

/* Mohr-Coulomb at one strain, and slopes of k, m, q by it. */
typedef struct {
  PetscReal x, p[MC_N_PARAMETERS], dk, dm, dq;
} SoftStrength;

static inline PetscReal soft_line(const PetscReal *at, const PetscReal *strain, int piece, PetscReal x,
                                  PetscReal *slope)
{
  *slope = 0.0;
  if (piece == 2) return at[2];
  *slope = (at[piece + 1] - at[piece]) / (strain[piece + 1] - strain[piece]);
  return at[piece] + *slope * (x - strain[piece]);
}

/* The strength at x, kept if it is the one that is there. */
static inline void soft_strength(const PetscReal *q, PetscReal x, SoftStrength *at)
{
  const PetscReal strain[3] = {0.0, q[SOFT_PEAK], q[SOFT_RESIDUAL]}, lambda = q[SOFT_LAMBDA], mu = q[SOFT_MU];
  const int piece = x >= strain[2] ? 2 : (x >= strain[1] ? 1 : 0);
  PetscReal dphi, dpsi, dc, *p = at->p;
  if (piece == 2) x = strain[2];
  if (at->x == x) return;
  at->x = x;
  const PetscReal phi = soft_line(q + SOFT_PHI, strain, piece, x, &dphi);
  const PetscReal psi = soft_line(q + SOFT_PSI, strain, piece, x, &dpsi);
  const PetscReal c = soft_line(q + SOFT_COHESION, strain, piece, x, &dc);
  const PetscReal s = sin(phi), d = sin(psi), root = cos(phi) / (1.0 - s), k = root * root, m = (1.0 + d) / (1.0 - d);
  at->dk = 2.0 * root / (1.0 - s) * dphi;
  at->dm = 2.0 * cos(psi) / ((1.0 - d) * (1.0 - d)) * dpsi;
  at->dq = 2.0 * root * dc + c / root * at->dk;
  p[MC_LAMBDA] = lambda;
  p[MC_MU] = mu;
  p[MC_K] = s > 0.0 ? k : 1.0;
  p[MC_M] = m;
  p[MC_Q] = 2.0 * c * root;
  p[MC_CUT] = q[SOFT_CUT] < INFINITY && (p[MC_K] - 1.0) * q[SOFT_CUT] < p[MC_Q] ? q[SOFT_CUT] : INFINITY;
  const PetscReal b[3] = {lambda * (m - 1.0) + 2.0 * mu * m, lambda * (m - 1.0), lambda * (m - 1.0) - 2.0 * mu};
  for (int i = 0; i < 3; ++i) p[MC_R0 + i] = b[i] / (k * b[0] - b[2]);
  p[MC_MEMORY] = 0.0;
  p[MC_NOISE] = 8.0 * PETSC_MACHINE_EPSILON * (k + 1.0) * (lambda + 2.0 * mu);
}

/* Slopes of what the return to the plane gives. */
static inline void soft_slope_plane(const SoftStrength *at, const PetscReal e[3], PetscReal slope[3])
{
  const PetscReal *p = at->p, *r = p + MC_R0, lambda = p[MC_LAMBDA], mu = p[MC_MU], k = p[MC_K], m = p[MC_M];
  const PetscReal first = lambda * (m - 1.0) + 2.0 * mu * m, last = lambda * (m - 1.0) - 2.0 * mu, a = k * first - last;
  const PetscReal db[3] = {(lambda + 2.0 * mu) * at->dm, lambda * at->dm, lambda * at->dm};
  const PetscReal da = at->dk * first + k * db[0] - db[2];
  PetscReal trial[3];
  mc_hooke(p, e, trial);
  const PetscReal f = mc_yield(p, trial), df = at->dk * trial[0] - at->dq;
  for (int i = 0; i < 3; ++i) slope[i] = -df * r[i] - f * (db[i] - r[i] * da) / a;
}

/* ... and to an edge, where tau_1 = g . (e - C base) / (g . C r). */
static inline void soft_slope_line(const SoftStrength *at, McRegion region, const PetscReal e[3],
                                   const PetscReal tau[3], PetscReal slope[3])
{
  const PetscReal *p = at->p, second = region == MC_LINE2 ? 1.0 : 0.0;
  const McEdge edge = mc_edge(p, region);
  const PetscReal g[3] = {0, second * at->dm, at->dm}, r[3] = {0, second * at->dk, at->dk};
  const PetscReal base[3] = {0, -second * p[MC_Q], -p[MC_Q]}, rise[3] = {0, -second * at->dq, -at->dq};
  PetscReal c_base[3], c_rise[3], c_r[3], c_dr[3];
  mc_compliance(p, base, c_base);
  mc_compliance(p, rise, c_rise);
  mc_compliance(p, edge.r, c_r);
  mc_compliance(p, r, c_dr);
  for (int i = 0; i < 3; ++i) c_base[i] = e[i] - c_base[i];
  const PetscReal top = mc_dot(g, c_base) - mc_dot(edge.g, c_rise);
  const PetscReal bottom = mc_dot(g, c_r) + mc_dot(edge.g, c_dr);
  const PetscReal first = (top - tau[0] * bottom) / mc_dot(edge.g, c_r);
  for (int i = 0; i < 3; ++i) slope[i] = first * edge.r[i] + tau[0] * r[i] + rise[i];
}

/* d tau / d x of a region at constant strains. */
static inline void soft_slope(const SoftStrength *at, McRegion region, const PetscReal e[3], const PetscReal tau[3],
                              PetscReal slope[3])
{
  const PetscReal *p = at->p, nu = 0.5 * p[MC_LAMBDA] / (p[MC_LAMBDA] + p[MC_MU]);
  const PetscReal apex = region == MC_APEX ? (at->dq - tau[0] * at->dk) / (p[MC_K] - 1.0) : 0.0;
  for (int i = 0; i < 3; ++i) slope[i] = apex;
  if (region == MC_PLANE) soft_slope_plane(at, e, slope);
  if (region == MC_LINE1 || region == MC_LINE2) soft_slope_line(at, region, e, tau, slope);
  if (region < MC_CUT_EDGE) return;
  slope[2] = at->dk * p[MC_CUT] - at->dq;
  slope[1] = slope[2] * (region == MC_CUT_EDGE ? nu : (region == MC_CUT_CORNER2 ? 1.0 : 0.0));
}

/* Where the table is entered: offset + scale kappa. */
typedef struct {
  PetscReal scale, offset;
} SoftScale;

/* A return at one strength: how far it flows, in which direction n, and d tau / d kappa. */
typedef struct {
  McRegion region;
  PetscReal tau[3], slope[3], flow, n[3], rate; /* rate: d (kappa - kappa_n - flow) / d kappa */
} SoftTry;

/* What differs by no more than this of strains is no shear: as where all that opens does so alike, at the apex, and has
 * no direction along which the strength could be asked for its slope. */
#define SOFT_ROUNDING (8.0 * PETSC_MACHINE_EPSILON)

static inline void soft_try(const PetscReal *q, PetscReal kappa, SoftScale scale, const PetscReal e[3],
                            SoftStrength *at, SoftTry *t)
{
  PetscReal elastic[3], norm = 0.0, size = 0.0, along = 0.0;
  soft_strength(q, PetscMax(scale.offset + scale.scale * kappa, 0.0), at);
  t->region = mc_return(at->p, e, t->tau);
  mc_compliance(at->p, t->tau, elastic);
  const PetscReal mean = (e[0] + e[1] + e[2] - elastic[0] - elastic[1] - elastic[2]) / 3.0;
  for (int i = 0; i < 3; ++i) {
    t->n[i] = t->region == MC_ELASTIC ? 0.0 : e[i] - elastic[i] - mean;
    norm += t->n[i] * t->n[i];
    size += fabs(e[i]) + fabs(elastic[i]);
  }
  norm = sqrt(norm);
  if (norm <= SOFT_ROUNDING * size) norm = 0.0;
  t->flow = sqrt(2.0 / 3.0) * norm;
  soft_slope(at, t->region, e, t->tau, t->slope);
  for (int i = 0; i < 3; ++i) {
    t->n[i] = norm > 0.0 ? sqrt(2.0 / 3.0) * t->n[i] / norm : 0.0;
    t->slope[i] *= scale.scale;
    along += t->n[i] * t->slope[i];
  }
  t->rate = 1.0 + 0.5 * along / q[SOFT_MU];
}

#define SOFT_MOST 100

/* The new kappa, or NAN. Newton's method between bounds; where it leaves them, their middle. A
 * return that would be elastic at the new strength flows less than nothing: the root lies below. */
static inline PetscReal soft_return(const PetscReal *q, PetscReal old, SoftScale scale, const PetscReal e[3],
                                    SoftStrength *at, SoftTry *t)
{
  PetscReal low = old, high = INFINITY, kappa = old;
  soft_try(q, old, scale, e, at, t);
  if (t->region == MC_ELASTIC) return old;
  for (int iteration = 0; iteration < SOFT_MOST; ++iteration) {
    const PetscReal miss = kappa - old - t->flow, noise = 2.0 * PETSC_MACHINE_EPSILON * (kappa + t->flow);
    if (fabs(miss) <= noise || high - low <= noise) return kappa;
    if (miss < 0.0) low = kappa;
    else high = kappa;
    PetscReal next = kappa - miss / t->rate;
    if (!(next > low && next < high)) next = high < INFINITY ? 0.5 * (low + high) : 2.0 * kappa - old + t->flow;
    if (next == kappa) return kappa;
    kappa = next;
    soft_try(q, kappa, scale, e, at, t);
  }
  return NAN;
}

/* d tau_A / d eps_B with the strength's own change. */
static inline void soft_moduli(const PetscReal *q, const SoftStrength *at, const SoftTry *t, PetscReal D[9])
{
  PetscReal grows[3];
  mc_moduli(at->p, t->region, D);
  if (t->region == MC_ELASTIC) return;
  for (int j = 0; j < 3; ++j) {
    const PetscReal along = t->n[0] * D[j] + t->n[1] * D[3 + j] + t->n[2] * D[6 + j];
    grows[j] = (t->n[j] - 0.5 * along / q[SOFT_MU]) / t->rate;
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) D[3 * i + j] += t->slope[i] * grows[j];
}
