/* Nanoseconds for the meshfree shape functions of a point, on one core: the bases alone, then with
 * the choice of the cloud among its candidates.
 *
 *   cmake --build build --target bench_cloud && build/bench/bench_cloud
 *
 * Nodes are a disordered lattice (15 % of the spacing); every figure is the best of seven passes
 * over 500 points. */
#include "basis/cloud/cloud_support.h"
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define POINTS 500

typedef struct {
  int dim, n;
  /* the n nodes nearest to each point, nearest first */
  PetscReal x[POINTS][3], X[POINTS][CLOUD_MAX_NODES * 3];
} Sample;

static PetscReal uniform(void) { return (PetscReal)rand() / RAND_MAX - 0.5; }

static PetscReal distance(int dim, const PetscReal *a, const PetscReal *b)
{
  PetscReal sum = 0.0;
  for (int k = 0; k < dim; ++k) sum += PetscSqr(a[k] - b[k]);
  return sum;
}

static void fill(Sample *sample, int dim, int n)
{
  const int side = 9, all = dim == 2 ? side * side : side * side * side;
  sample->dim = dim, sample->n = n;
  for (int p = 0; p < POINTS; ++p) {
    PetscReal node[9 * 9 * 9][3];
    for (int k = 0; k < dim; ++k) sample->x[p][k] = uniform();
    for (int a = 0; a < all; ++a)
      for (int k = 0, rest = a; k < dim; ++k, rest /= side) node[a][k] = rest % side - 4 + 0.3 * uniform();
    for (int a = 0; a < n; ++a) {
      int best = a;
      for (int b = a; b < all; ++b)
        if (distance(dim, node[b], sample->x[p]) < distance(dim, node[best], sample->x[p])) best = b;
      for (int k = 0; k < dim; ++k) {
        sample->X[p][a * dim + k] = node[best][k];
        node[best][k] = node[a][k];
      }
    }
  }
}

/* Mean time of a point; with `support` the cloud is chosen among the sample's nodes, else it is all
 * of them. */
static double measure(const Sample *sample, const CloudBasis *basis, const CloudSupport *support, double *nodes)
{
  static PetscReal N[CLOUD_MAX_NODES], dN[CLOUD_MAX_NODES * 3];
  double best = 1e300;
  int chosen[CLOUD_MAX_NODES];
  for (int pass = 0; pass < 7; ++pass) {
    const clock_t start = clock();
    *nodes = 0.0;
    for (int repeat = 0; repeat < 10; ++repeat)
      for (int p = 0; p < POINTS; ++p) {
        PetscReal condition, dual[3] = {0};
        if (support)
          *nodes += cloud_support(support, basis, sample->dim, sample->n, sample->X[p], 1.0, NULL, sample->x[p], chosen,
                                  N, dN, dual)
                      .n;
        else if (cloud_basis(basis, sample->dim, sample->n, sample->X[p], 1.0, sample->x[p], N, dN, &condition, dual))
          return -1.0;
        else *nodes += sample->n;
      }
    const double time = (double)(clock() - start) / CLOCKS_PER_SEC / (10 * POINTS);
    best = time < best ? time : best;
  }
  *nodes /= 10 * POINTS;
  return 1e9 * best;
}

int main(void)
{
  static const struct {
    const char *name;
    CloudBasis basis;
  } bases[] = {{"mls linear", {.effective_radius = 1.2}},
               {"mls bilinear", {.order = CLOUD_BILINEAR, .effective_radius = 1.4}},
               {"mls quadratic", {.order = CLOUD_QUADRATIC, .effective_radius = 1.4}},
               {"lme gamma 0.8", {.kind = CLOUD_LME, .gamma = 0.8}},
               {"lme gamma 1.8", {.kind = CLOUD_LME, .gamma = 1.8}}};
  static const int sizes[2][3] = {{9, 13, 21}, {27, 33, 64}}, candidates[2] = {38, 128};
  static Sample sample[4];
  for (int dim = 2; dim <= 3; ++dim) {
    for (int q = 0; q < 3; ++q) fill(&sample[q], dim, sizes[dim - 2][q]);
    fill(&sample[3], dim, candidates[dim - 2]);
    for (size_t b = 0; b < sizeof bases / sizeof bases[0]; ++b) {
      double nodes;
      printf("%dD  %-14s", dim, bases[b].name);
      for (int q = 0; q < 3; ++q) {
        const double time = measure(&sample[q], &bases[b].basis, NULL, &nodes);
        printf("  %2.0f nodes %5.0f ns", nodes, time);
      }
      const double time = measure(&sample[3], &bases[b].basis, &support_default_lme, &nodes);
      printf("  chosen %.1f of %d %5.0f ns\n", nodes, sample[3].n, time);
    }
  }
  return 0;
}
