#include "picture/scene/field.h"
#include <stdlib.h>
#include <string.h>

static const char *const vector_names[] = {"x", "y", "z", NULL};
static const char *const tensor_names[] = {"xx", "yy", "zz", "xy", "yz", "zx", NULL};
static const char *const full_names[] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz", NULL};
static const char *const no_names[] = {NULL};

static const char *const *names_of(PetscInt components)
{
  if (components == 2 || components == 3) return vector_names;
  if (components == 6) return tensor_names;
  return components == 9 ? full_names : no_names;
}

static void set(PlotScalar *scalar, PlotReduction reduction, PetscInt component, const char *name)
{
  scalar->reduction = reduction;
  scalar->component = component;
  snprintf(scalar->name, sizeof scalar->name, "%s", name);
}

/* What invariant of its deviator a tensor is shown by: of stresses and strains by that which belongs to their work. */
static const char *invariant_of(const char *field) { return strcmp(field, "strain") ? "mises" : "deviatoric"; }

static PetscBool reduce(const char *field, PetscInt components, const char *word, PlotScalar *scalar)
{
  const PetscBool invariant = (PetscBool)(components == 6 && !strcmp(word, invariant_of(field)));
  if (!strcmp(word, "magnitude") && components > 1) set(scalar, PLOT_MAGNITUDE, 0, word);
  else if (invariant) set(scalar, word[0] == 'm' ? PLOT_MISES : PLOT_DEVIATORIC, 0, word);
  else if (!strcmp(word, "mean") && components == 6) set(scalar, PLOT_MEAN, 0, word);
  else return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscBool plot_scalar_choose(const char *field, PetscInt components, const char *word, Diag *diag, PlotScalar *scalar)
{
  const char *const *names = names_of(components);
  char *end, list[128] = "", *next = list;
  if (!word && components == 1) return set(scalar, PLOT_COMPONENT, 0, ""), PETSC_TRUE;
  if (!word) word = components == 6 ? invariant_of(field) : "magnitude";
  if (reduce(field, components, word, scalar)) return PETSC_TRUE;
  for (PetscInt i = 0; i < components && names[i]; ++i)
    if (!strcmp(word, names[i])) return set(scalar, PLOT_COMPONENT, i, word), PETSC_TRUE;
  const long number = strtol(word, &end, 10);
  if (end != word && !*end && number >= 0 && number < components)
    return set(scalar, PLOT_COMPONENT, (PetscInt)number, word), PETSC_TRUE;
  diag_error(diag, NULL, "the field '%s' has no component '%s'", field, word);
  for (PetscInt i = 0; i < components && names[i]; ++i) next += snprintf(next, 8, "%s, ", names[i]);
  if (components == 1) diag_hint(diag, "it is a single number");
  else if (components == 6) diag_hint(diag, "it has %smagnitude, %s, mean", list, invariant_of(field));
  else diag_hint(diag, "it has %smagnitude", list);
  return PETSC_FALSE;
}

static PetscReal field_magnitude(PetscInt n, const PetscReal *v)
{
  PetscReal sum = 0;
  for (PetscInt i = 0; i < n; ++i)
    sum += v[i] * v[i] * (n == 6 && i >= 3 ? 2 : 1); /* a symmetric tensor's shear counts twice */
  return PetscSqrtReal(sum);
}

static PetscReal field_mises(const PetscReal s[6])
{
  const PetscReal a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return PetscSqrtReal(0.5 * (a * a + b * b + c * c) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

PetscReal plot_scalar_value(const PlotScalar *scalar, PetscInt components, const PetscReal *values)
{
  switch (scalar->reduction) {
  case PLOT_MAGNITUDE: return field_magnitude(components, values);
  case PLOT_MISES: return field_mises(values);
  case PLOT_DEVIATORIC: return 2. / 3 * field_mises(values);
  case PLOT_MEAN: return (values[0] + values[1] + values[2]) / 3;
  default: return values[scalar->component];
  }
}
