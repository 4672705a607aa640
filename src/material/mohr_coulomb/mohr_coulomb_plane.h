/* The Mohr-Coulomb law where increments and elastic strains do not turn z: one turn finds the
 * principal axes A and B in the plane, z is the third, and only the moduli of the plane are made;
 * with a `hoop`, where z strains by itself, those of z, too. What is not made here is in
 * mohr_coulomb.c. */
#pragma once
#include "material/mohr_coulomb/mohr_coulomb_lanes.h"

/* A, B and z; B is A turned by a right angle. */
enum { MC_A, MC_B, MC_Z };

/* Where 11, 22 and 12 stand among 11, 22, 33 and 12. */
static const int mc_plane_row[3] = {0, 1, 3};

typedef struct {
  Lanes b[4], stretch2[3], strain[3]; /* b: 11, 22, 33, 12 */
  Lanes n_AA[3];                      /* 11, 22 and 12 of n_A n_A; n_B n_B has 22, 11 and -12 */
  Lanes det;
  LaneBits finite;
  LaneBits z_first, z_last; /* where z stands among the falling strains, with A before B */
} PlaneTrial;

/* b = f b f^T, f: xx xy yx yy zz; PETSC_FALSE if a point has shear strains out of the plane. */
LANES_INLINE PetscBool mc_plane_push(const PetscBool hoop, const Lanes f[5], const Lanes old[MC_STATE], PlaneTrial *t)
{
  const LaneBits out = (old[4] != 0.0) | (old[5] != 0.0);
  if (lanes_any(&out)) return PETSC_FALSE;
  const Lanes x0 = f[0] * old[0] + f[1] * old[3], x1 = f[0] * old[3] + f[1] * old[1];
  const Lanes y0 = f[2] * old[0] + f[3] * old[3], y1 = f[2] * old[3] + f[3] * old[1];
  t->b[0] = x0 * f[0] + x1 * f[1];
  t->b[1] = y0 * f[2] + y1 * f[3];
  t->b[2] = hoop ? f[4] * f[4] * old[2] : old[2];
  t->b[3] = x0 * f[2] + x1 * f[3];
  mc_with_opening(&old[7], 4, t->b);
  t->det = f[0] * f[3] - f[1] * f[2];
  if (hoop) t->det *= f[4];
  return PETSC_TRUE;
}

/* Squares of the stretches along A and B, A the larger, and n_A n_A and n_B n_B in closed form; who is alike along all
 * axes has A along x. */
LANES_INLINE void mc_plane_axes(PlaneTrial *t)
{
  const Lanes none = {0}, most = none + 0.5;
  const Lanes middle = 0.5 * (t->b[0] + t->b[1]), h = 0.5 * (t->b[0] - t->b[1]), square = h * h + t->b[3] * t->b[3];
  const LaneBits alike = square <= 1e-36 * (t->b[0] * t->b[1]);
  Lanes root = none, cos, sin;
  lanes_sqrt(&square, &root);
  t->stretch2[MC_A] = middle + root;
  t->stretch2[MC_B] = middle - root;
  t->stretch2[MC_Z] = t->b[2];
  const Lanes half = 0.5 / root;
  cos = half * h;
  sin = half * t->b[3];
  lanes_select(&alike, &most, &cos, &cos);
  lanes_select(&alike, &none, &sin, &t->n_AA[2]);
  t->n_AA[0] = 0.5 + cos;
  t->n_AA[1] = 0.5 - cos;
}

LANES_INLINE PetscBool mc_plane_trial(const PetscBool hoop, const Lanes f[5], const Lanes old[MC_STATE], PlaneTrial *t)
{
  const Lanes one = (Lanes){0} + 1.0, none = {0};
  Lanes size, sum = none;
  if (!mc_plane_push(hoop, f, old, t)) return PETSC_FALSE;
  for (int k = 0; k < 4; ++k) {
    lanes_abs(&t->b[k], &size);
    sum += size;
  }
  t->finite = (sum * sum <= PETSC_MAX_REAL) & (t->det <= PETSC_MAX_REAL) & (t->det > 0.0);
  for (int k = 0; k < 4; ++k) lanes_select(&t->finite, &t->b[k], k < 3 ? &one : &none, &t->b[k]);
  mc_plane_axes(t);
  t->finite &= (t->stretch2[MC_B] > 0.0) & (t->b[2] > 0.0);
  for (int a = 0; a < 3; ++a) {
    lanes_log_near(&t->stretch2[a], &t->strain[a]);
    t->strain[a] *= 0.5;
  }
  t->z_first = t->strain[MC_A] < t->strain[MC_Z];
  t->z_last = ~(t->strain[MC_B] < t->strain[MC_Z]);
  return PETSC_TRUE;
}

/* to = what belongs to the place of A, B or z: first if z stands first, last if it stands last,
 * else middle. */
LANES_INLINE void mc_plane_pick(const PlaneTrial *t, const Lanes *first, const Lanes *middle, const Lanes *last,
                                Lanes *to)
{
  lanes_select(&t->z_last, last, middle, to);
  lanes_select(&t->z_first, first, to, to);
}

/* Stresses along A, B and z from the return of falling strains. */
LANES_INLINE void mc_plane_return(const PetscReal *p, const PlaneTrial *t, Lanes tau[3], LaneBits *regions)
{
  const Lanes *e = t->strain;
  Lanes falling[3], back[3];
  mc_plane_pick(t, &e[MC_Z], &e[MC_A], &e[MC_A], &falling[0]);
  mc_plane_pick(t, &e[MC_A], &e[MC_Z], &e[MC_B], &falling[1]);
  mc_plane_pick(t, &e[MC_B], &e[MC_B], &e[MC_Z], &falling[2]);
  mc_return_lanes(p, falling, back, regions);
  mc_plane_pick(t, &back[1], &back[0], &back[0], &tau[MC_A]);
  mc_plane_pick(t, &back[2], &back[2], &back[1], &tau[MC_B]);
  mc_plane_pick(t, &back[0], &back[1], &back[2], &tau[MC_Z]);
}

/* value along A, B and z as a tensor: 11, 22, 33, 12. */
LANES_INLINE void mc_plane_tensor(const PlaneTrial *t, const Lanes value[3], Lanes s[4])
{
  const Lanes rise = value[MC_A] - value[MC_B];
  s[0] = value[MC_B] + rise * t->n_AA[0];
  s[1] = value[MC_B] + rise * t->n_AA[1];
  s[2] = value[MC_Z];
  s[3] = rise * t->n_AA[2];
}

/* b^e, the equivalent plastic strain and the opening, which `state` brings from before; an elastic
 * point keeps its trial b. */
LANES_INLINE void mc_plane_state(const PetscReal *p, const PlaneTrial *t, const Lanes tau[3], const LaneBits *regions,
                                 Lanes state[MC_STATE])
{
  const Lanes share = p[MC_LAMBDA] / (3.0 * p[MC_LAMBDA] + 2.0 * p[MC_MU]) * (tau[0] + tau[1] + tau[2]), none = {0};
  const LaneBits plastic = *regions != MC_ELASTIC;
  const Lanes before = state[7];
  const PetscReal per_twice_mu = 0.5 / p[MC_MU];
  Lanes stretch2[3], b[4], norm2 = none, flow;
  for (int k = 0; k < 4; ++k) state[k] = t->b[k];
  state[4] = state[5] = state[7] = none;
  if (!lanes_any(&plastic)) return;
  mc_opening(p, regions, t->strain, tau, &before, &state[7]);
  for (int a = 0; a < 3; ++a) {
    const Lanes elastic = (tau[a] - share) * per_twice_mu, twice = 2.0 * elastic;
    const Lanes plastic_strain = t->strain[a] - elastic - (1.0 / 3.0) * state[7];
    norm2 += plastic_strain * plastic_strain;
    lanes_exp_near(&twice, &stretch2[a]);
  }
  mc_plane_tensor(t, stretch2, b);
  norm2 *= 1.0 / (1.0 + p[MC_M] * p[MC_M]);
  lanes_sqrt(&norm2, &norm2);
  lanes_select(&plastic, &norm2, &none, &flow);
  state[6] += flow;
  for (int k = 0; k < 4; ++k) lanes_select(&plastic, &b[k], &state[k], &state[k]);
}

/* d tau_i / d eps_j of i and j among A, B and z, from those of falling strains (3 x 3). */
LANES_INLINE void mc_plane_modulus(const PlaneTrial *t, const Lanes D[9], const int i, const int j, Lanes *to)
{
  /* of A, B, z: z first, in the middle, last */
  static const int place[3][3] = {{1, 2, 0}, {0, 2, 1}, {0, 1, 2}};
  mc_plane_pick(t, &D[3 * place[0][i] + place[0][j]], &D[3 * place[1][i] + place[1][j]],
                &D[3 * place[2][i] + place[2][j]], to);
}

/* Row and column of 33 among the moduli (4 x 4); A, B: 11, 22 and 12 of n_A n_A and n_B n_B. */
LANES_INLINE void mc_hoop_moduli(const PlaneTrial *t, const Lanes D[9], const Lanes tau[3], const Lanes A[3],
                                 const Lanes B[3], Lanes c[16])
{
  Lanes AZ, BZ, ZA, ZB;
  mc_plane_modulus(t, D, MC_A, MC_Z, &AZ);
  mc_plane_modulus(t, D, MC_B, MC_Z, &BZ);
  mc_plane_modulus(t, D, MC_Z, MC_A, &ZA);
  mc_plane_modulus(t, D, MC_Z, MC_B, &ZB);
  mc_plane_modulus(t, D, MC_Z, MC_Z, &c[10]);
  c[10] -= 2.0 * tau[MC_Z];
  for (int i = 0; i < 3; ++i) {
    c[4 * mc_plane_row[i] + 2] = AZ * A[i] + BZ * B[i];
    c[8 + mc_plane_row[i]] = ZA * A[i] + ZB * B[i];
  }
}

/* Moduli of 11, 22, 33 and 12 (4 x 4), of 33 zeros unless there is a hoop. */
LANES_INLINE void mc_plane_moduli(const PetscBool hoop, const PetscReal *p, const PlaneTrial *t,
                                  const LaneBits *regions, const Lanes tau[3], Lanes c[16])
{
  const Lanes xx = t->n_AA[0], yy = t->n_AA[1], xy = t->n_AA[2], rise = tau[MC_A] - tau[MC_B],
              apart = t->strain[MC_A] - t->strain[MC_B];
  const Lanes A[3] = {xx, yy, xy}, B[3] = {yy, xx, -xy}, none = {0};
  const Lanes mixed[3] = {-2.0 * xy, 2.0 * xy, xx - yy};
  const LaneBits elastic = (*regions == MC_ELASTIC) | (t->z_first & (*regions == MC_CUT_PLANE));
  Lanes D[9], AA, AB, BA, BB, r, coth;
  mc_moduli_lanes(p, regions, D);
  mc_plane_modulus(t, D, MC_A, MC_A, &AA);
  mc_plane_modulus(t, D, MC_A, MC_B, &AB);
  mc_plane_modulus(t, D, MC_B, MC_A, &BA);
  mc_plane_modulus(t, D, MC_B, MC_B, &BB);
  mc_difference_lanes(p, &elastic, &apart, &rise, &r);
  lanes_principal_coth(&apart, &t->stretch2[MC_A], &t->stretch2[MC_B], &coth);
  const Lanes shear = 0.5 * (r * coth - tau[MC_A] - tau[MC_B]);
  AA -= 2.0 * tau[MC_A];
  BB -= 2.0 * tau[MC_B];
  for (int j = 0; j < 3; ++j) {
    const Lanes along = AA * A[j] + AB * B[j], across = BA * A[j] + BB * B[j], turn = shear * mixed[j];
    for (int i = 0; i < 3; ++i)
      c[4 * mc_plane_row[i] + mc_plane_row[j]] = A[i] * along + B[i] * across + mixed[i] * turn;
  }
  for (int k = 0; k < 4; ++k) c[4 * k + 2] = c[8 + k] = none;
  if (hoop) mc_hoop_moduli(t, D, tau, A, B, c);
}
