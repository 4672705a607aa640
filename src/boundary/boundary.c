#include "boundary/bodies.h"
#include "boundary/boundary.h"
#include "case/motion.h"
#include "boundary/slip.h"

/* Behind the entries of the case stands one of the program's own: where the plane turns about x = 0
 * nothing leaves the axis. */
static const MotionSpec axis_entry = {.on = {.has = {PETSC_TRUE}}, .kind = MOTION_FIXED, .component = {PETSC_TRUE}};

static PetscInt count_entries(const Boundary *b) { return b->c->n_boundary + (b->c->kinematics->hoop ? 1 : 0); }

static const MotionSpec *entry_of(const Boundary *b, PetscInt k)
{
  return k < b->c->n_boundary ? &b->c->boundary[k] : &axis_entry;
}

PetscInt boundary_axis(const Boundary *b) { return b->c->kinematics->hoop ? b->c->n_boundary : -1; }

PetscBool boundary_slides_on_axis(const Boundary *b, PetscInt node)
{
  const PetscInt axis = boundary_axis(b), x = node * b->dim;
  return axis >= 0 && b->entry[x] == axis && !b->fixed[x + 1];
}

void boundary_increments(const Boundary *b, const Grid *grid, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  PetscReal field[3];
  for (PetscInt i = 0; i < b->n_nodes * b->dim; ++i) {
    if (!b->fixed[i]) continue;
    if (b->field) {
      b->field(b->field_context, grid->x + (i / b->dim) * b->dim, t0, t1, field);
      increment[i] = field[i % b->dim];
    } else {
      increment[i] =
        motion_increment(b->c, entry_of(b, b->entry[i]), grid->x + (i / b->dim) * b->dim, i % b->dim, t0, t1);
    }
  }
}

/* Do two entries ask the same of a node? Compared at some instants rather than symbolically. */
static PetscBool motions_agree(const Case *c, const MotionSpec *a, const MotionSpec *b, const PetscReal *x, PetscInt d)
{
  static const PetscReal part[] = {0.0101, 0.1, 0.37, 0.5, 0.77, 1};
  for (PetscInt k = 0; k < 6; ++k) {
    const PetscReal t = part[k] * c->analysis.end;
    const PetscReal u = motion_increment(c, a, x, d, 0, t), v = motion_increment(c, b, x, d, 0, t);
    if (PetscAbsReal(u - v) > 1e-12 * (PetscAbsReal(u) + PetscAbsReal(v))) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

void boundary_place(PetscInt dim, const PetscReal *x, char text[64])
{
  if (dim == 3) snprintf(text, 64, "(%g, %g, %g)", (double)x[0], (double)x[1], (double)x[2]);
  else snprintf(text, 64, "(%g, %g)", (double)x[0], (double)x[1]);
}

static void report_contradiction(const Boundary *b, const Grid *grid, PetscInt node, PetscInt d, PetscInt entry,
                                 Diag *diag)
{
  static const char axis[] = "xyz";
  const PetscReal *x = grid->x + node * b->dim;
  char path[64], at[64];
  PetscSNPrintf(path, sizeof path, "boundary[%d]", (int)entry);
  boundary_place(b->dim, x, at);
  if (entry == boundary_axis(b)) {
    PetscSNPrintf(path, sizeof path, "boundary[%d]", (int)b->entry[node * b->dim + d]);
    diag_error(diag, path, "%s moves the node at %s along x, but it lies on the axis, which nothing leaves", path, at);
    diag_hint(diag, "leave nodes with x = 0 out of the selection, or x out of the motion");
    return;
  }
  diag_error(diag, path,
             "boundary[%d] contradicts boundary[%d]: both prescribe %c of the node at %s, but not the same motion",
             (int)entry, (int)b->entry[node * b->dim + d], axis[d], at);
  diag_hint(diag, "leave the node out of one of the two selections");
}

/* Does the entry take a dof over from the one that has it? Sides push along their normals: a floor that holds x and y,
 * and a side that does, share the nodes of their edge so. */
static PetscBool takes_over(const Boundary *b, const Grid *grid, PetscInt entry, PetscInt node, PetscInt d)
{
  const PetscInt has = b->entry[node * b->dim + d];
  if (entry == boundary_axis(b) || b->motion[entry].faces != d || b->motion[has].faces == d) return PETSC_FALSE;
  return motions_agree(b->c, entry_of(b, entry), entry_of(b, has), grid->x + node * b->dim, d);
}

/* Mark the dofs of one entry; the first contradiction with an earlier entry is reported (diag NULL:
 * they were sought before). */
static void mark_entry(Boundary *b, const Grid *grid, PetscInt entry, Diag *diag)
{
  const MotionSpec *m = entry_of(b, entry);
  PetscBool reported = !diag;
  for (PetscInt k = 0; k < b->motion[entry].n; ++k) {
    const PetscInt node = b->motion[entry].node[k];
    for (PetscInt d = 0; d < b->dim; ++d) {
      const PetscInt i = node * b->dim + d;
      if (!m->component[d] && m->kind != MOTION_ROTATION) continue;
      if (b->fixed[i] && diag && !reported &&
          !motions_agree(b->c, m, entry_of(b, b->entry[i]), grid->x + node * b->dim, d)) {
        report_contradiction(b, grid, node, d, entry, diag);
        reported = PETSC_TRUE;
      }
      if (!b->fixed[i] || takes_over(b, grid, entry, node, d)) b->entry[i] = entry;
      b->fixed[i] = 1;
    }
  }
}

static PetscErrorCode CheckSelection(const Boundary *b, const Grid *grid, PetscInt entry, Diag *diag)
{
  const MotionSpec *spec = b->c->boundary + entry;
  const Selector *on = &spec->on;
  PetscInt local = b->motion[entry].n, all;
  PetscBool good = PETSC_TRUE;
  char path[64], from[64], to[64];

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(&local, &all, 1, MPIU_INT, MPI_SUM, grid->comm));
  if (all || bodies_come_later(b->c, spec)) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "boundary[%d].on.boundary", (int)entry));
  if (on->boundary) PetscCall(GridCheckBoundary(grid, on->boundary, path, diag, &good));
  if (good) {
    PetscCall(PetscSNPrintf(path, sizeof path, "boundary[%d].on", (int)entry));
    boundary_place(b->dim, grid->min, from);
    boundary_place(b->dim, grid->max, to);
    diag_error(diag, path, "%s selects no node of %s, which spans %s to %s", path,
               spec->n_bodies ? "its bodies in the grid" : "the grid", from, to);
  }
  PetscFunctionReturn(0);
}

#define FLAT 1e-9 /* of the grid's size */

/* Collective. Which way its nodes face. */
static PetscErrorCode FindFaces(const Grid *grid, MotionNodes *motion)
{
  PetscReal low[6], all[6];
  PetscInt flat = 0;

  PetscFunctionBeginUser;
  for (int i = 0; i < 6; ++i) low[i] = PETSC_MAX_REAL; /* of x, and of -x */
  for (PetscInt k = 0; k < motion->n; ++k)
    for (PetscInt d = 0; d < grid->dim; ++d) {
      const PetscReal x = grid->x[motion->node[k] * grid->dim + d];
      low[d] = PetscMin(low[d], x), low[3 + d] = PetscMin(low[3 + d], -x);
    }
  PetscCall(MPIU_Allreduce(low, all, 6, MPIU_REAL, MPIU_MIN, grid->comm));
  motion->faces = -1;
  for (PetscInt d = 0; d < grid->dim; ++d) {
    if (-all[3 + d] - all[d] > FLAT * (grid->max[d] - grid->min[d])) continue;
    motion->faces = d;
    ++flat;
  }
  if (flat != 1) motion->faces = -1;
  PetscFunctionReturn(0);
}

/* Where entries are for some bodies alone, which nodes are whose. */
static PetscErrorCode FindFields(Boundary *b, const Grid *grid, const Points *points)
{
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < b->c->n_boundary; ++k) any |= b->c->boundary[k].n_bodies > 0;
  if (!any) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(grid->n_nodes, &b->body_field));
  PetscCall(NodeFields(grid, b->c, points, b->body_field));
  PetscFunctionReturn(0);
}

/* Mistakes in the selections go to diag; NULL: they were sought before. */
static PetscErrorCode SelectNodes(Boundary *b, const Grid *grid, const Points *points, Diag *diag)
{
  PetscFunctionBeginUser;
  b->dim = grid->dim;
  b->n_nodes = grid->n_nodes;
  PetscCall(FindFields(b, grid, points));
  PetscCall(PetscCalloc1(b->n_nodes * b->dim, &b->fixed));
  PetscCall(PetscMalloc1(b->n_nodes * b->dim, &b->entry));
  for (PetscInt i = 0; i < b->n_nodes * b->dim; ++i) b->entry[i] = -1;
  PetscCall(PetscCalloc1(count_entries(b), &b->motion));
  for (PetscInt k = 0; k < count_entries(b); ++k) {
    if (entry_of(b, k)->absent) continue;
    PetscCall(EntryNodes(grid, b->c, entry_of(b, k), b->body_field, &b->motion[k].n, &b->motion[k].node));
    if (diag && k < b->c->n_boundary) PetscCall(CheckSelection(b, grid, k, diag));
    PetscCall(FindFaces(grid, &b->motion[k]));
    mark_entry(b, grid, k, diag);
  }
  PetscCall(WallNormals(grid, b->c, b->body_field, &b->n_walls, &b->walls));
  PetscCall(WallSides(grid, b->c, b->body_field, &b->n_sides, &b->sides));
  PetscCall(SlipMark(b, grid, diag));
  if (diag) PetscCall(SlipCheck(b, grid, diag));
  PetscFunctionReturn(0);
}

PetscErrorCode BoundaryCreate(const Grid *grid, const Case *c, const Points *points, Diag *diag, Boundary **boundary)
{
  PetscFunctionBeginUser;
  bodies_check(c, diag);
  PetscCall(PetscNew(boundary));
  (*boundary)->c = c;
  PetscCall(SelectNodes(*boundary, grid, points, diag));
  PetscFunctionReturn(0);
}

PetscErrorCode BoundaryRegrid(Boundary **boundary, const Grid *grid, const Points *points)
{
  Boundary *b;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  b->c = (*boundary)->c;
  b->field = (*boundary)->field;
  b->field_context = (*boundary)->field_context;
  PetscCall(SelectNodes(b, grid, points, NULL));
  PetscCall(BoundaryDestroy(boundary));
  *boundary = b;
  PetscFunctionReturn(0);
}

PetscErrorCode BoundaryToCloud(const Boundary *of_mesh, const Grid *mesh, Grid *cloud, Boundary **boundary)
{
  const PetscInt n_entries = count_entries(of_mesh);
  Boundary *b;
  unsigned char *there; /* of an entry */

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  b->c = of_mesh->c;
  b->dim = cloud->dim;
  PetscCall(PetscCalloc1(n_entries, &b->motion));
  PetscCall(PetscCalloc1(cloud->n_nodes * n_entries, &b->member));
  PetscCall(PetscMalloc1(mesh->n_nodes, &there));
  for (PetscInt k = 0; k < n_entries; ++k) {
    b->motion[k].faces = of_mesh->motion[k].faces;
    PetscCall(PetscArrayzero(there, mesh->n_nodes));
    for (PetscInt i = 0; i < of_mesh->motion[k].n; ++i) there[of_mesh->motion[k].node[i]] = 1;
    for (PetscInt i = 0; i < cloud->n_owned; ++i)
      if (!cloud_is_twin(cloud, i)) b->member[i * n_entries + k] = there[cloud_origin(cloud, mesh, i)];
  }
  PetscCall(PetscFree(there));
  PetscCall(GridCloudFollow(cloud, (CloudField){&b->member, n_entries, "member", NULL, PETSC_FALSE}));
  PetscCall(BoundaryFollow(b, cloud));
  *boundary = b;
  PetscFunctionReturn(0);
}

PetscErrorCode BoundaryFollow(Boundary *b, const Grid *cloud)
{
  const PetscInt n_entries = count_entries(b), dofs = cloud->n_nodes * b->dim;

  PetscFunctionBeginUser;
  b->n_nodes = cloud->n_nodes;
  PetscCall(PetscFree(b->fixed));
  PetscCall(PetscFree(b->entry));
  PetscCall(PetscCalloc1(dofs, &b->fixed));
  PetscCall(PetscMalloc1(dofs, &b->entry));
  for (PetscInt i = 0; i < dofs; ++i) b->entry[i] = -1;
  for (PetscInt k = 0; k < n_entries; ++k) {
    MotionNodes *m = &b->motion[k];
    PetscCall(PetscFree(m->node));
    PetscCall(PetscMalloc1(cloud->n_nodes, &m->node));
    m->n = 0;
    for (PetscInt i = 0; i < cloud->n_nodes; ++i)
      if (b->member[i * n_entries + k] > 0) m->node[m->n++] = i;
    mark_entry(b, cloud, k, NULL);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BoundaryDestroy(Boundary **boundary)
{
  Boundary *b = *boundary;

  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < count_entries(b); ++k) PetscCall(PetscFree(b->motion[k].node));
  PetscCall(PetscFree(b->motion));
  PetscCall(PetscFree(b->body_field));
  PetscCall(PetscFree(b->member));
  PetscCall(PetscFree(b->fixed));
  PetscCall(PetscFree(b->entry));
  PetscCall(PetscFree(b->walls));
  PetscCall(PetscFree(b->sides));
  PetscCall(FramesDestroy(&b->frames));
  PetscCall(PetscFree(*boundary));
  PetscFunctionReturn(0);
}

/* The nodes of a place that has moved, at time t. */
static PetscErrorCode ChooseMoved(Boundary *b, const Grid *grid, PetscInt k, PetscReal t)
{
  const MotionSpec *entry = entry_of(b, k);
  MotionNodes *motion = &b->motion[k];
  PetscReal X[3];

  PetscFunctionBeginUser;
  PetscCall(PetscFree(motion->node));
  PetscCall(PetscMalloc1(b->n_nodes, &motion->node));
  motion->n = 0;
  for (PetscInt node = 0; node < b->n_nodes; ++node) {
    if (b->body_field && !case_takes_field(b->c, entry, b->body_field[node])) continue;
    motion_origin(b->c, entry, grid->x + node * b->dim, t, X);
    if (grid_takes(grid, &entry->on, X)) motion->node[motion->n++] = node;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BoundaryMove(Boundary *b, const Grid *grid, PetscReal t)
{
  const PetscInt dofs = b->n_nodes * b->dim;
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < b->c->n_boundary; ++k) any |= b->c->boundary[k].moves;
  if (!any) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(b->fixed, dofs));
  for (PetscInt i = 0; i < dofs; ++i) b->entry[i] = -1;
  for (PetscInt k = 0; k < count_entries(b); ++k) {
    if (entry_of(b, k)->moves && !entry_of(b, k)->absent) PetscCall(ChooseMoved(b, grid, k, t));
    mark_entry(b, grid, k, NULL);
  }
  PetscCall(SlipMark(b, grid, NULL));
  PetscFunctionReturn(0);
}
