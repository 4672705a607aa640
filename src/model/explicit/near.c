/* Which points walls may meet in a lap: only these are looked at in its substeps. */
#include "grid/box/box.h"
#include "model/explicit/explicit.h"
#include "support/products.h"

/* Cells that a point may come nearer by in a lap; nodes are listed as far (lap.c). */
#define APPROACH 1

/* The most that matter of wall k within the box moves by until any substep of the lap, m. Motions are rigid: corners of
 * the box go farthest. */
static PetscReal travel_of_wall(const Model *m, const Explicit *e, PetscInt k)
{
  const GridBox *box = m->grid->box;
  PetscReal most = 0;
  if (m->c->walls[k].has_mass) return e->rush * (PetscReal)e->substeps * e->dt;
  for (PetscInt s = 1; s <= e->substeps && e->dt > 0; ++s)
    for (int corner = 0; corner < 1 << m->dim; ++corner) {
      PetscReal x[3] = {0, 0, 0}, way[3] = {0, 0, 0};
      for (PetscInt d = 0; d < m->dim; ++d) x[d] = box->line[d][corner >> d & 1 ? box->counts[d] : 0];
      wall_motion(m->walls, k, e->time, e->time + (PetscReal)s * e->dt, x, way);
      most = PetscMax(most, PetscSqrtReal(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]));
    }
  return most;
}

static PetscBool comes_near(const Model *m, const Explicit *e, PetscInt p, const PetscReal *travel)
{
  const PetscReal *x = point_real(m->points, POINT_X, p), cell = m->grid->smallest;
  const PetscReal within = cell + contact_farthest(m->points, p) + APPROACH * cell;
  WallPlace place;
  for (PetscInt k = 0; k < m->c->n_walls; ++k)
    if (wall_near(m->walls, k, e->time, x, within + travel[k], wall_side(m->walls, k, e->time, x), &place))
      return PETSC_TRUE;
  return PETSC_FALSE;
}

static void forget(const Model *m, PetscInt p)
{
  PetscReal *kept = point_real(m->points, POINT_CONTACT, p);
  for (PetscInt i = 0; i < m->points->components[POINT_CONTACT]; ++i) kept[i] = 0;
}

PetscErrorCode NearFind(Model *m, Explicit *e)
{
  NearWalls *near = &e->near;
  PetscReal *travel;

  PetscFunctionBeginUser;
  near->n = 0;
  if (!m->contact || !e->box) PetscFunctionReturn(0);
  if (m->points->n > near->capacity) {
    near->capacity = m->points->n + m->points->n / 4;
    PetscCall(PetscFree(near->point));
    PetscCall(PetscMalloc1(near->capacity, &near->point));
  }
  PetscCall(PetscMalloc1(m->c->n_walls, &travel));
  for (PetscInt k = 0; k < m->c->n_walls; ++k) travel[k] = travel_of_wall(m, e, k);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    if (m->points->cell[p] >= 0 && comes_near(m, e, p, travel)) near->point[near->n++] = p;
    else forget(m, p);
  }
  PetscCall(PetscFree(travel));
  PetscFunctionReturn(0);
}

void near_forget(const Model *m, const Explicit *e)
{
  for (PetscInt i = 0; i < (e->box ? e->near.n : m->points->n); ++i) forget(m, e->box ? e->near.point[i] : i);
}

/* The cell of the lattice in which x is, and where in it, 0 to 1. */
static void locate(PetscInt dim, const Lattice *l, const PetscReal *x, PetscInt cell[3], PetscReal at[3])
{
  for (PetscInt d = 0; d < dim; ++d) {
    const PetscReal s = (x[d] - l->origin[d]) * l->per_length[d];
    cell[d] = PetscMin(PetscMax((PetscInt)PetscFloorReal(s), 0), l->most[d]);
    at[d] = s - (PetscReal)cell[d];
  }
}

/* Nodes and functions of point p: products of linear ones. Returns how many. */
static PetscInt look(const Model *m, const Lattice *l, PetscInt p, PetscInt *node, PetscReal *N, PetscReal *dN)
{
  const PetscInt dim = m->dim;
  PetscInt cell[3], first = 0;
  PetscReal at[3];
  locate(dim, l, point_real(m->points, POINT_X, p), cell, at);
  for (PetscInt d = 0; d < dim; ++d) first += cell[d] * l->stride[d];
  for (PetscInt k = 0; k < 1 << dim; ++k) {
    node[k] = l->number[first + l->corner[k]];
    N[k] = 1;
    for (PetscInt d = 0; d < dim; ++d) {
      N[k] *= k >> d & 1 ? at[d] : 1 - at[d];
      dN[k * dim + d] = (k >> d & 1 ? 1 : -1) * l->per_length[d];
      for (PetscInt j = 0; j < dim; ++j)
        if (j != d) dN[k * dim + d] *= k >> j & 1 ? at[j] : 1 - at[j];
    }
  }
  return 1 << dim;
}

static PetscInt look_smoothly(const Model *m, const Lattice *l, PetscInt p, PetscInt *node, PetscReal *N, PetscReal *dN)
{
  const GridBox *box = m->grid->box;
  ProductPlace place = {.ijk = {0}};
  PetscReal at[3];
  locate(m->dim, l, point_real(m->points, POINT_X, p), place.ijk, at);
  for (PetscInt d = 0; d < m->dim; ++d) {
    place.ijk[d] += box->nodes.lo[d];
    place.size[d] = l->size[d];
  }
  return gimp_functions(box, m->c->kinematics->hoop, m->points, p, &place, node, N, dN);
}

PetscErrorCode NearSee(const Model *m, Explicit *e)
{
  const PetscInt dim = m->dim, n = e->near.n, most = e->smooth ? product_nodes(dim, GIMP_LINE) : 1 << dim;
  Support *s = e->near.support;

  PetscFunctionBeginUser;
  PetscCall(SupportReserve(s, n, n * most, n * most, dim));
  s->n_groups = n;
  s->n_runs = 0;
  s->point_start[0] = s->node_start[0] = s->value_start[0] = 0;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscInt first = s->node_start[i], p = e->near.point[i];
    PetscInt *node = s->node + first;
    PetscReal *N = s->N + first, *dN = s->dN + first * dim;
    const PetscInt nn =
      e->smooth ? look_smoothly(m, &e->lattice, p, node, N, dN) : look(m, &e->lattice, p, node, N, dN);
    s->point_start[i + 1] = i + 1;
    s->node_start[i + 1] = s->value_start[i + 1] = first + nn;
  }
  PetscFunctionReturn(0);
}
