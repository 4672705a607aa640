#include "base/process/child.h"
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

int child_run(char *const *arguments, char *const *environment, FILE *input, FILE *output, FILE *complaints,
              int *status)
{
  posix_spawn_file_actions_t actions;
  pid_t pid = 0;
  int error = posix_spawn_file_actions_init(&actions);
  if (error) return error;
  if (input) (void)posix_spawn_file_actions_adddup2(&actions, fileno(input), STDIN_FILENO);
  else (void)posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  (void)posix_spawn_file_actions_adddup2(&actions, fileno(output), STDOUT_FILENO);
  (void)posix_spawn_file_actions_adddup2(&actions, fileno(complaints), STDERR_FILENO);
  error = posix_spawnp(&pid, arguments[0], &actions, NULL, arguments, environment);
  (void)posix_spawn_file_actions_destroy(&actions);
  if (error) return error;
  while (waitpid(pid, status, 0) < 0 && errno == EINTR) continue;
  /* how some C libraries say that there is no such program */
  return WIFEXITED(*status) && WEXITSTATUS(*status) == 127 ? ENOENT : 0;
}

void child_end(int status, size_t size, char *text)
{
  text[0] = '\0';
  if (WIFSIGNALED(status))
    (void)snprintf(text, size, "it was killed by signal %d (%s)", WTERMSIG(status), strsignal(WTERMSIG(status)));
  else if (WIFEXITED(status) && WEXITSTATUS(status))
    (void)snprintf(text, size, "it ended with code %d", WEXITSTATUS(status));
}

void child_first_line(FILE *complaints, size_t size, char *text)
{
  char line[256];
  rewind(complaints);
  text[0] = '\0';
  while (!text[0] && fgets(line, sizeof line, complaints))
    (void)snprintf(text, size, "%.*s", (int)strcspn(line, "\n"), line);
}
