/* The walks of points.c in space, over boxes whose points find their nodes by arithmetic: as those of the plane
 * (plane.c), but with three components of one node or point in a register. Sums over the eight nodes go along the
 * four sides of a cell in each direction: a gradient along x is made of what the two ends of four sides differ by. */
#include "model/explicit/kernels/four.h"

/* Where points stand, N at each node, and the shape function of each side along x, y and z. */
typedef struct {
  Place place;
  PetscReal N[8][LAW_BATCH], side[3][4][LAW_BATCH];
} Shapes;

/* The first node of side j along d; its other node is 1 << d farther. */
KERNEL int side_start(int d, int j) { return (j & ((1 << d) - 1)) | (j >> d) << (d + 1); }

/* Component d of four points, n of which are the batch's, `stride` numbers from point to point. */
KERNEL void pick(const PetscReal *from, int stride, PetscInt n, Four *to)
{
  *to = (Four){0};
  if (n >= 4) *to = (Four){from[0], from[stride], from[2 * stride], from[3 * stride]};
  else
    for (int k = 0; k < n; ++k) (*to)[k] = from[k * stride];
}

/* Where n points stand, x: n x 3. */
KERNEL void locate(const Lattice *l, PetscInt n, const PetscReal *x, Shapes *s)
{
  for (PetscInt k = 0; k < n; k += 4) {
    Four at[3][2];
    FourCells first = {0};
    for (int d = 0; d < 3; ++d) {
      Four place;
      pick(x + 3 * k + d, 3, n - k, &place);
      locate_along(l, d, &place, &first, s->place.at[d] + k);
      at[d][1] = FOUR_OF(s->place.at[d] + k);
      at[d][0] = 1 - at[d][1];
    }
    memcpy(s->place.cell + k, &first, sizeof first);
#pragma GCC unroll 4
    for (int j = 0; j < 4; ++j) {
      const Four along_x = at[1][j & 1] * at[2][j >> 1];
      FOUR(s->side[0][j] + k) = along_x;
      FOUR(s->side[1][j] + k) = at[0][j & 1] * at[2][j >> 1];
      FOUR(s->side[2][j] + k) = at[0][j & 1] * at[1][j >> 1];
      FOUR(s->N[2 * j] + k) = at[0][0] * along_x;
      FOUR(s->N[2 * j + 1] + k) = at[0][1] * along_x;
    }
  }
}

/* Points from k on that are in one cell. */
KERNEL PetscInt run_of(const Place *place, PetscInt k, PetscInt n)
{
  PetscInt end = k + 1;
  while (end < n && place->cell[end] == place->cell[k]) ++end;
  return end;
}

/* Four numbers from each node of a cell, `width` to a node. */
KERNEL void fetch(const Lattice *l, int32_t cell, int width, const PetscReal *nodes, Four value[8])
{
#pragma GCC unroll 8
  for (int k = 0; k < 8; ++k) value[k] = FOUR_OF(nodes + l->number[cell + l->corner[k]] * width);
}

KERNEL void bring(const Lattice *l, int32_t cell, int width, const Four value[8], PetscReal *nodes)
{
#pragma GCC unroll 8
  for (int k = 0; k < 8; ++k) FOUR(nodes + l->number[cell + l->corner[k]] * width) += value[k];
}

KERNEL void mean(const Shapes *s, PetscInt k, const Four value[8], Four *to)
{
  *to = ((s->N[0][k] * value[0] + s->N[1][k] * value[1]) + (s->N[2][k] * value[2] + s->N[3][k] * value[3])) +
        ((s->N[4][k] * value[4] + s->N[5][k] * value[5]) + (s->N[6][k] * value[6] + s->N[7][k] * value[7]));
}

/* The first three of `value` at the points of a run go to their nodes. */
KERNEL void share(const Lattice *l, const Shapes *s, PetscInt k, PetscInt end, const Four *value, int width,
                  PetscReal *nodes)
{
  Four sum[8] = {{0}};
  const int32_t cell = s->place.cell[k];
  for (; k < end; ++k) {
#pragma GCC unroll 8
    for (int i = 0; i < 8; ++i) sum[i] += s->N[i][k] * value[k];
  }
  bring(l, cell, width, sum, nodes);
}

/* Momentum of a point with the gradient that it carries: m (v + G (x_I - x_p)) at the cell's first node, and what a
 * side along each axis adds. at: the first component of momentum in `value`. */
KERNEL void lean(const Lattice *l, const Shapes *s, const Points *points, PetscInt p, PetscReal ahead, PetscInt k,
                 int at, const Four *value, Four corner[8])
{
  const PetscReal mass = points->real[POINT_MASS][p];
  PetscReal G[9];
  slope_at(3, point_real(points, POINT_SLOPE, p), ahead, G);
  Four rise[3], start = *value;
  for (int d = 0; d < 3; ++d) {
    rise[d] = (Four){0};
    for (int i = 0; i < 3; ++i) rise[d][at + i] = mass * l->size[d] * G[3 * i + d];
    start -= s->place.at[d][k] * rise[d];
  }
#pragma GCC unroll 8
  for (int i = 0; i < 8; ++i) {
    corner[i] = start;
    for (int d = 0; d < 3; ++d)
      if (i >> d & 1) corner[i] += rise[d];
  }
}

/* As `share`, of points that carry gradients; p: the one that is the batch's first. */
KERNEL void share_leaning(const Lattice *l, const Shapes *s, const Points *points, PetscInt p, PetscReal ahead,
                          PetscInt k, PetscInt end, int at, const Four *value, int width, PetscReal *nodes)
{
  Four sum[8] = {{0}}, corner[8];
  const int32_t cell = s->place.cell[k];
  for (; k < end; ++k) {
    lean(l, s, points, p + k, ahead, k, at, &value[k], corner);
#pragma GCC unroll 8
    for (int i = 0; i < 8; ++i) sum[i] += s->N[i][k] * corner[i];
  }
  bring(l, cell, width, sum, nodes);
}

/* Mass and momentum of the points of a batch, and -V_0 tau over the cell's length along x, y, z: columns. */
typedef struct {
  Four inertia[LAW_BATCH], pull[3][LAW_BATCH];
} Given;

/* f_I = - V_0 tau grad N_I, of the points of a run. */
KERNEL void push(const Lattice *l, const Shapes *s, PetscInt k, PetscInt end, const Given *g, PetscReal *nodes)
{
  Four sum[3][4] = {{{0}}}, force[8] = {{0}};
  const int32_t cell = s->place.cell[k];
  for (; k < end; ++k) {
#pragma GCC unroll 3
    for (int d = 0; d < 3; ++d)
#pragma GCC unroll 4
      for (int j = 0; j < 4; ++j) sum[d][j] += s->side[d][j][k] * g->pull[d][k];
  }
#pragma GCC unroll 3
  for (int d = 0; d < 3; ++d)
#pragma GCC unroll 4
    for (int j = 0; j < 4; ++j) {
      force[side_start(d, j)] -= sum[d][j];
      force[side_start(d, j) + (1 << d)] += sum[d][j];
    }
  bring(l, cell, 7, force, nodes);
}

KERNEL void give(const Points *points, PetscInt first, PetscInt n, Shapes *s, Given *g, Explicit *e)
{
  const PetscReal *v = point_real(points, POINT_V, first), *mass = points->real[POINT_MASS] + first;
  const PetscReal half = explicit_half(e);
  locate(&e->lattice, n, point_real(points, POINT_X, first), s);
  for (PetscInt k = 0; k < n; ++k) g->inertia[k] = mass[k] * (Four){1, v[3 * k], v[3 * k + 1], v[3 * k + 2]};
  for (PetscInt k = 0, end; k < n; k = end) {
    end = run_of(&s->place, k, n);
    if (e->slopes) share_leaning(&e->lattice, s, points, first, -half, k, end, 1, g->inertia, 7, e->sum);
    else share(&e->lattice, s, k, end, g->inertia, 7, e->sum);
    push(&e->lattice, s, k, end, g, e->sum + 4);
  }
}

/* Columns of -V_0 tau over the cell's lengths of four points from k on. */
KERNEL void pulls(const Lattice *l, const Four *volume, const Four tau[6], PetscInt k, Given *g)
{
#pragma GCC unroll 3
  for (int d = 0; d < 3; ++d) {
    const Four scale = -*volume * l->per_length[d];
    Four column[4] = {scale * tau[voigt_of[0][d]], scale * tau[voigt_of[1][d]], scale * tau[voigt_of[2][d]], {0}};
    turn(column);
    for (int i = 0; i < 4; ++i) g->pull[d][k + i] = column[i];
  }
}

void space_gather(const Model *m, Explicit *e)
{
  const Points *points = m->points;
  Shapes s;
  Given g;
  for (PetscInt first = 0; first < points->n; first += LAW_BATCH) {
    const PetscInt n = PetscMin(LAW_BATCH, points->n - first);
    for (PetscInt k = 0; k < n; k += 4) {
      Four tau[6], volume;
      for (int i = 0; i < 6; ++i) pick(point_real(points, POINT_TAU, first + k) + i, 6, n - k, &tau[i]);
      take(points->real[POINT_VOLUME] + first + k, n - k, &volume);
      pulls(&e->lattice, &volume, tau, k, &g);
    }
    give(points, first, n, &s, &g, e);
  }
}

/* One point gains velocity; its momentum, and what damping takes of its energy. */
KERNEL PetscReal speed_up(const Points *points, PetscInt p, const Explicit *e, const Four *gained, const Four *seen,
                          Four *momentum)
{
  PetscReal *v = point_real(points, POINT_V, p), damped = 0;
  const PetscReal mass = points->real[POINT_MASS][p], kept = 1 - e->fade;
  for (int d = 0; d < 3; ++d) {
    const PetscReal gain = (*gained)[d];
    damped += v[d] * (e->fading[0] * v[d] + e->fading[1] * gain) + e->fading[2] * gain * gain;
    v[d] = kept * v[d] + gain;
    if (e->slopes) v[d] += e->unseen * ((*seen)[d] - v[d]);
    if (e->ends) point_real(points, POINT_A, p)[d] = gain * (1 / e->act);
  }
  *momentum = mass * (Four){v[0], v[1], v[2], 0};
  return mass * damped;
}

void space_gain(const Model *m, Explicit *e)
{
  const Points *points = m->points;
  const PetscBool again = m->c->analysis.update == EXPLICIT_MUSL;
  const PetscReal half = explicit_half(e);
  Four motion[8], flow[8] = {{0}}, gained, seen = {0}, momentum[LAW_BATCH];
  PetscReal damped = 0;
  Shapes s;
  for (PetscInt first = 0; first < points->n; first += LAW_BATCH) {
    const PetscInt n = PetscMin(LAW_BATCH, points->n - first);
    locate(&e->lattice, n, point_real(points, POINT_X, first), &s);
    for (PetscInt k = 0, end; k < n; k = end) {
      end = run_of(&s.place, k, n);
      fetch(&e->lattice, s.place.cell[k], 6, e->motion + 3, motion);
      if (e->slopes) fetch(&e->lattice, s.place.cell[k], 6, e->motion, flow);
      for (PetscInt i = k; i < end; ++i) {
        mean(&s, i, motion, &gained);
        if (e->slopes) mean(&s, i, flow, &seen);
        damped += speed_up(points, first + i, e, &gained, &seen, &momentum[i]);
      }
      if (again && e->slopes) share_leaning(&e->lattice, &s, points, first, half, k, end, 0, momentum, 3, e->straining);
      else if (again) share(&e->lattice, &s, k, end, momentum, 3, e->straining);
    }
  }
  e->damped += damped;
}

/* Of a batch: dF - 1 column by column, and by how much points move. */
typedef struct {
  Four column[3][LAW_BATCH], move[LAW_BATCH];
} Strain;

KERNEL void flow_past(const Explicit *e, const Shapes *s, PetscInt k, PetscInt end, Strain *strain)
{
  const Lattice *l = &e->lattice;
  Four motion[8], v[8], rise[3][4];
  fetch(l, s->place.cell[k], 3, e->straining, v);
  if (!e->as_strained) fetch(l, s->place.cell[k], 6, e->motion, motion);
  const Four *way = e->as_strained ? v : motion;
#pragma GCC unroll 3
  for (int d = 0; d < 3; ++d)
#pragma GCC unroll 4
    for (int j = 0; j < 4; ++j)
      rise[d][j] = e->dt * l->per_length[d] * (v[side_start(d, j) + (1 << d)] - v[side_start(d, j)]);
  for (; k < end; ++k) {
#pragma GCC unroll 3
    for (int d = 0; d < 3; ++d)
      strain->column[d][k] = (s->side[d][0][k] * rise[d][0] + s->side[d][1][k] * rise[d][1]) +
                             (s->side[d][2][k] * rise[d][2] + s->side[d][3][k] * rise[d][3]);
    mean(s, k, way, &strain->move[k]);
  }
}

/* The law's dF of four points. */
KERNEL void increments(const Strain *s, PetscInt k, Batch *b)
{
#pragma GCC unroll 3
  for (int j = 0; j < 3; ++j) {
    Four A[4] = {s->column[j][k], s->column[j][k + 1], s->column[j][k + 2], s->column[j][k + 3]};
    turn(A);
    for (int i = 0; i < 3; ++i) FOUR(b->dF[3 * i + j] + k) = i == j ? 1 + A[i] : A[i];
  }
}

/* Four points from p on: F after dF = 1 + A. Eight of its components are turned. */
KERNEL void deform(Points *points, PetscInt p, PetscInt n, const Four A[9])
{
  PetscReal *F = point_real(points, POINT_F, p);
  Four f[9], now[9];
  for (int half = 0; half < 8; half += 4) {
    for (int l = 0; l < 4; ++l) take(F + 9 * l + half, n > l ? 4 : 0, &f[half + l]);
    turn(f + half);
  }
  pick(F + 8, 9, n, &f[8]);
#pragma GCC unroll 3
  for (int i = 0; i < 9; i += 3)
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) now[i + j] = f[i + j] + (A[i] * f[j] + A[i + 1] * f[3 + j] + A[i + 2] * f[6 + j]);
  turn(now);
  turn(now + 4);
  for (int l = 0; l < 4 && l < n; ++l) {
    FOUR(F + 9 * l) = now[l];
    FOUR(F + 9 * l + 4) = now[4 + l];
    F[9 * l + 8] = now[8][l];
  }
}

/* The stress of four points, n of which are the batch's, for that of the batch. */
KERNEL void trade(PetscReal *stress, PetscInt n, const Batch *b, PetscInt k, Four old[6], Four tau[6])
{
  Four low[4], high[4];
  for (int i = 0; i < 6; ++i) tau[i] = FOUR_OF(b->tau[i] + k);
  for (int l = 0; l < 4; ++l) {
    take(stress + 6 * l, n > l ? 4 : 0, &low[l]);
    take(stress + 6 * l + 2, n > l ? 4 : 0, &high[l]);
  }
  turn(low);
  turn(high);
  for (int i = 0; i < 4; ++i) old[i] = low[i];
  old[4] = high[2];
  old[5] = high[3];
  for (int i = 0; i < 4; ++i) low[i] = tau[i];
  for (int i = 0; i < 4; ++i) high[i] = tau[i + 2];
  turn(low);
  turn(high);
  for (int l = 0; l < 4 && l < n; ++l) {
    FOUR(stress + 6 * l) = low[l];
    FOUR(stress + 6 * l + 2) = high[l];
  }
}

/* A and B of the trapezoidal rule's old : A + tau : B, component by component. */
KERNEL void pairs(const Four A[9], int i, Four *sum, Four *rest)
{
  const int r = voigt_row[i], c = voigt_column[i];
  *sum = i < 3 ? A[4 * r] : A[3 * r + c] + A[3 * c + r];
  *rest = *sum - (A[3 * r] * A[c] + A[3 * r + 1] * A[3 + c] + A[3 * r + 2] * A[6 + c]);
  if (i > 2) *rest -= A[3 * c] * A[r] + A[3 * c + 1] * A[3 + r] + A[3 * c + 2] * A[6 + r];
}

/* Stress and its work, as `keep` of points.c has them; F and J. */
KERNEL void keep(Points *points, PetscInt p, PetscInt n, const Lattice *l, const Batch *b, PetscInt k, Given *g)
{
  PetscReal *stress = point_real(points, POINT_TAU, p);
  Four A[9], old[6], tau[6], volume, work, J, density = {0};
  for (int i = 0; i < 9; ++i) A[i] = FOUR_OF(b->dF[i] + k) - (i % 4 == 0);
  deform(points, p, n, A);
  trade(stress, n, b, k, old, tau);
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i) {
    Four sum, rest;
    pairs(A, i, &sum, &rest);
    density += old[i] * sum + tau[i] * rest;
  }
  take(points->real[POINT_VOLUME] + p, n, &volume);
  take(points->real[POINT_WORK] + p, n, &work);
  take(points->real[POINT_J] + p, n, &J);
  work += 0.5 * volume * density;
  J *= (1 + A[0]) * ((1 + A[4]) * (1 + A[8]) - A[5] * A[7]) - A[1] * (A[3] * (1 + A[8]) - A[5] * A[6]) +
       A[2] * (A[3] * A[7] - (1 + A[4]) * A[6]);
  put(&work, n, points->real[POINT_WORK] + p);
  put(&J, n, points->real[POINT_J] + p);
  pulls(l, &volume, tau, k, g);
}

void space_strain(const Model *m, Explicit *e)
{
  Points *points = m->points;
  Strain strain;
  Shapes s;
  Batch b;
  Given g;
  for (PetscInt first = 0, n; first < points->n; first += n) {
    n = batch_points(m, first);
    PetscReal *x = point_real(points, POINT_X, first);
    locate(&e->lattice, n, x, &s);
    for (PetscInt k = 0, end; k < n; k = end) flow_past(e, &s, k, end = run_of(&s.place, k, n), &strain);
    for (PetscInt k = n; k < LAW_BATCH; ++k)
      for (int d = 0; d < 3; ++d) strain.column[d][k] = (Four){0};
    for (PetscInt k = 0; k < LAW_BATCH; k += 4) increments(&strain, k, &b);
    for (PetscInt k = 0; k < n; ++k) {
      const Four move = e->dt * strain.move[k];
      for (int d = 0; d < 3; ++d) x[3 * k + d] += move[d];
    }
    const LawStatus status = batch_stress(m, first, n, &b);
    e->status = PetscMax(e->status, status);
    for (PetscInt k = 0; k < n; k += 4) keep(points, first + k, n - k, &e->lattice, &b, k, &g);
    for (PetscInt k = 0; e->slopes && k < n; ++k) {
      PetscReal A[3][3];
      for (int i = 0; i < 9; ++i) A[i / 3][i % 3] = strain.column[i % 3][k][i / 3];
      slope_follow(3, e, A, point_real(points, POINT_SLOPE, first + k));
    }
    if (!e->ends) give(points, first, n, &s, &g, e);
  }
}
