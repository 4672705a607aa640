/* sweep.csv: a row for each member. */
#include <math.h>
#include <string.h>
#include "base/text.h"
#include "input/case_file.h"
#include "output/directory/run_dir_files.h"
#include "sweep/sweep_private.h"

/* In quotes where CSV wants it. */
static void write_cell(FILE *out, const char *text)
{
  const PetscBool quoted = strpbrk(text, ",\"\n") != NULL;
  if (quoted) fputc('"', out);
  for (; *text; ++text) {
    if (*text == '"') fputc('"', out);
    fputc(*text, out);
  }
  if (quoted) fputc('"', out);
}

static void write_header(FILE *out, const SweepRun *s)
{
  const SweepKey *key;
  PetscInt axis;
  char name[128], label[TEXT_LABEL];
  for (PetscInt k = 0; (key = sweep_key(s->sweep, k, &axis)); ++k) {
    write_cell(out, text_with_unit(key->key, schema_unit(key->key), label));
    fputc(',', out);
  }
  for (PetscInt k = 0; k < s->n_taken; ++k) {
    write_cell(out, text_with_unit(taken_name_among(&s->taken[k], s->n_taken, s->taken, name),
                                   s->members.member[0].units[k], label));
    fputc(',', out);
  }
  fputs("steps,iterations,halvings,seconds,ended,directory\n", out);
}

static void write_row(FILE *out, const SweepRun *s, PetscInt i)
{
  const Member *m = &s->members.member[i];
  const PetscBool began = m->state != MEMBER_WAITING;
  const SweepKey *key;
  PetscInt axis;
  char number[32];
  for (PetscInt k = 0; (key = sweep_key(s->sweep, k, &axis)); ++k) {
    write_cell(out, key->value[sweep_at(s->sweep, i, axis)]);
    fputc(',', out);
  }
  for (PetscInt k = 0; k < s->n_taken; ++k) {
    file_format_real(m->values[k], number);
    fprintf(out, "%s,", m->state == MEMBER_DONE ? number : "");
  }
  if (began)
    fprintf(out, "%" PetscInt_FMT ",%" PetscInt_FMT ",%" PetscInt_FMT ",%.6g,", m->summary.steps, m->summary.iterations,
            m->summary.halvings, (double)m->summary.seconds);
  else fputs(",,,,", out);
  fprintf(out, "%s,", member_states[m->state]);
  write_cell(out, m->name);
  fputc('\n', out);
}

PetscErrorCode SweepTable(const SweepRun *s)
{
  char path[PETSC_MAX_PATH_LEN], *text;
  TextStream stream;

  PetscFunctionBeginUser;
  PetscCall(TextOpen(&stream));
  write_header(stream.out, s);
  for (PetscInt i = 0; i < s->members.n; ++i) write_row(stream.out, s, i);
  PetscCall(TextClose(&stream, &text));
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/sweep.csv", s->out));
  const int error = file_write_text(path, text);
  PetscCall(PetscFree(text));
  if (error) diag_error(s->diag, NULL, "cannot write '%s': %s", path, strerror(error));
  PetscFunctionReturn(0);
}
