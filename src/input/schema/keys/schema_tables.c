/* The keys at the top of the case file, and those of the smaller blocks. The order of the lines is
 * the order of reading, writing and of the reference. */
#include "formulation/formulation.h"
#include "input/schema/keys/schema_keys.h"
#include "material/law.h"
#include "method/method.h"
#include "method/transfer/transfer.h"

static const SchemaWord analysis_words[] = {
  {"static", ANALYSIS_STATIC, "equilibrium at every step, no inertia"},
  {"dynamic", ANALYSIS_DYNAMIC, "Newmark in time, with inertia"},
  {"explicit", ANALYSIS_EXPLICIT,
   "dynamic without equations to solve: steps shorter than waves need to cross a cell, for mpm"},
  {"factor-of-safety", ANALYSIS_FACTOR, "static; all loads on, strength is divided until nothing balances any more"},
  {"limit-load", ANALYSIS_LIMIT, "static; all loads on, one of them is raised until nothing more holds"},
  {NULL, 0, NULL},
};
static const SchemaWord mass_words[] = {
  {"consistent", MASS_CONSISTENT, "of the shape functions; lumped in cells that are not full, see stabilisation.mass"},
  {"lumped", MASS_LUMPED, "all of it at the nodes: more Newton steps converge where grains flow, rotations lose more"},
  {NULL, 0, NULL},
};
static const SchemaWord unheld_words[] = {
  {"refuse", UNHELD_REFUSE, "a mistake: the body could be anywhere"},
  {"hold", UNHELD_HOLD,
   "held in as few directions of nodes as make the answer the only one, which bear nothing: loads must be in balance"},
  {NULL, 0, NULL},
};
static const SchemaWord update_words[] = {
  {"musl", EXPLICIT_MUSL,
   "by the velocities that the points give the nodes after the step: quiet where points leave cells"},
  {"usl", EXPLICIT_USL,
   "by the velocities of the balance of momentum, in shorter substeps: for bodies along the grid's lines, since nodes "
   "of little mass shake what they strain"},
  {NULL, 0, NULL},
};
static const SchemaWord linear_words[] = {
  {"auto", LINEAR_AUTO, "chosen from the problem: its size, dimension, law and step"},
  {"direct", LINEAR_DIRECT, "factorisation"},
  {"iterative", LINEAR_ITERATIVE, "Krylov method with a preconditioner"},
  {NULL, 0, NULL},
};

/* --- analysis --- */
static const SchemaEntry until_entries[] = {
  KEY("measure", REFERENCE, NULL, "a name from `measures`", .target = "measures", REQUIRED, AT(UntilSpec, measure)),
  KEY("below", NUMBER, NULL, "its value has fallen below this, in its unit", TAG(UNTIL_BELOW), AT(UntilSpec, value)),
  KEY("above", NUMBER, NULL, "its value has risen above this", TAG(UNTIL_ABOVE), AT(UntilSpec, value)),
  KEY("count", INTEGER, NULL, "so many events are over, of a measure that counts some", AT_LEAST(1), TAG(UNTIL_COUNT),
      AT(UntilSpec, count)),
  KEY("for", NUMBER, "s", "and has stayed there for so long", .fallback = "0", AT_LEAST(0), AT(UntilSpec, duration)),
  KEY("after", NUMBER, "s",
      "what is before this time does not matter; a step that goes past it may cross the value anywhere",
      .fallback = "0", AT_LEAST(0), AT(UntilSpec, after)),
  {.key = NULL},
};
static const SchemaTable until = {
  .name = "until",
  .help =
    "What ends a run before `end`. A value falls below another, or rises above it, only if it was not there before: "
    "what starts from rest is not over at once.",
  .entries = until_entries,
  .groups = schema_one_tag,
  .size = sizeof(UntilSpec),
  .tag_offset = offsetof(UntilSpec, kind),
  .check = SchemaCheckUntil};

static const SchemaEntry reduction_entries[] = {
  KEY("from", NUMBER, NULL, "the first factor that is tried", .fallback = "1", ABOVE(0), AT(ReductionSpec, from)),
  KEY("step", NUMBER, NULL, "from one factor to the next, until one has failed", .fallback = "0.1", ABOVE(0),
      AT(ReductionSpec, step)),
  KEY("tolerance", NUMBER, NULL, "width of the bracket at which the search ends, over the factor", .fallback = "0.005",
      .bounded = PETSC_TRUE, .min = 0, .min_open = PETSC_TRUE, .max = 0.5, AT(ReductionSpec, tolerance)),
  KEY("most", NUMBER, NULL, "what stands with this factor is not tried any further", .fallback = "10", ABOVE(0),
      AT(ReductionSpec, most)),
  KEY("bodies", REFERENCES, NULL,
      "bodies whose strength is divided, with the friction and adhesion of what they meet: walls and other bodies",
      .note = "all", .target = "bodies", AT(ReductionSpec, bodies), .count = offsetof(ReductionSpec, n_bodies)),
  {.key = NULL},
};
static const SchemaTable reduction = {.name = "reduction",
                                      .help = "Of a factor of safety: the factors that are tried.",
                                      .entries = reduction_entries,
                                      .check = SchemaCheckReduction};

static const SchemaEntry limit_entries[] = {
  KEY("raise", TEXT, NULL,
      "what is raised from zero when all other loads are on: `gravity`, the name of a load, or of an entry of "
      "boundary or a wall with a `displacement`, whose force is the load then; an `amplitude` of its own has no effect",
      REQUIRED, AT(LimitSpec, raise)),
  KEY("step", NUMBER, NULL, "the first increment: of the load's factor while it is small, or of the displacement's",
      .fallback = "0.02", ABOVE(0), AT(LimitSpec, step)),
  KEY("tolerance", NUMBER, NULL,
      "the load is the limit if it has grown by no more than this, over itself, while the displacement doubled",
      .fallback = "0.005", .bounded = PETSC_TRUE, .min = 0, .min_open = PETSC_TRUE, .max = 0.5,
      AT(LimitSpec, tolerance)),
  KEY("most", NUMBER, NULL, "factor of the load, or of the displacement, beyond which nobody looks",
      .note = "1 of a displacement, 1000 of a load", ABOVE(0), AT(LimitSpec, most)),
  KEY("steps", INTEGER, NULL, "the search ends after so many of them, found or not", .fallback = "1000", AT_LEAST(1),
      AT(LimitSpec, steps)),
  {.key = NULL},
};
static const SchemaTable limit = {
  .name = "limit", .help = "Of a limit load: what is raised, and when it is enough.", .entries = limit_entries};

static const SchemaEntry analysis_entries[] = {
  KEY("type", WORD, NULL, "static, dynamic, or what is sought", .words = analysis_words, REQUIRED,
      AT(AnalysisSpec, type)),
  KEY("reduction", TABLE, NULL, "factor-of-safety: the factors that are tried", .table = &reduction, ALWAYS,
      AT(AnalysisSpec, reduction)),
  KEY("limit", TABLE, NULL, "limit-load: what is raised", .table = &limit, AT(AnalysisSpec, limit)),
  KEY("end", NUMBER, "s",
      "time at the end of the run; factor-of-safety, limit-load: when all loads are on, and clocks stop",
      .note = "static: 1", ABOVE(0), AT(AnalysisSpec, end)),
  KEY("until", LIST, NULL, "any of these ends the run earlier", .table = &until, AT(AnalysisSpec, until),
      .count = offsetof(AnalysisSpec, n_until)),
  KEY("steps", INTEGER, NULL,
      "number of equal steps up to the end; in statics those after a shorter one come back to their times",
      .note = "static: 1, if `step` is not given", AT_LEAST(1), INPUT_ONLY, AT(AnalysisSpec, step)),
  KEY("step", NUMBER, "s", "the first step, and the largest one unless `largest` says otherwise", ABOVE(0),
      AT(AnalysisSpec, step)),
  KEY("smallest", NUMBER, "s", "the run gives up when a step has to be smaller", .note = "step / 1024", ABOVE(0),
      AT(AnalysisSpec, smallest)),
  KEY("largest", NUMBER, "s",
      "steps grow up to this after easy ones, and end where amplitudes turn; not while a `factor` of t acts",
      .note = "step", ABOVE(0), AT(AnalysisSpec, largest)),
  KEY("travel", NUMBER, NULL,
      "steps larger than `step` carry no point farther than this share of the smallest cell; 0: as far as it goes",
      .fallback = "0.3", AT_LEAST(0), AT(AnalysisSpec, travel)),
  KEY(
    "courant", NUMBER, NULL,
    "explicit: share of the critical step that is taken; within `step`, which the history and measures see, there are "
    "as many as that needs",
    .note = "0.8; with `update: usl` 0.3", .bounded = PETSC_TRUE, .min = 0, .min_open = PETSC_TRUE, .max = 1,
    AT(AnalysisSpec, courant)),
  KEY("update", WORD, NULL, "explicit: what strains the points", .words = update_words, .fallback = "musl",
      AT(AnalysisSpec, update)),
  KEY("contact_stiffness", NUMBER, NULL,
      "explicit: springs of walls and interfaces, over the stiffness of a cell; what is pressed gives way by so much "
      "less of a cell, and beyond 1.7 substeps are so much shorter: 1.3, 1.6, 2, 2.7 times with 3.6, 5.6, 9.2, 17",
      .fallback = "1", .bounded = PETSC_TRUE, .min = 1, .max = 1000, AT(AnalysisSpec, contact)),
  KEY("scheme", TEXT, NULL, "time scheme of dynamics",
      .note = "newmark; with bossak: bossak; with basis gimp and transfer consistent: midpoint",
      AT(AnalysisSpec, scheme)),
  KEY("beta", NUMBER, NULL, "Newmark parameter", .note = "0.25; with bossak (1 - bossak)^2 / 4", .bounded = PETSC_TRUE,
      .min = 0, .max = 1, .min_open = PETSC_TRUE, AT(AnalysisSpec, beta)),
  KEY("gamma", NUMBER, NULL, "Newmark parameter", .note = "0.5; with bossak 0.5 - bossak", BETWEEN(0, 1),
      AT(AnalysisSpec, gamma)),
  KEY("bossak", NUMBER, NULL, "Bossak's alpha: damps high frequencies",
      .note = "0; gmm in each stage in which a law yields, unless scheme, beta or gamma are given: -0.1",
      BETWEEN(-1. / 3., 0), AT(AnalysisSpec, bossak)),
  KEY("damping", NUMBER, "1/s", "Rayleigh damping proportional to the mass of bodies; walls with mass have none",
      .fallback = "0", AT_LEAST(0), AT(AnalysisSpec, damping)),
  KEY("mass", WORD, NULL, "mass matrix", .words = mass_words, .fallback = "consistent", AT(AnalysisSpec, mass)),
  KEY("transfer", WORD_TEXT, NULL, "mpm: what nodes take of the points' motion, see `talus list transfers`",
      .registry = (const void *const *)transfers,
      .note = "consistent where no law yields and nothing rubs; else thesis, and with basis gimp and bspline where "
              "scheme midpoint does not go (mixed, bossak, beta, gamma); with friction consistent in explicit steps, "
              "and with basis bspline",
      AT(AnalysisSpec, transfer)),
  KEY(
    "keep_velocity", BOOLEAN, NULL,
    "mpm: points beside prescribed nodes keep the velocity that they bring, as thesis (2.16) is printed, so that what "
    "slides over a floor slides on; otherwise they take over the motion of these nodes",
    .fallback = "false", AT(AnalysisSpec, keep_velocity)),
  KEY("unheld", WORD, NULL, "static: bodies that nothing holds in some direction (or, for `hold`, from turning)",
      .words = unheld_words, .fallback = "refuse", AT(AnalysisSpec, unheld)),
  {.key = NULL},
};
static const SchemaGroup analysis_groups[] = {{GROUP_AT_MOST_ONE, {"steps", "step", NULL}}, {GROUP_NONE, {NULL}}};
static PetscBool hide_in_analysis(const SchemaEntry *e, const void *source)
{
  const AnalysisType type = ((const AnalysisSpec *)source)->type;
  if (!strcmp(e->key, "unheld")) return type != ANALYSIS_STATIC;
  if (!strcmp(e->key, "limit")) return type != ANALYSIS_LIMIT;
  if (!strcmp(e->key, "courant") || !strcmp(e->key, "update") || !strcmp(e->key, "contact_stiffness"))
    return type != ANALYSIS_EXPLICIT;
  return !strcmp(e->key, "reduction") && type != ANALYSIS_FACTOR;
}

static const SchemaTable analysis = {.name = "analysis",
                                     .help = "Statics or dynamics, and the steps in time.",
                                     .entries = analysis_entries,
                                     .groups = analysis_groups,
                                     .check = SchemaCheckAnalysis,
                                     .hide = hide_in_analysis};

/* --- materials --- */
static const SchemaEntry material_entries[] = {
  KEY("law", WORD_TEXT, NULL, "the constitutive law, see `talus list laws`", .registry = (const void *const *)laws,
      REQUIRED, AT(MaterialSpec, law)),
  KEY("density", NUMBER, "kg/m3", "mass per volume of the body as it begins, with the stress that it has then",
      REQUIRED, ABOVE(0), AT(MaterialSpec, density)),
  KEY("amplitude", AMPLITUDES, NULL,
      "factors on parameters over time: {cohesion: [[0, 1], [10, 0.5]]}, linear between, density and elastic constants "
      "too; of a stage: times count from its start. Stresses stay when elastic constants change",
      AT(MaterialSpec, amplitudes), .count = offsetof(MaterialSpec, n_amplitudes)),
  {.key = NULL},
};
static const SchemaTable material = {
  .name = "material",
  .help = "A law with its constants: any two elastic constants, and the parameters of the law.",
  .entries = material_entries,
  .size = sizeof(MaterialSpec),
  .open = SchemaOpenMaterial,
  .write_open = SchemaWriteMaterial};

/* --- solver and output --- */
static const SchemaEntry newton_entries[] = {
  KEY("residual", NUMBER, NULL, "relative to the largest force met; below 1e-8 gaps of contacts shrink with it",
      .fallback = "1e-8", AT_LEAST(0), AT(NewtonSpec, residual)),
  KEY("residual_absolute", NUMBER, "N", "a residual below this is converged in any case", .fallback = "0", AT_LEAST(0),
      AT(NewtonSpec, residual_absolute)),
  KEY("increment", NUMBER, NULL, "relative to the displacement of the step", .fallback = "1e-10", AT_LEAST(0),
      AT(NewtonSpec, increment)),
  KEY("increment_absolute", NUMBER, "m", "an increment below this is converged in any case", .fallback = "0",
      AT_LEAST(0), AT(NewtonSpec, increment_absolute)),
  KEY("max_iterations", INTEGER, NULL, "then the step is halved", .fallback = "25", AT_LEAST(1),
      AT(NewtonSpec, max_iterations)),
  KEY("ease", INTEGER, NULL, "a step with at most so many iterations lets the next one grow", .fallback = "6",
      AT_LEAST(0), AT(NewtonSpec, ease)),
  {.key = NULL},
};
static const SchemaTable newton = {
  .name = "newton", .help = "When the Newton iteration has converged.", .entries = newton_entries};

static const SchemaEntry stabilisation_entries[] = {
  KEY("stiffness", NUMBER, NULL, "share of the material's stiffness that empty parts of cells keep", .fallback = "1e-6",
      AT_LEAST(0), AT(StabilisationSpec, stiffness)),
  KEY("curvature", NUMBER, NULL,
      "basis gimp, in place of `stiffness`: share of the material's stiffness against curvature where points hardly "
      "reach a node",
      .note = "0.01; in dynamics 0.1 with transfer consistent; in statics without stages and pressures 1e-3, 1e-4 if a "
              "law yields",
      AT_LEAST(0), AT(StabilisationSpec, curvature)),
  KEY(
    "follow", NUMBER, NULL,
    "basis gimp and bspline: a node with less than this of half its share of the cells follows those inside the body, "
    "as a linear function does; where it cannot, `curvature` holds it; with gimp those that loads on a body's surface "
    "act on follow below 0.1 in any case",
    .note = "0.02; in a case without stages 0 in dynamics, 0.3 with transfer consistent if no law yields, "
            "0.1 in statics if one does",
    BETWEEN(0, 1), AT(StabilisationSpec, follow)),
  KEY("mass", NUMBER, NULL, "share of the mass that is lumped at the nodes, times the empty part of the cell",
      .note = "1 if a law of the case yields; else 0.1, with transfer consistent 0.3, and 0 with basis gimp",
      BETWEEN(0, 1), AT(StabilisationSpec, mass)),
  KEY("inertia", NUMBER, NULL,
      "share of the mass that resists what moves the nodes of a cell apart, times its empty part",
      .note = "0.01 if a law of the case yields, 0 if all are elastic", BETWEEN(0, 1), AT(StabilisationSpec, inertia)),
  KEY(
    "room", BOOLEAN, NULL,
    "mpm, not mixed: what flows keeps to the room that the grid has around its points. Denser than its volume allows "
    "it is "
    "pressed "
    "apart; grains with `opening_memory` are no farther apart, and J no larger, than there is room for. So flows that "
    "go far or on for long neither shrink nor, with that memory, swell",
    .fallback = "false", AT(StabilisationSpec, room)),
  {.key = NULL},
};
static const SchemaTable stabilisation = {
  .name = "stabilisation", .help = "What keeps cells solvable that are not full.", .entries = stabilisation_entries};

static const SchemaEntry mixed_entries[] = {
  KEY("stabilisation", NUMBER, NULL,
      "alpha: pressures that vary inside a cell are held by alpha / shear modulus, in what flows through the cells of "
      "mpm without a change of volume by up to 16 times that; 0: off",
      .fallback = "2", AT_LEAST(0), AT(MixedSpec, stabilisation)),
  {.key = NULL},
};
static const SchemaTable mixed = {
  .name = "mixed", .help = "Numbers of `formulation: mixed`; others have no use for them.", .entries = mixed_entries};

static const SchemaEntry output_entries[] = {
  KEY("fields", FIELDS, NULL,
      "fields to write, see `talus list fields`; what points of a loaded law keep, too (docs/plugin.md)",
      .fallback = "[displacement, velocity, stress]", AT(OutputSpec, fields), .count = offsetof(OutputSpec, n_fields)),
  KEY("every", EVERY, NULL, "when states are written: a step ends there, and the last two before it are shorter for it",
      .fallback = "end", AT(OutputSpec, every)),
  KEY("history", EVERY, NULL,
      "when rows of history.csv are written, as `every`; what is a mean over a step in dynamics (forces of walls, "
      "interfaces and boundaries, tractions) is in a row the mean since the row before, with `end` over the whole run, "
      "and a formula is that of the row's numbers; what a run ends with in the log, in `talus verify` and in sweeps is "
      "of its last step",
      .fallback = "{steps: 1}", AT(OutputSpec, history)),
  KEY("grid", BOOLEAN, NULL, "write the fields of the grid too", .fallback = "true", AT(OutputSpec, grid)),
  KEY(
    "walls", BOOLEAN, NULL,
    "of a case with walls: write their surfaces (walls_*.hdf), and the places that touch them with the tractions there "
    "(contact_*.hdf, for ParaView and `talus plot --profile`)",
    .fallback = "true", AT(OutputSpec, walls)),
  {.key = NULL},
};
static const SchemaTable output = {.name = "output", .help = "What is written, and when.", .entries = output_entries};

static const SchemaEntry checkpoint_entries[] = {
  KEY("steps", INTEGER, NULL, "after so many steps; 0: not by steps", .fallback = "0", AT_LEAST(0),
      AT(CheckpointSpec, steps)),
  KEY("minutes", NUMBER, "min", "after so many minutes of the clock; 0: not by the clock", .fallback = "10",
      AT_LEAST(0), AT(CheckpointSpec, minutes)),
  KEY("keep", INTEGER, NULL, "how many are kept, the newest ones", .fallback = "2", AT_LEAST(1),
      AT(CheckpointSpec, keep)),
  {.key = NULL},
};
static const SchemaTable checkpoint = {.name = "checkpoint",
                                       .help = "When the whole state is put away, for `talus run --resume`.",
                                       .entries = checkpoint_entries};

static const SchemaEntry parallel_entries[] = {
  KEY("imbalance", NUMBER, NULL,
      "largest work of a rank over the mean at which mpm shares the grid, box or mesh, among the ranks anew; 0: never",
      .fallback = "1.2", AT_LEAST(0), AT(ParallelSpec, imbalance)),
  {.key = NULL},
};
static const SchemaTable parallel = {
  .name = "parallel", .help = "How several ranks share the work.", .entries = parallel_entries};

/* --- what is there before the first step --- */
static const SchemaWord equilibrium_words[] = {
  {"none", EQUILIBRIUM_NONE, "the first step finds what it may"},
  {"direct", EQUILIBRIUM_DIRECT, "with the laws as they are"},
  {"elastic-plastic", EQUILIBRIUM_ELASTIC_FIRST,
   "first as if nothing yielded (modified-cam-clay does), then with the strength that there is"},
  {NULL, 0, NULL},
};
static const SchemaEntry initial_entries[] = {
  KEY(
    "equilibrium", WORD, NULL,
    "before the first step forces come to balance under gravity and loads as they are at t = 0, without inertia: from "
    "the initial stress of the bodies (k0, stress), or from none, which is gravity loading. What was lacking is told",
    .words = equilibrium_words,
    .note = "statics, and the mixed formulation, with an initial stress: direct (gmm seeks none), else none",
    AT(InitialSpec, equilibrium)),
  KEY("reset_displacement", BOOLEAN, NULL,
      "what moves on the way to this equilibrium is forgotten: bodies keep the shape that they are given, and only "
      "their stresses change",
      .note = "true with an initial stress", AT(InitialSpec, reset)),
  KEY(
    "run", FILE, NULL,
    "or the stresses, places and velocities of another run in this directory, of the same bodies by their names: time, "
    "displacements and accounts begin anew. Points of mpm go onto any grid, walls, interfaces and loads on bodies "
    "apart; fem needs the same one",
    AT(InitialSpec, run)),
  KEY("stage", TEXT, NULL, "of that run: the end of this stage", .note = "the last state", .with = "run",
      AT(InitialSpec, stage)),
  RELEASE(InitialSpec, .with = "run"),
  {.key = NULL},
};
static const SchemaTable initial = {.name = "initial",
                                    .help = "The state before the first step, besides `k0` and `stress` of the bodies.",
                                    .entries = initial_entries};

/* --- the whole file --- */
static const SchemaEntry case_entries[] = {
  KEY("title", TEXT, NULL, "a line for people; it may be empty", .fallback = "", AT(Case, title)),
  KEY("kinematics", MEMBER, NULL, "dimension and symmetry", .registry = (const void *const *)kinematics_list, REQUIRED,
      AT(Case, kinematics)),
  KEY("method", WORD_TEXT, NULL, "numerical method", .registry = (const void *const *)methods, REQUIRED,
      AT(Case, method)),
  KEY("formulation", WORD_TEXT, NULL, "unknowns of the equations", .registry = (const void *const *)formulations,
      .fallback = "displacement",
      .note = "displacement; where a factor of safety or a limit load is sought, in any of the stages, mean-dilatation "
              "in boxes of quadrilaterals and hexahedra, mixed elsewhere",
      AT(Case, formulation)),
  KEY("mixed", TABLE, NULL, "numbers of the mixed formulation", .table = &mixed, ALWAYS, AT(Case, mixed)),
  KEY("analysis", TABLE, NULL, "statics or dynamics, steps", .table = &analysis, REQUIRED, AT(Case, analysis)),
  KEY("initial", TABLE, NULL, "equilibrium before the first step", .table = &initial, ALWAYS, AT(Case, initial)),
  KEY("grid", TABLE, NULL, "background grid or mesh", .table = &schema_grid, REQUIRED, AT(Case, grid)),
  KEY("bodies", LIST, NULL, "pieces of material", .table = &schema_body, REQUIRED, AT(Case, bodies),
      .count = offsetof(Case, n_bodies)),
  KEY("materials", NAMED, NULL, "laws with their constants", .table = &material, REQUIRED, AT(Case, materials),
      .count = offsetof(Case, n_materials)),
  KEY("boundary", LIST, NULL, "prescribed motion", .table = &schema_motion, AT(Case, boundary),
      .count = offsetof(Case, n_boundary)),
  KEY("walls", LIST, NULL, "rigid walls anywhere in the grid", .table = &schema_wall, AT(Case, walls),
      .count = offsetof(Case, n_walls)),
  KEY("interfaces", LIST, NULL, "bodies that meet other bodies, and slide and part", .table = &schema_interface,
      AT(Case, interfaces), .count = offsetof(Case, n_interfaces)),
  KEY("loads", TABLE, NULL, "gravity and forces", .table = &schema_loads, ALWAYS),
  KEY("measures", NAMED, NULL, "numbers followed through the run", .table = &schema_measure, AT(Case, measures),
      .count = offsetof(Case, n_measures)),
  KEY("newton", TABLE, NULL, "convergence", .table = &newton, ALWAYS, AT(Case, newton)),
  KEY("linear", WORD, NULL, "linear solver", .words = linear_words, .fallback = "auto", AT(Case, linear)),
  KEY("basis", TABLE, NULL, "shape functions; `gimp` for `{gimp: {}}`, and so on", .table = &schema_basis, ALWAYS,
      SPELLED, AT(Case, basis)),
  KEY("stabilisation", TABLE, NULL, "cells that are not full", .table = &stabilisation, ALWAYS,
      AT(Case, stabilisation)),
  KEY("output", TABLE, NULL, "what is written", .table = &output, ALWAYS, AT(Case, output)),
  KEY("checkpoint", TABLE, NULL, "state to resume from", .table = &checkpoint, ALWAYS, AT(Case, checkpoint)),
  KEY("parallel", TABLE, NULL, "load balance", .table = &parallel, ALWAYS, AT(Case, parallel)),
  KEY("strength", TABLE, NULL, "strength divided by a factor", .table = &schema_strength, AT(Case, strength)),
  KEY("stages", LIST, NULL, "one after another, each from the state of the one before", .table = &schema_stage,
      AT(Case, stages), .count = offsetof(Case, n_stages)),
  KEY("petsc", OPTIONS, NULL,
      "options of PETSc that choose solvers, set tolerances or print on the terminal: {snes_monitor: true, ksp_type: "
      "cg}; all others go on the command line",
      AT(Case, petsc), .count = offsetof(Case, n_petsc)),
  {.key = NULL},
};
/* Nothing divides the strength unless somebody asks for it. */
static PetscBool hide_in_case(const SchemaEntry *e, const void *source)
{
  const Case *c = source;
  return !strcmp(e->key, "strength") && c->strength.factor == 0 && c->strength.beyond_failure == 0;
}
const SchemaTable schema_case = {
  .name = "case", .help = "The keys at the top of the file.", .entries = case_entries, .hide = hide_in_case};
