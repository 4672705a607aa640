#include "method/transfer/mass.h"
#include "method/transfer/loops.h"

/* Meshes of fem have cells that are full. */
static PetscReal lumping_of(const Discretisation *s, PetscInt g) { return s->lumping ? s->lumping[g] : 0; }
static PetscReal tie_of(const Discretisation *s, PetscInt g) { return s->tie ? s->tie[g] : 0; }

/* out += N m (1 - l) N x of a point; weight += N m l. */
UNROLLED void multiply_point(const PetscInt nn, const PetscInt width, PetscReal m, PetscReal lumped, const PetscReal *N,
                             const PetscReal *in, PetscReal *weight, PetscReal *out)
{
  PetscReal at[6] = {0, 0, 0, 0, 0, 0};
  for (PetscInt I = 0; I < nn; ++I) {
    weight[I] += lumped * m * N[I];
    for (PetscInt k = 0; k < width; ++k) at[k] += N[I] * in[I * width + k];
  }
  for (PetscInt k = 0; k < width; ++k) at[k] *= (1 - lumped) * m;
  for (PetscInt I = 0; I < nn; ++I)
    for (PetscInt k = 0; k < width; ++k) out[I * width + k] += N[I] * at[k];
}

/* sum += M x over the points of a run. */
UNROLLED void multiply(const PetscInt dim, const PetscInt fixed_nn, const SupportRun *run, const Discretisation *s,
                       const PetscReal *x, PetscReal *sum)
{
  const Support *w = s->support;
  const PetscInt width = 2 * dim;
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt nn = fixed_nn ? fixed_nn : support_nodes(w, g), *node = w->node + w->node_start[g];
    const PetscReal tie = tie_of(s, g), lumping = lumping_of(s, g);
    PetscReal in[6 * CLOUD_MAX_NODES], out[6 * CLOUD_MAX_NODES], weight[CLOUD_MAX_NODES];
    PetscReal mean[6] = {0, 0, 0, 0, 0, 0};
    PetscReal any = 0;
    for (PetscInt I = 0; I < nn; ++I) {
      weight[I] = tie;
      for (PetscInt k = 0; k < width; ++k) {
        in[I * width + k] = x[node[I] * width + k];
        mean[k] -= tie / (PetscReal)nn * in[I * width + k];
        any += PetscAbsReal(in[I * width + k]);
      }
    }
    if (any == 0) continue; /* what walls gave too much is lacking near them alone */
    for (PetscInt i = 0; i < nn * width; ++i) out[i] = mean[i % width];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
      multiply_point(nn, width, s->points->real[POINT_MASS][p], lumping,
                     w->N + w->value_start[g] + (p - w->point_start[g]) * nn, in, weight, out);
    for (PetscInt i = 0; i < nn * width; ++i)
      sum[node[i / width] * width + i % width] += out[i] + weight[i / width] * in[i];
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
    const PetscReal tie = tie_of(s, g), lumping = lumping_of(s, g);
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

/* product = M x, on owners. */
static PetscErrorCode Multiply(MassSolve *c, PetscReal *x)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(c->product, c->size));
  mass_turn(c, x);
  WITH_SIZES(multiply, c->s, c->s, x, c->product);
  mass_turn(c, x);
  PetscCall(GridSumToOwners(c->s->grid, c->width, c->product));
  mass_turn(c, c->product);
  PetscFunctionReturn(0);
}

PetscErrorCode MassSolveCreate(const Discretisation *s, MassSolve *c)
{
  PetscFunctionBeginUser;
  PetscCall(MassSolveAllocate(s, Multiply, c));
  WITH_SIZES(add_diagonal, s, s, c->product);
  PetscCall(GridSumToOwners(s->grid, 1, c->product));
  for (PetscInt i = 0; i < s->grid->n_owned * c->width; ++i)
    c->inverse[i] = c->product[i / c->width] > 1e-300 ? 1 / c->product[i / c->width] : 0;
  PetscFunctionReturn(0);
}

PetscErrorCode MassSubtract(MassSolve *c)
{
  PetscFunctionBeginUser;
  PetscCall(Multiply(c, c->x));
  for (PetscInt i = 0; i < c->s->grid->n_owned * c->width; ++i) c->lack[i] -= c->product[i];
  PetscFunctionReturn(0);
}

PetscErrorCode MassSolveClose(MassSolve *c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->s->grid->n_owned * c->width; ++i)
    if (c->inverse[i] > 0) c->x[i] += c->lack[i] / c->s->nodes->mass[i / c->width];
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
