/* What the files of the public interface share. A public function checks its arguments, calls a
 * function that returns a PetscErrorCode like all others of this program by TALUS_CALL, which
 * translates the code. */
#pragma once
#include <petscsys.h>
#include "talus.h"
#include "input/case_file.h"
#include "model/model.h"

_Static_assert(sizeof(PetscReal) == sizeof(double), "the public interface is written for PETSc with double precision");

/* A caller's forces; talus_ask_forces asks for them as a BodyForce, with a TalusForce as its
 * context. */
typedef struct {
  TalusBodyForces force;
  void *context;
} TalusForce;
void talus_ask_forces(void *force, PetscInt n, const PetscReal *X, const PetscReal *x, PetscReal t, PetscReal *b);

/* Likewise factors of a load; talus_ask_factors with a TalusFactors as its context. */
typedef struct {
  TalusLoadFactors factors;
  void *context;
} TalusFactors;
void talus_ask_factors(void *factors, PetscInt n, const PetscReal *X, const PetscReal *x, PetscReal t, PetscReal *f);
/* Index of a load by its place, "tractions[0]"; -1 if there is none. */
PetscInt talus_load_index(const Case *c, const char *load);

struct TalusCase {
  PetscBool busy; /* runs, or becomes a model: what functions of the caller are asked then must not close it */
  MPI_Comm comm;  /* PETSc's copy of the user's, for no other messages than talus's */
  Case *c;
  Diag *diag;             /* knows where in the file each value stands */
  TalusForce force;       /* of runs and models made from now on; force NULL: none */
  TalusFactors *factors;  /* likewise, of each load */
  TalusProgress progress; /* NULL: nobody is told */
  void *progress_context;
};

/* PETSc's code as one of ours. The call is made in the "C" locale, as the program runs: a caller's may have commas in
 * its numbers. The C library keeps that locale and makes it once. */
#define TALUS_CALL(call) (talus_enter(), talus_leave(call))
void talus_enter(void);
int talus_leave(PetscErrorCode code);
/* Does PETSc run? Before anything else of PETSc may be called. */
PetscBool talus_is_running(void);
/* Collective. Print what was collected on stderr, or hand it to all ranks as text. */
PetscErrorCode TalusTell(MPI_Comm comm, Diag *diag, char **messages);
/* Index of the measure, -1 if there is none. */
PetscInt talus_measure_index(const Case *c, const char *name);
