/* Texts that grow in memory while they are written through a stream. */
#pragma once
#include <petscsys.h>
#include <stdio.h>

#define TEXT_LABEL 640

typedef struct {
  FILE *out; /* write here */
  char *text;
  size_t size;
} TextStream;

PetscErrorCode TextOpen(TextStream *stream);
/* What was written, to be freed with PetscFree. */
PetscErrorCode TextClose(TextStream *stream, char **text);

/* "(1, 2)" or "(1, 2, 3)": a position. Returns buffer. */
const char *text_position(PetscInt dim, const PetscReal *x, char buffer[80]);
/* "height [m]"; without a unit (NULL or "") the text alone. Returns buffer. */
const char *text_with_unit(const char *text, const char *unit, char buffer[TEXT_LABEL]);
