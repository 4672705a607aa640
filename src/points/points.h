/* Material points (and tracers, and carriers of loads: points without mass): structure of arrays.
 *
 * Every field stands in one table, so that migration, sorting, output and checkpoints treat all
 * alike. A real field f has components[f] numbers a point: data = real[f] + p * components[f]. */
#pragma once
#include "base/table/table.h"
#include "grid/grid.h"
#include "points/seed/outline.h"

typedef enum {
  POINT_X,      /* position, m: dim */
  POINT_U,      /* displacement since the start, m: dim */
  POINT_V,      /* velocity, m/s: dim */
  POINT_A,      /* acceleration, m/s2: dim */
  POINT_MASS,   /* kg (per m of thickness in plane strain): 1 */
  POINT_VOLUME, /* undeformed volume, m3: 1 */
  /* deformation gradient: 9 in 3D; xx xy yx yy zz (5) otherwise. In extreme flow its entries grow
   * without bound and its determinant means nothing any more: take POINT_J */
  POINT_F,
  POINT_J,   /* volume over undeformed volume, the product of the steps' det dF: 1 */
  POINT_TAU, /* Kirchhoff stress of the state, Pa: 6 in 3D; xx yy zz xy (4) otherwise */
  /* energy stored at the start and work of the stress since then, J: what is not stored now has
   * been dissipated: 1 */
  POINT_WORK,
  POINT_XI,    /* reference position in the cell: dim */
  POINT_STATE, /* the law's stored state: the largest n_state of the case */
  /* the mixed formulation's pressure at the point, tension positive, Pa: 1 there, otherwise 0
   * components */
  POINT_PRESSURE,
  POINT_FORCE, /* dead force of a load carrier, N: dim (0 components for material points) */
  /* of load carriers that stand for a piece of a surface: half its edges, m; the piece is x + s e (+ t e'), |s|, |t|
   * <= 1: dim (dim - 1) where the basis averages over pieces (Basis.carry), otherwise 0 components */
  POINT_EDGE,
  /* of such carriers in rings: from the middle of the undeformed piece to the mean of places by their radius, m: dim
   * there, otherwise 0 components */
  POINT_LEAN,
  /* of followers: from their position, the nearest in the grid, to where they really are, m: dim
   * (others: 0 components) */
  POINT_OVERHANG,
  /* half lengths along the axes, at the start, of the domain over which shape functions are
   * averaged, m: dim where the basis has such domains, otherwise 0 components */
  POINT_DOMAIN,
  /* gradients of velocity, 1/s, and acceleration, 1/s2, row by row: dim x dim each where the
   * transfer asks for them, otherwise 0 components */
  POINT_SLOPE,
  /* distance from the nearest side of the cell that it was seeded in, at the start, m: 1 where
   * there are walls, otherwise 0 components */
  POINT_REACH,
  /* from there to the side of its body that it stands beside, or the corner or edge where such sides meet, at the
   * start, m; nothing inside, and where the surface cuts cells: dim where there are walls, otherwise 0 components */
  POINT_CORNER,
  /* sum of the unit normals, outwards, of the sides that the last leads to, at the start; nothing where the surface
   * cuts cells: dim where bodies meet at interfaces, otherwise 0 components */
  POINT_BESIDE,
  /* the part of its body's surface that it stands for, at the start, as a vector outwards, m2 (in rings m, of the
   * section); nothing where whole cells of the grid say it, which the material goes through: dim where there are walls,
   * otherwise 0 components */
  POINT_FACE,
  /* of each wall, what it did to the point in the last step: state and forces (solve/contact), N; 0
   * components where there are none */
  POINT_CONTACT,
  /* which velocity field of the grid carries it: 1 where bodies meet at interfaces, otherwise 0
   * components */
  POINT_FIELD,
  /* of clouds of a mesh whose cells differ much in size: of nodes around it, at the start, m: 1 there, otherwise 0
   * components */
  POINT_SPACING,
  /* how far it was carried in the present event of each measure that counts some, m: one each */
  POINT_CARRIED,
  /* equivalent plastic strain that the last step added: 1 where it is to be written, otherwise 0
   * components */
  POINT_FLOW,
  /* displacement in the last step per time, or per factor of what is sought, m/s, m: dim where it is to be
   * written, otherwise 0 components */
  POINT_MECHANISM,
  POINT_N_REAL
} PointReal;

/* What became of points that left the grid, of one rank. */
typedef struct {
  PetscInt removed, held;    /* taken out; put back on the boundary */
  PetscReal mass, held_mass; /* theirs, kg */
  /* J that went: with those taken out, and in stopping those put back; POINT_WORK */
  PetscReal kinetic, work;
  PetscReal momentum[3]; /* kg m/s that went in the same ways */
  PetscInt64 first;      /* id of the first of them (if there are any) */
  PetscReal place[3];    /* where that one was, m */
} OutsideTally;

typedef struct Points {
  PetscInt dim, n, capacity;
  PetscInt components[POINT_N_REAL];
  PetscReal *real[POINT_N_REAL];
  /* unique over all ranks, for life; does not depend on the number of ranks */
  PetscInt64 *id;
  PetscInt *cell; /* local cell, -1 if lost */
  /* index into the case's bodies (tracers: the measure, carriers: the load) */
  PetscInt *body;
  PetscInt *material;   /* index into the case's materials */
  OutsideTally outside; /* what the last PointsRelocate did on this rank */
} Points;

/* n_state: components of POINT_STATE; force: components of POINT_FORCE. */
PetscErrorCode PointsCreate(PetscInt dim, PetscInt n_state, PetscInt n_force, Points **points);
/* Followers: points without mass that go with the material, tracers (n_force = 0) and carriers of
 * loads. They may leave the grid with it. */
PetscErrorCode FollowersCreate(PetscInt dim, PetscInt n_force, Points **points);
PetscErrorCode PointsDestroy(Points **points);
/* Make room for `capacity` points; existing ones stay. */
PetscErrorCode PointsReserve(Points *points, PetscInt capacity);
/* Append one point with all fields zero (F = I, J = 1, cell -1); returns its index. */
PetscErrorCode PointsAppend(Points *points, PetscInt *index);
/* Forget the points with drop[p], keeping the order of the others. */
PetscErrorCode PointsCompact(Points *points, const PetscBool *drop);
/* Order by cell, then material, then id: what the point loop wants. */
PetscErrorCode PointsSort(Points *points);

static inline PetscReal *point_real(const Points *points, PointReal field, PetscInt p)
{
  return points->real[field] + (size_t)p * (size_t)points->components[field];
}

static inline PetscInt point_field(const Points *points, PetscInt p)
{
  return points->components[POINT_FIELD] ? (PetscInt)points->real[POINT_FIELD][p] : 0;
}

/* The local cell of its field that holds the point; its xi. */
static inline PetscInt point_locate(const Points *points, PetscInt p, const Grid *grid, PetscInt guess)
{
  const PetscInt cell = grid_locate(grid, point_real(points, POINT_X, p), guess, point_real(points, POINT_XI, p));
  return grid_cell_in(grid, cell, point_field(points, p));
}

/* The point of this rank that is nearest to x, and the square of its distance, m2; -1: there is none. */
PetscInt points_near(const Points *points, const PetscReal *x, PetscReal *square);
/* The velocity field of the point nearest to x on this rank. */
PetscInt points_field_near(const Points *points, const PetscReal *x);

/* F of point p as a full 3 x 3. */
static inline void point_F(const Points *points, PetscInt p, PetscReal F[9])
{
  const PetscReal *f = point_real(points, POINT_F, p);
  if (points->dim == 3) {
    for (int i = 0; i < 9; ++i) F[i] = f[i];
  } else {
    const PetscReal full[9] = {f[0], f[1], 0, f[2], f[3], 0, 0, 0, f[4]};
    for (int i = 0; i < 9; ++i) F[i] = full[i];
  }
}

/* Kirchhoff stress of point p with all components. */
static inline void point_tau(const Points *points, PetscInt p, PetscReal tau[6])
{
  const PetscInt n = points->components[POINT_TAU];
  for (PetscInt k = 0; k < 6; ++k) tau[k] = k < n ? point_real(points, POINT_TAU, p)[k] : 0;
}

static inline void point_set_tau(Points *points, PetscInt p, const PetscReal tau[6])
{
  for (PetscInt k = 0; k < points->components[POINT_TAU]; ++k) point_real(points, POINT_TAU, p)[k] = tau[k];
}

static inline void point_set_F(Points *points, PetscInt p, const PetscReal F[9])
{
  PetscReal *f = point_real(points, POINT_F, p);
  if (points->dim == 3) {
    for (int i = 0; i < 9; ++i) f[i] = F[i];
  } else {
    f[0] = F[0], f[1] = F[1], f[2] = F[3], f[3] = F[4], f[4] = F[8];
  }
}

/* Seed the bodies: points at the Gauss points of each body's cells, that is, of the cells of the
 * grid (or of the body's own mesh) whose centre lies in its shape or region. Fills x, cell, xi,
 * mass, volume, v, id, body, material and the law's initial state. `density` and `initial` come per
 * material; equal: do points of a cell share its mass equally where the body leaves that to the
 * method? Collective. */
typedef struct {
  PetscReal density;
  PetscInt n_state;
  const PetscReal *initial; /* n_state numbers */
} PointSeed;
/* Does the body fill its shape, or whole cells? `equal` as below: whether nodes are free of the
 * body's cells. */
PetscBool body_fills_shape(const BodySpec *body, PetscBool equal);
/* Collective. The mesh that body b brings of its own; it may be a .geo with the parameters of the grid's. NULL after a
 * mistake, which goes to diag. */
PetscErrorCode BodyMeshCreate(MPI_Comm comm, const Case *c, PetscInt b, Diag *diag, Grid **own);
/* Initial velocity of a body at x: translation and rotation. */
void body_velocity(const BodySpec *body, PetscInt dim, const PetscReal *x, PetscReal *v);
PetscErrorCode PointsSeed(Points *points, const Grid *grid, const Case *c, const PointSeed *per_material,
                          PetscBool equal, Diag *diag);
/* The same, and the surface of the bodies' cells on this rank (NULL: not wanted). */
PetscErrorCode PointsSeedOutlined(Points *points, const Grid *grid, const Case *c, const PointSeed *per_material,
                                  PetscBool equal, Outline *outline, Diag *diag);

/* Collective. Send every point to the rank owner[p]; those that stay keep their order, arrivals
 * stand behind. */
PetscErrorCode PointsTransfer(Points *points, const Grid *grid, const PetscMPIInt *owner);

/* Collective. Points of `old`, in the order of its cells, go to the ranks that have their cells in
 * `grid`, which is the same grid shared in another way, and get sorted. *moved grows by the points
 * that leave this rank. */
PetscErrorCode PointsRepartition(Points *points, const Grid *old, const Grid *grid, PetscInt *moved);

/* A point found outside the grid. */
typedef struct {
  PetscInt64 id;
  PetscReal x[3], v[3];
  PetscInt last_cell; /* the user's number */
} LostPoint;

/* Find every point's cell again after it moved, send those that left this rank's part to their new
 * owner (messages only among ranks whose cells may hold them), and treat those outside the grid by
 * the policy. Collective. lost (n_lost of them, over all ranks on each, at most 16 kept) describes
 * what left the grid; PetscFree it. Points kept on the boundary do not count; of followers, which
 * go on outside, it is their nearest position that is kept there. A position that is no number is
 * lost under every policy: it is listed first, and stays in the table with cell -1. points->outside
 * says what was taken out or put back. */
PetscErrorCode PointsRelocate(Points *points, const Grid *grid, OutsidePolicy policy, PetscInt *n_lost,
                              LostPoint **lost);

/* Where a point really is: followers may stand out of the grid. */
static inline void point_place(const Points *points, PetscInt p, PetscReal *x)
{
  for (PetscInt d = 0; d < points->dim; ++d)
    x[d] = point_real(points, POINT_X, p)[d] +
           (points->components[POINT_OVERHANG] ? point_real(points, POINT_OVERHANG, p)[d] : 0);
}

/* Points of another case: what its bodies are here, -1 if they are gone. Materials stay those of
 * the other case. */
typedef struct {
  PetscInt n_bodies, n_materials; /* of the other case */
  const PetscInt *body;
} PointsChange;
/* Collective. As PointsFromTable; fields that are not in the table become 0, those of another
 * width are cut, or filled up with 0. */
PetscErrorCode PointsTake(Points *points, const Grid *grid, const Table *table, const PointsChange *change,
                          char reason[256]);
/* Another number of components of POINT_STATE: numbers behind the new ones are lost, new ones
 * are 0. */
PetscErrorCode PointsSetState(Points *points, PetscInt n_state);
/* The points p with take[p], appended to `to`, which has the same fields. */
PetscErrorCode PointsCopy(const Points *points, const PetscBool *take, Points *to);

/* The points as a table, every field of them. Columns stand over the points' own arrays where they
 * can. */
PetscErrorCode PointsToTable(const Points *points, const Grid *grid, const char *name, Tables *tables);
/* Collective. Points in place of those that are there, from such a table, however its rows are
 * shared: each goes to the rank that has its cell, and keeps its place among those that go there.
 * reason is left empty, or says on every rank what is wrong with the table. */
PetscErrorCode PointsFromTable(Points *points, const Grid *grid, const Table *table, PetscInt n_bodies,
                               PetscInt n_materials, char reason[256]);
