/* The matrix of a System as rows of blocks in single precision, made for conjugate gradients with
 * symmetric Gauss- Seidel.
 *
 * Rows and columns are scaled so that the blocks of the diagonal are identities: A^ = S A T = 1 + L
 * + U + O, with O the columns that other ranks own. S D T = 1 for a block D of the diagonal; where
 * A is symmetric T = S^T, else T =
 * 1. Gauss-Seidel on each rank's part is (1 + L)(1 + U), and by Eisenstat's trick
 *   (1 + L)^-1 A^ (1 + U)^-1 p = t + (1 + L)^-1 (p - t + O t),   t = (1 + U)^-1 p
 * needs no product with the matrix. Single precision moves half the bytes and makes Newton inexact
 * by 1e-7 of the matrix; residuals stay double (docs/decisions.md). */
#pragma once
#include "solve/blocks/block_kernels.h"
#include "solve/system/system.h"

typedef struct BlocksHalo BlocksHalo;
struct Projection;

/* Of the columns of a row in the system, ascending: how many stand before the diagonal, and how many in
 * all are this rank's; the rest is others'. */
typedef struct {
  PetscInt before, own;
} RowParts;

typedef struct Blocks {
  MPI_Comm comm;
  PetscInt dim, n;     /* size of a block; rows, one for each node with unknowns */
  PetscInt n_columns;  /* rows, and columns that other ranks own */
  PetscBool symmetric; /* T = S^T */
  /* a block of the diagonal has no inverse (or is not positive definite) on some rank */
  PetscBool singular;
  float *scale;                 /* S of each column, dim x dim row by row */
  RowParts *parts;              /* of each row */
  BlockRows lower, upper;       /* without blocks of zeros: which columns a row has is known once it is filled */
  PetscInt *next;               /* n, for whoever needs it a moment */
  PetscInt n_outer, *outer_row; /* rows that have columns of other ranks, ascending */
  BlockRows outer;              /* their blocks: row k is outer_row[k] */
  BlocksHalo *halo;
  /* constraints that the solver has to keep (not owned); NULL: none */
  struct Projection *projection;
  float *work[7]; /* vectors of the Krylov methods, made when they are first used */
} Blocks;

/* Collective. The pattern; the system must live on unchanged until BlocksDestroy. Blocks are 2 x 2
 * or 3 x 3. */
PetscErrorCode BlocksCreate(const System *system, PetscBool symmetric, Blocks **blocks);
PetscErrorCode BlocksDestroy(Blocks **blocks);
/* Collective. Take the singles of the system, or its values where there are none. */
PetscErrorCode BlocksFill(Blocks *blocks, const System *system);
/* Collective. y = A x, for a Mat of type shell. */
PetscErrorCode BlocksMultiply(Blocks *blocks, Vec x, Vec y);
/* A vector of one float register (or half) a column, zero; kept with the blocks. */
PetscErrorCode BlocksWork(Blocks *blocks, int which, float **vector);
/* Collective. Fetch what other ranks own of a work vector. */
PetscErrorCode BlocksExchange(const Blocks *blocks, float *vector);

/* The sweeps; vectors are work vectors. Sums are this rank's. */
typedef struct {
  double (*scaled_norm2)(const Blocks *m, const PetscReal *b); /* |S b|^2 */
  double (*start)(const Blocks *m, const PetscReal *b, PetscReal factor,
                  float *r); /* r = (1 + L)^-1 S b factor; r . r */
  /* p = r + beta p, t */
  void (*backward)(const Blocks *m, const float *r, PetscReal beta, float *p, float *t);
  double (*forward)(const Blocks *m, const float *p, const float *t, const float *q,
                    float *y); /* y = (1 + L)^-1 (p - t + O t); q . (t + y) */
  void (*finish)(const Blocks *m, const float *x, PetscReal factor, float *t,
                 PetscReal *u); /* u = factor T (1 + U)^-1 x */
} BlockSweeps;
const BlockSweeps *block_sweeps(PetscInt dim);
/* S^-1 of each row, in double precision: n x dim x dim. */
void blocks_invert_scales(const Blocks *blocks, PetscReal *inverse);

/* Products right after the sweeps start() and finish() where the result z of the latter has been
 * changed in some places (blocks_product.c). */
typedef struct {
  Blocks *m;
  PetscInt n_changed;
  /* numbers in this rank's vectors that may differ; below 0: of another rank */
  const PetscInt *changed;
  unsigned char *whole; /* per row: does it have such a column? */
  PetscReal *inverse;   /* S^-1 */
} BlocksProduct;
#define BLOCKS_PRODUCT_WORK 2 /* a work vector of its own */
/* Collective. `changed` must live on. */
PetscErrorCode BlocksProductCreate(Blocks *blocks, PetscInt n_changed, const PetscInt *changed, BlocksProduct *product);
PetscErrorCode BlocksProductDestroy(BlocksProduct *product);
/* Collective. q = A z. x, t: what start() and finish() left, for a vector divided by size. */
PetscErrorCode BlocksProductApply(const BlocksProduct *product, PetscReal size, const PetscReal *z, const float *x,
                                  float *t, PetscReal *q);

/* What crosses ranks: values of rows that others assembled too, and columns that others own
 * (blocks_halo.c). */
struct BlocksHalo {
  PetscSF columns; /* roots: rows; leaves: columns of others */
  PetscSF pairs;   /* roots: incoming blocks; leaves: pairs of rows that others own */
  MPI_Datatype vector, block, scale;
  PetscInt n_incoming;
  float *incoming;                  /* blocks */
  PetscInt n_shared, *shared_row;   /* rows with blocks of others, ascending */
  PetscInt *start, *column;         /* their whole pattern */
  PetscInt *own_start, *own, *come; /* where own pairs and incoming blocks go in it */
  float *values;
};
PetscErrorCode BlocksHaloCreate(const System *s, PetscInt *n_columns, BlocksHalo **halo);
PetscErrorCode BlocksHaloDestroy(BlocksHalo **halo);
/* Collective. Sum the shared rows. */
PetscErrorCode BlocksHaloSum(BlocksHalo *halo, const System *s);

/* A Krylov method of PETSc for Mats of type shell over Blocks: conjugate gradients, or BiCGStab if
 * they are not symmetric. */
#define KSPBLOCKS "talus_blocks"
PetscErrorCode BlocksRegister(void);
/* May a solve that does not reach its tolerance be done by factors (KSP_CONVERGED_ITS)? No, unless told. */
PetscErrorCode BlocksMayFactor(KSP ksp, PetscBool may);
/* Collective. A u = b by factors in double precision of the matrix as it is; b and u: numbers of this rank's rows.
 * PETSC_FALSE: it is singular, or no matrix of numbers (blocks_factor.c). */
PetscErrorCode BlocksFactorSolve(Blocks *m, const PetscReal *b, PetscReal *u, PetscBool *solved);
/* Collective. f = K u under m->projection, with the tolerances and monitors of `asked`; its is
 * added to. */
PetscErrorCode BlocksSolveProjected(KSP asked, Blocks *m, const PetscReal *f, PetscReal *u, PetscInt *its,
                                    KSPConvergedReason *reason);
