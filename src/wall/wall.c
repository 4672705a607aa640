#include "wall/wall_private.h"
#include <math.h>
#include "wall/check.h"
#include "wall/facets/mesh.h"

PetscErrorCode WallsCreate(const Case *c, Diag *diag, Walls **walls)
{
  char path[64];

  PetscFunctionBeginUser;
  PetscCall(PetscNew(walls));
  (*walls)->c = c;
  (*walls)->dim = kinematics_dim(c->kinematics);
  PetscCall(PetscCalloc1(c->n_walls, &(*walls)->wall));
  for (PetscInt k = 0; k < c->n_walls; ++k) {
    Wall *wall = (*walls)->wall + k;
    wall->spec = c->walls + k;
    snprintf(path, sizeof path, "walls[%" PetscInt_FMT "].shape", k);
    PetscCall(FormCreate(&wall->spec->shape, (*walls)->dim, c->kinematics->hoop, path, diag, &wall->form));
    if (wall->form) wall_check(c, wall->spec, wall->form, path, diag);
    wall->asked = NAN;
    wall->corners = wall_has_corners(wall->spec);
    wall->frame = (Frame){.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  }
  PetscFunctionReturn(0);
}

PetscErrorCode WallsDestroy(Walls **walls)
{
  PetscFunctionBeginUser;
  if (!*walls) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < (*walls)->c->n_walls; ++k) PetscCall(FormDestroy(&(*walls)->wall[k].form));
  PetscCall(PetscFree((*walls)->wall));
  PetscCall(PetscFree(*walls));
  PetscFunctionReturn(0);
}

/* Along the normal the distance does not bend: two are left, known by their sum and that of their squares. */
PetscReal wall_bend(const WallPlace *place)
{
  const PetscReal *c = place->curvature, sum = c[0] + c[4] + c[8];
  PetscReal squares = 0;
  for (int k = 0; k < 9; ++k) squares += PetscSqr(c[k]);
  return (sum + PetscSqrtReal(PetscMax(0, 2 * squares - PetscSqr(sum)))) / 2;
}

/* But for rounding, and by what no step is worth while. */
static PetscBool is_later(const Walls *walls, PetscReal t, PetscReal than)
{
  return t > than * (1 + 1e-9) && t - than > NO_STEP * walls->c->analysis.step;
}

/* A step that ends at `until` still meets the wall, one that ends at `from` does not yet. In what a search tries no
 * time passes: there stands what it begins with. */
PetscBool wall_stands(const Walls *walls, PetscInt k, PetscReal t)
{
  const WallSpec *w = walls->c->walls + k;
  if (case_time(walls->c, t) < t) return wall_comes(walls, k, t);
  if (!walls->wall[k].form || w->absent) return PETSC_FALSE;
  if (w->from > 0 && !is_later(walls, t, w->from)) return PETSC_FALSE;
  return !w->has_until || !is_later(walls, t, w->until);
}

PetscBool wall_comes(const Walls *walls, PetscInt k, PetscReal t)
{
  const WallSpec *w = walls->c->walls + k;
  const PetscReal now = case_time(walls->c, t);
  return walls->wall[k].form && !w->absent && !is_later(walls, w->from, now) &&
         (!w->has_until || is_later(walls, w->until, now));
}

PetscBool wall_is_new(const Walls *walls, PetscInt k, PetscReal t)
{
  const PetscBool begins = (PetscBool)!is_later(walls, t, walls->c->start);
  return (PetscBool)(!wall_stands(walls, k, t) || (begins && walls->c->walls[k].since == walls->c->stage));
}

PetscReal walls_until_change(const Walls *walls, PetscReal t)
{
  PetscReal next = PETSC_MAX_REAL;
  if (case_seeks(&walls->c->analysis) && t >= walls->c->analysis.end) return next;
  for (const WallSpec *w = walls->c->walls; w < walls->c->walls + walls->c->n_walls; ++w) {
    if (w->absent) continue;
    if (is_later(walls, w->from, t)) next = PetscMin(next, w->from - t);
    if (w->has_until && is_later(walls, w->until, t)) next = PetscMin(next, w->until - t);
  }
  return next;
}

static PetscBool moves(const Wall *wall) { return wall->spec->n_motions > 0 || wall->spec->has_mass; }

static void frame_of(const Walls *walls, PetscInt k, PetscReal t, Frame *frame)
{
  if (walls->wall[k].spec->has_mass) *frame = walls->wall[k].frame;
  else frame_at(walls->c, walls->wall[k].spec, t, frame);
}

void wall_origin(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x, PetscReal X[3])
{
  Wall *wall = walls->wall + k;
  PetscReal at[3] = {x[0], x[1], walls->dim == 3 ? x[2] : 0};
  if (!moves(wall)) {
    for (int d = 0; d < 3; ++d) X[d] = at[d];
    return;
  }
  if (t != wall->asked && !wall->spec->has_mass) frame_at(walls->c, wall->spec, t, &wall->frame);
  wall->asked = t;
  frame_origin(&wall->frame, at, X);
}

void wall_turn(const Wall *wall, WallPlace *place)
{
  const WallPlace own = *place;
  if (!moves(wall)) return;
  frame_turn(&wall->frame, own.normal, place->normal);
  frame_turn_tensor(&wall->frame, own.curvature, place->curvature);
}

void wall_turn_back(const Wall *wall, WallPlace *place)
{
  Frame back = {.T = {0}};
  const WallPlace own = *place;
  if (!moves(wall)) return;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) back.R[3 * i + j] = wall->frame.R[3 * j + i];
  frame_turn(&back, own.normal, place->normal);
  frame_turn_tensor(&back, own.curvature, place->curvature);
}

/* A surface without an inside, as seen from one of its sides; beside its rim from anywhere. */
static void see_from(int side, Nearness near, PetscReal thickness, WallPlace *place)
{
  const int own = place->gap < 0 ? -1 : 1, way = near != NEAR || !side ? own : side;
  place->gap = way * place->gap - thickness / 2;
  for (int d = 0; d < 3; ++d) place->normal[d] *= way;
  for (int k = 0; k < 9; ++k) place->curvature[k] *= way;
}

PetscBool wall_near(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x, PetscReal within, int side,
                    WallPlace *place)
{
  Wall *wall = walls->wall + k;
  const PetscBool thin = wall->form && wall->form->thin;
  const PetscReal half = thin ? wall->spec->thickness / 2 : 0;
  PetscReal X[3];
  if (!wall_stands(walls, k, t) && !wall_comes(walls, k, t)) return PETSC_FALSE;
  wall_origin(walls, k, t, x, X);
  const Nearness near = form_near(wall->form, X, wall->spec->inside ? -1 : 1, within + half, place);
  if (near == NEAR_NOT) return PETSC_FALSE;
  if (thin) see_from(side, near, 2 * half, place);
  wall_turn(wall, place);
  return PETSC_TRUE;
}

int wall_side(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x)
{
  Wall *wall = walls->wall + k;
  WallPlace place;
  PetscReal X[3];
  if (!wall->form || !wall->form->thin) return 0;
  wall_origin(walls, k, t, x, X);
  const Nearness near = form_near(wall->form, X, 1, PETSC_MAX_REAL, &place);
  return near == NEAR_RIM ? 0 : place.gap < 0 ? -1 : 1;
}

PetscBool wall_has_one_side(const Walls *walls, PetscInt k)
{
  const WallSpec *spec = walls->wall[k].spec;
  switch (spec->shape.kind) {
  case SHAPE_HALF_SPACE: return PETSC_TRUE;
  case SHAPE_BOX:
  case SHAPE_BALL:
  case SHAPE_CYLINDER:
  case SHAPE_CONE: return spec->inside;
  default: return PETSC_FALSE;
  }
}

void wall_motion(const Walls *walls, PetscInt k, PetscReal t0, PetscReal t1, const PetscReal *x, PetscReal increment[3])
{
  const PetscReal at[3] = {x[0], x[1], walls->dim == 3 ? x[2] : 0};
  frame_increment(walls->c, walls->c->walls + k, t0, t1, at, increment);
}

void wall_velocity(const Walls *walls, PetscInt k, PetscReal t, PetscReal glance, const PetscReal *x, PetscReal v[3])
{
  PetscReal half[3], whole[3];
  wall_motion(walls, k, t, t + glance / 2, x, half);
  wall_motion(walls, k, t, t + glance, x, whole);
  for (int d = 0; d < 3; ++d) v[d] = (4 * half[d] - whole[d]) / glance;
}

/* Of a wall that moves the box around the corners of its own one. */
void wall_bounds(const Walls *walls, PetscInt k, PetscReal t, PetscReal min[3], PetscReal max[3])
{
  static const PetscReal anywhere[] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL,
                                       PETSC_MAX_REAL,  PETSC_MAX_REAL,  PETSC_MAX_REAL};
  const Form *form = walls->wall[k].form; /* NULL: a mistake was found in it */
  const PetscReal *own = form ? form->bounds : anywhere,
                  half = form && form->thin ? walls->c->walls[k].thickness / 2 : 0;
  PetscBool endless = PETSC_FALSE;
  Frame frame;
  frame_of(walls, k, t, &frame);
  for (int d = 0; d < 3; ++d) {
    endless |= own[d] <= -PETSC_MAX_REAL || own[d + 3] >= PETSC_MAX_REAL;
    min[d] = PETSC_MAX_REAL, max[d] = -PETSC_MAX_REAL;
  }
  for (int corner = 0; corner < 8 && !endless; ++corner) {
    PetscReal X[3], x[3];
    for (int d = 0; d < 3; ++d) X[d] = corner >> d & 1 ? own[d + 3] : own[d];
    frame_turn(&frame, X, x);
    for (int d = 0; d < 3; ++d) {
      min[d] = PetscMin(min[d], x[d] + frame.T[d] - half);
      max[d] = PetscMax(max[d], x[d] + frame.T[d] + half);
    }
  }
  for (int d = 0; d < 3 && endless; ++d) {
    min[d] = moves(walls->wall + k) ? -PETSC_MAX_REAL : own[d];
    max[d] = moves(walls->wall + k) ? PETSC_MAX_REAL : own[d + 3];
  }
}

/* Of a wall that moves all is looked at that may come into view. */
PetscErrorCode WallMeshAdd(const Walls *walls, PetscInt k, PetscReal t, const WallView *view, WallMesh *mesh)
{
  const PetscInt first = mesh->n;
  PetscReal min[3], max[3], centre[3] = {0, 0, 0}, reach = 0;
  WallView own = *view;
  Frame frame;

  PetscFunctionBeginUser;
  if (!walls->wall[k].form) PetscFunctionReturn(0);
  frame_of(walls, k, t, &frame);
  for (PetscInt d = 0; d < walls->dim; ++d) {
    centre[d] = (view->min[d] + view->max[d]) / 2;
    reach += (view->max[d] - view->min[d]) / 2;
  }
  frame_origin(&frame, centre, centre);
  for (int d = 0; d < 3; ++d) min[d] = centre[d] - reach, max[d] = centre[d] + reach;
  if (moves(walls->wall + k)) own.min = min, own.max = max;
  PetscCall(FormMesh(walls->wall[k].form, &own, mesh));
  for (PetscInt i = first; i < mesh->n; ++i) {
    mesh->wall[i] = (PetscReal)k;
    for (PetscInt c = i * walls->dim; c < (i + 1) * walls->dim; ++c) {
      PetscReal x[3];
      frame_turn(&frame, mesh->x + 3 * c, x);
      for (int d = 0; d < 3; ++d) mesh->x[3 * c + d] = x[d] + frame.T[d];
    }
  }
  PetscFunctionReturn(0);
}
