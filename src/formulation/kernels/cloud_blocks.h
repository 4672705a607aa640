/* A point's blocks in one precision. Included by displacement_cloud.c once for each, which defines
 * NUMBER, registers of FOUR and EIGHT of them, and PRECISE(name). */

/* What stands on the diagonals of a point's blocks: sums of products of rows over its nodes, that of the mass
 * and those of its ties. Rows are padded to whole registers. */
typedef struct {
  int n;
  NUMBER row[5][CLOUD_MAX_NODES + 8], factor[5];
} PRECISE(CloudRows);

KERNEL void PRECISE(cloud_rows)(const CloudWork *w, PRECISE(CloudRows) * d)
{
  const PetscReal *from[5] = {w->N, w->free[0], w->free[1], w->free[2], w->free[3]};
  d->n = w->soft > 0 ? 1 + w->n_free : 1;
  for (int k = 0; k < d->n; ++k) {
    d->factor[k] = (NUMBER)(k ? -w->soft : w->inertia * (1 - w->lumping));
    for (PetscInt I = 0; I < w->nn; ++I) d->row[k][I] = (NUMBER)from[k][I];
    *(EIGHT *)(d->row[k] + w->nn) = (EIGHT){0};
  }
}

/* Of row I, from the node `first` on. */
KERNEL void PRECISE(cloud_diagonals)(const CloudWork *w, const PRECISE(CloudRows) * d, PetscInt I, PetscInt first,
                                     NUMBER *restrict diagonal)
{
  for (PetscInt J = first; J < w->nn; J += 8) {
    EIGHT sum = d->factor[0] * d->row[0][I] * *(const EIGHT *)(d->row[0] + J);
    for (int k = 1; k < d->n; ++k) sum += d->factor[k] * d->row[k][I] * *(const EIGHT *)(d->row[k] + J);
    *(EIGHT *)(diagonal + J) = sum;
  }
  diagonal[I] += (NUMBER)(w->inertia * w->lumping * w->N[I] + w->soft);
}

/* In the plane a block is four numbers, a register. */
KERNEL void PRECISE(cloud_matrix_2d)(const PetscBool hoop, const PetscBool half, const PetscInt *slot,
                                     const CloudWork *w, NUMBER *values)
{
  const int rows = gradient_rows(2, hoop);
  const FOUR unit = {1, 0, 0, 1};
  NUMBER diagonal[CLOUD_MAX_NODES + 8], g[3 * CLOUD_MAX_NODES];
  FOUR modulus[3][3];
  PRECISE(CloudRows) d;
  PRECISE(cloud_rows)(w, &d);
  for (int j = 0; j < rows; ++j)
    for (int l = 0; l < rows; ++l) modulus[j][l] = __builtin_convertvector(*(const Row4 *)w->modulus[j][l], FOUR);
  for (PetscInt i = 0; i < rows * w->nn; ++i) g[i] = (NUMBER)w->g[i];
  for (PetscInt I = 0; I < w->nn; ++I) {
    const PetscInt first = half ? I : 0;
    FOUR S[3];
    PRECISE(cloud_diagonals)(w, &d, I, first, diagonal);
    for (int l = 0; l < rows; ++l) {
      S[l] = g[rows * I] * modulus[0][l];
      for (int j = 1; j < rows; ++j) S[l] += g[rows * I + j] * modulus[j][l];
    }
    for (PetscInt J = first; J < w->nn; ++J) {
      FOUR sum = diagonal[J] * unit;
      for (int l = 0; l < rows; ++l) sum += g[rows * J + l] * S[l];
      *(FOUR *)(values + (size_t)slot[I * w->nn + J] * 4) += sum;
    }
  }
}

/* In space a block has nine numbers: eight in a register, and the last. */
KERNEL void PRECISE(cloud_matrix_3d)(const PetscBool half, const PetscInt *slot, const CloudWork *w, NUMBER *values)
{
  const EIGHT unit = {1, 0, 0, 0, 1, 0, 0, 0};
  NUMBER diagonal[CLOUD_MAX_NODES + 8], g[3 * CLOUD_MAX_NODES], corner[3][3];
  EIGHT modulus[3][3];
  PRECISE(CloudRows) d;
  PRECISE(cloud_rows)(w, &d);
  for (int j = 0; j < 3; ++j)
    for (int l = 0; l < 3; ++l) {
      modulus[j][l] = __builtin_convertvector(*(const Row8 *)w->modulus[j][l], EIGHT);
      corner[j][l] = (NUMBER)w->modulus[j][l][8];
    }
  for (PetscInt i = 0; i < 3 * w->nn; ++i) g[i] = (NUMBER)w->g[i];
  for (PetscInt I = 0; I < w->nn; ++I) {
    const PetscInt first = half ? I : 0;
    const NUMBER *at = g + 3 * I;
    EIGHT S[3];
    NUMBER last[3];
    PRECISE(cloud_diagonals)(w, &d, I, first, diagonal);
    for (int l = 0; l < 3; ++l) {
      S[l] = at[0] * modulus[0][l] + at[1] * modulus[1][l] + at[2] * modulus[2][l];
      last[l] = at[0] * corner[0][l] + at[1] * corner[1][l] + at[2] * corner[2][l];
    }
    for (PetscInt J = first; J < w->nn; ++J) {
      const NUMBER *to = g + 3 * J;
      NUMBER *block = values + (size_t)slot[I * w->nn + J] * 9;
      *(EIGHT *)block += to[0] * S[0] + to[1] * S[1] + to[2] * S[2] + diagonal[J] * unit;
      block[8] += to[0] * last[0] + to[1] * last[1] + to[2] * last[2] + diagonal[J];
    }
  }
}

#undef NUMBER
#undef FOUR
#undef EIGHT
#undef PRECISE
