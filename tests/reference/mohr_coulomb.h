/* The Mohr-Coulomb law for one point, as a textbook writes it (docs/theory.md, "Mohr-Coulomb";
 * thesis section 3.3).
 *
 * Read this first: src/material/mohr_coulomb does the same for eight points at once, with closed
 * formulas for every region. Here the stress that is too large returns along the flow of planes
 * until no plane is violated: of one (a face), of two (an edge) or of three (a corner), and if none
 * of them does, to the apex. Nothing of src is used, so that it is the law's oracle. */
#pragma once
#include <math.h>

typedef struct {
  double lambda, mu; /* Lamé's constants, Pa */
  double phi, psi;   /* angles of friction and of dilatancy, rad */
  double c, T;       /* cohesion and largest tension, Pa; T infinite: none but the apex */
  double memory;     /* share of an opening that has to close again, 0 to 1 */
} TextbookSoil;

/* Where the stress returns to: so many planes of those numbered below. */
enum { FACE, RIGHT, LEFT, TENSION_1, TENSION_2, TENSION_3, PLANES };
static const struct {
  const char *name;
  int n, plane[3];
} textbook_regions[] = {
  {"elastic", 0, {0}},
  {"face", 1, {FACE}},
  {"edge tau_1 = tau_2", 2, {FACE, RIGHT}},
  {"edge tau_2 = tau_3", 2, {FACE, LEFT}},
  {"cut-off", 1, {TENSION_1}},
  {"edge of the cut-off", 2, {TENSION_1, TENSION_2}},
  {"corner of the cut-off", 3, {TENSION_1, TENSION_2, TENSION_3}},
  {"face and cut-off", 2, {FACE, TENSION_1}},
  {"face and edge of the cut-off", 3, {FACE, TENSION_1, TENSION_2}},
  {"edge tau_1 = tau_2 and cut-off", 3, {FACE, RIGHT, TENSION_1}},
  {"edge tau_2 = tau_3 and cut-off", 3, {FACE, LEFT, TENSION_1}},
  {"apex", 0, {0}},
};
enum { TEXTBOOK_CUT_APEX = 6, TEXTBOOK_APEX = 11, TEXTBOOK_REGIONS };

/* Values and directions (columns of v) of a symmetric tensor: Jacobi's rotations, then sorted, the
 * largest first. */
static inline void textbook_principal(double a[3][3], double value[3], double v[3][3])
{
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) v[i][j] = i == j;
  for (int turn = 0; turn < 60; ++turn) {
    const int p = turn % 3, q = (p + 1) % 3;
    if (a[p][q] == 0) continue;
    const double apart = a[q][q] - a[p][p], angle = 0.5 * atan2(apart < 0 ? -2 * a[p][q] : 2 * a[p][q], fabs(apart));
    const double c = cos(angle), s = sin(angle);
    for (int k = 0; k < 3; ++k) { /* columns */
      const double x = a[k][p], y = a[k][q], z = v[k][p], w = v[k][q];
      a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
      v[k][p] = c * z - s * w, v[k][q] = s * z + c * w;
    }
    for (int k = 0; k < 3; ++k) { /* rows */
      const double x = a[p][k], y = a[q][k];
      a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
    }
  }
  for (int i = 0; i < 3; ++i) value[i] = a[i][i];
  for (int pass = 0; pass < 3; ++pass)
    for (int i = 0; i < 2; ++i)
      if (value[i] < value[i + 1]) {
        const double kept = value[i];
        value[i] = value[i + 1], value[i + 1] = kept;
        for (int k = 0; k < 3; ++k) {
          const double w = v[k][i];
          v[k][i] = v[k][i + 1], v[k][i + 1] = w;
        }
      }
}

/* Hooke's law in principal values. */
static inline void textbook_hooke(const TextbookSoil *m, const double e[3], double tau[3])
{
  for (int i = 0; i < 3; ++i) tau[i] = m->lambda * (e[0] + e[1] + e[2]) + 2 * m->mu * e[i];
}

/* x of A x = x, n <= 3, by elimination with pivots; 0 if A is singular. */
static inline int textbook_solve(int n, double A[3][3], double x[3])
{
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i)
      if (fabs(A[i][k]) > fabs(A[best][k])) best = i;
    for (int j = 0; j < n; ++j) {
      const double kept = A[k][j];
      A[k][j] = A[best][j], A[best][j] = kept;
    }
    const double kept = x[k];
    x[k] = x[best], x[best] = kept;
    if (fabs(A[k][k]) < 1e-9) return 0;
    for (int i = 0; i < n; ++i) {
      const double factor = i == k ? 0 : A[i][k] / A[k][k];
      for (int j = 0; j < n; ++j) A[i][j] -= factor * A[k][j];
      x[i] -= factor * x[k];
    }
  }
  for (int k = 0; k < n; ++k) x[k] /= A[k][k];
  return 1;
}

/* The planes a . tau = limit with their flow b: those of shear next to tau_1 >= tau_2 >= tau_3, and
 * those of tension. */
static inline void textbook_planes(const TextbookSoil *m, double a[PLANES][3], double b[PLANES][3],
                                   double limit[PLANES])
{
  const double k = (1 + sin(m->phi)) / (1 - sin(m->phi)), d = (1 + sin(m->psi)) / (1 - sin(m->psi));
  const double shear[3][3] = {{k, 0, -1}, {0, k, -1}, {k, -1, 0}}, flow[3][3] = {{d, 0, -1}, {0, d, -1}, {d, -1, 0}};
  for (int s = 0; s < PLANES; ++s) {
    for (int i = 0; i < 3; ++i) {
      a[s][i] = s < TENSION_1 ? shear[s][i] : i == s - TENSION_1;
      b[s][i] = s < TENSION_1 ? flow[s][i] : i == s - TENSION_1;
    }
    limit[s] = s < TENSION_1 ? 2 * m->c * sqrt(k) : m->T;
  }
}

static inline double textbook_dot(const double x[3], const double y[3])
{
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

/* tau = trial - sum gamma_s D b_s on the planes of the region; 0 if a gamma is negative or a plane
 * is violated. */
static inline int textbook_try(const TextbookSoil *m, int region, const double trial[3], double tau[3])
{
  const int n = textbook_regions[region].n, *plane = textbook_regions[region].plane;
  double a[PLANES][3], b[PLANES][3], limit[PLANES], A[3][3], gamma[3], flow[3] = {0}, Db[3];
  textbook_planes(m, a, b, limit);
  const double size = fabs(trial[0]) + fabs(trial[1]) + fabs(trial[2]) + limit[FACE];
  for (int s = 0; s < n; ++s) {
    if (limit[plane[s]] == INFINITY) return 0;
    gamma[s] = (textbook_dot(a[plane[s]], trial) - limit[plane[s]]) / m->mu;
    for (int t = 0; t < n; ++t) {
      textbook_hooke(m, b[plane[t]], Db);
      A[s][t] = textbook_dot(a[plane[s]], Db) / m->mu;
    }
  }
  if (!textbook_solve(n, A, gamma)) return 0;
  for (int s = 0; s < n; ++s) {
    if (gamma[s] < -1e-11 * size / m->mu) return 0;
    for (int i = 0; i < 3; ++i) flow[i] += gamma[s] * b[plane[s]][i];
  }
  textbook_hooke(m, flow, Db);
  for (int i = 0; i < 3; ++i) tau[i] = trial[i] - Db[i];
  for (int s = 0; s < PLANES; ++s)
    if (textbook_dot(a[s], tau) - limit[s] > 1e-11 * size * a[FACE][0]) return 0;
  return 1;
}

/* Principal stresses of falling trial strains; returns the region. */
static inline int textbook_return(const TextbookSoil *m, const double e[3], double tau[3])
{
  double trial[3];
  textbook_hooke(m, e, trial);
  for (int region = 0; region < TEXTBOOK_APEX; ++region)
    if (textbook_try(m, region, trial, tau)) return region;
  tau[0] = tau[1] = tau[2] = m->c / tan(m->phi);
  return TEXTBOOK_APEX;
}

/* The gap that is left when the strain e became `elastic` at the apex: what it grows by is
 * remembered in part, what it shrinks by is gone. */
static inline double textbook_gap(const TextbookSoil *m, const double e[3], const double elastic[3], double gap)
{
  double apart = 0;
  for (int i = 0; i < 3; ++i) apart += e[i] - elastic[i];
  const double grown = apart - gap;
  return fmax(0, gap + (grown > 0 ? m->memory * grown : grown));
}

/* One step: b = F b F^T, its logarithmic principal strains and a third of the gap in each, the
 * return, and b, the plastic strain and the gap of what is left. */
static inline int textbook_update(const TextbookSoil *m, double F[3][3], double b[3][3], double *plastic, double *gap,
                                  double tau[3][3])
{
  const double d = (1 + sin(m->psi)) / (1 - sin(m->psi));
  double Fb[3][3], trial[3][3], stretch2[3], v[3][3], e[3], elastic[3], principal[3], norm2 = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) Fb[i][j] = F[i][0] * b[0][j] + F[i][1] * b[1][j] + F[i][2] * b[2][j];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) trial[i][j] = textbook_dot(Fb[i], F[j]);
  textbook_principal(trial, stretch2, v);
  for (int i = 0; i < 3; ++i) e[i] = 0.5 * log(stretch2[i]) + *gap / 3;
  const int region = textbook_return(m, e, principal);
  const double volume = (principal[0] + principal[1] + principal[2]) / (3 * m->lambda + 2 * m->mu);
  for (int i = 0; i < 3; ++i) elastic[i] = (principal[i] - m->lambda * volume) / (2 * m->mu);
  *gap = region == TEXTBOOK_APEX || region == TEXTBOOK_CUT_APEX ? textbook_gap(m, e, elastic, *gap) : 0;
  for (int i = 0; i < 3; ++i) {
    norm2 += (e[i] - elastic[i] - *gap / 3) * (e[i] - elastic[i] - *gap / 3);
    stretch2[i] = exp(2 * elastic[i]);
  }
  *plastic += sqrt(norm2 / (1 + d * d));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      b[i][j] = tau[i][j] = 0;
      for (int k = 0; k < 3; ++k) {
        b[i][j] += stretch2[k] * v[i][k] * v[j][k];
        tau[i][j] += principal[k] * v[i][k] * v[j][k];
      }
    }
  return region;
}
