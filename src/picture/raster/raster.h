/* Points drawn as balls, triangles and lines that hide what lies behind them, into an image of colours. */
#pragma once
#include <petscsys.h>

/* Red, green, blue (0 to 255) of a value in [0, 1], dark blue over green to yellow; `palette_stops`
 * of them at equal distances. */
#define PALETTE_STOPS 10
extern const unsigned char palette_stops[PALETTE_STOPS][3];
void palette_colour(PetscReal value, PetscReal rgb[3]);
/* Colours of things that are told apart by name, again from the first one after the last. */
#define PALETTE_NAMES 10
extern const unsigned char palette_names[PALETTE_NAMES][3];

/* Where a place is: outside of the body next to whose surface its point began, inside with a point of the outermost,
 * whose own it is or may be, or with one of those behind them. */
typedef enum { RASTER_OUTSIDE, RASTER_OWN, RASTER_NEAR, RASTER_DEEP } RasterHeld;

typedef struct {
  PetscInt n;
  const PetscReal *x;        /* n x 3: right, up, towards the eye, m */
  const PetscReal *radius;   /* n, m */
  const PetscReal *value;    /* n, in [0, 1]; NaN is grey */
  PetscInt n_parts;          /* bodies with an outline of their own; 0: one */
  const unsigned char *part; /* n, of n_parts: whose a point is */
  PetscInt n_triangles;
  const PetscReal *corner;       /* n_triangles x 3 x 3, as x */
  const PetscReal *corner_value; /* n_triangles x 3, as value; linear between corners */
  const unsigned char *side;     /* n_triangles: bit k: from corner k to the next a line is drawn; NULL: none */
  PetscInt n_faces;
  const PetscReal *face; /* n_faces x 3 x 3, as corner: of walls, grey */
  const PetscInt
    *face_of; /* n_faces, those of a wall behind each other: which; where bodies are in it, it hides none */
  PetscInt n_lines;
  const PetscReal *line; /* n_lines x 2 x 3, as x: dark, where nothing hides them */
  PetscReal blur;        /* m, over which values of balls in the plane go over into each other; 0: each has its own */
  PetscBool named;       /* values are numbers of names, 0, 1, ... */
  PetscBool shaded;      /* as bodies in space; otherwise flat */
  /* m; gaps between balls up to twice this wide are filled, in space before what is empty, and the outline of what
   * they fill is drawn back by half their radius, to where the material ends; 0: neither */
  PetscReal gap;
  const unsigned char
    *solid; /* in the plane, width x height: is a wall there? What touches it is not drawn back from it;
                               * NULL: there is none */
  /* with a gap, n: which points know the outline next to them, and does the body hold a place next to such a point?
   * Of the outermost their own and all that balls cover is shown there, of others what is drawn back; in space balls
   * that know are cut by it. NULL: none knows */
  const unsigned char *knows;
  RasterHeld (*holds)(const void *of, PetscInt p, const PetscReal *x);
  const void *of;
  PetscReal min[2], max[2]; /* what the image shows, m */
  int width, height;        /* pixels */
} RasterScene;

/* rgba: width x height x 4, from the lower left corner row by row, smooth at the edges, transparent
 * where there is nothing. */
PetscErrorCode RasterDraw(const RasterScene *scene, unsigned char *rgba);
