/* The points of a body that another one may reach, on all ranks. */
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
  for (PetscInt d = 0; d < points->dim; ++d) s->corner[d] = point_real(points, POINT_CORNER, p)[d];
  point_F(points, p, s->F);
  const PetscReal thicker = points->dim == 2 ? s->F[8] : 1, root = 1 / (PetscReal)points->dim;
  s->reach = s->first * PetscPowReal(points->real[POINT_J][p] / thicker, root);
  s->size = PetscPowReal(points->real[POINT_J][p] * points->real[POINT_VOLUME][p] / weight, root);
}

/* The nodes of the surface's last point. */
static PetscErrorCode Carriers(const SurfaceInput *in, PetscInt g, Surface *surface)
{
  const PetscInt nn = support_nodes(in->support, g), *node = in->support->node + in->support->node_start[g];
  SurfacePoint *s = surface->point + surface->n - 1;
  PetscReal bend[3 * SURFACE_NODES];

  PetscFunctionBeginUser;
  PetscCheck(nn <= SURFACE_NODES, PETSC_COMM_SELF, PETSC_ERR_PLIB, "%" PetscInt_FMT " nodes carry a point", nn);
  const PetscReal *N = support_N(in->support, g, s->owner), *dN = support_dN(in->support, g, s->owner, surface->dim);
  const PetscBool bends = (PetscBool)(in->bends && in->bends(in->bends_context, s->owner, nn, bend));
  s->n = nn;
  s->carrier = surface->n_carriers;
  for (PetscInt I = 0; I < nn; ++I) {
    SurfaceCarrier *c = surface->carrier + surface->n_carriers++;
    *c = (SurfaceCarrier){.node = in->grid->global_node[node[I]], .N = N[I]};
    for (PetscInt d = 0; d < surface->dim; ++d) {
      c->dN[d] = dN[I * surface->dim + d];
      c->bend[d] = bends ? bend[I * surface->dim + d] : 0;
    }
  }
  PetscFunctionReturn(0);
}

/* What each rank has, n things of so many bytes, on all, in the order of the ranks; `before`: of lower ranks. */
static PetscErrorCode ShareThings(MPI_Comm comm, size_t bytes, PetscInt *n, void **things, PetscInt *before)
{
  PetscMPIInt size, rank, mine, *count, *start;
  char *all;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMPIIntCast(*n * (PetscInt)bytes, &mine));
  PetscCall(PetscMalloc2(size, &count, size + 1, &start));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, count, 1, MPI_INT, comm));
  start[0] = 0;
  for (PetscMPIInt r = 0; r < size; ++r) start[r + 1] = start[r] + count[r];
  *n = start[size] / (PetscInt)bytes;
  *before = start[rank] / (PetscInt)bytes;
  PetscCall(PetscMalloc1(start[size], &all));
  PetscCallMPI(MPI_Allgatherv(*things, mine, MPI_BYTE, all, count, start, MPI_BYTE, comm));
  PetscCall(PetscFree(*things));
  PetscCall(PetscFree2(count, start));
  *things = all;
  PetscFunctionReturn(0);
}

static PetscErrorCode Share(MPI_Comm comm, Surface *surface)
{
  const PetscInt own = surface->n;
  PetscMPIInt size;
  PetscInt before;
  void *points = surface->point, *carriers = surface->carrier;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (size == 1) PetscFunctionReturn(0);
  PetscCall(ShareThings(comm, sizeof *surface->carrier, &surface->n_carriers, &carriers, &before));
  for (PetscInt k = 0; k < own; ++k) surface->point[k].carrier += before;
  PetscCall(ShareThings(comm, sizeof *surface->point, &surface->n, &points, &before));
  surface->point = points;
  surface->carrier = carriers;
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
  *surface = (Surface){.dim = points->dim};
  PetscCall(PetscMalloc1(n, &surface->point));
  PetscCall(PetscMalloc1(w ? n * SURFACE_NODES : 0, &surface->carrier));
  for (PetscInt p = 0; p < points->n; ++p) {
    while (w && g < w->n_groups && p >= w->point_start[g + 1]) ++g;
    if (points->body[p] != body || !is_near(point_real(points, POINT_X, p), points->dim, bounds, within)) continue;
    if (w && g == w->n_groups) continue; /* lost */
    describe(in, p, surface->point + surface->n++);
    if (w) PetscCall(Carriers(in, g, surface));
  }
  PetscCall(Share(in->comm, surface));
  PetscCall(SurfaceSort(surface, in->grid->smallest));
  PetscFunctionReturn(0);
}

PetscErrorCode SurfaceClear(Surface *surface)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(surface->point));
  PetscCall(PetscFree(surface->carrier));
  PetscCall(PetscFree(surface->bins.start));
  PetscCall(PetscFree(surface->bins.point));
  surface->n = surface->n_carriers = 0;
  PetscFunctionReturn(0);
}
