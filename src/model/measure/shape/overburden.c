/* How far the stress in a level layer is off the weight of what lies above: in uniaxial strain, as
 * between smooth walls, they are equal whatever the law and however much the layer has settled. */
#include <math.h>
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

typedef enum { OFF_MEAN, OFF_LARGEST, RATIO_LOWEST, RATIO_HIGHEST } OverburdenWord;

/* Of the points that count: sums over them, and largest numbers. */
typedef struct {
  PetscReal volume, off;       /* off: times volume */
  PetscReal worst, less, more; /* worst: of what is off; stress over weight: -less and more */
} Tally;

static PetscErrorCode TallyPoints(Model *m, const MeasureSpec *s, Tally *t)
{
  const PetscInt body = measure_body(m, s);
  const Layer layer = layer_of(m, body);
  PetscReal sigma[6];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal share = measure_share(m, s, body, p);
    if (share == 0 || layer.g == 0) continue;
    const PetscReal weight = m->materials[m->points->material[p]].density * layer.g;
    const PetscReal volume = share * m->points->real[POINT_VOLUME][p];
    const PetscReal start =
      point_real(m->points, POINT_X, p)[layer.axis] - point_real(m->points, POINT_U, p)[layer.axis];
    PetscCall(ModelPointStress(m, p, sigma));
    const PetscReal above = weight * (layer.top + layer.sign * start);
    const PetscReal off = PetscAbsReal(sigma[layer.axis] + above) / (weight * layer.height);
    t->volume += volume;
    t->off += volume * off;
    t->worst = PetscMax(t->worst, off);
    t->less = PetscMax(t->less, sigma[layer.axis] / above);
    t->more = PetscMax(t->more, -sigma[layer.axis] / above);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode OffWeight(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  Tally t = {.worst = -PETSC_MAX_REAL, .less = -PETSC_MAX_REAL, .more = -PETSC_MAX_REAL};

  (void)index;
  PetscFunctionBeginUser;
  PetscCall(TallyPoints(m, s, &t));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &t.volume, 2, MPIU_REAL, MPI_SUM, m->comm));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &t.worst, 3, MPIU_REAL, MPI_MAX, m->comm));
  switch ((OverburdenWord)measure_number(s)->which) {
  case OFF_MEAN: *value = t.off / t.volume; break;
  case OFF_LARGEST: *value = t.worst; break;
  case RATIO_LOWEST: *value = -t.less; break;
  case RATIO_HIGHEST: *value = t.more; break;
  }
  if (t.volume == 0) *value = NAN;
  PetscFunctionReturn(0);
}

#define OVERBURDEN(word, what, number) WORD(word, what, .value = OffWeight, .which = number, .in = PETSC_TRUE)
static const MeasureNumber *const words[] = {
  OVERBURDEN("mean", "of all points, by their volume", OFF_MEAN),
  OVERBURDEN("largest", "of the point where it is most", OFF_LARGEST),
  OVERBURDEN("lowest_ratio", "the stress over the weight above, where that is least", RATIO_LOWEST),
  OVERBURDEN("highest_ratio", "the same where it is most", RATIO_HIGHEST),
  NULL,
};

const Measure measure_overburden = {
  .key = "overburden",
  .takes = MEASURE_WORD,
  .number = {.unit = "",
             .help = "how far the stress along gravity in a level layer, a body with a shape, is off the weight above "
                     "it, over that of the whole layer: 0 between smooth walls"},
  .words = words};
