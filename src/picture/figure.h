/* Figures of curves: several series of (x, y) on linear or logarithmic axes. */
#pragma once
#include <petscsys.h>
#include "base/diag/diag.h"

typedef enum { FIGURE_LINE, FIGURE_MARKS, FIGURE_LINE_MARKS, FIGURE_DASHES, FIGURE_DOTS } FigureStyle;

typedef struct {
  const char *name; /* in the legend; NULL: none */
  FigureStyle style;
  PetscInt n;
  const PetscReal *x, *y;
  PetscBool right; /* y along the right axis, which is linear */
} FigureSeries;

/* A range of y that is shaded over the whole width: what experiments allow. low = high is a line. */
typedef struct {
  const char *name; /* in the legend */
  PetscReal low, high;
} FigureBand;

typedef struct {
  const char *title, *x_label, *y_label; /* NULL: none */
  const char *right_label;               /* of the right axis; NULL: there is none */
  PetscBool log_x, log_y;
  PetscReal from, to; /* the axis of x reaches there at least; from >= to: as far as curves do */
  PetscInt n_series;
  const FigureSeries *series;
  PetscInt n_bands;
  const FigureBand *bands;
  PetscReal slope;   /* of a reference triangle's line in a log-log figure; 0: none */
  int width, height; /* pixels; 0: 900 x 600 */
} Figure;

/* A PNG, or what the ending of the file says (picture/gnuplot.h). What goes wrong (no gnuplot,
 * nothing to draw, no permission) is told to diag. Points that an axis
 * cannot show (not finite, or not positive on a logarithmic one) are left out. Not collective. */
PetscErrorCode FigureWrite(const Figure *figure, const char *png, Diag *diag, PetscBool *done);

/* n figures side by side in rows of `columns`, in one picture below a title (NULL or "": none); one
 * with nothing to draw stays empty. */
PetscErrorCode FigureSheet(const char *title, PetscInt n, const Figure *figures, PetscInt columns, const char *png,
                           Diag *diag, PetscBool *done);

/* An SI prefix that makes numbers of this size readable, for units that take one: 2.5e7 Pa -> 25
 * MPa. Returns the factor by which numbers are multiplied and writes the new unit. */
PetscReal figure_unit(const char *unit, PetscReal largest, char prefixed[64]);
