/* Kinematics from outside the house: a thick ring. Stretched alike in radius and hoop its stress
 * is uniform and known, every inner node is in balance, and its faces carry that stress times
 * their area; the tangent is that of the forces. */
#include "../formulation/patch.h"

static const Variant kinds[] = {{.cell = CELL_TRIANGLE},
                                {.cell = CELL_QUADRILATERAL},
                                {.cell = CELL_QUADRILATERAL, .cloud = PETSC_TRUE, .kind = CLOUD_LME},
                                {.cell = CELL_QUADRILATERAL, .cloud = PETSC_TRUE, .kind = CLOUD_MLS}};

static const Kinematics *revolution(void)
{
  const Kinematics *kinematics = kinematics_find("revolution");
  assert_non_null(kinematics);
  return kinematics;
}

/* From radius 1 to 2 and 0 to 1 along the axis: straight cells, no strain yet, one material. */
static void ring_begin(Patch *p, const Variant *variant)
{
  patch_begin_in(p, variant, revolution(), 1, 0);
  const PetscReal one[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, none[6] = {0};
  p->material[1] = p->material[0];
  for (PetscInt q = 0; q < p->points->n; ++q) {
    point_set_F(p->points, q, one);
    point_set_tau(p->points, q, none);
    *point_real(p->points, POINT_J, q) = 1;
    law_initial_state(p->material[0].law, point_real(p->points, POINT_STATE, q));
  }
  for (PetscInt g = 0; g < p->support->n_groups; ++g) p->lumping[g] = p->soft[g] = p->tie[g] = 0;
  CALL(PetscArrayzero(p->history, p->dofs));
}

/* Radius times 1.1, length times 0.9: F = diag(1.1, 0.9, 1.1). */
static void test_stretch(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) { /* the rules of cells are exact */
    Patch p;
    PetscReal initial[LAW_MAX_STATE], after[LAW_MAX_STATE], tau[6], *force, virtual[2] = {0, 0}, face = 0, volume = 0;
    const PetscReal dF[9] = {1.1, 0, 0, 0, 0.9, 0, 0, 0, 1.1};
    LawStatus status;
    ring_begin(&p, &kinds[k]);
    CALL(PetscMalloc1(p.dofs, &force));
    for (PetscInt i = 0; i < p.dofs; ++i) p.du[i] = (i % 2 ? -0.1 : 0.1) * p.grid->x[i];
    law_initial_state(p.material[0].law, initial);
    assert_int_equal(p.material[0].law->update(p.material[0].parameters, 1, dF, initial, after, tau, NULL), LAW_OK);
    assert_true(PetscAbsReal(tau[0] - tau[2]) <= 1e-12 * PetscAbsReal(tau[0]) && PetscAbsReal(tau[0]) > 100);
    assemble(&p, 0, p.du, force, NULL);
    for (PetscInt q = 0; q < p.points->n; ++q) volume += *point_real(p.points, POINT_VOLUME, q);
    const PetscReal scale = norm(p.dofs, force);
    for (PetscInt i = 0; i < p.grid->n_nodes; ++i) {
      const PetscReal *x = p.grid->x + 2 * i, *f = force + 2 * i;
      const PetscBool inner = x[0] > 1.1 && x[0] < 1.9 && x[1] > 0.1 && x[1] < 0.9;
      if (inner) assert_true(PetscAbsReal(f[0]) + PetscAbsReal(f[1]) <= 1e-13 * scale);
      if (x[0] > 1.9) face += f[0];
      for (int d = 0; d < 2; ++d) virtual[d] += f[d] * (x[d] + p.du[2 * i + d]);
    }
    assert_true(PetscAbsReal(virtual[0] - volume * (tau[0] + tau[2])) <= 1e-13 * PetscAbsReal(virtual[0]));
    assert_true(PetscAbsReal(virtual[1] - volume * tau[1]) <= 1e-13 * PetscAbsReal(virtual[1]));
    /* of the outer face, now */
    const PetscReal J = 1.1 * 1.1 * 0.9, area = 2 * PETSC_PI * 2 * 1.1 * 0.9;
    assert_true(PetscAbsReal(face - tau[0] / J * area) <= 1e-13 * PetscAbsReal(face));
    WeakFormInput in = input_of(&p, 0, p.du);
    CALL(formulation_displacement.commit(&in, p.points, &status));
    assert_int_equal(status, LAW_OK);
    for (PetscInt q = 0; q < p.points->n; ++q) {
      PetscReal found[6], F[9];
      point_tau(p.points, q, found);
      point_F(p.points, q, F);
      for (int e = 0; e < 6; ++e) assert_true(PetscAbsReal(found[e] - tau[e]) <= 1e-12 * PetscAbsReal(tau[0]));
      for (int e = 0; e < 9; ++e) assert_true(PetscAbsReal(F[e] - dF[e]) <= 1e-13);
      assert_true(PetscAbsReal(*point_real(p.points, POINT_J, q) - J) <= 1e-12);
    }
    CALL(PetscFree(force));
    patch_end(&p);
  }
}

/* At a random state, with inertia and without. */
static void test_differences(void **state)
{
  (void)state;
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k)
    for (int inertia = 0; inertia < 2; ++inertia) {
      Patch p;
      PetscReal *force, *values, *direction, *slope, size = 0;
      patch_begin_in(&p, &kinds[k], revolution(), 0.25, 0.05);
      CALL(PetscMalloc4(p.dofs, &force, p.dofs * p.dofs, &values, p.dofs, &direction, p.dofs, &slope));
      assemble(&p, 40 * inertia, p.du, force, values);
      fill(&p, direction, 1);
      difference(&p, 40 * inertia, direction, 1e-4, slope);
      size = norm(p.dofs, slope);
      for (PetscInt i = 0; i < p.dofs; ++i)
        for (PetscInt j = 0; j < p.dofs; ++j) slope[i] -= entry(&p, values, i, j) * direction[j];
      assert_true(norm(p.dofs, slope) <= 1e-8 * size);
      CALL(PetscFree4(force, values, direction, slope));
      patch_end(&p);
    }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_stretch), cmocka_unit_test(test_differences)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
