/* Who waits for other ranks here yields as talus does (src/cli/yield.c): MPI's libraries find that before libc's. */
#include <dlfcn.h>
#include <sched.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static void test_whose(void **state)
{
  void *libc = dlopen("libc.so.6", RTLD_LAZY), *found = dlsym(RTLD_DEFAULT, "sched_yield");
  (void)state;
  assert_non_null(libc);
  assert_non_null(found);
  assert_ptr_not_equal(found, dlsym(libc, "sched_yield"));
  dlclose(libc);
}

static void test_yields(void **state)
{
  (void)state;
  for (int k = 0; k < 1000; ++k) assert_int_equal(sched_yield(), 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_whose), cmocka_unit_test(test_yields)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
