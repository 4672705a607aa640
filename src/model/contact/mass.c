/* The mass matrix of the balance, for impulses of contact (solve/contact/impulse): of many products with it in a step.
 * Where cells have their points together a product goes over the matrices of cells. */
#include "method/transfer/loops.h"
#include "method/transfer/mass.h"
#include "model/model_private.h"

typedef PetscReal Column4 __attribute__((vector_size(4 * sizeof(PetscReal)), aligned(sizeof(PetscReal)), may_alias));
typedef PetscReal Column8 __attribute__((vector_size(8 * sizeof(PetscReal)), aligned(sizeof(PetscReal)), may_alias));

typedef struct {
  MassSolve solve;
  PetscReal *value[SUPPORT_MAX_RUNS]; /* of each run, nodes x nodes a group, by columns; none where points are groups */
  PetscReal *diagonal;
} Matrix;

/* M += sum_p m N ((1 - l) N + l), and what ties the nodes. */
UNROLLED void group_matrix(const PetscInt nn, const Discretisation *s, PetscInt g, PetscReal *M)
{
  const PetscReal tie = s->tie ? s->tie[g] : 0, lumped = s->lumping ? s->lumping[g] : 0;
  for (PetscInt I = 0; I < nn; ++I)
    for (PetscInt J = 0; J < nn; ++J) M[I * nn + J] = tie * ((I == J) - 1 / (PetscReal)nn);
  for (PetscInt p = s->support->point_start[g]; p < s->support->point_start[g + 1]; ++p) {
    const PetscReal *N = support_N(s->support, g, p), m = s->points->real[POINT_MASS][p];
    for (PetscInt I = 0; I < nn; ++I) {
      M[I * nn + I] += m * lumped * N[I];
      for (PetscInt J = 0; J < nn; ++J) M[J * nn + I] += m * (1 - lumped) * N[I] * N[J];
    }
  }
}

/* out = M in, of a cell, M by columns. A column is a vector of the compiler's, which would make sums of what it is
 * left. */
UNROLLED void cell_product(const PetscInt nn, const PetscReal *M, const PetscReal *in, PetscReal *out)
{
  if (nn == 8) {
    Column8 sum = {0};
    for (PetscInt J = 0; J < nn; ++J) sum += *(const Column8 *)(M + J * nn) * in[J];
    *(Column8 *)out = sum;
  } else if (nn == 4) {
    Column4 sum = {0};
    for (PetscInt J = 0; J < nn; ++J) sum += *(const Column4 *)(M + J * nn) * in[J];
    *(Column4 *)out = sum;
  } else
    for (PetscInt I = 0; I < nn; ++I) {
      out[I] = 0;
      for (PetscInt J = 0; J < nn; ++J) out[I] += M[J * nn + I] * in[J];
    }
}

/* product += M x of a run. Impulses act at few nodes, and sweeps carry them on by a layer each: most cells have
 * nothing to do. */
UNROLLED void multiply(const PetscInt dim, const PetscInt nn, const SupportRun *run, const Matrix *matrix,
                       const PetscReal *x, PetscReal *product)
{
  const Support *w = matrix->solve.s->support;
  const PetscReal *M = matrix->value[run - w->run];
  for (PetscInt g = run->first; g < run->end; ++g, M += nn * nn) {
    const PetscInt *node = w->node + w->node_start[g];
    PetscReal in[3][CLOUD_MAX_NODES], out[3][CLOUD_MAX_NODES];
    PetscReal any = 0;
    for (PetscInt I = 0; I < nn; ++I)
      for (PetscInt d = 0; d < dim; ++d) {
        in[d][I] = x[node[I] * dim + d];
        any += PetscAbsReal(in[d][I]);
      }
    if (any == 0) continue;
    for (PetscInt d = 0; d < dim; ++d) cell_product(nn, M, in[d], out[d]);
    for (PetscInt I = 0; I < nn; ++I)
      for (PetscInt d = 0; d < dim; ++d) product[node[I] * dim + d] += out[d][I];
  }
}

static PetscErrorCode MultiplyCells(void *context, const PetscReal *x, PetscReal *product)
{
  const Matrix *matrix = context;
  const Discretisation *s = matrix->solve.s;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(product, s->grid->n_nodes * s->grid->dim));
  WITH_SIZES(multiply, s, matrix, x, product);
  PetscCall(GridSumToOwners(s->grid, s->grid->dim, product));
  PetscFunctionReturn(0);
}

static PetscErrorCode MultiplyPoints(void *context, const PetscReal *x, PetscReal *product)
{
  MassSolve *c = &((Matrix *)context)->solve;
  const PetscInt dim = c->dim;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->s->grid->n_nodes; ++i)
    for (PetscInt d = 0; d < dim; ++d) c->x[mass_at(c, i, VELOCITY, d)] = x[i * dim + d];
  PetscCall(c->multiply(c, c->x));
  for (PetscInt i = 0; i < c->s->grid->n_owned; ++i)
    for (PetscInt d = 0; d < dim; ++d) product[i * dim + d] = c->product[mass_at(c, i, VELOCITY, d)];
  PetscFunctionReturn(0);
}

static PetscErrorCode FillCells(Matrix *matrix)
{
  const Support *w = matrix->solve.s->support;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < w->n_runs; ++k) {
    const SupportRun *run = w->run + k;
    const PetscInt size = run->nodes * run->nodes;
    PetscCall(PetscMalloc1((run->end - run->first) * size, &matrix->value[k]));
    for (PetscInt g = run->first; g < run->end; ++g)
      group_matrix(run->nodes, matrix->solve.s, g, matrix->value[k] + (g - run->first) * size);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ContactMassCreate(const Model *m, ContactMass *mass)
{
  Matrix *matrix;

  PetscFunctionBeginUser;
  *mass = (ContactMass){0};
  /* points keep the energy of mpm, not nodes */
  if (m->method->restores_grid || m->c->analysis.mass == MASS_LUMPED) PetscFunctionReturn(0);
  PetscCall(PetscNew(&matrix));
  MassSolve *c = &matrix->solve;
  PetscCall(MassSolveCreate(m->space, c));
  PetscCall(FillCells(matrix));
  PetscCall(PetscCalloc1(m->grid->n_nodes, &matrix->diagonal));
  for (PetscInt node = 0; node < m->grid->n_owned; ++node)
    matrix->diagonal[node] = c->inverse[node * c->width] > 0 ? 1 / c->inverse[node * c->width] : 0;
  *mass = (ContactMass){.multiply = m->space->support->n_runs ? MultiplyCells : MultiplyPoints,
                        .context = matrix,
                        .diagonal = matrix->diagonal};
  PetscFunctionReturn(0);
}

PetscErrorCode ContactMassDestroy(ContactMass *mass)
{
  Matrix *matrix = mass->context;

  PetscFunctionBeginUser;
  if (!matrix) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < SUPPORT_MAX_RUNS; ++k) PetscCall(PetscFree(matrix->value[k]));
  PetscCall(MassSolveDestroy(&matrix->solve));
  PetscCall(PetscFree(matrix->diagonal));
  PetscCall(PetscFree(mass->context));
  PetscFunctionReturn(0);
}
