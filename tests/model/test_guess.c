/* First guesses of a step in numbers, and what decides between them. */
#include "case_builder.h"
#include "model/model_private.h"

/* A block that slides to the right, one of its sides held along y. */
static Model *sliding(Bench *b)
{
  bench_init(b, "mpm", CELL_QUADRILATERAL, 8);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){0.5, 0.5, 1});
  bench_dynamic(b, 1, 0.01);
  bench_motion(b, 1, 0, MOTION_FIXED, 2);
  b->body[0].velocity[0] = 1.5;
  b->c.gravity[0] = 2;
  return bench_model(b, PETSC_COMM_WORLD);
}

/* Inertia alone: dt (v + a dt / 2). The step before: its increments in the ratio of the steps,
 * where they were solved for. Rest: nothing. */
static void test_values(void **state)
{
  Bench b;
  PetscReal *inertia, *previous, *rest;
  (void)state;
  Model *m = sliding(&b);
  const PetscInt dofs = 2 * m->grid->n_nodes;
  CALL(PetscMalloc3(dofs, &inertia, dofs, &previous, dofs, &rest));
  model_step(m, 0.01);
  model_step(m, 0.004);
  CALL(ModelActivate(m));
  mark_fixed(m);
  CHECK_CLOSE(m->guess.step, 0.004, 1e-15);
  guess_make(m, GUESS_INERTIA, 0.003, inertia);
  guess_make(m, GUESS_PREVIOUS, 0.003, previous);
  guess_make(m, GUESS_REST, 0.003, rest);
  PetscInt followed = 0;
  for (PetscInt i = 0; i < dofs; ++i) {
    const PetscReal v = m->nodes->v[i], a = m->nodes->a[i];
    const PetscReal alone = m->nodes->touched[i / 2] ? 0.003 * (v + 0.5 * 0.003 * a) : 0;
    const PetscBool follows = !m->nodes->fixed[i] && m->nodes->previous[i] != 0;
    CHECK_CLOSE(inertia[i], alone, 1e-16);
    CHECK_CLOSE(previous[i], follows ? 0.75 * m->nodes->previous[i] : alone, 1e-16);
    CHECK(rest[i] == 0, "rest moves");
    followed += follows;
  }
  CHECK(m->points->n == 0 || followed > 0, "no node knows the step before");
  CALL(PetscFree3(inertia, previous, rest));
  CALL(ModelDestroy(&m));
}

/* Whichever would have been nearer to the last solution comes first, the other one next, rest
 * last. */
static void test_order(void **state)
{
  Bench b;
  (void)state;
  Model *m = sliding(&b);
  FirstGuess order[GUESS_N];
  model_step(m, 0.01);
  for (int nearer = 0; nearer < 2; ++nearer) {
    m->guess.previous = nearer;
    CHECK(guess_order(m, order) == 3, "not three guesses");
    CHECK(order[0] == (nearer ? GUESS_PREVIOUS : GUESS_INERTIA), "first");
    CHECK(order[1] == (nearer ? GUESS_INERTIA : GUESS_PREVIOUS), "second");
    CHECK(order[2] == GUESS_REST, "last");
  }
  CALL(ModelDestroy(&m));
}

/* What was learnt from a step: inertia was right, or the step before was. */
static void test_learning(void **state)
{
  Bench b;
  (void)state;
  Model *m = sliding(&b);
  model_step(m, 0.01);
  CALL(ModelActivate(m));
  mark_fixed(m);
  for (int nearer = 0; nearer < 2; ++nearer) {
    for (PetscInt i = 0; i < 2 * m->grid->n_nodes; ++i) {
      m->nodes->previous[i] = m->nodes->touched[i / 2] && !m->nodes->fixed[i] ? 1e-3 : 0;
      m->nodes->v[i] = 1;
      m->nodes->a[i] = 0;
      /* half of the step before, or the velocity for as long */
      m->nodes->du[i] = nearer ? 0.5e-3 : 0.005;
    }
    m->guess = (Guess){.step = 0.01, .previous = !nearer};
    CALL(GuessLearn(m, 0.005));
    CHECK(m->guess.previous == (PetscBool)nearer, "nearer: %d", nearer);
    CHECK_CLOSE(m->guess.step, 0.005, 0);
  }
  CALL(ModelDestroy(&m));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_values), cmocka_unit_test(test_order),
                                     cmocka_unit_test(test_learning)};
  return run_model_tests(argc, argv, tests);
}
