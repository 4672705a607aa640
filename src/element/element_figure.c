/* One picture of a path: q over p', and what the point does over its strain. */
#include <stdio.h>
#include "base/text.h"
#include "element/element_table.h"
#include "picture/figure.h"

enum { N_PANELS = 4, NAMED = 1 }; /* one legend is enough */

/* What is drawn along an axis: a column times a factor. */
typedef struct {
  const char *label, *unit;
  PetscInt column;
  PetscReal factor;
} Along;

static const Along pressure = {"p'", "Pa", ELEMENT_P, 1}, deviator = {"q", "Pa", ELEMENT_Q, 1};
static const Along axial = {"axial shortening, -ln of the stretch along y", "", ELEMENT_STRAIN + 1, -1};
static const Along shear = {"shear xy, F_xy / F_yy", "", ELEMENT_SHEAR, 1};
static const Along volume = {"ln of the volume", "", ELEMENT_VOLUME, 1};
static const Along pore = {"pore pressure", "Pa", ELEMENT_PORE, 1};
static const Along friction = {"mobilised friction", "deg", ELEMENT_FRICTION, 1};

typedef struct {
  Along x, y;
  char x_label[TEXT_LABEL], y_label[TEXT_LABEL];
  PetscReal *x_values, *y_values;
  FigureSeries *series; /* a stage each */
} Panel;

static PetscReal largest(const ElementTable *t, PetscInt column)
{
  PetscReal value = 0;
  for (PetscInt i = 0; i < t->n; ++i) value = PetscMax(value, PetscAbsReal(element_value(t, i, column)));
  return value;
}

static void fill_values(const ElementTable *t, const Along *along, PetscReal *values, char label[TEXT_LABEL])
{
  char unit[64];
  const PetscReal factor = figure_unit(along->unit, largest(t, along->column), unit);
  for (PetscInt i = 0; i < t->n; ++i) values[i] = along->factor * factor * element_value(t, i, along->column);
  text_with_unit(along->label, unit, label);
}

/* A curve for each stage, which begins where the one before it has ended; names: NULL, or one each. */
static PetscInt fill_series(const ElementTable *t, const Panel *panel, PetscInt n_stages, char (*names)[80])
{
  PetscInt n = 0, first = 0;
  for (PetscInt s = 1; s <= n_stages; ++s) {
    PetscInt last = first;
    while (last + 1 < t->n && (PetscInt)element_value(t, last + 1, ELEMENT_STAGE) == s) ++last;
    if (last == first) break;
    panel->series[n++] = (FigureSeries){.name = names ? names[s - 1] : NULL,
                                        .n = last - first + 1,
                                        .x = panel->x_values + first,
                                        .y = panel->y_values + first};
    first = last;
  }
  return n;
}

/* Does any stage lead xy? Then the strain is the shear, else the shortening of the axis. */
static const Along *strain_of(const ElementSpec *spec)
{
  for (PetscInt s = 0; s < spec->n_stages; ++s) {
    const ElementStage *stage = &spec->stages[s];
    if (stage->test ? stage->test->component == 3 : stage->strain.given[3] || stage->stress.given[3]) return &shear;
  }
  return &axial;
}

static PetscBool is_undrained(const ElementSpec *spec)
{
  for (PetscInt s = 0; s < spec->n_stages; ++s)
    if (spec->stages[s].undrained) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void choose(const ElementSpec *spec, Panel panels[N_PANELS])
{
  const Along *strain = strain_of(spec);
  const PetscBool undrained = is_undrained(spec);
  const Along pairs[N_PANELS][2] = {{pressure, deviator},
                                    {*strain, deviator},
                                    {*strain, undrained ? pore : volume},
                                    {undrained ? *strain : pressure, undrained ? friction : volume}};
  for (int k = 0; k < N_PANELS; ++k) panels[k].x = pairs[k][0], panels[k].y = pairs[k][1];
}

PetscErrorCode ElementFigure(const ElementSpec *spec, const ElementTable *t, const char *png, Diag *diag,
                             PetscBool *done)
{
  Panel panels[N_PANELS] = {0};
  Figure figures[N_PANELS] = {0};
  char(*names)[80], text[60];

  PetscFunctionBeginUser;
  choose(spec, panels);
  PetscCall(PetscCalloc1(spec->n_stages, &names));
  for (PetscInt s = 0; s < spec->n_stages; ++s)
    snprintf(names[s], sizeof names[s], "%d %s", (int)s + 1, element_stage_name(&spec->stages[s], sizeof text, text));
  for (int k = 0; k < N_PANELS; ++k) {
    Panel *panel = &panels[k];
    PetscCall(PetscMalloc3(t->n, &panel->x_values, t->n, &panel->y_values, spec->n_stages, &panel->series));
    fill_values(t, &panel->x, panel->x_values, panel->x_label);
    fill_values(t, &panel->y, panel->y_values, panel->y_label);
    figures[k] =
      (Figure){.x_label = panel->x_label,
               .y_label = panel->y_label,
               .n_series = fill_series(t, panel, spec->n_stages, k == NAMED && spec->n_stages > 1 ? names : NULL),
               .series = panel->series};
  }
  PetscCall(FigureSheet(spec->title, N_PANELS, figures, 2, png, diag, done));
  for (int k = 0; k < N_PANELS; ++k) PetscCall(PetscFree3(panels[k].x_values, panels[k].y_values, panels[k].series));
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}
