/* Explicit dynamics (`type: explicit`): what its files share. step.c is the algorithm.
 *
 * A step of the run (analysis.step) is divided into substeps, none of which a wave crosses a cell in.
 * Some of them make a lap: points are sorted and find their cells, and the nodes that they can reach are
 * listed, only between laps. In a box of lines at equal distances points find their nodes by arithmetic, wherever
 * in it they are, with linear functions and in the plane with gimp; else laps have one substep, and a support in each.
 *
 * Between substeps velocities are those of the middle of the last one; at the ends of the run's steps they are
 * those of that time. */
#pragma once
#include "model/explicit/critical.h"
#include "model/model_private.h"
#include "solve/contact/contact.h"

/* Nodes of a box with lines at equal distances, as this rank knows it. */
typedef struct {
  PetscReal origin[3], per_length[3], size[3]; /* m, 1/m, m */
  PetscInt most[3], stride[3];                 /* last cell and distance of nodes along each axis, from `origin` */
  PetscInt corner[8];                          /* lattice number of a cell's nodes from its first */
  PetscReal end[3][2];                         /* where the box ends along each axis, from `origin` in cells */
  const PetscInt *number;                      /* local node of each */
} Lattice;

/* A prescribed dof, in the frame of its node. */
typedef struct {
  PetscInt node, axis;
  PetscReal velocity; /* of the substep, m/s */
  PetscReal glanced;  /* of a part of it */
} Held;

/* Points that walls may meet in the lap, where points find their nodes by arithmetic, and the nodes that these see in
 * the substep, a group each. */
typedef struct {
  PetscInt n, capacity, *point;
  Support *support;
} NearWalls;

/* Nodal arrays are 0 where no point reaches. */
typedef struct Explicit {
  PetscBool box;    /* do points find their nodes by arithmetic? */
  PetscBool smooth; /* and are their functions those of gimp? */
  PetscBool loaded; /* does anything act on nodes but stress, weight and walls? */
  PetscBool shared; /* do points of a cell share their change of volume (formulation mean-dilatation)? */
  Lattice lattice;
  PetscInt width;        /* 1 + 2 dim */
  PetscReal *sum;        /* n_nodes x width: mass, kg, momentum, kg m/s, and force, N */
  PetscReal *motion;     /* n_nodes x 2 dim: velocity at the end of the substep, and what points gain, m/s */
  PetscReal *surface;    /* n_nodes x partners x dim: normals that surface looks along in the lap */
  PetscReal *springs;    /* with walls, n_nodes x 2: stiffness of the springs, N/m, and mass, kg */
  PetscReal *straining;  /* n_nodes x dim: the velocity that strains the points, m/s */
  PetscBool as_strained; /* do points move by it, too (explicit_way)? */
  /* n_nodes: > 0 where points of some rank can come in the lap; then, in each substep, at nodes that carry neither
   * loads nor tracers */
  PetscReal *mark;
  PetscInt n_active, *active; /* nodes where points can come in the lap */
  PetscBool led;              /* do nodes follow others in the substep, on any rank? */
  PetscReal *bare;            /* n_nodes: then, masses before followers hand theirs on, kg */
  PetscReal *apart;           /* n_nodes x 3 dim: momentum and velocities meanwhile */
  PetscInt n_held;
  Held *held;
  PetscBool moved;     /* do prescribed velocities change? */
  PetscReal time;      /* at the start of the substep, s */
  PetscReal step;      /* of the run's, s */
  PetscReal dt;        /* of a substep, s: how long points move in it; 0: velocities alone are brought to `time` */
  PetscReal before;    /* of the last one, s; 0: velocities are those of `time` */
  PetscReal kick;      /* how long forces act in it, s: from the middle of the last one to that of this one */
  PetscReal fade;      /* of velocities by damping meanwhile, */
  PetscReal act;       /* and as if forces acted so long, s: damping takes of what they give, too; */
  PetscReal fading[3]; /* energy that it takes of a point: m times these of v v, v g and g g, with g the gain */
  PetscBool slopes;    /* do points carry the gradient of their motion (transfer consistent)? */
  PetscReal unseen;    /* share that they lose meanwhile of what nodes do not see of their motion, */
  PetscReal follow;    /* and by which their gradient goes after that of the nodes */
  PetscReal g[3];      /* gravity, m/s2 */
  PetscInt substeps;   /* in the lap; and all */
  PetscInt taken;
  PetscBool begins, ends; /* is the substep the lap's first, its last? */
  PetscReal critical;     /* substep, s, when it was last asked for, */
  PetscReal crossing;     /* and the time in which a wave crosses a cell along all its axes, s, */
  PetscInt since;         /* so many substeps ago */
  PetscReal fastest;      /* of the points, m/s */
  LawStatus status;
  PetscReal external, boundary, damped; /* energies of the run's step, this rank's share, J */
  PetscReal outside;                    /* Model.outside.energy at its start, J */
  NearWalls near;
  /* of each wall in the run's step, on this rank: mean force on the material and its torque; work of sliding, J */
  ContactSum *pushed;
  PetscReal *rubbed, friction; /* friction: of all walls */
  PetscReal *sunk;             /* likewise: how deep material was in it in any substep, m */
  /* walls with mass (heavy.c): bound of the square of the frequencies that they bring, 1/s2; how fast the fastest moves
   * anywhere, m/s; of each, by what its springs are multiplied to keep that bound; work on them without energy of
   * motion when the run's step began, J */
  PetscReal swing, rush, *ease, driven;
} Explicit;

/* lap.c. Collective. Arrays for the grid as it is. */
PetscErrorCode ExplicitCreate(const Model *model, Explicit **explicit);
/* Collective. Who reaches whom, who is held, and how many substeps of which length follow; left:
 * of the run's step, s. */
PetscErrorCode LapBegin(Model *model, Explicit *e, PetscReal left);
/* Walks by cells leave displacements to the lap: at its start (sign = -1) points lose their place from them, at
 * its end (1) they get the new one. */
void lap_displace(const Model *model, const Explicit *e, int sign);
/* Collective. Points find their cells and ranks. */
PetscErrorCode LapEnd(Model *model, StepReport *report);

/* near.c. Lists the points that walls may meet in the lap, and the others forget walls. */
PetscErrorCode NearFind(Model *model, Explicit *e);
/* What was kept of contact goes: of them where there is a list, else of all points. */
void near_forget(const Model *model, const Explicit *e);
/* Their functions where they are now. */
PetscErrorCode NearSee(const Model *model, Explicit *e);

/* inside.c. Collective in the first substep of a lap. What is pressed into walls within bodies is no contact. */
PetscErrorCode WallsTouchSurface(Model *model, Explicit *e, const NodalScene *scene);
/* walls.c. Forces of walls go to the nodes. */
PetscErrorCode WallsPush(Model *model, Explicit *e);
/* Material moves along walls: before the points do. */
void walls_follow(Model *model, Explicit *e);
/* Collective. What acted over the run's step. */
PetscErrorCode WallsAccount(Model *model, Explicit *e);

/* heavy.c. When a lap begins: what walls with mass ask of a substep; and the critical one with that. */
void heavy_limit(const Model *model, Explicit *e);
PetscReal heavy_substep(const Explicit *e);
/* Collective. They gain velocity by what acts on them, and choose their way; then they go it. */
PetscErrorCode HeavyMove(Model *model, Explicit *e);
void heavy_go(Model *model);

/* nodes.c. Collective. Forces that know where points are. */
PetscErrorCode ForcesBegin(Model *model, Explicit *e);
/* Velocities from momentum, and at the end of the substep from forces. Collective if loads act. */
PetscErrorCode NodesMove(Model *model, Explicit *e);
/* Prescribed dofs move as prescribed; the impulse goes to the reactions. */
void nodes_hold(Model *model, Explicit *e);
/* Collective. Copies on other ranks. */
PetscErrorCode NodesShare(const Model *model, PetscInt components, PetscReal *values);
/* lead.c. Collective. Who follows in the substep, by the masses in `sum`; is this node among them? */
PetscErrorCode Lead(Model *model, Explicit *e);
PetscBool is_led(const Model *model, const Explicit *e, PetscInt node);
/* Collective, on all copies: where nodes follow, what they have goes to those that lead, of `sum` once the substep has
 * begun, of momentum (n_nodes x dim) after that, of others; and they take what those have. */
PetscErrorCode SumsGive(const Model *model, Explicit *e);
PetscErrorCode MomentumGive(const Model *model, const Explicit *e, PetscReal *momentum);
PetscErrorCode NodesGive(const Model *model, const Explicit *e, PetscInt components, PetscReal *sum);
PetscErrorCode NodesTake(const Model *model, const Explicit *e, PetscInt components, PetscReal *field);
/* Collective. Momentum in `straining`, summed over the ranks, becomes velocity, held where that is prescribed. */
PetscErrorCode NodesStrain(const Model *model, Explicit *e);
/* Tracers and carriers of loads go with the nodes, whose sums start anew. Collective. */
PetscErrorCode NodesCarry(Model *model, Explicit *e);
/* `straining` starts anew. */
void nodes_forget(const Model *model, Explicit *e);

/* The velocity of a node that points, tracers and loads move by. What has other ways than its strain tells is pulled
 * apart by tension, and shaken by walls, motion that nodes do not see first (docs/theory.md, section 64). */
static inline const PetscReal *explicit_way(const Explicit *e, PetscInt dim, PetscInt node)
{
  return e->as_strained ? e->straining + node * dim : e->motion + node * 2 * dim;
}

/* points.c. Nodes get mass, momentum and forces. */
void points_gather(const Model *model, Explicit *e);
/* Points gain velocity, and give their momentum to `straining` where that is asked for. */
void points_gain(const Model *model, Explicit *e);
/* Points are strained, stressed and moved; walks by cells then give the nodes what they get in the next
 * substep of the lap. */
void points_strain(const Model *model, Explicit *e);

/* G is damped as the velocity is, and goes after the gradient A (1 - A / 2) / dt, A = dF - 1, of the middle between the
 * motion that has brought the point here and that which goes on: it serves both. */
static inline void slope_follow(const int dim, const Explicit *e, const PetscReal A[3][3], PetscReal *G)
{
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) {
      PetscReal square = 0;
      for (int k = 0; k < dim; ++k) square += A[i][k] * A[k][j];
      G[i * dim + j] += e->follow * ((A[i][j] - 0.5 * square) / e->dt - G[i * dim + j]) - e->fade * G[i * dim + j];
    }
}

/* Half a substep, s, where points move as they are strained; 0 with cells, whose two maps serve one gradient. */
static inline PetscReal explicit_half(const Explicit *e) { return e->as_strained ? 0.5 * e->dt : 0; }

/* G of the middle as it is `ahead` seconds later for the motion that it has, G (1 + ahead G): velocities half a substep
 * before where points stand lean by it with -dt / 2, those half a substep after with dt / 2. */
static inline void slope_at(const int dim, const PetscReal *G, PetscReal ahead, PetscReal *now)
{
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) {
      PetscReal square = 0;
      for (int k = 0; k < dim; ++k) square += G[i * dim + k] * G[k * dim + j];
      now[i * dim + j] = G[i * dim + j] + ahead * square;
    }
}

/* Points of one material that are worked off together, component by component. Numbers behind the last point are
 * an increment that changes nothing. */
typedef struct {
  PetscReal dF[9][LAW_BATCH];  /* row by row; in the plane xx xy yx yy zz */
  PetscReal tau[6][LAW_BATCH]; /* as POINT_TAU has them, Pa */
} Batch;

/* tau and the states of n points of one material from `first` after b->dF; n <= LAW_BATCH. */
static inline LawStatus batch_stress(const Model *m, PetscInt first, PetscInt n, Batch *b)
{
  const Material *material = &m->materials[m->points->material[first]];
  const LawMarch march = {.dF = b->dF[0],
                          .tau = b->tau[0],
                          .state = point_real(m->points, POINT_STATE, first),
                          .stride = m->points->components[POINT_STATE]};
  return law_march(material->law, m->dim == 2, material->parameters, n, &march);
}
/* Points from `first` on that one call of their law takes. */
static inline PetscInt batch_points(const Model *m, PetscInt first)
{
  const Points *points = m->points;
  const PetscInt most = PetscMin(LAW_BATCH, points->n - first);
  PetscInt n = m->c->n_materials == 1 ? most : 1;
  while (n < most && points->material[first + n] == points->material[first]) ++n;
  return n;
}

/* plane.c. The same three walks in the plane where e->box. */
void plane_gather(const Model *model, Explicit *e);
void plane_gain(const Model *model, Explicit *e);
void plane_strain(const Model *model, Explicit *e);
/* smooth.c. And with gimp. */
void smooth_gather(const Model *model, Explicit *e);
void smooth_gain(const Model *model, Explicit *e);
void smooth_strain(const Model *model, Explicit *e);
/* space.c. And in space. */
void space_gather(const Model *model, Explicit *e);
void space_gain(const Model *model, Explicit *e);
void space_strain(const Model *model, Explicit *e);
