/* A surface of triangles from a file: STL, the triangles and quadrilaterals of a Gmsh mesh, or terrain. */
#include <string.h>
#include "base/text.h"
#include "grid/gmsh/msh.h"
#include "wall/form.h"
#include "wall/surface/triangles.h"

typedef struct {
  const Shape *shape;
  Diag *diag;
  char path[512]; /* of the key `file` */
} Source;

static PetscBool ends_with(const char *name, const char *ending)
{
  const size_t n = strlen(name), m = strlen(ending);
  PetscBool same = PETSC_FALSE;
  if (n > m) (void)PetscStrcasecmp(name + n - m, ending, &same);
  return same;
}

/* --- from a mesh --- */
/* The physical group of surfaces of that name; 0 without a name, -1 and an error if there is no
 * such group. */
static PetscInt find_group(const Source *s, const MshFile *msh)
{
  const char *names[64] = {NULL};
  PetscInt n = 0;
  if (!s->shape->group) return 0;
  for (PetscInt k = 0; k < msh->n_names && n < 63; ++k) {
    if (msh->names[k].dim != 2) continue;
    if (!strcmp(msh->names[k].name, s->shape->group)) return msh->names[k].tag;
    names[n++] = msh->names[k].name;
  }
  diag_error(s->diag, s->path, "'%s' has no physical surface '%s'", s->shape->file, s->shape->group);
  diag_hint_names(s->diag, s->shape->group, names);
  return -1;
}

static PetscInt triangles_of(const MshFile *msh, PetscInt e)
{
  return msh->type[e]->dim == 2 && msh->type[e]->nodes ? msh->type[e]->nodes - 2 : 0;
}

/* Quadrilaterals are cut along the diagonal from their first node. */
static PetscErrorCode TakeElements(const MshFile *msh, const PetscBool *chosen, PetscInt n, Triangles *t)
{
  PetscInt i = 0;

  PetscFunctionBeginUser;
  PetscCall(TrianglesAllocate(n, t));
  for (PetscInt e = 0; e < msh->n_elements; ++e)
    for (PetscInt part = 0; chosen[e] && part < triangles_of(msh, e); ++part, ++i) {
      t->number[i] = msh->tag[e];
      for (PetscInt k = 0; k < 3; ++k) {
        const PetscInt node = msh->node[MSH_MAX_NODES * e + (k ? k + part : 0)];
        for (int d = 0; d < 3; ++d) t->corner[i][k][d] = msh->x[3 * node + d];
      }
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadMesh(const Source *s, Triangles *t, size_t size, char *message)
{
  MshFile *msh;
  PetscBool *chosen;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(MshRead(s->shape->file, s->shape->file, &msh, size, message));
  if (!msh) PetscFunctionReturn(0);
  const PetscInt group = find_group(s, msh);
  PetscCall(PetscCalloc1(msh->n_elements, &chosen));
  for (PetscInt e = 0; e < msh->n_elements && group >= 0; ++e) chosen[e] = group == 0;
  for (PetscInt k = 0; k < msh->n_marks && group > 0; ++k)
    if (msh->mark_group[k] == group) chosen[msh->mark_element[k]] = PETSC_TRUE;
  for (PetscInt e = 0; e < msh->n_elements; ++e)
    if (chosen[e]) n += triangles_of(msh, e);
  if (n) PetscCall(TakeElements(msh, chosen, n, t));
  else if (group >= 0)
    (void)snprintf(message, size, "'%s' has no triangles or quadrilaterals of first order", s->shape->file);
  PetscCall(PetscFree(chosen));
  PetscCall(MshDestroy(&msh));
  PetscFunctionReturn(0);
}

/* --- from any file --- */
static PetscErrorCode ReadTriangles(const Source *s, Triangles *t)
{
  const Shape *shape = s->shape;
  char message[1024] = "";

  PetscFunctionBeginUser;
  if (shape->relief) PetscCall(TerrainTriangles(shape->relief, t, sizeof message, message));
  else if (ends_with(shape->file, ".stl")) PetscCall(StlRead(shape->file, t, sizeof message, message));
  else if (ends_with(shape->file, ".msh")) PetscCall(ReadMesh(s, t, sizeof message, message));
  else (void)snprintf(message, sizeof message, "'%s' is neither a .stl nor a .msh file", shape->file);
  if (message[0]) diag_error(s->diag, s->path, "%s", message);
  if (ends_with(shape->file, ".geo")) diag_hint(s->diag, "make a mesh of it first: gmsh -2 %s", shape->file);
  if (ends_with(shape->file, ".stl") && shape->group) {
    diag_error(s->diag, s->path, "key 'group' means a physical group of a .msh file; an STL has none");
    t->n = 0;
  }
  PetscReal *x = (PetscReal *)t->corner;
  for (PetscInt i = 0; i < 9 * t->n && !shape->relief; ++i) x[i] = shape->scale * x[i] + shape->offset[i % 3];
  PetscFunctionReturn(0);
}

static const char *middle_of_edge(const Triangles *t, PetscInt e, char place[80])
{
  const PetscInt i = t->side[e][0] / 3, k = t->side[e][0] % 3;
  const PetscReal *a = t->x + 3 * t->vertex[i][k], *b = t->x + 3 * t->vertex[i][(k + 1) % 3];
  const PetscReal x[3] = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
  return text_position(3, x, place);
}

/* Edges where triangles have no neighbour, or more than one. */
static void check_edges(const Source *s, const Triangles *t)
{
  PetscInt open = 0, crowded = 0, first_open = 0, first_crowded = 0;
  char place[80];
  for (PetscInt e = 0; e < t->n_edges; ++e) {
    if (t->met[e] == 1 && !open++) first_open = e;
    if (t->met[e] > 2 && !crowded++) first_crowded = e;
  }
  if (crowded)
    diag_error(s->diag, s->path,
               "'%s': at %" PetscInt_FMT " edges more than two triangles meet, at the first %" PetscInt_FMT
               ", near %s: which side is out cannot be told",
               s->shape->file, crowded, t->met[first_crowded], middle_of_edge(t, first_crowded, place));
  if (!open || s->shape->open) return;
  diag_error(s->diag, s->path,
             "'%s' is open: %" PetscInt_FMT " edges have a triangle on one side alone, the first near %s",
             s->shape->file, open, middle_of_edge(t, first_open, place));
  diag_hint(s->diag, "close it; or `open: true` makes it a thin wall without an inside");
}

/* Does it say something which way triangles face? In Gmsh they face as the surfaces of the geometry do, those of an
 * extruded box this way and that; but a cavity is told from a body by it. */
static PetscBool facing_counts(const Shape *shape, PetscInt pieces)
{
  return (PetscBool)(!ends_with(shape->file, ".msh") || (!shape->open && pieces > 1));
}

/* Turn what is turned the wrong way; PETSC_FALSE if there is no right one. */
static PetscErrorCode Orient(const Source *s, Triangles *t)
{
  const PetscBool closed = !s->shape->open;
  PetscInt pieces, turned, first, two_faced;

  PetscFunctionBeginUser;
  PetscCall(TrianglesOrient(t, closed, &pieces, &turned, &first, &two_faced));
  if (two_faced >= 0)
    diag_error(s->diag, s->path, "'%s' has one side only (like a Moebius strip), near triangle %" PetscInt_FMT,
               s->shape->file, t->number[two_faced]);
  const PetscBool counts = facing_counts(s->shape, pieces);
  if (turned && counts)
    diag_warning(s->diag, s->path,
                 "'%s': %" PetscInt_FMT
                 " triangles face the other way than their neighbours, the first is number "
                 "%" PetscInt_FMT "; they are turned",
                 s->shape->file, turned, first);
  if (!closed || two_faced >= 0) PetscFunctionReturn(0);
  const PetscReal volume = triangles_volume(t);
  if (volume < 0) triangles_turn_all(t);
  if (volume < 0 && counts)
    diag_warning(s->diag, s->path, "'%s' is inside out: all its triangles are turned", s->shape->file);
  if (volume == 0) diag_error(s->diag, s->path, "'%s' encloses no volume", s->shape->file);
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeFacets(const Source *s, Triangles *t, Facets **facets)
{
  const PetscInt before = diag_errors(s->diag);
  PetscInt left_out, first, without;

  PetscFunctionBeginUser;
  PetscCall(TrianglesWeld(t, &left_out, &first));
  if (left_out)
    diag_warning(s->diag, s->path,
                 "'%s': %" PetscInt_FMT
                 " triangles have corners that coincide within %g m and are left out, the first "
                 "is number %" PetscInt_FMT,
                 s->shape->file, left_out, (double)t->tolerance, first);
  if (!t->n) diag_error(s->diag, s->path, "'%s' has no triangles with an area", s->shape->file);
  else PetscCall(TrianglesJoin(t));
  if (t->n) check_edges(s, t);
  if (diag_errors(s->diag) == before) PetscCall(Orient(s, t));
  if (diag_errors(s->diag) > before) PetscFunctionReturn(0);
  PetscCall(TrianglesNormals(t, &without));
  if (without >= 0)
    diag_error(s->diag, s->path, "'%s': triangle %" PetscInt_FMT " and its neighbours have no area", s->shape->file,
               t->number[without]);
  else PetscCall(FacetsOfTriangles(t->n_vertices, t->x, t->n, t->vertex, t->n_edges, t->edge, t->normal, facets));
  PetscFunctionReturn(0);
}

PetscErrorCode SurfaceRead(const Shape *shape, const char *path, Diag *diag, Facets **facets)
{
  Source s = {.shape = shape, .diag = diag};
  Triangles t = {0};

  PetscFunctionBeginUser;
  *facets = NULL;
  (void)snprintf(s.path, sizeof s.path, "%.480s.%s.file", path, shape->relief ? "terrain" : "surface");
  PetscCall(ReadTriangles(&s, &t));
  if (t.n) PetscCall(MakeFacets(&s, &t, facets));
  PetscCall(TrianglesFree(&t));
  PetscFunctionReturn(0);
}
