/* Systems made of random matrices of cells, the same on any number of ranks, for tests of linear
 * solvers. */
#pragma once
#include "../model/case_builder.h"
#include "solve/system/system.h"

/* A system over some cells of a grid; its values depend on the cells and not on the ranks that own
 * them. */
typedef struct {
  Bench b;
  Grid *grid;
  System *system;
  Support cells;
  unsigned char *fixed;
  PetscBool symmetric;
  PetscReal shift, coupling; /* on the diagonal of every cell's matrix, and between nodes */
} Made;

static inline void make_grid(Made *s, CellType type)
{
  Diag *diag;
  bench_init(&s->b, "mpm", type, type >= CELL_TETRAHEDRON ? 5 : 11);
  CALL(DiagCreate(&diag));
  CALL(GridCreate(PETSC_COMM_WORLD, &s->b.c, NULL, NULL, diag, &s->grid));
  CHECK(s->grid, "no grid");
  CALL(DiagDestroy(&diag));
}

/* Unknowns on the cells whose first node lies left of `width`: a small width leaves ranks without
 * any. */
static inline void make_pattern(Made *s, PetscReal width)
{
  const Grid *grid = s->grid;
  const PetscInt nn = grid->nodes_per_cell;
  CALL(PetscMalloc2(grid->n_cells + 1, &s->cells.node_start, grid->n_cells * nn, &s->cells.node));
  /* here: the cell's number over all ranks */
  CALL(PetscMalloc1(grid->n_cells, &s->cells.point_start));
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    const PetscInt *node = grid->cell_node + c * nn;
    if (grid->x[node[0] * grid->dim] >= width) continue;
    s->cells.node_start[s->cells.n_groups] = s->cells.n_groups * nn;
    s->cells.point_start[s->cells.n_groups] = grid->global_cell[c];
    CALL(PetscArraycpy(s->cells.node + s->cells.n_groups * nn, node, nn));
    ++s->cells.n_groups;
  }
  s->cells.node_start[s->cells.n_groups] = s->cells.n_groups * nn;
  s->cells.n_runs = 1;
  s->cells.run[0] = (SupportRun){.nodes = nn, .end = s->cells.n_groups};
  CALL(SystemCreate(PETSC_COMM_WORLD, grid->dim, grid->dim, &s->system));
  CALL(SystemBuild(s->system, grid,
                   &(NodeGroups){.n = s->cells.n_groups, .start = s->cells.node_start, .node = s->cells.node}));
  CALL(SystemSlots(s->system, &s->cells, NULL));
}

/* Prescribed: x on the floor, and all of one node. */
static inline void make_fixed(Made *s)
{
  const PetscInt dim = s->grid->dim;
  CALL(PetscCalloc1(s->grid->n_nodes * dim, &s->fixed));
  for (PetscInt i = 0; i < s->grid->n_nodes; ++i) {
    const PetscReal *x = s->grid->x + i * dim;
    if (x[1] == 0) s->fixed[i * dim] = 1;
    if (x[0] == 0 && x[1] == 1)
      for (PetscInt d = 0; d < dim; ++d) s->fixed[i * dim + d] = 1;
  }
}

/* G G^T + mass, for a random G of a cell; unsymmetric: one more random matrix. */
static inline void add_cell(Made *s, PetscInt g)
{
  const PetscInt dim = s->grid->dim, nn = s->grid->nodes_per_cell, n = nn * dim;
  const PetscInt *slot = s->system->slot + g * nn * nn;
  PetscReal G[24 * 4], more[24 * 24];
  Random random = {(uint64_t)s->cells.point_start[g] + 11};
  for (PetscInt i = 0; i < 4 * n; ++i) G[i] = random_real(&random, -1, 1);
  for (PetscInt i = 0; i < n * n; ++i) more[i] = s->symmetric ? 0 : random_real(&random, -0.2, 0.2);
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j) {
      const PetscInt I = i / dim, J = j / dim, a = i % dim, b = j % dim;
      PetscReal value = more[i * n + j] + (i == j ? s->shift : I != J ? s->coupling : 0);
      for (int k = 0; k < 4; ++k) value += G[4 * i + k] * G[4 * j + k];
      s->system->values[(slot[I * nn + J] * dim + a) * dim + b] += 1e7 * value;
    }
}

static inline void make(Made *s, CellType type, PetscBool symmetric, PetscReal width, PetscReal shift,
                        PetscReal coupling)
{
  *s = (Made){.symmetric = symmetric, .shift = shift, .coupling = coupling};
  make_grid(s, type);
  make_pattern(s, width);
  make_fixed(s);
  CALL(SystemZero(s->system));
  for (PetscInt g = 0; g < s->cells.n_groups; ++g) add_cell(s, g);
  CALL(SystemPrescribe(s->system, s->fixed, NULL));
}

static inline void drop(Made *s)
{
  CALL(SystemDestroy(&s->system));
  CALL(GridDestroy(&s->grid));
  CALL(PetscFree2(s->cells.node_start, s->cells.node));
  CALL(PetscFree(s->cells.point_start));
  CALL(PetscFree(s->fixed));
}

/* Zero on prescribed dofs. */
static inline Vec random_vector(const Made *s, PetscReal size)
{
  const PetscInt dim = s->grid->dim;
  PetscReal *v;
  Vec x;
  CALL(SystemCreateVec(s->system, &x));
  CALL(VecGetArrayWrite(x, &v));
  for (PetscInt k = 0; k < s->system->n_active; ++k) {
    const PetscInt i = s->system->active[k];
    Random random = {(uint64_t)s->grid->global_node[i] + 5};
    for (PetscInt d = 0; d < dim; ++d) v[k * dim + d] = s->fixed[i * dim + d] ? 0 : size * random_real(&random, -1, 1);
  }
  CALL(VecRestoreArrayWrite(x, &v));
  return x;
}

static inline PetscReal norm(Vec x)
{
  PetscReal value;
  CALL(VecNorm(x, NORM_2, &value));
  return value;
}
