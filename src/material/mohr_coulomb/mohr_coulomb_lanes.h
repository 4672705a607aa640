/* Return and moduli of the Mohr-Coulomb law in principal axes, eight points side by side. */
#pragma once
#include "material/mohr_coulomb/mohr_coulomb_return.h"
#include "material/algebra/principal_lanes.h"

/* Stresses on the surface or inside. Most points that flow are on the shear plane: that return is
 * made here, others point by point. */
LANES_INLINE void mc_return_lanes(const PetscReal *p, const Lanes e[3], Lanes tau[3], LaneBits *regions)
{
  const Lanes volume = p[MC_LAMBDA] * (e[0] + e[1] + e[2]);
  Lanes size[2], t[3];
  for (int k = 0; k < 3; ++k) tau[k] = volume + 2.0 * p[MC_MU] * e[k];
  lanes_abs(&tau[0], &size[0]);
  lanes_abs(&tau[2], &size[1]);
  const Lanes noise = p[MC_NOISE] + 4.0 * PETSC_MACHINE_EPSILON * (p[MC_K] * size[0] + size[1] + p[MC_Q]);
  const Lanes f = p[MC_K] * tau[0] - tau[2] - p[MC_Q];
  const LaneBits shear = f > noise, beyond = shear | (tau[0] - p[MC_CUT] > noise);
  *regions = beyond & 0;
  if (!lanes_any(&beyond)) return;
  for (int k = 0; k < 3; ++k) t[k] = tau[k] - f * p[MC_R0 + k];
  const LaneBits plane = shear & (t[0] >= t[1]) & (t[1] >= t[2]) & (t[0] <= p[MC_CUT]), others = beyond & ~plane;
  for (int k = 0; k < 3; ++k) lanes_select(&plane, &t[k], &tau[k], &tau[k]);
  *regions = plane & MC_PLANE;
  if (!lanes_any(&others)) return;
  for (int l = 0; l < LANES; ++l) {
    if (!others[l]) continue;
    PetscReal one[3];
    (*regions)[l] = mc_return(p, (PetscReal[3]){e[0][l], e[1][l], e[2][l]}, one);
    for (int k = 0; k < 3; ++k) tau[k][l] = one[k];
  }
}

/* Moduli d tau_A / d eps_B of each point's region. */
LANES_INLINE void mc_moduli_lanes(const PetscReal *p, const LaneBits *regions, Lanes D[9])
{
  const LaneBits plane = *regions == MC_PLANE, others = *regions > MC_PLANE;
  PetscReal elastic[9], plastic[9];
  mc_moduli(p, MC_ELASTIC, elastic);
  mc_moduli(p, MC_PLANE, plastic);
  for (int k = 0; k < 9; ++k) {
    const Lanes yes = (Lanes){0} + plastic[k], no = (Lanes){0} + elastic[k];
    lanes_select(&plane, &yes, &no, &D[k]);
  }
  if (!lanes_any(&others)) return;
  for (int l = 0; l < LANES; ++l) {
    if (!others[l]) continue;
    mc_moduli(p, (McRegion)(*regions)[l], plastic);
    for (int k = 0; k < 9; ++k) D[k][l] = plastic[k];
  }
}

/* (tau_A - tau_B) / (e_A - e_B) of a pair: rise over x. Elastic differences keep 2 mu exactly,
 * equal stresses give 0; in between the return only shrinks differences, which bounds what rounding
 * can do to nearly equal strains. */
LANES_INLINE void mc_difference_lanes(const PetscReal *p, const LaneBits *elastic, const Lanes *x, const Lanes *rise,
                                      Lanes *r)
{
  const Lanes none = {0}, full = none + 2.0 * p[MC_MU], slope = *rise / *x;
  const LaneBits equal = *rise == 0.0, less = *rise < full * *x;
  lanes_select(&less, &slope, &full, r);
  lanes_select(&equal, &none, r, r);
  lanes_select(elastic, &full, r, r);
}

/* What is open counts as strain before anything bears: b^e of n components as if it were closed by
 * elastic strain alone. */
LANES_INLINE void mc_with_opening(const Lanes *opening, int n, Lanes *b)
{
  const LaneBits open = *opening > 0.0;
  if (!lanes_any(&open)) return;
  const Lanes twice = (2.0 / 3.0) * *opening;
  Lanes factor;
  lanes_exp(&twice, &factor);
  for (int k = 0; k < n; ++k) b[k] *= factor;
}

/* What is open at the end: at the apex all volume beyond that of the apex, of what opened now the
 * share that is remembered. */
LANES_INLINE void mc_opening(const PetscReal *p, const LaneBits *regions, const Lanes strain[3], const Lanes tau[3],
                             const Lanes *before, Lanes *opening)
{
  const Lanes none = {0};
  const PetscReal three_bulk = 3.0 * p[MC_LAMBDA] + 2.0 * p[MC_MU];
  *opening = none;
  if (!(p[MC_MEMORY] > 0.0)) return;
  const Lanes gap = strain[0] + strain[1] + strain[2] - (tau[0] + tau[1] + tau[2]) / three_bulk;
  const Lanes wider = *before + p[MC_MEMORY] * (gap - *before);
  const LaneBits apex = ((*regions == MC_APEX) | (*regions == MC_CUT_APEX)) & (gap > 0.0), opens = gap > *before;
  lanes_select(&opens, &wider, &gap, opening);
  lanes_select(&apex, opening, &none, opening);
}
