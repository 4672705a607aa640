#include "method/transfer/lines.h"
#include "method/transfer/loops.h"

/* Products by points before the matrix is summed up: short solves are not worth it. */
#define FEW_PRODUCTS 4

/* Meshes of fem have cells that are full. */
PetscReal mass_lumping(const Discretisation *s, PetscInt g) { return s->lumping ? s->lumping[g] : 0; }
PetscReal mass_tie(const Discretisation *s, PetscInt g) { return s->tie ? s->tie[g] : 0; }

/* out += N m (1 - l) N x of a point; weight += N m l. */
UNROLLED void multiply_point(const PetscInt nn, PetscReal m, PetscReal lumped, const PetscReal *N, const Four *in,
                             PetscReal *weight, Four *out)
{
  Four at = {0, 0, 0, 0};
  for (PetscInt I = 0; I < nn; ++I) at += N[I] * in[I];
  at *= (1 - lumped) * m;
  for (PetscInt I = 0; I < nn; ++I) out[I] += N[I] * at;
  for (PetscInt I = 0; weight && I < nn; ++I) weight[I] += lumped * m * N[I];
}

/* sum += M x over the points of a group, of four numbers of its nodes. */
UNROLLED void multiply_part(const PetscInt part, const PetscInt width, const PetscInt nn, const Discretisation *s,
                            PetscInt g, const PetscReal *x, PetscReal *sum)
{
  const Support *w = s->support;
  const PetscInt *node = w->node + w->node_start[g];
  const PetscReal tie = mass_tie(s, g), lumping = mass_lumping(s, g);
  Four in[CLOUD_MAX_NODES], out[CLOUD_MAX_NODES], mean = {0, 0, 0, 0}, any = {0, 0, 0, 0};
  PetscReal weight[CLOUD_MAX_NODES];
  for (PetscInt I = 0; I < nn; ++I) {
    in[I] = take(part, width, x + node[I] * width);
    any += in[I] * in[I];
    mean -= tie / (PetscReal)nn * in[I];
    weight[I] = tie;
  }
  if (any[0] + any[1] + any[2] + any[3] == 0) return; /* what walls gave too much is lacking near them alone */
  for (PetscInt I = 0; I < nn; ++I) out[I] = mean;
  for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
    multiply_point(nn, s->points->real[POINT_MASS][p], lumping, w->N + w->value_start[g] + (p - w->point_start[g]) * nn,
                   in, lumping > 0 ? weight : NULL, out);
  for (PetscInt I = 0; I < nn; ++I) give(part, width, out[I] + weight[I] * in[I], sum + node[I] * width);
}

/* sum += M x over the points of a run. */
UNROLLED void multiply(const PetscInt dim, const PetscInt fixed_nn, const SupportRun *run, const Discretisation *s,
                       PetscBool alone, const PetscReal *x, PetscReal *sum)
{
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt nn = fixed_nn ? fixed_nn : support_nodes(s->support, g);
    multiply_part(0, 2 * dim, nn, s, g, x, sum);
    if (dim == 3 && !alone) multiply_part(1, 2 * dim, nn, s, g, x, sum);
  }
}

/* sum += the diagonal of M, a number for each node. */
UNROLLED void add_diagonal(const PetscInt dim, const PetscInt fixed_nn, const SupportRun *run, const Discretisation *s,
                           PetscReal *sum)
{
  const Support *w = s->support;
  (void)dim;
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt nn = fixed_nn ? fixed_nn : support_nodes(w, g), *node = w->node + w->node_start[g];
    const PetscReal tie = mass_tie(s, g), lumping = mass_lumping(s, g);
    for (PetscInt I = 0; I < nn; ++I) sum[node[I]] += tie * (1 - 1 / (PetscReal)nn);
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *N = w->N + w->value_start[g] + (p - w->point_start[g]) * nn;
      const PetscReal m = s->points->real[POINT_MASS][p];
      for (PetscInt I = 0; I < nn; ++I) sum[node[I]] += m * N[I] * ((1 - lumping) * N[I] + lumping);
    }
  }
}

void mass_turn(const MassSolve *c, PetscReal *x)
{
  const Frames *frames = &c->s->boundary->frames;
  for (PetscInt k = 0; c->framed && k < frames->n; ++k)
    for (PetscInt f = 0; f < MOTIONS; ++f)
      frame_turn(c->dim, frames->w + 3 * k, x + frames->node[k] * c->width + f * c->dim);
}

/* A matrix that others need, too, is kept. */
static PetscErrorCode SumUp(MassSolve *c)
{
  PetscFunctionBeginUser;
  PetscCall(MassRowsUpdate(c->s, c->kept ? c->kept : &c->rows));
  if (c->kept) c->rows = *c->kept;
  PetscFunctionReturn(0);
}

/* Sweeps that aim along lines take the matrix from the first on. */
static PetscErrorCode Prepare(MassSolve *c)
{
  PetscFunctionBeginUser;
  if (!c->rows && mass_lines_work(c->s)) PetscCall(SumUp(c));
  PetscFunctionReturn(0);
}

/* product = M x, on owners. */
static PetscErrorCode Multiply(MassSolve *c, PetscReal *x)
{
  PetscFunctionBeginUser;
  if (++c->products == FEW_PRODUCTS && !c->rows) PetscCall(SumUp(c));
  mass_turn(c, x);
  if (c->rows) mass_rows_multiply(c, x);
  else {
    mass_clear(c, c->product);
    WITH_SIZES(multiply, c->s, c->s, c->alone, x, c->product);
  }
  mass_turn(c, x);
  PetscCall(GridSumToOwners(c->s->grid, c->width, c->product));
  mass_turn(c, c->product);
  PetscFunctionReturn(0);
}

PetscErrorCode MassSolveCreate(const Discretisation *s, MassSolve *c)
{
  PetscFunctionBeginUser;
  PetscCall(MassSolveAllocate(s, Multiply, c));
  c->prepare = Prepare;
  WITH_SIZES(add_diagonal, s, s, c->product);
  PetscCall(GridSumToOwners(s->grid, 1, c->product));
  for (PetscInt node = 0; node < s->grid->n_owned; ++node) {
    const PetscReal inverse = c->product[node] > 1e-300 ? 1 / c->product[node] : 0;
    for (PetscInt i = node * c->width; inverse > 0 && i < (node + 1) * c->width; ++i) c->inverse[i] = inverse;
  }
  PetscCall(PetscArrayzero(c->product, c->size)); /* products clear it only where points reach */
  PetscCall(MassSolveReach(c));
  PetscFunctionReturn(0);
}

void mass_keep(MassSolve *c, MassRows **kept)
{
  c->kept = kept;
  if (*kept && (*kept)->known) c->rows = *kept;
}

PetscErrorCode MassSubtract(MassSolve *c)
{
  PetscFunctionBeginUser;
  PetscCall(Multiply(c, c->x));
  for (PetscInt k = 0; k < c->n_reached_owned; ++k)
    for (PetscInt i = c->reached[k] * c->width; i < (c->reached[k] + 1) * c->width; ++i) c->lack[i] -= c->product[i];
  PetscFunctionReturn(0);
}

PetscErrorCode MassSolveClose(MassSolve *c)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->n_reached_owned; ++k)
    for (PetscInt i = c->reached[k] * c->width; i < (c->reached[k] + 1) * c->width; ++i)
      if (c->inverse[i] > 0) c->x[i] += c->lack[i] / c->s->nodes->mass[c->reached[k]];
  PetscCall(GridToGhosts(c->s->grid, c->width, c->x));
  PetscFunctionReturn(0);
}

void mass_pack(const MassSolve *c, const PetscReal *v, const PetscReal *a, PetscReal *x)
{
  for (PetscInt i = 0; i < c->size; i += c->width)
    for (PetscInt d = 0; d < c->dim; ++d) {
      x[i + d] = v[i / MOTIONS + d];
      x[i + c->dim + d] = a[i / MOTIONS + d];
    }
}

void mass_unpack(const MassSolve *c, const PetscReal *x, PetscReal *v, PetscReal *a)
{
  for (PetscInt i = 0; i < c->size; i += c->width)
    for (PetscInt d = 0; d < c->dim; ++d) {
      v[i / MOTIONS + d] = x[i + d];
      a[i / MOTIONS + d] = x[i + c->dim + d];
    }
}
