/* Pictures made by gnuplot, which reads its script from a file without a name: nothing is left
 * behind. */
#pragma once
#include <petscsys.h>
#include <stdio.h>
#include "base/diag/diag.h"

/* A script that grows in memory. */
typedef struct {
  FILE *out; /* write here: commands, and binary data inline */
  char *text;
  size_t size;
} GnuplotScript;

/* Starts a PNG of so many pixels that becomes the file `png`; text is taken as it is (no sub- and
 * superscripts). */
PetscErrorCode GnuplotBegin(GnuplotScript *script, const char *png, int width, int height);
/* Let gnuplot run the script and give the picture its name. What goes wrong is told to diag; *done
 * says whether there is a picture. Frees the script. */
PetscErrorCode GnuplotEnd(GnuplotScript *script, const char *png, Diag *diag, PetscBool *done);

/* A text in quotes, for a title or a label. */
void gnuplot_quote(FILE *out, const char *text);
