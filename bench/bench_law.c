/* Points per second of the laws' batch update, on one core.
 *
 *   build/bench/bench_law [points per batch, 32]
 *
 * Prints one line per case: million points per second with the tangent and without, and nanoseconds
 * per point with it. Plastic cases start on the yield surface, stressed and turned, and go on
 * yielding; `plane` has no strain along z, `ring` a strain of its own there. */
#include "material/law.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

typedef struct {
  const char *law, *what;
  PetscReal given[14]; /* angles in rad */
  PetscReal strain;    /* size of the increments */
  const Kinematics *kinematics;
  int steps; /* steps towards the state that is measured: with 0 from rest */
} BenchCase;

/* From c at once down to `residual` within a strain of 0.1. */
#define SOFTENING(c, residual)                                       \
  {                                                                  \
    0.54, 0.02, c, 1e300, 0.4, 0, residual, NAN, NAN, NAN, 0, 0.1, 0 \
  }

static const BenchCase cases[] = {
  {"neo-hookean", "3d", {0}, 1e-3, &kinematics_3d, 0},
  {"neo-hookean-split", "3d", {0}, 1e-3, &kinematics_3d, 0},
  {"neo-hookean-split-log", "3d", {0}, 1e-3, &kinematics_3d, 0},
  {"j2", "elastic, 3d", {1, 0}, 1e-3, &kinematics_3d, 0},
  {"j2", "plastic, 3d", {1e-3, 1e-2}, 1e-3, &kinematics_3d, 5},
  {"j2-log", "plastic, 3d", {1e-3, 1e-2}, 1e-3, &kinematics_3d, 5},
  {"mohr-coulomb", "elastic, plane", {0.54, 0.02, 1, 1e300}, 1e-3, &kinematics_plane_strain, 0},
  {"mohr-coulomb", "plastic, plane", {0.54, 0.02, 1e-3, 1e300}, 1e-3, &kinematics_plane_strain, 5},
  {"mohr-coulomb", "elastic, ring", {0.54, 0.02, 1, 1e300}, 1e-3, &kinematics_axisymmetric, 0},
  {"mohr-coulomb", "plastic, ring", {0.54, 0.02, 1e-3, 1e300}, 1e-3, &kinematics_axisymmetric, 5},
  {"mohr-coulomb", "cut off, ring", {0.54, 0.02, 1e-3, 5e-4}, 1e-3, &kinematics_axisymmetric, 5},
  {"mohr-coulomb", "remembers, ring", {0.54, 0.02, 1e-3, 1e300, 1}, 1e-3, &kinematics_axisymmetric, 5},
  {"mohr-coulomb", "elastic, 3d", {0.54, 0.02, 1, 1e300}, 1e-3, &kinematics_3d, 0},
  {"mohr-coulomb", "plastic, 3d", {0.54, 0.02, 1e-3, 1e300}, 1e-3, &kinematics_3d, 5},
  {"mohr-coulomb", "cut off, 3d", {0.54, 0.02, 1e-3, 5e-4}, 1e-3, &kinematics_3d, 5},
  {"mohr-coulomb-softening", "elastic, 3d", SOFTENING(1, 1), 1e-3, &kinematics_3d, 0},
  {"mohr-coulomb-softening", "softening, 3d", SOFTENING(1e-3, 5e-4), 1e-3, &kinematics_3d, 5},
  {"drucker-prager", "elastic, 3d", {0.54, 0.02, 1, 1e300, 2}, 1e-3, &kinematics_3d, 0},
  {"drucker-prager", "plastic, 3d", {0.54, 0.02, 1e-3, 1e300, 2}, 1e-3, &kinematics_3d, 5},
  {"mu-i", "at rest, 3d", {5, 6, 0.279, 1e-3, 2500}, 1e-4, &kinematics_3d, 0},
  {"mu-i", "flowing, 3d", {0.38, 0.64, 0.279, 1e-3, 2500}, 1e-3, &kinematics_3d, 5},
  {"modified-cam-clay", "elastic, 3d", {1, 0.1, 0.02, 1, 4e6, NAN, 8, 1e5}, 1e-4, &kinematics_3d, 0},
  {"modified-cam-clay", "plastic, 3d", {1, 0.1, 0.02, 1, 4e6, NAN, 1, 1e5}, 1e-3, &kinematics_3d, 5},
};

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t); /* a shared machine must not slow the law down */
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Increments of all directions, each the same in every step; compressed a little, so that granular
 * matter has a load. */
static void set_up(const BenchCase *b, int n, PetscReal *dF)
{
  for (int p = 0; p < n; ++p)
    for (int k = 0; k < 9; ++k) {
      const int turns_z = k == 2 || k == 5 || k == 6 || k == 7;
      const int out = b->kinematics->dim == 2 && (turns_z || (k == 8 && !b->kinematics->hoop));
      dF[9 * p + k] = (k % 4 == 0) + (out ? 0.0 : b->strain * (sin(9.0 * p + k) - 0.2 * (k % 4 == 0)));
    }
}

/* Best of several runs of 0.1 s or so: million points per second. */
static double speed(const BenchCase *b, int n, int tangent)
{
  static PetscReal dF[9 * LAW_BATCH], old[LAW_MAX_STATE * LAW_BATCH], state[LAW_MAX_STATE * LAW_BATCH];
  static PetscReal tau[6 * LAW_BATCH], c[36 * LAW_BATCH];
  const Elasticity elastic = {.constant = {2.6, 0.3, 2.6 / 1.2, 1.0, 1.5}};
  const Law *law = law_find(b->law);
  PetscReal packed[LAW_MAX_PARAMETERS] = {0};
  double best = 0.0;
  const LawUpdate update = law_update_in(law, b->kinematics);
  law->prepare(&elastic, b->given, packed);
  if (law->rate && law->step) law->step(0, 1, packed);
  set_up(b, n, dF);
  for (int p = 0; p < n; ++p) {
    law_initial_state(law, old + p * law->n_state);
    if (law->needs_stress) law->initial_stress(packed, (PetscReal[6]){-1e5, -1e5, -1e5}, old + p * law->n_state);
  }
  for (int s = 0; s < b->steps; ++s) {
    if (law->update(packed, n, dF, old, state, tau, c) != LAW_OK) return NAN;
    for (int k = 0; k < n * law->n_state; ++k) old[k] = state[k];
  }
  for (int run = 0; run < 10; ++run) {
    const int batches = 500000 / n;
    const double start = now();
    for (int k = 0; k < batches; ++k)
      if (update(packed, n, dF, old, state, tau, tangent ? c : NULL) != LAW_OK) return NAN;
    best = fmax(best, 1e-6 * n * batches / (now() - start));
  }
  return best;
}

int main(int argc, char **argv)
{
  const int n = argc > 1 ? (int)strtol(argv[1], NULL, 10) : LAW_BATCH;
  if (n < 1 || n > LAW_BATCH) return fprintf(stderr, "a batch has 1 to %d points\n", LAW_BATCH), 2;
  printf("%-24s %-16s %10s %10s %10s   [million points/s, n = %d]\n", "law", "", "with c", "tau only", "ns with c", n);
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
    const double with = speed(&cases[i], n, 1), without = speed(&cases[i], n, 0);
    printf("%-24s %-16s %10.2f %10.2f %10.1f\n", cases[i].law, cases[i].what, with, without, 1e3 / with);
  }
  return 0;
}
