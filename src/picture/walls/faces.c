/* Walls in space as surfaces: what of them turns to the eye. What is seen through them from within is left to their
 * lines. */
#include "picture/walls/walls.h"
#include "wall/facets/mesh.h"

enum { MOST_CORNERS = 16 };

/* What is seen of wall k: to where it ends, if that is soon, or no farther than the view. */
static void seen_of(const PlotScene *scene, const WallView *view, PetscInt k, PetscReal time, PetscReal seen[2][3])
{
  PetscReal min[3], max[3];
  wall_bounds(scene->walls, k, time, min, max);
  for (int d = 0; d < 3; ++d) {
    const PetscReal beside = walls_beside(scene, view, d);
    seen[0][d] = min[d] > view->min[d] - beside ? min[d] : view->min[d];
    seen[1][d] = max[d] < view->max[d] + beside ? max[d] : view->max[d];
  }
}

/* The part of a piece that is seen. */
static PetscInt clip(const PetscReal *piece, PetscReal seen[2][3], PetscReal corner[MOST_CORNERS][3])
{
  PetscInt n = 3;
  for (int k = 0; k < 9; ++k) corner[k / 3][k % 3] = piece[k];
  for (int d = 0; d < 3 && n >= 3; ++d) {
    n = wall_mesh_cut(n, PETSC_TRUE, corner, d, 1, seen[1][d]);
    if (n >= 3) n = wall_mesh_cut(n, PETSC_TRUE, corner, d, -1, seen[0][d]);
  }
  return n;
}

/* Is the way out of wall k, at the middle of a piece of it, one towards the eye? What has no inside has no such way. */
static PetscBool faces_eye(const PlotScene *scene, PetscInt k, PetscReal time, const PetscReal *piece)
{
  PetscReal middle[3], towards[3];
  WallPlace place;
  for (int d = 0; d < 3; ++d) middle[d] = (piece[d] + piece[3 + d] + piece[6 + d]) / 3;
  if (wall_side(scene->walls, k, time, middle) != 0) return PETSC_FALSE;
  if (!wall_near(scene->walls, k, time, middle, PETSC_MAX_REAL, 0, &place)) return PETSC_FALSE;
  plot_project(scene, place.normal, towards);
  return (PetscBool)(towards[2] > 1e-6);
}

static void add(const PlotScene *scene, PetscInt k, PetscInt n, PetscReal corner[][3], PlotFrame *f)
{
  for (PetscInt i = 1; i + 1 < n; ++i, ++f->n_faces) {
    const PetscReal *of[3] = {corner[0], corner[i], corner[i + 1]};
    for (int c = 0; c < 3; ++c) plot_project(scene, of[c], f->face + 9 * f->n_faces + 3 * c);
    f->face_of[f->n_faces] = k;
  }
}

PetscErrorCode PlotWallsFaces(const PlotScene *scene, const WallMesh *mesh, const WallView *view, PlotFrame *f)
{
  const PetscInt most = mesh->n * (MOST_CORNERS - 2);
  PetscReal corner[MOST_CORNERS][3], seen[2][3];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(9 * most, &f->face, most, &f->face_of));
  for (PetscInt i = 0; i < mesh->n; ++i) {
    const PetscInt k = (PetscInt)mesh->wall[i];
    if (i == 0 || mesh->wall[i - 1] != mesh->wall[i]) seen_of(scene, view, k, f->time, seen);
    const PetscInt n = clip(mesh->x + 9 * i, seen, corner);
    if (n >= 3 && faces_eye(scene, k, f->time, mesh->x + 9 * i)) add(scene, k, n, corner, f);
  }
  PetscFunctionReturn(0);
}
