/* Forces and stiffness of the vectorised kernels against the textbook of tests/reference, for
 * every kind of cell and of cloud, with a made-up law: its moduli have no symmetry, or are
 * symmetric. */
#include "../reference/stiffness.h"
#include "patch.h"

/* Stress and moduli that depend smoothly on dF and mean nothing. */
static LawStatus made_up(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                         PetscReal *state, PetscReal *tau, PetscReal *c)
{
  (void)old, (void)state;
  for (PetscInt k = 0; k < n; ++k) {
    PetscReal s = parameters[0];
    for (int i = 0; i < 9; ++i) s += (1 + 0.3 * i) * dF[9 * k + i];
    for (int i = 0; i < 6; ++i) tau[6 * k + i] = sin(s + i);
    for (int i = 0; i < 36 && c; ++i) {
      const int a = i / 6, b = i % 6;
      c[36 * k + i] = parameters[1] > 0 ? cos(s + a) * cos(s + b) : cos(s + 5 * a + b);
    }
  }
  return LAW_OK;
}

static const Law law_made_up = {.name = "made-up", .update = made_up};

static void reference_assemble(const Patch *p, PetscReal *force, PetscReal *values)
{
  const Support *s = p->support;
  const int dim = (int)p->grid->dim;
  for (PetscInt g = 0, slot = 0; g < s->n_groups; ++g) {
    const int nn = (int)support_nodes(s, g);
    const PetscInt *node = s->node + s->node_start[g];
    PetscReal du[3 * CLOUD_MAX_NODES], grad[3 * CLOUD_MAX_NODES], dF[9], tau[6], c[36], f[3], K[9];
    for (int i = 0; i < nn * dim; ++i) du[i] = p->du[node[i / dim] * dim + i % dim];
    for (PetscInt q = s->point_start[g]; q < s->point_start[g + 1]; ++q) {
      const PetscReal *dN = support_dN(s, g, q, dim), volume = *point_real(p->points, POINT_VOLUME, q);
      reference_increment(dim, nn, dN, du, dF);
      reference_gradients(dim, nn, dN, dF, grad);
      (void)made_up(p->material[p->points->material[q]].parameters, 1, dF, NULL, NULL, tau, c);
      for (int I = 0; I < nn; ++I) {
        reference_force(dim, grad + I * dim, volume, tau, f);
        for (int a = 0; a < dim; ++a) force[node[I] * dim + a] += f[a];
        for (int J = 0; J < nn; ++J) {
          reference_stiffness(dim, grad + I * dim, grad + J * dim, volume, tau, c, K);
          for (int e = 0; e < dim * dim; ++e) values[p->slot[slot + I * nn + J] * dim * dim + e] += K[e];
        }
      }
    }
    slot += nn * nn;
  }
}

static PetscReal off(PetscInt n, const PetscReal *a, const PetscReal *b)
{
  PetscReal value = 0;
  for (PetscInt i = 0; i < n; ++i) value = PetscMax(value, PetscAbsReal(a[i] - b[i]));
  return value;
}

static void check(const Variant *variant, PetscBool symmetric)
{
  Patch p;
  PetscReal *force[2], *values[2];
  patch_begin(&p, variant);
  const PetscInt numbers = p.dofs * p.dofs;
  for (int k = 0; k < 2; ++k) p.material[k] = (Material){.law = &law_made_up, .parameters = {k, symmetric}};
  for (PetscInt g = 0; g < p.support->n_groups; ++g) p.lumping[g] = p.soft[g] = p.tie[g] = 0;
  CALL(PetscArrayzero(p.history, p.dofs));
  CALL(PetscCalloc4(p.dofs, &force[0], p.dofs, &force[1], numbers, &values[0], numbers, &values[1]));
  WeakFormInput in = input_of(&p, 0, p.du);
  WeakFormOutput out = {.force = force[0], .values = values[0], .slot = p.slot};
  in.symmetric = symmetric;
  CALL(formulation_displacement.assemble(&in, &out));
  reference_assemble(&p, force[1], values[1]);
  assert_true(norm(p.dofs, force[1]) > 0.1);
  assert_true(off(p.dofs, force[0], force[1]) <= 1e-14 * norm(p.dofs, force[1]));
  assert_true(off(numbers, values[0], values[1]) <= 1e-14 * norm(numbers, values[1]));
  CALL(PetscFree4(force[0], force[1], values[0], values[1]));
  patch_end(&p);
}

static void test_textbook(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_VARIANTS; ++k)
    for (int symmetric = 0; symmetric < 2 && !variants[k].ring; ++symmetric) check(&variants[k], symmetric);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_textbook)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
