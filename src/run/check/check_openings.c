/* Openings too narrow to let material through: gaps of less than two cells between held parts of
 * the outer boundary, and orifices on the axis of a body of revolution (their diameter counts). One
 * cell is shut, since all its nodes are held. In the plane only. */
#include "base/gather.h"
#include "run/check/check_private.h"

/* Where held faces end: a node that belongs to one of them alone. */
typedef struct {
  PetscReal x[2], length; /* of that face */
  PetscReal face;         /* which one, over all ranks */
} HeldEnd;

/* Of one entry, unless it has been counted with an earlier one: faces held around each node, their
 * length and their number, n_nodes x 3. */
static PetscErrorCode AddFaces(const Grid *grid, const Selector *on, unsigned char *seen, PetscReal *around)
{
  PetscInt n, *cell, *side;

  PetscFunctionBeginUser;
  PetscCall(GridSelectFaces(grid, on, &n, &cell, &side));
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt *face = grid_cell(grid, cell[k])->face[side[k]],
                   *node = grid->cell_node + cell[k] * grid->nodes_per_cell;
    const PetscReal *a = grid->x + node[face[0]] * 2, *b = grid->x + node[face[1]] * 2;
    if (grid_field_of(grid, cell[k]) || seen[cell[k]] & (1 << side[k])) continue;
    seen[cell[k]] |= (unsigned char)(1 << side[k]);
    for (int i = 0; i < 2; ++i) {
      PetscReal *s = around + node[face[i]] * 3;
      s[0] += 1;
      s[1] += PetscSqrtReal(PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]));
      s[2] += (PetscReal)(grid->global_cell[cell[k]] * 4 + side[k]);
    }
  }
  PetscCall(PetscFree(cell));
  PetscCall(PetscFree(side));
  PetscFunctionReturn(0);
}

/* The ends of all ranks, on all of them. On the axis nothing ends: the other half goes on. */
static PetscErrorCode GatherEnds(const Model *m, const PetscReal *around, PetscInt *n, HeldEnd **ends)
{
  const Grid *grid = m->grid;
  PetscInt mine = 0;
  HeldEnd *local;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_owned, &local));
  for (PetscInt node = 0; node < grid->n_owned; ++node) {
    const PetscReal *x = grid->x + 2 * node, *s = around + 3 * node;
    const PetscBool on_axis = m->c->kinematics->hoop && x[0] <= 0;
    if (s[0] == 1 && !on_axis) local[mine++] = (HeldEnd){{x[0], x[1]}, s[1], s[2]};
  }
  PetscCall(GatherAll(grid->comm, sizeof *local, mine, local, n, ends));
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

static PetscErrorCode FindEnds(const Model *m, PetscInt *n, HeldEnd **ends)
{
  PetscReal *around;
  unsigned char *seen;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(3 * m->grid->n_nodes, &around, m->grid->n_cells, &seen));
  for (PetscInt k = 0; k < m->c->n_boundary; ++k)
    if (!m->c->boundary[k].moves) PetscCall(AddFaces(m->grid, &m->c->boundary[k].on, seen, around));
  PetscCall(GridSumToOwners(m->grid, 3, around));
  PetscCall(GatherEnds(m, around, n, ends));
  PetscCall(PetscFree2(around, seen));
  PetscFunctionReturn(0);
}

/* The narrowest opening that begins at end i, m: to an end of another face, or to its mirror image
 * beyond the axis. */
static PetscReal opening_at(const Model *m, PetscInt n, const HeldEnd *ends, PetscInt i)
{
  const HeldEnd *a = &ends[i];
  PetscReal width = m->c->kinematics->hoop ? 2 * a->x[0] : PETSC_INFINITY;
  for (PetscInt j = i + 1; j < n; ++j)
    if (ends[j].face != a->face)
      width = PetscMin(width, PetscSqrtReal(PetscSqr(a->x[0] - ends[j].x[0]) + PetscSqr(a->x[1] - ends[j].x[1])));
  return width;
}

PetscErrorCode CheckOpenings(const Model *m, Diag *diag)
{
  PetscInt n = 0;
  HeldEnd *ends = NULL;
  char place[80];
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  if (m->dim != 2 || m->grid->cloud || !m->method->restores_grid) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  PetscCall(FindEnds(m, &n, &ends));
  for (PetscInt i = 0; i < n && !rank; ++i) {
    const PetscReal width = opening_at(m, n, ends, i);
    if (width >= 2 * ends[i].length * (1 - 1e-9)) continue;
    diag_warning(diag, "boundary",
                 "the opening of %g m at %s m is narrower than two cells: little or nothing passes it", (double)width,
                 text_position(2, ends[i].x, place));
    diag_hint(diag, "make the cells there smaller; steady flow wants ten of them from edge to edge");
  }
  PetscCall(PetscFree(ends));
  PetscFunctionReturn(0);
}
