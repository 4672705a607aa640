/* How fast explicit MPM can be: the dry column of cases/granular-collapse, and nothing else.
 *
 *   explicit_bound [STEP [END [EVERY [REFINE [FLIP [DAMPING [YOUNG]]]]]]]      (1e-4 0.5 20 1 1 1.5 0.84e6)
 *
 * Written to be measured against, not to be used: MUSL, linear functions, Mohr-Coulomb with an exact return and
 * Jaumann's rate, points sorted in every EVERYth step, cells REFINE times as small, share FLIP of the velocity kept by
 * the points, damping in 1/s; no output, no checks, no deformation gradient, no energies. Single precision, double
 * with -DREAL=double. Beyond a critical step (2e-4 s as it stands) it fails without a word. One file, which needs
 * neither talus nor PETSc: cc -O3 -march=native -ffast-math explicit_bound.c -lm. Part of talus, under its licence.
 *
 * A step walks over the points twice: points take the nodes' change of velocity, move, and give their momentum back;
 * then they are strained by the nodes' new velocities where they stood, and give mass, momentum and force from where
 * they stand. In each walk points of a cell that follow each other are summed in registers. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tgmath.h>
#include <time.h>

#ifndef REAL
#define REAL float
#endif
#define KERNEL static inline __attribute__((always_inline))
#define BLOCK 64      /* points that are worked off together */
#define POINTS_CELL 3 /* along each side */

typedef REAL Real;
typedef Real Two __attribute__((vector_size(2 * sizeof(Real)), aligned(sizeof(Real)), may_alias));
typedef Real Four __attribute__((vector_size(4 * sizeof(Real))));

enum { X, Y, VX, VY, SXX, SYY, SZZ, SXY, VOLUME, MASS, FIELDS };
/* sums of the nodes: those of mass, momentum and force, and momentum given back */
enum { M, PX, PY, FX, FY, QX, QY, SUMS };

/* Mohr-Coulomb in principal stresses: moduli, sines, and what the returns to plane, edges and apex need. */
typedef struct {
  Real shear, lame, sine, cohesion, apex; /* cohesion: 2 c cos(phi), Pa */
  Real along[3];                          /* what flow of the plane takes from each principal stress, Pa */
  Real turn;                              /* 1 - sine of dilatancy and 1 + it tell the edges apart */
  Real per_plane, plane, right, left;     /* Pa, and 1/Pa */
  Real per_right, per_left;               /* 1/Pa2 */
} Law;

typedef struct {
  int n, nx, ny, rows, nodes; /* points; cells; rows of nodes in use; nodes with what is read behind the last */
  Real h[2], per[2];          /* m, 1/m */
  Real dt, flip, damping;
  Law law;
  Real *p[FIELDS], *old[2], *spare; /* of the points; old: where they stood */
  int *key, *count;
  Real *sum[SUMS];
  Four *motion, *straining; /* vx vy, and their change; vx vy vx vy */
} Column;

/* Of a block's points: the first node of the cell, the place in it. */
typedef struct {
  int cell[BLOCK];
  Real x[BLOCK], y[BLOCK];
} Place;

static double processor_now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void *room(size_t n, size_t size)
{
  const size_t bytes = (n * size + 127) / 64 * 64;
  void *memory = aligned_alloc(64, bytes);
  if (!memory) exit(1);
  return memset(memory, 0, bytes);
}

static Law law_of(double young)
{
  const double nu = 0.3, degree = acos(-1.0) / 180, friction = 31 * degree, s = sin(friction), d = sin(degree), c = 0;
  const double K = young / (3 * (1 - 2 * nu)), G = young / (2 * (1 + nu));
  const double a = 4 * G * (1 + s * d / 3) + 4 * K * s * d;
  const double right = 2 * G * (1 + s + d - s * d / 3) + 4 * K * s * d;
  const double left = 2 * G * (1 - s - d - s * d / 3) + 4 * K * s * d;
  return (Law){.shear = (Real)G,
               .lame = (Real)(K - 2 * G / 3),
               .sine = (Real)s,
               .cohesion = (Real)(2 * c * cos(friction)),
               .apex = (Real)(c / tan(friction)),
               .along = {(Real)(2 * G * (1 + d / 3) + 2 * K * d), (Real)((4 * G / 3 - 2 * K) * d),
                         (Real)(2 * G * (1 - d / 3) - 2 * K * d)},
               .turn = (Real)d,
               .per_plane = (Real)(1 / a),
               .plane = (Real)a,
               .right = (Real)right,
               .left = (Real)left,
               .per_right = (Real)(1 / (a * a - right * right)),
               .per_left = (Real)(1 / (a * a - left * left))};
}

KERNEL Real larger(Real a, Real b) { return a > b ? a : b; }
KERNEL Real smaller(Real a, Real b) { return a < b ? a : b; }

/* Principal stresses s[0] >= s[1] >= s[2] return to the plane, else to an edge, else to the apex. All ways are gone,
 * for the compiler to put points side by side. */
KERNEL void yield(const Law *law, Real s[3])
{
  const Real s1 = s[0], s2 = s[1], s3 = s[2], k1 = law->along[0], k2 = law->along[1], k3 = law->along[2];
  const Real f = (s1 - s3) + (s1 + s3) * law->sine - law->cohesion;
  const Real g = larger(f, 0) * law->per_plane, m1 = s1 - k1 * g, m2 = s2 + k2 * g, m3 = s3 + k3 * g;
  const int right = (1 - law->turn) * s1 - 2 * s2 + (1 + law->turn) * s3 > 0;
  const Real other = (right ? (s1 - s2) + (s1 + s2) * law->sine : (s2 - s3) + (s2 + s3) * law->sine) - law->cohesion;
  const Real b = right ? law->right : law->left, per = right ? law->per_right : law->per_left;
  const Real ga = per * (law->plane * f - b * other), gb = per * (law->plane * other - b * f);
  const Real e1 = right ? s1 - k1 * (ga + gb) : s1 - k1 * ga + k2 * gb;
  const Real e2 = right ? s2 + k2 * ga + k3 * gb : s2 + k2 * ga - k1 * gb;
  const Real e3 = right ? s3 + k3 * ga + k2 * gb : s3 + k3 * (ga + gb);
  const Real little = (Real)1e-5 * fabs(s3);
  const int plane = (m1 >= m2 - little) & (m2 >= m3 - little) & (m1 + m2 + m3 <= 3 * law->apex);
  const int edge = (e1 >= e2 - little) & (e2 >= e3 - little) & (e1 + e2 + e3 <= 3 * law->apex);
  const Real r1 = plane  ? m1
                  : edge ? e1
                         : law->apex,
             r2 = plane  ? m2
                  : edge ? e2
                         : law->apex,
             r3 = plane  ? m3
                  : edge ? e3
                         : law->apex;
  s[0] = f > 0 ? r1 : s1;
  s[1] = f > 0 ? r2 : s2;
  s[2] = f > 0 ? r3 : s3;
}

/* Stresses of m points; l: velocity gradient times the step, xx xy yx yy. */
static void stress(const Law *law, int m, Real l[4][BLOCK], Real *restrict sxx, Real *restrict syy, Real *restrict szz,
                   Real *restrict sxy, Real *restrict volume)
{
#pragma GCC ivdep
  for (int i = 0; i < m; ++i) {
    const Real spin = (Real)0.5 * (l[1][i] - l[2][i]), trace = l[0][i] + l[3][i];
    const Real x = sxx[i] + law->lame * trace + 2 * law->shear * l[0][i] + 2 * spin * sxy[i];
    const Real y = syy[i] + law->lame * trace + 2 * law->shear * l[3][i] - 2 * spin * sxy[i];
    const Real z = szz[i] + law->lame * trace;
    const Real t = sxy[i] + law->shear * (l[1][i] + l[2][i]) + spin * (syy[i] - sxx[i]);
    const Real middle = (Real)0.5 * (x + y), half = (Real)0.5 * (x - y), radius = sqrt(half * half + t * t);
    const Real p1 = middle + radius, p2 = middle - radius;
    const Real s1 = larger(p1, z), s3 = smaller(p2, z);
    Real s[3] = {s1, p1 + p2 + z - s1 - s3, s3};
    yield(law, s);
    const Real q1 = z > p1 ? s[1] : s[0], q2 = z < p2 ? s[1] : s[2], centre = (Real)0.5 * (q1 + q2);
    const Real share = (Real)0.5 * (q1 - q2) / larger(radius, (Real)1e-12);
    sxx[i] = centre + half * share;
    syy[i] = centre - half * share;
    szz[i] = s[0] + s[1] + s[2] - q1 - q2;
    sxy[i] = t * share;
    volume[i] *= 1 + trace;
  }
}

KERNEL void locate(const Column *c, int m, const Real *x, const Real *y, Place *at)
{
  for (int i = 0; i < m; ++i) {
    const Real a = x[i] * c->per[0], b = y[i] * c->per[1];
    const int column = (int)a, row = (int)b;
    at->cell[i] = row * (c->nx + 1) + column;
    at->x[i] = a - (Real)column;
    at->y[i] = b - (Real)row;
  }
}

/* Functions of the four nodes of a cell, 00 10 01 11, along x and along y: their product is N. */
static const Four sign_x = {-1, 1, -1, 1}, base_x = {1, 0, 1, 0}, sign_y = {-1, -1, 1, 1}, base_y = {1, 1, 0, 0};

/* A cell's four sums go to a field of the nodes. */
KERNEL void put(const Column *c, Real *field, int cell, const Four *a)
{
  Two *low = (Two *)(field + cell), *high = (Two *)(field + cell + c->nx + 1);
  *low += (Two){(*a)[0], (*a)[1]};
  *high += (Two){(*a)[2], (*a)[3]};
}

/* Points b to b + m give mass, momentum and force from where they stand. */
KERNEL void give(Column *c, int b, int m)
{
  Place at;
  Real px[BLOCK], py[BLOCK], xx[BLOCK], xy[BLOCK], yx[BLOCK], yy[BLOCK];
  const Real *mass = c->p[MASS] + b;
  locate(c, m, c->p[X] + b, c->p[Y] + b, &at);
  for (int i = 0; i < m; ++i) {
    const Real vx = -c->p[VOLUME][b + i] * c->per[0], vy = -c->p[VOLUME][b + i] * c->per[1];
    px[i] = mass[i] * c->p[VX][b + i];
    py[i] = mass[i] * c->p[VY][b + i];
    xx[i] = vx * c->p[SXX][b + i];
    xy[i] = vx * c->p[SXY][b + i];
    yx[i] = vy * c->p[SXY][b + i];
    yy[i] = vy * c->p[SYY][b + i];
  }
  for (int i = 0; i < m;) {
    const int cell = at.cell[i];
    Four am = {0}, ax = {0}, ay = {0}, fx = {0}, fy = {0};
    do {
      const Four nx = base_x + at.x[i] * sign_x, ny = base_y + at.y[i] * sign_y;
      const Four N = nx * ny, dx = sign_x * ny, dy = sign_y * nx;
      am += mass[i] * N;
      ax += px[i] * N;
      ay += py[i] * N;
      fx += xx[i] * dx + yx[i] * dy;
      fy += xy[i] * dx + yy[i] * dy;
    } while (++i < m && at.cell[i] == cell);
    put(c, c->sum[M], cell, &am);
    put(c, c->sum[PX], cell, &ax);
    put(c, c->sum[PY], cell, &ay);
    put(c, c->sum[FX], cell, &fx);
    put(c, c->sum[FY], cell, &fy);
  }
}

/* Velocities of the nodes after the step, and how they have changed; the wall holds x, the floor x and y. */
static void nodes_move(Column *c)
{
  const int line = c->nx + 1;
  for (int k = 0; k < c->rows * line; ++k) {
    const Real m = c->sum[M][k], per = m > 0 ? 1 / m : 0, vx = c->sum[PX][k] * per, vy = c->sum[PY][k] * per;
    const Real dx = c->dt * (c->sum[FX][k] * per - c->damping * vx);
    const Real dy = m > 0 ? c->dt * (c->sum[FY][k] * per - (Real)9.81 - c->damping * vy) : 0;
    c->motion[k] = (Four){vx + dx, vy + dy, dx, dy};
  }
  for (int j = 0; j < c->rows; ++j) {
    const Four v = c->motion[j * line];
    c->motion[j * line] = (Four){0, v[1], v[2] - v[0], v[3]};
  }
  for (int i = 0; i < line; ++i) {
    const Four v = c->motion[i];
    c->motion[i] = (Four){0, 0, v[2] - v[0], v[3] - v[1]};
  }
  memset(c->sum[QX], 0, sizeof(Real) * 2 * (size_t)c->nodes);
}

/* Increments of displacement that strain the points. */
static void nodes_strain(Column *c)
{
  const int line = c->nx + 1;
  for (int k = 0; k < c->rows * line; ++k) {
    const Real m = c->sum[M][k], per = m > 0 ? c->dt / m : 0, x = c->sum[QX][k] * per, y = c->sum[QY][k] * per;
    c->straining[k] = (Four){x, y, x, y};
  }
  for (int j = 0; j < c->rows; ++j) {
    const Four v = c->straining[j * line];
    c->straining[j * line] = (Four){0, v[1], 0, v[3]};
  }
  memset(c->straining, 0, sizeof(Four) * (size_t)line);
  memset(c->sum[M], 0, sizeof(Real) * 5 * (size_t)c->nodes);
}

/* What the nodes' motion is to points b to b + m. */
KERNEL void feel(const Column *c, int m, const Place *at, Four *felt)
{
  Real w[4][BLOCK];
  for (int i = 0; i < m; ++i) {
    const Real x = at->x[i], y = at->y[i];
    w[3][i] = x * y;
    w[1][i] = x - x * y;
    w[2][i] = y - x * y;
    w[0][i] = 1 - x - y + x * y;
  }
  for (int i = 0; i < m;) {
    const int cell = at->cell[i];
    const Four *low = c->motion + cell, *high = low + c->nx + 1;
    const Four n0 = low[0], n1 = low[1], n2 = high[0], n3 = high[1];
    do felt[i] = w[0][i] * n0 + w[1][i] * n1 + w[2][i] * n2 + w[3][i] * n3;
    while (++i < m && at->cell[i] == cell);
  }
}

/* Points move, and give the nodes their momentum from where they stood. */
KERNEL void gain(Column *c, int b, int m)
{
  Place at;
  Four felt[BLOCK];
  Real px[BLOCK], py[BLOCK];
  locate(c, m, c->p[X] + b, c->p[Y] + b, &at);
  feel(c, m, &at, felt);
  for (int i = 0; i < m; ++i) {
    const Real *q = (const Real *)&felt[i];
    Real *x = c->p[X] + b, *y = c->p[Y] + b, *vx = c->p[VX] + b, *vy = c->p[VY] + b;
    c->old[0][b + i] = x[i];
    c->old[1][b + i] = y[i];
    x[i] += c->dt * q[0];
    y[i] += c->dt * q[1];
    vx[i] = c->flip * (vx[i] + q[2]) + (1 - c->flip) * q[0];
    vy[i] = c->flip * (vy[i] + q[3]) + (1 - c->flip) * q[1];
    px[i] = c->p[MASS][b + i] * vx[i];
    py[i] = c->p[MASS][b + i] * vy[i];
  }
  for (int i = 0; i < m;) {
    const int cell = at.cell[i];
    Four ax = {0}, ay = {0};
    do {
      const Four N = (base_x + at.x[i] * sign_x) * (base_y + at.y[i] * sign_y);
      ax += px[i] * N;
      ay += py[i] * N;
    } while (++i < m && at.cell[i] == cell);
    put(c, c->sum[QX], cell, &ax);
    put(c, c->sum[QY], cell, &ay);
  }
}

/* Points are strained where they stood. */
KERNEL void strain(Column *c, int b, int m)
{
  Place at;
  Four gradient[BLOCK]; /* xx yx xy yy */
  Real l[4][BLOCK];
  const Four per = {c->per[0], c->per[0], c->per[1], c->per[1]};
  locate(c, m, c->old[0] + b, c->old[1] + b, &at);
  for (int i = 0; i < m;) {
    const int cell = at.cell[i];
    const Four *low = c->straining + cell, *high = low + c->nx + 1;
    const Four n0 = low[0], along_x = low[1] - n0, along_y = high[0] - n0;
    const Four flat = per * __builtin_shufflevector(along_x, along_y, 0, 1, 4, 5);
    const Four twist = per * (high[1] - high[0] - along_x);
    do gradient[i] = flat + twist * (Four){at.y[i], at.y[i], at.x[i], at.x[i]};
    while (++i < m && at.cell[i] == cell);
  }
  for (int i = 0; i < m; ++i) {
    const Real *q = (const Real *)&gradient[i];
    l[0][i] = q[0];
    l[1][i] = q[2];
    l[2][i] = q[1];
    l[3][i] = q[3];
  }
  stress(&c->law, m, l, c->p[SXX] + b, c->p[SYY] + b, c->p[SZZ] + b, c->p[SXY] + b, c->p[VOLUME] + b);
}

/* Points in the order of their cells; nodes above the highest need no work. */
static void sort(Column *c)
{
  const int line = c->nx + 1, cells = line * (c->ny + 1);
  Real top = 0;
  memset(c->count, 0, sizeof(int) * (size_t)(cells + 1));
  for (int p = 0; p < c->n; ++p) {
    c->key[p] = (int)(c->p[Y][p] * c->per[1]) * line + (int)(c->p[X][p] * c->per[0]);
    ++c->count[c->key[p] + 1];
    top = larger(top, c->p[Y][p]);
  }
  for (int k = 0; k < cells; ++k) c->count[k + 1] += c->count[k];
  for (int p = 0; p < c->n; ++p) c->key[p] = c->count[c->key[p]]++;
  for (int k = 0; k < FIELDS; ++k) {
    Real *from = c->p[k], *to = c->spare;
    for (int p = 0; p < c->n; ++p) to[c->key[p]] = from[p];
    c->p[k] = to;
    c->spare = from;
  }
  c->rows = (int)(top * c->per[1]) + 4;
  if (c->rows > c->ny + 1) c->rows = c->ny + 1;
}

#define FOR_BLOCKS(c, b, m) for (int b = 0, m; m = (c)->n - b < BLOCK ? (c)->n - b : BLOCK, b < (c)->n; b += BLOCK)

static void march(Column *c, int steps, int every)
{
  FOR_BLOCKS(c, b, m) give(c, b, m);
  for (int s = 1; s <= steps; ++s) {
    nodes_move(c);
    FOR_BLOCKS(c, b, m) gain(c, b, m);
    nodes_strain(c);
    FOR_BLOCKS(c, b, m)
    {
      strain(c, b, m);
      give(c, b, m);
    }
    if (every && s % every == 0) sort(c);
  }
}

/* Column of 18 x 22 cells in a grid of 90 x 26, nine points at the Gauss points of each. */
static void seed(Column *c, int refine)
{
  const double gauss[POINTS_CELL] = {0.5 - sqrt(0.15), 0.5, 0.5 + sqrt(0.15)};
  const int nx = 18 * refine, ny = 22 * refine, most = nx * ny * POINTS_CELL * POINTS_CELL;
  c->nx = 90 * refine;
  c->ny = 26 * refine;
  c->rows = c->ny + 1;
  c->h[0] = (Real)(0.4525 / c->nx);
  c->h[1] = (Real)(0.1283454545454545 / c->ny);
  for (int d = 0; d < 2; ++d) c->per[d] = 1 / c->h[d];
  for (int k = 0; k < FIELDS; ++k) c->p[k] = room((size_t)most + BLOCK, sizeof(Real));
  for (int d = 0; d < 2; ++d) c->old[d] = room((size_t)most + BLOCK, sizeof(Real));
  c->spare = room((size_t)most + BLOCK, sizeof(Real));
  for (int k = 0; k < nx * ny; ++k)
    for (int g = 0; g < POINTS_CELL * POINTS_CELL; ++g, ++c->n) {
      c->p[X][c->n] = (Real)(k % nx + gauss[g % POINTS_CELL]) * c->h[0];
      c->p[Y][c->n] = (Real)(k / nx + gauss[g / POINTS_CELL]) * c->h[1];
      c->p[VOLUME][c->n] = c->h[0] * c->h[1] / (POINTS_CELL * POINTS_CELL);
      c->p[MASS][c->n] = 2600 * c->p[VOLUME][c->n];
    }
}

static void create(Column *c, int refine)
{
  seed(c, refine);
  c->nodes = ((c->nx + 1) * (c->ny + 1) + c->nx + 64) / 16 * 16;
  c->key = room((size_t)c->n, sizeof(int));
  c->count = room((size_t)c->nodes, sizeof(int));
  Real *all = room((size_t)c->nodes * SUMS, sizeof(Real));
  for (int k = 0; k < SUMS; ++k) c->sum[k] = all + (size_t)k * (size_t)c->nodes;
  c->motion = room((size_t)c->nodes, sizeof(Four));
  c->straining = room((size_t)c->nodes, sizeof(Four));
}

int main(int argc, char **argv)
{
  double argument[] = {1e-4, 0.5, 20, 1, 1, 1.5, 0.84e6};
  Column c = {0};
  for (int k = 1; k < argc && k <= 7; ++k) argument[k - 1] = strtod(argv[k], NULL);
  const int steps = (int)lround(argument[1] / argument[0]);
  create(&c, (int)argument[3]);
  c.dt = (Real)argument[0];
  c.flip = (Real)argument[4];
  c.damping = (Real)argument[5];
  c.law = law_of(argument[6]);
  const double start = processor_now();
  march(&c, steps, (int)argument[2]);
  const double seconds = processor_now() - start;
  Real front = 0;
  for (int p = 0; p < c.n; ++p) front = larger(front, c.p[X][p]);
  printf("%d points, %d steps, %.4f s of a core, front %.4f m: %.1f ns a point and step\n", c.n, steps, seconds,
         (double)front, 1e9 * seconds / c.n / steps);
  return 0;
}
