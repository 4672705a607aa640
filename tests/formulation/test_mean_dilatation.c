/* Points of a cell that share its change of volume: forces are the slope of an energy written down
 * here, the tangent is the slope of forces, cells with one gradient are those of displacements
 * alone, and neither batches nor steps change what comes out. */
#include "patch.h"

static const Variant shared[] = {{.cell = CELL_TRIANGLE},
                                 {.cell = CELL_QUADRILATERAL},
                                 {.cell = CELL_TETRAHEDRON},
                                 {.cell = CELL_HEXAHEDRON},
                                 {.cell = CELL_TRIANGLE, .ring = PETSC_TRUE},
                                 {.cell = CELL_QUADRILATERAL, .ring = PETSC_TRUE}};
#define N_SHARED (sizeof shared / sizeof *shared)

static void shared_begin(Patch *p, const Variant *variant)
{
  patch_begin(p, variant);
  p->formulation = &formulation_mean_dilatation;
}

static void without_ties(Patch *p)
{
  for (PetscInt g = 0; g < p->support->n_groups; ++g) p->lumping[g] = p->soft[g] = p->tie[g] = 0;
  CALL(PetscArrayzero(p->history, p->dofs));
}

/* --- forces against an energy --- */

/* The gradient of point q of group g in plain loops. */
static void own_gradient(const Patch *p, PetscInt g, PetscInt q, const PetscReal *du, PetscReal f[9])
{
  const Support *s = p->support;
  const PetscInt dim = p->grid->dim, *node = s->node + s->node_start[g];
  const PetscReal *N = support_N(s, g, q), *dN = support_dN(s, g, q, dim);
  for (int i = 0; i < 9; ++i) f[i] = i % 4 == 0;
  for (PetscInt I = 0; I < support_nodes(s, g); ++I)
    for (PetscInt a = 0; a < dim; ++a) {
      for (PetscInt b = 0; b < dim; ++b) f[3 * a + b] += du[node[I] * dim + a] * dN[I * dim + b];
      if (p->c.kinematics->hoop && !a) f[8] += du[node[I] * dim] * N[I] / *point_real(p->points, POINT_X, q);
    }
}

/* Psi = lambda (ln J)^2 / 2 - mu ln J + mu (tr b - 3) / 2 of neo-Hookean rubber, b = f b_n f^T, J^2 =
 * det b. */
static PetscReal rubber_energy(const PetscReal *constant, const PetscReal f[9], const PetscReal *b_n)
{
  const PetscReal E = constant[0], nu = constant[1], mu = E / (2 * (1 + nu)),
                  lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  PetscReal b[6];
  sym_push_forward(f, b_n, b);
  const PetscReal log_j = 0.5 * log(sym_det(b));
  return 0.5 * lambda * log_j * log_j - mu * log_j + 0.5 * mu * (b[0] + b[1] + b[2] - 3);
}

static PetscReal shared_energy(const Patch *p, const PetscReal *du)
{
  const Support *s = p->support;
  const int d = p->grid->dim == 2 && !p->c.kinematics->hoop ? 2 : 3;
  PetscReal energy = 0, f[9];
  for (PetscInt g = 0; g < s->n_groups; ++g) {
    PetscReal before = 0, after = 0;
    for (PetscInt q = s->point_start[g]; q < s->point_start[g + 1]; ++q) {
      const PetscReal volume = p->points->real[POINT_VOLUME][q] * p->points->real[POINT_J][q];
      own_gradient(p, g, q, du, f);
      before += volume;
      after += volume * tensor_det(f);
    }
    for (PetscInt q = s->point_start[g]; q < s->point_start[g + 1]; ++q) {
      own_gradient(p, g, q, du, f);
      const PetscReal scale = pow(after / before / tensor_det(f), 1.0 / d);
      for (int i = 0; i < 9; ++i)
        if (d == 3 || i != 8) f[i] *= scale;
      const PetscReal constant[2] = {p->points->material[q] ? 1e4 : 3e4, p->points->material[q] ? 0.1 : 0.3};
      energy += p->points->real[POINT_VOLUME][q] * rubber_energy(constant, f, point_real(p->points, POINT_STATE, q));
    }
  }
  return energy;
}

/* Both materials take the coupled law, so that the state of all points is b. */
static void as_rubber(Patch *p)
{
  Diag *diag;
  CALL(DiagCreate(&diag));
  p->c.materials[1].law = p->c.materials[0].law;
  CALL(MaterialResolve(&p->c, 1, diag, &p->material[1]));
  assert_int_equal(diag_errors(diag), 0);
  CALL(DiagDestroy(&diag));
}

static void test_energy(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_SHARED; ++k) {
    Patch p;
    PetscReal *force, *direction, *du, slope = 0, work = 0, size = 0;
    static const PetscReal step[] = {-2, -1, 1, 2}, weight[] = {1. / 12, -2. / 3, 2. / 3, -1. / 12}, h = 1e-3;
    shared_begin(&p, &shared[k]);
    without_ties(&p);
    as_rubber(&p);
    for (PetscInt q = 0; q < p.points->n; ++q) { /* a state of b for either law */
      PetscReal F[9] = {1.1, 0.05, 0, -0.03, 0.95, 0, 0, 0, 1.02}, one[6] = {1, 1, 1, 0, 0, 0};
      F[0] += random_real(&p.random, -0.05, 0.05);
      sym_push_forward(F, one, point_real(p.points, POINT_STATE, q));
    }
    CALL(PetscMalloc3(p.dofs, &force, p.dofs, &direction, p.dofs, &du));
    fill(&p, direction, 0.2);
    assemble(&p, 0, p.du, force, NULL);
    for (int i = 0; i < 4; ++i) {
      for (PetscInt a = 0; a < p.dofs; ++a) du[a] = p.du[a] + step[i] * h * direction[a];
      slope += weight[i] * shared_energy(&p, du) / h;
    }
    for (PetscInt a = 0; a < p.dofs; ++a) work += force[a] * direction[a];
    size = norm(p.dofs, force) * norm(p.dofs, direction);
    assert_true(PetscAbsReal(slope - work) <= 1e-9 * size);
    CALL(PetscFree3(force, direction, du));
    patch_end(&p);
  }
}

/* --- tangent --- */

/* Moduli without symmetry: tau += s ln det dF b, and L_v b = 0. */
static LawStatus one_sided(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                           PetscReal *state, PetscReal *tau, PetscReal *c)
{
  const PetscReal s = 1e4;
  const LawStatus status = law_find("neo-hookean")->update(parameters, n, dF, old, state, tau, c);
  for (PetscInt k = 0; k < n; ++k)
    for (int i = 0; i < 6; ++i) {
      tau[6 * k + i] += s * log(tensor_det(dF + 9 * k)) * state[6 * k + i];
      for (int j = 0; c && j < 3; ++j) c[36 * k + 6 * i + j] += s * state[6 * k + i];
    }
  return status;
}

static void check_tangent(const Variant *variant, PetscReal inertia, const Law *law)
{
  Patch p;
  PetscReal *force, *values, *alone;
  shared_begin(&p, variant);
  if (law) p.material[0].law = law;
  CALL(PetscMalloc3(p.dofs, &force, p.dofs * p.dofs, &values, p.dofs, &alone));
  assemble(&p, inertia, p.du, force, values);
  check_slopes(&p, inertia, values);
  if (law) assert_true(skew_of(&p, values) > 1e-3);
  else assert_true(skew_of(&p, values) <= 1e-13);
  assemble(&p, inertia, p.du, alone, NULL);
  for (PetscInt i = 0; i < p.dofs; ++i) assert_true(PetscAbsReal(alone[i] - force[i]) <= 1e-12 * norm(p.dofs, force));
  CALL(PetscFree3(force, values, alone));
  patch_end(&p);
}

static void test_differences(void **state)
{
  Law law = *law_find("neo-hookean");
  (void)state;
  law.update = one_sided;
  law.spares_state = PETSC_FALSE; /* it is read above */
  law.update_hoop = NULL;
  for (size_t k = 0; k < N_SHARED; ++k) {
    check_tangent(&shared[k], 0, NULL);
    check_tangent(&shared[k], 40, NULL);
    check_tangent(&shared[k], 0, &law);
  }
}

/* A symmetric tangent is half computed and mirrored. */
static void test_mirrored(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_SHARED; ++k) {
    Patch p;
    PetscReal *force, *values[2], worst = 0;
    shared_begin(&p, &shared[k]);
    const PetscInt numbers = p.dofs * p.dofs;
    CALL(PetscCalloc3(p.dofs, &force, numbers, &values[0], numbers, &values[1]));
    for (int symmetric = 0; symmetric < 2; ++symmetric) {
      WeakFormInput in = input_of(&p, 40, p.du);
      WeakFormOutput out = {.force = force, .values = values[symmetric], .slot = p.slot};
      in.symmetric = symmetric;
      CALL(formulation_mean_dilatation.assemble(&in, &out));
    }
    for (PetscInt i = 0; i < numbers; ++i) worst = PetscMax(worst, PetscAbsReal(values[0][i] - values[1][i]));
    assert_true(worst <= 1e-14 * norm(numbers, values[0]));
    CALL(PetscFree3(force, values[0], values[1]));
    patch_end(&p);
  }
}

/* --- what must not change it --- */

/* In triangles and tetrahedra there is nothing to share. */
static void test_simplices(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_SHARED; ++k) {
    Patch p;
    PetscReal *force[2], off = 0;
    if (shared[k].ring || (shared[k].cell != CELL_TRIANGLE && shared[k].cell != CELL_TETRAHEDRON)) continue;
    patch_begin(&p, &shared[k]);
    CALL(PetscMalloc2(p.dofs, &force[0], p.dofs, &force[1]));
    assemble(&p, 40, p.du, force[0], NULL);
    p.formulation = &formulation_mean_dilatation;
    assemble(&p, 40, p.du, force[1], NULL);
    for (PetscInt i = 0; i < p.dofs; ++i) off = PetscMax(off, PetscAbsReal(force[0][i] - force[1][i]));
    assert_true(off <= 1e-13 * norm(p.dofs, force[0]));
    CALL(PetscFree2(force[0], force[1]));
    patch_end(&p);
  }
}

/* Two materials by name, the same by their numbers, in turn from point to point: each batch is one
 * point, and cells are put together from many. Forces, tangent, and the committed points. */
static void test_cut_batches(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_SHARED; ++k) {
    PetscReal *force[2], *values[2], *committed[2], off[3] = {0};
    Patch p[2];
    for (int cut = 0; cut < 2; ++cut) {
      shared_begin(&p[cut], &shared[k]);
      as_rubber(&p[cut]);
      p[cut].material[1] = p[cut].material[0];
      const PetscInt n = p[cut].points->n, n_state = p[cut].points->components[POINT_STATE];
      for (PetscInt q = 0; q < n; ++q) {
        const PetscReal one[6] = {1, 1, 1, 0, 0, 0};
        p[cut].points->material[q] = cut ? q % 2 : 0;
        CALL(PetscArraycpy(point_real(p[cut].points, POINT_STATE, q), one, PetscMin(6, n_state)));
      }
      const PetscInt dofs = p[cut].dofs;
      CALL(PetscMalloc3(dofs, &force[cut], dofs * dofs, &values[cut], n * 9, &committed[cut]));
      assemble(&p[cut], 40, p[cut].du, force[cut], values[cut]);
      WeakFormInput in = input_of(&p[cut], 0, p[cut].du);
      LawStatus status;
      CALL(formulation_mean_dilatation.commit(&in, p[cut].points, &status));
      assert_int_equal(status, LAW_OK);
      for (PetscInt q = 0; q < n; ++q) {
        const PetscReal *tau = point_real(p[cut].points, POINT_TAU, q);
        for (int i = 0; i < 4; ++i) committed[cut][9 * q + i] = tau[i] / 1e4;
        for (int i = 0; i < 3; ++i) committed[cut][9 * q + 4 + i] = point_real(p[cut].points, POINT_STATE, q)[i];
        committed[cut][9 * q + 7] = p[cut].points->real[POINT_J][q];
        committed[cut][9 * q + 8] = p[cut].points->real[POINT_WORK][q];
      }
    }
    const PetscInt dofs = p[0].dofs;
    for (PetscInt i = 0; i < dofs; ++i) off[0] = PetscMax(off[0], PetscAbsReal(force[0][i] - force[1][i]));
    for (PetscInt i = 0; i < dofs * dofs; ++i) off[1] = PetscMax(off[1], PetscAbsReal(values[0][i] - values[1][i]));
    for (PetscInt i = 0; i < 9 * p[0].points->n; ++i)
      off[2] = PetscMax(off[2], PetscAbsReal(committed[0][i] - committed[1][i]));
    assert_true(off[0] <= 1e-13 * norm(dofs, force[0]));
    assert_true(off[1] <= 1e-13 * norm(dofs * dofs, values[0]));
    assert_true(off[2] <= 1e-13 * norm(9 * p[0].points->n, committed[0]));
    for (int cut = 0; cut < 2; ++cut) {
      CALL(PetscFree3(force[cut], values[cut], committed[cut]));
      patch_end(&p[cut]);
    }
  }
}

/* A rotation of a strained state turns the forces. */
static void test_rotated(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_SHARED; ++k) {
    Patch p;
    PetscReal Q[9] = {0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1}, *straight, *turned, *du;
    if (shared[k].ring) continue; /* whose axis would turn */
    shared_begin(&p, &shared[k]);
    without_ties(&p);
    const PetscInt dim = p.grid->dim;
    if (dim == 3) random_rotation(&p.random, Q);
    CALL(PetscMalloc3(p.dofs, &straight, p.dofs, &turned, p.dofs, &du));
    for (PetscInt i = 0; i < p.dofs; ++i) { /* x + du' = Q (x + du) */
      du[i] = -p.grid->x[i];
      for (PetscInt j = 0, n = i / dim * dim; j < dim; ++j)
        du[i] += Q[3 * (i % dim) + j] * (p.grid->x[n + j] + p.du[n + j]);
    }
    assemble(&p, 0, p.du, straight, NULL);
    assemble(&p, 0, du, turned, NULL);
    for (PetscInt i = 0; i < p.dofs; ++i)
      for (PetscInt j = 0; j < dim; ++j) turned[i] -= Q[3 * (i % dim) + j] * straight[i / dim * dim + j];
    assert_true(norm(p.dofs, turned) <= 1e-12 * norm(p.dofs, straight));
    CALL(PetscFree3(straight, turned, du));
    patch_end(&p);
  }
}

/* A point turned inside out is reported. */
static void test_inverted(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_SHARED; ++k) {
    Patch p;
    PetscReal *force;
    shared_begin(&p, &shared[k]);
    const PetscInt dim = p.grid->dim;
    CALL(PetscCalloc1(p.dofs, &force));
    for (PetscInt i = 0; i < p.dofs; ++i) p.du[i] = i % dim == 1 ? -2 * p.grid->x[i] : 0; /* mirrored */
    WeakFormInput in = input_of(&p, 0, p.du);
    WeakFormOutput out = {.force = force};
    CALL(formulation_mean_dilatation.assemble(&in, &out));
    assert_int_equal(out.status, LAW_INVERTED);
    assert_true(out.bad_point >= 0 && out.bad_point < p.points->n);
    CALL(PetscFree(force));
    patch_end(&p);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_energy),    cmocka_unit_test(test_differences), cmocka_unit_test(test_mirrored),
    cmocka_unit_test(test_simplices), cmocka_unit_test(test_cut_batches), cmocka_unit_test(test_rotated),
    cmocka_unit_test(test_inverted),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
