/* The walks of points.c in the plane, over boxes whose points find their nodes by arithmetic. What each point does
 * alone is done for four points at a time; what is between points and nodes, for the four nodes of a cell: points
 * of a cell follow each other between laps, so that its nodes are fetched once for all of them, and what they give
 * to the nodes is summed before it is brought there. */
#include "model/explicit/kernels/plane.h"

static const Four slope[2] = {{-1, 1, -1, 1}, {-1, -1, 1, 1}}, begin[2] = {{1, 0, 1, 0}, {1, 1, 0, 0}};

/* Where n points stand, x: n x 2. */
KERNEL void locate(const Lattice *l, PetscInt n, const PetscReal *x, Place *place)
{
  for (PetscInt k = 0; k < n; k += 4) {
    Four pair[2], xy[2];
    FourCells first = {0};
    take(x + 2 * k, 2 * (n - k), &pair[0]);
    take(x + 2 * k + 4, 2 * (n - k) - 4, &pair[1]);
    part(pair, xy);
    for (int d = 0; d < 2; ++d) locate_along(l, d, &xy[d], &first, place->at[d] + k);
    memcpy(place->cell + k, &first, sizeof first);
  }
}

/* Functions along each axis of one point at the four nodes. */
KERNEL void along(const Place *place, PetscInt k, Four N[2])
{
  for (int d = 0; d < 2; ++d) N[d] = begin[d] + place->at[d][k] * slope[d];
}

/* n numbers of each node of the cell go to the nodes; the sums start anew. The first four are turned, to be added
 * at once. */
KERNEL void bring(const int n, const Lattice *l, int32_t cell, Four *sum, PetscReal *nodes)
{
  Four row[4];
  for (int i = 0; i < 4; ++i) row[i] = i < n ? sum[i] : (Four){0};
  if (n > 2) turn(row);
  for (int k = 0; k < 4 && cell >= 0; ++k) {
    PetscReal *to = nodes + l->number[cell + l->corner[k]] * n;
    if (n > 2) FOUR(to) += row[k];
    for (int i = n > 2 ? 4 : 0; i < n; ++i) to[i] += sum[i][k];
  }
  for (int i = 0; i < n; ++i) sum[i] = (Four){0};
}

/* Linear functions of a cell: f = start + x along_x + y (along_y + x twist), of its nodes' values. */
typedef struct {
  Four start, along_x, along_y, twist;
} Bilinear;

KERNEL void bilinear_of(const Four value[4], Bilinear *f)
{
  f->start = value[0];
  f->along_x = value[1] - value[0];
  f->along_y = value[2] - value[0];
  f->twist = (value[3] - value[2]) - f->along_x;
}

/* At point k of a batch. */
KERNEL void bilinear_at(const Bilinear *f, const Place *place, PetscInt k, Four *value)
{
  const PetscReal x = place->at[0][k], y = place->at[1][k];
  *value = (f->start + x * f->along_x) + y * (f->along_y + x * f->twist);
}

/* Velocity and gain. */
KERNEL void fetch_motion(const Explicit *e, const Lattice *l, int32_t cell, Bilinear *motion)
{
  Four value[4];
  for (int k = 0; k < 4; ++k) value[k] = FOUR_OF(e->motion + l->number[cell + l->corner[k]] * 4);
  bilinear_of(value, motion);
}

/* What the gradient that point p, the k-th, carries adds to the momentum of the nodes: m N G (x_I - x_p). */
KERNEL void lean(const Lattice *l, const Points *points, PetscInt p, PetscReal ahead, const Place *place, PetscInt k,
                 const Four *weight, Four momentum[2])
{
  const PetscReal mass = points->real[POINT_MASS][p];
  PetscReal G[4];
  slope_at(2, point_real(points, POINT_SLOPE, p), ahead, G);
  const Four x = mass * l->size[0] * *weight * (1 - begin[0] - place->at[0][k]),
             y = mass * l->size[1] * *weight * (1 - begin[1] - place->at[1][k]);
  momentum[0] += G[0] * x + G[1] * y;
  momentum[1] += G[2] * x + G[3] * y;
}

/* f_I = - V_0 tau grad N_I, with gradients where the point is now. cell: that of the sums so far. */
KERNEL void give(const PetscBool hoop, const Points *points, PetscInt first, PetscInt n, const Place *place,
                 const Given *g, int32_t *cell, Four sum[5], Explicit *e)
{
  const Lattice *l = &e->lattice;
  const Four rise[2] = {slope[0] * l->per_length[0], slope[1] * l->per_length[1]};
  Four N[2];
  for (PetscInt k = 0; k < n; ++k) {
    if (place->cell[k] != *cell) bring(5, l, *cell, sum, e->sum);
    *cell = place->cell[k];
    along(place, k, N);
    const Four weight = N[0] * N[1], dx = rise[0] * N[1], dy = rise[1] * N[0];
    sum[0] += g->mass[k] * weight;
    sum[1] += g->momentum[2 * k] * weight;
    sum[2] += g->momentum[2 * k + 1] * weight;
    if (e->slopes) lean(l, points, first + k, -explicit_half(e), place, k, &weight, sum + 1);
    sum[3] += g->tau[0][k] * dx + g->tau[3][k] * dy;
    sum[4] += g->tau[3][k] * dx + g->tau[1][k] * dy;
    if (hoop) sum[3] += g->tau[2][k] / *point_real(points, POINT_X, first + k) * weight;
  }
}

KERNEL void gather(const PetscBool hoop, const Points *points, Explicit *e)
{
  Four sum[5] = {{0}};
  int32_t cell = -1;
  Place place;
  Given g;
  for (PetscInt first = 0; first < points->n; first += LAW_BATCH) {
    const PetscInt n = PetscMin(LAW_BATCH, points->n - first);
    locate(&e->lattice, n, point_real(points, POINT_X, first), &place);
    weigh(points, first, n, &g);
    load(points, first, n, &g);
    give(hoop, points, first, n, &place, &g, &cell, sum, e);
  }
  bring(5, &e->lattice, cell, sum, e->sum);
}

void plane_gather(const Model *m, Explicit *e)
{
  if (m->c->kinematics->hoop) gather(PETSC_TRUE, m->points, e);
  else gather(PETSC_FALSE, m->points, e);
}

/* Velocity and gain of the nodes where the points of a batch are. */
KERNEL void feel(const Explicit *e, const Place *place, PetscInt n, Four *felt)
{
  Bilinear motion = {.start = {0}};
  int32_t cell = -1;
  for (PetscInt k = 0; k < n; ++k) {
    if (place->cell[k] != cell) fetch_motion(e, &e->lattice, cell = place->cell[k], &motion);
    bilinear_at(&motion, place, k, felt + k);
  }
}

typedef struct {
  Four sum[2], damped, felt[LAW_BATCH];
  PetscReal momentum[2 * LAW_BATCH];
  int32_t cell;
  Place place;
} Gain;

KERNEL void gain_some(const PetscBool again, const Points *points, PetscInt first, PetscInt n, Explicit *e, Gain *w)
{
  Four N[2];
  locate(&e->lattice, n, point_real(points, POINT_X, first), &w->place);
  feel(e, &w->place, n, w->felt);
  speed_up_all(points, first, n, e, w->felt, w->momentum, &w->damped);
  for (PetscInt k = 0; again && k < n; ++k) {
    if (w->place.cell[k] != w->cell) bring(2, &e->lattice, w->cell, w->sum, e->straining);
    w->cell = w->place.cell[k];
    along(&w->place, k, N);
    const Four weight = N[0] * N[1];
    for (int d = 0; d < 2; ++d) w->sum[d] += w->momentum[2 * k + d] * weight;
    if (e->slopes) lean(&e->lattice, points, first + k, explicit_half(e), &w->place, k, &weight, w->sum);
  }
}

void plane_gain(const Model *m, Explicit *e)
{
  const Points *points = m->points;
  const PetscBool again = m->c->analysis.update == EXPLICIT_MUSL;
  Gain w = {.cell = -1};
  for (PetscInt first = 0; first < points->n; first += LAW_BATCH) {
    const PetscInt n = PetscMin(LAW_BATCH, points->n - first);
    if (n == LAW_BATCH) gain_some(again, points, first, LAW_BATCH, e, &w);
    else gain_some(again, points, first, n, e, &w);
  }
  if (again) bring(2, &e->lattice, w.cell, w.sum, e->straining);
  e->damped += (w.damped[0] + w.damped[1]) + (w.damped[2] + w.damped[3]);
}

/* What strains the points of a cell: gradient = constant + bilinear {y, y, x, x}, of rows xx yx xy yy; the way that
 * they go, twice; and the velocity towards a ring's outside, in the first component. */
typedef struct {
  Four constant, bilinear;
  Bilinear way, out;
} Flow;

KERNEL void fetch_flow(const PetscBool hoop, const Explicit *e, const Lattice *l, int32_t cell, Flow *f)
{
  const Four per_length = {l->per_length[0], l->per_length[0], l->per_length[1], l->per_length[1]};
  Four way[4], v[4];
  for (int k = 0; k < 4; ++k) {
    const PetscInt node = l->number[cell + l->corner[k]];
    const PetscReal *to = explicit_way(e, 2, node), *by = e->straining + node * 2;
    way[k] = (Four){to[0], to[1], to[0], to[1]};
    v[k] = (Four){by[0], by[1], by[0], by[1]};
  }
  const Four along_x = v[1] - v[0], along_y = v[2] - v[0], twist = (v[3] - v[2]) - along_x;
  f->constant = e->dt * per_length * __builtin_shufflevector(along_x, along_y, 0, 1, 4, 5);
  f->bilinear = e->dt * per_length * twist;
  bilinear_of(way, &f->way);
  if (hoop) bilinear_of(v, &f->out);
}

KERNEL void flow_past(const PetscBool hoop, const Points *points, PetscInt first, PetscInt n, const Explicit *e,
                      const Place *place, Strain *s)
{
  Flow f = {.constant = {0}};
  Four out;
  int32_t cell = -1;
  for (PetscInt k = 0; k < n; ++k) {
    const PetscReal x = place->at[0][k], y = place->at[1][k];
    if (place->cell[k] != cell) fetch_flow(hoop, e, &e->lattice, cell = place->cell[k], &f);
    s->A[k] = f.constant + f.bilinear * (Four){y, y, x, x};
    bilinear_at(&f.way, place, k, s->move + k);
    if (!hoop) continue;
    bilinear_at(&f.out, place, k, &out);
    s->ring[k] = e->dt * out[0] / *point_real(points, POINT_X, first + k);
  }
  rest_of_batch(n, s);
}

/* What a walk hands from batch to batch: what the nodes of a cell are to get, and room. */
typedef struct {
  Four sum[5];
  int32_t cell;
  Place place;
  Strain s;
  Batch b;
  Given g;
} Walk;

KERNEL void strain_some(const PetscBool hoop, const Model *m, Explicit *e, PetscInt first, PetscInt n, Walk *w)
{
  const Points *points = m->points;
  locate(&e->lattice, n, point_real(points, POINT_X, first), &w->place);
  flow_past(hoop, points, first, n, e, &w->place, &w->s);
  strain_batch(hoop, m, e, first, n, &w->s, &w->b, &w->g);
  if (e->ends) return;
  weigh(points, first, n, &w->g);
  locate(&e->lattice, n, point_real(points, POINT_X, first), &w->place);
  give(hoop, points, first, n, &w->place, &w->g, &w->cell, w->sum, e);
}

KERNEL void strain(const PetscBool hoop, const Model *m, Explicit *e)
{
  Walk w = {.cell = -1};
  batch_begin(&w.b);
  for (PetscInt first = 0, n; first < m->points->n; first += n) {
    n = batch_points(m, first);
    if (n == LAW_BATCH) strain_some(hoop, m, e, first, LAW_BATCH, &w);
    else strain_some(hoop, m, e, first, n, &w);
  }
  bring(5, &e->lattice, w.cell, w.sum, e->sum);
}

void plane_strain(const Model *m, Explicit *e)
{
  if (m->c->kinematics->hoop) strain(PETSC_TRUE, m, e);
  else strain(PETSC_FALSE, m, e);
}
