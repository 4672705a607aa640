/* A material law, seen from outside: a const struct of data and functions.
 *
 * To add one, copy neo_hookean.c, and add its name to laws.inc. Laws are three-dimensional inside;
 * plane strain and axisymmetry embed their kinematics. A law works on a batch of points at once,
 * so that nothing is called through a pointer inside the loop over points. */
#pragma once
#include "base/diag/diag.h"
#include "case/case.h"

#define LAW_MAX_PARAMETERS 32
#define LAW_MAX_STATE 48
#define LAW_BATCH 32 /* most points of one update call */
#define LAW_MAX_LOADED 8

typedef enum { LAW_OK = 0, LAW_INVERTED, LAW_NOT_CONVERGED, LAW_NOT_FINITE } LawStatus;
/* "a point was turned inside out"; NULL: all is well. */
const char *law_status_text(LawStatus status);

typedef struct {
  const char *word, *help;
} LawWord;

typedef struct {
  /* key in the case file; unit "" if none, "deg" is converted to rad */
  const char *name, *unit, *help;
  PetscReal min, max;           /* closed range */
  PetscBool min_open, max_open; /* the bound itself is excluded */
  PetscReal fallback;           /* default; NAN: must be given, unless it may be absent */
  PetscBool not_mixed;          /* in the mixed formulation only the default will do */
  const char *absent;           /* what counts where it is not given, and the law gets NAN; or NULL */
  const LawWord *const *words;  /* the number is that of one of these, ended by NULL; else NULL */
  PetscBool at_start;           /* it says how a point begins, and nothing of one that has a state */
} LawParameter;

typedef struct {
  const char *name, *unit, *help;
  PetscInt components; /* 1 or 6 (symmetric tensor, Voigt) */
  PetscReal initial[6];
} LawField;

/* How a law's stress depends on its volume, for the mixed formulation (material/pressure.h). */
typedef enum {
  VOLUME_COUPLED, /* shape and volume, or pressure and flow, act on each other */
  VOLUME_LINEAR,  /* apart: U = (J - 1)^2 / 2, p = K (J - 1) */
  VOLUME_LOG      /* apart: U = (ln J)^2 / 2, p = K ln J / J */
} VolumeLaw;

#define ELASTIC_CONSTANTS 5

/* All elastic constants, in the order of the table in elasticity.c. */
typedef union {
  struct {
    PetscReal young, poisson, bulk, shear, lame;
  };
  PetscReal constant[ELASTIC_CONSTANTS];
} Elasticity;

/* Update n points. dF: n x 9, increment of the deformation gradient x_(n+1)/x_n; old, state: n x
 * n_state; tau: n x 6 Kirchhoff stress, Pa; c: n x 36 with L_v tau = c : d, or NULL if not wanted.
 * Never touches old (which may not overlap state). Returns the worst status of the batch. */
typedef LawStatus (*LawUpdate)(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                               PetscReal *state, PetscReal *tau, PetscReal *c);

/* Points of one material in explicit dynamics, which wants no tangent: component by component in rows of
 * LAW_BATCH numbers, with whole lanes of increments (those behind the last point change nothing). */
typedef struct {
  const PetscReal *dF; /* rows: of the plane xx xy yx yy zz, of space 3 x 3 */
  PetscReal *tau;      /* rows: of the plane xx yy zz xy, of space 6 */
  PetscReal *state;    /* n x stride, of which n_state are the law's; updated in place */
  PetscInt stride;
} LawMarch;

/* The worst status; a point that failed keeps its state and carries no stress. n <= LAW_BATCH. */
typedef LawStatus (*LawMarching)(const PetscReal *parameters, PetscInt n, const LawMarch *march);

typedef struct Law {
  const char *name, *help;
  /* ended by name = NULL; elastic constants and density stand apart */
  const LawParameter *parameters;
  const LawField *fields; /* stored state, ended by name = NULL */
  PetscInt n_state;       /* sum of the fields' components */
  PetscBool symmetric;    /* is the tangent symmetric, whatever the parameters? */
  /* Is it with these, since plastic flow follows the normal of the yield surface? NULL: as above. */
  PetscBool (*associated)(const PetscReal *parameters);
  PetscBool yields;       /* can it lose its stiffness? */
  PetscBool needs_stress; /* has it no natural state, so that every point begins with an initial stress? */
  PetscBool spares_state; /* may `state` be NULL where only stress and tangent are wanted? */
  LawUpdate update;
  /* The same where dF leaves z alone, or NULL: of c only the components 11, 22, 12 of rows and
   * columns mean something; and where z strains by itself (dF_33 alone), with 33 as well. */
  LawUpdate update_plane, update_hoop;
  /* What `update` does without a tangent, in the plane (zz strains or not) and in space; or NULL: by `update`. */
  LawMarching march_plane, march_space;
  /* Stored elastic energy per undeformed volume, J/m3. NULL: not known, of a law from a library. */
  PetscReal (*energy)(const PetscReal *parameters, const PetscReal *state);
  /* The same of n points, whose states are `stride` numbers apart. NULL: one by one. */
  void (*energies)(const PetscReal *parameters, PetscInt n, PetscInt stride, const PetscReal *state, PetscReal *energy);
  /* State that carries the Cauchy stress sigma (6) with no shear history; PETSC_FALSE if there is
   * none. */
  PetscBool (*initial_stress)(const PetscReal *parameters, const PetscReal sigma[6], PetscReal *state);
  /* Let the elastic part of a state bear the Kirchhoff stress tau (6), whatever the strength: its history stays.
   * PETSC_FALSE: no elastic strain does. NULL: not known. */
  PetscBool (*bear)(const PetscReal *parameters, const PetscReal tau[6], PetscReal *state);
  /* Bulk and shear modulus that stand for it, of a law whose own parameters say how stiff it is:
   * it takes none of the elastic constants. NULL: two of them belong to it. */
  void (*elastic)(const PetscReal *given, PetscReal bulk_and_shear[2]);
  /* Tell the natural state where its point starts, m, before any initial stress, which keeps what this has set; NULL:
   * it is the same everywhere. */
  void (*place)(const PetscReal x[3], PetscReal *state);
  /* Tell a state where its point is, m, before each step; NULL: the law does not ask. */
  void (*moved)(const PetscReal x[3], PetscReal *state);
  /* Tell a state that initial_stress gave, or the natural one, the size of the cell in which its
   * point starts, m. NULL: the law has no length. */
  void (*size)(const PetscReal *parameters, PetscReal h, PetscReal *state);
  /* Number of the states that the strength follows by a table, 0: none. It counts what this law has done alone: a point
   * that comes from another law begins with the initial one. */
  PetscInt followed;
  /* How far it has come from one state to another, over the length of the piece of the table on which it was, the
   * shortest of several; where nothing changes, 0. NULL: there is no table. */
  PetscReal (*passed)(const PetscReal *parameters, const PetscReal *before, const PetscReal *state);
  /* Radius, m, within which that number is averaged over the points of a material before each step, and what is done
   * with the mean; reach is 0, or NULL, of a law whose points are alone. */
  PetscReal (*reach)(const PetscReal *parameters);
  void (*hear)(const PetscReal *parameters, PetscReal mean, PetscReal *state);
  /* Tell a state that no more than `most`, ln of a volume ratio, can be open. NULL: the law remembers no opening. */
  void (*room)(const PetscReal *parameters, PetscReal most, PetscReal *state);
  /* Turn the user's constants into the packed parameters; complain through diag at `path`. */
  void (*prepare)(const Elasticity *elastic, const PetscReal *given, PetscReal *packed);
  /* What the mixed formulation needs; NULL: the law has no mixed form. Elastic volume ratio of n
   * states; volumetric part; and, only where that may be VOLUME_COUPLED, states whose elastic
   * lengths are multiplied by factor (n), which stabilisation.room asks for, too. */
  void (*volume)(PetscInt n, const PetscReal *state, PetscReal *J);
  VolumeLaw (*volume_law)(const PetscReal *parameters);
  void (*scale)(PetscInt n, const PetscReal *factor, PetscReal *state);
  /* The user's constants of a material whose strength is divided by factor > 0, or, with factor = 0, of
   * one that does not yield; NULL: the law has no strength. */
  void (*reduce)(const PetscReal *given, PetscReal factor, PetscReal *reduced);
  /* Of a law with field equivalent_plastic_strain: its first yield stress, and by how much it rises with that strain,
   * Pa. NULL: it does not. */
  void (*hardens)(const PetscReal *parameters, PetscReal *yield, PetscReal *slope);
  /* Friction angle, rad, and cohesion, Pa, of the Mohr-Coulomb material that has its limit in plane strain, of a law
   * whose own need not be those: an angle of 90 degrees has none. NULL: its own are. */
  void (*in_plane)(const PetscReal *given, PetscReal strength[2]);
  /* What is wrong with parameters that are each in their range, or NULL. May itself be NULL. */
  const char *(*check)(const PetscReal *given);
  /* Tell packed parameters the time at the start of a step and its length, s; dt = 0 stands for no step, in
   * which nothing may flow. NULL: the law does not know of time. */
  void (*step)(PetscReal time, PetscReal dt, PetscReal *packed);
  /* Does stress depend on the rate of strain? Statics have no rate: a step is endless there, dt = PETSC_INFINITY. */
  PetscBool rate;
} Law;

/* What strains in these kinematics decides which update is the quickest. */
static inline LawUpdate law_update_in(const Law *law, const Kinematics *kinematics)
{
  if (kinematics->hoop && law->update_hoop) return law->update_hoop;
  return kinematics_is_plane(kinematics) && law->update_plane ? law->update_plane : law->update;
}

/* By the quickest way that the law has. plane: do rows mean the plane's components? */
LawStatus law_march(const Law *law, PetscBool plane, const PetscReal *parameters, PetscInt n, const LawMarch *march);
/* By `update` of a law with n_state numbers, point by point in memory. */
LawStatus march_by_update(LawUpdate update, PetscInt n_state, PetscBool plane, const PetscReal *parameters, PetscInt n,
                          const LawMarch *march);

/* A material of a case: a law with its packed parameters. */
typedef struct {
  const char *name;
  const Law *law;
  PetscReal density; /* kg/m3 */
  Elasticity elastic;
  /* lambda + 2 mu, Pa: the P-wave modulus, for time scales and stabilisation */
  PetscReal wave_modulus;
  PetscReal given[LAW_MAX_PARAMETERS]; /* the user's, in SI units, angles in radians */
  PetscReal parameters[LAW_MAX_PARAMETERS];
  PetscBool mixed;      /* is the pressure an unknown of its own? then the following count: */
  VolumeLaw volume;     /* how the mixed formulation takes the law apart */
  PetscReal compliance; /* 1 / K, 1/Pa: 0 if exactly incompressible */
  /* where points move through cells: which number of the state, from 1, is its plastic strain; 0: none */
  PetscInt flow;
  /* the parameters with K = G, where the mean stress is taken away again */
  PetscReal deviatoric[LAW_MAX_PARAMETERS];
} Material;

/* All laws, ended by NULL: the house's, and those that the command line loads (plugin/plugin.h). */
extern const Law *laws[];
const Law *law_find(const char *name);
/* One more, which stays ours; there is room for LAW_MAX_LOADED. */
void law_register(const Law *law);

/* Resolve materials[index] of the case; mistakes go to diag with their paths. */
PetscErrorCode MaterialResolve(const Case *c, PetscInt index, Diag *diag, Material *material);
/* The same with the factors that its amplitudes have at time t; what is wrong with them MaterialResolve has
 * said before. */
PetscErrorCode MaterialAt(const Case *c, PetscInt index, PetscReal t, Diag *diag, Material *material);
/* All of its constants but elastic ones and the density become those of the same material at another time. Elastic
 * ones of a law that says itself how stiff it is are those on which its moduli depend. */
void material_take_strength(Material *material, const Material *other);
/* Have both the same law and elastic constants, so that states of one are states of the other? */
PetscBool material_as_stiff(const Material *a, const Material *b);
/* Is the tangent symmetric? strength_varies: also with c and tan phi over any factor, where psi may stay behind phi. */
PetscBool material_symmetric(const Material *material, PetscBool strength_varies);
/* Divide the strength of a material by factor (0: it does not yield); that of the case is factor 1. */
void material_reduce(Material *material, PetscReal factor);
/* Tell all of them of the step that is tried; dt = 0: there is none. inertia: is time what clocks show, or, as in
 * statics, a load's? */
void materials_step(PetscInt n, Material *materials, PetscReal time, PetscReal dt, PetscBool inertia);
/* Law.passed from one state to another, 0 without a table; what is more than TABLE_PASSED is told. Undrained triaxial
 * compression that hardens and softens, to five times its peak strain: q is off by 3 % with steps of all of the way to
 * the peak, and by 0.3 % with a tenth. */
#define TABLE_PASSED 0.5
PetscReal material_passed(const Material *material, const PetscReal *before, const PetscReal *state);
/* lambda + 2 mu, Pa, of a mixed formulation, too: infinite where incompressible. */
PetscReal material_confined(const Material *material);
/* The same with a Poisson's ratio of 0.3 at most: what opposes a change of shape, however little volumes change. */
PetscReal material_sheared(const Material *material);
/* Can any of them lose its stiffness? */
PetscBool materials_yield(PetscInt n, const Material *materials);
/* The same before there are any, of the laws that are known. */
PetscBool specs_yield(PetscInt n, const MaterialSpec *specs);
/* Write the initial state of one point, n_state numbers. */
void law_initial_state(const Law *law, PetscReal *state);
