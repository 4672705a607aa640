/* What the case asks for after its end: it never comes. Of cases without stages, in which it might come later. */
#include "model/model_private.h"

#define MUCH_LATER 1.5 /* of the time that there is */

static PetscReal last_before(const Amplitude *a, PetscReal end)
{
  PetscReal most = 0;
  for (PetscInt i = 0; i < a->n; ++i)
    if (a->time[i] <= end) most = PetscMax(most, PetscAbsReal(a->value[i]));
  return PetscMax(most, PetscAbsReal(amplitude_value(a, end, 0)));
}

static void advise_amplitude(const Model *m, const Amplitude *a, const char *path, Diag *diag)
{
  const PetscReal end = m->c->analysis.end;
  PetscReal largest = 0;
  for (PetscInt i = 0; i < a->n; ++i) largest = PetscMax(largest, PetscAbsReal(a->value[i]));
  if (!(largest > 0) || case_raises(m->c, a)) return;
  if (last_before(a, end) == 0)
    diag_warning(diag, path, "it is 0 until the end of the run, at t = %g s: nothing of it ever acts", (double)end);
  else if (a->n == 2 && a->value[0] == 0 && a->time[1] > MUCH_LATER * end)
    diag_warning(diag, path, "the run ends at t = %g s, where it is %.3g: it would be %g at t = %g s", (double)end,
                 (double)amplitude_value(a, end, 0), (double)a->value[1], (double)a->time[1]);
  else return;
  diag_hint(diag, "times are in s, of statics those of `analysis.end`, which is 1 unless the case says otherwise");
}

static void advise_wall(const Model *m, PetscInt k, Diag *diag)
{
  const WallSpec *wall = m->c->walls + k;
  const PetscReal end = m->c->analysis.end;
  char path[96];
  for (PetscInt i = 0; i < wall->n_motions; ++i) {
    snprintf(path, sizeof path, "walls[%d].motion[%d].amplitude", (int)k, (int)i);
    advise_amplitude(m, &wall->motions[i].amplitude, path, diag);
  }
  /* what is sought begins at the end, and with the walls that come then */
  if (wall->from < end || (case_seeks(&m->c->analysis) && wall->from <= end)) return;
  snprintf(path, sizeof path, "walls[%d].from", (int)k);
  diag_warning(diag, path, "the run ends at t = %g s: wall '%s' never stands", (double)end, wall->name);
}

void advise_late(const Model *m, Diag *diag)
{
  const Case *c = m->c;
  char path[96], load[64];
  if (c->staged) return;
  advise_amplitude(m, &c->gravity_amplitude, "loads.gravity_amplitude", diag);
  for (PetscInt k = 0; k < c->n_boundary; ++k) {
    snprintf(path, sizeof path, "boundary[%d].amplitude", (int)k);
    advise_amplitude(m, &c->boundary[k].amplitude, path, diag);
  }
  for (PetscInt k = 0; k < c->n_loads; ++k) {
    snprintf(path, sizeof path, "%s.amplitude", case_load_path(c, k, load));
    advise_amplitude(m, &c->loads[k].amplitude, path, diag);
  }
  for (PetscInt k = 0; k < c->n_walls; ++k) advise_wall(m, k, diag);
}
