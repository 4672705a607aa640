#include "boundary/sides/load_sides.h"
#include "boundary/sides/cut_sides.h"
#include "points/seed/seed.h"

#define LITTLE 0.01 /* of what a load asks for: so much may go without */

PetscErrorCode FilledSides(const Grid *grid, const Points *points, const Selector *on, PetscInt *n, PetscInt **cell,
                           PetscInt **side)
{
  PetscBool *filled;
  PetscInt kept = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_cells, &filled));
  for (PetscInt p = 0; p < points->n; ++p)
    if (points->cell[p] >= 0) filled[points->cell[p]] = PETSC_TRUE;
  PetscCall(GridSelectFaces(grid, on, n, cell, side));
  for (PetscInt f = 0; f < *n; ++f)
    if (filled[(*cell)[f]]) (*cell)[kept] = (*cell)[f], (*side)[kept++] = (*side)[f];
  *n = kept;
  PetscCall(PetscFree(filled));
  PetscFunctionReturn(0);
}

/* Sides of the grid that are cut, of cells that hold points. */
static PetscErrorCode FilledCutSides(const Grid *grid, const Points *points, const Selector *on, PetscInt *n,
                                     PetscInt **cell, PetscInt **side)
{
  const Selector everywhere = {.boundary = on->boundary};
  PetscInt kept = 0;

  PetscFunctionBeginUser;
  PetscCall(FilledSides(grid, points, &everywhere, n, cell, side));
  for (PetscInt f = 0; f < *n; ++f) {
    const PetscReal share = side_share(grid, on, (*cell)[f], (*side)[f]);
    if (share > 0 && share < 1) (*cell)[kept] = (*cell)[f], (*side)[kept++] = (*side)[f];
  }
  *n = kept;
  PetscFunctionReturn(0);
}

/* Beside a body there is nothing to push. */
static void tell_empty(const Case *c, PetscBool may_come, const char *path, Diag *diag)
{
  if (may_come)
    diag_warning(diag, path,
                 "the cells at these sides of the grid hold no material: the load is nothing until some comes");
  else diag_error(diag, path, "the cells at these sides of the grid hold no material: the load would be nothing");
  diag_hint(diag, "a load on the surface of a body is `on: {body: name, ...}`, here of '%s'", c->bodies[0].name);
}

/* A traction asks for its cells' material at every step, a pressure at the start; nothing comes to a mesh that goes
 * with its body. */
static PetscBool material_may_come(const Case *c, const LoadSpec *load, PetscBool fills)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b) fills |= c->bodies[b].absent;
  return (PetscBool)(fills && load->kind == LOAD_TRACTION);
}

static PetscErrorCode TellNoFace(const Grid *grid, const Case *c, PetscInt load, const char *path, Diag *diag)
{
  const Selector *on = &c->loads[load].on;
  PetscInt n, any, *cell, *side;
  char key[96];
  const char **names;

  PetscFunctionBeginUser;
  PetscCall(GridSelectFaces(grid, on, &n, &cell, &side));
  PetscCall(MPIU_Allreduce(&n, &any, 1, MPIU_INT, MPI_SUM, grid->comm));
  if (on->boundary && !on->body && !grid_find_set(grid, on->boundary)) {
    PetscCall(PetscSNPrintf(key, sizeof key, "%s.boundary", path));
    PetscCall(GridSetNames(grid, &names));
    diag_error(diag, key, "the grid has no boundary or region named '%s'", on->boundary);
    diag_hint_names(diag, on->boundary, names);
    PetscCall(PetscFree(names));
  } else if (!on->body && any) tell_empty(c, PETSC_FALSE, path, diag);
  else diag_error(diag, path, "selects no face%s", on->body ? " of the body's boundary" : " of the grid's boundary");
  PetscCall(PetscFree(cell));
  PetscCall(PetscFree(side));
  PetscFunctionReturn(0);
}

static void tell_cut(const Case *c, PetscReal borne, PetscReal cut, PetscBool fills, const char *path, Diag *diag)
{
  const char *unit = kinematics_is_plane(c->kinematics) ? "m" : "m2";
  diag_warning(
    diag, path,
    "the load ends within sides of cells, which bear it as a whole or not at all: %.3g %s bear it, of about %.3g %s",
    (double)borne, unit, (double)(borne + cut), unit);
  if (fills)
    diag_hint(diag, "`on: {body: name, ...}` loads the surface of a shape just where it says; or let sides end there");
  else diag_hint(diag, "let sides of cells end there (nodes of the mesh), or give a value that makes up for it");
}

PetscErrorCode LoadSidesTell(const Grid *grid, const Case *c, const Points *points, PetscInt load, PetscBool fills,
                             PetscInt n_faces, const char *path, Diag *diag)
{
  const Selector *on = &c->loads[load].on;
  const PetscInt body = on->body ? case_body(c, on->body) : -1;
  PetscInt n, n_cut, filled, *cell, *side, *cut_cell, *cut_side;
  PetscReal borne, cut;

  PetscFunctionBeginUser;
  if (!n_faces) PetscCall(TellNoFace(grid, c, load, path, diag));
  if (!n_faces) PetscFunctionReturn(0);
  if (body >= 0 && body_fills_shape(&c->bodies[body], fills) && !c->bodies[body].mesh) PetscFunctionReturn(0);
  if (on->body) {
    PetscCall(BodyFaces(grid, points, body, on, PETSC_FALSE, &n, &cell, &side));
    PetscCall(BodyFaces(grid, points, body, on, PETSC_TRUE, &n_cut, &cut_cell, &cut_side));
  } else {
    PetscCall(FilledSides(grid, points, on, &n, &cell, &side));
    PetscCall(FilledCutSides(grid, points, on, &n_cut, &cut_cell, &cut_side));
  }
  PetscCall(CutSides(c->kinematics, grid, on, n, cell, side, n_cut, cut_cell, cut_side, &borne, &cut));
  PetscCall(MPIU_Allreduce(&n, &filled, 1, MPIU_INT, MPI_SUM, grid->comm));
  if (!filled) tell_empty(c, material_may_come(c, c->loads + load, fills), path, diag);
  else if (cut > LITTLE * (borne + cut)) tell_cut(c, borne, cut, fills, path, diag);
  PetscCall(PetscFree(cell));
  PetscCall(PetscFree(side));
  PetscCall(PetscFree(cut_cell));
  PetscCall(PetscFree(cut_side));
  PetscFunctionReturn(0);
}
