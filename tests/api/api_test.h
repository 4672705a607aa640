/* What the tests of the public interface share: checks that end all ranks, the block, folders. */
#pragma once
#include <math.h>
#include <mpi.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "talus.h"

#define BLOCK TALUS_SOURCE_DIR "/tests/api/block.yaml"
#define FOLDER 64

/* A rank that failed must not leave the others waiting in a collective call. */
static inline void check(int good, const char *what, const char *file, int line)
{
  int size = 1, running;
  if (good) return;
  MPI_Initialized(&running);
  if (running) MPI_Comm_size(MPI_COMM_WORLD, &size);
  fprintf(stderr, "%s:%d: failed: %s\n", file, line, what);
  if (size > 1) MPI_Abort(MPI_COMM_WORLD, 1);
  _fail(file, line);
}

#define CHECK(condition) check(!!(condition), #condition, __FILE__, __LINE__)
#define CHECK_ERROR(call, error) CHECK((call) == (error))
#define CALL(call) CHECK_ERROR(call, TALUS_OK)
#define CHECK_CLOSE(a, b, tolerance) CHECK(fabs((a) - (b)) <= (tolerance))

static inline TalusCase *open_block_on(MPI_Comm comm, int n_set, const char *const *set)
{
  TalusCase *c = NULL;
  CALL(TalusCaseOpen(comm, BLOCK, n_set, set, &c, NULL));
  CHECK(c != NULL);
  return c;
}

static inline TalusCase *open_block(int n_set, const char *const *set)
{
  return open_block_on(MPI_COMM_WORLD, n_set, set);
}

static inline TalusModel *create_model(TalusCase *c)
{
  TalusModel *model = NULL;
  CALL(TalusModelCreate(c, &model, NULL));
  CHECK(model != NULL);
  return model;
}

static inline int run_to_end(TalusModel *model)
{
  TalusStep step = TALUS_STEP_ACCEPTED;
  int steps = -1;
  while (step == TALUS_STEP_ACCEPTED) {
    CALL(TalusModelStep(model, 0, &step));
    ++steps;
  }
  CHECK(step == TALUS_STEP_AT_END);
  return steps;
}

static inline int my_rank(void)
{
  int rank = -1;
  CALL(TalusRanks(MPI_COMM_WORLD, &rank, NULL));
  return rank;
}

/* A folder that the first rank makes, and that goes with all in it. */
static inline void make_folder(char folder[FOLDER])
{
  snprintf(folder, FOLDER, "/tmp/talus-api-XXXXXX");
  if (my_rank() == 0) CHECK(mkdtemp(folder) != NULL);
  MPI_Bcast(folder, FOLDER, MPI_CHAR, 0, MPI_COMM_WORLD);
}

static inline void remove_folder(const char *folder)
{
  char command[FOLDER + 16];
  MPI_Barrier(MPI_COMM_WORLD);
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  if (my_rank() == 0) CHECK(system(command) == 0);
}
