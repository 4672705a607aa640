/* Which of the nodes near a point make up its cloud, so that a well-posed basis comes out whatever
 * the deformation.
 *
 * A pure function of positions, without memory: the same on any number of ranks and after a
 * restart. Since weights end smoothly at the radius and the radius depends continuously on the
 * positions, a node that comes or goes does so without a jump. docs/theory.md, "Meshfree bases". */
#pragma once
#include "basis/cloud/cloud.h"

typedef enum {
  SUPPORT_ADAPTIVE, /* the least radius that gives a good basis, no link through a gap */
  /* the paper's: more of the next nearest nodes, one by one, until the basis is good enough */
  SUPPORT_NEAREST,
  SUPPORT_FIXED, /* the nodes within the radius, whatever comes out */
} SupportRule;

typedef struct {
  SupportRule rule;
  PetscReal radius; /* in units of h; the radius aimed at */
  /* in units of h; candidates have to reach as far (not needed by SUPPORT_FIXED) */
  PetscReal max_radius;
  PetscReal condition; /* a basis with a condition above this is improved by more nodes */
  int minimum;         /* least number of nodes; 0: what the basis needs */
  /* in units of h: nodes farther apart are not neighbours in the material; 0: no such limit */
  PetscReal gap;
  /* hops grow with the material's stretch along them up to this factor, at least 1 */
  PetscReal stretch;
} CloudSupport;

extern const CloudSupport support_default_mls, support_default_lme;

typedef enum {
  SUPPORT_NOMINAL, /* the radius aimed at was enough */
  SUPPORT_GROWN,   /* the radius had to grow, to `radius` */
  /* a basis, but its condition stayed above the bound with all nodes within reach */
  SUPPORT_POOR,
  /* LME has no solution with all nodes within reach (outside their hull): linear MLS instead */
  SUPPORT_MLS,
  /* no gradient can be had (too few nodes, or on a line): weighted mean of the nodes, dN = 0 */
  SUPPORT_LOOSE,
  SUPPORT_EMPTY, /* no node within reach */
} SupportLevel;

extern const char *const support_level_names[];

typedef struct {
  SupportLevel level;
  CloudStatus status;  /* of the basis asked for, at the last radius tried */
  int n;               /* nodes in the cloud */
  int evaluations;     /* of the basis */
  PetscReal radius;    /* of the cloud, in units of h */
  PetscReal condition; /* of the basis returned */
} SupportReport;

/* Cloud of the point x among `n` candidate nodes X (n x dim, distance to x ascending, at most
 * CLOUD_MAX_NODES are looked at). metric: F^-T F^-1 of the point (dim x dim) or NULL: how far apart
 * neighbours may be along each direction. chosen: indices of the cloud's nodes among the
 * candidates, ascending; N (report.n), dN (report.n x dim), each with room for min(n,
 * CLOUD_MAX_NODES) nodes. dual as in cloud_basis(). */
SupportReport cloud_support(const CloudSupport *support, const CloudBasis *basis, int dim, int n, const PetscReal *X,
                            PetscReal h, const PetscReal *metric, const PetscReal *x, int *chosen, PetscReal *N,
                            PetscReal *dN, PetscReal *dual);
