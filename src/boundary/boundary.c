#include "boundary/boundary.h"

/* Displacement that the entry asks for at time t, in component d; zero at the start whatever the amplitude. */
static PetscReal displacement_at(const Case *c, const MotionSpec *m, PetscInt d, PetscReal t)
{
  if (t <= 0) return 0;
  const PetscReal ramp = c->analysis.type == ANALYSIS_STATIC ? t / c->analysis.end : 1;
  return m->value[d] * amplitude_value(&m->amplitude, t, ramp);
}

/* Turn x about the axis through centre by the angle; returns the displacement of component d. */
static PetscReal rotation(const MotionSpec *m, PetscInt dim, const PetscReal *x, PetscReal angle, PetscInt d)
{
  PetscReal r[3] = {0, 0, 0}, axis[3] = {0, 0, 1}, norm = 0;
  for (PetscInt i = 0; i < dim; ++i) r[i] = x[i] - m->centre[i];
  if (dim == 3)
    for (PetscInt i = 0; i < 3; ++i) axis[i] = m->axis[i];
  for (PetscInt i = 0; i < 3; ++i) norm += axis[i] * axis[i];
  norm = PetscSqrtReal(norm);
  PetscReal along = 0;
  for (PetscInt i = 0; i < 3; ++i) along += (axis[i] /= norm) * r[i];
  const PetscInt j = (d + 1) % 3, k = (d + 2) % 3;
  const PetscReal cross = axis[j] * r[k] - axis[k] * r[j];
  /* Rodrigues: r' = r cos + (n x r) sin + n (n.r)(1 - cos); 1 - cos without cancellation */
  const PetscReal s = PetscSinReal(angle / 2), one_less_cos = 2 * s * s;
  return PetscSinReal(angle) * cross + one_less_cos * (axis[d] * along - r[d]);
}

static PetscReal increment_of(const Case *c, const MotionSpec *m, const PetscReal *x, PetscInt d, PetscReal t0,
                              PetscReal t1)
{
  const PetscInt dim = kinematics_dim(c->kinematics);
  const PetscReal span = amplitude_integral(&m->amplitude, t1, 1) - amplitude_integral(&m->amplitude, t0, 1);
  switch (m->kind) {
  case MOTION_DISPLACEMENT: return displacement_at(c, m, d, t1) - displacement_at(c, m, d, t0);
  case MOTION_VELOCITY: return m->value[d] * span;
  case MOTION_ROTATION: return rotation(m, dim, x, m->rate * span, d);
  case MOTION_FIXED: break;
  }
  return 0;
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
        increment_of(b->c, &b->c->boundary[b->entry[i]], grid->x + (i / b->dim) * b->dim, i % b->dim, t0, t1);
    }
  }
}

/* Do two entries ask the same of a node? Compared at some instants rather than symbolically. */
static PetscBool motions_agree(const Case *c, const MotionSpec *a, const MotionSpec *b, const PetscReal *x, PetscInt d)
{
  static const PetscReal part[] = {0.0101, 0.1, 0.37, 0.5, 0.77, 1};
  for (PetscInt k = 0; k < 6; ++k) {
    const PetscReal t = part[k] * c->analysis.end;
    const PetscReal u = increment_of(c, a, x, d, 0, t), v = increment_of(c, b, x, d, 0, t);
    if (PetscAbsReal(u - v) > 1e-12 * (PetscAbsReal(u) + PetscAbsReal(v))) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* (x, y) or (x, y, z) */
static void position_text(PetscInt dim, const PetscReal *x, char text[64])
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
  position_text(b->dim, x, at);
  DiagError(diag, path,
            "boundary[%d] contradicts boundary[%d]: both prescribe %c of the node at %s, but not the same motion",
            (int)entry, (int)b->entry[node * b->dim + d], axis[d], at);
  DiagHint(diag, "leave the node out of one of the two selections");
}

/* Mark the dofs of one entry; the first contradiction with an earlier entry is reported (diag NULL: they were sought before). */
static void mark_entry(Boundary *b, const Grid *grid, PetscInt entry, Diag *diag)
{
  const MotionSpec *m = &b->c->boundary[entry];
  PetscBool reported = PETSC_FALSE;
  for (PetscInt k = 0; k < b->motion[entry].n; ++k) {
    const PetscInt node = b->motion[entry].node[k];
    for (PetscInt d = 0; d < b->dim; ++d) {
      const PetscInt i = node * b->dim + d;
      if (!m->component[d] && m->kind != MOTION_ROTATION) continue;
      if (b->fixed[i] && diag && !reported &&
          !motions_agree(b->c, m, &b->c->boundary[b->entry[i]], grid->x + node * b->dim, d)) {
        report_contradiction(b, grid, node, d, entry, diag);
        reported = PETSC_TRUE;
      }
      if (!b->fixed[i]) b->entry[i] = entry;
      b->fixed[i] = 1;
    }
  }
}

static PetscErrorCode CheckSelection(const Boundary *b, const Grid *grid, PetscInt entry, Diag *diag)
{
  const Selector *on = &b->c->boundary[entry].on;
  PetscInt local = b->motion[entry].n, all;
  char path[64], from[64], to[64];

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(&local, &all, 1, MPIU_INT, MPI_SUM, grid->comm));
  if (on->boundary && !GridFindSet(grid, on->boundary)) {
    const char **names;
    PetscCall(PetscSNPrintf(path, sizeof path, "boundary[%d].on.boundary", (int)entry));
    PetscCall(GridSetNames(grid, &names));
    DiagError(diag, path, "the grid has no boundary or region named '%s'", on->boundary);
    const char *nearest = DiagNearest(on->boundary, names);
    if (nearest) DiagHint(diag, "did you mean '%s'?", nearest);
    PetscCall(PetscFree(names));
  } else if (!all) {
    PetscCall(PetscSNPrintf(path, sizeof path, "boundary[%d].on", (int)entry));
    position_text(b->dim, grid->min, from);
    position_text(b->dim, grid->max, to);
    DiagError(diag, path, "%s selects no node of the grid, which spans %s to %s", path, from, to);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BoundaryCreate(const Grid *grid, const Case *c, Diag *diag, Boundary **boundary)
{
  Boundary *b;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  b->c = c;
  b->dim = grid->dim;
  b->n_nodes = grid->n_nodes;
  PetscCall(PetscCalloc1(b->n_nodes * b->dim, &b->fixed));
  PetscCall(PetscMalloc1(b->n_nodes * b->dim, &b->entry));
  for (PetscInt i = 0; i < b->n_nodes * b->dim; ++i) b->entry[i] = -1;
  PetscCall(PetscCalloc1(c->n_boundary, &b->motion));
  for (PetscInt k = 0; k < c->n_boundary; ++k) {
    PetscCall(GridSelectNodes(grid, &c->boundary[k].on, &b->motion[k].n, &b->motion[k].node));
    PetscCall(CheckSelection(b, grid, k, diag));
    mark_entry(b, grid, k, diag);
  }
  *boundary = b;
  PetscFunctionReturn(0);
}

PetscErrorCode BoundaryToCloud(const Boundary *of_mesh, const Grid *mesh, const unsigned char *marked, Grid *cloud,
                               Boundary **boundary)
{
  const PetscInt n_entries = of_mesh->c->n_boundary;
  Boundary *b;
  PetscInt *local;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  b->c = of_mesh->c;
  b->dim = cloud->dim;
  PetscCall(PetscCalloc1(n_entries, &b->motion));
  PetscCall(PetscCalloc1(cloud->n_nodes * n_entries, &b->member));
  PetscCall(PetscMalloc1(mesh->n_owned, &local));
  for (PetscInt i = 0, n = 0; i < mesh->n_owned; ++i) local[i] = marked[i] ? n++ : -1;
  for (PetscInt k = 0; k < n_entries; ++k)
    for (PetscInt i = 0; i < of_mesh->motion[k].n; ++i) {
      const PetscInt node = of_mesh->motion[k].node[i];
      if (node < mesh->n_owned && local[node] >= 0) b->member[local[node] * n_entries + k] = 1;
    }
  PetscCall(PetscFree(local));
  PetscCall(GridCloudFollow(cloud, &b->member, n_entries, PETSC_TRUE));
  PetscCall(BoundaryFollow(b, cloud));
  *boundary = b;
  PetscFunctionReturn(0);
}

PetscErrorCode BoundaryFollow(Boundary *b, const Grid *cloud)
{
  const PetscInt n_entries = b->c->n_boundary, dofs = cloud->n_nodes * b->dim;

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
  for (PetscInt k = 0; k < b->c->n_boundary; ++k) PetscCall(PetscFree(b->motion[k].node));
  PetscCall(PetscFree(b->motion));
  PetscCall(PetscFree(b->member));
  PetscCall(PetscFree(b->fixed));
  PetscCall(PetscFree(b->entry));
  PetscCall(PetscFree(*boundary));
  PetscFunctionReturn(0);
}

PetscErrorCode BoundarySum(const Boundary *b, const Grid *grid, PetscInt entry, const PetscReal *force,
                           PetscReal sum[3])
{
  PetscReal local[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < b->motion[entry].n; ++k) {
    const PetscInt node = b->motion[entry].node[k];
    if (node >= grid->n_owned) continue;
    for (PetscInt d = 0; d < b->dim; ++d)
      if (b->fixed[node * b->dim + d]) local[d] += force[node * b->dim + d];
  }
  PetscCall(MPIU_Allreduce(local, sum, 3, MPIU_REAL, MPI_SUM, grid->comm));
  PetscFunctionReturn(0);
}
