/* One constraint by hand: its gap, the forces of its multiplier, its part of the tangent, and a
 * sweep that closes gaps of motions. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "solve/forces/nodal_force.h"

#define CALL(call) assert_int_equal((call), 0)
#define ASSERT_NEAR(a, b) assert_true(PetscAbsReal((a) - (b)) <= 1e-14)

enum { NODES = 5, DIM = 2, DOFS = NODES * DIM };

/* At node 1, whose twin is 4: 0.2 u_0 + 0.5 u_1 + 0.3 u_2. */
static const PetscInt cloud[] = {0, 1, 2};
static const PetscReal N[] = {0.2, 0.5, 0.3};

static Constraints *one_constraint(void)
{
  Constraints *c;
  CALL(ConstraintsCreate(DIM, &c));
  CALL(ConstraintsAdd(c, 1, 4, 3, cloud, N));
  c->scale = 10;
  return c;
}

static Grid grid = {.dim = DIM, .n_nodes = NODES};

static NodalScene scene_of(const PetscReal *du, const PetscReal *prescribed, const unsigned char *fixed)
{
  return (NodalScene){.grid = &grid, .du = du, .prescribed = prescribed, .fixed = fixed};
}

/* gap = sum N du - prescribed; the multiplier pulls its nodes by their shares. */
static void test_forces(void **state)
{
  const PetscReal du[DOFS] = {1, 2, 3, 4, 5, 6, 0, 0, 7, 8}, prescribed[DOFS] = {0, 0, 0.5, 0.25};
  const unsigned char fixed[DOFS] = {1, 1}; /* a node, which makes no difference */
  PetscReal force[DOFS] = {0};
  Constraints *c = one_constraint();
  (void)state;
  const NodalScene scene = scene_of(du, prescribed, fixed);
  constraints_assemble(c, &scene, &(NodalOutput){.force = force});
  for (int d = 0; d < DIM; ++d) {
    PetscReal gap = -prescribed[2 + d];
    for (int e = 0; e < 3; ++e) {
      gap += N[e] * du[cloud[e] * DIM + d];
      ASSERT_NEAR(force[cloud[e] * DIM + d], -10 * N[e] * du[4 * DIM + d]);
    }
    ASSERT_NEAR(force[4 * DIM + d], -10 * gap);
    ASSERT_NEAR(force[3 * DIM + d], 0);
  }
  CALL(ConstraintsDestroy(&c));
}

/* A component whose multiplier is prescribed (it does not exist) gives nothing. */
static void test_component_left_out(void **state)
{
  const PetscReal du[DOFS] = {1, 2, 3, 4, 5, 6, 0, 0, 7, 8}, prescribed[DOFS] = {0};
  unsigned char fixed[DOFS] = {0};
  PetscReal force[DOFS] = {0};
  (void)state;
  Constraints *c = one_constraint();
  fixed[9] = 1;
  const NodalScene scene = scene_of(du, prescribed, fixed);
  constraints_assemble(c, &scene, &(NodalOutput){.force = force});
  for (int i = 1; i < DOFS; i += 2) ASSERT_NEAR(force[i], 0);
  assert_true(force[0] != 0 && force[8] != 0);
  CALL(ConstraintsDestroy(&c));
}

/* The tangent is that of the forces: -scale N between nodes and multiplier, both ways. */
static void test_values(void **state)
{
  const PetscReal du[DOFS] = {0}, prescribed[DOFS] = {0};
  const unsigned char fixed[DOFS] = {0};
  PetscReal force[DOFS] = {0}, values[6 * DIM * DIM] = {0};
  (void)state;
  Constraints *c = one_constraint();
  for (int e = 0; e < 3; ++e) c->slot[2 * e] = e, c->slot[2 * e + 1] = 3 + e;
  const NodalScene scene = scene_of(du, prescribed, fixed);
  System system = {.dim = DIM, .block = DIM, .values = values};
  constraints_assemble(c, &scene, &(NodalOutput){.force = force, .system = &system});
  for (int k = 0; k < 6; ++k)
    for (int i = 0; i < DIM; ++i)
      for (int j = 0; j < DIM; ++j) ASSERT_NEAR(values[(k * DIM + i) * DIM + j], i == j ? -10 * N[k % 3] : 0);
  CALL(ConstraintsDestroy(&c));
}

/* A sweep gives a held node what is missing at its place, over the share that held nodes have
 * there. */
static void test_relax(void **state)
{
  const PetscReal target[DOFS] = {0, 0, 0.6, -0.2};
  (void)state;
  for (int all = 0; all < 2; ++all) {
    PetscReal v[DOFS] = {1, 2, 3, 4, 5, 6}, correction[DOFS] = {0};
    unsigned char held[DOFS] = {0};
    Constraints *c = one_constraint();
    held[2] = held[3] = 1;
    if (all) held[0] = held[1] = held[4] = held[5] = 1;
    constraints_relax(c, held, target, v, correction);
    for (int d = 0; d < DIM; ++d) {
      const PetscReal before[] = {1 + d, 3 + d, 5 + d}, share = all ? 1 : N[1];
      const PetscReal gap = target[2 + d] - (N[0] * before[0] + N[1] * before[1] + N[2] * before[2]);
      ASSERT_NEAR(v[2 + d], before[1] + gap / share);
      ASSERT_NEAR(v[d], before[0]);
      ASSERT_NEAR(v[4 + d], before[2]);
      ASSERT_NEAR(correction[2 + d], 0);
    }
    CALL(ConstraintsDestroy(&c));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_forces), cmocka_unit_test(test_component_left_out),
                                     cmocka_unit_test(test_values), cmocka_unit_test(test_relax)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
