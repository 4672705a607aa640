/* The case: what a user asked for, as plain validated data. No YAML, no PETSc objects.
 *
 * SI units; angles in radians here (degrees in files). Names that the program looks up in a
 * registry (law, method) stay strings: this room knows no other. Strings and arrays belong to the
 * case. */
#pragma once
#include "case/kinematics/kinematics.h"

typedef enum { ANALYSIS_STATIC, ANALYSIS_DYNAMIC, ANALYSIS_FACTOR, ANALYSIS_LIMIT, ANALYSIS_EXPLICIT } AnalysisType;
/* Which velocity of the nodes strains the points of explicit dynamics: that which the points have given them anew
 * at the end of a step, or that of the balance of momentum. */
typedef enum { EXPLICIT_MUSL, EXPLICIT_USL } ExplicitUpdate;
typedef enum { MASS_CONSISTENT, MASS_LUMPED } MassMatrix;
typedef enum { UNHELD_REFUSE, UNHELD_HOLD } UnheldKind;
typedef enum { CELL_TRIANGLE, CELL_QUADRILATERAL, CELL_TETRAHEDRON, CELL_HEXAHEDRON } CellType;
typedef enum { DIAGONAL_RIGHT, DIAGONAL_LEFT, DIAGONAL_ALTERNATING, DIAGONAL_CROSSED } Diagonal;
typedef enum { OUTSIDE_STOP, OUTSIDE_REMOVE, OUTSIDE_KEEP } OutsidePolicy;
typedef enum { LINEAR_AUTO, LINEAR_DIRECT, LINEAR_ITERATIVE } LinearChoice;
typedef enum { WEIGHTS_AUTO, WEIGHTS_EQUAL, WEIGHTS_GAUSS } PointWeights;
typedef enum { FILL_AUTO, FILL_CELLS, FILL_SHAPE } BodyFill;

/* A function of time, linear between its entries and constant outside them. n = 0: not given. */
typedef struct {
  PetscInt n;
  PetscReal *time, *value;
  PetscInt since;   /* stage of the case whose words brought it, */
  PetscReal origin; /* when that began, s: times count from there */
} Amplitude;

typedef enum {
  SHAPE_BOX,
  SHAPE_BALL,
  SHAPE_POLYGON,
  SHAPE_HALF_SPACE,
  SHAPE_UNION,
  SHAPE_DIFFERENCE,
  SHAPE_INTERSECTION,
  SHAPE_CYLINDER,
  SHAPE_CONE,
  SHAPE_TERRAIN,
  /* of walls alone: */
  SHAPE_LINE,
  SHAPE_ARC,
  SHAPE_DISK,
  SHAPE_REVOLVED,
  SHAPE_SURFACE
} ShapeKind;

/* A set of positions. A difference is its first child without all the others. */
typedef struct Shape {
  ShapeKind kind;
  PetscReal min[3], max[3];      /* box */
  PetscReal centre[3], radius;   /* ball: a circle in 2D */
  PetscReal point[3], normal[3]; /* half-space: all x with (x - point) . normal <= 0 */
  PetscInt n_vertices;           /* polygon, 2D, closed by itself; line */
  PetscReal *vertices;           /* n_vertices x 2; revolved: radius and height */
  /* cylinder, cone, revolved: the axis begins at `point` and goes `length` along `normal` */
  PetscReal radii[2], length; /* of both ends; disk: of its hole and its rim */
  PetscReal angle[2];         /* arc: from, to, counter-clockwise from x, in degrees (as in files) */
  PetscBool open;             /* revolved, surface: thin, without an inside */
  char *file, *group;         /* surface: STL or .msh, and a physical group of it or NULL; terrain: .asc */
  PetscReal scale, offset[3]; /* of what the file gives: x = scale X + offset, m */
  struct Relief *relief;      /* terrain: what the file gives */
  PetscInt n_children;
  struct Shape *children;
} Shape;

typedef struct {
  char *name;
  PetscReal value;
} NamedValue;

typedef enum { GRID_BOX, GRID_MESH } GridKind;

typedef struct {
  GridKind kind;
  CellType cell;
  Diagonal diagonal;
  PetscReal min[3], max[3];
  PetscInt counts[3];    /* cells along each axis, resolved from `size` or `counts` */
  PetscReal grading[3];  /* size of the last cell over the first along each axis, 1 = uniform */
  char *mesh;            /* .msh or .geo, resolved against the folder of the case */
  PetscInt n_parameters; /* numbers handed to a .geo */
  NamedValue *parameters;
  OutsidePolicy outside;
  /* may a .geo run programs and write files? Said on the command line, never in the case file */
  PetscBool trusted;
} GridSpec;

typedef struct {
  char *name;
  Amplitude amplitude;
} NamedAmplitude;

typedef struct {
  char *name;
  char *law;
  PetscReal density;     /* kg/m3, of the undeformed body */
  PetscInt n_parameters; /* as the file gives them; the law resolves them */
  NamedValue *parameters;
  PetscInt n_amplitudes; /* factors on parameters, or on the density, over time */
  NamedAmplitude *amplitudes;
} MaterialSpec;

typedef struct {
  char *name, *material;
  PetscBool has_shape;
  Shape shape;
  char *region; /* a physical group of the grid's mesh, or NULL */
  char *mesh;   /* a mesh of its own that only seeds points, or NULL */
  PetscInt points_per_cell;
  PointWeights weights;
  BodyFill fill;                     /* whole cells, or what of them lies in the shape */
  PetscReal velocity[3];             /* initial: v + spin x (x - centre) */
  PetscReal spin[3], spin_centre[3]; /* rad/s; 2D uses spin[2] */
  /* geostatic: sigma_v of the material above, sigma_h = k0 sigma_v */
  PetscBool has_k0;
  PetscReal k0;
  /* or given: formulas of x y z, depth and weight for xx yy zz xy yz zx; those not given are NULL: 0 */
  PetscBool has_stress;
  char *stress[6];
  PetscBool has_surface;
  /* height against gravity at which the user believes the material to end, m: only compared */
  PetscReal surface;
  PetscBool absent; /* not yet, or no more: a stage places and removes */
  PetscBool leaves; /* does a later stage take it away? */
} BodySpec;

/* Where something acts: every condition given must hold. */
typedef struct {
  PetscBool has[3];
  PetscReal min[3], max[3]; /* m; x: 0 gives min = max */
  /* a physical group of the mesh, or left right bottom top front back of a box */
  char *boundary;
  char *body; /* for loads on a body: its boundary */
  PetscBool has_shape;
  Shape shape;
} Selector;

typedef enum { MOTION_FIXED, MOTION_DISPLACEMENT, MOTION_VELOCITY, MOTION_ROTATION } MotionKind;

/* The normal of a wall, beside the axes 0 1 2. */
#define NORMAL 3

/* Prescribed motion of the nodes selected. Components not in `component` stay free. */
typedef struct {
  Selector on;
  PetscBool moves; /* does the place `on` take part in the motion, on a grid that is restored? */
  MotionKind kind;
  PetscBool component[4];             /* x y z; NORMAL: nodes slide along the wall that they stand in */
  PetscReal value[3];                 /* m or m/s, times the amplitude */
  PetscReal centre[3], axis[3], rate; /* rotation, rad/s (times the amplitude) */
  Amplitude amplitude;
  char *name; /* for measures and messages; NULL if it has none */
  PetscBool absent;
} MotionSpec;

typedef enum { CONTACT_FRICTIONLESS, CONTACT_FRICTION, CONTACT_STICK, CONTACT_BONDED } ContactKind;

/* What moves a wall that has mass: what it touches, its weight, and a load at its centre. */
typedef struct {
  PetscBool has_density, has_total, has_centre, has_inertia;
  PetscReal density;              /* kg/m3 */
  PetscReal total;                /* or the mass, kg, in the plane of a metre of depth */
  PetscReal centre[3];            /* of mass, at the start, m */
  PetscReal inertia[3];           /* about the centre and the axes, kg m2; in the plane [2] */
  PetscReal velocity[3], spin[3]; /* at the start, m/s, rad/s */
  PetscBool gravity;              /* does it weigh anything? */
  PetscBool free[4];              /* x y z, rotation; none given: all that the kinematics have */
  PetscReal force[3], torque[3];  /* at the centre, N, N m */
  Amplitude amplitude;            /* of force and torque */
} WallMassSpec;

/* A rigid body that material meets anywhere in the grid: it does not go into it. */
typedef struct {
  char *name;
  Shape shape;         /* where the wall is, */
  PetscBool inside;    /* or where it is not: a container */
  PetscReal thickness; /* of a shape without an inside, m */
  PetscInt n_motions;
  MotionSpec *motions; /* each moves what those before it have made; `on` is empty */
  PetscReal from;      /* s; the wall stands after it, if it is not 0, */
  PetscBool has_until;
  PetscReal until;   /* and up to this time */
  PetscInt n_bodies; /* 0: all */
  char **bodies;     /* that meet it */
  ContactKind contact;
  PetscReal friction; /* tangent of the angle of friction */
  PetscReal adhesion; /* N/m2: tangential stress beside friction */
  PetscBool has_mass; /* does it move by what acts on it? */
  WallMassSpec mass;
  PetscInt since; /* stage whose words brought it: from and until count from its start */
  PetscBool absent;
} WallSpec;

/* How bodies meet that do not stick to each other: the second is to the first what a wall is. */
typedef struct {
  char *name; /* NULL if it has none */
  PetscInt n_between;
  char **between; /* two bodies */
  ContactKind contact;
  PetscReal friction; /* tangent of the angle of friction */
  PetscReal adhesion; /* N/m2: tangential stress beside friction */
} InterfaceSpec;

typedef enum { LOAD_TRACTION, LOAD_POINT, LOAD_PRESSURE, LOAD_KINDS } LoadKind;

typedef struct {
  char *name; /* NULL if it has none */
  LoadKind kind;
  Selector on;        /* traction, pressure: boundary faces of the grid, or of a body (carried by it) */
  PetscReal at[3];    /* point load: the material position at the start */
  PetscReal value[3]; /* N/m2 of undeformed boundary, or N; pressure: value[0], N/m2 of the present one */
  Amplitude amplitude;
  char *factor; /* a formula of LoadPlace that multiplies the value; NULL: 1 */
} LoadSpec;

/* What the formula of a load may name: x y z, where the material is when the step begins, X Y Z, where
 * it was undeformed (m), and t, s. */
typedef struct {
  PetscInt dim;
  const PetscReal *X, *x;
  PetscReal t;
} LoadPlace;

/* Of a Formula whose context is a LoadPlace. */
PetscErrorCode LoadPlaceValue(void *place, const char *name, PetscBool *known, PetscReal *value);

typedef enum { FRONT_POINTS, FRONT_SURFACE } FrontKind;

/* When a powder slides: more energy of motion, relative to its container, than a threshold. */
typedef struct {
  PetscBool has_container;
  PetscInt container; /* index into boundary[]: the prescribed motion that carries the powder */
  /* over the energy while it creeps, or of moving with the container if that is more; 0: not given */
  PetscReal times;
  PetscReal kinetic; /* or J */
  PetscReal creep;   /* s over which the energy while it creeps is averaged */
  PetscReal ends;    /* low threshold over the high one */
  PetscReal fades;   /* share of its peak below which an event may be over, too */
  PetscReal calm;    /* s that it must stay there */
  PetscReal from;    /* no event before, s */
  PetscReal carried; /* what moved farther than this has taken part, m; 0: one cell */
  PetscReal least;   /* kg that must have taken part */
} AvalancheSpec;

typedef struct {
  char *name;
  char *kind;         /* a measure's key, "energy" (model/measure) */
  char *word;         /* and one of its words, "kinetic"; NULL if it has none */
  PetscInt component; /* 0 1 2 */
  PetscBool maximum;  /* extent, run-out time: max, else min */
  PetscReal beyond;   /* extent: share of the mass that is left out */
  PetscBool advance;  /* extent: from where it was at the start, outwards */
  PetscBool has_tracer;
  PetscReal tracer[3]; /* material position of the tracer at the start */
  char *body;          /* NULL: all */
  PetscInt boundary;   /* reaction: index into boundary[] of the case */
  char *wall;          /* by its name */
  char *interface;     /* likewise */
  PetscBool has_at;
  PetscReal at;    /* x, m */
  PetscReal speed; /* run-out time: a slower front has come to rest, m/s */
  FrontKind front; /* run-out time: whose front */
  PetscBool has_in;
  Shape in; /* only what lies in it */
  PetscBool has_about;
  PetscReal about[3]; /* centre of a container, m */
  PetscReal middle;   /* share of the chord of a free surface that a line is fitted to; 0: usual */
  /* change per time, or mean: over the last window[0] s, or with window[0] < window[1] between two times */
  PetscBool has_rate, has_mean;
  PetscReal window[2];
  AvalancheSpec avalanche;
  PetscInt since; /* stage whose words brought it: it begins there */
} MeasureSpec;

typedef enum { UNTIL_BELOW, UNTIL_ABOVE, UNTIL_COUNT } UntilKind;

/* What ends a run before its end. */
typedef struct {
  UntilKind kind;
  char *measure;      /* by its name */
  PetscReal value;    /* of the measure, in its unit: below, above */
  PetscInt count;     /* of its events */
  PetscReal duration; /* s for which that must hold */
  PetscReal after;    /* s before which it does not matter */
} UntilSpec;

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

typedef struct {
  PetscReal residual, residual_absolute;   /* relative to the largest force met; N */
  PetscReal increment, increment_absolute; /* relative to the step's displacement; m */
  PetscInt max_iterations;
  PetscInt ease; /* a step that needs at most so many iterations lets the next grow */
} NewtonSpec;

typedef enum { ORDER_LINEAR, ORDER_BILINEAR, ORDER_QUADRATIC } BasisOrder;
typedef enum { WEIGHT_GAUSSIAN, WEIGHT_CUBIC_SPLINE } BasisWeight;
typedef enum { CLOUD_CHOICE_ADAPTIVE, CLOUD_CHOICE_NEAREST, CLOUD_CHOICE_FIXED } CloudChoice;
typedef enum { ESSENTIAL_AUTO, ESSENTIAL_DIRECT, ESSENTIAL_CONSTRAINTS } EssentialKind;

/* Shape functions, most numbers of clouds of nodes (gmm). Lengths are over the cell size of the
 * grid that gives the nodes. */
typedef struct {
  const char *kind;     /* one of basis_names[] (support/basis.h); NULL: the cell */
  PetscBool by_default; /* the case does not name it */
  CloudChoice choice;
  PetscReal radius;     /* of a cloud */
  PetscReal max_radius; /* that it may grow to */
  PetscReal condition;  /* of a basis that needs no more nodes */
  PetscInt minimum;     /* least number of nodes; 0: what the basis needs */
  /* nodes farther apart do not belong to the same material; 0: no limit */
  PetscReal gap;
  PetscReal effective_radius; /* mls: dilation of the weight function */
  BasisOrder order;           /* mls */
  BasisWeight weight;         /* mls */
  PetscReal gamma;            /* lme: locality, beta = gamma / h^2 */
  PetscReal split;            /* gimp: points whose neighbours stand farther away are split, cells; 0: never */
  EssentialKind essential;
} BasisSpec;

typedef struct {
  PetscReal stiffness, mass, inertia; /* see docs/theory.md, cells that are not full */
  PetscReal curvature;                /* see docs/theory.md, smooth shape functions */
  PetscReal follow;                   /* see docs/theory.md, nodes that follow */
  PetscBool room;                     /* see docs/theory.md, the room that points have */
} StabilisationSpec;

typedef struct {
  PetscReal stabilisation; /* of the pressure, alpha: the term is alpha / G */
} MixedSpec;

typedef struct {
  PetscInt n_fields;
  char **fields;
  PetscReal every;   /* s between states; 0: only the end; < 0: every |every| steps */
  PetscReal history; /* the same for history.csv; -1: every accepted step */
  PetscBool grid;    /* write the grid's fields too */
  PetscBool walls;   /* and walls, with what touches them */
} OutputSpec;

/* When the state is put away so that a run can go on after an accident. */
typedef struct {
  PetscInt steps;    /* after so many steps; 0: not by steps */
  PetscReal minutes; /* after so much time of the clock; 0: not by the clock */
  PetscInt keep;     /* how many checkpoints are kept */
} CheckpointSpec;

/* How the work is shared among the ranks. */
typedef struct {
  /* the largest share of a rank over the mean at which the grid is shared anew; 0: never */
  PetscReal imbalance;
} ParallelSpec;

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
/* When all stages are read: which bodies later ones take away. */
void case_tell_leaving(Case *c);
/* When all stages are read; case_columns are those of c alone before. */
PetscErrorCode CaseCollectColumns(Case *c);
/* Does it start from a state that is there? Not the first stage of a case that names no run. */
PetscBool case_goes_on(const Case *c);
/* The stage is about to begin, at start[c->stage]; start: of all stages so far, s. From now on all its
 * times are those of the run. */
void case_begin(Case *c, const PetscReal *start);

/* Where load k stands in the case: loads.tractions[0], loads.points[2]... Returns path. */
const char *case_load_path(const Case *c, PetscInt k, char path[64]);
/* Does a load follow the surface that it acts on? */
PetscBool case_load_follows(const Case *c);
/* Is the pressure an unknown beside the displacements? */
PetscBool case_is_mixed(const Case *c);
/* Of a wall or an interface. */
PetscBool case_has_contact(const Case *c, ContactKind kind);
PetscBool case_dilates(const Case *c); /* has any material a dilatancy angle? */
/* Equilibrium at every step, no inertia: a factor of safety is found so, too. Else there is inertia. */
PetscBool case_is_static(const AnalysisSpec *analysis);
/* What `bossak` asks for, and whether the case has others. */
PetscReal analysis_usual_beta(const AnalysisSpec *analysis);
PetscReal analysis_usual_gamma(const AnalysisSpec *analysis);
PetscBool analysis_tunes_newmark(const AnalysisSpec *analysis);
/* Explicit dynamics: share of the critical step that is taken. musl bears all of it, usl two thirds (docs/theory.md,
 * "Explicit dynamics"). Springs of contact that are stiffer than cells want a smaller one. */
PetscReal case_courant(const AnalysisSpec *analysis);
#define CONTACT_MARGIN 0.8 /* of the stiffness that a substep bears */
/* The same of what `update` bears as musl bears 1. */
PetscReal case_courant_of_musl(const AnalysisSpec *analysis);
/* Is something sought after `end`, when all loads are on: a factor of safety, a limit load? */
PetscBool case_seeks(const AnalysisSpec *analysis);
/* Is that one of the fields of states? */
PetscBool case_writes(const Case *c, const char *field);
/* Is what is raised a prescribed displacement, of a boundary or of a wall, and no force? */
PetscBool case_raises_displacement(const Case *c);
/* That displacement. */
const MotionSpec *case_raised_motion(const Case *c);
/* Is that the amplitude of what is raised to its limit? */
PetscBool case_raises(const Case *c, const Amplitude *amplitude);
/* Does the body start with a stress? Does any? */
PetscBool body_has_stress(const BodySpec *body);
PetscBool case_has_stress(const Case *c);
/* The factor at time t on a parameter of material i, or on its "density": 1 without an amplitude. When
 * something is sought (case_seeks), time ends for materials with `end`. */
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

PetscErrorCode CaseDestroy(Case **c);

/* Value at time t; `fallback` if the amplitude was not given. */
PetscReal amplitude_value(const Amplitude *amplitude, PetscReal t, PetscReal fallback);
/* Value at time t of what is applied: without an amplitude it grows with pseudo-time in statics and
 * stands at once in dynamics. */
PetscReal case_factor(const Case *c, const Amplitude *amplitude, PetscReal t);
/* Integral over [0, t], for prescribed velocities. */
PetscReal amplitude_integral(const Amplitude *amplitude, PetscReal t, PetscReal fallback);
/* Has the shape an inside? (Lines, arcs, disks and open surfaces have none.) */
PetscBool shape_is_solid(const Shape *shape);
/* Is x (2 or 3 coordinates) in the shape? Its surface belongs to it, within `tolerance` m. Not for
 * shapes of walls alone. */
PetscBool shape_contains(const Shape *shape, PetscInt dim, const PetscReal *x, PetscReal tolerance);
/* How deep below the surface x lies, m, `most` at most; 0: it lies outside. */
PetscReal shape_depth(const Shape *shape, PetscInt dim, const PetscReal *x, PetscReal most);
/* Smallest box around the shape; unbounded sides are +-PETSC_MAX_REAL. */
void shape_bounds(const Shape *shape, PetscInt dim, PetscReal min[3], PetscReal max[3]);
