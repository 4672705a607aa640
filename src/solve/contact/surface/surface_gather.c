/* The points of a body that another one may reach, on all ranks. */
#include "base/gather.h"
#include "base/math/vector.h"
#include "points/split.h"
#include "solve/contact/contact.h"
#include "solve/contact/surface/surface.h"

#define CUT 0.99    /* of the size of a whole part: round-off cuts nothing */
#define FLAT 1.5    /* times as wide as deep: of less a cell around a point has its neighbours */
#define SEVERAL 1.5 /* square of the sum of unit normals: 1 of one side, 2 or 3 of those at right angles */
#define TORN 0.5    /* strain beyond which nobody knows where a surface looks */

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

PetscBool surface_near(const PetscReal *x, PetscInt dim, const PetscReal *box, PetscReal within)
{
  for (PetscInt d = 0; d < dim; ++d)
    if (x[d] < box[d] - within || x[d] > -box[3 + d] + within) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Volume, in the plane area, of the part of a point that no surface cuts, of those that were given some of it; 0: not
 * known. */
static PetscReal uncut(const SurfaceInput *in, PetscInt p)
{
  const Points *points = in->points;
  const BodySpec *body = in->bodies ? in->bodies + points->body[p] : NULL;
  PetscReal x[CELL_MAX_NODES * 3];
  if (!body || body->mesh || in->grid->cloud || points->cell[p] < 0) return 0;
  if (points->id[p] != point_seed_id(points->id[p])) return 0; /* a half of one */
  grid_cell_x(in->grid, points->cell[p], x);
  return cell_volume(grid_cell_type(in->grid, points->cell[p]), x) / (PetscReal)body->points_per_cell;
}

/* The surface that a point was given, as it is now: J F^-T A, in the plane a length. Of what has flowed nobody knows
 * where it looks. */
static void take_face(const SurfaceInput *in, PetscInt p, SurfacePoint *s)
{
  const Points *points = in->points;
  const PetscInt dim = points->components[POINT_FACE];
  const PetscReal *face = dim ? point_real(points, POINT_FACE, p) : NULL, *F = s->F;
  if (!dim || (in->materials[points->material[p]].law->yields && contact_is_strained(points, p, TORN))) return;
  for (int i = 0; i < 3; ++i) {
    PetscReal row[3];
    vector_cross(F + 3 * ((i + 1) % 3), F + 3 * ((i + 2) % 3), row);
    for (PetscInt d = 0; d < dim; ++d) s->face[i] += row[d] * face[d] / (dim == 2 ? F[8] : 1);
  }
}

/* A part of a whole cell is as wide along the surface as what it was given of that, as deep as its volume has it. */
static void take_flatness(PetscInt dim, SurfacePoint *s)
{
  const PetscReal square = vector_dot(s->face, s->face), part = PetscPowRealInt(s->own, dim);
  const PetscReal flat = (dim == 2 ? square : PetscPowReal(square, 0.75)) / part;
  if (flat > FLAT) s->flat = flat;
}

/* The sides that a point stands beside. As far from the nearest one as the point is, its disk touches that alone:
 * beside a corner of cells that are taller than wide it would hang before the face that its neighbours lie on, which
 * hulls then took for a slope. Where the surface cuts cells only a corner says how far it is: PETSC_FALSE. */
static PetscBool take_sides(const SurfaceInput *in, PetscInt p, SurfacePoint *s)
{
  const Points *points = in->points;
  const PetscInt dim = points->components[POINT_BESIDE];
  const PetscReal *beside = dim ? point_real(points, POINT_BESIDE, p) : NULL, *F = s->F;
  PetscReal sides = 0;
  for (PetscInt d = 0; d < dim; ++d) sides += PetscSqr(beside[d]);
  s->bent = (PetscBool)(sides == 0 ? vector_dot(s->corner, s->corner) > 0 : sides > SEVERAL);
  if (sides == 0 || (in->materials[points->material[p]].law->yields && contact_is_strained(points, p, TORN)))
    return PETSC_FALSE;
  for (int i = 0; i < 3; ++i)
    for (PetscInt d = 0; d < dim; ++d) s->shift[i] += F[3 * i + d] * (s->corner[d] - s->first * beside[d]);
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
                      .softer = material_sheared(material) / material->wave_modulus,
                      .density = material->density};
  for (PetscInt d = 0; d < points->dim; ++d) s->x[d] = x[d], s->corner[d] = point_real(points, POINT_CORNER, p)[d];
  point_F(points, p, s->F);
  const PetscReal J = points->real[POINT_J][p], volume = J * points->real[POINT_VOLUME][p];
  s->reach = s->first * (points->dim == 2 ? PetscSqrtReal(J / s->F[8]) : PetscCbrtReal(J));
  s->size = points->dim == 2 ? PetscSqrtReal(volume / weight) : PetscCbrtReal(volume);
  s->own = s->size;
  const PetscBool of_cell = take_sides(in, p, s);
  take_face(in, p, s);
  if (vector_dot(s->face, s->face) == 0) return;
  if (of_cell) take_flatness(points->dim, s);
  const PetscReal whole = J * uncut(in, p), side = points->dim == 2 ? PetscSqrtReal(whole) : PetscCbrtReal(whole);
  if (s->size < CUT * side) s->size = side;
}

/* Those of the last point; there is room for them. */
static PetscErrorCode Carriers(const SurfaceInput *in, PetscInt g, SurfacePoint *s, Surface *surface)
{
  const PetscInt dim = surface->dim, nn = support_nodes(in->support, g);
  const PetscInt *node = in->support->node + in->support->node_start[g];
  const PetscReal *N = support_N(in->support, g, s->owner), *dN = support_dN(in->support, g, s->owner, dim);
  PetscReal bend[3 * CLOUD_MAX_NODES];

  PetscFunctionBeginUser;
  if (!in->bends || !in->bends(in->bends_context, s->owner, nn, bend)) PetscCall(PetscArrayzero(bend, dim * nn));
  s->n = nn;
  s->first_carrier = surface->n_carriers;
  for (PetscInt I = 0; I < nn; ++I) {
    SurfaceCarrier *c = surface->carrier + surface->n_carriers++;
    *c = (SurfaceCarrier){.node = in->grid->global_node[node[I]], .N = N[I]};
    for (PetscInt d = 0; d < dim; ++d) c->dN[d] = dN[I * dim + d], c->bend[d] = bend[I * dim + d];
  }
  PetscFunctionReturn(0);
}

/* What each rank has, on all: n things of a size, whose array is replaced. */
static PetscErrorCode ShareArray(MPI_Comm comm, size_t size, PetscInt *n, void **array)
{
  void *all;

  PetscFunctionBeginUser;
  PetscCall(GatherAll(comm, size, *n, *array, n, &all));
  PetscCall(PetscFree(*array));
  *array = all;
  PetscFunctionReturn(0);
}

/* Carriers of a rank stand behind those of the ranks before. */
static PetscErrorCode Share(MPI_Comm comm, Surface *surface)
{
  PetscInt before = 0;
  PetscMPIInt ranks;
  void *point = surface->point, *carrier = surface->carrier;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  if (ranks == 1) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Scan(&surface->n_carriers, &before, 1, MPIU_INT, MPI_SUM, comm));
  for (PetscInt k = 0; k < surface->n; ++k) surface->point[k].first_carrier += before - surface->n_carriers;
  PetscCall(ShareArray(comm, sizeof *surface->point, &surface->n, &point));
  PetscCall(ShareArray(comm, sizeof *surface->carrier, &surface->n_carriers, &carrier));
  surface->point = point;
  surface->carrier = carrier;
  PetscFunctionReturn(0);
}

static PetscBool is_wanted(const SurfaceInput *in, PetscInt p, PetscInt body, const PetscReal *bounds, PetscReal within)
{
  const Points *points = in->points;
  return (PetscBool)(points->body[p] == body &&
                     surface_near(point_real(points, POINT_X, p), points->dim, bounds, within));
}

/* On to the group that holds point p, of those that ascend; n_groups: it is lost. */
static void find_group(const Support *w, PetscInt p, PetscInt *g)
{
  while (w && *g < w->n_groups && p >= w->point_start[*g + 1]) ++*g;
}

/* How many are wanted, and the nodes that carry them. */
static void count_wanted(const SurfaceInput *in, PetscInt body, const PetscReal *bounds, PetscReal within, PetscInt *n,
                         PetscInt *carriers)
{
  const Support *w = in->support;
  *n = *carriers = 0;
  for (PetscInt p = 0, g = 0; p < in->points->n; ++p) {
    find_group(w, p, &g);
    if (!is_wanted(in, p, body, bounds, within)) continue;
    ++*n;
    if (w && g < w->n_groups) *carriers += support_nodes(w, g);
  }
}

PetscErrorCode SurfaceGather(const SurfaceInput *in, PetscInt body, const PetscReal *bounds, PetscReal within,
                             Surface *surface)
{
  const Points *points = in->points;
  const Support *w = in->support;
  PetscInt n, n_carriers, g = 0;

  PetscFunctionBeginUser;
  count_wanted(in, body, bounds, within, &n, &n_carriers);
  *surface = (Surface){.dim = points->dim};
  PetscCall(PetscMalloc1(n, &surface->point));
  PetscCall(PetscMalloc1(n_carriers, &surface->carrier));
  for (PetscInt p = 0; p < points->n; ++p) {
    find_group(w, p, &g);
    if (!is_wanted(in, p, body, bounds, within)) continue;
    if (w && g == w->n_groups) continue; /* lost */
    describe(in, p, surface->point + surface->n);
    if (w) PetscCall(Carriers(in, g, surface->point + surface->n, surface));
    ++surface->n;
  }
  PetscCall(Share(in->comm, surface));
  surface_sort(surface);
  PetscFunctionReturn(0);
}

PetscErrorCode SurfaceClear(Surface *surface)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(surface->point));
  PetscCall(PetscFree(surface->carrier));
  surface->n = surface->n_carriers = 0;
  PetscFunctionReturn(0);
}
