/* Which nodes of other bodies a rank must know: contact points are with the material points of the first body of an
 * interface, and the nodes that carry the other body there may be anywhere. */
#include "method/gmm/gmm.h"
#include "solve/contact/surface/surface.h"

PetscReal meeting_reach(const Discretisation *s)
{
  const PetscReal farthest = PetscMax(s->c->basis.radius, s->c->basis.max_radius);
  return SURFACE_SEARCH * s->grid->smallest + farthest * s->grid->cloud->widest;
}

static PetscBool may_meet(const Discretisation *s, PetscInt p, PetscInt k, const PetscReal *bounds)
{
  const InterfaceSpec *i = s->c->interfaces + k;
  if (s->points->body[p] != case_body(s->c, i->between[0])) return PETSC_FALSE;
  return surface_near(point_real(s->points, POINT_X, p), s->grid->dim, bounds + 6 * case_body(s->c, i->between[1]),
                      SURFACE_SEARCH * s->grid->smallest);
}

static void list_places(const Discretisation *s, const PetscReal *bounds, MeetingPlaces *places)
{
  const PetscInt dim = s->grid->dim;
  places->n = 0;
  for (PetscInt k = 0; k < s->c->n_interfaces; ++k)
    for (PetscInt p = 0; p < s->points->n; ++p) {
      if (!may_meet(s, p, k, bounds)) continue;
      const PetscInt n = places->n++;
      if (!places->x) continue; /* they are counted first */
      places->field[n] = case_field(s->c, case_body(s->c, s->c->interfaces[k].between[1]));
      for (PetscInt d = 0; d < dim; ++d) places->x[n * dim + d] = point_real(s->points, POINT_X, p)[d];
    }
}

PetscErrorCode MeetingPlacesFind(const Discretisation *s, MeetingPlaces *places)
{
  const SurfaceInput in = {.comm = s->grid->comm, .points = s->points};
  PetscReal *bounds;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  *places = (MeetingPlaces){0};
  PetscCallMPI(MPI_Comm_size(s->grid->comm, &size));
  if (size == 1 || !s->c->n_interfaces) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(6 * s->c->n_bodies, &bounds));
  PetscCall(SurfaceBounds(&in, s->c->n_bodies, bounds));
  list_places(s, bounds, places);
  PetscCall(PetscMalloc1(places->n, &places->field));
  PetscCall(PetscMalloc1(places->n * s->grid->dim, &places->x));
  list_places(s, bounds, places);
  PetscCall(PetscFree(bounds));
  PetscFunctionReturn(0);
}

PetscErrorCode MeetingPlacesDestroy(MeetingPlaces *places)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(places->field));
  PetscCall(PetscFree(places->x));
  PetscFunctionReturn(0);
}

PetscErrorCode MeetingPlacesUse(const MeetingPlaces *places, const Discretisation *s, PetscReal reach,
                                const RemoteNodes *remote, PetscBool *use)
{
  const PetscInt dim = s->grid->dim;
  unsigned char *skip;
  Neighbours near;
  PetscInt item;
  PetscReal square;

  PetscFunctionBeginUser;
  if (!places->n) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(places->n, &skip));
  for (PetscInt f = 0; f < s->grid->cloud->n_motions; ++f) {
    for (PetscInt i = 0; i < places->n; ++i) skip[i] = places->field[i] != f;
    PetscCall(NeighboursCreate(dim, places->n, places->x, 0, NULL, skip, reach, &near));
    for (PetscInt k = 0; k < remote->n; ++k)
      if (remote->field[k] == f && neighbours_within(&near, remote->x + k * dim, reach, 1, &item, &square))
        use[k] = PETSC_TRUE;
    PetscCall(NeighboursDestroy(&near));
  }
  PetscCall(PetscFree(skip));
  PetscFunctionReturn(0);
}
