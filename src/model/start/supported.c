/* Which method, formulation, basis, time scheme and transfer go together. */
#include <string.h>
#include "method/transfer/transfer.h"
#include "model/model_private.h"

/* "mpm, fem and gmm", or of these the ones that take the pressure as an unknown. */
static void list_methods(PetscBool pressure, size_t size, char *text)
{
  PetscInt n = 0, k = 0;
  for (const Method *const *method = methods; *method; ++method) n += !pressure || (*method)->takes_pressure;
  text[0] = 0;
  for (const Method *const *method = methods; *method; ++method) {
    const size_t used = strlen(text);
    if (pressure && !(*method)->takes_pressure) continue;
    snprintf(text + used, size - used, "%s%s", k == 0 ? "" : k == n - 1 ? " and " : ", ", (*method)->name);
    ++k;
  }
}

static void check_formulation(const Model *m, Diag *diag)
{
  const char *name = m->c->formulation;
  char list[256];
  if (!m->formulation)
    diag_error(diag, "formulation",
               "formulation '%s' is not part of this version; displacement, mean-dilatation and mixed are", name);
  if (m->formulation && m->formulation->cells && m->method && m->method->clouds)
    diag_error(diag, "formulation",
               "formulation '%s' shares the volume of a cell among its points, and method %s has no cells; mpm and "
               "fem have",
               name, m->method->name);
  if (!m->formulation || !m->formulation->pressure || !m->method || m->method->takes_pressure) return;
  list_methods(PETSC_TRUE, sizeof list, list);
  diag_error(diag, "formulation",
             "formulation '%s' is not part of this version for method %s, which takes displacement; %s take both", name,
             m->method->name, list);
}

static void check_basis(const Model *m, Diag *diag)
{
  const BasisSpec *spec = &m->c->basis;
  const Basis *basis = basis_find(spec->kind);
  const char *misfit = basis && basis->misfit ? basis->misfit(&m->c->grid) : NULL;
  char path[64];
  if (m->formulation && m->formulation->cells && m->method && !m->method->clouds && basis &&
      basis->nodes != BASIS_OF_CELLS)
    diag_error(diag, "formulation", "formulation '%s' takes no other basis than 'cell', not '%s'", m->c->formulation,
               spec->kind);
  if (!basis || (m->method && !method_takes(m->method, basis)))
    diag_error(diag, "basis", "method %s does not take the basis '%s'", m->c->method, spec->kind ? spec->kind : "cell");
  else if (misfit) {
    snprintf(path, sizeof path, "basis.%s", spec->kind);
    diag_error(diag, path, "basis '%s' %s", spec->kind, misfit);
    diag_hint(diag, "'cell' takes every grid");
  }
}

/* Nodes that keep their motion, and pressures, are known at the ends of steps. */
static void check_middle(const Case *c, const TimeScheme *scheme, const Method *method, Diag *diag)
{
  if (method && !method->restores_grid)
    diag_error(diag, "analysis.scheme", "scheme %s is for method mpm, whose nodes keep no acceleration", scheme->name);
  if (case_is_mixed(c))
    diag_error(diag, "analysis.scheme",
               "scheme %s knows no pressure at the end of a step; it takes displacements alone", scheme->name);
}

static void check_scheme(const Case *c, const TimeScheme *scheme, const Method *method, Diag *diag)
{
  const char *names[32] = {NULL};
  for (PetscInt i = 0; time_schemes[i] && i < 31; ++i) names[i] = time_schemes[i]->name;
  if (scheme && !scheme->middle) return;
  if (scheme) {
    check_middle(c, scheme, method, diag);
    return;
  }
  diag_error(diag, "analysis.scheme", "there is no time scheme '%s'", c->analysis.scheme);
  diag_hint_names(diag, c->analysis.scheme, names);
}

/* Nodes of a cloud move with the field and not with their coefficients: they have no frames. */
static void check_slip(const Case *c, const Method *method, Diag *diag)
{
  char path[64];
  for (PetscInt k = 0; k < c->n_boundary && method->clouds; ++k) {
    PetscSNPrintf(path, sizeof path, "boundary[%d].fix", (int)k);
    if (c->boundary[k].component[NORMAL])
      diag_error(diag, path, "method %s cannot let nodes slide along a normal: mpm and fem can", method->name);
  }
}

static void check_transfer(const Case *c, const Method *method, Diag *diag)
{
  const Transfer *transfer = transfer_find(c->analysis.transfer);
  const char *names[32] = {NULL};
  for (PetscInt i = 0; transfers[i] && i < 31; ++i) names[i] = transfers[i]->name;
  if (!transfer) {
    diag_error(diag, "analysis.transfer", "there is no transfer '%s'", c->analysis.transfer);
    diag_hint_names(diag, c->analysis.transfer, names);
  } else if (!method->restores_grid && transfer != transfers[0]) {
    diag_error(diag, "analysis.transfer", "nodes of method %s keep their motion; only mpm takes it from points",
               method->name);
  } else if (c->analysis.keep_velocity && !transfer->keeps_velocity) {
    diag_error(diag, "analysis.keep_velocity", "is the floor of transfer thesis; transfer %s knows no such floor",
               transfer->name);
  } else if (c->analysis.type == ANALYSIS_DYNAMIC && transfer->slopes && basis_find(c->basis.kind)->domains &&
             !time_scheme_of(&c->analysis)->middle) {
    diag_error(
      diag, "analysis.scheme",
      "transfer %s with basis %s takes scheme midpoint: an acceleration that points carry is out of balance on "
      "the next grid, and makes energy",
      transfer->name, c->basis.kind);
    diag_hint(diag, "midpoint is what it takes where the case names neither scheme nor bossak");
  }
}

void supported_check(const Model *m, Diag *diag)
{
  const Case *c = m->c;
  char list[256];
  list_methods(PETSC_FALSE, sizeof list, list);
  if (!m->method) diag_error(diag, "method", "method '%s' is not part of this version; %s are", c->method, list);
  check_formulation(m, diag);
  check_basis(m, diag);
  check_scheme(c, m->scheme, m->method, diag);
  explicit_check(m, diag);
  if (m->method) check_transfer(c, m->method, diag);
  if (m->method) room_check(m, diag);
  if (!m->method || m->method->restores_grid) return;
  check_slip(c, m->method, diag);
  if (c->analysis.keep_velocity)
    diag_error(diag, "analysis.keep_velocity",
               "only points of method mpm have a velocity apart from that of the nodes");
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    char path[64];
    PetscSNPrintf(path, sizeof path, "bodies[%d].mesh", (int)b);
    if (c->bodies[b].mesh)
      diag_error(diag, path,
                 "a body with a mesh of its own needs method mpm; for fem and gmm give that mesh as grid.mesh");
  }
}
