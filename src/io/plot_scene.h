/* What a picture of a state shows, and how it is laid out on the page. */
#pragma once
#include <petscsys.h>
#include <stdio.h>
#include "io/plot.h"

typedef struct {
  PetscInt dim, n;
  PetscReal *x;                     /* n x 3: right, up, towards the eye, m */
  PetscReal *value;                 /* n */
  PetscReal *radius;                /* n, m */
  char title[256], label[128];      /* label: of the colours, with the unit */
  PetscReal low, high;              /* of the colours */
  PetscInt up;                      /* axis that points up, in space */
  PetscReal box_min[3], box_max[3]; /* of the points (and the grid), before the projection */
  PetscInt n_edges;
  PetscReal *edges; /* n_edges x 4: the grid's lines on the page */
} PlotScene;

/* Where things stand on the page, in pixels from the lower left corner. */
typedef struct {
  int width, height;
  int left, bottom, w, h;   /* the field of the picture */
  PetscBool bar_below;      /* the colour bar lies under a wide picture, or stands beside it */
  PetscReal min[2], max[2]; /* what the field shows, m */
} PlotPage;

/* A position in space as the picture shows it: right, up, towards the eye. In the plane: as it is. */
void plot_project(const PlotScene *scene, const PetscReal *x, PetscReal shown[3]);

/* Fit the scene into a page of the size asked for (0: chosen). */
void plot_lay_out(const PlotScene *scene, int width, int height, PlotPage *page);

/* Axes in space: the box's edges behind the body, with ticks and names along three of them. */
void plot_draw_box(FILE *out, const PlotScene *scene);

/* Draw to a PNG. */
PetscErrorCode PlotDraw(PlotScene *scene, int width, int height, const char *png, Diag *diag, PetscBool *done);
