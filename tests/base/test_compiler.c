/* The compiler, with the flags that talus is built with, keeps the elements of vectors apart. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#define TALUS_TEST
#include "../../cmake/compiler/elements.c"

static void Elements(void **state)
{
  (void)state;
  assert_int_equal(wrong_elements(), 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Elements)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
