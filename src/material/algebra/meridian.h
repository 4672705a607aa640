/* Hencky solids that yield on a surface of revolution about the axis of pressure: a return acts within the meridian
 * (p, R) and keeps the direction of the shear stress s.
 *
 *   p = tr tau / 3,  R = sqrt(s : s / 2) */
#pragma once
#include "material/algebra/hencky.h"

/* Before the return; d: deviator of the principal strains. */
typedef struct {
  Lanes p, R, d[3];
} MeridianTrial;

/* What the return leaves of it, with derivatives by the trial p and R; ratio: R over R_tr. */
typedef struct {
  Lanes p, ratio, p_p, p_R, R_p, R_R;
} Meridian;

/* An option of the return where mask. */
LANES_INLINE void meridian_take(const LaneBits *mask, const Meridian *yes, Meridian *to)
{
  const Lanes *from = &yes->p;
  Lanes *at = &to->p;
  for (size_t k = 0; k < sizeof *to / sizeof(Lanes); ++k) lanes_select(mask, &from[k], &at[k], &at[k]);
}

/* Of the bulk modulus K, Pa, the shear modulus G, Pa, and principal strains e. */
LANES_INLINE void meridian_trial(PetscReal K, PetscReal G, const Lanes e[3], MeridianTrial *t)
{
  const Lanes mean = (e[0] + e[1] + e[2]) / 3.0;
  t->p = 3.0 * K * mean;
  for (int k = 0; k < 3; ++k) t->d[k] = e[k] - mean;
  const Lanes norm2 = 2.0 * (t->d[0] * t->d[0] + t->d[1] * t->d[1] + t->d[2] * t->d[2]);
  lanes_sqrt(&norm2, &t->R);
  t->R *= G;
}

/* Stress, elastic strains and, if wanted, moduli of what is left; after, before: equivalent plastic strain. */
LANES_INLINE void meridian_finish(PetscReal K, PetscReal G, PetscBool moduli, const MeridianTrial *t, const Meridian *m,
                                  const Lanes *before, Lanes *after, HenckyReturn *r)
{
  Lanes n[3];
  r->good = m->p == m->p; /* NOLINT(misc-redundant-expression): not where it is no number */
  for (int k = 0; k < 3; ++k) {
    r->tau[k] = m->p + 2.0 * G * m->ratio * t->d[k];
    r->elastic[k] = m->p / (3.0 * K) + m->ratio * t->d[k];
    n[k] = 2.0 * G * t->d[k] / (t->R + 1e-300); /* s / R */
    r->r[k] = 2.0 * G * m->ratio;
  }
  *after = *before + (t->R - m->ratio * t->R) / (sqrt(3.0) * G);
  lanes_select(&r->plastic, after, before, after);
  if (!moduli) return;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r->D[3 * i + j] = K * m->p_p + G * m->p_R * n[j] + K * m->R_p * n[i] + G * (m->R_R - m->ratio) * n[i] * n[j] +
                        2.0 * G * m->ratio * ((i == j ? 1.0 : 0.0) - 1.0 / 3.0);
}

/* The state that bears the Cauchy stress sigma, and where that stands in the meridian. */
static inline void meridian_initial(PetscReal K, PetscReal G, const PetscReal sigma[6], PetscReal *state, PetscReal *p,
                                    PetscReal *R)
{
  PetscReal tau[3], norm2 = 0.0;
  hencky_stress(K - 2.0 / 3.0 * G, G, sigma, tau, state);
  state[6] = 0.0;
  *p = (tau[0] + tau[1] + tau[2]) / 3.0;
  for (int a = 0; a < 3; ++a) norm2 += 0.5 * PetscSqr(tau[a] - *p);
  *R = sqrt(norm2);
}
