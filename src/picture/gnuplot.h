/* Pictures made by gnuplot, which reads its script from a file without a name: nothing is left
 * behind. */
#pragma once
#include <petscsys.h>
#include <stdio.h>
#include "base/diag/diag.h"

/* A script that grows on the disk, in a file without a name. */
typedef struct {
  FILE *out; /* write here: commands, and binary data inline */
} GnuplotScript;

/* Starts a picture of so many pixels that becomes the file `path`: a PNG, or by its ending .svg or
 * .pdf (96 pixels an inch), or .gif or .mp4, which show one plot after the other, 0.1 s each;
 * ffmpeg makes the latter. Text is taken as it is (no
 * sub- and superscripts). */
PetscErrorCode GnuplotBegin(GnuplotScript *script, const char *path, int width, int height);
/* Let gnuplot run the script and give the picture its name. What goes wrong is told to diag; *done
 * says whether there is a picture. Frees the script. */
PetscErrorCode GnuplotEnd(GnuplotScript *script, const char *path, Diag *diag, PetscBool *done);

/* Can this program be started by its name? */
PetscBool gnuplot_has_program(const char *name);
/* Of a picture's path ("a.svg"): is it one whose format is known? */
PetscBool gnuplot_knows(const char *path);
/* A text in quotes, for a title or a label. */
void gnuplot_quote(FILE *out, const char *text);
