/* The assembled tangent against differences of the residual, for every kernel of cells and of
 * clouds, at a random state (strains and with them shear stresses at the start of the step) with
 * inertia, lumping and ties; its symmetry. */
#include "patch.h"

static void check_tangent(const Variant *variant, PetscReal inertia, PetscBool stabilised)
{
  Patch p;
  PetscReal *force, *values;
  patch_begin(&p, variant);
  for (PetscInt g = 0; !stabilised && g < p.support->n_groups; ++g) p.lumping[g] = p.soft[g] = p.tie[g] = 0;
  CALL(PetscMalloc2(p.dofs, &force, p.dofs * p.dofs, &values));
  assemble(&p, inertia, p.du, force, values);
  check_slopes(&p, inertia, values);
  assert_true(skew_of(&p, values) <= 1e-13);
  CALL(PetscFree2(force, values));
  patch_end(&p);
}

/* A stress about the axis grows with the volume, and nothing with the strain about the axis:
 * tau_33 += s ln det dF. */
static LawStatus one_sided(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                           PetscReal *state, PetscReal *tau, PetscReal *c)
{
  const PetscReal s = 1e4;
  const LawStatus status = law_find("neo-hookean")->update(parameters, n, dF, old, state, tau, c);
  for (PetscInt k = 0; k < n; ++k) {
    const PetscReal more = s * log(tensor_det(dF + 9 * k));
    tau[6 * k + 2] += more;
    for (int j = 0; c && j < 3; ++j) c[36 * k + 12 + j] += s;
    if (c) c[36 * k + 14] -= 2 * more;
  }
  return status;
}

/* Plane and hoop act on each other in different ways, where the law says so. */
static void test_one_sided_rings(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_VARIANTS; ++k) {
    Patch p;
    PetscReal *force, *values;
    if (!variants[k].ring) continue;
    patch_begin(&p, &variants[k]);
    Law law = *p.material[0].law;
    law.update = one_sided;
    law.update_hoop = NULL;
    p.material[0].law = &law;
    CALL(PetscMalloc2(p.dofs, &force, p.dofs * p.dofs, &values));
    assemble(&p, 40, p.du, force, values);
    check_slopes(&p, 40, values);
    assert_true(skew_of(&p, values) > 1e-3);
    CALL(PetscFree2(force, values));
    patch_end(&p);
  }
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
    assemble(&p, 40, p.du, with, values);
    assemble(&p, 40, p.du, without, NULL);
    for (PetscInt i = 0; i < p.dofs; ++i) assert_true(PetscAbsReal(with[i] - without[i]) <= 1e-12 * norm(p.dofs, with));
    CALL(PetscFree3(with, without, values));
    patch_end(&p);
  }
}

/* A rotation of a strained state turns the forces and leaves the tangent's turned form: K(Q du) = Q
 * K(du) Q^T. */
static void test_rotated(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_VARIANTS; ++k) {
    Patch p;
    PetscReal Q[9] = {0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1}, *straight, *turned, *du;
    if (variants[k].ring) continue; /* whose axis would turn */
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
    assemble(&p, 0, p.du, straight, NULL);
    assemble(&p, 0, du, turned, NULL);
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
    cmocka_unit_test(test_differences), cmocka_unit_test(test_one_sided_rings), cmocka_unit_test(test_residual_alone),
    cmocka_unit_test(test_rotated),     cmocka_unit_test(test_inverted),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
