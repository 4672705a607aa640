/* A program that has MPI for itself and lets two cases work side by side, each on its half of the
 * ranks: both give the numbers of one rank, and neither meets the other's messages, nor the
 * program's. */
#include "api_test.h"

/* The second half's block is softer, steps finer and hangs in less gravity. */
static const char *const softer[] = {"materials.rubber.young=2e5", "analysis.step=0.001", "loads.gravity=[0, -5]"};

typedef struct {
  MPI_Comm comm;
  int which, rank, size; /* first or second half; this process among the half's */
} Half;

/* The first half is the larger one. One rank alone is the second. */
static Half create_half(void)
{
  Half half;
  int rank, size;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  half.which = rank >= (size + 1) / 2 || size == 1;
  MPI_Comm_split(MPI_COMM_WORLD, half.which, rank, &half.comm);
  CALL(TalusRanks(half.comm, &half.rank, &half.size));
  return half;
}

static TalusCase *open_on(MPI_Comm comm, int which)
{
  return open_block_on(comm, which ? 3 : 0, which ? softer : NULL);
}

/* Steps the block to its end: two measures; mass and vertical momentum, summed over the points. */
static void values_of(MPI_Comm comm, int which, double values[4])
{
  double local[2] = {0, 0}, buffer[3 * 64], mass[64];
  int n;
  TalusCase *c = open_on(comm, which);
  TalusModel *model = create_model(c);
  CHECK(run_to_end(model) == (which ? 10 : 5));
  CALL(TalusModelMeasure(model, "top", &values[0]));
  CALL(TalusModelMeasure(model, "falling", &values[1]));
  CALL(TalusModelPoints(model, "velocity", &n, NULL, buffer, 3 * 64));
  CALL(TalusModelPoints(model, "mass", NULL, NULL, mass, 64));
  for (int p = 0; p < n; ++p) local[0] += mass[p], local[1] += mass[p] * buffer[3 * p + 1];
  MPI_Allreduce(local, values + 2, 2, MPI_DOUBLE, MPI_SUM, comm);
  CALL(TalusModelDestroy(&model));
  CALL(TalusCaseClose(&c));
}

static void expect_those_of_one_rank(const Half *half, const double values[4])
{
  double alone[4];
  values_of(MPI_COMM_SELF, half->which, alone);
  for (int i = 0; i < 4; ++i) CHECK_CLOSE(values[i], alone[i], half->size == 1 ? 0 : 1e-9 * fabs(alone[i]));
  CHECK(alone[0] < -1e-4 && alone[2] > 999 && alone[3] < -10);
}

/* Two models at once, while the program itself waits for any message on the communicator. */
static void test_models(void **state)
{
  Half half = create_half();
  double values[4];
  int waiting = 0, word = 7, one = 1;
  MPI_Request request;
  (void)state;
  MPI_Irecv(&word, 1, MPI_INT, MPI_ANY_SOURCE, MPI_ANY_TAG, half.comm, &request);
  values_of(half.comm, half.which, values);
  MPI_Test(&request, &waiting, MPI_STATUS_IGNORE);
  CHECK(!waiting && word == 7);
  MPI_Send(&one, 1, MPI_INT, half.rank, 3, half.comm);
  MPI_Wait(&request, MPI_STATUS_IGNORE);
  expect_those_of_one_rank(&half, values);
  MPI_Comm_free(&half.comm);
}

/* Two runs at once, each with its directory. */
static void test_runs(void **state)
{
  Half half = create_half();
  char folder[FOLDER], out[FOLDER + 8], history[FOLDER + 24];
  double top, alone[4];
  TalusRun *run;
  (void)state;
  make_folder(folder);
  snprintf(out, sizeof out, "%s/%d", folder, half.which);
  snprintf(history, sizeof history, "%s/history.csv", out);
  TalusCase *c = open_on(half.comm, half.which);
  CALL(TalusRunCase(c, out, TALUS_RUN_QUIET, &run, NULL));
  CALL(TalusRunMeasure(run, "top", &top));
  CHECK(access(history, R_OK) == 0);
  values_of(MPI_COMM_SELF, half.which, alone);
  CHECK_CLOSE(top, alone[0], half.size == 1 ? 0 : 1e-9 * fabs(alone[0]));
  CALL(TalusRunDestroy(&run));
  CALL(TalusCaseClose(&c));
  remove_folder(folder);
  MPI_Comm_free(&half.comm);
}

/* A mistake of the second half's case is told to all its ranks, and to no other. */
static void test_messages(void **state)
{
  const char *const wrong[] = {"materials.rubber.yung=1"};
  Half half = create_half();
  TalusCase *c;
  char *messages;
  (void)state;
  const int error = TalusCaseOpen(half.comm, BLOCK, half.which, wrong, &c, &messages);
  CHECK(error == (half.which ? TALUS_ERROR_INPUT : TALUS_OK));
  CHECK(half.which ? c == NULL && messages && strstr(messages, "did you mean 'young'?") : c && !messages);
  TalusTextFree(&messages);
  CALL(TalusCaseClose(&c));
  MPI_Comm_free(&half.comm);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_models),
    cmocka_unit_test(test_runs),
    cmocka_unit_test(test_messages),
  };
  MPI_Init(&argc, &argv);
  CALL(TalusInitialize(&argc, &argv));
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  CALL(TalusFinalize());
  MPI_Finalize();
  return failed;
}
