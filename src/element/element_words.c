/* A test of the command line: --test triaxial --confining 100e3 --to 0.1,0.05. */
#include <stdlib.h>
#include <string.h>
#include "element/element_spec.h"

#define MOST_STAGES 64

static const ElementTest *find_test(const char *name, Diag *diag)
{
  const char *names[16] = {NULL};
  for (int i = 0; element_tests[i]; ++i) {
    if (!strcmp(element_tests[i]->name, name)) return element_tests[i];
    names[i] = element_tests[i]->name;
  }
  diag_error(diag, NULL, "there is no test '%s'", name);
  diag_hint_names(diag, name, names);
  return NULL;
}

/* The number at *text; what stands behind it must be a comma or the end. */
static PetscReal take_number(const char *option, const char **text, Diag *diag)
{
  char *end;
  const PetscReal value = (PetscReal)strtod(*text, &end);
  if (end == *text || (*end && *end != ',') || PetscIsInfOrNanReal(value))
    diag_error(diag, NULL, "--%s: '%s' is no number", option, *text);
  *text = *end == ',' ? end + 1 : "";
  return value;
}

static PetscReal number(const char *option, const char *text, PetscReal fallback, Diag *diag)
{
  if (!text) return fallback;
  const PetscReal value = take_number(option, &text, diag);
  if (*text) diag_error(diag, NULL, "--%s takes one number", option);
  return value;
}

PetscErrorCode ElementWords(const ElementOptions *o, Diag *diag, ElementSpec *spec)
{
  const ElementStage stage = {.test = find_test(o->test, diag), .has_to = PETSC_TRUE, .undrained = o->undrained};
  const PetscReal steps = number("steps", o->steps, 100, diag);
  const char *to = o->to ? o->to : "";

  PetscFunctionBeginUser;
  if (!o->to && stage.test)
    diag_error(diag, NULL, "where does the test go? --to gives %s: %s",
               stage.test->unit ? "a pressure in Pa" : "a strain", stage.test->help);
  if (!(steps >= 1 && steps <= 1e6 && steps == PetscFloorReal(steps)))
    diag_error(diag, NULL, "--steps is a number of increments, 1 to 1000000");
  for (int k = 0; k < 3; ++k) spec->start.value[k] = -number("confining", o->confining, 0, diag);
  PetscCall(PetscCalloc1(MOST_STAGES, &spec->stages));
  while (*to && spec->n_stages < MOST_STAGES && !diag_errors(diag)) {
    ElementStage *s = &spec->stages[spec->n_stages++];
    *s = stage;
    s->to = take_number("to", &to, diag);
    s->steps = (PetscInt)steps;
  }
  if (*to && !diag_errors(diag)) diag_error(diag, NULL, "--to has more than %d places", MOST_STAGES);
  PetscFunctionReturn(0);
}
