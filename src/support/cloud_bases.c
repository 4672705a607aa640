/* Bases of clouds of nodes: moving least squares and local maximum entropy, as the case's `basis`
 * block describes them. */
#include "grid/cloud/cloud.h"
#include "support/basis.h"
#include "support/cloud.h"

static CloudRule cloud_rule(const BasisInput *in, const CloudSupport *usual)
{
  static const SupportRule rule[] = {SUPPORT_ADAPTIVE, SUPPORT_NEAREST, SUPPORT_FIXED};
  const BasisSpec *b = in->spec;
  CloudRule r = {.support = *usual, .h = in->grid->cloud->spacing, .follows = in->follows};
  r.matter = in->start ? in->grid->cloud->matter : NULL;
  r.start = in->start;
  r.support.rule = rule[b->choice];
  r.support.radius = b->radius;
  r.support.max_radius = PetscMax(b->max_radius, b->radius);
  r.support.condition = b->condition;
  r.support.minimum = (int)b->minimum;
  r.support.gap = b->gap;
  return r;
}

static PetscErrorCode MlsSupport(const BasisInput *in, const Points *points, Support *support)
{
  static const CloudOrder order[] = {CLOUD_LINEAR, CLOUD_BILINEAR, CLOUD_QUADRATIC};
  CloudRule rule = cloud_rule(in, &support_default_mls);

  PetscFunctionBeginUser;
  rule.basis = (CloudBasis){.kind = CLOUD_MLS,
                            .order = order[in->spec->order],
                            .weight = in->spec->weight == WEIGHT_CUBIC_SPLINE ? CLOUD_CUBIC_SPLINE : CLOUD_GAUSSIAN,
                            .effective_radius = in->spec->effective_radius};
  PetscCall(SupportFromClouds(support, points, in->nodes, &rule));
  PetscFunctionReturn(0);
}

/* On the hull local maximum entropy has no smooth values: there linear moving least squares with
 * its weight take its place. */
static PetscErrorCode LmeSupport(const BasisInput *in, const Points *points, Support *support)
{
  const PetscReal gamma = in->spec->gamma;
  CloudRule rule = cloud_rule(in, &support_default_lme);

  PetscFunctionBeginUser;
  rule.basis = in->on_hull ? (CloudBasis){.kind = CLOUD_MLS, .effective_radius = 1 / PetscSqrtReal(gamma)}
                           : (CloudBasis){.kind = CLOUD_LME, .gamma = gamma};
  PetscCall(SupportFromClouds(support, points, in->nodes, &rule));
  PetscFunctionReturn(0);
}

/* How far the couplings of a point must reach: clouds that had to grow get their share, too. */
static PetscReal wide_radius(const BasisInput *in, const BasisSites *sites, const NeighboursMap *map, PetscInt p)
{
  const PetscInt dim = in->grid->dim;
  const PetscReal *x = point_real(sites->points, POINT_X, p);
  PetscReal farthest2 = PetscSqr(in->spec->radius * cloud_spacing_of(sites->points, p, in->grid->cloud->spacing));
  for (PetscInt i = sites->now->node_start[p]; i < sites->now->node_start[p + 1]; ++i)
    farthest2 = PetscMax(farthest2, neighbours_square(dim, map, in->grid->x + sites->now->node[i] * dim, x));
  return sites->skin * PetscSqrtReal(farthest2);
}

/* The nodes of the wider cloud of each point and of its present one, ascending. */
static PetscErrorCode CloudCouplings(const BasisInput *in, const BasisSites *sites, NodeGroups *groups)
{
  const Support *now = sites->now;
  PetscInt node[2 * CLOUD_MAX_NODES + 1];
  PetscReal distance2[CLOUD_MAX_NODES];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < now->n_groups; ++p) {
    const PetscInt nn = support_nodes(now, p);
    NeighboursMap room;
    const NeighboursMap *map = cloud_stretch_of(in->follows, sites->points, p, &room);
    PetscInt n =
      neighbours_mapped(in->nodes + point_field(sites->points, p), map, point_real(sites->points, POINT_X, p),
                        wide_radius(in, sites, map, p), CLOUD_MAX_NODES, node, distance2);
    PetscCall(PetscArraycpy(node + n, now->node + now->node_start[p], nn));
    n += nn;
    PetscCall(PetscSortRemoveDupsInt(&n, node));
    PetscCall(NodeGroupsAdd(groups, n, node));
  }
  PetscFunctionReturn(0);
}

const Basis basis_mls = {
  .nodes = BASIS_OF_CLOUD,
  .support = MlsSupport,
  .couplings = CloudCouplings,
};

const Basis basis_lme = {
  .nodes = BASIS_OF_CLOUD,
  .holds_boundary = PETSC_TRUE,
  .support = LmeSupport,
  .couplings = CloudCouplings,
};
