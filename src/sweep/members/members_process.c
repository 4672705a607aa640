/* A member's process: `talus run` in a group of its own, so that Ctrl-C comes to the sweep alone,
 * which asks its members to leave once. If the sweep itself is killed, they are asked by the
 * system. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include "base/process/environment.h"
#include "material/plugin/plugin.h"
#include "output/directory/run_dir_files.h"
#include "run/report/summary.h"
#include "sweep/members/members.h"

/* talus run CASE --out DIR --set ..., or talus run --resume DIR. Strings stay where they are. */
static PetscErrorCode Arguments(const Members *members, const Member *m, char ***out)
{
  PetscInt n = 0;
  char **a;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * m->set.n + 10 + PLUGIN_MOST, out));
  a = *out;
  a[n++] = (char *)"talus";
  a[n++] = (char *)"run";
  a[n++] = (char *)"--quiet";
  if (members->trust) a[n++] = (char *)"--trust";
  for (const char *const *law = plugin_words(); *law; ++law) a[n++] = (char *)*law;
  if (m->resume) a[n++] = (char *)"--resume", a[n++] = (char *)m->folder;
  else {
    a[n++] = (char *)m->file;
    a[n++] = (char *)"--out", a[n++] = (char *)m->folder;
    if (m->replace) a[n++] = (char *)"--force";
    for (PetscInt i = 0; i < m->set.n; ++i) a[n++] = (char *)"--set", a[n++] = m->set.text[i];
  }
  a[n] = NULL;
  PetscFunctionReturn(0);
}

/* Put "NAME=value" in the place of what has that name, or at the end. */
static void set_variable(char **environment, char *variable)
{
  const size_t length = strcspn(variable, "=") + 1;
  PetscInt n = 0;
  while (environment[n] && strncmp(environment[n], variable, length)) ++n;
  if (!environment[n]) environment[n + 1] = NULL;
  environment[n] = variable;
}

/* Ours, with the options of PETSc from our own command line. *own: to be freed after use. */
static PetscErrorCode Environment(char ***out, char **own)
{
  char *options;

  PetscFunctionBeginUser;
  PetscCall(EnvironmentForChild(1, out));
  PetscCall(PetscOptionsGetAll(NULL, &options));
  const size_t size = strlen(options) + 32;
  PetscCall(PetscMalloc1(size, own));
  PetscCall(PetscSNPrintf(*own, size, "PETSC_OPTIONS=%s", options));
  PetscCall(PetscFree(options));
  set_variable(*out, *own);
  PetscFunctionReturn(0);
}

static void said_file(const Member *m, char path[FILE_PATH]) { snprintf(path, FILE_PATH, "%s.txt", m->folder); }

/* In the child: become the member. What cannot be said otherwise is an exit code. */
static void become(const char *said, char *const *arguments, char *const *environment)
{
  const int in = open("/dev/null", O_RDONLY), out = open("/dev/null", O_WRONLY);
  const int err = open(said, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (in >= 0) dup2(in, STDIN_FILENO);
  if (out >= 0) dup2(out, STDOUT_FILENO);
  if (err >= 0) dup2(err, STDERR_FILENO);
  execve("/proc/self/exe", arguments, environment);
  _exit(127);
}

PetscErrorCode MemberStart(const Members *members, Member *m)
{
  char **arguments, **environment, *own, said[FILE_PATH];

  PetscFunctionBeginUser;
  PetscCall(Arguments(members, m, &arguments));
  PetscCall(Environment(&environment, &own));
  said_file(m, said);
  m->begun = m->resume ? member_share(m) : 0;
  fflush(NULL);
  const pid_t pid = fork();
  if (pid == 0) become(said, arguments, environment);
  m->pid = (PetscInt)pid;
  m->state = pid < 0 ? MEMBER_CRASHED : MEMBER_RUNNING;
  if (pid < 0) PetscCall(PetscSNPrintf(m->why, sizeof m->why, "no process could be started: %s", strerror(errno)));
  PetscCall(PetscFree(own));
  PetscCall(PetscFree(environment));
  PetscCall(PetscFree(arguments));
  PetscFunctionReturn(0);
}

void members_stop(const Members *members)
{
  for (PetscInt i = 0; i < members->n; ++i)
    if (members->member[i].state == MEMBER_RUNNING) kill((pid_t)members->member[i].pid, SIGTERM);
}

/* The first error that the run told, else its first words; an empty file goes. */
static void read_said(Member *m)
{
  char path[FILE_PATH], line[512];
  struct stat info;
  said_file(m, path);
  FILE *in = file_open_read(path);
  while (in && fgets(line, sizeof line, in)) {
    const char *error = strstr(line, "error: ");
    line[strcspn(line, "\n")] = '\0';
    if (!m->why[0] || error) PetscStrncpy(m->why, error ? error + 7 : line, sizeof m->why);
    if (error) break;
  }
  if (in) fclose(in);
  if (!stat(path, &info) && info.st_size == 0) unlink(path);
}

static void read_end(Member *m, int status)
{
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  m->why[0] = '\0';
  read_said(m);
  if (code == 1) m->state = strstr(m->why, "was interrupted") ? MEMBER_INTERRUPTED : MEMBER_GAVE_UP;
  else if (code == 2) m->state = MEMBER_BAD_INPUT;
  else m->state = MEMBER_CRASHED;
  if (WIFSIGNALED(status) && !m->why[0])
    snprintf(m->why, sizeof m->why, "killed by signal %d (%s)", WTERMSIG(status), strsignal(WTERMSIG(status)));
  else if (!m->why[0]) snprintf(m->why, sizeof m->why, "it ended with code %d", code);
}

PetscErrorCode MemberLook(const Members *members, Member *m, PetscBool *ended)
{
  int status;

  PetscFunctionBeginUser;
  *ended = waitpid((pid_t)m->pid, &status, WNOHANG) == (pid_t)m->pid;
  if (!*ended) PetscFunctionReturn(0);
  read_end(m, status);
  summary_read(m->folder, &m->summary);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    m->why[0] = '\0'; /* warnings, if anything */
    PetscCall(MemberRead(members, m));
  }
  PetscFunctionReturn(0);
}

PetscReal member_share(const Member *m)
{
  char path[FILE_PATH], tail[4096];
  struct stat info;
  PetscReal time = 0;
  snprintf(path, sizeof path, "%s/history.csv", m->folder);
  const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return 0;
  if (!fstat(fd, &info) && S_ISREG(info.st_mode)) {
    const off_t from = PetscMax((off_t)0, info.st_size - (off_t)sizeof tail + 1);
    const ssize_t n = pread(fd, tail, sizeof tail - 1, from);
    tail[PetscMax(n, 0)] = '\0';
    char *end = strrchr(tail, '\n'); /* of the last whole row */
    if (end) *end = '\0', end = strrchr(tail, '\n');
    if (end) time = (PetscReal)strtod(end + 1, NULL);
  }
  close(fd);
  return m->end > 0 ? PetscMin(PetscMax(time / m->end, 0), 1) : 0;
}
