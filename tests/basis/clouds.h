/* Clouds of nodes for the tests of this room. */
#pragma once
#include "basis/cloud/cloud.h"
#include "../conformance/basis_suite.h"
#include "../conformance/random.h"

/* A lattice of side^dim nodes, spacing h about the origin, each moved by up to disorder * h.
 * Returns their number. */
static inline int lattice_cloud(Random *random, int dim, int side, PetscReal h, PetscReal disorder, PetscReal *X)
{
  int n = 1;
  for (int k = 0; k < dim; ++k) n *= side;
  for (int a = 0; a < n; ++a)
    for (int k = 0, rest = a; k < dim; ++k, rest /= side)
      X[a * dim + k] = h * (rest % side - 0.5 * (side - 1) + random_real(random, -disorder, disorder));
  return n;
}

/* Nodes by their distance to x, nearest first. */
static inline void sort_cloud(int dim, int n, const PetscReal *x, PetscReal *X)
{
  for (int a = 1; a < n; ++a)
    for (int b = a; b > 0; --b) {
      PetscReal r[2] = {0};
      for (int s = 0; s < 2; ++s)
        for (int k = 0; k < dim; ++k) r[s] += PetscSqr(X[(b - s) * dim + k] - x[k]);
      if (r[0] >= r[1]) break;
      for (int k = 0; k < dim; ++k) {
        const PetscReal kept = X[b * dim + k];
        X[b * dim + k] = X[(b - 1) * dim + k], X[(b - 1) * dim + k] = kept;
      }
    }
}

typedef struct {
  const CloudBasis *basis;
  const PetscReal *X;
  int dim, n;
  PetscReal h;
} CloudContext;

static inline PetscBool evaluate_cloud(const void *context, const PetscReal *point, PetscReal *N, PetscReal *dN)
{
  const CloudContext *c = context;
  PetscReal condition;
  return cloud_basis(c->basis, c->dim, c->n, c->X, c->h, point, N, dN, &condition, NULL) == CLOUD_OK;
}

/* The suite of every basis, on disordered lattices at positions in their middle. */
static inline void cloud_suite(const char *name, const CloudBasis *basis, PetscReal difference)
{
  Random random = {2024};
  for (int dim = 2; dim <= 3; ++dim)
    for (int trial = 0; trial < 40; ++trial) {
      PetscReal X[CLOUD_MAX_NODES * 3], sample[3 * 5];
      const PetscReal h = trial % 2 ? 1e-3 : 2.5;
      const int n = lattice_cloud(&random, dim, dim == 2 ? 6 : 4, h, 0.3, X);
      const CloudContext context = {basis, X, dim, n, h};
      for (int k = 0; k < 5 * dim; ++k) sample[k] = random_real(&random, -h, h) / 2;
      const BasisUnderTest test = {.name = name,
                                   .dim = dim,
                                   .nodes = n,
                                   .x = X,
                                   .n_samples = 5,
                                   .sample = sample,
                                   .size = h,
                                   .tolerance = 1e-12,
                                   .difference = difference,
                                   .evaluate = evaluate_cloud,
                                   .context = &context};
      basis_suite_run(&test);
    }
}
