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

/* to[k] = component k of the n points at `from`, `stride` numbers from point to point; as many of them as fill a
 * register are loaded at once, and turned. */
LANES_INLINE void lanes_load_apart(int components, PetscInt stride, PetscInt n, const PetscReal *from, Lanes *to)
{
  const PetscReal *point[LANES];
  const int whole = components / LANES * LANES;
  for (int l = 0; l < LANES; ++l) point[l] = from + (n >= LANES || l < n ? l : n - 1) * stride;
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

LANES_INLINE void lanes_load(int components, PetscInt n, const PetscReal *from, Lanes *to)
{
  lanes_load_apart(components, components, n, from, to);
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

/* The same, `stride` numbers from point to point; not a number more is written. */
LANES_INLINE void lanes_store_apart(int components, PetscInt stride, PetscInt n, const Lanes *from, PetscReal *to)
{
  const int whole = n >= LANES ? components / LANES * LANES : 0;
  Lanes point[LANES];
  for (int first = 0; first < whole; first += LANES) {
    lanes_points(components, first, from, point);
    for (int l = 0; l < LANES; ++l) *(LanesAnywhere *)(to + l * stride + first) = point[l];
  }
  for (int l = 0; l < PetscMin(n, LANES); ++l)
    for (int k = whole; k < components; ++k) to[l * stride + k] = from[k][l];
}

/* Rows of LAW_BATCH numbers. */
LANES_INLINE void lanes_load_rows(int rows, const PetscReal *from, Lanes *to)
{
  for (int k = 0; k < rows; ++k) to[k] = *(const LanesAnywhere *)(from + k * LAW_BATCH);
}

LANES_INLINE void lanes_store_rows(int rows, const Lanes *from, PetscReal *to)
{
  for (int k = 0; k < rows; ++k) *(LanesAnywhere *)(to + k * LAW_BATCH) = from[k];
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

/* The march of n points by one of (up to) eight. */
LANES_INLINE LawStatus lanes_march(LawMarching eight, const PetscReal *parameters, PetscInt n, const LawMarch *march)
{
  LawStatus worst = LAW_OK;
  for (PetscInt p = 0; p < n; p += LANES) {
    const LawMarch here = {march->dF + p, march->tau + p, march->state + p * march->stride, march->stride};
    const LawStatus status = eight(parameters, n - p, &here);
    worst = PetscMax(worst, status);
  }
  return worst;
}

/* dF of a march as 3 x 3, and stresses given back. */
LANES_INLINE void lanes_march_dF(const PetscBool plane, const LawMarch *march, Lanes f[9])
{
  const Lanes none = {0};
  for (int k = 0; k < 9; ++k) f[k] = none;
  if (!plane) {
    lanes_load_rows(9, march->dF, f);
    return;
  }
  lanes_load_rows(2, march->dF, f);
  lanes_load_rows(2, march->dF + 2 * LAW_BATCH, f + 3);
  lanes_load_rows(1, march->dF + 4 * LAW_BATCH, f + 8);
}

LANES_INLINE void lanes_march_tau(const PetscBool plane, const Lanes tau[6], const LawMarch *march)
{
  lanes_store_rows(plane ? 4 : 6, tau, march->tau);
}

/* Points that failed get their state of before again and carry no stress; `good`: those that did not. */
static inline LawStatus lanes_halt(int n_state, int components, const LaneBits *good, const LaneBits *finite,
                                   const Lanes *det, PetscInt n, const Lanes *before, const LawMarch *march)
{
  LawStatus worst = LAW_OK;
  for (PetscInt l = 0; l < PetscMin(n, LANES); ++l) {
    if ((*good)[l]) continue;
    const LawStatus bad = (*det)[l] <= 0.0 ? LAW_INVERTED : LAW_NOT_FINITE,
                    status = (*finite)[l] ? LAW_NOT_CONVERGED : bad;
    worst = PetscMax(worst, status);
    for (int k = 0; k < n_state; ++k) march->state[l * march->stride + k] = before[k][l];
    for (int k = 0; k < components; ++k) march->tau[k * LAW_BATCH + l] = 0.0;
  }
  return worst;
}

/* Both marches of a law whose `name##_march` does them for (up to) eight points. */
#define LANES_MARCHES(name)                                                                        \
  LANES_INLINE LawStatus name##_plane_eight(const PetscReal *p, PetscInt n, const LawMarch *march) \
  {                                                                                                \
    return name##_march(PETSC_TRUE, p, n, march);                                                  \
  }                                                                                                \
  LANES_INLINE LawStatus name##_space_eight(const PetscReal *p, PetscInt n, const LawMarch *march) \
  {                                                                                                \
    return name##_march(PETSC_FALSE, p, n, march);                                                 \
  }                                                                                                \
  static LawStatus name##_march_plane(const PetscReal *p, PetscInt n, const LawMarch *march)       \
  {                                                                                                \
    return lanes_march(name##_plane_eight, p, n, march);                                           \
  }                                                                                                \
  static LawStatus name##_march_space(const PetscReal *p, PetscInt n, const LawMarch *march)       \
  {                                                                                                \
    return lanes_march(name##_space_eight, p, n, march);                                           \
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
