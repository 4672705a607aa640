/* The material of a case as its points have it when a run begins. */
#include <string.h>
#include "element/element_spec.h"
#include "model/model.h"

#define SAME 1e-6 /* of a size */

static void divide(const Case *c, PetscInt i, ElementSpec *spec)
{
  const PetscReal factor = c->strength.factor;
  if (!(factor > 0) || !spec->material.law->reduce || !case_reduces_material(c, i)) return;
  material_reduce(&spec->material, factor);
  spec->divided = factor;
}

/* Do two points in cells of different size begin differently? */
static PetscBool asks_for_size(const Material *m)
{
  PetscReal state[2][LAW_MAX_STATE];
  if (!m->law->size) return PETSC_FALSE;
  for (int k = 0; k < 2; ++k) {
    law_initial_state(m->law, state[k]);
    m->law->size(m->parameters, k + 1, state[k]);
  }
  return (PetscBool)(memcmp(state[0], state[1], (size_t)m->law->n_state * sizeof state[0][0]) != 0);
}

static PetscBool has_material(const Case *c, PetscInt b, PetscInt i)
{
  return (PetscBool)!strcmp(c->bodies[b].material, c->materials[i].name);
}

/* "0.25 to 0.5 m in 'a', 1 m in 'b'" */
static void list_sizes(const Case *c, PetscInt i, const PetscReal *range, size_t size, char *text)
{
  size_t used = 0;
  for (PetscInt b = 0; b < c->n_bodies && used < size; ++b) {
    const PetscReal *r = range + 2 * b;
    if (!has_material(c, b, i) || !(r[1] > 0)) continue;
    used += (size_t)snprintf(text + used, size - used, "%s%.4g", used ? ", " : "", (double)r[0]);
    if (used < size && r[1] > (1 + SAME) * r[0])
      used += (size_t)snprintf(text + used, size - used, " to %.4g", (double)r[1]);
    if (used < size) used += (size_t)snprintf(text + used, size - used, " m in '%s'", c->bodies[b].name);
  }
}

/* The smallest of all its bodies; where they differ that is said. */
static void choose_size(const Case *c, PetscInt i, const PetscReal *range, Diag *diag, ElementSpec *spec)
{
  PetscReal largest = 0;
  char list[512] = "";
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    const PetscReal *r = range + 2 * b;
    if (!has_material(c, b, i) || !(r[1] > 0)) continue;
    spec->cell = spec->cell > 0 ? PetscMin(spec->cell, r[0]) : r[0];
    largest = PetscMax(largest, r[1]);
  }
  list_sizes(c, i, range, sizeof list, list);
  if (spec->cell == 0) {
    diag_warning(diag, NULL, "how large the cells of '%s' are is not known: the point is in one of its reference_size",
                 spec->material.name);
    diag_hint(diag, "`talus check` says what is wrong with its bodies or their grid");
  } else if (largest > (1 + SAME) * spec->cell)
    diag_warning(diag, NULL, "cells of '%s' are not of one size, %s: the point is in one of %.4g m",
                 spec->material.name, list, (double)spec->cell);
}

static PetscErrorCode Measure(const Case *c, PetscInt i, Diag *diag, ElementSpec *spec)
{
  PetscReal *range;
  Diag *ignored;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * c->n_bodies, &range));
  PetscCall(DiagCreate(&ignored));
  PetscCall(ModelCellSizes(c, ignored, range));
  PetscCall(DiagDestroy(&ignored));
  choose_size(c, i, range, diag, spec);
  PetscCall(PetscFree(range));
  PetscFunctionReturn(0);
}

PetscErrorCode ElementMaterial(const Case *c, PetscInt i, Diag *diag, ElementSpec *spec)
{
  PetscFunctionBeginUser;
  PetscCall(MaterialResolve(c, i, diag, &spec->material));
  if (diag_errors(diag)) PetscFunctionReturn(0);
  divide(c, i, spec);
  if (asks_for_size(&spec->material)) PetscCall(Measure(c, i, diag, spec));
  PetscFunctionReturn(0);
}
