/* Points and their runs, and what follows from them. */
#include <ctype.h>
#include <math.h>
#include <string.h>
#include "calibrate/calibrate_private.h"
#include "calibrate/parameter.h"

/* With the values of all parameters for their names. */
static PetscErrorCode Settings(const CalibrateRun *r, const Instrument *instrument, const PetscReal *x,
                               SettingList *set)
{
  char text[32];

  PetscFunctionBeginUser;
  PetscCall(SettingListAppend(set, &r->c->set, NULL, NULL));
  PetscCall(SettingListAppend(set, &instrument->set, NULL, NULL));
  if (r->options->quick) PetscCall(SettingListAppend(set, &r->c->quick, NULL, NULL));
  if (r->options->quick) PetscCall(SettingListAppend(set, &instrument->quick, NULL, NULL));
  for (PetscInt p = 0; p < r->c->n_parameters; ++p) {
    SettingList replaced = {0};
    PetscCall(
      SettingListAppend(&replaced, set, r->c->parameters[p].name, parameter_text(&r->c->parameters[p], x[p], text)));
    PetscCall(SettingListClear(set));
    *set = replaced;
  }
  PetscFunctionReturn(0);
}

/* friction=41.2,cohesion=10 */
static void name_point(const CalibrateRun *r, const PetscReal *x, char name[200])
{
  char text[32];
  size_t used = 0;
  for (PetscInt p = 0; p < r->c->n_parameters && used < 200; ++p)
    used += (size_t)snprintf(name + used, 200 - used, "%s%.40s=%s", p ? "," : "", r->c->parameters[p].name,
                             parameter_text(&r->c->parameters[p], x[p], text));
  for (char *c = name; *c; ++c)
    if (!isalnum((unsigned char)*c) && !strchr("._-+=,", *c)) *c = '_';
}

static PetscErrorCode AddMember(CalibrateRun *r, PetscInt i, const char *name, const PetscReal *x)
{
  const Instrument *instrument = &r->c->instruments[i];
  char full[256];
  Member *m;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(full, sizeof full, "%.50s/%.200s", instrument->name, name));
  PetscCall(MembersAdd(&r->members, r->out, full, r->cases[i], instrument->n_targets, instrument->taken, &m));
  PetscCall(Settings(r, instrument, x, &m->set));
  PetscCall(MemberPlan(&r->members, m, r->diag));
  if (diag_errors(r->diag))
    yaml_error(r->c->document, r->diag, yaml_find(r->c->document->root, "instruments")->child[i], PETSC_TRUE,
               "the case of %s cannot be run", full);
  PetscFunctionReturn(0);
}

/* Few digits, as names of directories want them, but so many that the point stays the same to all targets. */
static void round_point(const CalibrateRun *r, const PetscReal *x, PetscBool meets, PetscReal *at)
{
  enum { FINEST = 5 };
  for (int finer = 0; finer <= FINEST; ++finer) {
    for (PetscInt p = 0; p < r->c->n_parameters; ++p) at[p] = parameter_round(&r->c->parameters[p], x[p], finer);
    if (!r->region.n || region_alike(&r->region, x, at, meets)) return;
  }
}

PetscErrorCode CalibrateAdd(CalibrateRun *r, const PetscReal *x, PetscBool meets, PetscInt *point)
{
  const PetscInt dim = r->c->n_parameters;
  PetscReal at[SURROGATE_MOST];
  char name[200];

  PetscFunctionBeginUser;
  round_point(r, x, meets, at);
  name_point(r, at, name);
  for (*point = 0; *point < r->n; ++*point) {
    PetscBool same;
    PetscCall(PetscArraycmp(r->x + *point * dim, at, dim, &same));
    if (same) PetscFunctionReturn(0);
  }
  PetscCall(PetscRealloc((size_t)((r->n + 1) * dim) * sizeof(PetscReal), &r->x));
  PetscCall(PetscArraycpy(r->x + r->n * dim, at, dim));
  ++r->n;
  for (PetscInt i = 0; i < r->c->n_instruments && !diag_errors(r->diag); ++i) PetscCall(AddMember(r, i, name, at));
  PetscFunctionReturn(0);
}

PetscErrorCode CalibrateDesign(CalibrateRun *r)
{
  const PetscInt dim = r->c->n_parameters, corners = (PetscInt)1 << dim;
  const PetscInt first = 2 * corners <= r->c->points ? corners : 0;
  PetscReal x[SURROGATE_MOST];
  PetscInt point;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->c->points && !diag_errors(r->diag); ++i) {
    if (i < first)
      for (PetscInt d = 0; d < dim; ++d) x[d] = (PetscReal)(i >> d & 1);
    else region_halton(dim, i - first, x);
    PetscCall(CalibrateAdd(r, x, PETSC_FALSE, &point));
  }
  PetscFunctionReturn(0);
}

PetscReal calibrate_found(const CalibrateRun *r, PetscInt point, PetscInt k)
{
  return r->members.member[point * r->c->n_instruments + r->instrument[k]].values[r->number[k]];
}

static PetscErrorCode FitTarget(CalibrateRun *r, PetscInt k, PetscReal *x, PetscReal *y)
{
  const PetscInt dim = r->c->n_parameters;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->n && n < SURROGATE_RUNS; ++i) {
    const PetscReal value = calibrate_found(r, i, k);
    if (PetscIsInfOrNanReal(value)) continue;
    PetscCall(PetscArraycpy(x + n * dim, r->x + i * dim, dim));
    y[n++] = value;
  }
  PetscCall(SurrogateDestroy(&r->surrogate[k]));
  if (n >= dim + 4) PetscCall(SurrogateCreate(dim, n, x, y, &r->surrogate[k]));
  else
    diag_error(r->diag, NULL, "%s of %s came out of %" PetscInt_FMT " runs: that is too few to learn from",
               r->target[k]->taken.measure, r->c->instruments[r->instrument[k]].name, n);
  PetscFunctionReturn(0);
}

PetscErrorCode CalibrateFit(CalibrateRun *r)
{
  PetscReal *x, *y;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(r->n * r->c->n_parameters, &x, r->n, &y));
  for (PetscInt k = 0; k < r->n_targets; ++k) PetscCall(FitTarget(r, k, x, y));
  PetscCall(PetscFree2(x, y));
  PetscCall(RegionDestroy(&r->region));
  if (!diag_errors(r->diag))
    PetscCall(RegionCreate(r->c->n_parameters, r->n_targets, r->target, r->surrogate, &r->region));
  PetscFunctionReturn(0);
}
