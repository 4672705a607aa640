#include "picture/gnuplot.h"
#include <errno.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "output/directory/run_dir_files.h"

PetscErrorCode GnuplotBegin(GnuplotScript *script, const char *png, int width, int height)
{
  char unfinished[FILE_PATH];

  PetscFunctionBeginUser;
  script->text = NULL;
  script->size = 0;
  script->out = open_memstream(&script->text, &script->size);
  PetscCheck(script->out, PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for a script");
  fprintf(script->out,
          "set encoding utf8\nset terminal pngcairo noenhanced truecolor size %d,%d font 'DejaVu Sans,%d'\n", width,
          height, height >= 600 ? 13 : 12);
  PetscCall(PetscSNPrintf(unfinished, sizeof unfinished, "%s" FILE_UNFINISHED, png));
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

/* Start gnuplot with these files as its input and its complaints; returns 0 or an errno. */
static int gnuplot_spawn(FILE *input, FILE *complaints, pid_t *pid)
{
  char *const arguments[] = {(char[]){"gnuplot"}, (char[]){"-d"}, (char[]){"-"}, NULL};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(input), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(complaints), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(complaints), STDERR_FILENO);
  const int error = posix_spawnp(pid, "gnuplot", &actions, NULL, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  return error;
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

static PetscBool run_script(const GnuplotScript *script, FILE *input, FILE *complaints, Diag *diag)
{
  char text[256];
  pid_t pid;
  int status = 0;
  if (fwrite(script->text, 1, script->size, input) != script->size || fflush(input)) {
    diag_error(diag, NULL, "no room for temporary files: %s", strerror(errno));
    return PETSC_FALSE;
  }
  rewind(input);
  const int error = gnuplot_spawn(input, complaints, &pid);
  if (error) {
    diag_error(diag, NULL, "cannot start gnuplot, which draws the pictures: %s", strerror(error));
    diag_hint(diag, "install it: apt install gnuplot-nox");
    return PETSC_FALSE;
  }
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) continue;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return PETSC_TRUE;
  first_complaint(complaints, text);
  diag_error(diag, NULL, "gnuplot could not draw the picture: %s", text);
  return PETSC_FALSE;
}

PetscErrorCode GnuplotEnd(GnuplotScript *script, const char *png, Diag *diag, PetscBool *done)
{
  char unfinished[FILE_PATH];
  FILE *input = tmpfile(), *complaints = tmpfile();

  PetscFunctionBeginUser;
  *done = PETSC_FALSE;
  PetscCall(PetscSNPrintf(unfinished, sizeof unfinished, "%s" FILE_UNFINISHED, png));
  PetscCheck(!fclose(script->out), PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for a script");
  if (input && complaints) {
    const PetscBool ran = run_script(script, input, complaints, diag);
    const int error = file_commit(unfinished, png, ran ? 0 : ECANCELED);
    if (ran && error) diag_error(diag, NULL, "cannot write the picture '%s': %s", png, strerror(error));
    *done = ran && !error;
  } else {
    diag_error(diag, NULL, "cannot make a temporary file: %s", strerror(errno));
  }
  if (input) fclose(input);
  if (complaints) fclose(complaints);
  free(script->text);
  PetscFunctionReturn(0);
}
