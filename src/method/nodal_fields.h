/* All that nodes know, in one place: made and destroyed together, following the nodes of a
 * cloud, put away in checkpoints and handed over to a grid that is shared anew. Arrays go over
 * the local nodes of the grid. */
#pragma once
#include "base/table/table.h"
#include "grid/grid.h"

typedef enum {
  DOF_USUAL,    /* prescribed or free as the boundary says */
  DOF_RELEASED, /* solved for although prescribed: a constraint holds it */
  DOF_UNUSED,   /* stays 0: a multiplier of no constraint */
} DofState;

typedef struct NodalFields {
  Grid *grid;
  PetscInt layouts;       /* state of a cloud that the flags fit */
  unsigned char *touched; /* n_nodes: does material reach the node? on every rank that knows it */
  unsigned char *idle;    /* n_nodes: no material touches the node in the step */
  /* n_nodes x dim: DofState where it is not what boundary and touched say */
  unsigned char *dof;
  unsigned char *fixed; /* n_nodes x dim: has no unknown in the step */
  PetscReal *mass;      /* n_nodes, kg */
  /* n_nodes x dim, as all up to the pressures */
  PetscReal *v, *a;    /* at t_n: what the solve starts from, m/s, m/s2 */
  PetscReal *v_points; /* v as the points gave it, before prescribed motion replaced it */
  PetscReal *a_points; /* likewise a */
  PetscReal *v_mean;   /* of points by mass: smooth, for first guesses; of grids that are restored */
  /* at prescribed dofs: momentum and force that the change from v_points and a_points took, on owners,
   * kg m/s, N */
  PetscReal *impulse, *lost_force;
  PetscReal *v_start, *a_start, *echo_start; /* v, a and echo before the step changed them */
  PetscReal *v_first, *a_first;              /* v and a that each try of the step begins with */
  PetscReal *v1, *a1;                        /* at t_(n+1), of an accepted step */
  PetscReal *du;                             /* increments of the step, m */
  PetscReal *previous;                       /* those of the last step where they were solved for, else 0 */
  PetscReal *prescribed;                     /* increments of prescribed dofs, m */
  PetscReal *history;                        /* see WeakFormInput */
  PetscReal *force;                          /* residual with the rows of prescribed dofs, on owners, N */
  PetscReal *external;                       /* dead forces, on owners, N */
  /* force of the boundary on the body, in dynamics its mean over the last step, on owners, N */
  PetscReal *reaction;
  /* the same at the end of the step, without the impulse that stopped points, N */
  PetscReal *held;
  /* its share in the rate of momentum there (`held` without Bossak's alpha), N */
  PetscReal *rate;
  PetscReal *echo; /* what Bossak's alpha held back of the last acceleration, m/s2 */
  /* n_nodes, NULL where displacements are the only unknowns */
  PetscReal *pressure;        /* at t_n, tension positive, Pa */
  PetscReal *scaled_pressure; /* the unknowns, m, see WeakFormInput */
  PetscReal *volume;          /* residual of the pressure equation, N */
} NodalFields;

/* pressure: is it an unknown? */
PetscErrorCode NodalFieldsCreate(Grid *grid, PetscBool pressure, NodalFields **nodes);
PetscErrorCode NodalFieldsDestroy(NodalFields **nodes);
/* Flags of a cloud, all 0, if its ghosts or owners changed since they were made; the other
 * fields follow by themselves. */
PetscErrorCode NodalFlagsFollow(NodalFields *nodes);

/* Collective, on grids of cells (clouds put away what follows them). What outlives a step: the
 * motion of nodes that move; increments: those of the last step; forces of the boundary, of nodes
 * that feel some. */
PetscErrorCode NodalFieldsToTables(NodalFields *nodes, PetscBool move, PetscBool increments, Tables *tables);
PetscErrorCode NodalFieldsFromTables(NodalFields *nodes, PetscBool move, const Tables *tables, char reason[256]);
