/* What the files of this room share. */
#pragma once
#include "model/model.h"

/* Put the case's PETSc options into the database, and take them out again. */
PetscErrorCode OptionsApply(Model *model);
PetscErrorCode OptionsCheck(const Model *model, Diag *diag);
PetscErrorCode OptionsForget(Model *model);
/* Collective. Space with its nodal fields, and the system's flags, for the grid that is now. */
PetscErrorCode ModelCreateFields(Model *model);
PetscErrorCode ModelDestroyFields(Model *model);
/* Work of a cell that holds points, in points: its share of matrix, solver and nodes. */
PetscReal cell_work(CellType type);
/* Collective. Share the grid anew if that is worth it: before a step. */
PetscErrorCode ModelBalance(Model *model, StepReport *report);
/* Collective. Move everything over to `grid`, which is the model's grid shared in another way and
 * becomes its own; the next ModelInitialise is the first of the space. *moved: points of this rank
 * that left it. */
PetscErrorCode ModelRegrid(Model *model, Grid *grid, PetscInt *moved);
/* Is it a case of what a prescribed displacement presses down until the ground gives way? */
PetscBool model_is_pressed(const Model *model);
/* step/guess.c. Does the node have inertia of its own: do points touch it, and is it no twin of another? */
PetscBool node_moves(const Model *model, PetscInt node);
/* step/guess.c. From where Newton may start: as inertia alone would bring, like the step before, from
 * rest. */
typedef enum { GUESS_INERTIA, GUESS_PREVIOUS, GUESS_REST, GUESS_GRIPPED, GUESS_N } FirstGuess;

/* Does it know the increments of the step before? */
PetscBool guess_follows(const Model *model);
/* The first guesses that the next step has, the nearest first. */
PetscInt guess_order(const Model *model, FirstGuess order[GUESS_N]);
/* One of them for a step of dt. */
void guess_make(const Model *model, FirstGuess guess, PetscReal dt, PetscReal *du);
/* Collective. A step of dt is accepted: which guess would have been nearer? Before points move. */
PetscErrorCode GuessLearn(Model *model, PetscReal dt);
PetscErrorCode GuessToTables(Model *model, Tables *tables);
/* let_go.c. Collective. Choose anew at time t the nodes of places that move, of a grid that is restored. */
PetscErrorCode ModelMovePlaces(Model *model, PetscReal t);
/* A step is accepted: what the scheme remembered has acted in it on nodes let go, and echoes (accept.c). */
void let_go_settle(Model *model, const TimeWeights *weights);
/* Collective. The force of an entry of the boundary over the last step, N. */
PetscErrorCode ModelReaction(const Model *model, PetscInt entry, PetscReal sum[3]);
PetscErrorCode LetGoToTables(const Model *model, Tables *tables);
PetscErrorCode LetGoFromTables(Model *model, const Tables *tables, char reason[256]);
void guess_from_tables(Model *model, const Tables *tables, char reason[256]);
/* Collective. The system for the cells that are enabled, or for a cloud as it is now. */
PetscErrorCode ModelEnable(Model *model);
/* Collective. Geostatic stress of bodies that ask for it, as their law's state: of the material
 * inside the outline that is above them. */
PetscErrorCode InitialStress(Model *model, const Outline *outline, Diag *diag);
/* Collective. Tell points whose law is nonlocal the mean of what is around them (nonlocal.c). */
PetscErrorCode NonlocalStep(Model *model);
/* Collective, after ModelInitialise. Points hear of the room that they have; what that makes, J, is numerical
 * (step/prepare.c). */
PetscErrorCode ModelRoom(Model *model, PetscReal *made);
/* Tell the law of point p, if it has a length, the size of the cell in which the point starts (start/laws.c). */
void size_start(const Model *model, PetscInt p);
/* Smallest and largest of these sizes in each body, m, on this rank: 2 n_bodies, all 0 before. */
void sizes_of_bodies(const Model *model, PetscReal *range);
/* Tell the laws that ask for it where their points start. */
void places_start(const Model *model);
/* The same before a step, of laws that ask where their points are now. */
void places_step(const Model *model);
/* Complain of methods, formulations, bases, time schemes and transfers that do not go together (start/supported.c). */
void supported_check(const Model *model, Diag *diag);
/* Complain where `stabilisation.room` means nothing (start/laws.c). */
void room_check(const Model *model, Diag *diag);
/* Collective. Complain of a value of `basis: {gimp: {split: ...}}` that means nothing, or too much (start/split.c). */
PetscErrorCode SplitCheck(const Model *model, Diag *diag);
/* Complain of bodies whose law needs a stress and has none (start/laws.c). */
void stresses_check(const Model *model, Diag *diag);
/* What it says of body b. */
void stress_tell_none(const Case *c, PetscInt b, const Law *law, Diag *diag);
/* equilibrium.c. Mistakes of a case that asks for one. */
void equilibrium_check(const Model *model, Diag *diag);
/* Does everything stay where it is, and only stresses change? */
PetscBool equilibrium_stays(const Model *model);
/* Forces before anything moves, in the frames: n_nodes x dim, N, owners count. */
typedef struct {
  const unsigned char *fixed;
  const PetscReal *force;    /* of the stress, less the external ones */
  const PetscReal *external; /* loads, and what walls, interfaces and constraints give */
  const PetscReal *acting;   /* loads alone, pressures too */
  PetscReal weight;          /* norm */
} AtRest;
/* Collective (start/lack.c). Forces out of balance at dofs that are not fixed over what acts there; where nothing does
 * (initial.acts), over what holds the others, walls and interfaces too; where nothing holds, over what the stress asks
 * of nodes. */
PetscErrorCode LackOfBalance(Model *model, const AtRest *at, PetscReal *lack);
/* What the stress of point p asks of its nodes, N. */
PetscReal stress_force(const Model *model, PetscInt p);
/* Collective. While it is sought: how much is lacking, and forces that hold what is to be taken away later. */
PetscErrorCode EquilibriumPrepare(Model *model, StepProblem *problem);
/* step/prepare.c. Velocity and acceleration, n_nodes x dim in the frames, with which the parabola through the middle
 * and the end of what is prescribed for the next dt begins; 0 at other dofs. */
PetscErrorCode PrescribedStart(const Model *model, PetscReal dt, PetscReal *v, PetscReal *a);
/* Acceleration now from the balance of momentum, so that a body in free fall falls from the first step on; of what is
 * prescribed that with which the first step begins. */
PetscErrorCode InitialAcceleration(Model *model);
/* Points' += the field of nodes', of the bodies for which that is asked; NULL: of all. */
void accelerate_points(const Model *model, const PetscBool *bodies, const PetscReal *a);
/* Collective. Accelerations that would balance what acts on nodes now, n_nodes x dim on all copies: held ones, and
 * contact as far as nodes remember it, are as they are. lacks: what such nodes lack, on owners, N; *size: of what
 * acts, N. All along the axes. */
PetscErrorCode BalancedAcceleration(Model *model, PetscReal *a, PetscReal *lacks, PetscReal *size);
/* In statics: what holds a given stress before the first step, where no equilibrium is sought. */
PetscErrorCode InitialReactions(Model *model);
/* contact/mass.c. Collective. The mass matrix that motion changes by in contact; nothing where that is the
 * lumped one. */
PetscErrorCode ContactMassCreate(const Model *model, ContactMass *mass);
PetscErrorCode ContactMassDestroy(ContactMass *mass);
/* forces.c. The body as nodal forces see it at time t, with increments du. */
NodalScene nodal_scene(const Model *model, PetscReal t, const PetscReal *du);
/* Collective. The list of nodal forces, made anew; diag NULL: mistakes were sought before. */
PetscErrorCode ForcesCreate(Model *model, Diag *diag);
PetscErrorCode ForcesToTables(const Model *model, Tables *tables);
PetscErrorCode ForcesFromTables(Model *model, const Tables *tables, char reason[256]);
/* Gravity times its amplitude at time t, m/s2. */
void gravity_at(const Case *c, PetscReal t, PetscReal g[3]);
/* Collective. Stress and stored energy of the points as the start of all work, and what measures
 * remember. */
PetscErrorCode EnergyStart(Model *model);
/* The stress of a point is what its law makes of its state. */
void energy_stress(Model *model, PetscInt p);
/* Measures of places that no point can reach are mistakes. */
void measures_check(const Model *model, Diag *diag);
PetscErrorCode MeasuresStart(Model *model);
PetscErrorCode MeasuresEnd(Model *model);
/* Collective. After every accepted step of dt, whether or not a row of the history is written. */
PetscErrorCode MeasuresRemember(Model *model, PetscReal dt);
/* Collective. Measure k begins now, and knows nothing of what was before. */
PetscErrorCode MeasureBegin(Model *model, PetscInt k);

/* followers.c. Collective. Once the model stands: nothing may follow a place that no material
 * carries. */
PetscErrorCode FollowersStart(Model *model, Diag *diag);
/* Collective. After every accepted step: what the material has left behind ends. */
PetscErrorCode FollowersEnd(Model *model);
/* outside.c. Do points that left the grid end the run? */
void outside_judge(const Model *model, StepReport *report);
/* Collective. Add up what the step did with points that left the grid. */
PetscErrorCode OutsideAdd(Model *model, StepReport *report);
/* Collective. A warning for each body that fills the grid to an edge where nothing holds it. */
PetscErrorCode OutsideWarn(const Model *model, Diag *diag);

/* limit_load.c. What cannot be raised is a mistake. */
void raised_start(Model *model, Diag *diag);
/* What a stage before has found stays known, until another one seeks. */
void raised_go_on(Model *model, const Model *before);
/* A warning where cells lock, once there is a grid. */
void raised_advise(const Model *model, Diag *diag);
/* Time at which loads have the size that they have at time t: at most `end`, and behind it by the factor of
 * a load that is raised, at the step's start and, later, where Newton's method has come to. */
PetscReal raised_time(const Model *model, PetscReal t);
/* Collective. Where a load is raised: its border of the step. dt: as in ModelRaise. */
PetscErrorCode RaisedPrepare(Model *model, PetscReal dt, StepProblem *problem);
/* stage/ageing.c. Materials are as strong as at time t, the end of a step, and as stiff and heavy as at its
 * start. */
PetscErrorCode MaterialsAt(Model *model, PetscReal t);
/* They are what they are now: of a model that goes on from a checkpoint, or whose step has failed. */
PetscErrorCode MaterialsBack(Model *model);
/* Collective. A step is accepted: they become as stiff and heavy as they are now; stresses stay. */
PetscErrorCode MaterialsSettle(Model *model, StepReport *report);
/* strength.c. Which materials are reduced; what cannot be is a mistake. */
void strength_start(Model *model, Diag *diag);
/* The factor that only the stage before knows. */
void strength_go_on(Model *model, const Model *before, Diag *diag);
/* Materials, and the factor in force, as they are when the strength is divided by it. */
void strength_set(Model *model, PetscReal factor);
/* Friction and adhesion of walls and interfaces likewise. */
void strength_of_contact(Model *model);
/* Collective. The largest increment of a node in the last step, or its last try, m. */
PetscErrorCode LargestIncrement(const Model *model, PetscReal *largest);
/* Does what has gone so far slide? Then report->leap says so. */
PetscBool strength_slides(Strength *s, PetscReal moved, StepReport *report);
/* Collective. Forces balance: but is it a body that stands, or one that has slid? */
PetscErrorCode StrengthJudge(Model *model, StepReport *report);

/* This rank's share of the energies of a step that is being accepted, J. */
typedef struct EnergyStep {
  PetscReal external, boundary, damped, transfer, friction, numerical, held, open;
} EnergyStep;

/* What a step changes although it is not accepted, besides v and a of the nodes. */
typedef struct {
  StepControl control;
  PetscInt cuts, iterations;
  Tries tries;
  NewtonMemory newton;
  PetscReal made; /* by the room that points have heard of, J */
} StepStart;

/* A step that is not accepted leaves nodes as they were; one that was interrupted never was. */
PetscErrorCode StepStartKeep(Model *model, StepStart *start);
PetscErrorCode StepStartRestore(Model *model, const StepStart *start, StepReport *report);
/* step/prepare.c. Collective. Which nodes have unknowns, on which ranks, and which are held; then
 * what a step changes before its solve. */
PetscErrorCode PrepareUnknowns(Model *model, StepStart *start, StepReport *report);
/* step/pseudo_time.c. Collective. The same of a step that Newton's method has lost in a search for the factor of
 * safety, after PrepareStep: converged is what rests; report->leap says of what slides or flows that it does.
 * newton.iterations: of all. */
PetscErrorCode PseudoTimeSolve(Model *m, StepProblem *p, const LinearProblem *linear, StepReport *report);
/* step/solve.c. Collective. The increments of a step of dt, or of halves of it: until Newton converges,
 * somebody interrupts it, or the step is too small. */
PetscErrorCode SolveStep(Model *model, PetscReal *dt, StepReport *report);
/* explicit/step.c. Collective. The whole step of explicit dynamics, of `limit` s at most. A step that fails
 * leaves the model where it failed. */
PetscErrorCode ExplicitStep(Model *model, PetscReal limit, StepReport *report);
PetscErrorCode ExplicitDestroy(struct Explicit **work);
/* What it cannot do is a mistake of the case. */
void explicit_check(const Model *model, Diag *diag);
/* Collective. As ModelBalance. */
PetscErrorCode ExplicitBalance(Model *model, StepReport *report);
/* Kinetic energy of this rank's points, and work of their stress, J. */
void energy_of_points(const Model *model, PetscReal energy[2]);
/* What the account begins with of what is there now, J; most_energy is not less than that with all work since. */
PetscReal energy_at_start(const Model *model);
void energy_note_most(Model *model);
/* step/accept.c. Before the new state is there (sign -1) and after: what it has more of plastic strain. */
void note_flow(Model *model, PetscReal sign);
/* step/entered.c. Collective. Whether parts of clouds that are strangers to each other have met (Model.entered). */
PetscErrorCode NoteEntered(Model *model);
/* step/accept.c. Collective. Points take over stress and history, and the boundary its forces. */
PetscErrorCode CommitStep(Model *model, PetscReal dt, EnergyStep *energy);
/* Collective. Points and nodes go where the solution leads them. */
PetscErrorCode ConvectStep(Model *model, PetscReal dt, EnergyStep *energy, StepReport *report);
/* Collective. shortened: was the accepted step made that short from outside, by the caller or (returning) to come back
 * to the times asked for? */
PetscErrorCode ChooseNextStep(Model *model, PetscBool shortened, PetscBool returning, const StepReport *report);

/* Of a cell: a gap within it is one of the digits in which places are written, or that steps leave. */
#define CONTACT_HAIR 1e-4
/* contact/start.c. Collective. Walls of the case, and what of the material touches them at the start. */
PetscErrorCode WallsStart(Model *model, Diag *diag);
/* Collective. Bonded is what touches as the wall comes, or as a body comes to it: any, on this rank? */
PetscErrorCode TellUntouched(const Model *model, PetscInt k, PetscBool any, Diag *diag);
/* Was the wall there before the stage, as it is now? */
PetscBool wall_stood(const WallSpec *wall, const Case *c, const Case *from);
/* Collective. Walls that a stage brings, or puts elsewhere, stand where no material is, and bodies that it brings in no
 * wall. */
PetscErrorCode WallsCome(Model *model, const Case *from, Diag *diag);
/* Collective. The step is refused (STEP_TOO_SMALL) where a wall appears amidst material. */
PetscErrorCode WallsAppear(const Model *model, StepReport *report);
/* contact/interfaces.c. Collective. What no interfaces can be made of, and bodies that go through each
 * other at the start. */
PetscErrorCode InterfacesStart(Model *model, Diag *diag);
/* Collective. What was made to fit touches exactly, after all that changes surfaces at the start. */
PetscErrorCode InterfacesSettle(Model *model);
/* Collective. One of the bodies of interface k has just come: where it was drawn to touch the other one, which has
 * settled since, it does, up to a tenth of a cell. */
PetscErrorCode InterfaceCloses(Model *model, PetscInt k);
struct Surface;
/* Collective. The surfaces (2) of the bodies of interface k where they are near each other: to be cleared. */
PetscErrorCode InterfaceSurfaces(const Model *model, PetscInt k, struct Surface *body);
/* Collective. Interfaces that are bonded from this stage on hold what touches. */
PetscErrorCode InterfacesBond(Model *model, const Case *from);
/* contact/bonds.c. Collective. And walls, too, which hold what comes with the stage from now on. */
PetscErrorCode BondsBegin(Model *model, const Case *from, Diag *diag);
/* Point p, at a distance `gap` (m) from its partner, is bonded if nothing presses it there (was) but it touches. */
void contact_bond(const Model *model, PetscInt p, const PetscReal normal[3], PetscReal gap, const PetscReal *was,
                  PetscReal *kept);
/* contact/rigid.c. What walls with mass cannot do; energies of theirs, J, the same on all ranks: of motion (of those
 * that are there; statics have none), and work of weight and loads since the start. away: of motion of those before
 * their `from`, and after their `until`. Nothing moves them, and the account has them from its start on: they are taken
 * off that (energy_at_start). */
void rigid_check(const Model *model, Diag *diag);
PetscReal rigid_motion(const Model *model);
PetscReal rigid_away(const Model *model);
PetscReal rigid_work(const Model *model);
/* What impulses took from them in the last step, J. */
PetscReal rigid_lost(const Model *model);
/* Back to the step's start. */
void rigid_back(Model *model);
/* Fastest of their centres, m/s. */
PetscReal rigid_fastest(const Model *model);
/* Collective. external += the forces of contact that material remembers, on owners: walls go on pressing as they did,
 * but for those that are gone. */
PetscErrorCode ContactGoOn(Model *model, PetscReal *external);
/* Collective. The same of what nodes remember of them as acceleration, of walls that are gone, too. */
PetscErrorCode ContactRemembered(Model *model, PetscReal *external);
/* Collective, after one of them: these forces are what walls give to the first acceleration. */
PetscErrorCode ContactBegin(Model *model, PetscBool remembered);
/* Collective. Another run's state: what walls and interfaces bear before the first step. */
PetscErrorCode ContactTell(Model *model);
/* Does a wall or an interface of the case rub? Then tangents are not symmetric. */
PetscBool contact_rubs(const Case *c);
/* Does a wall push along a normal that turns within steps? Of what has inertia its tangent is not symmetric then. */
PetscBool contact_turns(const Case *c);
/* Collective, in PrepareStep: what is in contact starts the step with the motion of its wall. */
PetscErrorCode ContactHold(Model *model, PetscReal dt, PetscReal inertia);
/* Collective. Likewise ends it, once v1 and a1 are known. */
PetscErrorCode ContactEnd(Model *model, PetscReal dt, struct EnergyStep *energy);
/* Does the scheme remember forces? One that balances them in the middle of the step does not, and lets nothing ring. */
PetscBool contact_holds(const Model *model);
/* Collective. Does anything touch, or has anything touched at the start of the step? */
PetscErrorCode ContactTouches(const Contact *contact, MPI_Comm comm, PetscBool *any);
/* release.c. Collective. After a step of dt: what walls' forces gave the acceleration beyond what stays is taken out
 * of what nodes remember. */
PetscErrorCode ContactRelease(Model *model, PetscReal dt);
/* Work of walls on the material in a step, J: of their motion; lost in sliding along them; of closing the
 * gap to them; half of that of the forces at the step's start; what of all this is more than the
 * trapezoidal rule gives. */
typedef struct {
  PetscReal moving, sliding, closing, start, more;
  PetscReal rigid; /* what of `moving` is that of walls with mass */
} ContactWork;

/* On this rank. */
ContactWork contact_work(const Model *model, PetscReal dt);
/* Collective, before the step is committed: mean forces of the step, and what is remembered. */
PetscErrorCode ContactForces(Model *model, PetscReal dt);
/* Collective. After the points' strain was committed: what measures ask of each wall. */
PetscErrorCode ContactSurvey(Model *model, PetscReal dt);
/* Collective. The same of the state that a first step begins with; contact points have its forces. */
PetscErrorCode ContactStand(Model *model);

/* Collective. The nodes know the step's end (force, v1, a1), the points still stand at its
 * start. */
PetscErrorCode EnergyOfNodes(Model *model, PetscReal dt, EnergyStep *step);
/* Collective. Work of what is out of balance at the start of that step, this rank's. g: gravity then; external: what
 * acts on nodes besides, NULL: nothing. */
PetscErrorCode UnbalancedWork(Model *model, PetscReal dt, const PetscReal *g, const PetscReal *external,
                              PetscReal *work);
/* Collective. Points have their new state and have moved: close the step's account. */
PetscErrorCode EnergyClose(Model *model, EnergyStep *step);
/* unloaded.c. Collective. After it: Model.kept_energy. */
PetscErrorCode NoteUnloaded(Model *model);
/* Nodal pressures of the step's start as unknowns; nothing without a mixed formulation. */
void pressure_guess(const Model *model);
/* Collective. Leave the cells: nodes that material fills or the boundary holds become a cloud, and
 * all that stood on the mesh moves over. */
PetscErrorCode ModelToCloud(Model *model);
/* Collective. Newton converged: unless the step is connected with the last state that is taken
 * back. */
PetscErrorCode JudgeStep(const Model *model, StepReport *report);
/* Collective. In statics each body must be held in all directions, by itself or by others that it touches. arrived: do
 * bodies stand where the case has them when it begins? Of a stage to come, and of a case that goes on from another run,
 * only what could not be held wherever they are is a mistake yet. */
PetscErrorCode CheckHeld(Model *model, PetscBool arrived, Diag *diag);
/* Collective. Of each body the directions in which something holds it, or (not arrived) may come to hold it (n_bodies x
 * dim, zero on entry). */
PetscErrorCode FindHeld(const Model *model, PetscBool arrived, PetscInt *held);
/* rests.c. Collective. A warning for each body whose weight nothing but friction along walls bears. */
PetscErrorCode AdviseRests(const Model *model, Diag *diag);
/* Loads out of balance, of the forces that there are: more than Newton's method leaves. */
#define UNHELD_BALANCE 1e-6
/* Likewise, of pressures on a surface whose parts go with points, and come to overlap and gape by that. */
PetscReal unheld_open_surface(const Model *model);
/* start/unheld.c. Collective. analysis.unheld: hold: once bodies have arrived (see CheckHeld) what nothing holds is
 * told, and a mistake where the loads of the first step push it. */
PetscErrorCode UnheldCheck(Model *model, PetscBool arrived, Diag *diag);
/* Collective. Otherwise: a mistake where nothing keeps a body from turning, in walls or sides that are smooth and
 * round, and loads leave it as it lies. */
PetscErrorCode UnheldTurning(Model *model, Diag *diag);
/* Collective. After mark_fixed, in each step: as few directions of nodes as hold it. */
PetscErrorCode UnheldHold(Model *model);
/* step/unheld_borne.c. Collective. Newton converged: goes on without those that keep the body from turning if they bear
 * anything, and has not converged if the others do. */
PetscErrorCode UnheldJudge(Model *model, StepProblem *problem, const LinearProblem *linear, StepReport *report);
/* Collective. body: n_nodes of the mesh, > 0 at nodes of a body, on all copies; beyond: n_owned, is it out of reach of
 * all material behind a face that is held in more directions than it is? */
PetscErrorCode CloudBeyondFaces(const Model *model, const PetscReal *body, unsigned char *beyond);
/* Collective. After the first step's clouds are known: tell which bodies hang on an obstacle from
 * the start. */
PetscErrorCode ModelWarnOfObstacles(const Model *model, Diag *diag);
/* limit.c. Collective. After every accepted step: how soft has the body become? */
PetscErrorCode LimitWatch(Model *model, PetscReal dt);
/* Collective. Add to the reason of a static run that gives up that it may be at a limit load, if it
 * looks like one. */
PetscErrorCode LimitDescribe(const Model *model, StepReport *report);
/* contact/slides.c. The same of a body that slides on all that it touches. */
PetscErrorCode ContactDescribe(const Model *model, StepReport *report);
/* Collective. Warnings of what a case asks for and its user hardly means: start/advice.c. */
PetscErrorCode ModelAdvise(const Model *model, Diag *diag);
/* Collective. The same of layers that share their cells, where strength is sought: start/thin.c. */
PetscErrorCode AdviseThin(const Model *model, Diag *diag);
/* own_mesh.c. Collective. The same of bodies' own meshes whose points do not add up to the cells of the grid; `outline`
 * is that of all bodies as they are seeded. */
PetscErrorCode AdviseOwnMeshes(Model *model, const Outline *outline, Diag *diag);
/* Collective. The same of amplitudes that do more within a step than at its ends: start/pulse.c. */
PetscErrorCode AdvisePulses(const Model *model, Diag *diag);
/* The same of walls and held nodes that jump when dynamics begin: start/jumps.c. */
void advise_jumps(const Model *model, Diag *diag);
/* The same of names and signs that mislead about which way is down: down.c. */
void advise_down(const Model *model, Diag *diag);
/* The same of prescribed nodes that stay while what they move passes them: passing.c. */
PetscErrorCode AdvisePassing(const Model *model, Diag *diag);
/* beside.c. Collective. The same of what is prescribed where no material is; once nodes know what touches them. */
PetscErrorCode AdviseBeside(const Model *model, Diag *diag);
/* Collective. An error where nothing determines the level of the pressure. */
PetscErrorCode CheckLevel(Model *model, Diag *diag);
/* hangs.c. Collective. The same of what holds a body only where one that it meets is held; at the start, and if nothing
 * was said then at the end of a run, which may have brought it there. */
PetscErrorCode AdviseHangs(Model *model, Diag *diag);
/* stairs.c. Collective. The same of bodies that meet across a slanting side made of whole cells. */
PetscErrorCode AdviseStairs(const Model *model, Diag *diag);
/* contact/astride.c. Collective. What a stage before has told of a wall is not told again. */
PetscErrorCode AstrideGoOn(Model *model, const Model *before);
/* held.c. Collective. Nodes (n_nodes) that the body touches, on all copies: 0 for the others. */
PetscErrorCode BodyTouches(const Model *model, PetscInt body, PetscReal *touched);
/* The same of a history of one row that holds means over the whole run: rows.c. */
PetscErrorCode AdviseRows(const Model *model, Diag *diag);
/* The same of what would begin after the end: late.c. */
void advise_late(const Model *model, Diag *diag);
/* cones.c. The same of laws whose strength in plane strain is not what their constants say. */
void advise_cones(const Model *model, Diag *diag);
/* cells.c. Collective. The same of cells whose points do not hold a uniform stress. */
PetscErrorCode AdviseCells(const Model *model, Diag *diag);
/* contact/interfaces.c. Collective. share[a * n_bodies + b]: body a has a node of the mesh that is b's as well, on any
 * rank; added to what is there. */
PetscErrorCode SharingPairs(const Model *model, int *share);
/* waves.c. Collective. The same of waves that the mixed formulation slows down. */
PetscErrorCode AdviseWaves(const Model *model, Diag *diag);
/* units.c. Collective. Warn of numbers that are no matter's in kg, m, s and Pa. */
PetscErrorCode AdviseUnits(const Model *model, Diag *diag);
/* Collective. The same of a drum that is not closed: start/drum.c. */
PetscErrorCode AdviseOpenDrum(const Model *model, Diag *diag);
/* Rayleigh damping, where there is inertia, 1/s. */
static inline PetscReal model_damping(const Model *m) { return m->scheme->inertia ? m->c->analysis.damping : 0; }
/* Input of the weak form for the model's present arrays. */
WeakFormInput weak_form_of(const Model *model, PetscReal inertia);
/* Prescribed dofs, and nodes with unknowns that no material touches. */
void mark_fixed(Model *model);
/* Collective. History, prescribed increments and loads for a step of dt; the first guess is to be
 * made. */
PetscErrorCode PrepareStep(Model *model, PetscReal dt, StepProblem *problem);
/* passed.c. Around the commit of a step; *before is theirs. */
PetscErrorCode PassedBegin(const Model *model, PetscReal **before);
PetscErrorCode PassedEnd(Model *model, PetscReal **before);
/* sway.c. Collective. Points are sorted, their displacements and stresses are those of one state: Model.sway. */
PetscErrorCode NoteSway(Model *model);
/* Collective. Norms over nodes that material touches: gravity g, the inertia force of stopping within a step of dt, and
 * that of the motion at its start. */
PetscErrorCode ForceScales(const Model *model, const PetscReal *g, PetscReal dt, StepProblem *problem);
