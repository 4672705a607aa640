/* Return of principal Kirchhoff stresses to the Mohr-Coulomb surface, cut off at a largest tension
 * if wished.
 *
 * Stresses fall, tension is positive; Hooke's law holds between the principal logarithmic strains
 * and them. The flow rule is non-associated, d eps^p = sum gamma b, on the shear planes a = (k, 0,
 * -1), b = (m, 0, -1) and their neighbours across the edges, and associated on the tension planes
 * tau_1 = T.
 *
 *   shear     PLANE (Clausen's region I); LINE1 where tau_1 = tau_2, r = (1, 1, k) (II); LINE2
 *   where tau_2 = tau_3,
 *             r = (1, k, k) (III); APEX (IV)
 *   tension   CUT_PLANE, tau_1 = T; CUT_LINE, tau_1 = tau_2 = T; CUT_APEX, all T
 *   both      CUT_EDGE, tau_1 = T and tau_3 = k T - q, from CUT_CORNER1 (tau_2 = T) to CUT_CORNER2
 *   (tau_2 = tau_3)
 *
 * No formula divides by k - 1 unless the apex was found to be there: lines are counted from where
 * tau_1 is zero, not from the apex, which for phi = 0 is at infinity. The regions need no boundary
 * planes: the return to the plane leaves the order tau_1 >= tau_2 >= tau_3 if and only if the trial
 * stress lies between p_I-II and p_I-III (they contain the line and the direction of the return).
 * With little dilatancy the flow rule cannot lead to the apex; it is then the return by definition,
 * the continuous one. */
#pragma once
#include <math.h>
#include <petscsys.h>

#define MC_STATE 8 /* b^e, equivalent plastic strain, opening */

/* Packed parameters. */
enum {
  MC_LAMBDA,
  MC_MU,
  MC_K,   /* (1 + sin phi) / (1 - sin phi) */
  MC_M,   /* the same of psi */
  MC_Q,   /* 2 c sqrt k */
  MC_CUT, /* T; infinite if none or beyond the apex */
  MC_R0,  /* direction of the return to the plane, D b / (a . D b) */
  MC_R1,
  MC_R2,
  MC_NOISE,  /* rounding of f at small strains, Pa */
  MC_MEMORY, /* share of an opening that is remembered */
  MC_ONTO1,  /* tau_1 on LINE1 is MC_ONTO1 g . e + MC_FROM1 */
  MC_FROM1,
  MC_ONTO2, /* ... on LINE2 */
  MC_FROM2,
  MC_N_PARAMETERS
};

typedef enum {
  MC_ELASTIC,
  MC_PLANE,
  MC_LINE1,
  MC_LINE2,
  MC_APEX,
  MC_CUT_PLANE,
  MC_CUT_LINE,
  MC_CUT_APEX,
  MC_CUT_EDGE,
  MC_CUT_CORNER1,
  MC_CUT_CORNER2,
  MC_N_REGIONS
} McRegion;

/* Directions of the edges in stress and in potential: rows of a table by region. */
typedef struct {
  PetscReal r[3], g[3];
} McEdge;

static inline McEdge mc_edge(const PetscReal *p, McRegion region)
{
  const PetscReal k = p[MC_K], m = p[MC_M];
  switch (region) {
  case MC_LINE1: return (McEdge){{1, 1, k}, {1, 1, m}};
  case MC_LINE2: return (McEdge){{1, k, k}, {1, m, m}};
  case MC_CUT_EDGE: return (McEdge){{0, 1, 0}, {0, 1, 0}};
  case MC_CUT_LINE: return (McEdge){{0, 0, 1}, {0, 0, 1}};
  default: return (McEdge){{0}, {0}};
  }
}

static inline void mc_hooke(const PetscReal *p, const PetscReal e[3], PetscReal tau[3])
{
  const PetscReal volume = p[MC_LAMBDA] * (e[0] + e[1] + e[2]);
  for (int k = 0; k < 3; ++k) tau[k] = volume + 2.0 * p[MC_MU] * e[k];
}

/* Elastic strains of stresses. */
static inline void mc_compliance(const PetscReal *p, const PetscReal tau[3], PetscReal e[3])
{
  const PetscReal share = p[MC_LAMBDA] / (3.0 * p[MC_LAMBDA] + 2.0 * p[MC_MU]) * (tau[0] + tau[1] + tau[2]);
  for (int k = 0; k < 3; ++k) e[k] = (tau[k] - share) / (2.0 * p[MC_MU]);
}

static inline PetscReal mc_dot(const PetscReal a[3], const PetscReal b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline PetscReal mc_yield(const PetscReal *p, const PetscReal tau[3])
{
  return p[MC_K] * tau[0] - tau[2] - p[MC_Q];
}

/* What rounding alone makes of a stress on the surface: a point at rest there stays elastic. */
static inline PetscReal mc_noise(const PetscReal *p, const PetscReal tau[3])
{
  return p[MC_NOISE] + 4.0 * PETSC_MACHINE_EPSILON * (p[MC_K] * fabs(tau[0]) + fabs(tau[2]) + p[MC_Q]);
}

/* tau_1 on the edge base + tau_1 r that the trial strains e lead to; base is the edge's stress
 * where tau_1 = 0. */
static inline PetscReal mc_on_line(const PetscReal *p, McRegion region, const PetscReal base[3], const PetscReal e[3])
{
  const McEdge edge = mc_edge(p, region);
  PetscReal c_base[3], c_r[3];
  mc_compliance(p, base, c_base);
  mc_compliance(p, edge.r, c_r);
  for (int k = 0; k < 3; ++k) c_base[k] = e[k] - c_base[k];
  return mc_dot(edge.g, c_base) / mc_dot(edge.g, c_r);
}

/* The same as two numbers for LINE1 and LINE2 each, in packed parameters that have all others. */
static inline void mc_prepare_lines(PetscReal *p)
{
  for (int line = 0; line < 2; ++line) {
    const McEdge edge = mc_edge(p, line ? MC_LINE2 : MC_LINE1);
    const PetscReal base[3] = {0, line ? -p[MC_Q] : 0, -p[MC_Q]};
    PetscReal c_base[3], c_r[3];
    mc_compliance(p, base, c_base);
    mc_compliance(p, edge.r, c_r);
    p[MC_ONTO1 + 2 * line] = 1.0 / mc_dot(edge.g, c_r);
    p[MC_FROM1 + 2 * line] = -mc_dot(edge.g, c_base) / mc_dot(edge.g, c_r);
  }
}

/* Shear planes alone, the trial stress being outside. */
static inline McRegion mc_return_shear(const PetscReal *p, const PetscReal e[3], PetscReal tau[3])
{
  const PetscReal k = p[MC_K], q = p[MC_Q], f = mc_yield(p, tau);
  PetscReal t[3], t1;
  for (int i = 0; i < 3; ++i) t[i] = tau[i] - f * p[MC_R0 + i];
  if (t[0] >= t[1] && t[1] >= t[2]) {
    for (int i = 0; i < 3; ++i) tau[i] = t[i];
    return MC_PLANE;
  }
  if (t[1] > t[0] && (k - 1.0) * (t1 = mc_on_line(p, MC_LINE1, (PetscReal[3]){0, 0, -q}, e)) <= q) {
    tau[0] = tau[1] = t1;
    tau[2] = k * t1 - q;
    return MC_LINE1;
  }
  if (t[2] > t[1] && (k - 1.0) * (t1 = mc_on_line(p, MC_LINE2, (PetscReal[3]){0, -q, -q}, e)) <= q) {
    tau[0] = t1;
    tau[1] = tau[2] = k * t1 - q;
    return MC_LINE2;
  }
  tau[0] = tau[1] = tau[2] = q / (k - 1.0);
  return MC_APEX;
}

/* Tension planes alone: the nearest point of all tau <= T. */
static inline McRegion mc_return_tension(const PetscReal *p, const PetscReal e[3], PetscReal tau[3])
{
  const PetscReal lambda = p[MC_LAMBDA], mu = p[MC_MU], T = p[MC_CUT];
  const PetscReal drop = lambda / (lambda + 2.0 * mu) * (tau[0] - T);
  tau[0] = T;
  tau[1] -= drop;
  tau[2] -= drop;
  if (tau[1] <= T) return MC_CUT_PLANE;
  tau[1] = T;
  /* E e3 + 2 nu T */
  tau[2] = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu) * e[2] + lambda / (lambda + mu) * T;
  if (tau[2] <= T) return MC_CUT_LINE;
  tau[2] = T;
  return MC_CUT_APEX;
}

/* Both: eps_2 does not flow on the edge between them; its corners take what lies beyond. */
static inline McRegion mc_return_edge(const PetscReal *p, const PetscReal e[3], PetscReal tau[3])
{
  const PetscReal lambda = p[MC_LAMBDA], mu = p[MC_MU], T = p[MC_CUT], S = p[MC_K] * T - p[MC_Q];
  const PetscReal young = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu), nu = 0.5 * lambda / (lambda + mu);
  const PetscReal middle = young * e[1] + nu * (T + S);
  tau[0] = T;
  tau[1] = PetscMax(S, PetscMin(T, middle));
  tau[2] = S;
  return middle > T ? MC_CUT_CORNER1 : (middle < S ? MC_CUT_CORNER2 : MC_CUT_EDGE);
}

/* Stresses of the trial strains e (falling), on the surface or inside. */
static inline McRegion mc_return(const PetscReal *p, const PetscReal e[3], PetscReal tau[3])
{
  PetscReal trial[3];
  mc_hooke(p, e, trial);
  for (int k = 0; k < 3; ++k) tau[k] = trial[k];
  const PetscReal noise = mc_noise(p, trial);
  const PetscBool shear = mc_yield(p, trial) > noise, tension = trial[0] - p[MC_CUT] > noise;
  if (!shear && !tension) return MC_ELASTIC;
  if (shear) {
    const McRegion region = mc_return_shear(p, e, tau);
    if (tau[0] <= p[MC_CUT]) return region;
    for (int k = 0; k < 3; ++k) tau[k] = trial[k];
  }
  if (trial[0] > p[MC_CUT]) {
    const McRegion region = mc_return_tension(p, e, tau);
    if (mc_yield(p, tau) <= 0.0) return region;
  }
  return mc_return_edge(p, e, tau);
}

/* Moduli d tau_A / d eps_B of the region. */
static inline void mc_moduli(const PetscReal *p, McRegion region, PetscReal D[9])
{
  const PetscReal lambda = p[MC_LAMBDA], mu = p[MC_MU], k = p[MC_K];
  const McEdge edge = mc_edge(p, region);
  PetscReal left[3] = {0}, right[3] = {0}, hooke = 0.0;
  if (region == MC_ELASTIC || region == MC_PLANE || region == MC_CUT_PLANE) hooke = 1.0;
  if (region == MC_PLANE)
    for (int i = 0; i < 3; ++i) {
      left[i] = -p[MC_R0 + i];
      right[i] = lambda * (k - 1.0) + (i == 0 ? 2.0 * mu * k : 0.0) - (i == 2 ? 2.0 * mu : 0.0);
    }
  else if (region == MC_CUT_PLANE)
    for (int i = 0; i < 3; ++i) {
      right[i] = lambda + (i == 0 ? 2.0 * mu : 0.0);
      left[i] = -right[i] / (lambda + 2.0 * mu);
    }
  else if (edge.g[0] + edge.g[1] + edge.g[2] > 0.0) {
    PetscReal c_r[3];
    mc_compliance(p, edge.r, c_r);
    const PetscReal scale = 1.0 / mc_dot(edge.g, c_r);
    for (int i = 0; i < 3; ++i) {
      left[i] = edge.r[i];
      right[i] = scale * edge.g[i];
    }
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) D[3 * i + j] = hooke * (lambda + (i == j ? 2.0 * mu : 0.0)) + left[i] * right[j];
}
