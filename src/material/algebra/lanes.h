/* Eight points side by side: a law written once for `Lanes` runs on vector registers of any width.
 *
 * A batch is always worked off in whole lanes (the last point fills those left over), so that a
 * point's result does not depend on the batch it came in, to the last bit. Arrays of points stand
 * in memory point by point; here each component is one Lanes. */
#pragma once
/* GCC compares vectors wider than a register number by number: a Mohr-Coulomb point took 4 times as long. */
#if defined(__AVX__) && !defined(__AVX512F__)
#define LANES 4
#endif
#include "base/math/lanes.h"
#include "base/math/tensor.h"
#include "material/law.h"

/* to[k] = component k of the n points at `from`, `components` numbers each; as many of them as fill a
 * register are loaded at once, and turned. */
LANES_INLINE void lanes_load(int components, PetscInt n, const PetscReal *from, Lanes *to)
{
  const PetscReal *point[LANES];
  const int whole = components / LANES * LANES;
  for (int l = 0; l < LANES; ++l) point[l] = from + (n >= LANES || l < n ? l : n - 1) * components;
  for (int first = 0; first < whole; first += LANES) {
    for (int l = 0; l < LANES; ++l) to[first + l] = *(const LanesAnywhere *)(point[l] + first);
    lanes_transpose(to + first);
  }
  for (int k = whole; k < components; ++k) {
    Lanes one = {0};
    for (int l = 0; l < LANES; ++l) one[l] = point[l][k];
    to[k] = one;
  }
}

/* Components first .. first + LANES - 1, turned: one Lanes a point. */
LANES_INLINE void lanes_points(int components, int first, const Lanes *from, Lanes point[LANES])
{
  const Lanes none = {0};
  for (int k = 0; k < LANES; ++k) point[k] = first + k < components ? from[first + k] : none;
  lanes_transpose(point);
}

/* Eight points, in whole registers: one by one, 36 components of a tangent took a quarter of the
 * law. Where a point has fewer components than a register, what is written too far is the next
 * point's, which follows. */
LANES_INLINE void lanes_store_all(int components, const Lanes *from, PetscReal *to)
{
  Lanes point[LANES];
  int first = 0;
  for (; first + LANES <= components; first += LANES) {
    lanes_points(components, first, from, point);
    for (int l = 0; l < LANES; ++l) *(LanesAnywhere *)(to + l * components + first) = point[l];
  }
  const int rest = components - first;
  if (!rest) return;
  lanes_points(components, first, from, point);
  for (int l = 0; l < LANES; ++l) {
    const int size = first == 0 && l < LANES - 1 ? LANES : rest;
    __builtin_memcpy(to + l * components + first, &point[l], (size_t)size * sizeof(PetscReal));
  }
}

LANES_INLINE void lanes_store(int components, PetscInt n, const Lanes *from, PetscReal *to)
{
  if (n >= LANES) {
    lanes_store_all(components, from, to);
    return;
  }
  for (int l = 0; l < n; ++l)
    for (int k = 0; k < components; ++k) to[l * components + k] = from[k][l];
}

LANES_INLINE void lanes_det(const Lanes a[9], Lanes *det)
{
  *det = a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) + a[2] * (a[3] * a[7] - a[4] * a[6]);
}

LANES_INLINE void lanes_sym_det(const Lanes s[6], Lanes *det)
{
  *det = s[0] * (s[1] * s[2] - s[4] * s[4]) - s[3] * (s[3] * s[2] - s[4] * s[5]) + s[5] * (s[3] * s[4] - s[1] * s[5]);
}

/* pushed = f s f^T. */
LANES_INLINE void lanes_push_forward(const Lanes f[9], const Lanes s[6], Lanes pushed[6])
{
  Lanes fs[9];
  for (int i = 0; i < 9; i += 3) {
    fs[i] = f[i] * s[0] + f[i + 1] * s[3] + f[i + 2] * s[5];
    fs[i + 1] = f[i] * s[3] + f[i + 1] * s[1] + f[i + 2] * s[4];
    fs[i + 2] = f[i] * s[5] + f[i + 1] * s[4] + f[i + 2] * s[2];
  }
  pushed[0] = fs[0] * f[0] + fs[1] * f[1] + fs[2] * f[2];
  pushed[1] = fs[3] * f[3] + fs[4] * f[4] + fs[5] * f[5];
  pushed[2] = fs[6] * f[6] + fs[7] * f[7] + fs[8] * f[8];
  pushed[3] = fs[0] * f[3] + fs[1] * f[4] + fs[2] * f[5];
  pushed[4] = fs[3] * f[6] + fs[4] * f[7] + fs[5] * f[8];
  pushed[5] = fs[6] * f[0] + fs[7] * f[1] + fs[8] * f[2];
}

/* The update of n points by one of (up to) eight. */
LANES_INLINE LawStatus lanes_update(LawUpdate eight, int n_state, const PetscReal *parameters, PetscInt n,
                                    const PetscReal *dF, const PetscReal *old, PetscReal *state, PetscReal *tau,
                                    PetscReal *c)
{
  LawStatus worst = LAW_OK;
  for (PetscInt p = 0; p < n; p += LANES) {
    const LawStatus status = eight(parameters, n - p, dF + 9 * p, old + n_state * p, state ? state + n_state * p : NULL,
                                   tau + 6 * p, c ? c + 36 * p : NULL);
    worst = PetscMax(worst, status);
  }
  return worst;
}

/* Worst status of points with increments f (whose determinants are det_f) and n results. */
LANES_INLINE LawStatus lanes_status(const Lanes *det_f, int n, const Lanes *result)
{
  Lanes sum = *det_f * 0.0; /* 0, or NaN if anything is infinite or NaN */
  int inverted = 0, not_finite = 0;
  for (int k = 0; k < n; ++k) sum += result[k] * 0.0;
  for (int l = 0; l < LANES; ++l) {
    const int lane_inverted = (*det_f)[l] <= 0.0;
    inverted |= lane_inverted;
    not_finite |= !lane_inverted & (sum[l] != 0.0);
  }
  return not_finite ? LAW_NOT_FINITE : (inverted ? LAW_INVERTED : LAW_OK);
}
