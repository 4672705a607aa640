/* Numbers too small to be normalised cost a hundred cycles each, and solutions that decay through a
 * grid are full of them in single precision. Between these two calls they are zero. */
#pragma once
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

/* Returns what denormals_restore needs. */
static inline unsigned denormals_flush(void)
{
#if defined(__SSE__)
  const unsigned mode = _mm_getcsr();
  _mm_setcsr(mode | 0x8040U);
  return mode;
#elif defined(__aarch64__) && defined(__GNUC__) && !defined(__clang__)
  const unsigned mode = __builtin_aarch64_get_fpcr();
  __builtin_aarch64_set_fpcr(mode | 1U << 24);
  return mode;
#else
  return 0;
#endif
}

static inline void denormals_restore(unsigned mode)
{
#if defined(__SSE__)
  _mm_setcsr(mode);
#elif defined(__aarch64__) && defined(__GNUC__) && !defined(__clang__)
  __builtin_aarch64_set_fpcr(mode);
#else
  (void)mode;
#endif
}
