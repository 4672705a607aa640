#include "method/extend/row.h"

void way_of(PetscInt way, PetscInt step[3])
{
  step[0] = way % 3 - 1;
  step[1] = way / 3 % 3 - 1;
  step[2] = way / 9 - 1;
}

PetscInt ways_many(PetscInt ways)
{
  PetscInt n = 0;
  for (; ways; ways &= ways - 1) ++n;
  return n;
}

PetscInt node_beside(const GridBox *box, const PetscInt at[LATTICE], const PetscInt step[3])
{
  const PetscInt there[LATTICE] = {at[0] + step[0], at[1] + step[1], at[2] + step[2], at[3]};
  return block_has(&box->nodes, there) ? box_node(box, there) : -1;
}

/* Room for a node at k, before those that stand there. */
static void insert(Row *row, PetscInt slopes, PetscInt k, PetscInt node)
{
  for (PetscInt q = row->n++; q > k; --q) {
    row->node[q] = row->node[q - 1];
    row->N[q] = row->N[q - 1];
    for (PetscInt d = 0; d < slopes; ++d) row->dN[q * slopes + d] = row->dN[(q - 1) * slopes + d];
  }
  row->node[k] = node;
  row->N[k] = 0;
  for (PetscInt d = 0; d < slopes; ++d) row->dN[k * slopes + d] = 0;
}

void row_add(Row *row, PetscInt slopes, PetscInt node, PetscReal share, PetscReal N, const PetscReal *dN)
{
  PetscInt k = row->n;
  while (k > 0 && row->node[k - 1] >= node) --k;
  if (k == row->n || row->node[k] != node) insert(row, slopes, k, node);
  row->N[k] += share * N;
  for (PetscInt d = 0; d < slopes; ++d) row->dN[k * slopes + d] += share * dN[d];
}

/* With B one step on the way, u = u_B + sum_d r_d (u_(B + d) - u_B) over the axes of the way: the linear function of
 * these nodes. */
PetscBool row_add_way(Row *row, PetscInt slopes, const GridBox *box, const PetscInt at[LATTICE], const PetscInt step[3],
                      const PetscReal *lean, PetscReal share, PetscReal N, const PetscReal *dN)
{
  const PetscInt base[LATTICE] = {at[0] + step[0], at[1] + step[1], at[2] + step[2], at[3]};
  PetscReal rest = share;
  for (PetscInt d = 0; d < box->dim; ++d) {
    PetscInt along[3] = {0, 0, 0};
    if (!step[d]) continue;
    along[d] = step[d];
    const PetscReal *line = box->line[d];
    const PetscReal whole = share * (line[at[d]] - line[base[d]]) / (line[base[d] + step[d]] - line[base[d]]);
    const PetscInt behind = node_beside(box, base, along);
    if (behind < 0) return PETSC_FALSE;
    const PetscReal r = lean ? lean[behind] * whole : whole;
    row_add(row, slopes, behind, r, N, dN);
    rest -= r;
  }
  row_add(row, slopes, box_node(box, base), rest, N, dN);
  return PETSC_TRUE;
}

PetscBool row_add_follower(Row *row, PetscInt slopes, const GridBox *box, const PetscInt at[LATTICE], PetscInt ways,
                           PetscReal N, const PetscReal *dN)
{
  const PetscInt n = ways_many(ways);
  PetscInt step[3];
  for (PetscInt way = 0; way < WAYS; ++way) {
    if (!(ways >> way & 1)) continue;
    way_of(way, step);
    if (node_beside(box, at, step) < 0 || !row_add_way(row, slopes, box, at, step, NULL, 1 / (PetscReal)n, N, dN))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}
