/* What a stage repeats word for word goes on with its clock: a table that is over by then does nothing more. */
#include "input/stages.h"

typedef struct {
  const Case *whole;
  PetscInt stage;
  Diag *diag;
} Reader;

/* When the table changes for the last time, s since it began. */
static PetscReal last_change(const Amplitude *a)
{
  PetscInt last = a->n - 1;
  while (last > 0 && a->value[last] == a->value[last - 1]) --last;
  return a->time[last];
}

/* Stages that may end before their time may do so before a table is over. */
static PetscReal since_it_began(const Reader *r, const Amplitude *a)
{
  PetscReal time = 0;
  for (PetscInt k = a->since; k < r->stage; ++k) time += r->whole->stage_case[k]->analysis.end;
  return time;
}

/* Loads and parameters that stay at a last value are meant to; a place does not change again. */
static void look_at(void *context, const Amplitude *a, TableUse use, const char *path)
{
  const Reader *r = context;
  const PetscReal last = a->n ? a->value[a->n - 1] : 1, end = a->n ? a->time[a->n - 1] : 0;
  const PetscBool does_nothing = (PetscBool)(last == 0 || use == TABLE_PLACE);
  if (!a->repeated || a->since >= r->stage || use == TABLE_PARAMETER || !does_nothing) return;
  if (last_change(a) > since_it_began(r, a) * (1 + 1e-9)) return;
  diag_warning(r->diag, path,
               "it is word for word that of stage '%s', whose clock goes on: it is over when this stage begins, and "
               "stays %g",
               r->whole->stages[a->since].name, (double)last);
  diag_hint(r->diag, "let its words differ, and it begins anew: by a further point, [%g, %g]",
            (double)(end + (a->n > 1 ? end - a->time[a->n - 2] : 1)), (double)last);
}

void stage_advise_repeated(const Case *whole, PetscInt k, Diag *diag)
{
  Reader r = {.whole = whole, .stage = k, .diag = diag};
  diag_of_stage(diag, k, whole->stages[k].name);
  case_visit_tables(whole->stage_case[k], look_at, &r);
  diag_of_stage(diag, -1, NULL);
}
