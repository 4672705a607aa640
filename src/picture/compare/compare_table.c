/* The tables of a comparison: on the terminal, and for programs. */
#include <math.h>
#include <string.h>
#include "base/text.h"
#include "input/case_file.h"
#include "output/directory/run_dir_files.h"
#include "picture/compare/compare_private.h"

/* Keys that the terminal shows; keys.csv has all. */
enum { SHOWN_KEYS = 20 };

enum { NARROW = 16, WIDE = 48 }; /* columns of runs */

/* How many characters all names have in common at their begin, or at their end; parts of them, as
 * the names of members of sweeps have them, stay whole. */
static size_t common(const Comparison *c, PetscBool at_end)
{
  const PetscInt n = c->options->n_runs;
  size_t same = 0, whole = 0;
  for (PetscBool differ = PETSC_FALSE; !differ; same += !differ) {
    char letter = 0;
    for (PetscInt r = 0; r < n && !differ; ++r) {
      const size_t length = strlen(c->runs[r].name);
      const char its = same >= length ? '\0' : c->runs[r].name[at_end ? length - 1 - same : same];
      differ = !its || (r && its != letter) ? PETSC_TRUE : PETSC_FALSE;
      letter = its;
    }
    if (!differ && letter == ',') whole = same + 1;
  }
  return whole;
}

/* What tells a run from the others, at most WIDE characters of it, and how many. */
static const char *label_of(const Comparison *c, PetscInt run, int *length)
{
  const char *name = c->runs[run].name;
  const size_t all = strlen(name), from = common(c, PETSC_FALSE), behind = common(c, PETSC_TRUE);
  *length = (int)(from + behind < all ? all - from - behind : all - from);
  return name + from;
}

/* Of the column that holds the labels. */
static int label_width(const Comparison *c)
{
  int width = NARROW, length;
  for (PetscInt r = 0; r < c->options->n_runs; ++r) {
    (void)label_of(c, r, &length);
    width = PetscMax(width, PetscMin(length, WIDE));
  }
  return width;
}

static const char *value_of(const DifferingKeys *keys, PetscInt key, PetscInt run)
{
  const char *value = keys->value[key * keys->n_runs + run];
  return value ? value : "-";
}

static void print_keys(FILE *out, const Comparison *c)
{
  const DifferingKeys *keys = &c->keys;
  const int width = label_width(c);
  int length;
  if (!keys->n) fputs("The cases do not differ in any key that changes numbers.\n", out);
  else fprintf(out, "%-44s", "key");
  for (PetscInt r = 0; r < keys->n_runs && keys->n; ++r) {
    const char *label = label_of(c, r, &length);
    fprintf(out, " %*.*s", width, PetscMin(length, WIDE), label);
  }
  if (keys->n) fputc('\n', out);
  for (PetscInt k = 0; k < PetscMin(keys->n, SHOWN_KEYS); ++k) {
    const char *unit = schema_unit(keys->key[k]);
    fprintf(out, "%-44s", keys->key[k]);
    for (PetscInt r = 0; r < keys->n_runs; ++r) fprintf(out, " %*.*s", width, WIDE, value_of(keys, k, r));
    fprintf(out, "%s%s\n", unit ? "  " : "", unit ? unit : "");
  }
  if (keys->n > SHOWN_KEYS) fprintf(out, "... and %d more (keys.csv)\n", (int)keys->n - SHOWN_KEYS);
  fputc('\n', out);
}

static void print_lack(FILE *out, const Comparison *c, const CompareRow *row, PetscInt lacks)
{
  const Lack *lack = &row->lacks[lacks];
  const CurveRun *without = &c->runs[lacks ? row->run : 0], *with = &c->runs[lacks ? 0 : row->run];
  if (!lack->any) return;
  fprintf(out, "'%s' has no value in %s ", row->measure, without->folder);
  if (lack->to > lack->from) fprintf(out, "from %g to %g s", (double)lack->from, (double)lack->to);
  else fprintf(out, "at %g s", (double)lack->from);
  fprintf(out, ", where %s has one\n", with->folder);
}

static void print_scale(FILE *out, const Comparison *c)
{
  PetscBool any = PETSC_FALSE;
  for (PetscInt i = 0; i < c->n_rows; ++i) any = (PetscBool)(any || c->rows[i].scale > 0);
  if (any) fputs("Energies are relative to the largest energy of both runs; a balance is a share already.\n", out);
}

/* What the numbers do not say: what some are relative to, where there are none, and when those of searches are from. */
static void print_remarks(FILE *out, const Comparison *c)
{
  print_scale(out, c);
  for (PetscInt i = 0; i < c->n_rows; ++i) {
    const CompareRow *row = &c->rows[i];
    if (row->found)
      fprintf(out, "'%s' of %s: what each run has found, whenever that was (from %g to %g s)\n", row->measure,
              c->runs[row->run].folder, (double)row->difference.from, (double)row->difference.to);
    for (PetscInt lacks = 0; lacks < 2; ++lacks) print_lack(out, c, row, lacks);
  }
}

void compare_print(FILE *out, const Comparison *c)
{
  const int width = label_width(c);
  char label[TEXT_LABEL];
  int length;
  print_keys(out, c);
  fprintf(out, "Differences from %s:\n", c->runs[0].folder);
  fprintf(out, "%-28s %-*s %13s %13s %11s %9s %13s\n", "measure", width, "run", "largest value", "difference", "at [s]",
          "relative", "at the end");
  for (PetscInt i = 0; i < c->n_rows; ++i) {
    const CompareRow *row = &c->rows[i];
    const Difference *d = &row->difference;
    const char *run = label_of(c, row->run, &length);
    fprintf(out, "%-28s %-*.*s", text_with_unit(row->measure, row->unit, label), width, PetscMin(length, WIDE), run);
    if (row->met)
      fprintf(out, " %13.6g %13.6g %11.6g %9.2e %13.6g\n", (double)d->size, (double)d->largest, (double)d->at,
              (double)d->relative, (double)d->last);
    else fputs(row->empty ? " no values\n" : " no time at which both have values\n", out);
  }
  print_remarks(out, c);
  fputc('\n', out);
  fflush(out);
}

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

static void write_number(FILE *out, PetscReal value)
{
  char number[32];
  file_format_real(value, number);
  fprintf(out, ",%s", number);
}

static void write_differences(FILE *out, const Comparison *c)
{
  fputs("measure,unit,run,from [s],to [s],largest value,difference,at [s],relative,at the end,", out);
  fputs("missing in,missing from [s]\n", out);
  for (PetscInt i = 0; i < c->n_rows; ++i) {
    const CompareRow *row = &c->rows[i];
    const Difference *d = &row->difference;
    const PetscReal values[] = {d->from, d->to, d->size, d->largest, d->at, d->relative, d->last};
    const Lack *lack = compare_lack(row);
    if (!row->met && !lack) continue;
    write_cell(out, row->measure), fputc(',', out);
    write_cell(out, row->unit), fputc(',', out);
    write_cell(out, c->runs[row->run].folder);
    for (int k = 0; k < 7; ++k) write_number(out, row->met ? values[k] : NAN);
    fputc(',', out);
    if (lack) {
      write_cell(out, c->runs[lack == row->lacks ? 0 : row->run].folder);
      write_number(out, lack->from);
    } else fputc(',', out);
    fputc('\n', out);
  }
}

static void write_keys(FILE *out, const Comparison *c)
{
  const DifferingKeys *keys = &c->keys;
  fputs("key,unit", out);
  for (PetscInt r = 0; r < keys->n_runs; ++r) fputc(',', out), write_cell(out, c->runs[r].folder);
  fputc('\n', out);
  for (PetscInt k = 0; k < keys->n; ++k) {
    const char *unit = schema_unit(keys->key[k]);
    write_cell(out, keys->key[k]), fputc(',', out);
    write_cell(out, unit ? unit : "");
    for (PetscInt r = 0; r < keys->n_runs; ++r) {
      const char *value = keys->value[k * keys->n_runs + r];
      fputc(',', out), write_cell(out, value ? value : "");
    }
    fputc('\n', out);
  }
}

static PetscErrorCode WriteTable(const Comparison *c, const char *name, void (*write)(FILE *, const Comparison *),
                                 Diag *diag, void (*said)(const char *path))
{
  char path[FILE_PATH], *text;
  TextStream stream;

  PetscFunctionBeginUser;
  PetscCall(TextOpen(&stream));
  write(stream.out, c);
  PetscCall(TextClose(&stream, &text));
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", c->folder, name));
  const int error = file_write_text(path, text);
  PetscCall(PetscFree(text));
  if (error) diag_error(diag, NULL, "cannot write '%s': %s", path, strerror(error));
  else if (said) said(path);
  PetscFunctionReturn(0);
}

PetscErrorCode CompareTables(const Comparison *c, Diag *diag, void (*said)(const char *path))
{
  PetscFunctionBeginUser;
  PetscCall(WriteTable(c, "differences.csv", write_differences, diag, said));
  PetscCall(WriteTable(c, "keys.csv", write_keys, diag, said));
  PetscFunctionReturn(0);
}
