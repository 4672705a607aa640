/* Displacement over the factor that divides the strength: where it turns, the body slides. */
#include <stdlib.h>
#include <string.h>
#include "base/file.h"
#include "output/directory/run_dir_files.h"
#include "picture/figure.h"
#include "picture/plot.h"

#define MOST_TRIES 1024

/* What stands, and the smallest factor that does not. */
typedef struct {
  PetscInt n;
  PetscReal factor[MOST_TRIES], displacement[MOST_TRIES], failed;
} FactorCurve;

/* A line of factor.csv; the header has no factor. */
static void read_line(const char *line, FactorCurve *curve)
{
  enum { FACTOR, STABLE, DISPLACEMENT = 5, COLUMNS };
  const char *column[COLUMNS];
  char *end;
  for (int k = 0; k < COLUMNS; ++k) {
    column[k] = k ? strchr(column[k - 1], ',') : line;
    if (!column[k]) return;
    column[k] += k > 0;
  }
  const PetscReal factor = (PetscReal)strtod(column[FACTOR], &end);
  if (end == column[FACTOR]) return;
  if (strncmp(column[STABLE], "yes,", 4)) {
    curve->failed = factor;
    return;
  }
  if (curve->n == MOST_TRIES) return;
  curve->factor[curve->n] = factor;
  curve->displacement[curve->n++] = (PetscReal)strtod(column[DISPLACEMENT], NULL);
}

PetscErrorCode PlotFactor(const PlotOptions *options, Diag *diag, void (*said)(const char *path))
{
  char path[FILE_PATH], png[FILE_PATH + 64], line[512];
  FactorCurve curve = {.failed = NAN};
  PetscBool done = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!file_exists(options->run, "factor.csv")) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/factor.csv", options->run));
  FILE *in = file_open_read(path);
  while (in && fgets(line, sizeof line, in)) read_line(line, &curve);
  if (in) fclose(in);
  if (curve.n < 2 || !plot_folder(options->run, diag)) PetscFunctionReturn(0);
  const PetscReal at[] = {curve.failed, curve.failed}, height[] = {0, curve.displacement[curve.n - 1]};
  /* without the state before the first factor, in which nothing had yielded */
  const FigureSeries series[] = {
    {.name = "stands",
     .style = FIGURE_LINE_MARKS,
     .n = curve.n - 1,
     .x = curve.factor + 1,
     .y = curve.displacement + 1},
    {.name = "slides", .style = FIGURE_DASHES, .n = 2, .x = at, .y = height},
  };
  const Figure figure = {.title = "Largest displacement",
                         .x_label = "factor that divides the strength",
                         .y_label = "displacement [m]",
                         .n_series = PetscIsNanReal(curve.failed) ? 1 : 2,
                         .series = series};
  PetscCall(PetscSNPrintf(png, sizeof png, "%s/pictures/factor.png", options->run));
  PetscCall(FigureWrite(&figure, png, diag, &done));
  if (done && said) said(png);
  PetscFunctionReturn(0);
}
