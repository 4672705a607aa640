/* The tables as Markdown, for the directory of the results and for docs/verification.md. */
#include <string.h>
#include <time.h>
#include "base/text.h"
#include "verify/verify_private.h"
#include "talus_version.h"

static void write_number(FILE *out, const char *format, PetscReal value)
{
  char text[40] = "";
  if (!PetscIsNanReal(value)) PetscSNPrintf(text, sizeof text, format, (double)value);
  fprintf(out, " %s |", text);
}

static void write_source(FILE *out, const Source *source)
{
  fputs(source->text, out);
  if (source->confidence) fprintf(out, " (*%s*)", confidence_words[source->confidence]);
}

static void write_head(FILE *out, const VerifyRow *r)
{
  const StudySpec *study = r->study;
  const PetscBool errors = verify_has_errors(study), agree = study->n_agree > 0;
  char variable[TEXT_LABEL], reference[TEXT_LABEL];
  fprintf(out, "| series | %s | %s | value | off by |",
          text_with_unit(study->sweep.symbol, study->sweep.unit, variable),
          text_with_unit("reference", r->unit, reference));
  if (agree) fputs(" apart |", out);
  if (errors) fputs(" error | order |", out);
  fputs(" steps | Newton | s |", out);
  if (study->pace) fprintf(out, " s / %s |", study->pace);
  fputs(" |\n|---|---|---|---|---|", out);
  if (study->pace) fputs("---|", out);
  if (agree) fputs("---|", out);
  if (errors) fputs("---|---|", out);
  fputs("---|---|---|---|\n", out);
}

static void write_row(FILE *out, const VerifyRow *r)
{
  fprintf(out, "| %s | %s |", r->series->name, r->row->at);
  write_number(out, "%.9g", r->reference);
  write_number(out, "%.10g", r->value);
  write_number(out, "%.1e", r->deviation);
  if (r->study->n_agree) write_number(out, "%.1e", r->difference);
  if (verify_has_errors(r->study)) {
    write_number(out, "%.3e", r->error);
    write_number(out, "%.3f", r->order);
  }
  fprintf(out, " %d | %d |", (int)r->summary.steps, (int)r->summary.iterations);
  if (r->shared) fputs(" shared |", out);
  else write_number(out, "%.2f", r->seconds);
  if (r->study->pace) write_number(out, "%.2f", r->pace);
  if (r->pass) fputs(" pass |\n", out);
  else if (r->result != RUN_DONE && !r->summary.interrupted)
    fputs(" **FAIL**: the run gave up |\n", out); /* no folder of this machine */
  else fprintf(out, " **FAIL**: %s |\n", r->why);
}

/* Sources of rows and series that differ from the study's, each once. */
static void write_sources(FILE *out, const Verification *v, PetscInt first, PetscInt last)
{
  const StudySpec *study = v->rows[first].study;
  if (study->source.text) {
    fputs("- Reference: ", out);
    write_source(out, &study->source);
    fprintf(out, "; %s %g of it", study->at_most ? "an upper bound, exceeded by at most" : "tolerance",
            (double)study->tolerance);
    if (study->absolute > 0) fprintf(out, " and %g", (double)study->absolute);
    fputs(".\n", out);
  }
  for (PetscInt k = first; k < last; ++k) {
    const VerifyRow *r = &v->rows[k];
    const Source *source = reference_source(study, r->row, r->series);
    PetscBool told = !source || source == &study->source || PetscIsNanReal(r->reference);
    for (PetscInt i = first; i < k && !told; ++i)
      told = reference_source(study, v->rows[i].row, v->rows[i].series) == source;
    if (told) continue;
    if (source == &r->series->source) fprintf(out, "- Reference of %s: ", r->series->name);
    else fprintf(out, "- Reference at %s = %s: ", study->sweep.symbol, r->row->at);
    write_source(out, source);
    fprintf(out, "; tolerance %g of it.\n", (double)reference_tolerance(study, r->row, r->series));
  }
}

static void write_exact(FILE *out, const StudySpec *study)
{
  const ExactSpec *exact = &study->exact;
  fputs("- Error and order against", out);
  if (exact->has_value) fprintf(out, " %.9g: ", (double)exact->value);
  for (PetscInt i = 0; i < exact->n_values; ++i)
    fprintf(out, " %.9g (%s)%s", (double)exact->values[i].value, exact->values[i].name,
            i + 1 < exact->n_values ? "," : ": ");
  write_source(out, exact->source.text ? &exact->source : &study->source);
  if (exact->order > 0)
    fprintf(out, "; order %g within %g asked for from %s = %g to %g", (double)exact->order,
            (double)exact->order_tolerance, study->sweep.symbol, (double)exact->from, (double)exact->to);
  fputs(".\n", out);
}

static void write_study(FILE *out, const Verification *v, PetscInt first, PetscInt last, PetscBool figures)
{
  const StudySpec *study = v->rows[first].study;
  fprintf(out, "Measure `%s` over %s %s.\n\n", study->measure, study->sweep.name, study->sweep.symbol);
  write_head(out, &v->rows[first]);
  for (PetscInt k = first; k < last; ++k) write_row(out, &v->rows[k]);
  fputc('\n', out);
  write_sources(out, v, first, last);
  if (study->has_exact) write_exact(out, study);
  for (PetscInt i = 0; i < study->n_agree; ++i) {
    const AgreeSpec *a = study->agree + i;
    fprintf(out, "- `%s` must agree with `%s` to %g", a->series, a->with, (double)a->tolerance);
    if (a->absolute > 0) fprintf(out, " of it and %g", (double)a->absolute);
    fputs(" (column *apart*).\n", out);
  }
  for (PetscInt i = 0; i < study->n_powers; ++i) {
    char text[512];
    verify_power_text(v->rows, first, last, &study->powers[i], text);
    if (text[0]) fprintf(out, "- %s.\n", text);
  }
  for (PetscInt i = 0; i < study->n_limits; ++i)
    fprintf(out, "- Limit: %s at most %g.\n", study->limits[i].name, (double)study->limits[i].value);
  if (figures && study->figure != VERIFY_FIGURE_NONE) fprintf(out, "\n![%s](%s.png)\n", study->title, study->name);
}

/* Which rows are of another program than this one: each of these once, with its rows' number. */
static void write_origins(FILE *out, const Verification *v)
{
  for (PetscInt k = 0; k < v->n; ++k) {
    const VerifyRow *r = &v->rows[k];
    PetscInt same = 0;
    PetscBool told = !r->taken || !strcmp(r->sources, TALUS_GIT_DESCRIBE);
    for (PetscInt i = 0; i < v->n && !told; ++i) {
      if (!v->rows[i].taken || strcmp(v->rows[i].sources, r->sources)) continue;
      if (i < k) told = PETSC_TRUE;
      ++same;
    }
    if (!told)
      fprintf(out, "%d of its rows were computed before, with %s.\n", (int)same,
              r->sources[0] ? r->sources : "a program that does not say which");
  }
}

/* When, and by which program. */
static void write_stamp(FILE *out, const Verification *v)
{
  const char *sources = TALUS_GIT_DESCRIBE;
  char date[32];
  time_t now = time(NULL);
  struct tm utc;
  gmtime_r(&now, &utc);
  strftime(date, sizeof date, "%Y-%m-%d", &utc);
  fprintf(out, "Recorded %s with talus %s%s%s%s on %d rank%s, %s rows.\n", date, TALUS_VERSION, sources[0] ? " (" : "",
          sources, sources[0] ? ")" : "", (int)v->size, v->size > 1 ? "s" : "", v->options->full ? "all" : "the quick");
  write_origins(out, v);
}

static void write_text(FILE *out, const Verification *v, VerifyMarkdownPart part)
{
  const PetscBool figures = part == VERIFY_WITH_FIGURES, alone = part == VERIFY_STUDY_ALONE;
  if (!alone) {
    fprintf(out, "## %s: %s\n\n", v->name, v->reference->title);
    write_stamp(out, v);
  }
  for (PetscInt first = 0, last; first < v->n; first = last) {
    const StudySpec *study = v->rows[first].study;
    for (last = first; last < v->n && v->rows[last].study == study;) ++last;
    fprintf(out, "\n### %s: %s\n\n", study->name, study->title);
    if (alone) {
      write_stamp(out, v);
      fputc('\n', out);
    }
    write_study(out, v, first, last, figures);
  }
}

PetscBool verify_is_table(const char *folder)
{
  char path[PETSC_MAX_PATH_LEN], head[1024] = "";
  PetscSNPrintf(path, sizeof path, "%s/verification.md", folder);
  FILE *in = fopen(path, "r");
  if (!in) return PETSC_FALSE;
  head[fread(head, 1, sizeof head - 1, in)] = '\0';
  fclose(in);
  return !strncmp(head, "## ", 3) && strstr(head, "\nRecorded ") && strstr(head, " with talus ");
}

PetscErrorCode VerifyMarkdown(const Verification *v, VerifyMarkdownPart part, char **text)
{
  TextStream stream;

  PetscFunctionBeginUser;
  PetscCall(TextOpen(&stream));
  write_text(stream.out, v, part);
  PetscCall(TextClose(&stream, text));
  PetscFunctionReturn(0);
}
