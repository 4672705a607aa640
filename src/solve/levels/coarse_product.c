/* Row by row of the tangent: its blocks are summed to those of its columns' coarse nodes, of which there are few, and
 * these go to the rows of its own coarse nodes. Of a symmetric tangent that is done with the half that was gathered
 * (and half of its diagonals), and the transpose is added. The sums of all ranks meet as those of a System do. */
#include "solve/levels/coarse_product.h"
#include "solve/levels/lists.h"
#include "solve/system/forms/assembled.h"

#define KERNEL static inline __attribute__((always_inline))

typedef double Four __attribute__((vector_size(32), aligned(8), may_alias));

/* Registers of a block, and numbers in them: of 3 x 3 nobody reads the last three. */
#define REGISTERS(dim) ((dim) == 2 ? 1 : 3)
#define NUMBERS(dim) (4 * REGISTERS(dim))

typedef struct {
  const Gathered *tangent;
  const CoarseBox *box;
  const unsigned char *fixed;
  System coarse;      /* local coarse nodes, owned ones and then others: no more of it than Assembled wants */
  Lists parents;      /* of each row of the tangent: local coarse nodes */
  PetscReal *weights; /* and their weights */
  Lists reached;      /* of each row: coarse nodes of its columns */
  PetscInt *place;    /* of each coarse node: in a row, or in `sum` */
  PetscReal *sum;     /* blocks of one row's coarse nodes */
} Product;

/* Which coarse nodes there are here, and of which rows. */
static PetscErrorCode NumberLocally(Product *p)
{
  const CoarseBox *box = p->box;
  const PetscInt n = p->tangent->s->n_rows, width = box->width;
  PetscInt first = 0, others = 0, *other, *count, at;
  System *c = &p->coarse;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Exscan(&box->n, &first, 1, MPIU_INT, MPI_SUM, c->comm));
  PetscCall(PetscMalloc1(n * width, &other));
  PetscCall(PetscCalloc1(n, &count));
  for (PetscInt i = 0; i < n * width; ++i) {
    const PetscInt number = box->parent[i];
    count[i / width] += number >= 0;
    if (number >= 0 && (number < first || number >= first + box->n)) other[others++] = number;
  }
  PetscCall(PetscSortRemoveDupsInt(&others, other));
  PetscCall(ListsCreate(n, count, &p->parents));
  PetscCall(PetscMalloc1(p->parents.start[n], &p->weights));
  for (PetscInt i = 0, k = 0; i < n * width; ++i) {
    const PetscInt number = box->parent[i];
    if (number < 0) continue;
    p->parents.item[k] = number - first;
    p->weights[k++] = box->weight[i];
    if (number >= first && number < first + box->n) continue;
    PetscCall(PetscFindInt(number, others, other, &at));
    p->parents.item[k - 1] = box->n + at;
  }
  c->n_active = box->n;
  c->n_nodes = c->n_rows = box->n + others;
  PetscCall(PetscMalloc2(c->n_nodes, &c->number, c->n_nodes, &c->row));
  for (PetscInt k = 0; k < c->n_nodes; ++k) {
    c->row[k] = k;
    c->number[k] = k < box->n ? first + k : other[k - box->n];
  }
  PetscCall(PetscFree(other));
  PetscCall(PetscFree(count));
  PetscFunctionReturn(0);
}

/* The pattern: what the rows of a coarse node reach, and who reaches it. */
static PetscErrorCode Pattern(Product *p)
{
  const Gathered *t = p->tangent;
  const PetscInt n = t->s->n_rows;
  const Lists columns = {t->start, t->column};
  System *c = &p->coarse;
  Lists rows, ahead, behind, all;

  PetscFunctionBeginUser;
  PetscCall(ListsUnite(n, &columns, &p->parents, c->n_nodes, &p->reached));
  PetscCall(ListsTranspose(n, &p->parents, c->n_nodes, &rows));
  PetscCall(ListsUnite(c->n_nodes, &rows, &p->reached, c->n_nodes, &ahead));
  PetscCall(ListsTranspose(c->n_nodes, &ahead, c->n_nodes, &behind));
  PetscCall(ListsMerge(c->n_nodes, &ahead, &behind, &all));
  PetscCall(ListsDestroy(&rows));
  PetscCall(ListsDestroy(&ahead));
  PetscCall(ListsDestroy(&behind));
  c->row_start = all.start;
  c->column = all.item;
  PetscCall(PetscCalloc1(c->row_start[c->n_rows] * c->dim * c->dim + SYSTEM_PADDING, &c->values));
  PetscFunctionReturn(0);
}

/* A block of the tangent along the axes, without what stands on the diagonals of prescribed unknowns. */
KERNEL void take_block(const int dim, const Product *p, PetscInt r, PetscInt e, PetscReal block[NUMBERS(3)])
{
  const System *s = p->tangent->s;
  const PetscInt pair = p->tangent->pair[e], node = s->column[s->diagonal[r]];
  const PetscReal *K = s->values + (size_t)pair * dim * dim;
  const PetscReal half = p->tangent->symmetric && pair == s->diagonal[r] ? 0.5 : 1;
  for (int k = 0; k < REGISTERS(dim); ++k) *(Four *)(block + 4 * k) = half * *(const Four *)(K + 4 * k);
  for (int d = 0; d < dim && pair == s->diagonal[r]; ++d)
    if (p->fixed[node * dim + d]) block[d * dim + d] = 0;
  if (s->frames) frame_turn_block(dim, dim, frame_of(s->frames, node), frame_of(s->frames, s->column[pair]), block);
}

/* sum = the row's blocks times P */
KERNEL void sum_columns(const int dim, const Product *p, PetscInt r)
{
  const Gathered *t = p->tangent;
  const PetscInt n = p->reached.start[r + 1] - p->reached.start[r], *reached = p->reached.item + p->reached.start[r];
  for (PetscInt k = 0; k < n; ++k) p->place[reached[k]] = k;
  for (PetscInt k = 0; k < n * NUMBERS(dim); ++k) p->sum[k] = 0;
  for (PetscInt e = t->start[r]; e < t->start[r + 1]; ++e) {
    PetscReal block[NUMBERS(3)];
    const PetscInt J = t->column[e];
    if (p->parents.start[J] == p->parents.start[J + 1]) continue;
    take_block(dim, p, r, e, block);
    for (PetscInt i = p->parents.start[J]; i < p->parents.start[J + 1]; ++i) {
      PetscReal *sum = p->sum + p->place[p->parents.item[i]] * NUMBERS(dim);
      for (int k = 0; k < REGISTERS(dim); ++k) *(Four *)(sum + 4 * k) += p->weights[i] * *(const Four *)(block + 4 * k);
    }
  }
}

/* P^T times that */
KERNEL void add_to_parents(const int dim, const Product *p, PetscInt r)
{
  const System *c = &p->coarse;
  const PetscInt n = p->reached.start[r + 1] - p->reached.start[r], *reached = p->reached.item + p->reached.start[r];
  for (PetscInt i = p->parents.start[r]; i < p->parents.start[r + 1]; ++i) {
    const PetscInt row = p->parents.item[i];
    for (PetscInt k = c->row_start[row]; k < c->row_start[row + 1]; ++k) p->place[c->column[k]] = k;
    for (PetscInt k = 0; k < n; ++k) {
      PetscReal *to = c->values + (size_t)p->place[reached[k]] * dim * dim;
      for (int m = 0; m < dim * dim; ++m) to[m] += p->weights[i] * p->sum[k * NUMBERS(dim) + m];
    }
  }
}

/* values += their transpose: rows come in the order of the columns from the diagonal on of each row. */
KERNEL void add_transpose(const int dim, const System *c, PetscInt *next)
{
  for (PetscInt r = 0; r < c->n_rows; ++r)
    for (PetscInt k = c->row_start[r]; k < c->row_start[r + 1] && c->column[k] <= r; ++k) {
      if (c->column[k] == r) next[r] = k;
      PetscReal *here = c->values + (size_t)k * dim * dim;
      PetscReal *there = c->values + (size_t)next[c->column[k]]++ * dim * dim;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < (here == there ? i + 1 : dim); ++j)
          here[i * dim + j] = there[j * dim + i] = here[i * dim + j] + there[j * dim + i];
    }
}

KERNEL void multiply(const int dim, const Product *p)
{
  for (PetscInt r = 0; r < p->tangent->s->n_rows; ++r) {
    if (p->parents.start[r] == p->parents.start[r + 1]) continue;
    sum_columns(dim, p, r);
    add_to_parents(dim, p, r);
  }
  if (p->tangent->symmetric) add_transpose(dim, &p->coarse, p->place);
}

static PetscErrorCode Multiply(Product *p)
{
  const PetscInt dim = p->coarse.dim, n = p->tangent->s->n_rows;
  PetscInt most = 0;

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < n; ++r) most = PetscMax(most, p->reached.start[r + 1] - p->reached.start[r]);
  PetscCall(PetscMalloc1(most * NUMBERS(dim), &p->sum));
  PetscCall(PetscMalloc1(p->coarse.n_nodes, &p->place));
  if (dim == 2) multiply(2, p);
  else multiply(3, p);
  PetscFunctionReturn(0);
}

/* Displacements of coarse nodes that no unknown follows stand alone. */
static PetscErrorCode Close(Mat coarse)
{
  PetscReal *d, largest = 0, all;
  PetscInt n;
  Vec diagonal;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(coarse, &diagonal, NULL));
  PetscCall(MatGetDiagonal(coarse, diagonal));
  PetscCall(VecGetLocalSize(diagonal, &n));
  PetscCall(VecGetArray(diagonal, &d));
  for (PetscInt i = 0; i < n; ++i) largest = PetscMax(largest, d[i]);
  PetscCall(MPIU_Allreduce(&largest, &all, 1, MPIU_REAL, MPIU_MAX, PetscObjectComm((PetscObject)coarse)));
  for (PetscInt i = 0; i < n; ++i) d[i] = d[i] == 0 ? all : d[i];
  PetscCall(VecRestoreArray(diagonal, &d));
  PetscCall(MatDiagonalSet(coarse, diagonal, INSERT_VALUES));
  PetscCall(VecDestroy(&diagonal));
  PetscFunctionReturn(0);
}

static PetscErrorCode Clear(Product *p)
{
  System *c = &p->coarse;

  PetscFunctionBeginUser;
  PetscCall(ListsDestroy(&p->parents));
  PetscCall(ListsDestroy(&p->reached));
  PetscCall(PetscFree(p->weights));
  PetscCall(PetscFree(p->place));
  PetscCall(PetscFree(p->sum));
  PetscCall(PetscFree2(c->number, c->row));
  PetscCall(PetscFree(c->row_start));
  PetscCall(PetscFree(c->column));
  PetscCall(PetscFree(c->values));
  PetscFunctionReturn(0);
}

PetscErrorCode CoarseProduct(const Gathered *tangent, const CoarseBox *box, const unsigned char *fixed, Mat *product)
{
  const System *s = tangent->s;
  Product p = {.tangent = tangent, .box = box, .fixed = fixed};
  Assembled *assembled;

  PetscFunctionBeginUser;
  p.coarse = (System){.comm = s->comm, .dim = s->dim, .block = s->dim};
  PetscCall(NumberLocally(&p));
  PetscCall(Pattern(&p));
  PetscCall(Multiply(&p));
  PetscCall(AssembledCreate(&p.coarse, &assembled, product));
  PetscCall(AssembledFill(assembled, &p.coarse, *product));
  PetscCall(AssembledDestroy(&assembled));
  PetscCall(Close(*product));
  PetscCall(Clear(&p));
  PetscFunctionReturn(0);
}
