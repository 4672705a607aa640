/* Which candidates are neighbours of a point through the material, and not across a void. */
#pragma once
#include "basis/cloud/cloud_support.h"

typedef struct {
  int dim, n;
  const PetscReal *X, *x, *metric;
  PetscReal h, r[CLOUD_MAX_NODES]; /* distances to the point in units of h, ascending */
  PetscBool known, linked[CLOUD_MAX_NODES];
} CloudCandidates;

void cloud_candidates(int dim, int n, const PetscReal *X, PetscReal h, const PetscReal *metric, const PetscReal *x,
                      CloudCandidates *near);

/* Does a chain of hops through candidates, none longer than the gap, lead from the point to
 * candidate a? Within `radius` <= gap everything is linked. The nearest candidate always is. */
PetscBool cloud_linked(CloudCandidates *near, const CloudSupport *support, int a, PetscReal radius);
