/* Load over displacement of a run that raised a load to its limit. */
#include <stdlib.h>
#include <string.h>
#include "base/file.h"
#include "output/directory/run_dir_files.h"
#include "picture/figure.h"
#include "picture/plot.h"

#define MOST_STEPS 4096

typedef struct {
  PetscInt n;
  PetscReal load[MOST_STEPS], displacement[MOST_STEPS], most;
} LimitCurve;

/* A line of limit.csv: control, load, displacement, ...; the header has no numbers. */
static void read_line(const char *line, LimitCurve *curve)
{
  char *end;
  const PetscReal control = (PetscReal)strtod(line, &end);
  (void)control;
  if (end == line || *end != ',' || curve->n == MOST_STEPS) return;
  curve->load[curve->n] = (PetscReal)strtod(end + 1, &end);
  curve->displacement[curve->n] = *end == ',' ? (PetscReal)strtod(end + 1, NULL) : 0;
  curve->most = PetscMax(curve->most, curve->load[curve->n]);
  ++curve->n;
}

PetscErrorCode PlotLimit(const PlotOptions *options, Diag *diag, void (*said)(const char *path))
{
  char path[FILE_PATH], png[FILE_PATH + 64], line[512];
  PetscBool done = PETSC_FALSE, forces = PETSC_FALSE;
  LimitCurve *curve;

  PetscFunctionBeginUser;
  if (!file_exists(options->run, "limit.csv")) PetscFunctionReturn(0);
  PetscCall(PetscNew(&curve));
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/limit.csv", options->run));
  FILE *in = file_open_read(path);
  while (in && fgets(line, sizeof line, in)) {
    if (strstr(line, "load []")) forces = PETSC_TRUE;
    read_line(line, curve);
  }
  if (in) fclose(in);
  if (curve->n > 1 && plot_folder(options->run, diag)) {
    const PetscReal across[] = {0, curve->displacement[curve->n - 1]}, height[] = {curve->most, curve->most};
    const FigureSeries series[] = {
      {.name = "load", .style = FIGURE_LINE_MARKS, .n = curve->n, .x = curve->displacement, .y = curve->load},
      {.name = "limit", .style = FIGURE_DASHES, .n = 2, .x = across, .y = height},
    };
    const Figure figure = {.title = "Limit load",
                           .x_label = "displacement [m]",
                           .y_label = forces ? "factor of the load" : "load [N]",
                           .n_series = 2,
                           .series = series};
    PetscCall(PetscSNPrintf(png, sizeof png, "%s/pictures/limit.png", options->run));
    PetscCall(FigureWrite(&figure, png, diag, &done));
    if (done && said) said(png);
  }
  PetscCall(PetscFree(curve));
  PetscFunctionReturn(0);
}
