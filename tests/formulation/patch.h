/* A grid of two cells a side, full of points of two materials in a random state, and its
 * residual and tangent as dense arrays. */
#pragma once
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "../conformance/random.h"
#include "formulation/formulation.h"
#include "support/basis.h"
#include "support/cloud.h"

#define CALL(call) assert_int_equal((call), 0)

/* Whose nodes a point sees: those of its cell, or a cloud of its own. */
typedef struct {
  CellType cell;
  PetscBool cloud;
  CloudKind kind;
  PetscBool ring; /* x is a radius, from 0.25 on */
} Variant;

static const Variant variants[] = {{.cell = CELL_TRIANGLE},
                                   {.cell = CELL_QUADRILATERAL},
                                   {.cell = CELL_TETRAHEDRON},
                                   {.cell = CELL_HEXAHEDRON},
                                   {.cell = CELL_QUADRILATERAL, .cloud = PETSC_TRUE, .kind = CLOUD_LME},
                                   {.cell = CELL_QUADRILATERAL, .cloud = PETSC_TRUE, .kind = CLOUD_MLS},
                                   {.cell = CELL_HEXAHEDRON, .cloud = PETSC_TRUE, .kind = CLOUD_LME},
                                   {.cell = CELL_HEXAHEDRON, .cloud = PETSC_TRUE, .kind = CLOUD_MLS},
                                   {.cell = CELL_TRIANGLE, .ring = PETSC_TRUE},
                                   {.cell = CELL_QUADRILATERAL, .ring = PETSC_TRUE},
                                   {CELL_QUADRILATERAL, PETSC_TRUE, CLOUD_LME, PETSC_TRUE}};
static const Kinematics rings = {.name = "rings", .dim = 2, .hoop = PETSC_TRUE};
#define N_VARIANTS (sizeof variants / sizeof *variants)

/* A grid of two cells a side, all points in it, two materials. */
typedef struct {
  Case c;
  Grid *grid;
  Points *points;
  Support *support;
  Material material[2];
  const Formulation *formulation;
  PetscInt dofs;
  PetscInt *slot;
  PetscReal *lumping, *soft, *tie, *history, *du;
  Random random;
} Patch;

static NamedValue constants[2][2] = {{{"young", 3e4}, {"poisson", 0.3}}, {{"young", 1e4}, {"poisson", 0.1}}};

static inline void fill(Patch *p, PetscReal *v, PetscReal size)
{
  for (PetscInt i = 0; i < p->dofs; ++i) v[i] = random_real(&p->random, -size, size);
}

/* Every pair of nodes has its block: slot = row * n_nodes + column. */
static inline void dense_slots(Patch *p)
{
  const Support *s = p->support;
  PetscInt entries = 0;
  for (PetscInt g = 0; g < s->n_groups; ++g) entries += PetscSqr(support_nodes(s, g));
  CALL(PetscMalloc1(entries, &p->slot));
  for (PetscInt g = 0, e = 0; g < s->n_groups; ++g)
    for (PetscInt I = 0, nn = support_nodes(s, g); I < nn; ++I)
      for (PetscInt J = 0; J < nn; ++J, ++e)
        p->slot[e] = s->node[s->node_start[g] + I] * p->grid->n_nodes + s->node[s->node_start[g] + J];
}

/* Clouds of different sizes, whose nodes stand in no cell together. */
static inline void patch_support(Patch *p, const Variant *variant)
{
  const CloudRule rule = {.basis = {.kind = variant->kind, .effective_radius = 1, .gamma = 1.8},
                          .support = variant->kind == CLOUD_MLS ? support_default_mls : support_default_lme,
                          .h = 0.5};
  Neighbours nodes;
  CALL(SupportCreate(&p->support));
  const BasisInput in_cells = {.grid = p->grid};
  CALL(basis_find("cell")->support(&in_cells, p->points, p->support));
  if (!variant->cloud) return;
  CALL(NeighboursCreate(p->grid->dim, p->grid->n_nodes, p->grid->x, 0, NULL, NULL, 0.5, &nodes));
  CALL(SupportFromClouds(p->support, p->points, &nodes, &rule));
  CALL(NeighboursDestroy(&nodes));
  assert_int_equal(p->support->n_runs, 0);
  assert_int_equal(p->support->tally.level[SUPPORT_LOOSE] + p->support->tally.level[SUPPORT_EMPTY], 0);
}

static inline void patch_points(Patch *p, Diag *diag)
{
  static const char *const law[] = {"neo-hookean", "neo-hookean-split"};
  static const PetscInt per_cell[] = {3, 4, 4, 8};
  static MaterialSpec spec[2];
  static BodySpec body[2];
  PetscReal initial[2][LAW_MAX_STATE];
  PointSeed seed[2];
  PetscInt n_state = 0;
  p->c.n_materials = p->c.n_bodies = 2;
  p->c.materials = spec;
  p->c.bodies = body;
  for (PetscInt k = 0; k < 2; ++k) {
    spec[k] = (MaterialSpec){.name = k ? "b" : "a",
                             .law = (char *)law[k],
                             .density = k ? 700 : 1000,
                             .n_parameters = 2,
                             .parameters = constants[k]};
    body[k] = (BodySpec){.name = spec[k].name,
                         .material = spec[k].name,
                         .has_shape = PETSC_TRUE,
                         .weights = WEIGHTS_GAUSS,
                         .points_per_cell = per_cell[p->c.grid.cell]};
    body[k].shape = (Shape){.kind = SHAPE_BOX,
                            .min = {p->c.grid.min[0] + (k ? 0.5 : 0), 0, 0},
                            .max = {p->c.grid.min[0] + (k ? 1 : 0.5), 1, 1}};
    CALL(MaterialResolve(&p->c, k, diag, &p->material[k]));
    law_initial_state(p->material[k].law, initial[k]);
    n_state = PetscMax(n_state, p->material[k].law->n_state);
    seed[k] = (PointSeed){.density = spec[k].density, .n_state = p->material[k].law->n_state, .initial = initial[k]};
  }
  CALL(PointsCreate(p->grid->dim, n_state, 0, &p->points));
  CALL(PointsSeed(p->points, p->grid, &p->c, seed, PETSC_TRUE, diag));
  assert_int_equal(diag_errors(diag), 0);
}

static inline WeakFormInput input_of(const Patch *p, PetscReal inertia, const PetscReal *du)
{
  return (WeakFormInput){.kinematics = p->c.kinematics,
                         .points = p->points,
                         .support = p->support,
                         .materials = p->material,
                         .du = du,
                         .history = p->history,
                         .inertia = inertia,
                         .lumping = p->lumping,
                         .soft = p->soft,
                         .tie = p->tie};
}

/* In these kinematics, this far from x = 0, with nodes up to `shake` out of place. */
static inline void patch_begin_in(Patch *p, const Variant *variant, const Kinematics *kinematics, PetscReal from,
                                  PetscReal shake)
{
  const CellType cell = variant->cell;
  Diag *diag;
  *p = (Patch){.random = {11}, .formulation = &formulation_displacement};
  p->c = (Case){.kinematics = kinematics, .method = "mpm"};
  p->c.grid = (GridSpec){
    .kind = GRID_BOX, .cell = cell, .min = {from}, .max = {from + 1, 1, 1}, .counts = {2, 2, 2}, .grading = {1, 1, 1}};
  CALL(DiagCreate(&diag));
  CALL(GridCreate(PETSC_COMM_SELF, &p->c, NULL, NULL, diag, &p->grid));
  patch_points(p, diag);
  CALL(DiagDestroy(&diag));
  p->dofs = p->grid->n_nodes * p->grid->dim;
  for (PetscInt i = 0; i < p->dofs; ++i) p->grid->x[i] += random_real(&p->random, -shake, shake);
  patch_support(p, variant);
  dense_slots(p);
  CALL(PetscCalloc5(p->dofs, &p->history, p->dofs, &p->du, p->support->n_groups, &p->lumping, p->support->n_groups,
                    &p->soft, p->support->n_groups, &p->tie));
  for (PetscInt g = 0; g < p->support->n_groups; ++g) {
    p->lumping[g] = random_real(&p->random, 0, 1);
    p->soft[g] = random_real(&p->random, 0, 1e3);
    p->tie[g] = random_real(&p->random, 0, 1e2);
  }
  fill(p, p->history, 10);
  fill(p, p->du, 0.08);
  WeakFormInput in = input_of(p, 0, p->du); /* a first step gives every point a strain of its own */
  LawStatus status;
  CALL(formulation_displacement.commit(&in, p->points, &status));
  assert_int_equal(status, LAW_OK);
  fill(p, p->du, 0.05);
}

static inline void patch_begin(Patch *p, const Variant *variant)
{
  const Kinematics *straight = variant->cell >= CELL_TETRAHEDRON ? &kinematics_3d : &kinematics_plane_strain;
  patch_begin_in(p, variant, variant->ring ? &rings : straight, variant->ring ? 0.25 : 0, 0.05);
}

static inline void patch_end(Patch *p)
{
  CALL(PetscFree(p->slot));
  CALL(PetscFree5(p->history, p->du, p->lumping, p->soft, p->tie));
  CALL(SupportDestroy(&p->support));
  CALL(PointsDestroy(&p->points));
  CALL(GridDestroy(&p->grid));
}

static inline void assemble(const Patch *p, PetscReal inertia, const PetscReal *du, PetscReal *force, PetscReal *values)
{
  WeakFormInput in = input_of(p, inertia, du);
  WeakFormOutput out = {.force = force, .values = values, .slot = p->slot};
  CALL(PetscArrayzero(force, p->dofs));
  if (values) CALL(PetscArrayzero(values, p->dofs * p->dofs));
  CALL(p->formulation->assemble(&in, &out));
  assert_int_equal(out.status, LAW_OK);
}

/* Entry of the dense matrix of node blocks. */
static inline PetscReal entry(const Patch *p, const PetscReal *values, PetscInt i, PetscInt j)
{
  const PetscInt dim = p->grid->dim;
  return values[((i / dim) * p->grid->n_nodes + j / dim) * dim * dim + i % dim * dim + j % dim];
}

static inline PetscReal norm(PetscInt n, const PetscReal *v)
{
  PetscReal sum = 0;
  for (PetscInt i = 0; i < n; ++i) sum += v[i] * v[i];
  return PetscSqrtReal(sum);
}

/* Fourth-order central difference of the residual along `direction`. */
static inline void difference(const Patch *p, PetscReal inertia, const PetscReal *direction, PetscReal h,
                              PetscReal *slope)
{
  static const PetscReal step[] = {-2, -1, 1, 2}, weight[] = {1. / 12, -2. / 3, 2. / 3, -1. / 12};
  PetscReal *du, *force;
  CALL(PetscMalloc2(p->dofs, &du, p->dofs, &force));
  CALL(PetscArrayzero(slope, p->dofs));
  for (int k = 0; k < 4; ++k) {
    for (PetscInt i = 0; i < p->dofs; ++i) du[i] = p->du[i] + step[k] * h * direction[i];
    assemble(p, inertia, du, force, NULL);
    for (PetscInt i = 0; i < p->dofs; ++i) slope[i] += weight[k] * force[i] / h;
  }
  CALL(PetscFree2(du, force));
}

/* K times a direction is what forces do along it. */
static inline void check_slopes(Patch *p, PetscReal inertia, const PetscReal *values)
{
  PetscReal *direction, *slope, *product;
  CALL(PetscMalloc3(p->dofs, &direction, p->dofs, &slope, p->dofs, &product));
  for (int trial = 0; trial < 3; ++trial) {
    fill(p, direction, 1);
    difference(p, inertia, direction, 1e-4, slope);
    for (PetscInt i = 0; i < p->dofs; ++i) {
      product[i] = 0;
      for (PetscInt j = 0; j < p->dofs; ++j) product[i] += entry(p, values, i, j) * direction[j];
      slope[i] -= product[i];
    }
    assert_true(norm(p->dofs, slope) <= 1e-9 * norm(p->dofs, product));
  }
  CALL(PetscFree3(direction, slope, product));
}

/* The largest difference across the diagonal, beside the largest entry. */
static inline PetscReal skew_of(const Patch *p, const PetscReal *values)
{
  PetscReal skew = 0, largest = 0;
  for (PetscInt i = 0; i < p->dofs; ++i)
    for (PetscInt j = 0; j < p->dofs; ++j) {
      skew = PetscMax(skew, PetscAbsReal(entry(p, values, i, j) - entry(p, values, j, i)));
      largest = PetscMax(largest, PetscAbsReal(entry(p, values, i, j)));
    }
  return skew / largest;
}
