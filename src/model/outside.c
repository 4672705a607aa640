/* Points that leave the grid: how many, how much mass, energy and momentum went with them. */
#include "model/model_private.h"

#define SHORT 0.1 /* of a cell: a body that ends farther from the edge of the grid does not fill it so far */

/* The place of the first of them by id, on all ranks. */
static PetscErrorCode FindFirst(const Model *m, LostPoint *first)
{
  const OutsideTally *t = &m->points->outside;
  const PetscInt64 none = (PetscInt64)1 << 62;
  PetscInt64 mine = t->removed + t->held > 0 ? t->first : none;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(&mine, &first->id, 1, MPIU_INT64, MPI_MIN, m->comm));
  for (int d = 0; d < 3; ++d) first->x[d] = mine == first->id && mine != none ? t->place[d] : 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, first->x, 3, MPIU_REAL, MPIU_SUM, m->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode OutsideAdd(Model *m, StepReport *report)
{
  const OutsideTally *t = &m->points->outside;
  Outside *o = &m->outside;
  PetscReal s[8] = {(PetscReal)t->removed, t->mass, (PetscReal)t->held, t->held_mass, t->kinetic + t->work};

  PetscFunctionBeginUser;
  if (!m->method->restores_grid || m->c->grid.outside == OUTSIDE_STOP) PetscFunctionReturn(0);
  for (int d = 0; d < 3; ++d) s[5 + d] = t->momentum[d];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s, 8, MPIU_REAL, MPIU_SUM, m->comm));
  report->removed = (PetscInt)s[0];
  report->held = (PetscInt)s[2];
  o->held_now = s[2];
  if (s[0] + s[2] == 0) PetscFunctionReturn(0);
  PetscCall(FindFirst(m, &report->first_outside));
  o->removed += s[0];
  o->mass += s[1];
  o->held += s[2];
  o->held_most = PetscMax(o->held_most, s[2]);
  o->held_most_mass = PetscMax(o->held_most_mass, s[3]);
  o->energy += s[4];
  for (int d = 0; d < 3; ++d) o->momentum[d] += s[5 + d];
  o->first = o->first > 0 ? o->first : m->time;
  o->last = m->time;
  PetscFunctionReturn(0);
}

/* Points whose position is no number are lost under every policy, and stand first. */
static PetscBool is_somewhere(const LostPoint *l) { return !PetscIsInfOrNanReal(l->x[0] + l->x[1] + l->x[2]); }

static void describe_lost(const Model *m, StepReport *report)
{
  PetscSNPrintf(report->reason, sizeof report->reason, "%d point(s) left the grid:", (int)m->space->n_lost);
  for (PetscInt k = 0; k < PetscMin(m->space->n_lost, 2); ++k) {
    const LostPoint *l = &m->space->lost[k];
    const size_t length = strlen(report->reason);
    snprintf(report->reason + length, sizeof report->reason - length,
             " point %lld at (%g, %g, %g) m with velocity (%g, %g, %g) m/s, last in cell %d, step %d;",
             (long long)l->id, (double)l->x[0], (double)l->x[1], (double)l->x[2], (double)l->v[0], (double)l->v[1],
             (double)l->v[2], (int)l->last_cell, (int)m->step);
  }
  const size_t length = strlen(report->reason);
  snprintf(report->reason + length, sizeof report->reason - length,
           " make the grid larger, or say grid: {outside: remove} or {outside: keep-on-boundary}");
}

void outside_judge(const Model *m, StepReport *report)
{
  if (!m->space->n_lost || (m->c->grid.outside != OUTSIDE_STOP && is_somewhere(&m->space->lost[0]))) return;
  report->outcome = STEP_POINTS_LOST;
  describe_lost(m, report);
}

/* The axis along which a side of a cell looks out of the grid: that of the largest component of its
 * normal. */
static PetscInt side_axis(const Model *m, PetscInt cell, PetscInt side, PetscReal *direction)
{
  const Cell *type = grid_cell(m->grid, cell);
  const PetscInt dim = m->dim, *corner = type->face[side];
  PetscReal x[3 * CELL_MAX_NODES], a[3] = {0, 0, 0}, b[3] = {0, 0, 1}, n[3];
  PetscInt axis = 0;
  grid_cell_x(m->grid, cell, x);
  for (PetscInt d = 0; d < dim; ++d) {
    a[d] = x[corner[1] * dim + d] - x[corner[0] * dim + d];
    if (dim == 3) b[d] = x[corner[2] * dim + d] - x[corner[0] * dim + d];
  }
  for (int d = 0; d < 3; ++d) n[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
  for (PetscInt d = 1; d < dim; ++d)
    if (PetscAbsReal(n[d]) > PetscAbsReal(n[axis]) * (1 + 1e-9)) axis = d;
  *direction = n[axis];
  return axis;
}

/* Is a node of the side held along the axis? */
static PetscBool is_held(const Model *m, PetscInt cell, PetscInt side, PetscInt axis)
{
  const Cell *type = grid_cell(m->grid, cell);
  for (PetscInt k = 0; k < type->face_nodes; ++k) {
    const PetscInt node = m->grid->cell_node[cell * m->grid->nodes_per_cell + type->face[side][k]];
    if (boundary_holds(m->boundary, node, axis)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Does a wall stand within half a cell of the side's middle? */
static PetscBool has_wall(const Model *m, PetscInt cell, PetscInt side)
{
  const Cell *type = grid_cell(m->grid, cell);
  PetscReal x[3 * CELL_MAX_NODES], middle[3] = {0, 0, 0};
  WallPlace place;
  grid_cell_x(m->grid, cell, x);
  for (PetscInt k = 0; k < type->face_nodes; ++k)
    for (PetscInt d = 0; d < m->dim; ++d)
      middle[d] += x[type->face[side][k] * m->dim + d] / (PetscReal)type->face_nodes;
  for (PetscInt k = 0; m->walls && k < m->c->n_walls; ++k)
    if (wall_near(m->walls, k, m->time, middle, m->grid->smallest, 0, &place) &&
        PetscAbsReal(place.gap) < 0.51 * m->grid->smallest)
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Sides of filled cells at the edge of the grid that nothing holds, per body and direction (-x x -y
 * y -z z). */
static PetscErrorCode CountFree(const Model *m, PetscInt *count)
{
  const GridSet *outer = &m->grid->outer;
  PetscInt *body;
  PetscReal direction;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m->grid->n_cells, &body));
  for (PetscInt c = 0; c < m->grid->n_cells; ++c) body[c] = -1;
  for (PetscInt p = 0; p < m->points->n; ++p) body[m->points->cell[p]] = m->points->body[p];
  for (PetscInt f = 0; f < outer->n_faces; ++f) {
    const PetscInt cell = outer->face_cell[f], side = outer->face_side[f];
    if (body[cell] < 0) continue;
    const PetscInt axis = side_axis(m, cell, side, &direction);
    if (!is_held(m, cell, side, axis) && !has_wall(m, cell, side)) ++count[6 * body[cell] + 2 * axis + (direction > 0)];
  }
  PetscCall(PetscFree(body));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, count, (PetscMPIInt)(6 * m->c->n_bodies), MPIU_INT, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

/* Does a body that fills its shape, and has not moved, end before this edge of a box, though in the last cell? */
static PetscBool ends_before(const Model *m, PetscInt b, PetscInt axis, PetscBool high)
{
  const BodySpec *body = m->c->bodies + b;
  PetscReal min[3], max[3];
  if (!m->grid->box || case_goes_on(m->c) || body->mesh || !body_fills_shape(body, PETSC_TRUE)) return PETSC_FALSE;
  shape_bounds(&body->shape, m->dim, min, max);
  return (PetscBool)((high ? m->grid->max[axis] - max[axis] : min[axis] - m->grid->min[axis]) >
                     SHORT * m->grid->smallest);
}

PetscErrorCode OutsideWarn(const Model *m, Diag *diag)
{
  static const char *const name[] = {"-x", "x", "-y", "y", "-z", "z"};
  static const char *const what[] = {"what passes that edge ends the run", "what passes that edge is removed",
                                     "what reaches that edge is kept there"};
  PetscInt *count;
  char path[64], list[32];

  PetscFunctionBeginUser;
  if (!m->method->restores_grid) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(6 * m->c->n_bodies, &count));
  PetscCall(CountFree(m, count));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) {
    int end = 0;
    for (int k = 0; k < 6; ++k)
      if (count[6 * b + k] && !ends_before(m, b, k / 2, (PetscBool)(k % 2)))
        end += snprintf(list + end, sizeof list - (size_t)end, "%s%s", end ? ", " : "", name[k]);
    if (!end) continue;
    snprintf(path, sizeof path, "bodies[%d]", (int)b);
    diag_warning(diag, path, "'%s' fills the grid to its edge towards %s, where nothing holds it: %s",
                 m->c->bodies[b].name, list, what[m->c->grid.outside]);
    diag_hint(diag, "let the grid reach at least a cell farther than the body will go");
  }
  PetscCall(PetscFree(count));
  PetscFunctionReturn(0);
}
