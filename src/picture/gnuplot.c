#include "picture/gnuplot.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/wait.h>
#include <unistd.h>
#include "base/process/child.h"
#include "output/directory/run_dir_files.h"
#include "picture/label.h"

/* Terminals by the ending of the file; fonts have the size that they have in a PNG. */
static const struct Format {
  const char *ending, *terminal;
  double unit; /* of its sizes, pixels; fonts are in points in all */
} formats[] = {{".png", "pngcairo truecolor", 1},
               {".svg", "svg dynamic background rgb 'white'", 1},
               {".pdf", "pdfcairo", 96},
               {".gif", "gif animate delay 10 loop 0 optimize", 1},
               {".mp4", "gif animate delay 10 loop 0 optimize", 1}};
enum { N_FORMATS = sizeof formats / sizeof formats[0] };

static const struct Format *format_of(const char *path)
{
  const char *ending = strrchr(path, '.');
  for (int k = 0; k < N_FORMATS && ending; ++k)
    if (!strcasecmp(ending, formats[k].ending)) return &formats[k];
  return NULL;
}

PetscBool gnuplot_knows(const char *path) { return format_of(path) != NULL; }

PetscErrorCode GnuplotBegin(GnuplotScript *script, const char *path, int width, int height)
{
  const struct Format *format = gnuplot_knows(path) ? format_of(path) : &formats[0];
  char unfinished[FILE_PATH];

  PetscFunctionBeginUser;
  script->out = tmpfile();
  PetscCheck(script->out, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "Cannot make a temporary file: %s", strerror(errno));
  fprintf(script->out, "set encoding utf8\nset terminal %s noenhanced size %g,%g font 'DejaVu Sans,%g'\n",
          format->terminal, width / format->unit, height / format->unit,
          (height >= 600 ? 13 : 12) * label_scale(width, height));
  PetscCall(PetscSNPrintf(unfinished, sizeof unfinished, "%s" FILE_UNFINISHED, path));
  (void)unlink(unfinished); /* a link would be written through */
  fputs("set output ", script->out);
  gnuplot_quote(script->out, unfinished);
  fputc('\n', script->out);
  PetscFunctionReturn(0);
}

void gnuplot_quote(FILE *out, const char *text)
{
  fputc('"', out);
  for (const char *c = text; *c; ++c) {
    /* a backquote would run a command */
    if (strchr("\"\\`", *c)) fprintf(out, "\\%03o", (unsigned char)*c);
    else fputc((unsigned char)*c < ' ' ? ' ' : *c, out);
  }
  fputc('"', out);
}

PetscBool gnuplot_has_program(const char *name)
{
  const char *paths = getenv("PATH");
  char path[FILE_PATH];
  for (size_t n; paths && *paths; paths += n + (paths[n] == ':')) {
    n = strcspn(paths, ":");
    snprintf(path, sizeof path, "%.*s/%s", (int)n, paths, name);
    if (!access(path, X_OK)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* What gnuplot says first that is neither blank nor the echo of its input. */
static void first_complaint(FILE *complaints, char text[256])
{
  char line[256];
  rewind(complaints);
  text[0] = 0;
  while (fgets(line, sizeof line, complaints))
    if (strstr(line, "line ") || !text[0])
      snprintf(text, 256, "%.*s", (int)strcspn(line, "\n"), line + strspn(line, " \t"));
}

/* "no such codec, it was killed by signal 9 (Killed)" */
static void tell_failure(const char *program, const char *complaint, int status, Diag *diag)
{
  char end[128];
  child_end(status, sizeof end, end);
  const PetscBool both = complaint[0] && WIFSIGNALED(status);
  diag_error(diag, NULL, "%s could not draw the picture: %s%s%s", program, complaint, both ? ", " : "",
             both || !complaint[0] ? end : "");
}

/* Let a program do its part of the picture. */
static PetscBool run_program(char *const *arguments, FILE *input, Diag *diag)
{
  char text[256];
  int status = 0;
  FILE *complaints = tmpfile();
  const int error = complaints ? child_run(arguments, environ, input, complaints, complaints, &status) : EMFILE;
  if (error) {
    diag_error(diag, NULL, "cannot start %s, which draws the pictures: %s", arguments[0], strerror(error));
    diag_hint(diag, "install it: apt install %s", strcmp(arguments[0], "gnuplot") ? arguments[0] : "gnuplot-nox");
    if (complaints) fclose(complaints);
    return PETSC_FALSE;
  }
  const PetscBool ran = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  first_complaint(complaints, text);
  if (!ran) tell_failure(arguments[0], text, status, diag);
  fclose(complaints);
  return ran;
}

/* The frames of a GIF as a film with its final name and .film; sizes of films are even. */
static PetscBool make_film(char *gif, char *film, FILE *nothing, Diag *diag)
{
  char *const arguments[] = {(char[]){"ffmpeg"},
                             (char[]){"-y"},
                             (char[]){"-loglevel"},
                             (char[]){"error"},
                             (char[]){"-f"},
                             (char[]){"gif"},
                             (char[]){"-i"},
                             gif,
                             (char[]){"-movflags"},
                             (char[]){"+faststart"},
                             (char[]){"-pix_fmt"},
                             (char[]){"yuv420p"},
                             (char[]){"-vf"},
                             (char[]){"crop=trunc(iw/2)*2:trunc(ih/2)*2"},
                             (char[]){"-f"},
                             (char[]){"mp4"},
                             film,
                             NULL};
  return run_program(arguments, nothing, diag);
}

static void tell_unwritable(const char *path, int error, Diag *diag)
{
  diag_error(diag, NULL, "cannot write the picture '%s': %s", path, strerror(error));
}

/* Gnuplot says of no file which it could not open, nor why. */
static PetscBool can_write(const char *unfinished, const char *path, Diag *diag)
{
  FILE *file = fopen(unfinished, "wb");
  if (!file) tell_unwritable(path, errno, diag);
  else fclose(file);
  return (PetscBool)(file != NULL);
}

PetscErrorCode GnuplotEnd(GnuplotScript *script, const char *path, Diag *diag, PetscBool *done)
{
  char *const arguments[] = {(char[]){"gnuplot"}, (char[]){"-d"}, (char[]){"-"}, NULL};
  char unfinished[FILE_PATH], film[FILE_PATH];
  const struct Format *format = format_of(path);

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(unfinished, sizeof unfinished, "%s" FILE_UNFINISHED, path));
  PetscCall(PetscSNPrintf(film, sizeof film, "%s.film" FILE_UNFINISHED, path));
  *done = !fflush(script->out) && !ferror(script->out);
  if (!*done) diag_error(diag, NULL, "no room for temporary files: %s", strerror(errno));
  rewind(script->out);
  *done = *done && can_write(unfinished, path, diag) && run_program(arguments, script->out, diag);
  if (*done && format && !strcmp(format->ending, ".mp4")) {
    (void)unlink(film);
    *done = make_film(unfinished, film, script->out, diag);
    (void)file_commit(film, unfinished, *done ? 0 : ECANCELED);
  }
  const int error = file_commit(unfinished, path, *done ? 0 : ECANCELED);
  if (*done && error) tell_unwritable(path, error, diag);
  *done = *done && !error;
  fclose(script->out);
  PetscFunctionReturn(0);
}
