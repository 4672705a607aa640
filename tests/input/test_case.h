/* Helpers of the tests of case files: write a text to a temporary file, read it, keep what was
 * said. */
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "input/case_file.h"

#define ASSERT_NEAR(a, b, tolerance) assert_true(PetscAbsReal((a) - (b)) <= (tolerance))

/* A case with nothing special; tests replace a line or use --set. */
#define PLAIN_TOP "kinematics: plane-strain\nmethod: mpm\nanalysis: {type: static, steps: 4}\n"
#define PLAIN_GRID "grid: {box: {min: [0, 0], max: [4, 2]}, size: 0.5}\n"
#define PLAIN_BODIES "bodies:\n  - {name: beam, shape: {box: {min: [0, 0], max: [2, 1]}}, material: rubber}\n"
#define PLAIN_MATERIALS "materials:\n  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}\n"
#define PLAIN PLAIN_TOP PLAIN_GRID PLAIN_BODIES PLAIN_MATERIALS

/* Write size bytes to a fresh file; every rank of PETSC_COMM_WORLD gets its name. */
static inline void write_case(const char *bytes, size_t size, char name[64])
{
  PetscMPIInt rank;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  strcpy(name, "/tmp/talus_case_XXXXXX");
  if (rank == 0) {
    const int file = mkstemp(name);
    assert_true(file >= 0);
    assert_int_equal(write(file, bytes, size), (ssize_t)size);
    close(file);
  }
  assert_int_equal(MPI_Bcast(name, 64, MPI_CHAR, 0, PETSC_COMM_WORLD), 0);
}

/* Read a text as a case file. *said (to be freed) is what DiagFlush prints, with the file's name
 * replaced by "F". */
__attribute__((noinline, unused)) static Case *read_bytes(const char *bytes, size_t size, PetscInt n_set,
                                                          const char *const *set, char **said)
{
  char name[64], *text = NULL;
  PetscMPIInt rank;
  size_t length = 0;
  Diag *diag;
  Case *c;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  write_case(bytes, size, name);
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(CaseRead(PETSC_COMM_WORLD, name, n_set, set, diag, &c), 0);
  assert_true((c == NULL) == (diag_errors(diag) > 0));
  FILE *out = open_memstream(&text, &length);
  assert_int_equal(DiagFlush(diag, out), 0);
  fclose(out);
  assert_int_equal(DiagDestroy(&diag), 0);
  assert_int_equal(MPI_Barrier(PETSC_COMM_WORLD), 0);
  if (rank == 0) unlink(name);
  for (char *p; (p = strstr(text, name));) {
    *p = 'F';
    memmove(p + 1, p + strlen(name), strlen(p + strlen(name)) + 1);
  }
  *said = text;
  return c;
}

static inline Case *read_text(const char *text, char **said) { return read_bytes(text, strlen(text), 0, NULL, said); }

/* A case that must be good. */
static inline Case *read_good(const char *text)
{
  char *said;
  Case *c = read_text(text, &said);
  if (!c) fail_msg("%s", said);
  free(said);
  return c;
}
