/* The linear system of a step: which nodes carry unknowns, the sparse pattern, and group ->
 * matrix slots.
 *
 * Unknowns sit on the nodes of the groups (cells, clouds) handed to SystemBuild; those that no
 * material touches get nothing but a diagonal, so that the pattern (and the symbolic
 * factorisation) may be padded and kept over many steps. */
#pragma once
#include <petscksp.h>
#include "boundary/frames.h"
#include "support/support.h"

/* What the linear solver works on: a matrix of PETSc; blocks in single precision for symmetric Gauss-Seidel
 * (solve/blocks/blocks.h); or the values themselves, where nothing but products is asked for (gathered.h). */
typedef enum { SYSTEM_ASSEMBLED, SYSTEM_BLOCKS, SYSTEM_GATHERED } SystemForm;

/* Numbers behind the last block, which registers read and nobody counts. */
#define SYSTEM_PADDING 3

/* The clouds that the slots were last looked up for: most are the same in the next step. */
typedef struct {
  PetscInt builds;           /* of the pattern then; 0: not all pairs were there */
  PetscBool half;            /* pairs before the diagonals were left out */
  PetscInt n, *start, *node; /* groups and their nodes */
  PetscInt capacity, capacity_entries;
  PetscInt n_spare, *spare; /* slots on their way to another place */
} CloudsBefore;

/* A pair of nodes that a prescribed unknown stands in (prescribed.c). */
typedef struct {
  PetscInt pair, row; /* of the pattern; the row's node */
  unsigned bits;      /* numbers of the block, row by row, that stand in its row or column */
} SystemCut;

/* A pair of nodes of which one has a frame (turned.c). */
typedef struct {
  PetscInt pair, row; /* of the pattern; the row's node */
} SystemPair;

/* What a row of the tangent gets: something; nothing any more; nothing, and it is zero already. */
typedef enum { ROW_FILLED, ROW_LEFT, ROW_EMPTY } RowMatter;

typedef struct System {
  MPI_Comm comm;
  /* displacements, and all unknowns, per node: dim, or dim + 1 with a pressure */
  PetscInt dim, block;
  PetscInt n_nodes;                         /* local nodes of the grid or cloud */
  PetscInt n_active;                        /* owned nodes that carry unknowns */
  PetscInt n_active_global, n_active_least; /* over all ranks: sum and smallest */
  PetscInt *active;                         /* n_active local nodes, ascending */
  /* n_nodes: global number of the node's unknowns, -1 if none */
  PetscInt *number;
  /* local nodes with unknowns, ghosts too: rows of the local pattern */
  PetscInt n_rows;
  PetscInt *row; /* n_nodes: row of the local pattern, -1 if none */
  /* pattern of node pairs: n_rows + 1, and local nodes, ascending in a row */
  PetscInt *row_start, *column;
  PetscReal n_pairs_global; /* over all ranks */
  PetscInt *diagonal;       /* n_rows: place of the diagonal pair */
  /* block x block numbers of pair k at k * block * block */
  PetscReal *values;
  /* the same in single precision, which is all that blocks need */
  float *singles;
  /* is the tangent gathered in singles, or else in values? */
  PetscBool single;
  PetscInt n_slots, *slot; /* SystemSlots: nn x nn pairs of each group */
  const Support *later;    /* whose slots nobody has wanted yet; NULL: they are there */
  /* SystemPrescribe, per row: of a node that no material touches, so that all its pairs are zeros; NULL: not told */
  RowMatter *matter;
  PetscInt n_cuts, capacity_cuts; /* SystemPrescribe */
  SystemCut *cut;
  const Frames *frames;               /* of the nodes: the unknowns are components in them; NULL: along the axes */
  PetscInt n_turned, capacity_turned; /* SystemFindTurned */
  SystemPair *turned;
  CloudsBefore before;
  SystemForm form;
  /* what the linear solver gets: assembled, or a shell; made by SystemUse */
  Mat matrix;
  struct Blocks *blocks;       /* of a shell over blocks */
  struct Assembled *assembled; /* where pairs go in PETSc's matrix */
  struct Gathered *gathered;   /* of a shell over the values */
  PetscInt builds;             /* how often the pattern was made */
} System;

PetscErrorCode SystemCreate(MPI_Comm comm, PetscInt dim, PetscInt block, System **system);
PetscErrorCode SystemDestroy(System **system);

/* Collective. Unknowns on the nodes of the groups, coupled group by group. */
PetscErrorCode SystemBuild(System *system, const Grid *grid, const NodeGroups *groups);
/* Look up the slots of every group of the support, one group behind the other. Cells' nodes must
 * all carry unknowns; clouds have ascending nodes, and `complete` tells whether the pattern has
 * all their pairs on this rank. */
PetscErrorCode SystemSlots(System *system, const Support *support, PetscBool *complete);
/* The same of a support whose pairs the pattern has for sure, when a tangent wants them: a step without
 * iterations never does. half: of clouds only pairs from the diagonals on. */
void system_slots_later(System *system, const Support *support);
PetscErrorCode SystemWantSlots(System *system, PetscBool half);
/* The slot of one pair of nodes; -1 if the pattern lacks it. */
PetscInt system_pair(const System *system, PetscInt I, PetscInt J);
/* What SystemSlots consists of (cloud_slots.c). */
PetscErrorCode SystemReserveSlots(System *system, PetscInt n);
PetscErrorCode SystemCloudSlots(System *system, const Support *support, PetscBool half, PetscBool *complete);
PetscErrorCode SystemFreeSlots(System *system);
/* Fill the blocks before the diagonals of the rows from `first` on with the transposes of those behind
 * diagonals. Symmetric blocks (solve/blocks) need no more than the rows that other ranks own. */
PetscErrorCode SystemMirror(System *system, PetscInt first);
/* Zero values or singles, whichever are in use. */
PetscErrorCode SystemZero(System *system);
/* The same from the diagonals on, before SystemMirror, or where nobody reads the rest. */
PetscErrorCode SystemZeroHalf(System *system);
/* Zero an array of n_nodes x dim where nodes have unknowns, ghosts too. */
PetscErrorCode SystemZeroNodes(const System *system, PetscReal *nodes);

/* Collective. Make the matrix in this form, if it is not there yet. */
PetscErrorCode SystemUse(System *system, SystemForm form, PetscBool symmetric);
/* May the tangent be gathered in single precision? Only where the matrix works on blocks;
 * forgotten with the pattern. */
PetscErrorCode SystemGather(System *system, PetscBool single);
/* Which unknowns are prescribed from now on, until this is called again or the pattern changes:
 * displacements in fixed (n_nodes x dim, also of nodes that no material touches) and pressures
 * of idle nodes (n_nodes; NULL without pressures), the same on every rank that has the node. */
PetscErrorCode SystemPrescribe(System *system, const unsigned char *fixed, const unsigned char *idle);
/* Forces of rows that are not fixed += K lift, lift (n_nodes x dim) being zero where nothing is
 * prescribed; volume: of the pressures' rows. For whole values, as they were assembled, and
 * forces that are not yet summed over ranks; all in the frames of the nodes. */
void system_lift(const System *system, const unsigned char *fixed, const PetscReal *lift, PetscReal *force,
                 PetscReal *volume);
/* Into the frames of the nodes: which pairs, after the pattern or the frames have changed; the
 * tangent as it was assembled, along the axes, before anything is cut or lifted. */
PetscErrorCode SystemFindTurned(System *system);
void system_turn(System *system);
/* Collective. Values -> matrix, where rows and columns of prescribed unknowns have nothing but a
 * diagonal. */
PetscErrorCode SystemToMatrix(System *system);
/* What SystemToMatrix consists of (prescribed.c): empty rows and columns, and their diagonals in
 * what the matrix takes. */
void system_cut(System *system);
PetscErrorCode SystemCloseCuts(System *system);

/* Components first .. first + n - 1 of the unknowns in a Vec <-> local array n_nodes x n.
 * ToNodes zeroes nodes without unknowns and fills ghosts; FromNodes takes owners. */
PetscErrorCode SystemToNodes(const System *system, const Grid *grid, Vec x, PetscInt first, PetscInt n,
                             PetscReal *nodes);
PetscErrorCode SystemFromNodes(const System *system, const PetscReal *nodes, PetscInt first, PetscInt n, Vec x);
PetscErrorCode SystemCreateVec(const System *system, Vec *x);
