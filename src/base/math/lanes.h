/* Eight (or four) numbers side by side, and what of the mathematical library they need. GCC and Clang know
 * vector_size and map it on registers of any width; lanes are passed by pointer, because the
 * calling convention for vectors wider than the machine's is not settled.
 *
 * Without -ffast-math compilers call scalar log and exp eight times; these here have no calls and
 * no branches. */
#pragma once
#include <math.h>
#include <petscsys.h>
#include <stdint.h>
#if defined(__AVX__)
#include <immintrin.h>
#endif

/* Who defines it as 4 before gets four: material/algebra/lanes.h */
#ifndef LANES
#define LANES 8
#endif
#define LANES_INLINE static inline __attribute__((always_inline))

typedef PetscReal Lanes __attribute__((vector_size(LANES * sizeof(PetscReal))));
/* the same anywhere in memory: GCC makes two halves of a memcpy, and waits for both to be read as one */
typedef Lanes LanesAnywhere __attribute__((aligned(sizeof(PetscReal)), may_alias));
/* of a comparison: -1 where true */
typedef int64_t LaneBits __attribute__((vector_size(LANES * sizeof(int64_t))));
/* bits that are counted with */
typedef uint64_t LaneWords __attribute__((vector_size(LANES * sizeof(uint64_t))));

/* to = mask ? yes : no */
LANES_INLINE void lanes_select(const LaneBits *mask, const Lanes *yes, const Lanes *no, Lanes *to)
{
  *to = (Lanes)((*mask & (LaneBits)*yes) | (~*mask & (LaneBits)*no));
}

LANES_INLINE int lanes_any(const LaneBits *mask)
{
#if LANES == 8 && defined(__AVX512F__)
  return _mm512_test_epi64_mask((__m512i)*mask, (__m512i)*mask) != 0;
#elif LANES == 4 && defined(__AVX__)
  return !_mm256_testz_si256((__m256i)*mask, (__m256i)*mask);
#elif LANES == 4
  return ((*mask)[0] | (*mask)[1] | (*mask)[2] | (*mask)[3]) != 0;
#else
  const LaneBits half = *mask | __builtin_shufflevector(*mask, *mask, 4, 5, 6, 7, 0, 1, 2, 3);
  return (half[0] | half[1] | half[2] | half[3]) != 0;
#endif
}

/* Rows of four numbers, whatever their alignment, to columns: r[i][j] becomes r[j][i]. */
#define TRANSPOSE_FOUR(Row, r)                                          \
  do {                                                                  \
    const Row a0 = __builtin_shufflevector((r)[0], (r)[1], 0, 4, 2, 6); \
    const Row a1 = __builtin_shufflevector((r)[0], (r)[1], 1, 5, 3, 7); \
    const Row a2 = __builtin_shufflevector((r)[2], (r)[3], 0, 4, 2, 6); \
    const Row a3 = __builtin_shufflevector((r)[2], (r)[3], 1, 5, 3, 7); \
    (r)[0] = __builtin_shufflevector(a0, a2, 0, 1, 4, 5);               \
    (r)[1] = __builtin_shufflevector(a1, a3, 0, 1, 4, 5);               \
    (r)[2] = __builtin_shufflevector(a0, a2, 2, 3, 6, 7);               \
    (r)[3] = __builtin_shufflevector(a1, a3, 2, 3, 6, 7);               \
  } while (0)

/* The same with all lanes. */
LANES_INLINE void lanes_transpose(Lanes r[LANES])
{
#if LANES == 4
  TRANSPOSE_FOUR(Lanes, r);
#else
  Lanes a[8], b[8];
  for (int i = 0; i < 8; i += 2) {
    a[i] = __builtin_shufflevector(r[i], r[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    a[i + 1] = __builtin_shufflevector(r[i], r[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int i = 0; i < 8; i += 4)
    for (int j = 0; j < 2; ++j) {
      b[i + j] = __builtin_shufflevector(a[i + j], a[i + j + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      b[i + j + 2] = __builtin_shufflevector(a[i + j], a[i + j + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (int j = 0; j < 4; ++j) {
    r[j] = __builtin_shufflevector(b[j], b[j + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    r[j + 4] = __builtin_shufflevector(b[j], b[j + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
#endif
}

LANES_INLINE void lanes_abs(const Lanes *x, Lanes *y) { *y = (Lanes)((LaneBits)*x & INT64_MAX); }

/* Number by number GCC makes two halves of a wide register in memory, and waits for both to be read as one. */
LANES_INLINE void lanes_sqrt(const Lanes *x, Lanes *y)
{
#if LANES == 8 && defined(__AVX512F__)
  *y = (Lanes)_mm512_sqrt_pd((__m512d)*x);
#elif LANES == 4 && defined(__AVX__)
  *y = (Lanes)_mm256_sqrt_pd((__m256d)*x);
#else
  for (int l = 0; l < LANES; ++l) (*y)[l] = sqrt((*x)[l]);
#endif
}

LANES_INLINE void lanes_cbrt(const Lanes *x, Lanes *y)
{
  for (int l = 0; l < LANES; ++l) (*y)[l] = cbrt((*x)[l]);
}

/* y = ln x to 1 ulp, also close to 1; NaN where x is no positive normal number. x = 2^k (1 + f)
 * with 1 + f between sqrt(1/2) and sqrt(2), ln(1 + f) = f - f^2/2 + s (f^2/2 + R(s^2)), s = f / (2
 * + f); R is the minimax polynomial of Sun's fdlibm. */
LANES_INLINE void lanes_log(const Lanes *x, Lanes *y)
{
  static const PetscReal R[] = {0x1.5555555555593p-1, 0x1.999999997fa04p-2, 0x1.2492494229359p-2, 0x1.c71c51d8e78afp-3,
                                0x1.7466496cb03dep-3, 0x1.39a09d078c69fp-3, 0x1.2f112df3e5244p-3};
  const Lanes zero = {0}, magic = zero + 0x1.8p52;
  const uint64_t root = 0x3fe6a09e667f3bcd; /* sqrt(1/2) */
  const LaneWords power = ((LaneWords)*x - root) & ~UINT64_C(0xfffffffffffff);
  const Lanes f = (Lanes)((LaneWords)*x - power) - 1.0;
  const Lanes k = (Lanes)((LaneWords)magic + (LaneWords)((LaneBits)power >> 52)) - magic;
  const Lanes s = f / (2.0 + f), z = s * s, half = 0.5 * f * f;
  Lanes sum = zero + R[6];
  for (int i = 5; i >= 0; --i) sum = sum * z + R[i];
  const Lanes low = s * (half + z * sum) + k * 0x1.a39ef35793c76p-33;
  const Lanes result = k * 0x1.62e42feep-1 - ((half - low) - f), none = zero + (PetscReal)NAN;
  const LaneBits usual = (*x >= 0x1p-1022) & (*x <= PETSC_MAX_REAL);
  lanes_select(&usual, &result, &none, y);
}

/* y = exp x to 1 ulp; below exp(-700) it stays there, as above exp(700); NaN comes through. */
LANES_INLINE void lanes_exp(const Lanes *x, Lanes *y)
{
  static const PetscReal inverse[] = {
    1.0,        1.0,         1.0 / 2,      1.0 / 6,       1.0 / 24,       1.0 / 120,       1.0 / 720,
    1.0 / 5040, 1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};
  const Lanes zero = {0}, magic = zero + 0x1.8p52, low = zero - 700.0, high = zero + 700.0;
  LaneBits mask = *x < low;
  Lanes v;
  lanes_select(&mask, &low, x, &v);
  mask = v > high;
  lanes_select(&mask, &high, &v, &v);
  const Lanes shifted = v * 0x1.71547652b82fep0 + magic, k = shifted - magic;
  const Lanes r = (v - k * 0x1.62e42feep-1) - k * 0x1.a39ef35793c76p-33;
  Lanes sum = zero + inverse[13];
  for (int i = 12; i >= 2; --i) sum = sum * r + inverse[i];
  sum = 1.0 + (r + r * r * sum);
  const LaneWords power = ((LaneWords)shifted << 52) + (LaneWords)(zero + 1.0);
  *y = sum * (Lanes)power;
}

/* The same for numbers near 1 and near 0, by their series to 1 ulp; a lane that is not near takes the long way, and
 * what it gets does not depend on its neighbours. */
LANES_INLINE void lanes_log_near(const Lanes *x, Lanes *y)
{
  const Lanes f = *x - 1.0, f2 = f * f, f4 = f2 * f2;
  const Lanes low = (-1.0 / 2 + f * (1.0 / 3)) + f2 * (-1.0 / 4 + f * (1.0 / 5));
  const Lanes high = (-1.0 / 6 + f * (1.0 / 7)) + f2 * (-1.0 / 8 + f * (1.0 / 9));
  const Lanes top = (-1.0 / 10 + f * (1.0 / 11)) - f2 * (1.0 / 12);
  Lanes size, whole;
  lanes_abs(&f, &size);
  const LaneBits far = ~(size < 0x1p-5);
  *y = f + f2 * (low + f4 * (high + f4 * top));
  if (!lanes_any(&far)) return;
  lanes_log(x, &whole);
  lanes_select(&far, &whole, y, y);
}

LANES_INLINE void lanes_exp_near(const Lanes *x, Lanes *y)
{
  const Lanes v = *x, v2 = v * v, v4 = v2 * v2;
  const Lanes low = (1.0 / 2 + v * (1.0 / 6)) + v2 * (1.0 / 24 + v * (1.0 / 120));
  const Lanes high = (1.0 / 720 + v * (1.0 / 5040)) + v2 * (1.0 / 40320 + v * (1.0 / 362880));
  Lanes size, whole;
  lanes_abs(&v, &size);
  const LaneBits far = ~(size < 0x1p-4);
  *y = 1.0 + (v + v2 * (low + v4 * (high + v4 * (1.0 / 3628800))));
  if (!lanes_any(&far)) return;
  lanes_exp(x, &whole);
  lanes_select(&far, &whole, y, y);
}
