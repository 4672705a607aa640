/* Inside of Diag, shared by the files that collect, reduce and print. */
#pragma once
#include "base/diag/diag.h"

typedef struct {
  DiagSeverity severity;
  char *file, *text, *message, *hint; /* owned; file, text and hint may be NULL */
  int line, column, width;
} DiagMessage;

/* Uses the C library's memory, not PETSc's: a mistake on the command line is reported before PETSc
 * is there. */
struct Diag {
  PetscInt n, capacity;
  DiagMessage *messages;
  PetscInt errors, warnings;
  /* others, errors: how many messages are kept, and how many only counted */
  PetscInt shown[2], more[2];
  /* does this rank print? 1, 0; -1 until DiagReduce: the first of all ranks does */
  int printer;
  PetscBool stale_hint; /* the newest message was lost: its hint goes too */
  PetscInt stage;       /* if it has a name */
  char stage_name[64];
  DiagResolver resolver;
  void *context;
  void (*context_destroy)(void *);
};

/* Takes over the message's strings. */
void diag_append(Diag *diag, DiagMessage *message);
void diag_message_clear(DiagMessage *message);
/* Print one message with its source line, caret and hint. */
void diag_message_print(const DiagMessage *message, FILE *out);
