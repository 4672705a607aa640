/* The table of a study on a terminal: one line a row, as it is done. */
#include <string.h>
#include "base/text.h"
#include "verify/verify_private.h"

/* A number, or a dash where there is none. */
static const char *cell(const char *format, PetscReal value, char text[40])
{
  if (PetscIsNanReal(value)) strcpy(text, "-");
  else PetscSNPrintf(text, 40, format, (double)value);
  return text;
}

static void write_source(FILE *out, const Source *source)
{
  fprintf(out, "%s", source->text);
  if (source->confidence) fprintf(out, " [%s]", confidence_words[source->confidence]);
}

static void write_exact(FILE *out, const StudySpec *study)
{
  const ExactSpec *exact = &study->exact;
  fputs("  exact: ", out);
  if (exact->has_value) fprintf(out, "%.9g", (double)exact->value);
  for (PetscInt i = 0; i < exact->n_values; ++i)
    fprintf(out, "%s%s %.9g", i ? ", " : "", exact->values[i].name, (double)exact->values[i].value);
  fputs("; ", out);
  write_source(out, exact->source.text ? &exact->source : &study->source);
  fputc('\n', out);
}

void verify_table_head(FILE *out, const Verification *v, PetscInt first)
{
  const VerifyRow *r = &v->rows[first];
  const StudySpec *study = r->study;
  char measure[TEXT_LABEL], variable[TEXT_LABEL];
  fprintf(out, "\n%s: %s\n  measure %s over %s %s\n", study->name, study->title,
          text_with_unit(study->measure, r->unit, measure), study->sweep.name,
          text_with_unit(study->sweep.symbol, study->sweep.unit, variable));
  if (study->source.text) {
    fputs("  reference: ", out);
    write_source(out, &study->source);
    fputc('\n', out);
  }
  if (study->has_exact) write_exact(out, study);
  fprintf(out, "\n  %-12s %9s %13s %15s %9s", "series", study->sweep.symbol, "reference", "value", "off by");
  if (verify_has_errors(study)) fprintf(out, " %9s %6s", "error", "order");
  fprintf(out, " %6s %6s %8s", "steps", "Newton", "s");
  if (study->pace) fprintf(out, " %6s", "pace");
  fputs("  result\n", out);
  fflush(out);
}

void verify_table_row(FILE *out, const VerifyRow *r)
{
  char a[40], b[40], c[40], d[40], e[40], f[40], seconds[40] = "shared";
  fprintf(out, "  %-12s %9s %13s %15s %9s", r->series->name, r->row->at, cell("%.9g", r->reference, a),
          cell("%.10g", r->value, b), cell("%.1e", r->deviation, c));
  if (verify_has_errors(r->study)) fprintf(out, " %9s %6s", cell("%.2e", r->error, d), cell("%.3f", r->order, e));
  if (!r->shared) cell("%.2f", r->seconds, seconds);
  fprintf(out, " %6d %6d %8s", (int)r->summary.steps, (int)r->summary.iterations, seconds);
  if (r->study->pace) fprintf(out, " %6s", cell("%.2f", r->pace, f));
  fprintf(out, "  %s\n", r->pass ? "pass" : "FAIL");
  if (!r->pass) fprintf(out, "  %-12s %9s ^ %s\n", "", "", r->why);
  fflush(out);
}

static void write_agreement(FILE *out, const Verification *v, PetscInt first, PetscInt last, const AgreeSpec *agree)
{
  PetscReal worst = -1;
  for (PetscInt k = first; k < last; ++k)
    if (!strcmp(v->rows[k].series->name, agree->series) && !PetscIsNanReal(v->rows[k].difference))
      worst = PetscMax(worst, v->rows[k].difference);
  if (worst >= 0)
    fprintf(out, "  %s agrees with %s to %.1e (allowed %.2g)\n", agree->series, agree->with, (double)worst,
            (double)agree->tolerance);
}

void verify_table_foot(FILE *out, const Verification *v, PetscInt first, PetscInt last)
{
  const StudySpec *study = v->rows[first].study;
  PetscReal seconds = 0;
  PetscInt passed = 0;
  for (PetscInt k = first; k < last; ++k) {
    seconds += v->rows[k].seconds;
    passed += v->rows[k].pass ? 1 : 0;
  }
  for (PetscInt i = 0; i < study->n_agree; ++i) write_agreement(out, v, first, last, &study->agree[i]);
  for (PetscInt i = 0; i < study->n_powers; ++i) {
    char text[512];
    verify_power_text(v->rows, first, last, &study->powers[i], text);
    if (text[0]) fprintf(out, "  %s\n", text);
  }
  fprintf(out, "  %d of %d rows pass, %.1f s\n", (int)passed, (int)(last - first), (double)seconds);
  fflush(out);
}

/* "30 %", "0.025 m", "1 % + 0.05 m"; a dash where the study compares nothing. */
static const char *allowed(const VerifyRow *r, char text[64])
{
  const PetscReal relative = 100 * reference_tolerance(r->study, r->row, r->series), absolute = r->study->absolute;
  if (absolute == 0) snprintf(text, 64, "%g %%", (double)relative);
  else if (relative == 0) snprintf(text, 64, "%g %s", (double)absolute, r->unit);
  else snprintf(text, 64, "%g %% + %g %s", (double)relative, (double)absolute, r->unit);
  return text;
}

/* The value beside one number: signed distance in per cent, and the verdict where there is one. */
static void write_comparison(FILE *out, const VerifyRow *r, PetscReal reference, const char *band, const char *verdict)
{
  char name[80], off[40] = "-", when[40] = "";
  snprintf(name, sizeof name, r->unit[0] ? "%.40s [%s]" : "%.40s%s", r->study->measure, r->unit);
  if (reference != 0) snprintf(off, sizeof off, "%+.2g %%", (double)(100 * (r->value / reference - 1)));
  if (r->study->moments) snprintf(when, sizeof when, ", at %g s", (double)r->row->x);
  fprintf(out, "  %-16s %12.6g %12.6g %10s %12s  %-5s  %s%s\n", name, (double)r->value, (double)reference, off, band,
          verdict, r->study->title, when);
}

void verify_table_run(FILE *out, const Verification *v)
{
  PetscInt compared = 0, passed = 0;
  char band[64];
  fprintf(out, "\ncompared with %s/reference.yaml\n  %-16s %12s %12s %10s %12s\n", v->options->folder, "measure",
          "here", "reference", "off by", "allowed");
  for (PetscInt k = 0; k < v->n; ++k) {
    const VerifyRow *r = &v->rows[k];
    const PetscReal exact = reference_exact(r->study, r->series);
    if (!PetscIsNanReal(r->reference)) write_comparison(out, r, r->reference, allowed(r, band), r->pass ? "ok" : "OFF");
    if (!PetscIsNanReal(exact)) write_comparison(out, r, exact, "-", "limit");
    if (!r->pass) fprintf(out, "  %-16s ^ %s\n", "", r->why);
    if (PetscIsNanReal(r->reference) && r->pass) continue;
    ++compared;
    passed += r->pass ? 1 : 0;
  }
  fprintf(out, "  %d of %d within what is allowed; that file tells the sources\n", (int)passed, (int)compared);
  fflush(out);
}
