/* Fields of points at the nodes of the grid: means over the volume of the points that a node sees.
 * Smooth contours of cells come of them; where a field is uniform they are exact, and nowhere beyond
 * the values of points. */
#include "base/count.h"
#include "run/output/output_private.h"

/* Add N V of the points, and the field times that: `components` numbers and one a node. */
static void add_points(const Model *m, PetscInt components, const PetscReal *values, PetscReal *sum)
{
  const Support *w = m->space->support;
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt nn = support_nodes(w, g), *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal volume = m->points->real[POINT_J][p] * m->points->real[POINT_VOLUME][p];
      for (PetscInt i = 0; i < nn; ++i) {
        /* some bases are negative far off */
        const PetscReal weight = volume * PetscMax(support_N(w, g, p)[i], 0);
        PetscReal *at = sum + count_numbers(node[i], components + 1);
        for (PetscInt k = 0; k < components; ++k) at[k] += weight * values[count_numbers(p, components) + (size_t)k];
        at[components] += weight;
      }
    }
  }
}

PetscErrorCode OutputNodalAverage(const Model *m, PetscInt components, const PetscReal *values, PetscReal *nodes)
{
  const PetscInt n = m->grid->n_nodes;
  PetscReal *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(count_numbers(n, components + 1), &sum));
  add_points(m, components, values, sum);
  PetscCall(GridSumToOwners(m->grid, components + 1, sum));
  PetscCall(GridToGhosts(m->grid, components + 1, sum));
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal *at = sum + count_numbers(i, components + 1);
    for (PetscInt k = 0; k < components; ++k)
      nodes[count_numbers(i, components) + (size_t)k] = at[components] > 0 ? at[k] / at[components] : 0;
  }
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(0);
}
