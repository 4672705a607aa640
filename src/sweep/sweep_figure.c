/* Pictures of a sweep: a measure over the values of the first axis, a curve for each combination of
 * the others. */
#include <math.h>
#include <string.h>
#include "base/text.h"
#include "input/case_file.h"
#include "picture/figure.h"
#include "sweep/sweep_private.h"

/* Of two keys with the same last word each goes by all of its words. */
static const char *label_of(const SweepRun *s, const SweepKey *key)
{
  if (key->label) return key->label;
  return sweep_is_ambiguous(s->sweep, key) ? key->key : sweep_short_key(key);
}

/* "cohesion = 10 Pa, dilatancy_angle = 2 deg" */
static void name_curve(const SweepRun *s, PetscInt member, char name[256])
{
  size_t used = 0;
  name[0] = '\0';
  for (PetscInt a = 1; a < s->sweep->n_axes && used < 256; ++a) {
    const SweepKey *key = &s->sweep->axes[a].key;
    const char *unit = schema_unit(key->key);
    used += (size_t)snprintf(name + used, 256 - used, "%s%s = %s%s%s", a > 1 ? ", " : "", label_of(s, key),
                             key->value[sweep_at(s->sweep, member, a)], unit && unit[0] ? " " : "", unit ? unit : "");
  }
}

/* x, y and the name of a curve. Members of one curve stand `stride` apart. */
static void fill_curve(const SweepRun *s, PetscInt curve, PetscInt stride, PetscInt taken, FigureSeries *series,
                       PetscReal *x, PetscReal *y)
{
  const SweepKey *key = &s->sweep->axes[0].key;
  for (PetscInt i = 0; i < key->n; ++i) {
    x[i] = sweep_number(key, i);
    y[i] = s->members.member[curve + i * stride].values[taken];
  }
  series->style = FIGURE_LINE_MARKS;
  series->n = key->n;
  series->x = x;
  series->y = y;
}

static PetscErrorCode Draw(const SweepRun *s, PetscInt k, PetscInt n, const FigureSeries *series)
{
  const SweepMeasure *measure = &s->sweep->measures[k];
  const SweepKey *key = &s->sweep->axes[0].key;
  char png[PETSC_MAX_PATH_LEN], name[128], x[TEXT_LABEL], y[TEXT_LABEL];
  FigureBand *bands;
  PetscBool done;

  PetscFunctionBeginUser;
  taken_name_among(&s->taken[k], s->n_taken, s->taken, name);
  PetscCall(PetscSNPrintf(png, sizeof png, "%s/%s.png", s->out, name));
  for (char *c = png + strlen(s->out) + 1; *c; ++c)
    if (*c == ' ') *c = '-';
  PetscCall(PetscMalloc1(measure->n_bands, &bands));
  for (PetscInt b = 0; b < measure->n_bands; ++b)
    bands[b] = (FigureBand){measure->bands[b].name, measure->bands[b].low, measure->bands[b].high};
  const Figure figure = {
    .title = s->sweep->title,
    .x_label = text_with_unit(label_of(s, key), schema_unit(key->key), x),
    .y_label = text_with_unit(measure->taken.label ? measure->taken.label : name, s->members.member[0].units[k], y),
    .n_series = n,
    .series = series,
    .n_bands = measure->n_bands,
    .bands = bands};
  PetscCall(FigureWrite(&figure, png, s->diag, &done));
  if (done) fprintf(s->told, "picture: %s\n", png);
  PetscCall(PetscFree(bands));
  PetscFunctionReturn(0);
}

static PetscErrorCode FigureOf(const SweepRun *s, PetscInt k)
{
  const PetscInt n = s->sweep->axes[0].key.n, curves = s->members.n / n;
  FigureSeries *series;
  char(*names)[256];
  PetscReal *numbers;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(curves, &series, curves, &names, 2 * s->members.n, &numbers));
  for (PetscInt c = 0; c < curves; ++c) {
    fill_curve(s, c, curves, k, &series[c], numbers + 2 * c * n, numbers + (2 * c + 1) * n);
    name_curve(s, c, names[c]);
    series[c].name = names[c][0] ? names[c] : NULL;
  }
  PetscCall(Draw(s, k, curves, series));
  PetscCall(PetscFree3(series, names, numbers));
  PetscFunctionReturn(0);
}

/* Does the first axis have places? Words have none. */
static PetscBool has_places(const SweepKey *key)
{
  for (PetscInt i = 0; i < key->n; ++i)
    if (PetscIsNanReal(sweep_number(key, i))) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscErrorCode SweepFigures(const SweepRun *s)
{
  const SweepKey *key = &s->sweep->axes[0].key;

  PetscFunctionBeginUser;
  if (!has_places(key)) fprintf(s->told, "no picture: the values of %s are no numbers\n", key->key);
  else
    for (PetscInt k = 0; k < s->n_taken; ++k) {
      PetscBool any = PETSC_FALSE;
      for (PetscInt i = 0; i < s->members.n; ++i) any |= !PetscIsNanReal(s->members.member[i].values[k]);
      if (any) PetscCall(FigureOf(s, k));
    }
  PetscFunctionReturn(0);
}
