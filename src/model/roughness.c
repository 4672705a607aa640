/* How rough the pressure is: the share of it that one averaging over neighbours takes away. */
#include "model/model_private.h"

/* Averages at the nodes of values at the points, weighted by shape function and present volume. */
static PetscErrorCode PointsToNodes(const Model *m, const PetscReal *at_points, PetscReal *at_nodes)
{
  const Support *w = m->stage->support;
  const PetscInt n = m->grid->n_nodes, nn = w->uniform;
  PetscReal *sum; /* volume and volume times value */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * n, &sum));
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
      for (PetscInt I = 0; I < nn; ++I) {
        PetscReal *s = sum + 2 * w->node[g * nn + I];
        const PetscReal volume = w->N[p * nn + I] * m->points->real[POINT_VOLUME][p] * m->points->real[POINT_J][p];
        s[0] += volume;
        s[1] += volume * at_points[p];
      }
  PetscCall(GridSumToOwners(m->grid, 2, sum));
  PetscCall(GridToGhosts(m->grid, 2, sum));
  for (PetscInt i = 0; i < n; ++i) at_nodes[i] = sum[2 * i] > 1e-300 ? sum[2 * i + 1] / sum[2 * i] : 0;
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(0);
}

static void nodes_to_points(const Model *m, const PetscReal *at_nodes, PetscReal *at_points)
{
  const Support *w = m->stage->support;
  const PetscInt nn = w->uniform;
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      at_points[p] = 0;
      for (PetscInt I = 0; I < nn; ++I) at_points[p] += w->N[p * nn + I] * at_nodes[w->node[g * nn + I]];
    }
}

static PetscErrorCode PointPressures(const Model *m, PetscReal *pressure)
{
  PetscReal sigma[6];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscCall(ModelPointStress(m, p, sigma));
    pressure[p] = -(sigma[0] + sigma[1] + sigma[2]) / 3;
  }
  PetscFunctionReturn(0);
}

/* sqrt(sum V (p - Sp)^2 / sum V p^2) over the points, S: to the nodes and back. */
PetscErrorCode RoughnessValue(const Model *m, PetscReal *value)
{
  PetscReal *pressure, *smooth, *nodal, local[2] = {0, 0}, sum[2];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(m->points->n, &pressure, m->points->n, &smooth, m->grid->n_nodes, &nodal));
  PetscCall(PointPressures(m, pressure));
  PetscCall(PointsToNodes(m, pressure, nodal));
  nodes_to_points(m, nodal, smooth);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal volume = m->points->real[POINT_VOLUME][p] * m->points->real[POINT_J][p];
    if (m->points->cell[p] < 0) continue;
    local[0] += volume * (pressure[p] - smooth[p]) * (pressure[p] - smooth[p]);
    local[1] += volume * pressure[p] * pressure[p];
  }
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  *value = sum[1] > 0 ? PetscSqrtReal(sum[0] / sum[1]) : 0;
  PetscCall(PetscFree3(pressure, smooth, nodal));
  PetscFunctionReturn(0);
}
