/* What the tests of output share: a scratch folder, and quiet ranks. */
#pragma once
#include <petscsys.h>
#include <ftw.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

static inline PetscMPIInt test_rank(void)
{
  PetscMPIInt rank;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

static inline PetscMPIInt test_ranks(void)
{
  PetscMPIInt size;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return size;
}

static inline int RemoveEntry(const char *path, const struct stat *status, int type, struct FTW *walk)
{
  (void)status, (void)type, (void)walk;
  return remove(path);
}

static inline void TestRemove(const char *folder)
{
  MPI_Barrier(PETSC_COMM_WORLD);
  if (test_rank() == 0) nftw(folder, RemoveEntry, 16, FTW_DEPTH | FTW_PHYS);
  MPI_Barrier(PETSC_COMM_WORLD);
}

/* A new empty folder, the same on all ranks. */
static inline void TestFolder(char folder[64])
{
  if (test_rank() == 0) {
    const char *root = getenv("TMPDIR");
    snprintf(folder, 64, "%.32s/talus-test-XXXXXX", root ? root : "/tmp");
    assert_non_null(mkdtemp(folder));
  }
  MPI_Bcast(folder, 64, MPI_CHAR, 0, PETSC_COMM_WORLD);
}

/* The whole file as text, to be freed; NULL if there is none. */
static inline char *TestRead(const char *folder, const char *name)
{
  char path[512], *text = NULL;
  size_t n = 0, size = 0;
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *in = fopen(path, "r");
  if (!in) return NULL;
  FILE *out = open_memstream(&text, &size);
  char buffer[4096];
  while ((n = fread(buffer, 1, sizeof buffer, in)) > 0) fwrite(buffer, 1, n, out);
  fclose(out);
  fclose(in);
  return text;
}

static inline PetscBool TestExists(const char *folder, const char *name)
{
  char path[512];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return !access(path, F_OK);
}

/* Run the tests with PETSc up; ranks above 0 keep cmocka's lines for themselves. */
static inline int TestMain(int argc, char **argv, int (*tests)(void))
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (test_rank() > 0 && !freopen("/dev/null", "w", stdout)) return 1;
  int failed = tests();
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_SUM, PETSC_COMM_WORLD);
  if (PetscFinalize()) return 1;
  return failed ? 1 : 0;
}
