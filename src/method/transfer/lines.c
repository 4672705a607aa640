/* What a MassSolve aims with in a box where ranks know the nodes beside theirs. On a full lattice the mass matrix is
 * the product of one matrix along each axis, each of which a step of Jacobi's method nearly solves:
 *
 *   M^-1 ~ G_1 .. G_d G_d .. G_1 D^-1,    G_k x = x - DAMPED D^-1 M_k x
 *
 * with the diagonal D of M and its entries M_k between neighbours along axis k. Each G_k is symmetric in the product
 * by D whatever the entries are, so that all of this is symmetric and positive wherever points cut cells, and ranks
 * come to the same numbers (docs/theory.md, "Solves with the mass matrix"). */
#include "grid/box/box.h"
#include "method/transfer/lines.h"
#include "method/transfer/loops.h"

#define DAMPED 0.45

/* The two nodes beside each along each axis and what M has between them; a node that has none there has itself. */
struct MassLines {
  PetscInt dim, n_nodes;
  PetscInt *beside;  /* n_nodes x dim x 2: before, behind */
  PetscReal *couple; /* the same, kg */
  PetscReal *behind; /* n_nodes x dim: of the one behind, kg */
};

PetscBool mass_lines_work(const Discretisation *s)
{
  return s->grid->box && basis_find(s->c->basis.kind)->halo > 0 ? PETSC_TRUE : PETSC_FALSE;
}

static void find_beside(const GridBox *box, MassLines *lines)
{
  const VoxelBlock *all = &box->nodes;
  const PetscInt *lo = all->lo, *hi = all->hi;
  PetscInt at[LATTICE], n = 0;
  for (PetscBool more = block_first(all, at); more; more = block_next(all, at), ++n)
    for (PetscInt d = 0, stride = 1; d < box->dim; stride *= hi[d] - lo[d], ++d) {
      PetscInt *beside = lines->beside + 2 * (box->lattice[n] * box->dim + d);
      beside[0] = box->lattice[at[d] > lo[d] ? n - stride : n];
      beside[1] = box->lattice[at[d] + 1 < hi[d] ? n + stride : n];
    }
}

PetscErrorCode MassLinesCreate(const Grid *grid, MassLines **lines)
{
  const PetscInt n = grid->n_nodes * grid->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(lines));
  (*lines)->dim = grid->dim;
  (*lines)->n_nodes = grid->n_nodes;
  PetscCall(PetscCalloc3(2 * n, &(*lines)->beside, 2 * n, &(*lines)->couple, n, &(*lines)->behind));
  for (PetscInt i = 0; i < 2 * n; ++i) (*lines)->beside[i] = i / (2 * grid->dim);
  find_beside(grid->box, *lines);
  PetscFunctionReturn(0);
}

PetscErrorCode MassLinesDestroy(MassLines **lines)
{
  PetscFunctionBeginUser;
  if (!*lines) PetscFunctionReturn(0);
  PetscCall(PetscFree3((*lines)->beside, (*lines)->couple, (*lines)->behind));
  PetscCall(PetscFree(*lines));
  PetscFunctionReturn(0);
}

/* Rows have each pair once, with either node. */
static void take_pairs(const MassPairs *half, MassLines *lines)
{
  const PetscInt dim = lines->dim;
  for (PetscInt node = 0; node < lines->n_nodes; ++node)
    for (PetscInt k = half->start[node] + 1; k < half->start[node + 1]; ++k)
      for (PetscInt d = 0; d < dim; ++d) {
        const PetscInt other = half->column[k], *beside = lines->beside + 2 * (node * dim + d);
        if (other == beside[1]) lines->behind[node * dim + d] += half->entry[k];
        else if (other == beside[0]) lines->behind[other * dim + d] += half->entry[k];
      }
}

PetscErrorCode MassLinesUpdate(const Grid *grid, const MassPairs *half, MassLines *lines)
{
  const PetscInt dim = lines->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(lines->behind, lines->n_nodes * dim));
  take_pairs(half, lines);
  PetscCall(GridSumToOwners(grid, dim, lines->behind));
  PetscCall(GridToGhosts(grid, dim, lines->behind));
  for (PetscInt i = 0; i < lines->n_nodes * dim; ++i) {
    const PetscInt before = lines->beside[2 * i];
    lines->couple[2 * i] = before == i / dim ? 0 : lines->behind[before * dim + i % dim];
    lines->couple[2 * i + 1] = lines->behind[i];
  }
  PetscFunctionReturn(0);
}

/* out = G_k in, of owned nodes. */
UNROLLED void step_along(const PetscInt width, const PetscInt parts, const MassSolve *c, const MassLines *lines,
                         PetscInt axis, const PetscReal *in, PetscReal *out)
{
  for (PetscInt i = 0; i < c->n_reached_owned; ++i) {
    const PetscInt node = c->reached[i], k = 2 * (node * (width / 2) + axis);
    const PetscReal *before = in + lines->beside[k] * width, *behind = in + lines->beside[k + 1] * width;
    const PetscReal a = DAMPED * lines->couple[k], b = DAMPED * lines->couple[k + 1];
    Four z[2];
    for (PetscInt part = 0; part < parts; ++part)
      z[part] =
        take(part, width, in + node * width) -
        take(part, width, c->inverse + node * width) * (a * take(part, width, before) + b * take(part, width, behind));
    for (PetscInt d = 0; d < PetscMin(width, 4 * parts); ++d) out[node * width + d] = z[d / 4][d % 4];
  }
}

PetscErrorCode MassLinesAim(MassSolve *c, const MassLines *lines, PetscReal *spare, PetscReal *aim)
{
  const Grid *grid = c->s->grid;
  const PetscInt dim = lines->dim;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 2 * dim; ++k) {
    const PetscInt axis = PetscMin(k, 2 * dim - 1 - k);
    PetscReal *in = k % 2 ? spare : aim, *out = k % 2 ? aim : spare;
    PetscCall(GridToGhosts(grid, c->width, in));
    if (c->width == 4) step_along(4, 1, c, lines, axis, in, out);
    else if (c->alone) step_along(6, 1, c, lines, axis, in, out);
    else step_along(6, 2, c, lines, axis, in, out);
  }
  PetscFunctionReturn(0);
}
