#include "model/measure/energy/mass_product.h"
#include "base/math/rows.h"
#include "model/model_private.h"

/* Sizes are constants at the calls below that matter, so that the inner loops unroll. */
#define UNROLLED static inline __attribute__((always_inline))

/* The part of u M w that ties the nodes of one cell together: their deviations from the mean. */
UNROLLED PetscReal tied_product(const PetscInt dim, const PetscInt nn, const PetscReal *u, const PetscReal *w)
{
  PetscReal sum = 0;
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal u_mean = 0;
    for (PetscInt I = 0; I < nn; ++I) u_mean += u[I * dim + d] / (PetscReal)nn;
    for (PetscInt I = 0; I < nn; ++I) sum += (u[I * dim + d] - u_mean) * w[I * dim + d];
  }
  return sum;
}

UNROLLED PetscReal product_sized(const PetscInt dim, const PetscInt nn, const SupportRun *run, const Model *m,
                                 const NodalField *u, const NodalField *w)
{
  const Support *support = m->space->support;
  PetscReal sum = 0;
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt *node = support->node + support->node_start[g];
    const PetscReal lumped = m->space->lumping ? m->space->lumping[g] : 0;
    PetscReal at_node[CELL_MAX_NODES], un[3 * CELL_MAX_NODES], wn[3 * CELL_MAX_NODES];
    for (PetscInt I = 0; I < nn; ++I) {
      at_node[I] = 0;
      for (PetscInt d = 0, k = I * dim, i = node[I] * dim; d < dim; ++d, ++k, ++i) {
        un[k] = u->factor[0] * u->x[0][i] + u->factor[1] * u->x[1][i];
        wn[k] = w->factor[0] * w->x[0][i] + w->factor[1] * w->x[1][i];
        at_node[I] += un[k] * wn[k];
      }
    }
    if (m->space->tie && m->space->tie[g] > 0) sum += m->space->tie[g] * tied_product(dim, nn, un, wn);
    for (PetscInt p = support->point_start[g]; p < support->point_start[g + 1]; ++p) {
      const PetscReal *N = support->N + support->value_start[g] + (p - support->point_start[g]) * nn;
      PetscReal uh[3] = {0, 0, 0}, wh[3] = {0, 0, 0}, nodes = 0;
      for (PetscInt I = 0; lumped > 0 && I < nn; ++I) nodes += N[I] * at_node[I];
      for (PetscInt I = 0; I < nn; ++I)
        for (PetscInt d = 0; d < dim; ++d) {
          uh[d] += N[I] * un[I * dim + d];
          wh[d] += N[I] * wn[I * dim + d];
        }
      sum += m->points->real[POINT_MASS][p] *
             ((1 - lumped) * (uh[0] * wh[0] + uh[1] * wh[1] + uh[2] * wh[2]) + lumped * nodes);
    }
  }
  return sum;
}

static inline Row4 row_of(const int dim, const NodalField *u, PetscInt i)
{
  return u->factor[0] * node_row(dim, u->x[0] + i) + u->factor[1] * node_row(dim, u->x[1] + i);
}

/* Of points with nodes of their own: a node is a register. */
UNROLLED PetscReal product_of_points(const int dim, const Model *m, const NodalField *u, const NodalField *w)
{
  const Support *support = m->space->support;
  PetscReal sum = 0;
  for (PetscInt p = 0; p < support->n_groups; ++p) {
    const PetscInt nn = support_nodes(support, p), *node = support->node + support->node_start[p];
    const PetscReal *N = support->N + support->value_start[p];
    const PetscReal tie = m->space->tie ? m->space->tie[p] : 0, lumped = m->space->lumping ? m->space->lumping[p] : 0;
    Row4 uh = {0, 0, 0, 0}, wh = uh, nodes = uh, u_sum = uh, w_sum = uh, all = uh;
    for (PetscInt I = 0; I < nn; ++I) {
      const Row4 un = row_of(dim, u, node[I] * dim), wn = row_of(dim, w, node[I] * dim);
      uh += N[I] * un;
      wh += N[I] * wn;
      if (lumped > 0) nodes += N[I] * un * wn;
      if (tie > 0) u_sum += un, w_sum += wn, all += un * wn;
    }
    sum += m->points->real[POINT_MASS][p] * ((1 - lumped) * row_sum(uh * wh) + lumped * row_sum(nodes));
    if (tie > 0) sum += tie * row_sum(all - u_sum * w_sum / (PetscReal)nn);
  }
  return sum;
}

PetscReal mass_product(const Model *m, NodalField u, NodalField w)
{
  const Support *support = m->space->support;
  PetscReal sum = 0;
  if (!support->n_runs && m->dim == 2) return product_of_points(2, m, &u, &w);
  if (!support->n_runs) return product_of_points(3, m, &u, &w);
  for (const SupportRun *run = support->run; run < support->run + support->n_runs; ++run) {
    if (m->dim == 2 && run->nodes == 3) sum += product_sized(2, 3, run, m, &u, &w);
    else if (m->dim == 2 && run->nodes == 4) sum += product_sized(2, 4, run, m, &u, &w);
    else if (m->dim == 3 && run->nodes == 8) sum += product_sized(3, 8, run, m, &u, &w);
    else sum += product_sized(m->dim, run->nodes, run, m, &u, &w);
  }
  return sum;
}
