/* Equations with the mass matrix of the step's balance, of two motions at a time: the velocity and
 * the acceleration of nodes.
 *
 *   (M x)_I = sum_g [ sum_p m N_I ((1 - l_g) sum_J N_J x_J + l_g x_I) + t_g (x_I - mean_g x) ]
 *
 * with the lumped share l and the tie t of the group g (docs/theory.md, "Cells that are not
 * full"). Nodal arrays are n_nodes x width, velocity and acceleration of a node behind each
 * other. */
#pragma once
#include "method/discretisation.h"

enum { VELOCITY, ACCELERATION, MOTIONS };

typedef struct MassSolve MassSolve;
typedef struct MassLines MassLines; /* lines.h */
/* Entries by rows of local nodes. */
typedef struct {
  PetscInt room, *start, *column; /* n_nodes + 1; local nodes */
  PetscReal *entry;               /* kg */
} MassPairs;

/* M of this rank's points. */
typedef struct MassRows {
  PetscBool known;       /* or is there only room? */
  MassPairs half, whole; /* each pair of nodes once, each node first in its own row; with both */
  MassLines *lines;      /* NULL: sweeps aim by the diagonal */
} MassRows;
/* Collective. product = M x, on owners; x is right on all copies. */
typedef PetscErrorCode (*MassMultiply)(MassSolve *solve, PetscReal *x);
/* Collective. What sweeps want, before the first of them. */
typedef PetscErrorCode (*MassPrepare)(MassSolve *solve);

struct MassSolve {
  const Discretisation *s;
  MassMultiply multiply;
  MassPrepare prepare;       /* NULL: nothing is to be done */
  PetscInt dim, width, size; /* width: 2 dim; size: n_nodes x width */
  /* the motion sought, on all copies when the equations are solved, m/s, m/s2 */
  PetscReal *x;
  PetscReal *lack;    /* right-hand side - M x, on owners, kg m/s, N */
  PetscReal *inverse; /* of M's diagonal, 0 where x is given or nothing has mass, on owners, 1/kg */
  PetscReal *direction, *product, *aim;
  /* local nodes that sweeps go over, owned ones first; of the others nothing is read of a product */
  PetscInt n_reached, n_reached_owned, *reached;
  PetscBool framed;  /* are components those in the frames of nodes that slide? */
  PetscInt products; /* how many there were */
  PetscBool alone;   /* does nobody ask for accelerations in this sweep? */
  MassRows *rows;    /* NULL: not worth it yet */
  MassRows **kept;   /* where they are kept for others; NULL: the solve's own */
};

/* Where a nodal array has component d of a motion of a node. */
static inline PetscInt mass_at(const MassSolve *solve, PetscInt node, PetscInt motion, PetscInt d)
{
  return node * solve->width + motion * solve->dim + d;
}

/* All arrays 0, `inverse` too: for another matrix than this one. */
PetscErrorCode MassSolveAllocate(const Discretisation *space, MassMultiply multiply, MassSolve *solve);
/* Collective. x and lack are 0. */
PetscErrorCode MassSolveCreate(const Discretisation *space, MassSolve *solve);
PetscErrorCode MassSolveDestroy(MassSolve *solve);
/* Find what the sweeps go over, unless it is known. */
PetscErrorCode MassSolveReach(MassSolve *solve);
/* x = 0 at the nodes that are reached. */
void mass_clear(const MassSolve *solve, PetscReal *x);
/* Collective. lack -= M x; x is right on all copies. */
PetscErrorCode MassSubtract(MassSolve *solve);
/* Collective. |lack|^2 of each motion, in the norm of the inverse diagonal. */
PetscErrorCode MassLack(MassSolve *solve, PetscReal square[MOTIONS]);
/* Collective. Conjugate gradients from x and its lack until that is `enough`, as MassLack gives
 * it, or after so many sweeps. */
PetscErrorCode MassSolveRun(MassSolve *solve, const PetscReal enough[MOTIONS], int sweeps);
/* Collective. What is lacking goes to the nodes by mass where `inverse` is not 0: then the sum of M x is that of
 * the right-hand side to round-off. x is right on all copies after that. */
PetscErrorCode MassSolveClose(MassSolve *solve);
/* Share of a group's mass that is lumped, and its tie, kg. */
PetscReal mass_lumping(const Discretisation *space, PetscInt group);
PetscReal mass_tie(const Discretisation *space, PetscInt group);
/* The matrix summed up for long solves is kept there for all that solve with it until mass_rows_forget. */
void mass_keep(MassSolve *solve, MassRows **kept);
/* mass_matrix.c. Sums the rows up; *rows may be NULL. */
PetscErrorCode MassRowsUpdate(const Discretisation *space, MassRows **rows);
void mass_rows_forget(MassRows *rows);
PetscErrorCode MassRowsDestroy(MassRows **rows);
/* product = M x at the nodes that are reached, before ranks add theirs up. */
void mass_rows_multiply(const MassSolve *solve, const PetscReal *x);
/* Between components along the axes and those in the frames, if these are used. */
void mass_turn(const MassSolve *solve, PetscReal *x);
/* Two fields of n_nodes x dim to such an array, and back. */
void mass_pack(const MassSolve *solve, const PetscReal *v, const PetscReal *a, PetscReal *x);
void mass_unpack(const MassSolve *solve, const PetscReal *x, PetscReal *v, PetscReal *a);
