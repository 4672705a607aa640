/* The walks of points.c in the plane with the functions of gimp (support/gimp.c), over boxes with lines at equal
 * distances. Along an axis they are the linear ones of the cell and, where the line next to the point lies in its
 * domain (|s| < l), a second difference about that line,
 *
 *   N = N_linear + q (1, -2, 1),   dN = dN_linear + p (1, -2, 1) / h,   q = (l - |s|)^2 / (4 l),   p = dq / ds
 *
 * with l and the distance s in cells. So points of a cell see four lines along each axis, whose numbers are one
 * register, and sixteen nodes, of which most have nothing: they are fetched once for all points of the cell, and
 * what these give is summed before it is brought there. */
#include "model/explicit/kernels/plane.h"

#define WINDOW 16
/* A line nearer to the domain's end than this part of a cell counts as outside, as in support/gimp.c. */
#define SLIVER 1e-10

/* Of the lines before the cell, of its two, and behind it: the linear functions, and second differences about its
 * first line and by how much those about its second differ. */
static const Four begin = {0, 1, 0, 0}, slope = {0, -1, 1, 0}, bend = {1, -2, 1, 0}, next = {-1, 3, -3, 1};
static const Four steps = {-1, 0, 1, 2};

/* Where points are: their cells and places in them, 0 to 1, and q and p; upper: is the second line the nearer one?
 * ring: what is added to dN along x beside p / h, (l^2 - s^2) / (4 l r); lean, curl: to N, where slopes along y have it
 * as a factor, beside x and q. */
typedef struct {
  int32_t cell[LAW_BATCH];
  PetscReal at[2][LAW_BATCH], q[2][LAW_BATCH], p[2][LAW_BATCH], upper[2][LAW_BATCH], ring[LAW_BATCH];
  PetscReal lean[LAW_BATCH], curl[LAW_BATCH];
} SmoothPlace;

KERNEL void root(Four *x)
{
  for (int k = 0; k < 4; ++k) (*x)[k] = __builtin_sqrt((*x)[k]);
}

/* Lengths of the domains of four points, m: F and its lengths at the start. */
KERNEL void domains(const Points *points, PetscInt p, PetscInt n, Four l[2])
{
  Four F[4], start[2], pair[2];
  for (int i = 0; i < 4; ++i) take(point_real(points, POINT_F, p + PetscMin(i, n - 1)), 4, &F[i]);
  turn(F);
  take(point_real(points, POINT_DOMAIN, p), 2 * n, &pair[0]);
  take(point_real(points, POINT_DOMAIN, p) + 4, 2 * n - 4, &pair[1]);
  part(pair, start);
  for (int d = 0; d < 2; ++d) {
    const Four x = F[2 * d] * start[0], y = F[2 * d + 1] * start[1];
    l[d] = x * x + y * y;
    root(&l[d]);
  }
}

/* q, p and the ring's share of four points at x along axis d. length: of their domains. */
KERNEL void smooth_along(const PetscBool ring, const Lattice *lattice, const int d, const Four *length, const Four *x,
                         PetscInt k, SmoothPlace *place)
{
  const Four t = FOUR_OF(place->at[d] + k), one = (Four){0} + 1, half = 0.5 * one;
  const FourBits far = t >= 0.5;
  const Four up = (Four)(far & (FourBits)one), s = t - up;
  const FourBits right = s >= 0.0;
  const Four off = (Four)((right & (FourBits)s) | (~right & (FourBits)-s));
  Four l = *length * lattice->per_length[d];
  const FourBits less = l < half;
  l = (Four)((less & (FourBits)l) | (~less & (FourBits)half));
  const Four line = (*x - lattice->origin[d]) * lattice->per_length[d] - s; /* its number, but for rounding */
  const FourBits inner = (line > lattice->end[d][0] + 0.5) & (line < lattice->end[d][1] - 0.5);
  const FourBits in = (off <= l - SLIVER) & inner;
  const Four per = half / l, gap = l - off, p = gap * per, q = half * gap * p;
  const Four turned = (Four)((right & (FourBits)-p) | (~right & (FourBits)p));
  FOUR(place->q[d] + k) = (Four)(in & (FourBits)q);
  FOUR(place->p[d] + k) = (Four)(in & (FourBits)turned);
  FOUR(place->upper[d] + k) = up;
  if (ring) {
    const Four more = half * (l * l - off * off) * per / *x;
    FOUR(place->ring + k) = (Four)(in & (FourBits)more);
    const Four scale = lattice->size[d] / *x, square = l * l * (one / 3);
    const Four even = off * (l * l - off * off * (one / 3)) * per, curl = half * (even - square) * scale;
    const Four signed_curl = (Four)((right & (FourBits)curl) | (~right & (FourBits)-curl));
    FOUR(place->lean + k) = square * scale;
    FOUR(place->curl + k) = (Four)(in & (FourBits)signed_curl);
  }
}

/* Where n points from `first` are. */
KERNEL void locate(const PetscBool hoop, const Lattice *l, const Points *points, PetscInt first, PetscInt n,
                   SmoothPlace *place)
{
  const PetscReal *x = point_real(points, POINT_X, first);
  for (PetscInt k = 0; k < n; k += 4) {
    Four pair[2], xy[2], length[2];
    FourCells cell = {0};
    take(x + 2 * k, 2 * (n - k), &pair[0]);
    take(x + 2 * k + 4, 2 * (n - k) - 4, &pair[1]);
    part(pair, xy);
    domains(points, first + k, n - k, length);
    for (int d = 0; d < 2; ++d) {
      locate_along(l, d, &xy[d], &cell, place->at[d] + k);
      smooth_along(hoop && d == 0, l, d, &length[d], &xy[d], k, place);
    }
    memcpy(place->cell + k, &cell, sizeof cell);
  }
}

/* N and dN of point k along axis d at the four lines. */
KERNEL void along(const PetscBool hoop, const Lattice *l, const SmoothPlace *place, PetscInt k, const int d, Four *N,
                  Four *dN)
{
  const Four curve = bend + place->upper[d][k] * next;
  *N = begin + place->at[d][k] * slope + place->q[d][k] * curve;
  if (!dN) return;
  *dN = l->per_length[d] * (slope + place->p[d][k] * curve);
  if (hoop && d == 0) *dN += place->ring[k] * curve;
}

/* N along x as slopes along y have it: of rings the mean by the radius. */
KERNEL Four leaning(const PetscBool hoop, const SmoothPlace *place, PetscInt k, Four N)
{
  return hoop ? N + place->lean[k] * slope + place->curl[k] * (bend + place->upper[0][k] * next) : N;
}

/* Local nodes on the four lines of each axis around a cell, x fastest. Beyond what there is come the last ones: all
 * functions vanish there. */
KERNEL void window(const Lattice *l, int32_t cell, PetscInt node[WINDOW])
{
  const PetscInt j = cell / l->stride[1], i = cell % l->stride[1];
  const PetscBool inside = i > 0 && j > 0 && i < l->most[0] && j < l->most[1];
  for (int b = 0; inside && b < 4; ++b)
    memcpy(node + 4 * b, l->number + cell + (b - 1) * l->stride[1] - 1, 4 * sizeof *node);
  for (int b = 0; !inside && b < 4; ++b) {
    const PetscInt row = PetscMin(PetscMax(j - 1 + b, 0), l->most[1] + 1) * l->stride[1];
    for (int a = 0; a < 4; ++a) node[4 * b + a] = l->number[row + PetscMin(PetscMax(i - 1 + a, 0), l->most[0] + 1)];
  }
}

/* n numbers of each node of the window, row by row, go to the nodes; the sums start anew. */
KERNEL void bring(const int n, const PetscInt *node, Four (*sum)[4], PetscReal *nodes)
{
  for (int b = 0; b < 4; ++b) {
    Four row[4];
    for (int i = 0; i < 4; ++i) row[i] = i < n ? sum[i][b] : (Four){0};
    if (n > 2) turn(row);
    for (int a = 0; a < 4; ++a) {
      PetscReal *to = nodes + node[4 * b + a] * n;
      if (n > 2) FOUR(to) += row[a];
      for (int i = n > 2 ? 4 : 0; i < n; ++i) to[i] += sum[i][b][a];
    }
    for (int i = 0; i < n; ++i) sum[i][b] = (Four){0};
  }
}

/* The cell whose window is known, and what its points have given. */
typedef struct {
  int32_t cell;
  PetscInt node[WINDOW];
  Four sum[5][4];
} Window;

/* Opens the window of another cell. */
KERNEL void pass_on(const int n, const Lattice *l, int32_t cell, Window *w, PetscReal *nodes)
{
  if (cell == w->cell) return;
  if (w->cell >= 0) bring(n, w->node, w->sum, nodes);
  w->cell = cell;
  window(l, cell, w->node);
}

/* What the gradient that point p, the k-th, carries adds to the momentum of the nodes: m N G (x_I - x_p). ahead: see
 * slope_at. */
KERNEL void lean(const Lattice *l, const Points *points, PetscInt p, PetscReal ahead, const SmoothPlace *place,
                 PetscInt k, const Four *mass_x, const Four *y, Four (*momentum)[4])
{
  PetscReal G[4];
  slope_at(2, point_real(points, POINT_SLOPE, p), ahead, G);
  const Four over = l->size[0] * (steps - place->at[0][k]) * *mass_x;
  for (int b = 0; b < 4; ++b) {
    const PetscReal up = l->size[1] * ((PetscReal)(b - 1) - place->at[1][k]);
    momentum[0][b] += (*y)[b] * (G[0] * over + G[1] * up * *mass_x);
    momentum[1][b] += (*y)[b] * (G[2] * over + G[3] * up * *mass_x);
  }
}

/* f_I = - V_0 tau grad N_I, with gradients where the point is now. */
KERNEL void give(const PetscBool hoop, const Points *points, PetscInt first, PetscInt n, const SmoothPlace *place,
                 const Given *g, Window *w, Explicit *e)
{
  const Lattice *l = &e->lattice;
  for (PetscInt k = 0; k < n; ++k) {
    Four x, dx, y, dy;
    pass_on(5, l, place->cell[k], w, e->sum);
    along(hoop, l, place, k, 0, &x, &dx);
    along(hoop, l, place, k, 1, &y, &dy);
    const Four mass = g->mass[k] * x, momentum[2] = {g->momentum[2 * k] * x, g->momentum[2 * k + 1] * x};
    Four over[2] = {g->tau[0][k] * dx, g->tau[3][k] * dx};
    const Four beside = leaning(hoop, place, k, x), up[2] = {g->tau[3][k] * beside, g->tau[1][k] * beside};
    if (hoop) over[0] += g->tau[2][k] / *point_real(points, POINT_X, first + k) * x;
    for (int b = 0; b < 4; ++b) {
      w->sum[0][b] += y[b] * mass;
      for (int d = 0; d < 2; ++d) {
        w->sum[1 + d][b] += y[b] * momentum[d];
        w->sum[3 + d][b] += y[b] * over[d] + dy[b] * up[d];
      }
    }
    if (e->slopes) lean(l, points, first + k, -explicit_half(e), place, k, &mass, &y, w->sum + 1);
  }
}

KERNEL void gather(const PetscBool hoop, const Points *points, Explicit *e)
{
  Window w = {.cell = -1};
  SmoothPlace place;
  Given g;
  for (PetscInt first = 0; first < points->n; first += LAW_BATCH) {
    const PetscInt n = PetscMin(LAW_BATCH, points->n - first);
    locate(hoop, &e->lattice, points, first, n, &place);
    weigh(points, first, n, &g);
    load(points, first, n, &g);
    give(hoop, points, first, n, &place, &g, &w, e);
  }
  if (w.cell >= 0) bring(5, w.node, w.sum, e->sum);
}

void smooth_gather(const Model *m, Explicit *e)
{
  if (m->c->kinematics->hoop) gather(PETSC_TRUE, m->points, e);
  else gather(PETSC_FALSE, m->points, e);
}

/* sum_I N_I f_I over the window. */
KERNEL void felt_at(const Four *x, const Four *y, const Four f[WINDOW], Four *felt)
{
  *felt = (Four){0};
  for (int b = 0; b < 4; ++b)
    *felt +=
      (*y)[b] * (((*x)[0] * f[4 * b] + (*x)[1] * f[4 * b + 1]) + ((*x)[2] * f[4 * b + 2] + (*x)[3] * f[4 * b + 3]));
}

/* Velocity and gain of the nodes where the points of a batch are. */
KERNEL void feel(const Explicit *e, const SmoothPlace *place, PetscInt n, Four *felt)
{
  Four motion[WINDOW] = {{0}}, x, y;
  PetscInt node[WINDOW];
  int32_t cell = -1;
  for (PetscInt k = 0; k < n; ++k) {
    if (place->cell[k] != cell) {
      window(&e->lattice, cell = place->cell[k], node);
      for (int i = 0; i < WINDOW; ++i) motion[i] = FOUR(e->motion + node[i] * 4);
    }
    along(PETSC_FALSE, &e->lattice, place, k, 0, &x, NULL);
    along(PETSC_FALSE, &e->lattice, place, k, 1, &y, NULL);
    felt_at(&x, &y, motion, felt + k);
  }
}

void smooth_gain(const Model *m, Explicit *e)
{
  const Points *points = m->points;
  const PetscBool again = m->c->analysis.update == EXPLICIT_MUSL;
  PetscReal momentum[2 * LAW_BATCH];
  Four damped = {0}, felt[LAW_BATCH] = {{0}}, x, y;
  Window w = {.cell = -1};
  SmoothPlace place;
  for (PetscInt first = 0; first < points->n; first += LAW_BATCH) {
    const PetscInt n = PetscMin(LAW_BATCH, points->n - first);
    locate(PETSC_FALSE, &e->lattice, points, first, n, &place);
    feel(e, &place, n, felt);
    speed_up_all(points, first, n, e, felt, momentum, &damped);
    for (PetscInt k = 0; again && k < n; ++k) {
      pass_on(2, &e->lattice, place.cell[k], &w, e->straining);
      along(PETSC_FALSE, &e->lattice, &place, k, 0, &x, NULL);
      along(PETSC_FALSE, &e->lattice, &place, k, 1, &y, NULL);
      for (int d = 0; d < 2; ++d)
        for (int b = 0; b < 4; ++b) w.sum[d][b] += y[b] * momentum[2 * k + d] * x;
      const Four mass = points->real[POINT_MASS][first + k] * x;
      if (e->slopes) lean(&e->lattice, points, first + k, explicit_half(e), &place, k, &mass, &y, w.sum);
    }
  }
  if (w.cell >= 0) bring(2, w.node, w.sum, e->straining);
  e->damped += (damped[0] + damped[1]) + (damped[2] + damped[3]);
}

/* Of the window: the velocity, twice. */
KERNEL void fetch_flow(const Explicit *e, int32_t cell, Four flow[WINDOW])
{
  PetscInt node[WINDOW];
  window(&e->lattice, cell, node);
  for (int i = 0; i < WINDOW; ++i) {
    const PetscReal *v = e->straining + node[i] * 2;
    flow[i] = (Four){v[0], v[1], v[0], v[1]};
  }
}

KERNEL void flow_past(const PetscBool hoop, const Points *points, PetscInt first, PetscInt n, const Explicit *e,
                      const SmoothPlace *place, Strain *s)
{
  Four flow[WINDOW] = {{0}};
  int32_t cell = -1;
  for (PetscInt k = 0; k < n; ++k) {
    Four x, dx, y, dy, here, over, up;
    if (place->cell[k] != cell) fetch_flow(e, cell = place->cell[k], flow);
    along(hoop, &e->lattice, place, k, 0, &x, &dx);
    along(hoop, &e->lattice, place, k, 1, &y, &dy);
    felt_at(&x, &y, flow, &here);
    felt_at(&dx, &y, flow, &over);
    x = leaning(hoop, place, k, x);
    felt_at(&x, &dy, flow, &up);
    s->A[k] = e->dt * __builtin_shufflevector(over, up, 2, 3, 6, 7);
    s->move[k] = here;
    s->ring[k] = hoop ? e->dt * here[0] / *point_real(points, POINT_X, first + k) : 0;
  }
  rest_of_batch(n, s);
}

KERNEL void strain(const PetscBool hoop, const Model *m, Explicit *e)
{
  Points *points = m->points;
  Window w = {.cell = -1};
  SmoothPlace place;
  Strain s;
  Batch b = {.dF = {{0}}};
  Given g;
  batch_begin(&b);
  for (PetscInt first = 0, n; first < points->n; first += n) {
    n = batch_points(m, first);
    locate(hoop, &e->lattice, points, first, n, &place);
    flow_past(hoop, points, first, n, e, &place, &s);
    strain_batch(hoop, m, e, first, n, &s, &b, &g);
    if (e->ends) continue;
    weigh(points, first, n, &g);
    locate(hoop, &e->lattice, points, first, n, &place);
    give(hoop, points, first, n, &place, &g, &w, e);
  }
  if (w.cell >= 0) bring(5, w.node, w.sum, e->sum);
}

void smooth_strain(const Model *m, Explicit *e)
{
  if (m->c->kinematics->hoop) strain(PETSC_TRUE, m, e);
  else strain(PETSC_FALSE, m, e);
}
