/* Unknowns of nodes that have frames are components in these: the tangent's block K_IJ becomes
 * H_I K_IJ H_J, which leaves the matrix symmetric and as sparse as it was. */
#include "solve/system/system.h"

/* Rows beside a node with a frame, and its own. */
static void mark_beside(const System *s, unsigned char *beside)
{
  for (PetscInt f = 0; f < s->frames->n; ++f) {
    const PetscInt row = s->row[s->frames->node[f]];
    for (PetscInt k = row < 0 ? 0 : s->row_start[row]; row >= 0 && k < s->row_start[row + 1]; ++k)
      beside[s->column[k]] = 1;
  }
}

PetscErrorCode SystemFindTurned(System *s)
{
  unsigned char *beside;

  PetscFunctionBeginUser;
  s->n_turned = 0;
  if (!s->frames || !s->frames->n) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(s->n_nodes, &beside));
  mark_beside(s, beside);
  for (PetscInt r = 0; r < s->n_rows; ++r) {
    const PetscInt node = s->column[s->diagonal[r]], pairs = s->row_start[r + 1] - s->row_start[r];
    if (!beside[node]) continue;
    if (s->n_turned + pairs > s->capacity_turned) {
      s->capacity_turned += s->capacity_turned / 2 + pairs + 256;
      PetscCall(PetscRealloc((size_t)s->capacity_turned * sizeof *s->turned, &s->turned));
    }
    for (PetscInt k = s->row_start[r]; k < s->row_start[r + 1]; ++k) {
      s->turned[s->n_turned] = (SystemPair){k, node};
      s->n_turned += frame_of(s->frames, node) || frame_of(s->frames, s->column[k]);
    }
  }
  PetscCall(PetscFree(beside));
  PetscFunctionReturn(0);
}

void system_turn(System *s)
{
  const PetscInt size = s->block * s->block;
  PetscReal a[16];
  for (const SystemPair *t = s->turned; t < s->turned + s->n_turned; ++t) {
    const PetscInt first = t->pair * size;
    const PetscReal *row = frame_of(s->frames, t->row), *column = frame_of(s->frames, s->column[t->pair]);
    for (PetscInt e = 0; e < size; ++e) a[e] = s->single ? (PetscReal)s->singles[first + e] : s->values[first + e];
    frame_turn_block(s->dim, s->block, row, column, a);
    for (PetscInt e = 0; e < size; ++e) {
      if (s->single) s->singles[first + e] = (float)a[e];
      else s->values[first + e] = a[e];
    }
  }
}
