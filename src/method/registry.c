#include "method/method.h"
#include "formulation/formulation.h"
#include "method/time/time_scheme.h"
#include "method/transfer/transfer.h"

#define METHOD(symbol) extern const Method symbol;
#include "method/methods.inc"
#undef METHOD

const Method *const methods[] = {
#define METHOD(symbol) &symbol,
#include "method/methods.inc"
#undef METHOD
  NULL};

const Method *method_find(const char *name)
{
  for (PetscInt i = 0; methods[i]; ++i)
    if (!strcmp(methods[i]->name, name)) return methods[i];
  return NULL;
}

PetscBool method_takes(const Method *method, const Basis *basis)
{
  if (method->couplings) return basis->nodes == BASIS_OF_CLOUD;
  return basis->nodes == BASIS_OF_CELLS || (basis->nodes == BASIS_OF_GRID && method->restores_grid);
}

/* Must forces balance at the end of a step? Pressures do, and schemes that the case chose by their names or numbers. */
static PetscBool lacks_middle(const Case *c)
{
  const AnalysisSpec *a = &c->analysis;
  const TimeScheme *scheme = time_scheme_of(a);
  if (case_is_static(a)) return PETSC_FALSE;
  return case_is_mixed(c) || a->bossak != 0 || analysis_tunes_newmark(a) || (a->scheme && scheme && !scheme->middle);
}

/* What points carry of their gradients is out of balance on the next grid, unless forces balance in
 * the middle of a step; that is what such a case then takes, if it may (docs/theory.md 16). */
PetscBool method_transfers(const Case *c, const Transfer *transfer, const Basis *basis)
{
  return (PetscBool)(!transfer || !basis || !transfer->slopes || !basis->domains || !lacks_middle(c));
}

/* What keeps the case from having the basis by default, in words that go on behind its name; NULL: nothing. */
static const char *misfit(const Case *c, const Basis *basis)
{
  const Formulation *formulation = c->formulation ? formulation_find(c->formulation) : NULL;
  const Transfer *transfer = transfer_find(c->analysis.transfer);
  if (formulation && formulation->cells && basis->nodes != BASIS_OF_CELLS)
    return "has no cells whose points could share their volume";
  if (!method_transfers(c, transfer, basis))
    return "takes another transfer, or displacements alone and scheme midpoint";
  if (basis->domains && case_is_mixed(c) && c->kinematics && kinematics_dim(c->kinematics) == 3)
    return "takes 4 times as long with pressures in space";
  return basis->misfit ? basis->misfit(&c->grid) : NULL;
}

const char *method_basis(const Method *method, const Case *c)
{
  const char *const *name = method->bases;
  while (name[1] && misfit(c, basis_find(name[0]))) ++name;
  return name[0];
}

void method_tell_basis(const Method *method, const Case *c, size_t size, char *text)
{
  const char *kind = c->basis.kind ? c->basis.kind : "cell", *first = method->bases[0], *last = method->bases[1];
  if (!c->basis.by_default) snprintf(text, size, "%s", kind);
  else if (strcmp(kind, first))
    snprintf(text, size, "%s, since %s, the default of %s, %s", kind, first, method->name,
             misfit(c, basis_find(first)));
  else
    snprintf(text, size, "%s, the default of %s%s%s%s", kind, method->name, last ? "; basis: {" : "", last ? last : "",
             last ? ": {}} is the thesis's" : "");
}

PetscBool method_tell_transfer(const Method *method, const Case *c, size_t size, char *text)
{
  const AnalysisSpec *a = &c->analysis;
  if (!method->restores_grid || case_is_static(a)) return PETSC_FALSE;
  snprintf(text, size, "%s%s; scheme %s", a->transfer, c->transfer_why ? c->transfer_why : "", time_scheme_of(a)->name);
  return PETSC_TRUE;
}

PetscBool method_tell_scheme(const Method *method, const Case *c, size_t size, char *text)
{
  if (!c->damps_clouds) return PETSC_FALSE;
  snprintf(text, size, "%s, alpha %g, the default of %s where a law yields; analysis: {scheme: newmark} damps nothing",
           time_scheme_of(&c->analysis)->name, (double)c->analysis.bossak, method->name);
  return PETSC_TRUE;
}
