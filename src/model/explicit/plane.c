/* The walks of points.c in the plane, over boxes whose points find their nodes by arithmetic. What each point does
 * alone is done for four points at a time; what is between points and nodes, for the four nodes of a cell: points
 * of a cell follow each other between laps, so that its nodes are fetched once for all of them, and what they give
 * to the nodes is summed before it is brought there. */
#include "model/explicit/four.h"

static const Four slope[2] = {{-1, 1, -1, 1}, {-1, -1, 1, 1}}, begin[2] = {{1, 0, 1, 0}, {1, 1, 0, 0}};

/* x and y of four points from two registers in which they follow each other. */
KERNEL void part(const Four pair[2], Four xy[2])
{
  xy[0] = __builtin_shufflevector(pair[0], pair[1], 0, 2, 4, 6);
  xy[1] = __builtin_shufflevector(pair[0], pair[1], 1, 3, 5, 7);
}

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

/* Mass, momentum and force of n points of a batch from `first`; tau: -V_0 times the stress. */
typedef struct {
  Place place;
  PetscReal mass[LAW_BATCH], momentum[2 * LAW_BATCH], tau[4][LAW_BATCH];
} Given;

KERNEL void weigh(const Points *points, PetscInt first, PetscInt n, Given *g)
{
  const PetscReal *v = point_real(points, POINT_V, first), *mass = points->real[POINT_MASS] + first;
  for (PetscInt k = 0; k < n; ++k) {
    g->mass[k] = mass[k];
    g->momentum[2 * k] = mass[k] * v[2 * k];
    g->momentum[2 * k + 1] = mass[k] * v[2 * k + 1];
  }
}

/* What the gradient that point p, the k-th, carries adds to the momentum of the nodes: m N G (x_I - x_p). */
KERNEL void lean(const Lattice *l, const Points *points, PetscInt p, const Place *place, PetscInt k, const Four *weight,
                 Four momentum[2])
{
  const PetscReal *G = point_real(points, POINT_SLOPE, p), mass = points->real[POINT_MASS][p];
  const Four x = mass * l->size[0] * *weight * (1 - begin[0] - place->at[0][k]),
             y = mass * l->size[1] * *weight * (1 - begin[1] - place->at[1][k]);
  momentum[0] += G[0] * x + G[1] * y;
  momentum[1] += G[2] * x + G[3] * y;
}

/* f_I = - V_0 tau grad N_I, with gradients where the point is now. cell: that of the sums so far. */
KERNEL void give(const PetscBool hoop, const Points *points, PetscInt first, PetscInt n, const Given *g, int32_t *cell,
                 Four sum[5], Explicit *e)
{
  const Lattice *l = &e->lattice;
  const Four rise[2] = {slope[0] * l->per_length[0], slope[1] * l->per_length[1]};
  Four N[2];
  for (PetscInt k = 0; k < n; ++k) {
    if (g->place.cell[k] != *cell) bring(5, l, *cell, sum, e->sum);
    *cell = g->place.cell[k];
    along(&g->place, k, N);
    const Four weight = N[0] * N[1], dx = rise[0] * N[1], dy = rise[1] * N[0];
    sum[0] += g->mass[k] * weight;
    sum[1] += g->momentum[2 * k] * weight;
    sum[2] += g->momentum[2 * k + 1] * weight;
    if (e->slopes) lean(l, points, first + k, &g->place, k, &weight, sum + 1);
    sum[3] += g->tau[0][k] * dx + g->tau[3][k] * dy;
    sum[4] += g->tau[3][k] * dx + g->tau[1][k] * dy;
    if (hoop) sum[3] += g->tau[2][k] / *point_real(points, POINT_X, first + k) * weight;
  }
}

KERNEL void gather(const PetscBool hoop, const Points *points, Explicit *e)
{
  Four sum[5] = {{0}};
  int32_t cell = -1;
  Given g;
  for (PetscInt first = 0; first < points->n; first += LAW_BATCH) {
    const PetscInt n = PetscMin(LAW_BATCH, points->n - first);
    const PetscReal *tau = point_real(points, POINT_TAU, first), *volume = points->real[POINT_VOLUME] + first;
    locate(&e->lattice, n, point_real(points, POINT_X, first), &g.place);
    weigh(points, first, n, &g);
    for (PetscInt k = 0; k < n; ++k)
      for (int i = 0; i < 4; ++i) g.tau[i][k] = -volume[k] * tau[4 * k + i];
    give(hoop, points, first, n, &g, &cell, sum, e);
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

/* Points k and k + 1 of a batch gain velocity: `left` numbers from v on are the batch's. */
KERNEL void speed_up(const Explicit *e, const Four *felt, const Four *mass, PetscInt left, PetscReal *v, PetscReal *a,
                     PetscReal *momentum, Four *damped)
{
  const PetscReal kept = 1 - e->fade;
  const Four gained = __builtin_shufflevector(felt[0], felt[1], 2, 3, 6, 7),
             seen = __builtin_shufflevector(felt[0], felt[1], 0, 1, 4, 5);
  Four old;
  take(v, left, &old);
  Four now = kept * old + gained;
  if (e->slopes) now += e->unseen * (seen - now);
  *damped += *mass * (old * old);
  put(&now, left, v);
  FOUR(momentum) = *mass * now;
  if (!e->ends) return;
  const Four acceleration = gained * (1 / e->kick);
  put(&acceleration, left, a);
}

/* ... and all of them. */
KERNEL void speed_up_all(const Points *points, PetscInt first, PetscInt n, const Explicit *e, const Four *felt,
                         PetscReal *momentum, Four *damped)
{
  PetscReal *v = point_real(points, POINT_V, first), *a = point_real(points, POINT_A, first);
  for (PetscInt k = 0; k < n; k += 4) {
    Four mass;
    take(points->real[POINT_MASS] + first + k, n - k, &mass);
    const Four low = __builtin_shufflevector(mass, mass, 0, 0, 1, 1),
               high = __builtin_shufflevector(mass, mass, 2, 2, 3, 3);
    speed_up(e, felt + k, &low, 2 * (n - k), v + 2 * k, a + 2 * k, momentum + 2 * k, damped);
    speed_up(e, felt + k + 2, &high, 2 * (n - k) - 4, v + 2 * k + 4, a + 2 * k + 4, momentum + 2 * k + 4, damped);
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
      if (e->slopes) lean(&e->lattice, points, first + k, &place, k, &weight, sum);
    }
  }
  if (again) bring(2, &e->lattice, cell, sum, e->straining);
  e->damped += 0.5 * e->fade * (2 - e->fade) * ((damped[0] + damped[1]) + (damped[2] + damped[3]));
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
  fetch_motion(e, l, cell, f->motion);
  for (int k = 0; k < 4; ++k) v[k] = e->straining + l->number[cell + l->corner[k]] * 2;
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

/* Strain increments dF - 1 of a batch: rows xx yx xy yy a point, and zz where that is a ring; and by how much the
 * points move. */
typedef struct {
  Four A[LAW_BATCH], move[LAW_BATCH];
  PetscReal ring[LAW_BATCH];
} Strain;

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
  for (PetscInt k = n; k < LAW_BATCH; ++k) {
    s->A[k] = (Four){0};
    s->ring[k] = 0;
  }
}

/* F of one point after dF. */
KERNEL void deform(const Four *A, PetscReal *F)
{
  const Four f = FOUR(F), left = __builtin_shufflevector(*A, *A, 0, 0, 1, 1),
             right = __builtin_shufflevector(*A, *A, 2, 2, 3, 3);
  const Four upper = __builtin_shufflevector(f, f, 0, 1, 0, 1), lower = __builtin_shufflevector(f, f, 2, 3, 2, 3);
  FOUR(F) = f + left * upper + right * lower;
}

/* Four points from p on move; F, J and the law's dF. n: as many of them are the batch's. */
KERNEL void move_on(const PetscBool hoop, Points *points, PetscInt p, PetscInt n, const Explicit *e, Strain *s,
                    PetscInt k, Batch *b)
{
  PetscReal *x = point_real(points, POINT_X, p), *F = point_real(points, POINT_F, p);
  Four A[4], pair, J, ring = {0};
  for (int i = 0; i < 2; ++i) {
    take(x + 4 * i, 2 * n - 4 * i, &pair);
    pair += e->dt * __builtin_shufflevector(s->move[k + 2 * i], s->move[k + 2 * i + 1], 0, 1, 4, 5);
    put(&pair, 2 * n - 4 * i, x + 4 * i);
  }
  for (PetscInt i = 0; i < PetscMin(n, 4); ++i) {
    deform(&s->A[k + i], F + 5 * i);
    if (hoop) F[5 * i + 4] += s->ring[k + i] * F[5 * i + 4];
  }
  if (hoop) ring = FOUR(s->ring + k);
  for (int i = 0; i < 4; ++i) A[i] = s->A[k + i];
  turn(A);
  take(points->real[POINT_J] + p, n, &J);
  J *= ((1 + A[0]) * (1 + A[3]) - A[1] * A[2]) * (1 + ring);
  put(&J, n, points->real[POINT_J] + p);
  FOUR(b->dF[0] + k) = 1 + A[0];
  FOUR(b->dF[1] + k) = A[2];
  FOUR(b->dF[2] + k) = A[1];
  FOUR(b->dF[3] + k) = 1 + A[3];
  FOUR(b->dF[4] + k) = 1 + ring;
}

/* Stress of four points from p on, and its work, as `keep` of points.c has them. */
KERNEL void keep(const PetscBool hoop, Points *points, PetscInt p, PetscInt n, const Batch *b, PetscInt k, Given *g)
{
  PetscReal *stress = point_real(points, POINT_TAU, p);
  Four old[4], tau[4], volume, work, part_of = {0};
  for (int i = 0; i < 4; ++i) take(stress + 4 * i, n > i ? 4 : 0, &old[i]);
  turn(old);
  for (int i = 0; i < 4; ++i) tau[i] = FOUR_OF(b->tau[i] + k);
  const Four xx = FOUR_OF(b->dF[0] + k) - 1, xy = FOUR_OF(b->dF[1] + k), yx = FOUR_OF(b->dF[2] + k);
  const Four yy = FOUR_OF(b->dF[3] + k) - 1, across = xy * yx, shear = xy + yx;
  if (hoop) {
    const Four ring = FOUR_OF(b->dF[4] + k) - 1;
    part_of = old[2] * ring + tau[2] * (ring - ring * ring);
  }
  part_of += old[0] * xx + old[1] * yy + old[3] * shear + tau[0] * (xx - xx * xx - across) +
             tau[1] * (yy - yy * yy - across) + tau[3] * (shear - (xx + yy) * shear);
  take(points->real[POINT_VOLUME] + p, n, &volume);
  take(points->real[POINT_WORK] + p, n, &work);
  work += 0.5 * volume * part_of;
  put(&work, n, points->real[POINT_WORK] + p);
  for (int i = 0; i < 4; ++i) FOUR(g->tau[i] + k) = -volume * tau[i];
  turn(tau);
  for (int i = 0; i < 4 && i < n; ++i) FOUR(stress + 4 * i) = tau[i];
}

KERNEL void strain(const PetscBool hoop, const Model *m, Explicit *e)
{
  Points *points = m->points;
  Four sum[5] = {{0}};
  int32_t cell = -1;
  Strain s;
  Batch b = {.dF = {{0}}};
  Given g;
  for (int k = 0; k < LAW_BATCH; ++k) b.dF[0][k] = b.dF[3][k] = b.dF[4][k] = 1; /* lanes behind the last point */
  for (PetscInt first = 0, n; first < points->n; first += n) {
    n = batch_points(points, first);
    locate(&e->lattice, n, point_real(points, POINT_X, first), &g.place);
    flow_past(hoop, points, first, n, e, &g.place, &s);
    for (PetscInt k = 0; k < n; k += 4) move_on(hoop, points, first + k, n - k, e, &s, k, &b);
    const LawStatus status = batch_stress(m, first, n, &b);
    e->status = PetscMax(e->status, status);
    for (PetscInt k = 0; k < n; k += 4) keep(hoop, points, first + k, n - k, &b, k, &g);
    for (PetscInt k = 0; e->slopes && k < n; ++k) {
      const PetscReal A[3][3] = {{s.A[k][0], s.A[k][2]}, {s.A[k][1], s.A[k][3]}};
      slope_follow(2, e, A, point_real(points, POINT_SLOPE, first + k));
    }
    if (e->ends) continue;
    weigh(points, first, n, &g);
    locate(&e->lattice, n, point_real(points, POINT_X, first), &g.place);
    give(hoop, points, first, n, &g, &cell, sum, e);
  }
  bring(5, &e->lattice, cell, sum, e->sum);
}

void plane_strain(const Model *m, Explicit *e)
{
  if (m->c->kinematics->hoop) strain(PETSC_TRUE, m, e);
  else strain(PETSC_FALSE, m, e);
}
