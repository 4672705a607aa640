/* What colours mean: a range of values in a unit that suits, or names. */
#include <math.h>
#include <string.h>
#include "picture/figure.h"
#include "picture/scene/scene.h"

PetscBool plot_has_names(const char *field) { return !strcmp(field, "body") || !strcmp(field, "material"); }

const char *plot_name(const PlotScene *scene, PetscInt value, char buffer[64])
{
  const Case *c = scene->walled;
  const PetscBool body = !strcmp(scene->label, "body");
  const char *name = NULL;
  if (c && body && value >= 0 && value < c->n_bodies) name = c->bodies[value].name;
  if (c && !body && value >= 0 && value < c->n_materials) name = c->materials[value].name;
  if (name) snprintf(buffer, 64, "%.63s", name);
  else snprintf(buffer, 64, "%.20s %" PetscInt_FMT, scene->label, value);
  return buffer;
}

/* Every value of the scene, in turn: NULL after the last. */
static PetscReal *next_value(PlotScene *scene, PetscInt *frame, PetscInt *i)
{
  for (; *frame < scene->n_frames; ++*frame, *i = 0) {
    PlotFrame *f = &scene->frames[*frame];
    if (*i < f->n) return &f->value[(*i)++];
    if (*i < f->n + 3 * f->n_triangles) return &f->corner_value[(*i)++ - f->n];
  }
  return NULL;
}

static void find_range(PlotScene *scene)
{
  PetscInt frame = 0, i = 0;
  scene->low = PETSC_MAX_REAL, scene->high = -PETSC_MAX_REAL;
  for (const PetscReal *v; (v = next_value(scene, &frame, &i));)
    if (fabs(*v) < 1e300) scene->low = PetscMin(scene->low, *v), scene->high = PetscMax(scene->high, *v);
  if (scene->low > scene->high) scene->low = 0, scene->high = 1;
}

/* "velocity [m/s]", and how long arrows are. */
static void write_label(PlotScene *scene, const char *what, const char *unit)
{
  const size_t size = sizeof scene->label;
  if (unit[0]) snprintf(scene->label, size, "%.60s [%s]", what, unit);
  const size_t used = strlen(scene->label);
  if (scene->arrow_most > 0)
    snprintf(scene->label + used, size - used, ", longest arrow %.3g%s%s", (double)(scene->arrow_most * scene->factor),
             unit[0] ? " " : "", unit);
}

void plot_choose_colours(PlotScene *scene, const PlotOptions *options, const char *unit, const char *what)
{
  char prefixed[64];
  PetscInt frame = 0, i = 0;
  scene->factor = 1;
  find_range(scene);
  snprintf(scene->label, sizeof scene->label, "%.60s", what);
  if (scene->named) return;
  if (options->has_range) scene->low = options->range[0], scene->high = options->range[1];
  const PetscReal factor = figure_unit(unit, PetscMax(fabs(scene->low), fabs(scene->high)), prefixed);
  scene->factor = factor;
  for (PetscReal *v; (v = next_value(scene, &frame, &i));) *v *= factor;
  scene->low *= factor, scene->high *= factor;
  const PetscReal middle = 0.5 * (scene->low + scene->high), least = middle != 0 ? 1e-2 * fabs(middle) : 1e-12;
  if (scene->high - scene->low < 1e-4 * least) scene->low = middle - least, scene->high = middle + least;
  write_label(scene, what, prefixed);
}

void plot_find_names(const PlotScene *scene, PetscBool there[PLOT_MAX_NAMES])
{
  PetscInt frame = 0, i = 0;
  for (PetscInt k = 0; k < PLOT_MAX_NAMES; ++k) there[k] = PETSC_FALSE;
  for (const PetscReal *v; (v = next_value((PlotScene *)scene, &frame, &i));)
    if (*v >= 0 && *v < PLOT_MAX_NAMES) there[(PetscInt)(*v + 0.5)] = PETSC_TRUE;
}
