/* The list of files and their times that ParaView reads: JSON with one entry a line, so that it is
 * edited without a parser. */
#include "output/vtk/vtk_series.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include "output/directory/run_dir_files.h"
#include "output/vtk/vtk.h"

/* `{"name": "points_000001.hdf", "time": 0.5},`: a file beside the list, and a time. */
static PetscBool parse_entry(const char *line, char file[VTK_SERIES_NAME], PetscReal *time)
{
  const char *name = strstr(line, "\"name\":"), *at = strstr(line, "\"time\":");
  char *end;
  if (!name || !at || !(name = strchr(name + 7, '"'))) return PETSC_FALSE;
  const size_t n = strcspn(name + 1, "\"");
  if (n == 0 || n >= VTK_SERIES_NAME) return PETSC_FALSE;
  memcpy(file, name + 1, n);
  file[n] = 0;
  *time = (PetscReal)strtod(at + 7, &end);
  return !(end == at + 7 || PetscIsInfOrNanReal(*time) || strchr(file, '/'));
}

static void write_entry(FILE *out, PetscBool first, const char *file, PetscReal time)
{
  char number[32];
  file_format_real(time, number);
  fprintf(out, "%s    {\"name\": \"%s\", \"time\": %s}", first ? "" : ",\n", file, number);
}

/* The number in grid_000012.hdf; 0 where there is none. */
static long state_number(const char *file)
{
  const char *number = strrchr(file, '_');
  return number ? strtol(number + 1, NULL, 10) : 0;
}

/* Does the entry stand before the new one? States that have a number by that: times of a search lie behind those of the
 * stage after it. */
static PetscBool stands_before(const char *name, PetscReal t, const char *file, PetscReal time)
{
  if (file && strrchr(file, '_')) return (PetscBool)(state_number(name) < state_number(file));
  return (PetscBool)(t < time - 1e-12 * PetscAbsReal(time)); /* but for the last bits of a sum of steps */
}

/* Entries that stand before the new one, of states before number `most`, then it. */
static PetscInt rewrite(FILE *old, FILE *out, const char *file, PetscReal time, PetscInt most)
{
  char line[1024], name[VTK_SERIES_NAME];
  PetscInt kept = 0;
  PetscReal t;
  fputs("{\n  \"file-series-version\": \"1.0\",\n  \"files\": [\n", out);
  while (old && kept < most && fgets(line, sizeof line, old)) {
    if (!parse_entry(line, name, &t) || !stands_before(name, t, file, time) || state_number(name) >= most) continue;
    write_entry(out, kept == 0, name, t);
    ++kept;
  }
  if (file) write_entry(out, kept == 0, file, time);
  fputs("\n  ]\n}\n", out);
  return kept;
}

/* ENODATA: there were less than `least` entries. */
static int rewrite_file(const char *path, const char *file, PetscReal time, PetscInt least, PetscInt most)
{
  char unfinished[FILE_PATH];
  snprintf(unfinished, sizeof unfinished, "%s" FILE_UNFINISHED, path);
  FILE *old = file_open_read(path);
  if (!old && (errno != ENOENT || !file)) return errno != ENOENT ? errno : least ? ENODATA : 0;
  FILE *out = fopen(unfinished, "w");
  int error = out ? 0 : errno;
  if (out) {
    const PetscInt kept = rewrite(old, out, file, time, most);
    error = file_finish_stream(out);
    if (!error && kept < least) error = ENODATA;
    error = file_commit(unfinished, path, error);
  }
  if (old) fclose(old);
  return error;
}

static PetscErrorCode Edit(MPI_Comm comm, const char *folder, const char *name, const char *file, PetscReal time,
                           PetscInt least, PetscInt most, char reason[256])
{
  char path[PETSC_MAX_PATH_LEN];
  PetscMPIInt rank;
  int error = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s.hdf.series", folder, name));
  if (rank == 0) error = rewrite_file(path, file, time, least, most);
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, comm));
  reason[0] = 0;
  if (error) {
    snprintf(reason, 256, "%s", error == ENODATA ? "entries are missing" : strerror(error));
    PetscFunctionReturn(PETSC_ERR_FILE_WRITE);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode VtkSeriesAppend(MPI_Comm comm, const char *folder, const char *name, const char *file, PetscReal time,
                               char reason[256])
{
  PetscFunctionBeginUser;
  const PetscErrorCode code = Edit(comm, folder, name, file, time, 0, PETSC_MAX_INT, reason);
  PetscFunctionReturn(code);
}

PetscErrorCode VtkSeriesKeep(MPI_Comm comm, const char *folder, const char *name, PetscInt n, PetscBool all,
                             char reason[256])
{
  PetscFunctionBeginUser;
  const PetscErrorCode code = Edit(comm, folder, name, NULL, PETSC_MAX_REAL, all ? n : 0, n, reason);
  PetscFunctionReturn(code);
}

static PetscErrorCode AddState(VtkSeries *series, PetscInt *capacity, const char *file, PetscReal time)
{
  PetscFunctionBeginUser;
  if (series->n == *capacity) {
    *capacity = 2 * *capacity + 16;
    PetscCall(PetscRealloc((size_t)*capacity * sizeof *series->states, &series->states));
  }
  VtkState *state = &series->states[series->n++];
  snprintf(state->file, sizeof state->file, "%s", file);
  state->time = time;
  PetscFunctionReturn(0);
}

static PetscBool is_entry(const char *line)
{
  const char *start = line + strspn(line, " \t");
  return *start == '{' && start[1] && start[1] != '\n' && start[1] != '\r';
}

static PetscErrorCode ReadEntries(FILE *in, VtkSeries *series, char reason[256])
{
  char line[1024], file[VTK_SERIES_NAME];
  PetscInt capacity = 0;
  PetscReal time;

  PetscFunctionBeginUser;
  for (long number = 1; fgets(line, sizeof line, in) && !reason[0]; ++number) {
    if (!is_entry(line)) continue;
    if (parse_entry(line, file, &time)) PetscCall(AddState(series, &capacity, file, time));
    else snprintf(reason, 256, "line %ld names no file and its time", number);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode VtkSeriesRead(const char *folder, const char *name, VtkSeries *series, char reason[256])
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  *series = (VtkSeries){0};
  reason[0] = 0;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s.hdf.series", folder, name));
  FILE *in = file_open_read(path);
  if (!in && errno == ENOENT) PetscFunctionReturn(0);
  if (in) {
    PetscCall(ReadEntries(in, series, reason));
    fclose(in);
  } else snprintf(reason, 256, "%s", strerror(errno));
  if (!reason[0]) PetscFunctionReturn(0);
  PetscCall(VtkSeriesFree(series));
  PetscFunctionReturn(PETSC_ERR_FILE_UNEXPECTED);
}

PetscErrorCode VtkSeriesFree(VtkSeries *series)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(series->states));
  series->n = 0;
  PetscFunctionReturn(0);
}
