/* Short cuts of the meshfree tangent give what the long way gives: slots kept from the step before,
 * and half of a symmetric matrix. */
#include "case_builder.h"
#include "model/model_private.h"

static const BasisSpec bases[] = {
  {.kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2},
  {.kind = "mls", .effective_radius = 1, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2},
};

/* A block that turns and falls on fixed nodes: clouds change at every step. */
static Model *fall(Bench *b, const BasisSpec *basis, CellType cell, PetscReal size)
{
  bench_init(b, "gmm", cell, 0);
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1, 1}, size);
  b->c.basis = *basis;
  bench_box(b, 0, (PetscReal[]){0.5, 0.25, 0}, (PetscReal[]){1.25, 0.75, 1});
  bench_dynamic(b, 1, 0.002);
  b->body[0].velocity[1] = -2;
  b->body[0].spin[2] = 3;
  b->body[0].spin_centre[0] = 0.875;
  b->body[0].spin_centre[1] = 0.5;
  b->c.gravity[1] = -9.81;
  bench_motion(b, 1, 0, MOTION_FIXED, 7);
  return bench_model(b, PETSC_COMM_WORLD);
}

/* Every slot that was kept is the one that a search finds. */
static void check_slots(Model *m)
{
  const Support *w = m->space->support;
  PetscInt n = 0, *kept;
  PetscBool complete;
  for (PetscInt g = 0; g < w->n_groups; ++g) n += PetscSqr(support_nodes(w, g));
  CALL(PetscMalloc1(n, &kept));
  CALL(PetscArraycpy(kept, m->system->slot, n));
  m->system->before.builds = 0;
  CALL(SystemSlots(m->system, w, &complete));
  CHECK(complete, "pairs are missing");
  for (PetscInt i = 0; i < n; ++i)
    CHECK(kept[i] == m->system->slot[i], "slot %d: %d instead of %d", (int)i, (int)kept[i], (int)m->system->slot[i]);
  CALL(PetscFree(kept));
}

/* Forces and values at the present increments, with half of the pairs or all; prescribed dofs are
 * lifted. */
static void assemble(Model *m, const PetscReal *lift, PetscBool half, PetscReal *force, PetscReal *values)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim, n = m->system->row_start[m->system->n_rows] * m->dim * m->dim;
  WeakFormInput in = weak_form_of(m, 4 / PetscSqr(0.002));
  WeakFormOutput out = {.force = m->nodes->force, .values = m->system->values, .slot = m->system->slot};
  in.half = half;
  CALL(SystemGather(m->system, PETSC_FALSE));
  CALL(PetscArrayzero(m->nodes->force, dofs));
  CALL(SystemZero(m->system));
  CALL(m->formulation->assemble(&in, &out));
  CHECK(out.status == LAW_OK, "no stress");
  if (half) CALL(SystemMirror(m->system, 0));
  CALL(SystemPrescribe(m->system, m->nodes->fixed, NULL));
  system_lift(m->system, m->nodes->fixed, lift, m->nodes->force, NULL);
  CALL(PetscArraycpy(force, m->nodes->force, dofs));
  CALL(PetscArraycpy(values, m->system->values, n));
}

static PetscReal largest(PetscInt n, const PetscReal *v, const PetscReal *minus)
{
  PetscReal value = 0;
  for (PetscInt i = 0; i < n; ++i) value = PetscMax(value, PetscAbsReal(v[i] - (minus ? minus[i] : 0)));
  return value;
}

static void check_half(Model *m)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim, n = m->system->row_start[m->system->n_rows] * m->dim * m->dim;
  PetscReal *force[2], *values[2], *lift;
  CALL(PetscMalloc5(dofs, &force[0], dofs, &force[1], n, &values[0], n, &values[1], dofs, &lift));
  for (PetscInt i = 0; i < dofs; ++i) {
    lift[i] = m->nodes->fixed[i] ? 1e-4 * (PetscReal)(1 + i % 5) : 0;
  }
  for (int half = 0; half < 2; ++half) assemble(m, lift, half, force[half], values[half]);
  CHECK(largest(n, values[0], values[1]) <= 1e-13 * largest(n, values[0], NULL), "blocks are off by %g of %g",
        (double)largest(n, values[0], values[1]), (double)largest(n, values[0], NULL));
  CHECK(largest(dofs, force[0], force[1]) <= 1e-13 * largest(dofs, force[0], NULL), "forces are off by %g of %g",
        (double)largest(dofs, force[0], force[1]), (double)largest(dofs, force[0], NULL));
  CALL(PetscFree5(force[0], force[1], values[0], values[1], lift));
}

static void follow(const BasisSpec *basis, CellType cell, PetscReal size, PetscInt steps)
{
  Bench b;
  Model *m = fall(&b, basis, cell, size);
  CHECK(m->symmetric, "the law is not symmetric");
  for (PetscInt step = 0; step < steps; ++step) {
    (void)model_step(m, 0.002);
    CALL(ModelActivate(m));
    check_slots(m);
    if (step % 10 == 9) check_half(m);
  }
  CALL(ModelDestroy(&m));
}

static void test_short_cuts(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    follow(&bases[k], CELL_QUADRILATERAL, 0.125, 60);
    follow(&bases[k], CELL_HEXAHEDRON, 0.25, 10);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_short_cuts)};
  return run_model_tests(argc, argv, tests);
}
