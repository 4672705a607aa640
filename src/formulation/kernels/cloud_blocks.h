/* A point's blocks in one precision. Included by displacement_cloud.c once for each, which defines
 * NUMBER, registers of FOUR and EIGHT of them, and PRECISE(name). */

/* Gradients, a row per node, and the mass and ties of a row I of the point: what stands on the diagonals
 * of its blocks. */
KERNEL void PRECISE(cloud_diagonals)(const CloudWork *w, PetscInt I, PetscInt first, NUMBER *restrict diagonal)
{
  const PetscReal mass = w->inertia * (1 - w->lumping) * w->N[I];
  for (PetscInt J = first; J < w->nn; ++J) diagonal[J] = (NUMBER)(mass * w->N[J]);
  for (int k = 0; w->soft > 0 && k < w->n_free; ++k) {
    const PetscReal part = w->soft * w->free[k][I];
    for (PetscInt J = first; J < w->nn; ++J) diagonal[J] -= (NUMBER)(part * w->free[k][J]);
  }
  diagonal[I] += (NUMBER)(w->inertia * w->lumping * w->N[I] + w->soft);
}

/* In the plane a block is four numbers, a register. */
KERNEL void PRECISE(cloud_matrix_2d)(const PetscBool hoop, const PetscBool half, const PetscInt *slot,
                                     const CloudWork *w, NUMBER *values)
{
  const int rows = gradient_rows(2, hoop);
  const FOUR unit = {1, 0, 0, 1};
  NUMBER diagonal[CLOUD_MAX_NODES], g[3 * CLOUD_MAX_NODES];
  FOUR modulus[3][3];
  for (int j = 0; j < rows; ++j)
    for (int l = 0; l < rows; ++l) modulus[j][l] = __builtin_convertvector(*(const Row4 *)w->modulus[j][l], FOUR);
  for (PetscInt i = 0; i < rows * w->nn; ++i) g[i] = (NUMBER)w->g[i];
  for (PetscInt I = 0; I < w->nn; ++I) {
    const PetscInt first = half ? I : 0;
    FOUR S[3];
    PRECISE(cloud_diagonals)(w, I, first, diagonal);
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
  NUMBER diagonal[CLOUD_MAX_NODES], g[3 * CLOUD_MAX_NODES], corner[3][3];
  EIGHT modulus[3][3];
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
    PRECISE(cloud_diagonals)(w, I, first, diagonal);
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
