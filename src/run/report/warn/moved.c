/* Loaded surfaces that have left the cells beside which their stress is right. */
#include "run/report/warn/warn.h"

/* cells that a loaded surface may move: until points beside it cross to the next one */
#define WAY_ALLOWED 0.5
#define WAY_ALLOWED_YIELDING 0.15 /* a block of four cells that yields beside it bears 6 % too little at 0.2 */

/* Does stress stand where loads on a surface are borne? Not where these are points, and see what points of no extent
 * do, nor in the mixed formulation, whose nodes at corners follow nobody. */
static PetscBool bears_where_loaded(const Model *m)
{
  return (PetscBool)(loads_have_pieces(m->loads) && !case_is_mixed(m->c));
}

/* One that is loaded now. */
static PetscBool is_surface(const LoadSpec *load)
{
  return (PetscBool)(load->kind != LOAD_POINT && !load->waits && load_pushes(load));
}

/* Of the carriers of surfaces: how far the farthest has come, in cells. */
static PetscReal way_of_carriers(const Model *m)
{
  const Points *carriers = m->loads->carriers;
  PetscReal most = 0;
  for (PetscInt p = 0; p < carriers->n; ++p)
    for (PetscInt d = 0; d < m->dim && is_surface(m->c->loads + carriers->body[p]); ++d)
      most = PetscMax(most, PetscAbsReal(point_real(carriers, POINT_U, p)[d]) / m->grid->smallest);
  return most;
}

PetscErrorCode LoadsMoved(const Model *m, PetscReal *moved)
{
  const PetscBool yields = materials_yield(m->c->n_materials, m->materials);
  PetscReal local, most;

  PetscFunctionBeginUser;
  *moved = 0;
  if (!m->method->restores_grid || bears_where_loaded(m)) PetscFunctionReturn(0);
  local = way_of_carriers(m);
  PetscCall(MPIU_Allreduce(&local, &most, 1, MPIU_REAL, MPIU_MAX, m->comm));
  if (most > (yields ? WAY_ALLOWED_YIELDING : WAY_ALLOWED)) *moved = most;
  PetscFunctionReturn(0);
}

PetscErrorCode WarnOfMovedLoads(const Model *m, Diag *diag)
{
  PetscReal most;

  PetscFunctionBeginUser;
  PetscCall(LoadsMoved(m, &most));
  if (!most) PetscFunctionReturn(0);
  diag_warning(diag, "loads", "a loaded surface has moved by %.2g cells: with %s", (double)most,
               loads_have_pieces(m->loads)
                 ? "the mixed formulation stresses of points beside it may be wrong by a tenth of the load"
                 : "these shape functions corners and stresses beside it may be wrong by several per cent, with "
                   "linear ones by any amount");
  diag_hint(diag, "%s, or compare with fem (docs/theory.md, section 67)",
            case_is_mixed(m->c) ? "`formulation: displacement`" : "`basis: {gimp: {}}` on a box");
  PetscFunctionReturn(0);
}
