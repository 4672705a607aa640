/* The case: what a user asked for, as plain validated data. No YAML, no PETSc objects.
 *
 * SI units; angles in radians here (degrees in files). Names that the program looks up in a
 * registry (law, method) stay strings: this room knows no other. Strings and arrays belong to the
 * case. */
#pragma once
#include "case/kinematics/kinematics.h"
#include "case/spec/amplitude.h"
#include "case/spec/analysis.h"
#include "case/spec/body.h"
#include "case/spec/contact.h"
#include "case/spec/grid.h"
#include "case/spec/load.h"
#include "case/spec/measure.h"
#include "case/spec/motion.h"
#include "case/spec/numerics.h"
#include "case/spec/output.h"
#include "case/spec/shape.h"

/* A file that a case reads besides itself. */
typedef struct {
  char *key;  /* where the case names it: grid.mesh */
  char *path; /* absolute */
} CaseFile;

typedef struct Case {
  char *file;   /* as the user named it */
  char *folder; /* where it stands, "." at least: relative names start here */
  char *title;
  const Kinematics *kinematics;
  char *method;
  char *formulation; /* "displacement", "mixed" */
  MixedSpec mixed;
  AnalysisSpec analysis;
  InitialSpec initial;
  GridSpec grid;
  PetscInt n_bodies;
  BodySpec *bodies;
  PetscInt n_materials;
  MaterialSpec *materials;
  PetscInt n_boundary;
  MotionSpec *boundary;
  PetscInt n_walls;
  WallSpec *walls;
  PetscInt n_interfaces;
  InterfaceSpec *interfaces;
  PetscReal gravity[3];
  Amplitude gravity_amplitude;
  PetscInt n_loads;
  LoadSpec *loads;
  PetscInt n_measures;
  MeasureSpec *measures;
  NewtonSpec newton;
  LinearChoice linear;
  BasisSpec basis;
  StabilisationSpec stabilisation;
  OutputSpec output;
  CheckpointSpec checkpoint;
  ParallelSpec parallel;
  PetscInt n_petsc; /* options of the petsc: block, in order: "-name value" */
  char **petsc;
  PetscInt n_files; /* each once; of a case with stages those that its stages name are with these */
  CaseFile *files;
  StrengthSpec strength;
  PetscInt n_stages; /* 0: the case is what is run */
  StageSpec *stages;
  struct Case **stage_case; /* of each: the case with the words of the stages so far */
  PetscInt n_columns;       /* of a case with stages: measures of all of them, each name once */
  const MeasureSpec **columns;
  /* of a stage: */
  PetscInt stage;           /* its number, 0 for the first; 0 of a case without stages */
  const StageSpec *spec;    /* NULL: the case is no stage */
  PetscBool seeks;          /* does any stage seek a factor of safety or a limit load? */
  PetscBool staged;         /* has it stages, or is it one? */
  const char *transfer_why; /* words that go on behind a transfer that it did not name; else NULL */
  PetscBool damps_clouds;   /* has it Bossak's alpha of clouds in which a law yields, without having named it? */
  PetscReal start;          /* when it began, s */
  PetscReal release;        /* s over which what is out of balance at the start fades; 0: at once */
} Case;

/* The case of stage k; of a case without stages the case itself. */
const Case *case_stage(const Case *c, PetscInt k);
PetscInt case_stages(const Case *c); /* 1 without stages */
/* Measures of the whole run, as the columns of its history have them: those of all stages, each name once, in
 * the order in which they come (columns.c). */
PetscInt case_columns(const Case *c);
const MeasureSpec *case_column(const Case *c, PetscInt k);
PetscInt case_column_of(const Case *c, const char *name);  /* its index, -1: there is none */
PetscInt case_measure_of(const Case *c, const char *name); /* likewise, among the measures of c itself */
/* Does the wall meet the body of that name? */
PetscBool case_wall_meets(const WallSpec *wall, const char *body);
/* When all stages are read: which bodies later ones take away, or bring to a wall, and whose motion begins with one. */
void case_tell_changes(Case *c);
/* When all stages are read; case_columns are those of c alone before. */
PetscErrorCode CaseCollectColumns(Case *c);
/* Does it start from a state that is there? Not the first stage of a case that names no run. */
PetscBool case_goes_on(const Case *c);
/* The stage is about to begin, at start[c->stage]; start: of all stages so far, s. From now on all its
 * times are those of the run. */
void case_begin(Case *c, const PetscReal *start);

/* Where load k stands in the case: loads.tractions[0], loads.points[2]... Returns path. */
const char *case_load_path(const Case *c, PetscInt k, char path[64]);
/* Loads but for those that wait for a later stage, which stand behind these. */
PetscInt case_acting_loads(const Case *c);
/* Does a load that acts follow the surface that it acts on? */
PetscBool case_load_follows(const Case *c);
/* Is the pressure an unknown beside the displacements? */
PetscBool case_is_mixed(const Case *c);
/* Of a wall or an interface. */
PetscBool case_has_contact(const Case *c, ContactKind kind);
PetscBool case_dilates(const Case *c); /* has any material a dilatancy angle? */
/* Is the strength of a body divided, by a search or from the start? Of material i, as that of such a body? */
PetscBool case_reduces(const Case *c, const BodySpec *body);
PetscBool case_reduces_material(const Case *c, PetscInt i);
/* Equilibrium at every step, no inertia: a factor of safety is found so, too. Else there is inertia. */
PetscBool case_is_static(const AnalysisSpec *analysis);
/* Explicit dynamics: share of the critical step that is taken. musl bears all of it, usl two thirds (docs/theory.md,
 * "Explicit dynamics"). Springs of contact that are stiffer than cells want a smaller one. */
PetscReal case_courant(const AnalysisSpec *analysis);
#define CONTACT_MARGIN 0.8 /* of the stiffness that a substep bears */
/* The same of what `update` bears as musl bears 1. */
PetscReal case_courant_of_musl(const AnalysisSpec *analysis);
/* Is something sought after `end`, when all loads are on: a factor of safety, a limit load? */
PetscBool case_seeks(const AnalysisSpec *analysis);
/* What a clock shows at time t of a run. While something is sought none goes on: behind `end` what steps are counted by
 * is a factor, and no time. */
PetscReal case_time(const Case *c, PetscReal t);
/* Is that one of the fields of states? */
PetscBool case_writes(const Case *c, const char *field);
/* Is what is raised a prescribed displacement, of a boundary or of a wall, and no force? */
PetscBool case_raises_displacement(const Case *c);
/* That displacement. */
const MotionSpec *case_raised_motion(const Case *c);
/* Is that the amplitude of what is raised to its limit? */
PetscBool case_raises(const Case *c, const Amplitude *amplitude);
/* The axis that gravity is nearest to; without any the last. */
PetscInt case_height_axis(const Case *c);
PetscBool case_has_stress(const Case *c); /* does any body start with one? */
/* Is an equilibrium sought before its first step? Of stages that of the first. */
PetscBool case_equilibrates(const Case *c);
/* The factor at time t on a parameter of material i, or on its "density": 1 without an amplitude. */
PetscReal case_material_factor(const Case *c, PetscInt i, const char *parameter, PetscReal t);
/* Does gravity act from the start: is there a stress that carries weight, or an equilibrium with it? */
PetscBool case_starts_with_gravity(const Case *c);

/* Do the two bodies meet at an interface? Its index, or -1; *first: is body a its first one? */
PetscInt case_interface(const Case *c, PetscInt a, PetscInt b, PetscBool *first);
PetscInt case_body(const Case *c, const char *name); /* its index; the name is one of the bodies' */
/* The velocity field of a body: the lowest one without a body before it that it meets at an interface;
 * and how many there are. Bodies of one field stick to each other where they share nodes. */
PetscInt case_field(const Case *c, PetscInt body);
PetscInt case_fields(const Case *c);
/* Does an entry of the boundary take nodes of that velocity field? */
PetscBool case_takes_field(const Case *c, const MotionSpec *entry, PetscInt field);

/* It reads this file, too; one that is known stays as it is. */
PetscErrorCode CaseAddFile(Case *c, const char *key, const char *path);
PetscErrorCode CaseDestroy(Case **c);

/* Value at time t of what is applied: without an amplitude it grows with pseudo-time in statics and
 * stands at once in dynamics. */
PetscReal case_factor(const Case *c, const Amplitude *amplitude, PetscReal t);

/* What a table gives factors of: it matters what forces do within a step; of a place or a parameter, what it is at the
 * step's end; prescribed velocities are integrated. */
typedef enum { TABLE_FORCE, TABLE_PLACE, TABLE_SPEED, TABLE_PARAMETER } TableUse;
typedef void (*TableVisit)(void *context, const Amplitude *table, TableUse use, const char *path);
/* Each table over time of what is there, but for that of what is raised to its limit (tables.c). */
void case_visit_tables(const Case *c, TableVisit visit, void *context);
/* The first time after t at which one of these tables turns, s; PETSC_MAX_REAL if none does. */
PetscReal case_corner_after(const Case *c, PetscReal t);
/* Of a table of that use, do its values at the ends of steps count, and no others? */
PetscBool case_counts_at_ends(const AnalysisSpec *a, TableUse use);
/* A step from t to `until`, or its part up to the peak of such a table that it would pass by, by a twentieth of the
 * table's largest size: its end, s. */
PetscReal case_peak_within(const Case *c, PetscReal t, PetscReal until);
/* Has a load that acts a factor whose formula names t? Where such a formula turns nobody knows. */
PetscBool case_has_timed_factor(const Case *c);
/* Does any of them begin to change between t and `until`, both counted, having stood still before? */
PetscBool case_begins_within(const Case *c, PetscReal t, PetscReal until);
