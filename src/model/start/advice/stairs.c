/* Bodies that meet along a side that slants or bends and is made of whole cells of a box: there it is stairs, of which
 * those of one body stand in those of the other, and nothing slides. */
#include "base/math/vector.h"
#include "model/model_private.h"
#include "solve/contact/surface/surface.h"

#define SLANTS 0.02 /* 1 - the largest part of a unit normal: by 11 degrees off the axes */
#define FEWEST 3    /* points: a corner alone has no direction, and so one may come of it */
#define BESIDE 0.5  /* of the points that stand at the interface: most of it */
#define FARTHEST 4  /* cells: so deep is a surface looked for */
#define APART 0.05  /* of a cell: places whose depth is compared */

/* Is the body made of whole cells of a box, which need not follow its shape? */
static PetscBool is_of_cells(const Model *m, PetscInt b)
{
  const BodySpec *body = &m->c->bodies[b];
  return (PetscBool)(m->c->grid.kind == GRID_BOX && body->has_shape && !body->mesh &&
                     !body_fills_shape(body, m->method->restores_grid));
}

/* Does the surface of the shape before point p lie aslant of the axes? It is asked a cell behind the point, which may
 * be outside of the shape itself. */
static PetscBool slants_before(const Model *m, const Shape *shape, const SurfacePoint *p)
{
  const PetscReal *beside = point_real(m->points, POINT_BESIDE, p->owner), h = m->grid->smallest, most = FARTHEST * h;
  PetscReal at[3] = {0}, square = 0, largest = 0, sum = 0;
  for (PetscInt d = 0; d < m->dim; ++d) square += PetscSqr(beside[d]);
  if (square == 0) return PETSC_FALSE;
  for (PetscInt d = 0; d < m->dim; ++d) at[d] = p->x[d] - h * beside[d] / PetscSqrtReal(square);
  const PetscReal depth = shape_depth(shape, m->dim, at, most);
  if (depth <= 0 || depth >= most) return PETSC_FALSE;
  for (PetscInt d = 0; d < m->dim; ++d) {
    PetscReal side[3] = {at[0], at[1], at[2]};
    side[d] += APART * h;
    const PetscReal deeper = PetscAbsReal(shape_depth(shape, m->dim, side, most) - depth);
    largest = PetscMax(largest, deeper);
    sum += PetscSqr(deeper);
  }
  return (PetscBool)(largest < (1 - SLANTS) * PetscSqrtReal(sum));
}

/* Collective. count: of the points of body b of this rank that are at the other one those before a slanting side, and
 * all; then over all ranks. */
static PetscErrorCode CountSlanting(const Model *m, PetscInt b, const Surface *mine, const Surface *other,
                                    PetscInt count[2])
{
  PetscMPIInt rank;
  SurfacePair pair;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  count[0] = count[1] = 0;
  for (const SurfacePoint *p = mine->point; p < mine->point + mine->n; ++p) {
    if (p->rank != rank || !surface_meet(mine, p, other, m->grid->smallest, &pair)) continue;
    if (pair.gap > m->grid->smallest + p->reach) continue;
    ++count[1];
    count[0] += slants_before(m, &m->c->bodies[b].shape, p);
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

static void tell(const Model *m, PetscInt k, PetscInt b, PetscInt n, Diag *diag)
{
  const InterfaceSpec *s = m->c->interfaces + k;
  char path[64];
  snprintf(path, sizeof path, "interfaces[%d]", (int)k);
  diag_warning(
    diag, path,
    "'%s' is made of whole cells of %.3g m, and its shape slants at '%s' (at %d points): there it is stairs, "
    "on which nothing slides",
    m->c->bodies[b].name, (double)m->grid->smallest, s->name, (int)n);
  diag_hint(diag, "give grid.mesh, whose cells follow the bodies; mpm cuts cells along the shape");
}

PetscErrorCode AdviseStairs(const Model *m, Diag *diag)
{
  Surface body[2];
  PetscInt count[2];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_interfaces; ++k) {
    const InterfaceSpec *s = m->c->interfaces + k;
    const PetscInt b[2] = {case_body(m->c, s->between[0]), case_body(m->c, s->between[1])};
    if (s->contact == CONTACT_BONDED || !(is_of_cells(m, b[0]) || is_of_cells(m, b[1]))) continue;
    PetscCall(InterfaceSurfaces(m, k, body));
    for (int i = 0, told = 0; i < 2 && !told; ++i) {
      if (!is_of_cells(m, b[i])) continue;
      PetscCall(CountSlanting(m, b[i], body + i, body + 1 - i, count));
      told = count[0] >= FEWEST && count[0] > BESIDE * count[1];
      if (told) tell(m, k, b[i], count[0], diag);
    }
    for (int i = 0; i < 2; ++i) PetscCall(SurfaceClear(body + i));
  }
  PetscFunctionReturn(0);
}
