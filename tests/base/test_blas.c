/* Kernels of OpenBLAS that fit the processor: chosen, and right. */
#include "base/process/blas.h"
#include <dlfcn.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <petscmat.h>
#include <strings.h>

enum { M = 67, N = 43, K = 129 };

/* Entries that binary numbers have, so that sums are exact in any order. */
static PetscReal entry(int i, int j) { return (PetscReal)((7 * i + 13 * j) % 32 - 16) / 8; }

static PetscErrorCode Fill(int rows, int columns, int shift, Mat *m)
{
  PetscScalar *v;
  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, rows, columns, NULL, m));
  PetscCall(MatDenseGetArrayWrite(*m, &v));
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < rows; ++i) v[i + rows * j] = entry(i, j + shift);
  PetscCall(MatDenseRestoreArrayWrite(*m, &v));
  PetscCall(MatAssemblyBegin(*m, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*m, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

static void test_product(void **state)
{
  Mat a, b, c;
  const PetscScalar *v;
  (void)state;
  assert_int_equal(Fill(M, K, 0, &a), 0);
  assert_int_equal(Fill(K, N, 5, &b), 0);
  assert_int_equal(MatMatMult(a, b, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &c), 0);
  assert_int_equal(MatDenseGetArrayRead(c, &v), 0);
  for (int i = 0; i < M; ++i)
    for (int j = 0; j < N; ++j) {
      PetscReal sum = 0;
      for (int l = 0; l < K; ++l) sum += entry(i, l) * entry(l, j + 5);
      assert_true(v[i + M * j] == sum);
    }
  assert_int_equal(MatDenseRestoreArrayRead(c, &v), 0);
  assert_int_equal(MatDestroy(&a) || MatDestroy(&b) || MatDestroy(&c), 0);
}

static void test_known(void **state)
{
  char *(*name)(void) = NULL;
  (void)state;
  *(void **)&name = dlsym(RTLD_DEFAULT, "openblas_get_corename");
#if defined(__x86_64__)
  if (name && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    assert_int_not_equal(strcasecmp(name(), "Prescott"), 0);
#endif
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_product), cmocka_unit_test(test_known)};
  blas_know_processor();
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
