/* What a picture of states shows, and how it is laid out on the page. */
#pragma once
#include <math.h>
#include <petscsys.h>
#include <stdio.h>
#include "picture/body/contours.h"
#include "picture/plot.h"
#include "picture/raster/raster.h"
#include "picture/scene/field.h"
#include "output/vtk/vtk_read.h"
#include "output/vtk/vtk_series.h"
#include "wall/wall.h"

/* One state. */
typedef struct {
  PetscInt n;
  PetscReal *x;      /* n x 3: right, up, towards the eye, m */
  PetscReal *value;  /* n */
  PetscReal *radius; /* n, m */
  char title[256];
  PetscReal time; /* s */
  PetscInt stage; /* from 1 on; 0: its file does not tell */
  PetscInt n_edges;
  PetscReal *edges; /* n_edges x 4: the grid's lines on the page */
  PetscInt n_triangles;
  PetscReal *corner, *corner_value; /* n_triangles x 3 x 3 and x 3: cells of fem, as RasterScene has them */
  unsigned char *side;
  PetscInt n_arrows;
  PetscReal *arrow;      /* n_arrows x 4: where they begin, and how far they go, m */
  PetscReal most, reach; /* of the longest one: in the unit of the field, and as long as suits this frame, m */
  PetscInt n_lines;
  PetscReal *line; /* n_lines x 2 x 3: walls in space */
  PetscInt n_faces;
  PetscReal *face; /* n_faces x 3 x 3, and n_faces: what of walls in space turns to the eye (RasterScene) */
  PetscInt *face_of;
  PetscReal *walls; /* 12 numbers of each wall with mass: walls_put_frames; NULL: they are where they began */
  PetscInt n_first;
  PetscReal *first, *first_radius; /* n_first x 3: where the points began, in the plane; NULL: not drawn */
  PetscReal *first_corner;         /* n_triangles x 3 x 3: where cells began */
  PetscInt n_parts;
  unsigned char *part; /* n: RasterScene; NULL: one */
  PetscReal gap;       /* of the balls: RasterScene */
  /* n: of points that began next to the surface of a shape that their body fills, the body's number from 1; is it known
   * where places around them began, and how (n x 9: body/shapes.c). NULL: of none */
  unsigned char *shape, *knows;
  PetscReal *back;
  unsigned char *there; /* of each body whose outline is known: has it points? */
} PlotFrame;

/* Whose outline is drawn: of a frame, as it is or as it was at first. */
typedef struct {
  const Case *c;
  const PlotContours *contours; /* NULL: none */
  const PlotFrame *frame;
  PetscBool first;
} PlotOutline;

/* Where points were at time 0: their numbers, rising, and the place of each among x (n x 3). */
typedef struct {
  PetscInt n, *place;
  PetscReal *id, *x;
} PlotOrigin;

typedef struct {
  PetscInt dim, n_frames;
  PlotFrame frames[PLOT_MAX_STATES];
  PetscInt columns;    /* in which frames stand; 0: chosen */
  char label[128];     /* of the colours, with the unit */
  PetscReal low, high; /* of the colours, in the unit that is shown: `factor` times the field's own */
  PetscReal factor;
  PetscBool named;       /* values are numbers of bodies or materials: they have names instead */
  PetscBool grid;        /* lines of the cells */
  PetscBool arrows;      /* of a vector field in the plane */
  PetscReal arrow_most;  /* the longest one of all frames, in the field's own unit; 0: there are none */
  PetscReal arrow_scale; /* m on the page for one of that unit */
  PetscBool smooth;      /* fields are means of the points around */
  PetscBool bare;        /* without the first outline, and where the grid is held */
  PetscReal gap;         /* how far apart points stand in the first frame, m */
  PetscInt up;           /* axis that points up, in space */
  PetscBool revolution;  /* x is a radius */
  PetscBool mirrored;    /* both sides of the axis x = 0 are there, the other one as x < 0 */
  PetscBool turned;      /* in space, of points that lie in the plane, on both sides */
  Case *walled;          /* the run's case, with walls and names; NULL: it cannot be read */
  Walls *walls;
  PlotContours *contours;           /* of bodies of meshes, in the plane; NULL */
  PetscBool borrowed;               /* are they those of the options? */
  PlotOrigin origin;                /* of runs that do not write displacements */
  PetscReal box_min[3], box_max[3]; /* of all points (and the grid), before the projection */
} PlotScene;

/* Where things stand on the page, in pixels from the lower left corner. All frames have fields of
 * the same size. */
typedef struct {
  int width, height;
  double scale; /* of letters and what they need, see label_scale */
  int columns, rows;
  int left, bottom, w, h;   /* the field in the lower left */
  int step_x, step_y;       /* from one field to the next */
  PetscBool bar_below;      /* the colour bar lies under a wide picture, or stands beside it */
  PetscReal min[2], max[2]; /* what a field shows, m */
} PlotPage;

/* A position in space as the picture shows it: right, up, towards the eye. In the plane: as it
 * is. */
void plot_project(const PlotScene *scene, const PetscReal *x, PetscReal shown[3]);

/* 1, 2 or 5 times a power of ten: the smallest that leaves so many pixels between ticks of a range
 * that takes `all` pixels. */
double plot_tick_step(PetscReal range, double all, double pixels);
#define LEAST_TICK_Y 30 /* such pixels, of several fields */

/* Fit the scene into a page of the size asked for (0: chosen). */
void plot_lay_out(const PlotScene *scene, int width, int height, PlotPage *page);

/* Axes in space: the box's edges behind the body, with ticks and names along three of them. */
void plot_draw_box(FILE *out, const PlotScene *scene, const PlotPage *page);

/* The image of one frame on the page: rgba of page->w x page->h pixels. */
PetscErrorCode PlotImage(const PlotScene *scene, const PlotFrame *frame, const PlotPage *page, unsigned char *rgba);

/* What is drawn: a field of the states, and its name, unit and component. */
typedef struct {
  VtkFieldInfo field;
  PlotScalar scalar;
  char words[192]; /* "velocity magnitude" */
} PlotSubject;

/* series.c: the states of a run that have points, and how many have none, which is told. A mistake goes to diag, and
 * there are no states then. */
PetscErrorCode PlotSeriesRead(const PlotOptions *options, Diag *diag, VtkSeries *series, PetscInt *empty);
/* state.c: n states as a scene, everything but its place on the page; mistakes go to diag. To be freed in any case. */
PetscErrorCode PlotSceneFill(const PlotOptions *options, PetscInt n, const VtkState *states, PlotSubject *subject,
                             Diag *diag, PlotScene *scene);
PetscErrorCode PlotSceneFree(PlotScene *scene);
/* Where the picture of these states goes, of one by its number. */
void plot_picture_name(const PlotOptions *options, const char *kind, PetscInt n, const VtkState *state,
                       const PlotSubject *subject, char *path);

/* draw.c: what all frames have around them; then one frame after the other. */
void plot_draw_around(FILE *out, const PlotScene *scene, const PlotPage *page);
PetscErrorCode PlotDrawFrame(FILE *out, const PlotScene *scene, PetscInt frame, const PlotPage *page,
                             unsigned char *rgba);
/* Draw to a file. */
PetscErrorCode PlotDraw(PlotScene *scene, int width, int height, const char *png, Diag *diag, PetscBool *done);

/* frame.c: read a state into the next frame of the scene, as it is in its file, with the field
 * reduced to a number. Points without a place are left out. A damaged file adds no frame; the
 * reason tells. */
PetscErrorCode PlotFrameRead(VtkFile *file, const VtkFieldInfo *field, const PlotScalar *scalar, PlotScene *scene,
                             char reason[256]);
/* A run that broke may hold points without one. */
static inline PetscBool plot_has_place(const PetscReal *x)
{
  return (PetscBool)(fabs(x[0]) < 1e30 && fabs(x[1]) < 1e30 && fabs(x[2]) < 1e30);
}
/* smooth.c: data (n x components) of points at x (n x 3) become means of what is around in the same body (n; NULL:
 * there is one), in about a cell. */
PetscErrorCode PlotSmooth(PetscInt dim, PetscInt n, const PetscReal *x, const PetscReal *body, PetscInt components,
                          PetscReal *data);
/* body/mesh.c: let the cells of a mesh, which moves with its body, stand for the points of the frame. */
PetscErrorCode PlotFrameMesh(VtkFile *file, PetscInt dim, const VtkFieldInfo *field, const PlotScalar *scalar,
                             PlotScene *scene, PlotFrame *frame, char reason[256]);
/* colours.c: colours from the smallest to the largest value, or as asked for, in a unit that suits. */
void plot_choose_colours(PlotScene *scene, const PlotOptions *options, const char *unit, const char *what);
/* Is the field one of those whose values are numbers of bodies or materials? Their names, and
 * which are in the picture. */
#define PLOT_MAX_NAMES 64
PetscBool plot_has_names(const char *field);
const char *plot_name(const PlotScene *scene, PetscInt value, char buffer[64]);
void plot_find_names(const PlotScene *scene, PetscBool there[PLOT_MAX_NAMES]);
/* When all are read: give each its size, see it from where the eye is, and draw the box around
 * all. */
PetscErrorCode PlotFramesShape(PlotScene *scene);
/* Lines of a grid in the plane; none, with a reason, of a damaged file. */
PetscErrorCode PlotFrameGrid(VtkFile *file, PlotScene *scene, PlotFrame *frame, char reason[256]);
/* first.c: displacements of a file, NULL without such a field; the outlines that bodies had in the beginning: their
 * size, and a line of each into the image of a frame. */
PetscErrorCode PlotReadDisplacement(VtkFile *file, PetscReal **u, char reason[256]);
PetscErrorCode PlotFirstShape(PlotScene *scene);
PetscErrorCode PlotFirstDraw(const PlotScene *scene, const PlotFrame *frame, const PlotPage *page, unsigned char *rgba);
/* image.c: a grey of this share over a pixel. */
void plot_blend(unsigned char *rgba, PetscReal grey, PetscReal alpha);
/* body/origin.c: the state at time 0, nothing if there is none; displacements of a file's points (x: n x 3) since then,
 * NULL if one of them was not there. */
PetscErrorCode PlotOriginRead(const char *run, PlotOrigin *origin);
PetscErrorCode PlotOriginFree(PlotOrigin *origin);
PetscErrorCode PlotOriginDisplacement(const PlotOrigin *origin, VtkFile *file, const PetscReal *x, PetscReal **u);
/* body/shapes.c: find points next to the surface of shapes and meshes, and how the material there moved. */
PetscErrorCode PlotShapes(const Case *c, const PlotContours *contours, PlotFrame *frame);
/* RasterScene's `holds`, of a PlotOutline. */
RasterHeld plot_shape_holds(const void *of, PetscInt p, const PetscReal *x);
/* Does a body whose outline is known, and of which there still are points, hold a place at the start? */
PetscBool plot_bodies_hold(const PlotOutline *outline, const PetscReal *x);
PetscErrorCode PlotFramesFree(PlotScene *scene);

/* arrows.c. Arrows of n points (x: n x 3) with vectors v (n x components), as long as these yet. */
PetscErrorCode PlotFrameArrows(PetscInt n, const PetscReal *x, PetscInt components, const PetscReal *v,
                               PlotFrame *frame);
/* One scale for those of all frames: that of the options, or by which none is longer than suits its frame. */
void plot_scale_arrows(PlotScene *scene, const PlotOptions *options);
