/* Diagnostics: mistakes of the user, collected and printed with their place in the case file.
 *
 * A mistake is named by the *path* of the value that it concerns, written as in `--set`:
 * "bodies[0].shape.box.min". The room that found it need not know where that value stands in the
 * file: a resolver (installed by the case reader) turns the path into file:line:column. */
#pragma once
#include <petscsys.h>
#include <stdio.h>

typedef struct Diag Diag;

typedef enum { DIAG_NOTE, DIAG_WARNING, DIAG_ERROR } DiagSeverity;

typedef struct {
  const char *file; /* name as the user gave it */
  const char *text; /* the source line, without its newline; NULL if there is none */
  int line, column; /* counted from 1; 0: unknown */
  int width;        /* how many characters the caret underlines, at least 1 */
} DiagPlace;

/* Find where `path` (or its nearest existing parent) stands. */
typedef void (*DiagResolver)(void *context, const char *path, DiagPlace *place);

PetscErrorCode DiagCreate(Diag **diag);
PetscErrorCode DiagDestroy(Diag **diag);
PetscErrorCode DiagSetResolver(Diag *diag, DiagResolver resolver, void *context);
/* Hand the resolver's context over: DiagDestroy (or the next resolver) calls `destroy` on it. */
PetscErrorCode DiagOwnContext(Diag *diag, void (*destroy)(void *));

/* From now on paths, and what is said, are those of stage k of the case (-1: of the case), by its name. What
 * was said in the same words of an earlier one is not said again. */
void diag_of_stage(Diag *diag, PetscInt k, const char *name);

/* Record a message about the value at `path` (NULL: about the case as a whole). */
void diag_error(Diag *diag, const char *path, const char *format, ...) PETSC_ATTRIBUTE_FORMAT(3, 4);
void diag_warning(Diag *diag, const char *path, const char *format, ...) PETSC_ATTRIBUTE_FORMAT(3, 4);
/* The same with a place that the caller knows (a mesh file, a syntax error). */
void diag_at(Diag *diag, DiagSeverity severity, const DiagPlace *place, const char *format, ...)
  PETSC_ATTRIBUTE_FORMAT(4, 5);
/* A second line under the newest message: "did you mean 'young'?". */
void diag_hint(Diag *diag, const char *format, ...) PETSC_ATTRIBUTE_FORMAT(2, 3);

/* So many errors, and so many other messages, are kept for print; the others only count. */
#define DIAG_MOST 50
/* Would the next message of this kind only count? Then it is not worth composing. */
PetscBool diag_full(const Diag *diag, DiagSeverity severity);

PetscInt diag_errors(const Diag *diag); /* number of errors so far on this rank */
PetscInt diag_warnings(const Diag *diag);

/* Collective: number of errors over all ranks; messages of other ranks travel to rank 0. */
PetscErrorCode DiagReduce(MPI_Comm comm, Diag *diag, PetscInt *errors);
/* Print all messages in the order of their lines: `case.yaml:12:7: error: ...`, the line, a caret, the hint; last how
 * many more there are. The first rank of the newest DiagReduce prints (before any: the first of all). */
PetscErrorCode DiagPrint(const Diag *diag, FILE *out);
/* The same, and all ranks forget them. */
PetscErrorCode DiagFlush(Diag *diag, FILE *out);

/* The word of a NULL-terminated list nearest to `word` (Damerau-Levenshtein); if none is near, one that begins as it
 * does; NULL if none does. */
const char *diag_nearest(const char *word, const char *const *words);
/* Under the newest message: "did you mean 'right'? There are: left, right, ...". */
void diag_hint_names(Diag *diag, const char *word, const char *const *words);
