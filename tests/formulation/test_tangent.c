/* The assembled tangent against differences of the residual, for every kernel of cells and of clouds, at a random state
 * (strains and with them shear stresses at the start of the step) with inertia, lumping and ties; its symmetry; and
 * what cutting and lifting of prescribed degrees of freedom do. */
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
} Variant;

static const Variant variants[] = {{.cell = CELL_TRIANGLE},
                                   {.cell = CELL_QUADRILATERAL},
                                   {.cell = CELL_TETRAHEDRON},
                                   {.cell = CELL_HEXAHEDRON},
                                   {CELL_QUADRILATERAL, PETSC_TRUE, CLOUD_LME},
                                   {CELL_QUADRILATERAL, PETSC_TRUE, CLOUD_MLS},
                                   {CELL_HEXAHEDRON, PETSC_TRUE, CLOUD_LME},
                                   {CELL_HEXAHEDRON, PETSC_TRUE, CLOUD_MLS}};
#define N_VARIANTS (sizeof variants / sizeof *variants)

/* A grid of two cells a side, all points in it, two materials. */
typedef struct {
  Case c;
  Grid *grid;
  Points *points;
  Support *support;
  Material material[2];
  PetscInt dofs;
  PetscInt *slot;
  PetscReal *lumping, *soft, *tie, *history, *du, *lift;
  unsigned char *fixed;
  Random random;
} Patch;

static NamedValue constants[2][2] = {{{"young", 3e4}, {"poisson", 0.3}}, {{"young", 1e4}, {"poisson", 0.1}}};

static void fill(Patch *p, PetscReal *v, PetscReal size)
{
  for (PetscInt i = 0; i < p->dofs; ++i) v[i] = random_real(&p->random, -size, size);
}

/* Every pair of nodes has its block: slot = row * n_nodes + column. */
static void dense_slots(Patch *p)
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
static void patch_support(Patch *p, const Variant *variant)
{
  const CloudRule rule = {.basis = {.kind = variant->kind, .effective_radius = 1, .gamma = 1.8},
                          .support = variant->kind == CLOUD_MLS ? support_default_mls : support_default_lme,
                          .h = 0.5};
  const BasisInput in_cells = {.grid = p->grid};
  Neighbours nodes;
  CALL(SupportCreate(&p->support));
  CALL(basis_find("cell")->support(&in_cells, p->points, p->support));
  if (!variant->cloud) return;
  CALL(NeighboursCreate(p->grid->dim, p->grid->n_nodes, p->grid->x, 0, NULL, NULL, 0.5, &nodes));
  CALL(SupportFromClouds(p->support, p->points, &nodes, &rule));
  CALL(NeighboursDestroy(&nodes));
  assert_int_equal(p->support->uniform, 0);
  assert_int_equal(p->support->tally.level[SUPPORT_LOOSE] + p->support->tally.level[SUPPORT_EMPTY], 0);
}

static void patch_points(Patch *p, Diag *diag)
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
                         .points_per_cell = per_cell[p->c.grid.cell]};
    body[k].shape = (Shape){.kind = SHAPE_BOX, .min = {k ? 0.5 : 0, 0, 0}, .max = {k ? 1 : 0.5, 1, 1}};
    CALL(MaterialResolve(&p->c, k, diag, &p->material[k]));
    law_initial_state(p->material[k].law, initial[k]);
    n_state = PetscMax(n_state, p->material[k].law->n_state);
    seed[k] = (PointSeed){.density = spec[k].density, .n_state = p->material[k].law->n_state, .initial = initial[k]};
  }
  CALL(PointsCreate(p->grid->dim, n_state, 0, &p->points));
  CALL(PointsSeed(p->points, p->grid, &p->c, seed, diag));
  assert_int_equal(diag_errors(diag), 0);
}

static WeakFormInput input_of(const Patch *p, PetscReal inertia, const PetscReal *du)
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
                         .tie = p->tie,
                         .fixed = p->fixed};
}

static void patch_begin(Patch *p, const Variant *variant)
{
  const CellType cell = variant->cell;
  Diag *diag;
  *p = (Patch){.random = {11}};
  p->c = (Case){.kinematics = cell >= CELL_TETRAHEDRON ? KINEMATICS_3D : KINEMATICS_PLANE_STRAIN, .method = "mpm"};
  p->c.grid = (GridSpec){.kind = GRID_BOX, .cell = cell, .max = {1, 1, 1}, .counts = {2, 2, 2}, .grading = {1, 1, 1}};
  CALL(DiagCreate(&diag));
  CALL(GridCreate(PETSC_COMM_SELF, &p->c, NULL, NULL, diag, &p->grid));
  patch_points(p, diag);
  CALL(DiagDestroy(&diag));
  p->dofs = p->grid->n_nodes * p->grid->dim;
  for (PetscInt i = 0; i < p->dofs; ++i) p->grid->x[i] += random_real(&p->random, -0.05, 0.05);
  patch_support(p, variant);
  dense_slots(p);
  CALL(PetscCalloc6(p->dofs, &p->history, p->dofs, &p->du, p->dofs, &p->lift, p->support->n_groups, &p->lumping,
                    p->support->n_groups, &p->soft, p->support->n_groups, &p->tie));
  CALL(PetscCalloc1(p->dofs, &p->fixed));
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

static void patch_end(Patch *p)
{
  CALL(PetscFree(p->slot));
  CALL(PetscFree6(p->history, p->du, p->lift, p->lumping, p->soft, p->tie));
  CALL(PetscFree(p->fixed));
  CALL(SupportDestroy(&p->support));
  CALL(PointsDestroy(&p->points));
  CALL(GridDestroy(&p->grid));
}

static void assemble(const Patch *p, PetscReal inertia, const PetscReal *du, const PetscReal *lift, PetscReal *force,
                     PetscReal *values)
{
  WeakFormInput in = input_of(p, inertia, du);
  WeakFormOutput out = {.force = force, .values = values, .slot = p->slot};
  in.lift = lift;
  CALL(PetscArrayzero(force, p->dofs));
  if (values) CALL(PetscArrayzero(values, p->dofs * p->dofs));
  CALL(formulation_displacement.assemble(&in, &out));
  assert_int_equal(out.status, LAW_OK);
}

/* Entry of the dense matrix of node blocks. */
static PetscReal entry(const Patch *p, const PetscReal *values, PetscInt i, PetscInt j)
{
  const PetscInt dim = p->grid->dim;
  return values[((i / dim) * p->grid->n_nodes + j / dim) * dim * dim + i % dim * dim + j % dim];
}

static PetscReal norm(PetscInt n, const PetscReal *v)
{
  PetscReal sum = 0;
  for (PetscInt i = 0; i < n; ++i) sum += v[i] * v[i];
  return PetscSqrtReal(sum);
}

/* Fourth-order central difference of the residual along `direction`. */
static void difference(const Patch *p, PetscReal inertia, const PetscReal *direction, PetscReal h, PetscReal *slope)
{
  static const PetscReal step[] = {-2, -1, 1, 2}, weight[] = {1. / 12, -2. / 3, 2. / 3, -1. / 12};
  PetscReal *du, *force;
  CALL(PetscMalloc2(p->dofs, &du, p->dofs, &force));
  CALL(PetscArrayzero(slope, p->dofs));
  for (int k = 0; k < 4; ++k) {
    for (PetscInt i = 0; i < p->dofs; ++i) du[i] = p->du[i] + step[k] * h * direction[i];
    assemble(p, inertia, du, NULL, force, NULL);
    for (PetscInt i = 0; i < p->dofs; ++i) slope[i] += weight[k] * force[i] / h;
  }
  CALL(PetscFree2(du, force));
}

static void check_tangent(const Variant *variant, PetscReal inertia, PetscBool stabilised)
{
  Patch p;
  PetscReal *force, *values, *direction, *slope, *product, skew = 0, largest = 0;
  patch_begin(&p, variant);
  for (PetscInt g = 0; !stabilised && g < p.support->n_groups; ++g) p.lumping[g] = p.soft[g] = p.tie[g] = 0;
  CALL(PetscMalloc5(p.dofs, &force, p.dofs * p.dofs, &values, p.dofs, &direction, p.dofs, &slope, p.dofs, &product));
  assemble(&p, inertia, p.du, NULL, force, values);
  for (int trial = 0; trial < 3; ++trial) {
    fill(&p, direction, 1);
    difference(&p, inertia, direction, 1e-4, slope);
    for (PetscInt i = 0; i < p.dofs; ++i) {
      product[i] = 0;
      for (PetscInt j = 0; j < p.dofs; ++j) product[i] += entry(&p, values, i, j) * direction[j];
      slope[i] -= product[i];
    }
    assert_true(norm(p.dofs, slope) <= 1e-9 * norm(p.dofs, product));
  }
  for (PetscInt i = 0; i < p.dofs; ++i)
    for (PetscInt j = 0; j < p.dofs; ++j) {
      skew = PetscMax(skew, PetscAbsReal(entry(&p, values, i, j) - entry(&p, values, j, i)));
      largest = PetscMax(largest, PetscAbsReal(entry(&p, values, i, j)));
    }
  assert_true(skew <= 1e-13 * largest);
  CALL(PetscFree5(force, values, direction, slope, product));
  patch_end(&p);
}

static void test_differences(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_VARIANTS; ++k) {
    check_tangent(&variants[k], 0, PETSC_FALSE);
    check_tangent(&variants[k], 0, PETSC_TRUE);
    check_tangent(&variants[k], 40, PETSC_FALSE);
    check_tangent(&variants[k], 40, PETSC_TRUE);
  }
}

/* The residual alone is the same as with its tangent. */
static void test_residual_alone(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_VARIANTS; ++k) {
    Patch p;
    PetscReal *with, *without, *values;
    patch_begin(&p, &variants[k]);
    CALL(PetscMalloc3(p.dofs, &with, p.dofs, &without, p.dofs * p.dofs, &values));
    assemble(&p, 40, p.du, NULL, with, values);
    assemble(&p, 40, p.du, NULL, without, NULL);
    for (PetscInt i = 0; i < p.dofs; ++i) assert_true(PetscAbsReal(with[i] - without[i]) <= 1e-12 * norm(p.dofs, with));
    CALL(PetscFree3(with, without, values));
    patch_end(&p);
  }
}

/* Rows and columns of prescribed dofs are empty, the rest is untouched; lifting adds K lift to the free rows; reactions
 * stay. */
static void test_prescribed(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_VARIANTS; ++k) {
    Patch p;
    PetscReal *full, *cut, *force, *lifted;
    patch_begin(&p, &variants[k]);
    CALL(PetscMalloc4(p.dofs * p.dofs, &full, p.dofs * p.dofs, &cut, p.dofs, &force, p.dofs, &lifted));
    assemble(&p, 40, p.du, NULL, force, full);
    for (PetscInt i = 0; i < p.dofs; ++i) {
      p.fixed[i] = random_real(&p.random, 0, 1) < 0.4;
      p.lift[i] = p.fixed[i] ? random_real(&p.random, -0.1, 0.1) : 0;
    }
    assemble(&p, 40, p.du, p.lift, lifted, cut);
    const PetscReal scale = norm(p.dofs * p.dofs, full);
    for (PetscInt i = 0; i < p.dofs; ++i) {
      PetscReal expected = force[i];
      for (PetscInt j = 0; j < p.dofs; ++j) {
        const PetscReal kept = p.fixed[i] || p.fixed[j] ? 0 : entry(&p, full, i, j);
        assert_true(PetscAbsReal(entry(&p, cut, i, j) - kept) <= 1e-14 * scale);
        if (!p.fixed[i]) expected += entry(&p, full, i, j) * p.lift[j];
      }
      assert_true(PetscAbsReal(lifted[i] - expected) <= 1e-13 * scale);
    }
    CALL(PetscFree4(full, cut, force, lifted));
    patch_end(&p);
  }
}

/* A rotation of a strained state turns the forces and leaves the tangent's turned form: K(Q du) = Q K(du) Q^T. */
static void test_rotated(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_VARIANTS; ++k) {
    Patch p;
    PetscReal Q[9] = {0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1}, *straight, *turned, *du;
    patch_begin(&p, &variants[k]);
    const PetscInt dim = p.grid->dim;
    if (dim == 3) random_rotation(&p.random, Q);
    for (PetscInt g = 0; g < p.support->n_groups; ++g)
      p.soft[g] = 0; /* ties to the start of the step, not to the material */
    CALL(PetscArrayzero(p.history, p.dofs));
    CALL(PetscMalloc3(p.dofs, &straight, p.dofs, &turned, p.dofs, &du));
    for (PetscInt i = 0; i < p.dofs; ++i) { /* x + du' = Q (x + du) */
      du[i] = -p.grid->x[i];
      for (PetscInt j = 0, n = i / dim * dim; j < dim; ++j)
        du[i] += Q[3 * (i % dim) + j] * (p.grid->x[n + j] + p.du[n + j]);
    }
    assemble(&p, 0, p.du, NULL, straight, NULL);
    assemble(&p, 0, du, NULL, turned, NULL);
    const PetscReal scale = norm(p.dofs, straight);
    for (PetscInt i = 0; i < p.dofs; ++i) {
      for (PetscInt j = 0; j < dim; ++j) turned[i] -= Q[3 * (i % dim) + j] * straight[i / dim * dim + j];
    }
    assert_true(norm(p.dofs, turned) <= 1e-12 * scale);
    CALL(PetscFree3(straight, turned, du));
    patch_end(&p);
  }
}

/* A point turned inside out is reported, and nothing of the points changes. */
static void test_inverted(void **state)
{
  Patch p;
  PetscReal *force;
  (void)state;
  patch_begin(&p, &variants[1]);
  CALL(PetscMalloc1(p.dofs, &force));
  for (PetscInt i = 0; i < p.dofs; ++i) p.du[i] = i % 2 ? 0 : -2 * p.grid->x[i]; /* mirrored */
  WeakFormInput in = input_of(&p, 0, p.du);
  WeakFormOutput out = {.force = force};
  CALL(PetscArrayzero(force, p.dofs));
  CALL(formulation_displacement.assemble(&in, &out));
  assert_int_equal(out.status, LAW_INVERTED);
  assert_true(out.bad_point >= 0 && out.bad_point < p.points->n);
  CALL(PetscFree(force));
  patch_end(&p);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_differences), cmocka_unit_test(test_residual_alone), cmocka_unit_test(test_prescribed),
    cmocka_unit_test(test_rotated),     cmocka_unit_test(test_inverted),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
