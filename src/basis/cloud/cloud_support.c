/* Growing the radius of a cloud until its basis is good; what to do where none comes out. */
#include "basis/cloud/cloud_support.h"
#include "basis/cloud/cloud_gap.h"
#include <math.h>

#define SUPPORT_STEP 1.1 /* of the radius while growing */
#define SUPPORT_STEPS 32 /* 1.1^32 = 21 */
#define SUPPORT_REFINEMENTS 12
#define SUPPORT_NEAR 0.999 /* share of the bound that ends the refinement */
/* moment matrix of MLS: beyond, small shifts of nodes turn N over; LME has no such limit */
#define SUPPORT_WORST 1e4
/* a bound that cannot be reached becomes this many times the condition at the end */
#define SUPPORT_SLACK 1.5

const CloudSupport support_default_mls = {
  .radius = 2.0, .max_radius = 3.5, .condition = 50.0, .gap = 2.0, .stretch = 1.5};
const CloudSupport support_default_lme = {
  .radius = 2.0, .max_radius = 3.5, .condition = 50.0, .gap = 2.0, .stretch = 1.5};

const char *const support_level_names[] = {"nominal", "grown", "poor", "mls instead of lme", "loose", "empty"};

typedef struct {
  const CloudSupport *rule;
  CloudBasis basis;
  CloudCandidates near;
  int minimum, *chosen;
  PetscReal *N, *dN, *dual, start[3];
  SupportReport *report;
} Search;

/* What a radius gave; radius 0: nothing tried. */
typedef struct {
  PetscReal radius, condition;
  CloudStatus status;
} Trial;

static void search_gather(Search *s, int n, PetscReal *X)
{
  const int dim = s->near.dim;
  for (int a = 0; a < n; ++a)
    for (int k = 0; k < dim; ++k) X[a * dim + k] = s->near.X[s->chosen[a] * dim + k];
}

/* Newton starts from the caller's dual variable at each trial: what comes out does not depend on
 * the trials before. */
static Trial search_evaluate(Search *s, int n, PetscReal radius)
{
  const int dim = s->near.dim;
  PetscReal X[CLOUD_MAX_NODES * 3];
  Trial trial = {.radius = radius, .condition = PETSC_MAX_REAL, .status = CLOUD_TOO_FEW};
  s->report->n = n;
  if (n < s->minimum) return trial;
  search_gather(s, n, X);
  for (int k = 0; s->dual && k < dim; ++k) s->dual[k] = s->start[k];
  trial.status = cloud_basis(&s->basis, dim, n, X, s->near.h, s->near.x, s->N, s->dN, &trial.condition, s->dual);
  ++s->report->evaluations;
  if (s->basis.kind == CLOUD_MLS && trial.condition > SUPPORT_WORST && trial.status == CLOUD_OK)
    trial.status = CLOUD_DEGENERATE;
  return trial;
}

/* The basis of the linked nodes within a radius, at which weights end. */
static Trial search_within(Search *s, PetscReal radius)
{
  int n = 0;
  for (int a = 0; a < s->near.n && s->near.r[a] < radius; ++a)
    if (cloud_linked(&s->near, s->rule, a, radius)) s->chosen[n++] = a;
  s->basis.reach = radius;
  return search_evaluate(s, n, radius);
}

static PetscBool trial_good(const Trial *trial, PetscReal bound)
{
  return trial->status == CLOUD_OK && trial->condition <= bound;
}

/* Where between a bad and a good radius to look next: where ln(condition) would meet the bound if
 * it were linear, well inside the interval every second time. */
static PetscReal search_guess(const Trial *bad, const Trial *good, PetscReal bound, int i)
{
  PetscReal share = 0.5;
  if (bad->status == CLOUD_OK && i % 2 == 0) {
    const PetscReal above = log(bad->condition / bound), below = log(bound / good->condition);
    share = PetscMin(PetscMax(above / (above + below), 0.02), 0.98);
  }
  return bad->radius + share * (good->radius - bad->radius);
}

/* The radius between a bad and a good one at which the condition meets the bound. */
static Trial search_refine(Search *s, Trial bad, Trial good, PetscReal bound)
{
  PetscBool last_good = PETSC_FALSE;
  for (int i = 0; i < SUPPORT_REFINEMENTS && good.condition < SUPPORT_NEAR * bound; ++i) {
    const Trial middle = search_within(s, search_guess(&bad, &good, bound, i));
    last_good = trial_good(&middle, bound);
    if (last_good) good = middle;
    else bad = middle;
  }
  return last_good ? good : search_within(s, good.radius);
}

/* The paper's cloud: all within the radius, or the nearest few, then one by one the next. */
static Trial search_nearest(Search *s, PetscReal bound)
{
  int n = 0;
  s->basis.reach = 0.0;
  while (n < s->near.n && (s->near.r[n] <= s->rule->radius || n < s->minimum) && s->near.r[n] <= s->rule->max_radius)
    s->chosen[n] = n, ++n;
  const int first = n;
  for (;; ++n) {
    const Trial trial = search_evaluate(s, n, n ? PetscMax(s->rule->radius, s->near.r[n - 1]) : 0.0);
    const PetscBool good = trial_good(&trial, bound);
    const PetscBool end = n >= s->near.n || s->near.r[n] > s->rule->max_radius;
    if (good || end) {
      s->report->level = good ? (n == first ? SUPPORT_NOMINAL : SUPPORT_GROWN) : SUPPORT_POOR;
      return trial;
    }
    s->chosen[n] = n;
  }
}

static Trial search_fixed(Search *s)
{
  int n = 0;
  s->basis.reach = 0.0;
  while (n < s->near.n && s->near.r[n] <= s->rule->radius) s->chosen[n] = n, ++n;
  s->report->level = SUPPORT_NOMINAL;
  return search_evaluate(s, n, s->rule->radius);
}

static Trial search_adaptive(Search *s, PetscReal bound)
{
  Trial trial[SUPPORT_STEPS];
  int m = 0;
  s->report->level = SUPPORT_NOMINAL;
  for (PetscReal radius = s->rule->radius;; radius = PetscMin(radius * SUPPORT_STEP, s->rule->max_radius)) {
    trial[m] = search_within(s, radius);
    if (trial_good(&trial[m], bound)) break;
    if (radius >= s->rule->max_radius || m == SUPPORT_STEPS - 1) {
      s->report->level = SUPPORT_POOR;
      break;
    }
    ++m;
  }
  if (s->report->level == SUPPORT_NOMINAL && m == 0) return trial[0];
  if (trial[m].status != CLOUD_OK) return trial[m];
  if (s->report->level == SUPPORT_POOR) {
    bound = SUPPORT_SLACK * trial[m].condition;
    for (int k = m; k >= 0; --k)
      if (trial_good(&trial[k], bound)) m = k;
  } else s->report->level = SUPPORT_GROWN;
  if (m == 0) return search_within(s, trial[0].radius);
  return search_refine(s, trial[m - 1], trial[m], bound);
}

/* No gradient can be had: the point goes with the mean of its nodes, and does not resist. */
static void search_loose(Search *s)
{
  const PetscReal end = PetscMax(s->rule->radius, s->rule->max_radius);
  int n = 0;
  PetscReal sum = 0.0;
  for (int a = 0; a < s->near.n && s->near.r[a] <= end; ++a)
    if (cloud_linked(&s->near, s->rule, a, end)) s->chosen[n++] = a;
  for (int a = 0; a < n; ++a) {
    s->N[a] = exp(PetscSqr(s->near.r[s->chosen[0]]) - PetscSqr(s->near.r[s->chosen[a]]));
    sum += s->N[a];
  }
  for (int a = 0; a < n; ++a) s->N[a] /= sum;
  for (int k = 0; k < n * s->near.dim; ++k) s->dN[k] = 0.0;
  for (int k = 0; s->dual && k < s->near.dim; ++k) s->dual[k] = 0.0;
  s->report->n = n;
  s->report->condition = PETSC_MAX_REAL;
  s->report->radius = end;
  s->report->level = n ? SUPPORT_LOOSE : SUPPORT_EMPTY;
}

/* Linear moving least squares with LME's weight: they do not need the point to be inside. */
static Trial search_instead(Search *s)
{
  const PetscReal gamma = s->basis.gamma;
  s->basis = (CloudBasis){.kind = CLOUD_MLS, .effective_radius = 1.0 / sqrt(gamma)};
  const Trial trial = search_adaptive(s, support_default_mls.condition);
  s->report->level = SUPPORT_MLS;
  for (int k = 0; s->dual && k < s->near.dim; ++k) s->dual[k] = 0.0;
  return trial;
}

SupportReport cloud_support(const CloudSupport *support, const CloudBasis *basis, int dim, int n, const PetscReal *X,
                            PetscReal h, const PetscReal *metric, const PetscReal *x, int *chosen, PetscReal *N,
                            PetscReal *dN, PetscReal *dual)
{
  SupportReport report = {0};
  Search s = {.rule = support, .basis = *basis, .report = &report};
  s.chosen = chosen, s.N = N, s.dN = dN, s.dual = dual;
  s.minimum = PetscMax(support->minimum, cloud_minimum(basis, dim));
  for (int k = 0; dual && k < dim; ++k) s.start[k] = dual[k];
  cloud_candidates(dim, n, X, h, metric, x, &s.near);
  Trial trial;
  if (support->rule == SUPPORT_ADAPTIVE) trial = search_adaptive(&s, support->condition);
  else if (support->rule == SUPPORT_NEAREST) trial = search_nearest(&s, support->condition);
  else trial = search_fixed(&s);
  report.status = trial.status;
  if (trial.status != CLOUD_OK && basis->kind == CLOUD_LME) trial = search_instead(&s);
  report.radius = trial.radius, report.condition = trial.condition;
  if (trial.status != CLOUD_OK) search_loose(&s);
  return report;
}
