/* Does the compiler keep the elements of vectors apart? GCC 12.2 with vectors of 64 bytes puts the wrong one
 * in a store that takes some of them, not in order of halves (F of a point in the plane lost F_yy). Returns how many
 * are wrong. Compiled with the flags of the program; also a test (tests/base/test_compiler.c). */
typedef double Eight __attribute__((vector_size(64)));

static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
static volatile double half = 0.5, three = 3; /* so that nothing is known beforehand */

__attribute__((noinline)) static void scale(double s, double *f)
{
  double F[9];
  for (int i = 0; i < 9; ++i) F[i] = s * identity[i];
  f[0] = F[0], f[1] = F[1], f[2] = F[3], f[3] = F[4], f[4] = F[8];
}

#define PICK(name, a, b, c, d)                                                    \
  __attribute__((noinline)) static void name(const Eight *p, double s, double *f) \
  {                                                                               \
    const Eight v = *p * s;                                                       \
    f[0] = v[a], f[1] = v[b], f[2] = v[c], f[3] = v[d];                           \
  }
PICK(first, 0, 1, 3, 4)
PICK(second, 1, 2, 3, 6)
PICK(third, 0, 3, 4, 7)
PICK(fourth, 2, 3, 5, 6)
PICK(fifth, 5, 0, 7, 1)
PICK(sixth, 0, 2, 4, 6)

static int wrong(const double *f, int a, int b, int c, int d)
{
  return (f[0] != 3 * a) + (f[1] != 3 * b) + (f[2] != 3 * c) + (f[3] != 3 * d);
}

int wrong_elements(void);
int wrong_elements(void)
{
  Eight v;
  double f[5];
  int n = 0;
  for (int i = 0; i < 8; ++i) v[i] = three - 3 + i;
  scale(half, f);
  n += (f[0] != 0.5) + (f[1] != 0) + (f[2] != 0) + (f[3] != 0.5) + (f[4] != 0.5);
  first(&v, three, f), n += wrong(f, 0, 1, 3, 4);
  second(&v, three, f), n += wrong(f, 1, 2, 3, 6);
  third(&v, three, f), n += wrong(f, 0, 3, 4, 7);
  fourth(&v, three, f), n += wrong(f, 2, 3, 5, 6);
  fifth(&v, three, f), n += wrong(f, 5, 0, 7, 1);
  sixth(&v, three, f), n += wrong(f, 0, 2, 4, 6);
  return n;
}

#ifndef TALUS_TEST
int main(void) { return wrong_elements(); }
#endif
