/* A method: how nodes get their kinematics before the solve (phase a), and how the solution moves nodes and points (phase c).
 * Phase b, the solve itself, is shared by all. To add one: a new file, and a line in methods.inc. */
#pragma once
#include "boundary/boundary.h"
#include "boundary/loads.h"
#include "material/law.h"
#include "support/basis.h"
#include "solve/system/constraints.h"
#include "solve/newton/newmark.h"

typedef enum {
  DOF_USUAL,    /* prescribed or free as the boundary says */
  DOF_RELEASED, /* solved for although prescribed: a constraint holds it */
  DOF_UNUSED,   /* stays 0: a multiplier of no constraint */
} DofState;

/* What a method works on. Nodal arrays go over the local nodes of the grid. */
typedef struct Stage {
  const Case *c;
  Grid *grid;
  Points *points, *tracers;
  Loads *loads;
  const Material *materials;
  PetscBool started; /* has initialise run before? */
  const Basis *basis;
  Support *support;
  unsigned char *filled;  /* n_cells: does the cell hold points? */
  unsigned char *touched; /* n_nodes: does material reach the node? on every rank that knows it */
  PetscReal *mass;        /* n_nodes, kg */
  PetscReal *v, *a;       /* n_nodes x dim at t_n: what the solve starts from, m/s, m/s2 */
  PetscReal *v_points;    /* n_nodes x dim: v as the points gave it, before prescribed motion replaced it */
  PetscReal *a_points;    /* n_nodes x dim: likewise a */
  PetscReal *v1, *a1;     /* n_nodes x dim at t_(n+1), of an accepted step */
  PetscReal fade;         /* share of a point's velocity beyond the nodes' that Rayleigh damping takes in the step */
  PetscInt group_capacity;
  PetscReal *lumping, *soft, *tie; /* per group, see WeakFormInput */
  PetscReal *pressure;             /* mixed: n_nodes at t_n, tension positive, Pa; otherwise NULL */
  PetscReal *pressure_tie;         /* mixed: per group, see WeakFormInput */
  PetscInt n_lost;                 /* points that left the grid in the last convection, all ranks */
  LostPoint *lost;                 /* at most 16 of them */
  Boundary *boundary;              /* of the same nodes */
  Constraints *constraints;        /* NULL: prescribed motion is that of the nodes themselves */
  unsigned char *dof; /* n_nodes x dim: DofState where it is not what boundary and touched say; NULL: nowhere */
  const PetscReal *prescribed; /* n_nodes x dim: increments of prescribed dofs in the step that is being accepted, m */
  struct Gmm *gmm;             /* what gmm remembers; NULL in other methods */
} Stage;

/* A nodal array (n_nodes x components) that a method carries from step to step: it goes into checkpoints. */
typedef struct {
  const char *name, *unit;
  PetscInt components;                /* 0: dim */
  PetscReal *(*values)(Stage *stage); /* NULL: the formulation has no such field */
} MethodField;

typedef struct Method {
  const char *name, *help;
  const char *basis;     /* that it has unless the case names another one */
  PetscBool points_move; /* do points cross cells? */
  /* Phase a, collective: sorted points, support, touched, mass, v, a. Called once before every step (and before output of nodal
   * fields); leaves points alone otherwise. */
  PetscErrorCode (*initialise)(Stage *stage);
  /* Collective. What a step changes of v and a before its solve, undone if it is not accepted. NULL: nothing. */
  PetscErrorCode (*begin)(Stage *stage);
  /* Phase c, collective: the step is accepted, v1 and a1 are known, du holds the increments. State and F are committed already. */
  PetscErrorCode (*convect)(Stage *stage, const PetscReal *du);
  const MethodField *fields; /* ended by name = NULL; NULL: nodes remember nothing */
  /* For methods whose nodes leave the grid that seeded the points; NULL in others. Collective. Nodes, ranks and neighbours may change here, between steps. */
  PetscErrorCode (*destroy)(Stage *stage);
  /* Groups of nodes that steps to come may couple, added to those that are there. NULL: those that the basis couples in the cells. */
  PetscErrorCode (*couplings)(const Stage *stage, NodeGroups *groups);
  /* Send nodes and points to ranks by where they are now. */
  PetscErrorCode (*redistribute)(Stage *stage);
} Method;

extern const Method *const methods[]; /* ended by NULL */
const Method *method_find(const char *name);
/* Do its nodes and points fit the basis? */
PetscBool method_takes(const Method *method, const Basis *basis);

PetscErrorCode StageCreate(const Case *c, Grid *grid, Points *points, Points *tracers, Loads *loads,
                           const Material *materials, Stage **stage);
PetscErrorCode StageDestroy(Stage **stage);

/* Steps that methods share. */
PetscErrorCode StageTouch(Stage *stage);     /* touched, and in grids of cells filled, from the support */
PetscErrorCode StageNodalMass(Stage *stage); /* m_I = sum N m_p, on all copies */
PetscErrorCode StageNodalPressure(
  Stage *stage); /* p_I = sum N m_p p / m_I (thesis eq. 5.20), on all copies; after StageNodalMass */
/* Nodes that keep their history take the velocity of their body where they stand; m and touched must be known. */
PetscErrorCode StageBodyVelocity(Stage *stage);
/* The same for points with clouds. */
PetscErrorCode StageMoveClouds(Stage *stage, Points *carried, const Support *support, const PetscReal *du);
PetscErrorCode StageMoveCarried(Stage *stage, Points *carried,
                                const PetscReal *du); /* tracers and carriers follow the field */
/* After initialise: does a node that material touches carry the tracer or carrier of this rank? */
PetscBool stage_carries(const Stage *stage, const Points *followers, PetscInt p);
