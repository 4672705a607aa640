/* Return and moduli of the Mohr-Coulomb law in principal axes, eight points side by side. */
#pragma once
#include "material/mohr_coulomb/mohr_coulomb_return.h"
#include "material/algebra/principal_lanes.h"

/* mc_return_shear of those that the plane t does not take: edges and the apex; what the cut-off takes from them
 * is left to mc_return. `others` are those that still need a return. */
LANES_INLINE void mc_return_edges(const PetscReal *p, const Lanes e[3], const Lanes t[3], Lanes tau[3],
                                  LaneBits *regions, LaneBits *others)
{
  const PetscReal k = p[MC_K], m = p[MC_M], q = p[MC_Q];
  const Lanes first = p[MC_ONTO1] * (e[0] + e[1] + m * e[2]) + p[MC_FROM1];
  const Lanes second = p[MC_ONTO2] * (e[0] + m * (e[1] + e[2])) + p[MC_FROM2];
  const LaneBits on_first = (t[1] > t[0]) & ((k - 1.0) * first <= q);
  const LaneBits on_second = ~on_first & (t[2] > t[1]) & ((k - 1.0) * second <= q);
  const Lanes apex = (Lanes){0} + q / (k - 1.0), low1 = k * first - q, low2 = k * second - q;
  Lanes s[3];
  lanes_select(&on_second, &second, &apex, &s[0]);
  lanes_select(&on_second, &low2, &apex, &s[1]);
  s[2] = s[1];
  lanes_select(&on_first, &first, &s[0], &s[0]);
  lanes_select(&on_first, &first, &s[1], &s[1]);
  lanes_select(&on_first, &low1, &s[2], &s[2]);
  const LaneBits done = *others & (s[0] <= p[MC_CUT]);
  const LaneBits region = (on_first & MC_LINE1) | (on_second & MC_LINE2) | (~(on_first | on_second) & MC_APEX);
  for (int i = 0; i < 3; ++i) lanes_select(&done, &s[i], &tau[i], &tau[i]);
  *regions |= done & region;
  *others &= ~done;
}

/* Stresses on the surface or inside; the cut-off's are found point by point. */
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
  const LaneBits plane = shear & (t[0] >= t[1]) & (t[1] >= t[2]) & (t[0] <= p[MC_CUT]),
                 ordered = (t[0] >= t[1]) & (t[1] >= t[2]);
  LaneBits edges = shear & ~ordered, others = beyond & ~plane;
  for (int k = 0; k < 3; ++k) lanes_select(&plane, &t[k], &tau[k], &tau[k]);
  *regions = plane & MC_PLANE;
  if (!lanes_any(&others)) return;
  others &= ~edges;
  mc_return_edges(p, e, t, tau, regions, &edges);
  others |= edges;
  if (!lanes_any(&others)) return;
  for (int l = 0; l < LANES; ++l) {
    if (!others[l]) continue;
    PetscReal one[3];
    (*regions)[l] = mc_return(p, (PetscReal[3]){e[0][l], e[1][l], e[2][l]}, one);
    for (int k = 0; k < 3; ++k) tau[k][l] = one[k];
  }
}

/* Moduli d tau_A / d eps_B of each point's region: those of shear for all at once, of what the cut-off takes point by
 * point. */
LANES_INLINE void mc_moduli_lanes(const PetscReal *p, const LaneBits *regions, Lanes D[9])
{
  const LaneBits elastic = *regions == MC_ELASTIC, yields = ~elastic;
  PetscReal of[9];
  mc_moduli(p, MC_ELASTIC, of);
  for (int k = 0; k < 9; ++k) D[k] = (Lanes){0} + of[k];
  if (!lanes_any(&yields)) return;
  for (McRegion region = MC_PLANE; region <= MC_APEX; ++region) {
    const LaneBits here = *regions == (int64_t)region;
    if (region != MC_PLANE && !lanes_any(&here)) continue;
    mc_moduli(p, region, of);
    for (int k = 0; k < 9; ++k) {
      const Lanes one = (Lanes){0} + of[k];
      lanes_select(&here, &one, &D[k], &D[k]);
    }
  }
  const LaneBits cut = *regions > MC_APEX;
  if (!lanes_any(&cut)) return;
  for (int l = 0; l < LANES; ++l) {
    if (!cut[l]) continue;
    mc_moduli(p, (McRegion)(*regions)[l], of);
    for (int k = 0; k < 9; ++k) D[k][l] = of[k];
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
