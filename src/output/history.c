#include <errno.h>
#include <stdio_ext.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>
#include "base/text.h"
#include "output/directory/run_dir_files.h"
#include "output/directory/run_dir_impl.h"

/* A name with a comma or a quote is quoted, as spreadsheets want it. */
static void write_name(FILE *out, const char *name, const char *unit)
{
  const PetscBool quote = strpbrk(name, ",\"") != NULL;
  if (quote) fputc('"', out);
  for (const char *c = name; *c; ++c) fputs(*c == '"' ? "\"\"" : (char[2]){*c, 0}, out);
  if (unit && unit[0]) fprintf(out, " [%s]", unit);
  if (quote) fputc('"', out);
}

static void write_header(FILE *out, PetscInt n, const char *const *names, const char *const *units)
{
  fputs("time [s],step", out);
  for (PetscInt i = 0; i < n; ++i) {
    fputc(',', out);
    write_name(out, names[i], units ? units[i] : NULL);
  }
  fputc('\n', out);
}

static int history_open(RunDir *dir, const char *mode)
{
  char path[FILE_PATH];
  snprintf(path, sizeof path, "%s/history.csv", dir->path);
  if (dir->history) fclose(dir->history);
  dir->history = fopen(path, mode);
  return dir->history ? 0 : errno;
}

/* Take note of text that now stands at the end of the file. */
static void mark_text(HistoryMark *mark, const char *text, size_t n)
{
  const uLong crc = mark->bytes ? (uLong)mark->crc : crc32(0, Z_NULL, 0);
  mark->crc = (PetscInt64)crc32(crc, (const Bytef *)text, (uInt)n);
  mark->bytes += (PetscInt64)n;
  ++mark->lines;
}

/* Push the row to the system: a run that dies has its history. A row that did not fit is cut off
 * again. */
static int flush(FILE *file, off_t before)
{
  errno = 0;
  if (!fflush(file) && !ferror(file)) return 0;
  const int error = errno ? errno : EIO;
  __fpurge(file);
  clearerr(file);
  return before > 0 && ftruncate(fileno(file), before) ? errno : error;
}

static PetscErrorCode HeaderText(PetscInt n, const char *const *names, const char *const *units, char **header)
{
  TextStream stream;

  PetscFunctionBeginUser;
  PetscCall(TextOpen(&stream));
  write_header(stream.out, n, names, units);
  PetscCall(TextClose(&stream, header));
  PetscFunctionReturn(0);
}

PetscErrorCode HistoryOpen(RunDir *dir, PetscInt n, const char *const *names, const char *const *units)
{
  char *header;
  int error = 0;

  PetscFunctionBeginUser;
  dir->n_measures = n;
  dir->mark = (HistoryMark){0};
  PetscCall(HeaderText(n, names, units, &header));
  if (dir->rank == 0) {
    error = history_open(dir, "w");
    if (!error) fputs(header, dir->history);
    if (!error) error = flush(dir->history, 0);
    if (!error) mark_text(&dir->mark, header, strlen(header));
  }
  PetscCall(PetscFree(header));
  const PetscErrorCode status = RunDirAgree(dir, "history.csv", error);
  PetscFunctionReturn(status);
}

/* Copy the rows up to that of `last`; a row that was cut off is dropped too, and one that says once
 * more what became of step `last` when all was known, after `was`. Returns the step of the last one
 * copied, -1 if there is none. */
static long long copy_rows(FILE *old, FILE *out, PetscInt last, const HistoryMark *was, HistoryMark *mark)
{
  char *line = NULL, *end;
  size_t size = 0;
  long long copied = -1;
  for (ssize_t n = getline(&line, &size, old); n > 0; n = getline(&line, &size, old)) {
    (void)strtod(line, &end);
    if (end == line || *end != ',' || line[n - 1] != '\n') continue;
    const long long step = strtoll(end + 1, NULL, 10);
    if (step > last || (step == copied && was && mark->lines >= was->lines)) continue;
    fputs(line, out);
    mark_text(mark, line, (size_t)n);
    copied = step;
  }
  free(line);
  return copied;
}

/* Does the old file start with our header? */
static PetscBool same_header(FILE *old, const char *header)
{
  char *line = NULL;
  size_t size = 0;
  const PetscBool same = getline(&line, &size, old) > 0 && !strcmp(line, header);
  free(line);
  return same;
}

/* Are the rows that were kept those that the run wrote, and all of them? `was`: NULL if nobody
 * knows. */
static PetscBool check_rows(const char *path, PetscInt step, long long copied, const HistoryMark *is,
                            const HistoryMark *was, Diag *diag)
{
  const PetscInt errors = diag_errors(diag);
  if (step >= 0 && copied != step)
    diag_error(diag, NULL, "'%s' has lost rows: the one of step %lld is missing", path, (long long)step);
  else if (was && is->lines < was->lines)
    diag_error(diag, NULL, "'%s' has lost rows: up to step %lld there are %lld, and there were %lld", path,
               (long long)step, (long long)is->lines - 1, (long long)was->lines - 1);
  else if (was && (is->lines != was->lines || is->bytes != was->bytes || is->crc != was->crc))
    diag_error(diag, NULL, "'%s' is not as the run wrote it: rows up to step %lld have been changed", path,
               (long long)step);
  if (diag_errors(diag) == errors) return PETSC_TRUE;
  diag_hint(diag, "put the file back as it was, or start the run again in another directory: --out OTHER");
  return PETSC_FALSE;
}

static int keep_rows(const char *path, const char *header, PetscInt step, const HistoryMark *was, HistoryMark *mark,
                     Diag *diag)
{
  char unfinished[FILE_PATH + 16];
  FILE *old = file_open_read(path), *out = NULL;
  long long copied = -1;
  int error = 0;
  *mark = (HistoryMark){0};
  snprintf(unfinished, sizeof unfinished, "%s" FILE_UNFINISHED, path);
  if (!old && errno != ENOENT) return errno;
  if (old && !same_header(old, header)) {
    diag_error(diag, NULL, "the measures differ from those of '%s': the run cannot go on there", path);
    fclose(old);
    return 0;
  }
  out = fopen(unfinished, "w");
  error = out ? 0 : errno;
  if (out) {
    fputs(header, out);
    mark_text(mark, header, strlen(header));
    if (old) copied = copy_rows(old, out, step, was, mark);
    if (old && ferror(old)) error = EIO;
    const int closing = file_finish_stream(out);
    if (!error) error = closing;
  }
  if (old) fclose(old);
  if (!error && !check_rows(path, step, copied, mark, was, diag)) {
    unlink(unfinished);
    return 0;
  }
  return file_commit(unfinished, path, error);
}

PetscErrorCode HistoryOpenFrom(RunDir *dir, PetscInt n, const char *const *names, const char *const *units,
                               PetscInt step, const HistoryMark *was, Diag *diag)
{
  const PetscInt errors = diag_errors(diag);
  char path[FILE_PATH], *header;
  int error = 0;

  PetscFunctionBeginUser;
  dir->n_measures = n;
  snprintf(path, sizeof path, "%s/history.csv", dir->path);
  PetscCall(HeaderText(n, names, units, &header));
  if (dir->rank == 0) error = keep_rows(path, header, step, was, &dir->mark, diag);
  if (dir->rank == 0 && !error && diag_errors(diag) == errors) error = history_open(dir, "a");
  PetscCall(PetscFree(header));
  const PetscErrorCode status = RunDirAgree(dir, "history.csv", error);
  PetscFunctionReturn(status);
}

PetscErrorCode HistorySync(RunDir *dir)
{
  int error = 0;

  PetscFunctionBeginUser;
  if (dir->rank == 0 && dir->history && fsync(fileno(dir->history)) && errno != EINVAL) error = errno;
  const PetscErrorCode status = RunDirAgree(dir, "history.csv", error);
  PetscFunctionReturn(status);
}

PetscErrorCode HistoryGetMark(const RunDir *dir, HistoryMark *mark)
{
  PetscFunctionBeginUser;
  *mark = dir->mark;
  PetscCallMPI(MPI_Bcast(mark, (PetscMPIInt)sizeof *mark, MPI_BYTE, 0, dir->comm));
  PetscFunctionReturn(0);
}

static void write_row(FILE *out, PetscReal time, PetscInt step, PetscInt n, const PetscReal *values,
                      const PetscBool *there)
{
  char number[32];
  file_format_real(time, number);
  fprintf(out, "%s,%" PetscInt_FMT, number, step);
  for (PetscInt i = 0; i < n; ++i) {
    file_format_real(values[i], number);
    fprintf(out, ",%s", !there || there[i] ? number : "");
  }
  fputc('\n', out);
}

/* Rank 0: a row, as far as the system. */
static PetscErrorCode AddRow(RunDir *dir, PetscReal time, PetscInt step, const PetscReal *values,
                             const PetscBool *there, int *error)
{
  const off_t before = ftello(dir->history);
  TextStream stream;
  char *row;

  PetscFunctionBeginUser;
  PetscCall(TextOpen(&stream));
  write_row(stream.out, time, step, dir->n_measures, values, there);
  PetscCall(TextClose(&stream, &row));
  fputs(row, dir->history);
  *error = flush(dir->history, before);
  if (!*error) mark_text(&dir->mark, row, strlen(row));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}

PetscErrorCode HistoryWrite(RunDir *dir, PetscReal time, PetscInt step, const PetscReal *values, const PetscBool *there)
{
  int error = 0;

  PetscFunctionBeginUser;
  if (dir->rank == 0) {
    error = dir->history ? run_dir_present(dir) : EBADF;
    if (!error) PetscCall(AddRow(dir, time, step, values, there, &error));
  }
  const PetscErrorCode status = RunDirAgree(dir, "history.csv", error);
  PetscFunctionReturn(status);
}
