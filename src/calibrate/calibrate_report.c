/* What a calibration has found: the report, tables of region and runs, pictures. */
#include <math.h>
#include <string.h>
#include "base/text.h"
#include "calibrate/calibrate_private.h"
#include "calibrate/parameter.h"
#include "output/directory/run_dir_files.h"
#include "picture/figure.h"

const char *calibrate_label(const Parameter *p) { return p->label ? p->label : p->name; }

static const Member *member_of(const CalibrateRun *r, PetscInt point, PetscInt k)
{
  return &r->members.member[point * r->c->n_instruments + r->instrument[k]];
}

static const char *unit_of(const CalibrateRun *r, PetscInt k) { return member_of(r, 0, k)->units[r->number[k]]; }

PetscBool calibrate_is_confirmed(const CalibrateRun *r)
{
  PetscBool all = r->confirmed >= 0;
  for (PetscInt k = 0; k < r->n_targets && all; ++k)
    all = PetscAbsReal(calibrate_found(r, r->confirmed, k) - r->target[k]->value) <= r->target[k]->uncertainty;
  return all;
}

/* "granufall flow mean" */
static const char *target_name(const CalibrateRun *r, PetscInt k, char name[256])
{
  char taken[128];
  PetscSNPrintf(name, 256, "%s %s", r->c->instruments[r->instrument[k]].name, taken_name(&r->target[k]->taken, taken));
  return name;
}

static void tell_targets(FILE *out, const CalibrateRun *r)
{
  char name[256];
  fputs("\n| measure | target | left out, a run is predicted within (root mean square) |\n|---|---|---|\n", out);
  for (PetscInt k = 0; k < r->n_targets; ++k) {
    const PetscReal error = surrogate_left_out(r->surrogate[k]);
    fprintf(out, "| %s | %.15g +- %.15g %s | %.3g %s |\n", target_name(r, k, name), (double)r->target[k]->value,
            (double)r->target[k]->uncertainty, unit_of(r, k), (double)error, unit_of(r, k));
  }
}

/* What the region says of a parameter: one whose whole range is possible is not determined. The region touches an end
 * of the range if it is no farther from it than such a part of its own width as its outermost points may lack. */
static const char *verdict_of(PetscReal low, PetscReal high, PetscInt inside)
{
  const PetscReal near = (high - low) * PetscMax(0.02, 3 / (PetscReal)inside);
  if (high - low > 0.95) return "not determined";
  if (low < near) return "not bounded from below by what was looked at";
  return high > 1 - near ? "not bounded from above by what was looked at" : "";
}

/* How far apart values of a parameter lie in the region; in all of its range if there is no region of two points. */
static PetscReal spread(const CalibrateRun *r, PetscInt p)
{
  const Parameter *parameter = &r->c->parameters[p];
  PetscReal low, high;
  region_range(&r->region, p, &low, &high);
  if (high > low) return parameter_at(parameter, high) - parameter_at(parameter, low);
  return parameter->high - parameter->low;
}

static void tell_ranges(FILE *out, const CalibrateRun *r)
{
  char text[4][32];
  PetscReal low, high;
  fputs("\n| parameter | in the region | looked at | |\n|---|---|---|---|\n", out);
  for (PetscInt p = 0; p < r->c->n_parameters; ++p) {
    const Parameter *parameter = &r->c->parameters[p];
    const PetscReal all = parameter->high - parameter->low;
    region_range(&r->region, p, &low, &high);
    fprintf(out, "| %s | %s to %s %s | %s to %s%s | %s |\n", calibrate_label(parameter),
            number_text(parameter_at(parameter, low), spread(r, p), 4, text[0]),
            number_text(parameter_at(parameter, high), spread(r, p), 4, text[1]),
            parameter->unit ? parameter->unit : "", number_text(parameter->low, all, 6, text[2]),
            number_text(parameter->high, all, 6, text[3]),
            parameter_is_logarithmic(parameter) ? ", by the logarithm" : "", verdict_of(low, high, r->region.inside));
  }
}

/* A handful of points is no range. */
static void tell_count(FILE *out, const CalibrateRun *r)
{
  enum { FEW = 100 };
  fprintf(out,
          "\nThe region in which all predictions lie within uncertainty and their own error is %.2g %% of what "
          "was looked at; %" PetscInt_FMT " of the points tried lie in it.\n",
          (double)(100 * r->region.volume), r->region.inside);
  if (r->region.inside < FEW)
    fputs("So few tell its ranges roughly: narrower ranges of the parameters about them show more of it.\n", out);
}

static void tell_couples(FILE *out, const CalibrateRun *r)
{
  for (PetscInt a = 0; a < r->c->n_parameters; ++a)
    for (PetscInt b = 0; b < a; ++b) {
      const PetscReal correlation = region_correlation(&r->region, b, a);
      if (PetscAbsReal(correlation) < 0.7) continue;
      fprintf(out, "%s and %s go together in it: where one is larger, the other is %s (correlation %.2f).\n",
              calibrate_label(&r->c->parameters[b]), calibrate_label(&r->c->parameters[a]),
              correlation > 0 ? "larger, too" : "smaller", (double)correlation);
    }
}

/* A region without a run that meets all targets is a guess. */
static void tell_verdict(FILE *out, const CalibrateRun *r)
{
  if (calibrate_is_confirmed(r)) fputs("\nThe run at the best point meets all targets.\n", out);
  else fputs("\nNo run at this point meets all targets.\n", out);
  if (r->region.inside && !calibrate_is_confirmed(r))
    fputs(
      "What the predictions allow is not confirmed, the region may lie elsewhere: more `rounds` or `points` tell "
      "(runs that are there are used again), or narrower ranges.\n",
      out);
}

static void tell_best(FILE *out, const CalibrateRun *r)
{
  const Region *region = &r->region;
  const PetscReal *best =
    r->confirmed >= 0 ? r->x + r->confirmed * region->dim : region->x + region->best * region->dim;
  char name[256], text[32];
  fprintf(out, "\n%s:", region->inside ? "Best point" : "Nearest point");
  for (PetscInt p = 0; p < r->c->n_parameters; ++p) {
    const Parameter *parameter = &r->c->parameters[p];
    fprintf(out, "%s %s = %s %s", p ? "," : "", calibrate_label(parameter), parameter_text(parameter, best[p], text),
            parameter->unit ? parameter->unit : "");
  }
  fputs("\n\n| measure | target | predicted | its run |\n|---|---|---|---|\n", out);
  for (PetscInt k = 0; k < r->n_targets; ++k) {
    const PetscReal uncertainty = r->target[k]->uncertainty;
    PetscReal value, error;
    surrogate_at(region->surrogate[k], best, &value, &error);
    fprintf(out, "| %s | %.15g +- %.15g | %s +- %.2g |", target_name(r, k, name), (double)r->target[k]->value,
            (double)uncertainty, number_text(value, uncertainty, 4, text), (double)error);
    if (r->confirmed < 0) fputs(" - |\n", out);
    else
      fprintf(out, " %s %s |\n", number_text(calibrate_found(r, r->confirmed, k), uncertainty, 4, text), unit_of(r, k));
  }
  tell_verdict(out, r);
}

static void tell(FILE *out, const CalibrateRun *r)
{
  const PetscReal doubt = region_doubt(&r->region);
  fprintf(out,
          "# %s\n\n%" PetscInt_FMT " sets of parameters were run, %" PetscInt_FMT " of %" PetscInt_FMT
          " runs came to their end.\n",
          r->c->title, r->n, members_count(&r->members, MEMBER_DONE), r->members.n);
  tell_targets(out, r);
  if (r->region.inside) {
    tell_count(out, r);
    tell_ranges(out, r);
    fputc('\n', out);
    tell_couples(out, r);
  } else
    fputs("\nThere is no region: no parameters within the ranges meet all targets, as far as the runs tell.\n", out);
  fprintf(out, "The predictions' own error is at most %.2g of the uncertainties there%s.\n", (double)doubt,
          doubt > r->c->resolve ? ": more rounds would make the region clearer" : "");
  tell_best(out, r);
}

static void write_header(FILE *out, const CalibrateRun *r, PetscBool predicted)
{
  char name[256], label[TEXT_LABEL];
  for (PetscInt p = 0; p < r->c->n_parameters; ++p)
    fprintf(out, "%s%s", p ? "," : "", text_with_unit(r->c->parameters[p].name, r->c->parameters[p].unit, label));
  for (PetscInt k = 0; k < r->n_targets; ++k) {
    fprintf(out, ",%s", text_with_unit(target_name(r, k, name), unit_of(r, k), label));
    if (predicted) fprintf(out, ",+- [%s]", unit_of(r, k));
  }
  fputs(predicted ? "\n" : ",ended\n", out);
}

static void write_region(FILE *out, const CalibrateRun *r)
{
  const Region *region = &r->region;
  PetscReal apart[SURROGATE_MOST];
  char text[32];
  write_header(out, r, PETSC_TRUE);
  for (PetscInt p = 0; p < region->dim; ++p) apart[p] = spread(r, p) / 1000; /* as many points may lie in it */
  for (PetscInt i = 0; i < region->n; ++i) {
    if (region->miss[i] > 1) continue;
    for (PetscInt p = 0; p < region->dim; ++p)
      fprintf(out, "%s%s", p ? "," : "",
              number_text(parameter_at(&r->c->parameters[p], region->x[i * region->dim + p]), apart[p], 6, text));
    for (PetscInt k = 0; k < r->n_targets; ++k) {
      const PetscInt at = i * r->n_targets + k;
      fprintf(out, ",%s,%.3g", number_text(region->value[at], r->target[k]->uncertainty, 6, text),
              (double)region->error[at]);
    }
    fputc('\n', out);
  }
}

/* How the runs of a point ended: done, or what the first that was not has come to. */
static const char *how_ended(const CalibrateRun *r, PetscInt point)
{
  for (PetscInt i = 0; i < r->c->n_instruments; ++i) {
    const Member *m = &r->members.member[point * r->c->n_instruments + i];
    if (m->state != MEMBER_DONE) return member_states[m->state];
  }
  return member_states[MEMBER_DONE];
}

static void write_runs(FILE *out, const CalibrateRun *r)
{
  char text[32];
  write_header(out, r, PETSC_FALSE);
  for (PetscInt i = 0; i < r->n; ++i) {
    for (PetscInt p = 0; p < r->c->n_parameters; ++p)
      fprintf(out, "%s%s", p ? "," : "", parameter_text(&r->c->parameters[p], r->x[i * r->c->n_parameters + p], text));
    for (PetscInt k = 0; k < r->n_targets; ++k) {
      const PetscReal value = calibrate_found(r, i, k);
      if (PetscIsNanReal(value)) fputc(',', out);
      else fprintf(out, ",%s", number_text(value, r->target[k]->uncertainty, 10, text));
    }
    fprintf(out, ",%s\n", how_ended(r, i));
  }
}

/* The region seen along all other parameters, and what was run. */
static PetscErrorCode Draw(CalibrateRun *r, PetscInt a, PetscInt b)
{
  const Parameter *pa = &r->c->parameters[a], *pb = &r->c->parameters[b];
  const Region *region = &r->region;
  const PetscInt dim = region->dim, best[2] = {r->confirmed >= 0 ? 1 : 0, PetscMax(r->confirmed, 0)};
  char png[PETSC_MAX_PATH_LEN], x_label[TEXT_LABEL], y_label[TEXT_LABEL];
  PetscReal *x, *y;
  PetscInt n = 0;
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(region->n + r->n, &x, region->n + r->n, &y));
  for (PetscInt i = 0; i < region->n; ++i)
    if (region->miss[i] <= 1)
      x[n] = parameter_at(pa, region->x[i * dim + a]), y[n++] = parameter_at(pb, region->x[i * dim + b]);
  for (PetscInt i = 0; i < r->n; ++i)
    x[n + i] = parameter_at(pa, r->x[i * dim + a]), y[n + i] = parameter_at(pb, r->x[i * dim + b]);
  const FigureSeries series[] = {
    {.name = "the region", .style = FIGURE_DOTS, .n = n, .x = x, .y = y},
    {.name = "runs", .style = FIGURE_MARKS, .n = r->n, .x = x + n, .y = y + n},
    {.name = "run at the best point", .style = FIGURE_MARKS, .n = best[0], .x = x + n + best[1], .y = y + n + best[1]}};
  const Figure figure = {.title = r->c->title,
                         .x_label = text_with_unit(calibrate_label(pa), pa->unit, x_label),
                         .y_label = text_with_unit(calibrate_label(pb), pb->unit, y_label),
                         .log_x = parameter_is_logarithmic(pa),
                         .log_y = parameter_is_logarithmic(pb),
                         .n_series = 3,
                         .series = series};
  PetscCall(PetscSNPrintf(png, sizeof png, "%s/%s-%s.png", r->out, pa->name, pb->name));
  PetscCall(FigureWrite(&figure, png, r->diag, &done));
  if (done) fprintf(r->told, "picture: %s\n", png);
  PetscCall(PetscFree2(x, y));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteFile(CalibrateRun *r, const char *name, void (*write)(FILE *out, const CalibrateRun *r),
                                PetscBool tell_it)
{
  char path[PETSC_MAX_PATH_LEN], *text;
  TextStream stream;

  PetscFunctionBeginUser;
  PetscCall(TextOpen(&stream));
  (*write)(stream.out, r);
  PetscCall(TextClose(&stream, &text));
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", r->out, name));
  const int error = file_write_text(path, text);
  if (error) diag_error(r->diag, NULL, "cannot write '%s': %s", path, strerror(error));
  if (tell_it) fprintf(r->told, "\n%s\nreport: %s\n", text, path);
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

PetscErrorCode CalibrateReport(CalibrateRun *r)
{
  PetscFunctionBeginUser;
  PetscCall(WriteFile(r, "runs.csv", write_runs, PETSC_FALSE));
  PetscCall(WriteFile(r, "region.csv", write_region, PETSC_FALSE));
  PetscCall(WriteFile(r, "report.md", tell, PETSC_TRUE));
  for (PetscInt a = 0; a < r->c->n_parameters; ++a)
    for (PetscInt b = a + 1; b < r->c->n_parameters; ++b) PetscCall(Draw(r, a, b));
  PetscFunctionReturn(0);
}
