/* How rough the pressure is: the share of it that one averaging over neighbours takes away.
 *
 * The averaging goes from the points to the nodes and back; a pressure that is an unknown at the
 * nodes makes the round trip from there, since points do not see all of its oscillations: on a
 * triangle 1, -1, 0 is nothing at the centre. */
#include "model/measure/measure.h"

static PetscReal point_volume(const Model *m, PetscInt p)
{
  return m->points->real[POINT_VOLUME][p] * m->points->real[POINT_J][p];
}

/* Averages at the nodes of values at the points, weighted by shape function and present volume;
 * `volume`: the sum of the weights. */
static PetscErrorCode PointsToNodes(const Model *m, const PetscReal *at_points, PetscReal *at_nodes, PetscReal *volume)
{
  const Support *w = m->space->support;
  const PetscInt n = m->grid->n_nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(at_nodes, n));
  PetscCall(PetscArrayzero(volume, n));
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
      for (PetscInt I = 0; I < support_nodes(w, g); ++I) {
        const PetscReal weight = support_N(w, g, p)[I] * point_volume(m, p);
        volume[w->node[w->node_start[g] + I]] += weight;
        at_nodes[w->node[w->node_start[g] + I]] += weight * at_points[p];
      }
  PetscCall(GridSumToOwners(m->grid, 1, at_nodes));
  PetscCall(GridSumToOwners(m->grid, 1, volume));
  for (PetscInt i = 0; i < m->grid->n_owned; ++i) at_nodes[i] = volume[i] > 1e-300 ? at_nodes[i] / volume[i] : 0;
  PetscCall(GridToGhosts(m->grid, 1, at_nodes));
  PetscFunctionReturn(0);
}

static void nodes_to_points(const Model *m, const PetscReal *at_nodes, PetscReal *at_points)
{
  const Support *w = m->space->support;
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      at_points[p] = 0;
      for (PetscInt I = 0; I < support_nodes(w, g); ++I)
        at_points[p] += support_N(w, g, p)[I] * at_nodes[w->node[w->node_start[g] + I]];
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

/* Sums of V (p - Sp)^2 and V p^2 over the points, S: to the nodes and back. */
static PetscErrorCode AtPoints(const Model *m, PetscReal sum[2])
{
  PetscReal *pressure, *smooth, *nodal, *volume;

  PetscFunctionBeginUser;
  PetscCall(
    PetscCalloc4(m->points->n, &pressure, m->points->n, &smooth, m->grid->n_nodes, &nodal, m->grid->n_nodes, &volume));
  PetscCall(PointPressures(m, pressure));
  PetscCall(PointsToNodes(m, pressure, nodal, volume));
  nodes_to_points(m, nodal, smooth);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    if (m->points->cell[p] < 0) continue;
    sum[0] += point_volume(m, p) * (pressure[p] - smooth[p]) * (pressure[p] - smooth[p]);
    sum[1] += point_volume(m, p) * pressure[p] * pressure[p];
  }
  PetscCall(PetscFree4(pressure, smooth, nodal, volume));
  PetscFunctionReturn(0);
}

/* The same over the nodes that had a pressure in the last step, S: to the points and back. */
static PetscErrorCode AtNodes(const Model *m, PetscReal sum[2])
{
  PetscReal *pressure, *smooth, *volume;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(m->points->n, &pressure, m->grid->n_nodes, &smooth, m->grid->n_nodes, &volume));
  nodes_to_points(m, m->nodes->scaled_pressure, pressure);
  PetscCall(PointsToNodes(m, pressure, smooth, volume));
  for (PetscInt i = 0; i < m->grid->n_owned; ++i) {
    if (m->nodes->idle[i]) continue;
    sum[0] += volume[i] * (m->nodes->scaled_pressure[i] - smooth[i]) * (m->nodes->scaled_pressure[i] - smooth[i]);
    sum[1] += volume[i] * m->nodes->scaled_pressure[i] * m->nodes->scaled_pressure[i];
  }
  PetscCall(PetscFree3(pressure, smooth, volume));
  PetscFunctionReturn(0);
}

static PetscErrorCode Roughness(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  PetscReal local[2] = {0, 0}, sum[2];

  (void)s, (void)index;
  PetscFunctionBeginUser;
  if (m->nodes->scaled_pressure) PetscCall(AtNodes(m, local));
  else PetscCall(AtPoints(m, local));
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  *value = sum[1] > 0 ? PetscSqrtReal(sum[0] / sum[1]) : 0;
  PetscFunctionReturn(0);
}

static const MeasureNumber *const words[] = {
  WORD(
    "pressure",
    "of the whole model's pressure: its root mean square distance from itself averaged over neighbours, over its own "
    "root mean square: 1 for a checkerboard, and for a smooth pressure less with every refinement",
    .of = OF_MODEL, .value = Roughness),
  NULL,
};

const Measure measure_roughness = {
  .key = "roughness", .takes = MEASURE_WORD, .number = {.unit = "", .help = "how rough a field is"}, .words = words};
