/* How far the stress in a level layer is off the weight of what lies above: in uniaxial strain, as
 * between smooth walls, they are equal whatever the law and however much the layer has settled. */
#include <math.h>
#include "model/measure/measure.h"
#include "model/model_private.h"

/* A body as a level layer, by its shape, and gravity. */
typedef struct {
  PetscReal min[3], max[3]; /* along each axis, m; of gravity heights */
  PetscReal weight;         /* N/m3; 0: it is not there, or has no shape */
} Layer;

typedef struct {
  PetscInt axis; /* of gravity */
  PetscReal g, up;
  Layer *layer; /* of each body */
} Layers;

static Layer layer_of(const Model *m, PetscInt body, const Layers *all)
{
  const BodySpec *b = m->c->bodies + body;
  const PetscInt k = all->axis;
  Layer layer = {.weight = 0};
  if (!b->has_shape || b->absent) return layer;
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if (!strcmp(b->material, m->c->materials[i].name)) layer.weight = m->materials[i].density * all->g;
  shape_bounds(&b->shape, m->dim, layer.min, layer.max);
  if (all->up > 0) return layer;
  const PetscReal top = -layer.min[k];
  layer.min[k] = -layer.max[k];
  layer.max[k] = top;
  return layer;
}

static PetscErrorCode FindLayers(const Model *m, Layers *all)
{
  PetscReal g[3];

  PetscFunctionBeginUser;
  *all = (Layers){.axis = 0};
  gravity_at(m->c, m->time, g);
  for (PetscInt d = 1; d < m->dim; ++d)
    if (PetscAbsReal(g[d]) > PetscAbsReal(g[all->axis])) all->axis = d;
  all->g = PetscAbsReal(g[all->axis]);
  all->up = g[all->axis] < 0 ? 1 : -1;
  PetscCall(PetscMalloc1(m->c->n_bodies, &all->layer));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) all->layer[b] = layer_of(m, b, all);
  PetscFunctionReturn(0);
}

/* Weight above a place, where material was at the start, and of all that lies above and below it, Pa. */
static void weigh(const Model *m, const Layers *all, PetscInt own, const PetscReal *x, PetscReal *above,
                  PetscReal *whole)
{
  const PetscInt k = all->axis;
  const PetscReal height = all->up * x[k];
  *above = *whole = 0;
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) {
    const Layer *l = all->layer + b;
    PetscBool beside = PETSC_FALSE;
    for (PetscInt d = 0; d < m->dim && b != own; ++d) beside |= d != k && (x[d] < l->min[d] || x[d] > l->max[d]);
    if (beside || l->weight == 0) continue;
    *whole += l->weight * (l->max[k] - l->min[k]);
    *above += l->weight * PetscMax(0, l->max[k] - PetscMax(height, l->min[k]));
  }
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
  PetscReal sigma[6], x[3], above, whole;
  Layers all;

  PetscFunctionBeginUser;
  PetscCall(FindLayers(m, &all));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal share = measure_share(m, s, body, p);
    for (PetscInt d = 0; d < m->dim; ++d)
      x[d] = point_real(m->points, POINT_X, p)[d] - point_real(m->points, POINT_U, p)[d];
    weigh(m, &all, m->points->body[p], x, &above, &whole);
    if (share == 0 || whole == 0) continue;
    const PetscReal volume = share * m->points->real[POINT_VOLUME][p];
    PetscCall(ModelPointStress(m, p, sigma));
    const PetscReal off = PetscAbsReal(sigma[all.axis] + above) / whole;
    t->volume += volume;
    t->off += volume * off;
    t->worst = PetscMax(t->worst, off);
    t->less = PetscMax(t->less, sigma[all.axis] / above);
    t->more = PetscMax(t->more, -sigma[all.axis] / above);
  }
  PetscCall(PetscFree(all.layer));
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
             .help =
               "how far the stress along gravity in level layers is off the weight above it, over that of all "
               "layers there (the shapes of all bodies, which need one): 0 between smooth walls, but for what cells "
               "cannot follow (a linear cell has the stress of its middle: of 16 cells on each other, 0.0156 "
               "at points a quarter from their sides)"},
  .words = words};
