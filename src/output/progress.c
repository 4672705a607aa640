#include "output/progress.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include "output/directory/run_dir_impl.h"

/* Steps of the last half minute count most; in a long run those of its last tenth. */
void progress_update(ProgressClock *clock, const RunProgress *progress, PetscReal wall)
{
  if (!clock->started) {
    clock->started = PETSC_TRUE;
    clock->time = progress->time - progress->dt;
  }
  const PetscReal spent = wall - clock->wall, moved = progress->time - clock->time;
  if (spent <= 0) return;
  const PetscReal memory = PetscMax(30.0, 0.1 * wall), weight = clock->rate > 0 ? 1 - exp(-spent / memory) : 1;
  clock->rate += weight * (moved / spent - clock->rate);
  clock->wall = wall;
  clock->time = progress->time;
}

PetscReal progress_left(const ProgressClock *clock, const RunProgress *progress)
{
  if (!(clock->rate > 0)) return -1;
  return PetscMax(progress->end - progress->time, 0) / clock->rate;
}

void progress_duration(PetscReal seconds, char text[32])
{
  if (!(seconds >= 0 && seconds < 1e9)) {
    snprintf(text, 32, "?");
    return;
  }
  const long s = lround((double)seconds), days = s / 86400, hours = s % 86400 / 3600;
  if (days > 0) snprintf(text, 32, "%ld d %02ld:%02ld:%02ld", days, hours, s % 3600 / 60, s % 60);
  else snprintf(text, 32, "%ld:%02ld:%02ld", hours, s % 3600 / 60, s % 60);
}

void progress_line(const RunProgress *p, PetscReal left, char text[256])
{
  char duration[32];
  int n =
    snprintf(text, 256, "step = %" PetscInt_FMT " time = %.9g dt = %.6g iterations = %" PetscInt_FMT " residual = %.2g",
             p->step, (double)p->time, (double)p->dt, p->iterations, (double)p->residual);
  if (left < 0) return;
  progress_duration(left, duration);
  snprintf(text + n, 256 - (size_t)n, " left %s %s", p->earlier ? "<=" : "=", duration);
}

/* 950, 12.3k, 1.05M */
static void short_count(PetscInt n, char text[16])
{
  if (n < 1000) snprintf(text, 16, "%" PetscInt_FMT, n);
  else if (n < 1000000) snprintf(text, 16, "%.3gk", n / 1e3);
  else snprintf(text, 16, "%.3gM", n / 1e6);
}

void progress_bar(const RunProgress *p, PetscReal elapsed, PetscReal left, int width, char text[512])
{
  enum { PARTS = 6, BAR = 10 };
  char part[PARTS][64], count[16], spent[32], rest[32];
  const PetscReal done = p->end > 0 ? PetscMin(PetscMax(p->time / p->end, 0), 1) : 0;
  short_count(p->points, count);
  progress_duration(elapsed, spent);
  progress_duration(left, rest);
  snprintf(part[0], 64, " %3.0f %%", floor(100 * (double)done));
  snprintf(part[1], 64, "  left %s%s", p->earlier ? "<= " : "", rest);
  snprintf(part[2], 64, "  step %" PetscInt_FMT "  t %.6g s", p->step, (double)p->time);
  snprintf(part[3], 64, "  dt %.3g", (double)p->dt);
  snprintf(part[4], 64, "  %" PetscInt_FMT " it", p->iterations);
  snprintf(part[5], 64, "  %s points  %s", count, spent);
  int used = BAR + 2, parts = 0;
  width = PetscMin(width, 200);
  while (parts < PARTS && used + (int)strlen(part[parts]) <= width) used += (int)strlen(part[parts++]);
  const int bar = PetscMin(BAR + PetscMax(width - used, 0), 40), full = (int)(done * bar);
  int n = 0;
  text[n++] = '[';
  for (int i = 0; i < bar; ++i) text[n++] = i < full ? '#' : '-';
  text[n++] = ']';
  text[n] = 0;
  for (int i = 0; i < parts; ++i) n += snprintf(text + n, 512 - (size_t)n, "%s", part[i]);
}

PetscBool progress_on_terminal(void)
{
  const char *terminal = getenv("TERM");
  char link[64], target[16] = "";
  if (!isatty(STDOUT_FILENO) || (terminal && !strcmp(terminal, "dumb"))) return PETSC_FALSE;
  if (!getenv("OMPI_COMM_WORLD_SIZE")) return PETSC_TRUE;
  snprintf(link, sizeof link, "/proc/%d/fd/1", (int)getppid());
  if (readlink(link, target, sizeof target - 1) < 0) return PETSC_FALSE;
  return !strncmp(target, "/dev/pts/", 9) || !strncmp(target, "/dev/tty", 8) || !strncmp(target, "/dev/console", 12);
}

static int terminal_width(void)
{
  struct winsize size;
  return !ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) && size.ws_col > 0 ? size.ws_col - 1 : 79;
}

/* The last bar stays on the screen. */
static void show_bar(RunDir *dir, const RunProgress *progress, PetscReal wall, PetscReal left, PetscBool last)
{
  char text[512];
  progress_bar(progress, wall, left, terminal_width(), text);
  printf("\r%s\033[K%s", text, last ? "\n" : "");
  fflush(stdout);
  dir->bar = !last;
}

PetscErrorCode RunDirProgress(RunDir *dir, const RunProgress *progress)
{
  const PetscReal pause = dir->terminal ? 0.1 : 5.0; /* s between two showings */
  char line[256];

  PetscFunctionBeginUser;
  if (dir->rank > 0) PetscFunctionReturn(0);
  const PetscReal wall = MPI_Wtime() - dir->start;
  progress_update(&dir->clock, progress, wall);
  const PetscReal left = progress_left(&dir->clock, progress);
  progress_line(progress, left, line);
  if (dir->log) fprintf(dir->log, "%s\n", line);
  run_dir_note_log(dir);
  const PetscBool last = progress->last || progress->time >= progress->end * (1 - 1e-12);
  if (dir->quiet || !(last || dir->last_shown < 0 || wall - dir->last_shown >= pause)) PetscFunctionReturn(0);
  dir->last_shown = wall;
  if (dir->terminal) {
    show_bar(dir, progress, wall, left, last);
  } else {
    printf("%s\n", line);
    fflush(stdout);
  }
  PetscFunctionReturn(0);
}
