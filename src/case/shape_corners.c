/* The smallest box around what half-spaces leave of another one: around its corners. */
#include "case/shape_corners.h"

#define MOST_PLANES 32
#define ROUNDED 1e-9  /* of the size of the box */
#define PARALLEL 1e-9 /* sine of an angle */

/* All x with normal . x <= offset, unit normals. */
typedef struct {
  PetscInt n;
  PetscReal normal[MOST_PLANES][3], offset[MOST_PLANES];
} Planes;

static void add_plane(const PetscReal *normal, PetscReal offset, Planes *p)
{
  PetscReal norm = 0;
  for (int d = 0; d < 3; ++d) norm += PetscSqr(normal[d]);
  norm = PetscSqrtReal(norm);
  for (int d = 0; d < 3; ++d) p->normal[p->n][d] = normal[d] / norm;
  p->offset[p->n++] = offset / norm;
}

/* Sides of the box, and the half-spaces among the shape's children. In the plane the third axis ends at 0 twice. */
static void collect_planes(const Shape *s, const PetscReal min[3], const PetscReal max[3], Planes *p)
{
  for (int side = 0; side < 6; ++side) {
    PetscReal normal[3] = {0, 0, 0};
    normal[side / 2] = side % 2 ? 1 : -1;
    add_plane(normal, side % 2 ? max[side / 2] : -min[side / 2], p);
  }
  for (PetscInt i = 0; i < s->n_children && p->n < MOST_PLANES; ++i) {
    const Shape *child = s->children + i;
    PetscReal offset = 0;
    if (child->kind != SHAPE_HALF_SPACE) continue;
    for (int d = 0; d < 3; ++d) offset += child->normal[d] * child->point[d];
    add_plane(child->normal, offset, p);
  }
}

/* Where three planes meet; PETSC_FALSE if they do not in one place. */
static PetscBool meet(const Planes *p, const PetscInt at[3], PetscReal x[3])
{
  PetscReal cross[3][3], volume = 0;
  for (int i = 0; i < 3; ++i) {
    const PetscReal *a = p->normal[at[(i + 1) % 3]], *b = p->normal[at[(i + 2) % 3]];
    for (int d = 0; d < 3; ++d) cross[i][d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
  }
  for (int d = 0; d < 3; ++d) volume += p->normal[at[0]][d] * cross[0][d];
  if (PetscAbsReal(volume) < PARALLEL) return PETSC_FALSE;
  for (int d = 0; d < 3; ++d) {
    x[d] = 0;
    for (int i = 0; i < 3; ++i) x[d] += p->offset[at[i]] * cross[i][d] / volume;
  }
  return PETSC_TRUE;
}

static PetscBool holds(const Planes *p, const PetscReal x[3], PetscReal tolerance)
{
  for (PetscInt k = 0; k < p->n; ++k) {
    PetscReal beyond = -p->offset[k];
    for (int d = 0; d < 3; ++d) beyond += p->normal[k][d] * x[d];
    if (beyond > tolerance) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

void corner_bounds(const Shape *s, PetscInt dim, PetscReal min[3], PetscReal max[3])
{
  Planes planes = {0};
  PetscReal low[3] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL}, high[3], x[3], size = 0;
  PetscInt at[3], found = 0;
  for (PetscInt d = 0; d < dim; ++d) {
    if (min[d] <= -PETSC_MAX_REAL || max[d] >= PETSC_MAX_REAL || min[d] >= max[d]) return;
    size = PetscMax(size, max[d] - min[d]);
  }
  for (int d = 0; d < 3; ++d) high[d] = -low[d];
  collect_planes(s, min, max, &planes);
  if (planes.n == 6) return;
  for (at[0] = 0; at[0] < planes.n; ++at[0])
    for (at[1] = at[0] + 1; at[1] < planes.n; ++at[1])
      for (at[2] = at[1] + 1; at[2] < planes.n; ++at[2]) {
        if (!meet(&planes, at, x) || !holds(&planes, x, ROUNDED * size)) continue;
        ++found;
        for (int d = 0; d < 3; ++d) low[d] = PetscMin(low[d], x[d]), high[d] = PetscMax(high[d], x[d]);
      }
  for (PetscInt d = 0; d < dim && found; ++d) min[d] = PetscMax(min[d], low[d]), max[d] = PetscMin(max[d], high[d]);
}
