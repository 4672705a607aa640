/* Columns of material against gravity: a line from a position upwards leaves and enters bodies
 * through their outlines. */
#include <stdlib.h>
#include "base/gather.h"
#include "grid/search/box_tree.h"
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
  PetscReal axis[3][3], gap; /* two axes across (one in 2D), and the one upwards */
  const Outline *outline;
  PetscInt n;
  Slab *slab;
  BoxTree *tree; /* of the slabs as they lie across `up` */
  PetscInt n_crossings;
  Crossing *crossing; /* of one line; room for all slabs */
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

static PetscErrorCode MakeTree(Overburden *o)
{
  PetscReal(*bounds)[6];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc(sizeof *bounds * (size_t)o->n, &bounds));
  for (PetscInt k = 0; k < o->n; ++k) box_around(2, o->dim, o->slab[k].across[0], bounds[k]);
  PetscCall(BoxTreeCreate(o->n, bounds, &o->tree));
  PetscCall(PetscMalloc1(o->n, &o->crossing));
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
  o->outline = outline;
  o->n_bodies = n_bodies;
  make_axes(dim, up, o->axis);
  PetscCall(GatherAll(comm, sizeof *all, outline->n, outline->face, &o->n, &all));
  PetscCall(PetscMalloc1(o->n, &o->slab));
  for (PetscInt k = 0; k < o->n; ++k) o->slab[k] = make_slab(o, &all[k]);
  PetscCall(PetscFree(all));
  PetscCall(MakeTree(o));
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
  PetscCall(BoxTreeDestroy(&o->tree));
  PetscCall(PetscFree(o->crossing));
  PetscCall(PetscFree3(o->density, o->depth, o->counts));
  PetscCall(PetscFree(*overburden));
  PetscFunctionReturn(0);
}

/* Twice the area of a, b, at: the same number, but for its sign, whichever way the edge is gone
 * along. */
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

/* A position across `up`, and the height above which crossings count. */
typedef struct {
  Overburden *overburden;
  PetscReal at[3], height;
} Line;

/* A BoxVisit: keep the crossing with this slab, if there is one. */
static PetscBool cross_slab(void *context, PetscInt index)
{
  const Line *line = context;
  Overburden *o = line->overburden;
  const Slab *s = &o->slab[index];
  Crossing *c = &o->crossing[o->n_crossings];
  const PetscBool crosses = o->dim == 2 ? cross_edge(s, line->at, c) : cross_triangle(s, line->at, c);
  if (crosses && c->height > line->height) ++o->n_crossings;
  return PETSC_TRUE;
}

/* All crossings above the height, the lowest first. */
static void cross(Line *line)
{
  Overburden *o = line->overburden;
  o->n_crossings = 0;
  box_tree_holding(o->tree, line->at, cross_slab, line);
  if (o->n_crossings) qsort(o->crossing, (size_t)o->n_crossings, sizeof *o->crossing, compare_crossings);
}

static PetscBool holds(const Line *line, const Shape *shape, PetscReal height)
{
  const Overburden *o = line->overburden;
  PetscReal x[3] = {0, 0, 0};
  for (PetscInt d = 0; d < o->dim; ++d) {
    x[d] = o->axis[2][d] * height;
    for (PetscInt a = 0; a < o->dim - 1; ++a) x[d] += o->axis[a][d] * line->at[a];
  }
  /* a surface along faces of cells is there to the bit */
  return shape_contains(shape, o->dim, x, 1e-10 * o->gap);
}

/* Where the line goes through the surface of the shape between two heights, one inside, one out. */
static PetscReal through(const Line *line, const Shape *shape, PetscReal low, PetscReal high)
{
  const PetscBool inside = holds(line, shape, low);
  for (int k = 0; k < 50; ++k) {
    const PetscReal middle = 0.5 * (low + high);
    if (holds(line, shape, middle) == inside) low = middle;
    else high = middle;
  }
  return 0.5 * (low + high);
}

/* Material of a body from here to there, if it lies on what is below; *reach: how high what
 * counts has come. */
static void pile(Overburden *o, PetscInt b, PetscReal from, PetscReal to, PetscReal below, PetscReal *mass,
                 PetscReal *reach)
{
  if (from <= below + o->gap) o->counts[b] = PETSC_TRUE;
  if (!o->counts[b]) return;
  *mass += o->density[b] * (to - from);
  *reach = PetscMax(*reach, to);
}

/* The same where the cells are filled by a shape, which the line may leave and enter: looked for
 * every quarter of a cell. */
static void pile_shape(const Line *line, PetscInt b, PetscReal from, PetscReal to, PetscReal *mass, PetscReal *reach)
{
  Overburden *o = line->overburden;
  const Shape *shape = o->outline->shape[b];
  const PetscInt n = 1 + (PetscInt)PetscMin(1e6, (to - from) / (0.5 * o->gap));
  PetscReal start = from, last = from;
  PetscBool inside = holds(line, shape, from);
  for (PetscInt k = 1; k <= n; ++k) {
    const PetscReal next = from + (to - from) * (PetscReal)k / (PetscReal)n;
    if (holds(line, shape, next) != inside) {
      const PetscReal at = through(line, shape, last, next);
      if (inside) pile(o, b, start, at, *reach, mass, reach);
      start = at;
      inside = (PetscBool)!inside;
    }
    last = next;
  }
  if (inside) pile(o, b, start, to, *reach, mass, reach);
}

/* The bodies between two crossings; *reach: how high what counts has come so far. */
static void climb(const Line *line, PetscReal from, const Crossing *to, PetscReal *mass, PetscReal *reach)
{
  Overburden *o = line->overburden;
  const PetscReal below = *reach;
  for (PetscInt b = 0; b < o->n_bodies; ++b) {
    if (o->depth[b] <= 0 || to->height <= from) continue;
    if (o->outline->shape && o->outline->shape[b]) pile_shape(line, b, from, to->height, mass, reach);
    else pile(o, b, from, to->height, below, mass, reach);
  }
}

static Line line_from(Overburden *o, const PetscReal *x)
{
  Line line = {.overburden = o, .height = dot(o->dim, o->axis[2], x)};
  for (PetscInt a = 0; a < o->dim - 1; ++a) line.at[a] = dot(o->dim, o->axis[a], x);
  return line;
}

PetscBool overburden_holds(Overburden *o, PetscInt body, const PetscReal *x)
{
  Line line = line_from(o, x);
  PetscInt left = 0;
  cross(&line);
  for (PetscInt k = 0; k < o->n_crossings; ++k)
    if (o->crossing[k].slab->body == body) left += o->crossing[k].leaves;
  return (PetscBool)(left > 0);
}

PetscErrorCode OverburdenAt(Overburden *o, PetscInt body, const PetscReal *x, PetscReal *mass, PetscReal *top)
{
  Line line = line_from(o, x);
  const PetscReal height = line.height;

  PetscFunctionBeginUser;
  cross(&line);
  for (PetscInt b = 0; b < o->n_bodies; ++b) o->depth[b] = 0, o->counts[b] = b == body;
  for (PetscInt k = 0; k < o->n_crossings; ++k) o->depth[o->crossing[k].slab->body] += o->crossing[k].leaves;
  *mass = 0;
  *top = height;
  for (PetscInt k = 0; k < o->n_crossings; ++k) {
    climb(&line, k ? o->crossing[k - 1].height : height, &o->crossing[k], mass, top);
    o->depth[o->crossing[k].slab->body] -= o->crossing[k].leaves;
  }
  PetscFunctionReturn(0);
}
