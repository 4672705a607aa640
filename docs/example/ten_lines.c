/* Runs the case file that its argument names, into the directory `run`, and prints the final value of every measure. */
#include <stdio.h>
#include <talus.h>

int main(int argc, char **argv)
{
  TalusCase *c = NULL;
  TalusRun *run = NULL;
  const char *name, *unit;
  double value;
  if (argc < 2 || TalusInitialize(&argc, &argv)) return 2;
  int error = TalusCaseOpen(MPI_COMM_WORLD, argv[1], 0, NULL, &c, NULL);
  if (!error) error = TalusRunCase(c, "run", TALUS_RUN_FORCE | TALUS_RUN_QUIET, &run, NULL);
  for (int i = 0; !error && !TalusCaseMeasureName(c, i, &name, &unit); ++i)
    if (!TalusRunMeasure(run, name, &value)) printf("%s = %.9g %s\n", name, value, unit);
  TalusRunDestroy(&run);
  TalusCaseClose(&c);
  return TalusFinalize() || error ? 1 : 0;
}
