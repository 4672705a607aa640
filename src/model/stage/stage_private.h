/* What the files of this folder share. */
#pragma once
#include "model/model_private.h"
#include "model/stage/stage.h"

/* Collective. Points of the tables in place of those of bodies that were there, swapped where their material has
 * changed. onto: they come from another grid. */
PetscErrorCode TakePoints(Model *model, const Tables *tables, const Case *from, PetscBool onto, Diag *diag,
                          char reason[256]);
/* Was body b of the case not there in `from`? */
PetscBool body_comes(const Case *c, const Case *from, PetscInt b);
/* The index of its material. */
PetscInt body_material(const Case *c, PetscInt body);
/* bodies/arrive.c. Collective. Points of such bodies, in a mesh whose nodes stood at `drawn` (n_nodes x dim) when they
 * were seeded, fill their cells as they are now, but that nodes of nothing that goes on stand there again; cells that
 * have no room for them are mistakes. */
PetscErrorCode BodiesArrive(Model *model, const Case *from, const PetscReal *drawn, Diag *diag);
/* bodies/gaps.c. Collective. Warns of such bodies that begin above what they stand on, or in it: it has moved since it
 * was drawn. For grids whose nodes do not move, or do not join bodies. */
PetscErrorCode BodiesStand(const Model *model, const Case *from, Diag *diag);
/* clouds.c. Bodies, tracers and prescribed nodes that a cloud would have to take in or let go: as far as cases
 * tell. */
void clouds_check(const Case *c, const Case *from, Diag *diag);
/* Collective. Are the prescribed nodes those of the tables? */
PetscErrorCode CheckCloud(const Model *model, const Tables *tables, Diag *diag, char reason[256]);
/* rename.c. Which measure of the case before measure k of c goes on as; -1: none, it begins anew. */
PetscInt measure_before(const Case *c, PetscInt k, const Case *from);
/* Tables of a state of `from` under the names of the model's case. */
PetscErrorCode RenameTables(const Model *model, const Case *from, const Tables *tables);
/* Row k of the table becomes row was[k], n of them; < 0: zeros. NULL: there is no such table. */
PetscErrorCode PickRows(Table *table, PetscInt n, const PetscInt *was);
/* loads.c. Loads that the material would have to carry from now on. */
PetscErrorCode LoadsCheck(const Case *c, const Case *from, Diag *diag);
/* Does the case have loads that go with the material? */
PetscBool loads_are_carried(const Case *c);
/* Collective. Carriers of the tables, of loads that are still there. */
PetscErrorCode TakeCarriers(Model *model, const Tables *tables, const Case *from, char reason[256]);
PetscErrorCode RenameLoads(const Case *c, const Case *from, Table *ended);
/* begin.c. Before a state is taken those of `take` are put aside, and the others go; after it they follow what was
 * taken, if no reason speaks against it. */
PetscErrorCode PutAside(Points *points, PetscInt dim, const PetscBool *take, Points **begun);
PetscErrorCode PutBack(Points **begun, const char reason[256], Points *points);
/* Collective. Followers of measures in the tables, and those of measures that begin with the stage. */
PetscErrorCode TakeTracers(Model *model, const Tables *tables, const Case *from, char reason[256]);
/* Tracers of measures that begin with the stage, or with a run that goes on with the state of another one (from: NULL),
 * begin in material; on the rank that holds them. */
PetscErrorCode BeginTracers(Model *model, const Case *from, Diag *diag);
/* Collective, once all of the state stands. Measures that begin with the stage, or with a run that goes on with the
 * state of another one (from: NULL), begin with it. */
PetscErrorCode BeginMeasures(Model *model, const Case *from);
/* The stress of point p stays, in the state of another law or of other constants, and so do its place and its
 * shape; PETSC_FALSE: there is no such state. */
PetscBool point_swap(Points *points, PetscInt p, const Material *was, const Material *is);
/* Do velocities end with the stage, or mean nothing in it? */
PetscBool stands_still(const Model *model);
/* Collective. Velocities end where the case says so, or where they mean nothing: in statics. */
PetscErrorCode ResetMotion(Model *model, const Case *from, PetscBool next);
/* Collective. Accelerations of the balance where nothing moves; those that go on jump with what acts. */
PetscErrorCode BeginAcceleration(Model *model, const Case *from, const Tables *tables);
/* motion/walls.c. Walls with mass go on from where they were in the stage before, or begin. */
void walls_go_on(Model *model, const Model *before);
/* motion/jump.c. Do accelerations go on from the stage before, and jump with what acts? */
PetscBool accelerations_go_on(const Case *c, const Case *from);
/* Collective. Before its tables are made: what balances the last state of the stage before goes to them, or with the
 * nodes of its cloud. */
PetscErrorCode JumpFrom(Model *before, Tables *tables);
/* Room for that in the next model, before it takes its state; and the jump, when it has. */
PetscErrorCode JumpExpect(Model *model);
PetscErrorCode JumpTo(Model *model, const Case *from, const Tables *tables, char reason[256]);
/* motion/bring.c. Collective. Nodes of fem that bodies come to get the velocities that these bring. */
PetscErrorCode BodiesBringMotion(Model *model, const Case *from);
/* Collective. And where nothing tells how accelerations jump, since the model of the run before is not at hand, those
 * that are theirs alone begin with what balances them. */
PetscErrorCode BodiesBeginAcceleration(Model *model, const Case *from);
/* Of values of all nodes, those of this rank's nodes that no boundary holds; the others become 0. */
void keep_free(const Model *model, PetscReal *values);
/* Of values of this rank's nodes, those that a boundary holds where material reaches; the others become 0. */
void keep_held(const Model *model, PetscReal *values);
/* Collective. What is out of balance now; where the case releases it over time, it is held. */
PetscErrorCode HoldImbalance(Model *model, const Case *from, Imbalance *imbalance);
/* Collective. Residual of the state as it is, also where nodes are held: what is missing to balance, n_nodes x dim, of
 * owned nodes, N. */
PetscErrorCode Residual(Model *model, PetscReal *residual);
/* remainder.c. Do both stages rest, so that the first step of c takes in what the last one of `from` has left; or move,
 * and does c release something, of which what accelerates already is none? */
PetscBool remainder_goes_on(const Case *c, const Case *from);
/* Collective. Before its tables are made: what the last state of the stage before leaves out of balance goes to them,
 * or with the nodes of its cloud. */
PetscErrorCode RemainderFrom(Model *before, Tables *tables);
/* Room for that in the next model, before it takes its state; what is not to be held, when it has (Model.remainder),
 * until it is forgotten. held: the sum of what is held all the same, N. */
PetscErrorCode RemainderExpect(Model *model);
PetscErrorCode RemainderTo(Model *model, const Case *from, const Tables *tables, PetscReal *held);
/* Residual, of owned nodes, less that, once it is known which nodes are held. */
PetscErrorCode RemainderTakeOff(const Model *model, PetscReal *residual);
PetscErrorCode RemainderForget(Model *model);
/* taken_over.c. Is it known what of the forces that lack is inertia? */
PetscBool inertia_is_known(const Model *model, const Case *from);
/* Collective. Contact points that touch and bear nothing bear from now on what free nodes lack, as far as
 * their law does. residual: n_nodes x dim, N, of owned nodes; taken: does it count no more as it is? */
PetscErrorCode ContactTakesOver(const Model *model, const Case *from, const PetscReal *residual, PetscBool *taken);
