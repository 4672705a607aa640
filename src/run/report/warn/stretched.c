/* What clouds do not see. In elastic material that is drawn out, those of wide functions: zigzags of its nodes grow
 * from step to step, and forces fall with them (docs/theory.md, "Meshfree bases"). And what comes from elsewhere. */
#include "run/report/warn/warn.h"
#include "base/text.h"
#include "support/cloud.h"

#define GAMMA_LEAST 1.5    /* of maximum entropy, or 1 over the square of the effective radius */
#define SHARE_ALLOWED 0.01 /* of the mass */

static PetscBool is_wide(const BasisSpec *b)
{
  if (basis_find(b->kind) == basis_find("lme")) return (PetscBool)(b->gamma < GAMMA_LEAST);
  return (PetscBool)(b->order == ORDER_QUADRATIC || b->weight == WEIGHT_CUBIC_SPLINE ||
                     PetscSqr(b->effective_radius) * GAMMA_LEAST > 1);
}

PetscErrorCode WarnOfStretch(const Model *m, Diag *diag)
{
  PetscReal sum[2] = {0, 0};
  NeighboursMap room;

  PetscFunctionBeginUser;
  if (!m->method->clouds || !is_wide(&m->c->basis) || materials_yield(m->c->n_materials, m->materials))
    PetscFunctionReturn(0);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    sum[0] += m->points->real[POINT_MASS][p];
    if (cloud_stretch_of(PETSC_TRUE, m->points, p, &room)) sum[1] += m->points->real[POINT_MASS][p];
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  if (!(sum[1] > SHARE_ALLOWED * sum[0])) PetscFunctionReturn(0);
  diag_warning(diag, "basis",
               "%.3g %% of the material is drawn out by more than a fifth, among functions so wide that its nodes need "
               "not stay even there: forces may be too small by any part",
               (double)(100 * sum[1] / sum[0]));
  diag_hint(diag, "`basis: {lme: {}}`, or linear mls with its own `effective_radius`, is right to a stretch of 2");
  PetscFunctionReturn(0);
}

void warn_of_entered(const Model *m, Diag *diag)
{
  char at[80];
  if (!m->entered.points) return;
  diag_warning(
    diag, "bodies",
    "from t = %.3g s on parts that no material joins are in each other, first at %s m in '%s': clouds of gmm "
    "do not reach from one to the other, and nothing stops them",
    (double)m->entered.time, text_position(m->dim, m->entered.place, at), m->c->bodies[m->entered.body].name);
  diag_hint(diag,
            "bodies meet at `interfaces: [{name: ..., between: [...]}]`; parts of one body that are to meet are "
            "bodies, too, which an interface with `contact: bonded` holds together elsewhere");
}
