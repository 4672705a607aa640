/* The points of a body that another one may reach, on all ranks. */
#include <stdlib.h>
#include "solve/contact/surface/surface.h"

PetscErrorCode SurfaceBounds(const SurfaceInput *in, PetscInt n_bodies, PetscReal *bounds)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 6 * n_bodies; ++i) bounds[i] = PETSC_MAX_REAL;
  for (PetscInt p = 0; p < in->points->n; ++p) {
    const PetscReal *x = point_real(in->points, POINT_X, p);
    PetscReal *box = bounds + 6 * in->points->body[p];
    for (PetscInt d = 0; d < in->points->dim; ++d) {
      box[d] = PetscMin(box[d], x[d]);
      box[3 + d] = PetscMin(box[3 + d], -x[d]);
    }
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, bounds, (PetscMPIInt)(6 * n_bodies), MPIU_REAL, MPIU_MIN, in->comm));
  PetscFunctionReturn(0);
}

static PetscBool is_near(const PetscReal *x, PetscInt dim, const PetscReal *box, PetscReal within)
{
  for (PetscInt d = 0; d < dim; ++d)
    if (x[d] < box[d] - within || x[d] > -box[3 + d] + within) return PETSC_FALSE;
  return PETSC_TRUE;
}

static void describe(const SurfaceInput *in, PetscInt p, SurfacePoint *s)
{
  const Points *points = in->points;
  const PetscReal *x = point_real(points, POINT_X, p), weight = kinematics_weight(in->kinematics, x[0]);
  const Material *material = in->materials + points->material[p];
  PetscMPIInt rank;
  MPI_Comm_rank(in->comm, &rank);
  *s = (SurfacePoint){.id = points->id[p],
                      .rank = rank,
                      .owner = p,
                      .first = points->real[POINT_REACH][p],
                      .modulus = material->wave_modulus,
                      .stiffer = material_confined(material) / material->wave_modulus,
                      .density = material->density};
  for (PetscInt d = 0; d < points->dim; ++d) s->x[d] = x[d];
  for (PetscInt d = 0; d < 2; ++d) s->corner[d] = point_real(points, POINT_CORNER, p)[d];
  point_F(points, p, s->F);
  s->reach = s->first * PetscSqrtReal(points->real[POINT_J][p] / s->F[8]);
  s->size = PetscSqrtReal(points->real[POINT_J][p] * points->real[POINT_VOLUME][p] / weight);
}

static PetscErrorCode Carriers(const SurfaceInput *in, PetscInt g, SurfacePoint *s)
{
  const PetscInt nn = support_nodes(in->support, g), *node = in->support->node + in->support->node_start[g];

  PetscFunctionBeginUser;
  PetscCheck(nn <= SURFACE_NODES, PETSC_COMM_SELF, PETSC_ERR_PLIB, "%" PetscInt_FMT " nodes carry a point", nn);
  s->n = nn;
  for (PetscInt I = 0; I < nn; ++I) s->node[I] = in->grid->global_node[node[I]];
  PetscCall(PetscArraycpy(s->N, support_N(in->support, g, s->owner), nn));
  PetscCall(PetscArraycpy(s->dN, support_dN(in->support, g, s->owner, 2), 2 * nn));
  if (!in->bends || !in->bends(in->bends_context, s->owner, nn, s->bend)) PetscCall(PetscArrayzero(s->bend, 2 * nn));
  PetscFunctionReturn(0);
}

static int compare(const void *a, const void *b)
{
  const SurfacePoint *p = a, *q = b;
  if (p->x[0] != q->x[0]) return p->x[0] < q->x[0] ? -1 : 1;
  return (p->id > q->id) - (p->id < q->id);
}

/* What each rank has, on all. */
static PetscErrorCode Share(MPI_Comm comm, Surface *surface)
{
  PetscMPIInt size, mine, *count, *start;
  SurfacePoint *all;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (size == 1) PetscFunctionReturn(0);
  PetscCall(PetscMPIIntCast(surface->n * (PetscInt)sizeof *all, &mine));
  PetscCall(PetscMalloc2(size, &count, size + 1, &start));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, count, 1, MPI_INT, comm));
  start[0] = 0;
  for (PetscMPIInt r = 0; r < size; ++r) start[r + 1] = start[r] + count[r];
  surface->n = start[size] / (PetscInt)sizeof *all;
  PetscCall(PetscMalloc1(surface->n, &all));
  PetscCallMPI(MPI_Allgatherv(surface->point, mine, MPI_BYTE, all, count, start, MPI_BYTE, comm));
  PetscCall(PetscFree(surface->point));
  PetscCall(PetscFree2(count, start));
  surface->point = all;
  PetscFunctionReturn(0);
}

PetscErrorCode SurfaceGather(const SurfaceInput *in, PetscInt body, const PetscReal *bounds, PetscReal within,
                             Surface *surface)
{
  const Points *points = in->points;
  const Support *w = in->support;
  PetscInt n = 0, g = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < points->n; ++p)
    n += points->body[p] == body && is_near(point_real(points, POINT_X, p), points->dim, bounds, within);
  *surface = (Surface){0};
  PetscCall(PetscMalloc1(n, &surface->point));
  for (PetscInt p = 0; p < points->n; ++p) {
    while (w && g < w->n_groups && p >= w->point_start[g + 1]) ++g;
    if (points->body[p] != body || !is_near(point_real(points, POINT_X, p), points->dim, bounds, within)) continue;
    if (w && g == w->n_groups) continue; /* lost */
    describe(in, p, surface->point + surface->n);
    if (w) PetscCall(Carriers(in, g, surface->point + surface->n));
    ++surface->n;
  }
  PetscCall(Share(in->comm, surface));
  if (surface->n) qsort(surface->point, (size_t)surface->n, sizeof *surface->point, compare);
  PetscFunctionReturn(0);
}

PetscErrorCode SurfaceClear(Surface *surface)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(surface->point));
  surface->n = 0;
  PetscFunctionReturn(0);
}
