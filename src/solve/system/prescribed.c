/* Prescribed unknowns leave the system here and nowhere else: their columns move to the
 * right-hand side, their rows and columns are cut. Whoever assembles forces and tangents knows
 * nothing of them. */
#include "solve/system/system.h"

/* One bit for each prescribed unknown of a node. */
static unsigned char held_bits(const System *s, const unsigned char *fixed, const unsigned char *idle, PetscInt node)
{
  unsigned bits = 0;
  for (PetscInt d = 0; d < s->dim; ++d) bits |= (unsigned)(fixed[node * s->dim + d] != 0) << d;
  if (s->block > s->dim) bits |= (unsigned)(idle[node] != 0) << s->dim;
  return (unsigned char)bits;
}

/* One bit for each number of a block that stands in the row or the column of a prescribed
 * unknown. */
static unsigned cut_bits(PetscInt block, unsigned row, unsigned column)
{
  unsigned bits = 0;
  for (PetscInt a = 0; a < block; ++a) bits |= (row >> a & 1 ? (1u << block) - 1 : column) << (a * block);
  return bits;
}

/* What is prescribed, node by node. */
typedef struct {
  unsigned char *held;       /* a bit for each prescribed unknown */
  unsigned char *beside;     /* is the node coupled with one that holds anything? */
  const unsigned char *idle; /* no material touches it, so that its pairs are zeros as they are; NULL: not told */
} Held;

static PetscErrorCode ReserveCuts(System *s, PetscInt more)
{
  PetscFunctionBeginUser;
  if (s->n_cuts + more <= s->capacity_cuts) PetscFunctionReturn(0);
  s->capacity_cuts += s->capacity_cuts / 2 + more + 256;
  PetscCall(PetscRealloc((size_t)s->capacity_cuts * sizeof *s->cut, &s->cut));
  PetscFunctionReturn(0);
}

/* A row is looked through only beside a node that holds anything: there are few. */
static PetscErrorCode FindCuts(System *s, const Held *h)
{
  PetscFunctionBeginUser;
  s->n_cuts = 0;
  for (PetscInt r = 0; r < s->n_rows; ++r) {
    const PetscInt node = s->column[s->diagonal[r]], pairs = s->row_start[r + 1] - s->row_start[r];
    const PetscBool alone = h->idle && h->idle[node];
    if (!alone && !h->beside[node]) continue;
    PetscCall(ReserveCuts(s, pairs));
    if (alone)
      s->cut[s->n_cuts++] = (SystemCut){s->diagonal[r], node, cut_bits(s->block, h->held[node], h->held[node])};
    for (PetscInt k = s->row_start[r]; !alone && k < s->row_start[r + 1]; ++k) {
      const PetscInt column = s->column[k];
      s->cut[s->n_cuts] = (SystemCut){k, node, cut_bits(s->block, h->held[node], h->held[column])};
      s->n_cuts += (h->held[node] || h->held[column]) && !(h->idle && h->idle[column]);
    }
  }
  PetscFunctionReturn(0);
}

/* Which rows get nothing. Where clouds choose their nodes constraints couple some that no material touches. */
static PetscErrorCode FindEmpty(System *s, const Held *h)
{
  PetscFunctionBeginUser;
  const PetscBool told = h->idle && s->before.half;
  if (!s->matter) PetscCall(PetscCalloc1(s->n_rows, &s->matter));
  for (PetscInt r = 0; r < s->n_rows; ++r) {
    const PetscInt node = s->column[s->diagonal[r]];
    const PetscBool empty = told && h->idle[node] && h->held[node] == (1u << s->dim) - 1;
    s->matter[r] = empty ? PetscMax(s->matter[r], ROW_LEFT) : ROW_FILLED;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SystemPrescribe(System *s, const unsigned char *fixed, const unsigned char *idle)
{
  Held h = {.idle = s->block == s->dim ? idle : NULL};

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(s->n_nodes, &h.held, s->n_nodes, &h.beside));
  for (PetscInt r = 0; r < s->n_rows; ++r) {
    const PetscInt node = s->column[s->diagonal[r]];
    h.held[node] = held_bits(s, fixed, idle, node);
    if (!h.held[node] || (h.idle && idle[node])) continue;
    for (PetscInt k = s->row_start[r]; k < s->row_start[r + 1]; ++k) h.beside[s->column[k]] = 1;
  }
  PetscCall(FindCuts(s, &h));
  PetscCall(FindEmpty(s, &h));
  PetscCall(SystemFindTurned(s));
  PetscCall(PetscFree2(h.held, h.beside));
  PetscFunctionReturn(0);
}

void system_lift(const System *s, const unsigned char *fixed, const PetscReal *lift, PetscReal *force,
                 PetscReal *volume)
{
  const PetscInt dim = s->dim, block = s->block;
  for (const SystemCut *c = s->cut; c < s->cut + s->n_cuts; ++c)
    for (PetscInt a = 0; a < block; ++a) {
      PetscReal moved = 0;
      for (PetscInt b = 0, e = (c->pair * block + a) * block; b < dim; ++b)
        moved += (s->single ? (PetscReal)s->singles[e + b] : s->values[e + b]) * lift[s->column[c->pair] * dim + b];
      if (a == dim) volume[c->row] += moved;
      else if (!fixed[c->row * dim + a]) force[c->row * dim + a] += moved;
    }
}

static inline __attribute__((always_inline)) void cut_blocks(const System *s, const int size, const PetscBool single)
{
  for (const SystemCut *c = s->cut; c < s->cut + s->n_cuts; ++c)
    for (int e = 0; e < size; ++e) {
      if (single) s->singles[c->pair * size + e] = c->bits >> e & 1 ? 0 : s->singles[c->pair * size + e];
      else s->values[c->pair * size + e] = c->bits >> e & 1 ? 0 : s->values[c->pair * size + e];
    }
}

void system_cut(System *s)
{
  const PetscInt size = s->block * s->block;
  if (s->single && size == 4) cut_blocks(s, 4, PETSC_TRUE);
  else if (s->single) cut_blocks(s, 9, PETSC_TRUE);
  else if (size == 4) cut_blocks(s, 4, PETSC_FALSE);
  else if (size == 9) cut_blocks(s, 9, PETSC_FALSE);
  else cut_blocks(s, 16, PETSC_FALSE);
}

/* Of the size of the others, which keeps the matrix's scale. */
static PetscErrorCode DiagonalScale(const System *s, PetscReal *scale)
{
  PetscReal largest = 0;

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < s->n_rows; ++r)
    for (PetscInt a = 0; a < s->dim; ++a)
      largest = PetscMax(largest, s->values[(s->diagonal[r] * s->block + a) * s->block + a]);
  PetscCall(MPIU_Allreduce(&largest, scale, 1, MPIU_REAL, MPIU_MAX, s->comm));
  if (*scale == 0) *scale = 1;
  PetscFunctionReturn(0);
}

PetscErrorCode SystemCloseCuts(System *s)
{
  PetscReal scale = 1;

  PetscFunctionBeginUser;
  if (!s->blocks) PetscCall(DiagonalScale(s, &scale));
  for (const SystemCut *c = s->cut; c < s->cut + s->n_cuts; ++c) {
    if (s->column[c->pair] != c->row || s->row[c->row] >= s->n_active) continue;
    for (PetscInt a = 0; a < s->block; ++a) {
      const PetscInt e = a * s->block + a, at = c->pair * s->block * s->block + e;
      if (!(c->bits >> e & 1)) continue;
      if (s->blocks) s->singles[at] = 1;
      else s->values[at] = a < s->dim ? scale : -scale;
    }
  }
  PetscFunctionReturn(0);
}
