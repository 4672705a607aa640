#include "solve/newton/patches/patch.h"
#include "base/math/lu.h"
#include "solve/newton/line_search.h"

#define MOST_ITERATIONS 10

/* A patch at work; its m unknowns stand node by node. */
typedef struct {
  const StepProblem *p;
  const Patch *patch;
  PetscInt dim, m;
  PetscBool tangent; /* is it wanted with the residual? */
  PetscInt reach;    /* nodes of a group are at most so many numbers apart */
  PetscInt *slot;    /* nn x nn of each group: pairs of the patch, or the one behind all others */
  PetscReal *blocks; /* dim x dim of each pair: n x width_of */
  PetscReal *matrix; /* m x lu_width */
  PetscReal *f, *y;  /* residual, direction */
  PetscReal *from;   /* increments where the direction starts */
  PetscReal *force;  /* n_nodes x dim */
} Work;

/* Unknown i of the patch among those of all nodes. */
static inline PetscInt place_of(const Work *w, PetscInt i) { return w->patch->node[i / w->dim] * w->dim + i % w->dim; }

/* Nodes that can couple with one, and unknowns beside the diagonal. */
static inline PetscInt width_of(const Work *w) { return 2 * w->reach + 1; }
static inline PetscInt band_of(const Work *w) { return (w->reach + 1) * w->dim - 1; }
static inline PetscInt size_of_blocks(const Work *w) { return (w->patch->n * width_of(w) + 1) * w->dim * w->dim; }

static void get_increments(const Work *w, PetscReal *x)
{
  for (PetscInt i = 0; i < w->m; ++i) x[i] = w->p->du[place_of(w, i)];
}

static void zero_forces(const Work *w)
{
  const Support *s = w->p->in.support;
  for (PetscInt k = 0; k < w->patch->n_groups; ++k)
    for (PetscInt i = s->node_start[w->patch->group[k]]; i < s->node_start[w->patch->group[k] + 1]; ++i)
      for (PetscInt d = 0; d < w->dim; ++d) w->force[s->node[i] * w->dim + d] = 0;
}

/* Groups k .. end - 1 of the patch follow each other in the support, too, and have as many nodes. */
static PetscInt run_end(const Work *w, PetscInt k)
{
  const PetscInt *group = w->patch->group, nn = support_nodes(w->p->in.support, group[k]);
  for (++k; k < w->patch->n_groups && group[k] == group[k - 1] + 1; ++k)
    if (support_nodes(w->p->in.support, group[k]) != nn) break;
  return k;
}

/* Forces and blocks of the patch's groups alone: to the formulation they are a support of few. */
static PetscErrorCode AssembleGroups(Work *w, LawStatus *worst)
{
  const Patch *patch = w->patch;
  Support part = *w->p->in.support;
  WeakFormInput in = w->p->in;
  WeakFormOutput out = {.force = w->force, .values = w->tangent ? w->blocks : NULL, .slot = w->slot};

  PetscFunctionBeginUser;
  zero_forces(w);
  if (w->tangent) PetscCall(PetscArrayzero(w->blocks, size_of_blocks(w)));
  in.support = &part;
  in.du = w->p->du;
  part.n_runs = 1;
  *worst = LAW_OK;
  for (PetscInt k = 0, end; k < patch->n_groups; k = end) {
    const PetscInt first = patch->group[k], nn = support_nodes(&part, first);
    end = run_end(w, k);
    part.run[0] = (SupportRun){.nodes = nn, .first = first, .end = first + end - k};
    PetscCall(w->p->formulation->assemble(&in, &out));
    *worst = PetscMax(*worst, out.status);
    out.slot += (end - k) * nn * nn;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode EvaluateAt(void *context, PetscReal lambda, PetscReal *norm, PetscReal *slope)
{
  Work *w = context;
  const StepProblem *p = w->p;
  LawStatus status;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < w->m; ++i) p->du[place_of(w, i)] = w->from[i] - lambda * w->y[i];
  PetscCall(AssembleGroups(w, &status));
  *norm = *slope = 0;
  for (PetscInt i = 0; i < w->m; ++i) {
    const PetscInt at = place_of(w, i);
    w->f[i] = p->fixed[at] ? 0 : w->force[at] - p->external[at];
    *norm += w->f[i] * w->f[i];
    *slope += w->y[i] * w->f[i];
  }
  *norm = status == LAW_OK ? PetscSqrtReal(*norm) : PETSC_INFINITY;
  PetscFunctionReturn(0);
}

/* The blocks of one node -> its rows of the matrix. */
static void fill_rows(Work *w, PetscInt node)
{
  const PetscInt dim = w->dim, band = band_of(w), first = PetscMax(0, node - w->reach);
  const PetscInt end = PetscMin(w->patch->n, node + w->reach + 1);
  const PetscReal *block = w->blocks + (node * width_of(w) + first - node + w->reach) * dim * dim;
  for (PetscInt other = first; other < end; ++other)
    for (PetscInt a = 0; a < dim; ++a)
      for (PetscInt b = 0; b < dim; ++b) w->matrix[lu_at(band, node * dim + a, other * dim + b)] = *block++;
}

/* Nothing but a diagonal where unknown i is prescribed. */
static void cut(Work *w, PetscInt i)
{
  const PetscInt band = band_of(w), end = PetscMin(w->m, i + band + 1);
  for (PetscInt j = PetscMax(0, i - band); j < end; ++j)
    w->matrix[lu_at(band, i, j)] = w->matrix[lu_at(band, j, i)] = i == j;
}

static PetscErrorCode FillMatrix(Work *w)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(w->matrix, w->m * lu_width(band_of(w))));
  for (PetscInt node = 0; node < w->patch->n; ++node) fill_rows(w, node);
  for (PetscInt i = 0; i < w->m; ++i)
    if (w->p->fixed[place_of(w, i)]) cut(w, i);
  PetscFunctionReturn(0);
}

/* y = K^-1 F and y . F; PETSC_FALSE if there is none. */
static PetscBool find_direction(Work *w, PetscReal *slope)
{
  for (PetscInt i = 0; i < w->m; ++i) w->y[i] = w->f[i];
  if (!lu_solve(w->m, band_of(w), w->matrix, w->y)) return PETSC_FALSE;
  *slope = 0;
  for (PetscInt i = 0; i < w->m; ++i) *slope += w->y[i] * w->f[i];
  return PETSC_TRUE;
}

/* best: the increments where |F| is least. */
static PetscErrorCode Iterate(Work *w, PetscReal enough, PetscReal *best)
{
  Line line = {.evaluate = EvaluateAt, .context = w, .enough = w->p->stiff ? ENOUGH_STIFF : ENOUGH};
  PetscReal least, slope, norm;

  PetscFunctionBeginUser;
  get_increments(w, w->from);
  get_increments(w, best);
  PetscCall(PetscArrayzero(w->y, w->m));
  w->tangent = w->p->stiff; /* most other patches need none */
  PetscCall(LineTry(&line, 0));
  if (!w->tangent && line.norm > enough) {
    w->tangent = PETSC_TRUE;
    PetscCall(LineTry(&line, 0));
  }
  least = line.norm;
  for (PetscInt it = 0; it < MOST_ITERATIONS && line.norm > enough && line.norm < PETSC_INFINITY; ++it) {
    PetscCall(FillMatrix(w));
    if (!find_direction(w, &slope)) break;
    norm = line.norm;
    get_increments(w, w->from);
    PetscCall(LineTry(&line, 1));
    PetscCall(LineShorten(&line, slope, norm));
    if (!(line.norm < least)) continue;
    least = line.norm;
    get_increments(w, best);
  }
  for (PetscInt i = 0; i < w->m; ++i) w->p->du[place_of(w, i)] = best[i];
  PetscFunctionReturn(0);
}

/* How far apart numbers of the patch (place) stand in a group. */
static PetscInt reach_of(const Work *w, const PetscInt *place)
{
  const Support *s = w->p->in.support;
  PetscInt reach = 0;
  for (PetscInt k = 0; k < w->patch->n_groups; ++k) {
    PetscInt least = w->patch->n, most = -1;
    for (PetscInt i = s->node_start[w->patch->group[k]]; i < s->node_start[w->patch->group[k] + 1]; ++i) {
      if (place[s->node[i]] < 0) continue;
      least = PetscMin(least, place[s->node[i]]);
      most = PetscMax(most, place[s->node[i]]);
    }
    reach = PetscMax(reach, most - least);
  }
  return reach;
}

static PetscErrorCode FindSlots(Work *w, PetscInt *place)
{
  const Patch *patch = w->patch;
  const Support *s = w->p->in.support;
  PetscInt size = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < patch->n_groups; ++k) size += PetscSqr(support_nodes(s, patch->group[k]));
  PetscCall(PetscMalloc1(size, &w->slot));
  for (PetscInt k = 0; k < patch->n; ++k) place[patch->node[k]] = k;
  w->reach = reach_of(w, place);
  for (PetscInt k = 0, *slot = w->slot; k < patch->n_groups; ++k) {
    const PetscInt nn = support_nodes(s, patch->group[k]), *node = s->node + s->node_start[patch->group[k]];
    for (PetscInt i = 0; i < nn * nn; ++i) {
      const PetscInt row = place[node[i / nn]], column = place[node[i % nn]], width = width_of(w);
      *slot++ = row < 0 || column < 0 ? patch->n * width : row * width + column - row + w->reach;
    }
  }
  for (PetscInt k = 0; k < patch->n; ++k) place[patch->node[k]] = -1;
  PetscFunctionReturn(0);
}

PetscErrorCode PatchSolve(const StepProblem *problem, const Patch *patch, PetscReal enough, PetscInt *place,
                          PetscReal *force)
{
  const PetscInt dim = problem->grid->dim, m = patch->n * dim;
  Work w = {.p = problem, .patch = patch, .dim = dim, .m = m};
  PetscReal *best;

  PetscFunctionBeginUser;
  w.force = force;
  PetscCall(FindSlots(&w, place));
  const PetscInt blocks = size_of_blocks(&w), matrix = m * lu_width(band_of(&w));
  PetscCall(PetscMalloc6(blocks, &w.blocks, matrix, &w.matrix, m, &w.f, m, &w.y, m, &w.from, m, &best));
  PetscCall(Iterate(&w, enough, best));
  PetscCall(PetscFree6(w.blocks, w.matrix, w.f, w.y, w.from, best));
  PetscCall(PetscFree(w.slot));
  PetscFunctionReturn(0);
}
