#include "boundary/sides/load_sides.h"
#include "boundary/sides/box_side.h"
#include "boundary/sides/cut_sides.h"
#include "boundary/sides/side_keys.h"
#include "boundary/surface/surface.h"

#define LITTLE 0.01 /* of what a load asks for: so much may go without */
#define STEPS 0.03  /* of the area of a shape: by so much the sides of cells may have more, */
#define PART 0.15   /* and of a part of it, beside which there may be slivers of other sides */

static PetscErrorCode FilledCells(const Grid *grid, const Points *points, PetscBool **filled)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_cells, filled));
  for (PetscInt p = 0; p < points->n; ++p)
    if (points->cell[p] >= 0) (*filled)[points->cell[p]] = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode SidesOfGrid(const Grid *grid, const Points *points, const Selector *on, PetscInt *n, PetscInt **cell,
                           PetscInt **side)
{
  PetscBool *filled;
  PetscInt both;

  PetscFunctionBeginUser;
  PetscCall(FilledCells(grid, points, &filled));
  PetscCall(GridSelectFaces(grid, on, n, cell, side));
  PetscCall(SidesFromMaterial(grid, filled, n, cell, side, &both));
  PetscCall(PetscFree(filled));
  PetscFunctionReturn(0);
}

PetscErrorCode FilledSides(const Grid *grid, const Points *points, const Selector *on, PetscInt *n, PetscInt **cell,
                           PetscInt **side, PetscInt *both)
{
  PetscBool *filled;
  PetscInt kept = 0;

  PetscFunctionBeginUser;
  PetscCall(FilledCells(grid, points, &filled));
  PetscCall(GridSelectFaces(grid, on, n, cell, side));
  PetscCall(SidesFromMaterial(grid, filled, n, cell, side, both));
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
  PetscInt kept = 0, both;

  PetscFunctionBeginUser;
  PetscCall(FilledSides(grid, points, &everywhere, n, cell, side, &both));
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

/* On a body: is the name that of a boundary of its own mesh, or at least of the grid? */
static PetscErrorCode CheckOwnMesh(const Grid *grid, const Case *c, const Selector *on, const char *path, Diag *diag,
                                   PetscBool *good)
{
  Grid *own;

  PetscFunctionBeginUser;
  PetscCall(BodyMeshAgain(grid, c, case_body(c, on->body), &own));
  if (own && !grid_find_set(grid, on->boundary)) PetscCall(GridCheckBoundary(own, on->boundary, path, diag, good));
  PetscCall(GridDestroy(&own));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckName(const Grid *grid, const Case *c, const Selector *on, PetscBool fills, const char *path,
                                Diag *diag, PetscBool *good)
{
  const Bearer bearer = on->body ? body_bearer(c->bodies + case_body(c, on->body), fills) : BORNE_BY_CELLS;
  char key[96];

  PetscFunctionBeginUser;
  *good = PETSC_TRUE;
  if (!on->boundary) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(key, sizeof key, "%s.boundary", path));
  if (bearer == BORNE_BY_MESH) PetscCall(CheckOwnMesh(grid, c, on, key, diag, good));
  else PetscCall(GridCheckBoundary(grid, on->boundary, key, diag, good));
  if (!*good || bearer != BORNE_BY_SHAPE || grid->box) PetscFunctionReturn(0);
  *good = PETSC_FALSE;
  diag_error(diag, key, "'%s' cuts the cells of the mesh with its shape, whose surface has no boundaries with names",
             on->body);
  diag_hint(diag, "say where it is: x, y, z or shape");
  PetscFunctionReturn(0);
}

/* A side of the box where the body does not end. */
static void tell_side(const Grid *grid, const Selector *on, Diag *diag)
{
  for (PetscInt side = 0; side < 2 * grid->dim; ++side) {
    const PetscInt axis = side / 2;
    if (strcmp(on->boundary, box_side_name(axis, side % 2))) continue;
    diag_hint(diag, "'%s' is the side of the grid at %c = %g m: a side of '%s' elsewhere is `on: {body: %s, %c: ...}`",
              on->boundary, "xyz"[axis], (double)(side % 2 ? grid->max[axis] : grid->min[axis]), on -> body, on -> body,
              "xyz"[axis]);
  }
}

static PetscErrorCode TellNoFace(const Grid *grid, const Case *c, PetscInt load, PetscBool fills, const char *path,
                                 Diag *diag)
{
  const Selector *on = &c->loads[load].on;
  PetscInt n, any, *cell, *side;
  PetscBool good;

  PetscFunctionBeginUser;
  PetscCall(CheckName(grid, c, on, fills, path, diag, &good));
  if (!good) PetscFunctionReturn(0);
  PetscCall(GridSelectFaces(grid, on, &n, &cell, &side));
  PetscCall(MPIU_Allreduce(&n, &any, 1, MPIU_INT, MPI_SUM, grid->comm));
  if (!on->body && any) tell_empty(c, PETSC_FALSE, path, diag);
  else diag_error(diag, path, "selects no face%s", on->body ? " of the body's boundary" : " of the grid's boundary");
  if (on->body && on->boundary && grid->box) tell_side(grid, on, diag);
  PetscCall(PetscFree(cell));
  PetscCall(PetscFree(side));
  PetscFunctionReturn(0);
}

/* A pressure pushes into the material, and has no way where that is on both sides. */
static void tell_between(const Selector *on, PetscInt both, const char *path, Diag *diag)
{
  diag_error(diag, path, "%d of these sides lie within the material: a pressure there has no direction", (int)both);
  diag_hint(diag, "say which body it pushes: `on: {body: ..., boundary: %s}`", on->boundary ? on->boundary : "...");
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

/* A traction on the steps of cells that do not follow their shape: as much larger than on the shape as they are. */
static PetscErrorCode TellSteps(const Grid *grid, const Case *c, const LoadSpec *load, PetscReal borne,
                                const char *path, Diag *diag)
{
  const PetscInt body = case_body(c, load->on.body);
  const char *unit = kinematics_is_plane(c->kinematics) ? "m" : "m2";
  const PetscBool is_part = (PetscBool)(load->on.has_shape || load->on.has[0] || load->on.has[1] || load->on.has[2]);
  PetscReal area;

  PetscFunctionBeginUser;
  if (load->kind != LOAD_TRACTION || !c->bodies[body].has_shape || load->on.boundary) PetscFunctionReturn(0);
  PetscCall(SurfaceArea(grid, c, body, &load->on, &area));
  if (!(area > 0) || PetscAbsReal(borne - area) < (is_part ? PART : STEPS) * area) PetscFunctionReturn(0);
  diag_warning(diag, path, "the sides of cells that bear it have %.4g %s, the surface of the shape %.4g %s",
               (double)borne, unit, (double)area, unit);
  diag_hint(diag,
            "'%s' is made of whole cells: a value that is %.3g times as large has the force that the shape would "
            "have",
            load->on.body, (double)(area / borne));
  PetscFunctionReturn(0);
}

PetscErrorCode LoadSidesTell(const Grid *grid, const Case *c, const Points *points, PetscInt load, PetscBool fills,
                             PetscInt n_faces, const char *path, Diag *diag)
{
  const Selector *on = &c->loads[load].on;
  const PetscInt body = on->body ? case_body(c, on->body) : -1;
  PetscInt n, n_cut, filled, both = 0, *cell, *side, *cut_cell, *cut_side;
  PetscReal borne, cut;

  PetscFunctionBeginUser;
  if (!n_faces) PetscCall(TellNoFace(grid, c, load, fills, path, diag));
  if (!n_faces) PetscFunctionReturn(0);
  if (body >= 0 && body_bearer(c->bodies + body, fills) != BORNE_BY_CELLS) PetscFunctionReturn(0);
  if (on->body) {
    PetscCall(BodyFaces(grid, points, body, on, PETSC_FALSE, &n, &cell, &side));
    PetscCall(BodyFaces(grid, points, body, on, PETSC_TRUE, &n_cut, &cut_cell, &cut_side));
  } else {
    PetscCall(FilledSides(grid, points, on, &n, &cell, &side, &both));
    PetscCall(FilledCutSides(grid, points, on, &n_cut, &cut_cell, &cut_side));
  }
  PetscCall(CutSides(c->kinematics, grid, on, n, cell, side, n_cut, cut_cell, cut_side, &borne, &cut));
  PetscCall(MPIU_Allreduce(&n, &filled, 1, MPIU_INT, MPI_SUM, grid->comm));
  if (both && c->loads[load].kind == LOAD_PRESSURE) tell_between(on, both, path, diag);
  if (!filled) tell_empty(c, material_may_come(c, c->loads + load, fills), path, diag);
  else if (cut > LITTLE * (borne + cut)) tell_cut(c, borne, cut, fills, path, diag);
  else if (on->body) PetscCall(TellSteps(grid, c, c->loads + load, borne, path, diag));
  else PetscCall(TellUncovered(grid, c, on, fills, borne, path, diag));
  PetscCall(PetscFree(cell));
  PetscCall(PetscFree(side));
  PetscCall(PetscFree(cut_cell));
  PetscCall(PetscFree(cut_side));
  PetscFunctionReturn(0);
}
