/* The model: everything that a case becomes, and the step that advances it.
 *
 * A step that fails leaves the model as it was: state is committed only on acceptance. */
#pragma once
#include "base/phase.h"
#include "method/method.h"
#include "method/time/time_scheme.h"
#include "solve/contact/contact.h"
#include "solve/newton/newton.h"
#include "solve/newton/step_control.h"

typedef struct {
  PetscReal kinetic, elastic; /* now, J */
  PetscReal dissipated;       /* stress work that is not stored, since the start, J */
  /* work of gravity and loads, and of prescribed motion, since the start, J */
  PetscReal external, boundary;
  /* lost by damping, and between points and grid, since the start, J (docs/theory.md) */
  PetscReal damped, transfer;
  PetscReal friction;  /* taken by sliding along walls, since the start, J */
  PetscReal held;      /* of transfer: by what holds nodes that points hardly reach, since the start, J */
  PetscReal numerical; /* taken by the damping of the time scheme, less what room makes, since the start, J */
  /* gone with points that left the grid, and in holding others at its boundary, since the start,
   * J */
  PetscReal outside;
  /* kinetic and elastic at the start, and what has come and gone with bodies and walls since, J */
  PetscReal start;
} Energies;

/* Of a mean over steps: that since the last row of the history, over how long, s, and 1 once a row has it. */
typedef struct {
  PetscReal mean, time, given;
} RowMean;
#define ROW_MEAN 3

/* What a measure remembers from step to step. */
#define MEASURE_KEPT 2
typedef struct {
  PetscReal kept[MEASURE_KEPT]; /* what it keeps for itself */
  RowMean row;
  PetscReal ended;    /* when the material left its tracer behind, s; 0: it did not */
  PetscReal where[3]; /* the tracer was then, m */
  /* more that it keeps, as many numbers as it likes: see MemoryAppend */
  PetscInt n_list, capacity;
  PetscReal *list;
} MeasureMemory;

/* A load whose carriers, or some of them, the material has left behind. */
typedef struct {
  PetscReal ended;    /* when that last happened, s; 0: it did not */
  PetscReal carriers; /* how many so far */
  PetscReal force[3]; /* that they bore, at amplitude 1, N */
  PetscReal where[3]; /* the middle of those that went last, m */
} LoadMemory;

/* What has become of points that left the grid, since the start. All real numbers, counts too: it
 * goes into checkpoints as one row, as do the above from `ended` on. */
typedef struct {
  PetscReal removed, mass;             /* taken out: points, kg */
  PetscReal held;                      /* times that a point was put back on the boundary */
  PetscReal held_now;                  /* in the last step, points */
  PetscReal held_most, held_most_mass; /* in one step: points, kg */
  PetscReal energy;                    /* J */
  PetscReal momentum[3];               /* kg m/s */
  PetscReal first, last;               /* step in which it happened first and last, s at its end */
} Outside;

/* How the work is shared among the ranks: by counts of points and of cells that hold some. */
typedef struct {
  /* largest share over the mean, at the start of the last step; 0: nobody looked */
  PetscReal imbalance;
  PetscReal largest;     /* that it was, since the start */
  PetscReal reached;     /* by the last try to share anew; 0: there was none */
  PetscInt tried;        /* step of that try */
  PetscInt repartitions; /* since the start */
} Balance;

/* What the first guess of a step knows of the step before. */
typedef struct {
  PetscReal step; /* its length, s; 0: there was none */
  /* were the increments of the step before it nearer to its solution than what inertia alone
   * would have brought? */
  PetscBool previous;
} Guess;

/* Newton's tries that failed before another one led to the solution, or the step was halved. */
typedef struct {
  PetscInt again; /* tries of the same step from another first guess */
  PetscInt lost;  /* iterations of tries that failed */
} Tries;

/* Sums over steps, of displacements since the start, J (step/sway.c): what points without an extent lose of the work of
 * stress in them, and what they strain the material by; without what bodies do as a whole (apart); and along each axis,
 * with the work of the strains' stress, and spin and strain apart, squared, m3. All of it is real, counts too. */
typedef struct {
  PetscReal steps, lost, strained, lost_apart, strained_apart;
  struct {
    PetscReal lost, work, spin, strain;
  } along[3];
} Sway;
#define SWAY_NUMBERS (sizeof(Sway) / sizeof(PetscReal))

/* How far a static step moves the body per time, m/s: of the stiffest step, of the last one and of
 * the one before it; 0: there was none. */
typedef struct {
  PetscReal least, last, before;
} Softening;

/* Strength divided by a factor (strength.c): 1 unless the analysis is for a factor of safety. */
typedef struct {
  PetscReal factor; /* that divides it in this state; 0: nothing yields yet */
  /* the largest with an equilibrium and the smallest without, and their middle when the search is
   * over; nan: not known */
  PetscReal lower, upper, value;
  PetscBool lost;   /* is the search over, and all it knows is `lower`? */
  PetscBool trying; /* a step for another factor: it is not made smaller */
  PetscReal reach;  /* no node of a body that stands moves farther in such a step, m */
  /* of the last try from this state that slid: by how much its factor was larger, and how far it went, m; 0: none */
  PetscReal slid_by, slid;
  PetscReal by;   /* and by how much that of this try is, */
  PetscReal anew; /* and what of its way does not grow with the factor, m */
} Strength;

/* A load that is raised to its limit (limit_load.c). */
typedef struct {
  PetscReal factor;       /* of a load that is given */
  PetscReal load;         /* that factor, or of a prescribed displacement the force along it, N */
  PetscReal displacement; /* of the boundary; of a load the one that it works on: work over force, m */
  PetscReal unit;         /* work of a load for a factor of 1 at the first stiffness, J; 0: not known yet */
  PetscReal value;        /* the largest load, when the search is over; nan until then */
  PetscReal resultant;    /* of the load's nodal forces for a factor of 1, N */
  PetscReal *nodal;       /* these, n_nodes x dim */
  LoadBorder border;
  PetscBool rising;  /* after `end` */
  PetscBool unfound; /* is the search over without a limit? */
} Raised;
#define RAISED_KEPT 5

/* What the state before the first step was like (start/). All of it is real, counts too. */
typedef struct {
  PetscReal beyond; /* points whose given stress was more than their strength allows */
  PetscReal lacked; /* norm of forces out of balance over that of the weight, as given; nan: nobody looked */
  /* the same in the equilibrium, and the largest displacement on the way there, m; nan: none was sought */
  PetscReal left, moved;
  PetscReal parts, elastic_parts; /* in which it was taken away; of these before anything could yield */
  PetscReal iterations;
  PetscReal share;   /* of what is lacking that the present step takes away */
  PetscBool seeking; /* equilibrium: time stands still */
  PetscBool acts;    /* did weight or loads act as it began? else what lacked is a share of what held */
} InitialState;
#define INITIAL_KEPT 7

/* What an entry of the boundary whose place moves gave the nodes that it has let go, N: over the last step (reaction),
 * and what of it the scheme remembers (rate). */
typedef struct {
  PetscReal reaction[3], rate[3];
} LetGo;
#define LET_GO_NUMBERS 6

/* What sticks to each other through a thin wall (contact/astride.c), as it was seen first. */
typedef struct {
  PetscInt nodes; /* 0: nothing was seen */
  PetscInt body[2], others;
  PetscReal time; /* s */
  PetscBool told;
} Astride;

typedef struct Model {
  MPI_Comm comm;
  const Case *c;
  PetscInt dim;
  const Method *method;
  const Formulation *formulation;
  Material *materials;
  PetscInt n_state;
  Grid *grid;
  PetscReal *drawn; /* of fem with stages: n_nodes x dim, where nodes were before any state was taken, m; else NULL */
  /* while a stage of dynamics begins: n_nodes x 2 dim, of the one before (motion/jump.c); else NULL */
  PetscReal *balanced;
  /* while a stage of statics begins, or one of dynamics that releases: n_nodes x 2 dim, N, of the one before where it
   * left nodes free, and where it held them (stage/remainder.c); else NULL */
  PetscReal *remainder;
  Points *points;
  Points *tracers; /* body = index of the measure */
  Boundary *boundary;
  LetGo *let_go;   /* one per entry of the boundary; NULL: no place moves */
  PetscBool hangs; /* was it told that the boundary holds what should slide? */
  Loads *loads;
  NodalForces forces;
  Walls *walls;     /* NULL: the case has none */
  Contact *contact; /* likewise */
  Astride *astride; /* n_walls; NULL: nobody has looked */
  Discretisation *space;
  NodalFields *nodes; /* those of space */
  const TimeScheme *scheme;
  System *system;
  Newton *newton;
  struct Explicit *explicit; /* what explicit dynamics works with; NULL before its first step */
  unsigned char *enabled;    /* n_cells: cells whose nodes carry unknowns */
  PetscInt n_constraints;    /* on nodes of a cloud, over all ranks */
  PetscInt layouts;          /* of the cloud, that the system fits */
  PetscReal pressure_scale;  /* mixed: Pa/m */
  Guess guess;
  BodyForce body_force; /* NULL: gravity alone */
  void *body_force_context;
  PetscReal *pull;          /* mixed: n_points x 3, what that gives in the step, m/s2; NULL: there is none */
  PetscBool (*asked)(void); /* does somebody want the run to end? NULL: a step is always finished */
  PetscReal time;           /* s */
  StepControl control;
  PetscInt step;
  PetscBool *option_set;    /* which of the case's PETSc options the model put into the database */
  PetscBool symmetric;      /* are all tangents symmetric? */
  PetscReal machine_memory; /* bytes: MemoryHeld */
  PetscReal gravity[3];     /* of the step, m/s2 */
  /* n_bodies: mixed: do pressures bear its weight? What dynamics let go at once bears none, in free flight never */
  PetscBool *weighs;
  PetscReal courant_speed; /* largest sqrt(M / density), m/s */
  /* see Energies */
  PetscReal external_work, boundary_work, damped_energy, transfer_energy, friction_energy, numerical_energy;
  PetscReal held_energy;
  PetscReal start_energy;
  /* that had come in, by the start, loads, gravity and prescribed motion, at any time, J */
  PetscReal most_energy;
  PetscReal kept_energy;  /* most that elastic bodies of statics stored when nothing acted on them any more, J */
  PetscReal least_energy; /* of strains that steps can tell from none, J */
  PetscReal open_energy;  /* that forces out of balance, as steps have left them, may have made or taken so far, J */
  Outside outside;
  MeasureMemory *memory;   /* one per measure */
  LoadMemory *load_memory; /* one per load */
  Balance balance;
  /* steps halved, Newton iterations (those of all tries), since the start */
  PetscInt cuts, total_iterations;
  /* of statics: the first and the last accepted step whose equilibrium is one that nothing stays in, s, and in how many
   * ways at most; 0: none was seen */
  struct {
    PetscInt ways;
    PetscReal first, last;
  } unstable;
  /* of clouds: when parts that no material joins first came into each other, s, and where, m; points: 0: never */
  struct {
    PetscInt points, body;
    PetscReal time, place[3];
  } entered;
  Tries tries; /* since the start */
  /* most of a piece of its table of strength that a point of this rank has passed in a step (Law.passed) */
  PetscReal passed;
  Softening limit;
  Sway sway;
  Strength strength;
  InitialState initial;
  struct {
    PetscInt n, *dof;   /* of local nodes, ghosts too */
    PetscBool *turns;   /* does it hold the body from turning? else where it is */
    PetscInt turning;   /* how many do, over all ranks */
    PetscReal size;     /* of the largest body that is held so, m */
    PetscBool along[3]; /* did nothing but that hold a body along the axis when the run began? */
  } unheld;             /* directions of nodes that hold what nothing else does, in the step */
  Raised raised;
  PetscReal uneven; /* what points of own meshes leave of a uniform stress out of balance, if it was told; else 0 */
  PetscReal seconds[PHASE_N]; /* see model_times */
} Model;

/* Interrupted: given up because somebody asked for it; the model is as it was. */
typedef enum { STEP_ACCEPTED, STEP_TOO_SMALL, STEP_POINTS_LOST, STEP_INTERRUPTED } StepOutcome;

typedef struct {
  StepOutcome outcome;
  PetscReal dt;  /* of the accepted step */
  PetscInt cuts; /* how often the step was halved */
  Tries tries;
  NewtonReport newton; /* of the last try */
  char reason[768];    /* why the run gives up, in words */
  /* why an equilibrium was not accepted, in words: newton.reason then points here */
  char leap[160];
  PetscBool flows; /* did it do so in pseudo-time? */
  /* that made the step share the grid among the ranks anew; 0: it did not */
  PetscReal imbalance;
  PetscInt moved;          /* points that changed their rank for that */
  PetscInt removed, held;  /* points that left the grid: taken out, put back on its boundary */
  LostPoint first_outside; /* the first of these: id and place only */
} StepReport;

/* Collective. Build from a case (which must outlive the model); the user's mistakes go to diag and
 * *model stays NULL. */
PetscErrorCode ModelCreate(MPI_Comm comm, const Case *c, Diag *diag, Model **model);
PetscErrorCode ModelDestroy(Model **model);
/* Of one process. Smallest and largest size of the cells in which points of each body start, m: 2 n_bodies. 0 of one
 * without points, and of all where grid or bodies have mistakes, which go to diag. */
PetscErrorCode ModelCellSizes(const Case *c, Diag *diag, PetscReal *range);

/* Collective. Of a model that was just created: the equilibrium that the case asks for before the first
 * step. If it is not found report->outcome is no acceptance, and the model is fit for nothing but
 * ModelDestroy. */
PetscErrorCode ModelEquilibrate(Model *model, StepReport *report);
/* Collective. Body force besides gravity, NULL for none. Before the first step it also enters the
 * initial acceleration. */
PetscErrorCode ModelSetBodyForce(Model *model, BodyForce force, void *context);
/* Collective. Nodes that an entry of `boundary` takes, and those of them beside material: start/advice/beside.c. */
PetscErrorCode ModelCountPrescribed(const Model *model, PetscInt entry, PetscInt count[2]);
/* Warn of a case in none of whose stages anything happens, once all that its caller gives is known:
 * start/advice/still.c. */
void model_advise_still(const Model *model, const Case *whole, Diag *diag);
/* Collective. Factors of a load of the case that vary from place to place, NULL for none; likewise. */
PetscErrorCode ModelSetLoadFactors(Model *model, PetscInt load, LoadFactors ask, void *context);

/* Collective. Somebody has changed velocities, accelerations or states of points between steps:
 * nodes learn of it where points carry the motion. Before the first step accelerations are found
 * anew. */
PetscErrorCode ModelPointsChanged(Model *model);

/* Collective. Phase a: nodes learn from where points are now, unless they have already. A step
 * begins with it; whoever wants nodal fields or measures between steps calls it first. */
PetscErrorCode ModelInitialise(Model *model);
/* Collective. Make the linear system fit the cells that hold material now; ModelStep does it by
 * itself. */
PetscErrorCode ModelActivate(Model *model);
/* How long until a wall appears or vanishes, where a step must end, s; PETSC_MAX_REAL: none does. */
PetscReal model_until_change(const Model *model);
/* Collective. One step of at most `limit` s; halves it until Newton converges. */
PetscErrorCode ModelStep(Model *model, PetscReal limit, StepReport *report);

/* Collective. After all loads are on: the force that is there before the displacement is raised. */
PetscErrorCode RaisedBegin(Model *model);
/* Collective. One step in which the load is raised, by control * (a factor of its
 * displacement, or of its work at the first stiffness), or by less if Newton's method asks for it. */
PetscErrorCode ModelRaise(Model *model, PetscReal control, StepReport *report);
/* Collective. What the rise of its materials' strength did in the plastic strain of the last step, J: in a steady
 * mechanism the rise of the load does as much in its displacement (docs/theory.md, "Limit loads"). */
PetscErrorCode RaisedHardening(const Model *model, PetscReal *work);
/* Does any material harden by more than the tolerance of a limit that is sought? */
PetscBool raised_hardens(const Model *model);
/* Collective. After all loads are on: one step to the equilibrium with a larger factor. It stands if
 * Newton finds one in which no node has moved farther than strength.reach; if not, the model is as it
 * was, and report->leap says how far it slid, if that was why. *moved: the largest increment of a node,
 * m; where Newton gave up, its last one. */
PetscErrorCode ModelTryFactor(Model *model, PetscReal factor, StepReport *report, PetscReal *moved);
/* Collective. How high that is which moves in the last step, along the axis that gravity is nearest to, m: nodes that
 * go half as far as the farthest, and two cells at least. */
PetscErrorCode MovingHeight(const Model *model, PetscReal *height);
/* Collective. Value of one measure of the case now. */
PetscErrorCode ModelMeasure(Model *model, const MeasureSpec *measure, PetscInt index, PetscReal *value);
/* Collective. The same for a row of the history (measure/rows.c): of what is a mean over a step that since the last
 * row, and formulas of these. Whoever has written one says so. */
PetscErrorCode ModelMeasureRow(Model *model, const MeasureSpec *measure, PetscInt index, PetscReal *value);
void model_row_given(Model *model);
/* Numbers behind the list that a measure keeps. */
PetscErrorCode MemoryAppend(MeasureMemory *memory, PetscInt n, const PetscReal *numbers);
const char *measure_unit(const MeasureSpec *measure);
PetscErrorCode ModelEnergies(Model *model, Energies *energies);
/* That steps can tell from none, J: of strains, of forces that they leave out of balance, and of gaps that contact
 * leaves. */
PetscReal energy_unresolved(const Model *model);

/* Seconds that this rank spent in each phase since the start. */
void model_times(const Model *model, PetscReal seconds[PHASE_N]);

/* After the run: a warning for each PETSc option, of the case or of the command line, that nobody
 * asked for. */
PetscErrorCode ModelUnusedOptions(const Model *model, Diag *diag);

/* Number of points over all ranks. */
PetscErrorCode ModelCountPoints(const Model *model, PetscInt *n);
/* Force of all walls on one point at the end of the last step, N. */
void contact_force_on(const Model *model, PetscInt p, PetscReal force[3]);
/* Collective. Tractions of a wall on the material after the step that was taken last, on this rank: none
 * before the first one and in a model just resumed; PetscFree them. */
PetscErrorCode ModelTractions(const Model *model, PetscInt wall, PetscInt *n, ContactTraction **tractions);
/* contact/astride.c. Collective. Look for nodes that reach through walls: at the start, and with each row, since bodies
 * may come there. What was found is told once, then or later. */
PetscErrorCode AstrideLook(Model *model);
void astride_tell(Model *model, Diag *diag);
/* Collective. After the last step of statics: which bodies have left all that held them. */
PetscErrorCode ModelWarnLoose(Model *model, Diag *diag);
/* Stored energy of one point per undeformed volume, J/m3. */
PetscReal model_point_energy(const Model *model, PetscInt p);
/* The same of n points. */
void model_point_energies(const Model *model, PetscInt first, PetscInt n, PetscReal *energy);
/* First number of a named field of the point's state, or NULL if its law has none. */
const PetscReal *model_state_field(const Model *model, PetscInt p, const char *name);
/* Cauchy stress (Voigt) of one point, from its state. */
PetscErrorCode ModelPointStress(const Model *model, PetscInt p, PetscReal sigma[6]);
