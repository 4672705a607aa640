#include "boundary/sides/box_side.h"
#include "boundary/surface/surface.h"

#define LITTLE 0.01 /* of what bodies have: sides of cells may have so much more */
#define SAME 1e-9   /* of the box: places so near are one */

void put_on_side(const Grid *grid, Selector *on)
{
  for (PetscInt side = 0; grid->box && on->boundary && side < 2 * grid->dim; ++side) {
    const PetscInt axis = side / 2;
    const PetscReal at = side % 2 ? grid->max[axis] : grid->min[axis];
    if (strcmp(on->boundary, box_side_name(axis, side % 2))) continue;
    on->min[axis] = on->has[axis] ? PetscMax(at, on->min[axis]) : at;
    on->max[axis] = on->has[axis] ? PetscMin(at, on->max[axis]) : at;
    on->has[axis] = PETSC_TRUE;
    on->boundary = NULL;
  }
}

PetscErrorCode SurfaceArea(const Grid *grid, const Case *c, PetscInt body, const Selector *on, PetscReal *area)
{
  PetscInt n, *cell;
  FacePoint *q;

  PetscFunctionBeginUser;
  *area = 0;
  PetscCall(BodySurfacePoints(grid, c, body, on, PETSC_FALSE, &n, &cell, &q));
  for (PetscInt k = 0; k < n; ++k) *area += q[k].area;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, area, 1, MPIU_REAL, MPIU_SUM, grid->comm));
  PetscCall(PetscFree(cell));
  PetscCall(PetscFree(q));
  PetscFunctionReturn(0);
}

/* Is all that it takes at one side of the box? */
static PetscBool is_on_side(const Grid *grid, const Selector *on)
{
  for (PetscInt d = 0; grid->box && !on->boundary && d < grid->dim; ++d) {
    const PetscReal near = SAME * (grid->max[d] - grid->min[d]);
    if (!on->has[d]) continue;
    if (on->min[d] > grid->max[d] - near || on->max[d] < grid->min[d] + near) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Do all bodies end where their shapes do? */
static PetscBool all_fill(const Case *c, PetscBool fills)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (body_bearer(c->bodies + b, fills) != BORNE_BY_SHAPE || c->bodies[b].region) return PETSC_FALSE;
  return PETSC_TRUE;
}

static void tell_uncovered(const Case *c, const char *boundary, PetscReal borne, PetscReal area, PetscInt most,
                           const char *path, Diag *diag)
{
  const char *unit = kinematics_is_plane(c->kinematics) ? "m" : "m2";
  diag_warning(diag, path, "the sides of cells that bear it have %.4g %s, the bodies %.4g %s of them", (double)borne,
               unit, (double)area, unit);
  if (area > 0)
    diag_hint(diag, "`on: {body: %s, boundary: %s}` loads just what the body has there", c->bodies[most].name,
              boundary ? boundary : "...");
  else diag_hint(diag, "no body reaches that side: `on: {body: %s, ...}` loads its surface", c->bodies[most].name);
}

PetscErrorCode TellUncovered(const Grid *grid, const Case *c, const Selector *on, PetscBool fills, PetscReal borne,
                             const char *path, Diag *diag)
{
  Selector side = *on;
  PetscReal all = 0, largest = -1, area;
  PetscInt most = 0;

  PetscFunctionBeginUser;
  put_on_side(grid, &side);
  if (case_goes_on(c) || !is_on_side(grid, &side) || !all_fill(c, fills)) PetscFunctionReturn(0);
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    if (c->bodies[b].absent) continue;
    PetscCall(SurfaceArea(grid, c, b, &side, &area));
    all += area;
    if (area > largest) largest = area, most = b;
  }
  if (borne > (1 + LITTLE) * all) tell_uncovered(c, on->boundary, borne, all, most, path, diag);
  PetscFunctionReturn(0);
}
