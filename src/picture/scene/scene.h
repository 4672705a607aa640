/* What a picture of states shows, and how it is laid out on the page. */
#pragma once
#include <petscsys.h>
#include <stdio.h>
#include "picture/plot.h"
#include "picture/scene/field.h"
#include "output/vtk/vtk_read.h"
#include "wall/wall.h"

/* One state. */
typedef struct {
  PetscInt n;
  PetscReal *x;      /* n x 3: right, up, towards the eye, m */
  PetscReal *value;  /* n */
  PetscReal *radius; /* n, m */
  char title[256];
  PetscReal time; /* s */
  PetscInt n_edges;
  PetscReal *edges; /* n_edges x 4: the grid's lines on the page */
} PlotFrame;

typedef struct {
  PetscInt dim, n_frames;
  PlotFrame frames[PLOT_MAX_STATES];
  PetscInt columns;     /* in which frames stand; 0: chosen */
  char label[128];      /* of the colours, with the unit */
  PetscReal low, high;  /* of the colours */
  PetscReal gap;        /* how far apart points stand in the first frame, m */
  PetscInt up;          /* axis that points up, in space */
  PetscBool revolution; /* x is a radius */
  PetscBool mirrored;   /* both sides of the axis x = 0 are there, the other one as x < 0 */
  PetscBool turned;     /* in space, of points that lie in the plane, on both sides */
  Case *walled;         /* whose walls are drawn; NULL: none */
  Walls *walls;
  PetscReal box_min[3], box_max[3]; /* of all points (and the grid), before the projection */
} PlotScene;

/* Where things stand on the page, in pixels from the lower left corner. All frames have fields of
 * the same size. */
typedef struct {
  int width, height;
  int columns, rows;
  int left, bottom, w, h;   /* the field in the lower left */
  int step_x, step_y;       /* from one field to the next */
  PetscBool bar_below;      /* the colour bar lies under a wide picture, or stands beside it */
  PetscReal min[2], max[2]; /* what a field shows, m */
} PlotPage;

/* A position in space as the picture shows it: right, up, towards the eye. In the plane: as it
 * is. */
void plot_project(const PlotScene *scene, const PetscReal *x, PetscReal shown[3]);

/* Fit the scene into a page of the size asked for (0: chosen). */
void plot_lay_out(const PlotScene *scene, int width, int height, PlotPage *page);

/* Axes in space: the box's edges behind the body, with ticks and names along three of them. */
void plot_draw_box(FILE *out, const PlotScene *scene, const PlotPage *page);

/* The image of one frame on the page: rgba of page->w x page->h pixels. */
PetscErrorCode PlotImage(const PlotScene *scene, const PlotFrame *frame, const PlotPage *page, unsigned char *rgba);

/* Draw to a PNG. */
PetscErrorCode PlotDraw(PlotScene *scene, int width, int height, const char *png, Diag *diag, PetscBool *done);

/* frame.c: read a state into the next frame of the scene, as it is in its file, with the field
 * reduced to a number. Points without a place are left out. A damaged file adds no frame; the
 * reason tells. */
PetscErrorCode PlotFrameRead(VtkFile *file, const VtkFieldInfo *field, const PlotScalar *scalar, PlotScene *scene,
                             char reason[256]);
/* When all are read: give each its size, see it from where the eye is, and draw the box around
 * all. */
PetscErrorCode PlotFramesShape(PlotScene *scene);
/* Lines of a grid in the plane; none, with a reason, of a damaged file. */
PetscErrorCode PlotFrameGrid(VtkFile *file, PlotScene *scene, PlotFrame *frame, char reason[256]);
PetscErrorCode PlotFramesFree(PlotScene *scene);
