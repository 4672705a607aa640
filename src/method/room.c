/* How much room points have: the density with which they stand on the grid, beside what they remember of
 * openings and the volume that their laws know (docs/theory.md, "The room that points have"). */
#include <math.h>
#include <string.h>
#include "material/algebra/invariants.h"
#include "method/discretisation.h"

/* Above its room, how much more points may seem to ask for: as uneven are four of a cell in what has flowed, after the
 * two means below. */
#define UNEVEN 0.04
/* Domains next to an axis do not know of it, and see their volume 6 % off there. */
#define UNEVEN_RINGS 0.1

/* Of what is too much, the share that goes with as much plastic strain as one, and the most that goes in a step. */
#define PARTING 4
#define AT_ONCE 0.5
/* Shear over pressure of what flows, q / p, below which it is nearly fluid (sand of 8 degrees has 0.24): what parts it
 * would drive it, and its flow part it more. */
#define FLUID 0.2

/* What a field of the nodes is at each point. */
static void to_points(const Discretisation *s, const PetscReal *nodal, PetscReal *at)
{
  const Support *w = s->support;
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      at[p] = 0;
      for (PetscInt I = 0; I < support_nodes(w, g); ++I)
        at[p] += support_N(w, g, p)[I] * nodal[w->node[w->node_start[g] + I]];
    }
}

/* The mean, by the volumes that points ask for, of what those around each node have. */
static PetscErrorCode ToNodes(const Discretisation *s, const PetscReal *at, const PetscReal *ratio,
                              const PetscReal *volume, PetscReal *nodal)
{
  const Support *w = s->support;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(nodal, s->grid->n_nodes));
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal V = (ratio ? ratio[p] : 1) * s->points->real[POINT_VOLUME][p];
      for (PetscInt I = 0; I < support_nodes(w, g); ++I)
        nodal[w->node[w->node_start[g] + I]] += support_N(w, g, p)[I] * V * at[p];
    }
  PetscCall(GridSumToOwners(s->grid, 1, nodal));
  PetscCall(GridToGhosts(s->grid, 1, nodal));
  for (PetscInt i = 0; i < s->grid->n_nodes; ++i) nodal[i] = volume[i] > 0 ? nodal[i] / volume[i] : 0;
  PetscFunctionReturn(0);
}

/* Averaged once more over the points around, since four of them in a cell are spread unevenly as soon as they have
 * moved. */
PetscErrorCode DiscretisationDensities(Discretisation *s, const PetscReal *ratio, PetscReal *density)
{
  PetscReal *volume, *filled;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(s->grid->n_nodes, &volume, s->grid->n_nodes, &filled));
  PetscCall(DiscretisationVolumes(s, ratio, volume));
  for (PetscInt i = 0; i < s->grid->n_nodes; ++i) filled[i] = s->whole[i] > 0 ? volume[i] / s->whole[i] : 0;
  to_points(s, filled, density);
  PetscCall(ToNodes(s, density, ratio, volume, filled));
  to_points(s, filled, density);
  PetscCall(PetscFree2(volume, filled));
  PetscFunctionReturn(0);
}

PetscErrorCode DiscretisationCrowding(Discretisation *s, PetscReal *density)
{
  PetscReal *ratio;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->points->n, &ratio));
  for (PetscInt p = 0; p < s->points->n; ++p) ratio[p] = point_asks(s->points, p);
  PetscCall(DiscretisationDensities(s, ratio, density));
  PetscCall(PetscFree(ratio));
  PetscFunctionReturn(0);
}

/* F loses volume where it is free to: not around an axis, which tells the radius, nor across a plane. */
static void shrink(Points *points, PetscInt p, PetscReal J)
{
  const PetscReal factor = pow(J / points->real[POINT_J][p], 1 / (PetscReal)points->dim);
  PetscReal *F = point_real(points, POINT_F, p);
  for (PetscInt i = 0; i < points->dim * points->dim; ++i) F[i] *= factor;
  points->real[POINT_J][p] = J;
}

/* Nothing is farther open than its surroundings have room for. */
static PetscErrorCode Close(Discretisation *s, PetscReal *density)
{
  Points *points = s->points;

  PetscFunctionBeginUser;
  PetscCall(DiscretisationDensities(s, NULL, density));
  for (PetscInt p = 0; p < points->n; ++p) {
    const Material *material = &s->materials[points->material[p]];
    const PetscReal most = PetscMax(0, -log(density[p]));
    if (!material->law->room) continue;
    material->law->room(material->parameters, most, point_real(points, POINT_STATE, p));
    if (points->real[POINT_J][p] > exp(most)) shrink(points, p, exp(most));
  }
  PetscFunctionReturn(0);
}

static PetscReal stored(const Material *material, const PetscReal *state)
{
  return material->law->energy ? material->law->energy(material->parameters, state) : 0;
}

/* The elastic part of a state, and F with it, is pressed together by e^-much: to be as before it has to part. That is
 * work on it, J. */
static PetscReal press(Discretisation *s, PetscInt p, PetscReal much)
{
  const Material *material = &s->materials[s->points->material[p]];
  const PetscReal shorter = exp(-much / 3);
  PetscReal *state = point_real(s->points, POINT_STATE, p);
  const PetscReal before = stored(material, state);
  material->law->scale(1, &shorter, state);
  shrink(s->points, p, s->points->real[POINT_J][p] * exp(-much));
  const PetscReal work = s->points->real[POINT_VOLUME][p] * (stored(material, state) - before);
  s->points->real[POINT_WORK][p] += work;
  return work;
}

/* Do its points flow, and know how to be pressed? */
static PetscBool parts(const Law *law) { return (PetscBool)(law->yields && law->scale); }

/* How far is flow from that of a fluid? 1: as that of sand. */
static PetscReal rubs(const Points *points, PetscInt p)
{
  PetscReal tau[6];
  point_tau(points, p, tau);
  const PetscReal pressure = -(tau[0] + tau[1] + tau[2]) / 3, shear = stress_deviatoric(tau);
  return shear < FLUID * pressure ? PetscSqr(shear / (FLUID * pressure)) : 1;
}

/* What flows, and asks for more than its room, is pressed as if it had been brought together by that: ln of a volume
 * ratio. */
static PetscReal much_of(const Discretisation *s, PetscInt p, PetscReal excess)
{
  const Law *law = s->materials[s->points->material[p]].law;
  const PetscReal flow = *point_real(s->points, POINT_FLOW, p);
  if (!parts(law) || !(flow > 0) || !(excess > 0)) return 0;
  return PetscMin(AT_ONCE, PARTING * flow) * excess * rubs(s->points, p);
}

/* Points of a cell that share their change of volume share this one, too. */
static void share_out(const Points *points, PetscReal *much)
{
  for (PetscInt p = 0, end; p < points->n; p = end) {
    PetscReal sum = 0, volume = 0;
    for (end = p; end < points->n && points->cell[end] == points->cell[p]; ++end) {
      sum += points->real[POINT_VOLUME][end] * much[end];
      volume += points->real[POINT_VOLUME][end];
    }
    for (PetscInt k = p; k < end; ++k) much[k] = sum / volume;
  }
}

static PetscErrorCode Part(Discretisation *s, PetscBool shared, PetscReal *density, PetscReal *made)
{
  Points *points = s->points;
  const PetscReal uneven = s->c->kinematics->hoop && s->basis->domains ? UNEVEN_RINGS : UNEVEN;

  PetscFunctionBeginUser;
  PetscCall(DiscretisationCrowding(s, density));
  for (PetscInt p = 0; p < points->n; ++p) density[p] = much_of(s, p, density[p] - 1 - uneven);
  if (shared) share_out(points, density);
  for (PetscInt p = 0; p < points->n; ++p)
    if (density[p] > 0 && parts(s->materials[points->material[p]].law)) *made += press(s, p, density[p]);
  PetscFunctionReturn(0);
}

/* What the room changes. */
static const int told[] = {POINT_F, POINT_J, POINT_STATE, POINT_WORK};

static void copy(Points *points, PetscReal *kept, PetscBool back)
{
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(told); ++k) {
    const size_t n = (size_t)points->components[told[k]] * (size_t)points->n;
    PetscReal *field = points->real[told[k]];
    memcpy(back ? field : kept, back ? kept : field, n * sizeof *kept);
    kept += n;
  }
}

static PetscErrorCode Keep(Discretisation *s)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(told); ++k) n += s->points->components[told[k]];
  PetscCall(PetscFree(s->unroomed));
  PetscCall(PetscMalloc1(n * s->points->n + 1, &s->unroomed));
  copy(s->points, s->unroomed, PETSC_FALSE);
  PetscFunctionReturn(0);
}

void discretisation_room_back(Discretisation *s)
{
  if (s->unroomed) copy(s->points, s->unroomed, PETSC_TRUE);
}

PetscErrorCode DiscretisationRoom(Discretisation *s, PetscBool shared, PetscReal *made)
{
  PetscReal *density;

  PetscFunctionBeginUser;
  *made = 0;
  PetscCall(Keep(s));
  PetscCall(PetscMalloc1(s->points->n, &density));
  PetscCall(Close(s, density));
  PetscCall(Part(s, shared, density, made));
  PetscCall(PetscFree(density));
  PetscFunctionReturn(0);
}
