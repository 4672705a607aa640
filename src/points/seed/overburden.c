/* Columns of material against gravity: a line from a position upwards leaves and enters bodies through their outlines. */
#include <stdlib.h>
#include "points/seed/outline.h"

/* A face as the lines along `up` see it. */
typedef struct {
  PetscReal across[3][2], height[3]; /* corners */
  PetscReal density;
  PetscInt body;
} Slab;

typedef struct {
  PetscReal height;
  const Slab *slab;
  PetscInt leaves; /* 1: upwards the line leaves the body here; -1: it enters it */
} Crossing;

struct Overburden {
  PetscInt dim, n_bodies;
  PetscReal axis[3][3], gap;  /* two axes across (one in 2D), and the one upwards */
  PetscInt n, *start, *which; /* of bins: slabs whose bounds touch bin k are which[start[k] .. start[k + 1]) */
  Slab *slab;
  PetscInt bins[2];
  PetscReal min[2], size[2];
  PetscInt capacity;
  Crossing *crossing; /* of one line */
  PetscReal *density; /* per body, as the next two */
  PetscInt *depth;    /* inside how many of its parts? */
  PetscBool *counts;  /* does it lie on what is below? */
};

static PetscReal dot(PetscInt dim, const PetscReal *a, const PetscReal *b)
{
  PetscReal sum = 0;
  for (PetscInt d = 0; d < dim; ++d) sum += a[d] * b[d];
  return sum;
}

/* Right-handed axes with `up` as the last; in 2D the one across is the first. */
static void make_axes(PetscInt dim, const PetscReal up[3], PetscReal axis[3][3])
{
  PetscInt least = 0;
  PetscReal norm, *e = axis[0], *f = axis[1];
  for (int d = 0; d < 3; ++d) axis[2][d] = up[d];
  if (dim == 2) {
    e[0] = up[1], e[1] = -up[0], e[2] = 0;
    return;
  }
  for (int d = 1; d < 3; ++d)
    if (PetscAbsReal(up[d]) < PetscAbsReal(up[least])) least = d;
  for (int d = 0; d < 3; ++d) e[d] = (d == least) - up[least] * up[d];
  norm = PetscSqrtReal(dot(3, e, e));
  for (int d = 0; d < 3; ++d) e[d] /= norm;
  for (int d = 0; d < 3; ++d) f[d] = up[(d + 1) % 3] * e[(d + 2) % 3] - up[(d + 2) % 3] * e[(d + 1) % 3];
}

static Slab make_slab(const Overburden *o, const OutlineFace *face)
{
  Slab s = {.density = face->density, .body = face->body};
  for (PetscInt i = 0; i < o->dim; ++i) {
    for (PetscInt a = 0; a < o->dim - 1; ++a) s.across[i][a] = dot(o->dim, o->axis[a], face->x + i * o->dim);
    s.height[i] = dot(o->dim, o->axis[2], face->x + i * o->dim);
  }
  return s;
}

static void slab_bounds(const Overburden *o, const Slab *s, PetscReal min[2], PetscReal max[2])
{
  for (PetscInt a = 0; a < 2; ++a) {
    min[a] = max[a] = s->across[0][a];
    for (PetscInt i = 1; i < o->dim; ++i) {
      min[a] = PetscMin(min[a], s->across[i][a]);
      max[a] = PetscMax(max[a], s->across[i][a]);
    }
  }
}

static PetscInt bin_of(const Overburden *o, PetscInt a, PetscReal at)
{
  const PetscReal bin = o->size[a] > 0 ? (at - o->min[a]) / o->size[a] : 0;
  return bin < 1 ? 0 : bin >= (PetscReal)o->bins[a] ? o->bins[a] - 1 : (PetscInt)bin;
}

/* About as many bins as slabs. */
static void choose_bins(Overburden *o)
{
  PetscReal max[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL}, low[2], high[2];
  o->min[0] = o->min[1] = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < o->n; ++k) {
    slab_bounds(o, &o->slab[k], low, high);
    for (PetscInt a = 0; a < 2; ++a) {
      o->min[a] = PetscMin(o->min[a], low[a]);
      max[a] = PetscMax(max[a], high[a]);
    }
  }
  const PetscReal n = (PetscReal)PetscMax(o->n, 1);
  for (PetscInt a = 0; a < 2; ++a) {
    o->bins[a] = a < o->dim - 1 ? 1 + (PetscInt)(o->dim == 3 ? PetscSqrtReal(n) : n) : 1;
    o->size[a] = (max[a] - o->min[a]) / (PetscReal)o->bins[a];
  }
}

/* pass 0 counts behind o->start, pass 1 fills o->which. */
static void put_in_bins(Overburden *o, int pass)
{
  PetscReal low[2], high[2];
  for (PetscInt k = 0; k < o->n; ++k) {
    slab_bounds(o, &o->slab[k], low, high);
    for (PetscInt j = bin_of(o, 1, low[1]); j <= bin_of(o, 1, high[1]); ++j)
      for (PetscInt i = bin_of(o, 0, low[0]); i <= bin_of(o, 0, high[0]); ++i) {
        PetscInt *at = &o->start[i + j * o->bins[0]];
        if (pass) o->which[--*at] = k;
        else ++*at;
      }
  }
}

static PetscErrorCode MakeBins(Overburden *o)
{
  PetscFunctionBeginUser;
  choose_bins(o);
  const PetscInt n = o->bins[0] * o->bins[1];
  PetscCall(PetscCalloc1(n + 1, &o->start));
  put_in_bins(o, 0);
  for (PetscInt k = 1; k <= n; ++k) o->start[k] += o->start[k - 1]; /* ends, until slabs are put before them */
  PetscCall(PetscMalloc1(o->start[n], &o->which));
  put_in_bins(o, 1);
  PetscFunctionReturn(0);
}

/* Faces of all ranks, in the order of ranks. */
static PetscErrorCode Gather(MPI_Comm comm, const Outline *outline, PetscInt *n, OutlineFace **all)
{
  PetscMPIInt size, mine, *count, *start;
  MPI_Datatype type;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMPIIntCast(outline->n, &mine));
  PetscCall(PetscMalloc2(size, &count, size + 1, &start));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, count, 1, MPI_INT, comm));
  start[0] = 0;
  for (PetscMPIInt r = 0; r < size; ++r) start[r + 1] = start[r] + count[r];
  *n = start[size];
  PetscCall(PetscMalloc1(*n, all));
  PetscCallMPI(MPI_Type_contiguous((int)sizeof(OutlineFace), MPI_BYTE, &type));
  PetscCallMPI(MPI_Type_commit(&type));
  PetscCallMPI(MPI_Allgatherv(outline->face, mine, type, *all, count, start, type, comm));
  PetscCallMPI(MPI_Type_free(&type));
  PetscCall(PetscFree2(count, start));
  PetscFunctionReturn(0);
}

PetscErrorCode OverburdenCreate(MPI_Comm comm, PetscInt dim, const PetscReal up[3], PetscReal gap, PetscInt n_bodies,
                                const Outline *outline, Overburden **overburden)
{
  OutlineFace *all;
  Overburden *o;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&o));
  o->dim = dim;
  o->gap = gap;
  o->n_bodies = n_bodies;
  make_axes(dim, up, o->axis);
  PetscCall(Gather(comm, outline, &o->n, &all));
  PetscCall(PetscMalloc1(o->n, &o->slab));
  for (PetscInt k = 0; k < o->n; ++k) o->slab[k] = make_slab(o, &all[k]);
  PetscCall(PetscFree(all));
  PetscCall(MakeBins(o));
  PetscCall(PetscCalloc3(n_bodies, &o->density, n_bodies, &o->depth, n_bodies, &o->counts));
  for (PetscInt k = 0; k < o->n; ++k) o->density[o->slab[k].body] = o->slab[k].density;
  *overburden = o;
  PetscFunctionReturn(0);
}

PetscErrorCode OverburdenDestroy(Overburden **overburden)
{
  Overburden *o = *overburden;

  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(0);
  PetscCall(PetscFree(o->slab));
  PetscCall(PetscFree(o->start));
  PetscCall(PetscFree(o->which));
  PetscCall(PetscFree(o->crossing));
  PetscCall(PetscFree3(o->density, o->depth, o->counts));
  PetscCall(PetscFree(*overburden));
  PetscFunctionReturn(0);
}

/* Twice the area of a, b, at: the same number, but for its sign, whichever way the edge is gone along. */
static PetscReal side_of(const PetscReal *a, const PetscReal *b, const PetscReal *at)
{
  const PetscBool swap = a[0] > b[0] || (a[0] == b[0] && a[1] > b[1]);
  const PetscReal *p = swap ? b : a, *q = swap ? a : b;
  const PetscReal area = (q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0]);
  return area != 0 ? (swap ? -area : area) : swap ? -0. : 0.;
}

/* Where a line meets an edge; on a corner it meets one of the two edges there. */
static PetscBool cross_edge(const Slab *s, const PetscReal *at, Crossing *c)
{
  const PetscReal a = s->across[0][0], b = s->across[1][0];
  if ((a <= at[0]) == (b <= at[0])) return PETSC_FALSE;
  const PetscReal t = (at[0] - a) / (b - a);
  *c = (Crossing){.height = (1 - t) * s->height[0] + t * s->height[1], .slab = s, .leaves = b < a ? 1 : -1};
  return PETSC_TRUE;
}

/* The same for a triangle; a line through an edge meets one of its two triangles. */
static PetscBool cross_triangle(const Slab *s, const PetscReal *at, Crossing *c)
{
  PetscReal area[3], sum = 0, height = 0;
  PetscInt right = 0;
  for (int i = 0; i < 3; ++i) {
    area[i] = side_of(s->across[i], s->across[(i + 1) % 3], at);
    right += signbit(area[i]) ? 1 : 0;
    sum += area[i];
    height += area[i] * s->height[(i + 2) % 3];
  }
  if ((right != 0 && right != 3) || sum == 0) return PETSC_FALSE;
  *c = (Crossing){.height = height / sum, .slab = s, .leaves = right ? -1 : 1};
  return PETSC_TRUE;
}

static int compare_crossings(const void *a, const void *b)
{
  const Crossing *p = a, *q = b;
  if (p->height != q->height) return p->height < q->height ? -1 : 1;
  return p->slab < q->slab ? -1 : p->slab > q->slab;
}

/* All crossings above the height, the lowest first. */
static PetscErrorCode Cross(Overburden *o, const PetscReal *at, PetscReal height, PetscInt *n)
{
  PetscFunctionBeginUser;
  *n = 0;
  const PetscInt bin = bin_of(o, 0, at[0]) + o->bins[0] * bin_of(o, 1, at[1]);
  const PetscInt most = o->start[bin + 1] - o->start[bin];
  if (most > o->capacity) {
    o->capacity = most;
    PetscCall(PetscRealloc((size_t)most * sizeof *o->crossing, &o->crossing));
  }
  for (PetscInt k = o->start[bin]; k < o->start[bin + 1]; ++k) {
    const Slab *s = &o->slab[o->which[k]];
    Crossing *c = &o->crossing[*n];
    if ((o->dim == 2 ? cross_edge(s, at, c) : cross_triangle(s, at, c)) && c->height > height) ++*n;
  }
  if (*n) qsort(o->crossing, (size_t)*n, sizeof *o->crossing, compare_crossings);
  PetscFunctionReturn(0);
}

/* The bodies between two crossings; *reach: how high what counts has come so far. */
static void climb(Overburden *o, PetscReal from, const Crossing *to, PetscReal *mass, PetscReal *reach)
{
  const PetscReal below = *reach;
  for (PetscInt b = 0; b < o->n_bodies; ++b) {
    if (o->depth[b] <= 0 || to->height <= from) continue;
    if (from <= below + o->gap) o->counts[b] = PETSC_TRUE;
    if (!o->counts[b]) continue;
    *mass += o->density[b] * (to->height - from);
    *reach = to->height;
  }
}

PetscErrorCode OverburdenAt(Overburden *o, PetscInt body, const PetscReal *x, PetscReal *mass, PetscReal *top)
{
  PetscReal at[2] = {0, 0}, height = dot(o->dim, o->axis[2], x);
  PetscInt n;

  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < o->dim - 1; ++a) at[a] = dot(o->dim, o->axis[a], x);
  PetscCall(Cross(o, at, height, &n));
  for (PetscInt b = 0; b < o->n_bodies; ++b) o->depth[b] = 0, o->counts[b] = b == body;
  for (PetscInt k = 0; k < n; ++k) o->depth[o->crossing[k].slab->body] += o->crossing[k].leaves;
  *mass = 0;
  *top = height;
  for (PetscInt k = 0; k < n; ++k) {
    climb(o, k ? o->crossing[k - 1].height : height, &o->crossing[k], mass, top);
    o->depth[o->crossing[k].slab->body] -= o->crossing[k].leaves;
  }
  PetscFunctionReturn(0);
}
