/* Seals: any byte of a short file counts, samples of a long one; its length always does. */
#include "test_output.h"
#include "output/seal.h"
#include <fcntl.h>
#include <sys/stat.h>
#include <stdio.h>

#define SHORT 100000
#define LONG 3000000

static char folder[64], path[128];

static void write_file(size_t n)
{
  FILE *out = fopen(path, "w");
  for (size_t i = 0; i < n; ++i) fputc((int)(i * i % 251), out);
  assert_int_equal(fclose(out), 0);
}

/* Turn the bits of one byte; again, and it is as it was. */
static void touch(off_t at)
{
  unsigned char byte;
  const int fd = open(path, O_RDWR);
  assert_int_equal(pread(fd, &byte, 1, at), 1);
  byte = (unsigned char)~byte;
  assert_int_equal(pwrite(fd, &byte, 1, at), 1);
  assert_int_equal(close(fd), 0);
}

static void expect(const FileSeal *seal, const char *words)
{
  char reason[128];
  file_check_seal(path, seal, reason);
  if (words) assert_non_null(strstr(reason, words));
  else assert_string_equal(reason, "");
}

static void test_every_byte_of_a_short_file(void **state)
{
  static const off_t at[] = {0, 4095, 4096, 50000, SHORT - 1};
  FileSeal seal;
  (void)state;
  write_file(SHORT);
  assert_int_equal(file_seal(path, &seal), 0);
  assert_int_equal(seal.bytes, SHORT);
  for (size_t k = 0; k < sizeof at / sizeof *at; ++k) {
    touch(at[k]);
    expect(&seal, "its checksum is wrong");
    touch(at[k]);
    expect(&seal, NULL);
  }
}

static void test_samples_of_a_long_file(void **state)
{
  FileSeal seal;
  (void)state;
  write_file(LONG);
  assert_int_equal(file_seal(path, &seal), 0);
  expect(&seal, NULL);
  for (off_t block = 0; block < 16; ++block) { /* whatever spoils 200 kB of it is found */
    for (off_t i = 0; i < 200000 && block * 200000 + i < LONG; i += 1000) touch(block * 200000 + i);
    if (block < LONG / 200000) expect(&seal, "its checksum is wrong");
    for (off_t i = 0; i < 200000 && block * 200000 + i < LONG; i += 1000) touch(block * 200000 + i);
  }
  touch(LONG - 1);
  expect(&seal, "its checksum is wrong");
  touch(LONG - 1);
  expect(&seal, NULL);
  assert_int_equal(truncate(path, LONG - 1), 0);
  expect(&seal, "it is 2999999 bytes long and was 3000000");
}

static void test_what_is_no_file(void **state)
{
  const FileSeal unknown = {.bytes = -1};
  FileSeal seal;
  (void)state;
  write_file(0);
  assert_int_equal(file_seal(path, &seal), 0);
  expect(&seal, NULL);
  write_file(10);
  expect(&seal, "it is 10 bytes long and was 0");
  expect(&unknown, NULL);
  assert_int_equal(unlink(path), 0);
  expect(&unknown, "it is missing");
  assert_int_equal(mkdir(path, 0700), 0);
  expect(&unknown, "it is no file");
  assert_int_equal(rmdir(path), 0);
  assert_int_equal(mkfifo(path, 0600), 0); /* and nobody waits for one who writes into it */
  expect(&unknown, "it is no file");
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_every_byte_of_a_short_file),
                                     cmocka_unit_test(test_samples_of_a_long_file),
                                     cmocka_unit_test(test_what_is_no_file)};
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/file", folder);
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  TestRemove(folder);
  return failed;
}

int main(int argc, char **argv) { return TestMain(argc, argv, Tests); }
