/* Statics, dynamics, searches, and stages of them. */
#pragma once
#include "case/kinematics/kinematics.h"
#include "case/spec/measure.h"

/* Of a step: times at which steps must end, but closer together than that, are one; and, in implicit dynamics, of
 * those that may move the ones that are so close to another. */
#define NO_STEP 1e-4
#define CLOSE_STEPS 0.1

typedef enum { ANALYSIS_STATIC, ANALYSIS_DYNAMIC, ANALYSIS_FACTOR, ANALYSIS_LIMIT, ANALYSIS_EXPLICIT } AnalysisType;
/* Which velocity of the nodes strains the points of explicit dynamics: that which the points have given them anew
 * at the end of a step, or that of the balance of momentum. */
typedef enum { EXPLICIT_MUSL, EXPLICIT_USL } ExplicitUpdate;
typedef enum { MASS_CONSISTENT, MASS_LUMPED } MassMatrix;
typedef enum { UNHELD_REFUSE, UNHELD_HOLD } UnheldKind;

/* How bodies come to rest before the first step: not at all, with their laws, or first as if nothing
 * yielded. AUTO until the case is read. */
typedef enum { EQUILIBRIUM_AUTO, EQUILIBRIUM_NONE, EQUILIBRIUM_DIRECT, EQUILIBRIUM_ELASTIC_FIRST } EquilibriumKind;

/* What the state before the first step is made of, besides the initial stress of bodies. */
typedef struct {
  EquilibriumKind equilibrium;
  PetscBool reset; /* bodies keep the shape that they are given, and only stresses change */
  char *run;       /* or the state of another run, in this directory; NULL: of none */
  char *stage;     /* the end of this stage of it; NULL: its newest state */
  PetscBool has_release;
  PetscReal release; /* s, see Case.release */
} InitialSpec;

/* By what the strength may be divided before a body fails. */
typedef struct {
  PetscReal from;      /* the first factor that is tried once the loads are on */
  PetscReal step;      /* to the next one, as long as none has failed */
  PetscReal tolerance; /* width of the bracket that is good enough, over the factor */
  PetscReal most;      /* beyond it nobody looks */
  PetscInt n_bodies;   /* 0: all */
  char **bodies;       /* whose strength is divided */
} ReductionSpec;

/* Strength divided by a factor from the start. */
typedef struct {
  PetscReal factor; /* 0: not given */
  /* or by so many times the smallest factor that failed in the stage before; 0: not given */
  PetscReal beyond_failure;
  PetscInt n_bodies; /* 0: all */
  char **bodies;
} StrengthSpec;

/* What a state loses when something else begins with it. */
typedef struct {
  PetscBool displacement, velocity;
} ResetSpec;

/* A stage, besides what it changes of the case. */
typedef struct {
  char *name;
  ResetSpec reset;
  PetscBool has_release;
  PetscReal release; /* s, see Case.release */
  char *text;        /* what it changes, resolved: keys of a case */
} StageSpec;

typedef enum { RAISE_NOTHING, RAISE_GRAVITY, RAISE_LOAD, RAISE_BOUNDARY, RAISE_WALL } RaiseKind;

/* What is raised until nothing more holds. */
typedef struct {
  char *raise; /* "gravity", or the name of a load, of an entry of the boundary or of a wall */
  RaiseKind kind;
  PetscInt index;      /* into loads[], boundary[] or walls[] */
  PetscReal step;      /* the first: factor of the load while it is small, of the prescribed displacement */
  PetscReal tolerance; /* by which the load may have grown while the displacement doubled */
  PetscReal most;      /* factor beyond which nobody looks */
  PetscInt steps;      /* the search ends after so many */
} LimitSpec;

typedef struct {
  AnalysisType type;
  LimitSpec limit;             /* of a limit load */
  ReductionSpec reduction;     /* of a factor of safety */
  PetscReal end;               /* s; statics: pseudo-time, 1 */
  PetscReal step;              /* s, the first and (without growth) largest step */
  PetscReal smallest, largest; /* s, bounds of step control */
  /* most cells that a point may cross in a step that has grown; 0: any */
  PetscReal travel;
  PetscReal courant;     /* explicit: share of the critical step that is taken; 0: as much as `update` bears */
  ExplicitUpdate update; /* explicit */
  PetscReal contact;     /* explicit: stiffness of springs of contact, over that of a cell */
  char *scheme;          /* of dynamics, by its name; NULL: Newmark's, with bossak Bossak's */
  PetscReal beta, gamma; /* Newmark */
  PetscReal bossak;      /* alpha_B in [-1/3, 0] */
  PetscReal damping;     /* Rayleigh, mass proportional, 1/s */
  MassMatrix mass;
  char *transfer; /* mpm: between points and nodes, by its name; NULL: the thesis's */
  /* mpm: prescribed nodes do not take from points what velocity they bring */
  PetscBool keep_velocity;
  UnheldKind unheld; /* static: rigid motions of bodies that nothing holds */
  PetscInt n_until;
  UntilSpec *until; /* any of them ends the run; `end` is the latest time */
} AnalysisSpec;

/* What `bossak` asks for, and whether the case has others. */
PetscReal analysis_usual_beta(const AnalysisSpec *analysis);
PetscReal analysis_usual_gamma(const AnalysisSpec *analysis);
PetscBool analysis_tunes_newmark(const AnalysisSpec *analysis);
