/* Random numbers that are the same on every machine: a test that fails once fails always. */
#pragma once
#include <petscsys.h>
#include <stdint.h>

typedef struct {
  uint64_t state;
} Random;

/* splitmix64: every seed is a good one. */
static inline uint64_t random_bits(Random *random)
{
  uint64_t z = random->state += UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}

/* Uniform in [low, high). */
static inline PetscReal random_real(Random *random, PetscReal low, PetscReal high)
{
  return low + (high - low) * (PetscReal)(random_bits(random) >> 11) * 0x1p-53;
}

/* A rotation, row by row, from a uniform unit quaternion (by rejection). */
static inline void random_rotation(Random *random, PetscReal q[9])
{
  PetscReal a, b, c, d, s;
  do {
    a = random_real(random, -1, 1), b = random_real(random, -1, 1);
    c = random_real(random, -1, 1), d = random_real(random, -1, 1);
    s = a * a + b * b + c * c + d * d;
  } while (s > 1.0 || s < 1e-3);
  s = 2.0 / s;
  q[0] = 1 - s * (c * c + d * d), q[1] = s * (b * c - a * d), q[2] = s * (b * d + a * c);
  q[3] = s * (b * c + a * d), q[4] = 1 - s * (b * b + d * d), q[5] = s * (c * d - a * b);
  q[6] = s * (b * d - a * c), q[7] = s * (c * d + a * b), q[8] = 1 - s * (b * b + c * c);
}
