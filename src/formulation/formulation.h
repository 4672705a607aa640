/* Residual and tangent of the points' weak form, shared by all methods (phase b).
 *
 *   R_I = sum_p V0 tau grad N_I + sum_p m N_I (a_h - b)          thesis eqs. 4.27, 4.31
 *   K_IJ = sum_p V0 [grad N_I . c . grad N_J + (grad N_I . tau grad N_J) 1] + sum_p c0 m N_I N_J 1
 *
 * with grad N at x_(n+1), tau and c from the law, a_h = sum_J N_J a_J the consistent inertia.
 * The effective nodal acceleration is a_I = c0 du_I + h_I; time integration chooses c0 and h
 * (gravity goes into h). */
#pragma once
#include "material/law.h"
#include "support/support.h"

typedef struct {
  const Kinematics *kinematics;
  const Points *points;
  const Support *support;
  const Material *materials;
  const PetscReal *x;       /* n_nodes x dim: positions at the start of the step, m; mixed rings, soft */
  const PetscReal *du;      /* n_nodes x dim: displacement since the start of the step, m */
  const PetscReal *history; /* n_nodes x dim: h, m/s2 */
  PetscReal inertia;        /* c0, 1/s2; 0 in statics */
  PetscBool middle;         /* are du those of half a step whose forces balance there? */
  PetscBool symmetric;      /* are the tangents of all materials symmetric? */
  const PetscReal *lumping; /* per group: share of the mass that is lumped, or NULL (0) */
  /* per group: stiffness that ties a hardly filled cell's nodes together, N/m, or NULL; where each point
   * has a part of a lattice of its own, to the linear part of their motion */
  const PetscReal *soft;
  PetscBool lattice;
  const PetscReal *tie; /* per group: inertia that ties them together, kg, or NULL */
  /* Where points are groups of their own and the tangent is symmetric: blocks with a row behind the
   * column are left out. */
  PetscBool half;
  /* Do points keep their place in their cell, so that det F is what has become of it? */
  PetscBool carried;
  const PetscReal *pressure; /* mixed: n_nodes, the unknown pressure over pressure_scale, m */
  /* mixed: Pa/m, gives both unknowns the same unit, and both equations N */
  PetscReal pressure_scale;
  PetscReal alpha; /* mixed: pressures that vary inside a cell are held by alpha / G, or more (material/pressure.h) */
  const PetscReal *gravity; /* mixed: m/s2, three numbers, */
  const PetscReal *pull;    /* n_points x 3, what acts per mass besides, or NULL, */
  const PetscBool *weighs;  /* and of which bodies pressures bear all that */
  /* mixed: per group, ties the pressures of a hardly filled cell, m3/Pa, or NULL */
  const PetscReal *pressure_tie;
  const PetscInt *cell_node; /* mixed, points with nodes of their own: the corners of each cell of their grid */
} WeakFormInput;

typedef struct {
  PetscReal *force;  /* n_nodes x dim, added to */
  PetscReal *volume; /* mixed: n_nodes, residual of the pressure equation, N, added to */
  PetscReal *values; /* matrix blocks, added to; NULL: residual only, unless there are singles */
  /* the same in single precision, from formulations that can; instead of values */
  float *singles;
  const PetscInt *slot; /* per group nn x nn: block of the pair of nodes in values */
  LawStatus status;     /* worst of all points */
  PetscInt bad_point;   /* a point of that status */
} WeakFormOutput;

typedef struct {
  const char *name, *help;
  /* is there an unknown pressure at the nodes, behind the displacements in each block? */
  PetscBool pressure;
  PetscBool cells;   /* do points of one cell need each other, so that their nodes must be those of cells? */
  PetscBool singles; /* can it add its blocks in single precision? */
  PetscErrorCode (*assemble)(const WeakFormInput *in, WeakFormOutput *out);
  /* Accept the step: new state, F, J, stress and work of every point. `state` of the points is
   * overwritten. */
  PetscErrorCode (*commit)(const WeakFormInput *in, Points *points, LawStatus *status);
  /* With a pressure: add to each node (n_nodes) a stand-in of the Schur complement's diagonal in an
   * elastic body at rest, N/m; NULL without. */
  void (*schur)(const WeakFormInput *in, PetscReal *nodes);
} Formulation;

extern const Formulation *const formulations[]; /* ended by NULL */
const Formulation *formulation_find(const char *name);
extern const Formulation formulation_displacement, formulation_mean_dilatation, formulation_mixed;

/* Increment of the deformation gradient of one point with nodes' increments du (nn x dim). */
static inline void increment_gradient(PetscInt dim, PetscInt nn, const PetscReal *dN, const PetscReal *du,
                                      PetscReal dF[9])
{
  for (int i = 0; i < 9; ++i) dF[i] = (i % 4 == 0) ? 1.0 : 0.0;
  for (PetscInt I = 0; I < nn; ++I)
    for (PetscInt i = 0; i < dim; ++i)
      for (PetscInt j = 0; j < dim; ++j) dF[3 * i + j] += du[I * dim + i] * dN[I * dim + j];
}
