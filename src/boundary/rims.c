/* Rims of what is held: lines of nodes, or the surface of a region of them. */
#include "boundary/boundary.h"
#include "grid/box/box.h"

/* Of one entry: member (n_nodes) tells its nodes. */
static void add_rims(const GridBox *box, const unsigned char *member, unsigned char *rim)
{
  const VoxelBlock *known = &box->nodes;
  PetscInt at[LATTICE];
  for (PetscBool more = block_first(known, at); more; more = block_next(known, at)) {
    const PetscInt node = box_node(box, at);
    for (PetscInt d = 0; member[node] && d < box->dim; ++d)
      for (int side = -1; side <= 1; side += 2) {
        PetscInt beside[LATTICE] = {at[0], at[1], at[2], at[3]};
        beside[d] += side;
        if (!block_has(known, beside) || member[box_node(box, beside)]) continue;
        rim[node] |= (unsigned char)(1 << d);
      }
  }
}

PetscErrorCode BoundaryRims(const Boundary *b, const Grid *grid, unsigned char *rim)
{
  unsigned char *member;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(rim, b->n_nodes));
  PetscCall(PetscCalloc1(b->n_nodes, &member));
  for (PetscInt k = 0; k < b->c->n_boundary; ++k) {
    const MotionNodes *nodes = b->motion + k;
    if (b->c->boundary[k].moves || b->c->boundary[k].absent) continue;
    for (PetscInt i = 0; i < nodes->n; ++i) member[nodes->node[i]] = 1;
    add_rims(grid->box, member, rim);
    for (PetscInt i = 0; i < nodes->n; ++i) member[nodes->node[i]] = 0;
  }
  PetscCall(PetscFree(member));
  PetscFunctionReturn(0);
}
