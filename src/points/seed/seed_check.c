/* What a user should know of a seeded body: that it has points at all, that it has its volume.
 * (overlap.c: that it overlaps no other.) */
#include "points/fields.h"
#include "points/seed/seed.h"
#include "base/count.h"
#include "case/shape_volume.h"

/* "[0, 1] x [-inf, 2] m" */
static void print_bounds(PetscInt dim, const PetscReal *min, const PetscReal *max, size_t size, char *text)
{
  const PetscReal infinite = 0.5 * PETSC_MAX_REAL;
  size_t used = 0;
  for (PetscInt d = 0; d < dim && used < size; ++d) {
    const PetscReal a = min[d] < -infinite ? -PETSC_INFINITY : min[d], b = max[d] > infinite ? PETSC_INFINITY : max[d];
    used += (size_t)snprintf(text + used, size - used, "%s[%g, %g]", d ? " x " : "", (double)a, (double)b);
  }
}

/* Do the bounds leave the grid on a side where they are finite? apart: they do not even meet it.
 * What turns about x = 0 is on its other side, too. */
static PetscBool reaches_out(const Seeding *s, const PetscReal *min, const PetscReal *max, PetscBool *apart)
{
  const PetscReal infinite = 0.5 * PETSC_MAX_REAL;
  PetscBool out = PETSC_FALSE;
  *apart = PETSC_FALSE;
  for (PetscInt d = 0; d < s->source->dim; ++d) {
    const PetscReal slack = 1e-9 * (s->source->max[d] - s->source->min[d]);
    const PetscReal low = d == 0 && s->c->kinematics->hoop ? PetscMax(0, min[d]) : min[d];
    const PetscBool below = low > -infinite && low < s->source->min[d] - slack;
    if (below || (max[d] < infinite && max[d] > s->source->max[d] + slack)) out = PETSC_TRUE;
    if (min[d] >= s->source->max[d] || max[d] <= s->source->min[d]) *apart = PETSC_TRUE;
  }
  return out;
}

static void tell_empty(const Seeding *s)
{
  const char *name = s->body->name;
  PetscReal min[3], max[3];
  PetscBool apart;
  char path[128], body[256], grid[256];
  print_bounds(s->source->dim, s->source->min, s->source->max, sizeof grid, grid);
  seed_path(s->b, s->body->has_shape ? "shape" : s->body->region ? "region" : "", sizeof path, path);
  if (!s->body->has_shape) {
    diag_error(s->diag, path, "body '%s' has no cell", name);
    return;
  }
  shape_bounds(&s->body->shape, s->source->dim, min, max);
  print_bounds(s->source->dim, min, max, sizeof body, body);
  (void)reaches_out(s, min, max, &apart);
  diag_error(s->diag, path, "body '%s' holds the centre of no cell: it spans %s m, the grid %s m", name, body, grid);
  if (apart) diag_hint(s->diag, "the body lies outside the grid");
  else if (s->body->region) diag_hint(s->diag, "is there anything of region '%s' inside the shape?", s->body->region);
  else
    diag_hint(s->diag, "is the body thinner than a cell? The smallest cell measures %g m", (double)s->source->smallest);
}

static void compare_volume(const Seeding *s, PetscReal seeded)
{
  const Shape *shape = s->body->has_shape && !s->body->region ? &s->body->shape : NULL;
  const PetscReal wanted = shape ? shape_volume(shape, s->c->kinematics, s->source->min, s->source->max) : -1;
  const PetscBool fills = body_fills_shape(s->body, s->equal);
  const char *unit = kinematics_is_plane(s->c->kinematics) ? "m2" : "m3";
  char path[128];
  if (wanted <= 0 || PetscAbsReal(seeded - wanted) <= 0.01 * wanted) return;
  seed_path(s->b, "shape", sizeof path, path);
  const double got = (double)seeded, meant = (double)wanted, off = (double)(100 * (seeded / wanted - 1));
  if (fills) {
    diag_warning(s->diag, path, "cells hold not all of body '%s': %.6g %s, its shape has %.6g %s (%+.2g %%)",
                 s->body->name, got, unit, meant, unit, off);
    diag_hint(s->diag, "does the grid have cells wherever the body is? Is the body thinner than a quarter of a cell?");
    return;
  }
  diag_warning(s->diag, path, "whole cells represent body '%s': they hold %.6g %s, its shape %.6g %s (%+.2g %%)",
               s->body->name, got, unit, meant, unit, off);
  diag_hint(s->diag,
            "cells whose centre lies in the shape belong to it: let cell faces follow it, use smaller cells, or "
            "`fill: shape` with mpm");
}

/* Material that the grid does not reach would be lost without a word. A shape cut by a region or a
 * mesh of its own is taken as meant. */
static PetscBool tell_outside_shape(const Seeding *s)
{
  PetscReal min[3], max[3];
  PetscBool apart;
  char path[128], body[256], grid[256];
  if (!s->body->has_shape || s->body->region || s->body->mesh) return PETSC_FALSE;
  shape_bounds(&s->body->shape, s->source->dim, min, max);
  if (!reaches_out(s, min, max, &apart)) return PETSC_FALSE;
  print_bounds(s->source->dim, min, max, sizeof body, body);
  print_bounds(s->source->dim, s->source->min, s->source->max, sizeof grid, grid);
  seed_path(s->b, "shape", sizeof path, path);
  diag_error(s->diag, path, "body '%s' reaches outside the grid: it spans %s m, the grid %s m", s->body->name, body,
             grid);
  return PETSC_TRUE;
}

/* Its middle is the only place where a quadrilateral or hexahedron with one point is felt: it may
 * bend into an hourglass at no cost. */
static void tell_hourglass(const Seeding *s)
{
  const CellType type = s->source->type;
  char path[128];
  if (s->rule.n > 1 || s->source != s->grid || (type != CELL_QUADRILATERAL && type != CELL_HEXAHEDRON)) return;
  seed_path(s->b, "points_per_cell", sizeof path, path);
  diag_warning(s->diag, path, "with one point in each %s of '%s' nothing resists its hourglass motions",
               cells[type].name, s->body->name);
  diag_hint(s->diag, "use %d points, or %ss", type == CELL_HEXAHEDRON ? 8 : 4,
            cells[type == CELL_HEXAHEDRON ? CELL_TETRAHEDRON : CELL_TRIANGLE].name);
}

/* Numbers that one point has in its widest array: a field, or its shape functions' gradients. */
static PetscInt widest(const Grid *grid, const Points *points)
{
  PetscInt most = grid->nodes_per_cell * grid->dim;
  for (int f = 0; f < POINT_N_REAL; ++f) most = PetscMax(most, points->components[f]);
  return most;
}

PetscErrorCode SeedCheckRoom(const Seeding *s, const Points *points, PetscBool *fits)
{
  const PetscInt most = count_most(widest(s->grid, points));
  PetscInt64 wanted;
  char path[128];
  PetscFunctionBeginUser;
  (void)count_fits(points->n, s->n_cells, s->rule.n, most, &wanted);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &wanted, 1, MPIU_INT64, MPI_MAX, s->grid->comm));
  *fits = wanted <= most;
  if (*fits || !seed_tells(s->grid)) PetscFunctionReturn(0);
  seed_path(s->b, "points_per_cell", sizeof path, path);
  diag_error(s->diag, path, "with body '%s' a rank would have %lld points; it can number %d", s->body->name,
             (long long)wanted, (int)most);
  diag_hint(s->diag, "use more ranks (mpiexec -n ...), larger cells, or fewer points in each");
  PetscFunctionReturn(0);
}

/* Of the k-th cell that which its points will have: parts turn about the axis with their own radii. */
static PetscReal volume_in(const Seeding *s, PetscInt k)
{
  const PetscInt cell = s->cells[k];
  const CellType type = grid_cell_type(s->source, cell);
  PetscReal x[CELL_MAX_NODES * 3], at[3], share = 0;
  if (!s->cut || s->cut[k] < 0) return seed_cell_volume(s, cell);
  grid_cell_x(s->source, cell, x);
  for (const SeedPart *part = s->part + s->cut[k]; part < s->part + s->cut[k] + seed_rule(s, cell)->n; ++part) {
    if (part->share <= 0) continue;
    cell_position(type, x, part->xi, at);
    share += part->share * kinematics_weight(s->c->kinematics, at[0]);
  }
  return share * cell_volume(type, x);
}

PetscErrorCode SeedCheckVolume(Seeding *s)
{
  PetscReal mine[2] = {(PetscReal)s->n_cells, 0}, sum[2];
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->n_cells; ++k) mine[1] += volume_in(s, k);
  PetscCallMPI(MPI_Allreduce(mine, sum, 2, MPIU_REAL, MPIU_SUM, s->grid->comm));
  s->volume = sum[1];
  if (!seed_tells(s->grid)) PetscFunctionReturn(0);
  if (sum[0] == 0) tell_empty(s);
  else if (tell_outside_shape(s)) PetscFunctionReturn(0);
  else {
    compare_volume(s, sum[1]);
    tell_hourglass(s);
  }
  PetscFunctionReturn(0);
}

static void tell_outside(const Grid *grid, const Case *c, PetscInt b, PetscInt n_out, Diag *diag)
{
  char path[128], bounds[256];
  print_bounds(grid->dim, grid->min, grid->max, sizeof bounds, bounds);
  seed_path(b, "mesh", sizeof path, path);
  diag_error(diag, path, "%d points of body '%s' lie outside the grid, which spans %s m", (int)n_out, c->bodies[b].name,
             bounds);
}

PetscErrorCode SeedCheckLocated(const Points *points, const Grid *grid, const Case *c, Diag *diag)
{
  PetscInt *n_out;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(c->n_bodies, &n_out));
  for (PetscInt p = 0; p < points->n; ++p) n_out[points->body[p]] += points->cell[p] < 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n_out, (PetscMPIInt)c->n_bodies, MPIU_INT, MPI_SUM, grid->comm));
  for (PetscInt b = 0; b < c->n_bodies && seed_tells(grid); ++b) {
    if (n_out[b]) tell_outside(grid, c, b, n_out[b], diag);
  }
  PetscCall(PetscFree(n_out));
  PetscFunctionReturn(0);
}
