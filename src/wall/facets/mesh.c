/* Forms become lines and triangles. */
#include "wall/facets/mesh.h"
#include <math.h>
#include "wall/form.h"

#define LEAST_TURNS 48 /* pieces of a circle */

typedef struct {
  WallMesh *mesh;
  const WallView *view;
  const Form *whole; /* of which only what is its surface counts; NULL: all does */
} Making;

static PetscErrorCode Append(const Making *m, const PetscReal corner[3][3])
{
  WallMesh *mesh = m->mesh;
  const PetscInt dim = mesh->dim;

  PetscFunctionBeginUser;
  if (mesh->n == mesh->capacity) {
    mesh->capacity += mesh->capacity / 2 + 256;
    PetscCall(PetscRealloc((size_t)(mesh->capacity * dim * 3) * sizeof *mesh->x, &mesh->x));
    PetscCall(PetscRealloc((size_t)(mesh->capacity * dim) * sizeof *mesh->node, &mesh->node));
    PetscCall(PetscRealloc((size_t)mesh->capacity * sizeof *mesh->wall, &mesh->wall));
  }
  for (PetscInt i = 0; i < dim; ++i) {
    mesh->node[mesh->n * dim + i] = mesh->n * dim + i;
    for (int d = 0; d < 3; ++d) mesh->x[3 * (mesh->n * dim + i) + d] = corner[i][d];
  }
  ++mesh->n;
  PetscFunctionReturn(0);
}

/* Of shapes that cut each other: is the middle of the piece on the surface that is left? */
static PetscBool is_surface(const Making *m, const PetscReal corner[3][3])
{
  const PetscInt dim = m->mesh->dim;
  PetscReal x[3] = {0, 0, 0};
  WallPlace place;
  for (PetscInt i = 0; i < dim; ++i)
    for (int d = 0; d < 3; ++d) x[d] += corner[i][d] / (PetscReal)dim;
  return form_near(m->whole, x, 1, PETSC_MAX_REAL, &place) != NEAR_NOT && fabs(place.gap) < 0.1 * m->view->size;
}

static PetscReal distance(const PetscReal a[3], const PetscReal b[3])
{
  return PetscSqrtReal(PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]));
}

/* One piece; where shapes cut each other it is halved until it is small. */
static PetscErrorCode Add(const Making *m, const PetscReal corner[3][3])
{
  const PetscInt dim = m->mesh->dim;
  PetscInt longest = 0;
  PetscReal length = 0, half[2][3][3];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < (dim == 2 ? 1 : 3); ++i) {
    const PetscReal edge = distance(corner[i], corner[(i + 1) % dim]);
    if (edge > length) length = edge, longest = i;
  }
  if (!m->whole || length <= m->view->size) {
    if (!m->whole || is_surface(m, corner)) PetscCall(Append(m, corner));
    PetscFunctionReturn(0);
  }
  for (PetscInt i = 0; i < dim; ++i)
    for (int d = 0; d < 3; ++d) half[0][i][d] = half[1][i][d] = corner[i][d];
  for (int d = 0; d < 3; ++d)
    half[0][(longest + 1) % dim][d] = half[1][longest][d] = (corner[longest][d] + corner[(longest + 1) % dim][d]) / 2;
  PetscCall(Add(m, (const PetscReal(*)[3])half[0]));
  PetscCall(Add(m, (const PetscReal(*)[3])half[1]));
  PetscFunctionReturn(0);
}

/* Corners in their order round a flat face. */
static PetscErrorCode AddFan(const Making *m, PetscInt n, PetscReal (*corner)[3])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 1; i + 1 < n; ++i) {
    PetscReal piece[3][3];
    for (int d = 0; d < 3; ++d) piece[0][d] = corner[0][d], piece[1][d] = corner[i][d], piece[2][d] = corner[i + 1][d];
    PetscCall(Add(m, (const PetscReal(*)[3])piece));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode AddBox(const Making *m, const Shape *s)
{
  static const int face[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  static const int edge[4][2] = {{0, 1}, {1, 3}, {3, 2}, {2, 0}};
  PetscReal corner[4][3];

  PetscFunctionBeginUser;
  for (int f = 0; f < (m->mesh->dim == 2 ? 4 : 6); ++f) {
    for (int i = 0; i < (m->mesh->dim == 2 ? 2 : 4); ++i) {
      const int at = m->mesh->dim == 2 ? edge[f][i] : face[f][i];
      for (int d = 0; d < 3; ++d) corner[i][d] = d >= m->mesh->dim ? 0 : at >> d & 1 ? s->max[d] : s->min[d];
    }
    if (m->mesh->dim == 2) PetscCall(Add(m, (const PetscReal(*)[3])corner));
    else PetscCall(AddFan(m, 4, corner));
  }
  PetscFunctionReturn(0);
}

static PetscInt turns(const Making *m, PetscReal radius, PetscReal angle)
{
  return PetscMax((PetscInt)ceil(LEAST_TURNS * angle / (2 * PETSC_PI)), (PetscInt)ceil(radius * angle / m->view->size));
}

static PetscErrorCode AddArc(const Making *m, const Shape *s, PetscReal from, PetscReal to)
{
  const PetscInt n = turns(m, s->radius, to - from);
  PetscReal corner[3][3];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) {
    for (int k = 0; k < 2; ++k) {
      const PetscReal angle = from + (to - from) * (PetscReal)(i + k) / (PetscReal)n;
      corner[k][0] = s->centre[0] + s->radius * cos(angle);
      corner[k][1] = s->centre[1] + s->radius * sin(angle);
      corner[k][2] = 0;
    }
    PetscCall(Add(m, (const PetscReal(*)[3])corner));
  }
  PetscFunctionReturn(0);
}

/* The line from (radius, height) a to b about an axis; bands[k]: of both ends of it. */
static PetscErrorCode Turn(const Making *m, const PetscReal base[3], const PetscReal axis[3], const PetscReal *a,
                           const PetscReal *b)
{
  const PetscInt n = turns(m, PetscMax(a[0], b[0]), 2 * PETSC_PI);
  const int least = fabs(axis[0]) <= fabs(axis[1]) && fabs(axis[0]) <= fabs(axis[2]) ? 0
                    : fabs(axis[1]) <= fabs(axis[2])                                 ? 1
                                                                                     : 2;
  PetscReal e[3], f[3], corner[4][3], length = 0;

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; ++d) e[d] = (d == least) - axis[least] * axis[d], length += e[d] * e[d];
  for (int d = 0; d < 3; ++d) e[d] /= PetscSqrtReal(length);
  for (int d = 0; d < 3; ++d) f[d] = axis[(d + 1) % 3] * e[(d + 2) % 3] - axis[(d + 2) % 3] * e[(d + 1) % 3];
  for (PetscInt i = 0; i < n; ++i) {
    for (int k = 0; k < 4; ++k) {
      const PetscReal angle = 2 * PETSC_PI * (PetscReal)(i + (k == 1 || k == 2)) / (PetscReal)n;
      const PetscReal *end = k < 2 ? a : b;
      for (int d = 0; d < 3; ++d)
        corner[k][d] = base[d] + end[1] * axis[d] + end[0] * (cos(angle) * e[d] + sin(angle) * f[d]);
    }
    PetscCall(AddFan(m, 4, corner));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode AddSphere(const Making *m, const Shape *s)
{
  const PetscReal up[3] = {0, 0, 1};
  const PetscInt n = turns(m, s->radius, PETSC_PI);

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal low = PETSC_PI * ((PetscReal)i / (PetscReal)n - 0.5), high = low + PETSC_PI / (PetscReal)n;
    const PetscReal a[2] = {s->radius * cos(low), s->radius * sin(low)},
                    b[2] = {s->radius * cos(high), s->radius * sin(high)};
    PetscCall(Turn(m, s->centre, up, a, b));
  }
  PetscFunctionReturn(0);
}

PetscInt wall_mesh_cut(PetscInt n, PetscBool closed, PetscReal (*x)[3], int d, int sign, PetscReal limit)
{
  PetscReal kept[16][3];
  PetscInt count = 0;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal *a = x[i], *b = x[(i + 1) % n], over = sign * (a[d] - limit), next = sign * (b[d] - limit);
    if (over <= 0)
      for (int k = 0; k < 3; ++k) kept[count][k] = a[k];
    count += over <= 0;
    if (over * next >= 0 || (!closed && i + 1 == n)) continue;
    for (int k = 0; k < 3; ++k) kept[count][k] = a[k] + over / (over - next) * (b[k] - a[k]);
    ++count;
  }
  for (PetscInt i = 0; i < count; ++i)
    for (int k = 0; k < 3; ++k) x[i][k] = kept[i][k];
  return count;
}

static PetscErrorCode AddPlane(const Making *m, const Form *f)
{
  const PetscInt dim = m->mesh->dim;
  const PetscReal *n = f->direction;
  const int least = dim == 2                                               ? 2
                    : fabs(n[0]) <= fabs(n[1]) && fabs(n[0]) <= fabs(n[2]) ? 0
                    : fabs(n[1]) <= fabs(n[2])                             ? 1
                                                                           : 2;
  PetscReal e[3], g[3], x[16][3], centre[3] = {0, 0, 0}, reach = 0, away = 0;
  PetscInt count = dim == 2 ? 2 : 4;

  PetscFunctionBeginUser;
  for (PetscInt d = 0; d < dim; ++d) {
    centre[d] = (m->view->min[d] + m->view->max[d]) / 2;
    reach += m->view->max[d] - m->view->min[d];
    away += n[d] * (centre[d] - f->base[d]);
  }
  for (int d = 0; d < 3; ++d) e[d] = n[(d + 1) % 3] * (least == (d + 2) % 3) - n[(d + 2) % 3] * (least == (d + 1) % 3);
  for (int d = 0; d < 3; ++d) g[d] = n[(d + 1) % 3] * e[(d + 2) % 3] - n[(d + 2) % 3] * e[(d + 1) % 3];
  for (PetscInt i = 0; i < count; ++i) /* reach is longer than the diagonal, and e at least 0.5 */
    for (int d = 0; d < 3; ++d)
      x[i][d] = centre[d] - away * n[d] + 2 * reach * ((i == 0 || i == 3) ? -e[d] : e[d]) +
                (dim == 2 ? 0 : 2 * reach * (i < 2 ? -g[d] : g[d]));
  for (int d = 0; d < dim && count > 0; ++d) {
    count = wall_mesh_cut(count, dim == 3, x, d, 1, m->view->max[d]);
    count = wall_mesh_cut(count, dim == 3, x, d, -1, m->view->min[d]);
  }
  if (dim == 2 && count == 2) PetscCall(Add(m, (const PetscReal(*)[3])x));
  if (dim == 3) PetscCall(AddFan(m, count, x));
  PetscFunctionReturn(0);
}

static PetscErrorCode AddForm(const Making *m, const Form *f)
{
  const Shape *s = f->shape;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < f->n; ++i) PetscCall(AddForm(m, f->child + i));
  for (PetscInt i = 0; f->facets && i < f->facets->n; ++i) {
    const PetscReal(*corner)[3] = (const PetscReal(*)[3])f->facets->corner[i];
    if (!form_is_flat(f)) PetscCall(Turn(m, f->base, f->direction, corner[0], corner[1]));
    else PetscCall(Add(m, corner));
  }
  if (s->kind == SHAPE_BOX) PetscCall(AddBox(m, s));
  if (s->kind == SHAPE_HALF_SPACE) PetscCall(AddPlane(m, f));
  if (s->kind == SHAPE_ARC) PetscCall(AddArc(m, s, s->angle[0] * PETSC_PI / 180, s->angle[1] * PETSC_PI / 180));
  if (s->kind == SHAPE_BALL && m->mesh->dim == 2) PetscCall(AddArc(m, s, 0, 2 * PETSC_PI));
  if (s->kind == SHAPE_BALL && m->mesh->dim == 3) PetscCall(AddSphere(m, s));
  PetscFunctionReturn(0);
}

PetscErrorCode FormMesh(const Form *form, const WallView *view, WallMesh *mesh)
{
  const Making making = {.mesh = mesh, .view = view, .whole = form->n ? form : NULL};

  PetscFunctionBeginUser;
  PetscCall(AddForm(&making, form));
  PetscFunctionReturn(0);
}

PetscErrorCode WallMeshFree(WallMesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(mesh->x));
  PetscCall(PetscFree(mesh->node));
  PetscCall(PetscFree(mesh->wall));
  PetscFunctionReturn(0);
}
