/* How much room points have: the density with which they stand on the grid, beside what they remember of
 * openings (docs/theory.md, "The room that points have"). */
#include <math.h>
#include "method/discretisation.h"

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

/* The mean, by volume, of what the points around each node have. */
static PetscErrorCode ToNodes(const Discretisation *s, const PetscReal *at, const PetscReal *volume, PetscReal *nodal)
{
  const Support *w = s->support;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(nodal, s->grid->n_nodes));
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
      for (PetscInt I = 0; I < support_nodes(w, g); ++I)
        nodal[w->node[w->node_start[g] + I]] += support_N(w, g, p)[I] * s->points->real[POINT_VOLUME][p] * at[p];
  PetscCall(GridSumToOwners(s->grid, 1, nodal));
  PetscCall(GridToGhosts(s->grid, 1, nodal));
  for (PetscInt i = 0; i < s->grid->n_nodes; ++i) nodal[i] = volume[i] > 0 ? nodal[i] / volume[i] : 0;
  PetscFunctionReturn(0);
}

/* Volume at the start over the room of now, at each point. Averaged once more over the points around, since four of
 * them in a cell are spread unevenly as soon as they have moved. */
static PetscErrorCode Densities(Discretisation *s, PetscReal *density)
{
  PetscReal *volume, *filled;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(s->grid->n_nodes, &volume, s->grid->n_nodes, &filled));
  PetscCall(DiscretisationVolumes(s, PETSC_FALSE, volume));
  for (PetscInt i = 0; i < s->grid->n_nodes; ++i) filled[i] = s->whole[i] > 0 ? volume[i] / s->whole[i] : 0;
  to_points(s, filled, density);
  PetscCall(ToNodes(s, density, volume, filled));
  to_points(s, filled, density);
  PetscCall(PetscFree2(volume, filled));
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

PetscErrorCode DiscretisationRoom(Discretisation *s)
{
  Points *points = s->points;
  PetscReal *density;

  PetscFunctionBeginUser;
  if (!s->c->stabilisation.room) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(points->n, &density));
  PetscCall(Densities(s, density));
  for (PetscInt p = 0; p < points->n; ++p) {
    const Material *material = &s->materials[points->material[p]];
    const PetscReal most = PetscMax(0, -log(density[p]));
    if (!material->law->room) continue;
    material->law->room(material->parameters, most, point_real(points, POINT_STATE, p));
    if (points->real[POINT_J][p] > exp(most)) shrink(points, p, exp(most));
  }
  PetscCall(PetscFree(density));
  PetscFunctionReturn(0);
}
