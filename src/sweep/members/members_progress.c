#include <string.h>
#include "output/progress.h"
#include "sweep/members/members.h"

/* Seconds left, from how much of all runs was done since the beginning; < 0: not known yet. */
static PetscReal seconds_left(const Members *members, PetscReal elapsed, PetscReal *share)
{
  PetscReal done = 0, rest = 0;
  for (PetscInt i = 0; i < members->n; ++i) {
    const Member *m = &members->member[i];
    if (m->kept) continue;
    if (m->state == MEMBER_WAITING) rest += 1;
    else if (m->state == MEMBER_RUNNING) {
      const PetscReal now = member_share(m);
      done += PetscMax(now - m->begun, 0);
      rest += 1 - now;
    } else done += 1 - m->begun;
  }
  *share = 1 - rest / (PetscReal)PetscMax(members->n, 1);
  return done > 0 ? elapsed * rest / done : -1;
}

static PetscInt n_ended(const Members *members)
{
  return members->n - members_count(members, MEMBER_WAITING) - members_count(members, MEMBER_RUNNING);
}

static void tell_values(FILE *out, const Member *m)
{
  char name[128];
  for (PetscInt k = 0; k < PetscMin(m->n_taken, 6); ++k)
    fprintf(out, "%s = %.5g %s, ", taken_name_among(&m->taken[k], m->n_taken, m->taken, name), (double)m->values[k],
            m->units[k]);
}

void members_tell_end(const Members *members, const Member *m, PetscReal elapsed)
{
  char left[32], spent[32];
  PetscReal share;
  members_wipe(members);
  progress_duration(seconds_left(members, elapsed, &share), left);
  progress_duration(m->summary.seconds, spent);
  fprintf(members->out, "%" PetscInt_FMT " of %" PetscInt_FMT "  %s: ", n_ended(members), members->n, m->name);
  if (m->state == MEMBER_DONE) {
    tell_values(members->out, m);
    fprintf(members->out, "%" PetscInt_FMT " steps, %" PetscInt_FMT " halvings, %s", m->summary.steps,
            m->summary.halvings, spent);
  } else fprintf(members->out, "%s: %.160s%s", member_states[m->state], m->why, strlen(m->why) > 160 ? "..." : "");
  fprintf(members->out, n_ended(members) < members->n && !members->stopped ? "; left %s\n" : "\n", left);
  fflush(members->out);
}

void members_show(const Members *members, PetscReal elapsed)
{
  enum { BAR = 20 };
  char bar[BAR + 1], left[32];
  PetscReal share;
  if (members->out != stdout || !progress_on_terminal()) return;
  progress_duration(seconds_left(members, elapsed, &share), left);
  for (int i = 0; i < BAR; ++i) bar[i] = i < (int)(share * BAR) ? '#' : '-';
  bar[BAR] = '\0';
  fprintf(members->out,
          "\r[%s] %3.0f %%  left %s  %" PetscInt_FMT " of %" PetscInt_FMT ", %" PetscInt_FMT " running\033[K", bar,
          100 * (double)share, left, n_ended(members), members->n, members_count(members, MEMBER_RUNNING));
  fflush(members->out);
}

void members_wipe(const Members *members)
{
  if (members->out != stdout || !progress_on_terminal()) return;
  fputs("\r\033[K", members->out);
  fflush(members->out);
}
