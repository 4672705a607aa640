/* Pictures of a run: states coloured by a field, side by side if there are several, and the
 * histories of its measures; those of several runs over each other. */
#pragma once
#include <petscsys.h>
#include "base/diag/diag.h"

#define PLOT_MAX_STATES 36
#define PLOT_MAX_CURVES 30

/* Words of options, ended by NULL. */
extern const char *const plot_formats[], *const plot_films[], *const plot_legends[];

typedef struct {
  const char *run;                  /* the run directory */
  const char *field;                /* NULL: displacement, or the first that there is */
  const char *component;            /* NULL: magnitude of a vector, mises of a stress, deviatoric of a strain */
  PetscInt n_times;                 /* the states nearest to these; 0: the last one */
  PetscReal times[PLOT_MAX_STATES]; /* s */
  /* so many of all states instead, from the first to the last; no picture where there are less
   * than three */
  PetscInt even;
  PetscBool all_times; /* every state instead */
  PetscInt columns;    /* of several states; 0: chosen */
  PetscBool grid;      /* draw the grid too */
  PetscBool arrows;    /* of a vector field in the plane: arrows, too */
  /* the longest of them in the field's own unit, and m for one of it; 0: as suits the states that are drawn */
  PetscReal arrow_most, arrow_scale;
  PetscBool smooth;    /* means of the points around instead of what each carries */
  PetscBool bare;      /* without the outline that the body had at first, and where the grid is held */
  PetscBool animate;   /* PlotAnimate */
  const char *profile; /* of PlotProfile: a wall, by its name */
  PetscBool has_range;
  PetscReal range[2]; /* of the colours, in the field's own unit */
  int width, height;  /* pixels; 0: chosen to suit the body */
  PetscInt up;        /* axis that points up in a picture in space: 0 1 2; -1: that of gravity */
  /* of bodies of revolution, which are shown on both sides of their axis: */
  PetscBool half;     /* one side alone */
  PetscBool turned;   /* the whole body in space, with a quarter cut out */
  const char *out;    /* its ending is the format; NULL: RUN/pictures/state_... */
  const char *format; /* png svg pdf: of pictures whose name is chosen; NULL: png */
  /* what bounds bodies of meshes, for many pictures of a run; NULL: read for each */
  struct PlotContours *contours;
} PlotOptions;

typedef struct {
  PetscInt n_runs, n_y;
  const char *const *runs; /* run directories */
  const char *x;           /* a measure, "time" or "step"; NULL: time */
  const char *const *y;
  const char *legend; /* "names" of runs or the "keys" in which they differ; NULL: keys, where there are two at most */
  const char *out;    /* NULL: pictures/Y_over_X.png of the first run */
  const char *format;
  int width, height; /* pixels; 0: chosen */
} PlotXYOptions;

/* Draw the states, all on one scale and in one set of colours. Mistakes go to diag, and picture is
 * "" if there is none. One process. */
PetscErrorCode PlotState(const PlotOptions *options, Diag *diag, char picture[PETSC_MAX_PATH_LEN]);

/* RUN/pictures/history_NAME.png for every measure of history.csv. `said` is called with the path of
 * each. */
PetscErrorCode PlotHistories(const PlotOptions *options, Diag *diag, void (*said)(const char *path));

/* RUN/pictures/animation_FIELD.gif (or .mp4): all states of the run one after the other. */
PetscErrorCode PlotAnimate(const PlotOptions *options, Diag *diag, void (*said)(const char *path));

/* Measures over a measure: a curve for each y of each run. Units stand at the axes; measures of a second unit have
 * the right one. `said` is called with the path. */
PetscErrorCode PlotXY(const PlotXYOptions *options, Diag *diag, void (*said)(const char *path));

/* RUN/pictures/factor.png of a run that has a factor.csv: displacement over the factor of its strength. */
PetscErrorCode PlotFactor(const PlotOptions *options, Diag *diag, void (*said)(const char *path));
/* RUN/pictures/limit.png of a run that has a limit.csv: load over displacement. */
PetscErrorCode PlotLimit(const PlotOptions *options, Diag *diag, void (*said)(const char *path));

/* RUN/pictures/profile_WALL.png (or `out`) and .csv: normal and shear tractions of the state nearest to the
 * first time, along the coordinate in which what touches the wall reaches farthest. */
PetscErrorCode PlotProfile(const PlotOptions *options, Diag *diag, void (*said)(const char *path));

/* RUN/pictures/, made if it is not there; PETSC_FALSE and a diagnostic if it cannot be. */
PetscBool plot_folder(const char *run, Diag *diag);
/* The ending of pictures: the format, or "png" for NULL. */
const char *plot_ending(const char *format);
/* Turn what a file name should not hold into '_'. */
void plot_file_name(char *name);
