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

/* N of four points at each of their nodes. */
KERNEL void shapes(const Place *place, PetscInt k, Four N[4])
{
  const Four x = FOUR_OF(place->at[0] + k), y = FOUR_OF(place->at[1] + k);
  for (int i = 0; i < 4; ++i) N[i] = (i & 1 ? x : 1 - x) * (i & 2 ? y : 1 - y);
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

/* Of the cell's nodes: velocity and gain, row by row. */
KERNEL void fetch_motion(const Explicit *e, const Lattice *l, int32_t cell, Four motion[4])
{
  for (int k = 0; k < 4; ++k) motion[k] = FOUR(e->motion + l->number[cell + l->corner[k]] * 4);
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
  PetscReal N[4][LAW_BATCH];
  Four motion[4] = {{0}}, shape[4];
  int32_t cell = -1;
  for (PetscInt k = 0; k < n; k += 4) {
    shapes(place, k, shape);
    for (int i = 0; i < 4; ++i) FOUR(N[i] + k) = shape[i];
  }
  for (PetscInt k = 0; k < n; ++k) {
    if (place->cell[k] != cell) fetch_motion(e, &e->lattice, cell = place->cell[k], motion);
    felt[k] = (N[0][k] * motion[0] + N[1][k] * motion[1]) + (N[2][k] * motion[2] + N[3][k] * motion[3]);
  }
}

void plane_gain(const Model *m, Explicit *e)
{
  const Points *points = m->points;
  const PetscBool again = m->c->analysis.update == EXPLICIT_MUSL;
  PetscReal momentum[2 * LAW_BATCH];
  Four sum[2] = {{0}}, damped = {0}, felt[LAW_BATCH] = {{0}}, N[2];
  int32_t cell = -1;
  Place place;
  for (PetscInt first = 0; first < points->n; first += LAW_BATCH) {
    const PetscInt n = PetscMin(LAW_BATCH, points->n - first);
    locate(&e->lattice, n, point_real(points, POINT_X, first), &place);
    feel(e, &place, n, felt);
    speed_up_all(points, first, n, e, felt, momentum, &damped);
    for (PetscInt k = 0; again && k < n; ++k) {
      if (place.cell[k] != cell) bring(2, &e->lattice, cell, sum, e->straining);
      cell = place.cell[k];
      along(&place, k, N);
      const Four weight = N[0] * N[1];
      for (int d = 0; d < 2; ++d) sum[d] += momentum[2 * k + d] * weight;
      if (e->slopes) lean(&e->lattice, points, first + k, explicit_half(e), &place, k, &weight, sum);
    }
  }
  if (again) bring(2, &e->lattice, cell, sum, e->straining);
  e->damped += (damped[0] + damped[1]) + (damped[2] + damped[3]);
}

/* What strains the points of a cell: gradient = constant + bilinear {y, y, x, x}, of rows xx yx xy yy. */
typedef struct {
  Four motion[4], constant, bilinear;
  PetscReal first[4]; /* component x of the nodes' velocities */
} Flow;

KERNEL void fetch_flow(const Explicit *e, const Lattice *l, int32_t cell, Flow *f)
{
  const Four per_length = {l->per_length[0], l->per_length[0], l->per_length[1], l->per_length[1]};
  const PetscReal *v[4];
  for (int k = 0; k < 4; ++k) {
    const PetscInt node = l->number[cell + l->corner[k]];
    const PetscReal *way = explicit_way(e, 2, node);
    f->motion[k] = (Four){way[0], way[1], way[0], way[1]};
    v[k] = e->straining + node * 2;
  }
  for (int d = 0; d < 2; ++d) {
    const PetscReal twist = (v[3][d] - v[2][d]) - (v[1][d] - v[0][d]);
    f->constant[d] = v[1][d] - v[0][d];
    f->constant[2 + d] = v[2][d] - v[0][d];
    f->bilinear[d] = f->bilinear[2 + d] = twist;
  }
  f->constant *= e->dt * per_length;
  f->bilinear *= e->dt * per_length;
  for (int k = 0; k < 4; ++k) f->first[k] = v[k][0];
}

KERNEL void flow_past(const PetscBool hoop, const Points *points, PetscInt first, PetscInt n, const Explicit *e,
                      const Place *place, Strain *s)
{
  PetscReal N[4][LAW_BATCH];
  Four shape[4];
  Flow f = {0};
  int32_t cell = -1;
  for (PetscInt k = 0; k < n; k += 4) {
    shapes(place, k, shape);
    for (int i = 0; i < 4; ++i) FOUR(N[i] + k) = shape[i];
  }
  for (PetscInt k = 0; k < n; ++k) {
    const PetscReal x = place->at[0][k], y = place->at[1][k];
    if (place->cell[k] != cell) fetch_flow(e, &e->lattice, cell = place->cell[k], &f);
    s->A[k] = f.constant + f.bilinear * (Four){y, y, x, x};
    s->move[k] = (N[0][k] * f.motion[0] + N[1][k] * f.motion[1]) + (N[2][k] * f.motion[2] + N[3][k] * f.motion[3]);
    if (hoop) {
      const PetscReal v = N[0][k] * f.first[0] + N[1][k] * f.first[1] + N[2][k] * f.first[2] + N[3][k] * f.first[3];
      s->ring[k] = e->dt * v / *point_real(points, POINT_X, first + k);
    }
  }
  rest_of_batch(n, s);
}

KERNEL void strain(const PetscBool hoop, const Model *m, Explicit *e)
{
  Points *points = m->points;
  Four sum[5] = {{0}};
  int32_t cell = -1;
  Place place;
  Strain s;
  Batch b = {.dF = {{0}}};
  Given g;
  batch_begin(&b);
  for (PetscInt first = 0, n; first < points->n; first += n) {
    n = batch_points(points, first);
    locate(&e->lattice, n, point_real(points, POINT_X, first), &place);
    flow_past(hoop, points, first, n, e, &place, &s);
    strain_batch(hoop, m, e, first, n, &s, &b, &g);
    if (e->ends) continue;
    weigh(points, first, n, &g);
    locate(&e->lattice, n, point_real(points, POINT_X, first), &place);
    give(hoop, points, first, n, &place, &g, &cell, sum, e);
  }
  bring(5, &e->lattice, cell, sum, e->sum);
}

void plane_strain(const Model *m, Explicit *e)
{
  if (m->c->kinematics->hoop) strain(PETSC_TRUE, m, e);
  else strain(PETSC_FALSE, m, e);
}
