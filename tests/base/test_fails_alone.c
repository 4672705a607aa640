/* Meant to fail, on the last rank only: the message must be there, and the other ranks must not
 * wait in their barrier until the time is up. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <petscsys.h>

static void last_rank_fails(void **state)
{
  PetscMPIInt rank, size;
  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  if (rank == size - 1) fail_msg("the last rank fails alone");
  MPI_Barrier(PETSC_COMM_WORLD);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(last_rank_fails)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
