/* What explicit dynamics does not do, by name; and how it shares the grid among the ranks. */
#include "method/transfer/transfer.h"
#include "model/explicit/explicit.h"

static void refuse(PetscBool asked, const char *path, const char *what, Diag *diag)
{
  if (!asked) return;
  diag_error(diag, path, "`type: explicit` does not take %s", what);
  diag_hint(diag, "`type: dynamic` does");
}

/* A node that a corner of a body hardly reaches has next to no mass and all of its gradient. What yields gives way. */
static void warn_of_usl(const Model *m, Diag *diag)
{
  const Case *c = m->c;
  const Basis *basis = basis_find(c->basis.kind);
  if (c->analysis.update != EXPLICIT_USL || !basis || basis->nodes != BASIS_OF_CELLS) return;
  if (specs_yield(c->n_materials, c->materials)) return;
  diag_warning(diag, "analysis.update",
               "`usl` with the functions of cells makes energy from nothing where a body ends between the grid's "
               "lines, or moves across them");
  diag_hint(diag, "`update: musl`, or `basis: gimp`");
}

void explicit_check(const Model *m, Diag *diag)
{
  const Case *c = m->c;
  if (c->analysis.type != ANALYSIS_EXPLICIT) return;
  refuse(!m->method || !m->method->restores_grid, "method", "methods other than mpm", diag);
  refuse(case_is_mixed(c), "formulation", "the mixed formulation", diag);
  const Transfer *transfer = transfer_find(c->analysis.transfer);
  refuse(transfer && transfer != transfers[0] && !transfer->slopes, "analysis.transfer",
         "transfers other than thesis and consistent", diag);
  if (transfer && transfer->slopes && c->analysis.update == EXPLICIT_USL)
    diag_error(diag, "analysis.update", "`usl` does not take transfer consistent: `musl` does");
  warn_of_usl(m, diag);
  refuse(c->analysis.keep_velocity, "analysis.keep_velocity", "`keep_velocity`", diag);
  refuse(c->basis.split > 0, "basis.gimp.split", "points that are split", diag);
  for (PetscInt k = 0; k < c->n_interfaces; ++k) {
    char path[64];
    if (c->interfaces[k].contact != CONTACT_BONDED) continue;
    snprintf(path, sizeof path, "interfaces[%d]", (int)k);
    diag_error(diag, path, "`type: explicit` does not take interfaces that are bonded");
    diag_hint(diag,
              "bodies without an interface share the nodes where they meet, and stay together; `stick` lets them part");
  }
}

PetscErrorCode ExplicitBalance(Model *m, StepReport *report)
{
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(m->comm, &size));
  if (size == 1) PetscFunctionReturn(0);
  PetscCall(ModelInitialise(m));
  PetscCall(ModelBalance(m, report));
  PetscFunctionReturn(0);
}
