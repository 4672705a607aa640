/* How far the stress in a level layer is off the weight of what lies above: in uniaxial strain, as
 * between smooth walls, they are equal whatever the law and however much the layer has settled. */
#include "model/measure/measure.h"
#include "model/model_private.h"

/* Along gravity, from the top of the bodies' shapes. */
typedef struct {
  PetscInt axis;
  PetscReal g, top, height, sign; /* sign: -1 where gravity pulls towards smaller coordinates */
} Layer;

static Layer layer_of(const Model *m, PetscInt body)
{
  Layer layer = {.top = -PETSC_MAX_REAL};
  PetscReal g[3], lowest = PETSC_MAX_REAL;
  gravity_at(m->c, m->time, g);
  for (PetscInt d = 1; d < m->dim; ++d)
    if (PetscAbsReal(g[d]) > PetscAbsReal(g[layer.axis])) layer.axis = d;
  layer.g = PetscAbsReal(g[layer.axis]);
  layer.sign = g[layer.axis] < 0 ? -1 : 1;
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) {
    PetscReal min[3], max[3];
    if ((body >= 0 && b != body) || !m->c->bodies[b].has_shape) continue;
    shape_bounds(&m->c->bodies[b].shape, m->dim, min, max);
    const PetscReal low = -layer.sign * (layer.sign < 0 ? min : max)[layer.axis],
                    high = -layer.sign * (layer.sign < 0 ? max : min)[layer.axis];
    layer.top = PetscMax(layer.top, high);
    lowest = PetscMin(lowest, low);
  }
  layer.height = layer.top - lowest;
  return layer;
}

static PetscErrorCode OffWeight(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const PetscInt body = measure_body(m, s);
  const Layer layer = layer_of(m, body);
  PetscReal local[2] = {0, 0}, sum[2], worst = 0, sigma[6];

  (void)index;
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    if (!measure_takes_point(m, body, p)) continue;
    const PetscReal rho = m->materials[m->points->material[p]].density, volume = m->points->real[POINT_VOLUME][p];
    const PetscReal start =
      point_real(m->points, POINT_X, p)[layer.axis] - point_real(m->points, POINT_U, p)[layer.axis];
    PetscCall(ModelPointStress(m, p, sigma));
    const PetscReal above = rho * layer.g * (layer.top + layer.sign * start);
    const PetscReal off = PetscAbsReal(sigma[layer.axis] + above) / (rho * layer.g * layer.height);
    local[0] += volume * off;
    local[1] += volume;
    worst = PetscMax(worst, off);
  }
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  PetscCall(MPIU_Allreduce(&worst, value, 1, MPIU_REAL, MPIU_MAX, m->comm));
  if (measure_number(s)->which) *value = sum[0] / sum[1];
  PetscFunctionReturn(0);
}

static const MeasureNumber *const words[] = {
  WORD("mean", "of all points, by their volume", .value = OffWeight, .which = 1),
  WORD("largest", "of the point where it is most", .value = OffWeight),
  NULL,
};

const Measure measure_overburden = {
  .key = "overburden",
  .takes = MEASURE_WORD,
  .number = {.unit = "",
             .help = "how far the stress along gravity in a level layer, a body with a shape, is off the weight above "
                     "it, over that of the whole layer: 0 between smooth walls"},
  .words = words};
