/* Runs gmsh on a .geo: as a program of its own, without a shell, its words kept for the error
 * message. */
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>
#include "base/process/environment.h"
#include "grid/gmsh/msh.h"

#define OUTPUT_KEPT 4096

/* gmsh -2 file.geo -o out -format msh41 -bin -setnumber name value ... ; values get room of their
 * own. */
static PetscErrorCode Arguments(const char *path, PetscInt dim, PetscInt n_parameters, const NamedValue *parameters,
                                const char *output, char ***out, char **room)
{
  const PetscInt width = 32;
  PetscInt n = 0;
  char **argv;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(10 + 3 * n_parameters, out));
  PetscCall(PetscMalloc1(width * n_parameters, room));
  argv = *out;
  argv[n++] = (char *)"gmsh";
  argv[n++] = (char *)(dim == 3 ? "-3" : "-2");
  argv[n++] = (char *)path;
  argv[n++] = (char *)"-o";
  argv[n++] = (char *)output;
  argv[n++] = (char *)"-format";
  argv[n++] = (char *)"msh41";
  argv[n++] = (char *)"-bin";
  for (PetscInt p = 0; p < n_parameters; ++p) {
    (void)snprintf(*room + width * p, (size_t)width, "%.17g", (double)parameters[p].value);
    argv[n++] = (char *)"-setnumber";
    argv[n++] = parameters[p].name;
    argv[n++] = *room + width * p;
  }
  argv[n] = NULL;
  PetscFunctionReturn(0);
}

/* The last part of what comes through the pipe. */
static void read_tail(int fd, char tail[OUTPUT_KEPT])
{
  size_t used = 0;
  char chunk[1024];
  ssize_t got;
  while ((got = read(fd, chunk, sizeof chunk)) > 0 || (got < 0 && errno == EINTR)) {
    if (got < 0) continue;
    const size_t keep = PetscMin(used, OUTPUT_KEPT - 1 - (size_t)got);
    memmove(tail, tail + used - keep, keep);
    memcpy(tail + keep, chunk, (size_t)got);
    used = keep + (size_t)got;
  }
  tail[used] = 0;
}

/* gmsh marks its errors so; it may still exit with 0. */
static PetscBool complained(const char *tail) { return strstr(tail, "Error   :") != NULL; }

/* A line without the temporary file that nobody knows, and without Gmsh's "Info    :". */
static const char *line_text(const char *line, const char *output)
{
  const char *text = strchr(line, ':');
  if (!line[strspn(line, " -")] || strstr(line, output)) return NULL;
  return text && text[1] == ' ' ? text + 2 : line;
}

/* Up to three error lines, or else the last three lines, joined by "; ". */
static void quote_tail(char *tail, const char *output, size_t size, char *message)
{
  const PetscBool errors = complained(tail);
  const char *quoted[3] = {NULL, NULL, NULL};
  size_t used = strlen(message);
  int n = 0;
  for (char *line = strtok(tail, "\n"); line && !(errors && n == 3); line = strtok(NULL, "\n")) {
    const char *text = errors && !strstr(line, "Error") ? NULL : line_text(line, output);
    if (!text) continue;
    if (n == 3) quoted[0] = quoted[1], quoted[1] = quoted[2], --n;
    quoted[n++] = text;
  }
  for (int i = 0; i < n && used < size; ++i)
    used += (size_t)snprintf(message + used, size - used, "%s%s", i ? "; " : ": ", quoted[i]);
}

/* "it was killed by signal 11 (Segmentation fault)" */
static void tell_end(int status, size_t size, char *message)
{
  const size_t used = strlen(message);
  if (WIFSIGNALED(status))
    (void)snprintf(message + used, size - used, ", it was killed by signal %d (%s)", WTERMSIG(status),
                   strsignal(WTERMSIG(status)));
  else if (WIFEXITED(status) && WEXITSTATUS(status))
    (void)snprintf(message + used, size - used, ", it ended with code %d", WEXITSTATUS(status));
}

/* Start gmsh with its output going to the pipe; returns errno-like code. */
static int start(char *const *argv, char *const *environment, const int pipe_end[2], pid_t *child)
{
  posix_spawn_file_actions_t actions;
  int status = posix_spawn_file_actions_init(&actions);
  if (status) return status;
  (void)posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  (void)posix_spawn_file_actions_adddup2(&actions, pipe_end[1], 1);
  (void)posix_spawn_file_actions_adddup2(&actions, pipe_end[1], 2);
  (void)posix_spawn_file_actions_addclose(&actions, pipe_end[0]);
  (void)posix_spawn_file_actions_addclose(&actions, pipe_end[1]);
  status = posix_spawnp(child, "gmsh", &actions, NULL, argv, environment);
  (void)posix_spawn_file_actions_destroy(&actions);
  return status;
}

/* PETSC_TRUE if gmsh ended well; else the message says why. */
static PetscBool run_gmsh(char *const *argv, char *const *environment, size_t size, char *message)
{
  char tail[OUTPUT_KEPT] = "";
  int ends[2], status = 0;
  pid_t child;
  if (pipe(ends)) {
    (void)snprintf(message, size, "cannot run gmsh: %s", strerror(errno));
    return PETSC_FALSE;
  }
  const int failed = start(argv, environment, ends, &child);
  (void)close(ends[1]);
  if (!failed) {
    read_tail(ends[0], tail);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  }
  (void)close(ends[0]);
  if (failed || (WIFEXITED(status) && WEXITSTATUS(status) == 127)) {
    (void)snprintf(message, size, "a .geo file needs the program gmsh, which cannot be run: %s",
                   strerror(failed ? failed : ENOENT));
    return PETSC_FALSE;
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && !complained(tail)) return PETSC_TRUE;
  (void)snprintf(message, size, "gmsh could not mesh '%s'", argv[2]);
  tell_end(status, size, message);
  quote_tail(tail, argv[4], size, message);
  return PETSC_FALSE;
}

PetscErrorCode GeoRun(const char *path, PetscInt dim, PetscInt n_parameters, const NamedValue *parameters, size_t size,
                      char *output, size_t message_size, char *message)
{
  const char *folder = getenv("TMPDIR");
  char **argv, **environment, *room;

  PetscFunctionBeginUser;
  message[0] = 0;
  (void)snprintf(output, size, "%s/talus-XXXXXX.msh", folder && *folder ? folder : "/tmp");
  const int fd = mkstemps(output, 4);
  if (fd < 0) {
    (void)snprintf(message, message_size, "cannot make a temporary file '%s': %s", output, strerror(errno));
    output[0] = 0;
    PetscFunctionReturn(0);
  }
  (void)close(fd);
  PetscCall(Arguments(path, dim, n_parameters, parameters, output, &argv, &room));
  PetscCall(EnvironmentForChild(0, &environment));
  if (!run_gmsh(argv, environment, message_size, message)) {
    (void)unlink(output);
    output[0] = 0;
  }
  PetscCall(PetscFree(argv));
  PetscCall(PetscFree(room));
  PetscCall(PetscFree(environment));
  PetscFunctionReturn(0);
}
