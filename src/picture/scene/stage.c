/* The stage of a run that a state belongs to. */
#include "picture/scene/stage.h"
#include <stdlib.h>
#include <string.h>
#include "output/directory/run_dir_files.h"

PetscBool plot_stage_at(const char *run, PetscReal time, PetscInt number, char name[64])
{
  char path[FILE_PATH], line[256];
  snprintf(path, sizeof path, "%s/stages.csv", run);
  FILE *in = file_exists(run, "stages.csv") ? file_open_read(path) : NULL;
  name[0] = '\0';
  while (in && fgets(line, sizeof line, in)) {
    const char *begins = strchr(line, ','), *called = begins ? strchr(begins + 1, ',') : NULL;
    char *end = NULL;
    line[strcspn(line, "\n")] = '\0';
    const double from = called ? strtod(begins + 1, &end) : 0;
    if (!called || end == begins + 1) continue; /* the header */
    if (number && strtol(line, NULL, 10) > number) break;
    if (!number && name[0] && time <= from * (1 + 1e-9)) break; /* a state at the end of a stage is of that stage */
    snprintf(name, 64, "%.63s", called + 1);
  }
  if (in) fclose(in);
  return name[0] != '\0';
}
